"""Closed forms against branch and bound over the exact surface of the part's file, its boxes and its table.

Both are proofs by other means: the forms know bodies and no surface, the bounds know the surface and no body. A form that searches a
parametrised surface may miss some micrometres where the tool enters along a crease; there the bounds stand.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from conformance.exact.bound import Tree, deepest, least, numbers, tree
from conformance.exact.cells import Cells, UnfitError, cells
from conformance.made.blocks import cuboid
from conformance.made.part import MadePart, Setup
from conformance.posture import Postures

#: How far (mm) a margin may lie outside its bounds; beyond this depth the inside of a body counts, which has no surface.
AGREE, DEEP = 1e-4, 0.5
#: A table is a block of this half width (mm).
_TABLE = 80.0


@dataclass(frozen=True)
class Contradiction:
    """A row whose margin (mm) the bounds exclude."""

    row: int
    form: float
    low: float
    high: float
    #: What of the tool the surface reaches deepest.
    reason: str


class Around:
    """A part's shape with the boxes and the table of each of its setups; a tree is made once, when it is first asked for."""

    def __init__(self, part: MadePart, shape: Any) -> None:
        self.part, self.shape = part, shape
        self._trees: dict[str, Tree] = {}

    def of(self, setup_name: str) -> Tree:
        """Return the tree of a setup."""
        if setup_name not in self._trees:
            self._trees[setup_name] = self._made(self.part.setup(setup_name))
        return self._trees[setup_name]

    def _made(self, setup: Setup) -> Tree:
        solids = [self.shape, *(cuboid(*corners).val().wrapped for corners in setup.boxes)]
        if setup.table is not None:
            solids.append(cuboid((-_TABLE, -_TABLE, setup.table - _TABLE), (_TABLE, _TABLE, setup.table)).val().wrapped)
        made = [cells_of(each) for each in solids]
        return tree(Cells(*(np.concatenate([getattr(c, column) for c in made]) for column in ("corners", "delta", "face", "whole"))))


def cells_of(shape: Any) -> Cells:
    """Return the cells of a shape; faces that have no enclosure of their own are B-splines first, exactly."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_NurbsConvert

    try:
        return cells(shape)
    except UnfitError:
        return cells(BRepBuilderAPI_NurbsConvert(shape, True).Shape())


def contradictions(around: Around, table: Postures) -> Iterator[Contradiction]:
    """Yield the rows of a part's table whose margins the bounds exclude; rows beyond the machine's limit are left out."""
    for i in np.flatnonzero(~(table.limit_deg < 0)):
        shape, tool = around.of(str(table.setup[i])), around.part.tool(str(table.tool[i]))
        where = shape, numbers(tool), table.tip[i], table.axis[i]
        low, high, _ = least(*where, enough=0.0)
        form = float(table.low[i])
        wrong = high < -AGREE if table.verdict[i] == "safe" else form > high + AGREE or -DEEP < form < low - AGREE
        if wrong:
            yield Contradiction(int(i), form, low, high, tool.pieces[deepest(*where)].part)


def confirmed(around: Around, table: Postures) -> tuple[Postures, int]:
    """Return the table with the bounds where they contradict the form, and how many those are; what they do not decide either is left out."""
    found = list(contradictions(around, table))
    columns = {name: getattr(table, name).copy() for name in ("low", "high", "verdict", "reason", "proof")}
    kept = np.ones(len(table), bool)
    for each in found:
        kept[each.row] = each.high < 0.0
        columns["low"][each.row], columns["high"][each.row] = each.low, each.high
        columns["verdict"][each.row], columns["reason"][each.row], columns["proof"][each.row] = "blocked", each.reason, "bound"
    return replace(table, **columns)[np.flatnonzero(kept)], len(found)
