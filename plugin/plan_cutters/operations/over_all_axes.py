"""How few orientations there can be whatever the axes: a bound that holds for every direction, not for candidates alone.

The sphere of directions is parted into triangles, called cells. A cell counts as blocked for a sample only if a certain obstacle
reaches into a body that lies in the tool of every axis of the cell, as deep as a gouge must be to count. All other cells count as
open, so the fewest open cells that cover the samples are no more than any axes that serve them all (`docs/motion.md`).
"""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters.domain.assembly import assembly
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.operations import Fewest
from plan_cutters.domain.pieces import row_of, solid
from plan_cutters.domain.tolerance import depths
from plan_cutters.kernels.codes import (
    ARC,
    BOTTOM,
    COLUMNS,
    HIGH,
    KIND,
    LOW,
    OFFSET_OF,
    PART,
    RADIUS,
    RISE,
    ROUND,
    SLOPE,
    TILT_FROM,
    TILT_TO,
    TOP,
    WIDE,
)
from plan_cutters.kernels.rows import Tool
from plan_cutters.operations.cover import UNIT, fewest, relax
from plan_cutters.operations.probes import Probes
from plan_cutters.scene.conditions import Context, contacts_of
from plan_cutters.scene.fixed_axis import FLAT
from plan_cutters.scene.threads import Progress

Rows = NDArray[np.int64]
#: Halvings of the icosahedron's sides that make the first cells: 320 of them, about 10 deg in radius.
_FIRST = 2
#: Cells are not made smaller than this radius, rad; and how many are parted in a round, and how many rounds there are.
_LEAST, _PARTED, _ROUNDS = math.radians(0.5), 150, 16
#: Times that a body is put down at a sample, at most: about five seconds.
_TESTS = 600_000
#: Samples that the cover of cells has, at most: those with the largest weights.
_ROWS = 200
#: Pieces that one walk of a tree can tell apart.
_PIECES = 60
#: Angles through which a frame turns within a cell, in radii of the cell, for tools that stand beside their axis.
_TURNS = np.geomspace(2.0, 16.0, 10)
_ROUNDING = 1e-6
#: Of a tool that stands as it leans alone, for the kernel: neither upright nor along a wall.
_TILTED_ALONE = (-1.0, -1.0, False)


@dataclass(frozen=True, slots=True, eq=False)
class Cells:
    """Cells of directions.

    Attributes
    ----------
    corner : (m, 3, 3) float
        Unit directions; the cell is the spherical triangle between them.
    """

    corner: Floats

    def __len__(self) -> int:
        return len(self.corner)

    @classmethod
    def whole(cls, halvings: int = _FIRST) -> "Cells":
        """Cells that are all directions together: an icosahedron's sides, halved so many times."""
        golden = 0.5 * (1.0 + math.sqrt(5.0))
        point = np.array([np.roll((0.0, a, b * golden), k) for k in range(3) for a in (-1, 1) for b in (-1, 1)])
        point /= np.linalg.norm(point[0])
        near = point @ point.T > 0.4
        sides = [(i, j, k) for i in range(12) for j in range(i) for k in range(j) if near[i, j] and near[j, k] and near[i, k]]
        cells = cls(point[np.array(sides)])
        for _ in range(halvings):
            cells = cells.parted()
        return cells

    @property
    def middle(self) -> Floats:
        """Unit directions (m, 3)."""
        total = self.corner.sum(axis=1)
        return np.asarray(total / np.linalg.norm(total, axis=1)[:, None])

    @property
    def radius(self) -> Floats:
        """The largest angle (m,) from the middle to a direction of the cell, rad: that to a corner, for a cap is convex."""
        apart = np.linalg.norm(self.corner - self.middle[:, None], axis=2).max(axis=1)
        return np.asarray(2.0 * np.arcsin(np.minimum(1.0, 0.5 * apart)) + 1e-9)

    def parted(self) -> "Cells":
        """Four cells (4 m) in place of each, by the middles of its sides; those of one stand together."""
        a, b, c = (self.corner[:, k] for k in range(3))
        ab, bc, ca = (_unit(p + q) for p, q in ((a, b), (b, c), (c, a)))
        four = np.stack([np.stack(each, axis=1) for each in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))], axis=1)
        return Cells(four.reshape(-1, 3, 3))

    def of(self, which: NDArray[np.int64]) -> "Cells":
        """Take some of them."""
        return Cells(self.corner[which])


def _unit(vector: Floats) -> Floats:
    return np.asarray(vector / np.linalg.norm(vector, axis=-1, keepdims=True))


class OpenCells:
    """Tells at which samples a cell is open: whether a tool may be free there with one of its axes.

    Parameters
    ----------
    probes : Probes
        Samples, cutters and setups.
    rows : (r,) int64
        Samples.
    progress : callable, optional
        Called with `made`, and the most that it may be.

    Attributes
    ----------
    made : int
        Times that a body was put down at a sample.
    """

    def __init__(self, probes: Probes, rows: Rows, progress: Progress | None = None) -> None:
        self.probes, self.rows, self.made, self._progress = probes, rows, 0, progress or (lambda done, of: None)
        self._tools: dict[tuple[Cutter, int, int, float, bool], list[Tool]] = {}
        self._modes = [[each.inner_tool.mode for each in of_cutter] for of_cutter in probes.contexts]

    def table(self, cells: Cells, before: NDArray[np.bool_] | None = None) -> NDArray[np.bool_]:
        """Find which cells are open, (cells, cutters with setups, rows); `before`: what is known of larger cells around them."""
        probes = self.probes
        pairs = [(c, s) for s in range(len(probes.setups)) for c in range(len(probes.cutters))]
        open_table = np.ones((len(cells), len(pairs), len(self.rows)), bool) if before is None else before.copy()
        middle, radius = cells.middle, float(cells.radius.max(initial=0.0))
        cosine = np.clip(middle @ probes.samples.normal[self.rows].T, -1.0, 1.0)
        tilt = np.arccos(cosine)
        for k, (c, s) in enumerate(pairs):
            conditions, (low, high) = probes.setups[s], probes.setups[s].postures.tilt
            # Upright and along a wall it stands with a tilt of 0 or a right angle, within the accuracy of the axes.
            off = radius + max(FLAT, conditions.accuracy) + _ROUNDING
            reached = (tilt + off >= low) & (tilt - off <= high)
            limit = math.acos(max(-1.0, conditions.machine.limit_cos))
            held = np.arccos(np.clip(middle @ conditions.setup, -1.0, 1.0)) - radius <= limit + _ROUNDING
            open_table[:, k] &= reached & held[:, None] & probes.outside[s][self.rows]
            for i in np.flatnonzero(open_table[:, k].any(axis=1)).tolist():
                mine = np.flatnonzero(open_table[i, k])
                open_table[i, k, mine] = self._free(c, s, middle[i], radius, mine, tilt[i, mine])
                self._progress(min(self.made, _TESTS), _TESTS)
        return open_table

    def _free(self, c: int, s: int, axis: Floats, radius: float, mine: Rows, tilt: Floats) -> NDArray[np.bool_]:
        """At which samples (of `rows`, those of numbers `mine`) no body proves that all axes of a cell are blocked."""
        from plan_cutters.kernels.material import sheet
        from plan_cutters.kernels.search.fixed_axis import served

        # What is enclosed is not asked for: only what a triangle blocks counts.
        conditions = self.probes.setups[s]
        solids, contacts = sheet(conditions.surroundings.certain.tree), contacts_of(self.probes.samples)
        off = radius + max(FLAT, conditions.accuracy) + _ROUNDING
        free, none = np.zeros(len(mine), bool), np.zeros((0, 3))
        for number, mode in enumerate(self._modes[c][s]):
            touching = (tilt + off >= mode[TILT_FROM]) & (tilt - off <= mode[TILT_TO])
            turn = _turn(tilt, radius, float(mode[OFFSET_OF]))
            # Under the flat the contact may be anywhere.
            turn[tilt <= off] = np.inf if mode[OFFSET_OF] > 0.0 else turn[tilt <= off]
            wall = np.abs(tilt - 0.5 * math.pi) <= off
            free |= touching & ~np.isfinite(turn)
            for psi, along in {*zip(turn[touching].tolist(), wall[touching].tolist(), strict=True)}:
                open_rows = np.flatnonzero(touching & (turn == psi) & (wall == along) & ~free)
                for tool in self._bodies(c, s, number, psi, along) if len(open_rows) else ():
                    decided = np.full(len(open_rows), -1, np.int8)
                    at = self.rows[mine[open_rows]]
                    self.made += served(at, axis, contacts, -1.0, math.pi + 1.0, _TILTED_ALONE, tool, solids, decided, none)[0]
                    open_rows = open_rows[decided >= 0]
                free[open_rows] = True
        return free

    def _bodies(self, c: int, s: int, mode: int, turn: float, along: bool) -> list[Tool]:
        key = self.probes.cutters[c], s, mode, turn, along
        if key not in self._tools:
            self._tools[key] = bodies(self.probes.contexts[c][s], mode, turn, along=along)
        return self._tools[key]


def _turn(tilt: Floats, radius: float, offset: float) -> Floats:
    """Through which angle (n,) the tool's frame turns at most from the middle axis to any other of a cell; infinite: unknown.

    The lean turns about the normal by asin(sin radius / sin tilt) at most, and the tilt changes by the radius at most. Where the
    tool touches about a point of its own axis, its turn about that axis moves nothing. Angles are rounded up, to few of them.
    """
    if offset == 0.0:
        return np.full(len(tilt), radius)
    sine = np.sin(tilt)
    far = sine > math.sin(radius) * (1.0 + 1e-9)
    turn = radius + np.arcsin(np.divide(math.sin(radius), sine, out=np.ones(len(tilt)), where=far))
    steps = radius * _TURNS
    at = np.searchsorted(steps, turn)
    return np.where(far & (at < len(steps)), steps[np.minimum(at, len(steps) - 1)], np.inf)


def bodies(context: Context, mode: int, turn: float, *, along: bool = False) -> list[Tool]:
    """Make bodies that lie in a tool however it is turned about its centre of curvature, deep enough to count.

    What is within D of the centre moves by no more than `turn` D in the tool's frame, so what lies deeper by that much in the
    tool as it stands lies deep enough in the turned one. Heights are looked at in layers, each with its own D.

    Parameters
    ----------
    context : Context
    mode : int
        The way in which it touches.
    turn : float
        rad, at most, about any line through the centre of curvature.
    along : bool
        Whether its flank may stand along a wall as well: turned by the accuracy of the axes, and moved by the tolerance.

    Returns
    -------
    list of Tool
        None where nothing of the tool is left.
    """
    cutter, conditions, whole = context.cutter, context.conditions, context.inner_tool
    error = conditions.obstacles.triangles.chord_error
    (_, blocked), (_, blocked_rest) = depths(conditions.tolerance, error), depths(0.0, error)
    offset, rows, moved = float(whole.mode[mode, OFFSET_OF]), whole.piece[mode], 0.0
    if along:
        off = max(FLAT, conditions.accuracy)
        turn, moved = turn + off, conditions.tolerance + off * float(whole.mode[mode, RISE])
    if not len(rows):
        return []
    low, high = float(rows[:, BOTTOM].min()), float(rows[:, TOP].max())
    result = []
    for first, last in pairwise(_layers(low, high, cutter.radius)):
        inside = (rows[:, TOP] > first) & (rows[:, BOTTOM] < last)
        wide = float(rows[inside][:, [RADIUS, WIDE]].max(initial=0.0))
        more = turn * math.hypot(offset + wide, max(abs(first), abs(last))) + moved
        smaller = assembly(cutter, blocked + more, blocked_rest + more, kind="inner")
        result += [row for each in smaller.piece[mode] if solid(row := _cut_off(each, first, last))]
    anywhere = whole.mode[mode : mode + 1].copy()
    anywhere[0, [TILT_FROM, TILT_TO]] = -1.0, 4.0
    return [
        Tool(np.array(result[k : k + _PIECES], float).reshape(1, -1, COLUMNS), anywhere, whole.reach, whole.inner, whole.end)
        for k in range(0, len(result), _PIECES)
    ]


def _layers(low: float, high: float, radius: float) -> list[float]:
    """Heights from the lowest to the highest point, wider apart the farther they are from the centre."""
    steps = [0.0]
    step = 0.5 * radius
    while step < max(high, -low):
        steps += [step, -step]
        step *= 1.6
    return [low, *sorted(each for each in steps if low < each < high), high]


def _cut_off(row: Floats, low: float, high: float) -> list[float]:
    """The part of a piece between two heights."""
    first, last = max(float(row[LOW]), low), min(float(row[HIGH]), high)
    if row[KIND] == ARC:
        return row_of(ARC, first, last, row[RADIUS], row[SLOPE], row[ROUND], int(row[PART]))
    return row_of(row[KIND], first, last, row[RADIUS] + row[SLOPE] * (first - row[LOW]), row[SLOPE], 0.0, int(row[PART]))


def apart(normal: Floats, tilt: float) -> Rows:
    """Samples (k,) of which no two can share an axis: normals (n, 3) that are farther apart than twice the largest tilt, rad.

    Examples
    --------
    >>> len(apart(np.concatenate([np.eye(3), -np.eye(3)]), np.radians(44.0)))
    6
    """
    if 2.0 * tilt >= math.pi or not len(normal):
        return np.arange(min(1, len(normal)))
    some = np.unique(np.round(normal, 6), axis=0, return_index=True)[1]
    least, best = 2.0 * tilt + _ROUNDING, list[int]()
    for start in some[:: max(1, len(some) // 16)].tolist():
        picked, open_ = list[int](), np.ones(len(some), bool)
        nearest, following = np.full(len(some), np.inf), start
        while True:
            picked.append(int(following))
            angle = 2.0 * np.arcsin(np.minimum(1.0, 0.5 * np.linalg.norm(normal[some] - normal[following], axis=1)))
            open_ &= angle > least
            nearest = np.minimum(nearest, angle)
            if not open_.any():
                break
            # As dense as can be: the next one is the nearest that shares no axis with those before it.
            following = some[int(np.where(open_, nearest, np.inf).argmin())]
        best = max(best, picked, key=len)
    return np.sort(np.array(best, np.int64))


def over_all_axes(probes: Probes, fewest: Fewest, wanted: Rows, *, progress: Progress | None = None) -> tuple[int, float]:
    """Bound how many orientations are needed, whatever their axes.

    Parameters
    ----------
    probes : Probes
    fewest : Fewest
        The fewest among candidates; its weights say which samples are looked at.
    wanted : (n,) int64
        Samples to serve.
    progress : callable, optional
        Called with how much is done of the most that may be.

    Returns
    -------
    at_least : int
    cells : float
        Radius of the smallest cells that were looked at, rad; nan where none was needed.
    """
    wanted = np.setdiff1d(wanted, fewest.alone)
    least = 0 if not len(wanted) else 1
    if len(fewest.chosen) <= least:
        return least, math.nan
    most = _largest_tilt(probes)
    alone = wanted[apart(probes.samples.normal[wanted], most)]
    least = max(least, len(alone))
    if least >= len(fewest.chosen):
        return least, math.nan
    heaviest = np.argsort(-fewest.weight, kind="stable")[:_ROWS]
    rows = np.union1d(fewest.rows[heaviest[fewest.weight[heaviest] > 0]], alone)
    by_cells, radius = _by_cells(OpenCells(probes, rows, progress), len(fewest.chosen))
    return max(least, by_cells), radius


def _largest_tilt(probes: Probes) -> float:
    """The largest tilt of any cutter in any setup, rad."""
    tilts = [
        min(each.conditions.postures.tilt[1], float(each.inner_tool.mode[:, TILT_TO].max()))
        for of_cutter in probes.contexts
        for each in of_cutter
    ]
    return max(tilts)


def _by_cells(cells_at: OpenCells, most: int) -> tuple[int, float]:
    """What cells prove: orientations that are needed, and the radius of the smallest cells, rad; `most` is enough."""
    cells = Cells.whole()
    open_, least, finest = cells_at.table(cells), 1, float(cells.radius.max())
    for _ in range(_ROUNDS):
        columns, first = _columns(open_)
        relaxed = relax(columns)
        least = max(least, math.ceil(relaxed.bound - 1e-9))
        if least >= most or cells_at.made >= _TESTS:
            break
        used = _tight(open_, relaxed.weight, first[relaxed.share > _ROUNDING], cells.radius)
        if not len(used):
            break
        small = cells.of(used).parted()
        remaining = np.setdiff1d(np.arange(len(cells)), used)
        # Cells of about one size share their bodies.
        parts = [_same_size(cells_at, small, np.repeat(open_[used], 4, axis=0))]
        open_ = np.concatenate([open_[remaining], *parts])
        cells = Cells(np.concatenate([cells.corner[remaining], small.corner]))
        finest = min(finest, float(small.radius.max()))
    if least < most:
        least = max(least, fewest(_columns(open_)[0], prove=False).at_least)
    return min(least, most), finest


def _same_size(cells_at: OpenCells, cells: Cells, before: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """The table of cells of several sizes, size by size."""
    reordered = np.empty_like(before)
    size = np.round(np.log2(cells.radius / _LEAST)).astype(np.int64)
    for each in np.unique(size).tolist():
        mine = np.flatnonzero(size == each)
        reordered[mine] = cells_at.table(cells.of(mine), before[mine])
    return reordered


def _columns(open_: NDArray[np.bool_]) -> tuple[NDArray[np.bool_], NDArray[np.int64]]:
    """Different columns (rows, columns) of a table of cells, and the cell that each of them came from."""
    flat = open_.reshape(-1, open_.shape[2])
    first = np.unique(np.packbits(flat, axis=1), axis=0, return_index=True)[1]
    return flat[first].T, first // open_.shape[1]


def _tight(open_: NDArray[np.bool_], weight: NDArray[np.int64], used: Rows, radius: Floats) -> NDArray[np.int64]:
    """Cells that hold the bound down, and that may still be parted: used by the cover, or as loaded as any; large ones first."""
    load = (open_ @ weight).max(axis=1)
    tight = load >= (1.0 - 1e-4) * UNIT
    tight[used] = True
    looser = np.flatnonzero(tight & (radius > 2.0 * _LEAST))
    order = np.lexsort((-load[looser], ~np.isin(looser, used), -np.round(radius[looser], 2)))
    return np.sort(looser[order[:_PARTED]])
