"""Which is the largest of a row of tools, each within the next, that finds a posture at a sample?

The search starts from the answer at the sample before, goes up or down by 1, 2, 4 ... tools until the answer lies between two of
them, and halves what is between. A tool is asked for a posture at the rotation found last; where that has none, what is
surely in the way is asked next, for it answers for all rotations and mostly ends the search: an inaccessible tool costs one
search without success, not two. Lemma N4 of `docs/nested_cutters_proof.md`.
"""

from typing import Any, NamedTuple

import numpy as np

from plan_cutters.kernels.codes import INACCESSIBLE, UNDECIDED
from plan_cutters.kernels.jit import entry, kernel
from plan_cutters.kernels.material import MAYBE_INSIDE, SURELY_INSIDE, Solids
from plan_cutters.kernels.rows import Tool
from plan_cutters.kernels.search.place import Proof
from plan_cutters.kernels.search.search import _FINEST, _NO_INTERVAL, START, _reason, _write
from plan_cutters.kernels.search.sweep import WITHOUT_END, Side, both, sweep_both


class Ladder(NamedTuple):
    """Tools from the smallest up: piece (tools, m, k, COLUMNS), mode (tools, m, 5), reach, inner and end (tools,), each as in
    `Tool`."""

    piece: Any
    mode: Any
    reach: Any
    inner: Any
    end: Any


class _Sides(NamedTuple):
    """This record is a `Side` of many tools: the tools; `piece` and `mode`, a workspace for one of them; the rest as there."""

    tools: Ladder
    piece: Any
    mode: Any
    solids: Solids
    within: float
    narrowest: float
    pasts: Any
    proof: Any


@kernel
def _look(contacts, row, ranges, side, level, starts, turns, workspaces):
    """Search as `sweep_both` with one tool of a row."""
    tools, piece, mode = side.tools, side.piece, side.mode
    for m in range(len(mode)):
        for column in range(mode.shape[1]):
            mode[m, column] = tools.mode[level, m, column]
        for k in range(piece.shape[1]):
            for column in range(piece.shape[2]):
                piece[m, k, column] = tools.piece[level, m, k, column]
    tool = Tool(piece, mode, tools.reach[level], tools.inner[level], tools.end[level])
    one = Side(tool, side.solids, side.within, side.narrowest, WITHOUT_END, side.pasts, side.proof)
    return sweep_both(contacts, row, ranges, one, starts, turns, workspaces)


@kernel
def _largest(contacts, row, ranges, outer, inner, guess, last, freed, workspaces, results):
    """The number of the largest tool that finds a posture, -1 for none, and the verdict on the next; then where the searches
    of both sides ended.
    """
    count, turns = len(outer.tools.reach), len(ranges.rotation_cos)
    # Reached, not reached; not known to be inaccessible, known to be so.
    low, high, free, beyond = -1, count, -1, count
    level, stride = guess, 1
    while high - low > 1:
        rotation, tilt, last = _look(contacts, row, ranges, outer, level, last, 1, workspaces)
        if rotation < 0 and level > free:
            turn, _, freed = _look(contacts, row, ranges, inner, level, freed, turns, workspaces)
            if turn < 0:
                beyond = level
                results.reason[row] = _reason(workspaces[0].tally, workspaces[1].tally)
            else:
                free = level
        if rotation < 0 and level < beyond:
            rotation, tilt, last = _look(contacts, row, ranges, outer, level, last, turns, workspaces)
            if rotation < 0:
                results.reason[row] = _reason(workspaces[0].tally, workspaces[1].tally)
        if rotation < 0:
            high = level
        else:
            low = level
            _write(results, row, contacts, ranges, rotation, tilt)
        if low < 0:
            level = max(high - stride, 0)
        elif high == count:
            level = min(low + stride, count - 1)
        else:
            level = (low + high) // 2
        stride *= 2
    return low, INACCESSIBLE if beyond == high else UNDECIDED, last, freed


@entry
def largest(rows, contacts, ranges, outer_tool, inner_tool, possible, certain, results, level, beyond):
    """Find the largest tool that reaches each sample.

    Parameters
    ----------
    rows : (m,) int64
        Samples, neighbours in sequence.
    contacts : Contacts
    ranges : Ranges
    outer_tool, inner_tool : Ladder
        The outer and the inner tools; each lies within the next.
    possible, certain : Solids
        As `search.search` takes them.
    results : Found, written
        The posture of the largest tool that has one, and the reason why the next one has none.
    level : (n,) int64, written
        The number of the largest tool that has a posture, -1 where none has.
    beyond : (n,) uint8, written
        INACCESSIBLE or UNDECIDED for the tool after it; as it was where there is none.
    """
    rotations = len(ranges.rotation_cos)
    pasts, workspaces = both(rotations, outer_tool.mode.shape[1])
    met, _ = both(rotations, inner_tool.mode.shape[1])
    proof, (piece, mode), (held, ways) = Proof(np.zeros(0), 0.0, certain), outer_tool[:2], inner_tool[:2]
    outer = _Sides(outer_tool, piece[0].copy(), mode[0].copy(), possible, MAYBE_INSIDE, _FINEST, pasts, proof)
    inner = _Sides(inner_tool, held[0].copy(), ways[0].copy(), certain, SURELY_INSIDE, _NO_INTERVAL, met, proof)
    guess, last, freed = len(outer_tool.reach) // 2, START, START
    for row in rows:
        low, verdict, last, freed = _largest(contacts, row, ranges, outer, inner, guess, last, freed, workspaces, results)
        level[row], guess = low, max(low, 0)
        if low + 1 < len(outer_tool.reach):
            beyond[row] = verdict
