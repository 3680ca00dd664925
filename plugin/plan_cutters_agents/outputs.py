"""Entries of answers that are made of what commands list, and of arrays beside a plan: tools, machines, postures, a sample."""

import json
import math
from pathlib import Path

from plan_cutters.plan_file.model import Plan
from plan_cutters.plan_file.reasons import INTERVALS
from plan_cutters_agents.access import CallError, Permissions
from plan_cutters_agents.plan_answers import Entry
from plan_cutters_agents.requests import ExplainQuestion

#: Digits behind the point, deg.
_DIGITS = 3


def tools_in(output: bytes) -> tuple[list[Entry], list[str]]:
    """The tools in the output of the command `tools`, and a line for each that cannot be judged."""
    tools, unused = [], []
    for library in json.loads(output)["libraries"]:
        tools += [
            {"id": each["id"], "name": next(iter(each["names"]), ""), "number": next(iter(each["numbers"]), None),
             "kind": each["shape"], "diameter_mm": 2.0 * each["radius"], "corner_radius_mm": each["corner_radius"],
             "stickout_mm": each["length"], "holder": (each["holder"] or {}).get("name", "")}
            for each in library["cutters"]
        ]  # fmt: skip
        unused += [f"{each['place']}: {each['unused']}" for each in library["entries"] if each["unused"]]
    return tools, unused


def built_in_tools() -> list[Entry]:
    """The tools that are judged where none are named."""
    from plan_cutters.domain.standard_tools import builtin
    from plan_cutters.plan_file.words.names import kind

    return [
        {"id": each.id, "name": each.name, "number": None, "kind": kind(each), "diameter_mm": 2.0 * each.radius,
         "corner_radius_mm": each.corner_radius, "stickout_mm": each.length, "holder": ""}
        for each in builtin()
    ]  # fmt: skip


def machines_in(output: bytes) -> list[Entry]:
    """The machines in the output of the command `machines`: axes from the tool to the part, the share of all directions held."""
    return [
        {"name": each["given"],
         "axes": [axis["axis"] for chain in ("tool_chain", "part_chain") for axis in each["machine"].get(chain, [])],
         "reaches": each["share_of_directions"]}
        for each in json.loads(output)["machines"]
    ]  # fmt: skip


def postures_of(output: bytes) -> Entry:
    """The postures in the output of the command `map`: shares of those that were searched, and a row for each rotation."""
    answer = json.loads(output)
    rows, tilt = answer["rotations"], answer["tilt_deg"]
    unit = 10**_DIGITS
    wide = max(1e-12, (tilt[1] - tilt[0]) * len(rows))

    def share(word: str) -> float:
        return sum(high - low for row in rows for low, high in row[word]) / wide

    least = [tilt[1] if (at := row["local_gouge"]) is None else min(max(at, tilt[0]), tilt[1]) for row in rows]
    forbidden = {"local_gouge": sum(at - tilt[0] for at in least) / wide, **{word: share(word) for word in INTERVALS}}
    return {
        **{name: answer[name] for name in ("point", "face", "off_mm", "normal", "direction_max", "certified")},
        "free_share": min(1.0, share("free")),
        "undecided_share": min(1.0, share("undecided")),
        "forbidden": {word: min(1.0, part) for word, part in forbidden.items() if part > 0.0},
        "rotations": [
            {
                "deg": round(row["deg"], _DIGITS),
                # None wider than it is: those too narrow for the digits are left out.
                "free": [
                    [inner, outer]
                    for low, high in row["free"]
                    if (inner := math.ceil(low * unit) / unit) <= (outer := math.floor(high * unit) / unit)
                ],
                "undecided": _rounded(row["undecided"]),
                "local_gouge_below": row["local_gouge"],
                "forbidden": {word: _rounded(row[word]) for word in INTERVALS if row[word]},
            }
            for row in rows
        ],
        "missing": len(answer["missing"]),
        **{name: answer[name] for name in ("flank_axis", "under_flat_mm")},
    }


def _rounded(intervals: list[list[float]]) -> list[list[float]]:
    return [[round(low, _DIGITS), round(high, _DIGITS)] for low, high in intervals]


def nearest_sample(file: str, plan: Plan, cutter: str, question: ExplainQuestion, permissions: Permissions) -> Entry:
    """Look up the sample that is nearest to the point in question; a CallError where none is near enough, or no arrays are."""
    import numpy as np

    from plan_cutters.domain.verdicts import NO_REASON, WORDS
    from plan_cutters.files.arrays import Archive

    if "npz" not in plan.files:
        why = "has no samples.npz in its folder, so a point cannot be looked up: give a face, or plan with the format npz"
        raise CallError(why, file=file)
    npz = str(Path(file).parent / plan.files["npz"].name)
    with Archive(permissions.file(npz), "samples", CallError) as archive:
        names = ("point", "face", f"verdict_{cutter}", f"reason_{cutter}", f"axis_{cutter}")
        if any(name not in archive.headers for name in names):
            raise archive.fault(f"without {cutter}")
        points, faces, verdicts, reasons, axes = (archive.read(name) for name in names)
    shaped = points.ndim == 2 and points.shape[1:] == (3,) and len(points)
    if not shaped or any(len(a) != len(points) for a in (faces, verdicts, reasons, axes)):
        raise CallError("its arrays do not belong together: plan the part again", file=npz)
    off = np.linalg.norm(points - np.array(question.point), axis=1)
    row = int(np.nanargmin(off))
    most, face = max(question.within_mm, plan.samples.max_gap_mm or 0.0), f"F{int(faces[row])}"
    if not off[row] <= most:
        raise CallError(
            f"the nearest sample is {off[row]:.4g} mm from the point, on {face}; give a point within {most:.3g} mm "
            "of one, or a face",
            file=file,
        )
    code = int(reasons[row])
    return {
        "point": points[row].tolist(),
        "distance_mm": float(off[row]),
        "face": face,
        "verdict": WORDS.get(int(verdicts[row]), "unknown"),
        "reason": None if code == NO_REASON or code >= len(plan.reasons) else plan.reasons[code],
        "axis": axes[row].tolist() if np.isfinite(axes[row]).all() else None,
    }
