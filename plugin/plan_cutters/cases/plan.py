"""The test cases of a plan: one for the process, and one for each target face and cutter.

The file agrees with the exit code of the command: a case fails only where that is 1, and is an error only where it is 1 or 4.
"""

from plan_cutters.cases.files import Case, Outcome
from plan_cutters.domain.figures import count, listed, mm, percent, place
from plan_cutters.plan_file.model import CutterEntry, FaceEntry, Plan, WitnessEntry
from plan_cutters.plan_file.operations import UNJUDGED_CAUSE
from plan_cutters.plan_file.reasons import reason
from plan_cutters.plan_file.shares import FaceVerdicts, by_share, unreached
from plan_cutters.plan_file.words.cutters import called, main_reason
from plan_cutters.plan_file.words.names import short_names

#: Name of the case that is about all steps together.
PROCESS = "process"
_FINISHED, _NOT_FINISHED = 0, 1
#: Cutters that are named of those that reach a face.
_NAMED = 3
#: What the exit code says of the process; every other code is an error.
_OUTCOMES: dict[int, Outcome] = {0: "passed", 1: "failure", 4: "error"}


def plan_cases(plan: Plan, code: int, file: str) -> list[Case]:
    """Make the cases of a plan: the process first, then faces in their order, each with the cutters in theirs.

    `code` is the exit code that the plan asks for; `file` the part's, as it was given.
    """
    names = short_names(plan)
    left = [each for each in plan.process.left if each.cause != UNJUDGED_CAUSE]
    open_faces = {face for each in left for face in each.faces}
    # Grouped once: a part may have thousands of faces, and a cutter as many witnesses.
    places: dict[tuple[str, str], list[WitnessEntry]] = {}
    for cutter in plan.cutters:
        for each in cutter.witnesses:
            if not each.inside_bodies:
                places.setdefault((cutter.id, each.face), []).append(each)
    # All steps together: what the exit code is about.
    outcome = _OUTCOMES.get(code, "error")
    kind = {"failure": "not_finished", "error": "not_sure"}.get(outcome, "")
    cases = [Case(file, PROCESS, outcome, kind, plan.text.headline, "\n".join(plan.text.lines), plan.run.total)]
    for face in plan.faces:
        if not face.target:
            continue
        whole = [names[c.id] for c in plan.cutters if _whole(face, c.faces.get(face.id))]
        finished = f"reached by {listed(whole, _NAMED)}" if whole else ""
        if not whole and face.id not in open_faces:
            finished = "finished by several steps together"
        for cutter in plan.cutters:
            case = _case(plan, face, cutter, Case(file, f"{face.id} {names[cutter.id]}"), finished)
            worst = sorted(places.get((cutter.id, face.id), []), key=lambda w: -(w.depth_mm or 0.0))[:_NAMED]
            cases.append(case if case.outcome == "passed" else case._replace(details="\n".join(map(_witness, worst))))
    # What `--fail-under` lets pass neither fails nor is an error: as the exit code has it.
    passes = {"failure": code != _NOT_FINISHED, "error": code == _FINISHED}
    return [case._replace(outcome="skipped") if passes.get(case.outcome) else case for case in cases]


def _witness(w: WitnessEntry) -> str:
    way = f", {called(w.obstacle_face)} in the way" if w.obstacle_face else ""
    deep = f", {mm(w.depth_mm)} deep in the tool" if w.depth_mm is not None else ""
    return f"at {place(w.point)}: {reason(w.reason)}{way}{deep}"


def _case(plan: Plan, face: FaceEntry, cutter: CutterEntry, case: Case, finished: str) -> Case:
    """The case with its outcome; `finished`: who finishes the face, empty where nobody does."""
    verdicts = cutter.faces.get(face.id, FaceVerdicts())
    if not verdicts.required and verdicts.drilled:
        return case._replace(outcome="skipped", message=f"{face.id} is in a hole for a drill, which no mill has to reach")
    if not verdicts.required and (verdicts.inside_bodies or verdicts.exempt):
        where = "lies inside other bodies of the part" if verdicts.inside_bodies else "is at sharp inside edges, and not required"
        return case._replace(outcome="skipped", message=f"all of {face.id} {where}")
    doubt = ""
    if plan.missing:
        doubt = f"{count(len(plan.missing), 'obstacle')} {'is' if len(plan.missing) == 1 else 'are'} missing or guessed"
    elif not cutter.seen and plan.effective.sampled_by == "default":
        doubt = "the samples are farther apart than the cutter's radius"
    if _whole(face, verdicts):
        doubtful = case._replace(outcome="error", kind="not_sure", message=f"{face.id} is reached, but {doubt}")
        return doubtful if doubt else case
    text = _text(face, cutter, verdicts)
    kind = main_reason(verdicts.area_share) or ("unjudged" if not verdicts.not_reached else "undecided")
    case = case._replace(kind=kind, message=text)
    if not verdicts.not_reached:
        return case._replace(outcome="error")
    if finished:
        return case._replace(outcome="skipped", message=f"{text}; {finished}")
    return case._replace(outcome="failure" if verdicts.blocked else "error")


def _whole(face: FaceEntry, verdicts: FaceVerdicts | None) -> bool:
    """Whether every sample of the face is judged and reached, and all of the face was sampled."""
    if verdicts is None or face.unjudged:
        return False
    return verdicts.reached > 0 and not verdicts.not_reached and not verdicts.unjudged


def _text(face: FaceEntry, cutter: CutterEntry, verdicts: FaceVerdicts) -> str:
    """One line on a face that a cutter does not reach whole, or not for sure."""
    share = verdicts.area_share
    unjudged = face.unjudged or (f"{count(verdicts.unjudged, 'sample')} could not be judged" if verdicts.unjudged else "")
    if not verdicts.required:
        return f"{face.id} could not be judged: {unjudged or 'it has no sample'}"
    if not verdicts.not_reached:
        return f"not all of {face.id} could be judged: {unjudged}"
    alone = len(share.lost_by) == 1 and not verdicts.reached
    why = ", ".join(f"{reason(code)} {percent(part, some=True, whole=alone)}" for code, part in by_share(share.lost_by))
    what = "is not reached" if verdicts.blocked else "is undecided"
    text = f"{unreached(verdicts, share)} of {face.id} {what}: {why or 'no reason is known'}"
    return f"{text}; {unjudged}" if unjudged else text
