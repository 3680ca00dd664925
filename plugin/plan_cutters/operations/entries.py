"""Plans of operations as the plan file has them: areas, lengths and times, made once of what was found."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, SurfaceSamples
from plan_cutters.domain.verdicts import NO_REASON, REASONS
from plan_cutters.operations.choices import Worth
from plan_cutters.operations.plans import changes_of
from plan_cutters.operations.task import Task
from plan_cutters.outcome import Operation, OperationPlan, Operations
from plan_cutters.plan_file import operations as schema
from plan_cutters.plan_file.frozen import vector
from plan_cutters.plan_file.reasons import operation_colour

#: The fastest plan against a bound, with the area, mm2, that the samples compared stand for.
Timed = tuple[schema.FastestEntry, float]
#: Areas differ by less, as a share, where they are of the same samples.
_SAME_AREA = 1e-3
#: Fields of an operation that are not known where nothing was looked at, or where it is simultaneous.
_UNKNOWN = dict.fromkeys(("proved_share", "approaches_proved", "frame", "index_s", "index_from"))


def operations_entry(
    task: Task, plans: Sequence[OperationPlan], notes: Sequence[str], fewest: schema.FewestEntry | None, timed: Timed | None,
    worth: Sequence[Worth],
) -> schema.OperationsEntry:  # fmt: skip
    """Make the entry of plans, without reasons why samples are left.

    `worth`: of each cutter, the largest first.
    """
    options, feed = task.ready.options, task.paths.feed
    area = np.where(task.ready.finished, np.nan_to_num(task.ready.samples.area), 0.0)
    entries = [_plan(task, each, area, timed) for each in plans]
    return schema.OperationsEntry(
        asked=options.operations or "",  # type: ignore[arg-type]
        rotary=task.orientations[0].names,
        plans=entries,
        fewest=fewest,
        fastest=None if timed is None else timed[0],
        cutters=[
            schema.CutterUse(
                id=each.cutter.id,
                takes_mm2={
                    str(one.name): sum(its.area_mm2 for its in one.operations if its.cutter == each.cutter.id) for one in entries
                },
                only_mm2=float(area[each.only].sum()), saves_seconds=each.saves, change_seconds=each.change,
            )
            for each in worth
        ],
        assumed=schema.AssumedEntry(
            feed_mm_min=None if feed is None else {cutter.id: each for cutter, each in feed.items()}, scallop_mm=options.scallop,
            stepover=options.stepover, overlap_mm=options.overlap, index_s=task.indexing.constant,
            index_from=task.indexing.source, change_s=options.change_time, setup_s=options.setup_time, link_s=task.paths.link,
        ),
        probes=task.probes.made,
        notes=list(notes),
    )  # fmt: skip


def with_reasons(operations: Operations, reason: NDArray[np.uint8], finished: NDArray[np.bool_]) -> Operations:
    """Add to plans why samples are left.

    `reason` (n,) uint8: why the most wanted cutter reaches a sample in no setup, an index into REASONS, or NO_REASON. `finished`
    (n,) bool: the samples that are to be finished.
    """
    entries = []
    for entry, plan in zip(operations.entry.plans, operations.plans, strict=True):
        left = reason[finished & (plan.label < 0) & (reason != NO_REASON)]
        counts = {REASONS[code]: count for code, count in enumerate(np.bincount(left).tolist()) if count}
        entries.append(entry.model_copy(update={"rest": entry.rest.model_copy(update={"reason_counts": counts})}))
    return replace(operations, entry=operations.entry.model_copy(update={"plans": entries}))


def _plan(task: Task, plan: OperationPlan, area: Floats, timed: Timed | None) -> schema.OperationPlanEntry:
    whole, alone, rest = float(area.sum()), plan.alone, task.ready.finished & (plan.label < 0)
    operations = [
        _operation(k, each, plan, area[alone & (plan.label == k)], task, area, whole) for k, each in enumerate(plan.operations)
    ]
    unserved = float(area[rest].sum())
    known = bool(np.isfinite(plan.cutting))
    held = [each for each in operations if each.proved_share is not None]
    size = sum(each.area_mm2 for each in held)
    return schema.OperationPlanEntry(
        name=plan.name,  # type: ignore[arg-type]
        orientations=sum(each.mode == "fixed" for each in operations),
        cut_length_mm=sum(each.cut_length_mm or 0.0 for each in operations),
        seconds=plan.total if known else None,
        cutting_seconds=plan.cutting if known else None,
        link_seconds=plan.links,
        other_seconds=plan.other,
        changes=changes_of(task, plan.operations),
        pieces=len(np.unique(plan.region[plan.region >= 0])),
        ratio_at_most=_ratio(operations, timed),
        proved_share=sum(each.area_mm2 * (each.proved_share or 0.0) for each in held) / size if size > 0.0 else None,
        approaches_proved=sum(each.approaches_proved or 0 for each in held) if held else None,
        operations=operations,
        rest=schema.RestEntry(
            samples=int(rest.sum()), area_mm2=unserved, share=unserved / whole if whole > 0.0 else 0.0, reason_counts={},
            short=len(plan.short),
        ),
    )  # fmt: skip


def _ratio(operations: Sequence[schema.OperationEntry], timed: Timed | None) -> float | None:
    """Cutting and links of the fixed operations over those at best; only where both are about the same area."""
    fixed = [each for each in operations if each.mode == "fixed"]
    if timed is None or timed[0].at_best_seconds <= 0.0 or any(each.seconds is None for each in fixed):
        return None
    if abs(sum(each.area_mm2 for each in fixed) - timed[1]) > _SAME_AREA * timed[1]:
        return None
    return max(1.0, sum((each.seconds or 0.0) + each.link_seconds for each in fixed) / timed[0].at_best_seconds)


def _operation(
    number: int, operation: Operation, plan: OperationPlan, alone: Floats, task: Task, area: Floats, whole: float
) -> schema.OperationEntry:
    rows, samples = operation.rows, task.ready.samples
    strip, length, seconds, mine = plan.strip[rows], plan.length[rows], plan.seconds[rows], area[rows]
    known = np.isfinite(strip) & (strip > 0.0)
    angles, others = (
        None if angle is None else dict(zip(task.orientations[0].names, angle.tolist(), strict=True))
        for angle in (operation.angle, operation.other_angle)
    )
    return schema.OperationEntry(
        id=operation.name, step=operation.step or None, mode=operation.mode, cutter=operation.cutter.id, setup=operation.setup,
        axis=None if operation.axis is None else vector(operation.axis), angles_deg=angles, other_angles_deg=others,
        samples=len(rows), area_mm2=float(mine.sum()), share=min(1.0, float(mine.sum()) / whole) if whole > 0.0 else 0.0,
        exclusive_mm2=float(alone.sum()),
        strip_mm=tuple(np.percentile(strip[known], (10, 50, 90)).tolist()) if known.any() else None,
        cut_length_mm=float(length.sum()) if np.isfinite(length).all() else None,
        seconds=float(seconds.sum()) if np.isfinite(seconds).all() else None,
        orbit=None if operation.orbit < 0 else operation.orbit, faces=_faces(rows, samples, area),
        regions=[_region(k, np.flatnonzero(plan.region == k), samples, area) for k in np.unique(plan.region[rows]).tolist()],
        colour=operation_colour(number), **{**_UNKNOWN, **operation.fields},
    )  # fmt: skip


def _region(number: int, rows: NDArray[np.int64], samples: SurfaceSamples, area: Floats) -> schema.OperationRegion:
    point = samples.point[rows]
    return schema.OperationRegion(
        id=number, samples=len(rows), area_mm2=float(area[rows].sum()), faces=_faces(rows, samples, area),
        low=vector(point.min(axis=0)), high=vector(point.max(axis=0)), rows=schema.runs(rows),
    )  # fmt: skip


def _faces(rows: NDArray[np.int64], samples: SurfaceSamples, area: Floats) -> list[schema.OperationFace]:
    number, which, count = np.unique(samples.face[rows], return_inverse=True, return_counts=True)
    size = np.bincount(which, area[rows], len(number))
    faces = [
        schema.OperationFace(face=f"F{f}", samples=n, area_mm2=a)
        for f, n, a in zip(number.tolist(), count.tolist(), size.tolist(), strict=True)
    ]
    return sorted(faces, key=lambda each: -each.area_mm2)
