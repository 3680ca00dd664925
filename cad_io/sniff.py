"""What kind of file is this? Told from its content, since names lie."""

import re
from pathlib import Path

from cad_io.errors import ReadError

_STEP = re.compile(rb"\s*(/\*.*?\*/\s*)*ISO-10303-21\s*;", re.DOTALL)
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


def sniff(data: bytes, file: str) -> str:
    """Kind of a CAD file: `step`, `iges`, `brep` or `binary brep`.

    Parameters
    ----------
    data : bytes
        The whole content.
    file : str
        Named in errors.

    Raises
    ------
    ReadError
        Empty, or not a CAD file that can be read.
    """
    if not data.strip():
        raise ReadError("is empty", file=file)
    start = data[:4096]
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
