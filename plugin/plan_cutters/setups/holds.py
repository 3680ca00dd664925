"""How a vise or chuck holds a part: where it stands, and what it grips."""

from dataclasses import dataclass

from plan_cutters.domain.fixture import Fixture
from plan_cutters.errors import FixtureError


class NothingToGripError(FixtureError):
    """A vise or chuck has nothing to grip in a setup; `why` is the cause alone."""

    why: str = ""


@dataclass(frozen=True, slots=True)
class Hold:
    """A vise or chuck that was placed for a setup.

    Attributes
    ----------
    fixture : Fixture
        In its place, with all its numbers.
    grips : tuple of int
        Numbers of the faces that its jaws touch.
    rests_on : tuple of int
        Numbers of the planar faces with which the part rests in it.
    hidden : float
        Area of the faces to machine that its jaws touch, mm2.
    words : str
        What it is and what it grips, for people.
    """

    fixture: Fixture
    grips: tuple[int, ...]
    rests_on: tuple[int, ...]
    hidden: float
    words: str

    @property
    def faces(self) -> tuple[int, ...]:
        """All faces that it holds, ascending."""
        return tuple(sorted({*self.grips, *self.rests_on}))
