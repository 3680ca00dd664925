"""Put the plan of operations into words, the worst first."""

from collections.abc import Iterator

from plan_cutters.document.model import Plan
from plan_cutters.document.operations import FewestEntry, OperationEntry, OperationPlanEntry, OperationsEntry
from plan_cutters.report.story.line import Line
from plan_cutters.report.story.names import named
from plan_cutters.report.story.numbers import some

#: Operations that are listed, and faces that are named of one.
_LISTED, _FACES = 12, 4
#: A share of the curve that is worth stopping at, and a share of the area for which an orientation is hardly worth its turn.
_KNEE, _LITTLE = 0.97, 0.005
#: A sample of this much cutting is told in minutes, s.
_MINUTES = 120.0


def operations(plan: Plan) -> list[Line]:
    """Lines about the operations, cutters called as everywhere; none where they were not asked for."""
    found = plan.operations
    if found is None:
        return []
    told = [
        *_rest(found),
        *_fewest(found),
        *(line for each in found.plans for line in _plan(found, each)),
        *found.notes,
    ]
    return [Line(named(plan, text)) for text in told]


def _rest(found: OperationsEntry) -> Iterator[str]:
    rest = found.plans[0].rest
    if rest.samples:
        yield f"No operation finishes {some(rest.share)} of the area: no cutter of the plan reaches it."
    for each in found.plans[0].operations:
        if each.mode == "simultaneous":
            yield f"Only simultaneous motion reaches {some(each.share)} of the area, with {each.cutter}: {_faces(each)}."


def _fewest(found: OperationsEntry) -> Iterator[str]:
    few = found.fewest
    if not few.found:
        yield "There is nothing that a fixed orientation reaches."
        return
    yield f"{_times(few.found)} everything that is reached{_proved(few)}"
    part = next((step for step in found.curve if step.share >= _KNEE * found.curve[-1].share), None)
    if part is not None and part.orientations < few.found:
        end = (
            "" if part.at_most is None else f" (no choice of {part.orientations} serves more than {some(part.at_most)})"
        )
        yield f"{_count(part.orientations)} of them finish {some(part.share)} of the area{end}."


def _times(found: int) -> str:
    return f"{_count(found)} {'finishes' if found == 1 else 'finish'}"


def _count(found: int) -> str:
    return f"{found} fixed orientation{'s' * (found != 1)}"


def _proved(few: FewestEntry) -> str:
    near = f"{few.candidates} candidates ({few.spacing_deg:.2g} deg apart where it matters)"
    if few.proof == "weights":
        return f"; no choice among {near} does with fewer, as weights on {len(few.weights)} samples prove."
    if few.proof == "branch and bound":
        return f"; no choice among {near} does with fewer, as branch and bound proves."
    return f"; among {near} at least {few.at_least} are needed."


def _plan(found: OperationsEntry, plan: OperationPlanEntry) -> Iterator[str]:
    what = (
        f"in {_duration(plan.seconds)}"
        if plan.seconds is not None
        else f"with {plan.cut_length_mm / 1000.0:.3g} m of cutting"
    )
    yield f"The {plan.name} plan: {_count(plan.orientations)} {what}."
    for each in plan.operations[:_LISTED]:
        took = "" if each.seconds is None else f", {_duration(each.seconds)}"
        where = "" if each.setup == 0 else f" in setup {each.setup + 1}"
        yield f"  {each.id}: {each.cutter}{where}, {_turned(each)}: {some(each.share)} of the area{took}, {_faces(each)}."
    if plan.proved_share is not None and plan.proved_share < 1.0:
        yield f"  Not proved between samples: {some(1.0 - plan.proved_share)} of their area."
    if len(plan.operations) > _LISTED:
        yield f"  and {len(plan.operations) - _LISTED} more in plan.json."
    small = [each for each in plan.operations if each.mode == "fixed" and each.share < _LITTLE]
    for each in small[:3]:
        yield f"  {each.id} is there for {some(each.share)} of the area: {_faces(each)}."


def _turned(each: OperationEntry) -> str:
    if each.angles_deg is None:
        return "simultaneous"
    return " ".join(f"{name} {angle:g}" for name, angle in each.angles_deg.items()) + " deg"


def _faces(each: OperationEntry) -> str:
    names = [face.face for face in each.faces]
    more = len(names) - _FACES
    return ", ".join(names[:_FACES]) + (f" and {more} more faces" if more > 0 else "")


def _duration(seconds: float) -> str:
    return f"{seconds:.0f} s" if seconds < _MINUTES else f"{seconds / 60.0:.1f} min"
