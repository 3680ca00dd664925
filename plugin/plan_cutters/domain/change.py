"""The next steps for a cutter that does not finish a part: what each changes, by how much, and what it gains."""

from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from plan_cutters.domain.area import Patch
from plan_cutters.domain.cutter import Cutter

#: What a step may change, from what asks a planner for least to what asks for most: time to compute, how far the tool is tilted,
#: how it is held, another tool, how the part is clamped, another machine, an area that is left to other means. What asks for
#: least comes first among steps that leave as much.
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
class Advice:
    """Advice names what to do next with one cutter.

    Attributes
    ----------
    cutter : str
        Its id.
    lost, buried : int
        Samples that are inaccessible or undecided now, and those of them that lie within another body of the part: these are no
        surface of the finished part, and nothing is asked about them.
    why : str
        Why no steps were looked for; empty where they were.
    share : float
        Of the finished area that is not reached now, in all setups of the plan.
    steps : tuple of Step
        The next steps: first the one that leaves least, last an area to leave out. Empty where they were not looked for.
    areas : tuple of Patch
        Connected areas that are not reached now, the largest first, and how many more there are.
    uncompared : int
        Changes that promised less than those judged and were not judged, and kinds of changes that were not looked at, since the
        work for advice was spent.
    unsure : bool
        Faces are missing from what is in the way, so that no gain is sure.
    """

    cutter: str
    lost: int
    buried: int
    why: str
    share: float = 0.0
    steps: tuple[Step, ...] = ()
    areas: tuple[Patch, ...] = ()
    more_areas: int = 0
    uncompared: int = 0
    unsure: bool = False
