"""Make the process of a plan: its steps, and what they leave by cause."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters.document.over_setups import OverSetups
from plan_cutters.document.remaining import faces_of, reasons, remaining, remaining_entry
from plan_cutters.document.repeats import repeats
from plan_cutters.document.shares import sample_areas
from plan_cutters.domain.figures import exact
from plan_cutters.domain.fillet import Fitting
from plan_cutters.domain.own_results import OwnResult
from plan_cutters.domain.verdicts import NO_REASON, REASONS, SHARP_EDGE
from plan_cutters.outcome import Answers, OperationPlan, Operations
from plan_cutters.plan_file.frozen import filled, vector
from plan_cutters.plan_file.model import CutterEntry
from plan_cutters.plan_file.nearest import nearest
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
    requested, clamping, name, seconds = float(area.sum()) + not_sampled, None, "", None
    parts = _Parts(ready, over, area, requested)
    if answers.operations is not None:
        chosen, entry = min(
            zip(answers.operations.plans, answers.operations.entry.plans, strict=True),
            key=lambda each: _PREFERRED.index(each[0].name),
        )
        done, name, seconds = (chosen.label >= 0) & ready.finished, entry.name, entry.seconds
        steps = [*parts.own(answers.operations, chosen, entry), *parts.planned(answers.operations, chosen, entry)]
        if seconds is not None:
            clamping = ready.options.setup_time * max(0, len({step.setup for step in steps}) - 1)
            seconds -= clamping
    else:
        runs = list(_runs(ready, entries, answers, over))
        done = np.logical_or.reduce([mine for *_, mine in runs]) if runs else np.zeros(len(area), bool)
        none = {"mode": "any", "angles_deg": None, "axis": None, "seconds": None, "clearance_mm": None}
        steps = [parts.step(mine, None, setup=setup, cutter=cutter, **none) for setup, cutter, mine in runs]
    advice = answers.mends.get(shown)
    left = remaining(
        ready, done, reasons(entries, over, steps, done), area, requested, () if advice is None else advice.steps, fitting
    )
    finished, exempt = float(area[done].sum()), None
    if ready.exempt is not None and ready.exempt.any():
        at_edges = np.where(ready.inside_bodies, 0.0, sampled)
        exempt = remaining_entry(ready, REASONS[SHARP_EDGE], ready.exempt, at_edges, requested)
    return ProcessEntry(
        steps=steps, plan=name, finished_mm2=finished, asked_mm2=requested, left=left, seconds=seconds, setup_seconds=clamping,
        finished_share=exact(finished / max(1e-300, requested), some=bool(done.any()), whole=not left), exempt=exempt,
    )  # fmt: skip


@dataclass(frozen=True, slots=True, eq=False)
class _Parts:
    """Steps are made of this: the areas (n,) of samples, and what is requested of all, mm2."""

    ready: Prepared
    over: OverSetups
    area: Floats
    requested: float

    def step(self, mine: NDArray[np.bool_], made: OperationEntry | None, **fields: Any) -> ProcessStep:
        """A step that finishes some samples (n,): with one axis, or each with that of its posture.

        What is not among the `fields` is as in its operation.
        """
        size, ready = float(self.area[mine].sum()), self.ready
        setup, cutter, axis = (fields[name] if name in fields else getattr(made, name) for name in ("setup", "cutter", "axis"))
        axes = self.over.each()[setup][1][cutter].axis[mine] if axis is None else np.tile(axis, (int(mine.sum()), 1))
        below = axes @ ready.setups[setup].setup < _BELOW
        return filled(
            ProcessStep, made, faces=faces_of(ready, mine, self.area), area_mm2=size,
            share=min(1.0, size / max(1e-300, self.requested)), below_mm2=float(self.area[mine][below].sum()),
            operation="" if made is None else made.id, **fields,
        )  # fmt: skip

    def planned(self, operations: Operations, plan: OperationPlan, entry: OperationPlanEntry) -> list[ProcessStep]:
        """The steps that were planned: by setup, fixed orientations first, by cutter, the largest area first."""
        by_cutter: dict[tuple[int, str], float] = {}
        for each in entry.operations:
            key = each.setup, each.cutter
            by_cutter[key] = by_cutter.get(key, 0.0) + each.area_mm2

        def place(e: OperationEntry | ProcessStep) -> tuple[object, ...]:
            return e.setup, e.mode != "fixed", -by_cutter[e.setup, e.cutter], e.cutter, -e.area_mm2

        # Operations that are images of each other are one step.
        together = dict[object, list[tuple[int, OperationEntry]]]()
        for k, each in sorted(enumerate(entry.operations), key=lambda ranked: place(ranked[1])):
            if each.step is None:
                together.setdefault(each.id if each.orbit is None else each.orbit, []).append((k, each))
        alone, planned = _alone(operations, plan), list[ProcessStep]()
        for images in together.values():
            images.sort(key=lambda ranked: [angle % 360.0 for angle in (ranked[1].angles_deg or {}).values()])
            ranks, same = [k for k, _ in images], [each for _, each in images]
            mine, clearance = np.isin(plan.label, ranks), [each.clearance_mm for each in same]
            gone = mine & (alone if operations.own else ~np.delete(plan.serves, ranks, axis=1).any(axis=1))
            single = len(same) == 1 and not operations.own
            repeat, by = repeats(self.ready, same, mine)
            planned.append(self.step(
                mine, same[0], seconds=_sum([each.seconds for each in same]), repeat=repeat, repeat_deg=by, take="share",
                clearance_mm=None if None in clearance else min(each for each in clearance if each is not None),
                alone_mm2=same[0].exclusive_mm2 if single else float(self.area[gone].sum()),
            ))  # fmt: skip
        # Those that are images of others count with all of them.
        return sorted(planned, key=place)

    def own(self, operations: Operations, plan: OperationPlan, entry: OperationPlanEntry) -> Iterator[ProcessStep]:
        """The planner's own steps in their order."""
        done = {each.step: (k, each) for k, each in enumerate(entry.operations)}
        all_done = np.concatenate([np.zeros(0, np.int64), *(each.rows for each in operations.own)])
        alone, process = _alone(operations, plan), self.ready.options.process
        for outcome in operations.own:
            k, made = done.get(outcome.number, (-2, None))
            known = outcome.angle is not None and np.isfinite(outcome.angle).all()
            none: dict[str, Any] = {"seconds": 0.0, "clearance_mm": None} if made is None else {}
            yield self.step(
                plan.label == k, made, setup=outcome.setup, mode=outcome.mode, cutter=outcome.cutter.id,
                angles_deg=_named(operations, outcome.angle) if known else None,
                axis=None if outcome.axis is None else vector(outcome.axis),
                take="first" if process is None else process.steps[outcome.number - 1].take,
                alone_mm2=float(self.area[alone & (plan.label == k)].sum()),
                own=self._own(operations, outcome, all_done), **none,
            )  # fmt: skip

    def _own(self, operations: Operations, outcome: OwnResult, done: Rows) -> OwnStepEntry:
        """What a step of the planner's own is asked, what none of them does of the faces that it names, and what would do.

        `done` (d,) is what all of them do together.
        """
        process, area, near = self.ready.options.process, self.area, outcome.nearest
        leaves, missed = list[RemainingEntry](), np.zeros(len(area), bool)
        missed[outcome.requested] = True
        missed[done] = False
        if process is not None and process.steps[outcome.number - 1].faces is not None:
            verdicts = self.over.each()[outcome.setup][1][outcome.cutter.id]
            cause = np.where(verdicts.reached, _OTHER, verdicts.reason.astype(np.int32))
            for code in np.unique(cause[missed]).tolist():
                word = OTHER_ORIENTATION if code == _OTHER else REASONS[code] if code != NO_REASON else NOT_PLANNED
                leaves.append(remaining_entry(self.ready, word, missed & (cause == code), area, self.requested))
        return OwnStepEntry(
            number=outcome.number, asked_mm2=float(area[outcome.requested].sum()), wrong=outcome.wrong,
            leaves=sorted(leaves, key=lambda each: (-each.area_mm2, each.cause)),
            nearest=None if near is None else NearestEntry(
                angles_deg=_named(operations, near.angle), axis=vector(near.axis), area_mm2=float(area[near.rows].sum())
            ),
        )  # fmt: skip


def _named(operations: Operations, angle: Floats | None) -> dict[str, float]:
    """The angles of the rotary axes by their names."""
    return {} if angle is None else dict(zip(operations.entry.rotary, angle.tolist(), strict=True))


def _alone(operations: Operations, plan: OperationPlan) -> NDArray[np.bool_]:
    """Samples (n,) that one step alone serves: one of the planner's own serves what it could finish of its faces."""
    times = plan.serves[:, [k for k, each in enumerate(plan.operations) if not each.step]].sum(axis=1)
    for outcome in operations.own:
        times[outcome.serves] += 1
    return np.asarray(times == 1)


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
