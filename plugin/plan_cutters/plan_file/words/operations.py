"""Put the plan of operations into words, the worst first."""

import math
from collections.abc import Iterable, Iterator
from typing import NamedTuple

from plan_cutters.domain.figures import ROUNDING, bound, count, duration, joined, listed, percent, some
from plan_cutters.domain.figures import area as size
from plan_cutters.plan_file.model import Plan
from plan_cutters.plan_file.operations import CutterUse, FewestEntry, OperationEntry, OperationPlanEntry, OperationsEntry
from plan_cutters.plan_file.words.names import Line, named

#: Operations that are listed, and faces that are named of one.
_LISTED, _FACES = 12, 4
#: Operations for little area that are named before the others; a gap that counts as none, as a share.
_SMALL, _NO_GAP = 3, 1e-6
#: How an operation cuts, where it does not cut in points alone.
_STRATEGIES = {"floor": "as floors", "wall": "along walls", "mixed": "floors, walls and points"}
#: A share of the area for which an orientation is hardly worth its turn.
_LITTLE = 0.005


def operations(plan: Plan) -> list[Line]:
    """Lines about the operations, cutters called as everywhere; none where they were not requested."""
    operations = plan.operations
    if operations is None:
        return []
    lines = [*_rest(operations), *_fewest(operations)]
    if any(each.operations for each in operations.plans):
        lines += [
            *(line for each in operations.plans for line in _plan(operations, each)),
            *_fastest(operations),
            *_assumed(operations),
            *_by_cutter(operations),
            *(line for use in operations.cutters for line in _worth(operations, use)),
        ]
    return [Line(named(plan, text)) for text in (*lines, *operations.notes)]


def in_short(plan: Plan) -> list[str]:
    """Say what no operation finishes, and how many orientations finish the rest; nothing where operations were not requested."""
    operations = plan.operations
    return [] if operations is None else [named(plan, text) for text in (*_rest(operations), next(_fewest(operations)))]


def _rest(operations: OperationsEntry) -> Iterator[str]:
    rest = operations.plans[0].rest
    if rest.samples:
        short = f", but for {count(rest.short, 'sample')} for which a step would take less than 1 s" if rest.short else ""
        yield f"No operation finishes {some(rest.share)} of the area: no cutter of the plan reaches it{short}."
    # Where fewer orientations were requested than all needs, others may reach what is left to simultaneous motion.
    first = operations.plans[0]
    most = first.orientations if operations.fewest is None else operations.fewest.found
    for each in first.operations:
        if each.mode == "simultaneous" and first.orientations < most:
            yield (
                f"Simultaneous motion finishes {some(each.share)} of the area, with {each.cutter}: {_faces(each)}. "
                f"{count(first.orientations, 'fixed orientation')} leave{'s' * (first.orientations == 1)} it."
            )
        elif each.mode == "simultaneous":
            yield f"Only simultaneous motion reaches {some(each.share)} of the area, with {each.cutter}: {_faces(each)}."


def _fewest(operations: OperationsEntry) -> Iterator[str]:
    few = operations.fewest
    if few is None:
        plan = operations.plans[0]
        whose = "The planner's own process" if plan.name == "process" else "The plan, of one copy and its repeats,"
        yield f"{whose} has {count(plan.orientations, 'fixed orientation')}."
        return
    if not few.found:
        yield "There is nothing that a fixed orientation reaches."
        return
    verb = "finishes" if few.found == 1 else "finish"
    yield f"{count(few.found, 'fixed orientation')} {verb} everything that is reached{_proved(few)}"
    if saving := one_more(operations):
        yield saving


def one_more(operations: OperationsEntry | None) -> str:
    """Say what one more orientation than the fewest would save; empty where that is little, or not known."""
    more = None if operations is None or operations.fewest is None else operations.fewest.one_more
    plan = None if operations is None else next((each for each in operations.plans if each.name == "fewest"), None)
    if operations is None or more is None or plan is None or plan.seconds is None:
        return ""
    angles = " ".join(f"{name} {angle:g}" for name, angle in more.angles_deg.items())
    where = f" in setup {more.setup + 1}" if more.setup or _setups(operations) else ""
    return (
        f"One more orientation, {angles} with {more.cutter}{where}, would save {duration(more.saves_seconds)} of "
        f"{duration(plan.seconds)} [--operations fastest]."
    )


def _proved(few: FewestEntry) -> str:
    if few.found == 1:
        return "."
    near = f"{few.candidates} candidates ({few.spacing_deg:.2g} deg apart where it matters)"
    if few.proof == "weights":
        return f"; no choice among {near} does with fewer, as weights on {len(few.weights)} samples prove."
    if few.proof == "branch and bound":
        return f"; no choice among {near} does with fewer, as branch and bound proves."
    return f"; among {near} at least {few.at_least} are needed."


def _plan(operations: OperationsEntry, plan: OperationPlanEntry) -> Iterator[str]:
    first = operations.plans[0]
    if plan is not first and _choice(plan) == _choice(first):
        yield f"The {plan.name} plan is the same."
        return
    yield f"The {plan.name} plan: {count(plan.orientations, 'fixed orientation')}, {_work(plan)}."
    small = [each for each in plan.operations if each.mode == "fixed" and each.share < _LITTLE]
    for each in small[:_SMALL]:
        yield f"  {each.id} is there for {_little(each)}: {_faces(each)}."
    if len(small) > _SMALL:
        yield f"  So are {len(small) - _SMALL} more, each for less than {some(_LITTLE)}."
    for each in plan.operations[:_LISTED]:
        yield f"  {_listed(each, _setups(operations))}"
    if len(plan.operations) > _LISTED:
        yield f"  and {len(plan.operations) - _LISTED} more in plan.json."
    yield from (line for each in plan.operations if (line := turning(each)))
    if plan.proved_share is not None and plan.proved_share < 1.0:
        yield f"Not proved between samples: {some(1.0 - plan.proved_share)} of the area of the {plan.name} plan."


def _choice(plan: OperationPlanEntry) -> list[tuple[object, ...]]:
    """The operations of a plan, whatever they are called."""
    return sorted((each.cutter, each.setup, *sorted((each.angles_deg or {}).items())) for each in plan.operations)


def _work(plan: OperationPlanEntry) -> str:
    if plan.cutting_seconds is None:
        return f"{plan.cut_length_mm / 1000.0:.3g} m of cutting"
    links = f", {duration(plan.link_seconds)} of links" if plan.link_seconds > 0.0 else ""
    if plan.other_seconds <= 0.0:
        return f"{duration(plan.cutting_seconds)} of cutting{links}"
    cutters = len({each.cutter for each in plan.operations})
    setups = len({each.setup for each in plan.operations})
    what = [word for word, there in (("orientations", True), ("cutters", cutters > 1), ("setups", setups > 1)) if there]
    return f"{duration(plan.cutting_seconds)} of cutting{links} and {duration(plan.other_seconds)} for {joined(what)}"


def share_text(share: float) -> str:
    """A share of the area: what falls short of all by rounding is all of it, for areas are sums of rounded numbers."""
    return percent(share, whole=share >= 1.0 - ROUNDING)


def _little(each: OperationEntry) -> str:
    took = "" if each.seconds is None else f", {duration(each.seconds)} of cutting"
    return f"{some(each.share)} of the area{took}"


def _fastest(operations: OperationsEntry) -> Iterator[str]:
    """How the times of fixed orientations compare with simultaneous motion and with the best choice."""
    timed = operations.fastest
    if timed is None:
        return
    for plan in operations.plans:
        again = plan is not operations.plans[0] and _choice(plan) == _choice(operations.plans[0])
        if plan.ratio_at_most is not None and not again:
            cutting = sum((each.seconds or 0.0) + each.link_seconds for each in plan.operations if each.mode == "fixed")
            times = f"at most {_factor(plan.ratio_at_most)} times as long as five axes at once"
            yield f"3+2 ({plan.name}) takes {duration(cutting)} of cutting and links, {times}."
    few = operations.fewest
    some_of = f" of {few.samples}" if few is not None and timed.samples < few.samples - few.alone else ""
    near = f"the best of {timed.candidates} candidates, by {timed.samples}{some_of} samples"
    if timed.gap is None:
        yield "How far the fastest plan is above the best is not known: a width of a pass is not known."
    elif timed.gap <= _NO_GAP:
        yield f"No choice takes less than the fastest plan: it is {near}."
    else:
        yield f"The fastest plan is at most {bound(timed.gap)} above {near}."


def _assumed(operations: OperationsEntry) -> Iterator[str]:
    """That nobody knows how long an orientation takes, where it counts."""
    if operations.fastest is not None and operations.assumed.index_from == "assumed" and operations.plans[0].orientations > 1:
        guess = f"Each orientation counts {operations.assumed.index_s:g} s, which is a guess"
        yield f"{guess}: the machine does not say how fast its rotary axes turn; --index-time tells it."


def _by_cutter(operations: OperationsEntry) -> Iterator[str]:
    """What each cutter cuts by the fastest plan."""
    taken = [(use.id, use.takes_mm2["fastest"]) for use in operations.cutters if use.takes_mm2.get("fastest", 0.0) > 0.0]
    whole = sum(area for _, area in taken)
    if len(taken) > 1:
        yield f"Of what is cut, the fastest plan cuts {joined([f'{share_text(area / whole)} with {id}' for id, area in taken])}."


def _worth(operations: OperationsEntry, use: CutterUse) -> Iterator[str]:
    """What a cutter saves, and what its change costs."""
    if use.only_mm2 > 0.0:
        yield f"Only {use.id} reaches {size(use.only_mm2)}."
        return
    used = any(use.id == each.cutter for plan in operations.plans if plan.name == "fastest" for each in plan.operations)
    if use.saves_seconds is None:
        yield f"{use.id} is needed: no plan was found without it."
    elif use.saves_seconds < 1.0:
        yield f"{use.id} would save nothing."
    elif use.change_seconds <= 0.0:
        yield f"{use.id} saves {duration(use.saves_seconds)} against the best without it."
    else:
        verb, cost = ("saves", "costs") if used else ("would save", "cost")
        yield f"{use.id} {verb} {duration(use.saves_seconds)} and {cost} a change of {duration(use.change_seconds)}."


def _setups(operations: OperationsEntry) -> bool:
    """Whether operations are in more than one setup: then each says in which."""
    return len({each.setup for plan in operations.plans for each in plan.operations}) > 1


def _listed(each: OperationEntry, setups: bool) -> str:
    took = "" if each.seconds is None else f", {duration(each.seconds)}"
    where = f" in setup {each.setup + 1}" if setups else ""
    how = f"{each.cutter}{where}, {_turned(each)}{_strategy(each)}"
    return f"{each.id}: {how}: {share_text(each.share)} of the area{took}, {_faces(each)}."


def turning(each: OperationEntry) -> str:
    """Say over what share simultaneous motion is proved, and how the axes turn there; empty where nothing was looked at."""
    turn = each.turning
    if turn is None or each.proved_share is None:
        return ""
    if not turn.pieces_mm2:
        return f"Simultaneous motion in {each.id}: nothing of it is proved between the samples."
    pieces = "1 piece" if len(turn.pieces_mm2) == 1 else f"{len(turn.pieces_mm2)} pieces"
    text = (
        f"Simultaneous motion in {each.id}: {share_text(each.proved_share)} of its area is proved, in {pieces}, with axes that "
        f"turn by at most {turn.steepest_deg_mm:.2g} deg a mm"
    )
    if turn.angles_deg is not None:
        text += f"; {', '.join(f'{name} {low:.0f} to {high:.0f} deg' for name, (low, high) in turn.angles_deg.items())}"
    if turn.angles_deg is not None and turn.held_share < 1.0 - ROUNDING:
        text += (
            f"; in {some(1.0 - turn.held_share)} of that no solution of the rotary axes goes from end to end without turning back"
        )
    if turn.singular_mm2 > 0.0:
        text += f"; {size(turn.singular_mm2)} lie near the singular direction, where the first rotary axis may turn fast"
    return f"{text}."


class OperationText(NamedTuple):
    """An operation as a row of a table, with angles in degrees and the setup where there are several, and as a sentence."""

    entry: OperationEntry
    setup: str
    turned: str
    took: str
    faces: str
    sentence: str


def operation_text(plan: Plan, each: OperationEntry) -> OperationText:
    """Put one operation into words; `took` is its cutting time or, without a feed, its cut length."""
    length = "" if each.cut_length_mm is None else f"{each.cut_length_mm / 1000.0:.3g} m"
    took = length if each.seconds is None else duration(each.seconds)
    setups = plan.operations is not None and _setups(plan.operations)
    where = f"setup {each.setup + 1}" if setups else ""
    return OperationText(each, where, _turned(each).removesuffix(" deg"), took, _faces(each), named(plan, _listed(each, setups)))


def of_the_whole(lines: Iterable[Line], above: Iterable[str] = ()) -> list[Line]:
    """Those lines that are about plans, not about one operation, and do not stand above: what is indented stands in a list."""
    mentioned = set(above)
    return [line for line in lines if not line.text.startswith(" ") and line.text not in mentioned]


def _turned(each: OperationEntry) -> str:
    if each.angles_deg is None:
        return "simultaneous"
    return " ".join(f"{name} {angle:g}" for name, angle in each.angles_deg.items()) + " deg"


def _strategy(each: OperationEntry) -> str:
    """How it cuts, where it does not cut in points alone."""
    return "" if each.strategy == "point" else f", {_STRATEGIES[each.strategy]}"


def _faces(each: OperationEntry) -> str:
    return listed([face.face for face in each.faces], _FACES)


def _factor(ratio: float) -> str:
    return f"{math.ceil(10.0 * ratio - 1e-9) / 10.0:.1f}"
