"""All parts summed up in numbers: `summary.json`, and its schema."""

import json
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field

from plan_cutters.batch.row import PartRow

FORMAT_VERSION = 1
#: Failures that the summary names; the table has all.
NAMED = 100

#: What came of a part, from worst to best.
Outcome = Literal["failed", "not_finished", "not_sure", "finished"]
#: The same in words for people.
OUTCOMES: dict[Outcome, str] = {
    "failed": "failed",
    "not_finished": "not finished",
    "not_sure": "not sure",
    "finished": "finished",
}
#: By the exit code of a single plan; every other code is a failure.
_OF_CODES: dict[int, Outcome] = {0: "finished", 1: "not_finished", 4: "not_sure"}


def outcome(row: PartRow) -> Outcome:
    """Sum up a part in a word.

    >>> outcome(PartRow(name="a", file="a.step", status="kept", code=4))
    'not_sure'
    >>> outcome(PartRow(name="a", file="a.step", status="planned", code=139))
    'failed'
    """
    return "failed" if row.status == "failed" else _OF_CODES.get(row.code, "failed")


def code_of(row: PartRow) -> int:
    """The exit code of a part: a failure has never that of an answer.

    >>> code_of(PartRow(name="a", file="a.step", status="failed", code=0))
    3
    """
    return row.code if outcome(row) != "failed" or row.code > 1 else 3


def cause(row: PartRow) -> str:
    """Why a part failed: never empty."""
    return row.error or f"no cause was reported (exit code {row.code})"


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
    failures: list[Failure] = Field(description=f"the first {NAMED}, by name; the tables have all")
    files: dict[str, Table] = Field(description="the tables that were written before this file, by format")
    versions: dict[str, str]
    run: BatchRun


def summary_of(
    rows: Sequence[PartRow], *, title: str, files: Mapping[str, Table], versions: Mapping[str, str], run: BatchRun
) -> Summary:
    """Sum up the rows."""
    outcomes = [outcome(row) for row in rows]
    cutters: dict[str, Counter[str]] = {}
    for row, result in zip(rows, outcomes, strict=True):
        if row.cutter is not None:
            cutters.setdefault(row.cutter, Counter())[result] += 1
    failed = [row for row, result in zip(rows, outcomes, strict=True) if result == "failed"]
    reasons = Counter(row.reason for row, result in zip(rows, outcomes, strict=True) if row.reason and result != "finished")
    made = Counter(row.status for row in rows)
    return Summary(
        title=title,
        code=max(map(code_of, rows), default=0),
        parts=Parts(count=len(rows), planned=made["planned"], kept=made["kept"], **_counts(Counter(outcomes))),
        by_cutter=[
            CutterParts(cutter=name, **_counts(result))
            for name, result in sorted(cutters.items(), key=lambda each: (-each[1].total(), each[0]))
        ],
        by_reason=[
            ReasonParts(reason=code, parts=parts) for code, parts in sorted(reasons.items(), key=lambda each: (-each[1], each[0]))
        ],
        failures=[Failure(name=row.name, file=row.file, code=code_of(row), error=cause(row)) for row in failed[:NAMED]],
        files=dict(files),
        versions=dict(versions),
        run=run,
    )


def _counts(counts: Mapping[str, int]) -> dict[str, int]:
    return {word: counts.get(word, 0) for word in OUTCOMES}


def schema() -> dict[str, Any]:
    """JSON Schema of `summary.json` (draft 2020-12), made from the model."""
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **Summary.model_json_schema(mode="serialization")}


def schema_text() -> str:
    return json.dumps(schema(), indent=2) + "\n"


if __name__ == "__main__":
    (Path(__file__).parent.parent / "batch_summary.schema.json").write_text(schema_text(), encoding="utf-8")
