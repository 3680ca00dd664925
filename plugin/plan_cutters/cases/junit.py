"""JUnit XML: one suite, as the schemas of Surefire and of Jenkins have it."""

import math
from collections import Counter
from collections.abc import Iterable
from xml.etree import ElementTree as ET

from plan_cutters.cases.case import Case, line, written


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
        "testsuite", name=written(name), tests=str(len(cases)), failures=str(counts["failure"]), errors=str(counts["error"]),
        skipped=str(counts["skipped"]), time=_time(sum(_finite(case.seconds) for case in cases)),
    )  # fmt: skip
    for case in cases:
        row = ET.SubElement(
            suite, "testcase", name=written(case.name), classname=written(case.classname), time=_time(_finite(case.seconds))
        )
        if case.outcome != "passed":
            more = {"message": line(case.message)}
            # Surefire's schema has no type of what is skipped.
            more |= {} if case.outcome == "skipped" else {"type": written(case.kind) or case.outcome}
            ET.SubElement(row, case.outcome, more).text = written(case.details) or None
    ET.indent(suite)
    return bytes(ET.tostring(suite, encoding="utf-8", xml_declaration=True)) + b"\n"


def _finite(seconds: float) -> float:
    return max(0.0, seconds) if math.isfinite(seconds) else 0.0


def _time(seconds: float) -> str:
    return f"{seconds:.3f}"
