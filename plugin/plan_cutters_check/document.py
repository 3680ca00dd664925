"""All that plan.json must say, record by record: what its files give, what the command says, and what the words are made of."""

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from plan_cutters_check.findings import Finding
from plan_cutters_check.leaves import Between, Exactly
from plan_cutters_check.operations import operations
from plan_cutters_check.process import Process
from plan_cutters_check.question import Question
from plan_cutters_check.reckoned import Reckoned
from plan_cutters_check.spoken import contradictions
from plan_cutters_check.verdicts import chosen, cutter, without_posture


def findings(question: Question, reckoned: Reckoned) -> Iterator[Finding]:
    """List what the words say otherwise than the records, and what no plan has."""
    document = question.document
    if question.odd:
        yield Finding(False, f"plan.json: {question.odd}.")
    yield from without_posture(reckoned)
    wrong = [*contradictions(document)]
    text = f": {'; '.join(wrong[:3])}" if wrong else ""
    yield Finding(not wrong, f"The headline, the table of steps and shares were read; {len(wrong)} contradict the records{text}.")
    errors = [each["chord_error_mm"] or 0.0 for each in (*document["faces"], *document["fixtures"])]
    if document["effective"]["chord_error_mm"] > max(errors) + 1e-12:
        yield Finding(False, "effective.chord_error_mm is larger than that of each face and fixture.")


def document_of(question: Question, reckoned: Reckoned) -> dict[str, Any]:
    """Reckon plan.json, as far as it follows from the files, the part and the command."""
    document, samples, machine, face = question.document, question.samples, question.machine, question.samples["face"]
    made, targets = [cutter(reckoned, name) for name in reckoned.ids], {*document["effective"]["target_faces"]}
    inside = {*np.unique(face).tolist()} - {int(name[1:]) for name in targets}
    sets = {
        "judged": [f for f in document["faces"] if f["target"]],
        "not_judged": [f for f in document["faces"] if not f["target"] and not f["ignored"]],
    }
    mine = {
        "operations": operations(reckoned),
        "scope": {
            **{name: len(some) for name, some in sets.items()},
            **{f"{name}_mm2": math.fsum(f["area_mm2"] or 0.0 for f in some) for name, some in sets.items()},
            **{f"{name}_by_kind": Exactly(Counter(f["kind"] for f in some)) for name, some in sets.items()},
        },
        "machine": {
            "tilt_limit_deg": None if machine.tilt_limit >= math.pi else math.degrees(machine.tilt_limit),
            "rotary": [
                {"name": name, "limits_deg": None if np.isinf(limits).any() else np.degrees(limits).tolist()}
                for name, limits in zip(machine.names, machine.limits, strict=True)
            ] if document["machine"]["rotary"] else None,
        },
        "process": Process(reckoned).entry(),
        "cutters": made,
        **chosen(document, made),
        "samples": {
            "count": len(face), "unjudged": int(reckoned.unjudged.sum()), "inside_bodies": int(samples["inside_bodies"].sum()),
            "exempt": int(reckoned.exempt.sum()),
        },
        "faces": [
            {
                "id": each.id, "name": each.name, "surface": each.surface, "shape": each.shape, "target": each.id in targets,
                "ignored": each.number in question.ignored, "samples": int((face == each.number).sum()),
                "area_mm2": each.area if np.isfinite(each.area) else None,
            }
            for each in question.part.faces
        ] if not inside else "faces whose samples were judged are targets",
        "part": {"faces": len(question.part.faces), "size_mm": [Between(s - 1e-6, s + 1e-6) for s in question.part.size]},
    }  # fmt: skip
    merged: dict[str, Any] = _merged(mine, question.stated)
    return merged


def _merged(one: Any, other: Any) -> Any:
    """Two trees in one; where both say something, the first is taken."""
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        both = {name: _merged(one[name], other[name]) for name in one if name in other}
        return type(one)({**one, **{name: other[name] for name in other if name not in one}, **both})  # type: ignore[call-arg]
    if isinstance(one, Sequence) and isinstance(other, list) and len(one) == len(other) and not isinstance(one, str):
        return [_merged(*pair) for pair in zip(one, other, strict=True)]
    return one
