"""What is asked for: every option of a plan, with its default."""

import math
import os
from dataclasses import dataclass, field

from cad_io.units import UNITS
from plan_cutters.cutter import Cutter, builtin
from plan_cutters.errors import OptionError
from plan_cutters.machine import Machine
from plan_cutters.posture import PostureRange, unit


@dataclass(frozen=True, slots=True)
class Options:
    """Options of a plan. Lengths mm, angles rad.

    Attributes
    ----------
    cutters : tuple of Cutter
        Empty: the built-in ones.
    machine : Machine
    setup : tuple of float
        Direction of the part along the machine's spindle at zero angles.
    faces : str
        Target faces, as `faces.select_faces` reads it.
    grid : int, optional
        N x N samples a face.
    spacing : float, optional
        Largest distance between samples. Neither: from curvature, smallest cutter and a budget.
    postures : PostureRange
    tolerance : float
        Gouge tolerance.
    jobs : int
        Threads.
    flip : bool
        Machine the other side of open shells and loose faces.
    area_budget : int
        Most contacts to look at between the samples for the selected cutter; 0: none.
    posture_maps : bool
        Find every free tilt of every sample, too, for the cutter that the models show.
    unit : str, optional
        Length unit to take instead of the part's own, one of `cad_io.units.UNITS`.

    Raises
    ------
    OptionError
        A value has no meaning.
    """

    cutters: tuple[Cutter, ...] = ()
    machine: Machine = field(default_factory=Machine)
    setup: tuple[float, float, float] = (0.0, 0.0, 1.0)
    faces: str = "sculptured"
    grid: int | None = None
    spacing: float | None = None
    postures: PostureRange = field(default_factory=PostureRange)
    tolerance: float = 0.01
    jobs: int = field(default_factory=lambda: len(os.sched_getaffinity(0)))
    flip: bool = False
    area_budget: int = 100_000
    posture_maps: bool = False
    unit: str | None = None

    def __post_init__(self) -> None:
        if self.grid is not None and self.spacing is not None:
            raise OptionError("give a grid or a spacing, not both")
        if self.grid is not None and not 2 <= self.grid <= 5000:
            raise OptionError(f"grid {self.grid} must lie between 2 and 5000 samples a side")
        if self.spacing is not None and not (math.isfinite(self.spacing) and self.spacing > 0):
            raise OptionError(f"spacing {self.spacing:g} must be a positive number of mm")
        if not 1e-4 <= self.tolerance <= 10:
            raise OptionError(f"tolerance {self.tolerance:g} must lie between 0.0001 and 10 mm")
        if self.unit is not None and self.unit not in UNITS:
            raise OptionError(f"unit {self.unit!r} is not one of {', '.join(UNITS)}")
        if self.area_budget < 0:
            raise OptionError(f"area budget {self.area_budget} must not be negative")
        if self.jobs < 1:
            raise OptionError(f"jobs {self.jobs} must be at least 1")
        unit(self.setup, "setup axis")
        for cutter in self.judged:
            if not cutter.large_enough(self.tolerance):
                raise OptionError(f"tolerance {self.tolerance:g} mm is too coarse for cutter {cutter.id}")

    @property
    def judged(self) -> tuple[Cutter, ...]:
        """The cutters to judge, each id once."""
        return tuple({c.id: c for c in self.cutters or builtin()}.values())
