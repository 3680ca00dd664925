"""A part that is ready to be judged, cutter by cutter."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from cad_io import SurfaceSamples
from cad_io.arrays import Ints, Record
from plan_cutters.domain.cutter import Cutter
from plan_cutters.options import Options
from plan_cutters.scene.conditions import Conditions
from plan_cutters.scene.faces import Chosen
from plan_cutters.scene.scene import Scene
from plan_cutters.scene.spacing import Spacing

#: A unit direction of the part.
Axis = tuple[float, float, float]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Prepared(Record):
    """Everything that is needed to judge a cutter.

    Attributes
    ----------
    scene : Scene
    options : Options
    chosen : Chosen
        Target and ignored faces.
    spacing : float, dict or None
        Of the samples: one, by face number, or none where they were taken on a grid.
    samples : SurfaceSamples
    surface_class : (n,) uint8
    region : (n,) int32
        Connected samples of one class.
    inside : (n,) int32
        The body that each sample lies within, -1 for none.
    inside_bodies : (n,) bool
        Samples that lie inside another body of the part (`inside_material.inside_bodies`).
    conditions : Conditions
    cutters : tuple of Cutter
        From the most wanted down.
    coarser : float
        How many times as far apart as curvature and cutters ask the samples are, for the budget of a default plan.
    """

    scene: Scene
    options: Options
    chosen: Chosen
    spacing: Spacing
    samples: SurfaceSamples
    surface_class: NDArray[np.uint8]
    region: Ints
    inside: Ints
    inside_bodies: NDArray[np.bool_]
    conditions: Conditions
    cutters: tuple[Cutter, ...]
    coarser: float = 1.0

    @property
    def axes(self) -> tuple[tuple[Axis, Axis | None], ...]:
        """Give the setup axis and, where it is known, the direction along the machine's X, of each requested setup."""
        options, given = self.options, (self.scene.setup, *self.options.other_setups)
        places = (options.placement, *(options.other_placements or (None,) * len(options.other_setups)))
        return tuple((axis, None if place is None else place.x) for axis, place in zip(given, places, strict=True))

    @property
    def setups(self) -> tuple[Conditions, ...]:
        """Give the conditions for judging cutters in each requested setup, the first one first."""
        others = (
            replace(self.conditions, setup=np.array(axis), x=None if x is None else np.array(x))
            for axis, x in self.axes[1:]
        )
        return (self.conditions, *others)

    @property
    def finished(self) -> NDArray[np.bool_]:
        """Judged samples (n,) of the finished part's surface: shares, selection, reasons and answers are about these."""
        return (self.samples.unjudged < 0) & ~self.inside_bodies
