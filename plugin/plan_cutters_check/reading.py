"""Are the files of a plan what they must be, before anything is looked at?"""

import math
from collections.abc import Iterator
from typing import Any

from plan_cutters_check.question import Question

#: Arrays of operations.npz that are of each plan, of samples and of candidates: their last axes, and kinds.
_OF_PLAN = {"operation": ((), "i"), "strip_mm": ((), "f"), "path_mm": ((), "f"), "seconds": ((), "f"), "link_s": ((), "f"),
            "exclusive": ((), "b"), "lean": ((3,), "f"), "strategy": ((), "u"), "contact": ((3,), "f"),
            "moving_axis": ((3,), "f"), "moving_piece": ((), "i")}  # fmt: skip
_OF_CANDIDATES = {
    "candidate_cutter": ((), "i"),
    "candidate_setup": ((), "i"),
    "candidate_angle": ((2,), "f"),
    "candidate_axis": ((3,), "f"),
}
_OF_SAMPLES = {"point": ((3,), "f"), "normal": ((3,), "f"), "direction_max": ((3,), "f"), "uv": ((2,), "f"), "face": ((), "i"),
               "area": ((), "f"), "inside_bodies": ((), "b")}  # fmt: skip
_OF_CUTTERS = {"verdict": ((), "u"), "axis": ((3,), "f"), "lean": ((3,), "f"), "reason": ((), "u")}


def suffix(index: int, name: str) -> str:
    """Give the end of the names of a plan's arrays: nothing for the first plan."""
    return f"_{name.replace(' ', '_')}" if index else ""


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
    m = len(arrays.get("candidate_cutter", ()))
    yield from _shaped("operations.npz", arrays, _OF_CANDIDATES, m)
    yield from _shaped("operations.npz", arrays, {"chosen": ((), "i")}, len(arrays.get("chosen", ())))
    for k, plan in enumerate(entry["plans"]):
        yield from _shaped("operations.npz", arrays, {f"{a}{suffix(k, plan['name'])}": b for a, b in _OF_PLAN.items()}, n)
    every = {f"{name}{suffix(k, plan['name'])}" for k, plan in enumerate(entry["plans"]) for name in _OF_PLAN} | {
        *_OF_CANDIDATES,
        "chosen",
    }
    if more := sorted({*arrays} - every):
        yield f"operations.npz has arrays that no plan has: {', '.join(more)}"
    yield from (f"plan.json: {path} is no finite number" for path in _not_finite(entry, "operations"))


def _shaped(file: str, arrays: Any, wanted: dict[str, tuple[tuple[int, ...], str]], count: int) -> Iterator[str]:
    for name, (last, kind) in wanted.items():
        array = arrays.get(name)
        if array is None:
            yield f"{file} has no array {name}"
        elif array.shape != (count, *last) or array.dtype.kind != kind:
            yield f"{file}: array {name} is {array.dtype} {array.shape}, not {(count, *last)} of the kind {kind}"


def _not_finite(value: Any, path: str) -> Iterator[str]:
    if isinstance(value, dict):
        for name, each in value.items():
            yield from _not_finite(each, f"{path}.{name}")
    elif isinstance(value, list):
        for k, each in enumerate(value):
            yield from _not_finite(each, f"{path}[{k}]")
    elif isinstance(value, float) and not math.isfinite(value):
        yield path
