"""The rows of all parts as tables for programs and spreadsheets: `index.csv` and `index.parquet`, the same columns in both."""

import csv
import io
import math
import re
import types
from collections.abc import Sequence
from importlib.util import find_spec
from typing import Any, Literal, Union, get_args, get_origin

from plan_cutters.batch.row import PartRow
from plan_cutters.batch.summary import cause, outcome

#: What a spreadsheet takes for the beginning of a formula (the wide forms too), or drops before one; and our own mark.
_FORMULA = re.compile(r"[=+\-@＝＋－＠'\s\x00-\x1f\x7f]")
#: Outcome first, as it sums up status and code; then the fields of a row in their order. New ones are appended.
_FIRST = ("name", "file", "outcome")
#: What no cell holds: the summary counts it.
_NESTED = frozenset({"tools"})


def columns() -> dict[str, type]:
    """The columns in their order: name -> str, int or float."""
    fields = {name: _kind(field.annotation) for name, field in PartRow.model_fields.items() if name not in _NESTED}
    return {**{name: fields.get(name, str) for name in _FIRST}, **fields}


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


def parquet_of(rows: Sequence[PartRow]) -> bytes | None:
    """The table for columnar engines, texts as they are; None where pyarrow is not installed."""
    if find_spec("pyarrow") is None:
        return None
    import pyarrow
    from pyarrow import parquet

    types_of = {str: pyarrow.string(), int: pyarrow.int64(), float: pyarrow.float64()}
    schema = pyarrow.schema([(name, types_of[kind]) for name, kind in columns().items()])
    sink = io.BytesIO()
    parquet.write_table(pyarrow.Table.from_pylist([values(row) for row in rows], schema=schema), sink)
    return sink.getvalue()


def _guarded(cell: Any) -> Any:
    return f"'{cell}" if isinstance(cell, str) and _FORMULA.match(cell) else cell


def _kind(annotation: Any) -> type:
    """The type of a field's values, whether they may be missing or not."""
    origin = get_origin(annotation)
    if origin is Literal:
        return type(get_args(annotation)[0])
    if origin in (Union, types.UnionType):
        (kind,) = (each for each in get_args(annotation) if each is not type(None))
        return _kind(kind)
    if annotation not in (str, int, float):
        raise TypeError(f"no column can hold {annotation}")
    return annotation
