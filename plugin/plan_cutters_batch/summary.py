"""All parts summed up: `summary.json` and its schema, a page for people and a table for programs, in the folder above theirs."""

import csv
import hashlib
import io
import json
import math
import re
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path, PurePosixPath
from typing import Any, Literal
from urllib.parse import quote

from markupsafe import Markup
from pydantic import BaseModel, ConfigDict, Field
from pydantic_core import to_jsonable_python

from plan_cutters.document.build import versions
from plan_cutters.domain import figures as numbers
from plan_cutters.domain.figures import percent
from plan_cutters.files.markup import embedded, finite, plain, policy, template
from plan_cutters.plan_file.words.cutters import reason
from plan_cutters_batch.row import OUTCOMES, PartRow, cause, code_of, fault, fewest, outcome

FORMAT_VERSION = 1
#: Failures that the summary names; the table has all.
NAMED = 100


class _Entry(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class Counts(_Entry):
    """How many parts have each outcome."""

    failed: int = 0
    not_finished: int = Field(default=0, description="no cutter reaches all that could be judged")
    not_sure: int = Field(default=0, description="a cutter would, but something could not be judged or obstacles are missing")
    finished: int = Field(default=0, description="a cutter reaches every judged sample")


class Parts(Counts):
    """The same, and where the answers came from."""

    count: int
    planned: int = Field(description="planned in this run")
    kept: int = Field(description="answers reused from earlier runs; those that failed are in neither")


class CutterParts(Counts):
    """A cutter is the one to take of so many parts, or comes nearest; by outcome."""

    cutter: str


class ReasonParts(_Entry):
    """Parts that lose most by a reason."""

    reason: str = Field(description="a code of the plans' `reasons`")
    parts: int


class Failure(_Entry):
    name: str
    file: str
    code: int
    error: str = Field(description="one line: file, face, cause, what to try")


class ToolParts(_Entry):
    """A tool is judged on so many parts; so many it finishes alone, and in the plans of so many it has a step."""

    tool: str
    id: str = Field(description="as in the plans: the same dimensions, the same id")
    judged: int
    alone: int = Field(description="parts of which it reaches every judged sample, beyond doubt")
    used: int = Field(description="parts whose plan has a step with it, whatever the plan finishes")


class LeastTools(_Entry):
    """The fewest tools for all parts that are finished, as far as the plans state which tools finish a part together."""

    tools: list[str] = Field(description="the one that finishes most parts alone first")
    parts: int = Field(description="that they finish: all that any tools finish beyond doubt")


class UnfinishedPart(_Entry):
    """A part that nothing finishes, and what it needs."""

    name: str
    share: float | None = Field(description="of what is requested, that all its tools finish together, 0 to 1; null: not known")
    needs: list[str] = Field(description="what would finish more, the best first; empty where its plan does not say")


class ShopTools(_Entry):
    """The tools of all parts of a batch together."""

    tools: list[ToolParts] = Field(default=[], description="the one that finishes most parts alone first")
    least: LeastTools | None = Field(default=None, description="null where no part is finished")
    never_used: list[str] = Field(default=[], description="judged, and in no step of any plan")
    unfinished: list[UnfinishedPart] = Field(default=[], description=f"the first {NAMED}, by name")
    unfinished_count: int = Field(
        default=0, description="parts that nothing finishes; those in doubt and failed ones are not counted"
    )
    not_known: int = Field(default=0, description="parts, failed ones too, of which no plan states what its tools finish")


class Table(_Entry):
    name: str
    sha256: str


class BatchRun(_Entry):
    """Beside the rows' own seconds, only these values differ between two runs with the same input."""

    time: str = Field(description="UTC, ISO 8601, at which the table was written")
    seconds: float | None = Field(description="by the clock, of the whole run; null where it is not known")
    seconds_of_parts: float = Field(description="sum over the parts that were planned in this run, or failed in it")
    cluster: dict[str, Any] = Field(description="where it ran")


class Summary(_Entry):
    """A summary counts many parts, and has the worst exit code, the first failures and the tables beside it."""

    format: Literal["plan-cutters-batch"] = "plan-cutters-batch"
    format_version: int = FORMAT_VERSION
    title: str
    code: int = Field(description="the worst exit code of a part, as of `plan-cutters` with several parts: the largest")
    parts: Parts
    by_cutter: list[CutterParts] = Field(description="most parts first; parts without a cutter are in none")
    by_reason: list[ReasonParts] = Field(description="most parts first; of the parts that are not finished")
    shop: ShopTools = Field(default=ShopTools(), description="which tools finish which parts, alone and together")
    failures: list[Failure] = Field(description=f"the first {NAMED}, by name; the tables have all")
    files: dict[str, Table] = Field(description="the tables that were written before this file, by format")
    versions: dict[str, str]
    run: BatchRun


def summary_of(rows: Sequence[PartRow], table: bytes, *, title: str, seconds: float, cluster: Mapping[str, object]) -> Summary:
    """Sum up the rows, and the table that they make."""
    cutters: dict[str, Counter[str]] = {}
    for row in rows:
        if row.cutter is not None:
            cutters.setdefault(row.cutter, Counter())[outcome(row)] += 1
    failed = [row for row in rows if outcome(row) == "failed"]
    reasons = Counter(row.reason for row in rows if row.reason and outcome(row) != "finished")
    made = Counter(row.status for row in rows)
    return Summary(
        title=plain(title),
        code=max(map(code_of, rows), default=0),
        parts=Parts(count=len(rows), planned=made["planned"], kept=made["kept"], **Counter(str(outcome(row)) for row in rows)),
        by_cutter=[CutterParts(cutter=name, **cutters[name])
                   for name in sorted(cutters, key=lambda name: (-cutters[name].total(), name))],
        by_reason=[ReasonParts(reason=code, parts=reasons[code])
                   for code in sorted(reasons, key=lambda code: (-reasons[code], code))],
        shop=_shop(rows),
        failures=[Failure(name=row.name, file=row.file, code=code_of(row), error=cause(row)) for row in failed[:NAMED]],
        files={"csv": Table(name=CSV, sha256=hashlib.sha256(table).hexdigest())},
        versions=versions(),
        run=BatchRun(
            time=datetime.now(UTC).isoformat(timespec="seconds"),
            seconds=finite(float(seconds)),
            seconds_of_parts=sum(row.seconds for row in rows if row.status != "kept" and math.isfinite(row.seconds)),
            cluster=json.loads(embedded(to_jsonable_python(dict(cluster), fallback=str, inf_nan_mode="constants"))),
        ),
    )  # fmt: skip


def _shop(rows: Sequence[PartRow]) -> ShopTools:
    """Sum up the tools of all parts."""
    parts = [row.tools for row in rows if row.tools is not None and row.status != "failed"]
    # How each tool is called: as most plans call it, each otherwise.
    calls: dict[str, Counter[str]] = {}
    for part in parts:
        for tool, name in part.names.items():
            calls.setdefault(tool, Counter())[name] += 1
    names = {tool: min(call, key=lambda name: (-call[name], name)) for tool, call in calls.items()}
    taken = Counter(names.values())
    names = {tool: name if taken[name] == 1 else f"{name} ({tool})" for tool, name in names.items()}
    judged = Counter(tool for part in parts for tool in part.names)
    alone = Counter(tool for part in parts for tool in part.alone)
    used = Counter(tool for part in parts for tool in part.used)
    order = sorted(judged, key=lambda tool: (-alone[tool], -used[tool], names[tool], tool))
    best = fewest(parts)
    unfinished = [row for row in rows if outcome(row) == "not_finished"]
    return ShopTools(
        tools=[ToolParts(tool=names[tool], id=tool, judged=judged[tool], alone=alone[tool], used=used[tool]) for tool in order],
        least=None if not best else
        LeastTools(tools=[names[tool] for tool in best], parts=sum(part.finished_by(best) for part in parts)),
        never_used=[names[tool] for tool in order if not used[tool]],
        unfinished=[
            UnfinishedPart(name=row.name, share=tools.share if tools else None, needs=list(tools.needs) if tools else [])
            for row, tools in ((row, row.tools) for row in unfinished[:NAMED])
        ],
        unfinished_count=len(unfinished), not_known=len(rows) - len(parts),
    )  # fmt: skip


def schema_text() -> str:
    """JSON Schema of `summary.json` (draft 2020-12), made from the model."""
    made = Summary.model_json_schema(mode="serialization")
    return json.dumps({"$schema": "https://json-schema.org/draft/2020-12/schema", **made}, indent=2) + "\n"


PAGE, CSV, SUMMARY = "index.html", "index.csv", "summary.json"
_HERE = Path(__file__).parent
#: What a spreadsheet takes for the beginning of a formula (the wide forms too), or drops before one; and our own mark.
_FORMULA = re.compile(r"[=+\-@＝＋－＠'\s\x00-\x1f\x7f]")
#: Tools that a sentence names.
_NAMED = 8


def write_index(
    rows: Sequence[PartRow], put: Callable[[str, bytes], None], *, title: str, seconds: float, cluster: Mapping[str, object]
) -> None:
    """Write the index of all parts; all is made before anything is written, and the summary comes last.

    Rows come in any order: the table has them by name, the page with failures on top. `put` lets a file of a name and a content
    appear whole or not at all, or raises. `seconds` by the clock, of the whole run. `cluster` says where it ran.
    """
    rows = sorted(map(_clean, rows), key=lambda row: (row.name, row.file, row.key))
    table = csv_of(rows)
    summary = summary_of(rows, table, title=title, seconds=seconds, cluster=cluster)
    text = (summary.model_dump_json(indent=2) + "\n").encode()
    for name, data in ((CSV, table), (PAGE, page(rows, summary)), (SUMMARY, text)):
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
    same = {"page": row.page, "picture": row.picture, "seconds": row.seconds}
    return PartRow.model_validate(json.loads(embedded(row.model_dump())) | same)


#: Columns in their order: the outcome first, as it sums up status and code; then the fields of a row.
COLUMNS = [*dict.fromkeys(("name", "file", "outcome", *(name for name in PartRow.model_fields if name != "tools")))]


def csv_of(rows: Sequence[PartRow]) -> bytes:
    """The table as text (RFC 4180, UTF-8): a header, then a line for each part; what is not known is empty.

    A text that a spreadsheet might take for a formula has an apostrophe in front, as has one that begins with an apostrophe: who
    takes the first apostrophe away has the text as it was.
    """
    text = io.StringIO(newline="")
    table = csv.writer(text, lineterminator="\r\n")
    table.writerow(COLUMNS)
    for row in rows:
        result = outcome(row)
        cells = finite(row.model_dump() | {"outcome": result, "error": cause(row) if result == "failed" else row.error})
        texts = (cells[name] for name in COLUMNS)
        table.writerow([f"'{cell}" if isinstance(cell, str) and _FORMULA.match(cell) else cell for cell in texts])
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
    return f"Fewest tools for {parts} that can be finished beyond doubt, {len(least.tools)}: {names}."


def _listed(names: Sequence[str]) -> str:
    rest = len(names) - _NAMED
    return ", ".join(names[:_NAMED]) + (f" and {rest} more" if rest > 0 else "")


_TEMPLATE = template(_HERE / "index.html.jinja")


if __name__ == "__main__":
    Path(__file__).with_name("summary.schema.json").write_text(schema_text(), encoding="utf-8")
