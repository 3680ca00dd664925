"""The plan of operations for the page: which sample goes with which operation, their looks and their tables."""

from typing import Any, NamedTuple

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from cad_io.arrays import SurfaceSamples
from plan_cutters.outcome import OperationPlan
from plan_cutters.plan_file.model import Plan
from plan_cutters.plan_file.operations import OperationEntry, OperationPlanEntry
from plan_cutters.plan_file.palette import OPERATIONS, operation_colour
from plan_cutters.plan_file.words.line import Line
from plan_cutters.plan_file.words.operations import OperationText, of_the_whole, operation_text
from plan_cutters.plan_file.words.story import Story
from plan_cutters.report.page.arrays import Arrays
from plan_cutters.report.page.encode import Stored
from plan_cutters.report.page.facts import shares, turned_by
from plan_cutters.report.protocol import Judged

#: Patterns of operations, another one each time that the colours come round.
_PATTERNS = ("plain", "hatch", "cross", "dots")


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


class OperationTables(NamedTuple):
    """These are what the template shows of the operations; `process`: the plan and the place in it of each one of the process."""

    lines: list[Line]
    plans: list[tuple[OperationPlanEntry, str, list[OperationText], bool]]
    process: dict[str, tuple[str, int]]


def tables(plan: Plan, story: Story) -> OperationTables | None:
    """Sentences and rows of tables; None where operations were not requested."""
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
    places = {
        one.id: (key(each), k)
        for each in operations.plans
        if plan.process is not None and each.name == plan.process.plan
        for k, one in enumerate(each.operations)
    }
    return OperationTables(of_the_whole(story.operations, story.in_short), plans, places)
