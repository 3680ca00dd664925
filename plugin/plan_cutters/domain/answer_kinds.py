"""The questions that a plan may answer beside its verdicts: the only table of their words.

To add one, add its row here, its work to `answers.ask`, and its sentence to `plan_file.words.answers`; a new kind of record needs
its entry in `plan_file.answers` and `document.answers`, too.
"""

from typing import NamedTuple


class AnswerKind(NamedTuple):
    """A question: its word, its meaning for the help, and the name of its work."""

    word: str
    meaning: str
    work: str


KINDS = (
    AnswerKind("stick-out", "how short each cutter can be held", "asking for the least stick-out"),
    AnswerKind("radius", "the largest flat and ball end that reaches each sample", "asking for the largest radius"),
    AnswerKind(
        "mend",
        "the next steps where no cutter finishes, and their gain, for the three that come nearest",
        "asking what to do next",
    ),
)
#: What takes less off what is left is no advice, a share of the area.
WORTH = 0.001
ANSWERS = tuple(each.word for each in KINDS)
