"""The part as the plan names it: its file, its faces in and out of scope, what is odd about it, and what stands beside it."""

from typing import Literal

from pydantic import Field

from plan_cutters.plan_file.frozen import Frozen, Vector


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
