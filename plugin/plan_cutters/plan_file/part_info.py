"""Entries on the part itself: its file, its bodies, and what is told of the form of its faces."""

from typing import Literal

from pydantic import Field

from plan_cutters.plan_file.frozen import Frozen, Vector


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


class ReferenceEntry(Frozen):
    """A file that a CAD file refers to."""

    file: str = Field(description="path from the folder of the file that refers to it, or of the one that refers to that")
    sha256: str | None = Field(description="null: it is not there")


class FixtureEntry(Frozen):
    """A body that is in the way and no part of what is machined."""

    name: str = Field(description="as `obstacle_face` has it: fixture:NAME")
    file: str | None = Field(description="null for words and objects")
    sha256: str | None
    references: list[ReferenceEntry] = Field(default=[], description="files that the file refers to")
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
    references: list[ReferenceEntry] = Field(default=[], description="files that the file refers to")
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
