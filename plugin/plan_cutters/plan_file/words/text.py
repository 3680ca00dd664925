"""A plan put into words, once, and the text that stands in its file: every reader lays these out."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import NamedTuple

from plan_cutters.domain.figures import count, listed, reporting, sentence
from plan_cutters.plan_file.model import Plan, TextEntry, Tone, VerdictText
from plan_cutters.plan_file.operations import MARGIN
from plan_cutters.plan_file.words import headline as first
from plan_cutters.plan_file.words import notes
from plan_cutters.plan_file.words.answers import answers, together
from plan_cutters.plan_file.words.cutters import CutterStory, cutter_story
from plan_cutters.plan_file.words.holes import holes, missing_tools
from plan_cutters.plan_file.words.names import Line, as_fields, named, short_names, typed
from plan_cutters.plan_file.words.notes import repeated_warnings
from plan_cutters.plan_file.words.operations import in_short, one_more, operations
from plan_cutters.plan_file.words.process import ProcessStory, process_story, shortened, with_process_words, wrapped


@dataclass(frozen=True, slots=True)
class Story:
    """A story puts a plan into words, in the order in which people read them."""

    names: Mapping[str, str]  #: Those of cutters in the texts, by id.
    taken: str | None  #: Id of the cutter that the headline says to take, if any.
    shown: str  #: Id of the one that the models show.
    inside: tuple[str, ...]  #: Surface that does not belong to the finished part, which comes first.
    headline: first.Headline
    process: ProcessStory
    proposal: tuple[str, ...]
    in_short: tuple[str, ...]  #: What the plan of operations leaves, and how many orientations it needs.
    scope: tuple[str, ...]  #: What is undecided, which faces were not judged or not seen, what the cutters reach together.
    between: tuple[str, ...]  #: How much is known between the samples.
    cutters: tuple[CutterStory, ...]
    setups: tuple[Line, ...]
    operations: tuple[Line, ...]
    answers: tuple[Line, ...]
    doubts: Mapping[str, tuple[Line, ...]]  #: Causes that make verdicts unsure, by their kind in the plural.
    notes: tuple[Line, ...]

    def cutter(self, name: str) -> CutterStory:
        """The story of a cutter, by its id."""
        return next(each for each in self.cutters if each.id == name)


@reporting(lambda plan: plan.effective.units)
def story_of(plan: Plan) -> Story:
    """Tell a plan."""
    names, best = short_names(plan), first.shown_cutter(plan)
    cutters = tuple(cutter_story(plan, c, names[c.id]) for c in plan.cutters)
    finished = plan.selected or plan.selected_over_setups
    pair = "" if finished else together(plan)
    scope = (
        *first.undecided(plan, names), *holes(plan), *first.sharp_edges(plan, names), *first.inside_radii(plan, names),
        *first.not_judged(plan), *first.not_seen(plan, names), *([sentence(named(plan, pair))] if pair else []),
    )  # fmt: skip
    return Story(
        names=names, taken=finished or plan.selected_for_setup, shown=best.id,
        inside=tuple(named(plan, line) for line in first.inside(plan)), headline=first.headline(plan, names),
        process=process_story(plan, names), proposal=first.proposal(plan), in_short=tuple(in_short(plan)), scope=scope,
        between=tuple(each.between for each in cutters if each.between), cutters=cutters,
        setups=(*notes.setups(plan, best), *notes.travel(plan, best)), operations=tuple(operations(plan)),
        answers=tuple(answers(plan)), doubts=notes.unsure(plan),
        notes=(notes.side(plan), *map(Line, first.patterns(plan)), *notes.libraries(plan), *notes.notes(plan)),
    )  # fmt: skip


class Chip(NamedTuple):
    """The tone of a text, a sign, and a word."""

    tone: Tone
    sign: str
    word: str

    @property
    def kind(self) -> str:
        """`good`, `unsure` or `bad`: its colours."""
        return "unsure" if self.tone == "partly" else self.tone


#: Of a cutter: feasible, not, undecided.
CHIPS = {True: Chip("good", "✓", "Feasible"), False: Chip("bad", "✕", "Not feasible"), None: Chip("unsure", "?", "Undecided")}
#: Where it says more than that.
_WHERE_JUDGED, _IN_PART = Chip("unsure", "!", "Feasible where judged"), Chip("partly", "◐", "Feasible in part")


def chip(plan: Plan, story: Story) -> Chip:
    """The verdict on the part. Feasible without more words is only what the exit code calls so, too."""
    good = story.headline.good
    if good and (first.could_not(plan) or first.unseen(plan)):
        return _WHERE_JUDGED
    if good is None and not plan.process.finished and any(c.blocked for c in plan.cutters):
        return _IN_PART
    return CHIPS[good]


#: Most lines: with the headline and the path of the page they are 25 in a terminal.
MOST = 22
#: Doubts, and cutters, that are named.
_DOUBTS, _CUTTERS = 4, 6
#: Steps that are listed where there is no space for more, and then fewer.
_FEWER = (*range(14, 2, -2), 2)
#: Lines on an area that is left.
_LEFT = 3
#: Lines on what each cutter reaches by itself.
_ALONE = 3


@reporting(lambda plan: plan.effective.units)
def with_text(plan: Plan) -> Plan:
    """The plan with its text and the words of its process, made anew of all that it says by now."""
    plan = with_process_words(plan)
    return plan.model_copy(update={"text": text_of(plan)})


@reporting(lambda plan: plan.effective.units)
def text_of(plan: Plan) -> TextEntry:
    """Put a plan into a few lines."""
    story = story_of(plan)
    # As of the part: feasible without more words only where all was judged and seen.
    default, judged = plan.effective.sampled_by == "default", not first.could_not(plan)
    unsure = {c.id: bool(c.feasible) and not (judged and (c.seen or not default)) for c in plan.cutters}
    chips = {c.id: _WHERE_JUDGED if unsure[c.id] else CHIPS[c.feasible] for c in plan.cutters}
    return TextEntry(
        headline=f"{story.headline.title}.", tone=chip(plan, story).tone, lines=process_lines(plan, story),
        cutters={each.id: each.sentence for each in story.cutters}, shares={each.id: each.shares for each in story.cutters},
        verdicts={name: VerdictText(tone=each.tone, word=each.word) for name, each in chips.items()},
    )  # fmt: skip


def process_lines(plan: Plan, story: Story, write: Callable[[str], str] = as_fields, most: int = MOST) -> list[str]:
    """The process below the headline, at most so many lines of 80 columns: what makes it unsure, steps, what is left, next.

    What is left comes before the last steps of a long table, if there is no space for both; before that give way a second next
    step, and a small clearance. `write`: how options are written:
    `typed` for a terminal; other readers have fields of these names.
    """
    more = "-v, or the review page" if write is typed else "see the review page"
    lines = list[str]()
    for steps, tight in product((None, *_FEWER), (False, True)):
        shorter = story if steps is None else replace(story, process=process_story(plan, story.names, steps))
        lines, whole = _fitting(list(_paragraphs(plan, shorter, write, more, tight=tight)), most, f"More: {more}.")
        if whole:
            break
    return lines


def _paragraphs(
    plan: Plan, story: Story, write: Callable[[str], str], more: str, *, tight: bool
) -> Iterator[tuple[int, list[str]]]:
    """Lines of each sentence, with its rank: those of rank 0 are in every text, but for some that are not if space is tight."""
    process, small = (
        story.process,
        any(step.clearance_mm is not None and step.clearance_mm < MARGIN for step in plan.process.steps),
    )

    def each(texts: Iterable[str], most: int, rank: int = 2) -> list[tuple[int, list[str]]]:
        return [(rank, wrapped([write(text)], most)) for text in texts if text]

    yield from each(plan.process.doubts, 2, 0)
    yield from each([f"Inside other bodies: {text}" for text in story.inside[:1]], _LEFT, 1)
    yield from each([" ".join(story.inside[1:])], 5)
    yield from each(_doubts(plan, story)[:_DOUBTS], 1, 1)
    yield from each([" ".join(filter(None, (story.headline.about, *first.not_judged(plan))))], 3, 1)
    yield from each([first.in_summary(plan)], 2, 1)
    yield from ((0, [line]) for line in ([process.roughing] if process.roughing else []) + process.table())
    of_holes, lack = [*holes(plan)], bool(missing_tools(plan))
    yield from each(of_holes[:1], 2, 1)
    yield from each(of_holes[1:], 3 if lack else 2, 0 if lack else 1)
    if plan.process.plan == "fewest":
        yield from each([named(plan, one_more(plan.operations))], 3)
    stays = [", ".join(filter(None, each)) for each in process.remaining]
    left = [*shortened(process.own), *stays[: process.much]]
    yield from each(left[:1], _LEFT, 0)
    yield from each(left[1:], _LEFT)
    yield from each(process.next[:1], 3, 0)
    yield from each(process.next[1:], 3, 2 if tight or plan.process.hole_setup is None else 0)
    yield from each(stays[process.much :], _LEFT, 2 if left else 1)
    unseen = first.not_seen(plan, story.names) if first.unseen(plan) else []
    yield from each([*first.undecided(plan, story.names), *unseen], 2, 1)
    yield from each([process.clearance], 1, 0 if small and not tight else 1)
    yield from each(_alone(story), _ALONE)
    yield from each([story.headline.why], 2)
    yield from each(story.between[:1], 2)
    unshown = len(story.notes) + len(story.setups) + len(story.answers)
    yield from each([f"{count(unshown, 'note')}: {more}."] if unshown else [], 1)


def _fitting(paragraphs: Sequence[tuple[int, list[str]]], most: int, more: str) -> tuple[list[str], bool]:
    """Lines of as many paragraphs as fit, by their rank, each whole, for a sentence that is cut says something else; and whether
    those of rank 0 are among them."""
    if sum(len(lines) for _, lines in paragraphs) <= most:
        return [line for _, lines in paragraphs for line in lines], True
    space, shown = most - 1, set[int]()
    for k in sorted(range(len(paragraphs)), key=lambda k: paragraphs[k][0]):
        if len(paragraphs[k][1]) <= space:
            shown.add(k)
            space -= len(paragraphs[k][1])
    whole = all(k in shown for k, (rank, _) in enumerate(paragraphs) if rank == 0)
    return [*(line for k in sorted(shown) for line in paragraphs[k][1]), more], whole


def _doubts(plan: Plan, story: Story) -> list[str]:
    """What makes the verdicts unsure, but for warnings that stand above in other words."""
    above = {f"{text}." for text in repeated_warnings(plan)}
    return [f"{line.mark} {line.text}" for lines in story.doubts.values() for line in lines if line.text not in above]


def _alone(story: Story) -> list[str]:
    """How much each of several cutters reaches by itself, and why no more."""
    if len(story.cutters) < 2:
        return []
    why = {c.id: f" ({c.reason})" if c.reason else "" for c in story.cutters}
    each = [f"{c.name} {'all' if c.feasible else f'{c.reached}{why[c.id]}'}" for c in story.cutters]
    for shown in range(min(_CUTTERS, len(each)), 0, -1):
        text = f"Each alone reaches: {listed(each, shown)}."
        if len(wrapped([text], len(text))) <= _ALONE:
            break
    return [text]


def before_approval(story: Story) -> list[str]:
    """A reviewer of a process looks at these first: the least clearance, and how much is proved between the samples."""
    return [*filter(None, [story.process.clearance]), *map(str.strip, wrapped(story.between[:1], 2))]


def of_the_plan(story: Story) -> list[str]:
    """Sentences on the plan as a whole: its setups and orientations, its scope, and all doubts."""
    doubts = [f"{line.mark} {line.text}" for lines in story.doubts.values() for line in lines]
    return [*story.proposal, *story.in_short, *story.scope, *story.between, *doubts]


def further(story: Story) -> list[str]:
    """Lines that follow those on the cutters: setups, operations, answers and notes, but for the minor ones.

    What `of_the_plan` has in short is not said again.
    """
    operations = (line for line in story.operations if line.text not in story.in_short)
    lines = (*story.setups, *operations, *story.answers, *story.notes)
    return [f"{line.mark} {line.text}{line.typed}".lstrip() for line in lines if not line.minor]
