"""Tell the kind of a file from its content, since names can be wrong; files other than CAD files are not read to the end."""

import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from cad_io.errors import ReadError
from plan_cutters_base import user_files as files

#: Bytes that must tell the kind.
_HEAD = 4096
# Possessive, or a file of nothing but comments would be tried in every way to part them.
_STEP = re.compile(rb"(?>\s|/\*.*?\*/)*+ISO-10303-21\s*;", re.DOTALL)
_IGES = re.compile(rb"[^\r\n]{72}[SBC]\s*\d+\s*[\r\n]")
_BREP = re.compile(rb"\s*(DBRep_DrawableShape|CASCADE Topology)")
_BINARY_BREP = re.compile(rb"\s*Open CASCADE Topology V")

#: Starts of files that people give by mistake, and what to tell them.
_OTHERS = (
    (b"\x1f\x8b", "is compressed (gzip): unpack it first"),
    (b"PK\x03\x04", "is a zip archive: unpack it first"),
    (b"\xd0\xcf\x11\xe0", "is a native CAD or Office file: export it as STEP"),
    (b"version https://git-lfs", "is a Git LFS pointer, not the file: fetch it with `git lfs pull`"),
    (b"solid ", "is a mesh (STL): surfaces need STEP or IGES"),
    (b"glTF", "is a mesh (GLB): surfaces need STEP or IGES"),
    (b"ply", "is a mesh (PLY): surfaces need STEP or IGES"),
)


def load(file: str) -> tuple[str, bytes]:
    """Kind, as `sniff` tells it, and content of a CAD file; ReadError where there is no such file, or it is not one that can be
    read.
    """
    with _opened(file) as stream:
        data = stream.read(_HEAD)
        kind = sniff(data, file)
        data += stream.read()
    files.note(file, data)
    return kind, data


def kind(file: str) -> str:
    """Kind of a CAD file by its start alone, as `sniff` tells it; errors as of `load`."""
    with _opened(file) as stream:
        return sniff(stream.read(_HEAD), file)


@contextmanager
def _opened(file: str) -> Iterator[BinaryIO]:
    """A file, open; errors as of `reported`."""
    try:
        os.fspath(file).encode()
    except UnicodeEncodeError:
        raise ReadError("its name is no text in UTF-8, which the CAD kernel asks for: rename it", file=file) from None
    # The kernel opens it once more, and a pipe or a device has no end.
    with reported(file), files.open_regular(files.permitted(file)) as stream:
        yield stream


@contextmanager
def reported(file: str) -> Iterator[None]:
    """Turn what goes wrong as a user's file is read into a ReadError."""
    try:
        yield
    except files.IrregularError:
        folder = os.path.isdir(file)
        what = "is a folder, not a file" if folder else "is a pipe or a device, not a file: save its content in a file"
        raise ReadError(what, file=file) from None
    except FileNotFoundError:
        raise ReadError("no such file", file=file) from None
    except MemoryError:
        raise ReadError("is too large for the memory allowed: give more, or check that it is the one", file=file) from None
    except (OSError, ValueError) as error:
        raise ReadError(f"cannot be read: {getattr(error, 'strerror', None) or error}", file=file) from error


def sniff(data: bytes, file: str) -> str:
    """Kind of a CAD file, by its content or at least the first 4096 bytes: `step`, `iges`, `brep` or `binary brep`.

    Raises ReadError, which names the file, where it is empty, or not a CAD file that can be read.
    """
    start = data[:_HEAD]
    if not start.strip():
        raise ReadError("is empty" if len(data) < _HEAD else "starts with nothing but blanks", file=file)
    for kind, pattern in (("step", _STEP), ("iges", _IGES), ("brep", _BREP), ("binary brep", _BINARY_BREP)):
        if pattern.match(start):
            return kind
    if start.startswith(b"\xef\xbb\xbf") and _STEP.match(start[3:]):
        raise ReadError("starts with a byte-order mark, which STEP does not allow: save it without", file=file)
    if re.match(rb"\s*(<!doctype html|<html|<\?xml)", start, re.IGNORECASE):
        raise ReadError("is a web page or XML, not a CAD file: download the file itself", file=file)
    for magic, cause in _OTHERS:
        if start.startswith(magic):
            raise ReadError(cause, file=file)
    suffix = Path(file).suffix.lower()
    named = {".stp": "STEP", ".step": "STEP", ".igs": "IGES", ".iges": "IGES", ".brep": "BREP"}.get(suffix)
    wrong = f"is named {suffix} but does not start as {named} does" if named else "is not a CAD file that can be read"
    raise ReadError(f"{wrong}: give STEP, IGES or BREP", file=file)
