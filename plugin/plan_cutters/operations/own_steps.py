"""The planner's own process: each step does what it does as it stands, in its order; what they leave is planned behind them."""

import math
from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters.domain.operations import Columns, columns_of
from plan_cutters.domain.own_process import Nearest, OwnProcess, OwnResult, OwnStep, cutter_of
from plan_cutters.domain.verdicts import UNJUDGED
from plan_cutters.operations.orientations import DIGITS, Orientations, apart, directions
from plan_cutters.operations.plans import Reserved, costs_with, plan_with
from plan_cutters.operations.probes import Probes
from plan_cutters.operations.task import Task
from plan_cutters.operations.walls import Walls
from plan_cutters.outcome import OperationPlan

Rows = NDArray[np.int64]
#: An orientation that would do is looked for in rings about the one that was written, so far apart and as far as, deg.
_RING, _FARTHEST = 5.0, 60.0
#: Samples by which such orientations are compared first.
_COMPARED = 120
#: A step that leaves less of what is requested of it does all, as a share: crumbs at borders are no fault.
_ALL = 0.001
#: In the place of a step's number: a sample is divided among steps that share it.
_SHARED = -1


def own_plan(task: Task, process: OwnProcess, planned: Callable[[Task], Columns]) -> tuple[OperationPlan, tuple[OwnResult, ...]]:
    """Make the plan of a process that a person wrote.

    `task`: its cutters are all that the steps name, and others. `planned`: gives the fixed orientations of what the steps leave,
    as a task of its own. The plan is called `process`, and its operations know their steps; behind it is what each step does, in
    their order.
    """
    outcome, owner = _judged(task, process)
    barred = {
        task.cutters.index(cutter_of(each.cutter, task.cutters, "forbid")): np.isin(task.ready.samples.face, each.faces)
        for each in process.forbidden
    }
    # What is planned goes by the verdicts without those of cutters where they are forbidden.
    everywhere, columns = [dict(each) for each in task.everywhere], task.no_columns
    for c, rows in barred.items():
        for its in everywhere:
            known = its[task.cutters[c]]
            its[task.cutters[c]] = replace(known, verdict=np.where(rows, UNJUDGED, known.verdict).astype(np.uint8))
    others = replace(task, everywhere=tuple(everywhere))
    step = list[int]()
    for each in outcome:
        if each.axis is not None and each.angle is not None and len(each.rows):
            cutter = task.cutters.index(each.cutter)
            columns = columns.and_(columns_of(each.axis[None], each.angle[None], cutter, each.setup))
            step.append(each.number)
    if process.rest == "plan":
        more = planned(_rest(others, owner, barred))
        columns, step = columns.and_(more), [*step, *([0] * len(more))]
    number = np.array(step, np.int64)

    taken = {each.number: each.rows for each in outcome}

    def rule(serves: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Each sample goes with the step that takes it, or one of those that share it; what none takes, with what was planned."""
        may = serves & (owner[:, None] == number[None, :])
        for j, rows in ((j, taken[each]) for j, each in enumerate(step) if each):
            may[rows, j] = serves[rows, j]
        for c, samples in barred.items():
            may[np.ix_(samples & (owner == 0), (columns.cutter == c) & (number == 0))] = False
        return may

    moving = tuple(
        (each.number, task.cutters.index(each.cutter), each.setup, each.rows) for each in outcome if each.mode == "simultaneous"
    )
    reserved = Reserved(tuple(step), moving, process.rest == "leave", others.everywhere)
    plan = plan_with(task, "process", columns, rule, reserved)
    place = {each.step: k for k, each in enumerate(plan.operations)}
    return plan, tuple(replace(each, rows=np.flatnonzero(plan.label == place.get(each.number, -2))) for each in outcome)


def _rest(task: Task, owner: NDArray[np.int64], barred: Mapping[int, NDArray[np.bool_]]) -> Task:
    """What no step takes, as a task of its own."""
    ready, rows = task.ready, task.rows[owner[task.rows] == 0]
    open_ = ready.machinable
    reached = np.logical_or.reduce(
        [open_[s] & verdicts[cutter].reached for s, verdicts in enumerate(task.everywhere) for cutter in task.cutters]
    )
    probes = Probes(ready.samples, task.cutters, ready.setups, open_, barred, task.everywhere)
    return task.probed_by(probes, Walls(probes, task.paths), rows=rows[reached[rows]])


def _judged(task: Task, process: OwnProcess) -> tuple[tuple[OwnResult, ...], NDArray[np.int64]]:
    """Judge the steps in their order: each takes what it serves of its faces, if no step before it has taken that.

    Behind them come those that share: what fixed ones serve is divided later, and simultaneous ones take what is left.
    """
    owner, outcome = np.zeros(len(task.ready.samples), np.int64), list[OwnResult]()
    for step in sorted(process.steps, key=lambda each: (each.take == "share", each.take == "share" and each.mode != "fixed")):
        mine = task.rows if step.faces is None else task.rows[np.isin(task.ready.samples.face[task.rows], step.faces)]
        one = _moving(task, step, mine) if step.mode == "simultaneous" else _fixed(task, step, mine)
        divided = step.take == "share" and step.mode == "fixed"
        open_ = owner <= 0 if divided else owner == 0
        one = replace(one, requested=mine[open_[mine]], rows=one.serves[open_[one.serves]])
        owner[one.rows] = _SHARED if divided else step.number
        outcome.append(one)
    outcome.sort(key=lambda each: each.number)
    return tuple(_helped(task, each, process.steps[each.number - 1], owner) for each in outcome), owner


def _moving(task: Task, step: OwnStep, rows: Rows) -> OwnResult:
    """A simultaneous step over samples (m,) of its faces: it serves what its cutter reaches in its setup with any posture."""
    cutter = cutter_of(step.cutter, task.cutters, f"step {step.number}")
    serves = task.everywhere[step.setup][cutter].reached[rows] & task.ready.machinable[step.setup][rows]
    return OwnResult(step.number, step.setup, "simultaneous", cutter, None, None, rows, rows[serves], rows[serves])


def _fixed(task: Task, step: OwnStep, rows: Rows) -> OwnResult:
    """A fixed step over samples (m,) of its faces: it serves what its cutter finishes with its axis."""
    cutter, where = cutter_of(step.cutter, task.cutters, f"step {step.number}"), task.orientations[step.setup]
    angle, axis, held = _set_to(where, step)
    outcome = OwnResult(step.number, step.setup, "fixed", cutter, axis, angle, rows, rows[:0], rows[:0])
    if not held:
        return replace(outcome, wrong="the machine cannot hold this orientation")
    return replace(outcome, serves=rows[_serves(task, outcome, rows, axis[None], angle[None])[:, 0]])


def _helped(task: Task, outcome: OwnResult, step: OwnStep, owner: NDArray[np.int64]) -> OwnResult:
    """A fixed step with the orientation next to it that would do, where no step finishes much of what it is requested."""
    if outcome.axis is None or (step.faces is None and len(outcome.rows)):
        return outcome
    area, requested = np.nan_to_num(task.ready.samples.area), outcome.requested
    reached = task.everywhere[outcome.setup][outcome.cutter].reached[requested] & task.ready.machinable[outcome.setup][requested]
    missed = requested[reached & (owner[requested] == 0)]
    if float(area[missed].sum()) <= _ALL * float(area[requested].sum()):
        return outcome
    return replace(outcome, nearest=_nearest(task, task.orientations[outcome.setup], outcome, requested[reached]))


def _set_to(where: Orientations, step: OwnStep) -> tuple[Floats, Floats, bool]:
    """The angles (k,), deg, and the axis (3,) of a step, and whether the machine can hold them."""
    if step.angles is not None:
        angle = np.array([dict(step.angles)[name] for name in where.names])
        angles, axes = where.set_to(angle[None])
        if len(axes):
            return angles[0], axes[0], True
        return angle, where.kinematics.axis(np.radians(angle)[None])[0], False
    wanted = np.array(step.axis)
    angles, axes = where.near(wanted[None])
    # A control shows thousandths of a degree: what it shows is judged.
    if len(axes) and float(axes[0] @ wanted) >= math.cos(1e-4):
        return angles[0], axes[0], True
    return np.full(len(where.names), np.nan), wanted, False


def _serves(task: Task, outcome: OwnResult, rows: Rows, axis: Floats, angle: Floats) -> NDArray[np.bool_]:
    """Where the cutter of a step cuts samples (m,) with some axes: (m, k)."""
    columns = columns_of(axis, angle, task.cutters.index(outcome.cutter), outcome.setup)
    return np.isfinite(costs_with(replace(task, rows=rows), columns)[1])


def _nearest(task: Task, where: Orientations, outcome: OwnResult, wanted: Rows) -> Nearest | None:
    """The orientation next to a step's that serves all that its cutter reaches of its faces, or else the most; None: none."""
    written = np.asarray(outcome.axis)
    rings = [where.about(written[None], math.radians(angle)) for angle in np.arange(_RING, _FARTHEST + 1.0, _RING).tolist()]
    angle, axis = where.near(np.concatenate([directions(task.ready.samples, where.conditions.setup), *rings]))
    distinct = apart(axis)
    angle, axis = angle[distinct], axis[distinct]
    cosine = axis @ written
    near = np.argsort(-cosine, kind="stable")[: int((cosine >= math.cos(math.radians(_FARTHEST))).sum())]
    if not len(near) or not len(wanted):
        return None
    few = wanted[:: max(1, len(wanted) // _COMPARED)]
    area = np.nan_to_num(task.ready.samples.area)
    size = area[few] @ _serves(task, outcome, few, axis[near], angle[near])
    best = near[int(size.argmax())]
    # As short as it does as much: whole degrees first.
    angles, axes = where.set_to(np.stack([np.round(angle[best], digits) for digits in (0, 1, DIGITS)]))
    served = _serves(task, outcome, wanted, axes, angles)
    best = int(np.argmax(served.T @ area[wanted] >= (served.T @ area[wanted]).max() * (1.0 - _ALL)))
    angle, axis, rows = angles, axes, wanted[served[:, best]]
    if float(area[rows].sum()) <= float(area[outcome.rows].sum()) * (1.0 + _ALL):
        return None
    return Nearest(angle[best], axis[best], rows)
