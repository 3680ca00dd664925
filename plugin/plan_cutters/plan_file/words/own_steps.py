"""Steps of the planner's own, and what is wrong with them, in words."""

from collections.abc import Iterator, Mapping, Sequence

from plan_cutters.domain.figures import area, count, listed
from plan_cutters.plan_file.operations import OTHER_ORIENTATION, ProcessEntry, ProcessStep
from plan_cutters.plan_file.reasons import reason

#: Steps of the planner's own whose faults are listed, and faces that are named of one.
_OWN_STEPS, _FACES = 3, 3
#: A step that leaves less of what it is asked does all, as a share: crumbs at borders are no fault.
_MINOR = 0.001


def angles_text(angles: Mapping[str, float], by: Mapping[str, float] | None = None) -> str:
    """Rotary axes with their angles, and by how much some turn from one time to the next.

    >>> angles_text({"C": 0.0, "A": 12.5}, {"C": 36.0})
    'C 0 + 36 A 12.5'
    """
    return " ".join(f"{name} {angle:g}" + (f" + {by[name]:g}" if by and name in by else "") for name, angle in angles.items())


def own_steps(process: ProcessEntry) -> Iterator[str]:
    """Sentences on the planner's own steps, first which they are, then what is wrong with each; none where all were planned."""
    own = {k: step for k, step in enumerate(process.steps, 1) if step.own is not None}
    if not own:
        return
    planned = len(process.steps) - len(own)
    mine = f"Step {min(own)} is" if len(own) == 1 else f"Steps {min(own)} to {max(own)} are"
    behind = f"; behind {'it' if len(own) == 1 else 'them'} {count(planned, 'step')} planned" if planned else ""
    yield f"{mine if planned else 'All steps are'} yours{behind}."
    yield from (text for k, step in own.items() if (text := fault(k, step)))


def shortened(sentences: Sequence[str]) -> list[str]:
    """The first of the sentences on the planner's own steps, and how many more there are.

    >>> shortened(["Steps 1 to 5 are yours.", *(f"Step {k} leaves 3 mm²." for k in range(1, 6))])[3:]
    ['Step 3 leaves 3 mm².', '2 more steps of yours leave something: the review page and plan.json say what.']
    """
    rest = len(sentences) - _OWN_STEPS - 1
    more = [f"{count(rest, 'more step')} of yours leave something: the review page and plan.json say what."] if rest > 0 else []
    return [*sentences[: _OWN_STEPS + 1], *more]


def fault(number: int, step: ProcessStep) -> str:
    """Say what is wrong with a step; empty where it does what it is asked, and where it was planned."""
    own = step.own
    if own is None:
        return ""
    near = "" if own.nearest is None else f": {angles_text(own.nearest.angles_deg)} would take {area(own.nearest.area_mm2)}"
    if own.wrong:
        return f"Step {number}: {own.wrong}{near}."
    left = sum(each.area_mm2 for each in own.leaves)
    if left > _MINOR * own.asked_mm2:
        worst = own.leaves[0]
        cause = "it needs another orientation" if worst.cause == OTHER_ORIENTATION else reason(worst.cause)
        return f"Step {number} leaves {area(left)} of {area(own.asked_mm2)}, {listed(worst.faces, _FACES)}: {cause}{near}."
    if step.area_mm2 <= 0.0 and own.asked_mm2 > 0.0 and step.take == "share":
        return f"Step {number} does nothing: steps that share its faces are quicker."
    if step.area_mm2 <= 0.0:
        return (
            f"Step {number} finds nothing left to do."
            if own.asked_mm2 <= 0.0
            else f"Step {number} reaches nothing that is left{near}."
        )
    return ""
