"""A part that changed is a row: what became of it, by which rule it fails, and its test cases."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from plan_cutters_ci.repository import Changed

if TYPE_CHECKING:
    from plan_cutters.cases.case import Case
    from plan_cutters_ci.model import PlanDifference

#: Rules by which the command fails, each one stricter than the one before it.
RULES = ("none", "lost", "unreachable", "not-comparable")


@dataclass(frozen=True, slots=True)
class Row:
    """A part that changed: its folders of plans before and after, the difference, or why there is none."""

    part: Changed
    before: Path | None = None
    after: Path | None = None
    difference: "PlanDifference | None" = None
    #: The page of both plans, below the output folder, where they differ.
    beside: Path | None = None
    #: Target faces as it is that no cutter reaches whole.
    unreachable: tuple[str, ...] = ()
    #: Why it could not be planned as it is, or as it was.
    failed: str = ""
    unread: str = ""

    def breaks(self, rule: str) -> bool:
        """Whether the part fails by a rule."""
        at = RULES.index(rule)
        worse = self.difference is not None and self.difference.lost
        doubtful = bool(self.unread) or (self.difference is not None and not self.difference.comparable)
        return (at >= 1 and (worse or bool(self.failed))) or (at >= 2 and bool(self.unreachable)) or (at >= 3 and doubtful)


def row_cases(row: Row, rule: str) -> "Iterator[Case]":
    """The test cases of a part; what the rule lets pass is skipped, so that the report agrees with the exit code."""
    from plan_cutters.cases.case import Case
    from plan_cutters.domain.figures import listed
    from plan_cutters_ci.cases import difference_cases

    name, at = row.part.name, RULES.index(rule)

    def counted(case: Case, least: str) -> Case:
        passes = at < RULES.index(least) and case.outcome in ("failure", "error")
        return case._replace(outcome="skipped", message=f"{case.message} (--fail-on {rule} lets it pass)") if passes else case

    planned = Case(name, "planned")
    if row.part.new is None:
        yield planned._replace(outcome="skipped", message="it was deleted")
        return
    if row.failed:
        yield counted(planned._replace(outcome="error", kind="not_planned", message=row.failed), "lost")
        return
    yield planned
    if row.unread:
        case = Case(name, "planned as it was", "error", "not_planned", row.unread)
        yield counted(case, "not-comparable")
    if row.difference is not None:
        for case in difference_cases(row.difference):
            yield counted(case, "lost" if row.difference.lost else "not-comparable")
    whole = Case(name, "each face is reached whole by a cutter")
    if row.unreachable:
        text = f"no cutter reaches all of {listed(row.unreachable, 20)}"
        whole = whole._replace(outcome="failure", kind="unreachable", message=text)
    yield counted(whole, "unreachable")
