"""An answer has one line for each statement of a plan, and names what is unchecked, in its first line."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

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


@dataclass(frozen=True, slots=True)
class Answer:
    """All findings, and the entries of `operations` and of all else in plan.json that agree, differ and are unchecked.

    Attributes
    ----------
    findings : tuple of Finding
    entries, others : Compared
    wanted : float
        Gouge tolerance that was wanted, mm; 0: any.
    """

    findings: tuple[Finding, ...]
    entries: Compared
    others: Compared = field(default_factory=Compared)
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
        every, open_ = sum(each.postures for each in self.findings), sum(each.open_ for each in self.findings)
        why = [
            *([f"at {self.beyond} the tool is deeper than the {self.wanted:g} mm that were wanted"] if self.beyond else []),
            *([f"{open_ - self.beyond} were not put down in the time"] if open_ > self.beyond else []),
        ]
        reasons = f" ({', '.join(why)})" if why else ""
        text = f"{open_:,} of {every:,} postures are not decided{reasons}." if every else "No posture was put down."
        head = "holds" if self.holds and not self.beyond else "not decided" if self.holds else "FAILS"
        under: dict[str, list[str]] = {}
        for entries, before in ((self.others, ""), (self.entries, "operations.")):
            for name in _short(entries.unchecked, entries.agree):
                begin, dot, rest = f"{before}{name}".partition(".")
                under.setdefault(begin, []).extend([rest] if dot else [])
        names = [f"{name} ({', '.join(some)})" if some else name for name, some in under.items()]
        if not names:
            return f"{head}: {text} Nothing of it was checked."
        return f"{head}: {text} Not checked: {', '.join(names)}, and whether no tool reaches what no verdict reaches."

    @property
    def lines(self) -> list[str]:
        """The answer in lines."""
        words = {True: "holds", False: "FAILS", None: "not checked"}
        return [
            self.first,
            *(f"{words[each.holds]}: {each.words}" for each in self.findings),
            *_unchecked(self.others),
            *_unchecked(self.entries),
        ]


def _unchecked(entries: Compared) -> Iterator[str]:
    groups: dict[str, list[str]] = {}
    for path in entries.unchecked:
        groups.setdefault(entries.why(path) or "they are empty", []).append(path)
    for why, paths in groups.items():
        yield f"not checked: {', '.join(_short(paths, entries.agree, whole=True))} ({len(paths)}): {why}"


def _short(unchecked: Sequence[str], checked: Sequence[str], *, whole: bool = False) -> list[str]:
    """Patterns of unchecked paths, each by its shortest beginning that no checked path has; `whole`: with marks of lists."""
    known = {begin for path in checked for begin in _beginnings(pattern(path))}
    plain = dict.fromkeys(map(pattern, unchecked))
    short = (next((each for each in _beginnings(path) if each not in known), path) for path in plain)
    return [*dict.fromkeys(each if whole else each.replace("[]", "") for each in short)]


def _beginnings(path: str) -> Iterator[str]:
    yield from (path[:k].removesuffix("[]") for k, letter in enumerate(path) if letter == ".")
    yield path
