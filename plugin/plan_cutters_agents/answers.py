"""The answers to an agent: their fields are the output schemas of the tools, and what of a plan file they are made of.

Lengths are mm, angles deg, part coordinates; shares are of an area, 0 to 1. Lists are whole here: `short` cuts them.
"""

from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

FORMAT_VERSION = 1
Vector = tuple[float, float, float]
#: Which faces a change was judged on.
About = Literal["this face", "all faces of the plan", "nothing"]


class Entry(BaseModel):
    """An entry takes its fields from a plan file, and leaves the others."""

    model_config = ConfigDict(frozen=True, extra="ignore", from_attributes=True)


class Posture(Entry):
    tilt: float
    rotation: float
    axis: Vector


class Witness(Entry):
    """A place that is not reached, with the posture that comes nearest."""

    point: Vector
    face: str
    verdict: Literal["inaccessible", "undecided"] = "inaccessible"
    reason: str = Field(description="code, as in `reasons`")
    obstacle_face: str | None = Field(default=None, description="in the way at the best posture: a face, or `fixture:NAME`")
    obstacle_point: Vector | None = None
    best_posture: Posture | None = None
    depth_mm: float | None = Field(default=None, description="how deep the obstacle is in the tool at the best posture")
    samples: int = Field(default=1, description="that it stands for")
    inside_bodies: bool = False


class Reason(Entry):
    """Why something is not reached."""

    code: str = Field(description="stable: docs/json.md lists all")
    name: str
    meaning: str
    try_first: str = Field(description="a rule of thumb, not computed: what was computed is in `would_help`")
    share: float = Field(description="of the area in question that is not reached for it")


class Help(Entry):
    """A change that was judged, not guessed: with it so much more is reached."""

    what: str
    things: list[str] = Field(description="codes of what is changed: radius, stick_out, setup, ...")
    finishes: bool | None = Field(description="whether all is reached then; null: not decided")
    lost_before: float | None = None
    lost_after: float | None = None
    gained_samples: int | None = None
    option: str | None = Field(default=None, description="words of the command line that do it")


class Lost(Entry):
    """A face of which a cutter loses something."""

    face: str
    share: float = Field(description="of the face that is not reached")
    reason: str | None = Field(description="code of the reason for which most is not reached")


class CutterAnswer(Entry):
    id: str
    name: str
    text: str = Field(description="how much it reaches, or does not reach and why")
    feasible: bool | None = Field(description="whether it reaches every judged sample; null: not decided")
    seen: bool = Field(description="false: samples are too far apart for this cutter, so `feasible` says little")
    reached: float
    inaccessible: float
    undecided: float
    lost_by: dict[str, float] = Field(description="code of a reason -> share of the area")
    faces: list[Lost] = Field(description="the worst first")
    next: Help | None = Field(default=None, description="the step that gains most, where `mend` was requested")


class Missing(Entry):
    """An obstacle that is missing or guessed: while there is one, nothing is feasible beyond doubt."""

    face: str | None = None
    name: str = ""
    why: str


class Note(Entry):
    code: str
    text: str


class Samples(Entry):
    """Shares of two answers about one part and its faces can be compared where both have the same samples."""

    count: int
    #: The widest of any face; given as `spacing_mm` in each call, all have the same samples.
    spacing_mm: float | None = None
    sampled_by: str = Field(default="default", description="default: by curvature and the smallest cutter; else the option")
    max_gap_mm: float | None = None
    unjudged: int = 0
    inside_bodies: int = 0


class Answer(Entry):
    format_version: int = FORMAT_VERSION
    part: str
    told: str = Field(description="the answer in sentences")


class OfPlan(Answer):
    """An answer about a plan has these fields."""

    exit_code: int = Field(description="as of the command: 0 a cutter finishes, 1 none does, 4 not all could be judged")
    selected: str | None = Field(description="id of the cutter to take")
    samples: Samples
    cutters: list[CutterAnswer] = Field(description="those that reach most first")
    not_judged: list[Note] = Field(default=[], description="target faces that could not be judged, and why: `code` is the face")
    missing: list[Missing] = Field(default=[])


class Remaining(Entry):
    """An area that no step finishes, for one cause."""

    #: Code of a reason; `unjudged`; `not_planned`: reached, and in no step; `short_step`: a step for it would take less than 1 s;
    #: `orientation`: reached by the step's cutter in this setup at other angles.
    cause: str
    area_mm2: float
    share: float
    faces: list[str] = Field(description="the one with the most of it first")
    place_mm: Vector | None = Field(default=None, description="a sample in the middle of it, on the first of the faces")
    needs: str = Field(default="", description="what would help, in words")


class NearestOrientation(Entry):
    """The orientation next to that of a step, that takes more of what the step is asked."""

    angles: dict[str, float]
    axis: Vector
    area_mm2: float


class OwnStepAnswer(Entry):
    """A step of `process` is asked this, and leaves this of it."""

    number: int = Field(description="in `process`, from 1")
    text: str = Field(default="", description="what is wrong with it, a sentence; empty where it does all")
    asked_mm2: float
    wrong: str = Field(default="", description="why it does nothing; empty where it can be judged")
    leaves: list[Remaining]
    nearest: NearestOrientation | None = None


class StepAnswer(Entry):
    """A step of the process, in the words of `process`: to edit and to judge again."""

    setup: int = Field(description="from 1")
    mode: Literal["fixed", "simultaneous", "any"]
    angles: dict[str, float] | None = Field(description="of the rotary axes by name, deg; null unless fixed")
    axis: Vector | None = Field(description="of a fixed orientation without angles; else null")
    cutter: str
    faces: list[str] = Field(description="the one with the most of it first")
    take: Literal["first", "share"] = Field(description="as in `process`: share: by time, with other steps that share its faces")
    area_mm2: float
    share: float = Field(description="of `asked_mm2`")
    alone_mm2: float | None = Field(description="that no other step serves: gone if it is left out; null: not known")
    seconds: float | None = Field(description="cutting alone; null where it is not known")
    clearance_mm: float | None = None
    own: OwnStepAnswer | None = Field(default=None, description="null: the step was planned")


class PlanAnswer(OfPlan):
    format: Literal["plan-cutters-agent-plan"] = "plan-cutters-agent-plan"
    asked_mm2: float | None = Field(default=None, description="of the faces to machine, that the steps are to finish")
    finished_share: float | None = Field(default=None, description="by all steps together; 1 only where nothing is left")
    seconds: float | None = Field(default=None, description="of all steps, turns and changes of cutters; null without a feed")
    steps: list[StepAnswer] = Field(default=[], description="of the process, in their order")
    left: list[Remaining] = Field(default=[], description="what no step finishes, the largest area first")
    notes: list[Note] = Field(description="what these verdicts do not say")
    files: dict[str, str] = Field({}, description="format -> path, where `out` was given")
    not_written: dict[str, str] = Field({})


class FaceRow(Entry):
    """A face on which cutters differ."""

    face: str
    reached: dict[str, float] = Field(description="cutter -> share of the face that it reaches")


class Run(Entry):
    cutter: str
    setup: Vector
    share: float
    samples: int = 0


class LeastSet(Entry):
    runs: list[Run]
    share: float
    left_share: float = 0.0
    proven: bool = False


class Comparison(OfPlan):
    format: Literal["plan-cutters-agent-comparison"] = "plan-cutters-agent-comparison"
    differ: list[FaceRow] = Field(description="faces of which cutters reach different shares, the widest difference first")
    together: LeastSet | None = Field(default=None, description="the fewest of them that reach all that any of them reaches")


class RotationRow(Entry):
    deg: float
    free: list[tuple[float, float]] = Field(description="free tilts")
    undecided: list[tuple[float, float]]
    local_gouge_below: float | None = Field(description="least tilt that the surface itself allows; null: none")
    forbidden: dict[str, list[tuple[float, float]]] = Field(description="code of a cause -> tilts; causes overlap")


class Postures(Entry):
    """All postures of a cutter at a point."""

    point: Vector = Field(description="the nearest point of the part")
    face: str
    off_mm: float = Field(description="from the requested point")
    normal: Vector
    direction_max: Vector = Field(description="rotation 0")
    certified: bool = Field(description="free tilts are safe for the true surface, to the tolerance")
    free_share: float = Field(description="of the postures searched")
    undecided_share: float
    forbidden: dict[str, float] = Field(description="code of a cause -> share of the postures; causes overlap")
    rotations: list[RotationRow]
    missing: int = Field(default=0, description="obstacles that are missing or guessed")
    flank_axis: Vector | None = Field(default=None, description="tool axis with which the flank lies along the surface, free")
    #: Upright the tool is free with the point under its flat: from its axis to the point.
    under_flat_mm: Vector | None = None


class MapAnswer(Answer):
    format: Literal["plan-cutters-agent-map"] = "plan-cutters-agent-map"
    cutter: str
    exit_code: int = Field(description="0 some tilt is free, or the point under the flat, 1 none is, 4 none is surely free")
    postures: Postures


class Sample(Entry):
    """The sample of the plan that is nearest to the point."""

    point: Vector
    distance_mm: float
    face: str
    verdict: str
    reason: str | None
    axis: Vector | None = Field(description="tool axis that was found")


class InTheWay(Entry):
    face: str = Field(description="a face, or `fixture:NAME`")
    reason: str
    depth_mm: float | None = Field(description="the deepest")
    places: int = Field(description="witnesses that name it")


class Explanation(Answer):
    format: Literal["plan-cutters-agent-explanation"] = "plan-cutters-agent-explanation"
    cutter: str
    face: str
    reached: bool | None = Field(description="every judged sample of the face; null: undecided, or not to be judged")
    lost_share: float = Field(description="of the face")
    counts: dict[str, int] = Field(description="samples of the face by verdict")
    reasons: list[Reason] = Field(description="the one that loses most first")
    in_the_way: list[InTheWay]
    witnesses: list[Witness] = Field(description="worst spots, the deepest first; with a point, the nearest first")
    would_help: list[Help] = Field(description="changes that gain something, the best first")
    help_is_about: About = "nothing"
    no_help: str = Field(default="", description="why `would_help` is empty")
    postures: Postures | None = Field(default=None, description="at the point, where a part was given")
    sample: Sample | None = Field(default=None, description="nearest to the point, where a plan with samples.npz was given")
    missing: list[Missing] = Field(default=[])


class Picture(OfPlan):
    format: Literal["plan-cutters-agent-picture"] = "plan-cutters-agent-picture"
    shown: str = Field(description="id of the cutter whose verdicts are shown")
    legend: dict[str, str] = Field(description="colour -> what it means")


class ToolRow(Entry):
    """A tool that can be judged."""

    id: str = Field(description="as `cutters` and `cutter` take it, where it says all of the tool")
    name: str = ""
    number: int | None = Field(default=None, description="in the tool changer")
    kind: str
    diameter_mm: float
    corner_radius_mm: float = 0.0
    stickout_mm: float
    holder: str = ""


class MachineRow(Entry):
    """A machine that is built in."""

    name: str = Field(description="as `machine` takes it")
    axes: list[str] = Field(description="from the tool to the part")
    reaches: float = Field(description="share of all directions of the tool axis")


class ShopAnswer(Answer):
    format: Literal["plan-cutters-agent-shop"] = "plan-cutters-agent-shop"
    library: str = Field(description="empty: the built-in set")
    tools: list[ToolRow]
    unused: list[str] = Field(default=[], description="entries of the library that cannot be judged, and why")
    machines: list[MachineRow]


class ChangedRow(Entry):
    """A face or cutter that two plans answer otherwise."""

    name: str
    what: str = Field(description="what became of it, as `diff` of the command line says it")
    was: str
    now: str
    changed: str = ""


class PlanDifferenceAnswer(Answer):
    format: Literal["plan-cutters-agent-difference"] = "plan-cutters-agent-difference"
    comparable: bool
    why_not: list[str] = Field(default=[])
    lost: bool | None = Field(description="whether a face or cutter reaches less; null: not comparable")
    won: bool | None
    selected: list[str | None] = Field(description="ids of the cutters to take, old and new")
    faces: list[ChangedRow] = Field(description="the worst first")
    cutters: list[ChangedRow]
    unreachable: list[str] = Field(default=[], description="target faces of the new plan that no cutter reaches whole")
