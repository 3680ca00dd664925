"""Put operations and the process into words: steps in a table of 80 columns, what is left by cause, what to do next."""

import math
import shlex
import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from plan_cutters.domain.answer_kinds import WORTH
from plan_cutters.domain.figures import ROUNDING, area, bound, count, duration, joined, listed, mm, percent, place, size, some
from plan_cutters.domain.placement import axis_words
from plan_cutters.plan_file.model import Plan
from plan_cutters.plan_file.operations import (
    MARGIN,
    NOT_PLANNED,
    OTHER_ORIENTATION,
    SHORT_STEP,
    UNJUDGED_CAUSE,
    NextEntry,
    OperationEntry,
    OperationPlanEntry,
    OperationsEntry,
    ProcessEntry,
    ProcessSetup,
    ProcessStep,
    RemainingEntry,
)
from plan_cutters.plan_file.reasons import CLOSED_VOID, reason
from plan_cutters.plan_file.words.answers import is_excluded, needs
from plan_cutters.plan_file.words.headline import shown_cutter
from plan_cutters.plan_file.words.names import Line, named
from plan_cutters.plan_file.words.notes import doubts

#: Operations that are listed, and faces that are named of one.
_LISTED, _OF_OPERATION = 12, 4
#: Operations for little area that are named before the others; a gap that counts as none, as a share.
_SMALL, _NO_GAP = 3, 1e-6
#: How an operation cuts, where it does not cut in points alone.
_CUTS_AS = {"floor": "as floors", "wall": "along walls", "mixed": "floors, walls and points"}


def operations(plan: Plan) -> list[Line]:
    """Lines about the operations, the worst first, cutters called as everywhere; none where they were not requested."""
    operations = plan.operations
    if operations is None:
        return []
    lines = [*_rest(operations), *_fewest(operations)]
    if any(each.operations for each in operations.plans):
        lines += [*(line for each in operations.plans for line in _plan(operations, each)), *_fastest(operations)]
        lines += _by_cutter(operations)
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
    return f"One more orientation, {what}, would save {saved} of {duration(plan.seconds)} [--operations fastest]."


def _plan(operations: OperationsEntry, plan: OperationPlanEntry) -> Iterator[str]:
    first = operations.plans[0]
    if plan is not first and _choice(plan) == _choice(first):
        yield f"The {plan.name} plan is the same."
        return
    work = f"{plan.cut_length_mm / 1000.0:.3g} m of cutting"
    if plan.cutting_seconds is not None:
        links = f", {duration(plan.link_seconds)} of links" if plan.link_seconds > 0.0 else ""
        work = f"{duration(plan.cutting_seconds)} of cutting{links}"
        cutters, setups = ({getattr(each, word) for each in plan.operations} for word in ("cutter", "setup"))
        what = joined(["orientations", *["cutters"] * (len(cutters) > 1), *["setups"] * (len(setups) > 1)])
        work += f" and {duration(plan.other_seconds)} for {what}" if plan.other_seconds > 0.0 else ""
    yield f"The {plan.name} plan: {count(plan.orientations, 'fixed orientation')}, {work}."
    small = [each for each in plan.operations if each.mode == "fixed" and each.share < _LITTLE]
    for each in small[:_SMALL]:
        took = "" if each.seconds is None else f", {duration(each.seconds)} of cutting"
        yield f"  {each.id} is there for {some(each.share)} of the area{took}: {_faces(each)}."
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
        yield f"{guess}: the machine does not say how fast its rotary axes turn; --index-time tells it."


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
        text += f"; {area(turn.singular_mm2)} lie near the singular direction, where the first rotary axis may turn fast"
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
    return f"{angles_text(each.angles_deg)} deg" if each.angles_deg else "upright"


def _faces(each: OperationEntry) -> str:
    return listed([face.face for face in each.faces], _OF_OPERATION)


#: Columns of a line; steps and causes that are listed; faces that are named of a cause; next steps.
WIDTH, _STEPS, _CAUSES, _FACES, _NEXT = 80, 9, 4, 3, 2
#: Fixed orientations by how many rotary axes index, and how many axes move at once otherwise.
_INDEXED = {1: ("3+1", "four"), 2: ("3+2", "five")}
#: Shares are sums of areas: a gain that is less than it should be by this is that.
_ROUNDING = 1e-6
#: Changes that come beside what there is, and take nothing away.
_ADDED = {"cutter", "radius", "corner_radius", "second_setup"}
#: Up to this share what is left comes after the next step, and an orientation is hardly worth its turn.
_LITTLE = 0.005
#: A clearance that is told as that or more, mm.
_FAR = 100.0
_STRATEGIES = {"point": "", "floor": "floor", "wall": "wall", "mixed": ""}
_OTHER_CAUSES = {
    UNJUDGED_CAUSE: "not judged", NOT_PLANNED: "in no step", SHORT_STEP: "because a step for it would take less than 1 s"
}  # fmt: skip
#: Steps of the planner's own whose faults are told.
_OWN_STEPS = 3
#: A step that leaves less of what it is asked does all, as a share: crumbs at borders are no fault.
_MINOR = 0.001


class StepRow(NamedTuple):
    """A step as a row of texts; `setup`, `turned` and `took` are empty where there is nothing to tell apart, or not known.

    `alone` is what is gone if it is left out, empty where that is not known, `operation` the id of its operation, and `at` its
    setup, counted from 0.
    """

    number: str
    setup: str
    turned: str
    cutter: str
    share: str
    took: str
    faces: list[str]
    alone: str
    operation: str
    at: int


@dataclass(frozen=True, slots=True)
class ProcessStory:
    """A process in words: rows of steps, how the part stands in each setup, and how many more steps there are; sentences on the
    planner's own steps and on what is left, next steps, and clearance. The first `much` of those on what is left are of more than
    a little.
    """

    rows: tuple[StepRow, ...]
    stands: tuple[str, ...]
    roughing: str
    more: str
    own: tuple[str, ...]
    remaining: tuple[str, ...]
    much: int
    next: tuple[str, ...]
    clearance: str

    def table(self) -> list[str]:
        """Rows in lines of at most 80 columns, as many faces in each as fit into a width; how the part stands before the steps of
        each setup."""
        rows = [(row.number, *row[2:6]) for row in self.rows]
        wide = [max(map(len, column)) for column in zip(*rows, strict=True)]
        stands, lines, setup = dict(enumerate(self.stands)), list[str](), None if self.rows else -1
        for row, texts in zip(self.rows, rows, strict=True):
            if row.at != setup:
                setup = row.at
                lines += wrapped([stands.pop(setup, f"Setup {setup + 1} again:")], 2)
            cells = [
                f"{text:>{width}}" if k in (0, 3, 4) else f"{text:<{width}}"
                for k, (text, width) in enumerate(zip(texts, wide, strict=True))
                if width
            ]
            line = "  " + "  ".join(cells)
            lines.append(f"{line}  {_fitting(row.faces, WIDTH - len(line) - 2)}".rstrip()[:WIDTH])
        idle = wrapped([f"{text} No step." for text in stands.values()], 2) if self.rows or len(stands) > 1 else []
        return [*lines, *([f"  {self.more}"] if self.more else []), *(idle or wrapped(list(stands.values()), 2))]


def process_story(plan: Plan, names: Mapping[str, str]) -> ProcessStory | None:
    """Tell the process of a plan; None where an older file has none."""
    process = plan.process
    if process is None:
        return None
    setups = len({step.setup for step in process.steps}) > 1
    fixed = any(step.mode != "any" for step in process.steps)
    steps = dict(enumerate(process.steps, 1))
    # The largest ones where there is no space for all, in the order of the process.
    largest = sorted(steps, key=lambda k: -steps[k].share)[: _STEPS if len(steps) > _STEPS + 1 else None]
    rows = tuple(_row(k, steps[k], names, setups=setups, fixed=fixed) for k in sorted(largest))
    more = ""
    if rest := [steps[k] for k in steps if k not in largest]:
        many = percent(sum(step.share for step in rest), some=True, whole=False)
        more = f"and {count(len(rest), 'smaller step')} for {many}: the review page and plan.json list them."
    known = [(step.clearance_mm, k) for k, step in steps.items() if step.clearance_mm is not None]
    least, step = min(known, default=(0.0, 0))
    clearance = f"Least clearance: {f'{mm(_FAR)} or more' if least >= _FAR else f'{mm(least)} in step {step}'}." if known else ""
    if known and least < MARGIN and steps[step].mode == "fixed" and steps[step].own is None:
        clearance = f"{clearance[:-1]}, where no orientation of the plan has {mm(MARGIN)}."
    return ProcessStory(
        rows=rows,
        stands=tuple(each.text for each in process.setups),
        roughing=roughing(process),
        more=more,
        own=tuple(own_steps(process)),
        remaining=tuple(_remaining(process, plan)),
        much=sum(each.share >= _LITTLE for each in process.left[:_CAUSES]),
        next=tuple(named(plan, _next(each)) for each in process.next[:_NEXT]),
        clearance=clearance,
    )


def with_process_words(plan: Plan) -> Plan:
    """The plan with the words of its process made anew: of steps, of what each area that is left needs, and what to do next."""
    if plan.process is None:
        return plan
    needed = [each.model_copy(update={"needs": needs(plan, each)}) for each in plan.process.left]
    steps = [
        step if step.own is None else step.model_copy(update={"own": step.own.model_copy(update={"text": fault(k, step)})})
        for k, step in enumerate(plan.process.steps, 1)
    ]
    setups = [each.model_copy(update={"text": stand_text(plan, each)}) for each in plan.process.setups]
    words = {
        "steps": steps,
        "setups": setups,
        "left": needed,
        "doubts": doubts(plan),
        "next": list(_next_entries(plan, plan.process, needed)),
    }
    return plan.model_copy(update={"process": plan.process.model_copy(update=words)})


def _row(number: int, step: ProcessStep, names: Mapping[str, str], *, setups: bool, fixed: bool) -> StepRow:
    turned = ""
    if fixed:
        by = step.repeat_deg or {}
        angles = angles_text(step.angles_deg or {}, by)
        turned = angles if step.mode == "fixed" else "simultaneous" if step.mode == "simultaneous" else "any angles"
        if step.mode == "simultaneous":
            turned += "".join(f", {name} + {angle:g}" for name, angle in by.items())
    what = " ".join(filter(None, (names.get(step.cutter, step.cutter), _STRATEGIES[step.strategy])))
    times = f"{step.repeat} x, " if step.repeat > 1 else ""
    longest = 26 if fixed else 40
    return StepRow(
        number=str(number),
        setup=f"setup {step.setup + 1}" if setups else "",
        turned=times + turned,
        cutter=what if len(what) <= longest else f"{what[: longest - 3]}...",
        share=percent(step.share, some=step.area_mm2 > 0.0),
        took=duration(None if step.seconds is None else step.seconds + step.link_seconds),
        faces=step.faces,
        alone="" if step.alone_mm2 is None else area(step.alone_mm2),
        operation=step.operation,
        at=step.setup,
    )


def stand_text(plan: Plan, setup: ProcessSetup) -> str:
    """Say which way is up, what holds the part, and what it stands on."""
    along = [f"{sign}{name}" for name, each in zip("XYZ", setup.up, strict=True) for sign in "+-" if each == float(f"{sign}1")]
    up = along[0] if along else axis_words(setup.up)
    on = "stock" if setup.stands_on == "stock" else listed(setup.stands_on or [], _FACES)
    if setup.grip_mm is not None:
        what = f" on {listed(setup.grips, _FACES)}" if setup.grips else ""
        across = f"{mm(setup.apart_mm or 0.0)} {'apart' if setup.held == 'vise' else 'wide'}"
        rests = f", rests on {on}" if setup.grips and on else ""
        how = f"in a {setup.held}{what}, {across}, jaws {mm(setup.grip_mm)} high{rests}"
    elif setup.held is None:
        how = f"nothing holds it yet{f'; {on} {_is_are(setup)} below' if on else ''}"
    else:
        held = "on a table" if setup.held == "table" else f"held by {setup.held}"
        how = f"{held}, {f'stands on {on}' if on else 'on no plane'}"
    if on == "stock" and plan.process is not None and plan.process.stock is not None:
        how = f"stock of {size(plan.process.stock.size_mm)} {how}"
    soft = f"; it needs soft jaws or a nest: {setup.soft}" if setup.soft else ""
    return named(plan, f"Setup {setup.number}: {up} up, {how}{soft}.")


def roughing(process: ProcessEntry) -> str:
    """How much of the stock is to be roughed, and in what time if that is known; empty where there is none."""
    stock = process.stock
    if stock is None:
        return ""
    took = "" if stock.seconds is None else f", {duration(stock.seconds)}"
    removed, whole = (
        f"{each:,.0f}" if each >= 100.0 else f"{each:.3g}" for each in (0.001 * stock.remove_mm3, 0.001 * stock.volume_mm3)
    )
    return f"Roughing: {removed} of {whole} cm³ of stock{took}."


def _is_are(setup: ProcessSetup) -> str:
    return "is" if len(setup.stands_on or ()) == 1 else "are"


def _fitting(faces: list[str], width: int) -> str:
    """As many faces as fit into a width, and how many more there are.

    >>> _fitting(["F1", "F22", "F3"], 20), _fitting(["F1", "F22", "F3"], 8), _fitting(["F1"], 1)
    ('F1 F22 F3', 'F1 +2', '')
    """
    for number in range(len(faces), 0, -1):
        more = len(faces) - number
        text = " ".join(faces[:number]) + (f" +{more}" if more else "")
        if len(text) <= width:
            return text
    return ""


def _remaining(process: ProcessEntry, plan: Plan) -> Iterator[str]:
    listed_causes = process.left[:_CAUSES]
    for each in listed_causes:
        faces = listed(each.faces, _FACES)
        near = f" near ({place(each.place_mm)})" if each.place_mm is not None else ""
        needs = f": {named(plan, each.needs)}" if each.needs else ""
        some = percent(each.share, some=True, whole=False) if each.samples else percent(each.share)
        yield f"Left, {some}, {area(each.area_mm2)}, {_OTHER_CAUSES.get(each.cause) or reason(each.cause)}: {faces}{near}{needs}."
    if len(process.left) > len(listed_causes):
        rest = process.left[len(listed_causes) :]
        yield f"Left besides, {percent(sum(each.share for each in rest), some=True, whole=False)}, for other causes."
    if process.exempt is not None:
        where = listed(process.exempt.faces, _FACES)
        yield f"Not required (--sharp-edges left): {area(process.exempt.area_mm2)} at sharp inside edges of {where}."


def _next_entries(plan: Plan, process: ProcessEntry, remaining: Sequence[RemainingEntry]) -> Iterator[NextEntry]:
    """The best next steps of the cutter that the plan shows, or the answer to ask for; `remaining` say what they need."""
    if all(each.cause == UNJUDGED_CAUSE or each.needs == CLOSED_VOID for each in remaining):
        return
    advice, left = shown_cutter(plan).mend, 1.0 - process.finished_share
    sharp = sum(each.share for each in process.left if each.cause == "sharp_edge")
    if sharp >= WORTH and plan.effective.sharp_edges == "asked":
        # It costs nothing, and no cutter makes a sharp inside edge. How much that leaves out is for the finest cutter to say.
        words = "leave sharp inside edges as the cutter rounds them, if the drawing lets you"
        yield NextEntry(words=words, argv=["--sharp-edges", "left"], left_share=None)
        if left - sharp < WORTH:
            return
    if advice is None:
        if "mend" not in plan.effective.answers:
            yield NextEntry(words="ask what would help", argv=["--answers", "mend"], left_share=None)
        return
    things = [{change.thing for change in step.changes} for step in advice.steps]
    after = dict[int, float]()
    for k, step in enumerate(advice.steps):
        # The process keeps its own cutters and setups where a step takes none away.
        if not is_excluded(step):
            gained = sum(each.share * helped.share for each in process.left for helped in each.helped if helped.step == k)
            after[k] = min(step.lost_after, max(0.0, left - gained)) if things[k] <= _ADDED else step.lost_after
    reported = list[tuple[set[str], float]]()
    for k in after:
        # What changes less comes first where it does as much.
        fewer = [(things[j], after[j]) for j in after if things[j] < things[k]]
        alike = any(each <= things[k] and then - after[k] < WORTH for each, then in (*reported, *fewer))
        if left - after[k] >= WORTH - _ROUNDING and not alike:
            reported.append((things[k], after[k]))
            option = advice.steps[k].option
            yield NextEntry(words=advice.steps[k].why, argv=shlex.split(option) if option else [], left_share=after[k])


def _next(each: NextEntry) -> str:
    stays = "" if each.left_share is None else f": left {percent(each.left_share, some=each.left_share > 0.0)}"
    bracket = f" [{shlex.join(each.argv)}]" if each.argv else ""
    return f"Next: {each.words}{stays}{bracket}"


def wrapped(texts: list[str], most: int) -> list[str]:
    """Paragraphs in lines of at most 80 columns, of each as many as are allowed."""
    lines: list[str] = []
    for text in texts:
        mine = textwrap.wrap(text, WIDTH, subsequent_indent="  ", break_on_hyphens=False, break_long_words=True)
        if len(mine) > most:
            mine = [*mine[: most - 1], textwrap.shorten(" ".join(mine[most - 1 :]).strip(), WIDTH - 2, placeholder=" ...")]
            mine[-1] = f"  {mine[-1]}" if most > 1 else mine[-1]
        lines += mine
    return lines


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
