"""What type checkers see of the names that `__init__.py` hands on lazily."""

from cad_io.arrays import FaceGrid, FaceInfo, FaceLabels, LostFace, Orientation, Style, SurfaceSamples, Triangles
from cad_io.errors import CadIoError, ReadError, WriteError
from cad_io.part.part import Part
from cad_io.read.read import read_part

__all__ = [
    "CadIoError",
    "FaceGrid",
    "FaceInfo",
    "FaceLabels",
    "LostFace",
    "Orientation",
    "Part",
    "ReadError",
    "Style",
    "SurfaceSamples",
    "Triangles",
    "WriteError",
    "read_part",
]
