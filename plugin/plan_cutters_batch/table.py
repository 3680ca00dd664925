"""The rows of all parts as a table for programs and spreadsheets: `index.csv`."""

import csv
import io
import math
import re
from collections.abc import Sequence
from typing import Any

from plan_cutters_batch.row import PartRow
from plan_cutters_batch.summary import cause, outcome

#: What a spreadsheet takes for the beginning of a formula (the wide forms too), or drops before one; and our own mark.
_FORMULA = re.compile(r"[=+\-@＝＋－＠'\s\x00-\x1f\x7f]")
#: Outcome first, as it sums up status and code; then the fields of a row in their order. New ones are appended.
_FIRST = ("name", "file", "outcome")
#: What no cell holds: the summary counts it.
_NESTED = frozenset({"tools"})


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
    table.writerows([_guarded(cell) for cell in values(row).values()] for row in rows)
    return text.getvalue().encode()


def _guarded(cell: Any) -> Any:
    return f"'{cell}" if isinstance(cell, str) and _FORMULA.match(cell) else cell
