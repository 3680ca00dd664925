"""A comparison as Markdown, for the summary of a job in CI."""

import unicodedata
from collections.abc import Iterable, Iterator, Mapping, Sequence
from types import MappingProxyType
from urllib.parse import quote

from plan_cutters_ci.model import Comparison, PlanDifference
from plan_cutters_ci.wording import CUTTERS, FACES, apart, cutter_rows, face_rows, headline, remarks, verdict

#: Rows of a table; a summary of GitHub may have one MiB.
MOST_ROWS = 100
#: What Markdown, or the HTML that it may hold, would take as its own.
_OWN = frozenset("\\`*_{}[]<>()#+!|~&@$")


def markdown(comparison: Comparison, pages: Mapping[str, str] = MappingProxyType({})) -> str:
    """The comparison in Markdown: a section for each pair of plans that differ, and a sentence for the others.

    Parameters
    ----------
    comparison : Comparison
    pages : mapping
        Paths of the pages of both plans by the name of their pair; the only one has none.
    """
    same = [each for each in comparison.plans if each.same]
    lines = [f"**{verdict(comparison)}**", ""]
    for each in comparison.plans:
        if not each.same:
            page = pages.get(each.name) or pages.get("")
            lines += [*section(each), *(["", page_link(page)] if page else []), ""]
    lines += [f"- {escaped(line)}" for line in apart(comparison)]
    if same:
        lines += ["", f"Nothing changed: {', '.join(escaped(each.name) for each in same)}."]
    return "\n".join(lines).rstrip() + "\n"


def section(difference: PlanDifference) -> Iterator[str]:
    """The lines of one pair of plans."""
    yield f"### {escaped(headline(difference))}"
    yield ""
    for line in difference.why_not:
        yield f"- **Not comparable:** {escaped(line)}"
    for line in remarks(difference):
        yield f"- {escaped(line)}"
    yield from table(FACES, face_rows(difference))
    yield from table(CUTTERS, cutter_rows(difference))


def page_link(path: str, address: str = "") -> str:
    """A link to the page of two plans, or to an address that has it.

    >>> page_link("compared/a b/review.html")
    '[Both plans side by side](compared/a%20b/review.html)'
    """
    within = f": {escaped(path)} there" if address else ""
    return f"[Both plans side by side]({address or quote(path)}){within}"


def table(names: Sequence[str], rows: Iterable[Sequence[str]]) -> Iterator[str]:
    """A table with a blank line before it; nothing where there is no row."""
    lines = list(rows)
    if not lines:
        return
    yield ""
    yield f"| {' | '.join(name or ' ' for name in names)} |"
    yield f"|{' --- |' * len(names)}"
    yield from (f"| {' | '.join(escaped(cell) or ' ' for cell in row)} |" for row in lines[:MOST_ROWS])
    if len(lines) > MOST_ROWS:
        yield ""
        yield f"and {len(lines) - MOST_ROWS} more: `--json` has all."


def escaped(text: str) -> str:
    r"""A text that Markdown shows as it stands; names in files may hold anything.

    >>> escaped("a|b <img>\n*c*")
    'a\\|b \\<img\\>\\\\n\\*c\\*'
    """
    plain = "".join(c.encode("unicode_escape").decode() if unicodedata.category(c)[0] == "C" else c for c in text)
    return "".join(f"\\{c}" if c in _OWN else c for c in plain)
