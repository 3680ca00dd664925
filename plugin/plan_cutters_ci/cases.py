"""Test cases of a comparison: one whether two plans are comparable, and one for each face and cutter whose answer differs.

A case fails where something is lost, and is an error where plans are not comparable or cannot be read, as the exit
code of `diff` says.
"""

from collections.abc import Iterator

from plan_cutters.cases.case import Case
from plan_cutters_ci.model import Comparison, PlanDifference
from plan_cutters_ci.wording import CUTTERS, apart, called, cutter_rows, face_rows, headline

#: Name of the case that is about two plans as wholes.
COMPARABLE = "comparable"


def comparison_cases(comparison: Comparison) -> list[Case]:
    """The cases of all plans of two folders, or of two plans."""
    cases = [case for each in comparison.plans for case in difference_cases(each)]
    # Lines as the terminal has them, these first.
    gone = zip(comparison.only_old, apart(comparison), strict=False)
    cases += [Case(name, COMPARABLE, "failure", "gone", line.removeprefix(f"{name}: ")) for name, line in gone]
    cases += [Case(name, COMPARABLE) for name in comparison.only_new]
    return cases + [Case(line.partition(":")[0], COMPARABLE, "error", "unread", line) for line in comparison.unread]


def difference_cases(difference: PlanDifference) -> Iterator[Case]:
    """The cases of two plans: of those that are not comparable the reasons are all there is."""
    name = difference.name
    if not difference.comparable:
        yield Case(name, COMPARABLE, "error", "not_comparable", "; ".join(difference.why_not) or headline(difference))
        return
    yield Case(name, COMPARABLE)
    for face, (_, _, kind, area, was, now) in zip(difference.faces, face_rows(difference), strict=True):
        case = Case(name, f"face {called(face.old, face.new)}{f' {face.name}' if face.name else ''}")
        if not face.lost:
            yield case
            continue
        text = f"was {was}, now {now}" if face.was is not None else f"is new, and {now}"
        yield case._replace(outcome="failure", kind="lost", message=text, details=f"{kind}, {area}")
    for cutter, (_, what, was, now, faces, _, changed) in zip(difference.cutters, cutter_rows(difference), strict=True):
        case = Case(name, f"cutter {what}")
        if not cutter.lost:
            yield case
            continue
        more = [f"{CUTTERS[4]}: {faces}"] * bool(faces) + [f"changed: {changed}"] * bool(changed)
        yield case._replace(outcome="failure", kind="lost", message=f"was {was}, now {now}", details="\n".join(more))
