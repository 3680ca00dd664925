"""How patterns of equal faces stand in the plan file."""

from typing import Literal

from pydantic import Field

from plan_cutters.plan_file.frozen import Frozen, Vector


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
