"""How far faces go on from samples, along a pass and across it: a strip is no wider than what there is, a pass no longer."""

import math

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, SurfaceSamples, cross
from plan_cutters.scene.obstacles import Obstacles

Rows = NDArray[np.int64]
#: Directions in which a face is measured at a sample, over half a turn from that of the larger curvature.
DIRECTIONS = 12
#: Samples of a face at which it is measured, at most about, and of one of many triangles, by how many these are together; others
#: take what the nearest one has.
_OF_A_FACE, _AT_LEAST, _TOGETHER = 100, 16, 60_000


class Extents:
    """Lengths of faces through samples, measured when they are requested first.

    Parameters
    ----------
    samples : SurfaceSamples
        n of them.
    obstacles : Obstacles
        With the triangles of the part.

    Notes
    -----
    What was measured belongs to this object alone, and is read and written by one thread.
    """

    def __init__(self, samples: SurfaceSamples, obstacles: Obstacles) -> None:
        self._samples, self._obstacles = samples, obstacles
        self._length = np.full((2, len(samples), DIRECTIONS), np.nan)
        self._measured = np.zeros(len(samples), bool)

    def along(self, rows: Rows, direction: Floats) -> tuple[Floats, Floats]:
        """Lengths (m,), mm, of the faces of samples along directions (m, 3) in them: what goes on from each, and all of it.

        Of the directions that are measured the nearest is taken: an extent may be longer by 1 %. nan: it is not known.
        """
        self._measure(rows)
        first, second = self._frame(rows)
        turn = np.arctan2((direction * second).sum(axis=1), (direction * first).sum(axis=1))
        which = np.rint(np.nan_to_num(turn) * (DIRECTIONS / math.pi)).astype(np.int64) % DIRECTIONS
        connected, whole = self._length[:, rows, which]
        return connected, whole

    def longest(self, rows: Rows) -> Floats:
        """The unit directions (m, 3) in which the faces of samples go on farthest, among those that are measured."""
        self._measure(rows)
        first, second = self._frame(rows)
        turn = np.nan_to_num(self._length[0, rows]).argmax(axis=1)[:, None] * (math.pi / DIRECTIONS)
        return np.asarray(np.cos(turn) * first + np.sin(turn) * second)

    def _frame(self, rows: Rows) -> tuple[Floats, Floats]:
        first = self._samples.direction_max[rows]
        return first, cross(self._samples.normal[rows], first)

    def _measure(self, rows: Rows) -> None:
        face = self._samples.face
        for number in np.unique(face[rows[~self._measured[rows]]]).tolist():
            self._measure_face(number, np.flatnonzero(face == number))

    def _measure_face(self, number: int, every: Rows) -> None:
        from scipy.spatial import cKDTree

        from plan_cutters.kernels.linear.sections import sections

        samples, triangles = self._samples, self._obstacles.triangles
        self._measured[every] = True
        known = every[np.isfinite(samples.direction_max[every]).all(axis=1) & np.isfinite(samples.normal[every]).all(axis=1)]
        vertex = np.ascontiguousarray(triangles.vertex[triangles.face == number])
        if not len(known) or not len(vertex):
            return
        most = min(_OF_A_FACE, max(_AT_LEAST, _TOGETHER // len(vertex)))
        some = known[:: 1 + len(known) // most]
        first, second = self._frame(some)
        point, normal = np.ascontiguousarray(samples.point[some]), np.ascontiguousarray(samples.normal[some])
        near = 2.0 * triangles.chord_error + 1e-6
        nearest = cKDTree(point).query(samples.point[known])[1]
        for k in range(DIRECTIONS):
            turn = k * math.pi / DIRECTIONS
            along = np.ascontiguousarray(math.cos(turn) * first + math.sin(turn) * second)
            connected, whole = np.empty((2, len(some)))
            sections(point, along, normal, vertex, near, near, connected, whole)
            self._length[0, known, k], self._length[1, known, k] = connected[nearest], whole[nearest]
        # A sample has its area there: what the triangles about a border say is no less than that allows.
        longest = np.nan_to_num(self._length[0, known]).max(axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            least = np.nan_to_num(samples.area[known] / longest, posinf=0.0)
        self._length[:, known] = np.maximum(self._length[:, known], least[:, None])
