"""Lines that a job of GitHub shows at the files they are about: one for each part that fails."""

import os
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from plan_cutters.cases.case import Case

#: Words of `--annotations`: where none is given, the environment decides.
KINDS = ("github", "none")
#: GitHub shows so many of a step; and findings of a part, in one.
_MOST, _FINDINGS = 10, 5


def requested(kind: str | None) -> bool:
    """Whether annotations are written: as requested, else where this is a job of GitHub.

    >>> requested("github"), requested("none")
    (True, False)
    """
    return kind == "github" or (kind is None and os.environ.get("GITHUB_ACTIONS") == "true")


def annotations(parts: Iterable[tuple[str, Sequence["Case"]]]) -> Iterator[str]:
    """The lines, without line ends; of more parts than GitHub shows the last line says how many there are.

    Parameters
    ----------
    parts : iterable of (str, sequence of Case)
        Path of each part in the repository, and its test cases.
    """
    failing = [(part, [case for case in cases if case.outcome in ("failure", "error")]) for part, cases in parts]
    failing = [(part, cases) for part, cases in failing if cases]
    for part, cases in failing[: _MOST if len(failing) <= _MOST else _MOST - 1]:
        lines = [f"{case.name}: {case.message}" for case in cases[:_FINDINGS]]
        lines += [f"and {len(cases) - _FINDINGS} more"] * (len(cases) > _FINDINGS)
        text = "\n".join(lines)
        yield f"::error file={_property(part)},title=plan-cutters::{_data(text)}"
    if len(failing) > _MOST:
        yield f"::error title=plan-cutters::{len(failing) - _MOST + 1} more parts fail: the summary has all"


def _data(text: str) -> str:
    r"""A text that ends no line and begins no command.

    >>> _data("50 %\n::stop")
    '50 %25%0A::stop'
    """
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    """The same for a property, whose ends are marked by commas and colons."""
    return _data(text).replace(":", "%3A").replace(",", "%2C")
