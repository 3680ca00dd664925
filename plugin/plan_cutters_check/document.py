"""Every number and word of plan.json outside `operations`: compared with what is reckoned anew, or listed as unchecked."""

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from plan_cutters_check.expected import Reckoned
from plan_cutters_check.findings import Finding
from plan_cutters_check.leaves import Between, Compared, compared
from plan_cutters_check.process import Process
from plan_cutters_check.question import Question
from plan_cutters_check.spoken import contradictions
from plan_cutters_check.verdicts import COUNTS, chosen, cutters, without_posture

#: What is not checked, and why, by paths; those that end in `**` with all that is under them. What is here may be checked where
#: more is known.
UNCHECKED = {
    **dict.fromkeys(
        ("text.**", "process.next**", "process.doubts**", "process.left[].needs", "process.exempt.needs",
         "process.left[].fits**", "process.left[].points**", "process.left[].helped**"),
        "the words, and what they advise, were not made again",
    ),
    **dict.fromkeys(("process.steps[].own**", "process.steps[].take"), "what other orientations would do is not looked for"),
    **dict.fromkeys(
        ("process.steps[].repeat", "process.steps[].repeat_deg**", "process.steps[].alone_mm2", "process.steps[].below_mm2",
         "process.steps[].angles_deg.*", "process.steps[].axis[]",
         "process.steps[].angles_deg", "process.steps[].axis"),
        "of repeated, simultaneous and own steps alone it does not follow from the files",
    ),
    "effective.**": "the command that checks does not say it",
    **dict.fromkeys(
        ("cutters[].axis_limit_with**", "cutters[].setups**", "cutters[].lost_in_all", "selected_for_setup",
         "cutters[].witnesses**", "cutters[].witnesses_untried", "cutters[].beyond_setup", "cutters[].area**",
         "cutters[].singular", "cutters[].travel**", "cutters[].least_stick_out**", "cutters[].mend**",
         "cutters[].march_differs", "cutters[].slack_mm", "cutters[].seen", "cutters[].touches_deg**", "cutters[].sources**",
         "cutters[].group", "cutters[].name", "cutters[].holder", "cutters[].flutes_mm", "inside_radii**", "sharp_edges**",
         "setups**", "setup_proposal**", "largest_radius**", "least_set**", "not_mended**", "selection**",
         "samples.max_gap_mm", "samples.convex", "samples.concave", "samples.saddle", "samples.regions",
         "inside_other_bodies.**", "missing**", "patterns**"),
        "it is no part of the operations",
    ),
    **dict.fromkeys(
        ("faces[].kind", "faces[].component", "faces[].carrier**", "faces[].neighbours**", "faces[].centre_mm**",
         "faces[].gap_mm",
         "faces[].chord_error_mm", "faces[].unjudged", "part.**", "libraries**", "machine.linear**",
         "machine.notes**", "machine.name", "machine.rotary[].**", "fixtures[].**"),
        "it describes the input",
    ),
    **dict.fromkeys(
        ("reasons[]", "reason_words.**", "legend**", "legend_words**", "units.**", "format", "format_version", "versions.**",
         "notes**", "note_codes**", "split**", "files**", "not_written**", "run**"),
        "it is about the program and its files",
    ),
}  # fmt: skip
#: The same of several setups.
_SEVERAL = {
    **UNCHECKED,
    **dict.fromkeys(
        ("cutters[].by_reason**", "cutters[].undecided_by_reason**", "cutters[].faces**", "cutters[].area_share**",
         "cutters[].feasible", "selected", "shown", *(f"cutters[].{word}" for word in COUNTS)),
        "the verdicts of each setup by itself are not written",
    ),
}  # fmt: skip


class Document:
    """The checks of what people read of a plan.

    Parameters
    ----------
    question : Question
    reckoned : Reckoned
    """

    def __init__(self, question: Question, reckoned: Reckoned) -> None:
        self.question, self.reckoned = question, reckoned
        self.document: dict[str, Any] = {name: each for name, each in question.document.items() if name != "operations"}

    def findings(self) -> Iterator[Finding]:
        """List what the words say otherwise than the records, and what no plan has."""
        if self.question.odd:
            yield Finding(False, f"plan.json: {self.question.odd}.")
        yield from without_posture(self.reckoned)
        wrong = [*contradictions(self.document)]
        text = f": {'; '.join(wrong[:3])}" if wrong else ""
        yield Finding(
            not wrong, f"The headline, the table of steps and shares were read; {len(wrong)} contradict the records{text}."
        )
        effective, faces = self.document["effective"], self.document["faces"]
        errors = [each["chord_error_mm"] or 0.0 for each in (*faces, *self.document["fixtures"])]
        if effective["chord_error_mm"] > max(errors) + 1e-12:
            yield Finding(False, "effective.chord_error_mm is larger than that of each face and fixture.")

    def entries(self) -> Compared:
        """Each entry compared with what is reckoned, or named."""
        listed = UNCHECKED if len(self.question.setups) == 1 else _SEVERAL
        return compared(_merged(self._entry(), self.question.stated), self.document, listed)

    def _entry(self) -> dict[str, Any]:
        question, reckoned, samples = self.question, self.reckoned, self.question.samples
        entries, face = cutters(reckoned), samples["face"]
        verdicts = [reckoned.verdict[name] for name in reckoned.ids]
        targets = {*question.document["effective"]["target_faces"]}
        inside = {*np.unique(face).tolist()} - {int(name[1:]) for name in targets}
        machine, judged = question.machine, [f for f in question.document["faces"] if f["target"]]
        others = [f for f in question.document["faces"] if not f["target"] and not f["ignored"]]
        return {
            "scope": {
                "judged": len(judged), "not_judged": len(others), "judged_mm2": _area(judged), "not_judged_mm2": _area(others),
                "judged_by_kind": Counter(f["kind"] for f in judged), "not_judged_by_kind": Counter(f["kind"] for f in others),
            },
            "machine": {
                "tilt_limit_deg": None if machine.tilt_limit >= math.pi else math.degrees(machine.tilt_limit),
                "rotary": [
                    {"name": name, "limits_deg": None if np.isinf(limits).any() else np.degrees(limits).tolist()}
                    for name, limits in zip(machine.names, machine.limits, strict=True)
                ] if question.document["machine"]["rotary"] else None,
            },
            "process": Process(reckoned).entry(),
            "cutters": entries,
            **chosen(question.document, entries),
            "samples": {
                "count": len(face), "unjudged": int(np.logical_and.reduce([each == 255 for each in verdicts]).sum()),
                "inside_bodies": int(samples["inside_bodies"].sum()), "exempt": int(samples.get("exempt", np.zeros(1)).sum()),
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


def _area(faces: Sequence[Mapping[str, Any]]) -> float:
    return math.fsum(each["area_mm2"] or 0.0 for each in faces)


def _merged(one: Any, other: Any) -> Any:
    """Two trees in one; where both say something, the first is taken."""
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        return {name: _merged(one[name], other[name]) if name in one and name in other else {**other, **one}[name]
                for name in [*one, *(each for each in other if each not in one)]}  # fmt: skip
    if isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        return [_merged(*pair) for pair in zip(one, other, strict=True)]
    return one
