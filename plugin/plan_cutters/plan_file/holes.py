"""Holes in the plan file: those that are for drills."""

from typing import Literal

from pydantic import Field

from plan_cutters.plan_file.frozen import Frozen, Vector


class CountersinkEntry(Frozen):
    """The widest cone at a mouth of a hole."""

    diameter_mm: float = Field(description="its largest")
    angle_deg: float = Field(description="the whole angle")


class CounterboreEntry(Frozen):
    """The widest cylinder at a mouth of a hole."""

    diameter_mm: float
    depth_mm: float = Field(description="from that mouth")


class HoleEntry(Frozen):
    """A hole for drills: a cylinder with more than half a turn of material around it, and what lies about its axis."""

    faces: list[str] = Field(description="its faces that are narrower than `effective.drill_below_mm`: no mill is asked for them")
    diameter_mm: float = Field(description="of its narrowest cylinder")
    depth_mm: float = Field(description="from the mouth to the lower end of that cylinder, without the point of a drill")
    through: bool
    bottom: Literal["flat", "cone", "open", "round"] = Field(description="open where it is through; round: a sphere or torus")
    cone_deg: float | None = Field(description="the whole angle of a bottom that is a cone, else null")
    countersink: CountersinkEntry | None
    counterbore: CounterboreEntry | None
    axis: Vector = Field(description="unit direction out of the mouth")
    place_mm: Vector = Field(description="point of the axis at the mouth")
    group: int = Field(description="from 1: holes of one group are equal but for their place")
    drilled: bool = Field(description="a tool of the libraries makes it")
    tool: str | None = Field(description="that tool; null where none does")
