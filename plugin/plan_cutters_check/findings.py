"""An answer has a line for each statement of a plan, and entries of plan.json, compared with what follows from the files.

Every number and word of plan.json is met in one walk: it is compared with what is expected, or named as not checked.
"""

import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plan_cutters_check.surface import MET, OPEN

#: Objects whose keys are names that a plan makes: they stand as * in the paths below.
_NAMED = ("split", "takes_mm2", "feed_mm_min", "reason_counts", "angles_deg", "other_angles_deg", "by_reason", "lost_by",
          "undecided_by_reason", "axis_limit_with", "repeat_deg", "cutters", "verdicts", "shares")  # fmt: skip
#: Numbers that differ by less are one, as a share and in their own unit.
_SHARE, _NEAR = 1e-9, 1e-9


@dataclass(frozen=True, slots=True)
class Between:
    """A number that may be anywhere from `low` to `high`."""

    low: float
    high: float
    near: float = 1e-9

    def __str__(self) -> str:
        return f"from {self.low:.6g} to {self.high:.6g}"


def about(value: Any, by: float) -> Any:
    """A number, or numbers of a list, that may be off by so much."""
    return [about(each, by) for each in value] if isinstance(value, list) else Between(value - by, value + by)


@dataclass(frozen=True, slots=True)
class Such:
    """A value for which something holds; `words` say what that is."""

    words: str
    holds: Callable[[Any], bool]

    def __str__(self) -> str:
        return self.words


class Exactly(dict[str, Any]):
    """An object whose names a plan makes: it has these, and no others."""


@dataclass(slots=True)
class Compared:
    """Leaves of plan.json that agree, lines on what differs, and paths of which, and below which, nothing is expected."""

    agree: list[str] = field(default_factory=list)
    differ: list[str] = field(default_factory=list)
    unchecked: list[str] = field(default_factory=list)

    def compare(self, expected: Any, actual: Any, path: str = "") -> "Compared":
        """Compare what is expected, as far as it is known, with what is there."""
        if isinstance(expected, dict) and isinstance(actual, dict):
            for name in [*expected, *(each for each in actual if each not in expected)]:
                below = f"{path}.{name}" if path else name
                if name not in actual:
                    self.differ.append(f"{below} is not there")
                elif name in expected:
                    self.compare(expected[name], actual[name], below)
                elif isinstance(expected, Exactly):
                    self.differ.append(f"{below} is an entry that no plan has")
                else:
                    self.unchecked.append(below)
        elif isinstance(expected, list) and isinstance(actual, list):
            if len(expected) != len(actual):
                self.differ.append(f"{path} has {len(actual)} entries, not {len(expected)}")
            elif not actual:
                self.agree.append(path)
            for k, (one, other) in enumerate(zip(expected, actual, strict=False)):
                self.compare(one, other, f"{path}[{k}]")
        elif not same(expected, actual):
            self.differ.append(f"{path} is {short(actual)}, not {short(expected)}")
        else:
            self.agree += (leaf for leaf, _ in leaves(actual, path))
        return self


def pattern(path: str) -> str:
    """A path without numbers of lists, and with * for names that a plan makes.

    >>> pattern("plans[0].operations[12].angles_deg.C"), pattern("fewest.weights[3][0]")
    ('plans[].operations[].angles_deg.*', 'fewest.weights[][]')
    """
    plain = re.sub(r"\[\d+\]", "[]", path)
    return re.sub(rf"(^|\.)({'|'.join(_NAMED)})\.[^.\[]+", r"\1\2.*", plain)


def leaves(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """The leaves of a tree by their paths; what is empty is one, too."""
    if isinstance(value, dict) and value:
        for name, each in value.items():
            yield from leaves(each, f"{path}.{name}" if path else name)
    elif isinstance(value, list) and value:
        for k, each in enumerate(value):
            yield from leaves(each, f"{path}[{k}]")
    else:
        yield path, value


def same(expected: Any, actual: Any) -> bool:
    """Whether a value is what is expected, numbers but for rounding."""
    if isinstance(expected, Such):
        return expected.holds(actual)
    if isinstance(expected, Between):
        return _number(actual) and bool(expected.low - expected.near <= actual <= expected.high + expected.near)
    if _number(expected) and _number(actual):
        return math.isclose(expected, actual, rel_tol=_SHARE, abs_tol=_NEAR)
    return type(expected) is type(actual) and bool(expected == actual)


def _number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def merged_trees(one: Any, other: Any) -> Any:
    """Make one tree of two; where both say something, the first is taken."""
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        both = {name: merged_trees(one[name], other[name]) for name in one if name in other}
        return type(one)({**one, **{name: other[name] for name in other if name not in one}, **both})  # type: ignore[call-arg]
    if isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        return [merged_trees(*pair) for pair in zip(one, other, strict=True)]
    return one


def short(value: Any) -> str:
    """A value in words, not too many."""
    text = f"{value:.9g}" if _number(value) else ", ".join(map(str, value)) if isinstance(value, list) else str(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


@dataclass(frozen=True, slots=True)
class Finding:
    """One statement of the plan, whether it holds, None: it could not be looked at, and in words how it was checked.

    `postures` that were to be put down, `open_` of them not decided, and `beyond` of these holding what the plan keeps, and not
    what was wanted.
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
    """All findings, the entries of plan.json, and the gouge tolerance that was wanted, mm; 0: any."""

    findings: tuple[Finding, ...]
    entries: Compared
    wanted: float = 0.0

    @property
    def holds(self) -> bool:
        """Whether nothing of what was checked is wrong."""
        return all(each.holds is not False for each in self.findings)

    @property
    def beyond(self) -> int:
        """Postures that hold what the plan keeps, and not what was wanted."""
        return sum(each.beyond for each in self.findings)

    @property
    def first(self) -> str:
        """The first line: how many postures are not decided and why, and all that is not checked."""
        every, open_ = (sum(getattr(each, name) for each in self.findings) for name in ("postures", "open_"))
        beyond, why = self.beyond, list[str]()
        if beyond:
            why.append(f"at {beyond} the tool is deeper than the {self.wanted:g} mm that were wanted")
        if open_ > beyond:
            why.append(f"{open_ - beyond} were not put down in the time")
        reasons = f" ({', '.join(why)})" if why else ""
        text = f"{open_:,} of {every:,} postures are not decided{reasons}." if every else "No posture was put down."
        head = "holds" if self.holds and not beyond else "not decided" if self.holds else "FAILS"
        under: dict[str, dict[str, None]] = {}
        for path in map(pattern, self.entries.unchecked):
            begin, dot, rest = path.replace("[]", "").partition(".")
            under.setdefault(begin, {}).update({rest: None} if dot else {})
        names = [f"{name} ({', '.join(some)})" if some else name for name, some in under.items()]
        if not names:
            return f"{head}: {text} Nothing of it was checked."
        return f"{head}: {text} Not checked: {', '.join(names)}, and whether no tool reaches what no verdict reaches."

    @property
    def lines(self) -> list[str]:
        """The answer in lines."""
        words = {True: "holds", False: "FAILS", None: "not checked"}
        return [self.first, *(f"{words[each.holds]}: {each.words}" for each in self.findings)]
