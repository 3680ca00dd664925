"""A plan made of chosen columns: what each sample goes with, region by region, and the tilted plane of each operation."""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Ints, SurfaceSamples
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.figures import area as size
from plan_cutters.domain.operations import STRATEGIES, Columns, strategy_of, tool_changes
from plan_cutters.domain.preference import NEARLY_ALL, by_radius, group_of, rank
from plan_cutters.domain.verdicts import Verdicts
from plan_cutters.operations.labels import (
    MINOR_SECONDS,
    MINOR_SHARE,
    Steps,
    in_one_step,
    joined,
    labelled,
    regions_of,
    without_minor_steps,
)
from plan_cutters.operations.moving_axes import turning_times
from plan_cutters.operations.orientations import Indexing
from plan_cutters.operations.passes import Cut, cut_by_tip, on_floor
from plan_cutters.operations.task import Task, costs_of, paces
from plan_cutters.outcome import Operation, OperationPlan
from plan_cutters.plan_file.frozen import vector
from plan_cutters.plan_file.holes import WorkplaneEntry
from plan_cutters.plan_file.operations import SlideEntry
from plan_cutters.scene.conditions import Context
from plan_cutters.scene.distances import least_clearance, slid_along
from plan_cutters.scene.fixed_axis import at_fixed_axis, held_at, tilted_plane
from plan_cutters.scene.preparation import Prepared, places


def workplanes(operations: Sequence[Operation], ready: Prepared, indexing: Indexing) -> list[Operation]:
    """Operations with the tilted plane of each one with a fixed axis: the plane that a control turns to, and what that takes.

    Operations of one cutter in one setup follow each other, in the order in which the rotary axes need least time; the first one
    starts with these at zero.
    """
    options = ready.options
    placements = places(options)
    planned = list(operations)
    groups: dict[tuple[int, str], list[int]] = {}
    for i, each in enumerate(operations):
        if each.axis is not None:
            groups.setdefault((each.setup, each.cutter.id), []).append(i)
    for (s, _), mine in groups.items():
        where = indexing.orientations[s]
        conditions, moved = where.conditions, where.kinematics
        known = [[each for each in (operations[i].angle, operations[i].other_angle) if each is not None] for i in mine]
        for i, seconds in zip(mine, indexing.times(s, known).tolist(), strict=True):
            axis, angle = operations[i].axis, operations[i].angle
            assert axis is not None, "a group holds fixed axes"
            assert angle is not None, "a fixed axis has angles"
            own, other = (
                None if each is None else dict(zip(where.names, each.tolist(), strict=True))
                for each in (angle if conditions.machine.turns else None, operations[i].other_angle)
            )
            origin, x, words = tilted_plane(conditions, placements[s], moved, axis, np.radians(angle), own, other)
            frame = WorkplaneEntry(origin=vector(origin), x=vector(x), z=vector(axis))
            planned[i] = operations[i].with_fields(
                frame=frame, index_s=seconds, index_from=indexing.source, g68_2=words.g68_2, g53_1=words.g53_1,
                rotary_words=words.rotary,
            )  # fmt: skip
    return planned


Rows = NDArray[np.int64]
#: Pieces of an operation smaller than so many squares of the overlap are joined to another operation, if one serves them.
_SMALL = 4.0
#: A sample with less than the margin about neck, shank and holder counts so many times as long.
_TIGHT = 2.0
#: An orientation that adds less of the area is not worth its turn.
MINOR_AREA = 0.001


@dataclass(frozen=True, slots=True, eq=False)
class Reserved:
    """The planner's own steps take this of a plan.

    `step`: of each column the number of the step that it is of; 0: it was planned. `moving` (tuple of (int, int, int, (r,)
    int64)): simultaneous steps: their number, cutter, setup, and the samples that they take. `leave`: whether what no step takes
    is left, and not given to simultaneous operations. `others`: of each setup the verdicts by cutter for these: without those of
    cutters where they are forbidden.
    """

    step: tuple[int, ...]
    moving: tuple[tuple[int, int, int, Rows], ...]
    leave: bool
    others: tuple[Mapping[Cutter, Verdicts], ...]


def plan_with(
    task: Task, name: str, columns: Columns, rule: Callable[[NDArray[np.bool_]], NDArray[np.bool_]] | None = None,
    own: Reserved | None = None, *, times: bool = False,
) -> OperationPlan:  # fmt: skip
    """Make the plan of some columns: each sample goes with one that serves it, the rest with simultaneous operations.

    A `rule` says which of those that serve (n, k) a sample may go with; where some columns are a person's `own`, crumbs keep to
    it, too. With `times`, which are enough to compare plans, nothing is looked at of how tools stand.
    """
    columns, orbit = expanded(task, columns)
    samples, rows = task.ready.samples, task.rows
    n, overlap = len(samples), task.ready.options.overlap
    area, edge = np.nan_to_num(samples.area), task.seams.edge
    serves, pace = np.zeros((n, len(columns)), bool), np.full((n, len(columns)), np.nan)
    serves[rows] = task.probes.kept(rows, columns)
    pace[rows] = _paces(task, columns, serves[rows])
    cost = np.full((n, len(columns)), np.inf)
    cost[rows] = costs_of(columns, pace[rows], serves[rows], area[rows], task.cutters, task.paths)
    # A border is cut twice over the overlap: what that takes is what the same area costs elsewhere.
    finite = np.isfinite(cost)
    each = float((cost[finite].sum() / max(1e-300, (finite * area[:, None]).sum())) if finite.any() else 0.0)
    mark = 0.0 if task.paths.feed is None else task.ready.options.border_cost
    border = task.seams.length * (overlap * each + mark * task.seams.shows)
    may = finite.copy() if rule is None else rule(finite)
    if rule is None:
        may[rows] &= ~_floors_of_other_setups(task, columns, serves[rows])
    may = may if task.moved is None else may & ~task.moved[:, None]
    # A rule is about areas that are worth an operation: crumbs go with what is beside them.
    joining = finite if own is None else may
    priced = np.where(may, cost, np.inf)
    if own is None:
        priced[rows] *= _tight(task, columns, serves[rows])
    label = joined(labelled(priced, edge, border), joining, edge, area, _SMALL * overlap**2)
    operations, order = _fixed(task, columns, label, area, orbit, (0,) * len(columns) if own is None else own.step)
    place = np.full(len(columns) + 1, -1, np.int32)
    place[order] = np.arange(len(order))
    number, table = place[label], finite[:, order]
    moving = np.full(n, np.nan)
    number, table, moving, others = _simultaneous(task, len(operations), number, table, moving, own)
    operations += others
    fixed = np.flatnonzero(label >= 0)
    moving[fixed] = pace[fixed, label[fixed]]
    made, short = _Made(operations, number, table, moving), rows[:0]
    if operations and task.ready.options.most_operations is None:
        made, short = _fewer(task, made, np.where(may, cost, np.inf)[:, order], pace[:, order], own)
    operations, number, table, moving = made
    if own is None:
        # Where no axis moves while it cuts, nothing takes what no fixed step is worth.
        short = np.union1d(short, rows[number[rows] < 0])
    region = regions_of(number, edge, area)
    strip, length, link, slower = *np.full((3, n), np.nan), np.ones(n)
    tilt_direction, contact, strategy = np.full((n, 3), np.nan), np.full((n, 3), np.nan), np.zeros(n, np.uint8)
    if times:
        # Links between passes are in the pace, and so in the seconds of samples.
        with np.errstate(divide="ignore", invalid="ignore"):
            strip, length = moving, area / moving
        links = sum(_to_pieces(task, region[each.rows]) for each in operations)
    else:
        for k, operation in enumerate(operations):
            if operation.axis is None:
                # Simultaneous motion goes with the axes of its field.
                axis = task.moving.smooth(task.cutters.index(operation.cutter), operation.setup, operation.rows)
                operation = replace(operation, moving=(axis, np.full(n, -1, np.int32)))
            stands, mine = _stands(task, operation), operation.rows
            strip[mine], length[mine], slower[mine] = stands.cut.strip, area[mine] * stands.cut.path, stands.cut.slower
            if task.paths.feed is not None:
                link[mine] = area[mine] * stands.cut.links * task.paths.link_of(operation.cutter)
            tilt_direction[mine], contact[mine] = stands.held.tilt_direction[mine], stands.contact
            strategy[mine] = stands.strategy
            clearance, word = clearance_of(task, operation, stands), strategy_of(stands.strategy, area[mine])
            slide = None if clearance is None else _slide(task, operation, stands, clearance)
            linked = float(np.nansum(link[mine])) + _to_pieces(task, region[mine])
            operations[k] = operation.with_fields(clearance_mm=clearance, slide=slide, strategy=word, link_seconds=linked)
        links = sum(each.fields["link_seconds"] for each in operations)
    operations = workplanes(operations, task.ready, task.indexing)
    seconds = length * slower / _speed(task, operations, number)
    cutting, other = float(seconds[number >= 0].sum()), _other(task, operations)
    return OperationPlan(
        name, tuple(operations), number, table, strip, length, seconds, region, tilt_direction, strategy, contact, link, cutting,
        links, other, short, mark * task.seams.marks(number),
    )  # fmt: skip


def _tight(task: Task, columns: Columns, serves: NDArray[np.bool_]) -> Floats:
    """How much the time of samples (r, k) counts with columns that serve them: more with little room about the tool, where there
    is a choice."""
    result = np.ones(serves.shape)
    open_ = np.flatnonzero(serves.sum(axis=1) > 1)
    if len(open_):
        spacious = task.probes.spacious(task.rows[open_], columns, serves[open_])
        result[open_] = np.where(serves[open_] & ~spacious, _TIGHT, 1.0)
    return result


def _to_pieces(task: Task, region: Ints) -> float:
    """Seconds of links to the pieces of an operation, by the numbers of these at its samples; 0 without a feed."""
    return 0.0 if task.paths.feed is None else task.paths.link * len(np.unique(region))


def _speed(task: Task, operations: Sequence[Operation], number: NDArray[np.int32]) -> Floats:
    """The feed (n,) at each sample, mm/s; nan where there is none."""
    speed = np.full(len(number), np.nan)
    if task.paths.feed is not None:
        for k, operation in enumerate(operations):
            speed[number == k] = task.paths.feed[operation.cutter] / 60.0
    return speed


def _other(task: Task, operations: Sequence[Operation]) -> float:
    """Seconds of orientations, of changes of cutters, and of each setup after the first, which is there anyway."""
    options = task.ready.options
    # How simultaneous motion begins is not known: it takes the time of an orientation that no rates tell.
    turns = sum(each.fields.get("index_s", task.indexing.constant) for each in operations)
    changes, setups = changes_of(task, operations), len({each.setup for each in operations})
    return turns + options.change_time * changes + options.setup_time * max(0, setups - 1)


def changes_of(task: Task, operations: Iterable[Operation]) -> int:
    """Changes of cutters of some operations: a planner's own in their order, then by size."""
    place = {cutter: k for k, cutter in enumerate(by_radius(task.cutters))}
    in_turn = sorted(operations, key=lambda each: (not each.step, each.step, place[each.cutter]))
    return tool_changes((each.setup, each.cutter) for each in in_turn)


def expanded(task: Task, columns: Columns) -> tuple[Columns, Rows]:
    """All that some columns stand for, each once, and to which column it belongs; -1: it is repeated nowhere."""
    if task.symmetry is None or not len(columns):
        return columns, np.full(len(columns), -1, np.int64)
    every = task.images(columns)
    first = every.first
    step = first // task.times
    return every.of(first), np.where(np.bincount(step)[step] > 1, step, -1)


def _fixed(
    task: Task, columns: Columns, label: NDArray[np.int32], area: Floats, orbit: Rows, step: Sequence[int]
) -> tuple[list[Operation], list[int]]:
    """The operations of columns that some sample goes with, the largest first; and the columns in that order."""
    mine = label >= 0
    size = np.bincount(label[mine], area[mine], len(columns))
    used = np.flatnonzero(np.bincount(label[mine], minlength=len(columns)))
    order = sorted(used.tolist(), key=lambda k: (-size[k], columns.setup[k], *columns.axis[k].tolist()))
    operations = [
        Operation(
            f"op{i}", "fixed", task.cutters[columns.cutter[k]], int(columns.setup[k]), columns.axis[k], columns.angle[k],
            task.orientations[columns.setup[k]].others(columns.axis[[k]], columns.angle[[k]])[0], np.flatnonzero(label == k),
            step=step[k], orbit=int(orbit[k]),
        )
        for i, k in enumerate(order, 1)
    ]  # fmt: skip
    return operations, order


@dataclass(frozen=True, slots=True, eq=False)
class Motion:
    """Simultaneous motion over samples, m of them: which cutter and setup, and what a mm of path cuts, mm2."""

    cutter: Rows
    setup: Rows
    pace: Floats

    def costs(self, task: Task, area: Floats) -> Floats:
        """Seconds with links (m,), or mm of path without a feed, of samples with an area (m,); not finite where not known."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.asarray(area / (self.pace * task.paths.speeds(task.cutters)[self.cutter]))


def moving_over(task: Task, rows: Rows) -> Motion:
    """Simultaneous motion over samples (m,): with the first cutter in the first setup that reaches each, in its widest passes."""
    n = len(rows)
    motion = Motion(np.full(n, -1, np.int64), np.full(n, -1, np.int64), np.full(n, np.nan))
    for s, verdicts in enumerate(task.everywhere):
        for c, cutter in enumerate(task.cutters):
            mine = np.flatnonzero((motion.cutter < 0) & verdicts[cutter].reached[rows])
            if len(mine):
                motion.cutter[mine], motion.setup[mine] = c, s
                motion.pace[mine] = task.moving.widest(c, s, rows[mine])[1]
    return motion


def _simultaneous(
    task: Task, before: int, number: NDArray[np.int32], table: NDArray[np.bool_], pace: Floats, own: Reserved | None
) -> tuple[NDArray[np.int32], NDArray[np.bool_], Floats, list[Operation]]:
    """Give what no fixed operation takes to simultaneous ones: number, what serves, paces and operations."""
    operations, rest = list[Operation](), task.rows[number[task.rows] < 0]
    pieces = [(step, c, s, rows, task.moving.widest(c, s, rows)[1]) for step, c, s, rows in (own.moving if own else ())]
    if task.moves and (own is None or not own.leave):
        rest = rest[~np.isin(rest, np.concatenate([np.zeros(0, np.int64), *(each[3] for each in pieces)]))]
        motion = moving_over(task if own is None else replace(task, everywhere=own.others), rest)
        for s, c in sorted({*zip(motion.setup.tolist(), motion.cutter.tolist(), strict=True)}):
            chosen = (motion.cutter == c) & (motion.setup == s)
            pieces += [(0, c, s, rest[chosen], motion.pace[chosen])] if c >= 0 else []
    for step, c, s, mine, own_pace in pieces:
        if not len(mine):
            continue
        number[mine], pace[mine] = before + len(operations), own_pace
        column = np.zeros((len(number), 1), bool)
        column[mine] = True
        table = np.concatenate([table, column], axis=1)
        name = f"op{before + len(operations) + 1}"
        operations.append(Operation(name, "simultaneous", task.cutters[c], s, None, None, None, mine, step=step))
    return number, table, pace, operations


class _Made(NamedTuple):
    """Operations, and of the samples (n,) the operation, which ones serve (n, k), and what a mm of path cuts, mm2."""

    operations: list[Operation]
    number: NDArray[np.int32]
    table: NDArray[np.bool_]
    pace: Floats


def _fewer(task: Task, made: _Made, cost: Floats, pace: Floats, own: Reserved | None) -> tuple[_Made, Rows]:
    """Join operations to fewer, and say which samples are left for that: `cost` and `pace` (n, f) are those of the fixed ones.

    Simultaneous motion of any cutter in any setup is an operation that a face of free form may go into.
    """
    samples, options, number = task.ready.samples, task.ready.options, made.number
    area, operations = np.nan_to_num(samples.area), list(made.operations)
    # The faces that axes may turn over and that several operations cut, the largest first.
    size, pairs = np.bincount(samples.face, area), np.unique(np.column_stack([samples.face, number])[number >= 0], axis=0)
    face, count = np.unique(pairs[:, 0], return_counts=True)
    flowing = np.intersect1d(face[count > 1], task.flowing).tolist()
    free_form = sorted(flowing, key=lambda each: -size[each])
    if len(free_form) and options.index_step is None and own is None and task.moves:
        there = {(each.cutter, each.setup) for each in operations if each.axis is None}
        operations += [
            Operation("", "simultaneous", cutter, s, None, None, None, task.rows[:0])
            for s in range(len(task.everywhere)) for cutter in task.cutters if (cutter, s) not in there
        ]  # fmt: skip
    verdicts, open_ = task.everywhere if own is None else own.others, task.ready.machinable
    may_move = np.isin(samples.face, free_form) | _little(made, area, _speed(task, made.operations, number))
    for each in operations[cost.shape[1] :]:
        c, mine = task.cutters.index(each.cutter), each.rows
        if not each.step:
            able = verdicts[each.setup][each.cutter].reached & open_[each.setup] & may_move
            able[mine] = True
            mine = task.rows[able[task.rows]]
        column = np.full((len(number), 2), np.nan)
        column[mine, 0] = task.moving.widest(c, each.setup, mine)[1]
        with np.errstate(divide="ignore", invalid="ignore"):
            column[mine, 1] = area[mine] / (column[mine, 0] * task.paths.speeds([each.cutter])[0])
        pace = np.column_stack([pace, column[:, 0]])
        cost = np.column_stack([cost, np.where(np.isfinite(column[:, 1]), column[:, 1], np.inf)])
    group = np.array([-1 - k if each.orbit < 0 else each.orbit for k, each in enumerate(operations)])
    planned = np.array([not each.step for each in operations])

    @cache
    def spent(used: tuple[int, ...]) -> float:
        return _other(task, workplanes([operations[k] for k in used], task.ready, task.indexing))

    moving = np.array([each.axis is None for each in operations])
    steps = Steps(cost, group, planned, moving, area, task.paths.feed is not None, spent)
    somewhere = np.logical_or.reduce([its[each].reached & open_[s] for s, its in enumerate(verdicts) for each in task.cutters])
    fewer = in_one_step(steps, number, samples.face, free_form)
    fewer = without_minor_steps(steps, fewer, incomplete=bool((task.ready.finished & ~somewhere).any()))
    return (made, task.rows[:0]) if np.array_equal(fewer, number) else _made_of(operations, fewer, made, pace, area)


def _little(made: _Made, area: Floats, speed: Floats) -> NDArray[np.bool_]:
    """The samples (n,) of operations of little area or time, which may be joined to others."""
    mine = np.flatnonzero(made.number >= 0)
    with np.errstate(divide="ignore", invalid="ignore"):
        seconds = area / (made.pace * speed)
    many = len(made.operations)
    size, time = (np.bincount(made.number[mine], each[mine], many) for each in (area, seconds))
    little = (size < MINOR_SHARE * size.sum()) | (time < MINOR_SECONDS)
    return np.append(little, False)[made.number]


def _made_of(operations: Sequence[Operation], number: Ints, made: _Made, pace: Floats, area: Floats) -> tuple[_Made, Rows]:
    """What is made of operations that samples (n,) go with now, in the order in which operations stand, and what is left."""
    used = np.unique(number[number >= 0]).tolist()
    size = np.bincount(number[number >= 0], area[number >= 0], len(operations))
    used.sort(key=lambda k: (operations[k].axis is None, -size[k] if operations[k].axis is not None else k))
    place, n = np.full(len(operations) + 1, -1, np.int32), len(number)
    place[used] = np.arange(len(used))
    renumbered = [replace(operations[k], name=f"op{i}", rows=np.flatnonzero(number == k)) for i, k in enumerate(used, 1)]
    table = np.column_stack([
        made.table[:, k] if operations[k].axis is not None else number == k for k in used
    ]) if used else np.zeros((n, 0), bool)  # fmt: skip
    own = np.where(number >= 0, pace[np.arange(n), np.maximum(number, 0)], np.nan) if used else np.full(n, np.nan)
    return _Made(renumbered, place[number], table, own), np.flatnonzero((made.number >= 0) & (number < 0))


@dataclass(frozen=True, slots=True, eq=False)
class _Stands:
    """How a tool stands at the samples of an operation.

    `samples`: all n, with the contact in the place of those that are cut along a wall.
    `held`: postures at its samples; those of others are not looked at.
    `strategy` (r,) uint8: how its samples are cut, in STRATEGIES.
    `contact` (r, 3) float: as in the plan.
    `cut`: what it takes.
    """

    samples: SurfaceSamples
    held: Verdicts
    strategy: NDArray[np.uint8]
    contact: Floats
    cut: Cut


def _stands(task: Task, operation: Operation) -> _Stands:
    """How the tool of an operation stands at its samples."""
    samples, rows, c = task.ready.samples, operation.rows, task.cutters.index(operation.cutter)
    if operation.axis is None:
        assert operation.moving is not None, "it has been looked at closely"
        held = task.moving.held(c, operation.setup, rows, operation.moving[0])
        field, turns, speeds = operation.moving[0], None, None if task.paths.feed is None else task.indexing.speeds
        if speeds is not None:
            turns = turning_times(samples, rows, field, task.orientations[operation.setup].kinematics, speeds)
        cut = cut_by_tip(operation.cutter, samples, rows, field[rows], task.paths, turning=True, turns=turns)
        return _Stands(samples, held, np.zeros(len(rows), np.uint8), np.full((len(rows), 3), np.nan), cut)
    axis, cutter, number = operation.axis, operation.cutter, np.full(len(samples), -1, np.int32)
    number[rows] = 0
    context, searched = Context.of(cutter, task.ready.setups[operation.setup]), task.everywhere[operation.setup][cutter]
    held = held_at(axis[None], number, samples, context, searched)
    tip = cut_by_tip(cutter, samples, rows, np.broadcast_to(axis, (len(rows), 3)), task.paths)
    passes = task.walls.passes(c, operation.setup, axis, rows)
    wall = passes.cut.pace(task.paths, cutter) > np.nan_to_num(tip.pace(task.paths, cutter))
    cut = Cut(*(np.where(wall, mine, others) for mine, others in zip(passes.cut, tip, strict=True)))
    strategy = np.where(wall, STRATEGIES.index("wall"), np.where(cut.floor, STRATEGIES.index("floor"), 0)).astype(np.uint8)
    mine, flutes = rows[wall], passes.normal[wall]
    # Postures with the contact at a sample; those along walls, which are known to be free, are put in their place.
    at = at_fixed_axis(samples, held, task.ready.conditions.tolerance)
    point, normal, tilt, tilt_direction = (each.copy() for each in (at.point, at.normal, held.tilt, held.tilt_direction))
    point[mine], normal[mine], tilt[mine] = passes.point[wall], flutes, 0.5 * math.pi - cutter.taper
    tilt_direction[mine] = (axis - math.sin(cutter.taper) * flutes) / math.cos(cutter.taper)
    shift = held.shift.copy()
    shift[mine] = 0.0
    # Where the contact is elsewhere than at the sample.
    moved = wall | shift[rows].any(axis=1)
    return _Stands(
        replace(at, point=point, normal=normal), replace(held, tilt=tilt, tilt_direction=tilt_direction, shift=shift), strategy,
        np.where(moved[:, None], point[rows] + shift[rows], np.nan), cut,
    )  # fmt: skip


def clearance_of(task: Task, operation: Operation, stands: _Stands | None = None) -> float | None:
    """The least clearance of an operation at its samples, mm; None where nothing is known."""
    stands = stands or _stands(task, operation)
    clearance = least_clearance(stands.samples, operation.cutter, stands.held, task.ready.setups[operation.setup])
    return clearance if math.isfinite(clearance) else None


def _slide(task: Task, operation: Operation, stands: _Stands, clearance: float) -> SlideEntry | None:
    conditions = task.ready.setups[operation.setup]
    faces, wider = slid_along(stands.samples, operation.cutter, stands.held, conditions, clearance)
    return SlideEntry(faces=[f"F{number}" for number in faces], relieved_mm=wider) if faces else None


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


def costs_with(task: Task, columns: Columns, *, chosen: bool = False) -> tuple[Floats, Floats]:
    """The area (r,) of the samples of a task, and what each costs with columns (r, k), infinite where one does not serve it.

    Of columns that were `chosen` together, none cuts by its flank what others cut as a floor of their setup.
    """
    rows, every = task.rows, task.images(columns)
    area, serves = task.copies * np.nan_to_num(task.ready.samples.area[rows]), task.probes.kept(rows, every)
    may = serves & ~_floors_of_other_setups(task, every, serves) if chosen else serves
    cost = costs_of(every, _paces(task, every, serves), may, area, task.cutters, task.paths)
    if task.moved is not None:
        cost[task.moved[rows]] = np.inf
    # Of images the best one cuts a sample.
    return area, cost.reshape(len(rows), len(columns), task.times).min(axis=2)


def _floors_of_other_setups(task: Task, columns: Columns, serves: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Where columns (r, k) turn the part to cut by the flank what others cut as a floor of their setup, without a turn.

    Where the floor is one of the setup itself, such a wall is none anyway.
    """
    samples, rows, accuracy = task.ready.samples, task.rows, task.paths.accuracy
    normal, curvature, floor = samples.normal[rows], samples.curvature[rows], np.zeros((len(task.everywhere), len(rows)), bool)
    if len(floor) < 2 or not len(columns):
        return np.zeros(serves.shape, bool)
    setups = np.array([each.setup for each in task.ready.setups])[columns.setup]
    upright = (columns.axis * setups).sum(axis=1) >= math.cos(accuracy)
    for k in np.flatnonzero(upright).tolist():
        cutter, s, axis = task.cutters[columns.cutter[k]], columns.setup[k], np.broadcast_to(columns.axis[k], normal.shape)
        floor[s] |= serves[:, k] & on_floor(cutter, normal, curvature, axis, accuracy, task.paths.scallop)
    others = np.array([np.delete(floor, s, axis=0).any(axis=0) for s in range(len(floor))])[columns.setup].T & ~upright
    flank = np.zeros(serves.shape, bool)
    at = np.flatnonzero((others & serves).any(axis=1))
    if len(at):
        by_tip = paces(columns, rows[at], samples, task.cutters, task.paths, serves[at])
        flank[at] = task.walls.cached(columns, rows[at], serves[at]) > np.nan_to_num(by_tip)
    return others & flank


def _paces(task: Task, columns: Columns, serves: NDArray[np.bool_]) -> Floats:
    """What a mm of path cuts (r, k), mm2, of columns at the samples of a task that they serve: by the tip, or along a wall."""
    by_tip = paces(columns, task.rows, task.ready.samples, task.cutters, task.paths, serves)
    return np.fmax(by_tip, task.walls.cached(columns, task.rows, serves))


def worth_their_turn(task: Task, columns: Columns) -> Columns:
    """Leave out columns that serve less than `CRUMB` of the area alone and save less time than an orientation takes.

    The one that saves least goes first; what it served goes with the others.
    """
    (area, cost), columns_left = costs_with(task, columns, chosen=True), np.arange(len(columns))
    least = MINOR_AREA * float(area @ np.isfinite(cost).any(axis=1))
    turn = task.together(columns) / max(1, len(columns))
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
