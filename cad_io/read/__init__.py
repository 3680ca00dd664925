"""A file or an object becomes a Part, or an error of one line.

May use: parts, and what is below them. `read_part` is handed on lazily: `sniff` tells the kind of a file without
the CAD kernel.
"""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from cad_io.read.read import read_part

__all__ = ["read_part"]


def __getattr__(name: str) -> Any:
    if name != "read_part":
        raise AttributeError(f"module 'cad_io.read' has no attribute {name!r}")
    from cad_io.read.read import read_part

    return read_part
