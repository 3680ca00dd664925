"""Find the usual sizes of a cutter that reach most of what it gouges, by judging them there."""

from dataclasses import replace
from functools import cache

import numpy as np

from cad_io.arrays import Floats, Ints
from plan_cutters.answers.areas import Rows
from plan_cutters.answers.state import HALF, NEARLY, Case
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.standard_tools import MOST, Fit, smaller
from plan_cutters.scene.preparation import Prepared

#: Samples on which sizes are compared, at most.
_LOOKED_AT = 128
#: What a second size reaches more than the first one, at least, a share of the area.
_MORE = 0.1


def fitting(ready: Prepared, cutter: Cutter, rows: Rows, area: Floats) -> tuple[Fit, ...] | None:
    """Find the largest usual size that reaches most of some samples, and a smaller one where that reaches notably more.

    Each is judged as long as the cutter, in its holder, without a thinner neck or a thicker shank, under the conditions of the
    plan: whether a tool of that size is sold so long is not asked here.

    `cutter`: of its kind the sizes are. `rows` (m,) int64: samples that it does not reach. Of very many some are looked at, as
    many of each face as it has of the area. `area` (n,) float: mm2 that each sample stands for. It is empty where no size
    reaches any. None where nothing was judged: sizes have no meaning (form cutters, tapers), none is smaller, or obstacles are
    missing.
    """
    conditions = ready.conditions
    if conditions.surroundings.doubtful or not area[rows].sum() > 0.0:
        return None
    few, weight = _few(ready.samples.face, rows, area)
    bare = (replace(made, length=cutter.length, flutes=None, neck=None, shank_radius=None) for made in smaller(cutter, MOST))
    sizes = [made for made in bare if conditions.judges(made)]

    # Of each sample the largest size that is known to reach it, and the smallest that does not: each is taken to reach what
    # those before it reach, as round and flat ends of one length do but for what their holders meet.
    reaches, fails = np.full(len(few), len(sizes)), np.full(len(few), -1)

    @cache
    def reached(k: int) -> float:
        open_ = np.flatnonzero((k < reaches) & (k > fails))
        missed = np.isin(few[open_], Case(ready, sizes[k]).misses(few[open_])) if len(open_) else np.zeros(0, bool)
        reaches[open_[~missed]], fails[open_[missed]] = k, k
        return float(weight[k >= reaches].sum() / weight.sum())

    def largest(share: float, above: int) -> int:
        """The largest of the sizes after one that reaches a share."""
        low, high = above, len(sizes) - 1
        while high - low > 1:
            middle = (low + high) // 2
            low, high = (low, middle) if reached(middle) >= share else (middle, high)
        return high

    if not sizes:
        return None
    most = reached(len(sizes) - 1)
    if not most > 0.0:
        return ()
    chosen = [largest(HALF if most >= HALF else NEARLY * most, -1)]
    first = reached(chosen[0])
    if first >= HALF and most - first >= _MORE:
        chosen.append(largest(max(first + _MORE, first + HALF * (most - first)), chosen[0]))
    return tuple(Fit(sizes[k], reached(k)) for k in chosen)


def _few(face: Ints, rows: Rows, area: Floats) -> tuple[Rows, Floats]:
    """Some of some samples (m,), ascending, with what each counts: all of them by area, or of very many as many by area.

    What is taken of a face does not depend on the others, nor on the sequence of its samples, which go along its parameters.
    """
    if len(rows) <= _LOOKED_AT:
        return np.sort(rows), area[np.sort(rows)]
    each = [rows[face[rows] == number] for number in np.unique(face[rows])]
    mixed = np.concatenate([mine[np.random.default_rng(0).permutation(len(mine))] for mine in each])
    sums = np.cumsum(area[mixed])
    at = np.searchsorted(sums, sums[-1] * (np.arange(_LOOKED_AT) + 0.5) / _LOOKED_AT)
    few, count = np.unique(mixed[np.minimum(at, len(mixed) - 1)], return_counts=True)
    return few, count.astype(float)
