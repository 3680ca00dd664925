"""The answers after the plan, as the plan file has them."""

from typing import Literal

import numpy as np
from pydantic import Field

from cad_io.arrays import SurfaceSamples
from plan_cutters.document.frozen import Frozen, Posture, Vector, filled, posture, vector
from plan_cutters.domain.area import Patch
from plan_cutters.domain.change import MEANS, Change, Mend, Step, Value
from plan_cutters.domain.least_set import LeastSet
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
    doubtful: bool = Field(default=False, description="obstacles are missing, which might ask for more")
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
    doubtful: bool = Field(default=False, description="obstacles are missing, which might leave less")
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
    lost_before: float | None = Field(default=None, description="share of the finished area that is lost now, 0 to 1")
    lost_after: float | None = Field(default=None, description="and with `asked`; null where nothing is asked or known")
    option: str | None = Field(
        default=None, description="what to say on the command line; null where nothing is asked, or no option says it"
    )
    doubted: bool = Field(
        default=False, description="it would help, unless a face that is missing from the obstacles is in the way"
    )


class MoveEntry(Frozen):
    """One change of a step."""

    thing: str = Field(description=", ".join(MEANS))
    now: float | tuple[float, ...] | str | None = Field(description="mm, deg, a direction, or the id of a cutter")
    asked: float | tuple[float, ...] | str | None
    why: str = Field(description="the change in words")


class LostAreaEntry(Frozen):
    """Connected samples that are not reached."""

    area_mm2: float
    share: float = Field(description="of the finished area, 0 to 1")
    samples: int
    faces: list[str] = Field(description="the one with the most of it first")
    point: Vector = Field(description="the sample nearest to its middle")
    across_mm: float = Field(description="largest extent, from sample to sample")
    why: str = Field(description="all of it in words")


class StepEntry(Frozen):
    """A step is a thing to do next; its gain is judged on every sample, not estimated."""

    changes: list[MoveEntry] = Field(description="one, or two")
    lost_before: float = Field(description="share of the finished area that is lost now, 0 to 1")
    lost_after: float = Field(description="and that stays lost; of an area that is left to other means, 0")
    gained: int = Field(description="samples that it frees")
    left: int = Field(description="samples that stay lost")
    cutters: list[str] = Field(description="ids of those that do it together, what becomes of the mended one first")
    setups: list[Vector] = Field(description="setup axes in which they do")
    option: str | None = Field(
        description="what to say on the command line, --cutter beside what is said there, all else in place of its like; null "
        "where no option says it"
    )
    why: str
    remains: list[LostAreaEntry] = Field(description="the largest areas that stay lost")


class MendEntry(Frozen):
    """A what-if answer gives the changes that would make a cutter finish the part, those that help first, and the next steps."""

    lost: int = Field(description="samples that are inaccessible or undecided now")
    buried: int = Field(description="those of them that lie within another body: nothing is asked about them")
    why: str
    changes: list[ChangeEntry]
    lost_share: float = Field(default=0.0, description="of the finished area that is lost now in all setups, 0 to 1")
    steps: list[StepEntry] = Field(
        default=[],
        description="by what stays lost, the least first; of those alike what asks least; an area to leave out last",
    )
    lost_areas: list[LostAreaEntry] = Field(default=[], description="the largest first")
    more_lost_areas: int = Field(default=0, description="that are not listed")
    unsure: bool = Field(default=False, description="obstacles are missing, which may take away what a step gains")


class RunEntry(Frozen):
    """A cutter in a setup, and what it takes: what no run before it reaches."""

    cutter: str
    setup: Vector
    samples: int
    area_mm2: float
    share: float = Field(description="of the finished area, 0 to 1")
    faces: list[str] = Field(description="on which it takes samples")
    alone: int = Field(description="samples that no other run of the set reaches")


class LeastSetEntry(Frozen):
    """The fewest runs, a given cutter in a setup of the plan each, that reach all that any of them reaches."""

    runs: list[RunEntry] = Field(
        description="by setup, then by rank; of sets of as many that in the fewest setups was taken"
    )
    reached: int = Field(description="samples of the finished surface")
    left: int = Field(description="samples that nothing given reaches for sure")
    share: float = Field(description="of the finished area that they reach, 0 to 1")
    left_share: float
    proven: bool = Field(description="no fewer do")
    doubtful: bool = Field(default=False, description="obstacles are missing, which might take away some of it")


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
        doubtful=around.doubtful,
        step_mm=None if found.each is None else found.step,
    )


def radius_entry(found: RadiusMap, samples: SurfaceSamples, *, doubtful: bool = False) -> RadiusEntry:
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
        doubtful=doubtful,
        bottleneck_mm=None if row is None else float(found.radius[row]),
        bottleneck_face=None if row is None else f"F{samples.face[row]}",
        bottleneck_point=None if row is None else vector(samples.point[row]),
        beyond=None if row is None else _WORDS.get(int(found.beyond[row])),
        reason=reason,
    )


def mend_entry(found: Mend) -> MendEntry:
    """Make the entry of a what-if answer: the changes that would make a cutter feasible, and the next steps."""
    return filled(
        MendEntry, found, changes=[_change_entry(each) for each in found.changes], lost_share=found.share,
        steps=[_step_entry(each) for each in found.steps], lost_areas=[_area_entry(each) for each in found.areas],
        more_lost_areas=found.more_areas,
    )  # fmt: skip


def least_set_entry(found: LeastSet, *, doubtful: bool = False) -> LeastSetEntry:
    """The fewest runs."""
    runs = [
        filled(RunEntry, each, cutter=each.cutter.id, area_mm2=each.area, faces=list(each.faces)) for each in found.runs
    ]
    return filled(LeastSetEntry, found, runs=runs, doubtful=doubtful)


def _area_entry(found: Patch) -> LostAreaEntry:
    return filled(LostAreaEntry, found, area_mm2=found.area, faces=list(found.faces), point=found.place, across_mm=found.across,
                  why=found.words)  # fmt: skip


def _joined(words: list[str]) -> str:
    rest = " for the rest"
    if len(words) > 1 and all(each.endswith(rest) for each in words):
        return " and ".join(each.removesuffix(rest) for each in words) + rest
    return ", and ".join(words)


def _step_entry(found: Step) -> StepEntry:
    return filled(
        StepEntry, found,
        changes=[MoveEntry(thing=each.means, now=each.now, asked=each.asked, why=each.words) for each in found.moves],
        lost_before=found.before, lost_after=found.after, cutters=[each.id for each in found.cutters],
        setups=[vector(each) for each in found.setups], why=_joined([each.words for each in found.moves]),
        remains=[_area_entry(each) for each in found.remains],
    )  # fmt: skip


def _change_entry(found: Change) -> ChangeEntry:
    return filled(
        ChangeEntry, found, now=_plain(found.now), asked=_plain(found.asked), beyond=_plain(found.beyond),
        cutter=None if found.cutter is None else found.cutter.id, lost_before=found.before, lost_after=found.after,
    )  # fmt: skip


def _plain(value: Value) -> Value:
    """JSON has no infinity."""
    return None if isinstance(value, float) and not np.isfinite(value) else value
