"""Archives of arrays (`.npz`) that others wrote: what each array is said to be is looked at before any of it is unpacked."""

import math
import os
import warnings
import zipfile
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

from plan_cutters.errors import PlanError
from plan_cutters.files.content import translated
from plan_cutters_base import user_files as files

#: Members that are looked at, and bytes of an array's header.
_MEMBERS, _HEADER = 10_000, 4096
#: Packed bytes never unpack to more than so many each: of deflate, and of LZMA, which packs what repeats itself harder.
_RATIO = {zipfile.ZIP_STORED: 1, zipfile.ZIP_DEFLATED: 1040, zipfile.ZIP_LZMA: 8000}
#: Most bytes of memory that an archive may fill where the system does not tell how much there is.
_UNPACKED = 8 << 30
_WAYS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED, zipfile.ZIP_LZMA)
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
        return np.dtype(self.dtype).itemsize * math.prod(self.shape)


class Archive:
    """An open archive of arrays.

    `noun`: what it should be, for errors. `error`: raised where it is none.

    `headers`: array name -> Header: of booleans, integers, floats and texts; nothing else is read.
    """

    def __init__(self, path: str | os.PathLike[str], noun: str, error: type[PlanError]) -> None:
        self.name, self.noun, self.error = Path(path).name, noun, error
        with translated(self.name, error):
            self._file = files.open_regular(files.permitted(path))
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
        try:
            with self._archive.open(f"{name}.npy") as packed:
                array: NDArray[Any] = npy.read_array(packed, allow_pickle=False, max_header_size=_HEADER)
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
            if each.file_size > _RATIO[each.compress_type] * (each.compress_size + 1):
                raise self.fault(f"{shown} cannot unpack to the {each.file_size} bytes that its header states")
            total += each.file_size
        if total > _most():
            raise self.error(
                f"unpacks to {total / 1e9:.0f} GB, more than half of the memory here; sample more coarsely (--spacing)",
                file=self.name,
            )
        return headers

    def _header(self, member: zipfile.ZipInfo, shown: str) -> Header:
        """Read a header of version 1, as NumPy writes them for numbers and texts: the others may be gigabytes long."""
        try:
            # One that NumPy reads only after it has mended it is none, whatever else its parser raises.
            with self._archive.open(member) as packed, warnings.catch_warnings(action="error"):
                if npy.read_magic(packed) != (1, 0):
                    raise ValueError
                shape, by_columns, dtype = npy.read_array_header_1_0(packed, _HEADER)
                start = packed.tell()
            if by_columns or len(shape) > 4 or not all(type(each) is int and 0 <= each < 1 << 40 for each in shape):
                raise ValueError
            if dtype.kind not in "biufU":
                raise ValueError
        except Exception:
            raise self.fault(f"{shown} is no array of numbers or texts") from None
        return Header(dtype.str, shape, start)


def _most() -> int:
    try:
        return int(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")) // 2
    except (AttributeError, ValueError, OSError):
        return _UNPACKED


def _cause(fault: BaseException) -> str:
    text = " ".join(str(fault).split())[:80]
    return f": {ascii(text)[1:-1]}" if text else ""
