"""How far a triangle in a face's parameter plane may be from the surface: proved from how the surface bends about it.

With corners p_i, a point p = sum l_i p_i of the triangle and second derivatives H within `spread` of `middle` over a
rectangle that holds it, Taylor's formula gives `|S(p) - sum l_i S(p_i)| <= 1/2 sum_(i<j) l_i l_j q(p_i - p_j)`, with
`q(d) = |middle(d, d)| + spread(d, d)`: the squares' weighted sum about p is that of the edges. Of the spread, what the twist
Suv adds is shared out to the squares, `|2 du dv| <= k du^2 + dv^2 / k`: k is the triangle's own, for a surface may be run through
a billion times as fast at one place as at another. A table holds middle and spread for windows of cells, so that one look
tells them for a triangle of any size.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from cad_io.surface import Bends, Surface
from cad_io.surface.surface import lines_within
from plan_cutters_base.jit import entry, kernel

#: Cells along a surface that is bent one way only, at least, so many times those of one bent both ways; at most each way, where
#: dense knots are put together. Where there are few one way, there may be more the other way.
_ALONG, _MOST = 4, 256
#: How often cells are halved where control points swing farther than the surface does: each time they come four times as near.
_HALVINGS = 8
#: Cells each way where few triangles are to be laid, more, and many: bounds close in as cells shrink.
COARSE, MIDDLE, FINE = 8, 24, 64
#: Knots nearer than this share of the range are one line; what the surface does between them is not proved.
_NARROW = 1e-9
#: A first derivative that jumps by so much may belong to a surface with a gap: `forms` says 1e30.
TORN = 1e20
#: Columns of a table: Suu, Svv, Suv in the middle, what each of them may differ by, |Su|, |Sv|, how long lines along u and v are.
_WIDE = 16


class Table(NamedTuple):
    """Bends over windows of cells.

    u, v: lines. kink_u, kink_v (k, 2): lines where first derivatives jump, and how far at most. node (n, _WIDE): windows'
    bends, level after level: those of level (i, j) begin at start[i, j] and are along_u[i] by along_v[j].
    """

    u: Any
    v: Any
    kink_u: Any
    kink_v: Any
    node: Any
    start: Any
    along_u: Any
    along_v: Any


class Ground(NamedTuple):
    """This record holds the data that all tables of a surface over a rectangle (u0, u1, v0, v1) share.

    lines: along u and v at which its pieces end, None where only the kernel can evaluate it or its bends have no bound. ways:
    whether it is bent along u and along v. bends: over the cells between the lines. kinks: as in `Table`. whole: whether nothing
    hides between knots that are nearly one.
    """

    surface: Surface
    box: tuple[float, float, float, float]
    lines: tuple[Floats, Floats] | None
    ways: tuple[bool, bool]
    bends: Bends | None
    kinks: tuple[Floats, Floats]
    whole: bool

    @staticmethod
    def of(surface: Surface, box: tuple[float, float, float, float], chord: float = np.inf) -> "Ground":
        """The ground over a rectangle, with lines so dense that bounds within a cell are not much looser than `chord`, mm."""
        none = np.zeros((0, 2))
        unknown = Ground(surface, box, None, (True, True), None, (none, none), False)
        form = surface.form
        if form is None:
            return unknown
        lines, kinks, whole = [], [], True
        for k in range(2):
            ends = (box[2 * k], box[2 * k + 1])
            knots, jumps = lines_within(form.knots[k], form.jumps[k], form.period[k], ends)
            lines.append(_merged(knots, ends))
            kinks.append(np.stack([knots, jumps], axis=1)[jumps > 0.0])
            # A knot at the border itself hides nothing: the piece beyond it is as wide as others, and hardly entered.
            whole = whole and bool((np.diff(knots) > _NARROW * (ends[1] - ends[0])).all())
        bends = _bends(form.bends, lines[0], lines[1])
        for _ in range(_HALVINGS):
            loose = _loose(bends, lines, chord)
            if not any(each.any() for each in loose):
                break
            lines = [evenly(each, 1 + times) for each, times in zip(lines, loose, strict=True)]
            bends = _bends(form.bends, lines[0], lines[1])
        if not _bounded(bends):
            return unknown
        bent = [bool(np.abs(bends.middle[:, :, k]).max() + bends.spread[:, :, k].max() > 0.0) for k in range(3)]
        ways = (bent[0] or bent[2], bent[1] or bent[2])
        return Ground(surface, box, (lines[0], lines[1]), ways, bends, (kinks[0], kinks[1]), whole)

    def finer(self, count: int) -> list[Floats]:
        """Lines along u and along v, so many cells each way or more between them."""
        if self.lines is None:
            return [np.linspace(self.box[2 * k], self.box[2 * k + 1], count + 1) for k in range(2)]
        count = count if all(self.ways) else _ALONG * count
        return [
            evenly(each, np.maximum(1, np.ceil(count * np.diff(each) / (each[-1] - each[0]) - 1e-6)).astype(int))
            if way and len(each) <= count
            else each
            for each, way in zip(self.lines, self.ways, strict=True)
        ]


def table_of(ground: Ground, cells: int = COARSE) -> tuple[Table, bool]:
    """The table of a surface over a rectangle, of so many cells each way or more, and whether its bounds are proved.

    Where only the kernel can evaluate a surface, its bounds are estimated from derivatives in places. The shape between knots
    that are nearly one is left out. Results that rest on either must be measured.
    """
    form = ground.surface.form
    u, v = ground.finer(cells)
    if form is not None and ground.lines is not None and ground.bends is not None:
        same = len(u) == len(ground.lines[0]) and len(v) == len(ground.lines[1])
        bends = ground.bends if same else _bends(form.bends, u, v)
        if _bounded(bends):
            return _table(_thinned(u, v), _thinned(v, u), *ground.kinks, bends), ground.whole
        u, v = (np.linspace(ground.box[2 * k], ground.box[2 * k + 1], cells + 1) for k in range(2))
    none = np.zeros((0, 2))
    return _table(u, v, none, none, _guessed(ground.surface, u, v)), False


def _bounded(bends: Bends) -> bool:
    return bool(np.isfinite(bends.spread).all() and np.isfinite(bends.first).all())


def _loose(bends: Bends, lines: list[Floats], chord: float) -> list[NDArray[np.bool_]]:
    """Which cells along u, and along v, have bounds that are loose: what is not known of their bending is more than what is
    known, and more than a chord error, mm, across the cell."""
    loose = []
    for k, each in enumerate(lines):
        width = np.diff(each)
        if bends.spread.shape[k] != len(width):
            return [np.zeros(len(along) - 1, bool) for along in lines]  # cells are put together already
        spread, middle = bends.spread[:, :, k], np.linalg.norm(bends.middle[:, :, k], axis=2)
        with np.errstate(over="ignore"):
            far = 0.125 * spread * np.expand_dims(width * width, 1 - k) > chord
        loose.append((far & (spread > middle)).any(axis=1 - k))
    return loose


def _merged(knots: Floats, ends: tuple[float, float]) -> Floats:
    """Lines at the ends and at the knots between, one where knots are nearly one."""
    narrow = _NARROW * (ends[1] - ends[0])
    merged = [ends[0]]
    for knot in knots.tolist():
        if knot - merged[-1] > narrow and ends[1] - knot > narrow:
            merged.append(knot)
    return np.array([*merged, max(ends[1], ends[0] + 1e-300)])


def evenly(lines: Floats, times: NDArray[np.int64]) -> Floats:
    """Lines with others evenly between them, so that there are so many cells for each that was."""
    which = np.repeat(np.arange(len(times)), times)
    step = np.diff(lines) / times
    within = np.arange(len(which)) - (np.cumsum(times) - times)[which]
    return np.append(within * step[which] + lines[which], lines[-1])


def _groups(cells: int, across: int) -> NDArray[np.int64]:
    """Where groups of cells begin, so that there are no more than _MOST, or than fill a square where there are few across."""
    most = max(_MOST, _MOST * _MOST // max(across, COARSE))
    return np.arange(0, cells, -(-cells // most))


def _thinned(lines: Floats, across: Floats) -> Floats:
    """Lines that are left when cells are put together in groups."""
    return np.append(lines[:-1][_groups(len(lines) - 1, len(across) - 1)], lines[-1])


def _bends(of: Any, u: Floats, v: Floats) -> Bends:
    """Bends over cells between lines, groups of them put together where there are too many."""
    groups_u, groups_v = _groups(len(u) - 1, len(v) - 1), _groups(len(v) - 1, len(u) - 1)
    if len(groups_u) == len(u) - 1 and len(groups_v) == len(v) - 1:
        return Bends(*of(u, v))
    strips = []
    for first, last in zip(groups_u, np.append(groups_u[1:], len(u) - 1), strict=True):
        fine = of(u[first : last + 1], v)
        high = np.maximum.reduceat(fine.middle.max(axis=0), groups_v, axis=0)
        low = np.minimum.reduceat(fine.middle.min(axis=0), groups_v, axis=0)
        middle = 0.5 * (high + low)
        each = np.repeat(middle, np.diff(np.append(groups_v, len(v) - 1)), axis=0)
        off = (np.linalg.norm(fine.middle - each, axis=3) + fine.spread).max(axis=0)
        strips.append(
            (middle, np.maximum.reduceat(off, groups_v, axis=0), np.maximum.reduceat(fine.first.max(axis=0), groups_v, axis=0))
        )
    return Bends(*(np.stack(column) for column in zip(*strips, strict=True)))


def _guessed(surface: Surface, u: Floats, v: Floats) -> Bends:
    """Estimate bends from derivatives at the cells' corners: the spread within a cell is taken to be that of its corners."""
    s, t = (grid.ravel() for grid in np.meshgrid(u, v, indexing="ij"))
    with np.errstate(all="ignore"):
        corner = surface.second(s, t).reshape(len(u), len(v), 6, 3)
    each = np.stack([corner[:-1, :-1], corner[1:, :-1], corner[:-1, 1:], corner[1:, 1:]])
    middle = each[:, :, :, 3:].mean(axis=0)
    spread = np.linalg.norm(each[:, :, :, 3:] - middle, axis=4).max(axis=0)
    return Bends(middle, spread, np.linalg.norm(each[:, :, :, 1:3], axis=4).max(axis=0))


def _table(u: Floats, v: Floats, kink_u: Floats, kink_v: Floats, bends: Bends) -> Table:
    along_u, along_v = _windows(len(u) - 1), _windows(len(v) - 1)
    counts = along_u[:, None] * along_v[None, :]
    start = np.concatenate([[0], np.cumsum(counts)[:-1]]).reshape(counts.shape)
    node = np.zeros((int(counts.sum()), _WIDE))
    cells = node[: len(bends.first.reshape(-1, 2))]
    cells[:, :9] = bends.middle.reshape(-1, 9)
    cells[:, 9:12] = bends.spread.reshape(-1, 3)
    cells[:, 12:14] = bends.first.reshape(-1, 2)
    width = np.stack([np.repeat(np.diff(u), len(v) - 1), np.tile(np.diff(v), len(u) - 1)], axis=1)
    cells[:, 14:] = cells[:, 12:14] * width
    table = Table(u, v, np.ascontiguousarray(kink_u), np.ascontiguousarray(kink_v), node, start, along_u, along_v)
    _gather(table)
    return table


def _windows(cells: int) -> NDArray[np.int64]:
    """Windows at each level: single cells, then two neighbouring blocks of 1, 2, 4, ... cells each."""
    counts, blocks = [cells], cells
    while blocks > 1:
        counts.append(blocks - 1)
        if blocks == 2:
            break
        blocks = -(-blocks // 2)
    return np.array(counts, np.int64)


@kernel
def _join(one, other, along, out):
    """Write the bends of two windows together, one behind the other along u (0) or v (1)."""
    for k in range(3):
        apart = 0.0
        for c in range(3 * k, 3 * k + 3):
            apart += (one[c] - other[c]) ** 2
            out[c] = 0.5 * (one[c] + other[c])
        out[9 + k] = max(one[9 + k], other[9 + k]) + 0.5 * np.sqrt(apart)
    for k in range(2):
        out[12 + k] = max(one[12 + k], other[12 + k])
        out[14 + k] = one[14 + k] + other[14 + k] if k == along else max(one[14 + k], other[14 + k])


@kernel
def _fill(table):
    node, start, along_u, along_v = table.node, table.start, table.along_u, table.along_v
    for k in range(1, len(along_u)):
        step = 1 if k == 1 else 2
        for i in range(along_u[k]):
            other = min(i + 1 if k == 1 else 2 * i + 2, along_u[k - 1] - 1)
            for j in range(along_v[0]):
                below = start[k - 1, 0]
                _join(
                    node[below + step * i * along_v[0] + j],
                    node[below + other * along_v[0] + j],
                    0,
                    node[start[k, 0] + i * along_v[0] + j],
                )
    for k in range(len(along_u)):
        for m in range(1, len(along_v)):
            step = 1 if m == 1 else 2
            for i in range(along_u[k]):
                before, here = start[k, m - 1] + i * along_v[m - 1], start[k, m] + i * along_v[m]
                for j in range(along_v[m]):
                    other = min(j + 1 if m == 1 else 2 * j + 2, along_v[m - 1] - 1)
                    _join(node[before + step * j], node[before + other], 1, node[here + j])


@entry
def _gather(table):
    """Fill the windows of all levels from the single cells."""
    _fill(table)


@kernel
def _cell(lines, t, low):
    """The cell between lines in which a parameter lies; on a line the one above (`low`) or below."""
    first, last = 0, len(lines) - 1
    while last - first > 1:
        middle = (first + last) // 2
        if t > lines[middle] or (low and t == lines[middle]):
            first = middle
        else:
            last = middle
    return first


@kernel
def _window(lines, low, high):
    """Level and number of the smallest window that holds a range."""
    a, b = _cell(lines, low, True), _cell(lines, high, False)
    if b <= a:
        return 0, b
    level = 1
    while (b >> (level - 1)) - (a >> (level - 1)) > 1:
        level += 1
    return level, a >> (level - 1)


@kernel
def window(table, low_u, high_u, low_v, high_v):
    """Row of `table.node` that bounds a rectangle."""
    k, i = _window(table.u, low_u, high_u)
    m, j = _window(table.v, low_v, high_v)
    return table.start[k, m] + min(i, table.along_u[k] - 1) * table.along_v[m] + min(j, table.along_v[m] - 1)


@kernel
def twist_share(wide, high):
    """The k of a triangle that is as wide along u and along v as this: with it least is lost."""
    return high / wide if wide > 0.0 and high > 0.0 else 1.0


@kernel
def bend(row, share, du, dv):
    """Largest q of a step in the parameter plane: `1/8 q` bounds how far an edge is from its course. `share`: the k of the
    triangle."""
    uu, vv, uv = du * du, dv * dv, 2.0 * du * dv
    total = 0.0
    for c in range(3):
        total += (row[c] * uu + row[3 + c] * vv + row[6 + c] * uv) ** 2
    twist = row[11] * (share * uu + vv / share) if row[11] > 0.0 else 0.0
    return np.sqrt(total) + row[9] * uu + row[10] * vv + twist


@kernel
def most_inside(a, b, c):
    """Half the largest sum of `l_i l_j q_ij` over a triangle whose edges have q of a, b and c."""
    edge = 0.25 * max(a, max(b, c))
    across = 2.0 * (a * b + b * c + c * a) - a * a - b * b - c * c
    if across > 0.0 and a + b > c and b + c > a and c + a > b:
        edge = max(edge, a * b * c / across)
    return 0.5 * edge
