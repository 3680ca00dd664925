"""Check a written plan of operations by means of its own: exact surfaces, an own tool, own kinematics, own sums.

Nothing here is shared with the search that made the plan. The answer is a line for each statement of the plan, whether it holds,
and how much of it was looked at; what no statement covers is named as not checked.
"""

import time
from collections.abc import Callable
from dataclasses import replace

from plan_cutters_check import drilling, fixtures, paper, trials
from plan_cutters_check.bench import Bench
from plan_cutters_check.findings import Answer, Compared, Finding
from plan_cutters_check.question import Question, require_operations
from plan_cutters_check.reckoned import Reckoned
from plan_cutters_check.records import document_of
from plan_cutters_check.surface import Clock

#: Seconds that a check takes at most unless another time is set, and the shares of them by which operations, drills and postures
#: of verdicts must be put down.
SECONDS, _UNTIL = 60.0, (0.6, 0.8, 1.0)


def check(question: Question, *, seconds: float = SECONDS, tell: Callable[[str], None] = lambda doing: None) -> Answer:
    """Check the operations of a plan; `tell` is called with what is being done.

    What is not done after so many seconds is listed as not checked, with how much was.

    Raises OptionError: the plan has no operations.
    """
    require_operations(question.document)
    wrong = [Finding(False, each) for each in paper.faults(question)]
    if wrong:
        return Answer(tuple(wrong), Compared())
    try:
        return _answer(question, seconds, tell)
    except (KeyError, TypeError, ValueError, IndexError, AttributeError, OverflowError) as error:
        line = f"The plan contradicts its own form ({type(error).__name__}: {' '.join(str(error).split())})."
        return Answer((Finding(False, line),), Compared())


def _answer(question: Question, seconds: float, tell: Callable[[str], None]) -> Answer:
    start, reckoned = time.monotonic(), Reckoned(question)
    findings = [*paper.findings(reckoned), *(Finding(False, f"{each}.") for each in fixtures.faults(question))]
    findings += paper.unsound(reckoned)
    expected = document_of(reckoned)
    first = _compared(question, findings, Compared().compare(expected, question.document))
    if not first.holds:
        none = Finding(None, "No tool was put down: what is written contradicts itself, or the part, already.")
        return replace(first, findings=(*first.findings, none))
    bench = Bench(fixtures.resting(question), tell)
    operations, drills, verdicts = (Clock(start + seconds * share) for share in _UNTIL)
    if bench.unread:
        findings.append(Finding(None, f"Nothing is known of what {', '.join(bench.unread)} are in the way of."))
    if bench.hollow:
        findings.append(Finding(None, f"Whether a tool stands wholly within {', '.join(bench.hollow)} is not looked at."))
    findings += trials.placed(reckoned, bench, operations, tell, expected["operations"])
    findings += drilling.findings(question, bench, drills)
    findings += trials.postures(reckoned, bench, verdicts)
    return _compared(question, findings, Compared().compare(expected, question.document))


def on_paper(question: Question) -> Answer:
    """The part of a check that is about what plan.json says: no array is looked at by itself, and no tool is put down."""
    reckoned = Reckoned(question)
    return _compared(question, [*paper.unsound(reckoned)], Compared().compare(document_of(reckoned), question.document))


def _compared(question: Question, findings: list[Finding], entries: Compared) -> Answer:
    """The findings, with those of the entries of plan.json."""
    agree, unchecked = len(entries.agree), len(entries.unchecked)
    right = f"{agree} numbers and words of the plan follow from its samples and labels, {unchecked} are not checked."
    last = [Finding(False, f"{each}.") for each in entries.differ] or [Finding(True, right)]
    return Answer((*findings, *last), entries, question.asked)
