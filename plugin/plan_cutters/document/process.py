"""Make the process of a plan: its steps, and what they leave by cause."""

from collections.abc import Iterator, Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters.document.over_setups import OverSetups
from plan_cutters.document.remaining import faces_of, reasons, remaining, remaining_entry
from plan_cutters.document.repeats import repeats
from plan_cutters.document.shares import sample_areas
from plan_cutters.domain.fillet import Fitting
from plan_cutters.domain.own_results import OwnResult
from plan_cutters.domain.verdicts import NO_REASON, REASONS, SHARP_EDGE
from plan_cutters.found import Answers, OperationPlan, Operations
from plan_cutters.plan_file.frozen import filled, vector
from plan_cutters.plan_file.model import CutterEntry
from plan_cutters.plan_file.nearest import nearest
from plan_cutters.plan_file.numbers import exact
from plan_cutters.plan_file.operations import OperationEntry, OperationPlanEntry
from plan_cutters.plan_file.process import (
    NOT_PLANNED,
    OTHER_ORIENTATION,
    NearestEntry,
    OwnStepEntry,
    ProcessEntry,
    ProcessStep,
    RemainingEntry,
)
from plan_cutters.scene.preparation import Prepared

#: Which plan of operations is the process: the first of these that there is.
_PREFERRED = ("process", "fastest", "fewest")
Rows = NDArray[np.int64]
#: A number of a reason that is none: another orientation would do.
_OTHER = 1000
#: Cosine from the setup axis under which a tool comes from below: walls that are drawn out of true by half a degree are walls.
_BELOW = -0.01


def process_entry(
    ready: Prepared, entries: Sequence[CutterEntry], answers: Answers, over: OverSetups, shown: str,
    fitting: Fitting | None = None,
) -> ProcessEntry:  # fmt: skip
    """Put together what the given cutters, setups and operations finish.

    Parameters
    ----------
    ready : Prepared
    entries : sequence of CutterEntry
        Of all cutters, from the most wanted down.
    answers : Answers
        The plan of operations is the process where there is one, else the fewest runs of cutters and setups.
    over : OverSetups
    shown : str
        Id of the cutter that the plan shows: its next steps are told.
    fitting : callable, optional
        Finds the usual sizes that fit where cutters gouge.
    """
    sampled, not_sampled = sample_areas(entries[0].faces, ready.samples, ready.scene.part)
    area = np.where(ready.not_required, 0.0, sampled)
    requested, clamping, name = float(area.sum()) + not_sampled, None, ""
    if answers.operations is not None:
        chosen, entry = _preferred(answers.operations)
        done = (chosen.label >= 0) & ready.finished
        steps, seconds = _operated(ready, answers.operations, chosen, entry, over, area, requested), entry.seconds
        name = entry.name
        if seconds is not None:
            clamping = ready.options.setup_time * max(0, len({step.setup for step in steps}) - 1)
            seconds -= clamping
    else:
        runs, seconds = list(_runs(ready, entries, answers, over)), None
        done = np.logical_or.reduce([mine for *_, mine in runs]) if runs else np.zeros(len(area), bool)
        steps = [
            _step(ready, over, area, requested, mine, None, setup=setup, mode="any", cutter=cutter, angles_deg=None, axis=None,
                  seconds=None, clearance_mm=None)
            for setup, cutter, mine in runs
        ]  # fmt: skip
    advice = answers.mends.get(shown)
    left = remaining(
        ready, done, reasons(entries, over, steps, done), area, requested, () if advice is None else advice.steps, fitting
    )
    finished = float(area[done].sum())
    share = exact(finished / max(1e-300, requested), some=bool(done.any()), whole=not left)
    return ProcessEntry(
        steps=steps, plan=name, finished_share=share, finished_mm2=finished, asked_mm2=requested, left=left, seconds=seconds,
        setup_seconds=clamping, exempt=_exempt(ready, sampled, requested),
    )  # fmt: skip


def _exempt(ready: Prepared, sampled: Floats, requested: float) -> RemainingEntry | None:
    """What is not required at sharp inside edges; None where that is nothing."""
    if ready.exempt is None or not ready.exempt.any():
        return None
    return remaining_entry(ready, REASONS[SHARP_EDGE], ready.exempt, np.where(ready.inside_bodies, 0.0, sampled), requested)


def _preferred(operations: Operations) -> tuple[OperationPlan, OperationPlanEntry]:
    """The plan of operations that is recommended, in arrays and as it is in the plan file."""
    return min(zip(operations.plans, operations.entry.plans, strict=True), key=lambda each: _PREFERRED.index(each[0].name))


def _operated(
    ready: Prepared, operations: Operations, plan: OperationPlan, entry: OperationPlanEntry, over: OverSetups, area: Floats,
    requested: float,
) -> list[ProcessStep]:  # fmt: skip
    """The steps of a plan of operations: the planner's own in their order, then by setup, fixed orientations first, by cutter,
    the largest area first.
    """
    by_cutter: dict[tuple[int, str], float] = {}
    for each in entry.operations:
        key = each.setup, each.cutter
        by_cutter[key] = by_cutter.get(key, 0.0) + each.area_mm2
    rank = {id(each): k for k, each in enumerate(entry.operations)}
    ordered = sorted(
        (each for each in entry.operations if each.step is None),
        key=lambda e: (e.setup, e.mode != "fixed", -by_cutter[e.setup, e.cutter], e.cutter, -e.area_mm2, rank[id(e)]),
    )
    alone = _alone(plan, operations.own, len(area))
    planned = list[ProcessStep]()
    for same in _together(ordered):
        first, ranks = same[0], [rank[id(each)] for each in same]
        mine, seconds, clearance = (
            np.isin(plan.label, ranks),
            [each.seconds for each in same],
            [each.clearance_mm for each in same],
        )
        repeat, by = repeats(ready, same, mine)
        planned.append(_step(
            ready, over, area, requested, mine, first, seconds=_sum(seconds), repeat=repeat, repeat_deg=by,
            clearance_mm=None if None in clearance else min(each for each in clearance if each is not None),
            operation=first.id, take="share", alone_mm2=_gone(plan, same, ranks, mine, area, alone if operations.own else None),
        ))  # fmt: skip
    # Those that are images of others count with all of them.
    planned.sort(key=lambda s: (s.setup, s.mode != "fixed", -by_cutter[s.setup, s.cutter], s.cutter, -s.area_mm2))
    done = {each.step: (k, each) for k, each in enumerate(entry.operations)}
    own, all_done = [], np.concatenate([np.zeros(0, np.int64), *(each.rows for each in operations.own)])
    for outcome in operations.own:
        k, made = done.get(outcome.number, (-2, None))
        known, names = outcome.angle is not None and np.isfinite(outcome.angle).all(), operations.entry.rotary
        angles = dict(zip(names, outcome.angle.tolist(), strict=True)) if outcome.angle is not None and known else None
        none = {"seconds": 0.0, "clearance_mm": None} if made is None else {}
        own.append(
            _step(ready, over, area, requested, plan.label == k, made, setup=outcome.setup, mode=outcome.mode,
                  cutter=outcome.cutter.id, angles_deg=angles, axis=None if outcome.axis is None else vector(outcome.axis),
                  operation="" if made is None else made.id, take=_take(ready, outcome),
                  alone_mm2=float(area[alone & (plan.label == k)].sum()),
                  own=_own_entry(ready, over, area, requested, outcome, names, all_done), **none)
        )  # fmt: skip
    return [*own, *planned]


def _take(ready: Prepared, outcome: OwnResult) -> Literal["first", "share"]:
    process = ready.options.process
    return "first" if process is None else process.steps[outcome.number - 1].take


def _alone(plan: OperationPlan, own: Sequence[OwnResult], count: int) -> NDArray[np.bool_]:
    """Samples (n,) that one step alone serves: one of the planner's own serves what it could finish of its faces."""
    times = np.zeros(count, np.int64)
    for outcome in own:
        times[outcome.serves] += 1
    planned = [k for k, each in enumerate(plan.operations) if not each.step]
    return times + plan.serves[:, planned].sum(axis=1) == 1


def _own_entry(
    ready: Prepared, over: OverSetups, area: Floats, requested: float, outcome: OwnResult, names: tuple[str, str], done: Rows
) -> OwnStepEntry:
    """What a step of the planner's own is asked, what none of them does of the faces that it names, and what would do.

    `done` (d,) is what all of them do together.
    """
    process = ready.options.process
    leaves, missed = list[RemainingEntry](), np.zeros(len(area), bool)
    missed[outcome.requested] = True
    missed[done] = False
    if process is not None and process.steps[outcome.number - 1].faces is not None:
        verdicts = over.each()[outcome.setup][1][outcome.cutter.id]
        cause = np.where(verdicts.reached, _OTHER, verdicts.reason.astype(np.int32))
        for code in np.unique(cause[missed]).tolist():
            word = OTHER_ORIENTATION if code == _OTHER else REASONS[code] if code != NO_REASON else NOT_PLANNED
            leaves.append(remaining_entry(ready, word, missed & (cause == code), area, requested))
    near = outcome.nearest
    nearest_ = None if near is None else NearestEntry(
        angles_deg=dict(zip(names, near.angle.tolist(), strict=True)), axis=vector(near.axis),
        area_mm2=float(area[near.rows].sum())
    )  # fmt: skip
    return OwnStepEntry(
        number=outcome.number, asked_mm2=float(area[outcome.requested].sum()), wrong=outcome.wrong,
        leaves=sorted(leaves, key=lambda each: (-each.area_mm2, each.cause)), nearest=nearest_,
    )  # fmt: skip


def _gone(
    plan: OperationPlan, same: Sequence[OperationEntry], ranks: Sequence[int], mine: NDArray[np.bool_], area: Floats,
    alone: NDArray[np.bool_] | None,
) -> float:  # fmt: skip
    """What no other step serves of the samples (n,) of one; `alone` (n,) where some steps are the planner's own."""
    if alone is not None:
        return float(area[alone & mine].sum())
    if len(same) == 1:
        return same[0].exclusive_mm2
    return float(area[mine & ~np.delete(plan.serves, ranks, axis=1).any(axis=1)].sum())


def _together(operations: Sequence[OperationEntry]) -> list[list[OperationEntry]]:
    """Operations of one step each, those that are images of each other in one."""
    steps: dict[object, list[OperationEntry]] = {}
    for each in operations:
        steps.setdefault(each.id if each.orbit is None else each.orbit, []).append(each)
    return [sorted(same, key=_first_angles) for same in steps.values()]


def _first_angles(operation: OperationEntry) -> list[float]:
    return [angle % 360.0 for angle in (operation.angles_deg or {}).values()]


def _sum(seconds: Sequence[float | None]) -> float | None:
    known = [each for each in seconds if each is not None]
    return sum(known) if len(known) == len(seconds) else None


def _runs(
    ready: Prepared, entries: Sequence[CutterEntry], answers: Answers, over: OverSetups
) -> Iterator[tuple[int, str, NDArray[np.bool_]]]:
    """The fewest runs, each with its setup, its cutter, and the samples (n,) that none before it reaches."""
    verdicts = [each for _, each in over.each()]
    if answers.least_set is None:
        pairs = [(0, nearest(entries).id)]
    else:
        pairs = [(run.number, run.cutter.id) for run in answers.least_set.runs]
    open_, done = ready.machinable, np.zeros(len(ready.samples), bool)
    for setup, cutter in pairs:
        mine = verdicts[setup][cutter].reached & open_[setup] & ~done
        done |= mine
        if mine.any():
            yield setup, cutter, mine


def _step(
    ready: Prepared, over: OverSetups, area: Floats, requested: float, mine: NDArray[np.bool_], made: OperationEntry | None,
    **fields: Any,
) -> ProcessStep:  # fmt: skip
    """A step that finishes some samples (n,): with one axis, or each with that of its posture.

    What is not among the `fields` is as in its operation.
    """
    size = float(area[mine].sum())
    setup, cutter, axis = (fields[name] if name in fields else getattr(made, name) for name in ("setup", "cutter", "axis"))
    axes = over.each()[setup][1][cutter].axis[mine] if axis is None else np.tile(axis, (int(mine.sum()), 1))
    below = axes @ ready.setups[setup].setup < _BELOW
    return filled(
        ProcessStep, made, faces=faces_of(ready, mine, area), area_mm2=size, share=min(1.0, size / max(1e-300, requested)),
        below_mm2=float(area[mine][below].sum()), **fields,
    )  # fmt: skip
