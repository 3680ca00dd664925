"""The CAD boundary: files and kernel shapes in, arrays out; labelled faces in, annotated files out.

No machining words here. This package alone imports the CAD kernel (OCP); names are handed on lazily so that
importing `cad_io` costs nothing until a name is used. Each room hands on its one function, as
`from cad_io.sample import sample`.
"""

from importlib import import_module
from typing import Any

_MODULES = {
    "arrays": ("FaceGrid", "FaceInfo", "FaceLabels", "LostFace", "Orientation", "Style", "SurfaceSamples", "Triangles"),
    "errors": ("CadIoError", "ReadError", "WriteError"),
    "part": ("Part",),
    "read": ("read_part",),
}
_HOME = {name: module for module, names in _MODULES.items() for name in names}
__all__ = sorted(_HOME)


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'cad_io' has no attribute {name!r}")
    return getattr(import_module(f"cad_io.{_HOME[name]}"), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
