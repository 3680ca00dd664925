"""The plan of operations, as the plan file has it."""

from typing import Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from cad_io.arrays import Floats, SurfaceSamples
from plan_cutters.document.frozen import Frozen, Vector, vector
from plan_cutters.domain.operations import Fewest, Operation, OperationPlan, Operations


class OperationFace(Frozen):
    """An operation finishes this much of a face."""

    face: str
    samples: int
    area_mm2: float


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


class RestEntry(Frozen):
    """Judged samples that no operation finishes: no cutter of the plan reaches them."""

    samples: int
    area_mm2: float
    share: float


class OperationPlanEntry(Frozen):
    """A plan of operations: each reached sample goes with one of them."""

    name: Literal["fewest", "fastest", "largest first"]
    orientations: int = Field(description="fixed ones, each with one cutter and setup")
    cut_length_mm: float
    seconds: float | None = Field(description="cutting, orientations, cutters and setups; null without a feed")
    proved_share: float | None = Field(description="of the area of all fixed operations, proved between the samples")
    approaches_proved: int | None = Field(description="of all of them together")
    operations: list[OperationEntry] = Field(description="the largest share first")
    rest: RestEntry


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
    relaxed: float = Field(description="the bound of the best weights, before they are rounded")
    candidates: int = Field(description="their angles are in operations.npz")
    spacing_deg: float = Field(description="between candidates where the weights lie")
    alone: int = Field(description="reached samples that no candidate serves: they need simultaneous motion")


class FastestEntry(Frozen):
    """How good the fastest plan is, by some samples that stand for the area of all."""

    seconds: float = Field(description="with orientations, cutters and setups")
    bound_seconds: float = Field(description="no choice among the candidates takes less")
    at_best_seconds: float = Field(
        description="cutting alone, each sample with its own best axis among the candidates: simultaneous motion at its best, "
        "without its rotary speeds"
    )
    samples: int
    candidates: int


class StepEntry(Frozen):
    """So many orientations serve this share of the judged area."""

    orientations: int
    share: float
    at_most: float | None = Field(
        description="no choice of as many candidates serves more; null where that is not known"
    )


class OperationsEntry(Frozen):
    """Operations with fixed orientations that finish together all that is reached. All is about samples, at their contacts."""

    asked: Literal["fewest", "fastest", "both"]
    rotary: tuple[str, str] = Field(description="names of the angles")
    plans: list[OperationPlanEntry]
    fewest: FewestEntry
    fastest: FastestEntry | None = Field(description="null unless the fastest were asked for")
    curve: list[StepEntry]
    probes: int = Field(description="how many times a tool was put down")
    notes: list[str]


def operations_entry(
    found: Operations, samples: SurfaceSamples, wanted: NDArray[np.bool_], times: tuple[float, float, float]
) -> OperationsEntry:
    """Make the entry of what was found.

    Parameters
    ----------
    found : Operations
    samples : SurfaceSamples
    wanted : (n,) bool
        Judged samples of the finished surface.
    times : (float, float, float)
        Seconds of another orientation, cutter and setup.
    """
    area = np.where(wanted, np.nan_to_num(samples.area), 0.0)
    plans = [_plan(each, found.names, samples, area, wanted, times) for each in found.plans]
    steps = [StepEntry(orientations=s.orientations, share=s.share, at_most=s.at_most) for s in found.curve]
    return OperationsEntry(
        asked=found.which,  # type: ignore[arg-type]
        rotary=found.names, plans=plans, fewest=_fewest(found.fewest), curve=steps, fastest=_fastest(found), probes=found.probes,
        notes=list(found.notes),
    )  # fmt: skip


def _fewest(found: Fewest) -> FewestEntry:
    weights = [(row, weight) for row, weight in zip(found.rows.tolist(), found.weight.tolist(), strict=True) if weight]
    return FewestEntry(
        found=len(found.chosen), at_least=found.at_least, proof=found.proof, weights=sorted(weights), bound=found.bound,
        relaxed=found.relaxed, candidates=len(found.columns), spacing_deg=float(np.degrees(found.spacing)),
        alone=len(found.alone),
    )  # fmt: skip


def _fastest(found: Operations) -> FastestEntry | None:
    timed = found.fastest
    if timed is None:
        return None
    return FastestEntry(seconds=timed.seconds, bound_seconds=timed.bound, at_best_seconds=timed.at_best, samples=timed.samples,
                        candidates=timed.candidates)  # fmt: skip


def _plan(
    found: OperationPlan, names: tuple[str, str], samples: SurfaceSamples, area: Floats, wanted: NDArray[np.bool_],
    times: tuple[float, float, float],
) -> OperationPlanEntry:  # fmt: skip
    whole = float(area.sum())
    operations = [_operation(each, found, names, samples, area, whole) for each in found.operations]
    rest = wanted & (found.label < 0)
    left = float(area[rest].sum())
    index, change, setup = times
    seconds = None
    if all(each.seconds is not None for each in operations):
        seconds = sum(each.seconds or 0.0 for each in operations) + index * len(operations)
        seconds += change * len({each.cutter for each in operations}) + setup * len({each.setup for each in operations})
    held = [each for each in operations if each.proved_share is not None]
    size = sum(each.area_mm2 for each in held)
    share = sum(each.area_mm2 * (each.proved_share or 0.0) for each in held) / size if size > 0.0 else None
    return OperationPlanEntry(
        name=found.name, orientations=sum(each.mode == "fixed" for each in operations),  # type: ignore[arg-type]
        cut_length_mm=sum(each.cut_length_mm or 0.0 for each in operations), seconds=seconds, operations=operations,
        proved_share=share, approaches_proved=sum(each.approaches_proved or 0 for each in held) if held else None,
        rest=RestEntry(samples=int(rest.sum()), area_mm2=left, share=left / whole if whole > 0.0 else 0.0),
    )  # fmt: skip


def _operation(
    found: Operation, plan: OperationPlan, names: tuple[str, str], samples: SurfaceSamples, area: Floats, whole: float
) -> OperationEntry:  # fmt: skip
    rows = found.rows
    strip, mine = plan.strip[rows], area[rows]
    known = np.isfinite(strip) & (strip > 0.0)
    length = float((mine[known] / strip[known]).sum()) if known.all() else None
    seconds = plan.seconds[rows]
    faces = [
        OperationFace(face=f"F{f}", samples=int((samples.face[rows] == f).sum()),
                      area_mm2=float(mine[samples.face[rows] == f].sum()))
        for f in np.unique(samples.face[rows]).tolist()
    ]  # fmt: skip
    return OperationEntry(
        id=found.name, mode=found.mode, cutter=found.cutter.id, setup=found.setup,
        axis=None if found.axis is None else vector(found.axis), angles_deg=_angles(found.angle, names),
        other_angles_deg=_angles(found.other_angle, names), samples=len(rows), area_mm2=float(mine.sum()),
        share=min(1.0, float(mine.sum()) / whole) if whole > 0.0 else 0.0, exclusive_mm2=float(area[found.only].sum()),
        strip_mm=_tenths(strip[known]), cut_length_mm=length,
        seconds=float(seconds.sum()) if np.isfinite(seconds).all() else None, proved_share=found.proved,
        approaches_proved=found.approaches,
        faces=sorted(faces, key=lambda each: -each.area_mm2),
    )  # fmt: skip


def _angles(angle: Floats | None, names: tuple[str, str]) -> dict[str, float] | None:
    return None if angle is None else dict(zip(names, angle.tolist(), strict=True))


def _tenths(strip: Floats) -> tuple[float, float, float] | None:
    if not len(strip):
        return None
    low, middle, high = np.percentile(strip, (10, 50, 90)).tolist()
    return low, middle, high
