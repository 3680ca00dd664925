"""The plan of operations, as the plan file has it."""

from typing import Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from cad_io.arrays import Floats, SurfaceSamples
from plan_cutters.document.frozen import Frozen, Vector, vector
from plan_cutters.document.palette import operation_colour
from plan_cutters.document.runs import Runs, runs
from plan_cutters.document.split import SplitEntry
from plan_cutters.domain.operations import (
    RESOLUTION,
    Fastest,
    Fewest,
    Motion,
    Operation,
    OperationPlan,
    Operations,
    Workplane,
    Worth,
)
from plan_cutters.domain.verdicts import NO_REASON, REASONS
from plan_cutters.options import Options

#: Areas differ by less, as a share, where they are of the same samples.
_SAME_AREA = 1e-3


class OperationFace(Frozen):
    """An operation finishes this much of a face."""

    face: str
    samples: int
    area_mm2: float


class OperationRegion(Frozen):
    """Connected samples of one operation."""

    id: int = Field(description="in its plan, from 0: by operation, the largest first")
    samples: int
    area_mm2: float
    faces: list[OperationFace] = Field(description="the one with the most of it first")
    low: Vector = Field(description="corner of the box around its samples")
    high: Vector
    rows: Runs = Field(description="its samples: first and last of runs of rows of samples.npz and axes.csv, from 0")


class WorkplaneEntry(Frozen):
    """The tilted plane that a control turns to: z is the tool axis, x the machine's X turned with it. Part coordinates."""

    origin: Vector = Field(description="mm: the setup's origin, or the part's zero where the setup names none")
    x: Vector
    z: Vector


class OperationEntry(Frozen):
    """One cutter in one setup, with one orientation of its axis or with simultaneous motion."""

    id: str
    mode: Literal["fixed", "simultaneous"]
    cutter: str
    setup: int = Field(description="0 for the first setup, then the others in their order")
    axis: Vector | None = Field(description="unit, from the tip to the spindle, part coordinates; null if simultaneous")
    angles_deg: dict[str, float] | None = Field(
        description="of the rotary axes by name; of a machine without any the azimuth about the setup axis and the tilt from it"
    )
    other_angles_deg: dict[str, float] | None = Field(description="the other solution with the same axis; null: none")
    samples: int
    area_mm2: float
    share: float = Field(description="of the judged area, 0 to 1")
    exclusive_mm2: float = Field(description="area that no other operation of the plan serves")
    strip_mm: tuple[float, float, float] | None = Field(
        description="widths of a pass that leaves the scallop height: 10, 50 and 90 % of the samples have at most this"
    )
    cut_length_mm: float | None = Field(description="area over width, summed up: without links and lead-ins")
    seconds: float | None = Field(description="cutting alone, at the feed; null without a feed")
    proved_share: float | None = Field(
        description="of its area, proved between the samples with its axis or another of the plan; null: not looked at"
    )
    approaches_proved: int | None = Field(
        description="connected pieces that hold 99 % of what is proved with its axis; inside one, any path is safe"
    )
    faces: list[OperationFace] = Field(description="the one with the most of it first")
    frame: WorkplaneEntry | None = Field(description="null if simultaneous")
    index_s: float | None = Field(
        description="what the rotary axes take to come to its angles from those before, in the best order of the operations of "
        "its cutter and setup, the first one from zero; null if simultaneous. The plan's seconds reckon with --index-time instead"
    )
    index_from: Literal["rates", "assumed"] | None = Field(
        description="of the rotary axes; or assumed, as not all have rates: --index-time"
    )
    regions: list[OperationRegion]
    colour: str = Field(description="sRGB, in the models")


class RestEntry(Frozen):
    """Judged samples that no operation finishes: no cutter of the plan reaches them."""

    samples: int
    area_mm2: float
    share: float
    reason_counts: dict[str, int] = Field(description="why the first cutter of the plan does not reach them")


class AssumedEntry(Frozen):
    """Times and widths are reckoned with these numbers."""

    feed_mm_min: dict[str, float] | None = Field(description="by cutter; null: lengths stand for times")
    scallop_mm: float
    stepover: float = Field(description="widest distance of passes, in diameters")
    overlap_mm: float
    index_s: float
    change_s: float
    setup_s: float


class OperationPlanEntry(Frozen):
    """A plan of operations: each reached sample goes with one of them."""

    name: Literal["fewest", "fastest", "largest first"]
    orientations: int = Field(description="fixed ones, each with one cutter and setup")
    cut_length_mm: float
    seconds: float | None = Field(description="cutting and other_seconds together; null without a feed")
    cutting_seconds: float | None = Field(description="of all operations, at the feed; null without a feed")
    other_seconds: float = Field(
        description="index time of each operation, change and setup time of each cutter and setup after the first"
    )
    ratio_at_most: float | None = Field(
        description="cutting of the fixed operations over at_best_seconds of the fastest: they take at most so many times as "
        "long as simultaneous motion, by the samples compared; null where that is not known"
    )
    proved_share: float | None = Field(description="of the area of all fixed operations, proved between the samples")
    approaches_proved: int | None = Field(description="of all of them together")
    operations: list[OperationEntry] = Field(description="the largest share first")
    rest: RestEntry
    split: dict[str, SplitEntry] = Field(
        default_factory=dict, description="by face: how its models show those of several operations"
    )


class FewestEntry(Frozen):
    """How few orientations there can be, with what proves it.

    Each weight is that of a sample. No candidate serves samples whose weights sum up to more than 1,000,000: so any choice of
    candidates that serves all has at least the sum of all weights over 1,000,000, rounded up.
    """

    found: int
    at_least: int = Field(
        description="no choice among the candidates has fewer; about samples and postures proved free"
    )
    proof: Literal["weights", "branch and bound", "not closed"]
    weights: list[tuple[int, int]] = Field(description="row of samples.npz, and its weight")
    bound: float = Field(description="sum of the weights over 1,000,000")
    lp: float = Field(description="the bound of the best weights, before they are rounded")
    samples: int = Field(description="that are reached, so that orientations must serve them")
    candidates: int = Field(description="their angles are in operations.npz")
    spacing_deg: float = Field(description="between candidates where the weights lie")
    alone: int = Field(description="reached samples that no candidate serves: they need simultaneous motion")
    at_least_any: int = Field(description="no choice of any axes has fewer, candidates or not; as far as was looked")
    cells_deg: float | None = Field(
        description="radius of the smallest cells of directions that this bound was found with; null where none were needed"
    )


class FastestEntry(Frozen):
    """How good the fastest plan is, by some samples that stand for the area of all."""

    seconds: float = Field(description="with orientations, cutters and setups")
    bound_seconds: float = Field(description="no choice among the candidates takes less")
    at_best_seconds: float = Field(
        description="cutting alone, each sample with its own best axis among the candidates: simultaneous motion at its best, "
        "without its rotary speeds"
    )
    gap: float = Field(description="how far seconds are above bound_seconds, as a share of these")
    samples: int
    candidates: int


class CutterUse(Frozen):
    """A cutter takes so much in each plan, and is worth so much beside the others that were compared."""

    id: str
    takes_mm2: dict[str, float] = Field(description="area of its operations, by the name of the plan")
    only_mm2: float = Field(description="judged area that none of the others reaches")
    saves_seconds: float | None = Field(
        description="of cutting, orientations and other cutters, before its own change; null: the others alone cannot do it"
    )
    change_seconds: float = Field(description="that its change costs; 0 where it is the only one")


class StepEntry(Frozen):
    """So many orientations serve this share of the judged area."""

    orientations: int
    share: float
    at_most: float | None = Field(
        description="no choice of as many candidates serves more; null where that is not known"
    )


class ForcedStepEntry(Frozen):
    """Some step of the rotary axes between neighbours of a grid line is at least so large, whatever postures are taken."""

    along: Literal["u", "v"] = Field(description="the direction of the grid lines")
    deg: float = Field(
        description="the larger angle of the two axes; the first one does not count within 2 deg of its direction"
    )
    turning_deg: float = Field(description="the same where that counts, too")
    face: str = Field(description="where that line is")
    looked_at: int = Field(description="lines that were looked at")
    lines: int


class MotionEntry(Frozen):
    """How the free postures of one cutter in the first setup hang together over the surface. An estimate: it proves nothing."""

    cutter: str
    components: int = Field(description="sets of postures between which no way in contact was found")
    components_strict: int = Field(description="the same where ways between two rotations count only if both are free")
    largest_share: float = Field(description="of the judged area, 0 to 1: what the largest of them touches")
    needed: int = Field(description="fewest of them that touch every sample with a posture")
    needed_at_least: int
    outside: int = Field(description="samples with a posture that the largest does not touch")
    without: int = Field(description="judged samples without a posture in the maps")
    forced_steps: list[ForcedStepEntry] = Field(description="empty without two rotary axes")
    resolution_deg: float = Field(description="of the forced steps")


class OperationsEntry(Frozen):
    """Operations with fixed orientations that finish together all that is reached. All is about samples, at their contacts."""

    asked: Literal["fewest", "fastest", "both"]
    rotary: tuple[str, str] = Field(description="names of the angles")
    plans: list[OperationPlanEntry]
    fewest: FewestEntry
    fastest: FastestEntry | None = Field(description="null unless the fastest were asked for")
    cutters: list[CutterUse] = Field(
        description="the largest first; empty unless the fastest were asked for and several cutters were compared"
    )
    curve: list[StepEntry]
    assumed: AssumedEntry
    motion: MotionEntry | None = Field(description="null unless posture maps were asked for, too")
    probes: int = Field(description="how many times a tool was put down")
    notes: list[str]


def operations_entry(
    found: Operations, samples: SurfaceSamples, wanted: NDArray[np.bool_], options: Options
) -> OperationsEntry:
    """Make the entry of what was found.

    Parameters
    ----------
    found : Operations
    samples : SurfaceSamples
    wanted : (n,) bool
        Judged samples of the finished surface.
    options : Options
    """
    area = np.where(wanted, np.nan_to_num(samples.area), 0.0)
    assumed = AssumedEntry(
        feed_mm_min=None if found.feed is None else {cutter.id: feed for cutter, feed in found.feed.items()},
        scallop_mm=options.scallop, stepover=options.stepover, overlap_mm=options.overlap, index_s=options.index_time,
        change_s=options.change_time, setup_s=options.setup_time,
    )  # fmt: skip
    plans = [_plan(each, found, samples, area, wanted, assumed) for each in found.plans]
    uses = [_use(each, plans, area) for each in found.worth]
    steps = [StepEntry(orientations=s.orientations, share=s.share, at_most=s.at_most) for s in found.curve]
    return OperationsEntry(
        asked=found.which,  # type: ignore[arg-type]
        rotary=found.names, plans=plans, fewest=_fewest(found.fewest), cutters=uses, curve=steps, fastest=_fastest(found),
        assumed=assumed, probes=found.probes, motion=_motion(found.motion), notes=list(found.notes),
    )  # fmt: skip


def _fewest(found: Fewest) -> FewestEntry:
    weights = [(row, weight) for row, weight in zip(found.rows.tolist(), found.weight.tolist(), strict=True) if weight]
    return FewestEntry(
        found=len(found.chosen), at_least=found.at_least, proof=found.proof, weights=sorted(weights), bound=found.bound,
        lp=found.relaxed, samples=found.samples, candidates=len(found.columns), spacing_deg=float(np.degrees(found.spacing)),
        alone=len(found.alone), at_least_any=found.at_least_any,
        cells_deg=float(np.degrees(found.cells)) if np.isfinite(found.cells) else None,
    )  # fmt: skip


def with_motion(plan: OperationsEntry, found: Motion | str) -> OperationsEntry:
    """The entry with what was found of motion, or with the words why there is nothing."""
    if isinstance(found, str):
        return plan.model_copy(update={"notes": [*plan.notes, found]})
    return plan.model_copy(update={"motion": _motion(found)})


def _motion(found: Motion | None) -> MotionEntry | None:
    if found is None:
        return None
    steps = [
        ForcedStepEntry(along=each.along, deg=each.step, turning_deg=each.turning, face=f"F{each.face}",
                        looked_at=each.looked_at, lines=each.lines)
        for each in found.steps
    ]  # fmt: skip
    return MotionEntry(
        cutter=found.cutter, components=found.components, components_strict=found.strictly, largest_share=found.largest_share,
        needed=found.needed, needed_at_least=found.needed_at_least, outside=found.outside, without=found.without,
        forced_steps=steps, resolution_deg=RESOLUTION,
    )  # fmt: skip


def _fastest(found: Operations) -> FastestEntry | None:
    timed = found.fastest
    if timed is None:
        return None
    return FastestEntry(seconds=timed.seconds, bound_seconds=timed.bound, at_best_seconds=timed.at_best, gap=timed.gap,
                        samples=timed.samples, candidates=timed.candidates)  # fmt: skip


def _use(found: Worth, plans: list[OperationPlanEntry], area: Floats) -> CutterUse:
    takes: dict[str, float] = {
        str(plan.name): sum(each.area_mm2 for each in plan.operations if each.cutter == found.cutter.id)
        for plan in plans
    }
    return CutterUse(id=found.cutter.id, takes_mm2=takes, only_mm2=float(area[found.only].sum()), saves_seconds=found.saves,
                     change_seconds=found.change)  # fmt: skip


def _plan(
    plan: OperationPlan, found: Operations, samples: SurfaceSamples, area: Floats, wanted: NDArray[np.bool_],
    assumed: AssumedEntry,
) -> OperationPlanEntry:  # fmt: skip
    whole = float(area.sum())
    operations = [
        _operation(i, each, plan, plane, found.names, samples, area, whole)
        for i, (each, plane) in enumerate(zip(plan.operations, plan.planes, strict=True))
    ]
    rest = wanted & (plan.label < 0)
    left = float(area[rest].sum())
    # The first cutter and the first setup are there anyway.
    other = assumed.index_s * len(operations) + assumed.change_s * max(0, len({each.cutter for each in operations}) - 1)
    other += assumed.setup_s * max(0, len({each.setup for each in operations}) - 1)
    known = [each.seconds for each in operations if each.seconds is not None]
    cutting = sum(known) if len(known) == len(operations) else None
    held = [each for each in operations if each.proved_share is not None]
    size = sum(each.area_mm2 for each in held)
    share = sum(each.area_mm2 * (each.proved_share or 0.0) for each in held) / size if size > 0.0 else None
    return OperationPlanEntry(
        name=plan.name, orientations=sum(each.mode == "fixed" for each in operations),  # type: ignore[arg-type]
        cut_length_mm=sum(each.cut_length_mm or 0.0 for each in operations), operations=operations,
        seconds=None if cutting is None else cutting + other, cutting_seconds=cutting, other_seconds=other,
        ratio_at_most=_ratio(operations, found.fastest), proved_share=share,
        approaches_proved=sum(each.approaches_proved or 0 for each in held) if held else None,
        rest=RestEntry(samples=int(rest.sum()), area_mm2=left, share=left / whole if whole > 0.0 else 0.0,
                       reason_counts=_reasons(found.reason[rest])),
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
    number: int, found: Operation, plan: OperationPlan, plane: Workplane | None, names: tuple[str, str],
    samples: SurfaceSamples, area: Floats, whole: float,
) -> OperationEntry:  # fmt: skip
    rows = found.rows
    strip, mine = plan.strip[rows], area[rows]
    known = np.isfinite(strip) & (strip > 0.0)
    length = float((mine[known] / strip[known]).sum()) if known.all() else None
    seconds = plan.seconds[rows]
    return OperationEntry(
        id=found.name, mode=found.mode, cutter=found.cutter.id, setup=found.setup,
        axis=None if found.axis is None else vector(found.axis), angles_deg=_angles(found.angle, names),
        other_angles_deg=_angles(found.other_angle, names), samples=len(rows), area_mm2=float(mine.sum()),
        share=min(1.0, float(mine.sum()) / whole) if whole > 0.0 else 0.0, exclusive_mm2=float(area[found.only].sum()),
        strip_mm=_tenths(strip[known]), cut_length_mm=length,
        seconds=float(seconds.sum()) if np.isfinite(seconds).all() else None, proved_share=found.proved,
        approaches_proved=found.approaches,
        faces=_faces(rows, samples, area), frame=None if plane is None else _frame(plane),
        colour=operation_colour(number), index_s=None if plane is None else plane.index,
        index_from=None if plane is None else "rates" if plane.timed else "assumed",
        regions=[
            _region(k, np.flatnonzero(plan.region == k), samples, area)
            for k in np.unique(plan.region[rows]).tolist()
        ],
    )  # fmt: skip


def _frame(plane: Workplane) -> WorkplaneEntry:
    return WorkplaneEntry(origin=vector(plane.origin), x=vector(plane.x), z=vector(plane.z))


def _region(number: int, rows: NDArray[np.int64], samples: SurfaceSamples, area: Floats) -> OperationRegion:
    point = samples.point[rows]
    return OperationRegion(
        id=number, samples=len(rows), area_mm2=float(area[rows].sum()), faces=_faces(rows, samples, area),
        low=vector(point.min(axis=0)), high=vector(point.max(axis=0)), rows=runs(rows),
    )  # fmt: skip


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
