"""The plan as written: one pydantic model is the file's form, its JSON Schema and its documentation.

Lengths in mm, angles in degrees, part coordinates.
"""

import math
from collections.abc import Iterable
from typing import Literal

from pydantic import Field

from plan_cutters.plan_file.answers import LeastSetEntry, MendEntry, RadiusEntry, StickOutEntry
from plan_cutters.plan_file.effective import Effective
from plan_cutters.plan_file.frozen import Frozen, Posture, Vector
from plan_cutters.plan_file.holes import HoleEntry
from plan_cutters.plan_file.operations import OperationsEntry, ProcessEntry, SplitEntry
from plan_cutters.plan_file.part_info import (
    CarrierEntry,
    FixtureEntry,
    InsideEntry,
    InsideRadiusEntry,
    PartInfo,
    PatternEntry,
    Scope,
    SetupEntry,
    SetupProposal,
    SetupReach,
    SharpEdgeEntry,
    TravelEntry,
)
from plan_cutters.plan_file.shares import AreaShare, FaceVerdicts, VerdictCounts

FORMAT_VERSION = 1


class Units(Frozen):
    length: Literal["mm"] = "mm"
    angle: Literal["deg"] = "deg"


class SampleCounts(Frozen):
    count: int
    max_gap_mm: float = Field(
        description="largest distance between neighbours on a face's grid, and from a point of a sampled face, up to its "
        "border, to the nearest sample of that face; verdicts are about samples"
    )
    convex: int
    concave: int
    saddle: int
    unjudged: int
    regions: int
    inside_bodies: int = Field(
        default=0, description="inside other bodies of the part: no surface of the finished part (`inside_other_bodies`)"
    )

    exempt: int = Field(default=0, description="at sharp inside edges that no cutter enters, and not required (`sharp_edges`)")

    drilled: int = Field(
        default=0, exclude_if=lambda samples: not samples, description="in holes for drills; not written where there are none"
    )

    @property
    def finished(self) -> int:
        """Samples that are required: what shares and choices are about, those that are not judged included."""
        return self.count - self.inside_bodies - self.exempt - self.drilled

    @property
    def judged(self) -> int:
        """Judged samples of the finished part's surface."""
        return self.finished - self.unjudged


class FaceEntry(Frozen):
    id: str
    name: str
    surface: str = Field(description="kind of the stored surface")
    shape: str = Field(description="what it is in shape: plane, cylinder, cone, sphere, torus or sculptured")
    kind: str = Field(default="", description="`shape`, or `blend`: a fillet or round that joins two faces smoothly")
    target: bool
    ignored: bool = Field(default=False, description="neither a target nor an obstacle")
    area_mm2: float
    centre_mm: Vector | None = Field(
        default=None,
        description="middle of its bounding box, by which it is known again in another plan; null where it has no finite size",
    )
    carrier: CarrierEntry | None = Field(default=None, description="null of a sculptured face")
    neighbours: list[str] | None = Field(default=None, description="ids of the faces across its edges; null in older files")
    component: str = Field(description="names of the instances in the file down to the product that it belongs to")
    samples: int
    gap_mm: float | None = Field(
        default=None, description="as `samples.max_gap_mm`, of this face alone; null where it was not sampled"
    )
    chord_error_mm: float | None = Field(
        default=None, description="bound of the distance between its triangles and its surface; null where it has none"
    )
    unjudged: str | None = Field(description="why the face, or some of its samples, could not be judged")


class MissingEntry(Frozen):
    """A face that is in the way only as a guess, or not at all: while there is one, no cutter is feasible beyond doubt."""

    face: str | None = Field(description="null: it is only in the file")
    entity: str | None = Field(description="what the file calls it, where it could not be read")
    name: str
    why: str
    stand_in: Literal["triangles", "box", "edges", "none"] = Field(
        description="what is in the way instead; what only that forbids is undecided"
    )


class WitnessEntry(Frozen):
    """A sample that is not reached and the posture that comes nearest to reaching it."""

    sample: int = Field(description="its row in samples.npz")
    point: Vector
    face: str
    verdict: Literal["inaccessible", "undecided"] = "inaccessible"
    reason: str
    obstacle_face: str | None = Field(description="or `fixture:NAME`")
    obstacle_point: Vector | None = Field(description="a point of that face in the cutter at the best posture")
    best_posture: Posture | None
    depth_mm: float | None = Field(description="how deep the part reaches into the cutter at the best posture, or may do")
    inside_bodies: bool = Field(default=False, description="it lies inside another body of the part")
    samples: int = Field(default=1, description="of its face that are not reached for its reason, inside the same body if any")


class AreaEntry(Frozen):
    """How far a cutter's postures, each with its axis kept, serve the surface between the samples and up to its border."""

    share: float = Field(
        description="of the area of the target faces, faces without samples included (these are not served), 0 to 1"
    )
    feasible: bool = Field(description="all of it, to one part in a million, and no face is left out")
    contacts: int = Field(description="contacts looked at, samples included")
    left: int = Field(description="contacts whose cells were not shown to be served when the budget ended")
    short: int = Field(description="those of them for which the budget was spent")
    dropped: int = Field(
        default=0, description="those of them that were not looked at more closely, for too little area was to be gained"
    )
    left_out: list[str] = Field(default=[], description="target faces whose area is not known: they are not in `share`")


class SegmentEntry(Frozen):
    """A segment is one cylinder or cone above the flutes: of the neck, the shank or the holder."""

    part: Literal["neck", "shank", "holder"]
    low_mm: float = Field(description="height over the tip at which it begins")
    length_mm: float
    radius_mm: float
    upper_radius_mm: float


class RotaryEntry(Frozen):
    """A rotary axis of the machine."""

    name: str
    carries: Literal["part", "tool"]
    direction: Vector = Field(description="in the part's frame at zero angles; positive is the tool's turn relative to the part")
    limits_deg: tuple[float, float] | None


class LinearEntry(Frozen):
    """A linear axis of the machine, and how far the surface to machine reaches along it."""

    name: str
    carries: Literal["part", "tool"]
    direction: Vector = Field(description="as of rotary axes, in the first setup")
    limits_mm: tuple[float | None, float | None] = Field(description="null: no limit on that side")
    extent_mm: float = Field(description="of all target samples along it, rotary axes at zero")

    @property
    def short_mm(self) -> float:
        """By how much the surface is longer than the travel; 0 where it is not, or where there is no limit."""
        low, high = self.limits_mm
        return 0.0 if low is None or high is None else max(0.0, self.extent_mm - (high - low))


class MachineEntry(Frozen):
    """The machine limited the tool axes in this way."""

    name: str
    tilt_limit_deg: float | None = Field(description="largest angle from the setup axis")
    rotary: list[RotaryEntry] | None = Field(description="from the part to the tool; null: any within the limit above")
    linear: list[LinearEntry] = Field(default=[], description="from the part to the tool; empty where none is known")
    notes: list[str]


class SourceEntry(Frozen):
    """Where a tool library lists a cutter."""

    file: str
    place: str
    number: int | None = Field(description="in the machine's tool changer")
    name: str
    kind: str = Field(description="as the file words it")
    unit: str = Field(description="that its lengths are given in; empty where the file does not say")
    notes: list[str] = Field(description="how it was understood where that is not plain")


class UnusedEntry(Frozen):
    """A tool of a library that became no cutter."""

    place: str
    number: int | None
    name: str
    kind: str
    why: str = Field(description="the field concerned, what is wrong with it and what to add")
    broken: bool = Field(description="it contradicts itself or cannot be read")
    unheld: bool = Field(default=False, description="it does not fit its holder, as with a shank wider than the collet takes")


class LibraryEntry(Frozen):
    """A tool library, and what of it was not used."""

    file: str
    format: str
    tools: int = Field(description="that it lists")
    cutters: int = Field(description="of different geometry that came of them")
    drills: int = Field(
        default=0,
        exclude_if=lambda tools: not tools,
        description="tools for holes of different geometry that came of them; not written where there are none",
    )
    holders: list[str] = Field(description="that it lists by themselves")
    notes: list[str]
    unused: list[UnusedEntry]


class CutterEntry(VerdictCounts):
    id: str
    name: str
    sources: list[SourceEntry] = Field(default=[], description="where tool libraries list it, all places")
    radius: float
    corner_radius: float
    length: float = Field(description="from the tip to the holder's nose, or to the end of what is checked")
    shape: str = Field(default="end", description="end, lollipop, barrel, lens or form")
    taper_deg: float = Field(default=0.0, description="half angle")
    group: str = Field(
        description="how its kind is ranked: ball, bull, flat, special (tapered with a round tip, barrel, lens, lollipop) or "
        "last (engraving, chamfer and form cutters, dovetails)"
    )
    flutes_mm: float | None = Field(default=None, description="height over the tip up to which it cuts")
    holder: str = Field(default="", description="its holder's name; empty where it has none, or one without a name")
    stages: list[SegmentEntry] = Field(default=[], description="from the flutes up")
    touches_deg: list[tuple[float, float]] = Field(default=[], description="tilts at which the cutting part can touch")
    allowance_mm: float = 0.0
    clearance_mm: float = Field(default=0.0, description="clearance required of neck, shank and holder")
    slack_mm: float = Field(
        default=0.0, description="how far from what counts a point may be and still count, where a shape is held in a larger one"
    )
    feasible: bool | None = Field(
        description="null: undecided samples alone are left, or those that stand on the table of a proposed setup (reason "
        "another_setup), or it reaches all that could be judged but obstacles are missing"
    )
    seen: bool = Field(
        default=True,
        description="no point of the sampled faces is farther from their samples than its radius, nor grid neighbours from each "
        "other (`samples.max_gap_mm`), or the area between them is proved; `feasible` is about the samples all the same",
    )
    march_differs: int = Field(description="convex samples on which the seed's boundary march gives another answer")
    by_reason: dict[str, int] = Field(description="inaccessible samples by reason")
    undecided_by_reason: dict[str, int]
    axis_limit_with: dict[str, int] = Field(
        default={},
        description="samples that the axis limit forbids, at which something else is in the way within the limit, by that reason",
    )
    faces: dict[str, FaceVerdicts]
    area_share: AreaShare = Field(
        default=AreaShare(),
        description="of the target faces' area without what lies inside other bodies, faces without samples (unjudged) included "
        "and those of unknown area not; what the samples stand for, not what is shown between them: that is in `area`",
    )
    witnesses: list[WitnessEntry] = Field(description="for each face and reason, the deepest that was tried first")
    witnesses_untried: int = Field(default=0, description="those without a depth: others of larger area took all tries")
    area: AreaEntry | None = Field(default=None, description="of the selected cutter; null where it was not requested")
    setups: list[SetupReach] = Field(
        default=[], description="where several setups were requested: what it reaches in each, the plan's own first"
    )
    lost_in_all: int | None = Field(
        default=None, description="samples that it reaches in none of these setups; null where one was requested"
    )
    beyond_setup: int = Field(
        default=0,
        description="samples at which no axis within the limit lets any cutter touch, as an underside's, in each of the setups "
        "asked for; `by_reason` says what would free each",
    )
    singular: int | None = Field(
        default=None,
        description="reached samples whose posture lies within 2 deg of the rotary axis next to the part, which then turns fast; "
        "null without two rotary axes",
    )
    travel: TravelEntry | None = Field(default=None, description="null where linear travel is not judged: see the notes")
    least_stick_out: StickOutEntry | None = Field(default=None, description="null where it was not requested")
    mend: MendEntry | None = Field(
        default=None, description="what to do next with it; null where it is feasible, or where that was not requested"
    )
    seconds: float = Field(default=0.0, exclude=True, description="dummy tests and search; not written")


class Selection(Frozen):
    rule: str
    free_form: float = Field(default=0.0, description="share of the target faces' area that is bent in both directions, 0 to 1")
    runner_up: str | None
    why: str


Tone = Literal["good", "partly", "bad", "unsure"]


class VerdictText(Frozen):
    """A verdict in a word, and how good it is."""

    tone: Tone
    word: str


class TextEntry(Frozen):
    """The plan in words, made once: every reader shows these."""

    headline: str = Field(description="how much is finished in how many steps, what stays and why; or which cutter to take")
    tone: Tone
    lines: list[str] = Field(
        description="why, what is not judged or left: at most 25 lines of at most 80 columns; options as fields of their names"
    )
    cutters: dict[str, str] = Field(description="id of a cutter -> how much it reaches, or does not reach and why")
    verdicts: dict[str, VerdictText] = Field(description="id of a cutter -> whether it is feasible")
    shares: dict[str, dict[str, str]] = Field(
        description="id of a cutter -> verdict -> share of the area with it, in percent as people read it"
    )


#: Of a plan that is not yet put into words.
NO_TEXT = TextEntry(headline="", tone="unsure", lines=[], cutters={}, verdicts={}, shares={})


class FileEntry(Frozen):
    name: str
    sha256: str
    size_bytes: int


class Run(Frozen):
    """Only these values differ between two runs with the same input."""

    time: str
    seconds: dict[str, float] = Field(description="by stage; those of a cutter, by its id, are its judging")
    boxes: dict[str, int] = Field(default={}, description="boxes of obstacle trees that were looked at, by stage")
    total: float = Field(
        default=0.0,
        description="seconds from the start of the command (from Python: of the planning, without what lies between it and the "
        "writing) to the writing of this file; the stages are its parts",
    )


class Plan(Frozen):
    """Which cutters finish the target faces of a part, where each does not, and why."""

    format: Literal["plan-cutters-plan"] = "plan-cutters-plan"
    format_version: int = FORMAT_VERSION
    units: Units = Units()
    text: TextEntry
    process: ProcessEntry
    part: PartInfo
    effective: Effective
    versions: dict[str, str]
    samples: SampleCounts
    scope: Scope = Field(description="which faces were judged")
    inside_other_bodies: InsideEntry = InsideEntry()
    faces: list[FaceEntry]
    missing: list[MissingEntry]
    reasons: list[str] = Field(description="what `reason_ID` in samples.npz counts in")
    reason_words: dict[str, str] = Field(default={}, description="what each of `reasons` is called, for people")
    machine: MachineEntry
    fixtures: list[FixtureEntry] = Field(default=[], description="what holds the part: obstacles, never targets")
    libraries: list[LibraryEntry] = Field(default=[], description="tool libraries that were read")
    cutters: list[CutterEntry]
    selected: str | None
    shown: str = Field(description="id of the cutter that models show: `selected`, else the one that leaves the least area")
    selected_over_setups: str | None = Field(
        default=None,
        description="where several setups were requested: the first cutter that reaches every judged sample in one or another",
    )
    selected_for_setup: str | None = Field(
        default=None,
        description="the first cutter that leaves nothing but what the axis limit loses for every cutter in this setup; null "
        "where a cutter is selected, where none does, or where nothing is within the limit",
    )
    selection: Selection
    sharp_edges: list[SharpEdgeEntry] = Field(
        default=[], description="sharp inside edges at which the cutter `shown` leaves a fillet, the largest area first"
    )
    patterns: list[PatternEntry] = Field(default=[], description="equal faces; those of motions of the whole part first")
    inside_radii: list[InsideRadiusEntry] = Field(
        default=[], description="faces that bend inwards more than the cutter `shown`, the smallest radius first"
    )
    holes: list[HoleEntry] = Field(
        default=[],
        description="holes for drills: those narrower than `effective.drill_below_mm`, with a target face among theirs",
    )
    setup_proposal: SetupProposal | None = Field(default=None, description="null unless requested (--setup auto)")
    setups: list[SetupEntry] = Field(default=[], description="this setup axis first; empty where any tool axis is possible")
    largest_radius: list[RadiusEntry] = Field(
        default=[], description="of bare flat and ball ends, whatever cutters there are; empty where it was not requested"
    )
    least_set: LeastSetEntry | None = Field(
        default=None,
        description="which of the given cutters and setups reach together all that any of them reaches; null where there "
        "is one of each",
    )
    operations: OperationsEntry | None = Field(default=None, description="null unless requested (--operations)")
    not_mended: list[str] = Field(
        default=[], description="ids of cutters that fail and were left out of `mend`, as others come nearer"
    )
    notes: list[str] = Field(description="what these verdicts do not say")
    note_codes: list[str] = Field(description="what each note is about")
    legend: dict[str, str] = Field(description="colour of each verdict in the STEP and GLB files, sRGB")
    legend_words: dict[str, str] = Field(default={}, description="what those colours mean, in words for people")
    split: dict[str, SplitEntry] = Field(default={}, description="faces of mixed verdicts: how the models show them")
    files: dict[str, FileEntry] = Field(default={}, description="what was written into the folder of this file, by format")
    not_written: dict[str, str] = Field(default={}, description="requested formats whose file is missing, and why")
    run: Run


#: The reason of what is left for another setup.
ANOTHER_SETUP = "another_setup"
#: Shares that differ by less are equal.
_DIGITS = 9


def leaves(cutter: CutterEntry) -> tuple[float, int]:
    """Sort cutters by this: the share of the area that is left, then the number of samples, which may stand for no area.

    What stands on the table of a proposed setup does not count: that table is not there yet, and chooses no cutter.
    """
    share = cutter.area_share.not_reached - cutter.area_share.lost_by.get(ANOTHER_SETUP, 0.0)
    samples = cutter.not_reached - cutter.by_reason.get(ANOTHER_SETUP, 0)
    return round(share, _DIGITS) + 0.0 if math.isfinite(share) else math.inf, samples


def nearest(cutters: Iterable[CutterEntry]) -> CutterEntry:
    """Of some cutters the one that leaves least; of equals the first, which is the most wanted."""
    return min(cutters, key=leaves)
