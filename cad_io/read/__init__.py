"""A file or an object becomes a Part, or an error of one line.

May use: parts, and what is below them.
"""

from cad_io.read.read import read_part

__all__ = ["read_part"]
