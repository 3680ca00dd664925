"""A test case: one thing that was looked at, and the outcome."""

import re
from typing import Literal, NamedTuple

#: What XML 1.0 cannot hold, not even as a reference: controls, halves of surrogate pairs and two that are no characters.
_NO_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")

Outcome = Literal["passed", "skipped", "failure", "error"]


class Case(NamedTuple):
    """A test case says what was looked at, and what came of it.

    Attributes
    ----------
    classname : str
        The part's file, or the name of its plan.
    name : str
        What of it: a face and a cutter, say.
    outcome : str
        `failure`: it is not reached; `error`: that is not known; `skipped`: it does not count.
    kind : str
        A code: of a reason, or another word of the plan.
    message : str
        One line.
    details : str
        More lines; empty where there are none.
    seconds : float
    """

    classname: str
    name: str
    outcome: Outcome = "passed"
    kind: str = ""
    message: str = ""
    details: str = ""
    seconds: float = 0.0


def written(text: str) -> str:
    r"""Give a text as a file can hold it, whatever the name of a file has in it.

    >>> written("a\x00b")
    'a\ufffdb'
    """
    return _NO_XML.sub("\ufffd", text)


def line(text: str) -> str:
    """Give it as one line: an attribute of XML loses its line ends when it is read."""
    return " ".join(written(text).split())
