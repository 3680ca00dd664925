"""Samples of faces on grids, linked across joints, or at one place.

May use: triangles in the parameter plane, parts, and what is below them.
"""

from cad_io.sample.at_point import locate, nearest
from cad_io.sample.on_grids import sample

__all__ = ["locate", "nearest", "sample"]
