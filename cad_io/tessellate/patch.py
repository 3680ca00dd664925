"""One face on its way to triangles: where they begin, what bounds their distance from the surface, and those that are laid."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from cad_io.part import Part
from cad_io.surface import Surface
from cad_io.tessellate.bounds import COARSE, FINE, MIDDLE, Ground, Table, table_of
from cad_io.tessellate.curves import Curves, packed, reach
from cad_io.tessellate.mesh import UVMesh
from cad_io.tessellate.refine import RefinedMesh, Start, refined

#: Measured distances count this much larger, for what lies between the points measured.
MARGIN = 1.05
#: Where triangles are measured that must be: shares of their corners.
_MEASURED = np.array([(a, b, 4 - a - b) for a in range(5) for b in range(5 - a) if max(a, b, 4 - a - b) < 4]) / 4
#: Triangles measured at once.
_AT_ONCE = 1 << 16
#: How often a guess that does not hold is made again, and how much larger than measured.
_GUESSES, _LARGER = 6, 1.02

#: Triangles from which a table of so many cells takes less time than the triangles that it saves.
_FINER = ((400, MIDDLE), (8000, FINE))

Indices = NDArray[np.int64]


def workspace(triangles: int) -> RefinedMesh:
    """Room for so many triangles of a face, and as many nodes."""
    return RefinedMesh(np.empty((triangles, 2)), np.empty((triangles, 3), np.int64))


EMPTY = workspace(0)


class Laid(NamedTuple):
    """Finished triangles of a face: nodes (n, 3) in mm, corners (t, 3), the bound of their distance from it, mm, their area in
    the parameter plane, and whether they are all that it takes."""

    point: Floats
    corner: Indices
    off: float
    area: float
    whole: bool = True


class Patch(NamedTuple):
    """A face before its triangles are cut.

    proved: whether the bound of the table and the curves holds everywhere; else it is a guess, and distances are measured.
    """

    number: int
    surface: Surface
    start: Start
    ground: Ground
    table: Table
    curves: Curves
    proved: bool

    @staticmethod
    def of(part: Part, number: int, mesh: UVMesh, chord: float = np.inf) -> "Patch":
        """The patch of a face that begins with a mesh; for a chord error, mm, its bounds need not be much closer than that."""
        surface = part.surface(number)
        curves, exact = packed(
            [b.curve for b in mesh.border], [(float(b.parameter.min()), float(b.parameter.max())) for b in mesh.border]
        )
        curve, ends = _edges(mesh)
        start = Start(np.ascontiguousarray(mesh.uv), mesh.corner.astype(np.int64), curve, ends)
        low, high = reach(curves, mesh.uv, curve, ends)
        box = (low[0], high[0], low[1], high[1])
        ground = Ground.of(surface, box, chord)
        table, proved = table_of(ground)
        return Patch(number, surface, start, ground, table, curves, proved and exact)

    def begun(self, chord: float, most: int, workspace: RefinedMesh) -> tuple["Patch", "Tried"]:
        """The patch with a table as fine as is worth while for a chord error, and its triangles."""
        before = COARSE
        for many, cells in _FINER if self.ground.whole else ():
            tried = self.tried(chord, many, workspace)
            if tried.triangles <= many:
                return self, tried
            if self.ground.is_finer(cells, than=before):
                self, before = self._replace(table=table_of(self.ground, cells)[0]), cells
        return self, self.tried(chord, most, workspace)

    def tried(self, chord: float, most: int, workspace: RefinedMesh) -> "Tried":
        """Triangles for a chord error, counted, and kept if there is room for them."""
        count, number, off, strayed, area = refined(self.start, self.table, self.curves, self._asked(chord), most, workspace)
        own = None
        if count <= min(most, len(workspace.corner)) and number <= len(workspace.uv):
            own = RefinedMesh(workspace.uv[:number].copy(), workspace.corner[:count].copy())
        return Tried(chord, count, number, own, off, strayed, area, count <= most)

    def _asked(self, chord: float) -> float:
        return chord if self.proved else chord / MARGIN

    def laid(self, tried: "Tried", most: int) -> Laid:
        """Triangles that were counted, and no more than `most` where that was a guess."""
        chord = tried.chord
        for guess in range(_GUESSES):
            mesh, off = tried.found, tried.off
            if mesh is None:
                mesh = RefinedMesh(np.empty((tried.nodes, 2)), np.empty((tried.triangles, 3), np.int64))
                refined(self.start, self.table, self.curves, self._asked(chord), tried.triangles, mesh)
            point = self.surface.values(mesh.uv[:, 0], mesh.uv[:, 1])
            if not self.proved:
                off = MARGIN * _measured(self.surface, mesh, point) + tried.strayed
            laid = Laid(point, mesh.corner, off, tried.area, tried.whole)
            if self.proved or off <= chord or not np.isfinite(off) or tried.triangles >= most or guess + 1 == _GUESSES:
                break
            self = self._replace(table=self.table._replace(node=_LARGER * off / chord * self.table.node))
            tried = self.tried(chord, most, EMPTY)
        return laid


class Tried(NamedTuple):
    """Triangles counted for a chord error, mm, kept or not, with what `refined` tells of them; whole: all were counted."""

    chord: float
    triangles: int
    nodes: int
    found: RefinedMesh | None
    off: float
    strayed: float
    area: float
    whole: bool


def _measured(surface: Surface, mesh: RefinedMesh, point: Floats) -> float:
    """Largest distance found between points of triangles and of the surface with the same parameters, mm."""
    worst = 0.0
    for first in range(0, len(mesh.corner), _AT_ONCE):
        corner = mesh.corner[first : first + _AT_ONCE]
        for share in _MEASURED:
            uv = np.einsum("c,tcx->tx", share, mesh.uv[corner])
            off = surface.values(uv[:, 0], uv[:, 1]) - np.einsum("c,tcx->tx", share, point[corner])
            # Not a number counts as far.
            worst = max(worst, float(np.nan_to_num(np.linalg.norm(off, axis=1), nan=np.inf).max(initial=0.0)))
    return worst


def _edges(mesh: UVMesh) -> tuple[Indices, Floats]:
    """`curve` and `ends` of a mesh's triangles, as in `Start`."""
    n = len(mesh.uv)
    curve, ends = np.full(mesh.corner.shape, -1, np.int64), np.zeros((*mesh.corner.shape, 2))
    if not mesh.border:
        return curve, ends
    keys, first, last = [], [], []
    for border in mesh.border:
        a, b = border.nodes[:-1].astype(np.int64), border.nodes[1:].astype(np.int64)
        keys.append(np.concatenate([a * n + b, b * n + a]))
        first.append(np.concatenate([border.parameter[:-1], border.parameter[1:]]))
        last.append(np.concatenate([border.parameter[1:], border.parameter[:-1]]))
    index = np.repeat(np.arange(len(keys)), [len(each) for each in keys])
    key = np.concatenate(keys)
    order = np.argsort(key, kind="stable")
    wanted = mesh.corner.astype(np.int64) * n + np.roll(mesh.corner, -1, axis=1)
    at = order[np.minimum(np.searchsorted(key, wanted, sorter=order), len(key) - 1)]
    hit = key[at] == wanted
    curve[hit] = index[at[hit]]
    ends[hit] = np.stack([np.concatenate(first), np.concatenate(last)], axis=1)[at[hit]]
    return curve, ends
