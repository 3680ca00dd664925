"""How far a cutter keeps from what is around it, where it does not cut: the part of it that counts, grown all round.

All of a cutter counts but the lowest of its flutes, up to their diameter over the tip: that is where it works.
"""

import numpy as np

from cad_io.arrays import Floats
from plan_cutters.domain.assembly import Assembly, assembly, placed
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.pieces import PARTS, Band, alone, band_row, flute_rows, row_of, solid
from plan_cutters.domain.shapes import flute_length, stages
from plan_cutters.kernels.codes import ARC, COLUMNS, FLUTES, HIGH, KIND, LOW, PART, RADIUS, ROUND, SLOPE

#: Clearances are looked for up to this, mm, and told to this share of them, or to `FINEST`, whichever is more.
MOST, SHARE, FINEST = 100.0, 0.02, 0.005


def working_height(cutter: Cutter) -> float:
    """Height over the tip, mm, above which the flutes count, too: their diameter."""
    return 2.0 * cutter.radius


def grown(cutter: Cutter, by: float) -> Assembly:
    """Build the cutter as far as it counts, with all points that are no farther from it than a distance, mm.

    Neck, shank and holder are grown exactly. The flutes' pieces hold a little more at their edges, never less.

    Parameters
    ----------
    cutter : Cutter
        Its own allowance and clearance are not counted in.
    by : float
        Not negative.
    """
    rows = [_from(row, working_height(cutter) - by) for row in flute_rows(cutter, -by, flute_length(cutter) + by, "outer")]
    if flute_length(cutter) <= working_height(cutter):
        rows = []
    for part, low, stage in stages(cutter):
        rows += alone(Band(PARTS[part], low, stage, -by))
    table = np.array([row for row in rows if solid(row)], float).reshape(-1, COLUMNS)
    return placed(assembly(cutter, 0.0, 0.0), table)


def rungs(cutter: Cutter) -> Floats:
    """The clearances (k,) that are looked at, mm, ascending from 0; the one asked for is among them."""
    steps = [0.0]
    while steps[-1] < MOST:
        steps.append(min(MOST, steps[-1] + max(FINEST, SHARE * steps[-1])))
    return np.unique(np.round([*steps, cutter.clearance or 0.0], 6))


def part_words() -> dict[int, str]:
    """Give the names of the parts of an assembly, by their numbers."""
    return {FLUTES: "flutes", **{number: word for word, number in PARTS.items()}}


def _from(row: list[float], low: float) -> list[float]:
    """Cut a piece off below a height, mm, and keep the rest."""
    if row[LOW] >= low:
        return row
    if row[KIND] == ARC:
        return row_of(ARC, low, row[HIGH], row[RADIUS], row[SLOPE], row[ROUND], int(row[PART]))
    return band_row(low, row[HIGH], row[RADIUS] + row[SLOPE] * (low - row[LOW]), row[SLOPE], int(row[PART]))
