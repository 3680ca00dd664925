"""An answer has one line for each statement of a plan, and lists what is unchecked."""

from collections import Counter
from dataclasses import dataclass

from plan_cutters.checker.leaves import UNCHECKED, Compared, pattern


@dataclass(frozen=True, slots=True)
class Finding:
    """One statement of the plan, whether it holds, None: it could not be looked at, and in words how it was checked."""

    holds: bool | None
    words: str


@dataclass(frozen=True, slots=True)
class Answer:
    """All findings, and the entries of `operations` in plan.json that agree, that differ and that are unchecked."""

    findings: tuple[Finding, ...]
    entries: Compared

    @property
    def holds(self) -> bool:
        """Whether nothing of what was checked is wrong."""
        return all(each.holds is not False for each in self.findings)

    @property
    def lines(self) -> list[str]:
        """The answer in lines."""
        words = {True: "holds", False: "FAILS", None: "not checked"}
        lines = [f"{words[each.holds]}: {each.words}" for each in self.findings]
        count = Counter(UNCHECKED.get(pattern(each), "they are empty") for each in self.entries.unchecked)
        for why, number in count.items():
            names = dict.fromkeys(
                pattern(each) for each in self.entries.unchecked if UNCHECKED.get(pattern(each), "they are empty") == why
            )
            lines.append(f"not checked: {', '.join(names)} ({number}): {why}")
        return lines
