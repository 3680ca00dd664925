"""A part that is ready to be judged, cutter by cutter."""

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io import SurfaceSamples
from cad_io.arrays import Ints, Record
from cad_io.part.patterns import Pattern
from plan_cutters.domain.cutter import Cutter
from plan_cutters.options import Options
from plan_cutters.scene.conditions import Conditions
from plan_cutters.scene.copies import Copies
from plan_cutters.scene.faces import Chosen
from plan_cutters.scene.scene import Scene
from plan_cutters.scene.spacing import Spacing
from plan_cutters_base.stage_cache import NO_CACHE, Cache

#: A unit direction of the part.
Axis = tuple[float, float, float]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class OtherSetup(Record):
    """Another setup than the first has its own conditions, and its own samples that no cutter gets to.

    Attributes
    ----------
    conditions : Conditions
        With the obstacles of that setup.
    inside : (n,) int32
        The body that each sample lies within there, -1 for none.
    clamped : (n,) bool
        Samples of faces that are held there.
    """

    conditions: Conditions
    inside: Ints
    clamped: NDArray[np.bool_]


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
        The body that each sample lies within in the first setup, -1 for none.
    inside_bodies : (n,) bool
        Samples that lie inside another body of the part (`inside_material.inside_bodies`).
    conditions : Conditions
    cutters : tuple of Cutter
        From the most wanted down.
    coarser : float
        How many times as far apart as curvature and cutters ask the samples are, for the budget of a default plan.
    held : (n,) bool, optional
        Samples of faces that are clamped in the first setup; None: none of them is.
    others : tuple of OtherSetup
        The setups beside the first.
    exempt : (n,) bool, optional
        Samples at sharp inside edges that no cutter has to reach (`judging.sharp_edges.exempt`); None: all are required.
    patterns : tuple of Pattern
        Equal faces of the part, and motions that carry it onto itself.
    copies : Copies, optional
        Samples that these motions carry onto others; None where there are few, or patterns are not to be used.
    cache : Cache
        What stages make of this part is kept there.
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
    held: NDArray[np.bool_] | None = None
    others: tuple[OtherSetup, ...] = ()
    exempt: NDArray[np.bool_] | None = None
    patterns: tuple[Pattern, ...] = ()
    copies: Copies | None = None
    cache: Cache = field(default=NO_CACHE, compare=False)

    @property
    def axes(self) -> tuple[tuple[Axis, Axis | None], ...]:
        """Give the setup axis and, where it is known, the direction along the machine's X, of each requested setup."""
        options, axes = self.options, (self.scene.setup, *self.options.other_setups)
        places = (options.placement, *(options.other_placements or (None,) * len(options.other_setups)))
        return tuple((axis, None if place is None else place.x) for axis, place in zip(axes, places, strict=True))

    @property
    def setups(self) -> tuple[Conditions, ...]:
        """Give the conditions for judging cutters in each requested setup, the first one first."""
        return (self.conditions, *(each.conditions for each in self.others))

    def there(self, setup: int) -> "Prepared":
        """The same as the first setup sees it, for a setup counted from 0: its conditions, and what is held there."""
        if setup == 0:
            return self
        other = self.others[setup - 1]
        copies = None if self.copies is None else self.copies.there(setup)
        return replace(self, conditions=other.conditions, inside=other.inside, held=other.clamped, copies=copies)

    def alone(self, setup: int) -> "Prepared":
        """One setup, counted from 0, as if there were no other one."""
        return replace(self.there(setup), others=())

    def under(self, **changes: Any) -> "Prepared":
        """The same with other values of the conditions, by their names, in every setup."""
        others = tuple(replace(each, conditions=replace(each.conditions, **changes)) for each in self.others)
        return replace(self, conditions=replace(self.conditions, **changes), others=others)

    @property
    def clamped(self) -> NDArray[np.bool_]:
        """Samples (n,) of faces that are held in this setup: no cutter gets there."""
        return np.zeros(len(self.samples), bool) if self.held is None else self.held

    @property
    def shut(self) -> Ints:
        """The body that each sample (n,) lies within, -1 for none; of a clamped face, one more than there are."""
        if self.held is None or not self.held.any():
            return self.inside
        return np.where(self.held & (self.inside < 0), len(self.conditions.surroundings.enclosing), self.inside).astype(np.int32)

    @property
    def machinable(self) -> tuple[NDArray[np.bool_], ...]:
        """Of each setup the finished samples (n,) that are neither clamped nor inside material there."""
        each = [self.there(k) for k in range(1 + len(self.others))]
        return tuple(self.finished & (one.inside < 0) & ~one.clamped for one in each)

    @property
    def somewhere(self) -> NDArray[np.bool_]:
        """Finished samples (n,) that can be machined in one setup or another, as far as fixtures and clamped faces go."""
        return np.asarray(np.logical_or.reduce(self.machinable))

    @property
    def alike(self) -> bool:
        """Whether the part stands among the same obstacles in all setups, held at the same faces."""
        return not self.clamped.any() and not any(
            each.conditions.surroundings is not self.conditions.surroundings or each.clamped.any() for each in self.others
        )

    @property
    def finished(self) -> NDArray[np.bool_]:
        """Judged samples (n,) that a cutter has to reach: shares, selection, reasons and answers are about these."""
        return (self.samples.unjudged < 0) & ~self.not_required

    @property
    def not_required(self) -> NDArray[np.bool_]:
        """Samples (n,) that no cutter has to reach: inside other bodies of the part, or exempt."""
        return self.inside_bodies if self.exempt is None else self.inside_bodies | self.exempt
