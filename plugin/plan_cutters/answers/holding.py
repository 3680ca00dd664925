"""Find what holds a part best in a direction: a table, a vise or a chuck, by what cutters reach among each."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters.domain.fixture import Fixture
from plan_cutters.errors import FixtureError
from plan_cutters.plan_file.numbers import percent
from plan_cutters.scene.preparation import Axis, Prepared
from plan_cutters.scene.surroundings import Surroundings

#: Shares nearer than this are equal.
EVEN = 0.002


@dataclass(frozen=True, slots=True)
class Held:
    """How a part is held in a direction that was searched.

    Attributes
    ----------
    fixture : Fixture
        In its place.
    grips, faces : tuple of int
        Faces that jaws touch, and all that a vise or chuck holds; none for a table.
    why : str
        What it and the others serve, or cannot grip; empty where only one was tried.
    """

    fixture: Fixture
    grips: tuple[int, ...] = ()
    faces: tuple[int, ...] = ()
    why: str = ""

    @property
    def kind(self) -> Any:
        """`table`, `vise` or `chuck`."""
        return self.fixture.kind


def best_hold(
    ready: Prepared, axis: Axis, words: Sequence[str], among: Callable[[Surroundings], NDArray[np.bool_]], area: Floats
) -> tuple[NDArray[np.bool_], Held | None, list[str]]:
    """Find what holds a part best along an axis: where a posture is tried in it (r,), how it holds, and why others do not.

    Parameters
    ----------
    ready : Prepared
    axis : (float, float, float)
    words : sequence of str
        `table`, and words of vises and chucks.
    among : callable
        Where any cutter has a posture among some obstacles, (r,).
    area : (r,) float
        What each of these samples stands for.

    Returns
    -------
    reached : (r,) bool
    held : Held or None
        None where nothing holds it.
    refused : list of str
        Why vises and chucks do not.
    """
    tried: list[tuple[float, NDArray[np.bool_], Held]] = []
    refused: list[str] = []
    for word in words:
        try:
            surroundings = ready.scene.surround_held(axis, word)
        except FixtureError as error:
            refused.append(error.cause)
            continue
        (placed,) = surroundings.fixtures
        reached, hold = among(surroundings), placed.hold
        share = float(area @ reached / max(1e-300, float(area.sum())))
        faces = ((), ()) if hold is None else (hold.grips, hold.faces)
        tried.append((share, reached, Held(placed.fixture, *faces)))
    if not tried:
        return np.zeros(len(area), bool), None, refused
    # Of equals what grips the part: a table alone does not hold it.
    best = max(tried, key=lambda each: (round(each[0] / EVEN), each[2].kind != "table"))
    if len(words) == 1:
        return best[1], best[2], refused
    served = [f"{each[2].kind} {percent(each[0])}" for each in sorted(tried, key=lambda each: each is not best)]
    nothing = [f"a {word} has nothing to grip" for word in words if word not in [each[2].kind for each in tried]]
    return best[1], replace(best[2], why=f"of these samples' area {', '.join([*served, *nothing])}"), refused
