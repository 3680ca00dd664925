"""The entry of the plan of operations is made here, of what was found."""

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, SurfaceSamples
from plan_cutters.domain.operations import (
    INDEX_TIME,
    Fastest,
    Fewest,
    IndexFrom,
    Operation,
    OperationPlan,
    Operations,
    Workplane,
    Worth,
)
from plan_cutters.domain.verdicts import NO_REASON, REASONS
from plan_cutters.options import Options
from plan_cutters.plan_file.frozen import vector
from plan_cutters.plan_file.operations import (
    AssumedEntry,
    CutterUse,
    FastestEntry,
    FewestEntry,
    OperationEntry,
    OperationFace,
    OperationPlanEntry,
    OperationRegion,
    OperationsEntry,
    RestEntry,
    TurningEntry,
    WorkplaneEntry,
    runs,
)
from plan_cutters.plan_file.palette import operation_colour

#: Areas differ by less, as a share, where they are of the same samples.
_SAME_AREA = 1e-3


def operations_entry(
    operations: Operations, samples: SurfaceSamples, wanted: NDArray[np.bool_], reason: NDArray[np.uint8], options: Options
) -> OperationsEntry:
    """Make the entry of what was found.

    Parameters
    ----------
    operations : Operations
    samples : SurfaceSamples
    wanted : (n,) bool
        Judged samples of the finished surface.
    reason : (n,) uint8
        Why the most wanted cutter reaches a sample in no setup, an index into REASONS, or NO_REASON.
    options : Options
    """
    area = np.where(wanted, np.nan_to_num(samples.area), 0.0)
    assumed = AssumedEntry(
        feed_mm_min=None if operations.feed is None else {cutter.id: feed for cutter, feed in operations.feed.items()},
        scallop_mm=options.scallop,
        stepover=options.stepover,
        overlap_mm=options.overlap,
        index_s=INDEX_TIME if options.index_time is None else options.index_time,
        index_from=operations.index_from,
        change_s=options.change_time,
        setup_s=options.setup_time,
    )
    plans = [_plan(each, operations, samples, area, wanted, reason) for each in operations.plans]
    uses = [_use(each, plans, area) for each in operations.worth]
    return OperationsEntry(
        asked=operations.which,  # type: ignore[arg-type]
        rotary=operations.names,
        plans=plans,
        fewest=None if operations.fewest is None else _fewest(operations.fewest),
        cutters=uses,
        fastest=_fastest(operations),
        assumed=assumed,
        probes=operations.probes,
        notes=list(operations.notes),
    )


def _fewest(fewest: Fewest) -> FewestEntry:
    weights = [(row, weight) for row, weight in zip(fewest.rows.tolist(), fewest.weight.tolist(), strict=True) if weight]
    return FewestEntry(
        found=len(fewest.chosen), at_least=fewest.at_least, proof=fewest.proof, weights=sorted(weights), bound=fewest.bound,
        lp=fewest.relaxed, samples=fewest.samples, candidates=len(fewest.columns), spacing_deg=float(np.degrees(fewest.spacing)),
        alone=len(fewest.alone),
    )  # fmt: skip


def _fastest(operations: Operations) -> FastestEntry | None:
    timed = operations.fastest
    if timed is None:
        return None
    known = np.isfinite(timed.seconds)
    return FastestEntry(
        seconds=timed.seconds if known else None,
        bound_seconds=timed.bound,
        at_best_seconds=timed.at_best,
        gap=timed.gap if known else None,
        samples=timed.samples,
        candidates=timed.candidates,
    )


def _use(worth: Worth, plans: list[OperationPlanEntry], area: Floats) -> CutterUse:
    takes: dict[str, float] = {
        str(plan.name): sum(each.area_mm2 for each in plan.operations if each.cutter == worth.cutter.id) for plan in plans
    }
    return CutterUse(
        id=worth.cutter.id,
        takes_mm2=takes,
        only_mm2=float(area[worth.only].sum()),
        saves_seconds=worth.saves,
        change_seconds=worth.change,
    )


def _plan(
    plan: OperationPlan, results: Operations, samples: SurfaceSamples, area: Floats, wanted: NDArray[np.bool_],
    reason: NDArray[np.uint8],
) -> OperationPlanEntry:  # fmt: skip
    whole = float(area.sum())
    operations = [
        _operation(i, each, plan, plane, results.names, samples, area, whole, results.index_from)
        for i, (each, plane) in enumerate(zip(plan.operations, plan.planes, strict=True))
    ]
    rest = wanted & (plan.label < 0)
    unserved = float(area[rest].sum())
    cutting = plan.cutting if np.isfinite(plan.cutting) else None
    held = [each for each in operations if each.proved_share is not None]
    size = sum(each.area_mm2 for each in held)
    share = sum(each.area_mm2 * (each.proved_share or 0.0) for each in held) / size if size > 0.0 else None
    return OperationPlanEntry(
        name=plan.name, orientations=sum(each.mode == "fixed" for each in operations),  # type: ignore[arg-type]
        cut_length_mm=sum(each.cut_length_mm or 0.0 for each in operations), operations=operations,
        seconds=None if cutting is None else plan.total, cutting_seconds=cutting, other_seconds=plan.other,
        ratio_at_most=_ratio(operations, results.fastest), proved_share=share,
        changes=max(0, len({each.cutter for each in operations}) - 1),
        pieces=len(np.unique(plan.region[plan.region >= 0])),
        approaches_proved=sum(each.approaches_proved or 0 for each in held) if held else None,
        rest=RestEntry(samples=int(rest.sum()), area_mm2=unserved, share=unserved / whole if whole > 0.0 else 0.0,
                       reason_counts=_reasons(reason[rest])),
    )  # fmt: skip


def _reasons(reason: NDArray[np.uint8]) -> dict[str, int]:
    """How many samples have each reason."""
    codes, counts = np.unique(reason[reason != NO_REASON], return_counts=True)
    return {REASONS[code]: count for code, count in zip(codes.tolist(), counts.tolist(), strict=True)}


def _ratio(operations: list[OperationEntry], timed: Fastest | None) -> float | None:
    """Cutting of the fixed operations over that at best; only where both are about the same area."""
    fixed = [each for each in operations if each.mode == "fixed"]
    if timed is None or timed.at_best <= 0.0 or any(each.seconds is None for each in fixed):
        return None
    if abs(sum(each.area_mm2 for each in fixed) - timed.area) > _SAME_AREA * timed.area:
        return None
    return max(1.0, sum(each.seconds or 0.0 for each in fixed) / timed.at_best)


def _operation(
    number: int, operation: Operation, plan: OperationPlan, plane: Workplane | None, names: tuple[str, str],
    samples: SurfaceSamples, area: Floats, whole: float, index_from: IndexFrom,
) -> OperationEntry:  # fmt: skip
    rows = operation.rows
    strip, mine = plan.strip[rows], area[rows]
    known = np.isfinite(strip) & (strip > 0.0)
    length = float((mine[known] / strip[known]).sum()) if known.all() else None
    seconds = plan.seconds[rows]
    return OperationEntry(
        id=operation.name, step=operation.step or None, mode=operation.mode,
        strategy=operation.strategy, cutter=operation.cutter.id, setup=operation.setup,
        axis=None if operation.axis is None else vector(operation.axis), angles_deg=_angles(operation.angle, names),
        other_angles_deg=_angles(operation.other_angle, names), samples=len(rows), area_mm2=float(mine.sum()),
        share=min(1.0, float(mine.sum()) / whole) if whole > 0.0 else 0.0, exclusive_mm2=float(area[operation.only].sum()),
        strip_mm=_tenths(strip[known]), cut_length_mm=length,
        seconds=float(seconds.sum()) if np.isfinite(seconds).all() else None, proved_share=operation.proved,
        approaches_proved=operation.approaches, turning=_turning(operation, names), clearance_mm=operation.clearance,
        orbit=None if operation.orbit < 0 else operation.orbit,
        faces=_faces(rows, samples, area), frame=None if plane is None else _frame(plane),
        colour=operation_colour(number), index_s=None if plane is None else plane.index,
        index_from=None if plane is None else index_from,
        regions=[
            _region(k, np.flatnonzero(plan.region == k), samples, area)
            for k in np.unique(plan.region[rows]).tolist()
        ],
    )  # fmt: skip


def _turning(operation: Operation, names: tuple[str, str]) -> TurningEntry | None:
    turning = operation.turning
    if turning is None:
        return None
    angles = None
    if turning.low is not None and turning.high is not None:
        (a, b), (c, d) = turning.low.tolist(), turning.high.tolist()
        angles = {names[0]: (a, c), names[1]: (b, d)}
    return TurningEntry(
        pieces_mm2=list(turning.area), steepest_deg_mm=turning.steepest, angles_deg=angles, held_share=turning.held,
        both_share=turning.both, singular_mm2=turning.singular,
    )  # fmt: skip


def _frame(plane: Workplane) -> WorkplaneEntry:
    return WorkplaneEntry(origin=vector(plane.origin), x=vector(plane.x), z=vector(plane.z))


def _region(number: int, rows: NDArray[np.int64], samples: SurfaceSamples, area: Floats) -> OperationRegion:
    point = samples.point[rows]
    return OperationRegion(
        id=number,
        samples=len(rows),
        area_mm2=float(area[rows].sum()),
        faces=_faces(rows, samples, area),
        low=vector(point.min(axis=0)),
        high=vector(point.max(axis=0)),
        rows=runs(rows),
    )


def _faces(rows: NDArray[np.int64], samples: SurfaceSamples, area: Floats) -> list[OperationFace]:
    number, which, count = np.unique(samples.face[rows], return_inverse=True, return_counts=True)
    size = np.bincount(which, area[rows], len(number))
    faces = [
        OperationFace(face=f"F{f}", samples=n, area_mm2=a)
        for f, n, a in zip(number.tolist(), count.tolist(), size.tolist(), strict=True)
    ]
    return sorted(faces, key=lambda each: -each.area_mm2)


def _angles(angle: Floats | None, names: tuple[str, str]) -> dict[str, float] | None:
    return None if angle is None else dict(zip(names, angle.tolist(), strict=True))


def _tenths(strip: Floats) -> tuple[float, float, float] | None:
    if not len(strip):
        return None
    low, middle, high = np.percentile(strip, (10, 50, 90)).tolist()
    return low, middle, high
