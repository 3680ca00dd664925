"""Test cases of many parts: one for each."""

from plan_cutters.cases import case
from plan_cutters.cases.case import Case
from plan_cutters_batch.row import PartRow
from plan_cutters_batch.summary import Outcome, cause, outcome

#: What is not sure is neither reached nor known not to be.
_OUTCOMES: dict[Outcome, case.Outcome] = {"failed": "error", "not_finished": "failure", "not_sure": "error", "finished": "passed"}


def part_case(row: PartRow) -> Case:
    """The case of a part: an error without an answer or where the answer is not sure, a failure where it is not finished.

    >>> part_case(PartRow(name="a", file="in/a.step", status="failed", code=124, error="not done within 9 s")).outcome
    'error'
    """
    result = outcome(row)
    if result == "finished":
        return Case(row.file, row.name, seconds=row.seconds)
    text = cause(row) if result == "failed" else row.verdict
    kind = f"exit_code_{row.code}" if result == "failed" else row.reason or result
    return Case(row.file, row.name, _OUTCOMES[result], kind, text, row.error or "" if result != "failed" else "", row.seconds)
