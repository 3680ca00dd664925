"""Clearance: how far a cutter keeps from the part and the fixtures at the postures found, where it does not cut.

The distance is that between all of the tool above its working height (`domain.assembly`) and the true surface of everything
around it. A tool grown by a clearance and the chord error meets no triangle: then no point of the true surface is nearer than the
clearance. So what is told is proved, and never more than the true distance.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Ints, Record, SurfaceSamples
from plan_cutters.domain.assembly import Assembly, grown, rungs
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.verdicts import UNJUDGED, Verdicts
from plan_cutters.kernels.codes import PART
from plan_cutters.scene.conditions import Conditions, laid_tool_of
from plan_cutters.scene.threads import in_chunks

#: Added to the chord error, mm, for rounding.
_ROUNDING = 1e-9


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Clearances(Record):
    """Of n samples at the postures found; where there is no posture nan and -1.

    Attributes
    ----------
    distance : (n,) float
        No more than the true clearance, mm, and within 2 % or 0.005 mm of it, unless the flutes' edges are nearest. At
        `domain.assembly.MOST` it is that or more.
    part : (n,) int8
        Of the tool what is nearest: FLUTES, NECK, SHANK or HOLDER; -1 where nothing is near.
    face : (n,) int32
        The face in the way if that part were a little larger, negative for a fixture (`Surroundings.called`); 0 for none.
    """

    distance: Floats
    part: NDArray[np.int8]
    face: Ints


def clearances_over(
    samples: SurfaceSamples, cutter: Cutter, verdicts: Verdicts, setups: Sequence[Conditions], served_in: Ints | None
) -> Clearances:
    """The same over several setups: each posture among the obstacles of the setup that serves its sample, (n,) int32.

    A fixture that stands in another setup than the first has no number: its `face` is 0.
    """
    if served_in is None or all(each.surroundings is setups[0].surroundings for each in setups):
        return clearances(samples, cutter, verdicts, setups[0])
    n = len(samples)
    result = Clearances(np.full(n, np.nan), np.full(n, -1, np.int8), np.zeros(n, np.int32))
    for k, conditions in enumerate(setups):
        mine = served_in == k
        verdict = np.where(mine, verdicts.verdict, UNJUDGED).astype(np.uint8)
        there = clearances(samples, cutter, replace(verdicts, verdict=verdict), conditions)
        for name in ("distance", "part", "face"):
            value = getattr(there, name)
            getattr(result, name)[mine] = (np.maximum(value, 0) if name == "face" and k else value)[mine]
    return result


def clearances(samples: SurfaceSamples, cutter: Cutter, verdicts: Verdicts, conditions: Conditions) -> Clearances:
    """Clearance at every posture found.

    Parameters
    ----------
    samples : SurfaceSamples
    cutter : Cutter
    verdicts : Verdicts
        What was found for it.
    conditions : Conditions

    Returns
    -------
    Clearances
        Unknown at all samples where an obstacle is missing or only guessed, for nothing could be proved, and of a bare cutter
        that is no longer than it is wide.
    """
    n, obstacles, steps = len(samples), conditions.obstacles, rungs(cutter)
    result = Clearances(np.full(n, np.nan), np.full(n, -1, np.int8), np.zeros(n, np.int32))
    rows = np.flatnonzero(verdicts.reached)
    if _unknown(cutter, conditions) or not len(rows):
        return result
    triangle, which = np.full(n, -1, np.int32), np.full(n, -1, np.int32)
    free, not_reached = np.full(n, -1), np.full(n, len(steps))
    nearest, part = np.full(n, -1, np.int32), np.full(n, -1, np.int8)
    while len(open_rows := rows[not_reached[rows] - free[rows] > 1]):
        middle = (free[open_rows] + not_reached[open_rows]) // 2
        for rung in np.unique(middle).tolist():
            mine = open_rows[middle == rung]
            made = _probed(samples, verdicts, mine, cutter, float(steps[rung]), conditions, triangle, which)
            clear = triangle[mine] == -1
            free[mine[clear]], not_reached[mine[~clear]] = rung, rung
            met = mine[triangle[mine] >= 0]
            nearest[met], part[met] = triangle[met], made.piece[0, which[met], PART]
    # Even the tool itself may be met, within the tolerance: a barrel touches with its flank.
    result.distance[rows] = np.where(free[rows] >= 0, steps[np.maximum(free[rows], 0)], 0.0)
    result.part[rows] = part[rows]
    met = rows[nearest[rows] >= 0]
    result.face[met] = obstacles.faces[nearest[met]]
    return result


def least_clearance(samples: SurfaceSamples, cutter: Cutter, verdicts: Verdicts, conditions: Conditions) -> float:
    """Least clearance over the postures found, as `clearances` has it, with fewer probes; nan where there is none.

    What keeps clear of something once is not looked at again while another posture does not.
    """
    n, steps = len(samples), rungs(cutter)
    reached = np.flatnonzero(verdicts.reached)
    if _unknown(cutter, conditions) or not len(reached):
        return float("nan")
    triangle, which = np.full(n, -1, np.int32), np.full(n, -1, np.int32)
    free, not_free = -1, len(steps)
    while not_free - free > 1:
        middle = (free + not_free) // 2
        _probed(samples, verdicts, reached, cutter, float(steps[middle]), conditions, triangle, which)
        met = reached[triangle[reached] != -1]
        if len(met):
            reached, not_free = met, middle
        else:
            free = middle
    return float(steps[free]) if free >= 0 else 0.0


def _unknown(cutter: Cutter, conditions: Conditions) -> bool:
    """Whether nothing can be said: an obstacle is only guessed, or nothing of the tool is above its working height."""
    return conditions.surroundings.doubtful or not grown(cutter, 0.0).piece.shape[1]


def _probed(
    samples: SurfaceSamples, verdicts: Verdicts, rows: NDArray[np.int64], cutter: Cutter, distance: float,
    conditions: Conditions, triangle: Ints, which: Ints,
) -> Assembly:  # fmt: skip
    """Put the cutter, grown by a distance, down at some samples: writes what (n,) it meets, -1 for none, and with which piece."""
    from plan_cutters.kernels.search.search import probe

    made = grown(cutter, distance + conditions.obstacles.triangles.chord_error + _ROUNDING)
    # Arrays that may not be written are another type to the compiler: `probe` would be compiled once more for them.
    postures = verdicts.contact(samples.point), samples.normal, verdicts.axis.copy(), verdicts.tilt_direction.copy()
    in_chunks(
        lambda piece: probe(piece, *postures, laid_tool_of(made), conditions.obstacles.tree, triangle, which),
        rows,
        conditions.jobs,
    )
    return made
