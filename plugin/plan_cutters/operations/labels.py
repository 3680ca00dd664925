"""Which operation each sample goes with, so that cutting and the overlap at borders take little time, in few steps.

A border between two operations is cut twice, over the width of the overlap: what that costs is weighed against what each sample
costs with each operation. The sum is made small by alpha expansion: for one operation after the other, a least cut says which
samples change to it (Boykov, Veksler, Zabih 2001). An operation that does not serve a sample costs too much to be ever taken.

A machinist sets fewer steps: a border on a face of free form is a mark there, and nobody sets up a step of a few seconds whose
samples another step serves as well. Each sample goes only with a step that serves it. What no other step serves, and what takes
less than a second, is no step at all where the plan leaves something anyway: it is left, by name.
"""

import math
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from heapq import heapify, heappop, heappush
from itertools import cycle, islice

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import breadth_first_order, maximum_flow

from cad_io.arrays import Floats, Ints, SurfaceSamples, cross
from cad_io.graphs import connected
from plan_cutters.domain.kinematics import angle_about
from plan_cutters.domain.preference import is_bent
from plan_cutters.scene.preparation import Prepared

Rows = NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class Seams:
    """Pairs of neighbouring samples, and the border between the areas of each two.

    `edge` (e, 2) int. `length` (e,) float, mm: about the side of the areas of the two. `shows` (e,) bool: both lie on one face
    that is bent in both directions: two operations leave a mark there.
    """

    edge: Ints
    length: Floats
    shows: NDArray[np.bool_]

    @classmethod
    def of(cls, ready: Prepared) -> "Seams":
        """Those of all samples of a part."""
        samples, edge = ready.samples, ready.samples.neighbours
        face, area = samples.face[edge], np.nan_to_num(samples.area)
        bent = np.isin(face, sampled_faces(ready, is_bent))
        return cls(edge, np.sqrt(0.5 * area[edge].sum(axis=1)), (face[:, 0] == face[:, 1]) & bent.all(axis=1))

    def marks(self, label: Ints) -> float:
        """The length of the borders that show, mm, where samples (n,) go with these operations, -1 for none."""
        one, other = label[self.edge.astype(np.int64)].T
        return float(self.length[self.shows & (one != other) & (one >= 0) & (other >= 0)].sum())

    def among(self, stands_for: Rows) -> "Seams":
        """Those between fewer samples: `stands_for` (n,) has which of these stands for each, -1 for none."""
        one, other = np.sort(stands_for[self.edge.astype(np.int64)], axis=1).T
        apart = (one >= 0) & (one != other)
        every = np.column_stack([one, other, self.shows])[apart]
        pair, which = np.unique(every, axis=0, return_inverse=True)
        length = np.bincount(which.reshape(-1), self.length[apart], len(pair))
        return Seams(pair[:, :2], np.asarray(length, float), pair[:, 2] > 0)


def sampled_faces(ready: Prepared, shaped: Callable[[str], bool]) -> Rows:
    """Numbers of the faces of a part with samples that have some shape, ascending."""
    faces = ready.scene.part.faces
    return np.array([face for face in np.unique(ready.samples.face).tolist() if shaped(faces[face - 1].shape)], np.int64)


#: A face goes round a rotary axis where its normals turn about it by more than this, rad: one orientation cuts no more of it.
_ROUND = math.radians(120.0)
#: How far a face of revolution is off its axis, as a share of its size.
_OFF_AXIS = 1e-6


def flowing_faces(ready: Prepared) -> Rows:
    """Numbers of the faces that a machine cuts while its axes turn, ascending.

    They are those of free form, and, of a machine with one axis that turns the tool, those of revolution that go round a line
    along it, as on a lathe.
    """
    free_form = sampled_faces(ready, "sculptured".__eq__)
    machines = [each.kinematics.turning()[0] for each in ready.setups if each.kinematics is not None]
    directions = [each.direction[0] for each in machines if len(each.direction) == 1]
    others = np.setdiff1d(np.unique(ready.samples.face), free_form) if directions else free_form[:0]
    round_ = [face for face in others.tolist() if any(_goes_round(ready.samples, face, each) for each in directions)]
    return np.union1d(free_form, np.array(round_, np.int64))


def _goes_round(samples: SurfaceSamples, face: int, direction: Floats) -> bool:
    """Whether a face is one of revolution about a line along a direction, and goes round it."""
    mine = samples.face == face
    point, normal = samples.point[mine], samples.normal[mine]
    across = cross(np.broadcast_to(direction, normal.shape), normal)
    known = np.isfinite(across).all(axis=1) & (np.linalg.norm(across, axis=1) > _OFF_AXIS)
    point, normal, across = point[known], normal[known], across[known]
    if len(point) < 3:
        return False
    # All normals meet the line: their planes with it hold a point of it.
    middle = point.mean(axis=0)
    away = ((point - middle) * across).sum(axis=1)
    off = across @ np.linalg.lstsq(across, away, rcond=1e-9)[0] - away
    turn = np.sort(angle_about(direction, across[0], across))
    gap = float(np.diff(np.append(turn, turn[0] + 2.0 * math.pi)).max())
    return bool(np.abs(off).max() <= _OFF_AXIS * float(np.ptp(point, axis=0).max()) and 2.0 * math.pi - gap > _ROUND)


#: The largest whole number of a capacity of a cut; sums of some of them must not pass 2^31.
_MOST = 2**28
#: Rounds over all operations.
_ROUNDS = 5


def labelled(cost: Floats, edge: Ints, border: Floats) -> Ints:
    """Choose an operation for each sample.

    `cost` (n, k) float: of cutting each sample with each operation; infinite where the operation does not serve it. `edge` (e, 2)
    int: pairs of neighbouring samples. `border` (e,) float: what it costs if the two have different operations, in the same unit.
    Returns (n,) int32: index of the operation, -1 where none serves the sample: never one that does not serve it.
    """
    served = np.isfinite(cost).any(axis=1)
    label = np.full(len(cost), -1, np.int32)
    rows = np.flatnonzero(served)
    if not len(rows):
        return label
    at = np.full(len(cost), -1, np.int64)
    at[rows] = np.arange(len(rows))
    inner = (at[edge] >= 0).all(axis=1)
    pair, weight, price = at[edge[inner]], border[inner], cost[rows]
    cheapest = price.argmin(axis=1)
    # Costs as whole numbers: the largest that a cut can need stays below _MOST.
    largest = float(price[np.isfinite(price)].max()) + float(np.bincount(pair.ravel(), np.repeat(weight, 2)).max(initial=0.0))
    scale = 0.25 * _MOST / max(largest, 1e-300)
    units, sides = (
        np.where(np.isfinite(price), np.rint(price * scale), _MOST).astype(np.int64),
        np.rint(weight * scale).astype(np.int64),
    )
    least, since = _energy(units, pair, sides, cheapest), 0
    # An operation is tried again only where another has changed something since.
    for operation in islice(cycle(range(price.shape[1])), _ROUNDS * price.shape[1]):
        tried = _expanded(units, pair, sides, cheapest, operation)
        energy = _energy(units, pair, sides, tried)
        since += 1
        if energy < least:
            cheapest, least, since = tried, energy, 1
        if since == price.shape[1]:
            break
    label[rows] = cheapest
    assert np.isfinite(cost[rows, cheapest]).all(), "an operation that does not serve a sample was chosen"
    return label


def _energy(units: NDArray[np.int64], pair: NDArray[np.int64], sides: NDArray[np.int64], label: NDArray[np.int64]) -> int:
    parted = label[pair[:, 0]] != label[pair[:, 1]]
    return int(units[np.arange(len(label)), label].sum() + sides[parted].sum())


def _expanded(
    units: NDArray[np.int64], pair: NDArray[np.int64], sides: NDArray[np.int64], label: NDArray[np.int64], operation: int
) -> NDArray[np.int64]:
    """The best labels of which each is kept or becomes one operation."""
    # Only what may change is in the cut: beside what stays, a pair is a cost of the one sample alone.
    may = (label != operation) & (units[:, operation] < _MOST)
    open_, at = np.flatnonzero(may), np.cumsum(may) - 1
    if not len(open_):
        return label
    i, j = pair.T
    change = units[open_, operation] - units[open_, label[open_]]
    apart = np.where(label[i] != label[j], sides, 0)
    for mine, other in ((i, j), (j, i)):
        alone = may[mine] & ~may[other]
        then = np.where(label[other[alone]] != operation, sides[alone], 0)
        np.add.at(change, at[mine[alone]], then - apart[alone])
    both = may[i] & may[j]
    # With x = 1 where a sample changes, such a pair costs apart + x_i (side - apart) - x_j side + (1 - x_i) x_j (2 side - apart).
    i, j, side, apart = at[i[both]], at[j[both]], sides[both], apart[both]
    np.add.at(change, i, side - apart)
    np.add.at(change, j, -side)
    change = np.clip(change, -_MOST, _MOST)
    source = len(open_)
    sink = source + 1
    up, down = np.flatnonzero(change > 0), np.flatnonzero(change < 0)
    tail = np.concatenate([np.full(len(up), source), down, i])
    head = np.concatenate([up, np.full(len(down), sink), j])
    size = np.concatenate([change[up], -change[down], np.minimum(2 * side - apart, _MOST)]).astype(np.int32)
    graph = coo_array((size, (tail, head)), shape=(sink + 1, sink + 1)).tocsr()
    flow = maximum_flow(graph, source, sink).flow
    residual = (graph - flow).tocsr()
    residual.data[residual.data < 0] = 0
    residual.eliminate_zeros()
    result = label.copy()
    changed = np.ones(sink + 1, bool)
    changed[breadth_first_order(residual, source, return_predecessors=False)] = False
    result[open_[changed[:source]]] = operation
    return result


def pieces(label: Ints, edge: Ints) -> Ints:
    """Connected samples of one operation (n,), numbered from 0; -1 where there is none."""
    same = (label[edge[:, 0]] == label[edge[:, 1]]) & (label[edge[:, 0]] >= 0)
    components = connected(len(label), edge[same])
    number = np.full(len(label), -1, np.int32)
    mine = label >= 0
    number[mine] = np.unique(components[mine], return_inverse=True)[1]
    return number


def regions_of(label: Ints, edge: Ints, area: Floats) -> Ints:
    """Number (n,) the connected samples of one operation from 0, by operation, the largest first; -1 where there is none."""
    number = pieces(label, edge)
    mine = number >= 0
    size = np.bincount(number[mine], area[mine])
    first = np.unique(number[mine], return_index=True)[1]
    order = np.lexsort((first, -size, label[mine][first]))
    place = np.append(np.argsort(order), -1).astype(np.int32)
    return np.asarray(place[number])


def joined(label: Ints, serves: NDArray[np.bool_], edge: Ints, area: Floats, least: float) -> Ints:
    """Let pieces smaller than an area go over to a neighbouring operation that serves all of them, where there is one.

    The smallest goes first. Pieces that no neighbour serves stay: they are listed as they are.
    """
    label, number = label.copy(), pieces(label, edge)
    mine = number >= 0
    size = np.bincount(number[mine], area[mine]).tolist()
    ends = np.cumsum(np.bincount(number[mine]))[:-1]
    rows_of = [each.tolist() for each in np.split(np.flatnonzero(mine)[np.argsort(number[mine], kind="stable")], ends)]
    both = np.concatenate([edge, edge[:, ::-1]])
    adjacency = coo_array((np.ones(len(both), np.int8), both.T), shape=(len(label), len(label))).tocsr()
    neighbours, starts = adjacency.indices.tolist(), adjacency.indptr.tolist()
    waiting = [(each, piece) for piece, each in enumerate(size) if each < least]
    heapify(waiting)
    while waiting:
        known, piece = heappop(waiting)
        # What another piece has joined has another size, or none.
        if known != size[piece]:
            continue
        # Most pieces are a sample or two, for which arrays would take ten times as long.
        rows = rows_of[piece]
        others = [(label.item(k), number.item(k)) for row in rows for k in neighbours[starts[row] : starts[row + 1]]]
        others = [(its, other) for its, other in others if its >= 0 and other != piece]
        touching = Counter(its for its, _ in others)
        to = next((each for each in sorted(touching, key=lambda own: (-touching[own], own)) if serves[rows, each].all()), -1)
        if to < 0:
            continue
        into = sorted({other for its, other in others if its == to})
        whole = max(into, key=lambda each: len(rows_of[each]))
        for each in [piece, *into]:
            if each != whole:
                number[rows_of[each]] = whole
                rows_of[whole] += rows_of[each]
                size[whole], size[each] = size[whole] + size[each], -1.0
        label[rows] = to
        # Those beside it may have somewhere to go now.
        for each in {whole, *(other for _, other in others)}:
            if 0.0 <= size[each] < least:
                heappush(waiting, (size[each], each))
    return label


#: A step of less than this share of the area, or of less than so many seconds, is joined to others where that costs nothing.
MINOR_SHARE, MINOR_SECONDS = 0.01, 5.0
#: A step of less area, mm2, or of less time, s, and less than a share of the area, is none where something is left anyway.
LEAST_AREA, LEAST_SECONDS, LEAST_SHARE = 0.1, 1.0, 0.001
#: A step that serves so much of a face of free form takes it, where that costs no more than this share of the face's time.
WHOLE_FACE, _MORE = 0.95, 0.1
#: A fixed step takes it in place of simultaneous motion at so much more of the time that the face takes in motion.
_RATHER_FIXED = 0.25
#: Seconds that count as nothing.
_NOTHING = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class Steps:
    """Steps that samples may go with.

    `cost` (n, k) float: of each sample with each step, s, or mm without a feed; infinite where the step does not serve the
        sample, or may not.
    `group` (k,) int: steps of one number are images of each other: to a machinist one step.
    `free` (k,) bool: whether a step was planned: a person's own keeps its samples, and takes no others.
    `moving` (k,) bool: whether it is simultaneous motion, which takes no step of a large area that a fixed orientation cuts.
    `area` (n,) float: of the samples, mm2.
    `timed`: whether costs are seconds.
    `spent`: what some steps, by their numbers, take besides cutting: orientations, changes of cutters and setups.
    """

    cost: Floats
    group: NDArray[np.int64]
    free: NDArray[np.bool_]
    moving: NDArray[np.bool_]
    area: Floats
    timed: bool
    spent: Callable[[tuple[int, ...]], float]

    def cutting(self, number: Ints, rows: Rows | None = None) -> float:
        """Sum up what samples, or some (m,), cost with the steps (n,) that they go with; what is not known is not counted."""
        rows = np.flatnonzero(number >= 0) if rows is None else rows
        cost = self.cost[rows, number[rows]]
        return float(cost[np.isfinite(cost)].sum())

    def total(self, number: Ints) -> float:
        """The same with what the steps that are used take besides."""
        return self.cutting(number) + self.spent(tuple(np.unique(number[number >= 0]).tolist()))

    def minor(self, number: Ints) -> Iterator[Rows]:
        """The samples of each group of planned steps of little area or time, the smallest first."""
        mine = np.flatnonzero(number >= 0)
        groups = self.group[number[mine]]
        parts = [mine[groups == each] for each in np.unique(groups[self.free[number[mine]]]).tolist()]
        least = MINOR_SHARE * self.area[mine].sum()
        for rows in sorted(parts, key=lambda rows: (float(self.area[rows].sum()), len(rows))):
            if self.area[rows].sum() < least or (self.timed and self.cutting(number, rows) < MINOR_SECONDS):
                yield rows

    def negligible(self, number: Ints, rows: Rows, more: float) -> bool:
        """Whether some samples (m,) are no step by themselves, with so much area, mm2, that is none already."""
        area, whole = float(self.area[rows].sum()) + more, float(self.area[number >= 0].sum())
        # To move all axes for so little of the area is no step however long it takes.
        short = self.moving[number[rows]].all() or (self.timed and self.cutting(number, rows) < LEAST_SECONDS)
        return area < LEAST_AREA or (bool(short) and area < LEAST_SHARE * whole)


def in_one_step(steps: Steps, number: Ints, face: Ints, free_form: Sequence[int]) -> Ints:
    """Let faces of free form go into one step each, where one serves nearly all of what is cut of it at little more time.

    `number` (n,) int32: the step that each sample goes with, -1 for none. `face` (n,) int: the face of each sample. `free_form`:
    numbers of the faces of free form. Returns (n,) int32: as `number`.
    """
    for each in free_form:
        rows = np.flatnonzero((face == each) & (number >= 0))
        rows = rows[steps.free[number[rows]]]
        if len(np.unique(steps.group[number[rows]])) < 2:
            continue
        serves, area = np.isfinite(steps.cost[rows]), steps.area[rows]
        able = (area @ serves >= WHOLE_FACE * area.sum()) & steps.free
        if area.sum() < MINOR_SHARE * steps.area[number >= 0].sum():
            able &= ~steps.moving
        tried = {False: (math.inf, number), True: (math.inf, number)}
        for k in np.flatnonzero(able).tolist():
            then, moving = number.copy(), bool(steps.moving[k])
            then[rows[serves[:, k]]] = k
            if (total := steps.total(then)) < tried[moving][0]:
                tried[moving] = total, then
        own, (fixed, still), (in_motion, then) = steps.cutting(number, rows), tried[False], tried[True]
        most = steps.total(number) + _MORE * own
        if in_motion <= most:
            # Nobody moves all axes where one orientation will do at a little more.
            most = max(most, in_motion + _RATHER_FIXED * steps.cutting(then, rows))
        if fixed <= most:
            number = still
        elif in_motion <= most:
            number = then
    return number


def without_minor_steps(steps: Steps, number: Ints, *, incomplete: bool) -> Ints:
    """Join minor steps to others that serve their samples, where the plan takes no more time then.

    `number` (n,) int32: the step that each sample goes with, -1 for none. `incomplete`: whether the plan leaves something anyway:
    then what is hardly anything, and no other step serves, is left as well. Returns (n,) int32: as `number`; -1 as well where a
    sample is left.
    """
    before, again = number, True
    while again:
        more, again = float(steps.area[(before >= 0) & (number < 0)].sum()), False
        for rows in steps.minor(number):
            then = _without_step(steps, number, rows, more if incomplete else None)
            if then is not None:
                number, again = then, True
                break
    return number


def _without_step(steps: Steps, number: Ints, rows: Rows, more: float | None) -> Ints | None:
    """Labels (n,) without the step of some samples (m,); None where it has to stay.

    `more` is how much, mm2, is none already of what may be left; None: nothing may be.
    """
    used = np.unique(number[number >= 0])
    others = used[steps.free[used] & ~np.isin(steps.group[used], steps.group[number[rows]])]
    if not steps.moving[number[rows]].any():
        # A fixed orientation goes to motion only where it is small itself, and motion is a step anyway.
        size, mine = np.bincount(number[number >= 0], steps.area[number >= 0], steps.cost.shape[1]), float(steps.area[rows].sum())
        large = size >= MINOR_SHARE * size.sum() if mine < MINOR_SHARE * size.sum() else np.zeros(len(size), bool)
        others = others[~steps.moving[others] | large[others]]
    if not len(others):
        return None
    cost = steps.cost[np.ix_(rows, others)]
    served = np.isfinite(cost).any(axis=1)
    rest, mine, cost = rows[~served], rows[served], cost[served]
    if len(rest) and (more is None or not steps.negligible(number, rest, more)):
        return None
    most = steps.total(number) - steps.cutting(number, rest) + _NOTHING
    # One step that serves all of them is better than several.
    single = int(cost.sum(axis=0).argmin())
    for which in (np.full(len(mine), single), cost.argmin(axis=1)):
        then = number.copy()
        then[rest], then[mine] = -1, others[which]
        if np.isfinite(cost[np.arange(len(mine)), which]).all() and steps.total(then) <= most:
            return then
    return None
