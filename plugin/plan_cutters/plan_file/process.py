"""How the process stands in the plan file: what to do in which order, how much that finishes, and what is left."""

from typing import Literal

from pydantic import Field

from plan_cutters.plan_file.frozen import Frozen, Vector

#: Causes beside the reasons for which samples are not reached: not judged, or reached but in no step.
UNJUDGED_CAUSE, NOT_PLANNED = "unjudged", "not_planned"
#: Why a step of the planner's own leaves something: another orientation of its cutter would reach it.
OTHER_ORIENTATION = "orientation"


class FitEntry(Frozen):
    """A smaller cutter of a usual size reaches this much of an area: judged as long and in the same holder as the one before."""

    cutter: str = Field(description="its specification")
    kind: str = Field(description="flat end, ball end or bull nose")
    size: str = Field(description="as it is typed: D3, D2 rc0.5, D0.125in")
    diameter_mm: float
    share: float = Field(description="of the area that is left for this cause, 0 to 1")


class PointsEntry(Frozen):
    """Inside cones that end in a point, as a drill leaves them: no end of a cutter fits there."""

    faces: list[str] = Field(description="the one with the most of it first")
    share: float = Field(description="of the area that is left for this cause, 0 to 1")


class HelpEntry(Frozen):
    """A step of an answer (`mend.steps` of the cutter `shown`) finishes this much of an area."""

    step: int = Field(description="its place in the list, from 0")
    share: float = Field(description="of the area that is left for this cause, 0 to 1")


class RemainingEntry(Frozen):
    """An area that no step finishes, for one cause."""

    cause: str = Field(
        description="a code of `reasons`; `unjudged`; `not_planned`: a cutter reaches it, and no step takes it; "
        "`orientation`, of what a step leaves: its cutter reaches it in this setup, and not with this axis"
    )
    area_mm2: float
    share: float = Field(description="of what is requested, 0 to 1")
    samples: int = Field(description="0 for faces without samples")
    faces: list[str] = Field(description="the one with the most of it first")
    place_mm: Vector | None = Field(description="a sample in the middle of it, on the first of the faces")
    fits: list[FitEntry] | None = Field(
        default=None,
        description="where flutes gouge or meet the part: the largest usual size that reaches most of it, and one that reaches "
        "more; empty where none reaches any; null where that was not judged",
    )
    points: PointsEntry | None = Field(default=None, description="null where there are none")
    helped: list[HelpEntry] = Field(default=[], description="the most first")
    needs: str = Field(default="", description="what would help, in words")


class NearestEntry(Frozen):
    """An orientation that would do more of what a step of the planner's own is asked."""

    angles_deg: dict[str, float]
    axis: Vector
    area_mm2: float = Field(description="that it serves of the faces of the step")


class OwnStepEntry(Frozen):
    """A step of the planner's own process is asked this, and leaves this of it."""

    number: int = Field(description="in `effective.process`, from 1")
    asked_mm2: float = Field(description="of its faces, that no step before it finishes")
    wrong: str = Field(default="", description="why it does nothing; empty where it is one that the machine can hold")
    leaves: list[RemainingEntry] = Field(
        default=[], description="of the faces that it names, that no step of the planner's own finishes, the largest area first"
    )
    nearest: NearestEntry | None = None
    text: str = Field(default="", description="what is wrong with it, a sentence; empty where it does all")


class ProcessStep(Frozen):
    """One cutter in one setup, with one orientation, with simultaneous motion, or with any of its postures."""

    setup: int = Field(description="0 for the first setup, then the others in their order")
    mode: Literal["fixed", "simultaneous", "any"] = Field(
        description="any: no operations were requested, each sample has a posture of its own"
    )
    angles_deg: dict[str, float] | None = Field(description="of the rotary axes by name, the first time; null unless fixed")
    axis: Vector | None = Field(
        description="unit, from the tip to the spindle, part coordinates, as `angles_deg`; null unless fixed"
    )
    cutter: str = Field(description="id")
    strategy: Literal["point", "floor", "wall", "mixed"] = Field(
        default="point", description="how most of it is cut, as of the operation; point where no operations were requested"
    )
    repeat: int = Field(default=1, description="how many times it is done, over a pattern of equal faces")
    repeat_deg: dict[str, float] | None = Field(
        default=None,
        description="by how much rotary axes turn from one time to the next; null: it is done once, or several axes turn",
    )
    faces: list[str] = Field(description="the one with the most of it first")
    area_mm2: float
    share: float = Field(description="of what is requested, 0 to 1")
    seconds: float | None = Field(description="cutting alone; null where it is not known")
    below_mm2: float = Field(
        default=0.0, description="of its area, cut from below: the tool's axis points under the plane across the setup axis"
    )
    clearance_mm: float | None = Field(description="least at any of its samples; 100: that or more; null: not known")
    alone_mm2: float | None = Field(
        default=None,
        description="of its area, that no other step serves on the faces that it has: gone if it is left out and nothing is "
        "planned in its place; null: not known",
    )
    operation: str = Field(default="", description="its id in the plan of operations that is the process; empty: none")
    take: Literal["first", "share"] = Field(
        default="first", description="share: it shares its faces with other steps, by time, as those that were planned do"
    )
    own: OwnStepEntry | None = Field(default=None, description="null: the step was planned")


class NextEntry(Frozen):
    """A change that would finish more, with its effect."""

    words: str
    argv: list[str] = Field(description="to add to the command that was given; empty where no option says it")
    left_share: float | None = Field(description="of what is requested, that stays; null where it was not judged")


class ProcessEntry(Frozen):
    """A process says in which steps the given cutters, setups and operations finish how much together."""

    steps: list[ProcessStep] = Field(description="the planner's own first, then by setup and, in a setup, by cutter")
    plan: str = Field(default="", description="the name of the plan of operations that the steps are; empty: no operations")
    finished_share: float = Field(description="of what is requested, 0 to 1: 1 only where nothing at all is left")
    finished_mm2: float
    asked_mm2: float = Field(description="of the target faces, without what lies inside other bodies or is exempt")
    left: list[RemainingEntry] = Field(description="the largest area first")
    exempt: RemainingEntry | None = Field(
        default=None,
        description="strips at sharp inside edges that no cutter enters, where they are not required (`sharp_edges`): in none of "
        "the other numbers; null where there is none",
    )
    seconds: float | None = Field(
        description="on the machine: cutting of all steps, orientations and changes of cutters, without `setup_seconds`; null "
        "without a feed"
    )
    setup_seconds: float | None = Field(default=None, description="to clamp the part for each setup after the first")
    next: list[NextEntry] = Field(default=[], description="the best first")
    doubts: list[str] = Field(default=[], description="what changes what one does: a line each, the gravest first")

    @property
    def finished(self) -> bool:
        """Whether all that could be judged is finished."""
        return all(each.cause == UNJUDGED_CAUSE for each in self.left)
