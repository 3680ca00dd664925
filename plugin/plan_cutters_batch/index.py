"""The index of many parts: a page for people, a table for programs, and a summary, in the folder above theirs."""

import csv
import hashlib
import io
import math
import re
from collections.abc import Callable, Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path, PurePosixPath
from typing import Any
from urllib.parse import quote

from markupsafe import Markup
from pydantic_core import to_jsonable_python

from plan_cutters.document.build import versions
from plan_cutters.domain import figures as numbers
from plan_cutters.domain.figures import percent
from plan_cutters.files.markup import finite, plain, policy, template
from plan_cutters.plan_file.reasons import reason
from plan_cutters_batch.row import PartRow, PartTools
from plan_cutters_batch.summary import OUTCOMES, BatchRun, LeastTools, Summary, Table, cause, fault, outcome, summary_of

PAGE, CSV, SUMMARY = "index.html", "index.csv", "summary.json"
_HERE = Path(__file__).parent
#: What a spreadsheet takes for the beginning of a formula (the wide forms too), or drops before one; and our own mark.
_FORMULA = re.compile(r"[=+\-@＝＋－＠'\s\x00-\x1f\x7f]")
#: Outcome first, as it sums up status and code; then the fields of a row in their order. New ones are appended.
_FIRST = ("name", "file", "outcome")
#: What no cell holds: the summary counts it.
_NESTED = frozenset({"tools"})
#: Tools that a sentence names.
_NAMED = 8


def write_index(
    rows: Sequence[PartRow], put: Callable[[str, bytes], None], *, title: str, seconds: float, cluster: Mapping[str, object]
) -> None:
    """Write the index of all parts; all is made before anything is written, and the summary comes last.

    Parameters
    ----------
    rows : sequence of PartRow
        In any order: the table has them by name, the page with failures on top.
    put : callable
        Called with the name of a file and its content; it lets the file appear whole or not at all, or raises.
    title : str
    seconds : float
        By the clock, of the whole run.
    cluster : mapping
        Where it ran, as words and numbers: what is no JSON is told by its `str`.
    """
    rows = sorted((_clean(row) for row in rows), key=lambda row: (row.name, row.file, row.key))
    tables = {CSV: csv_of(rows)}
    facts = to_jsonable_python(dict(cluster), fallback=str, inf_nan_mode="constants")
    summary = summary_of(
        rows,
        title=plain(title),
        files={"csv": Table(name=CSV, sha256=hashlib.sha256(tables[CSV]).hexdigest())},
        versions=versions(),
        run=BatchRun(
            time=datetime.now(UTC).isoformat(timespec="seconds"),
            seconds=finite(float(seconds)),
            seconds_of_parts=sum(row.seconds for row in rows if row.status != "kept" and math.isfinite(row.seconds)),
            cluster={plain(str(name)): plain(value) for name, value in finite(facts).items()},
        ),
    )
    tables[PAGE] = page(rows, summary)
    tables[SUMMARY] = (summary.model_dump_json(indent=2) + "\n").encode()
    for name, data in tables.items():
        put(name, data)


def page(rows: Sequence[PartRow], summary: Summary) -> bytes:
    """The page: UTF-8, one file without its pictures and the pages of the parts, which it names relative to itself."""
    worst = list(OUTCOMES)
    shown = sorted(map(_shown, rows), key=lambda each: worst.index(each["outcome"]))
    script, style = ((_HERE / name).read_text(encoding="utf-8") for name in ("index.js", "index.css"))
    return _TEMPLATE.render(
        policy=policy(script, style, "'self' file:"),
        script=Markup(script),
        style=Markup(style),
        summary=summary,
        rows=shown,
        worst={word: place for place, word in enumerate(worst)},
        outcomes=OUTCOMES,
        of=summary.parts.model_dump(),
        shop=shop_lines(summary),
        pages={each["row"].name: each["page"] for each in shown},
        percent=percent,
        reason=reason,
        time=numbers.duration,
        w=numbers,
    ).encode()


def _shown(row: PartRow) -> dict[str, Any]:
    """A row as the page has it: texts, and what they are sorted by where that is not the text."""
    result = outcome(row)
    return {
        "row": row,
        "outcome": result,
        # Of a part that failed its cause, else the headline; then what went wrong all the same, as a file that was not written.
        "says": cause(row) if result == "failed" else row.verdict,
        "wrong": "" if result == "failed" else row.error or "",
        "coarser": row.coarser or "",
        "late": fault(row) == "late",
        "made": "reused from an earlier run" if row.status == "kept" else "",
        "share": "" if row.share is None else percent(row.share),
        "reason": reason(row.reason) if row.reason else "",
        "time": numbers.duration(row.seconds),
        "seconds": row.seconds if math.isfinite(row.seconds) else -1.0,
        "page": _link(row.page or (f"{row.folder}/plan.json" if row.folder and result == "failed" else None)),
        "picture": _link(row.picture),
    }


def _link(path: str | None) -> str:
    """A path below the index as a reference that cannot leave its folder, nor begin with a scheme; empty where there is none.

    >>> _link("a b/review.html"), _link("javascript:alert(1)"), _link("../x"), _link("/etc/passwd"), _link(None)
    ('./a%20b/review.html', './javascript%3Aalert%281%29', '', '', '')
    """
    if not path or path.startswith("/") or ".." in PurePosixPath(path).parts:
        return ""
    try:
        # Bytes of a file's name that are no UTF-8 stay what they are.
        return "./" + quote(path.encode("utf-8", "surrogateescape"))
    except UnicodeEncodeError:
        return ""  # no file system has such a name


def _clean(row: PartRow) -> PartRow:
    """The row without what has no place in a text file; links keep their bytes."""
    texts = {name: plain(value) for name, value in row if name not in ("page", "picture", "tools")}
    tools = None if row.tools is None else PartTools.model_validate(_plain(row.tools.model_dump()))
    return row.model_copy(update={**texts, "tools": tools})


def _plain(value: Any) -> Any:
    """The same value with `plain` texts, and no number that is not finite."""
    if isinstance(value, Mapping):
        return {plain(name): _plain(each) for name, each in value.items()}
    if isinstance(value, list | tuple):
        return tuple(map(_plain, value))
    return finite(plain(value))


def columns() -> list[str]:
    """The columns in their order."""
    return list(dict.fromkeys((*_FIRST, *(name for name in PartRow.model_fields if name not in _NESTED))))


def values(row: PartRow) -> dict[str, Any]:
    """The cells of a row; None for what is not known. A part that failed always says why."""
    result = outcome(row)
    cells = {**row.model_dump(exclude=set(_NESTED)), "outcome": result, "error": cause(row) if result == "failed" else row.error}
    return {
        name: None if isinstance(cells[name], float) and not math.isfinite(cells[name]) else cells[name] for name in columns()
    }


def csv_of(rows: Sequence[PartRow]) -> bytes:
    """The table as text (RFC 4180, UTF-8): a header, then a line for each part; what is not known is empty.

    A text that a spreadsheet might take for a formula has an apostrophe in front, as has one that begins with an apostrophe: who
    takes the first apostrophe away has the text as it was.
    """
    text = io.StringIO(newline="")
    table = csv.writer(text, lineterminator="\r\n")
    table.writerow(columns())
    for row in rows:
        cells = values(row).values()
        table.writerow([f"'{cell}" if isinstance(cell, str) and _FORMULA.match(cell) else cell for cell in cells])
    # Paths keep bytes that are no UTF-8.
    return text.getvalue().encode(errors="backslashreplace")


def shop_lines(summary: Summary) -> list[str]:
    """Say which tools finish most parts, which are the fewest for all parts that are finished, and which are never used."""
    shop, parts = summary.shop, summary.parts
    if not shop.tools:
        return []
    best = [each.tool for each in shop.tools if each.alone == shop.tools[0].alone]
    lines = [
        f"Finishes most parts alone: {_listed(best)}, {shop.tools[0].alone:,} of {parts.count:,}{' each' * (len(best) > 1)}."
        if shop.tools[0].alone
        else "No tool finishes a part alone."
    ]
    lines.append("No tools finish a part together beyond doubt." if shop.least is None else _least(shop.least))
    if shop.never_used:
        lines.append(f"In no plan: {_listed(shop.never_used)}.")
    return lines


def _least(least: LeastTools) -> str:
    parts = "the one part" if least.parts == 1 else f"all {least.parts:,} parts"
    names = _listed(least.tools)
    if len(least.tools) == 1:
        return f"One tool finishes {parts} that can be finished beyond doubt: {names}."
    text = f"Fewest tools for {parts} that can be finished beyond doubt, {len(least.tools)}: {names}"
    if least.proven:
        return f"{text}. No fewer do (proved)."
    doubt = f"whether fewer than {len(least.tools)} do, the plans do not state"
    return f"{text}. At least {numbers.count(least.at_least, 'tool')} must be there (proved); {doubt}."


def _listed(names: Sequence[str]) -> str:
    rest = len(names) - _NAMED
    return ", ".join(names[:_NAMED]) + (f" and {rest} more" if rest > 0 else "")


_TEMPLATE = template(_HERE / "index.html.jinja")
