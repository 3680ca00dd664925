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

    faces: list[str] = Field(description="its faces that are narrower than `effective.drill_below_mm`: no mill has to reach them")
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
    drilled: bool = Field(description="a tool of the libraries makes it (`drilling`)")
    tool: str | None = Field(description="that tool; null where none does")


class DrillingEntry(Frozen):
    """A step that drills equal holes with one tool in one orientation of a setup."""

    tool: str
    name: str = Field(description="of that tool in its library; empty where it has none")
    group: int = Field(description="of the holes")
    holes: int = Field(description="how many")
    setup: int = Field(description="0 is the first")
    axis: Vector = Field(description="unit tool axis")
    angles_deg: dict[str, float] | None = Field(description="of the rotary axes; null where the machine has none that are known")
    depth_mm: float = Field(description="of each hole, with what the point of the drill goes further through it")
    seconds: float | None = Field(
        description="for each hole 1.3 times the depth at the feed, and a link; null where no feed is known"
    )
