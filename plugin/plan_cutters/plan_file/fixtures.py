"""A fixture as the plan file states it."""

from pydantic import Field

from plan_cutters.plan_file.frozen import Frozen


class ReferenceEntry(Frozen):
    """A file that a CAD file refers to."""

    file: str = Field(
        description="path from the folder of the file that refers to it, or of the one that refers to that"
    )
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
    setups: list[int] = Field(default=[0], description="setups in which it stands, counted from 0 for the first")
