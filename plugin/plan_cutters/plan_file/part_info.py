"""Entries on the part itself, the form of its faces, how it stands, and how much is reached in each setup."""

from typing import Literal

from pydantic import Field

from plan_cutters.plan_file.frozen import Frozen, Vector
from plan_cutters.plan_file.shares import VerdictCounts


class CarrierEntry(Frozen):
    """The whole plane, cylinder, cone, sphere or torus that a face is a part of, as `shape` of the face says."""

    point_mm: Vector = Field(
        description="the point of a plane or of a cylinder's axis that is nearest the origin, the apex of a cone, the centre of "
        "a sphere or torus"
    )
    direction: Vector | None = Field(
        default=None,
        description="unit normal of a plane, unit direction of an axis: the first of its longest components is positive, of a "
        "cone it points from the apex to the face; null of a sphere",
    )
    radius_mm: float | None = Field(
        default=None, description="of a cylinder or sphere, and of the circle about which a torus lies"
    )
    minor_radius_mm: float | None = Field(default=None, description="of the tube of a torus")
    half_angle_deg: float | None = Field(default=None, description="between the axis and the surface of a cone")
    outward: bool | None = Field(
        default=None,
        description="whether the normal out of the material points along a plane's direction, or away from an axis, from a "
        "centre or from the middle of a tube: of a hole it does not; null where that is a guess",
    )


class SharpEdgeEntry(Frozen):
    """Where two faces meet at an angle below 180 deg without a fillet, and what the cutter `shown` leaves there."""

    faces: tuple[str, str]
    length_mm: float = Field(description="of all edges between the two faces that are sharp")
    angle_deg: float = Field(description="between the faces, through the air; the mean along the edges")
    radius_mm: float = Field(description="of the fillet that the cutter leaves, its allowance included")
    width_mm: float = Field(description="of the strip on each face, as between planes at this angle")
    area_mm2: float = Field(description="that the cutter leaves on both faces, by its samples with the reason `sharp_edge`")


class CoveringBody(Frozen):
    """A body of the part, and what of the target faces lies inside it."""

    number: int = Field(description="from 1")
    name: str = Field(description="of its component; empty where it has none of its own")
    own_faces: list[str] = Field(description="runs of them, as `F7-12`")
    faces: list[str] = Field(description="target faces that it covers, some of each at least")
    samples: int
    area_mm2: float
    how: Literal["overlaps", "stands_on", "touches_or_overlaps"] = Field(
        description="stands_on: the shells touch and the volumes do not intersect, as a clamp modelled as a solid"
    )
    largest: bool = Field(default=False, description="no other body is larger")
    option: str = Field(description="of the command, which leaves the body out")


class SheetsEntry(Frozen):
    """Construction sheets on the skin of a body: what of them faces into it."""

    faces: list[str]
    samples: int
    area_mm2: float
    option: str = Field(description="of the command, which leaves them out")


class InsideEntry(Frozen):
    """This much of the target faces lies inside other bodies of the part: it is no surface of the finished part."""

    samples: int = 0
    area_mm2: float = 0.0
    share: float = Field(default=0.0, description="of the target faces' area, 0 to 1")
    bodies: list[CoveringBody] = Field(default=[], description="those that cover the largest area first")
    sheets: SheetsEntry | None = None


class InsideRadiusEntry(Frozen):
    """A face that bends inwards more than the cutter `shown`, which is not reached there for that."""

    face: str
    radius_mm: float = Field(description="inside radius that most of the area that is not reached there has, or a larger one")
    cutter_radius_mm: float = Field(description="radius or corner radius of the cutter, its allowance included")
    area_mm2: float = Field(description="of the face that is not reached for local or rear gouge")
    fits_mm: float | None = Field(description="largest usual diameter whose radius fits; null where none is that small")


class PatternEntry(Frozen):
    """Faces that are equal under a rotation, a mirror or shifts, within a millionth of the part's size."""

    kind: Literal["rotation", "mirror", "shift"]
    order: int = Field(description="copies: the whole turn over the angle of a rotation; 2 of a mirror")
    whole: bool = Field(description="whether each motion carries the whole part onto itself")
    place_mm: Vector | None = Field(description="a point of the axis or of the mirror; null for shifts")
    direction: Vector | None = Field(description="unit, of the axis, or the mirror's normal; null for shifts")
    shifts_mm: list[Vector] = Field(default=[], description="from the first copy to each other one; of shifts alone")
    faces: list[list[str]] = Field(description="by copy, the first one first: equal faces stand in the same place")
    moved: int = Field(
        default=0, description="samples of all cutters and setups whose posture is that of an equal one, tested in its place"
    )
    followed: int = Field(default=0, description="samples that were found not to be reached as equal ones are, without a search")
    verified: int = Field(default=0, description="samples that were searched by themselves to verify that")


class FixtureEntry(Frozen):
    """A body that is in the way and no part of what is machined."""

    name: str = Field(description="as `obstacle_face` has it: fixture:NAME")
    file: str | None = Field(description="null for words and objects")
    sha256: str | None
    unit: str | None = Field(description="of lengths in the file; null: as the file says")
    placement: tuple[float, float, float, float, float, float] = Field(
        description="x, y, z, mm, and turns about the part's fixed x, then y, then z axis, deg, which come before the shift"
    )
    triangles: int
    chord_error_mm: float = Field(description="how far they are from what they stand for; of a mesh, as stated")
    watertight: bool = Field(description="it encloses something; else only its surface is in the way")
    notes: list[str]
    clamping: str | None = Field(
        default=None, description="of a built-in vise or chuck: its word with all numbers and its place, as --fixture takes it"
    )
    grips: list[str] = Field(default=[], description="faces that its jaws touch, where it was placed for the setup")
    unheld: list[str] = Field(
        default=[], description="of a vise or chuck: bodies of the part that its jaws do not hold, each by its first face"
    )
    hidden_mm2: float | None = Field(
        default=None, description="area of the faces to machine that its jaws touch; null: it was not placed for the setup"
    )
    setups: list[int] = Field(default=[0], description="setups in which it stands, counted from 0 for the first")


class OrientationInfo(Frozen):
    """How the side out of the material was found, and whether that is more than a guess."""

    method: str
    confident: bool


class SewingInfo(Frozen):
    """Faces that stand in no solid, joined where their edges coincide to find out which side is material."""

    tolerance_mm: float | None = Field(description="the smallest tried that left the least open; null: nothing to join")
    tried_mm: float | None = Field(description="the largest tried")
    open_edges: int = Field(description="edges that still belong to one face alone")
    open_length_mm: float


class UnitEntry(Frozen):
    """A statement of the file about its length unit or scale that is in doubt."""

    cause: Literal["disagree", "scale", "not_sure"] = Field(
        description="disagree: two units, the flag's is taken; scale: lengths are divided by the model space scale; not_sure: "
        "nothing that is known, or a part of it is not"
    )
    stated: str = Field(description="what it says")
    taken: str = Field(description="unit")
    unit: str = Field(description="that chooses the other reading, as --unit takes it; empty: none does")
    times: float = Field(description="a length by the other reading, as a multiple of what was taken")


class PartInfo(Frozen):
    file: str | None
    sha256: str | None
    size_mm: Vector
    solids: int
    faces: int
    orientation: OrientationInfo
    sewing: SewingInfo | None = Field(default=None, description="null where every face belongs to a solid")
    warnings: list[str]
    loose_faces: list[str] = Field(
        default=[], description="in no closed body, where there are solids: rather construction sheets and reference planes"
    )
    guessed_faces: list[str] = Field(
        default=[],
        description="in no closed body, or of a solid that encloses nothing, so that which side of them is material is a guess; "
        "empty where it is sure",
    )
    sheets_doubt: str = Field(
        default="", description="the warning on those of them that lie on faces of solids; empty: none does"
    )
    void_faces: list[str] = Field(
        default=[], description="in a closed void of a body, as far as they were judged: no cutter gets in, whatever it is"
    )
    unit_doubt: str = Field(default="", description="the warning that makes the length unit doubtful; empty where there is none")
    unit_readings: list[UnitEntry] = Field(default=[], description="what is doubtful of what the file says about its unit")


class Scope(Frozen):
    """Faces that were judged, and those that were not: these are obstacles, unless they are ignored."""

    judged: int = Field(description="target faces")
    judged_mm2: float = Field(description="their area, as far as it is known")
    not_judged: int = Field(description="faces that are obstacles only")
    not_judged_mm2: float = Field(description="their area, as far as it is known")
    judged_by_kind: dict[str, int] = Field(description="as `faces[].kind`")
    not_judged_by_kind: dict[str, int]


class PlacementEntry(Frozen):
    """How the part stands in a setup, where more than the axis was given."""

    file: str | None
    x: Vector | None = Field(description="direction of the part along the machine's X; null: as near to the part's X as can be")
    origin_mm: Vector | None = Field(description="point of the part at the machine's zero; null: not known")
    clamped: list[str] = Field(description="faces that are held, in the words for faces: left for another setup")


class AxisTravel(Frozen):
    """The postures found need this travel of a linear axis."""

    name: str
    limits_mm: tuple[float | None, float | None] = Field(description="null: no limit on that side")
    least_mm: float | None = Field(description="least position needed; null where no sample is reached")
    most_mm: float | None
    outside: int = Field(description="reached samples at which it is beyond its limits")


class BeyondTravel(Frozen):
    """The sample at which an axis is farthest beyond its limits."""

    point: Vector
    face: str
    axis: str
    beyond_mm: float


class TravelEntry(Frozen):
    """Linear travel at the postures found, of the holder's nose: a second check that changes no verdict."""

    judged: int = Field(description="reached samples at which the positions were found")
    unknown: int = Field(description="reached samples at which they were not: there linear axes are in one plane")
    outside: int = Field(description="reached samples at which an axis is beyond its limits")
    axes: list[AxisTravel]
    worst: list[BeyondTravel] = Field(description="one for each axis that is ever beyond its limits, the farthest first")


class SetupEntry(Frozen):
    """How much of the target surface some cutter could touch within the axis limits, were this the setup axis."""

    axis: Vector
    within: int = Field(description="samples")
    share: float = Field(description="of the judged samples' area, 0 to 1")
    reached: int | None = Field(
        default=None, description="samples that some cutter reaches in it; null where it was not requested"
    )
    reached_share: float | None = Field(default=None, description="of the judged samples' area, 0 to 1")


class HiddenFaces(Frozen):
    """Of these faces another proposed setup machines what this one hides."""

    setup: int = Field(description="that setup, counted from 0 for the first")
    faces: list[str]


class ProposedSetup(Frozen):
    """A setup that was proposed, with a table, a vise or a chuck as all that holds the part."""

    axis: Vector
    x: Vector | None = Field(default=None, description="direction of the part along the machine's X, where a chuck needs it")
    stands_on: list[str] = Field(
        description="planar faces that lie on the table, or on the ledges of the jaws: no targets in this setup"
    )
    clamping: Literal["table", "vise", "chuck"] = "table"
    grips: list[str] = Field(default=[], description="faces that the jaws touch")
    fixtures: list[str] = Field(default=["table"], description="what holds the part, as --fixture takes it")
    hidden_mm2: float = Field(default=0.0, description="area of the faces to machine that the jaws touch: for another setup")
    how_held: str = Field(default="", description="what the vise or chuck is and what it grips; empty for a table")
    soft: str = Field(default="", description="why soft jaws or a nest are needed; empty: the part is held as it is")
    why_held: str = Field(default="", description="why it is held so; empty where nothing else was tried")
    left_for: list[HiddenFaces] = Field(default=[], description="which other setups machine what it stands on and grips")
    promised: float = Field(description="share of the compared samples' area that it serves by itself, 0 to 1")
    holes: int = Field(
        default=0,
        exclude_if=lambda holes: not holes,
        description="that drills make from here and from no setup before it, where it is for these alone; else not written",
    )


class SetupProposal(Frozen):
    """Which setups were proposed, what was promised of them, and what their plan found."""

    setups: list[ProposedSetup] = Field(description="those of the plan, in its order")
    directions: int = Field(description="directions of the part that were compared by the limits of the machine")
    searched: int = Field(description="those of them that were searched for postures over a table, or in a vise or chuck")
    samples: int = Field(description="at which they were compared")
    promised: float = Field(description="share of these samples' area that the setups serve together, 0 to 1")
    found: float = Field(description="share of all target area that the plan reaches, faces that are stood on included")
    kept: float = Field(description="of what was promised, the share of area that the plan reaches, 0 to 1")
    held: bool = Field(description="the plan holds what was promised, to 1 %")
    tried: int = Field(description="which proposal this is: those before it did not hold")
    why: str


class SetupReach(VerdictCounts):
    """The verdicts of a cutter in one setup are counted in samples."""

    axis: Vector
    serves: int = Field(default=0, description="samples whose posture is that of this setup: the first one that reaches them")
