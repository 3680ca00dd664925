"""Where on a grid of labels do the boundaries run? Smooth parameter-plane curves between nodes of different label.

A face's labels are first made ready: cut where the face's own seam is, reaching to the face's bounds.

A boundary between labels k and k + 1 is first a chain of grid edges that it must cross (marching squares on a field
that knows only whole numbers, hence a staircase). Each crossing may slide along its own grid edge but not past its
ends, and slides to where the chain bends least: the staircase of a straight boundary becomes straight, and no node
changes sides. A cubic B-spline is then fitted to the chain.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve2d
from scipy.ndimage import distance_transform_edt, maximum_filter

from cad_io.arrays import FaceLabels, Floats, Ints, Record
from cad_io.face.trim import nodes_inside, outline
from cad_io.kernel import edges_of

#: Share of its allowed stretch that a crossing keeps from either end, so that curves of two levels stay apart.
MARGIN = 0.1
#: Steps of the accelerated descent; they straighten stairs up to about 40 cells long.
STEPS = 300
#: Curves reach this many cells past the last node on the face: over the trim, but not across a whole hole.
REACH = 2


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class LabelGrid(Record):
    """A filled label field ready to be contoured."""

    #: (nu + closed,) and (nv + closed,); along u and v; a closed direction repeats its first line one period later.
    lines: tuple[Floats, Floats]
    #: (nu, nv); labels, known everywhere.
    field: Ints
    #: (nu, nv); nodes within REACH cells of a node on the face.
    near: NDArray[np.bool_]
    #: Of u and v: the last line's neighbour is the first one.
    closed: tuple[bool, bool]


class Line(NamedTuple):
    """Points x (n, 2) in cells, where a boundary crosses grid edges; closed: the last one is followed by the first."""

    x: Floats
    closed: bool


class Spline(NamedTuple):
    """Cubic curve in (u, v): clamped knots (m + 4,) and poles (m, 2); closed if it ends where it starts."""

    knots: Floats
    poles: Floats
    closed: bool


class _Chain(NamedTuple):
    """Crossings in order: x = base + t * step in cells, lo <= t <= hi; `turn` is what closing the chain adds to x."""

    base: Floats
    step: Floats
    lo: Floats
    hi: Floats
    closed: bool
    turn: Floats


def fill(label: Ints) -> Ints:
    """Unknown nodes (-1) take the label of the nearest known node, counted in cells. At least one must be known."""
    nearest = distance_transform_edt(label < 0, return_distances=False, return_indices=True)
    return np.asarray(label[tuple(nearest)], np.int32)


def without_specks(field: Ints, closed: Sequence[bool]) -> Ints:
    """The field without islands of a single node: too small for a smooth boundary.

    Levels are cleared one by one, high islands first, so that the result does not depend on the order of nodes.
    """
    out = np.zeros_like(field)
    low = int(field.min())
    along_u, along_v = ("wrap" if each else "constant" for each in closed)  # beyond the border is nobody
    for k in range(low, int(field.max())):
        above = field > k
        for value in (True, False):
            same = above == value
            u, v = np.pad(same, ((1, 1), (0, 0)), along_u), np.pad(same, ((0, 0), (1, 1)), along_v)  # type: ignore[call-overload]
            above ^= same & ~(u[2:] | u[:-2] | v[:, 2:] | v[:, :-2])
        out += above
    return out + low


def smoothed(grids: Sequence[LabelGrid]) -> list[list[Line]]:
    """Lines along all label boundaries of each grid, cut at the seams of closed directions; none for a field of one label.

    All grids together, because that costs little more than one: each line is what it would be alone.
    """
    chains = [
        [chain for k in range(int(grid.field.min()), int(grid.field.max())) for chain in _chains(grid, k)] for grid in grids
    ]
    along = iter(_relaxed([chain for mine in chains for chain in mine]))
    return [
        [line for chain in mine for line in _cut(chain, chain.base + next(along)[:, None] * chain.step, grid)]
        for grid, mine in zip(grids, chains, strict=True)
    ]


def curves(grid: LabelGrid, lines: Sequence[Line], fit: float) -> list[Spline]:
    """Curves along lines of a grid, in surface parameters, inside the rectangle of the grid lines.

    A curve ends on that rectangle, on a seam or REACH cells off the face; else it is closed. fit: root mean square distance
    between curve and line that the fit may leave, cells.
    """
    shape = np.array(grid.field.shape, float)
    axes = grid.lines
    corner = np.array([g[0] for g in axes])
    cell = np.array([(g[-1] - g[0]) / (len(g) - 1) for g in axes])
    out = []
    for line in lines:
        piece = np.vstack([line.x, line.x[:1]]) if line.closed else line.x.copy()
        for a, is_closed in enumerate(grid.closed):
            if is_closed:
                piece[:, a] -= np.floor(piece[:, a].mean() / shape[a]) * shape[a]
        uv = np.stack([np.interp(piece[:, a], np.arange(len(g)), g) for a, g in enumerate(axes)], axis=1)
        knots, poles = _fitted((uv - corner) / cell, line.closed, fit)
        # The curve lies in the hull of its poles: clipped poles keep it on the surface's own domain.
        poles = np.clip(poles * cell + corner, corner, [g[-1] for g in axes])
        out.append(Spline(knots, poles, line.closed))
    return out


def _chains(grid: LabelGrid, k: int) -> list[_Chain]:
    """Crossings of the boundary between `<= k` and `> k`, linked in order."""
    nu, nv = grid.field.shape
    value = np.pad(grid.field, [(0, int(each)) for each in grid.closed], mode="wrap")
    above = value > k
    # Numbers of the grid edges: along u first, then along v; those on a repeated line get the first line's number.
    iu, ju = np.indices((value.shape[0] - 1, value.shape[1]))
    iv, jv = np.indices((value.shape[0], value.shape[1] - 1))
    along_u = iu * nv + ju % nv
    along_v = value.size + (iv % nu) * nv + jv

    a, b, c, d = above[:-1, :-1], above[1:, :-1], above[1:, 1:], above[:-1, 1:]
    sides = np.stack([along_u[:, :-1], along_v[1:], along_u[:, 1:], along_v[:-1]], axis=-1)  # bottom, right, top, left
    crossed = np.stack([a ^ b, b ^ c, d ^ c, a ^ d], axis=-1)
    count = crossed.sum(-1)
    plain = sides[count == 2][crossed[count == 2]].reshape(-1, 2)
    saddle = count == 4
    joined = (value[:-1, :-1] + value[1:, :-1] + value[1:, 1:] + value[:-1, 1:])[saddle] > 4 * k + 2
    order = np.where((a[saddle] == joined)[:, None], [0, 1, 2, 3], [0, 3, 2, 1])  # cut off b and d, or a and c
    segments = np.concatenate([plain, np.take_along_axis(sides[saddle], order, axis=1).reshape(-1, 2)])

    out = []
    for ids, closed in _linked(segments):
        is_u = ids < value.size
        i, j = np.divmod(np.where(is_u, ids, ids - value.size), nv)
        step = np.stack([is_u, ~is_u], axis=1).astype(float)
        first = grid.field[i, j]
        second = value[i + is_u, j + ~is_u]
        ends = np.sort(np.stack([(k - first) / (second - first), (k + 1 - first) / (second - first)]), axis=0)
        middle = np.stack([i, j], axis=1) + 0.5 * step
        for axis, is_closed in enumerate(grid.closed):
            if is_closed:
                middle[:, axis] = np.unwrap(middle[:, axis], period=grid.field.shape[axis])
        turn = np.zeros(2)
        if closed:
            turn = np.round((middle[-1] - middle[0]) / (nu, nv)) * (nu, nv) * grid.closed
        spare = MARGIN * (ends[1] - ends[0])
        out.append(_Chain(middle - 0.5 * step, step, ends[0] + spare, ends[1] - spare, closed, turn))
    return out


def _linked(segments: NDArray[np.int64]) -> list[tuple[NDArray[np.int64], bool]]:
    """Chains of the numbers that pairs share (each in at most two pairs): (numbers, closed), open ones first."""
    ids, where = np.unique(segments, return_inverse=True)
    neighbours = np.full((len(ids), 2), -1)
    for a, b in where.reshape(-1, 2).tolist():
        neighbours[a, int(neighbours[a, 0] >= 0)] = b
        neighbours[b, int(neighbours[b, 0] >= 0)] = a
    links = neighbours.tolist()
    used = [False] * len(ids)
    out = []
    for start in [*np.flatnonzero(neighbours[:, 1] < 0).tolist(), *range(len(ids))]:
        if used[start]:
            continue
        closed = links[start][1] >= 0
        chain = []
        at = start
        while at >= 0 and not used[at]:
            used[at] = True
            chain.append(at)
            following, behind = links[at]
            at = following if following >= 0 and not used[following] else behind
        out.append((ids[chain], closed))
    return out


def _relaxed(chains: list[_Chain]) -> list[Floats]:
    """Positions t of all crossings that make the sum of squared second differences small, by projected fast descent."""
    if not chains:
        return []
    sizes = [len(c.base) for c in chains]
    last = np.cumsum(sizes) - 1
    first = last - np.array(sizes) + 1
    total = int(last[-1]) + 1
    base, step = np.concatenate([c.base for c in chains]), np.concatenate([c.step for c in chains])
    lo, hi = np.concatenate([c.lo for c in chains]), np.concatenate([c.hi for c in chains])
    before, after = np.arange(total) - 1, np.arange(total) + 1
    jump = np.zeros((total, 2))  # what the neighbours' sum lacks at the ends of closed chains
    free_end = np.zeros(total, bool)
    for f, l, c in zip(first.tolist(), last.tolist(), chains, strict=True):
        before[f], after[l] = (l, f) if c.closed else (f, l)
        free_end[[f, l]] = not c.closed
        jump[f] -= c.turn
        jump[l] += c.turn
    # Each coordinate is an array of its own, and neighbours are a shift and the ends put right: fancy indexing costs most.
    inner, has_before, has_after = ~free_end, before != np.arange(total), after != np.arange(total)
    ends = np.union1d(first, last)
    coordinates = list(zip(base.T.copy(), step.T.copy(), jump.T.copy(), strict=True))

    def neighbours(x: Floats) -> tuple[Floats, Floats]:
        behind, beyond = np.empty_like(x), np.empty_like(x)
        behind[1:], beyond[:-1] = x[:-1], x[1:]
        behind[ends], beyond[ends] = x[before[ends]], x[after[ends]]
        return behind, beyond

    t = 0.5 * (lo + hi)
    extrapolated, momentum = t.copy(), 1.0
    for _ in range(STEPS):
        gradient = np.zeros(total)
        for at, way, turn in coordinates:
            x = at + extrapolated * way
            behind, beyond = neighbours(x)
            bend = (behind + beyond + turn - 2 * x) * inner
            behind, beyond = neighbours(bend)
            gradient += (behind * has_before + beyond * has_after - 2 * bend) * way
        new = np.clip(extrapolated - gradient / 16, lo, hi)  # 16: the largest curvature of the sum
        following = 0.5 * (1 + np.sqrt(1 + 4 * momentum * momentum))
        extrapolated = np.clip(new + (momentum - 1) / following * (new - t), lo, hi)
        t, momentum = new, following
    return np.split(t, last[:-1] + 1)


def _cut(chain: _Chain, x: Floats, grid: LabelGrid) -> list[Line]:
    """Parts of a chain that lie near the face and do not cross a seam."""
    node = np.round(chain.base).astype(int) % grid.field.shape
    near = grid.near[node[:, 0], node[:, 1]]
    seam = np.zeros(len(x), bool)
    for axis, is_closed in enumerate(grid.closed):
        if is_closed:
            seam |= (node[:, axis] == 0) & (chain.step[:, axis] == 0)
    if chain.closed:
        if near.all() and not seam.any():
            return [Line(x, True)]
        start = int(np.argmax(seam | ~near))
        order = np.r_[start : len(x), 0 : start + 1]
        shift = np.where((np.arange(len(order)) >= len(x) - start)[:, None], chain.turn, 0.0)
        x, near, seam = x[order] + shift, near[order], seam[order]
    out = []
    begin = 0
    for i in range(len(x)):
        ends = not near[i] or seam[i] or i == len(x) - 1
        if not ends:
            continue
        stop = i + 1 if near[i] else i
        if stop - begin >= 2:
            out.append(Line(x[begin:stop], False))
        begin = i if near[i] else i + 1
    return out


def _fitted(points: Floats, closed: bool, fit: float) -> tuple[Floats, Floats]:
    """Clamped cubic through the ends of a chain and close to the rest: knots and poles. Lengths in cells."""
    from scipy.interpolate import BSpline, make_interp_spline, splprep  # half a second to load

    while len(points) < 5:  # a cubic needs four points, a closed one five
        halves = 0.5 * (points[1:] + points[:-1])
        points = np.insert(points, np.arange(1, len(points)), halves, axis=0)
    weight = np.ones(len(points))
    if not closed:
        weight[[0, -1]] = 100
    for tolerance in (fit, fit / 2, fit / 4, 0.0):
        (knots, poles, _), t = splprep(points.T, w=weight, s=len(points) * tolerance**2, k=3, per=closed, quiet=2)
        curve = BSpline(knots, np.stack(poles, axis=1), 3)
        if np.abs(curve(t) - points).max() < 3 * fit:
            break
    # A periodic fit runs over its ends; the same piecewise cubic on clamped knots, found by interpolation, does not.
    clamped = np.concatenate([[knots[3]] * 4, knots[4:-4], [knots[-4]] * 4])
    result = np.convolve(clamped[1:-1], np.ones(3) / 3, mode="valid")
    poles = make_interp_spline(result, curve(result), k=3, t=clamped).c
    poles[0], poles[-1] = points[0], points[-1]
    if closed:
        poles[0] = poles[-1] = curve(knots[3])
    return clamped, poles


#: Curves may end this far past the trim, cells: an end exactly on it could miss the edge it should cut.
_OVER = 0.25


def label_grid(face: Any, labels: FaceLabels) -> tuple[LabelGrid, Ints, NDArray[np.bool_]]:
    """Contourable grid of a face, of labels with at least one node known; ValueError where the face has no border.

    Returns the grid, whose field holds ranks of the labels that occur, so that absent labels make no boundary; the labels (nu,
    nv) at its nodes, -1 where unknown; and which (nu, nv) known nodes were islands of one node and went to their surroundings.
    """
    segments = outline(face)
    if not len(segments):
        raise ValueError("the face has no border")
    low, high = segments.min(axis=(0, 1)), segments.max(axis=(0, 1))
    surface = BRep_Tool.Surface_s(face)
    u0, u1, v0, v1 = surface.Bounds()
    u_period = surface.UPeriod() if surface.IsUPeriodic() else u1 - u0 if surface.IsUClosed() else 0.0
    v_period = surface.VPeriod() if surface.IsVPeriodic() else v1 - v0 if surface.IsVClosed() else 0.0
    # Sides of the parameter plane that are a point in space: (0 for u or 1 for v, the side's parameter).
    poles = []
    for edge in edges_of(face):
        if BRep_Tool.Degenerated_s(edge):
            curve = BRepAdaptor_Curve2d(edge, face)
            start, stop = (curve.Value(t).Coord() for t in (curve.FirstParameter(), curve.LastParameter()))
            axis = int(abs(start[1] - stop[1]) < abs(start[0] - stop[0]))
            poles.append((axis, float(start[axis])))
    over = 0.0 if poles else _OVER

    label, lines, closed = labels.label, [], []
    directions = ((labels.u, u_period, surface.IsUPeriodic(), u0, u1), (labels.v, v_period, surface.IsVPeriodic(), v0, v1))
    for axis, (line, period, periodic, first, last) in enumerate(directions):
        cell = (line[-1] - line[0]) / (len(line) - 1)
        if period and line[-1] - line[0] + 1.5 * cell > period:
            start = low[axis]
            if not periodic:
                start = first
            elif high[axis] - low[axis] < period - 1e-6 * period:
                start = 0.5 * (low[axis] + high[axis] - period)  # the middle of what the face leaves out
            line, label = _from_seam(line, label, axis, float(start), period)
            closed.append(True)
        else:
            if not periodic:
                reach = max(low[axis] - over * cell, first), min(high[axis] + over * cell, last)
            else:
                reach = low[axis] - over * cell, high[axis] + over * cell
            line, label = _reaching(line, label, axis, reach)
            closed.append(False)
        lines.append(line)

    ranks = np.unique(label[label >= 0])
    ranked = np.searchsorted(ranks, fill(label)).astype(np.int32)
    field = ranked.copy()
    for axis, at in poles:
        # One point in space has one label: curves that met in it would not be joined to it by the kernel.
        i = int(np.argmin(np.abs(lines[axis][: label.shape[axis]] - at)))
        row = np.moveaxis(field, axis, 0)
        row[i] = np.bincount(row[i]).argmax()
    despeckled = without_specks(field, closed)
    modes = ["wrap" if c else "nearest" for c in closed]
    on_face = (label >= 0) | nodes_inside(segments, *(line[:n] for line, n in zip(lines, label.shape, strict=True)))
    near = maximum_filter(on_face.astype(np.uint8), size=2 * REACH + 1, mode=modes) > 0
    dropped = (despeckled != field) & (label >= 0)
    return LabelGrid((lines[0], lines[1]), despeckled, near, (closed[0], closed[1])), label, dropped


def _from_seam(line: Floats, label: Ints, axis: int, start: float, period: float) -> tuple[Floats, Ints]:
    """Grid of a closed direction that begins with a line on its seam and ends with the same line a period on."""
    near = 1e-3 * period / len(line)
    if line[-1] - line[0] > period - near:
        line, label = line[:-1], np.delete(label, -1, axis)
    offset = (line - start) % period
    offset[offset > period - near] = 0.0
    order = np.argsort(offset)
    offset, label = offset[order], np.take(label, order, axis)
    if offset[0] > near:
        twin = 0 if offset[0] < period - offset[-1] else -1
        offset = np.insert(offset, 0, 0.0)
        label = np.insert(label, 0, np.take(label, twin, axis), axis)
    offset[0] = 0.0
    return start + np.append(offset, period), label


def _reaching(line: Floats, label: Ints, axis: int, ends: tuple[float, float]) -> tuple[Floats, Ints]:
    """Grid of an open direction that covers the ends: its outer lines are moved there if near, else doubled."""
    line = line.copy()
    cell = (line[-1] - line[0]) / (len(line) - 1)
    for at, end, gap in ((0, ends[0], line[0] - ends[0]), (-1, ends[1], ends[1] - line[-1])):
        if 0 < gap <= 0.5 * cell:
            line[at] = end
        elif gap > 0.5 * cell:
            where = 0 if at == 0 else len(line)
            line = np.insert(line, where, end)
            label = np.insert(label, where, np.take(label, at, axis), axis)
    return line, label
