"""Find what holds a part best in a direction: a table, a vise or a chuck, by what cutters reach among each."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters.domain.figures import area, percent
from plan_cutters.domain.fixture import TABLE, Fixture
from plan_cutters.scene.preparation import Axis, Prepared
from plan_cutters.scene.surroundings import Surroundings

#: A table holds nothing: it is taken only where what grips the part serves less than this share of what it serves.
_GRIPPED_FOR = 0.9


@dataclass(frozen=True, slots=True, eq=False)
class Held:
    """How a part is held in a direction that was searched.

    Attributes
    ----------
    fixture : Fixture
        In its place.
    served : (r,) bool
        Where a posture was found among it.
    grips, rests_on : tuple of int
        Faces that jaws touch, and planar ones with which the part rests in them; none for a table.
    hidden : float
        Area of the target faces that jaws touch, mm2.
    words : str
        What it is and what it grips; empty for a table.
    why : str
        Why it was taken; empty where only one was tried.
    """

    fixture: Fixture
    served: NDArray[np.bool_]
    grips: tuple[int, ...] = ()
    rests_on: tuple[int, ...] = ()
    hidden: float = 0.0
    words: str = ""
    why: str = ""

    @property
    def kind(self) -> Any:
        """`table`, `vise` or `chuck`."""
        return self.fixture.kind

    @property
    def faces(self) -> tuple[int, ...]:
        """All faces that a vise or chuck holds."""
        return (*self.grips, *self.rests_on)


def held_by(ready: Prepared, axis: Axis, word: str, among: Callable[[Surroundings], NDArray[np.bool_]]) -> Held:
    """Hold a part along an axis by a table, vise or chuck, and find where a posture is among it.

    Parameters
    ----------
    ready : Prepared
    axis : (float, float, float)
    word : str
        `table`, or the word of a vise or chuck.
    among : callable
        Where any cutter has a posture among some obstacles, (r,).

    Raises
    ------
    NothingToGripError
    """
    surroundings = ready.scene.surround_held(axis, word)
    (placed,) = surroundings.fixtures
    held, hold = Held(placed.fixture, among(surroundings)), placed.hold
    if hold is None:
        return held
    return replace(held, grips=hold.grips, rests_on=hold.rests_on, hidden=hold.hidden, words=hold.words)


def best_hold(tried: list[Held], refused: dict[str, str], weight: Floats) -> Held:
    """Take what holds a part best, and say why.

    Parameters
    ----------
    tried : list of Held
        At least one.
    refused : dict of str
        Of each kind that cannot hold it, why not.
    weight : (r,) float
        The area that each sample stands for.
    """
    whole = max(1e-300, float(weight.sum()))
    share = {each.kind: float(weight @ each.served) / whole for each in tried}
    gripping = [each for each in tried if each.kind != TABLE]
    best = max(gripping or tried, key=lambda each: share[each.kind])
    if share[best.kind] < _GRIPPED_FOR * share.get(TABLE, 0.0):
        best = next(each for each in tried if each.kind == TABLE)
    served = [f"the {each.kind} serves {percent(share[each.kind])}" for each in sorted(tried, key=lambda each: each is not best)]
    served[0] += " of the samples' area"
    nothing = [f"a {kind} has nothing to grip ({why})" for kind, why in refused.items()]
    left = f"; {area(best.hidden)} under its jaws" if best.hidden > 0.0 else ""
    return replace(best, why=f"{', '.join([*served, *nothing])}{left}")
