"""How a part is held in a direction: what a table, a vise or a chuck grips there, and which of them is best."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters.domain.clamping import VISE
from plan_cutters.domain.figures import area, percent
from plan_cutters.domain.fixture import TABLE, Fixture
from plan_cutters.domain.stock import Stock
from plan_cutters.scene.preparation import Axis, Prepared
from plan_cutters.scene.surroundings import Surroundings
from plan_cutters.setups.workpiece import BENDS

#: Shares of the area that differ by less are equal.
EVEN = 0.002
#: A table holds nothing: it is taken only where what grips the part serves less than this share of what it serves.
GRIPPED_FOR = 0.9


@dataclass(frozen=True, slots=True, eq=False)
class Held:
    """How a part is held in a direction that was searched."""

    fixture: Fixture  #: In its place.
    served: NDArray[np.bool_]  #: (r,) bool: where a posture was found among it.
    grips: tuple[int, ...] = ()  #: Faces that jaws touch.
    rests_on: tuple[int, ...] = ()  #: Planar faces with which the part rests in jaws; none for a table.
    hidden: float = 0.0  #: Area of the target faces that jaws touch, mm2.
    words: str = ""  #: What it is and what it grips; empty for a table.
    why: str = ""  #: Why it was taken; empty where only one was tried.
    soft: str = ""  #: Why the part needs soft jaws or a nest; empty where it stands, or is gripped, as it is.
    stock: Fixture | None = None  #: What is gripped, if that is stock.
    x: Axis | None = None  #: Direction of the part along the machine's X; None: any.

    @property
    def kind(self) -> Any:
        """`table`, `vise` or `chuck`."""
        return self.fixture.kind

    @property
    def faces(self) -> tuple[int, ...]:
        """All faces that a vise or chuck holds."""
        return (*self.grips, *self.rests_on)


def held_by(
    ready: Prepared, axis: Axis, fixture: Fixture, among: Callable[[Surroundings], NDArray[np.bool_]], stock: Stock | None = None
) -> Held:
    """Hold a part, or its stock, along an axis by a table, vise or chuck, and find where a posture is among it.

    `axis` (float, float, float). `fixture`: a table, a vise or a chuck. `among`: where any cutter has a posture among
    some obstacles, (r,). Raises NothingToGripError.
    """
    surroundings = ready.scene.surround_held(axis, fixture, stock)
    *blank, placed = surroundings.fixtures
    held, hold = Held(placed.fixture, among(surroundings), stock=blank[0].fixture if blank else None), placed.hold
    if hold is None:
        return held
    return replace(held, grips=hold.grips, rests_on=hold.rests_on, hidden=hold.hidden, words=hold.words, soft=hold.soft)


def best_hold(
    tried: list[Held], refused: dict[str, str], weight: Floats, open_rows: NDArray[np.bool_] | None = None, usual: str = VISE
) -> Held:
    """Take what holds a part best, and say why.

    `tried`: at least one. `refused`: of each kind that cannot hold it, why not. `weight` (r,) float: the area that each sample
    stands for. `open_rows` (r,) bool: those that count, for other setups serve the rest; all by default. `usual`: the kind that
    is taken of those that serve as much.
    """
    wanted = weight if open_rows is None else weight * open_rows
    share, served_of = (
        {each.kind: float(these @ each.served) / max(1e-300, float(weight.sum())) for each in tried} for these in (wanted, weight)
    )
    able = [each for each in tried if not each.soft] or tried
    gripping = [each for each in able if each.kind != TABLE]
    best = max(gripping or able, key=lambda each: (round(share[each.kind] / EVEN), each.kind == usual, share[each.kind]))
    if any(each.kind == TABLE for each in able) and share[best.kind] < GRIPPED_FOR * share[TABLE]:
        best = next(each for each in able if each.kind == TABLE)
    # What stands on thin walls is clamped no better from above.
    bending = next((each.soft for each in tried if BENDS in each.soft and best.kind == TABLE), "")
    served = [
        f"the {each.kind} serves {percent(served_of[each.kind])}" for each in sorted(tried, key=lambda each: each is not best)
    ]
    served[0] += " of the samples' area"
    nothing = [f"a {each.kind} needs soft jaws or a nest ({each.soft})" for each in tried if each.soft]
    nothing += [f"a {kind} has nothing to grip ({why})" for kind, why in refused.items()]
    left = f"; {area(best.hidden)} under its jaws" if best.hidden > 0.0 else ""
    return replace(best, soft=best.soft or bending, why=f"{', '.join([*served, *nothing])}{left}")
