"""The plan of operations for the page: which sample goes with which operation, their looks, their tables and the curve."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from cad_io.arrays import SurfaceSamples
from plan_cutters.domain.operations import OperationPlan
from plan_cutters.plan_file.model import Plan
from plan_cutters.plan_file.numbers import bound, percent
from plan_cutters.plan_file.operations import CurveStepEntry, OperationEntry, OperationPlanEntry
from plan_cutters.plan_file.palette import OPERATIONS, operation_colour
from plan_cutters.plan_file.words.line import Line
from plan_cutters.plan_file.words.operations import OperationText, of_the_whole, operation_text, share_text
from plan_cutters.plan_file.words.story import Story
from plan_cutters.report.page.arrays import Arrays
from plan_cutters.report.page.encode import Stored
from plan_cutters.report.page.facts import shares, turned_by
from plan_cutters.report.protocol import Judged

#: The drawing of the curve: its size, and the edges of what is plotted in it.
_WIDE, _HIGH = 360, 170
_LEFT, _RIGHT, _TOP, _BOTTOM = 46, 352, 8, 132
#: Patterns of operations, another one each time that the colours come round.
_PATTERNS = ("plain", "hatch", "cross", "dots")
#: Numbers along the curve, at most.
_TICKS = 10


def key(plan: OperationPlan | OperationPlanEntry) -> str:
    """The name of a plan in names of arrays."""
    return plan.name.replace(" ", "_")


def operation_arrays(result: Judged) -> Arrays:
    """For each plan the operation of each sample, counted from 1, 0 is none; and where its tool leans."""
    operations, arrays = result.answers.operations, Arrays()
    for plan in operations.plans if operations else ():
        arrays[f"operation.{key(plan)}"] = Stored.of(_numbers(plan))
        arrays[f"operation_lean.{key(plan)}"] = Stored.of(turned_by(result.samples, plan.lean))
        if (share := shares(plan.lean)) is not None:
            arrays[f"operation_share.{key(plan)}"] = Stored.of(share)
    return arrays


def _numbers(plan: OperationPlan) -> Any:
    kind = np.uint8 if len(plan.operations) < 255 else np.uint16
    return (plan.label + 1).astype(kind)


def operations_of(result: Judged) -> dict[str, Any] | None:
    """Collect what the script needs of the operations beside the tables; None where they were not requested."""
    operations, entry = result.answers.operations, result.plan.operations
    if operations is None or entry is None:
        return None
    return {
        "plans": [
            {
                "key": key(mine),
                "name": each.name,
                "array": f"operation.{key(mine)}",
                "lean": f"operation_lean.{key(mine)}",
                "operations": [
                    _operation(result.plan, one, k, row)
                    for k, (one, row) in enumerate(zip(each.operations, _shown_at(mine, result.samples), strict=True))
                ],
            }
            for mine, each in zip(operations.plans, entry.plans, strict=True)
        ]
    }


def _operation(plan: Plan, entry: OperationEntry, number: int, row: int) -> dict[str, Any]:
    pattern = _PATTERNS[number // len(OPERATIONS) % len(_PATTERNS)]
    words = operation_text(plan, entry)
    return {
        "cutter": entry.cutter, "setup": entry.setup, "axis": entry.axis, "colour": operation_colour(number), "pattern": pattern,
        "label": entry.id, "turned": words.turned, "text": words.sentence, "sample": row,
    }  # fmt: skip


def _shown_at(plan: OperationPlan, samples: SurfaceSamples) -> list[int]:
    """A sample of each operation, where its tool is shown: amid its largest connected region.

    A region may be bent, so that its middle is no part of it: the sample next to the middle is taken.
    """
    label, edge = plan.label, samples.neighbours
    same = edge[label[edge[:, 0]] == label[edge[:, 1]]]
    graph = coo_array((np.ones(len(same), np.int8), tuple(same.T)), shape=(len(label), len(label)))
    piece = connected_components(graph, directed=False)[1]
    area, samples_shown = np.nan_to_num(samples.area), []
    for k in range(len(plan.operations)):
        rows = np.flatnonzero(label == k)
        size = np.bincount(piece[rows], area[rows])
        rows = rows[piece[rows] == size.argmax()] if size.any() else rows
        middle = samples.point[rows].mean(axis=0)
        samples_shown.append(int(rows[np.linalg.norm(samples.point[rows] - middle, axis=1).argmin()]))
    return samples_shown


class Curve(NamedTuple):
    """The curve as lines of a drawing, and what stands along its edges: (place, text)."""

    size: tuple[int, int]
    edges: tuple[int, int, int, int]
    line: str
    bounds: list[tuple[float, float, float]]
    across: list[tuple[float, str]]
    up: list[tuple[float, str]]


class OperationTables(NamedTuple):
    """These are what the template shows of the operations; `process`: the plan and the place in it of each one of the process."""

    lines: list[Line]
    plans: list[tuple[OperationPlanEntry, str, list[OperationText], bool]]
    steps: list[tuple[int, str, str]]
    curve: Curve | None
    process: dict[str, tuple[str, int]]


def tables(plan: Plan, story: Story) -> OperationTables | None:
    """Sentences, rows of tables and the curve; None where operations were not requested."""
    operations = plan.operations
    if operations is None:
        return None
    plans = [
        (
            each,
            key(each),
            [operation_text(plan, one) for one in each.operations],
            all(o.seconds is not None for o in each.operations),
        )
        for each in operations.plans
    ]
    steps = [(s.orientations, share_text(s.share), "" if s.at_most is None else bound(s.at_most)) for s in operations.curve]
    places = {
        one.id: (key(each), k)
        for each in operations.plans
        if plan.process is not None and each.name == plan.process.plan
        for k, one in enumerate(each.operations)
    }
    return OperationTables(of_the_whole(story.operations, story.in_short), plans, steps, curve(operations.curve), places)


def curve(steps: Sequence[CurveStepEntry]) -> Curve | None:
    """The step plot of the share by number of orientations; None where there is nothing to plot."""
    if not steps:
        return None
    first, last = steps[0].orientations, steps[-1].orientations
    wide = (_RIGHT - _LEFT) / (last - first + 1)

    def x(number: float) -> float:
        return round(_LEFT + wide * (number - first + 0.5), 2)

    def y(share: float) -> float:
        return round(_BOTTOM - (_BOTTOM - _TOP) * min(1.0, max(0.0, share)), 2)

    line, at = f"M{_LEFT} {_BOTTOM}", _LEFT * 1.0
    for step, after in zip(steps, [*steps[1:], None], strict=True):
        at = x(after.orientations - 0.5) if after else float(_RIGHT)
        line += f"V{y(step.share)}H{at}"
    bounds = [(x(s.orientations - 0.5), x(s.orientations + 0.5), y(s.at_most)) for s in steps if s.at_most is not None]
    stride = -(-(last - first + 1) // _TICKS)
    across = [(x(n), str(n)) for n in range(first, last + 1, stride)]
    up = [(y(share / 100.0), percent(share / 100.0)) for share in (0, 25, 50, 75, 100)]
    return Curve((_WIDE, _HIGH), (_LEFT, _RIGHT, _TOP, _BOTTOM), line, bounds, across, up)
