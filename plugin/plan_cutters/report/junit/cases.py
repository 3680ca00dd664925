"""Test cases, and the file that they are written into: one suite, as the schemas of Surefire and of Jenkins have it."""

import math
import re
from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from typing import Literal, NamedTuple
from xml.etree import ElementTree as ET

from cad_io.whole import refusal, whole
from plan_cutters.errors import OptionError, PlanError

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


def document(name: str, cases: Iterable[Case]) -> bytes:
    """The file: one suite with its cases in their order.

    Examples
    --------
    >>> print(document("plan", [Case("a.step", "F1")]).decode())
    <?xml version='1.0' encoding='utf-8'?>
    <testsuite name="plan" tests="1" failures="0" errors="0" skipped="0" time="0.000">
      <testcase name="F1" classname="a.step" time="0.000" />
    </testsuite>
    <BLANKLINE>
    """
    cases = list(cases)
    counts = Counter(case.outcome for case in cases)
    suite = ET.Element(
        "testsuite", name=_text(name), tests=str(len(cases)), failures=str(counts["failure"]), errors=str(counts["error"]),
        skipped=str(counts["skipped"]), time=_time(sum(_finite(case.seconds) for case in cases)),
    )  # fmt: skip
    for case in cases:
        row = ET.SubElement(
            suite, "testcase", name=_text(case.name), classname=_text(case.classname), time=_time(_finite(case.seconds))
        )
        if case.outcome != "passed":
            # One line: an attribute loses its line ends when it is read.
            more = {"message": " ".join(_text(case.message).split())}
            # Surefire's schema has no type of what is skipped.
            more |= {} if case.outcome == "skipped" else {"type": _text(case.kind) or case.outcome}
            ET.SubElement(row, case.outcome, more).text = _text(case.details) or None
    ET.indent(suite)
    return bytes(ET.tostring(suite, encoding="utf-8", xml_declaration=True)) + b"\n"


def write(path: str | Path, name: str, cases: Iterable[Case]) -> None:
    """Write the file whole or not at all; its folder is made.

    Raises
    ------
    PlanError
        It cannot be written.
    """
    path = Path(path)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise PlanError(f"cannot be written: {error.strerror}", file=str(path)) from None
    with whole(path, PlanError) as temporary:
        temporary.write_bytes(document(name, cases))


def check(path: str | None) -> None:
    """Look before the work begins whether the file can be written; nothing where none is requested.

    Raises
    ------
    OptionError
        It is no name of a file, a folder, or cannot be written.
    """
    if path is None:
        return
    if path in ("", "-"):
        raise OptionError("--junit: give the name of a file; standard output has the summary")
    if Path(path).is_dir():
        raise OptionError("--junit: is a folder; give the name of a file", file=path)
    if why := refusal(Path(path).parent):
        raise OptionError(f"--junit: cannot be written: {why}", file=path)


def _text(text: str) -> str:
    return _NO_XML.sub("\ufffd", text)


def _finite(seconds: float) -> float:
    return max(0.0, seconds) if math.isfinite(seconds) else 0.0


def _time(seconds: float) -> str:
    return f"{seconds:.3f}"
