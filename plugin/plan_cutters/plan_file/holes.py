"""Holes in the plan file: those that are for drills."""

from typing import Literal

from pydantic import Field

from plan_cutters.domain.drill import Kind, Why
from plan_cutters.plan_file.frozen import Frozen, Vector


def _none(entry: object) -> bool:
    return entry is None


def _empty(entry: list[str]) -> bool:
    return not entry


class WorkplaneEntry(Frozen):
    """The tilted plane that a control turns to: z is the tool axis, x the machine's X turned with it. Part coordinates."""

    origin: Vector = Field(description="mm: the setup's origin, or the part's zero where the setup names none")
    x: Vector
    z: Vector


class CountersinkEntry(Frozen):
    """The widest cone at a mouth of a hole."""

    diameter_mm: float = Field(description="its largest")
    angle_deg: float = Field(description="the whole angle")


class CounterboreEntry(Frozen):
    """The widest cylinder at a mouth of a hole."""

    diameter_mm: float
    depth_mm: float = Field(description="from that mouth")


class ThreadEntry(Frozen):
    """A thread that the part's file states of a hole; none is guessed."""

    name: str = Field(description="as M4, M8x1 or 1/4-20 UNC")
    diameter_mm: float = Field(description="its largest")
    pitch_mm: float
    fit: str = Field(description="its tolerance class, as 6H or 2B; empty where none is stated")
    left: bool = Field(description="it turns to the left")


class ToleranceEntry(Frozen):
    """The diameter of a hole lies within this, as the part's file states it."""

    nominal_mm: float
    lower_mm: float | None = Field(description="deviation; null where the file states the class alone")
    upper_mm: float | None
    fit: str = Field(description="tolerance class, as H7; empty where none is stated")


class MissingEntry(Frozen):
    """No tool of the libraries makes this of a hole."""

    thing: Literal["hole", "countersink", "counterbore", "thread", "reamer"] = Field(
        description="hole: its narrowest cylinder, with its bottom; reamer: a drill makes it, but does not hold its tolerance"
    )
    diameter_mm: float
    depth_mm: float | None = Field(description="null but of a hole and a counterbore")
    angle_deg: float | None = Field(description="the whole angle of a countersink, else null")
    why: Why = Field(
        description="empty: no tool has its size; of those that have it: axis: no setup has it; short: flutes are too short; "
        "in_the_way: they do not stand free; bottom: no mill reaches its bottom, which is no cone"
    )
    name: str = Field(default="", exclude_if=lambda name: not name, description="of a thread, as M4; of a tolerance its class")


class HoleEntry(Frozen):
    """A hole for drills: a cylinder with more than half a turn of material around it, and what lies about its axis."""

    faces: list[str] = Field(
        description="its faces that no mill has to reach: narrower than `effective.drill_below_mm`, without a bottom that is no "
        "cone, and without a counterbore that is milled"
    )
    diameter_mm: float = Field(description="of its narrowest cylinder")
    depth_mm: float = Field(description="from the mouth to the lower end of that cylinder, without the point of a drill")
    through: bool
    bottom: Literal["flat", "cone", "open", "round"] = Field(description="open where it is through; round: a sphere or torus")
    floor: list[str] = Field(default=[], exclude_if=_empty, description="faces of a bottom that a mill has to reach")
    cone_deg: float | None = Field(description="the whole angle of a bottom that is a cone, else null")
    countersink: CountersinkEntry | None
    counterbore: CounterboreEntry | None
    axis: Vector = Field(description="unit direction out of the mouth")
    place_mm: Vector = Field(description="point of the axis at the mouth")
    group: int = Field(description="from 1: holes of one group are equal but for their place")
    drilled: bool = Field(
        description="tools of the libraries make its narrowest cylinder (`process.drilling`), and its bottom, or a mill does"
    )
    tool: str | None = Field(description="the tool that makes that cylinder last; null where none does")
    missing: list[MissingEntry] = Field(default=[], description="what of it no tool of the libraries makes")
    thread: ThreadEntry | None = Field(default=None, exclude_if=_none, description="where the part's file states one")
    tolerance: ToleranceEntry | None = Field(default=None, exclude_if=_none, description="where the part's file states one")


class StrokeEntry(Frozen):
    """A tool goes down in a hole."""

    hole: int = Field(description="its place in `holes`, from 0")
    mouth_mm: Vector = Field(description="where it enters: the middle of the mouth of the hole, countersink or counterbore")
    tip_mm: Vector = Field(
        description="where its tip stands at the deepest; a point of an angle that is not stated is one of 90 deg"
    )
    slope_deg: float | None = Field(
        default=None, exclude_if=_none, description="of the mouth, where it is too steep for a drill to begin"
    )


class DrillingStep(Frozen):
    """A step of a process that does the same in equal holes, with one tool for holes in one orientation of a setup."""

    kind: Kind = Field(description="of the tool")
    tool: str = Field(description="id")
    name: str = Field(description="of that tool in its library; empty where it has none")
    holes: list[StrokeEntry]
    setup: int = Field(description="0 is the first")
    axis: Vector = Field(description="unit tool axis")
    angles_deg: dict[str, float] | None = Field(description="of the rotary axes; null where the machine has none that are known")
    frame: WorkplaneEntry | None = Field(default=None, exclude_if=_none, description="where `angles_deg` are known")
    g68_2: str | None = Field(default=None, exclude_if=_none, description="as of an operation: the tilted plane")
    g53_1: str | None = Field(default=None, exclude_if=_none, description="as of an operation: the turn onto it")
    rotary_words: str | None = Field(default=None, exclude_if=_none, description="as of an operation: in place of both")
    diameter_mm: float = Field(description="that it leaves")
    depth_mm: float = Field(
        description="of its full width under each mouth, with what the point goes further through a hole; of a countersink or "
        "centre drill that of the tip"
    )
    thread: str = Field(default="", exclude_if=lambda name: not name, description="that a tap cuts, as M4")
    pitch_mm: float | None = Field(default=None, exclude_if=_none, description="of a tap")
    feed_mm_min: float | None = Field(default=None, exclude_if=_none, description="of its file, else that was given")
    seconds: float | None = Field(
        description="for all holes 1.3 times the depth at the feed, twice that of a tap; null where no feed is known"
    )
    link_seconds: float = Field(description="from hole to hole: a link for each")
    index_seconds: float = Field(description="of the turn to its orientation, once for the tool; 0 without operations")
