"""A plan made of chosen columns: what each sample goes with, region by region."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, SurfaceSamples
from plan_cutters.domain.columns import Columns
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.operations import Operation, OperationPlan, Workplane
from plan_cutters.domain.preference import NEARLY_ALL, group_of, rank
from plan_cutters.domain.verdicts import UNJUDGED, Verdicts
from plan_cutters.operations.candidates import Orientations
from plan_cutters.operations.indexing import Indexing
from plan_cutters.operations.labels import joined, labelled, regions_of
from plan_cutters.operations.probes import Probes
from plan_cutters.operations.strips import strips
from plan_cutters.operations.timing import Paths, Problems, costs_of, widths
from plan_cutters.operations.workplanes import workplanes
from plan_cutters.plan_file.numbers import area as size
from plan_cutters.scene.clearance import least_clearance
from plan_cutters.scene.conditions import Context
from plan_cutters.scene.fixed_axis import at_fixed_axis, held_at
from plan_cutters.scene.preparation import Prepared

Rows = NDArray[np.int64]
#: Pieces of an operation smaller than so many squares of the overlap are joined to another operation, if one serves them.
_SMALL = 4.0
#: An orientation that adds less of the area is not worth its turn.
MINOR_AREA = 0.001


@dataclass(frozen=True, slots=True, eq=False)
class Task:
    """The same for all plans of a part.

    Attributes
    ----------
    ready : Prepared
    cutters : tuple of Cutter
        Those that are compared; columns count in them.
    orientations : tuple of Orientations
        Of each setup.
    everywhere : tuple of mapping
        Of each setup, the verdicts by cutter.
    rows : (r,) int64
        Samples that are reached by one of the cutters in one of the setups.
    probes : Probes
    paths : Paths
    indexing : Indexing
    problems : Problems
    """

    ready: Prepared
    cutters: tuple[Cutter, ...]
    orientations: tuple[Orientations, ...]
    everywhere: tuple[Mapping[Cutter, Verdicts], ...]
    rows: Rows
    probes: Probes
    paths: Paths
    indexing: Indexing
    problems: Problems


def plan_with(
    task: Task, name: str, columns: Columns, rule: Callable[[NDArray[np.bool_]], NDArray[np.bool_]] | None = None
) -> OperationPlan:
    """Make the plan of some columns: each sample goes with one that serves it, the rest with simultaneous operations.

    A `rule` says which of those that serve (n, k) a sample may go with.
    """
    samples, rows = task.ready.samples, task.rows
    n, overlap = len(samples), task.ready.options.overlap
    area, edge = np.nan_to_num(samples.area), samples.neighbours
    serves, width = np.zeros((n, len(columns)), bool), np.full((n, len(columns)), np.nan)
    serves[rows] = task.probes.kept(rows, columns)
    width[rows] = widths(columns, rows, samples, task.cutters, task.paths, serves[rows])
    cost = np.full((n, len(columns)), np.inf)
    cost[rows] = costs_of(columns, width[rows], serves[rows], area[rows], task.cutters, task.paths)
    # A border is cut twice over the overlap: what that takes is what the same area costs elsewhere.
    finite = np.isfinite(cost)
    each = float((cost[finite].sum() / max(1e-300, (finite * area[:, None]).sum())) if finite.any() else 0.0)
    border = np.sqrt(0.5 * area[edge].sum(axis=1)) * overlap * each
    may = finite if rule is None else rule(finite)
    # A rule is about areas that are worth an operation: crumbs go with what is beside them.
    label = joined(labelled(np.where(may, cost, np.inf), edge, border), finite, edge, area, _SMALL * overlap**2)
    operations, order = _fixed(task, columns, finite, label, area)
    place = np.full(len(columns) + 1, -1, np.int32)
    place[order] = np.arange(len(order))
    number, table = place[label], finite[:, order]
    strip = np.where(label >= 0, width[np.arange(n), np.maximum(label, 0)], np.nan) if len(columns) else np.full(n, np.nan)
    number, table, strip, others = _simultaneous(task, len(operations), number, table, strip)
    operations += others
    speed = np.full(n, np.nan)
    if task.paths.feed is not None:
        for k, operation in enumerate(operations):
            speed[number == k] = task.paths.feed[operation.cutter] / 60.0
    with np.errstate(divide="ignore", invalid="ignore"):
        seconds = area / (strip * speed)
    tilt_direction = np.full((n, 3), np.nan)
    for k, operation in enumerate(operations):
        held = _held(task, operation)
        tilt_direction[operation.rows] = held.tilt_direction[operation.rows]
        operations[k] = replace(operation, clearance=_clearance(task, operation, held))
    region = regions_of(number, edge, area)
    planes = workplanes(operations, task.ready, task.indexing)
    cutting, other = float(seconds[number >= 0].sum()), _other(task, operations, planes)
    return OperationPlan(name, tuple(operations), number, table, strip, seconds, region, planes, tilt_direction, cutting, other)


def _other(task: Task, operations: Sequence[Operation], planes: Sequence[Workplane | None]) -> float:
    """Seconds of orientations, and of each cutter and each setup after the first, which are there anyway."""
    options = task.ready.options
    # How simultaneous motion begins is not known: it takes the time of an orientation that no rates tell.
    turns = sum(task.indexing.constant if plane is None else plane.index for plane in planes)
    cutters, setups = len({each.cutter for each in operations}), len({each.setup for each in operations})
    return turns + options.change_time * max(0, cutters - 1) + options.setup_time * max(0, setups - 1)


def _fixed(
    task: Task, columns: Columns, serves: NDArray[np.bool_], label: NDArray[np.int32], area: Floats
) -> tuple[list[Operation], list[int]]:
    """The operations of columns that some sample goes with, the largest first; and the columns in that order."""
    mine = label >= 0
    size = np.bincount(label[mine], area[mine], len(columns))
    used = np.flatnonzero(np.bincount(label[mine], minlength=len(columns)))
    order = sorted(used.tolist(), key=lambda k: (-size[k], columns.setup[k], *columns.axis[k].tolist()))
    times = serves[:, order].sum(axis=1)
    operations = [
        Operation(
            f"op{i}", "fixed", task.cutters[columns.cutter[k]], int(columns.setup[k]), columns.axis[k], columns.angle[k],
            task.orientations[columns.setup[k]].other(columns.axis[k], columns.angle[k]), np.flatnonzero(label == k),
            np.flatnonzero(serves[:, k] & (times == 1)),
        )
        for i, k in enumerate(order, 1)
    ]  # fmt: skip
    return operations, order


def _simultaneous(
    task: Task, before: int, number: NDArray[np.int32], table: NDArray[np.bool_], strip: Floats
) -> tuple[NDArray[np.int32], NDArray[np.bool_], Floats, list[Operation]]:
    """Give what no fixed operation takes to simultaneous ones: number, what serves, strips and operations."""
    samples, paths, operations = task.ready.samples, task.paths, list[Operation]()
    rest = task.rows[number[task.rows] < 0]
    for s, verdicts in enumerate(task.everywhere):
        for cutter in task.cutters:
            mine = rest[verdicts[cutter].reached[rest]]
            if not len(mine):
                continue
            rest = np.setdiff1d(rest, mine)
            number[mine] = before + len(operations)
            strip[mine] = strips(cutter, samples, verdicts[cutter].axis, paths.scallop, paths.stepover).width[mine]
            column = np.zeros((len(samples), 1), bool)
            column[mine] = True
            table = np.concatenate([table, column], axis=1)
            operations.append(
                Operation(f"op{before + len(operations) + 1}", "simultaneous", cutter, s, None, None, None, mine, mine)
            )
    return number, table, strip, operations


def _held(task: Task, operation: Operation) -> Verdicts:
    """The postures at the samples of an operation; those of others are not looked at."""
    samples, n = task.ready.samples, len(task.ready.samples)
    number = np.full(n, -1, np.int32)
    number[operation.rows] = 0
    if operation.axis is not None:
        context = Context.of(operation.cutter, task.ready.setups[operation.setup])
        return held_at(operation.axis[None], number, samples, context)
    verdicts = task.everywhere[operation.setup][operation.cutter]
    return replace(verdicts, verdict=np.where(number == 0, verdicts.verdict, UNJUDGED).astype(np.uint8))


def clearance_of(task: Task, operation: Operation) -> float | None:
    """The least clearance of an operation at its samples, mm; None where nothing is known."""
    return _clearance(task, operation, _held(task, operation))


def _clearance(task: Task, operation: Operation, held: Verdicts) -> float | None:
    """The least clearance of postures of an operation; None where nothing is known."""
    samples = at_fixed_axis(task.ready.samples, held)
    clearance = least_clearance(samples, operation.cutter, held, task.ready.setups[operation.setup])
    return clearance if math.isfinite(clearance) else None


def small_pieces(plan: OperationPlan, samples: SurfaceSamples, overlap: float) -> tuple[str, ...]:
    """Say what pieces of a plan are small, where there are any: no neighbouring operation serves all of one of these."""
    mine = plan.region >= 0
    areas = np.bincount(plan.region[mine], np.nan_to_num(samples.area[mine]))
    small = areas < _SMALL * overlap**2
    if not small.any():
        return ()
    many, them = ("one piece", "it") if small.sum() == 1 else (f"{small.sum()} pieces", "all of one of them")
    return (
        f"The {plan.name} plan has {many} of less than {size(_SMALL * overlap**2)}, {size(areas[small].sum())} in all: no "
        f"neighbouring operation serves {them}.",
    )


def best_area(task: Task, columns: Columns, most: int | None) -> Columns:
    """Of some columns so many that serve most of the area, one after the other, and then those that save most time.

    `most` None: as many as add each at least `CRUMB` of the area that all serve.
    """
    area, cost = costs_with(task, columns)
    serves, now, picked = np.isfinite(cost), np.full(len(cost), np.inf), list[int]()
    least = MINOR_AREA * float(area @ serves.any(axis=1))
    for _ in range(len(columns) if most is None else min(most, len(columns))):
        gain = np.where(np.isfinite(now), 0.0, area) @ serves
        if most is None and picked and gain.max() < least:
            break
        if most is not None and gain.max() <= 0.0:
            some = np.isfinite(now)
            gain = np.maximum(0.0, now[some, None] - cost[some]).sum(axis=0)
        gain[picked] = -1.0
        picked.append(int(gain.argmax()))
        now = np.minimum(now, cost[:, picked[-1]])
    return columns.of(np.array(picked, np.int64))


def costs_with(task: Task, columns: Columns) -> tuple[Floats, Floats]:
    """The area (r,) of the samples of a task, and what each costs with columns (r, k), infinite where one does not serve it."""
    rows = task.rows
    area, serves = np.nan_to_num(task.ready.samples.area[rows]), task.probes.kept(rows, columns)
    width = widths(columns, rows, task.ready.samples, task.cutters, task.paths, serves)
    return area, costs_of(columns, width, serves, area, task.cutters, task.paths)


def worth_their_turn(task: Task, columns: Columns) -> Columns:
    """Leave out columns that serve less than `CRUMB` of the area alone and save less time than an orientation takes.

    The one that saves least goes first; what it served goes with the others.
    """
    (area, cost), columns_left = costs_with(task, columns), np.arange(len(columns))
    least = MINOR_AREA * float(area @ np.isfinite(cost).any(axis=1))
    turn = task.indexing.together(columns) / max(1, len(columns))
    while len(columns_left) > 1:
        own = cost[:, columns_left]
        first, second = np.partition(own, 1, axis=1)[:, :2].T
        alone, best = np.isfinite(first) & ~np.isfinite(second), own.argmin(axis=1)
        size = np.bincount(best[alone], area[alone], len(columns_left))
        both = np.isfinite(second)
        saved = np.bincount(best[both], second[both] - first[both], len(columns_left))
        minor = np.flatnonzero((size < least) & (saved < turn))
        if not len(minor):
            break
        columns_left = np.delete(columns_left, minor[saved[minor].argmin()])
    return columns.of(columns_left)


def orientations_of(ready: Prepared) -> tuple[Orientations, ...]:
    """Those of each setup."""
    return tuple(Orientations.of(conditions) for conditions in ready.setups)


def considered(cutters: Sequence[Cutter], needed: Sequence[Cutter], most: int) -> tuple[Cutter, ...]:
    """The cutters whose operations are compared, by rank: those that are needed, and the most wanted of each other kind."""
    others = [each for each in cutters if each not in needed]
    first_of_kind = list({group_of(each): each for each in reversed(others)}.values())[::-1]
    ordered = [*needed, *first_of_kind, *(each for each in others if each not in first_of_kind)]
    chosen = ordered[: max(most, len(needed))]
    return tuple(each for each in cutters if each in chosen)


def of_wanted_kinds(cutters: Sequence[Cutter], needed: Sequence[Cutter], free_form: float) -> list[Cutter]:
    """Cutters without the kinds that come after all that are needed, for what is needed reaches all without them.

    These are engraving, chamfer and form cutters in any case, and flat ends and others where nearly all faces are free-form;
    `free_form` is their share of the area.
    """
    place = {each: rank(group_of(each), free_form=free_form) for each in cutters}
    last = max(place[each] for each in needed)
    most = last if free_form >= NEARLY_ALL else max(last, rank("last", free_form=free_form) - 1)
    return [each for each in cutters if place[each] <= most]
