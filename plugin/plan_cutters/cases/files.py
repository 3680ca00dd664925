"""A test case, one thing that was looked at with the outcome, and the files of cases: JUnit XML and SARIF 2.1.0."""

import hashlib
import json
import math
import re
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, NamedTuple
from urllib.parse import quote
from xml.etree import ElementTree as ET

from plan_cutters import __version__
from plan_cutters.domain.figures import capital
from plan_cutters.errors import OptionError, PlanError
from plan_cutters.plan_file.reasons import reason
from plan_cutters_base.whole import refusal, whole

#: What XML 1.0 cannot hold, not even as a reference: controls, halves of surrogate pairs and two that are no characters.
_NO_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")

Outcome = Literal["passed", "skipped", "failure", "error"]


class Case(NamedTuple):
    """A test case says what was looked at, and what came of it."""

    classname: str  #: The part's file, or the name of its plan.
    name: str  #: What of it was looked at: a face and a cutter, say.
    outcome: Outcome = "passed"  #: `failure`: it is not reached; `error`: that is not known; `skipped`: it does not count.
    kind: str = ""  #: A code, of a reason or another word of the plan.
    message: str = ""  #: One line.
    details: str = ""  #: More lines.
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


def junit(name: str, cases: Iterable[Case]) -> bytes:
    """The file: one suite with its cases in their order.

    >>> print(junit("plan", [Case("a.step", "F1")]).decode())
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
        skipped=str(counts["skipped"]), time=f"{sum(map(_seconds, cases)):.3f}",
    )  # fmt: skip
    for case in cases:
        row = ET.SubElement(
            suite, "testcase", name=written(case.name), classname=written(case.classname), time=f"{_seconds(case):.3f}"
        )
        if case.outcome != "passed":
            more = {"message": line(case.message)}
            # Surefire's schema has no type of what is skipped.
            more |= {} if case.outcome == "skipped" else {"type": written(case.kind) or case.outcome}
            ET.SubElement(row, case.outcome, more).text = written(case.details) or None
    ET.indent(suite)
    return bytes(ET.tostring(suite, encoding="utf-8", xml_declaration=True)) + b"\n"


def _seconds(case: Case) -> float:
    return max(0.0, case.seconds) if math.isfinite(case.seconds) else 0.0


_SCHEMA = "https://json.schemastore.org/sarif-2.1.0.json"
_LEVELS = {"failure": "error", "error": "warning"}


def sarif(name: str, cases: Iterable[Case]) -> bytes:
    """The file: one run with its findings, in the order of their cases; `name`: of the command, by which runs are told apart.

    >>> file = sarif("plan-cutters", [Case("a b.step", "F1 R3", "failure", "rear_gouge", "12 % of F1 is not reached")])
    >>> run = json.loads(file)["runs"][0]
    >>> run["results"][0]["message"]["text"], run["results"][0]["level"], run["tool"]["driver"]["rules"][0]["id"]
    ('F1 R3: 12 % of F1 is not reached', 'error', 'rear_gouge')
    >>> run["results"][0]["locations"][0]["physicalLocation"]["artifactLocation"]["uri"]
    'a%20b.step'
    """
    findings = [case for case in cases if case.outcome in _LEVELS]
    kinds = list(dict.fromkeys(_kind(case) for case in findings))
    rules = [{"id": kind, "shortDescription": {"text": f"{capital(reason(kind))}."}} for kind in kinds]
    run = {
        "tool": {"driver": {"name": "plan-cutters", "version": __version__, "rules": rules}},
        "automationDetails": {"id": f"{written(name)}/"},
        "columnKind": "unicodeCodePoints",
        "results": [_result(case, kinds.index(_kind(case))) for case in findings],
    }
    return json.dumps({"$schema": _SCHEMA, "version": "2.1.0", "runs": [run]}, indent=2).encode() + b"\n"


def _result(case: Case, rule: int) -> dict[str, Any]:
    text = "\n".join(filter(None, [line(f"{case.name}: {case.message}"), written(case.details)]))
    # Line 1: readers ask for a line, and a face of a part has none.
    place = {"artifactLocation": {"uri": uri(case.classname)}, "region": {"startLine": 1}}
    # What is found again in a later run has the same mark, whatever the share of a face that is lost.
    mark = hashlib.sha256("\0".join((case.classname, case.name, _kind(case))).encode(errors="replace")).hexdigest()
    return {
        "ruleId": _kind(case),
        "ruleIndex": rule,
        "level": _LEVELS[case.outcome],
        "message": {"text": text},
        "locations": [{"physicalLocation": place, "logicalLocations": [{"fullyQualifiedName": line(case.name)}]}],
        "partialFingerprints": {"case/v1": mark[:32]},
    }


def _kind(case: Case) -> str:
    return written(case.kind) or case.outcome


def uri(file: str) -> str:
    r"""Give a file as a reference: relative to where the command ran, unless it is absolute or has an address.

    >>> uri("parts/a b.step"), uri("/in/a#1.stp"), uri("C:\\in\\a.stp"), uri("s3://in/a.step")
    ('parts/a%20b.step', 'file:///in/a%231.stp', 'file:///C:/in/a.stp', 's3://in/a.step')
    """
    path = quote(file.replace("\\", "/"), safe="/:", errors="surrogatepass")
    if "://" in file:
        return path
    if re.match("[A-Za-z]:/", path):
        return f"file:///{path}"
    # A colon in the first step of a relative path would be read as the end of a scheme.
    return f"file://{path}" if path.startswith("/") else path.replace(":", "%3A")


@dataclass(frozen=True, slots=True)
class CaseFiles:
    """Names of files for test cases."""

    junit: str | None = None
    sarif: str | None = None

    def check(self) -> None:
        """Look before the work begins whether the files can be written.

        An OptionError where one is no name of a file, a folder, or cannot be written; or both are one file.
        """
        named = [(word, path) for word, path in (("--junit", self.junit), ("--sarif", self.sarif)) if path is not None]
        for word, path in named:
            if path in ("", "-"):
                raise OptionError(f"{word}: give the name of a file; standard output has the summary")
            if Path(path).is_dir():
                raise OptionError(f"{word}: is a folder; give the name of a file", file=path)
            if why := refusal(Path(path).parent):
                raise OptionError(f"{word}: cannot be written: {why}", file=path)
        if len({Path(path).absolute() for _, path in named}) < len(named):
            raise OptionError("--junit and --sarif name one file; give each its own", file=self.junit)

    def write(self, name: str, cases: Iterable[Case]) -> None:
        """Write each file whole or not at all, or a PlanError; its folder is made. `name`: of the command."""
        cases = list(cases)
        for path, document in ((self.junit, junit), (self.sarif, sarif)):
            if path is None:
                continue
            try:
                Path(path).parent.mkdir(parents=True, exist_ok=True)
            except OSError as error:
                raise PlanError(f"cannot be written: {error.strerror}", file=path) from None
            with whole(Path(path), PlanError) as temporary:
                temporary.write_bytes(document(name, cases))
