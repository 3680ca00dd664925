"""The fewest columns that cover all rows of a table, and weights on rows that prove how few can do.

Weights of rows that load no column with more than 1 sum up to no more than the columns of any cover: each of its columns
carries 1 at most, and every row's weight is carried by one of them. So the sum, rounded up, is a bound that needs no trust
in the solver that found the weights.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters.domain.answers import essential_rows

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

    Attributes
    ----------
    chosen : (k,) int64
        Columns, ascending.
    at_least : int
        No cover has fewer columns.
    weight : (n,) int64
        Of the rows, in parts of `UNIT`.
    bound : float
        What the weights prove: their sum, at the largest load of a column.
    relaxed : float
        The least sum of shares of columns that covers all rows, where columns may be taken in part.
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

    Attributes
    ----------
    rows : (r,) int64
        Rows of which no other one follows from them.
    share : (m,) float
        Part of each column that is taken.
    dual : (r,) float
        Weights of `rows`: no column carries more than 1.
    weight : (n,) int64
        Of all rows, in parts of `UNIT`.
    value : float
        Sum of the parts.
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

    Parameters
    ----------
    table : (n, m) bool
    known : (k,) int64, optional
        A cover.
    relaxed : Relaxed, optional
        Of this table, where it is known.
    prove : bool
        Search until no smaller cover is possible; else stop early.
    seconds : float
        That the search may take; behind it `at_least` is what is known by then.

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
