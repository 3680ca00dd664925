"""Files as bytes and text: what is too large, packed too tightly or none is one line."""

import codecs
import io
import json
import lzma
import os
import re
import zipfile
import zlib
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, ClassVar, Self

from plan_cutters.errors import PlanError
from plan_cutters.files.xml_tree import Element, parse
from plan_cutters_base import user_files as files
from plan_cutters_base.user_files import IrregularError, open_regular


def regular_bytes(path: str | os.PathLike[str], most: int) -> bytes | None:
    """Read all bytes of a regular file, or of a link to one; the result is None where there is no such file.

    Parameters
    ----------
    path : path
        Where it should be.
    most : int
        Bytes that it may have.

    Raises
    ------
    PlanError
        It is no regular file, is larger, or cannot be read.

    Examples
    --------
    >>> regular_bytes("not/there", most=10) is None
    True
    """
    name = Path(path).name
    try:
        with open_regular(path) as opened:
            large = os.fstat(opened.fileno()).st_size > most
            data = b"" if large else opened.read(most + 1)
    except (FileNotFoundError, NotADirectoryError):
        return None
    except IrregularError as fault:
        raise PlanError(str(fault), file=name) from None
    except OSError as fault:
        raise PlanError(f"cannot be read: {fault.strerror or fault}", file=name) from None
    except ValueError as fault:
        raise PlanError(f"is no name of a file: {fault}", file=ascii(name)) from None
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


def data_of(path: str | os.PathLike[str], noun: str, error: type[PlanError]) -> bytes:
    """All bytes of a regular file; `error` names it as no `noun` where it cannot be one."""
    name = Path(path).name
    try:
        data = files.content(path, _FILE + 1)
    except files.IrregularError as fault:
        what = f"{noun} in it" if os.path.isdir(path) else "file"
        raise error(f"{fault}; give a {what}", file=name) from None
    except OSError as fault:
        raise error(f"cannot be read: {fault.strerror or fault}", file=name) from None
    except ValueError as fault:
        raise error(f"is no name of a file: {fault}", file=ascii(name)) from None
    if len(data) > _FILE:
        raise error(f"is larger than {_FILE >> 20} MB: no {noun} is; split it", file=name)
    return data


@dataclass(frozen=True)
class Content:
    """A file that is being recognised: its bytes, its text, its JSON, its XML, what a zip archive it is holds.

    What it should be, and the error where it is not, are said by a class of each kind.
    """

    noun: ClassVar[str] = "file"
    error: ClassVar[type[PlanError]] = PlanError

    path: Path
    data: bytes
    notes: list[str] = field(default_factory=list)

    @classmethod
    def of(cls, path: str | os.PathLike[str]) -> Self:
        """Read the content of a regular file."""
        return cls(Path(path), data_of(path, cls.noun, cls.error))

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
    decode = json.JSONDecoder()
    blank = re.compile(r"[ \t\n\r,]*")
    at = re.compile(r"\s*\{").match(text)
    place, lines = at.end() if at else len(text), []
    line, seen = 1, 0
    try:
        while place < len(text):
            place = blank.match(text, place).end()  # type: ignore[union-attr]
            name, place = decode.raw_decode(text, place)
            place = re.compile(r"\s*:\s*").match(text, place).end()  # type: ignore[union-attr]
            if name != key:
                _, place = decode.raw_decode(text, place)
                continue
            place = blank.match(text, place + 1).end()  # type: ignore[union-attr]
            while text[place] != "]":
                line, seen = line + text.count("\n", seen, place), place
                lines.append(line)
                _, place = decode.raw_decode(text, place)
                place = blank.match(text, place).end()  # type: ignore[union-attr]
            return lines
    except (ValueError, AttributeError, IndexError, RecursionError):
        pass
    return []
