"""Check a written plan of operations by means of its own: exact surfaces, an own tool, own kinematics, own sums.

Nothing here is shared with the search that made the plan. The answer is a line for each statement of the plan, whether it holds,
and how much of it was looked at; what no statement covers is named as not checked.
"""

import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from plan_cutters_check import drilling, fixtures
from plan_cutters_check.bench import Bench
from plan_cutters_check.findings import Answer, Compared, Finding
from plan_cutters_check.paper import Paper, faults, ill_formed, unsound
from plan_cutters_check.question import Question, require_operations
from plan_cutters_check.reckoned import Reckoned
from plan_cutters_check.records import document_of
from plan_cutters_check.surface import Clock
from plan_cutters_check.trials import Trials

#: Seconds that a check takes at most unless another time is set, and the share of them by which each of its parts must be done.
SECONDS = 60.0
_PARTS = {"placed": 0.35, "weights": 0.6, "covered": 0.75, "alone": 0.85, "verdicts": 0.9, "clearance": 1.0}


def check(question: Question, *, seconds: float = SECONDS, tell: Callable[[str], None] = lambda doing: None) -> Answer:
    """Check the operations of a plan; `tell` is called with what is being done.

    What is not done after so many seconds is listed as not checked, with how much was; all samples of the labels are looked at in
    the order of a random draw with seed 0.

    Raises OptionError: the plan has no operations.
    """
    require_operations(question.document)
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
    findings = [*Paper(reckoned, rng).findings(), *ill_formed(reckoned)]
    findings += (Finding(False, f"{each}.") for each in fixtures.faults(question))
    findings += unsound(reckoned)
    expected = document_of(reckoned)
    first = _compared(question, findings, Compared().compare(expected, question.document))
    if not first.holds:
        last = Finding(None, "No tool was put down: what is written contradicts itself, or the part, already.")
        return replace(first, findings=(*first.findings, last))
    bench = Bench(fixtures.resting(question), tell)
    clock = {part: Clock(start + seconds * share) for part, share in _PARTS.items()}
    findings += drilling.findings(question, bench, clock["clearance"])
    findings += Trials(reckoned, bench, rng, clock.__getitem__, tell).findings(expected["operations"])
    return _compared(question, findings, Compared().compare(expected, question.document))


def on_paper(question: Question) -> Answer:
    """The part of a check that is about what plan.json says: no array is looked at by itself, and no tool is put down."""
    reckoned = Reckoned(question)
    return _compared(question, [*unsound(reckoned)], Compared().compare(document_of(reckoned), question.document))


def _compared(question: Question, findings: list[Finding], entries: Compared) -> Answer:
    """The findings, with those of the entries of plan.json."""
    agree, unchecked = len(entries.agree), len(entries.unchecked)
    right = f"{agree} numbers and words of the plan follow from its samples and labels, {unchecked} are not checked."
    last = [Finding(False, f"{each}.") for each in entries.differ] or [Finding(True, right)]
    return Answer((*findings, *last), entries, question.asked)
