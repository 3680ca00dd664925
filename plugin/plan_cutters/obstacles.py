"""Obstacles: triangles in tree order, and how deep one may reach into a cutter."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from cad_io.arrays import Floats, Ints, Triangles


@dataclass(frozen=True)
class Obstacles:
    """Triangles with their bounding tree.

    Attributes
    ----------
    triangles : Triangles
        As tessellated.
    """

    triangles: Triangles

    @cached_property
    def _built(self) -> tuple[Ints, Floats, int]:
        from plan_cutters.kernels.tree import build

        order, box, depth = build(np.ascontiguousarray(self.triangles.vertex))
        return order, box, int(depth)

    @cached_property
    def tree(self) -> tuple[Floats, Floats, int]:
        """(vertex (n, 3, 3) in tree order, box (nodes, 16), depth), as the kernels take it."""
        order, box, depth = self._built
        return np.ascontiguousarray(self.triangles.vertex[order]), box, depth

    @cached_property
    def wide_tree(self) -> tuple[Floats, Floats, Ints, int]:
        """(vertex in tree order, blocks, offset, bottom): the tree as posture maps take it, eight boxes at a time."""
        from plan_cutters.kernels.lanes import wide_tree

        blocks, offset, bottom = wide_tree(*self.tree)
        return self.tree[0], blocks, offset, int(bottom)

    @cached_property
    def faces(self) -> Ints:
        """Face numbers (n,) in tree order."""
        return np.ascontiguousarray(self.triangles.face[self._built[0]])

    def face(self, triangle: int) -> int:
        """Face number of a triangle in tree order."""
        return int(self.faces[triangle])

    def depths(self, tolerance: float) -> tuple[float, float]:
        """Depths `(safe, blocked)`, mm, that decide for the true surface.

        Every surface point has a triangle point within the chord error and the reverse. So if no triangle reaches
        deeper than `safe`, no surface point is deeper than the tolerance; a triangle point deeper than `blocked`
        proves one.
        """
        error = self.triangles.chord_error
        return tolerance - error, tolerance + error
