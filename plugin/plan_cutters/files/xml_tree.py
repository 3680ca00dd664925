"""XML with the lines of its elements, and no more: no entities, no other files, no depth without end."""

import io
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from xml.sax import ContentHandler, SAXException
from xml.sax.xmlreader import AttributesImpl, InputSource, Locator

from defusedxml.common import DefusedXmlException
from defusedxml.expatreader import create_parser

from plan_cutters.errors import PlanError

_DEEPEST, _ELEMENTS = 64, 2_000_000
_DECLARED = re.compile(r"""^<\?xml[^>]*?\bencoding\s*=\s*["']([\w.-]+)["']""")


@dataclass(slots=True)
class Element:
    """An element: its name without a namespace's prefix, its attributes, text, children and the line in which it begins."""

    tag: str
    given: dict[str, str]
    line: int
    text: str = ""
    children: list["Element"] = field(default_factory=list)

    def first(self, tag: str) -> "Element | None":
        """The first child of a name."""
        return next((child for child in self.children if child.tag == tag), None)

    def below(self, tags: tuple[str, ...]) -> Iterator["Element"]:
        """Elements of some names, in whatever group they stand, but not in each other."""
        waiting = self.children[::-1]
        while waiting:
            element = waiting.pop()
            if element.tag in tags:
                yield element
            else:
                waiting += element.children[::-1]


class _Tree(ContentHandler):
    """Elements as they come."""

    _locator: Locator

    def __init__(self, file: str, error: type[PlanError]) -> None:
        self.file, self.error, self.count = file, error, 0
        self.top = Element("", {}, 0)
        self.open = [self.top]

    def startElement(self, name: str, attrs: AttributesImpl) -> None:
        self.count += 1
        line = self._locator.getLineNumber() or 0
        if len(self.open) > _DEEPEST or self.count > _ELEMENTS:
            raise self.error(f"line {line}: its elements are too deep or too many", file=self.file)
        element = Element(name.rpartition(":")[2], dict(attrs.items()), line)
        self.open[-1].children.append(element)
        self.open.append(element)

    def endElement(self, name: str) -> None:
        self.open.pop()

    def characters(self, content: str) -> None:
        self.open[-1].text += content


def parse(data: bytes, file: str, text: str, noun: str, error: type[PlanError]) -> Element:
    """The root of a document; `text` is what its bytes say, whatever it declares of their encoding.

    Raises
    ------
    error
        It is not well-formed, or declares a document type or entities.
    """
    source = InputSource()
    declared = _DECLARED.match(text.lstrip("\ufeff"))
    wide = 0 in data[:4] or data[:2] in (b"\xff\xfe", b"\xfe\xff")
    if declared and declared[1].lower().startswith("utf-16") != wide:
        # Saved by an editor in another encoding than it still declares.
        source.setEncoding("utf-8")
        data = text.encode("utf-8", "replace")
    source.setByteStream(io.BytesIO(data))
    parser, tree = create_parser(forbid_dtd=True), _Tree(file, error)
    parser.setContentHandler(tree)
    try:
        parser.parse(source)
    except DefusedXmlException:
        raise error(
            f"line {parser.getLineNumber()}: it declares a document type or entities, which no {noun} needs; they are refused",
            file=file,
        ) from None
    except (SAXException, LookupError, ValueError) as fault:
        cause = fault.getException() if isinstance(fault, SAXException) else None
        raise error(f"is no well-formed XML ({cause or fault}); export it anew", file=file) from None
    return tree.top.children[0]
