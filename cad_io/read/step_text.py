"""The text of a STEP file, without the CAD kernel: files that it refers to, names in older encodings, solids without a product.

Whoever keeps or sends a part knows so what belongs to it.
"""

import os
import re
from collections.abc import Callable, Iterator
from typing import NamedTuple

from cad_io.errors import ReadError
from cad_io.read.encodings import CALLED, decoded, encoding_of, is_plain
from plan_cutters_base import user_files as files

#: The entities that name a file, each by its first text, and their short names (ISO 10303-21; AP214 and AP242 call them
#: external documents).
WORDS = b"APPLIED_EXTERNAL_IDENTIFICATION_ASSIGNMENT", b"DOCUMENT_FILE", b"APEXIA", b"DCMFL"
_NAMED = re.compile(rb"(?:" + b"|".join(WORDS) + rb")\s*\(\s*'((?:[^']|'')*)'")
#: A comment, or a text, in which none begins.
_COMMENT = re.compile(rb"/\*.*?\*/|'[^']*'", re.DOTALL)
#: Letters beyond ASCII, and a backslash, as a text has them (ISO 10303-21, 6.4.3).
_LETTERS = re.compile(rb"\\X2\\((?:[0-9A-Fa-f]{4})*)\\X0\\|\\X4\\((?:[0-9A-Fa-f]{8})*)\\X0\\|\\X\\([0-9A-Fa-f]{2})|\\S\\(.)|\\\\")
#: Documents beside the shape: that one is not there costs no geometry.
DOCUMENTS = (".pdf", ".txt", ".doc", ".docx", ".xls", ".xlsx", ".csv", ".htm", ".html", ".jpg", ".jpeg", ".png", ".tif",
              ".tiff", ".svg")  # fmt: skip
#: Files that are followed from one, at most.
_MOST = 10_000


def names(data: bytes) -> tuple[str, ...]:
    """Names of the files that a STEP file's text refers to, as the CAD kernel reads them there, each once."""
    if not any(word in data for word in WORDS):
        return ()
    if b"/*" in data:
        data = _COMMENT.sub(lambda match: b" " if match[0].startswith(b"/") else match[0], data)
    return tuple(name for name in dict.fromkeys(map(_name, _NAMED.findall(data))) if name.strip())


def _name(text: bytes) -> str:
    """The name of a file that a text in STEP stands for: a long one may be broken into lines."""
    whole = text.replace(b"\r", b"").replace(b"\n", b"").replace(b"''", b"'")
    # As the kernel takes them: a folder of Windows is one on every system.
    return os.fsdecode(_LETTERS.sub(_letters, whole)).replace("\\", "/")


def _letters(match: re.Match[bytes]) -> bytes:
    two, four, one, upper = match.groups()
    if two is not None:
        text = bytes.fromhex(two.decode()).decode("utf-16-be", "replace")
    elif four is not None:
        text = bytes.fromhex(four.decode()).decode("utf-32-be", "replace")
    elif one is not None:
        text = bytes.fromhex(one.decode()).decode("latin-1")
    else:
        text = "\\" if upper is None else chr(upper[0] | 0x80)
    return text.encode()


def followed(data: bytes, read: Callable[[str], bytes | None]) -> Iterator[tuple[str, bytes | None]]:
    """Follow the references of a STEP file, by its content, and those of the files that they lead to.

    `read` gives the content of a file by its path from the folder of the first one; None where there is none. Yields that path,
    and the content; each path once. A file that is no STEP file refers to nothing. Raises ReadError where there are too many.
    """
    seen: set[str] = set()
    waiting = [("", data)]
    while waiting:
        folder, content = waiting.pop()
        for name in names(content):
            path = os.path.normpath(os.path.join(folder, name))
            if path in seen:
                continue
            if len(seen) >= _MOST:
                raise ReadError(f"refers to more than {_MOST} files: save the assembly as one file")
            seen.add(path)
            raw = read(path)
            yield path, raw
            if raw is not None:
                waiting.append((os.path.dirname(path), raw))


def in_folder_of(file: str | os.PathLike[str]) -> Callable[[str], bytes | None]:
    """Read files by their paths from the folder of a file; None where there is none that can be read.

    Raises `plan_cutters_base.user_files.OutsideError` where one may not be read, ReadError where one is a pipe or a device, which
    the kernel would wait for.
    """
    folder = os.path.dirname(os.fspath(file))

    def read(name: str) -> bytes | None:
        try:
            return files.content(os.path.join(folder, name))
        except files.OutsideError:
            raise
        except files.IrregularError as error:
            if os.path.isdir(os.path.join(folder, name)):
                return None
            raise ReadError(f"refers to {name}, which {error}: save the part that it was in its place") from None
        except (OSError, ValueError):
            return None

    return read


#: Comments and strings; what stands between the apostrophes of a comment is no string.
_STRING = re.compile(rb"/\*.*?\*/|'(?:[^']|'')*'", re.DOTALL)
_FOREIGN = re.compile("[^\0-\x7f]+")
_SOLID = re.compile(rb"(#\d+)\s*=\s*(?:MANIFOLD_SOLID_BREP|BREP_WITH_VOIDS|FACETED_BREP|SHELL_BASED_SURFACE_MODEL)\s*\(")
_REPRESENTATION = re.compile(rb"(#\d+)\s*=\s*[A-Z_]*SHAPE_REPRESENTATION\s*\(\s*'[^']*'\s*,\s*\(([^)]*)\)")
_UNIT = re.compile(rb"(#\d+)\s*=\s*\(([^;]*\bLENGTH_UNIT\s*\(\s*\)[^;]*)\)\s*;")
_NUMBER = re.compile(rb"#(\d+)\s*=")
#: A product, its definition, and the representation that it is joined to.
_PRODUCT = """#{0}=APPLICATION_CONTEXT('');
#{1}=PRODUCT_CONTEXT('',#{0},'mechanical');
#{2}=PRODUCT('','','',(#{1}));
#{3}=PRODUCT_DEFINITION_FORMATION('','',#{2});
#{4}=PRODUCT_DEFINITION_CONTEXT('part definition',#{0},'design');
#{5}=PRODUCT_DEFINITION('','',#{3},#{4});
#{6}=PRODUCT_DEFINITION_SHAPE('','',#{5});
#{7}=SHAPE_DEFINITION_REPRESENTATION(#{6},{representation});
"""
_OWN = """#{0}=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));
#{1}=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNIT_ASSIGNED_CONTEXT(({unit}))REPRESENTATION_CONTEXT('',''));
#{2}=SHAPE_REPRESENTATION('',({solids}),#{1});
"""


class Adopted(NamedTuple):
    """A file whose solids got a product: its text, the solids, and what is known of their unit; empty where it is stated."""

    data: bytes
    solids: list[str]
    unit: str


def readable(data: bytes) -> tuple[bytes, str]:
    r"""A file with the names in it as the kernel can read them, and what the encoding that they were in is called.

    The second is empty, and the first as it was, where names are ASCII or UTF-8.

    Examples
    --------
    >>> readable("#1=PRODUCT('齿轮');".encode("gb18030"))
    (b"#1=PRODUCT('\\X2\\9F7F8F6E\\X0\\');", 'GB18030')
    >>> readable(b"#1=PRODUCT('rim');")
    (b"#1=PRODUCT('rim');", '')
    """
    if data.isascii() or is_plain(data):
        return data, ""
    names = {text for text in _STRING.findall(data) if text.startswith(b"'") and not text.isascii()}
    encoding = encoding_of(sorted(names))
    escaped = {name: _FOREIGN.sub(lambda match: _escaped(match[0]), decoded(name, encoding)).encode() for name in names}
    return _STRING.sub(lambda match: escaped.get(match[0], match[0]), data), CALLED.get(encoding, "")


def _escaped(text: str) -> str:
    """Letters as STEP writes those that are not ASCII."""
    if max(text) <= "\uffff":
        return f"\\X2\\{''.join(f'{ord(letter):04X}' for letter in text)}\\X0\\"
    return f"\\X4\\{''.join(f'{ord(letter):08X}' for letter in text)}\\X0\\"


def adopted(data: bytes) -> Adopted | None:
    """A file none of whose shapes belongs to a product, with a product for its solids; None where that is not needed, or not so.

    Solids in a representation keep its unit. For others the only length unit of the file is taken, or else mm.
    """
    if b"SHAPE_DEFINITION_REPRESENTATION" in data or not (solids := _SOLID.findall(data)):
        return None
    number = 1 + max(int(each) for each in _NUMBER.findall(data))
    within = {rep: {item.strip() for item in items.split(b",")} for rep, items in _REPRESENTATION.findall(data)}
    representations = [rep.decode() for rep, items in within.items() if items & set(solids)]
    lone = [each.decode() for each in solids if not any(each in items for items in within.values())]
    text, unit = "", ""
    if lone:
        named = [(each.decode(), b"CONVERSION_BASED_UNIT" in words) for each, words in _UNIT.findall(data)]
        known = [each for each, converted in named if converted] or [each for each, _ in named]
        only = len(known) == 1
        unit = f"no unit is stated for {lone[0]}" + (f", {known[0]} is the only one" if only else "")
        text += _OWN.format(*range(number, number + 3), unit=known[0] if only else f"#{number}", solids=",".join(lone))
        representations.append(f"#{number + 2}")
        number += 3
    for representation in representations:
        text += _PRODUCT.format(*range(number, number + 8), representation=representation)
        number += 8
    end = data.rindex(b"ENDSEC") if b"ENDSEC" in data else len(data)
    return Adopted(data[:end] + text.encode() + data[end:], [each.decode() for each in solids], unit)
