"""Few tool axes that stay as they are and serve together what one cutter reaches, found soon and without a proof."""

import math

import numpy as np

from cad_io.arrays import Floats, Ints, SurfaceSamples
from plan_cutters.domain.columns import Columns, columns_of
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.operations import OperationPlan
from plan_cutters.domain.verdicts import Verdicts
from plan_cutters.operations.candidates import apart, directions
from plan_cutters.operations.fewest import Rows, Search, spread
from plan_cutters.operations.probes import Probes
from plan_cutters.scene.conditions import Conditions

#: Axes all around that are compared, and axes found far from each other.
_DIRECTIONS, _MOST_AXES = 200, 64


def fixed_axes(
    samples: SurfaceSamples, cutter: Cutter, verdicts: Verdicts, conditions: Conditions, plan: OperationPlan | None = None
) -> tuple[Floats, Ints]:
    """Few axes that serve what a cutter reaches: first those that a plan of operations has for it, then as few as are soon found.

    Parameters
    ----------
    samples : SurfaceSamples
    cutter : Cutter
    verdicts : Verdicts
        What was found for it.
    conditions : Conditions
        Of the first setup.
    plan : OperationPlan, optional

    Returns
    -------
    axes : (k, 3) float
    number : (n,) int32
        Of the axis that each sample goes with; -1 where it is not reached, or no axis was found that serves it.
    """
    number, axes = np.full(len(samples), -1, np.int32), list[Floats]()
    reached, area = verdicts.reached, np.maximum(np.nan_to_num(samples.area), 1e-12)
    probes = Probes(samples, (cutter,), (conditions,), (reached,))

    def take(columns: Columns, order: list[int]) -> None:
        """Let each of some axes have what it serves and none before it does, in an order."""
        for k in order:
            open_rows = np.flatnonzero(reached & (number < 0))
            mine = open_rows[probes.one(open_rows, columns, k)]
            if len(mine):
                number[mine] = len(axes)
                axes.append(columns.axis[k])

    if plan is not None:
        # Regions are those of the plan, as far as this cutter has them; then its axes serve what other cutters have there.
        here = [each.axis is not None and each.setup == 0 and each.cutter == cutter for each in plan.operations]
        mine = np.flatnonzero(here).tolist()
        for i in mine:
            number[(plan.label == i) & reached] = len(axes)
            axes.append(np.asarray(plan.operations[i].axis))
        for k, i in enumerate(mine):
            number[plan.serves[:, i] & reached & (number < 0)] = k
    open_rows = np.flatnonzero(reached & (number < 0))
    if len(open_rows):
        search = Search(
            probes, _first(samples, verdicts, conditions, open_rows), open_rows, lambda bare: _columns(verdicts.axis[bare])
        )
        cover = search.solve(prove=False)
        chosen = search.columns.of(cover.chosen)
        size = area[open_rows] @ probes.table(open_rows, chosen)
        take(chosen, np.argsort(-size, kind="stable").tolist())
    return np.array(axes).reshape(-1, 3), number


def _columns(axis: Floats) -> Columns:
    axis = axis[apart(axis)]
    return columns_of(axis, np.zeros((len(axis), 2)))


def _first(samples: SurfaceSamples, verdicts: Verdicts, conditions: Conditions, rows: Rows) -> Columns:
    """Axes to compare: the part's, some all around, and of those found some far from each other."""
    turn = np.arange(_DIRECTIONS) * (math.pi * (3.0 - math.sqrt(5.0)))
    height = 1.0 - (2.0 * np.arange(_DIRECTIONS) + 1.0) / _DIRECTIONS
    wide = np.sqrt(1.0 - height**2)
    circle = np.column_stack([wide * np.cos(turn), wide * np.sin(turn), height])
    axes = verdicts.axis[spread(rows, verdicts.axis, _MOST_AXES)]
    every = np.concatenate([directions(samples, conditions.setup), axes, circle])
    return _columns(every[conditions.allows(every)])
