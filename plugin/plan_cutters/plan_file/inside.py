"""Entries that say how much of the target faces lies inside other bodies of the part."""

from typing import Literal

from pydantic import Field

from plan_cutters.plan_file.frozen import Frozen


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
