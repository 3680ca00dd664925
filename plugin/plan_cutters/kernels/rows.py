"""This module defines the records that kernels take, as named tuples: the compiler handles these like single values."""

from collections import namedtuple
from typing import Any, NamedTuple

import numpy as np

from cad_io.arrays import Floats


class Tree(NamedTuple):
    """Triangles in tree order, vertex (n, 3, 3), and the tree, box (nodes, 16) and depth, as `tree.build` gives it.

    What is added to them, such as fixtures to a part, has a second tree of the same form; its triangles are counted on from n. So
    many can share the first one.
    """

    vertex: Any
    box: Any
    depth: int
    more_vertex: Any = np.zeros((0, 3, 3))
    more_box: Any = np.zeros((0, 16))
    more_depth: int = 0

    def corners(self, triangle: int) -> Floats:
        """Corners (3, 3) of a triangle by its number in tree order."""
        first = len(self.vertex)
        return np.asarray(self.vertex[triangle] if triangle < first else self.more_vertex[triangle - first])


#: point, normal, direction_max (n, 3): where a cutter may touch, the normal out of the material, and the direction of the larger
#: curvature; curvature (n, 2): kappa_max, kappa_min, 1/mm, concave positive.
Contacts = namedtuple("Contacts", "point normal direction_max curvature")

#: Rotary axes of a machine, in the part's frame: circle (m, 4), direction (k, 3), limit (k, 2) and tool (3,), as in
#: `domain.kinematics.Kinematics`; `tool` is zero where there is no machine. swing: how the second axis moves the tool towards the
#: first, the angle at which it is nearest, the amplitude and the middle of the cosine between the two. aim (a, 3): tool axes
#: towards which each sample's rotations tilt, in place of those requested, where fewer than two axes turn the tool.
Rotary = namedtuple("Rotary", "circle direction limit tool swing aim")


class Ranges(NamedTuple):
    """Which postures there are: cosines and sines (k,) of the rotations, tilts from and to, rad, and the axis limits: the
    cosine `limit_cos` about the unit axis `setup` (3,), -2 for none, and rotary axes. strict: only those that curvature at the
    contact allows, as if there were no tolerance."""

    rotation_cos: Any
    rotation_sin: Any
    tilt_low: float
    tilt_high: float
    setup: Any
    limit_cos: float
    rotary: Any
    strict: bool = False


class Tool(NamedTuple):
    """A tool, each piece made smaller or larger by what does not matter, or does: as in `domain.assembly`.

    piece (m, k, COLUMNS) and mode (m, 5) of each of the m ways in which it touches; `reach`, the distance from the contact within
    which an obstacle of the flutes counts as rear gouging; `inner` and `end`, heights over the tip of two points of its axis; mm.
    """

    piece: Any
    mode: Any
    reach: float
    inner: float
    end: float


class Cylinder(NamedTuple):
    """A flat end that was made smaller by a depth all round: its own radius, the one left, and the heights between which it is
    solid, mm; and the same as a row of pieces (1, COLUMNS)."""

    radius: float
    shrunk: float
    low: float
    high: float
    piece: Any


#: Contact p, normal n, tilt direction f, and t = n x f; each (3,).
Frame = namedtuple("Frame", "p n f t")

#: A workspace: stack and masks (64,) int64, corner (3, 3), drawn (4, 3), polygon and spare (8, 3), pieces (k, 3, 3). looked (1,)
#: int64: boxes looked at since it was made, and what else takes as long. balls (k, 5), stored (2,) int64: balls in bodies, see
#: `material.keep_ball`; of which solids, and how many were stored.
Scratch = namedtuple("Scratch", "stack masks corner drawn polygon spare pieces looked balls stored")

#: A search writes these arrays (n): verdict, axis, tilt_direction, tilt, rotation, reason; see `domain.verdicts.Verdicts`.
VerdictArrays = namedtuple("VerdictArrays", "verdict axis tilt_direction tilt rotation reason")
