"""Put the process into words: steps in a table of 80 columns, what is left by cause, what to do next."""

import math
import re
import shlex
import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain, groupby
from typing import NamedTuple

from plan_cutters.domain.answer_kinds import WORTH
from plan_cutters.domain.clamping import Vise
from plan_cutters.domain.figures import INCH, area, count, duration, in_inches, listed, mm, percent, place, size
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.placement import axis_words
from plan_cutters.plan_file import operations as schema
from plan_cutters.plan_file.holes import DrillingStep
from plan_cutters.plan_file.model import Plan
from plan_cutters.plan_file.reasons import CLOSED_VOID, reason
from plan_cutters.plan_file.words.answers import is_excluded, more_setup, needs
from plan_cutters.plan_file.words.headline import shown_cutter
from plan_cutters.plan_file.words.holes import behind_drills, drilling_words
from plan_cutters.plan_file.words.names import named
from plan_cutters.plan_file.words.notes import doubts
from plan_cutters.plan_file.words.operations import angles_text, each_time

#: Rows of mills and drills that are listed together, and so many of drills in any case.
_ROWS, _DRILLED = 10, 4
#: Columns of a line; steps and causes that are listed; faces that are named of a cause; next steps.
WIDTH, _STEPS, _CAUSES, _FACES, _NEXT = 80, 9, 4, 3, 2
#: Shares are sums of areas: a gain that is less than it should be by this is that.
_ROUNDING = 1e-6
#: Changes that come beside what there is, and take nothing away.
_ADDED = {"cutter", "radius", "corner_radius", "second_setup"}
#: Up to this share what is left comes after the next step, and an orientation is hardly worth its turn, nor a setup its clamping.
_LITTLE = 0.005
#: Share of what is left for a cause from which on a step helps against it.
_HELPED = 0.5
#: Columns for the angles of a step that is repeated.
_ANGLES = 34
#: An area that is left, and less than that and hardly a share, has no line of its own, mm2.
_SMALLEST = 1.0
#: A clearance that is told as that or more, mm.
_FAR = 100.0
_STRATEGIES = {"point": "", "floor": "floor", "wall": "wall", "mixed": ""}
_OTHER_CAUSES = {
    schema.UNJUDGED_CAUSE: "not judged", schema.NOT_PLANNED: "in no step", schema.SHORT_STEP: "too little for a step"
}  # fmt: skip
#: Steps of the planner's own whose faults are told.
_OWN_STEPS = 3
#: A step that leaves less of what it is asked does all, as a share: crumbs at borders are no fault.
_MINOR = 0.001


class StepRow(NamedTuple):
    """A step as a row of texts; `setup`, `turned` and `took` are empty where there is nothing to tell apart, or not known."""

    number: str
    setup: str
    turned: str
    cutter: str
    share: str
    took: str
    at: int  #: Its setup, counted from 0.
    faces: Sequence[str] = ()
    alone: str = ""  #: What is gone if it is left out; empty where that is not known.
    operation: str = ""  #: The id of its operation.
    holes: int = 0  #: How many it drills, 0 for a mill.


class Stays(NamedTuple):
    """An area that no step finishes: `lead` and `share` are empty where it is not required; `text` ends the sentence."""

    lead: str
    share: str
    text: str


@dataclass(frozen=True, slots=True)
class ProcessStory:
    """A process in words: rows of steps, how the part stands in each setup, how many more steps there are, in which setups from 0
    (`unlisted`), and the time between steps (`besides`); sentences on the planner's own steps and on what is left, next steps,
    and clearance. The first `much` of those on what is left are of more than a little.
    """

    rows: tuple[StepRow, ...]
    stands: tuple[str, ...]
    roughing: str
    more: str
    besides: str
    own: tuple[str, ...]
    remaining: tuple[Stays, ...]
    much: int
    next: tuple[str, ...]
    clearance: str
    unlisted: frozenset[int] = frozenset()

    def table(self) -> list[str]:
        """Rows in lines of at most 80 columns, as many faces in each as fit into a width; how the part stands before the steps of
        each setup."""
        drills = sorted((row for row in self.rows if row.holes), key=lambda row: -row.holes)
        unshown = drills[_DRILLED // 2 if self.more else max(_DRILLED, _ROWS - len(self.rows) + len(drills)) :]
        shown = [row for row in self.rows if row not in unshown]
        rows = [(row.number, *row[2:6]) for row in shown]
        wide = [max(map(len, column)) for column in zip(*rows, strict=True)]
        stands, lines, setup = dict(enumerate(self.stands)), list[str](), None if self.rows else -1
        for row, texts in zip(shown, rows, strict=True):
            if row.at != setup:
                setup = row.at
                for other in sorted(at for at in stands if at < setup and at in self.unlisted):
                    lines += wrapped([stands.pop(other)], 2)
                lines += wrapped([stands.pop(setup, f"Setup {setup + 1} again:")], 2)
            cells = [
                f"{text:>{width}}" if k in (0, 3, 4) else f"{text:<{width}}"
                for k, (text, width) in enumerate(zip(texts, wide, strict=True))
                if width
            ]
            line = "  " + "  ".join(cells)
            lines.append(f"{line}  {_fitting(row.faces, WIDTH - len(line) - 2)}".rstrip()[:WIDTH])
        without = [text if at in self.unlisted else f"{text} No step." for at, text in stands.items()]
        idle = wrapped(without, 2) if self.rows or len(stands) > 1 else []
        if unshown:
            lines.append(f"  and {count(len(unshown), 'more step')} that drill: the review page and plan.json list them.")
        lines += [f"  {text}" for text in (self.more, self.besides) if text]
        return [*lines, *(idle or wrapped(list(stands.values()), 2))]


def process_story(plan: Plan, names: Mapping[str, str], most: int = _STEPS) -> ProcessStory:
    """Tell the process of a plan, about so many steps of it."""
    process = plan.process
    setups = len({*(step.setup for step in process.steps), *(step.setup for step in process.drilling)}) > 1
    fixed = any(step.mode != "any" for step in process.steps)
    steps = dict(enumerate(process.steps, 1))
    # The largest ones where there is no space for all, in the order of the process.
    largest = sorted(steps, key=lambda k: -steps[k].share)[: most if len(steps) > most + 1 else None]
    rows = [
        _row(k, steps[k], names, setups=setups, fixed=fixed, each=each_time(plan, steps[k], _ANGLES)) for k in sorted(largest)
    ]
    # Steps that drill follow those of mills in their setup.
    for k, bores in enumerate(process.drilling, len(steps) + 1):
        after = max((i for i, row in enumerate(rows, 1) if row.at <= bores.setup), default=0)
        rows.insert(after, _drilling_row(k, bores, setups=setups, fixed=fixed or not steps))
    # What goes to the bottoms of holes is run behind their drills.
    late = {str(k) for k in behind_drills(plan)}
    runs = (sorted(run, key=lambda row: row.number in late) for _, run in groupby(rows, key=lambda row: row.at))
    rows = [*chain.from_iterable(runs)]
    more = ""
    if rest := [steps[k] for k in steps if k not in largest]:
        many = percent(sum(step.share for step in rest), some=True, whole=False)
        more = f"and {count(len(rest), 'smaller step')} for {many}: the review page and plan.json list them."
    return ProcessStory(
        rows=tuple(rows), stands=tuple(each.text for each in process.setups), roughing=roughing(process), more=more,
        besides=_besides(process), own=tuple(own_steps(process)), remaining=tuple(_remaining(process, plan)),
        much=sum(each.share >= _LITTLE for each in process.left[:_CAUSES]),
        next=tuple(named(plan, _next(each)) for each in process.next[:_NEXT]), clearance=_clearance(plan, steps),
        unlisted=frozenset(steps[k].setup for k in steps if k not in largest),
    )  # fmt: skip


def _clearance(plan: Plan, steps: Mapping[int, schema.ProcessStep]) -> str:
    """The least clearance with its step, and how to have more; empty where none is known."""
    known = [(step.clearance_mm, step.slide is not None, k) for k, step in steps.items() if step.clearance_mm is not None]
    if not known:
        return ""
    least, _, k = min(known)
    wider, slide = least < schema.MARGIN and plan.effective.holder_clearance_mm < schema.MARGIN, steps[k].slide
    much = f"{mm(_FAR)} or more" if least >= _FAR else f"{mm(least)} in step {k}"
    if slide is not None:
        advice = f": the shank is as wide as the flutes and slides along {listed(slide.faces, _FACES)}; a relieved shank (neck) "
        advice += f"clears it, with {mm(slide.relieved_mm)} there"
    else:
        more = f"; plan with {mm(schema.MARGIN)}, and leave what that cannot reach: `--holder-clearance {schema.MARGIN:g}`"
        advice = more if wider else ""
    return f"Least clearance of neck, shank and holder: {much}{advice}."


def with_process_words(plan: Plan) -> Plan:
    """The plan with the words of its process made anew: of steps, of what each area that is left needs, and what to do next."""
    needed = [each.model_copy(update={"needs": needs(plan, each)}) for each in plan.process.left]
    steps = [
        step if step.own is None else step.model_copy(update={"own": step.own.model_copy(update={"text": fault(k, step)})})
        for k, step in enumerate(plan.process.steps, 1)
    ]
    setups = [each.model_copy(update={"text": stand_text(plan, each)}) for each in plan.process.setups]
    following = list(_next_entries(plan, plan.process, needed))
    # What mills need most comes first; a setup for holes is among those that are shown.
    following[1:1] = _for_holes(plan)
    following[:0] = _for_chamfers(plan)
    words = {"steps": steps, "setups": setups, "left": needed, "doubts": doubts(plan), "next": following}
    return plan.model_copy(update={"process": plan.process.model_copy(update=words)})


def _row(number: int, step: schema.ProcessStep, names: Mapping[str, str], *, setups: bool, fixed: bool, each: str) -> StepRow:
    turned = ""
    if fixed:
        by = step.repeat_deg or {}
        angles = each or angles_text(step.angles_deg or {}, by)
        turned = angles if step.mode == "fixed" else "simultaneous" if step.mode == "simultaneous" else "any angles"
        if step.mode == "simultaneous":
            turned += "".join(f", {name} + {angle:g}" for name, angle in by.items())
    what = " ".join(filter(None, (names.get(step.cutter, step.cutter), _STRATEGIES[step.strategy])))
    times = f"{step.repeat} x, " if step.repeat > 1 else ""
    longest = 26 if fixed else 40
    return StepRow(
        number=str(number), setup=f"setup {step.setup + 1}" if setups else "", turned=times + turned,
        cutter=what if len(what) <= longest else f"{what[: longest - 3]}...",
        share=percent(step.share, some=step.area_mm2 > 0.0), took=_took(step), at=step.setup, faces=step.faces,
        alone="" if step.alone_mm2 is None else area(step.alone_mm2), operation=step.operation,
    )  # fmt: skip


def _drilling_row(number: int, step: DrillingStep, *, setups: bool, fixed: bool) -> StepRow:
    return StepRow(
        number=str(number), setup=f"setup {step.setup + 1}" if setups else "", cutter=drilling_words(step),
        turned=angles_text(step.angles_deg or {}) if fixed else "", share=count(len(step.holes), "hole"), took=_took(step),
        at=step.setup, holes=len(step.holes),
    )  # fmt: skip


def _took(step: schema.ProcessStep | DrillingStep) -> str:
    return duration(None if step.seconds is None else step.seconds + step.link_seconds)


def stand_text(plan: Plan, setup: schema.ProcessSetup) -> str:
    """Say which way is up, what holds the part, and what it stands on."""
    on = "stock" if setup.stands_on == "stock" else listed(setup.stands_on or [], _FACES)
    if setup.grip_mm is not None:
        what = f" on {listed(setup.grips, _FACES)}" if setup.grips else ""
        fixture = Fixture.parse(setup.clamping or setup.held or "")
        clamping, along = fixture.clamping, fixture.stands_along(setup.up)
        if along != setup.up:
            what = f" along {_direction(along)}{what}"
        bored = isinstance(clamping, Vise) and clamping.bored
        across = f"{mm(setup.apart_mm or 0.0)} {'apart' if setup.held == 'vise' and not bored else 'wide'}"
        rests = f", rests on {on}" if setup.grips and on else ""
        high = f"{mm(setup.grip_mm)} high"
        if setup.contact_mm is not None:
            high = f"{mm(setup.contact_mm)} high by jaws that reach {mm(setup.grip_mm)} up"
        gripped = f"in soft jaws bored to it, {high}" if bored else f"gripped {high}"
        how = f"{'across' if bored else 'in'} a {setup.held}{what}, {across}, {gripped}{rests}"
    elif setup.held is None:
        are = "is" if len(setup.stands_on or ()) == 1 else "are"
        how = f"nothing holds it yet{f'; {on} {are} below' if on else ''}"
    else:
        held = "on a table" if setup.held == "table" else f"held by {setup.held}"
        how = f"{held}, {f'stands on {on}' if on else 'on no plane'}{'; its clamps are yours to add' * (setup.held == 'table')}"
    if on == "stock" and plan.process.stock is not None:
        stock = plan.process.stock
        wide = stock.size_mm[2] if _lies(stock) else stock.size_mm[0]
        long = max(stock.size_mm) if _lies(stock) else stock.size_mm[2]
        bar = f"a bar {mm(wide)} wide and {mm(long)} long{', lying,' * _lies(stock)}"
        how = f"{bar if stock.word.startswith('cylinder') else f'stock of {size(stock.size_mm)}'} {how}"
    soft = f"; it needs soft jaws or a nest: {setup.soft}" if setup.soft else ""
    return named(plan, f"Setup {setup.number}: {_direction(setup.up)} up, {how}{soft}.")


def _direction(along: Sequence[float]) -> str:
    """A direction of the part by the name of its axis, where it is one."""
    names = [
        f"{sign}{name}" for name, each in zip("XYZ", along, strict=True) for sign in "+-" if abs(each - float(f"{sign}1")) < 1e-9
    ]
    return names[0] if names else axis_words(along)


def _lies(stock: schema.StockEntry) -> bool:
    return stock.word.startswith("cylinder") and stock.size_mm[0] != stock.size_mm[1]


def roughing(process: schema.ProcessEntry) -> str:
    """How much of the stock is to be roughed, and in what time if that is known; empty where there is none."""
    stock = process.stock
    if stock is None:
        return ""
    took = "" if stock.seconds is None else f", {duration(stock.seconds)}"
    times, unit = (INCH**-3, "in³") if in_inches() else (0.001, "cm³")
    removed, whole = (
        f"{each:,.0f}" if each >= 100.0 else f"{each:.3g}" for each in (times * stock.remove_mm3, times * stock.volume_mm3)
    )
    return f"Roughing: {removed} of {whole} {unit} of stock{took}."


def _besides(process: schema.ProcessEntry) -> str:
    """The time between steps, which with theirs makes that of the process, or why that is not known; empty without any."""
    if unknown := [str(k) for k, step in enumerate(process.steps, 1) if step.seconds is None and process.plan == "fastest"]:
        steps = f"step{'s' * (len(unknown) > 1)} {listed(unknown, _FACES)}"
        return f"The time is not known: the width of a pass is not at some samples of {steps}."
    spent = ("tool changes", process.change_seconds), ("turns", process.index_seconds)
    each = [f"{what} {duration(seconds)}" for what, seconds in spent if seconds]
    return f"Between steps: {', '.join(each)}." if each else ""


def _fitting(faces: Sequence[str], width: int) -> str:
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


def _remaining(process: schema.ProcessEntry, plan: Plan) -> Iterator[Stays]:
    # Too small for a line, and for advice; what was not judged is none.
    minor = [e for e in process.left[1:] if e.area_mm2 < _SMALLEST and e.share < WORTH and e.cause != schema.UNJUDGED_CAUSE]
    listed_causes = [each for each in process.left if each not in minor][:_CAUSES]
    for each in listed_causes:
        faces = listed(each.faces, _FACES)
        near = f" near ({place(each.place_mm)})" if each.place_mm is not None else ""
        needs = f": {named(plan, each.needs)}" if each.needs else ""
        some = percent(each.share, some=True, whole=False) if each.samples else percent(each.share)
        cause = _OTHER_CAUSES.get(each.cause) or reason(each.cause)
        yield Stays("Left", some, f"{area(each.area_mm2)}, {cause}: {faces}{near}{needs}.")
    if len(process.left) > len(listed_causes):
        rest = [each for each in process.left if each not in listed_causes]
        yield Stays("Left besides", percent(sum(each.share for each in rest), some=True, whole=False), "for other causes.")
    if process.exempt is not None:
        where = listed(process.exempt.faces, _FACES)
        text = f"Not required (`--sharp-edges left`): {area(process.exempt.area_mm2)} at sharp inside edges of {where}."
        yield Stays("", "", text)


def _next_entries(
    plan: Plan, process: schema.ProcessEntry, remaining: Sequence[schema.RemainingEntry]
) -> Iterator[schema.NextEntry]:
    """The best next steps of the cutter that the plan shows, or the answer to ask for; `remaining` say what they need."""
    if all(each.cause == schema.UNJUDGED_CAUSE or each.needs == CLOSED_VOID for each in remaining):
        return
    left, sharp = 1.0 - process.finished_share, sum(each.share for each in process.left if each.cause == "sharp_edge")
    rounded = list[schema.NextEntry]()
    if sharp >= WORTH and plan.effective.sharp_edges == "asked":
        # It costs nothing, and no cutter makes a sharp inside edge. How much that leaves out is for the finest cutter to say.
        words = "leave sharp inside edges as the cutter rounds them, if the drawing lets you"
        rounded.append(schema.NextEntry(words=words, argv=["--sharp-edges", "left"], left_share=None))
        if left - sharp < WORTH:
            yield from rounded
            return
    others, most = _answered_entries(plan, process, left), process.left[0]
    # It comes second where a step is known that helps most of what is left for another cause.
    known = most.cause != "sharp_edge" and any(each.share >= _HELPED for each in most.helped)
    yield from chain(others, rounded) if known else chain(rounded, others)


def _for_holes(plan: Plan) -> Iterator[schema.NextEntry]:
    """The setup from which drills make most of the holes that they make in no setup of the plan."""
    if (more := plan.process.hole_setup) is not None:
        now = plan.process.setups
        cosine = sum(a * b for a, b in zip(more.axis, now[0].up, strict=True))
        turn = math.degrees(math.acos(max(-1.0, min(1.0, cosine))))
        words = f"{more_setup(more.axis, turn, 1 + len(now))} for {count(more.holes, 'hole')} that drills make there"
        yield schema.NextEntry(words=words, argv=more.argv, left_share=None)


def _for_chamfers(plan: Plan) -> Iterator[schema.NextEntry]:
    """The chamfer mill that takes the place of end mills that go along chamfers up and down."""
    if (mill := plan.process.chamfers) is not None:
        those = listed(mill.faces, _FACES)
        less = f"{duration(mill.saves)} less of the {duration(mill.seconds)} there"
        words = f"a chamfer mill of {mill.angle_deg:g}° for {those}: {less}"
        yield schema.NextEntry(words=words, argv=mill.argv, left_share=None)


def _answered_entries(plan: Plan, process: schema.ProcessEntry, left: float) -> Iterator[schema.NextEntry]:
    """The next steps that the answers know of, or the answer to ask for; `left`: the share that the process leaves."""
    advice = shown_cutter(plan).mend
    if advice is None:
        if "mend" not in plan.effective.answers:
            yield schema.NextEntry(words="ask what would help", argv=["--answers", "mend"], left_share=None)
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
        least = _LITTLE if "second_setup" in things[k] else WORTH
        if left - after[k] >= least - _ROUNDING and not alike:
            reported.append((things[k], after[k]))
            option = advice.steps[k].option
            yield schema.NextEntry(words=advice.steps[k].why, argv=shlex.split(option) if option else [], left_share=after[k])


def _next(each: schema.NextEntry) -> str:
    stays = "" if each.left_share is None else f": left {percent(each.left_share, some=each.left_share > 0.0)}"
    bracket = f" [`{shlex.join(each.argv)}`]" if each.argv else ""
    return f"Next: {each.words}{stays}{bracket}"


#: Where a sentence ends, and another begins.
_SENTENCE = re.compile(r"(?<=[.!?])\s+(?=[A-Z]|--)")


def wrapped(texts: Iterable[str], most: int) -> list[str]:
    """Paragraphs in lines of at most 80 columns, of each as many whole sentences as go into so many lines, and the first one.

    >>> wrapped(["One. " + "Two is long " * 8 + "and ends."], 1)
    ['One.']
    """
    lines: list[str] = []
    for text in texts:
        first, *others = _SENTENCE.split(text)
        mine = _lines(first)
        for each in others:
            first = f"{first} {each}"
            if len(longer := _lines(first)) > most:
                break
            mine = longer
        lines += mine
    return lines


def _lines(text: str) -> list[str]:
    return textwrap.wrap(text, WIDTH, subsequent_indent="  ", break_on_hyphens=False, break_long_words=True)


def own_steps(process: schema.ProcessEntry) -> Iterator[str]:
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


def fault(number: int, step: schema.ProcessStep) -> str:
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
        cause = "it needs another orientation" if worst.cause == schema.OTHER_ORIENTATION else reason(worst.cause)
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
