"""The verdicts of each cutter over all setups."""

from collections.abc import Mapping
from dataclasses import dataclass

from cad_io.arrays import Ints
from plan_cutters.domain.verdicts import Verdicts
from plan_cutters.plan_file.frozen import Vector

#: A setup axis, and what each cutter reaches there by its id.
OtherSetup = tuple[Vector, Mapping[str, Verdicts]]


@dataclass(frozen=True, slots=True)
class OverSetups:
    """The verdicts of each cutter over all setups and in each of them, by its id."""

    #: In one setup or another.
    reaches: dict[str, Verdicts]
    #: In the first one.
    here: dict[str, Verdicts]
    #: The setup that serves each sample, (n,) int32.
    served_in: dict[str, Ints]
    #: (float, float, float); its axis.
    first: Vector
    #: In each other setup.
    elsewhere: tuple[tuple[Vector, dict[str, Verdicts]], ...] = ()

    def each(self) -> tuple[OtherSetup, ...]:
        """Every setup with what is reached there, the first one first."""
        return ((self.first, self.here), *self.elsewhere)
