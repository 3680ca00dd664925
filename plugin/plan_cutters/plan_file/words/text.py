"""The text that stands in a plan file: made once, when the plan is made, and shown by every reader."""

from plan_cutters.domain.figures import count
from plan_cutters.domain.lengths import reporting
from plan_cutters.plan_file.model import CutterEntry, Plan, TextEntry, VerdictText
from plan_cutters.plan_file.words.chip import TONES, chip, cutter_chip
from plan_cutters.plan_file.words.cutters import CutterStory
from plan_cutters.plan_file.words.doubts import repeated_warnings
from plan_cutters.plan_file.words.patterns import in_summary
from plan_cutters.plan_file.words.process import shortened, with_process_words, wrapped
from plan_cutters.plan_file.words.scope import not_judged, not_seen, unseen
from plan_cutters.plan_file.words.story import Story, story_of
from plan_cutters.plan_file.words.undecided import undecided

#: Most lines: with the headline and the path of the page they are 25 in a terminal.
MOST = 22
#: Doubts, and cutters, that are named.
_DOUBTS, _CUTTERS = 4, 6
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
    return TextEntry(
        headline=f"{story.headline.title}.",
        tone=TONES[chip(plan, story)],
        lines=process_lines(plan, story, MOST),
        cutters={each.id: each.sentence for each in story.cutters},
        verdicts={each.id: _verdict(plan, each) for each in plan.cutters},
        shares={each.id: each.shares for each in story.cutters},
    )


def process_lines(plan: Plan, story: Story, most: int) -> list[str]:
    """The process below the headline, at most so many lines of 80 columns: what makes it unsure, steps, what is left, next."""
    process = story.process
    inside = [f"Inside other bodies: {' '.join(story.inside)}"] if story.inside else []
    judged = " ".join(filter(None, (story.headline.about, *not_judged(plan))))
    blocks: list[list[str]] = [
        wrapped(plan.process.doubts if plan.process else [], 2),
        [*wrapped(inside, 6), *wrapped(_doubts(plan, story), 1)[:_DOUBTS], *wrapped([judged] if judged else [], 3)],
        wrapped([in_summary(plan)] if process and in_summary(plan) else [], 2),
        process.table() if process else [],
        wrapped([*shortened(process.own), *process.remaining[: process.much]], _LEFT) if process else [],
        wrapped(list(process.next), 3) if process else [],
        wrapped(list(process.remaining[process.much :]), _LEFT) if process else [],
        wrapped(_unsure(plan, story), 2),
        wrapped([process.clearance] if process and process.clearance else [], 1),
        wrapped(_alone(story), _ALONE),
        wrapped([story.headline.why] if story.headline.why else [], 2),
        wrapped(list(story.between[:1]), 2),
        _remaining(plan, story),
    ]
    lines: list[str] = []
    for block in blocks:
        lines += block
    return lines if len(lines) <= most else [*lines[: most - 1], "More: -v, or the review page."]


def _doubts(plan: Plan, story: Story) -> list[str]:
    """What makes the verdicts unsure, but for warnings that stand above in other words."""
    above = {f"{text}." for text in repeated_warnings(plan)} if plan.process else set()
    return [f"{line.mark} {line.text}" for lines in story.doubts.values() for line in lines if line.text not in above]


def _unsure(plan: Plan, story: Story) -> list[str]:
    """What is undecided, and not seen between the samples."""
    return [*undecided(plan, story.names), *(not_seen(plan, story.names) if unseen(plan) else [])]


def _alone(story: Story) -> list[str]:
    """How much each of several cutters reaches by itself, and why no more."""
    if len(story.cutters) < 2:
        return []
    each = [f"{c.name} {_alone_reaches(c)}" for c in story.cutters]
    for shown in range(min(_CUTTERS, len(each)), 0, -1):
        more = f" and {len(each) - shown} more" if len(each) > shown else ""
        text = f"Each alone reaches: {', '.join(each[:shown])}{more}."
        if len(wrapped([text], len(text))) <= _ALONE:
            break
    return [text]


def _alone_reaches(cutter: CutterStory) -> str:
    if cutter.feasible:
        return "all"
    return f"{cutter.reached} ({cutter.reason})" if cutter.reason else cutter.reached


def _remaining(plan: Plan, story: Story) -> list[str]:
    """How many notes there are that are not shown."""
    number = len(story.notes) + len(story.setups) + len(story.answers)
    return [f"{count(number, 'note')}: -v, or the review page."] if number else []


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


def _verdict(plan: Plan, cutter: CutterEntry) -> VerdictText:
    chip = cutter_chip(plan, cutter)
    return VerdictText(tone=TONES[chip], word=chip.word)
