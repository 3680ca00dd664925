"""Check a written plan of operations by means of its own: exact surfaces, an own tool, own kinematics, own sums.

Nothing here is shared with the search that made the plan. What is found is one line for each statement of the plan, whether it
holds, and how much of it was looked at; what no statement covers is listed as unchecked.
"""

import time
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

from plan_cutters.checker.bench import Bench
from plan_cutters.checker.clash import Clock
from plan_cutters.checker.expected import Reckoned
from plan_cutters.checker.findings import Answer, Finding
from plan_cutters.checker.leaves import Compared, compared
from plan_cutters.checker.moving import ill_formed
from plan_cutters.checker.paper import Paper
from plan_cutters.checker.patterns import Patterns
from plan_cutters.checker.question import Question
from plan_cutters.checker.reading import faults
from plan_cutters.checker.trials import Trials
from plan_cutters.errors import OptionError

#: Seconds that a check takes at most unless another time is set, and the share of them by which each of its parts must be done.
SECONDS = 60.0
_PARTS = {"placed": 0.35, "weights": 0.65, "covered": 0.8, "alone": 0.9, "clearance": 1.0}


def check(question: Question, *, seconds: float = SECONDS, tell: Callable[[str], None] = lambda doing: None) -> Answer:
    """Check the operations of a plan.

    Parameters
    ----------
    question : Question
    seconds : float
        What is not done after these is listed as not checked, with how much was; all samples of the labels are looked at in the
        order of a random draw with seed 0.
    tell : callable
        Called with what is being done.

    Raises
    ------
    OptionError
        The plan has no operations.
    """
    if not isinstance(question.document.get("operations"), dict):
        raise OptionError("the plan has no operations: make it with --operations")
    wrong = [Finding(False, each) for each in faults(question)]
    if wrong:
        return Answer(tuple(wrong), Compared())
    try:
        return _answer(question, seconds, tell)
    except (KeyError, TypeError, ValueError, IndexError, AttributeError, OverflowError) as error:
        line = f"The plan contradicts its own form ({type(error).__name__}: {' '.join(str(error).split())})."
        return Answer((Finding(False, line),), Compared())


def _answer(question: Question, seconds: float, tell: Callable[[str], None]) -> Answer:
    start, rng, reckoned = time.monotonic(), np.random.default_rng(0), Reckoned(question)
    findings = [*Paper(question, reckoned, rng).findings(), *Patterns(question).findings()]
    findings += ill_formed(question, reckoned)
    entry = reckoned.entry()
    first = _compared(question, findings, entry)
    if not first.holds:
        last = Finding(None, "No tool was put down: what is written contradicts itself, or the part, already.")
        return Answer((*first.findings, last), first.entries)
    bench = Bench(question, tell)
    trials = Trials(question, reckoned, bench, rng, lambda part: Clock(start + seconds * _PARTS[part]), tell)
    findings += trials.findings(entry)
    return _compared(question, findings, entry)


def _compared(question: Question, findings: Iterable[Finding], entry: dict[str, Any]) -> Answer:
    """The findings, with those of the entries of plan.json."""
    entries = compared(entry, question.document["operations"])
    unknown = [f"operations.{path} is an entry that this checker does not know." for path in entries.unknown]
    wrong = [Finding(False, words) for words in (*unknown, *(f"operations.{line}." for line in entries.differ))]
    right = Finding(
        True,
        f"{len(entries.agree)} numbers and words of the plan follow from its samples and labels, "
        f"{len(entries.unchecked)} are not checked.",
    )
    return Answer((*findings, *(wrong or [right])), entries)
