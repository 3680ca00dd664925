"""The plan of operations of a part that was judged: the order of its steps."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters.domain.columns import Columns, columns_of
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.least_set import LeastSet
from plan_cutters.domain.operations import Operation, OperationPlan, Operations
from plan_cutters.domain.verdicts import Verdicts
from plan_cutters.operations.candidates import STEP, Orientations, apart, candidates
from plan_cutters.operations.curve import curve
from plan_cutters.operations.fewest import FINEST, Search, search_fewest
from plan_cutters.operations.labels import joined, labelled
from plan_cutters.operations.probes import Probes
from plan_cutters.operations.strips import strips
from plan_cutters.scene.preparation import Prepared
from plan_cutters.scene.threads import Progress

Rows = NDArray[np.int64]
#: Of each setup, the verdicts by cutter.
Everywhere = Sequence[Mapping[Cutter, Verdicts]]
#: Cutters whose operations are compared, at most: the fewest that reach all, and then by rank.
_CUTTERS = 4
#: Pieces of an operation smaller than so many squares of the overlap are joined to another operation, if one serves them.
_SMALL = 4.0


def plan_operations(
    ready: Prepared, everywhere: Everywhere, least: LeastSet | None, stage: Callable[[str], AbstractContextManager[Progress]]
) -> Operations:  # fmt: skip
    """Plan the operations that finish together all that the cutters reach.

    Parameters
    ----------
    ready : Prepared
    everywhere : sequence of mapping
        Of each setup, the first one first, the verdicts by cutter.
    least : LeastSet, optional
        The fewest cutters that reach all that any reaches: they are considered before others.
    stage : callable
        Opens a stage of work by its name; what it gives is told how much of how much is done.

    Raises
    ------
    OptionError
        The machine has fewer than two rotary axes.
    """
    options, samples = ready.options, ready.samples
    orientations = [Orientations.of(conditions) for conditions in ready.setups]
    cutters = _considered(ready.cutters, [run.cutter for run in least.runs] if least else [])
    open_ = ready.finished & (ready.buried < 0)
    reached = np.zeros(len(samples), bool)
    for verdicts in everywhere:
        for cutter in cutters:
            reached |= verdicts[cutter].reached & open_
    rows = np.flatnonzero(reached)
    probes = Probes(samples, cutters, ready.setups, [open_] * len(orientations))
    with stage("operations") as tell:
        first = _first(orientations, len(cutters), ready)
        search = Search(probes, first, rows, lambda bare: _stored(bare, cutters, everywhere, orientations))
        spacing = options.index_step or STEP
        fewest = search_fewest(search, orientations, spacing, FINEST if options.index_step is None else spacing, tell)
        chosen = fewest.columns.of(fewest.chosen)
        serves = np.zeros((len(samples), len(chosen)), bool)
        serves[rows] = probes.table(rows, chosen)
        whole = float(np.nansum(samples.area[open_]))
        steps = curve(probes, fewest, rows, samples.area, whole)
        if options.most_operations is not None and len(chosen) > options.most_operations:
            kept = _best(serves, samples.area, options.most_operations)
            chosen, serves = chosen.of(kept), serves[:, kept]
        plan = _plan("fewest", ready, cutters, chosen, serves, everywhere, reached, orientations)
    return Operations(
        options.operations or "", tuple(cutters), (plan,), fewest, steps, orientations[0].names, probes.made
    )


def _considered(cutters: Sequence[Cutter], needed: Sequence[Cutter]) -> list[Cutter]:
    """The cutters whose operations are compared, by rank."""
    wanted = [*needed, *(each for each in cutters if each not in needed)][: max(_CUTTERS, len(needed))]
    return [each for each in cutters if each in wanted]


def _first(orientations: Sequence[Orientations], cutters: int, ready: Prepared) -> Columns:
    """The first candidates of all cutters and setups."""
    found: Columns | None = None
    for s, where in enumerate(orientations):
        angle, axis = candidates(where, ready.samples, ready.options.index_step)
        for c in range(cutters):
            mine = columns_of(axis, angle, c, s)
            found = mine if found is None else found.and_(mine)
    assert found is not None
    return found


def _stored(
    rows: Rows, cutters: Sequence[Cutter], everywhere: Everywhere, orientations: Sequence[Orientations]
) -> Columns:
    """Columns of the postures that were found for samples, rounded as a control shows them."""
    found = columns_of(np.zeros((0, 3)), np.zeros((0, 2)))
    for s, verdicts in enumerate(everywhere):
        for c, cutter in enumerate(cutters):
            mine = rows[verdicts[cutter].reached[rows]]
            angle, axis = orientations[s].near(verdicts[cutter].axis[mine])
            kept = apart(axis)
            found = found.and_(columns_of(axis[kept], angle[kept], c, s))
    return found


def _best(serves: NDArray[np.bool_], area: Floats, most: int) -> Rows:
    """The columns that serve most of the area, one after the other."""
    left, picked = np.nan_to_num(area), list[int]()
    for _ in range(most):
        gain = left @ serves
        gain[picked] = -1.0
        picked.append(int(gain.argmax()))
        left = np.where(serves[:, picked[-1]], 0.0, left)
    return np.array(picked, np.int64)


def _plan(
    name: str, ready: Prepared, cutters: Sequence[Cutter], columns: Columns, serves: NDArray[np.bool_], everywhere: Everywhere,
    reached: NDArray[np.bool_], orientations: Sequence[Orientations],
) -> OperationPlan:  # fmt: skip
    """The plan of some columns: each sample goes with one that serves it, the rest with a simultaneous operation."""
    samples, options = ready.samples, ready.options
    n = len(samples)
    width = np.full((n, len(columns)), np.nan)
    for k in range(len(columns)):
        axis = np.broadcast_to(columns.axis[k], (n, 3))
        width[:, k] = strips(cutters[columns.cutter[k]], samples, axis, options.scallop, options.stepover).width
    area = np.nan_to_num(samples.area)
    with np.errstate(divide="ignore", invalid="ignore"):
        length = np.where(serves & (width > 0.0), area[:, None] / width, np.inf)
    edge = samples.neighbours
    # A border is cut twice over the overlap: what that takes with a pass of usual width.
    usual = float(np.nanmedian(np.where(serves, width, np.nan))) if serves.any() else 1.0
    border = np.sqrt(0.5 * area[edge].sum(axis=1)) * options.overlap / usual
    label = joined(labelled(length, edge, border), serves, edge, area, _SMALL * options.overlap**2)
    rest = np.flatnonzero(reached & (label < 0))
    sizes = np.bincount(label[label >= 0], area[label >= 0], len(columns))
    used = np.flatnonzero(np.bincount(label[label >= 0], minlength=len(columns)))
    order = sorted(used.tolist(), key=lambda k: (-sizes[k], columns.setup[k], *columns.axis[k].tolist()))
    times = serves.sum(axis=1)
    operations = [
        Operation(
            f"op{i}", "fixed", cutters[columns.cutter[k]], int(columns.setup[k]), columns.axis[k], columns.angle[k],
            _other(orientations[columns.setup[k]], columns.axis[k], columns.angle[k]), np.flatnonzero(label == k),
            np.flatnonzero(serves[:, k] & (times == 1)),
        )
        for i, k in enumerate(order, 1)
    ]  # fmt: skip
    place = np.full(len(columns) + 1, -1, np.int16)
    place[order] = np.arange(len(order))
    table = serves[:, order]
    numbers = place[label].astype(np.int32)
    strip = np.where(label >= 0, width[np.arange(n), np.maximum(label, 0)], np.nan)
    for s, verdicts in enumerate(everywhere):
        for cutter in cutters:
            mine = rest[verdicts[cutter].reached[rest]]
            if not len(mine):
                continue
            rest = np.setdiff1d(rest, mine)
            numbers[mine] = len(operations)
            own = strips(cutter, samples, verdicts[cutter].axis, options.scallop, options.stepover).width
            strip[mine] = own[mine]
            column = np.zeros((n, 1), bool)
            column[mine] = True
            table = np.concatenate([table, column], axis=1)
            operations.append(
                Operation(f"op{len(operations) + 1}", "simultaneous", cutter, s, None, None, None, mine, mine)
            )
    with np.errstate(divide="ignore", invalid="ignore"):
        seconds = np.full(n, np.nan) if options.feed is None else 60.0 * area / (strip * options.feed)
    return OperationPlan(name, tuple(operations), numbers, table, strip, seconds)


def _other(where: Orientations, axis: Floats, angle: Floats) -> Floats | None:
    """The other angles that hold an axis, deg."""
    both = np.degrees(where.kinematics.positions(axis[None])[0][0])
    apart_ = np.abs((both - angle + 180.0) % 360.0 - 180.0).sum(axis=1)
    other = both[int(np.nan_to_num(apart_, nan=-1.0).argmax())]
    return np.round(other, 3) + 0.0 if np.isfinite(other).all() and np.nanmax(apart_) > 0.01 else None
