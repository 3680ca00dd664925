"""SARIF 2.1.0: findings at the files that they are about, as code scanning of GitHub, Azure and editors read them.

What passed or was skipped is no finding. A failure has the level `error`; where it is not known whether there
is one, the level is `warning`. A rule is a reason: its id is the code that the plan has.
"""

import hashlib
import json
import re
from collections.abc import Iterable
from typing import Any
from urllib.parse import quote

from plan_cutters import __version__
from plan_cutters.cases.case import Case, line, written
from plan_cutters.plan_file.words.cutters import reason

_SCHEMA = "https://json.schemastore.org/sarif-2.1.0.json"
_LEVELS = {"failure": "error", "error": "warning"}


def document(name: str, cases: Iterable[Case]) -> bytes:
    """The file: one run with its findings, in the order of their cases; `name`: of the command, by which runs are told apart.

    Examples
    --------
    >>> file = document("plan-cutters", [Case("a b.step", "F1 R3", "failure", "rear_gouge", "12 % of F1 is not reached")])
    >>> run = json.loads(file)["runs"][0]
    >>> run["results"][0]["message"]["text"], run["results"][0]["level"], run["tool"]["driver"]["rules"][0]["id"]
    ('F1 R3: 12 % of F1 is not reached', 'error', 'rear_gouge')
    >>> run["results"][0]["locations"][0]["physicalLocation"]["artifactLocation"]["uri"]
    'a%20b.step'
    """
    findings = [case for case in cases if case.outcome in _LEVELS]
    kinds = list(dict.fromkeys(_kind(case) for case in findings))
    rules = [{"id": kind, "shortDescription": {"text": _named(kind)}} for kind in kinds]
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


def _named(kind: str) -> str:
    text = reason(kind)
    return f"{text[:1].upper()}{text[1:]}."


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
