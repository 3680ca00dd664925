"""Vises and chucks as CAD bodies."""

from typing import Any

from cad_io.kernel.bodies import Side, prism, revolved
from cad_io.kernel.components import compound
from plan_cutters.domain.clamping import Block, Clamping, Solid


def clamping_shape(clamping: Clamping, chord: float) -> Any:
    """The bodies of a vise or chuck in its own frame, a solid each; of the table below them, what is drawn.

    Parameters
    ----------
    clamping : Vise or Chuck
        In its place: how far its jaws stand apart is known.
    chord : float
        How far the bore of a jaw may be from its planes, mm.
    """
    return compound([_solid(each) for each in clamping.solids(chord, shown=True)])


def _solid(solid: Solid) -> Any:
    if isinstance(solid, Block):
        return prism((*solid.inner, *reversed(solid.outer)), solid.low, solid.high)
    radius, low, high = solid.radius, solid.low, solid.high
    return revolved((0.0, low), [Side((radius, low)), Side((radius, high)), Side((0.0, high)), Side((0.0, low))])
