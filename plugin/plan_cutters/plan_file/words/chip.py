"""The verdict on a part or a cutter in a word with a sign: what a reader sees first, by colour, sign and word."""

from typing import NamedTuple

from plan_cutters.plan_file.model import Plan
from plan_cutters.plan_file.words.headline import could_not
from plan_cutters.plan_file.words.scope import not_seen
from plan_cutters.plan_file.words.story import Story


class Chip(NamedTuple):
    """A kind (`good`, `unsure` or `bad`: its colours), a sign, and a word."""

    kind: str
    sign: str
    word: str


#: Of a cutter: feasible, not, undecided.
CHIPS = {
    True: Chip("good", "✓", "Feasible"),
    False: Chip("bad", "✕", "Not feasible"),
    None: Chip("unsure", "?", "Undecided"),
}


def chip(plan: Plan, story: Story) -> Chip:
    """The verdict on the part. Feasible without more words is only what the exit code calls so, too."""
    good = story.headline.good
    if good:
        unseen = plan.effective.sampled_by == "default" and not_seen(plan, story.names)
        return Chip("unsure", "!", "Feasible where judged") if could_not(plan) or unseen else CHIPS[True]
    if good is None and story.taken:
        return Chip("unsure", "◐", "Feasible in part")
    return CHIPS[good]
