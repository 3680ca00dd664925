"""The page that says when all tests, the slow ones among them, were last run, and what they found.

`--record` beside `--slow all` writes it. `.ci/run` warns where its newest commit is far behind.
"""

import datetime
import sys
import time
from collections.abc import Mapping, Sequence
from typing import Any

import pytest

from tests.support.places import ROOT, git

PAGE = ROOT / "docs/nightly.md"
#: How many runs the page has, and after how many commits the newest one is too old.
RUNS, OLD = 10, 100
_HEAD = """# The whole run

`.ci/nightly` runs every test, the slow ones and those of FreeCAD among them, and writes this page. `.ci/run` takes one part of
eleven of the slow ones each time, and warns when the newest commit below is more than 100 commits old.

| commit | date | seconds | passed | failed | skipped | expected to fail |
| --- | --- | --- | --- | --- | --- | --- |
"""
_RED = "\n## Red in the newest run\n\n"
_COUNTS = ("passed", "failed", "skipped", "xfailed")


def page(before: str, commit: str, date: str, seconds: float, counts: Mapping[str, int], red: Sequence[str]) -> str:
    """The page with one more run on top.

    Parameters
    ----------
    before : str
        The page as it was; empty where there was none.
    commit, date : str
        What was tested, and when.
    seconds : float
        Wall time of the tests.
    counts : mapping of str to int
        Numbers of tests by outcome.
    red : sequence of str
        Ids of tests that failed, or could not be set up.

    >>> page("", "abc1", "2026-01-02", 61.4, {"passed": 3, "failed": 1}, ["tests/a.py::test_b"]).splitlines()[-5]
    '| `abc1` | 2026-01-02 | 61 | 3 | 1 | 0 | 0 |'
    """
    rows = [line for line in before.splitlines() if line.startswith("| `")]
    new = " | ".join([f"`{commit}`", date, f"{seconds:.0f}", *(str(counts.get(each, 0)) for each in _COUNTS)])
    told = "".join(f"- `{each}`\n" for each in red) or "None.\n"
    return _HEAD + "\n".join([f"| {new} |", *rows][:RUNS]) + "\n" + _RED + told


def behind(text: str) -> str:
    """Why the newest run of the page is no longer the answer; empty where it is."""
    commit = next((line.split("`")[1] for line in text.splitlines() if line.startswith("| `")), None)
    if commit is None:
        return "docs/nightly.md has no whole run: call .ci/nightly"
    found = git("rev-list", "--count", f"{commit}..HEAD")
    if not found.isdecimal():
        return f"docs/nightly.md: {commit} is no commit of this history: call .ci/nightly"
    return f"docs/nightly.md: the whole run is {found} commits old: call .ci/nightly" if int(found) > OLD else ""


def _written() -> str:
    return PAGE.read_text() if PAGE.exists() else ""


class Record:
    """Writes the page at the end of a run."""

    def __init__(self) -> None:
        self.began = time.monotonic()
        self.commit = git("rev-parse", "--short=10", "HEAD")
        if git("status", "--porcelain", "--untracked-files=no"):
            raise pytest.UsageError("--record: there are changes that are in no commit")

    def pytest_terminal_summary(self, terminalreporter: Any, exitstatus: int) -> None:
        if exitstatus not in (pytest.ExitCode.OK, pytest.ExitCode.TESTS_FAILED):
            return  # interrupted, or not begun: it was no whole run
        stats = terminalreporter.stats
        counts = {each: len(stats.get(each, ())) for each in _COUNTS}
        red = sorted({each.nodeid for name in ("failed", "error") for each in stats.get(name, ())})
        counts["failed"] = len(red)
        date, seconds = datetime.date.today().isoformat(), time.monotonic() - self.began
        PAGE.write_text(page(_written(), self.commit, date, seconds, counts, red))


if __name__ == "__main__":
    if why := behind(_written()):
        print(f"warning: {why}", file=sys.stderr)
