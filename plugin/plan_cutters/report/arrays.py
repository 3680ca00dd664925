"""Samples, verdicts and operations as arrays and a table, for anyone who wants to check a posture."""

import csv
import io
import json
import zipfile
from pathlib import Path
from typing import Any

import numpy as np

from plan_cutters.outcome import OperationPlan
from plan_cutters.report.protocol import Judged


def write_npz(result: Judged, _split: object, path: Path) -> None:
    """Write `samples.npz`: the samples, and per cutter verdict, axis, tilt_direction and reason with its id as suffix.

    `shift_ID`, where a flank or a flat that is not quite square serves, goes from the samples to where the tool is put down.

    Over several setups what one or another reaches, with the posture of the first that does: `setup_ID` is its index into
    `setups`, -1 where none does, and `reached_in_ID` says which do. `inside_bodies`: what is no surface of the finished part;
    `exempt`, where some is: what is not required at sharp inside edges.

    With a machine of rotary axes, also their positions at the posture found, in degrees: both solutions, axis by axis from the
    part to the tool, nan where one is beyond a limit, and which of them is to be taken, -1 where there is none. Where linear
    travel is judged, also the positions of the linear axes, mm, in the machine's order, for the solution to be taken. Where they
    were requested, also the largest radii with `flat` and `ball` as suffix.
    """
    samples = result.samples
    arrays = {
        "point": samples.point,
        "normal": samples.normal,
        "direction_max": samples.direction_max,
        "curvature": samples.curvature,
        "uv": samples.uv,
        "face": samples.face,
        "area": samples.area,
        "surface_class": result.surface_class,
        "inside_bodies": result.inside_bodies,
    }
    if result.exempt is not None:
        arrays["exempt"] = result.exempt
    for name, verdicts in result.reaches.items():
        arrays[f"verdict_{name}"] = verdicts.verdict
        arrays[f"axis_{name}"] = verdicts.axis
        arrays[f"lean_{name}"] = verdicts.tilt_direction
        arrays[f"reason_{name}"] = verdicts.reason
        if verdicts.shift.any():
            arrays[f"shift_{name}"] = verdicts.shift
        if result.kinematics is not None:
            angles, taken = result.rotary(name)
            if name in result.travels:
                arrays[f"travel_{name}"] = result.travels[name].position
            arrays[f"rotary_{name}"], arrays[f"rotary_taken_{name}"] = np.degrees(angles), taken
    if result.elsewhere:
        arrays["setups"] = np.array([result.scene.setup, *(axis for axis, _ in result.elsewhere)])
        for name, verdicts in result.here.items():
            each = [verdicts, *(verdicts_there[name] for _, verdicts_there in result.elsewhere)]
            arrays[f"setup_{name}"] = result.served_in[name]
            arrays[f"reached_in_{name}"] = np.stack([one.reached for one in each], axis=1)
    for radii in result.answers.radius_maps:
        arrays[f"radius_{radii.shape}"] = radii.radius
        arrays[f"radius_beyond_{radii.shape}"] = radii.beyond
        arrays[f"radius_axis_{radii.shape}"] = radii.axis
        arrays[f"radius_lean_{radii.shape}"] = radii.tilt_direction
    write_arrays(arrays, path)


def write_postures(result: Judged, _split: object, path: Path) -> None:
    """Write `postures.npz`: the free tilts of every sample at every rotation, as in PostureMaps, for the cutter shown.

    Whatever the machine: what one holds of them is for the reader to find. `missing`: obstacles that are missing or guessed.
    """
    maps = result.maps
    name = maps.cutter
    about = {"format": "plan-cutters-postures", "version": 3, "cutter": name, "part": maps.part, "tilt": maps.tilt,
             "tolerance": maps.tolerance, "missing": maps.missing, "unmapped": maps.unmapped}  # fmt: skip
    write_arrays({"about": np.array(json.dumps(about)), "rotation": maps.rotations, "normal": maps.normal,
            "direction_max": maps.direction_max, "inside": maps.inside, f"offset_{name}": maps.offset,
            f"free_{name}": maps.free, f"undecided_{name}": maps.undecided, f"verdict_{name}": maps.verdict,
            f"reason_{name}": maps.reason}, path)  # fmt: skip


def write_arrays(arrays: dict[str, Any], path: Path) -> None:
    # numpy's own writer stamps the time: two runs would differ.
    with zipfile.ZipFile(path, "w") as archive:
        for key, array in arrays.items():
            buffer = io.BytesIO()
            np.lib.format.write_array(buffer, np.ascontiguousarray(array), allow_pickle=False)
            archive.writestr(
                zipfile.ZipInfo(f"{key}.npy", (1980, 1, 1, 0, 0, 0)), buffer.getvalue(), zipfile.ZIP_DEFLATED, compresslevel=1
            )


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
        "path_mm": plan.length,
        "seconds": plan.seconds,
        "link_s": plan.link,
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
                       "link_seconds", "faces"])  # fmt: skip
        for plan in entry.plans:
            for each in plan.operations:
                angles = each.angles_deg or {}
                axis = ("", "", "") if each.axis is None else [_rounded(x, 9) for x in each.axis]
                turned = (angles.get(first, ""), angles.get(second, ""))
                rows.writerow([plan.name, each.id, each.mode, each.strategy, each.cutter, each.setup + 1, *turned, *axis,
                               _rounded(each.area_mm2), _rounded(each.share, 6), _rounded(each.exclusive_mm2),
                               _rounded(each.cut_length_mm), _rounded(each.seconds), _rounded(each.link_seconds),
                               " ".join(face.face for face in each.faces)])  # fmt: skip


def _rounded(value: float | None, digits: int = 3) -> float | str:
    """A number as people read it in a table: plan.json has all digits. Nothing is empty."""
    return "" if value is None else round(value, digits) + 0.0
