"""Do the numbers and tools in the first words of a plan, its headline and its table of steps, follow from its records?

The words are read anew here, by their form alone.
"""

import re
from collections.abc import Iterator, Mapping
from typing import Any

from plan_cutters_check.findings import Finding
from plan_cutters_check.paper import without_posture
from plan_cutters_check.reckoned import Reckoned

_HEAD = re.compile(
    r"finish(?:es)? (?:(?P<share>[<>]?[\d.]+) % of|any of|all) (?P<area>[\d,.]+) (?P<unit>mm|in)²"
    r"(?:, (?P<took>less than 1 s|[\d.]+ (?:s|min|h)))?(?: and (?P<again>less than 1 s|[\d.]+ (?:s|min|h)) to clamp it again)?"
    r"(?:; (?P<stays>[<>]?[\d.]+) % stay(?:: |, mostly )[^;]+|; F[^;]* not judged)?\.$"
)
_STEP = re.compile(
    r"^ {2} *(?P<number>\d+) {2}(?P<what>.*?) +(?P<share>[<>]?[\d.]+) %"
    r"(?: +(?P<took>less than 1 s|[\d.]+ (?:s|min|h)))?(?:  (?P<faces>F[\dF +]*))?$"
)
_DRILLING = re.compile(
    r"^ {2} *(?P<number>\d+) {2}(?P<what>.*?) +(?P<holes>\d+) holes?(?: +(?P<took>less than 1 s|[\d.]+ (?:s|min|h)))?$"
)
_SECONDS = {"s": 1.0, "min": 60.0, "h": 3600.0}
#: How far a written number may be from the true one, in units of its last digit.
_HALF = 0.5 + 1e-6


def findings(reckoned: Reckoned) -> Iterator[Finding]:
    """List what the words say otherwise than the records, and what no plan has."""
    question, document = reckoned.question, reckoned.question.document
    if question.odd:
        yield Finding(False, f"plan.json: {question.odd}.")
    yield from without_posture(reckoned)
    wrong = [*_contradictions(document)]
    text = f": {'; '.join(wrong[:3])}" if wrong else ""
    yield Finding(not wrong, f"The headline, the table of steps and shares were read; {len(wrong)} contradict the records{text}.")
    errors = [each["chord_error_mm"] or 0.0 for each in (*document["faces"], *document["fixtures"])]
    if document["effective"]["chord_error_mm"] > max(errors) + 1e-12:
        yield Finding(False, "effective.chord_error_mm is larger than that of each face and fixture.")


def _contradictions(document: Mapping[str, Any]) -> Iterator[str]:
    """List what the text says otherwise than the process and the cutters."""
    text, process = document["text"], document["process"]
    head = _HEAD.search(text["headline"])
    if head is not None:
        size = 25.4**2 if head["unit"] == "in" else 1.0
        stays = any(each["cause"] != "unjudged" for each in process["left"])
        seconds = process["seconds"]
        on_machine = None if seconds is None else seconds - (process["setup_seconds"] or 0.0)
        pairs = [
            ("share", _share(head["share"] or ("0" if "finishes any of" in head[0] else "100")), process["finished_share"]),
            ("area", _span(head["area"]), process["asked_mm2"] / size),
            ("time", _time(head["took"]), on_machine),
            ("time to clamp", _time(head["again"]), process["setup_seconds"] or None),
            ("rest", _share(head["stays"]) if head["stays"] else None, 1.0 - process["finished_share"] if stays else None),
        ]
        yield from (f"the headline has another {what} than the process" for what, span, value in pairs if not _in(span, value))
    elif not text["headline"].startswith("Take ") or any(each["cause"] != "unjudged" for each in process["left"]):
        yield "the headline is none of a plan with this process"
    elif not any(document[name] for name in ("selected", "selected_over_setups")):
        yield "the headline says to take a cutter, and none is selected"
    if text["tone"] == "good" and any(each["cause"] != "unjudged" for each in process["left"]):
        yield "the tone is good, and something is left"
    rows = [match for line in text["lines"] if (match := _STEP.match(line))]
    numbers = [int(row["number"]) for row in rows]
    if len({*numbers}) != len(rows) or (len(rows) < min(9, len(process["steps"])) and len(text["lines"]) < 22):
        yield "the table has other steps than the process"
    for row, k in zip(rows, numbers, strict=True):
        if not 1 <= k <= len(process["steps"]):
            yield f"there is no step {k}"
        else:
            yield from (
                f"line {k} of the table has {what} than the process" for what in _step(row, process["steps"][k - 1], document)
            )
    yield from _drilled(text["lines"], process)
    for cutter in document["cutters"]:
        for word, share in text["shares"].get(cutter["id"], {}).items():
            if not _in(_share(share.removesuffix(" %")), cutter["area_share"][word]):
                yield f"the share {share} of {cutter['id']}, {word}, is another one"


def _drilled(lines: list[str], process: Mapping[str, Any]) -> Iterator[str]:
    """List what rows of steps that drill say otherwise: their numbers follow those of mills."""
    first, drilling = len(process["steps"]) + 1, process.get("drilling", [])
    for row in (match for line in lines if (match := _DRILLING.match(line))):
        k = int(row["number"])
        if not first <= k < first + len(drilling):
            yield f"there is no step {k} that drills"
            continue
        step = drilling[k - first]
        size = re.search(rf"\b{re.escape(step.get('thread') or 'D')}[\d. ]", row["what"])
        alike = step["kind"] in row["what"] and int(row["holes"]) == len(step["holes"])
        time = None if step["seconds"] is None else step["seconds"] + step["link_seconds"]
        if not alike or size is None or not _in(_time(row["took"]), time):
            yield f"line {k} of the table has another tool, number of holes or time than the process"


def _step(row: re.Match[str], step: Mapping[str, Any], document: Mapping[str, Any]) -> Iterator[str]:
    if not _in(_share(row["share"]), step["share"]):
        yield "another share"
    if not _in(_time(row["took"]), None if step["seconds"] is None else step["seconds"] + step["link_seconds"]):
        yield "another time"
    if step["mode"] == "fixed":
        for name, angle in step["angles_deg"].items():
            shown = re.search(rf"(?:^|\s){re.escape(name)} (-?[\d.]+)(?:\s|$|,)", row["what"])
            if shown is not None and not _in(_span(shown[1], least=1e-3), angle):
                yield "another angle"
            elif shown is None and name not in (step["repeat_deg"] or {}):
                yield "no angle"
    elif "simultaneous" not in row["what"]:
        yield "another kind of motion"
    tool = {each["id"]: each for each in document["cutters"]}[step["cutter"]]
    across = re.findall(r"\bD(\d[\d.]*)(in)?\b", row["what"])
    if across and not any(
        abs(float(size) * (25.4 if inch else 1.0) - 2.0 * tool["radius"]) <= 1e-3 * tool["radius"] for size, inch in across
    ):
        yield "another tool"
    faces = re.findall(r"F\d+", row["faces"] or "")
    if faces != step["faces"][: len(faces)]:
        yield "other faces"


def _in(span: tuple[float, float] | None, value: Any) -> bool:
    if span is None or value is None:
        return span is None and value is None
    return bool(span[0] <= value <= span[1])


def _span(text: str, least: float = 0.0) -> tuple[float, float]:
    """Between what a number lies that is written with three digits, or with those behind its point."""
    plain = text.replace(",", "")
    digit = 10.0 ** -len(plain.partition(".")[2]) if "." in plain else 10.0 ** max(0, len(plain.lstrip("-")) - 3)
    return float(plain) - _HALF * max(digit, least), float(plain) + _HALF * max(digit, least)


def _share(text: str) -> tuple[float, float]:
    """Between what a share lies; hardly any and all but some are words of their own."""
    if text.startswith(("<", ">")):
        return (0.0, 0.0006) if text.startswith("<") else (0.9994, 1.0)
    try:
        low, high = _span(text if "." in text else f"{text}.0")
    except ValueError:
        return 2.0, 2.0
    return low / 100.0, high / 100.0


def _time(text: str | None) -> tuple[float, float] | None:
    if text is None:
        return None
    if text.startswith("less"):
        return 0.0, 1.0
    number, unit = text.split()
    low, high = _span(number) if "." in number else (float(number) - _HALF, float(number) + _HALF)
    return low * _SECONDS[unit], high * _SECONDS[unit]
