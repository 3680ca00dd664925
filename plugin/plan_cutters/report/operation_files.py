"""The plan of operations as files: `operations.npz` and `operations.csv`."""

import csv
from pathlib import Path
from typing import Any

import numpy as np

from plan_cutters.outcome import OperationPlan
from plan_cutters.report.protocol import Judged
from plan_cutters.report.to_npz import write_arrays


def write_operations(result: Judged, _split: object, path: Path) -> None:
    """Write `operations.npz`: of each plan what each sample goes with, and the candidates that the proof is about.

    Of the first plan, and of others with `_` and their name behind the words: `operation` (n,) int16, an index into its
    operations, -1 for none; `strip_mm`, the width of a pass; `seconds`, nan without a feed; `exclusive`, that no other operation
    serves it; `lean` (n, 3), where the tool leans, on a floor the side of its bottom that touches; `strategy`, 0: in a point,
    1: on a floor, 2: along a wall; `contact` (n, 3), where the tool touches as it cuts a sample of a wall, else nan;
    `moving_axis` (n, 3), the axes proposed for simultaneous operations, else nan, and `moving_piece`, the proved piece of the
    operation about the sample, the largest first, -1 for none.
    `candidate_cutter` and `candidate_setup` (m,) are indices into the plan's cutters and setups, `candidate_angle` (m, 2) is in
    degrees; beside a process of the planner's own there are none.
    """
    operations = result.answers.operations
    assert operations is not None, "written where operations were requested"
    ids, columns = [entry.id for entry in result.cutters], operations.candidates
    number = np.array([ids.index(cutter.id) for cutter in operations.cutters], np.int32)
    arrays: dict[str, Any] = {
        "candidate_cutter": number[columns.cutter],
        "candidate_setup": columns.setup,
        "candidate_angle": columns.angle,
        "candidate_axis": columns.axis,
        "chosen": operations.chosen,
    }
    for k, plan in enumerate(operations.plans):
        behind = f"_{plan.name.replace(' ', '_')}" if k else ""
        arrays |= {f"{word}{behind}": each for word, each in _columns(plan).items()}
    write_arrays(arrays, path)


def _columns(plan: OperationPlan) -> dict[str, Any]:
    axis, piece = np.full((len(plan.label), 3), np.nan), np.full(len(plan.label), -1, np.int32)
    for each in plan.operations:
        if each.moving is not None:
            axis[each.rows], piece[each.rows] = (mine[each.rows] for mine in each.moving)
    return {
        "operation": plan.label.astype(np.int16),
        "strip_mm": plan.strip,
        "seconds": plan.seconds,
        "exclusive": plan.alone,
        "lean": plan.lean,
        "strategy": plan.strategy,
        "contact": plan.contact,
        "moving_axis": axis,
        "moving_piece": piece,
    }


def write_operations_csv(result: Judged, _split: object, path: Path) -> None:
    """Write `operations.csv`: a header line, then a line for each operation of each plan; numbers have a point."""
    entry = result.plan.operations
    assert entry is not None, "written where operations were requested"
    first, second = entry.rotary
    with path.open("w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file, lineterminator="\r\n")
        rows.writerow(["plan", "operation", "mode", "strategy", "cutter", "setup", f"{first}_deg", f"{second}_deg",
                       "axis_x", "axis_y", "axis_z", "area_mm2", "share", "exclusive_mm2", "cut_length_mm", "seconds",
                       "faces"])  # fmt: skip
        for plan in entry.plans:
            for each in plan.operations:
                angles = each.angles_deg or {}
                axis = ("", "", "") if each.axis is None else [_rounded(x, 9) for x in each.axis]
                turned = (angles.get(first, ""), angles.get(second, ""))
                rows.writerow([plan.name, each.id, each.mode, each.strategy, each.cutter, each.setup + 1, *turned, *axis,
                               _rounded(each.area_mm2), _rounded(each.share, 6), _rounded(each.exclusive_mm2),
                               _rounded(each.cut_length_mm), _rounded(each.seconds),
                               " ".join(face.face for face in each.faces)])  # fmt: skip


def _rounded(value: float | None, digits: int = 3) -> float | str:
    """A number as people read it in a table: plan.json has all digits. Nothing is empty."""
    return "" if value is None else round(value, digits) + 0.0
