"""XML with the lines of its elements, and no more: no entities, no other files, no depth without end."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any
from xml.parsers import expat

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


def parse(data: bytes, file: str, text: str, noun: str, error: type[PlanError]) -> Element:
    """The root of a document; `text` is what its bytes say, whatever it declares of their encoding.

    Raises
    ------
    error
        It is not well-formed, or declares a document type or entities.
    """
    declared = _DECLARED.match(text.lstrip("\ufeff"))
    wide = 0 in data[:4] or data[:2] in (b"\xff\xfe", b"\xfe\xff")
    if declared and declared[1].lower().startswith("utf-16") != wide:
        # Saved by an editor in another encoding than it still declares.
        parser, data = expat.ParserCreate("utf-8"), text.encode("utf-8", "replace")
    else:
        parser = expat.ParserCreate()
    top = Element("", {}, 0)
    open_, count = [top], 0

    def refuse(*_: Any) -> None:
        raise error(
            f"line {parser.CurrentLineNumber}: it declares a document type or entities, which no {noun} needs; they are "
            "refused",
            file=file,
        )

    def start(tag: str, attributes: dict[str, str]) -> None:
        nonlocal count
        count += 1
        if len(open_) > _DEEPEST or count > _ELEMENTS:
            raise error(f"line {parser.CurrentLineNumber}: its elements are too deep or too many", file=file)
        element = Element(tag.rpartition(":")[2], attributes, parser.CurrentLineNumber)
        open_[-1].children.append(element)
        open_.append(element)

    def end(_: str) -> None:
        open_.pop()

    def words(text: str) -> None:
        open_[-1].text += text

    parser.buffer_text = True
    parser.StartDoctypeDeclHandler = parser.EntityDeclHandler = refuse
    parser.StartElementHandler, parser.EndElementHandler, parser.CharacterDataHandler = start, end, words
    try:
        parser.Parse(data, True)
    except (expat.ExpatError, LookupError, ValueError) as fault:
        raise error(f"is no well-formed XML ({fault}); export it anew", file=file) from None
    return top.children[0]
