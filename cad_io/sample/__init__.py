"""Samples of faces on grids, linked across joints, or at one place.

May use: triangles in the parameter plane, parts, and what is below them.
"""

from cad_io.sample.at_point import foot_on, locate, nearest
from cad_io.sample.on_grids import bends, sample

__all__ = ["bends", "foot_on", "locate", "nearest", "sample"]
