"""The index of many parts: a page for people, a table for programs, and a summary, in the folder above theirs."""

import hashlib
import math
from collections.abc import Callable, Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path, PurePosixPath
from typing import Any, NamedTuple
from urllib.parse import quote

from markupsafe import Markup
from pydantic_core import to_jsonable_python

from plan_cutters.document.build import versions
from plan_cutters.domain import figures as numbers
from plan_cutters.domain.figures import percent
from plan_cutters.files.markup import finite, plain, policy, template
from plan_cutters.plan_file.words.cutters import reason
from plan_cutters_batch.part_tools import PartTools
from plan_cutters_batch.row import PartRow
from plan_cutters_batch.shop_text import shop_lines
from plan_cutters_batch.summary import OUTCOMES, BatchRun, Outcome, Summary, Table, cause, fault, outcome, summary_of
from plan_cutters_batch.table import csv_of

PAGE, CSV, SUMMARY = "index.html", "index.csv", "summary.json"
_HERE = Path(__file__).parent


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
        What was planned, for people.
    seconds : float
        By the clock, of the whole run.
    cluster : mapping
        Where it ran, as words and numbers: what is no JSON is told by its `str`.
    """
    rows = sorted((_clean(row) for row in rows), key=lambda row: (row.name, row.file, row.key))
    tables = {CSV: csv_of(rows)}
    summary = summary_of(
        rows,
        title=plain(title),
        files={name.rpartition(".")[2]: _table(name, data) for name, data in tables.items()},
        versions=versions(),
        run=BatchRun(
            time=datetime.now(UTC).isoformat(timespec="seconds"),
            seconds=finite(float(seconds)),
            seconds_of_parts=sum(row.seconds for row in rows if row.status != "kept" and math.isfinite(row.seconds)),
            cluster=_facts(cluster),
        ),
    )
    tables[PAGE] = page(rows, summary)
    tables[SUMMARY] = (summary.model_dump_json(indent=2) + "\n").encode()
    for name, data in tables.items():
        put(name, data)


class _Shown(NamedTuple):
    """A row as the page has it: texts, and what they are sorted by where that is not the text."""

    row: PartRow
    outcome: Outcome
    #: Of a part that failed its cause, else the headline; what went wrong all the same, as a file that was not written; what was
    #: not done as requested; and how the answer came about.
    says: str
    wrong: str
    coarser: str
    late: bool
    made: str
    share: str
    reason: str
    time: str
    seconds: float
    page: str
    picture: str


def page(rows: Sequence[PartRow], summary: Summary) -> bytes:
    """The page: UTF-8, one file without its pictures and the pages of the parts, which it names relative to itself."""
    worst = list(OUTCOMES)
    shown = sorted(map(_shown, rows), key=lambda each: worst.index(each.outcome))
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
        pages={each.row.name: each.page for each in shown},
        percent=percent,
        reason=reason,
        time=numbers.duration,
        w=numbers,
    ).encode()


def _shown(row: PartRow) -> _Shown:
    result = outcome(row)
    return _Shown(
        row=row,
        outcome=result,
        says=cause(row) if result == "failed" else row.verdict,
        wrong="" if result == "failed" else row.error or "",
        coarser=row.coarser or "",
        late=fault(row) == "late",
        made=_made(row),
        share="" if row.share is None else percent(row.share),
        reason=reason(row.reason) if row.reason else "",
        time=numbers.duration(row.seconds),
        seconds=row.seconds if math.isfinite(row.seconds) else -1.0,
        page=_link(row.page or (f"{row.folder}/plan.json" if row.folder and result == "failed" else None)),
        picture=_link(row.picture),
    )


def _made(row: PartRow) -> str:
    """Whether the answer is an earlier one."""
    return "reused from an earlier run" if row.status == "kept" else ""


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


def _facts(cluster: Mapping[str, object]) -> dict[str, Any]:
    facts = to_jsonable_python(dict(cluster), fallback=str, inf_nan_mode="constants")
    return {plain(str(name)): plain(value) for name, value in finite(facts).items()}


def _table(name: str, data: bytes) -> Table:
    return Table(name=name, sha256=hashlib.sha256(data).hexdigest())


_TEMPLATE = template(_HERE / "index.html.jinja")
