"""Between the samples: over which share of the target area do the postures found hold, each with its axis kept?

The argument and its assumptions are in `docs/between_samples.md`. Where a contact's posture does not serve its whole
cell, another one with more room to the local gouging bound is tried, then the cell is cut into four, until a budget of
contacts is spent.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import FaceGrid, Floats, Ints, SurfaceSamples
from plan_cutters.conditions import Conditions, search_postures
from plan_cutters.cutter import Cutter
from plan_cutters.reach import FREE, Reach, blank
from plan_cutters.threads import in_chunks

#: The patch about a node is at least half the way to its diagonal neighbours; some more, for cells that are bent.
_WIDER = 1.1
#: In a cell, the curvature tensor may differ from its node's this many times as much as half way to the next nodes.
_WILDER = 2.0
#: Room to the local gouging bound, in sines of tilt, that is asked of other postures, in turn: the smaller a cell, the
#: less is of use.
_ROOM = ((0.5,), (0.5, 0.2), (0.5, 0.2), (0.5, 0.2, 0.05))
#: A lean with a smaller sine has no direction.
_UPRIGHT = 1e-9
#: Times that a cell is cut into four, at most.
_LEVELS = 6

#: Surface points, normals, larger principal directions, curvatures (as in SurfaceSamples) of a face at parameters.
Evaluate = Callable[[int, Floats], tuple[Floats, ...]]


@dataclass(frozen=True, slots=True)
class Cells:
    """Cells of target faces that are served, each by one tool axis.

    Attributes
    ----------
    face : (m,) int32
    uv, span : (m, 2) float
        Middle and full extent in surface parameters; what of it lies in the trim counts.
    axis : (m, 3) float
        Unit tool axis `a`. At a contact with the normal n the cutter stands on the side that they give: its bottom
        centre lies from the contact along `n - (n.a) a`.
    """

    face: Ints
    uv: Floats
    span: Floats
    axis: Floats


@dataclass(frozen=True, slots=True)
class Between:
    """What of the target area is served.

    Attributes
    ----------
    share : float
        Of the area of the judged target samples' cells, 0 to 1, rounded down.
    contacts : int
        Contacts looked at, samples included.
    left : int
        Contacts whose cells are not served, when the budget or the levels ended.
    cells : Cells
    """

    share: float
    contacts: int
    left: int
    cells: Cells


@dataclass(slots=True)
class _Contacts:
    """Contacts on one face, each for a cell."""

    point: Floats
    normal: Floats
    direction_max: Floats
    curvature: Floats
    axis: Floats
    flat: NDArray[np.bool_]
    patch: Floats
    home: Ints
    middle: Floats
    span: Floats
    area: Floats

    def of(self, rows: NDArray[Any]) -> "_Contacts":
        return _Contacts(*(getattr(self, name)[rows] for name in self.__slots__))

    def __len__(self) -> int:
        return len(self.point)


def between(
    samples: SurfaceSamples,
    reach: Reach,
    cutter: Cutter,
    evaluate: Evaluate,
    conditions: Conditions,
    *,
    budget: int,
) -> Between:
    """Find the share of the target area over which a cutter's postures hold.

    Parameters
    ----------
    samples : SurfaceSamples
    reach : Reach
        Of the cutter.
    cutter : Cutter
    evaluate : callable
        Geometry of a face at parameters (n, 2).
    conditions : Conditions
    budget : int
        Most contacts to add to the samples.
    """
    tensor = _tensors(samples.normal, samples.direction_max, samples.curvature)
    judged = samples.unjudged < 0
    whole = float(samples.area[judged].sum())
    served, looked, left = 0.0, int(judged.sum()), 0
    found: list[Cells] = []
    for grid in samples.grids:
        radius, wobble = _cells(samples, grid, tensor)
        by_sample = np.full(len(samples), np.nan)
        by_sample[grid.index[grid.index >= 0]] = radius[grid.index >= 0]
        field = _Field(grid, samples, tensor, wobble, by_sample)
        on = (grid.index >= 0) & judged[grid.index]
        rows = grid.index[on]
        middle, span = (
            np.stack(np.broadcast_arrays(along_u[:, None], along_v[None, :]), axis=-1)[on]
            for along_u, along_v in zip(_tiles(grid.u, grid.closed_u), _tiles(grid.v, grid.closed_v), strict=True)
        )
        now = _Contacts(
            samples.point[rows], samples.normal[rows], samples.direction_max[rows], samples.curvature[rows],
            reach.axis[rows], reach.verdict[rows] == FREE, radius[on], np.argwhere(on).astype(np.int32),
            middle, span, samples.area[rows],
        )  # fmt: skip
        # A fair share of the budget for each face, by its samples.
        allowed = int(budget * len(rows) / max(1, int(judged.sum())))
        for level in range(_LEVELS + 1):
            good = _served(now, field, cutter, conditions, _ROOM[min(level, len(_ROOM) - 1)])
            served += float(now.area[good].sum())
            found.append(
                Cells(np.full(int(good.sum()), grid.face, np.int32), now.middle[good], now.span[good], now.axis[good])
            )
            now = now.of(~good)
            # Where the budget is short, the largest cells first, in the order of the grid.
            most = allowed // 4 if level < _LEVELS else 0
            chosen = np.sort(np.argsort(-now.area, kind="stable")[:most])
            left += len(now) - len(chosen)
            now = now.of(chosen)
            if not len(now):
                break
            now = _quarters(now, grid.face, evaluate, conditions)
            allowed -= len(now)
            looked += len(now)
    share = served / whole if whole > 0 else 0.0
    columns = ([getattr(cells, name) for cells in found] for name in Cells.__slots__)
    return Between(float(np.floor(1e6 * min(1.0, share + 1e-9)) / 1e6), looked, left,
                   Cells(*map(np.concatenate, columns)))  # fmt: skip


@dataclass(frozen=True, slots=True)
class _Field:
    """A face's grid and what is known of curvature at its nodes."""

    grid: FaceGrid
    samples: SurfaceSamples
    tensor: Floats
    wobble: Floats
    radius: Floats


def _served(
    contacts: _Contacts, field: _Field, cutter: Cutter, conditions: Conditions, rooms: Sequence[float]
) -> NDArray[np.bool_]:
    """Contacts whose posture, or another one, serves their cell; postures found on the way are kept."""
    good = np.zeros(len(contacts), bool)
    known = np.isfinite(contacts.axis).all(axis=1) & _whole(contacts)
    _cover(contacts, field, cutter, conditions, np.flatnonzero(known), good)
    for room in rooms:
        open_rows = np.flatnonzero(~good & _whole(contacts))
        # A posture with room to the local gouging bound: the search is told that the surface is more concave.
        curved = contacts.curvature + room / cutter.radius
        geometry = (contacts.point, contacts.normal, contacts.direction_max, curved)
        found, (safe, _) = blank(len(contacts)), conditions.depths
        search_postures(geometry, open_rows, cutter, conditions, (safe, safe), found)
        rows = open_rows[found.reached[open_rows]]
        if len(rows):
            contacts.axis[rows], contacts.flat[rows] = found.axis[rows], False
            _cover(contacts, field, cutter, conditions, rows, good)
    return good


def _cover(
    contacts: _Contacts, field: _Field, cutter: Cutter, conditions: Conditions, rows: NDArray[np.int64],
    good: NDArray[np.bool_],
) -> None:  # fmt: skip
    from plan_cutters.kernels.cover import cover

    samples, grid, obstacles = field.samples, field.grid, conditions.obstacles
    tensor = _tensors(contacts.normal, contacts.direction_max, contacts.curvature)
    safe, _ = conditions.depths
    closed = np.array([grid.closed_u, grid.closed_v])
    vertex, box, depth = obstacles.tree

    def work(piece: NDArray[np.int64]) -> None:
        cover(piece, contacts.point, contacts.normal, tensor, contacts.axis, contacts.flat, contacts.patch,
              contacts.home, grid.index, closed, samples.point, samples.normal, field.tensor, field.wobble, field.radius,
              grid.face, cutter.radius, cutter.length, safe, obstacles.triangles.chord_error, vertex, obstacles.faces,
              box, depth, good)  # fmt: skip

    in_chunks(work, rows, conditions.jobs)
    # A cell that is served touches no skin with any of its cutters: within a body are all of them or none.
    mine = rows[good[rows]]
    axis, normal = contacts.axis[mine], contacts.normal[mine]
    upright = (axis * normal).sum(axis=1)
    across = axis - upright[:, None] * normal
    sine = np.linalg.norm(across, axis=1)
    flat = contacts.flat[mine] | (sine < _UPRIGHT)
    lean = np.where(flat[:, None], contacts.direction_max[mine], across / np.where(flat, 1.0, sine)[:, None])
    tilt = np.where(flat, 0.0, np.arctan2(sine, upright))
    good[mine] = ~conditions.obstacles.holds(cutter, contacts.point[mine], normal, lean, tilt)


def _whole(contacts: _Contacts) -> NDArray[np.bool_]:
    """Contacts at which the surface could be evaluated."""
    columns = (contacts.point, contacts.normal, contacts.direction_max, contacts.curvature)
    return np.asarray(np.all([np.isfinite(column).all(axis=1) for column in columns], axis=0))


def _quarters(contacts: _Contacts, face: int, evaluate: Evaluate, conditions: Conditions) -> _Contacts:
    """Four contacts for each, in the middle of the quarters of its cell, that start from its posture."""
    step = 0.25 * contacts.span
    signs = np.array([[-1, -1], [-1, 1], [1, -1], [1, 1]])
    uv = (contacts.middle[:, None] + signs * step[:, None]).reshape(-1, 2)
    point, normal, direction, curvature = evaluate(face, uv)
    four = {name: np.repeat(getattr(contacts, name), 4, axis=0) for name in ("axis", "flat", "home")}
    # An interference-free contact leans nowhere: its quarters do so about their own normals, if the machine can.
    own = np.where(conditions.upright(normal)[:, None], normal, np.nan)
    four["axis"] = np.where(four["flat"][:, None], own, four["axis"])
    return _Contacts(point, normal, direction, curvature, middle=uv, span=np.repeat(0.5 * contacts.span, 4, axis=0),
                     patch=np.repeat(0.5 * contacts.patch, 4), area=np.repeat(0.25 * contacts.area, 4), **four)  # fmt: skip


def _tensors(normal: Floats, direction_max: Floats, curvature: Floats) -> Floats:
    """Second fundamental form (n, 3, 3) in part coordinates, 1/mm, concave positive."""
    across = np.cross(normal, direction_max)
    high, low = curvature[:, 0, None, None], curvature[:, 1, None, None]
    e1, e2 = direction_max[:, :, None], across[:, :, None]
    return np.asarray(high * e1 * e1.transpose(0, 2, 1) + low * e2 * e2.transpose(0, 2, 1))


def _cells(samples: SurfaceSamples, grid: FaceGrid, tensor: Floats) -> tuple[Floats, Floats]:
    """Radius (nu, nv) of the patch about each node, mm, nan where no neighbour tells it; and by sample, how far the
    curvature may differ in its cell, 1/mm, nan next to nodes without curvature."""
    on = grid.index >= 0
    point = np.where(on[..., None], samples.point[grid.index], np.nan)
    bend = tensor[grid.index].reshape(*on.shape, 9)
    wobble = np.zeros(on.shape)
    for axis, closed in ((0, grid.closed_u), (1, grid.closed_v)):
        differs = np.linalg.norm(_next(bend, axis, closed) - bend, axis=2)
        differs[~(on & (_next(on.astype(float), axis, closed) == 1))] = 0.0
        wobble += np.maximum(differs, np.roll(differs, 1, axis))
    by_sample = np.full(len(samples), np.nan)
    by_sample[grid.index[on]] = 0.5 * _WILDER * wobble[on]
    return _radius(point, grid), by_sample


def _tiles(line: Floats, closed: bool) -> tuple[Floats, Floats]:
    """Middles and spans of the cells along grid lines: half way to the next lines, or to the end."""
    ends = [line[:1], line[-1:]]
    if closed:
        half = 0.5 * (line[-1] - line[-2])  # the last line's next one is the first, a turn later
        ends = [line[:1] - half, line[-1:] + half]
    borders = np.concatenate([ends[0], 0.5 * (line[1:] + line[:-1]), ends[1]])
    return 0.5 * (borders[1:] + borders[:-1]), np.diff(borders)


def _next(field: Floats, axis: int, closed: bool) -> Floats:
    """Each node's next one along an axis; nan past the end of a grid that is not closed."""
    moved = np.roll(field, -1, axis)
    if not closed:
        moved[(-1,) if axis == 0 else (slice(None), -1)] = np.nan
    return moved


def _radius(point: Floats, grid: FaceGrid) -> Floats:
    """Half the largest distance to the diagonal neighbours; beyond an end of the face, as on this side of it."""
    ahead_u, ahead_v = _next(point, 0, grid.closed_u), _next(point, 1, grid.closed_v)
    sides = []
    for axis, ahead in ((0, ahead_u), (1, ahead_v)):
        gap = np.linalg.norm(ahead - point, axis=2)
        sides.append(np.fmax(gap, np.roll(gap, 1, axis)))
    straight = np.hypot(*sides)
    both = _next(ahead_u, 1, grid.closed_v)
    down = np.linalg.norm(both - point, axis=2)
    up = np.linalg.norm(ahead_u - ahead_v, axis=2)
    corners = [down, np.roll(down, (1, 1), (0, 1)), np.roll(up, 1, 0), np.roll(up, 1, 1)]
    longest = np.fmax(straight, np.fmax.reduce(corners))
    return np.asarray(0.5 * _WIDER * np.where(np.isfinite(straight), longest, np.nan))
