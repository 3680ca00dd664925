"""Check a plan before any tool is put down: files, samples, holes, labels, strategies, axes for motion."""

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from cad_io.arrays import Floats
from plan_cutters_check.bench import Contacts
from plan_cutters_check.findings import Finding, leaves
from plan_cutters_check.question import Question, ToolSizes
from plan_cutters_check.reckoned import DRILLED, FLOOR, REACHED, WALL, WORDS, Planned, Reckoned, Rows, suffix

_Arrays = dict[str, tuple[tuple[int, ...], str]]
#: Arrays of operations.npz that are of each plan, and those of samples.npz, of all and of each cutter: last axes and kinds.
_OF_PLAN: _Arrays = {
    "operation": ((), "i"), "strip_mm": ((), "f"), "path_mm": ((), "f"), "seconds": ((), "f"), "link_s": ((), "f"),
    "exclusive": ((), "b"), "lean": ((3,), "f"), "strategy": ((), "u"), "contact": ((3,), "f"), "moving_axis": ((3,), "f"),
    "moving_piece": ((), "i"),
}  # fmt: skip
_OF_SAMPLES: _Arrays = {"point": ((3,), "f"), "normal": ((3,), "f"), "direction_max": ((3,), "f"), "uv": ((2,), "f"),
                        "face": ((), "i"), "area": ((), "f"), "inside_bodies": ((), "b")}  # fmt: skip
_OF_CUTTERS: _Arrays = {"verdict": ((), "u"), "axis": ((3,), "f"), "lean": ((3,), "f"), "reason": ((), "u")}
#: Parts and lengths of unit vectors, and mm, that differ by less are one; shares by which areas of a face may.
_SAME, _SAME_MM, _SAME_AREA = 1e-6, 1e-5, 0.01
#: Arrays of operations.npz that are of the fewest orientations, which are not proved again.
_NOT_READ = {"candidate_cutter", "candidate_setup", "candidate_angle", "candidate_axis", "chosen"}


def faults(question: Question) -> Iterator[str]:
    """List what is wrong with the form of the files, a line each: nothing more can be checked then."""
    entry, samples, arrays = question.document["operations"], question.samples, question.operations
    if not isinstance(entry.get("plans"), list) or not entry["plans"]:
        yield "plan.json has no plans of operations"
        return
    if not all(isinstance(plan, dict) and isinstance(plan.get("name"), str) for plan in entry["plans"]):
        yield "plan.json has plans without a name"
        return
    n = len(samples.get("face", ()))
    if n != question.document["samples"]["count"]:
        yield f"samples.npz has {n} samples, and plan.json {question.document['samples']['count']}"
        return
    yield from _shaped("samples.npz", samples, _OF_SAMPLES, n)
    for cutter in question.document["cutters"]:
        yield from _shaped("samples.npz", samples, {f"{k}_{cutter['id']}": v for k, v in _OF_CUTTERS.items()}, n)
    every = _NOT_READ
    for k, plan in enumerate(entry["plans"]):
        mine = {f"{name}{suffix(k, plan['name'])}": form for name, form in _OF_PLAN.items()}
        every = every.union(mine)
        yield from _shaped("operations.npz", arrays, mine, n)
    if more := sorted({*arrays} - every):
        yield f"operations.npz has arrays that no plan has: {', '.join(more)}"
    for path, value in leaves(entry, "operations"):
        if isinstance(value, float) and not math.isfinite(value):
            yield f"plan.json: {path} is no finite number"


def _shaped(file: str, arrays: Any, wanted: _Arrays, count: int) -> Iterator[str]:
    for name, (last, kind) in wanted.items():
        array = arrays.get(name)
        if array is None:
            yield f"{file} has no array {name}"
        elif array.shape != (count, *last) or array.dtype.kind != kind:
            yield f"{file}: array {name} is {array.dtype} {array.shape}, not {(count, *last)} of the kind {kind}"


def findings(reckoned: Reckoned) -> Iterator[Finding]:
    """List what is wrong with the arrays, and what was looked at of the samples."""
    for name, (stated, there) in reckoned.question.checksums.items():
        if stated != there:
            words = f"its SHA-256 is {there[:12]}..., not {stated[:12]}..."
            yield Finding(False, f"{name} is not the file that plan.json names: {words}")
    yield from _samples(reckoned)
    yield from _holes(reckoned)
    for plan in reckoned.plans:
        yield from _labels(reckoned, plan)
        yield from _passes(reckoned, plan)
        yield from motion(plan)


def _samples(reckoned: Reckoned) -> Iterator[Finding]:
    """Samples lie on the exact surface, with its normal on the side of the tool, and stand for its area."""
    question, rows = reckoned.question, np.flatnonzero(reckoned.finished)
    samples, part = question.samples, question.part
    face, far, odd = samples["face"][rows], 0.0, 0
    if not len(rows) or not 1 <= face.min() <= face.max() <= len(part.faces):
        yield Finding(False, "The samples are of faces that the part does not have.")
        return
    area_off = ""
    for number in np.unique(face).tolist():
        mine = rows[face == number]
        point, normal, slope = question.surface(number, samples["uv"][mine])
        far = max(far, float(np.abs(point - samples["point"][mine]).max()))
        size = np.linalg.norm(np.cross(slope[:, 0], slope[:, 1]), axis=1)
        # Where the parameters meet in a point the kernel has no normal.
        known = size > 1e-9 * size.max(initial=0.0)
        off = np.abs(normal[known] - samples["normal"][mine][known]).max(axis=1) > _SAME
        trim = part.trim(number)
        beyond = np.zeros(len(mine), bool) if trim is None else ~trim.inside(*samples["uv"][mine].T)
        odd += int(off.sum() + beyond.sum())
        stands, whole = float(reckoned.area[mine].sum()), part.faces[number - 1].area
        judged = (samples["face"] == number).sum() == len(mine)
        low, high = (1.0 - _SAME_AREA) * whole - _SAME, (1.0 + _SAME_AREA) * whole + _SAME
        if stands > high or (judged and stands < low):
            area_off = f" The samples of F{number} stand for {stands:.6g} mm2 of its {whole:.6g}."
    direction = samples["direction_max"][rows]
    odd += int((np.abs((direction * samples["normal"][rows]).sum(axis=1)) > _SAME).sum())
    words = f"{len(rows)} samples lie on the kernel's surface, the farthest {far:.2g} mm away; {odd} have another normal"
    yield Finding(far <= _SAME_MM and not odd and not area_off, f"{words} than it or lie beyond its border.{area_off}")


def _holes(reckoned: Reckoned) -> Iterator[Finding]:
    """Samples are for drills where they lie on the faces of holes that are narrow enough, and nowhere else."""
    document, samples, drilled = reckoned.question.document, reckoned.question.samples, reckoned.drilled
    holes = document.get("holes", [])
    if not holes and not drilled.any():
        return
    on = np.isin(samples["face"], [int(name[1:]) for hole in holes for name in hole["faces"]])
    due = on & ~reckoned.unjudged & ~samples["inside_bodies"]
    below = document["effective"].get("drill_below_mm", 0.0)
    wide, wrong = sum(hole["diameter_mm"] >= below for hole in holes), int((due != drilled).sum())
    words = f"{len(holes)} holes are for drills, {wide} of them no narrower than {below:g} mm; {wrong} samples are otherwise."
    yield Finding(not wide and not wrong, words)


def _labels(reckoned: Reckoned, plan: Planned) -> Iterator[Finding]:
    """Samples go with operations that there are, and only those that are finished."""
    label = plan.label
    bad = (label < -1) | (label >= len(plan.operations)) | ((label >= 0) & ~reckoned.finished)
    bad |= (label < 0) & (np.isfinite(plan["lean"]).any(axis=1) | plan["exclusive"])
    if bad.any():
        words = f"{int(bad.sum())} of {len(label)} samples go with operations that there are not, or with none, though they"
        yield Finding(False, f"{plan}: {words} are reached.")


def _passes(reckoned: Reckoned, plan: Planned) -> Iterator[Finding]:
    """Strategies are known, contacts elsewhere than at the sample are of fixed operations, strips no wider than their tool."""
    label, strategy, strip, widest = plan.label, plan["strategy"], plan["strip_mm"], np.zeros(len(plan.label))
    known, fixed = np.isfinite(plan["contact"]).all(axis=1), np.zeros(len(label), bool)
    for i, each in enumerate(plan.operations):
        tool = reckoned.question.tools[each["cutter"]]
        fixed[label == i] = each["axis"] is not None
        widest[label == i] = 2.0 * tool.radius
        widest[(label == i) & (strategy == WALL)] = tool.flutes / math.cos(tool.taper)
    wrong = (strategy > WALL) | (((strategy > 0) | known) & ~fixed)
    wrong |= ((strategy == WALL) & ~known) | ((strategy == FLOOR) & known)
    wrong |= np.isfinite(plan["contact"]).any(axis=1) != known
    wrong |= np.isfinite(plan["path_mm"]) & ~np.isfinite(strip)
    wrong |= np.isfinite(strip) & ~((strip > 0.0) & (strip <= widest * (1.0 + _SAME)))
    if wrong.any():
        words = f"{int(wrong.sum())} samples have a strategy that cannot be, a contact without one, or no strip of their tool."
        yield Finding(False, f"{plan}: {words}")


def contacts_at(question: Question, plan: Planned, each: Mapping[str, Any], rows: Rows, axis: Floats) -> Contacts:
    """Where the tool of an operation of a plan touches as it cuts samples (m,), with axes (m, 3): on walls as is written."""
    point, normal = question.samples["point"][rows].copy(), question.samples["normal"][rows].copy()
    if each["mode"] != "fixed":
        # The posture that was found may touch elsewhere than at the sample; other axes touch there.
        same = (np.abs(axis - question.samples[f"axis_{each['cutter']}"][rows]) <= _SAME).all(axis=1)
        point[same] += question.shift(each["cutter"])[rows[same]]
    tilt_direction = plan["lean"][rows].copy()
    written = np.isfinite(plan["contact"][rows]).all(axis=1)
    point[written] = plan["contact"][rows[written]]
    mine = plan["strategy"][rows] == WALL
    normal[mine], tilt_direction[mine] = _flutes(question.tools[each["cutter"]], normal[mine], axis[mine])
    return Contacts(point, normal, tilt_direction)


def _flutes(sizes: ToolSizes, normal: Floats, axis: Floats) -> tuple[Floats, Floats]:
    """The normals (m, 3) of flutes along faces with normals (m, 3), and the directions in which the tool leans from them."""
    across = normal - (normal * axis).sum(axis=1)[:, None] * axis
    across = across / np.maximum(np.linalg.norm(across, axis=1), 1e-300)[:, None]
    c, s = math.cos(sizes.taper), math.sin(sizes.taper)
    own = c * across + s * axis
    return own, (axis - s * own) / c


def motion(plan: Planned) -> Iterator[Finding]:
    """Images of each other are of one cutter, setup and mode; axes for motion are unit vectors, of simultaneous operations."""
    label, axis, piece, operations = plan.label, plan["moving_axis"], plan["moving_piece"], plan.operations
    kinds: dict[int, set[Any]] = {}
    for each in (each for each in operations if each.get("orbit") is not None):
        kinds.setdefault(each["orbit"], set()).add((each["cutter"], each["setup"], each["mode"]))
    for orbit in (orbit for orbit, some in kinds.items() if len(some) > 1):
        yield Finding(False, f"{plan}: the operations of orbit {orbit} are no images of each other.")
    if any(each["mode"] == "fixed" and each["turning"] is not None for each in operations):
        yield Finding(False, f"{plan}: the axis of a fixed operation turns.")
    moving = [i for i, each in enumerate(operations) if each["mode"] != "fixed"]
    proved = [i for i in moving if (operations[i]["turning"] or {}).get("pieces_mm2")]
    known, unit = ~np.isnan(axis).all(axis=1), np.abs(np.linalg.norm(axis, axis=1) - 1.0) <= _SAME
    wrong = (known & ~(np.isin(label, moving) & unit)) | ((piece >= 0) & ~(known & np.isin(label, proved))) | (piece < -1)
    if wrong.any():
        words = f"{int(wrong.sum())} of {int(known.sum())} axes for simultaneous motion are no axes, or of no such operation."
        yield Finding(False, f"{plan}: {words}")


def unsound(reckoned: Reckoned) -> Iterator[Finding]:
    """List what no plan has: words that cannot be made, verdicts that contradict their axes, a chord error that nothing has."""
    document = reckoned.question.document
    if reckoned.question.odd:
        yield Finding(False, f"plan.json: {reckoned.question.odd}.")
    for name, verdict in reckoned.verdict.items():
        axis, reached = reckoned.question.samples[f"axis_{name}"], np.isin(verdict, REACHED)
        with np.errstate(invalid="ignore"):
            unit = np.abs(np.linalg.norm(axis, axis=1) - 1.0) <= _SAME
        wrong = int((reached != unit).sum()) + int((~np.isin(verdict, [*WORDS.values(), DRILLED])).sum())
        if wrong:
            words = f"samples.npz: {wrong} verdicts of {name} have no tool axis with which they are reached, or no meaning."
            yield Finding(False, words)
    errors = [each["chord_error_mm"] or 0.0 for each in (*document["faces"], *document["fixtures"])]
    if document["effective"]["chord_error_mm"] > max(errors) + 1e-12:
        yield Finding(False, "effective.chord_error_mm is larger than that of each face and fixture.")
