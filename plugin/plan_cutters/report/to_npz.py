"""Samples and verdicts as arrays, for anyone who wants to check a posture."""

import io
import json
import zipfile
from pathlib import Path
from typing import Any

import numpy as np

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
