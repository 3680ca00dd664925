"""Entries of the answers after the plan: next steps, least stick-outs, largest radii, the least set of runs."""

from typing import Literal

from pydantic import Field

from plan_cutters.domain.answers import MEANS
from plan_cutters.plan_file.frozen import Frozen, Posture, Vector

#: The verdict on a sample just beyond an answer.
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


class RadiusEntry(Frozen):
    """The largest radius that reaches each sample, for one shape of bare end mill."""

    shape: Literal["flat", "ball"]
    length_over_radius: float
    step: float = Field(description="by which share each radius that was tried is larger than the one before")
    least_mm: float = Field(description="radii that were tried, from")
    most_mm: float = Field(description="and to")
    percentiles_mm: dict[str, float] = Field(description="q -> at least q % of the samples' area has this one or a smaller one")
    below: int = Field(description="samples that not even the least one reaches")
    no_less: int = Field(description="samples that the largest one reaches: theirs is no less")
    doubtful: bool = Field(default=False, description="obstacles are missing, which might leave less")
    bottleneck_mm: float | None = Field(description="the smallest of all samples; 0: not even the least one reaches it")
    bottleneck_face: str | None
    bottleneck_point: Vector | None
    beyond: Beyond = Field(description="the verdict there on the radius one step larger")
    reason: str | None = Field(description="and why it does not reach that sample")


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
    lost_before: float = Field(description="share of the finished area that is not reached now, 0 to 1")
    lost_after: float = Field(description="and that stays unreached; of an area that is left to other means, 0")
    gained: int = Field(description="samples that it frees")
    left: int = Field(description="samples that stay unreached")
    cutters: list[str] = Field(description="ids of those that do it together, the changed one first")
    setups: list[Vector] = Field(description="setup axes in which they do")
    option: str | None = Field(
        description="what to write on the command line, --cutter is added to what stands there, all else replaces its like; null "
        "where no option says it"
    )
    why: str
    remains: list[LostAreaEntry] = Field(description="the largest areas that stay unreached")


class MendEntry(Frozen):
    """Advice names what to do next with a cutter that does not finish the part."""

    lost: int = Field(description="samples that are inaccessible or undecided now")
    buried: int = Field(description="those of them that lie within another body: no change is looked for")
    why: str = Field(description="why no steps were looked for; empty where they were")
    lost_share: float = Field(default=0.0, description="of the finished area that is not reached now in all setups, 0 to 1")
    steps: list[StepEntry] = Field(
        default=[],
        description="by what stays unreached, the least first; of those alike what asks least; an area to leave out last",
    )
    lost_areas: list[LostAreaEntry] = Field(default=[], description="the largest first")
    more_lost_areas: int = Field(default=0, description="that are not listed")
    uncompared: int = Field(
        default=0,
        description="changes that promised less than those judged and were not judged, and kinds of changes that were not looked "
        "at: the work for advice was spent",
    )
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

    runs: list[RunEntry] = Field(description="by setup, then by rank; of sets of as many that in the fewest setups was taken")
    reached: int = Field(description="samples of the finished surface")
    left: int = Field(description="samples that nothing given reaches for sure")
    share: float = Field(description="of the finished area that they reach, 0 to 1")
    left_share: float
    proven: bool = Field(description="no fewer do")
    doubtful: bool = Field(default=False, description="obstacles are missing, which might take away some of it")
