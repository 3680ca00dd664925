"""`--junit` and `--sarif` of a plan: cases of each part come from the process that plans it, and are written when all ended."""

import json
from collections.abc import Sequence
from typing import TYPE_CHECKING

from plan_cutters_base.workers.child import is_child, report

if TYPE_CHECKING:
    from plan_cutters.cases.case import Case
    from plan_cutters.cases.files import CaseFiles
    from plan_cutters.plan_file.model import Plan

_SUITE = "plan-cutters"


class PartCases:
    """Gathers what came of each part.

    Parameters
    ----------
    files : CaseFiles
        Where they are written.
    parts : sequence of str
        All that were requested: one of which nothing is known when the file is written is an error.
    """

    def __init__(self, files: "CaseFiles", parts: Sequence[str]) -> None:
        self.files, self.parts = files, parts
        self.part = ""
        self.cases: dict[str, list[Case]] = {}
        self.faults: dict[str, str] = {}

    def planned(self, part: str, plan: "Plan", code: int) -> None:
        """Take the cases of a plan, or hand them to the process that gathers them."""
        from plan_cutters.cases.plan import plan_cases

        cases = plan_cases(plan, code, part)
        if is_child():
            report("cases", json.dumps(cases))
        else:
            self.cases[part] = cases

    def handed(self, text: str) -> None:
        """Take the cases of the part that began last."""
        from plan_cutters.cases.case import Case

        self.cases[self.part] = [Case(*each) for each in json.loads(text)]

    def failed(self, line: str, part: str | None = None) -> None:
        """Take the line on a part without a plan, by default the one that began last."""
        if is_child():
            report("failed", line)
        self.faults.setdefault(self.part if part is None else part, line.removeprefix("plan-cutters: "))

    def write(self, rest: str = "not planned") -> None:
        """Write the files; `rest`: why parts of which nothing is known have no plan.

        Raises
        ------
        PlanError
            One cannot be written.
        """
        from plan_cutters.cases.case import Case
        from plan_cutters.cases.plan import PROCESS

        cases: list[Case] = []
        for part in self.parts:
            fault = Case(part, PROCESS, "error", "not_planned", self.faults.get(part, rest))
            cases += self.cases.get(part, [fault])
        self.files.write(_SUITE, cases)
