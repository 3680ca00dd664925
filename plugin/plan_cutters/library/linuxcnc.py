"""LinuxCNC tool tables, `.tbl`: numbers and diameters alone. Z is an offset of the machine and never taken for a stick-out."""

import re

from plan_cutters.domain.checks import shown
from plan_cutters.library.files import MOST_TOOLS, Content, too_many
from plan_cutters.library.raw_tool import FaultError, LibraryContent, name_of, number_in, whole_of
from plan_cutters.library.records import Entry

_LINE = re.compile(r"^\s*T\s*[+-]?\d+(?:\s+[A-Z]\s*[+-]?[\d.,]+)*\s*(?:;.*)?$", re.IGNORECASE)
_WORD = re.compile(r"([A-Z])\s*([^\sA-Z;]+)", re.IGNORECASE)
_TOO_LITTLE = (
    "LCF, LPR (stick-out), DMM and a holder are missing: a tool table has none; write the tool as TOML "
    "(docs/tool_libraries.md)"
)


def is_table(content: Content) -> bool:
    """The first line that is no comment has T and a number, then letters with numbers."""
    lines = (line for line in content.text.splitlines() if line.strip() and not line.lstrip().startswith(";"))
    return _LINE.match(next(lines, "")) is not None


def read_table(content: Content) -> LibraryContent:
    """List it: none of its tools can be judged."""
    library = LibraryContent(notes=["the file does not say in which unit its diameters are: that of the machine"])
    for number, line in enumerate(content.text.splitlines(), 1):
        if number > MOST_TOOLS:
            raise too_many(content.name)
        words, _, comment = line.partition(";")
        if words.strip():
            library.tools.append(_entry(words, name_of(comment), f"line {number}"))
    return library


def _entry(words: str, name: str, place: str) -> Entry:
    result = [(letter.upper(), value) for letter, value in _WORD.findall(words)]
    by_letter = dict(result)
    try:
        if len(by_letter) < len(result):
            raise FaultError(f"{shown(words.strip())} has a letter twice")
        if _WORD.sub("", words).strip() or "T" not in by_letter:
            raise FaultError(f"{shown(words.strip())} is no line of a tool table")
        number = whole_of(by_letter["T"], "T")
        if "D" not in by_letter:
            return Entry(place, number, name, unused=f"D (the diameter) is missing; {_TOO_LITTLE}")
        diameter, _ = number_in(by_letter["D"], "D")
        if diameter < 0.0:
            raise FaultError(f"D is {diameter:g}: a diameter cannot be negative")
    except FaultError as fault:
        return Entry(place, None, name, unused=str(fault), broken=True)
    return Entry(place, number, name, unused=_TOO_LITTLE, notes=(f"D {diameter:g}, in the machine's unit",))
