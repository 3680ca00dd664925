"""What would make a cutter finish a part: one thing changed, by how much, and what of that is known."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any, Literal

from plan_cutters.domain.cutter import Cutter

#: What may be changed, from what asks a planner for least to what asks for most: time to compute, how far the tool is tilted, how
#: it is held, how the part is clamped, another tool, another machine, something left undone.
Thing = Literal["tolerance", "tilt_range", "stick_out", "setup", "corner_radius", "radius", "tilt_limit", "faces"]
THINGS: tuple[Thing, ...] = (
    "tolerance", "tilt_range", "stick_out", "setup", "corner_radius", "radius", "tilt_limit", "faces"
)  # fmt: skip

#: Lengths in mm, angles in degrees, a range of them, a direction, or the ids of faces.
Value = float | tuple[float, ...] | tuple[str, ...] | None


@dataclass(frozen=True, slots=True)
class Change:
    """One thing changed, all else as it is.

    Attributes
    ----------
    thing : str
        One of THINGS.
    now : float or tuple, optional
        Its value now: mm, deg, a range of deg, or a unit vector; of faces, the ids of those with samples that are lost.
    asked : float or tuple, optional
        The change that asks least of those with which the cutter finishes; of faces, the ids of those to leave out. None
        where there is none.
    helps : bool, optional
        True: every target sample was judged with it, and each has a posture. False: no value that was tried does that. None: it
        could not be decided, as samples stay undecided or obstacles are missing.
    left, looked : int
        Samples still inaccessible or undecided with the best value that was tried, of those looked at: of the samples that are
        lost now all or, where these are thousands and there is no help, some of them, spread evenly.
    verified : int
        Target samples that were judged with `asked`.
    beyond : float or tuple, optional
        The value that asks a step less, which was tried and does not serve; None where there is none.
    cutter : Cutter, optional
        The cutter with it, where that is another one.
    why : str
        One sentence for a planner.
    options : mapping
        The options of a plan, by name, that differ with it; none where nothing is asked.
    """

    thing: Thing
    now: Value
    asked: Value
    helps: bool | None
    left: int
    looked: int
    verified: int
    beyond: Value
    cutter: Cutter | None
    why: str
    options: Mapping[str, Any] = field(default_factory=lambda: MappingProxyType({}))


@dataclass(frozen=True, slots=True)
class Mend:
    """What would make one cutter finish a part.

    Attributes
    ----------
    cutter : str
        Its id.
    lost, buried : int
        Samples that are inaccessible or undecided now, and those of them that lie within a body.
    changes : tuple of Change
        Those that help first, then those that could not be decided, then those that do not; within each in the order of THINGS.
    why : str
        What is to be said before all of them; empty where that is nothing.
    """

    cutter: str
    lost: int
    buried: int
    changes: tuple[Change, ...]
    why: str

    @property
    def least(self) -> Change | None:
        """The change that helps and asks least; None if none does."""
        return next((each for each in self.changes if each.helps), None)
