"""Cells: pieces of exact surfaces, each within a bound of a flat hull, that are cut smaller where a tool comes near.

A cell of a face is a box of its parameters: the kernel evaluates point and tangents at its middle, and points around it, whose
distance from the tangent plane's parallelogram, doubled, is taken for how far the surface leaves that (`slack`). A cell of a mesh
is a triangle. Cells are stored: each is evaluated once, however many tools come near.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cad_io import Part
from cad_io.arrays import Floats
from cad_io.kernel import first_derivatives, values

Rows = NDArray[np.int64]
#: Whether a cell lies within the border of its face.
OUTSIDE, INSIDE, ACROSS = 0, 1, 2
#: Points along each side at which the slack of a cell is measured: of the first cells, and of later ones.
_MANY, _FEW = 7, 3
#: Points that are asked at once whether they lie in a face, and pairs of cells and border segments that are looked at at once.
_AT_ONCE, _PAIRS = 128, 2_000_000
_CORNERS = np.array([(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)])


@dataclass(frozen=True, slots=True, eq=False)
class MeasuredCells:
    """Cells as they were measured, n of them: see `Cells`."""

    point: Floats
    offset: Floats
    slack: Floats
    state: NDArray[np.int8]
    proper: NDArray[np.bool_]


class Face:
    """A face of a part, perhaps placed: `rotation @ point + shift`."""

    def __init__(self, part: Part, number: int, name: str, rotation: Floats | None = None, shift: Floats | None = None) -> None:
        self.name, self._part, self._number = name, part, number
        self._rotation = np.eye(3) if rotation is None else rotation
        self._shift = np.zeros(3) if shift is None else shift
        trim = part.trim(number)
        if trim is None:
            raise ValueError(f"{name} has no border that can be read")
        self._trim, self._adaptor = trim, part.adaptor(number)
        self._flat = part.faces[number - 1].surface == "plane"
        self._first = True

    def roots(self) -> Floats:
        """The whole of it: (1, 3, 3)."""
        u0, u1, v0, v1 = self._trim.box
        return np.array([[[u0, u1, 0.0], [v0, v1, 0.0], [0.0, 0.0, 0.0]]])

    def halves(self, form: Floats, offset: Floats) -> tuple[Floats, Rows]:
        """Cut boxes (n, 3, 3) along their longer sides: the pieces, and which box each is of."""
        u, v = form[:, 0, :2], form[:, 1, :2]
        # Corners are at -a - b, -a + b, a - b, a + b.
        along_u = np.linalg.norm(offset[:, 2] - offset[:, 0], axis=1)
        along_v = np.linalg.norm(offset[:, 1] - offset[:, 0], axis=1)
        cut_u, cut_v = along_u >= 0.6 * along_v, along_v >= 0.6 * along_u
        pieces, owner = [], []
        number = np.arange(len(form))
        for i in (0, 1):
            for j in (0, 1):
                mine = (cut_u | (i == 0)) & (cut_v | (j == 0))
                piece = form[mine].copy()
                for row, ends, cut, side in ((0, u, cut_u, i), (1, v, cut_v, j)):
                    middle = ends.mean(axis=1)[mine]
                    piece[cut[mine], row, 1 - side] = middle[cut[mine]]
                pieces.append(piece)
                owner.append(number[mine])
        return np.concatenate(pieces), np.concatenate(owner)

    def measured(self, form: Floats) -> MeasuredCells:
        """Evaluate boxes (n, 3, 3)."""
        u, v = form[:, 0, :2].mean(axis=1), form[:, 1, :2].mean(axis=1)
        a, b = 0.5 * np.diff(form[:, 0, :2], axis=1)[:, 0], 0.5 * np.diff(form[:, 1, :2], axis=1)[:, 0]
        point, s_u, s_v = np.moveaxis(first_derivatives(self._adaptor, u, v), 1, 0)
        offset = _CORNERS[:, 0, None] * (s_u * a[:, None])[:, None] + _CORNERS[:, 1, None] * (s_v * b[:, None])[:, None]
        slack = np.zeros(len(form))
        if not self._flat:
            steps = np.linspace(-1.0, 1.0, _MANY if self._first else _FEW)
            for i in steps.tolist():
                for j in steps.tolist():
                    if i or j:
                        there = values(self._adaptor, u + i * a, v + j * b)
                        flat = point + i * a[:, None] * s_u + j * b[:, None] * s_v
                        slack = np.maximum(slack, np.linalg.norm(there - flat, axis=1))
            # What lies between the points that were looked at.
            slack *= 2.0
        self._first = False
        state = self._state(form)
        proper = state == INSIDE
        across = np.flatnonzero(state == ACROSS)
        for some in np.array_split(across, -(-len(across) // _AT_ONCE) or 1):
            if len(some):
                proper[some] = self._trim.inside(u[some], v[some])
        unusable = ~np.isfinite(point).all(axis=1) | ~np.isfinite(slack)
        # Where the kernel has no value there is nothing to look at.
        point[unusable], offset[unusable], slack[unusable], proper[unusable], state[unusable] = (0.0, 0.0, 0.0, False, OUTSIDE)
        return MeasuredCells(point @ self._rotation.T + self._shift, offset @ self._rotation.T, slack, state, proper)

    def _state(self, form: Floats) -> NDArray[np.int8]:
        """Whether boxes lie in the face: those that no segment of its border comes near are all in it or all out of it."""
        trim = self._trim
        if trim.rectangular:
            return np.full(len(form), INSIDE, np.int8)
        if not trim.closed:
            return np.full(len(form), ACROSS, np.int8)
        reach = (trim.tolerance + 2.0 * trim.deflection) / trim.scale
        low, high = form[:, :2, 0] - reach, form[:, :2, 1] + reach
        first, second = trim.segments[:, 0], trim.segments[:, 1]
        near = np.zeros(len(form), bool)
        size = max(1, _PAIRS // max(1, len(first)))
        for start in range(0, len(form), size):
            some = slice(start, start + size)
            near[some] = _touched(low[some], high[some], first, second)
        state = np.full(len(form), ACROSS, np.int8)
        clear = np.flatnonzero(~near)
        u, v = form[clear, 0, :2].mean(axis=1), form[clear, 1, :2].mean(axis=1)
        for start in range(0, len(clear), _AT_ONCE):
            some = slice(start, start + _AT_ONCE)
            state[clear[some]] = np.where(trim.inside(u[some], v[some]), INSIDE, OUTSIDE)
        return state


def _touched(low: Floats, high: Floats, first: Floats, second: Floats) -> NDArray[np.bool_]:
    """Which boxes (n, 2) a segment of some (m, 2) to (m, 2) comes into."""
    middle, half = 0.5 * (low + high)[:, None], 0.5 * (high - low)[:, None]
    away, side = 0.5 * (first + second)[None] - middle, 0.5 * np.abs(second - first)[None]
    apart = (np.abs(away) > half + side).any(axis=2)
    along = (second - first)[None]
    cross = np.abs(along[..., 0] * away[..., 1] - along[..., 1] * away[..., 0])
    apart |= cross > half[..., 0] * np.abs(along[..., 1]) + half[..., 1] * np.abs(along[..., 0])
    return np.asarray((~apart).any(axis=1))


class Triangles:
    """Triangles (n, 3, 3) of a mesh, of a box, or of a table."""

    def __init__(self, vertex: Floats, name: str) -> None:
        self.name, self._vertex = name, vertex

    def roots(self) -> Floats:
        """The triangles themselves."""
        return self._vertex

    def halves(self, form: Floats, offset: Floats) -> tuple[Floats, Rows]:
        """Cut triangles (n, 3, 3) across their longest sides: the pieces, and which triangle each is of."""
        side = np.linalg.norm(np.roll(form, -1, axis=1) - form, axis=2).argmax(axis=1)
        number = np.arange(len(form))
        a, b, c = (form[number, (side + k) % 3] for k in range(3))
        middle = 0.5 * (a + b)
        pieces = np.concatenate([np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)])
        return pieces, np.concatenate([number, number])

    def measured(self, form: Floats) -> MeasuredCells:
        """Their middles and corners; they are flat, and have no border to be beyond."""
        point = form.mean(axis=1)
        offset = form - point[:, None]
        n = len(form)
        return MeasuredCells(
            point, np.concatenate([offset, offset[:, :1]], axis=1), np.zeros(n), np.full(n, INSIDE, np.int8), np.ones(n, bool)
        )


Source = Face | Triangles


class Cells:
    """Cells of some sources, with a tree of groups above the first ones.

    Attributes
    ----------
    point : (n, 3) float
        A point of the surface; of a group, the middle of its ball.
    offset : (n, 4, 3) float
        Corners of its flat hull from there.
    slack : (n,) float
        How far its surface leaves that hull, mm; of a group, the radius of its ball.
    size : (n,) float
        Longest offset and slack, mm.
    state : (n,) int8
        `OUTSIDE`, `INSIDE` or `ACROSS`.
    proper : (n,) bool
        Whether `point` is a point of the surface, within the border of its face.
    source : (n,) int32
        Index into `sources`; -1 for a group.
    """

    def __init__(self) -> None:
        self.sources: list[Source] = []
        self.point, self.offset = np.zeros((0, 3)), np.zeros((0, 4, 3))
        self.slack, self.size = np.zeros(0), np.zeros(0)
        self.state, self.proper = np.zeros(0, np.int8), np.zeros(0, bool)
        self.source = np.zeros(0, np.int32)
        self._form, self._first, self._count = np.zeros((0, 3, 3)), np.zeros(0, np.int64), np.zeros(0, np.int64)
        self.used = 0

    def add(self, sources: Sequence[Source]) -> int:
        """Take in some surfaces: the number of the group of all their cells."""
        roots = []
        for each in sources:
            self.sources.append(each)
            form = each.roots()
            roots.append(self._append(form, each.measured(form), len(self.sources) - 1))
        return self._grouped(np.concatenate(roots))

    def joined(self, groups: Sequence[int]) -> int:
        """The number of one group of several."""
        return self._grouped(np.array(groups, np.int64))

    def children(self, cells: Rows) -> tuple[Rows, Rows]:
        """The pieces of cells (n,): their numbers, and which of the cells each is of."""
        fresh = np.unique(cells[self._first[cells] < 0])
        for number in np.unique(self.source[fresh]).tolist():
            mine = fresh[self.source[fresh] == number]
            form, owner = self.sources[number].halves(self._form[mine], self.offset[mine])
            order = np.argsort(owner, kind="stable")
            new = self._append(form[order], self.sources[number].measured(form[order]), number)
            count = np.bincount(owner, minlength=len(mine))
            self._count[mine] = count
            self._first[mine] = new[0] + np.concatenate([[0], np.cumsum(count)[:-1]])
        count = self._count[cells]
        owner = np.repeat(np.arange(len(cells)), count)
        place = np.arange(len(owner)) - np.repeat(np.cumsum(count) - count, count)
        return self._first[cells][owner] + place, owner

    def _grouped(self, cells: Rows) -> int:
        """Put cells under balls, eight to each, neighbours along the longest side of their box together."""
        while len(cells) > 1:
            cells = cells[_order(self.point[cells])]
            parts = np.array_split(cells, -(-len(cells) // 8))
            groups = []
            # Members of a group must follow each other: links stand for them.
            for part in parts:
                first = self._links(part)
                low = (self.point[part] - self.size[part, None]).min(axis=0)
                high = (self.point[part] + self.size[part, None]).max(axis=0)
                point = 0.5 * (low + high)
                radius = float((np.linalg.norm(self.point[part] - point, axis=1) + self.size[part]).max())
                contacts = MeasuredCells(
                    point[None], np.zeros((1, 4, 3)), np.array([radius]), np.array([ACROSS], np.int8), np.zeros(1, bool)
                )
                number = int(self._append(np.zeros((1, 3, 3)), contacts, -1)[0])
                self._first[number], self._count[number] = first, len(part)
                groups.append(number)
            cells = np.array(groups, np.int64)
        return int(cells[0])

    def _links(self, cells: Rows) -> int:
        """Copies of cells that follow each other, with the pieces of the cells: the number of the first."""
        contacts = MeasuredCells(self.point[cells], self.offset[cells], self.slack[cells], self.state[cells], self.proper[cells])
        new = self._append(self._form[cells], contacts, 0)
        self.source[new], self._first[new], self._count[new] = (self.source[cells], self._first[cells], self._count[cells])
        return int(new[0])

    def _append(self, form: Floats, contacts: MeasuredCells, source: int) -> Rows:
        n, start = len(form), self.used
        if start + n > len(self.slack):
            more = max(n, len(self.slack), 1024)
            for name in ("point", "offset", "slack", "size", "state", "proper", "source", "_form", "_first", "_count"):
                old = getattr(self, name)
                setattr(self, name, np.concatenate([old, np.zeros((more, *old.shape[1:]), old.dtype)]))
        mine = slice(start, start + n)
        self._form[mine], self.point[mine], self.offset[mine] = form, contacts.point, contacts.offset
        self.slack[mine], self.state[mine], self.proper[mine] = contacts.slack, contacts.state, contacts.proper
        self.size[mine] = np.linalg.norm(contacts.offset, axis=2).max(axis=1) + contacts.slack
        self.source[mine], self._first[mine], self._count[mine] = source, -1, 0
        self.used = start + n
        return np.arange(start, start + n)


def _order(point: Floats) -> Rows:
    """An order of points (n, 3) in which neighbours mostly follow each other: halved along the longest side, again and again."""
    rows, todo = np.arange(len(point)), [(0, len(point))]
    while todo:
        start, end = todo.pop()
        if end - start > 8:
            part = rows[start:end]
            side = int(np.ptp(point[part], axis=0).argmax())
            rows[start:end] = part[np.argsort(point[part, side], kind="stable")]
            middle = (start + end) // 2
            todo += [(start, middle), (middle, end)]
    return rows
