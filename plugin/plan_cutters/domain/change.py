"""What-if answers name the change that would make a cutter finish a part: the thing, the amount, and how far that is known."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from plan_cutters.domain.area import Patch
from plan_cutters.domain.cutter import Cutter

#: What may be changed, from what asks a planner for least to what asks for most: time to compute, how far the tool is tilted, how
#: it is held, how the part is clamped, another tool, another machine, something left undone.
Thing = Literal["tolerance", "tilt_range", "stick_out", "setup", "corner_radius", "radius", "tilt_limit", "faces"]
THINGS: tuple[Thing, ...] = ("tolerance", "tilt_range", "stick_out", "setup", "corner_radius", "radius", "tilt_limit", "faces")

#: How the cause begins of a change that could not be decided.
UNDECIDED = "is not decided: "
#: How the cause goes on where the holder would have to stand farther from the tip than any cutter is held.
NO_USUAL = "no usual stick-out does"

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
        Its value now: mm, deg, a range of deg, or a unit vector; of faces, the ids of those with samples that are not reached.
    asked : float or tuple, optional
        The change that asks least of those with which the cutter finishes; of faces, the ids of those to leave out. None
        where there is none.
    helps : bool, optional
        True: every sample of the finished surface was judged with it, and each has a posture. False: no value that was
        tried does that. None: it could not be decided, as samples stay undecided or obstacles are missing.
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
    before, after : float, optional
        Share of the finished area that is not reached now, and with `asked`; `after` is None where nothing is asked or known.
    option : str, optional
        What to say on the command line; None where nothing is asked, or where no option says it.
    doubted : bool
        It would help, but a face that is missing from the obstacles may be in the way.
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
    options: Mapping[str, Any] = field(default_factory=dict)
    before: float | None = None
    after: float | None = None
    option: str | None = None
    doubted: bool = False


#: What a step may change: any of THINGS, a slimmer holder, a second setup beside the present one, another cutter for the
#: rest, or an area that is left to other means. What asks a planner for least comes first among steps that leave as much.
Means = Literal[
    "tolerance", "tilt_range", "stick_out", "cutter", "corner_radius", "radius", "holder", "setup", "second_setup",
    "tilt_limit", "area"
]  # fmt: skip
MEANS: tuple[Means, ...] = (
    "tolerance", "tilt_range", "stick_out", "cutter", "corner_radius", "radius", "holder", "setup", "second_setup",
    "tilt_limit", "area"
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class Move:
    """One change of a step: of what, from which value to which (mm, deg, a direction, the id of a cutter), and in words."""

    means: Means
    now: float | tuple[float, ...] | str | None
    asked: float | tuple[float, ...] | str | None
    words: str


@dataclass(frozen=True, slots=True)
class Step:
    """A step is a thing to do next; its gain was judged on every sample.

    Attributes
    ----------
    moves : tuple of Move
        One change, or two.
    before, after : float
        Share of the finished area, 0 to 1, that is not reached now, and that is still not reached: every sample was judged.
    gained, left : int
        Samples that it frees, and that are still not reached.
    cutters : tuple of Cutter
        That do it together, the one that is mended, or what becomes of it, first.
    setups : tuple of (float, float, float)
        Setup axes in which they do.
    option : str, optional
        The options for the command line: `--cutter` is added to those of now, each other option replaces the same option. None
        where no option says it.
    remains : tuple of Patch
        The largest areas that are still not reached.
    freed : (m,) int64
        The samples that it frees.
    """

    moves: tuple[Move, ...]
    before: float
    after: float
    gained: int
    left: int
    cutters: tuple[Cutter, ...]
    setups: tuple[tuple[float, float, float], ...]
    option: str | None
    remains: tuple[Patch, ...]
    freed: NDArray[np.int64] = field(default_factory=lambda: np.zeros(0, np.int64), compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class WhatIfAnswer:
    """A what-if answer: the changes that would make one cutter finish a part, and the next steps.

    Attributes
    ----------
    cutter : str
        Its id.
    lost, buried : int
        Samples that are inaccessible or undecided now, and those of them that lie within another body of the part: these are no
        surface of the finished part, and nothing is asked about them.
    changes : tuple of Change
        Those that help first, then those that could not be decided, then those that do not; within each in the order of THINGS.
    why : str
        A remark that comes before all of them; may be empty.
    share : float
        Of the finished area that is not reached now, in all setups of the plan.
    steps : tuple of Step
        The next steps: first the one that leaves least, last an area to leave out. Empty where they were not looked for.
    areas : tuple of Patch
        Connected areas that are not reached now, the largest first, and how many more there are.
    unsure : bool
        Faces are missing from what is in the way, so that no gain is sure.
    """

    cutter: str
    lost: int
    buried: int
    changes: tuple[Change, ...]
    why: str
    share: float = 0.0
    steps: tuple[Step, ...] = ()
    areas: tuple[Patch, ...] = ()
    more_areas: int = 0
    unsure: bool = False

    @property
    def least(self) -> Change | None:
        """The change that helps and asks least; None if none does."""
        return next((each for each in self.changes if each.helps), None)
