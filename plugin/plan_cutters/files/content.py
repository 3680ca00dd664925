"""Files as bytes, text, JSON, XML and zip archives: what is too large, packed too tightly or none is one line."""

import codecs
import io
import json
import lzma
import os
import re
import tomllib
import zipfile
import zlib
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, Generic, TypeVar
from xml.sax import ContentHandler, SAXException
from xml.sax.xmlreader import AttributesImpl, InputSource, Locator

from defusedxml.common import DefusedXmlException
from defusedxml.expatreader import create_parser

from plan_cutters.errors import PlanError
from plan_cutters_base import user_files
from plan_cutters_base.user_files import IrregularError, open_regular

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

    Raises error: it is not well-formed, or declares a document type or entities.
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


@contextmanager
def translated(name: str, error: type[PlanError]) -> Iterator[None]:
    """Raise what goes wrong where a file is opened and read as an error that names the file."""
    try:
        yield
    except IrregularError as fault:
        raise error(str(fault), file=name) from None
    except OSError as fault:
        raise error(f"cannot be read: {fault.strerror or fault}", file=name) from None
    except ValueError as fault:
        raise error(f"is no name of a file: {fault}", file=ascii(name)) from None


def regular_bytes(path: str | os.PathLike[str], most: int) -> bytes | None:
    """Read all bytes of a regular file, or of a link to one; the result is None where there is no such file.

    `path`: where it should be. `most`: bytes that it may have. Raises PlanError: it is no regular file, is larger, or cannot be
    read.

    >>> regular_bytes("not/there", most=10) is None
    True
    """
    name = Path(path).name
    with translated(name, PlanError):
        try:
            with open_regular(path) as opened:
                large = os.fstat(opened.fileno()).st_size > most
                data = b"" if large else opened.read(most + 1)
        except (FileNotFoundError, NotADirectoryError):
            return None
    if large or len(data) > most:
        raise PlanError(f"is larger than {most} bytes", file=name)
    return data


#: Most bytes of a file, of what is unpacked from it, and unpacked bytes for each packed one (beyond the first million).
_FILE, _UNPACKED, _RATIO = 32 << 20, 32 << 20, 300
_MEMBERS = 2000


class TwiceError(ValueError):
    """A JSON object that says something twice, and not the same."""


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    members = dict(pairs)
    if len(members) < len(pairs):
        for key, value in pairs:
            if members[key] != value:
                raise TwiceError(f"{ascii(key)[:40]} is given twice in one object, with different values")
    return members


@dataclass(frozen=True)
class Content:
    """A file that is being recognised: its bytes, its text, its JSON, its XML, what a zip archive it is holds."""

    path: Path
    data: bytes
    noun: str  #: What it should be, and the error where it is not.
    error: type[PlanError]

    @classmethod
    def of(cls, path: str | os.PathLike[str], noun: str, error: type[PlanError]) -> "Content":
        """Read the content of a regular file; `error` names it as no `noun` where it cannot be one."""
        try:
            name = Path(path).name
        except TypeError:
            raise error(f"a {noun} is a file's name, not a value of type {type(path).__name__}") from None
        with translated(name, error):
            try:
                data = user_files.content(path, _FILE + 1)
            except IrregularError as fault:
                what = f"{noun} in it" if os.path.isdir(path) else "file"
                raise error(f"{fault}; give a {what}", file=name) from None
        if len(data) > _FILE:
            raise error(f"is larger than {_FILE >> 20} MB: no {noun} is; split it", file=name)
        return cls(Path(path), data, noun, error)

    @property
    def name(self) -> str:
        return self.path.name

    @cached_property
    def encoded(self) -> tuple[str, str]:
        """The text and its encoding."""
        data = self.data
        for mark, encoding in ((codecs.BOM_UTF8, "utf-8-sig"), (codecs.BOM_UTF16_LE, "utf-16"), (codecs.BOM_UTF16_BE, "utf-16")):
            if data.startswith(mark):
                return data.decode(encoding, "replace"), encoding
        if len(data) >= 4 and 0 in data[:2] and data[0] != data[1]:
            encoding = "utf-16-be" if data[0] == 0 else "utf-16-le"
            return data.decode(encoding, "replace"), encoding
        try:
            return data.decode("utf-8"), "utf-8"
        except UnicodeDecodeError:
            return data.decode("cp1252", "replace"), "cp1252"

    @property
    def text(self) -> str:
        return self.encoded[0]

    @cached_property
    def head(self) -> str:
        """How the text begins, in lower case."""
        return self.text[:4096].lstrip().lower()

    @cached_property
    def json(self) -> Any:
        """Read the content as JSON; the result is None where it is no valid JSON."""
        if self.head[:1] not in ("{", "["):
            return None
        try:
            return json.loads(self.text, object_pairs_hook=_once)
        except (ValueError, RecursionError):
            return None

    def xml(self) -> Element:
        """The root of the XML that it holds."""
        return parse(self.data, self.name, self.text, self.noun, self.error)

    def broken_json(self) -> PlanError:
        """Why what looks like JSON is none."""
        try:
            json.loads(self.text, object_pairs_hook=_once)
        except RecursionError:
            why = "it is nested too deeply"
        except json.JSONDecodeError as error:
            why = f"line {error.lineno}, column {error.colno}: {error.msg[:1].lower()}{error.msg[1:]}"
        except TwiceError as error:
            why = str(error)
        except ValueError:
            why = "it has a number of thousands of digits"
        else:
            why = "it holds nothing that is known"
        return self.error(f"looks like JSON but cannot be read ({why}); export it anew", file=self.name)

    def toml(self) -> dict[str, Any]:
        """The content as TOML. Raises `error`: it is none."""
        try:
            return tomllib.loads(self.text)
        except RecursionError:
            why = "it is nested too deeply"
        except tomllib.TOMLDecodeError as error:
            why = " ".join(str(error).split())
        except ValueError:
            # Python's own words about numbers of thousands of digits are for programmers.
            why = "a number has too many digits"
        raise self.error(f"is no TOML: {why}", file=self.name)

    @cached_property
    def members(self) -> dict[str, zipfile.ZipInfo] | None:
        """List the members of a zip archive by name; the result is None where the file is no zip archive."""
        if not self.data.startswith((b"PK\x03\x04", b"PK\x05\x06")):
            return None
        try:
            with zipfile.ZipFile(io.BytesIO(self.data)) as archive:
                entries = archive.infolist()
        except (zipfile.BadZipFile, OSError, ValueError, NotImplementedError) as fault:
            raise self.error(f"is a zip archive that cannot be read ({fault}); export it anew", file=self.name) from None
        if len(entries) > _MEMBERS:
            raise self.error(f"is a zip archive of {len(entries)} files: no {self.noun} is", file=self.name)
        members = {each.filename: each for each in entries}
        if len(members) < len(entries):
            raise self.error("is a zip archive with two files of one name; export it anew", file=self.name)
        return members

    def unpacked(self, member: str) -> bytes:
        """One file of a zip archive, unless it is a bomb."""
        try:
            with zipfile.ZipFile(io.BytesIO(self.data)) as archive, archive.open(member) as packed:
                most = min(_UNPACKED, (1 << 20) + _RATIO * len(self.data))
                data = packed.read(most + 1)
        except (zipfile.BadZipFile, zlib.error, lzma.LZMAError, OSError, EOFError, ValueError, RuntimeError, KeyError) as error:
            what = " ".join(str(error).split()) or type(error).__name__
            raise self.error(f"its {member} cannot be unpacked ({what}); export it anew", file=self.name) from None
        if len(data) > most:
            raise self.error(
                f"its {member} unpacks to more than {most >> 20} MB from {len(self.data)} bytes: that is no {self.noun}, but a "
                "zip bomb",
                file=self.name,
            )
        return data


def lines_of(text: str, key: str) -> list[int]:
    """Lines, from 1, in which the items of the list `key` of a JSON object begin; none where that cannot be told."""
    decode, between, lines = json.JSONDecoder(), re.compile(r"[ \t\n\r,]*"), list[int]()
    begins = re.search(rf'"{key}"\s*:\s*\[', text)
    place, line, seen = begins.end() if begins else len(text), 1, 0
    try:
        while text[place := between.match(text, place).end()] != "]":  # type: ignore[union-attr]
            line, seen = line + text.count("\n", seen, place), place
            lines.append(line)
            _, place = decode.raw_decode(text, place)
    except (ValueError, IndexError, RecursionError):
        return []
    return lines


#: A function of a content, and of what a room adds to it.
Reader = TypeVar("Reader", bound=Callable[..., Any])


@dataclass(frozen=True, slots=True)
class Format(Generic[Reader]):
    """A format that is read: its name, its usual suffixes, and the functions that recognise and read its content."""

    name: str
    suffixes: tuple[str, ...]
    recognises: Callable[[Any], bool]
    read: Reader


@dataclass(frozen=True, slots=True)
class Foreign:
    """A foreign format is recognised but not read: it has a name, a test of the content, and advice."""

    name: str
    recognises: Callable[[Any], bool]
    instead: str


def rooted(*names: str) -> Callable[[Content], bool]:
    """Recognise XML or HTML by names of which one begins an element near its start."""
    pattern = re.compile(rf"<\s*(?:\w+:)?(?:{'|'.join(names)})\b", re.IGNORECASE)
    return lambda c: c.head.startswith("<") and pattern.search(c.head) is not None


def called(*suffixes: str) -> Callable[[Content], bool]:
    """Recognise a file by the suffix of its name."""
    return lambda c: c.path.suffix.lower() in suffixes


def recognised(
    content: Content, formats: Sequence[Format[Reader]], foreign: Iterable[Foreign], *, xml: str, json: str,
    archive: str = "", first: Iterable[Foreign] = (),
) -> Format[Reader]:  # fmt: skip
    """The format of a file; what is known and not read is refused by name, some of it `first`.

    `xml`, `json`, `archive`: what to say of a file of these that is of no format.

    Raises PlanError: the content's own error.
    """
    # But perhaps a byte-order mark.
    if not content.data.strip(b" \t\r\n\0\xef\xbb\xbf\xff\xfe"):
        raise content.error("is empty", file=content.name)
    _refuse(content, first)
    for form in formats:
        if form.recognises(content):
            return form
    _refuse(content, foreign)
    if archive and content.members is not None:
        raise content.error(f"is a zip archive {archive}", file=content.name)
    if content.head[:1] in ("{", "[") and content.json is None:
        raise content.broken_json()
    if content.head.startswith("<"):
        raise content.error(f"is XML, but {xml}", file=content.name)
    if content.json is not None:
        raise content.error(f"is JSON, but {json}", file=content.name)
    names = dict.fromkeys(f"{form.name} ({' '.join(form.suffixes)})" for form in formats)
    raise content.error(f"is no {content.noun} that is known; read are {', '.join(names)}", file=content.name)


def _refuse(content: Content, foreign: Iterable[Foreign]) -> None:
    for each in foreign:
        if each.recognises(content):
            raise content.error(f"is {each.name}, which is not read: {each.instead}", file=content.name)


def toml_text(value: Any) -> str:
    """A text, a number, a list or a table as TOML has it; of a list None stands for an end that is not there."""
    if isinstance(value, str):
        clean = value.encode("utf-8", "replace").decode("utf-8")
        return json.dumps(clean, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, dict):
        return f"{{ {', '.join(f'{key} = {toml_text(each)}' for key, each in value.items())} }}"
    if isinstance(value, list):
        # TOML has no null; only limits lack an end.
        ends = ["-inf", "inf"]
        return f"[{', '.join(ends[i] if each is None else toml_text(each) for i, each in enumerate(value))}]"
    return repr(value)
