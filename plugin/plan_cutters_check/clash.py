"""Does a tool, put down at a contact, come deeper into an exact surface than allowed? By branch and bound over its cells."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters_check.surface import OUTSIDE, Cells
from plan_cutters_check.tool import Solid, Tool, bounds

Rows = NDArray[np.int64]
#: Verdicts of a placement.
FREE, MET, OPEN = 0, 1, 2
#: Tools that are put down at a time, and pairs of a tool and a cell that are looked at at once.
_TOOLS, _PAIRS = 256, 100_000
#: Depths that rounding makes, mm.
_ROUNDING = 1e-7


@dataclass(slots=True)
class Clock:
    """Seconds that a check may take."""

    end: float

    @property
    def over(self) -> bool:
        """Whether they are over."""
        return time.monotonic() > self.end


@dataclass(frozen=True, slots=True, eq=False)
class Met:
    """Tools, n of them, met something or nothing.

    Attributes
    ----------
    verdict : (n,) int8
        `FREE`, `MET`, or `OPEN` where the time was over.
    cell : (n,) int64
        A cell whose point is too deep, -1 for none.
    depth : (n,) float
        How deep that point lies in the tool, mm; negative outside.
    solid : (n,) int64
        In which solid of the tool.
    """

    verdict: NDArray[np.int8]
    cell: Rows
    depth: Floats
    solid: Rows


def met(
    cells: Cells, root: int, tool: Tool, tip: Floats, axis: Floats, limits: tuple[float, float], grain: float, clock: Clock,
    tell: Callable[[int], None] = lambda done: None,
) -> Met:  # fmt: skip
    """Which tools, put down with their tips (n, 3) and axes (n, 3), hold a point of the surface that is too deep.

    Parameters
    ----------
    cells : Cells
    root : int
        The group of all that may be in the way.
    tool : Tool
    tip, axis : (n, 3) float
    limits : (float, float)
        Depth in the flutes, and in all above them, beyond which a point is too deep, mm; negative: so near to it.
    grain : float
        What is deeper by less than this may be missed, mm.
    clock : Clock
    tell : callable, optional
        Called with how many are done.
    """
    n = len(tip)
    hits = Met(np.full(n, OPEN, np.int8), np.full(n, -1, np.int64), np.full(n, np.nan), np.full(n, -1, np.int64))
    limit = np.array([limits[0] if each.part == "flutes" else limits[1] for each in tool.solids])
    for start in range(0, n, _TOOLS):
        if clock.over:
            break
        some = np.arange(start, min(n, start + _TOOLS))
        _some_met(cells, root, tool.solids, tip, axis, limit, grain, clock, some, hits)
        tell(len(some))
    return hits


def _some_met(
    cells: Cells, root: int, solids: Sequence[Solid], tip: Floats, axis: Floats, limit: Floats, grain: float, clock: Clock,
    some: Rows, hits: Met,
) -> None:  # fmt: skip
    # The cells nearest to a contact come last, and are the smallest: the stack keeps few of them at a time.
    stack = [(some, np.full(len(some), root, np.int64))]
    while stack:
        if clock.over:
            return
        who, cell = stack.pop()
        open_ = (hits.verdict[who] != MET) & (cells.state[cell] != OUTSIDE)
        who, cell = who[open_], cell[open_]
        if len(who) > _PAIRS:
            half = len(who) // 2
            stack += [(who[half:], cell[half:]), (who[:half], cell[:half])]
            continue
        if not len(who):
            continue
        near = np.zeros(len(who), bool)
        for k, solid in enumerate(solids):
            deep, most = bounds(solid, tip[who], axis[who], cells.point[cell], cells.offset[cell])
            near |= most + cells.slack[cell] > limit[k] + grain
            hit = np.flatnonzero((deep > limit[k] + _ROUNDING) & cells.proper[cell])
            hits.verdict[who[hit]], hits.cell[who[hit]] = MET, cell[hit]
            hits.depth[who[hit]], hits.solid[who[hit]] = deep[hit], k
        near &= (hits.verdict[who] != MET) & (cells.size[cell] > grain)
        if near.any():
            pieces, owner = cells.children(cell[near])
            stack.append((who[near][owner], pieces))
    rest = some[hits.verdict[some] == OPEN]
    hits.verdict[rest] = FREE


def nearest(
    cells: Cells, root: int, solids: Sequence[Solid], tip: Floats, axis: Floats, beyond: float, grain: float, clock: Clock
) -> tuple[float, str] | None:
    """The least distance, mm, of any point of the surface from solids at tips and axes (n, 3), and the part of the tool there.

    Negative where a point lies within; to within `grain`; `beyond` where all is farther away; None where the time was over.
    """
    best, part = -beyond, ""
    stack = [(np.arange(len(tip)), np.full(len(tip), root, np.int64))]
    while stack:
        if clock.over:
            return None
        who, cell = stack.pop()
        if len(who) > _PAIRS:
            half = len(who) // 2
            stack += [(who[half:], cell[half:]), (who[:half], cell[:half])]
            continue
        most = np.full(len(who), -np.inf)
        for solid in solids:
            deep, bound = bounds(solid, tip[who], axis[who], cells.point[cell], cells.offset[cell])
            most = np.maximum(most, bound + cells.slack[cell])
            deep = np.where(cells.proper[cell], deep, -np.inf)
            if deep.max(initial=-np.inf) > best:
                best, part = float(deep.max()), solid.part
        open_cells = (most > best + grain) & (cells.state[cell] != OUTSIDE) & (cells.size[cell] > grain)
        if open_cells.any():
            pieces, owner = cells.children(cell[open_cells])
            stack.append((who[open_cells][owner], pieces))
    return -best, part


def lowest(cells: Cells, root: int, direction: Floats, grain: float) -> float:
    """How far down along a unit direction (3,) the surface goes, mm, to within `grain`."""
    best, cell = np.inf, np.array([root])
    while len(cell):
        at = cells.point[cell] @ direction
        best = min(best, float(at[cells.proper[cell]].min(initial=np.inf)))
        least = at - np.abs(cells.offset[cell] @ direction).max(axis=1) - cells.slack[cell]
        open_cells = (least < best - grain) & (cells.state[cell] != OUTSIDE) & (cells.size[cell] > grain)
        cell = cells.children(cell[open_cells])[0]
    return best
