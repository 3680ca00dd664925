"""Put plans of operations into words: how few there can be, how fast they are, and each one with its cutter and its faces."""

import math
import re
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from plan_cutters.domain.figures import ROUNDING, area, bound, count, duration, joined, listed, percent, some
from plan_cutters.plan_file.model import Plan
from plan_cutters.plan_file.operations import OperationEntry, OperationPlanEntry, OperationsEntry, ProcessEntry, ProcessStep
from plan_cutters.plan_file.words.names import Line, named

#: The id of an operation in a text.
_OPERATION = re.compile(r"\bop\d+\b")
#: Fixed orientations by how many rotary axes index, and how many axes move at once otherwise.
_INDEXED = {1: ("3+1", "four"), 2: ("3+2", "five")}
#: Faces that are named of an operation; a gap that counts as none, as a share.
_OF_OPERATION, _NO_GAP = 4, 1e-6
#: How an operation cuts, where it does not cut in points alone.
_CUTS_AS = {"floor": "as floors", "wall": "along walls", "mixed": "floors, walls and points"}


def operations(plan: Plan) -> list[Line]:
    """Lines about the plans of operations, cutters called as everywhere; none where they were not requested.

    What each operation does stands in the table of the process.
    """
    operations = plan.operations
    if operations is None:
        return []
    lines = [*_rest(operations), *_fewest(operations)]
    if any(each.operations for each in operations.plans):
        lines += [_plan(operations, each) for each in operations.plans]
        lines += _fastest(operations)
        lines += _by_cutter(operations)
    return [Line(named(plan, text)) for text in (*lines, *operations.notes)]


def operation_names(plan: Plan) -> dict[str, str]:
    """Number the operations of the process, by their ids, as their steps: `3`, or `3.2` where that is done several times."""
    return {} if plan.operations is None else numbered(plan.operations, plan.process)


def numbered(operations: OperationsEntry, process: ProcessEntry) -> dict[str, str]:
    """The numbers of `operation_names`."""
    names = dict[str, str]()
    for number, step in enumerate(process.steps, 1):
        images = images_of(operations, process, step)
        for k, each in enumerate(images, 1):
            names[each.id] = f"{number}.{k}" if len(images) > 1 else str(number)
    return names


def of_process(operations: OperationsEntry, process: ProcessEntry) -> list[OperationEntry]:
    """The operations of the plan that is the process."""
    return [each for one in operations.plans if one.name == process.plan for each in one.operations]


def images_of(operations: OperationsEntry, process: ProcessEntry, step: ProcessStep) -> list[OperationEntry]:
    """The operations that a step consists of: images of each other."""
    entries = of_process(operations, process)
    made = next((each for each in entries if each.id == step.operation), None)
    return [each for each in entries if each is made or (each.orbit is not None and each.orbit == made.orbit)] if made else []


def each_time(plan: Plan, step: ProcessStep, width: int) -> str:
    """The angles of each time that a step is done, where no increment leads from one to the next: `C 0, 47, 190 · A 45`, as many
    as go into a width; empty where one does, and where they are not known.
    """
    if step.repeat < 2 or step.repeat_deg or plan.operations is None:
        return ""
    images = images_of(plan.operations, plan.process, step)
    every = sorted((each.angles_deg or {} for each in images), key=lambda angles: [angle % 360.0 for angle in angles.values()])
    for shown in range(len(every), 1, -1):
        words = list[str]()
        for name in every[0]:
            each = [f"{angles[name]:g}" for angles in every]
            more = f" +{len(each) - shown}" if len(each) > shown else ""
            words.append(f"{name} {each[0] if len({*each}) == 1 else ', '.join(each[:shown]) + more}")
        if len(text := " · ".join(words)) <= width:
            return text
    return ""


def steps_of(plan: Plan, of: OperationPlanEntry) -> dict[str, str]:
    """The numbers of `operation_names` if a plan of operations is that of the process, else none."""
    return operation_names(plan) if of.name == plan.process.plan else {}


def stepped(plan: Plan, of: OperationPlanEntry, text: str) -> str:
    """A text on a plan of operations, or the id of one: those of the process are called by their steps."""
    names = steps_of(plan, of)
    return _OPERATION.sub(lambda match: f"step {names[match[0]]}" if match[0] in names else match[0], text)


def in_short(plan: Plan) -> list[str]:
    """Say what no operation finishes, and how many orientations finish the rest; nothing where operations were not requested."""
    operations = plan.operations
    return [] if operations is None else [named(plan, text) for text in (*_rest(operations), next(_fewest(operations)))]


def _rest(operations: OperationsEntry) -> Iterator[str]:
    rest = operations.plans[0].rest
    if rest.samples:
        short = f", but for {count(rest.short, 'sample')} too few for a step" if rest.short else ""
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
    near = f"{few.candidates} candidates ({few.spacing_deg:.2g} deg apart where it matters)"
    proved = f"; among {near} at least {few.at_least} are needed."
    if few.found == 1:
        proved = "."
    elif few.proof != "not closed":
        by = f"weights on {len(few.weights)} samples prove" if few.proof == "weights" else "branch and bound proves"
        proved = f"; no choice among {near} does with fewer, as {by}."
    verb = "finishes" if few.found == 1 else "finish"
    yield f"{count(few.found, 'fixed orientation')} {verb} everything that is reached{proved}"
    if saving := one_more(operations):
        yield saving


def one_more(operations: OperationsEntry | None) -> str:
    """Say what one more orientation than the fewest would save; empty where that is little, or not known."""
    more = None if operations is None or operations.fewest is None else operations.fewest.one_more
    plan = None if operations is None else next((each for each in operations.plans if each.name == "fewest"), None)
    if operations is None or more is None or plan is None or plan.seconds is None:
        return ""
    where = f" in setup {more.setup + 1}" if more.setup or _setups(operations) else ""
    what, saved = f"{angles_text(more.angles_deg)} with {more.cutter}{where}", duration(more.saves_seconds)
    return f"One more orientation, {what}, would save {saved} of {duration(plan.seconds)} [`--operations fastest`]."


def _plan(operations: OperationsEntry, plan: OperationPlanEntry) -> str:
    first = operations.plans[0]
    if plan is not first and _choice(plan) == _choice(first):
        return f"The {plan.name} plan is the same."
    work = f"{plan.cut_length_mm / 1000.0:.3g} m of cutting"
    if plan.cutting_seconds is not None:
        links = f", {duration(plan.link_seconds)} of links" if plan.link_seconds > 0.0 else ""
        work = f"{duration(plan.cutting_seconds)} of cutting{links}"
        cutters, setups = ({getattr(each, word) for each in plan.operations} for word in ("cutter", "setup"))
        what = joined(["orientations", *["cutters"] * (len(cutters) > 1), *["setups"] * (len(setups) > 1)])
        work += f" and {duration(plan.other_seconds)} for {what}" if plan.other_seconds > 0.0 else ""
    return f"The {plan.name} plan: {count(plan.orientations, 'fixed orientation')}, {work}."


def _choice(plan: OperationPlanEntry) -> list[tuple[object, ...]]:
    return sorted((each.cutter, each.setup, *sorted((each.angles_deg or {}).items())) for each in plan.operations)


def share_text(share: float) -> str:
    """A share of the area: what falls short of all by rounding is all of it, for areas are sums of rounded numbers."""
    return percent(share, whole=share >= 1.0 - ROUNDING)


def _fastest(operations: OperationsEntry) -> Iterator[str]:
    """How the times of fixed orientations compare with simultaneous motion and with the best choice, and what was guessed."""
    timed, first = operations.fastest, operations.plans[0]
    if timed is None:
        return
    kind, axes = _INDEXED.get(len(operations.rotary), ("", ""))
    for plan in operations.plans:
        if kind and plan.ratio_at_most is not None and (plan is first or _choice(plan) != _choice(first)):
            cutting = sum((each.seconds or 0.0) + each.link_seconds for each in plan.operations if each.mode == "fixed")
            times = f"at most {math.ceil(10.0 * plan.ratio_at_most - 1e-9) / 10.0:.1f} times as long as {axes} axes at once"
            yield f"{kind} ({plan.name}) takes {duration(cutting)} of cutting and links, {times}."
    few = operations.fewest
    some_of = f" of {few.samples}" if few is not None and timed.samples < few.samples - few.alone else ""
    near = f"the best of {timed.candidates} candidates, by {timed.samples}{some_of} samples"
    if timed.gap is None:
        yield "How far the fastest plan is above the best is not known: a width of a pass is not known."
    elif timed.gap <= _NO_GAP:
        yield f"No choice takes less than the fastest plan: it is {near}."
    else:
        yield f"The fastest plan is at most {bound(timed.gap)} above {near}."
    if operations.assumed.index_from == "assumed" and first.orientations > 1:
        guess = f"Each orientation counts {operations.assumed.index_s:g} s, which is a guess"
        yield f"{guess}: the machine does not say how fast its rotary axes turn; `--index-time` tells it."


def _by_cutter(operations: OperationsEntry) -> Iterator[str]:
    """What each cutter cuts by the fastest plan, what it saves, and what its change costs."""
    taken = [(use.id, use.takes_mm2["fastest"]) for use in operations.cutters if use.takes_mm2.get("fastest", 0.0) > 0.0]
    whole = sum(size for _, size in taken)
    if len(taken) > 1:
        yield f"Of what is cut, the fastest plan cuts {joined([f'{share_text(size / whole)} with {id}' for id, size in taken])}."
    used = {each.cutter for plan in operations.plans if plan.name == "fastest" for each in plan.operations}
    for use in operations.cutters:
        if use.only_mm2 > 0.0:
            yield f"Only {use.id} reaches {area(use.only_mm2)}."
        elif use.saves_seconds is None:
            yield f"{use.id} is needed: no plan was found without it."
        elif use.saves_seconds < 1.0:
            yield f"{use.id} would save nothing."
        elif use.change_seconds <= 0.0:
            yield f"{use.id} saves {duration(use.saves_seconds)} against the best without it."
        else:
            verb, cost = ("saves", "costs") if use.id in used else ("would save", "cost")
            yield f"{use.id} {verb} {duration(use.saves_seconds)} and {cost} a change of {duration(use.change_seconds)}."


def _setups(operations: OperationsEntry) -> bool:
    """Whether operations are in more than one setup: then each says in which."""
    return len({each.setup for plan in operations.plans for each in plan.operations}) > 1


def _listed(each: OperationEntry, setups: bool) -> str:
    took = "" if each.seconds is None else f", {duration(each.seconds)}"
    where = f" in setup {each.setup + 1}" if setups else ""
    how = "" if each.strategy == "point" else f", {_CUTS_AS[each.strategy]}"
    what = f"{each.cutter}{where}, {_turned(each)}{how}"
    return f"{each.id}: {what}: {share_text(each.share)} of the area{took}, {_faces(each)}."


class OperationText(NamedTuple):
    """An operation as a row of a table, with angles in degrees and the setup where there are several, and as a sentence."""

    entry: OperationEntry
    setup: str
    turned: str
    took: str
    faces: str
    sentence: str


def operation_text(plan: Plan, of: OperationPlanEntry, each: OperationEntry) -> OperationText:
    """Put one operation of a plan into words; `took` is its cutting time or, without a feed, its cut length."""
    length = "" if each.cut_length_mm is None else f"{each.cut_length_mm / 1000.0:.3g} m"
    took = length if each.seconds is None else duration(each.seconds)
    setups = plan.operations is not None and _setups(plan.operations)
    where = f"setup {each.setup + 1}" if setups else ""
    sentence = named(plan, stepped(plan, of, _listed(each, setups)))
    return OperationText(each, where, _turned(each).removesuffix(" deg"), took, _faces(each), sentence)


def _turned(each: OperationEntry) -> str:
    if each.angles_deg is None:
        return "simultaneous"
    return f"{angles_text(each.angles_deg)} deg" if each.angles_deg else "upright"


def _faces(each: OperationEntry) -> str:
    return listed([face.face for face in each.faces], _OF_OPERATION)


def angles_text(angles: Mapping[str, float], by: Mapping[str, float] | None = None) -> str:
    """Rotary axes with their angles, and by how much some turn from one time to the next.

    >>> angles_text({"C": 0.0, "A": 12.5}, {"C": 36.0})
    'C 0 + 36 A 12.5'
    """
    return " ".join(f"{name} {angle:g}" + (f" + {by[name]:g}" if by and name in by else "") for name, angle in angles.items())
