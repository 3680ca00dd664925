"""Entries on setups and the process: verdicts over all setups, where the part stands, steps, and what they leave by cause."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from cad_io.arrays import Floats, Ints, SurfaceSamples
from plan_cutters.document.build import sample_areas
from plan_cutters.document.features import ends_in_a_point
from plan_cutters.document.stands import setups_and_stock
from plan_cutters.domain.figures import exact
from plan_cutters.domain.machine import Axis, Machine
from plan_cutters.domain.operations import Strategy
from plan_cutters.domain.own_process import OwnResult
from plan_cutters.domain.placement import Placement
from plan_cutters.domain.preference import by_radius
from plan_cutters.domain.standard_tools import Fitting
from plan_cutters.domain.travel import Travel
from plan_cutters.domain.verdicts import COLLISION, LOCAL_GOUGE, NO_REASON, REAR_GOUGE, REASONS, SHARP_EDGE, Verdicts
from plan_cutters.judging.limits import AXES, within_limits
from plan_cutters.options import Options
from plan_cutters.outcome import Answers, OperationPlan, Operations, Step
from plan_cutters.plan_file import operations as schema
from plan_cutters.plan_file.frozen import Vector, filled, vector
from plan_cutters.plan_file.model import CutterEntry, LinearEntry, nearest
from plan_cutters.plan_file.part_info import AxisTravel, BeyondTravel, PlacementEntry, SetupEntry, TravelEntry
from plan_cutters.plan_file.reasons import operation_colour
from plan_cutters.plan_file.words.answers import typed_size
from plan_cutters.plan_file.words.names import kind
from plan_cutters.plan_file.words.operations import numbered
from plan_cutters.scene.preparation import Prepared


class OverSetups(NamedTuple):
    """The verdicts of each cutter, by its id, in one setup or another; the setup that serves each sample, (n,) int32; and of each
    setup, the first one first, its axis and what each cutter reaches there.
    """

    reaches: dict[str, Verdicts]
    served_in: dict[str, Ints]
    each: tuple[tuple[Vector, dict[str, Verdicts]], ...]


def setup_table(ready: Prepared, within: Sequence[NDArray[np.bool_]], over: OverSetups) -> list[SetupEntry]:
    """Tell how much is within the axis limits and is reached in each setup asked for, `within` (n,) each, and how much would be
    within them in each along the part's own axes.
    """
    if not ready.conditions.machine.limited:
        return []
    finished = ready.finished
    whole = float(ready.samples.area[finished].sum())

    def share(mine: NDArray[np.bool_]) -> float:
        return min(1.0, float(ready.samples.area[mine].sum()) / whole) if whole > 0.0 else 0.0

    entries: dict[Vector, SetupEntry] = {}
    for (axis, each), inside in zip(over.each, within, strict=False):
        mine = finished & np.logical_or.reduce([verdicts.reached for verdicts in each.values()])
        count, reached, part = int(inside.sum()), int(mine.sum()), share(mine)
        entries.setdefault(axis, SetupEntry(axis=axis, within=count, share=share(inside), reached=reached, reached_share=part))
    for axis in AXES:
        if axis not in entries:
            mine = finished & within_limits(ready.samples, ready.cutters, ready.conditions, axis)
            entries[axis] = SetupEntry(axis=axis, within=int(mine.sum()), share=share(mine))
    return list(entries.values())


def placement_entry(placement: Placement | None) -> PlacementEntry | None:
    """How a part stands."""
    if placement is None:
        return None
    file = None if placement.proposed else placement.file or None
    return PlacementEntry(file=file, x=placement.x, origin_mm=placement.origin, clamped=list(placement.clamped))


def linear_entries(ready: Prepared) -> list[LinearEntry]:
    """The linear axes of the machine in the part's frame of the first setup, and how far the target samples reach along each."""
    entries = []
    for axis in ready.options.machine.linear:
        direction = np.array(axis.direction) @ ready.conditions.frame
        along = ready.samples.point[ready.finished] @ direction
        extent = float(np.ptp(along)) if len(along) else 0.0
        entries.append(filled(LinearEntry, axis, direction=vector(direction), limits_mm=_limits(axis), extent_mm=extent))
    return entries


def _limits(axis: Axis) -> tuple[float | None, float | None]:
    low, high = (float(end) if np.isfinite(end) else None for end in axis.limits or (np.inf, np.inf))
    return low, high


def travel_entry(machine: Machine, travel: Travel, reach: Verdicts, samples: SurfaceSamples) -> TravelEntry:
    """Give the travel of the linear axes that a cutter needs."""
    known = reach.reached & np.isfinite(travel.position).all(axis=1)
    axes, worst = [], []
    for k, axis in enumerate(machine.linear):
        position, beyond = travel.position[known, k], np.where(known, travel.beyond[:, k], 0.0)
        least, most = (float(position.min()), float(position.max())) if len(position) else (None, None)
        outside = int((beyond > 0.0).sum())
        axes.append(AxisTravel(name=axis.name, limits_mm=_limits(axis), least_mm=least, most_mm=most, outside=outside))
        if outside:
            at = int(beyond.argmax())
            point, face = vector(samples.point[at]), f"F{samples.face[at]}"
            worst.append(BeyondTravel(point=point, face=face, axis=axis.name, beyond_mm=float(beyond[at])))
    unknown, outside = int((reach.reached & ~known).sum()), int((travel.outside & known).sum())
    worst.sort(key=lambda each: -each.beyond_mm)
    return TravelEntry(judged=int(known.sum()), unknown=unknown, outside=outside, axes=axes, worst=worst)


#: Angles that are written to three digits are equal within this, deg.
_WRITTEN = 0.0021
#: Share of the area of a step that must have an image in it, and how well normals agree.
_AGREES, _NORMAL = 0.98, math.cos(math.radians(10.0))
#: Directions are one within this.
_SAME = 1e-6


def repeats(
    ready: Prepared, same: Sequence[schema.OperationEntry], mine: NDArray[np.bool_]
) -> tuple[int, dict[str, float] | None]:
    """How often a step is done, and by how much one rotary axis turns from one time to the next; None where several turn.

    `same` are the operations of the step: images of each other, from the first angle up; `mine` (n,) its samples.
    """
    if same[0].mode == "simultaneous":
        return _moving(ready, same[0].setup, mine)
    if len(same) == 1:
        return 1, None
    angles = [each.angles_deg or {} for each in same]
    for name in angles[0]:
        others = [key for key in angles[0] if key != name]
        turned = np.sort([each[name] % 360.0 for each in angles])
        steps = np.diff(turned)
        if all(abs(each[key] - angles[0][key]) <= _WRITTEN for each in angles for key in others):
            step, number = float(steps.min()), len(same)
            # One that is left out leaves a gap: then no angle leads from each to the next.
            parts = max(1, round(360.0 / step)) if step > _WRITTEN else 1
            even = np.ptp(steps) <= _WRITTEN * number and abs(step - 360.0 / parts) <= _WRITTEN
            return number, {name: round(360.0 / parts, 3)} if even and parts >= number else None
    return len(same), None


def _moving(ready: Prepared, setup: int, mine: NDArray[np.bool_]) -> tuple[int, dict[str, float] | None]:
    """The same of simultaneous motion: a rotation of the whole part repeats it, where limits and fixtures are kept as well.

    Nearly all of the area of the samples is carried onto others of them.
    """
    conditions, samples, rows = ready.setups[setup], ready.samples, np.flatnonzero(mine)
    kinematics = conditions.kinematics
    if ready.copies is None or kinematics is None or len(kinematics.direction) != 2 or not len(rows):
        return 1, None
    point, normal, area = samples.point[rows], samples.normal[rows], np.nan_to_num(samples.area[rows])
    keeps = dict(zip(map(id, ready.copies.motions), ready.copies.unchanged[setup], strict=True))
    for each in ready.patterns:
        motion = each.motions[0]
        axis = motion.axis if each.whole and each.kind == "rotation" else None
        if axis is None or not all(keeps.get(id(motion), False) for motion in each.motions):
            continue
        if abs(abs(axis[1] @ kinematics.direction[0]) - 1.0) > _SAME:
            continue
        near = cKDTree(point).query(motion.points(point), k=min(8, len(rows)), distance_upper_bound=samples.max_gap)
        distance, which = (part.reshape(len(rows), -1) for part in near)
        is_near = np.isfinite(distance)
        alike = (motion.directions(normal)[:, None] * normal[np.where(is_near, which, 0)]).sum(axis=2) >= _NORMAL
        if area[(is_near & alike).any(axis=1)].sum() >= _AGREES * area.sum():
            return each.order, {conditions.machine.rotary[0].name: round(360.0 / each.order, 3)}
    return 1, None


Rows = NDArray[np.int64]

#: A number of a reason that is none: a step for it would be hardly any.
_SHORT = 1001
#: Reasons against which a smaller size is tried.
_BY_SIZE = (LOCAL_GOUGE, REAR_GOUGE, COLLISION)
#: A face that has less of an area does not speak for the others, mm2, as long as these have most of it.
_SPEAKS, _MOST = 1.0, 0.5
#: A help that does less of an area is not told.
_HELPS = 0.01


class Reasons(NamedTuple):
    """Why each sample (n,) is left, and for which of some cutters that holds, -1 for none."""

    reason: Ints
    by: Ints
    cutters: list[str]


def reasons(
    entries: Sequence[CutterEntry], over: OverSetups, steps: Sequence[schema.ProcessStep], done: NDArray[np.bool_]
) -> Reasons:
    """Why each sample (n,) is left: by the finest cutter of the process that has a reason, else by any.

    A sharp inside edge is no cause of what a finer cutter leaves for another one: it enters the edge farther.
    """
    used, finest_first = {each.cutter for each in steps}, sorted(entries, key=lambda e: (e.radius, e.corner_radius))

    def first_of(some: Sequence[CutterEntry]) -> tuple[Ints, Ints]:
        reason, by = np.full(len(done), NO_REASON, np.int32), np.full(len(done), -1, np.int32)
        for entry in some:
            verdicts = over.reaches[entry.id]
            open_ = ~done & (reason == NO_REASON) & verdicts.not_reached
            reason[open_], by[open_] = verdicts.reason[open_], finest_first.index(entry)
        return reason, by

    reason, by = first_of(sorted(finest_first, key=lambda e: e.id not in used))
    finest, by_finest = first_of(finest_first)
    finer = (reason == SHARP_EDGE) & ~np.isin(finest, (SHARP_EDGE, NO_REASON))
    reason, by = np.where(finer, finest, reason), np.where(finer, by_finest, by)
    return Reasons(reason, by, [entry.id for entry in finest_first])


def remaining(
    ready: Prepared, done: NDArray[np.bool_], why: Reasons, area: Floats, requested: float, steps: Sequence[Step],
    fitting: Fitting,
) -> list[schema.RemainingEntry]:  # fmt: skip
    """List what is left by cause, the largest area first.

    `done` (n,): samples that are finished; `area` (n,), mm2, and `requested` that of all; `steps` that are known, as they stand
    in the plan file; `fitting` finds the usual sizes that fit.
    """
    samples, entries = ready.samples, list[schema.RemainingEntry]()
    cutters, left = {cutter.id: cutter for cutter in ready.cutters}, ready.finished & ~done
    for code in np.unique(why.reason[left]).tolist():
        mine = left & (why.reason == code)
        cause = schema.SHORT_STEP if code == _SHORT else REASONS[code] if code != NO_REASON else schema.NOT_PLANNED
        by_size: dict[str, Any] = {}
        if code in _BY_SIZE:
            rows = np.flatnonzero(mine)
            # Without the samples of faces that have hardly any of their area, unless these have most of it.
            large = np.bincount(samples.face[rows], area[rows])[samples.face[rows]] >= _SPEAKS
            rows = rows[large] if area[rows[large]].sum() >= _MOST * area[rows].sum() and large.any() else rows
            cutter = cutters[why.cutters[int(np.bincount(why.by[rows], area[rows]).argmax())]]
            fits = fitting(cutter, rows, area)
            by_size["points"] = _points(ready, rows, area)
            by_size["fits"] = None if fits is None else [
                schema.FitEntry(cutter=c.id, kind=kind(c), size=typed_size(c), diameter_mm=2.0 * c.radius, share=share)
                for c, share in fits
            ]  # fmt: skip
        helped = _helped(steps, mine, area)
        entries.append(remaining_entry(ready, cause, mine, area, requested, helped=helped, **by_size))
    unjudged = samples.unjudged >= 0
    if unjudged.any() or samples.empty:
        empty = [number for number, _ in samples.empty]
        entries.append(remaining_entry(ready, schema.UNJUDGED_CAUSE, unjudged, area, requested, empty))
    return sorted(entries, key=lambda each: (-each.area_mm2, each.cause))


def _points(ready: Prepared, rows: Rows, area: Floats) -> schema.PointsEntry | None:
    """The inside cones with a point among the faces of some samples (m,)."""
    by_face = {number: rows[ready.samples.face[rows] == number] for number in np.unique(ready.samples.face[rows]).tolist()}
    sizes = {number: float(area[mine].sum()) for number, mine in by_face.items() if ends_in_a_point(ready, number, mine)}
    if not sizes:
        return None
    faces = [f"F{number}" for number in sorted(sizes, key=lambda number: (-sizes[number], number))]
    return schema.PointsEntry(faces=faces, share=min(1.0, sum(sizes.values()) / max(1e-300, float(area[rows].sum()))))


def _helped(steps: Sequence[Step], mine: NDArray[np.bool_], area: Floats) -> list[schema.HelpEntry]:
    """How much of some samples (n,) each step frees, the most first."""
    whole, each = float(area[mine].sum()), list[schema.HelpEntry]()
    for k, step in enumerate(steps):
        freed = step.freed[mine[step.freed]]
        share = min(1.0, float(area[freed].sum()) / max(1e-300, whole))
        if share >= _HELPS:
            each.append(schema.HelpEntry(step=k, share=share))
    return sorted(each, key=lambda entry: (-entry.share, entry.step))


def remaining_entry(
    ready: Prepared, cause: str, mine: NDArray[np.bool_], area: Floats, requested: float, empty: Sequence[int] = (), **more: Any
) -> schema.RemainingEntry:
    """The entry of some samples (n,) that are left for one cause, and of faces without samples; with more of its fields."""
    samples, missing = ready.samples, float(sum(ready.scene.part.faces[number - 1].area for number in empty))
    whole = float(area[mine].sum()) + (missing if np.isfinite(missing) else 0.0)
    faces, place = faces_of(ready, mine, area), None
    if faces:
        rows = np.flatnonzero(mine & (samples.face == int(faces[0][1:])))
        middle = samples.point[rows].mean(axis=0)
        place = vector(samples.point[rows[np.linalg.norm(samples.point[rows] - middle, axis=1).argmin()]])
    share = min(1.0, whole / max(1e-300, requested))
    faces = list(dict.fromkeys([*faces, *(f"F{number}" for number in empty)]))
    return schema.RemainingEntry(
        cause=cause, area_mm2=whole, share=share, samples=int(mine.sum()), faces=faces, place_mm=place, **more
    )


def faces_of(ready: Prepared, mine: NDArray[np.bool_], area: Floats) -> list[str]:
    """Ids of the faces of some samples (n,), the one with the most of their area first."""
    face = ready.samples.face[mine]
    each = np.bincount(face, area[mine])
    return [f"F{number}" for number in sorted(np.unique(face).tolist(), key=lambda number: (-each[number], number))]


#: Which plan of operations is the process: the first of these that there is.
_PREFERRED = ("process", "fastest", "fewest")
#: A number of a reason that is none: another orientation would do.
_OTHER = 1000
#: How the steps of a cutter cut, in their order.
_IN_TURN: tuple[Strategy, ...] = ("floor", "mixed", "wall", "point")
#: Cosine from the setup axis under which a tool comes from below: walls that are drawn out of true by half a degree are walls.
_BELOW = -0.01


def process_entry(
    ready: Prepared, entries: Sequence[CutterEntry], answers: Answers, over: OverSetups, shown: str, fitting: Fitting
) -> schema.ProcessEntry:
    """Put together what the given cutters, setups and operations finish.

    The plan of operations among the `answers` is the process where there is one, else the fewest runs of cutters and setups.
    `entries` are of all cutters, from the most wanted down; `shown` is the id of the cutter whose next steps are told;
    `fitting` finds the usual sizes that fit where cutters gouge.
    """
    sampled, not_sampled = sample_areas(entries[0].faces, ready.samples, ready.scene.part)
    area = np.where(ready.not_required, 0.0, sampled)
    requested, name, seconds, times, short = float(area.sum()) + not_sampled, "", None, dict[str, Any](), np.zeros(0, np.int64)
    parts = _Parts(ready, over, area, requested)
    if answers.operations is not None:
        chosen, entry = min(
            zip(answers.operations.plans, answers.operations.entry.plans, strict=True),
            key=lambda each: _PREFERRED.index(each[0].name),
        )
        done, name, seconds, short = (chosen.label >= 0) & ready.finished, entry.name, entry.seconds, chosen.short
        steps = [*parts.own(answers.operations, chosen, entry), *parts.planned(answers.operations, chosen, entry)]
        if seconds is not None:
            times = _times(ready.options, entry, len({step.setup for step in steps}))
    else:
        runs = list(_runs(ready, entries, answers, over))
        done = np.logical_or.reduce([mine for *_, mine in runs]) if runs else np.zeros(len(area), bool)
        none = {"mode": "any", "angles_deg": None, "axis": None, "seconds": None, "clearance_mm": None}
        steps = [parts.step(mine, None, setup=setup, cutter=cutter, **none) for setup, cutter, mine in runs]
    advice, why = answers.mends.get(shown), reasons(entries, over, steps, done)
    why.reason[short] = _SHORT
    left = remaining(ready, done, why, area, requested, () if advice is None else advice.steps, fitting)
    finished, exempt = float(area[done].sum()), None
    if ready.exempt is not None and ready.exempt.any():
        at_edges = np.where(ready.inside_bodies, 0.0, sampled)
        exempt = remaining_entry(ready, REASONS[SHARP_EDGE], ready.exempt, at_edges, requested)
    setups, stock = setups_and_stock(ready)
    return schema.ProcessEntry(
        steps=steps, setups=setups, stock=stock, plan=name, finished_mm2=finished,
        asked_mm2=requested, left=left,
        seconds=seconds, **times,
        finished_share=exact(finished / max(1e-300, requested), some=bool(done.any()), whole=not left), exempt=exempt,
    )  # fmt: skip


def in_colours_of_steps(operations: schema.OperationsEntry, process: schema.ProcessEntry) -> schema.OperationsEntry:
    """Plans with the operations of the process in the colours of their steps: pages, models and CAD have one legend."""
    step = {name: int(number.partition(".")[0]) for name, number in numbered(operations, process).items()}
    plans = [
        each
        if each.name != process.plan
        else each.model_copy(update={"operations": [
            one.model_copy(update={"colour": operation_colour(step[one.id] - 1)}) if one.id in step else one
            for one in each.operations
        ]})
        for each in operations.plans
    ]  # fmt: skip
    return operations.model_copy(update={"plans": plans})


def _times(options: Options, plan: schema.OperationPlanEntry, setups: int) -> dict[str, Any]:
    """What the time of a plan is made of, by the fields of the process."""
    clamping = options.setup_time * max(0, setups - 1)
    change = options.change_time * plan.changes
    return {
        "cutting_seconds": plan.cutting_seconds or 0.0, "link_seconds": plan.link_seconds, "setup_seconds": clamping,
        "change_seconds": change, "index_seconds": max(0.0, plan.other_seconds - change - clamping),
    }  # fmt: skip


def _slide(same: Sequence[schema.OperationEntry]) -> schema.SlideEntry | None:
    """The walls along which the shank slides in operations that are one step; None where one comes near something else."""
    least = [each for each in same if each.clearance_mm == min(one.clearance_mm or 0.0 for one in same)]
    slides = [each.slide for each in least if each.slide is not None]
    if len(slides) < len(least):
        return None
    return schema.SlideEntry(
        faces=sorted({face for each in slides for face in each.faces}, key=lambda face: int(face[1:])),
        relieved_mm=min(each.slide.relieved_mm if each.slide else each.clearance_mm or 0.0 for each in same),
    )


def place_in_shop(step: schema.OperationEntry | schema.ProcessStep, size: Mapping[str, int]) -> tuple[object, ...]:
    """Give the place of a step in the order of a shop, `size` being those of cutters by their ids, 0 the largest.

    Setup by setup the largest cutter comes first, so that each is changed to once a setup; of a cutter floors, then walls, other
    fixed orientations and simultaneous motion, of each the largest area first.
    """
    return step.setup, size[step.cutter], step.mode != "fixed", _IN_TURN.index(step.strategy), -step.area_mm2


@dataclass(frozen=True, slots=True, eq=False)
class _Parts:
    """Steps are made of this: the areas (n,) of samples, and what is requested of all, mm2."""

    ready: Prepared
    over: OverSetups
    area: Floats
    requested: float

    def step(self, mine: NDArray[np.bool_], made: schema.OperationEntry | None, **fields: Any) -> schema.ProcessStep:
        """A step that finishes some samples (n,): with one axis, or each with that of its posture.

        What is not among the `fields` is as in its operation.
        """
        size, ready = float(self.area[mine].sum()), self.ready
        setup, cutter, axis = (fields[name] if name in fields else getattr(made, name) for name in ("setup", "cutter", "axis"))
        axes = self.over.each[setup][1][cutter].axis[mine] if axis is None else np.tile(axis, (int(mine.sum()), 1))
        below = axes @ ready.setups[setup].setup < _BELOW
        return filled(
            schema.ProcessStep, made, faces=faces_of(ready, mine, self.area), area_mm2=size,
            share=min(1.0, size / max(1e-300, self.requested)), below_mm2=float(self.area[mine][below].sum()),
            operation="" if made is None else made.id, **fields,
        )  # fmt: skip

    def planned(self, operations: Operations, plan: OperationPlan, entry: schema.OperationPlanEntry) -> list[schema.ProcessStep]:
        """List the steps that were planned, in the order of a shop."""
        place = partial(place_in_shop, size={cutter.id: k for k, cutter in enumerate(by_radius(self.ready.cutters))})
        # Operations that are images of each other are one step.
        together = dict[object, list[tuple[int, schema.OperationEntry]]]()
        for k, each in sorted(enumerate(entry.operations), key=lambda ranked: place(ranked[1])):
            if each.step is None:
                together.setdefault(each.id if each.orbit is None else each.orbit, []).append((k, each))
        alone, planned = _alone(operations, plan), list[schema.ProcessStep]()
        for images in together.values():
            images.sort(key=lambda ranked: [angle % 360.0 for angle in (ranked[1].angles_deg or {}).values()])
            ranks, same = [k for k, _ in images], [each for _, each in images]
            mine, clearance = np.isin(plan.label, ranks), [each.clearance_mm for each in same]
            seconds = [each.seconds for each in same]
            gone = mine & (alone if operations.own else ~np.delete(plan.serves, ranks, axis=1).any(axis=1))
            single = len(same) == 1 and not operations.own
            repeat, by = repeats(self.ready, same, mine)
            planned.append(self.step(
                mine, same[0], seconds=None if None in seconds else sum(s for s in seconds if s is not None),
                link_seconds=sum(each.link_seconds for each in same), repeat=repeat, repeat_deg=by, take="share",
                clearance_mm=None if None in clearance else min(each for each in clearance if each is not None),
                slide=_slide(same),
                alone_mm2=same[0].exclusive_mm2 if single else float(self.area[gone].sum()),
            ))  # fmt: skip
        # Those that are images of others count with all of them.
        return sorted(planned, key=place)

    def own(self, operations: Operations, plan: OperationPlan, entry: schema.OperationPlanEntry) -> Iterator[schema.ProcessStep]:
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

    def _own(self, operations: Operations, outcome: OwnResult, done: Rows) -> schema.OwnStepEntry:
        """What a step of the planner's own is asked, what none of them does of the faces that it names, and what would do.

        `done` (d,) is what all of them do together.
        """
        process, area, near = self.ready.options.process, self.area, outcome.nearest
        leaves, missed = list[schema.RemainingEntry](), np.zeros(len(area), bool)
        missed[outcome.requested] = True
        missed[done] = False
        if process is not None and process.steps[outcome.number - 1].faces is not None:
            verdicts = self.over.each[outcome.setup][1][outcome.cutter.id]
            cause = np.where(verdicts.reached, _OTHER, verdicts.reason.astype(np.int32))
            for code in np.unique(cause[missed]).tolist():
                word = schema.OTHER_ORIENTATION if code == _OTHER else REASONS[code] if code != NO_REASON else schema.NOT_PLANNED
                leaves.append(remaining_entry(self.ready, word, missed & (cause == code), area, self.requested))
        return schema.OwnStepEntry(
            number=outcome.number, asked_mm2=float(area[outcome.requested].sum()), wrong=outcome.wrong,
            leaves=sorted(leaves, key=lambda each: (-each.area_mm2, each.cause)),
            nearest=None if near is None else schema.NearestEntry(
                angles_deg=_named(operations, near.angle), axis=vector(near.axis), area_mm2=float(area[near.rows].sum())
            ),
        )  # fmt: skip


def _named(operations: Operations, angle: Floats | None) -> dict[str, float]:
    return {} if angle is None else dict(zip(operations.entry.rotary, angle.tolist(), strict=True))


def _alone(operations: Operations, plan: OperationPlan) -> NDArray[np.bool_]:
    """Samples (n,) that one step alone serves: one of the planner's own serves what it could finish of its faces."""
    times = plan.serves[:, [k for k, each in enumerate(plan.operations) if not each.step]].sum(axis=1)
    for outcome in operations.own:
        times[outcome.serves] += 1
    return np.asarray(times == 1)


def _runs(
    ready: Prepared, entries: Sequence[CutterEntry], answers: Answers, over: OverSetups
) -> Iterator[tuple[int, str, NDArray[np.bool_]]]:
    """The fewest runs, each with its setup, its cutter, and the samples (n,) that none before it reaches."""
    least, done = answers.least_set, np.zeros(len(ready.samples), bool)
    for setup, cutter in [(0, nearest(entries).id)] if least is None else [(run.number, run.cutter.id) for run in least.runs]:
        mine = over.each[setup][1][cutter].reached & ready.machinable[setup] & ~done
        done |= mine
        if mine.any():
            yield setup, cutter, mine
