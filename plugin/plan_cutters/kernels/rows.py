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
    """Which postures there are."""

    rotation_cos: Any  #: (k,): of the rotations.
    rotation_sin: Any
    tilt_low: float  #: rad.
    tilt_high: float
    setup: Any  #: (3,): the unit axis about which the tool axis is limited.
    limit_cos: float  #: Cosine of that limit, -2 for none.
    rotary: Any
    strict: bool = False  #: Only those that curvature at the contact allows, as if there were no tolerance.


class Tool(NamedTuple):
    """A tool, each piece made smaller or larger by what does not matter, or does: as in `domain.assembly`; lengths in mm."""

    piece: Any  #: (m, k, COLUMNS): of each of the m ways in which it touches.
    mode: Any  #: (m, 5)
    reach: float  #: The distance from the contact within which an obstacle of the flutes counts as rear gouging.
    #: `inner`, `end`: heights over the tip of two points of its axis.
    inner: float
    end: float


class Cylinder(NamedTuple):
    """A flat end that was made smaller by a depth all round, mm."""

    radius: float  #: Its own.
    shrunk: float  #: The one left.
    #: `low`, `high`: between which heights it is solid.
    low: float
    high: float


#: Contact p, normal n, tilt direction f, and t = n x f; each (3,).
Frame = namedtuple("Frame", "p n f t")

#: A workspace: stack and masks (64,) int64, corner (3, 3), face (4, 3), polygon and spare (8, 3), pieces (k, 3, 3). looked (1,)
#: int64: boxes looked at since it was made, and what else takes as long. balls (k, 5), stored (2,) int64: balls in bodies, see
#: `material.keep_ball`; of which solids, and how many were stored.
Scratch = namedtuple("Scratch", "stack masks corner face polygon spare pieces looked balls stored")

#: A search writes these arrays (n): verdict, axis, tilt_direction, tilt, rotation, reason; see `domain.verdicts.Verdicts`.
VerdictArrays = namedtuple("VerdictArrays", "verdict axis tilt_direction tilt rotation reason")
