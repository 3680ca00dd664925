"""Entries of the plan of operations, and of the process: its steps and what they leave."""

from typing import Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from plan_cutters.plan_file.frozen import Frozen, Vector
from plan_cutters.plan_file.holes import DrillingStep, WorkplaneEntry


class SplitEntry(Frozen):
    """How the models show a face of several labels: verdicts, or operations."""

    rung: Literal["contour", "beside", "whole"] = Field(
        description="split in its place; split as a separate copy of the face; coloured whole"
    )
    why: str | None = Field(description="why it could not be split in its place")
    joined: int = Field(default=0, description="slivers coloured as the worst of their neighbours, or that hold no sample")
    dropped: int = Field(
        default=0,
        description="samples without a piece of their label, coloured as their neighbours: of operations those beyond a "
        "smooth border, by half a cell of the grid at most",
    )


#: Rows of samples as the files have them: first and last of runs of consecutive numbers.
Runs = list[tuple[int, int]]


def runs(rows: NDArray[np.int64]) -> Runs:
    """First and last of runs of consecutive numbers.

    >>> runs(np.array([3, 4, 5, 9]))
    [(3, 5), (9, 9)]
    """
    if not len(rows):
        return []
    ends = np.flatnonzero(np.diff(rows) > 1)
    first, last = rows[np.concatenate([[0], ends + 1])], rows[np.concatenate([ends, [len(rows) - 1]])]
    return list(zip(first.tolist(), last.tolist(), strict=True))


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
    low: Vector = Field(description="corner of the bounding box of its samples")
    high: Vector
    rows: Runs = Field(description="its samples: first and last of runs of rows of samples.npz and axes.csv, from 0")


class TurningEntry(Frozen):
    """How the tool axis turns in simultaneous motion, over the pieces that are proved."""

    pieces_mm2: list[float] = Field(description="area of each of `approaches_proved`, the largest first")
    steepest_deg_mm: float = Field(description="largest turn of the axis between neighbouring samples, over their distance")
    angles_deg: dict[str, tuple[float, float]] | None = Field(
        description="least and largest angle of each rotary axis over the pieces that one solution holds; null: none is"
    )
    held_share: float = Field(
        description="of what is proved, in pieces that one solution of the rotary axes holds from end to end, within limits"
    )
    both_share: float = Field(description="in pieces that both solutions hold")
    singular_mm2: float = Field(
        description="proved area with the axis within 2 deg of the first rotary axis: that one may have to turn fast there"
    )


class SlideEntry(Frozen):
    """A shank slides along the walls that its flutes cut, for it is as wide as these."""

    faces: list[str]
    relieved_mm: float = Field(description="least clearance with a neck ground behind the flutes, 0.95 of them wide")


class OperationEntry(Frozen):
    """One cutter in one setup, with one orientation of its axis or with simultaneous motion."""

    id: str
    step: int | None = Field(default=None, description="of the planner's own process, its number there; null: it was planned")
    mode: Literal["fixed", "simultaneous"]
    strategy: Literal["point", "floor", "wall", "mixed"] = Field(
        default="point",
        description="floor: the flat part of the tip lies on the face, strips are stepover times that; wall: the flutes lie "
        "along it, strips are as high as they are; point: the tool touches in a point; that of 95 % of its area, or mixed",
    )
    cutter: str
    setup: int = Field(description="0 for the first setup, then the others in their order")
    axis: Vector | None = Field(description="unit, from the tip to the spindle, part coordinates; null if simultaneous")
    angles_deg: dict[str, float] | None = Field(
        description="of every rotary axis by name, none on three axes; where the machine names no axes the azimuth about the "
        "setup axis and the tilt from it"
    )
    other_angles_deg: dict[str, float] | None = Field(description="the other solution with the same axis; null: none")
    samples: int
    area_mm2: float
    share: float = Field(description="of the judged area, 0 to 1")
    exclusive_mm2: float = Field(description="area that no other operation of the plan serves")
    strip_mm: tuple[float, float, float] | None = Field(
        description="widths of a pass that leaves the scallop height: 10, 50 and 90 % of the samples have at most this"
    )
    cut_length_mm: float | None = Field(description="path of the tool's centre in the cut: without links and lead-ins")
    seconds: float | None = Field(description="cutting alone, at the feed; null without a feed")
    link_seconds: float = Field(default=0.0, description="of links between passes and to its pieces; 0 without a feed")
    proved_share: float | None = Field(
        description="of its area, proved between the samples with its axis or another of the plan, or with a field of axes if "
        "simultaneous; null: not looked at"
    )
    approaches_proved: int | None = Field(
        description="connected pieces that hold 99 % of what is proved with its axis or field; inside one, any path is safe"
    )
    turning: TurningEntry | None = Field(default=None, description="of a simultaneous one; null: nothing was looked at")
    clearance_mm: float | None = Field(
        default=None,
        description="least at any of its samples, as in axes.csv: what does not cut keeps so far from its surroundings; 100: "
        "that or more; null: not known",
    )
    slide: SlideEntry | None = Field(
        default=None, exclude_if=lambda each: each is None, description="why its clearance is hardly any; not written otherwise"
    )
    orbit: int | None = Field(
        default=None, description="the same for all orientations that are images of each other about an axis; null: not repeated"
    )
    faces: list[OperationFace] = Field(description="the one with the most of it first")
    frame: WorkplaneEntry | None = Field(description="null if simultaneous")
    g68_2: str | None = Field(
        default=None,
        description="the tilted plane as LinuxCNC has it: about Z by I, the new X by J, the new Z by K, deg, from the part as it "
        "stands at zero; its zero is that of G54, the setup's origin; null: simultaneous, or no axis turns",
    )
    g53_1: str | None = Field(
        default=None,
        description="the turn onto that plane: P0 the shortest way of the first rotary axis, P1 the positive, P2 the negative "
        "one, with the rotary axes at zero before",
    )
    rotary_words: str | None = Field(
        default=None,
        description="instead of both: G54 and the positions of the rotary axes; null where their names are no A, B, C",
    )
    index_s: float | None = Field(
        description="what the rotary axes take to come to its angles from those before, in the best order of the operations of "
        "its cutter and setup, the first one from zero, or what was given or assumed; null if simultaneous"
    )
    index_from: Literal["rates", "given", "assumed"] | None = Field(
        description="of the rotary axes; given by --index-time; or assumed, as nothing was given and not all axes have rates"
    )
    regions: list[OperationRegion]
    colour: str = Field(description="sRGB, in the models")


class RestEntry(Frozen):
    """Judged samples that no operation finishes: no cutter of the plan reaches them, or a step for them would be hardly any."""

    samples: int
    area_mm2: float
    share: float
    reason_counts: dict[str, int] = Field(description="why the first cutter of the plan does not reach them")
    short: int = Field(
        default=0,
        description="of the samples, reached ones: left because they are too little for a step: less than 1 s or 0.1 mm2, or "
        "simultaneous motion; 0.1 % of the area together at most, and none where all else is finished",
    )


class AssumedEntry(Frozen):
    """Times and widths are reckoned with these numbers."""

    feed_mm_min: dict[str, float] | None = Field(description="by cutter; null: lengths stand for times")
    scallop_mm: float
    stepover: float = Field(description="widest distance of passes, in diameters")
    overlap_mm: float
    index_s: float = Field(description="of another orientation, where rates of the rotary axes do not say it")
    index_from: Literal["rates", "given", "assumed"] = Field(description="what the seconds of orientations follow from")
    change_s: float
    setup_s: float
    link_s: float = Field(default=0.0, description="from the end of a pass to the next one, and to each piece")


class OperationPlanEntry(Frozen):
    """A plan of operations: each reached sample goes with one of them."""

    name: Literal["fewest", "fastest", "process"] = Field(
        description="process: the planner's own steps, and those planned behind them"
    )
    orientations: int = Field(description="fixed ones, each with one cutter and setup")
    cut_length_mm: float
    seconds: float | None = Field(description="cutting, link and other seconds together; null without a feed")
    cutting_seconds: float | None = Field(description="of all operations, at the feed; null without a feed")
    link_seconds: float = Field(default=0.0, description="of links of all operations; 0 without a feed")
    other_seconds: float = Field(
        description="index time of each operation, change and setup time of each cutter and setup after the first"
    )
    changes: int = Field(description="of cutters")
    pieces: int = Field(description="connected regions of its operations")
    ratio_at_most: float | None = Field(
        description="cutting and links of the fixed operations over at_best_seconds of the fastest: they take at most so many "
        "times as long as simultaneous motion, by the samples compared; null where that is not known"
    )
    proved_share: float | None = Field(
        description="of the area of the operations that were looked at, proved between the samples"
    )
    approaches_proved: int | None = Field(description="of all of them together")
    operations: list[OperationEntry] = Field(description="the largest share first")
    rest: RestEntry
    split: dict[str, SplitEntry] = Field(
        default_factory=dict, description="by face: how its models show those of several operations"
    )


class OneMoreEntry(Frozen):
    """One more orientation beside the fewest would save this much time."""

    saves_seconds: float = Field(description="of the fewest plan, by a plan with it: more than a minute, and than a tenth of it")
    cutter: str
    setup: int = Field(description="0 for the first setup, then the others in their order")
    angles_deg: dict[str, float]


class FewestEntry(Frozen):
    """How few orientations there can be, with what proves it.

    Each weight is that of a sample. No candidate serves samples whose weights sum up to more than 1,000,000: so any choice of
    candidates that serves all has at least the sum of all weights over 1,000,000, rounded up.
    """

    found: int
    at_least: int = Field(description="no choice among the candidates has fewer; about samples and postures proved free")
    proof: Literal["weights", "branch and bound", "not closed"]
    weights: list[tuple[int, int]] = Field(description="row of samples.npz, and its weight")
    bound: float = Field(description="sum of the weights over 1,000,000")
    lp: float = Field(description="the bound of the best weights, before they are rounded")
    samples: int = Field(description="that are reached, so that orientations must serve them")
    candidates: int = Field(description="their angles are in operations.npz")
    spacing_deg: float = Field(description="between candidates where the weights lie")
    alone: int = Field(description="reached samples that no candidate serves: they need simultaneous motion")
    one_more: OneMoreEntry | None = Field(
        default=None, description="the orientation that saves most in addition; null: none saves so much, or there is no feed"
    )


class FastestEntry(Frozen):
    """How good the fastest plan is, against a bound by some samples that stand for the area of all."""

    seconds: float | None = Field(description="as in the fastest plan; null where a width of a pass is not known")
    bound_seconds: float = Field(
        description="no choice among the candidates takes less for these samples, counted in the same way: cutting, "
        "orientations, cutters and setups"
    )
    at_best_seconds: float = Field(
        description="cutting and links, each sample with its own best axis among the candidates: simultaneous motion at its "
        "best, without its rotary speeds"
    )
    gap: float | None = Field(
        description="how far seconds are above bound_seconds, as a share of these, 0 or more; null as they are"
    )
    samples: int
    candidates: int


class CutterUse(Frozen):
    """A cutter takes so much in each plan, and is worth so much beside the others that were compared."""

    id: str
    takes_mm2: dict[str, float] = Field(description="area of its operations, by the name of the plan")
    only_mm2: float = Field(description="judged area that none of the others reaches")
    saves_seconds: float | None = Field(
        description="the fastest plan found without it less the fastest with it, before its own change; null: no plan was "
        "found without it"
    )
    change_seconds: float = Field(description="that its change costs; 0 where it is the only one")


class OperationsEntry(Frozen):
    """Operations with fixed orientations that finish together all that is reached. All is about samples, at their contacts."""

    asked: Literal["fewest", "fastest", "both"]
    rotary: tuple[str, ...] = Field(description="names of the angles: of the rotary axes, none on three axes")
    plans: list[OperationPlanEntry]
    fewest: FewestEntry | None = Field(default=None, description="null with the planner's own process")
    fastest: FastestEntry | None = Field(description="null unless the fastest were requested")
    cutters: list[CutterUse] = Field(
        description="the largest first; empty unless the fastest were requested and several cutters were compared"
    )
    assumed: AssumedEntry
    probes: int = Field(description="how many times a tool was put down")
    notes: list[str]


#: Causes beside the reasons for which samples are not reached: not judged, reached but in no step, or hardly a step.
UNJUDGED_CAUSE, NOT_PLANNED, SHORT_STEP = "unjudged", "not_planned", "short_step"
#: Why a step of the planner's own leaves something: another orientation of its cutter would reach it.
OTHER_ORIENTATION = "orientation"
#: Room about neck, shank and holder, mm: with less, a sample counts twice in the choice of its step.
MARGIN = 1.0


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
        description="a code of `reasons`; `unjudged`; `not_planned`: a cutter reaches it, and no step takes it; `short_step`: "
        "left because it is too little for a step (less than 1 s, 0.1 mm2, or simultaneous motion for 0.1 %); "
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
    g68_2: str | None = Field(default=None, description="as of its operation, the first time; null: it has none")
    g53_1: str | None = Field(default=None, description="as of its operation")
    rotary_words: str | None = Field(default=None, description="as of its operation")
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
    link_seconds: float = Field(default=0.0, description="of links between its passes and to its pieces")
    below_mm2: float = Field(
        default=0.0, description="of its area, cut from below: the tool's axis points under the plane across the setup axis"
    )
    clearance_mm: float | None = Field(description="least at any of its samples; 100: that or more; null: not known")
    slide: SlideEntry | None = Field(
        default=None, exclude_if=lambda each: each is None, description="why its clearance is hardly any; not written otherwise"
    )
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


class ProcessSetup(Frozen):
    """How the part stands in a setup, and what holds it."""

    number: int = Field(description="1 for the first setup")
    up: Vector = Field(description="unit direction of the part along the spindle")
    stands_on: list[str] | Literal["stock"] | None = Field(
        description="planar faces below it, on the table or the ledges of jaws; stock: what the first setup grips; null: none"
    )
    held: str | None = Field(description="vise, chuck, table, or the name of a fixture; null: nothing was given")
    grips: list[str] = Field(default=[], description="faces that jaws touch; none of stock")
    apart_mm: float | None = Field(default=None, description="between the jaws of a vise; what a chuck grips is so wide")
    grip_mm: float | None = Field(default=None, description="how high jaws reach over what the part rests on")
    contact_mm: float | None = Field(
        default=None,
        exclude_if=lambda each: each is None,
        description="how much of that the faces that jaws touch have, where it is less",
    )
    out_mm: float | None = Field(
        default=None,
        exclude_if=lambda each: each is None,
        description="how far the part stands out of a chuck along a rotary axis, where that is more than it carries alone",
    )
    clamping: str | None = Field(default=None, description="what holds it, as --fixture takes it")
    soft: str = Field(default="", description="why soft jaws or a nest are needed; empty: the part is held as it is")
    text: str = ""


class StockEntry(Frozen):
    """The first setup grips stock, and some of it is to be roughed."""

    word: str = Field(description="as --stock takes it")
    size_mm: Vector = Field(description="of the box about it in the frame of the first setup, z along its axis")
    volume_mm3: float
    remove_mm3: float = Field(description="its volume less that of the part")
    seconds: float | None = Field(description="of roughing, by --removal-rate; null: none was given")


class NextEntry(Frozen):
    """A change that would finish more, with its effect."""

    words: str
    argv: list[str] = Field(description="to add to the command that was given; empty where no option says it")
    left_share: float | None = Field(description="of what is requested, that stays; null where it was not judged")


class HoleSetupEntry(Frozen):
    """A further setup, in which tools of the libraries make holes that they make in none of the plan's."""

    axis: Vector = Field(description="direction of the part along the spindle")
    holes: int = Field(description="that are made there, where nothing but the part is in the way")
    argv: list[str] = Field(description="to add to the command that was given; empty where no option says it")


class ChamferEntry(Frozen):
    """A chamfer mill that would save much of the time that the steps take for chamfers."""

    angle_deg: float = Field(description="of its tip")
    faces: list[str]
    seconds: float = Field(description="that the steps take for them, with links")
    saves: float = Field(description="seconds, after the change of the tool")
    argv: list[str] = Field(description="to add to the command that was given; empty where no option says it")


class ProcessEntry(Frozen):
    """A process says in which steps the given cutters, setups and operations finish how much together."""

    steps: list[ProcessStep] = Field(
        description="the planner's own first, then by setup; in a setup by cutter, the largest first, and with a cutter floors, "
        "walls, other fixed orientations, simultaneous motion"
    )
    drilling: list[DrillingStep] = Field(
        default=[],
        exclude_if=lambda steps: not steps,
        description="steps that drill `holes` with tools of the libraries, by setup; their numbers follow those of `steps`, "
        "and their seconds are in those of the process; not written where there are none",
    )
    hole_setup: HoleSetupEntry | None = Field(
        default=None, exclude_if=lambda each: each is None, description="the one for most holes; not written where there is none"
    )
    chamfers: ChamferEntry | None = Field(
        default=None, exclude_if=lambda each: each is None, description="not written where no chamfer mill saves much"
    )
    setups: list[ProcessSetup] = Field(default=[], description="how the part stands, in the order of the setups")
    stock: StockEntry | None = Field(default=None, description="null: the part is there but for its last cut")
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
        description="of all steps, with links, orientations, changes of cutters and setups: the sum of the next five; null "
        "without a feed"
    )
    cutting_seconds: float | None = Field(default=None, description="of all steps, at their feeds")
    link_seconds: float | None = Field(default=None, description="of links between their passes and to their pieces")
    index_seconds: float | None = Field(default=None, description="of turns from one orientation to the next")
    change_seconds: float | None = Field(default=None, description="of changes of cutters")
    setup_seconds: float | None = Field(default=None, description="to clamp the part for each setup after the first")
    next: list[NextEntry] = Field(default=[], description="the best first")
    doubts: list[str] = Field(default=[], description="what changes what one does: a line each, the gravest first")

    @property
    def finished(self) -> bool:
        """Whether all that could be judged is finished."""
        return all(each.cause == UNJUDGED_CAUSE for each in self.left)
