"""The answers after the plan, as the plan file has them."""

from typing import Literal

import numpy as np
from pydantic import Field

from cad_io.arrays import SurfaceSamples
from plan_cutters.document.frozen import Frozen, Posture, Vector, posture, vector
from plan_cutters.domain.change import Change, Mend, Value
from plan_cutters.domain.radius_map import RadiusMap
from plan_cutters.domain.stick_out import StickOut
from plan_cutters.domain.verdicts import INACCESSIBLE, NO_REASON, REASONS, UNDECIDED
from plan_cutters.scene.surroundings import Surroundings

#: Of a verdict on what lies just beyond an answer.
_WORDS: dict[int, Literal["inaccessible", "undecided"]] = {INACCESSIBLE: "inaccessible", UNDECIDED: "undecided"}
Beyond = Literal["inaccessible", "undecided"] | None


class StickOutEntry(Frozen):
    """The least stick-out with which the cutter in its holder reaches every sample that it reaches now."""

    least_mm: float | None = Field(description="to 0.01 mm, for the rotations searched; null: `limited_by` says why")
    floor_mm: float | None = Field(description="the shortest that was looked at: flutes and neck stand out")
    longest_mm: float = Field(description="the longest that was looked at: what the cutter was judged with")
    limited_by: str = Field(description="obstacle, floor, or why nothing was looked for: no holder, reaches nothing")
    served: int = Field(description="samples that are reached now, and were found to be reached with it")
    beyond_mm: float | None = Field(description="just below it, where the limiting sample was judged again")
    beyond: Beyond = Field(description="the verdict on it there")
    face: str | None = Field(description="of the sample that limits it")
    point: Vector | None
    posture: Posture | None = Field(description="with the least stick-out, at that sample")
    obstacle_face: str | None = Field(description="in the way of a holder that comes lower at that posture")
    obstacle_point: Vector | None
    step_mm: float | None = Field(default=None, description="of the least stick-outs of all samples, in samples.npz")


class RadiusEntry(Frozen):
    """The largest radius that reaches each sample, for one shape of bare end mill."""

    shape: Literal["flat", "ball"]
    length_over_radius: float
    step: float = Field(description="by which share each radius that was tried is larger than the one before")
    least_mm: float = Field(description="radii that were tried, from")
    most_mm: float = Field(description="and to")
    percentiles_mm: dict[str, float] = Field(
        description="q -> at least q % of the samples' area has this one or a smaller one"
    )
    below: int = Field(description="samples that not even the least one reaches")
    no_less: int = Field(description="samples that the largest one reaches: theirs is no less")
    bottleneck_mm: float | None = Field(description="the smallest of all samples; 0: not even the least one reaches it")
    bottleneck_face: str | None
    bottleneck_point: Vector | None
    beyond: Beyond = Field(description="the verdict there on the radius one step larger")
    reason: str | None = Field(description="and why it does not reach that sample")


class ChangeEntry(Frozen):
    """One thing changed, all else as it is."""

    thing: str
    helps: bool | None = Field(
        description="true: all target samples were judged with it and are reached; null: not decided"
    )
    now: float | tuple[float, ...] | tuple[str, ...] | None = Field(description="mm, deg, a direction, or faces")
    asked: float | tuple[float, ...] | tuple[str, ...] | None = Field(
        description="the least change with which it finishes"
    )
    beyond: float | tuple[float, ...] | tuple[str, ...] | None = Field(
        description="a step less, which was tried and fails"
    )
    left: int = Field(description="samples that stay lost with the best value tried, of those looked at")
    looked: int = Field(description="samples that are lost now on which values were tried")
    verified: int = Field(description="target samples that were judged with `asked`")
    cutter: str | None = Field(description="id of the cutter with it, where that is another one")
    why: str


class MendEntry(Frozen):
    """What would make a cutter finish the part: those changes that help first."""

    lost: int = Field(description="samples that are inaccessible or undecided now")
    buried: int = Field(description="those of them that lie within a body")
    why: str
    changes: list[ChangeEntry]


def stick_out_entry(found: StickOut, samples: SurfaceSamples, around: Surroundings) -> StickOutEntry:
    """A least stick-out."""
    limited, none = found.sample >= 0, np.isnan(found.least)
    return StickOutEntry(
        least_mm=None if none else found.least,
        floor_mm=None if none else found.floor,
        longest_mm=found.longest,
        limited_by=found.why,
        served=found.served,
        beyond_mm=found.beyond if limited else None,
        beyond=_WORDS.get(found.verdict),
        face=f"F{samples.face[found.sample]}" if limited else None,
        point=vector(samples.point[found.sample]) if limited else None,
        posture=None if found.axis is None else posture(found.tilt, found.rotation, found.axis),
        obstacle_face=around.called(found.obstacle_face) if found.obstacle_face else None,
        obstacle_point=None if found.obstacle_point is None else vector(found.obstacle_point),
        step_mm=None if found.each is None else found.step,
    )


def radius_entry(found: RadiusMap, samples: SurfaceSamples) -> RadiusEntry:
    """A map of largest radii."""
    row = found.bottleneck
    reason = None if row is None or found.reason[row] == NO_REASON else REASONS[found.reason[row]]
    return RadiusEntry(
        shape=found.shape,
        length_over_radius=found.ratio,
        step=found.step,
        least_mm=found.least,
        most_mm=found.most,
        percentiles_mm={str(q): radius for q, radius in found.percentiles(samples.area).items()},
        below=int(found.less.sum()),
        no_less=int(found.no_less.sum()),
        bottleneck_mm=None if row is None else float(found.radius[row]),
        bottleneck_face=None if row is None else f"F{samples.face[row]}",
        bottleneck_point=None if row is None else vector(samples.point[row]),
        beyond=None if row is None else _WORDS.get(int(found.beyond[row])),
        reason=reason,
    )


def mend_entry(found: Mend) -> MendEntry:
    """What would make a cutter feasible."""
    return MendEntry(
        lost=found.lost, buried=found.buried, why=found.why, changes=[_change_entry(each) for each in found.changes]
    )


def _change_entry(found: Change) -> ChangeEntry:
    return ChangeEntry(
        thing=found.thing,
        helps=found.helps,
        now=_plain(found.now),
        asked=_plain(found.asked),
        beyond=_plain(found.beyond),
        left=found.left,
        looked=found.looked,
        verified=found.verified,
        cutter=None if found.cutter is None else found.cutter.id,
        why=found.why,
    )


def _plain(value: Value) -> Value:
    """JSON has no infinity."""
    return None if isinstance(value, float) and not np.isfinite(value) else value
