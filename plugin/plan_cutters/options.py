"""What is asked for: every option of a plan, with its default."""

import math
import os
from dataclasses import dataclass, field
from typing import Any

from cad_io.units import UNITS
from plan_cutters.domain.checks import choice, flag, number, shown, whole
from plan_cutters.domain.cutter import Cutter, builtin
from plan_cutters.domain.machine import Machine
from plan_cutters.domain.posture import PostureRange, unit
from plan_cutters.errors import OptionError


@dataclass(frozen=True, slots=True)
class Options:
    """Options of a plan. Lengths mm, angles rad.

    Attributes
    ----------
    cutters : tuple of Cutter
        May be given as one cutter or a list, and texts such as `R6L80` for cutters. Empty: the built-in ones.
    machine : Machine
        May be given as a text such as `tilt:60`.
    setup : tuple of float
        Direction of the part along the machine's spindle at zero angles; kept with length 1.
    faces : str or objects, optional
        Target faces, as `faces.select_faces` reads it, or as numbers, or as objects of the kernel or a CAD host. Default:
        the faces picked on the object that the part was made from; where none were, `sculptured`.
    ignore : str, list of str or objects
        Faces that are neither targets nor obstacles, in the same words.
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
    faces: Any = None
    ignore: Any = ()
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
        self._check_kinds()
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
        for cutter in self.judged:
            if not cutter.large_enough(self.tolerance):
                raise OptionError(f"tolerance {self.tolerance:g} mm is too coarse for cutter {cutter.id}")

    def _check_kinds(self) -> None:
        """Every value of the type that its attribute says."""

        def take(**values: Any) -> None:
            for word, value in values.items():
                object.__setattr__(self, word, value)

        take(cutters=Cutter.each_of(self.cutters), machine=Machine.of(self.machine))
        take(setup=tuple(unit(self.setup, "setup axis").tolist()), tolerance=number(self.tolerance, "tolerance"))
        take(jobs=whole(self.jobs, "jobs"), area_budget=whole(self.area_budget, "area budget"))
        take(flip=flag(self.flip, "flip"), posture_maps=flag(self.posture_maps, "posture_maps"))
        choice(self.faces, "faces")
        choice(self.ignore, "ignore")
        if self.grid is not None:
            take(grid=whole(self.grid, "grid"))
        if self.spacing is not None:
            take(spacing=number(self.spacing, "spacing"))
        if self.unit is not None and not isinstance(self.unit, str):
            raise OptionError(f"unit must be one of {', '.join(UNITS)}, not {shown(self.unit)}")
        if not isinstance(self.postures, PostureRange):
            raise OptionError(f"postures must be a PostureRange, not {shown(self.postures)}")

    @property
    def judged(self) -> tuple[Cutter, ...]:
        """The cutters to judge, each id once."""
        return tuple({c.id: c for c in self.cutters or builtin()}.values())
