"""The fewest fixed orientations that serve samples, found from few of them and checked at all, with weights that prove it.

Rows of the table are made only for samples that the cover of the others misses; candidates are made denser where the weights of
rows lie. Weights of rows that load no column with more than 1 sum up to no more than the columns of any cover: each of its
columns carries 1 at most, and every row's weight is carried by one of them. So the sum, rounded up, is a bound that needs no
trust in the solver that found the weights.
"""

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Record
from plan_cutters.domain.answers import essential_rows
from plan_cutters.domain.operations import Columns, columns_of
from plan_cutters.operations.orientations import Orientations, apart
from plan_cutters.operations.probes import Probes
from plan_cutters.plan_file.operations import FewestEntry
from plan_cutters.scene.work import Progress

Table = NDArray[np.bool_]
Which = NDArray[np.int64]

#: Weights are whole parts of so many.
UNIT = 1_000_000
#: Greedy covers that are tried, each with other random weights, on the way and for the proof, and how much the weights differ.
_TRIES, _MORE_TRIES, _SPREAD = 12, 150, 0.5
#: Nodes of branch and bound.
_NODES = 20_000
#: Seconds that a proof may take unless another number is requested, whatever its nodes.
SECONDS = 30.0
_ROUNDING = 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class Cover:
    """A cover of the rows of a table.

    `chosen` (k,) int64: columns, ascending.
    `at_least`: no cover has fewer columns.
    `weight` (n,) int64: of the rows, in parts of `UNIT`.
    `bound`: what the weights prove: their sum, at the largest load of a column.
    `relaxed`: the least sum of shares of columns that covers all rows, where columns may be taken in part.
    """

    chosen: Which
    at_least: int
    weight: Which
    bound: float
    relaxed: float

    @property
    def closed(self) -> bool:
        """Whether no cover has fewer columns than this one."""
        return len(self.chosen) <= self.at_least


@dataclass(frozen=True, slots=True, eq=False)
class Relaxed:
    """The cover of a table whose columns may be taken in part, and the weights that belong to it.

    `rows` (r,) int64: rows of which no other one follows from them.
    `share` (m,) float: part of each column that is taken.
    `dual` (r,) float: weights of `rows`: no column carries more than 1.
    `weight` (n,) int64: of all rows, in parts of `UNIT`.
    `value`: sum of the parts.
    """

    rows: Which
    share: Floats
    dual: Floats
    weight: Which
    value: float

    @property
    def bound(self) -> float:
        """Return the number that the whole weights prove."""
        return float(self.weight.sum()) / UNIT


def relax(table: Table) -> Relaxed:
    """Find the least sum of parts of columns that covers each row (n, m), and the weights that prove it."""
    from scipy.optimize import linprog
    from scipy.sparse import csr_array

    weight = np.zeros(len(table), np.int64)
    if not len(table):
        return Relaxed(np.zeros(0, np.int64), np.zeros(table.shape[1]), np.zeros(0), weight, 0.0)
    rows = essential_rows(table)
    small = table[rows]
    # The weights' own problem: most weight of which no column carries more than 1.
    solution = linprog(
        -np.ones(len(small)),
        A_ub=csr_array(small.T.astype(float)),
        b_ub=np.ones(table.shape[1]),
        bounds=(0.0, None),
        method="highs",
    )
    if solution.x is None:
        return Relaxed(rows, np.ones(table.shape[1]), np.zeros(len(small)), weight, 0.0)
    dual = np.maximum(0.0, solution.x)
    weight[rows] = whole_weights(small, dual)
    return Relaxed(rows, np.maximum(0.0, -solution.ineqlin.marginals), dual, weight, float(-solution.fun))


def fewest(
    table: Table, known: Which | None = None, *, relaxed: Relaxed | None = None, prove: bool = True, seconds: float = SECONDS
) -> Cover:
    """Find few columns that cover every row, each row of which some column covers.

    `table` (n, m) bool. `known` (k,) int64: a cover. `relaxed`: of this table, where it is known. `prove`: search until no
    smaller cover is possible; else stop early. `seconds`: that the search may take; behind it `at_least` is what is known by
    then.

    Examples
    --------
    >>> found = fewest(np.array([[1, 0, 1], [0, 1, 1], [1, 1, 0]], bool))
    >>> len(found.chosen), found.at_least, found.closed
    (2, 2, True)
    """
    if not len(table):
        return Cover(np.zeros(0, np.int64), 0, np.zeros(0, np.int64), 0.0, 0.0)
    relaxed = relax(table) if relaxed is None else relaxed
    small, bound = table[relaxed.rows], relaxed.bound
    at_least = max(1, math.ceil(bound - 1e-9))
    covers = [_without_spare(small, known)] if known is not None and small[:, known].any(axis=1).all() else []
    covers.append(_greedy_covers(small, relaxed.share, at_least, _MORE_TRIES if prove else _TRIES))
    best = min(covers, key=len)
    if prove and len(best) > at_least:
        # A cover with one column less has none whose price, by the weights, passes what is left over.
        price = 1.0 - relaxed.dual @ small
        selected = np.flatnonzero(price <= len(best) - 1 - relaxed.dual.sum() + _ROUNDING)
        smaller, proven = _smaller(small[:, selected], len(best) - 1, seconds)
        best = best if smaller is None else selected[smaller]
        if proven is not None:
            at_least = max(at_least, min(proven, len(best)))
    return Cover(np.sort(best), at_least, relaxed.weight, bound, relaxed.value)


def whole_weights(table: Table, weight: Floats) -> Which:
    """Weights (n,) as whole parts of `UNIT`, of which no column carries more than `UNIT`."""
    units = np.floor(weight * UNIT).astype(np.int64)
    load = int((units @ table.astype(np.int64)).max(initial=0))
    return units if load <= UNIT else units * UNIT // load


def _greedy_covers(table: Table, share: Floats, least: int, tries: int) -> Which:
    """The smallest of some greedy covers, led by the parts that the relaxed cover takes."""
    rng = np.random.default_rng(0)
    held, best = table.astype(np.float32), None
    for attempt in range(tries):
        lead = (
            1.0
            + (share * rng.uniform(0.5, 2.0) if attempt else 0.0)
            + (_SPREAD * rng.random(len(share)) * (share > 0.0) if attempt else 0.0)
        )
        open_samples, chosen = np.ones(len(table), np.float32), []
        gain = held.sum(axis=0)
        while open_samples.any():
            column = int((gain * lead).argmax())
            chosen.append(column)
            new = open_samples * held[:, column]
            open_samples -= new
            gain -= new @ held
        cover = _without_spare(table, np.array(chosen, np.int64))
        if best is None or len(cover) < len(best):
            best = cover
            if len(best) <= least:
                break
    assert best is not None
    return best


def _without_spare(table: Table, chosen: Which) -> Which:
    """A cover without the columns that the others make up for."""
    times = table[:, chosen].sum(axis=1)
    selected = np.ones(len(chosen), bool)
    for k in np.argsort(table[:, chosen].sum(axis=0), kind="stable").tolist():
        mine = table[:, chosen[k]]
        if (times[mine] > 1).all():
            selected[k] = False
            times = times - mine
    return chosen[selected]


def _smaller(table: Table, most: int, seconds: float) -> tuple[Which | None, int | None]:
    """A cover of at most so many columns; else None, and how many every cover needs, where that is known."""
    from scipy.optimize import Bounds, LinearConstraint, milp
    from scipy.sparse import csr_array

    if not table.any(axis=1).all():
        return None, most + 1
    held = csr_array(table.astype(float))
    few = csr_array(np.ones((1, table.shape[1])))
    solution = milp(
        np.ones(table.shape[1]),
        integrality=np.ones(table.shape[1]),
        bounds=Bounds(0, 1),
        constraints=[LinearConstraint(held, 1.0, np.inf), LinearConstraint(few, 0.0, most)],
        options={"time_limit": max(0.1, seconds), "mip_rel_gap": 0.99 / (most + 1), "node_limit": _NODES},
    )
    if solution.status == 2:
        return None, most + 1
    bound = solution.mip_dual_bound
    proven = math.ceil(bound - _ROUNDING) if bound is not None and math.isfinite(bound) else None
    if solution.x is None:
        return None, proven
    chosen = np.flatnonzero(solution.x > 0.5)
    return (chosen if table[:, chosen].any(axis=1).all() else None), proven


Rows = NDArray[np.int64]
#: Samples that the first table holds, and samples that are added to it at once.
_FIRST, _MORE = 300, 200
#: Rounds, at most, until a cover of some samples must serve all.
_ROUNDS = 60
#: Candidates about which new ones are laid, at most, at each halving of their spacing.
_LOADED = 250
#: Candidates that enter the table at once.
_ENTER = 150
#: Candidates that come with one that enters are loaded with at least so much of what it takes.
_NEARLY = 0.97
#: Whole weights and those of the solver differ by less, summed up.
_MARGIN = 0.01
#: Spacing down to which candidates are laid, rad.
FINEST = math.radians(0.5)


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Fewest(Record):
    """The fewest orientations found, with what proves how few there can be.

    `columns`: all candidates.
    `cover`: of the samples in the table by them.
    `rows` (r,) int64: samples in the table.
    `spacing`: between candidates where the weights lie, rad.
    `alone` (s,) int64: samples that no candidate serves.
    `samples`: how many are reached.
    """

    columns: Columns
    cover: Cover
    rows: Rows
    spacing: float
    alone: Rows
    samples: int

    @property
    def proof(self) -> Literal["weights", "branch and bound", "not closed"]:
        """Name the proof that there are no fewer: the weights alone, a solver, or none yet."""
        if np.ceil(self.cover.bound - 1e-9) >= len(self.cover.chosen):
            return "weights"
        return "branch and bound" if self.cover.closed else "not closed"

    @property
    def entry(self) -> FewestEntry:
        """As the plan file has it."""
        cover = self.cover
        weights = [(row, weight) for row, weight in zip(self.rows.tolist(), cover.weight.tolist(), strict=True) if weight]
        return FewestEntry(
            found=len(cover.chosen), at_least=cover.at_least, proof=self.proof, weights=sorted(weights), bound=cover.bound,
            lp=cover.relaxed, samples=self.samples, candidates=len(self.columns), spacing_deg=float(np.degrees(self.spacing)),
            alone=len(self.alone),
        )  # fmt: skip


class Search:
    """A table of samples and candidates that grows until a cover of it serves all samples.

    Candidates that are laid later wait: a weight on samples says which of them could make a cover smaller, and only these enter
    the table whole. Of the others no more is known than that the weights do not load them too much, which is all that the
    bound needs.

    `columns`: all candidates, the first ones at first. `rows` (n,) int64: samples to serve, and then those (r,) in the table.
    `stored`: gives columns for samples that no candidate serves: their own postures. `first`: samples that the first table holds.
    `alone` (s,) int64: samples that no candidate serves.
    """

    def __init__(
        self, probes: Probes, columns: Columns, rows: Rows, stored: Callable[[Rows], Columns],
        progress: Progress | None = None, first: int = _FIRST,
    ) -> None:  # fmt: skip
        self._probes, self.columns, self._wanted, self._stored = probes, columns, rows, stored
        self.wanted = len(rows)
        self.rows: Rows = np.zeros(0, np.int64)
        self.alone: Rows = np.zeros(0, np.int64)
        self._table = np.zeros((0, len(columns)), np.int8)
        self._active = np.ones(len(columns), bool)
        #: Those that neither wait nor are in the table: no good choice has them by the samples so far.
        self._dropped = np.zeros(len(columns), bool)
        #: What is left of the time for proofs, s.
        self._seconds = SECONDS
        rng = np.random.default_rng(0)
        some = rng.choice(rows, min(first, len(rows)), replace=False) if len(rows) else rows
        self._add_rows(np.sort(some), progress)

    def solve(self, known: Rows | None = None, *, prove: bool = True) -> Cover:
        """Return a small cover of the candidates that serves all samples but those that none serves.

        With `prove` the smallest, or at least a bound of it; else what is found soon. `known` is such a cover.
        """
        for _ in range(_ROUNDS):
            cover = self._cover(known, prove=False)
            missed = self._missed(cover.chosen)
            if prove and not len(missed) and not cover.closed:
                known = cover.chosen
                cover = self._cover(known, prove=True)
                missed = self._missed(cover.chosen) if len(cover.chosen) < len(known) else missed
            if not len(missed):
                return cover
            self._add_rows(spread(missed, self._probes.samples.point, _MORE))
        return self._patched()

    @property
    def whole(self) -> tuple[Rows, NDArray[np.bool_]]:
        """The candidates of which it is known where each serves, and the table (rows, candidates) of these."""
        active = np.flatnonzero(self._active)
        return active, self._table[:, active] == 1

    def begin(self) -> Columns:
        """Few candidates that serve the samples in the table."""
        return self.columns.of(self._cover(None, prove=False).chosen)

    def narrow(self, columns: Columns) -> None:
        """Drop all candidates but for some: they are looked at again at samples alone that no other serves."""
        self._active = np.isin(self.columns.key, columns.key)
        self._dropped = ~self._active

    def require(self, rows: Rows) -> None:
        """Take samples into the table."""
        new = np.setdiff1d(rows, np.union1d(self.rows, self.alone))
        if len(new):
            self._add_rows(new)

    def refine(self, cover: Cover, spacing: float, orientations: Sequence[Orientations]) -> None:
        """Lay candidates at a spacing, rad, about those that the weights load most, and about those chosen."""
        active = np.flatnonzero(self._active)
        load = cover.weight @ self._table[:, active]
        self._lay(np.union1d(active[np.argsort(-load, kind="stable")[:_LOADED]], cover.chosen), spacing, orientations)

    def surround(self, chosen: Columns, spacing: float, orientations: Sequence[Orientations]) -> None:
        """Lay candidates at a spacing, rad, about some, and take them into the table whole."""
        before = len(self.columns)
        self._lay(np.flatnonzero(np.isin(self.columns.key, chosen.key)), spacing, orientations)
        new = np.arange(before, len(self.columns))
        if len(new):
            self._table[:, new] = self._probes.table(self.rows, self.columns.of(new))
            self._active[new] = True

    def _lay(self, near: Rows, spacing: float, orientations: Sequence[Orientations]) -> None:
        """Lay candidates at a spacing, rad, about some of them."""
        for c, s in sorted({*zip(self.columns.cutter[near].tolist(), self.columns.setup[near].tolist(), strict=True)}):
            same = (self.columns.cutter == c) & (self.columns.setup == s)
            angle, axis = orientations[s].near(orientations[s].about(self.columns.axis[near[same[near]]], spacing))
            new = apart(axis, 0.6 * spacing, self.columns.axis[same])
            self._add_columns(columns_of(axis[new], angle[new], c, s))

    def _cover(self, known: Rows | None, *, prove: bool) -> Cover:
        """The fewest columns of the table whole, once the weights load none of those that wait too much."""
        while True:
            active = np.flatnonzero(self._active)
            table = self._table[:, active] == 1
            relaxed = relax(table)
            idle, load = self._idle(relaxed.weight)
            if known is not None:
                # Weights that load a candidate that waits too much still prove something: all of them made smaller.
                weight = relaxed.weight * UNIT // max(UNIT, int(load.max(initial=0)))
                bound = float(weight.sum()) / UNIT
                if math.ceil(bound - 1e-9) >= len(known):
                    return Cover(known, len(known), weight, bound, bound)
            if self._enter(idle, load, 1.0):
                continue
            own = None if known is None else np.searchsorted(active, known)
            prove, began = prove and self._seconds > 0.0, time.monotonic()
            cover = fewest(table, own, relaxed=relaxed, prove=prove, seconds=self._seconds)
            self._seconds -= time.monotonic() - began if prove else 0.0
            cover = replace(cover, chosen=active[cover.chosen])
            # The weights' bound holds for all. Branch and bound has seen those alone that are in the table whole.
            by_weights = math.ceil(cover.bound - 1e-9)
            if not prove or by_weights >= len(cover.chosen):
                return replace(cover, at_least=max(min(1, len(cover.chosen)), by_weights))
            if not self._enter(idle, load, cover.bound + 2.0 - len(cover.chosen) - _MARGIN):
                return cover

    def _idle(self, weight: Rows) -> tuple[Rows, Rows]:
        """Candidates that wait, and how much the weights load each."""
        idle, rows = np.flatnonzero(~self._active & ~self._dropped), np.flatnonzero(weight)
        open_ = rows[(self._table[np.ix_(rows, idle)] < 0).any(axis=1)]
        if len(open_) and len(idle):
            self._table[np.ix_(open_, idle)] = self._probes.table(self.rows[open_], self.columns.of(idle))
        return idle, weight[rows] @ (self._table[np.ix_(rows, idle)] == 1)

    def _enter(self, idle: Rows, load: Rows, most: float) -> bool:
        """Take candidates into the table whole that wait and that are loaded with more than so much, if there are any."""
        if not (load > most * UNIT).any():
            return False
        # Those loaded nearly as much are likely the next ones.
        over = np.flatnonzero(load > _NEARLY * most * UNIT)
        new = np.sort(idle[over[np.argsort(-load[over], kind="stable")[:_ENTER]]])
        self._table[:, new] = self._probes.table(self.rows, self.columns.of(new))
        self._active[new] = True
        return True

    def _missed(self, chosen: Rows) -> Rows:
        missing = np.setdiff1d(self._wanted, self.alone)
        order = np.argsort(-self._table[:, chosen].sum(axis=0), kind="stable")
        for column in chosen[order].tolist():
            missing = missing[~self._probes.table(missing, self.columns.of(np.array([column])))[:, 0]]
        return missing

    def _add_rows(self, rows: Rows, progress: Progress | None = None) -> None:
        active = np.flatnonzero(self._active)
        new = np.full((len(rows), len(self.columns)), -1, np.int8)
        new[:, active] = self._probes.table(rows, self.columns.of(active), progress)
        self._wake(rows, new)
        bare = rows[~(new == 1).any(axis=1)]
        if len(bare):
            before = len(self.columns)
            self._add_columns(self._stored(bare))
            added = np.arange(before, len(self.columns))
            self._table[:, added] = self._probes.table(self.rows, self.columns.of(added))
            self._active[added] = True
            new = np.concatenate([new, self._probes.table(rows, self.columns.of(added)).astype(np.int8)], axis=1)
        served = (new == 1).any(axis=1)
        self.alone = np.union1d(self.alone, rows[~served])
        self.rows = np.concatenate([self.rows, rows[served]])
        self._table = np.concatenate([self._table, new[served]])

    def _wake(self, rows: Rows, new: NDArray[np.int8]) -> None:
        """Take dropped candidates that serve what no other does into the table again, and into its `new` part (rows, columns)."""
        while True:
            bare, dropped = np.flatnonzero(~(new[:, self._active] == 1).any(axis=1)), np.flatnonzero(self._dropped)
            if not len(bare) or not len(dropped):
                return
            open_ = dropped[(new[np.ix_(bare, dropped)] < 0).any(axis=0)]
            new[np.ix_(bare, open_)] = self._probes.table(rows[bare], self.columns.of(open_))
            serves = (new[np.ix_(bare, dropped)] == 1).sum(axis=0)
            if not serves.any():
                return
            best = dropped[[int(serves.argmax())]]
            self._table[:, best] = self._probes.table(self.rows, self.columns.of(best))
            new[:, best] = self._probes.table(rows, self.columns.of(best))
            self._active[best], self._dropped[best] = True, False

    def _add_columns(self, new: Columns) -> None:
        self._table = np.concatenate([self._table, np.full((len(self.rows), len(new)), -1, np.int8)], axis=1)
        self._active, self._dropped = (np.append(each, np.zeros(len(new), bool)) for each in (self._active, self._dropped))
        self.columns = self.columns.and_(new)

    def _patched(self) -> Cover:
        """A cover that serves all samples, without the proof: the rounds did not do."""
        cover = self._cover(None, prove=False)
        while len(missed := self._missed(cover.chosen)):
            self._add_rows(missed[:_MORE])
            cover = self._cover(None, prove=False)
        return cover


def search_fewest(
    search: Search, orientations: Sequence[Orientations], spacing: float, finest: float, tell: Callable[[int, int], None]
) -> Fewest:
    """Find the fewest orientations, with candidates that are refined down to a spacing.

    `orientations`: of each setup. `spacing`, `finest`: of the first candidates, and the least, rad; equal: none are added.
    `tell`: told the number of levels done and of all.
    """
    levels = max(0, math.ceil(math.log2(spacing / finest) - 0.5))
    best = search.solve(prove=not levels)
    for level in range(levels):
        tell(level, levels)
        if len(best.chosen) <= 1:
            break
        spacing *= (finest / spacing) ** (1.0 / (levels - level))
        search.refine(best, spacing, orientations)
        best = search.solve(best.chosen, prove=level == levels - 1)
    return Fewest(search.columns, best, search.rows, spacing, search.alone, search.wanted)


def spread(rows: Rows, point: Floats, most: int) -> Rows:
    """Some of the samples, far from each other."""
    if len(rows) <= most:
        return rows
    apart_ = np.linalg.norm(point[rows] - point[rows[0]], axis=1)
    picked = [0]
    while len(picked) < most:
        far = int(apart_.argmax())
        if apart_[far] <= 0.0:
            break
        picked.append(far)
        apart_ = np.minimum(apart_, np.linalg.norm(point[rows] - point[rows[far]], axis=1))
    return np.sort(rows[picked])
