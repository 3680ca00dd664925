"""The text that stands in a plan file: made once, when the plan is made, and shown by every reader."""

import textwrap
from collections.abc import Iterator

from plan_cutters.plan_file.model import CutterEntry, Plan, TextEntry, VerdictText
from plan_cutters.plan_file.numbers import count
from plan_cutters.plan_file.words.chip import TONES, chip, cutter_chip
from plan_cutters.plan_file.words.story import Story, story_of

#: Columns of a line, and the most lines.
WIDTH, MOST = 80, 25


def with_text(plan: Plan) -> Plan:
    """The plan with its text, made anew of all that it says by now."""
    return plan.model_copy(update={"text": text_of(plan)})


def text_of(plan: Plan) -> TextEntry:
    """Put a plan into a few lines; what stands in short above is not said again below."""
    story = story_of(plan)
    return TextEntry(
        headline=f"{story.headline.title}.",
        tone=TONES[chip(plan, story)],
        lines=_lines([*filter(None, dict.fromkeys(each.strip() for each in sentences(story)))]),
        cutters={each.id: each.sentence for each in story.cutters},
        verdicts={each.id: _verdict(plan, each) for each in plan.cutters},
        shares={each.id: each.shares for each in story.cutters},
    )


def sentences(story: Story) -> Iterator[str]:
    """All that people read of a plan unless they ask for more, below the headline; what makes it unsure comes first."""
    # It comes first, for what follows is about the rest.
    yield from story.inside
    yield from (story.headline.about, story.headline.why)
    yield from of_the_plan(story)
    yield from (each.sentence for each in story.cutters)
    yield from further(story)


def of_the_plan(story: Story) -> list[str]:
    """Sentences on the plan as a whole: its setups and orientations, its scope, and all doubts."""
    doubts = [f"{line.mark} {line.text}" for lines in story.doubts.values() for line in lines]
    return [*story.proposal, *story.in_short, *story.scope, *story.between, *doubts]


def further(story: Story) -> list[str]:
    """Lines that follow those on the cutters: setups, operations, answers and notes, but for the minor ones."""
    lines = (*story.setups, *story.operations, *story.answers, *story.notes)
    return [f"{line.mark} {line.text}{line.typed}".lstrip() for line in lines if not line.minor]


def _verdict(plan: Plan, cutter: CutterEntry) -> VerdictText:
    chip = cutter_chip(plan, cutter)
    return VerdictText(tone=TONES[chip], word=chip.word)


def _lines(texts: list[str]) -> list[str]:
    """As many whole texts as there is room for; the last line says how many more there are."""
    lines: list[str] = []
    for place, text in enumerate(texts):
        mine = textwrap.wrap(text, WIDTH, break_on_hyphens=False)
        last = place == len(texts) - 1
        if len(lines) + len(mine) > MOST - (not last):
            return [*lines, f"{count(len(texts) - place, 'more sentence')} in the review page."]
        lines += mine
    return lines
