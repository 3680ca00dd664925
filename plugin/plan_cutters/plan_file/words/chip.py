"""The verdict on a part or a cutter in a word with a sign: what a reader sees first, by colour, sign and word."""

from typing import NamedTuple

from plan_cutters.plan_file.model import CutterEntry, Plan, Tone
from plan_cutters.plan_file.words.headline import could_not
from plan_cutters.plan_file.words.scope import unseen
from plan_cutters.plan_file.words.story import Story


class Chip(NamedTuple):
    """A kind (`good`, `unsure` or `bad`: its colours), a sign, and a word."""

    kind: str
    sign: str
    word: str


#: Of a cutter: feasible, not, undecided.
CHIPS = {True: Chip("good", "✓", "Feasible"), False: Chip("bad", "✕", "Not feasible"), None: Chip("unsure", "?", "Undecided")}
#: Where it says more than that.
_WHERE_JUDGED = Chip("unsure", "!", "Feasible where judged")
_IN_PART = Chip("unsure", "◐", "Feasible in part")
#: The tone of a text, by its chip.
TONES: dict[Chip, Tone] = {
    CHIPS[True]: "good",
    CHIPS[False]: "bad",
    CHIPS[None]: "unsure",
    _WHERE_JUDGED: "unsure",
    _IN_PART: "partly",
}


def chip(plan: Plan, story: Story) -> Chip:
    """The verdict on the part. Feasible without more words is only what the exit code calls so, too."""
    good = story.headline.good
    if good:
        return _WHERE_JUDGED if could_not(plan) or unseen(plan) else CHIPS[True]
    if good is None and not (plan.process is not None and plan.process.finished) and any(c.blocked for c in plan.cutters):
        return _IN_PART
    return CHIPS[good]


def cutter_chip(plan: Plan, cutter: CutterEntry) -> Chip:
    """The verdict on a cutter. As of the part: feasible without more words only where all was judged and seen."""
    unseen = plan.effective.sampled_by == "default" and not cutter.seen
    return _WHERE_JUDGED if cutter.feasible and (unseen or could_not(plan)) else CHIPS[cutter.feasible]
