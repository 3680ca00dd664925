"""An answer has one line for each statement of a plan, and names what is unchecked, in its first line."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plan_cutters_check.clash import MET, OPEN
from plan_cutters_check.leaves import Compared, pattern


@dataclass(frozen=True, slots=True)
class Finding:
    """One statement of the plan, whether it holds, None: it could not be looked at, and in words how it was checked.

    Attributes
    ----------
    holds : bool or None
    words : str
    open_ : int
        Postures that are not decided.
    beyond : int
        Those of them that hold what the plan keeps, and not what was wanted.
    postures : int
        All that were to be put down.
    """

    holds: bool | None
    words: str
    open_: int = 0
    beyond: int = 0
    postures: int = 0


@dataclass(slots=True)
class Tally:
    """Tools that were put down: decided, wrong, not decided, those of them that the plan's own tolerance allows, and words."""

    tested: int = 0
    wrong: int = 0
    open_: int = 0
    beyond: int = 0
    words: list[str] = field(default_factory=list)

    def add(self, verdict: NDArray[np.int8], beyond: int, words: Sequence[str], name: str = "") -> None:
        """Count some, as `Bench.put_down` gives them."""
        self.wrong, self.open_ = self.wrong + int((verdict == MET).sum()), self.open_ + int((verdict == OPEN).sum())
        self.tested, self.beyond = self.tested + int((verdict != OPEN).sum()), self.beyond + beyond
        self.words += [f"{name}, {one}" for one in words] if name else words

    @property
    def some(self) -> str:
        """The first few words."""
        return f" {'; '.join(self.words[:3])}." if self.words else ""

    def finding(self, words: str, every: int, *, holds: bool = True) -> Finding:
        """Whether all is right; None where nothing is wrong, and none was decided or some are deeper than was wanted."""
        right = holds and not self.wrong
        undecided = right and (self.beyond or not self.tested) and every
        return Finding(None if undecided else right, words, self.open_, self.beyond, every)


@dataclass(frozen=True, slots=True)
class Answer:
    """All findings, and the entries of plan.json that agree, differ and are unchecked.

    Attributes
    ----------
    findings : tuple of Finding
    entries : Compared
    wanted : float
        Gouge tolerance that was wanted, mm; 0: any.
    """

    findings: tuple[Finding, ...]
    entries: Compared
    wanted: float = 0.0

    @property
    def holds(self) -> bool:
        """Whether nothing of what was checked is wrong."""
        return all(each.holds is not False for each in self.findings)

    def _sum(self, name: str) -> Any:
        return sum(getattr(each, name) for each in self.findings)

    @property
    def beyond(self) -> int:
        """Postures that hold what the plan keeps, and not what was wanted."""
        return int(self._sum("beyond"))

    @property
    def first(self) -> str:
        """The first line: how many postures are not decided and why, and all that is not checked."""
        every, open_, beyond = (int(self._sum(name)) for name in ("postures", "open_", "beyond"))
        why = [
            *([f"at {beyond} the tool is deeper than the {self.wanted:g} mm that were wanted"] if beyond else []),
            *([f"{open_ - beyond} were not put down in the time"] if open_ > beyond else []),
        ]
        reasons = f" ({', '.join(why)})" if why else ""
        text = f"{open_:,} of {every:,} postures are not decided{reasons}." if every else "No posture was put down."
        head = "holds" if self.holds and not beyond else "not decided" if self.holds else "FAILS"
        under: dict[str, list[str]] = {}
        for name in _short(self.entries.unchecked, self.entries.agree):
            begin, dot, rest = name.partition(".")
            under.setdefault(begin, []).extend([rest] if dot else [])
        names = [f"{name} ({', '.join(some)})" if some else name for name, some in under.items()]
        if not names:
            return f"{head}: {text} Nothing of it was checked."
        return f"{head}: {text} Not checked: {', '.join(names)}, and whether no tool reaches what no verdict reaches."

    @property
    def lines(self) -> list[str]:
        """The answer in lines."""
        words = {True: "holds", False: "FAILS", None: "not checked"}
        return [self.first, *(f"{words[each.holds]}: {each.words}" for each in self.findings)]


def _short(unchecked: Sequence[str], checked: Sequence[str]) -> list[str]:
    """Patterns of unchecked paths without marks of lists, each by its shortest beginning that no checked path has."""
    known = {begin for path in {*map(pattern, checked)} for begin in _beginnings(path)}
    every = dict.fromkeys(map(pattern, unchecked))
    return [*dict.fromkeys(next((b for b in _beginnings(path) if b not in known), path).replace("[]", "") for path in every)]


def _beginnings(path: str) -> Iterator[str]:
    yield from (path[:k].removesuffix("[]") for k, letter in enumerate(path) if letter == ".")
    yield path
