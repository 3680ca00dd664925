"""Exact surfaces in cells, that are cut smaller where a tool comes near: does one come deeper into them than allowed?

A cell of a face is a box of its parameters: the kernel evaluates point and tangents at its middle, and points around it, whose
distance from the tangent plane's parallelogram, doubled, is taken for how far the surface leaves that (`slack`). A cell of a mesh
is a triangle. Cells are stored: each is evaluated once, however many tools come near.
"""

import time
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from cad_io import Part
from cad_io.arrays import Floats
from cad_io.kernel import first_derivatives, values
from plan_cutters_check.tool import Tool, bounds

Rows = NDArray[np.int64]
#: Verdicts of a placement.
FREE, MET, OPEN = 0, 1, 2
#: Whether a cell lies within the border of its face.
OUTSIDE, INSIDE, ACROSS = 0, 1, 2
#: Points along each side at which the slack of a cell is measured: of the first cells, and of later ones.
_MANY, _FEW = 7, 3
_CORNERS = np.array([(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)])
#: Steps in parameters to all sides.
SIDES = [np.array(side) for side in ((1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (1, -1), (-1, 1), (-1, -1))]
#: Tools that are put down at a time, and pairs of a tool and a cell that are looked at at once.
_TOOLS, _MOST = 256, 100_000
#: Depths that rounding makes, mm.
_ROUNDING = 1e-7


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
        self.name = name
        self._rotation = np.eye(3) if rotation is None else rotation
        self._shift = np.zeros(3) if shift is None else shift
        trim = part.trim(number)
        if trim is None:
            raise ValueError(f"{name} has no border that can be read")
        self._trim, self._adaptor = trim, part.adaptor(number)
        self._border = shapely.STRtree(shapely.linestrings(trim.segments))
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
        proper[across] = self._trim.inside(u[across], v[across])
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
        near, _ = self._border.query(shapely.box(*low.T, *high.T), predicate="intersects")
        state = np.full(len(form), ACROSS, np.int8)
        clear = np.setdiff1d(np.arange(len(form)), near)
        within = trim.inside(form[clear, 0, :2].mean(axis=1), form[clear, 1, :2].mean(axis=1))
        state[clear] = np.where(within, INSIDE, OUTSIDE)
        return state


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
        point, n = form.mean(axis=1), len(form)
        offset = (form - point[:, None])[:, [0, 1, 2, 0]]
        return MeasuredCells(point, offset, np.zeros(n), np.full(n, INSIDE, np.int8), np.ones(n, bool))


Source = Face | Triangles


class Cells:
    """Cells of some sources, with a tree of groups above the first ones.

    Of each cell, n of them: `point` (n, 3) of the surface, of a group the middle of its ball; `offset` (n, 4, 3), corners of its
    flat hull from there; `slack` (n,), how far its surface leaves that hull, mm, of a group the radius of its ball; `size` (n,),
    longest offset and slack, mm; `state` (n,): `OUTSIDE`, `INSIDE` or `ACROSS`; `proper` (n,): whether `point` is a point of the
    surface, within the border of its face; `source` (n,): index into `sources`, -1 for a group.
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
            for part in parts:
                # Members of a group must follow each other: copies with the pieces of the cells stand for them.
                own = MeasuredCells(self.point[part], self.offset[part], self.slack[part], self.state[part], self.proper[part])
                link = self._append(self._form[part], own, 0)
                self.source[link], self._first[link], self._count[link] = self.source[part], self._first[part], self._count[part]
                low = (self.point[part] - self.size[part, None]).min(axis=0)
                high = (self.point[part] + self.size[part, None]).max(axis=0)
                point = 0.5 * (low + high)
                radius = float((np.linalg.norm(self.point[part] - point, axis=1) + self.size[part]).max())
                state = np.array([ACROSS], np.int8)
                ball = MeasuredCells(point[None], np.zeros((1, 4, 3)), np.array([radius]), state, np.zeros(1, bool))
                number = int(self._append(np.zeros((1, 3, 3)), ball, -1)[0])
                self._first[number], self._count[number] = link[0], len(part)
                groups.append(number)
            cells = np.array(groups, np.int64)
        return int(cells[0])

    def _append(self, form: Floats, cells: MeasuredCells, source: int) -> Rows:
        n, start = len(form), self.used
        if start + n > len(self.slack):
            more = max(n, len(self.slack), 1024)
            for name in ("point", "offset", "slack", "size", "state", "proper", "source", "_form", "_first", "_count"):
                old = getattr(self, name)
                setattr(self, name, np.concatenate([old, np.zeros((more, *old.shape[1:]), old.dtype)]))
        mine = slice(start, start + n)
        self._form[mine], self.point[mine], self.offset[mine] = form, cells.point, cells.offset
        self.slack[mine], self.state[mine], self.proper[mine] = cells.slack, cells.state, cells.proper
        self.size[mine] = np.linalg.norm(cells.offset, axis=2).max(axis=1) + cells.slack
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


@dataclass(slots=True)
class Clock:
    """Seconds that a check may take."""

    end: float

    @property
    def over(self) -> bool:
        """Whether they are over."""
        return time.monotonic() > self.end


@dataclass(frozen=True, slots=True, eq=False)
class Met:
    """Tools, n of them, met something or nothing: `verdict` (n,): `FREE`, `MET`, or `OPEN` where the time was over.

    `cell` (n,): a cell whose point is too deep, -1 for none; `depth` (n,): how deep that point lies in the tool, mm, negative
    outside; `solid` (n,): in which solid of the tool.
    """

    verdict: NDArray[np.int8]
    cell: Rows
    depth: Floats
    solid: Rows


def met(
    cells: Cells, root: int, tool: Tool, tip: Floats, axis: Floats, limits: tuple[float, float], grain: float, clock: Clock
) -> Met:
    """Which tools, put down with their tips (n, 3) and axes (n, 3), hold a point of the surface that is too deep.

    `root`: the group of all that may be in the way; `limits`: depth in the flutes, and in all above them, beyond which a point is
    too deep, mm, negative: so near to it; `grain`: what is deeper by less than this may be missed, mm.
    """
    n = len(tip)
    hits = Met(np.full(n, OPEN, np.int8), np.full(n, -1, np.int64), np.full(n, np.nan), np.full(n, -1, np.int64))
    limit = [limits[0] if each.part == "flutes" else limits[1] for each in tool.solids]
    for start in range(0, n, _TOOLS):
        some = np.arange(start, min(n, start + _TOOLS))
        # The cells nearest to a contact come last, and are the smallest: the stack keeps few of them at a time.
        stack = [(some, np.full(len(some), root, np.int64))]
        while stack and not clock.over:
            who, cell = stack.pop()
            open_ = (hits.verdict[who] != MET) & (cells.state[cell] != OUTSIDE)
            who, cell = who[open_], cell[open_]
            while len(who) > _MOST:
                half = len(who) // 2
                stack.append((who[half:], cell[half:]))
                who, cell = who[:half], cell[:half]
            near = np.zeros(len(who), bool)
            for k, solid in enumerate(tool.solids if len(who) else ()):
                deep, most = bounds(solid, tip[who], axis[who], cells.point[cell], cells.offset[cell])
                near |= most + cells.slack[cell] > limit[k] + grain
                hit = np.flatnonzero((deep > limit[k] + _ROUNDING) & cells.proper[cell])
                hits.verdict[who[hit]], hits.cell[who[hit]] = MET, cell[hit]
                hits.depth[who[hit]], hits.solid[who[hit]] = deep[hit], k
            near &= (hits.verdict[who] != MET) & (cells.size[cell] > grain)
            if near.any():
                pieces, owner = cells.children(cell[near])
                stack.append((who[near][owner], pieces))
        if stack:
            break
        hits.verdict[some[hits.verdict[some] == OPEN]] = FREE
    return hits


def lowest(cells: Cells, root: int, direction: Floats, grain: float) -> float:
    """How far down along a unit direction (3,) the surface goes, mm, to within `grain`."""
    best, cell = np.inf, np.array([root])
    while len(cell):
        at = cells.point[cell] @ direction
        best = min(best, float(at[cells.proper[cell]].min(initial=np.inf)))
        least = at - np.abs(cells.offset[cell] @ direction).max(axis=1) - cells.slack[cell]
        near = (least < best - grain) & (cells.state[cell] != OUTSIDE) & (cells.size[cell] > grain)
        cell = cells.children(cell[near])[0]
    return best
