"""Archives of arrays (`.npz`) that others wrote: what each array is said to be is looked at before any of it is unpacked."""

import ast
import os
import zipfile
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io import files
from plan_cutters.errors import PlanError

#: Members that are looked at, and bytes of an array's header.
_MEMBERS, _HEADER = 10_000, 4096
#: Deflated bytes never unpack to more than so many each.
_RATIO = 1040
#: Most bytes of memory that an archive may fill where the system does not tell how much there is.
_UNPACKED = 8 << 30
_WAYS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
_FAULTS = (zipfile.BadZipFile, zlib.error, OSError, EOFError, ValueError, RuntimeError, NotImplementedError, LookupError,
           TypeError, SyntaxError, MemoryError, RecursionError, OverflowError)  # fmt: skip


@dataclass(frozen=True, slots=True)
class Header:
    """The header of an array states its type (`<f8`), its shape, and how many bytes stand before its numbers."""

    dtype: str
    shape: tuple[int, ...]
    start: int

    @property
    def bytes(self) -> int:
        """Bytes of its numbers."""
        count = np.dtype(self.dtype).itemsize
        for each in self.shape:
            count *= each
        return count


class Archive:
    """An open archive of arrays.

    Parameters
    ----------
    path : path
    noun : str
        What it should be, for errors.
    error : type of PlanError
        Raised where it is none.

    Attributes
    ----------
    headers : dict
        Array name -> Header: of booleans, integers, floats and texts; nothing else is read.
    """

    def __init__(self, path: str | os.PathLike[str], noun: str, error: type[PlanError]) -> None:
        self.name, self.noun, self.error = Path(path).name, noun, error
        try:
            self._file = files.open_regular(files.permitted(path))
        except files.IrregularError as fault:
            raise error(str(fault), file=self.name) from None
        except OSError as fault:
            raise error(f"cannot be read: {fault.strerror or fault}", file=self.name) from None
        except ValueError as fault:
            raise error(f"is no name of a file: {fault}", file=ascii(self.name)) from None
        try:
            self._archive = self._opened()
            self.headers = self._headers()
        except BaseException:
            self._file.close()
            raise

    def __enter__(self) -> "Archive":
        return self

    def __exit__(self, *_: object) -> None:
        self._archive.close()
        self._file.close()

    def fault(self, why: str) -> PlanError:
        """The error of this file."""
        return self.error(f"holds no {self.noun}, or is damaged ({why}): write it again", file=self.name)

    def read(self, name: str) -> NDArray[Any]:
        """One array, as its header says."""
        header = self.headers[name]
        try:
            array = np.empty(header.shape, header.dtype)
            view: Any = array.reshape(-1).view(np.uint8) if header.bytes else b""
            with self._archive.open(f"{name}.npy") as packed:
                packed.read(header.start)
                place = 0
                while place < len(view):
                    piece = packed.read(min(1 << 20, len(view) - place))
                    if not piece:
                        raise EOFError
                    view[place : place + len(piece)] = np.frombuffer(piece, np.uint8)
                    place += len(piece)
                # To the end of it, so that its checksum is looked at.
                if packed.read(1):
                    raise EOFError
        except MemoryError:
            raise self.error(f"its array {name} does not fit into memory", file=self.name) from None
        except _FAULTS as fault:
            raise self.fault(f"array {name} cannot be unpacked{_cause(fault)}") from None
        return array

    def _opened(self) -> zipfile.ZipFile:
        try:
            return zipfile.ZipFile(self._file)
        except _FAULTS as fault:
            raise self.fault(f"no archive of arrays{_cause(fault)}") from None

    def _headers(self) -> dict[str, Header]:
        members = self._archive.infolist()
        if len(members) > _MEMBERS:
            raise self.fault(f"{len(members)} arrays")
        headers: dict[str, Header] = {}
        total = 0
        for each in members:
            name, dot, kind = each.filename.rpartition(".")
            shown = ascii(each.filename)[:60]
            if not dot or kind != "npy" or not name:
                raise self.fault(f"{shown} is no array")
            if name in headers:
                raise self.fault(f"array {ascii(name)[:60]} is there twice")
            if each.flag_bits & 1 or each.compress_type not in _WAYS:
                raise self.fault(f"{shown} is encrypted, or packed in an unknown way")
            headers[name] = self._header(each, shown)
            if each.file_size != headers[name].start + headers[name].bytes:
                raise self.fault(f"{shown} is not as long as its shape says")
            if each.file_size > _RATIO * (each.compress_size + 1):
                raise self.fault(f"{shown} cannot unpack to the {each.file_size} bytes that its header states")
            total += each.file_size
        if total > _most():
            raise self.error(
                f"unpacks to {total / 1e9:.0f} GB, more than half of the memory here; sample more coarsely (--spacing)",
                file=self.name,
            )
        return headers

    def _header(self, member: zipfile.ZipInfo, shown: str) -> Header:
        """Read what `numpy.lib.format` describes, without its readers: they make what the header says."""
        try:
            with self._archive.open(member) as packed:
                start = packed.read(10)
                if start[:6] != b"\x93NUMPY" or start[6:8] not in (b"\x01\x00", b"\x02\x00", b"\x03\x00"):
                    raise ValueError
                width = 2 if start[6] == 1 else 4
                size = start[8:] + packed.read(width - 2)
                length = int.from_bytes(size[:width], "little")
                if len(size) != width or length > _HEADER:
                    raise ValueError
                text = packed.read(length)
            fields = ast.literal_eval(text.decode("latin-1").strip())
            dtype, order, shape = fields["descr"], fields["fortran_order"], fields["shape"]
            if len(fields) != 3 or len(text) != length or not isinstance(dtype, str) or order is not False:
                raise ValueError
            if not isinstance(shape, tuple) or len(shape) > 4:
                raise ValueError
            if not all(type(each) is int and 0 <= each < 1 << 40 for each in shape):
                raise ValueError
            if np.dtype(dtype).kind not in "biufU":
                raise ValueError
        except _FAULTS:
            raise self.fault(f"{shown} is no array of numbers or texts") from None
        return Header(np.dtype(dtype).str, shape, 8 + width + length)


def _most() -> int:
    """Bytes that an archive may unpack to."""
    try:
        return int(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")) // 2
    except (AttributeError, ValueError, OSError):
        return _UNPACKED


def _cause(fault: BaseException) -> str:
    """Shorten the message of a fault to one line."""
    text = " ".join(str(fault).split())[:80]
    return f": {ascii(text)[1:-1]}" if text else ""
