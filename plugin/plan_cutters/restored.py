"""The result of a plan in a folder: its arrays are read, and its part is prepared again, so that models can be made of it."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.tessellate.triangles import At
from plan_cutters.document.clock import Clock
from plan_cutters.document.process import OverSetups
from plan_cutters.domain.answers import RadiusMap
from plan_cutters.domain.operations import Columns
from plan_cutters.domain.travel import Travel
from plan_cutters.domain.verdicts import NO_REASON, Verdicts
from plan_cutters.errors import PlanError
from plan_cutters.files.arrays import Archive
from plan_cutters.options import cores
from plan_cutters.outcome import Answers, Operation, OperationPlan, Operations
from plan_cutters.pipeline import prepare
from plan_cutters.plan_file.model import Plan
from plan_cutters.plan_file.operations import OperationPlanEntry
from plan_cutters.report.folder import file_name, sha256
from plan_cutters.report.question import Question, read_question
from plan_cutters.result import Result
from plan_cutters.scene.conditions import rotations_of
from plan_cutters.scene.preparation import Prepared
from plan_cutters_base.stage_cache import NO_CACHE, StageCache

Arrays = Mapping[str, NDArray[Any]]
_AGAIN = "plan the part again"
#: Samples that are taken again lie where they lay, to this share of the part's size.
_SAME = 1e-7


def part_of(plan: Plan, folder: Path, named: Path | None = None) -> Path:
    """The file of a plan's part: the one that is `named`, else the one of its name here, in the folder or above that.

    A PlanError where there is none, or another one of its name.
    """
    name = plan.part.file
    if named is None and name is None:
        raise PlanError("its part came from a script: give a file of it with --part")
    places = [named] if named is not None else [place / str(name) for place in (Path(), folder, folder.absolute().parent)]
    there = [place for place in places if place.is_file()]
    if not there:
        looked = str(named) if named is not None else f"{name}, here or with the plan"
        raise PlanError(f"its part is gone ({looked}): give its file with --part")
    same = [place for place in there if plan.part.sha256 in (None, sha256(place))]
    if not same:
        raise PlanError(f"its part was changed since: the SHA-256 of {there[0]} is not {str(plan.part.sha256)[:12]}...; {_AGAIN}")
    return same[0]


def restored(
    plan: Plan, folder: Path, part: Path, clock: Clock, *, at: At = lambda whose, face: None, cache: StageCache | None = None
) -> Result:
    """The result of a plan as its folder has it.

    A CadIoError where the part cannot be read; a PlanError where the arrays are missing or not those of the plan, the part or a
    fixture has changed, or it was another version.
    """
    arrays = _arrays(plan, folder, "npz")
    question = read_question(arrays["question"]) if "question" in arrays else None
    if question is None:
        raise PlanError(f"made by another version, or of objects of a script: {_AGAIN}", file=file_name("npz"))
    ready = _prepared(plan, arrays, question, partial(prepare, part, clock=clock, at=at, cache=cache or NO_CACHE))
    over = _over_setups(plan, arrays, ready)
    travels = {
        each.id: Travel(
            arrays[f"travel_{each.id}"], arrays[f"rotary_taken_{each.id}"], np.zeros_like(arrays[f"travel_{each.id}"])
        )
        for each in plan.cutters
        if f"travel_{each.id}" in arrays
    }
    operations = _operations(plan, folder, ready) if plan.operations is not None else None
    return Result(plan, ready, over, travels, Answers(radius_maps=_radii(plan, arrays), operations=operations))


def _arrays(plan: Plan, folder: Path, form: str) -> dict[str, NDArray[Any]]:
    path, entry = folder / file_name(form), plan.files.get(form)
    if entry is None or not path.is_file():
        raise PlanError(f"not in {folder}, and models are made of it: {_AGAIN}", file=file_name(form))
    if sha256(path) != entry.sha256:
        raise PlanError(f"not the file that plan.json names: {_AGAIN}", file=file_name(form))
    with Archive(path, "arrays of a plan", PlanError) as archive:
        return {name: archive.read(name) for name in archive.headers}


def _prepared(plan: Plan, arrays: Arrays, question: Question, prepared: Callable[..., Prepared]) -> Prepared:
    ready = prepared(replace(question.options, jobs=cores()), excluded=question.excluded)
    ready = replace(ready, exempt=arrays.get("exempt"), inside_bodies=arrays["inside_bodies"])
    placed = [None if each.source is None else each.source.sha256 for each in ready.conditions.surroundings.fixtures]
    before = [each.sha256 for each in plan.fixtures if 0 in each.setups]
    if placed != before:
        raise PlanError(f"a file of its fixtures was changed since: {_AGAIN}")
    point, near = ready.samples.point, _SAME * max(1.0, float(np.linalg.norm(ready.scene.part.size)))
    same = arrays["point"].shape == point.shape and np.array_equal(arrays["face"], ready.samples.face)
    if not same or not np.allclose(arrays["point"], point, rtol=0.0, atol=near, equal_nan=True):
        raise PlanError(f"its samples are not those that this version takes: {_AGAIN}", file=file_name("npz"))
    return ready


def _over_setups(plan: Plan, arrays: Arrays, ready: Prepared) -> OverSetups:
    # In the order in which they were judged.
    ids = [name.removeprefix("verdict_") for name in arrays if name.startswith("verdict_")]
    if sorted(ids) != sorted(each.id for each in plan.cutters):
        raise PlanError(f"its cutters are not those of plan.json: {_AGAIN}", file=file_name("npz"))
    reaches = {name: _verdicts(arrays, name, ready) for name in ids}
    # What each setup reaches alone is no part of a model.
    each = tuple((axis, dict(reaches)) for axis, _ in ready.axes)
    served = {name: arrays[f"setup_{name}"] for name in ids} if len(each) > 1 else {}
    return OverSetups(reaches, served, each)


def _verdicts(arrays: Arrays, name: str, ready: Prepared) -> Verdicts:
    axis, tilted = (arrays[f"{word}_{name}"].astype(float) for word in ("axis", "lean"))
    samples, ends = ready.samples, ready.options.postures.rotations
    shift = arrays.get(f"shift_{name}", np.zeros_like(axis)).astype(float)
    across, along = np.linalg.norm(np.cross(samples.normal, axis), axis=1), (samples.normal * axis).sum(axis=1)
    turn = rotations_of(samples.normal, samples.direction_max, tilted)
    known = np.isfinite(turn)
    nearest = np.abs(np.angle(np.exp(1j * (np.where(known, turn, 0.0)[:, None] - ends)))).argmin(axis=1) if len(ends) else 0
    rotation = np.where(known, nearest, -1).astype(np.int32)
    return Verdicts(arrays[f"verdict_{name}"], axis, tilted, np.arctan2(across, along), rotation, shift, arrays[f"reason_{name}"])


def _radii(plan: Plan, arrays: Arrays) -> tuple[RadiusMap, ...]:
    made = []
    for each in plan.largest_radius:
        axis, tilted, radius, beyond = (arrays[f"radius_{word}{each.shape}"] for word in ("axis_", "lean_", "", "beyond_"))
        reason, tilt, rotation = (np.full(len(radius), none) for none in (np.uint8(NO_REASON), np.nan, np.int32(-1)))
        made.append(RadiusMap(each.shape, each.length_over_radius, each.step, each.least_mm, each.most_mm, radius, beyond,
                              reason, axis, tilted, tilt, rotation))  # fmt: skip
    return tuple(made)


def _operations(plan: Plan, folder: Path, ready: Prepared) -> Operations | None:
    """The operations as far as models show them; None where their arrays are not there."""
    entry = plan.operations
    assert entry is not None
    if "operations" not in plan.files:
        return None
    arrays = _arrays(plan, folder, "operations")
    plans = tuple(_plan(each, k, arrays, ready) for k, each in enumerate(entry.plans))
    columns = Columns(*(arrays[f"candidate_{word}"] for word in ("cutter", "setup", "axis", "angle")))
    return Operations(entry, ready.cutters, plans, columns, arrays["chosen"])


def _plan(entry: OperationPlanEntry, number: int, arrays: Arrays, ready: Prepared) -> OperationPlan:
    behind = f"_{entry.name.replace(' ', '_')}" if number else ""
    label, strip, length, seconds, alone, tilted, strategy, contact, link = (
        arrays[f"{word}{behind}"]
        for word in ("operation", "strip_mm", "path_mm", "seconds", "exclusive", "lean", "strategy", "contact", "link_s")
    )
    label, n = label.astype(np.int32), len(label)
    cutter = {each.id: each for each in ready.cutters}
    operations = tuple(
        Operation(each.id, each.mode, cutter[each.cutter], each.setup, None if each.axis is None else np.array(each.axis), None,
                  None, np.flatnonzero(label == k))
        for k, each in enumerate(entry.operations)
    )  # fmt: skip
    serves = np.zeros((n, len(operations)), bool)
    rows = np.flatnonzero(alone)
    serves[rows, label[rows]] = True
    none = np.full(n, -1, np.int32)
    return OperationPlan(entry.name, operations, label, serves, strip, length, seconds, none, tilted, strategy, contact, link,
                         float(np.nan), float(np.nan), float(np.nan), np.empty(0, np.int64))  # fmt: skip
