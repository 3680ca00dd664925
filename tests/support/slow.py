"""Which of the tests that are marked as slow take part in a run: none, one part of eleven, or all of them.

`@pytest.mark.slow("starts a cluster")` says why. Of a test of several cases, or of a whole module, `only=` names the slow ones or
`but=` those that every run keeps: by the beginning of a case's id, or of a test's name with its case. `together=` names what they
share, such as a program that must be installed: they come in one part.

`--slow 3/11` takes one part, `--slow commit` that of the number of commits. Each test belongs to the part that its own id says:
eleven parts are the whole, and a test that is added moves no other.
"""

import sys
import zlib
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import pytest

from tests.support.places import ROOT, git

#: By which a report says that its test is slow.
PROPERTY = "part of the slow tests"
#: In how many parts `.ci/run` tests what is slow: eleven commits in a row are the whole.
PARTS = 11


def part_of(shared: str) -> int:
    """Part of the tests that share a name, or of the test of an id.

    >>> part_of("FreeCAD"), part_of("tests/scene/test_vise.py::test_it")
    (3, 1)
    """
    return zlib.crc32(shared.encode()) % PARTS


def of_commit() -> int:
    """The part that is tested at the commit that is checked out.

    Raises
    ------
    pytest.UsageError
        Where this is no checkout.
    """
    count = git("rev-list", "--count", "HEAD")
    if not count.isdecimal():
        raise pytest.UsageError(f"--slow commit: git does not count the commits of {ROOT}")
    return int(count) % PARTS


def chosen(text: str) -> frozenset[int]:
    """The parts that `none`, `all`, `commit` or `K/11` names.

    Raises
    ------
    pytest.UsageError
        Where it names none of these.

    >>> sorted(chosen("3/11")), len(chosen("all")), len(chosen("none"))
    ([3], 11, 0)
    """
    if text in ("none", "all"):
        return frozenset(range(PARTS) if text == "all" else ())
    if text == "commit":
        return frozenset({of_commit()})
    part, _, parts = text.partition("/")
    if parts != str(PARTS) or not part.isdecimal() or int(part) >= PARTS:
        raise pytest.UsageError(f"--slow {text}: give none, all, commit, or one of 0/{PARTS} to {PARTS - 1}/{PARTS}")
    return frozenset({int(part)})


def _words(mark: Any) -> Sequence[str]:
    unknown = [*(set(mark.kwargs) - {"only", "but", "together"})]
    if len(mark.args) != 1 or not str(mark.args[0]).strip() or unknown or {"only", "but"} <= set(mark.kwargs):
        raise pytest.UsageError(f"slow{mark.args}{unknown}: it takes a reason, and only= or but=, and together=")
    found = mark.kwargs.get("only", mark.kwargs.get("but", ()))
    if isinstance(found, str):
        raise pytest.UsageError(f"slow({found!r}): give a tuple")
    return tuple(found)


class Slow:
    """Which tests are slow, and what was named by no test."""

    def __init__(self) -> None:
        self._unnamed: dict[tuple[str, str], bool] = {}

    def part(self, item: Any) -> int | None:
        """The part of a test; None where each run has it."""
        case = item.callspec.id if hasattr(item, "callspec") else ""
        found = None
        for mark in item.iter_markers("slow"):
            words = _words(mark)
            named = [each for each in words if item.name.startswith(each) or (case and case.startswith(each))]
            for each in words:
                at = (str(item.path), each)
                self._unnamed[at] = self._unnamed.get(at, True) and each not in named
            if bool(named) == ("but" not in mark.kwargs) or not words:
                found = part_of(mark.kwargs.get("together", item.nodeid))
        return found

    def unnamed(self) -> list[str]:
        """What marks name and no test that was collected is."""
        return [f"{path}: slow names {word!r}, and no test begins so" for (path, word), none in self._unnamed.items() if none]


def select(items: Iterable[Any], parts: frozenset[int], whole: bool) -> tuple[list[Any], list[Any]]:
    """The tests of a run, and those left out of it.

    Parameters
    ----------
    items : iterable of pytest.Item
        Tests as collected.
    parts : frozenset of int
        The parts of slow tests that take part.
    whole : bool
        Whether modules were collected as wholes: what a mark names must be there then.

    Raises
    ------
    pytest.UsageError
        Where a mark has no reason, unknown words, or names what is not there.
    """
    slow, runs, left = Slow(), [], []
    for item in items:
        part = slow.part(item)
        (runs if part is None or part in parts else left).append(item)
        if part is not None:
            item.user_properties.append((PROPERTY, part))
    if whole and (unnamed := slow.unnamed()):
        raise pytest.UsageError("; ".join(unnamed))
    return runs, left


def summary(stats: Mapping[str, Sequence[Any]], parts: frozenset[int]) -> str:
    """One line of what the slow tests of a run have found; empty where it has none of them.

    Parameters
    ----------
    stats : mapping of str to sequence of reports
        Reports by outcome, as pytest keeps them.
    parts : frozenset of int
        The parts that took part.
    """
    counts = {
        outcome: sum(PROPERTY in dict(getattr(each, "user_properties", ())) for each in stats.get(outcome, ()))
        for outcome in ("passed", "failed", "error", "skipped", "xfailed")
    }
    which = "all parts" if len(parts) == PARTS else f"part {', '.join(map(str, sorted(parts)))} of {PARTS}"
    return f"slow tests, {which}: " + ", ".join(f"{many} {outcome}" for outcome, many in counts.items()) if parts else ""


if __name__ == "__main__":  # whether what shares this name is tested at this commit
    sys.exit(part_of(sys.argv[1]) != of_commit())
