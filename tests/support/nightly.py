"""What runs in `.ci/nightly` alone: the tests that `tests/nightly.txt` names, and more cases of some others."""

import os
from collections.abc import Sequence

from tests.support.places import ROOT

#: Set by `.ci/nightly`: tests that draw from many cases draw all.
NIGHTLY = "PLAN_CUTTERS_NIGHTLY" in os.environ
LIST = ROOT / "tests/nightly.txt"


def rules(text: str) -> list[tuple[bool, str]]:
    """Lines of the list: whether the tests whose id begins so wait for the night, and that beginning.

    >>> rules("# why\\n\\na/test_b.py\\n! a/test_b.py::test_c")
    [(True, 'a/test_b.py'), (False, 'a/test_b.py::test_c')]
    """
    lines = [line.strip() for line in text.splitlines()]
    return [(line[0] != "!", line.lstrip("! ")) for line in lines if line and line[0] != "#"]


def waits(rules: Sequence[tuple[bool, str]], test: str) -> bool:
    """Whether a test, by its id below the folder of tests, waits for the night: the last line that names it decides.

    >>> waits(rules("a/test_b.py\\n! a/test_b.py::test_c"), "a/test_b.py::test_c[1]")
    False
    """
    return next((late for late, begins in reversed(rules) if test.startswith(begins)), False)
