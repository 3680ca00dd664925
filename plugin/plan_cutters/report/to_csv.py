"""The posture found at every sample as a table of text (RFC 4180): `axes.csv`."""

import csv
from pathlib import Path
from typing import Any

import numpy as np

from plan_cutters.report.axes import Column, columns
from plan_cutters.report.protocol import Judged


def write_csv(result: Judged, _split: object, path: Path) -> None:
    """Write `axes.csv`: a header line, then a line for each sample, for the cutter shown; what is not known is empty.

    Lines end as RFC 4180 has it, numbers have a point, units stand at the end of the names. `docs/cam_outputs.md` has the
    columns.
    """
    table = columns(result)
    cells = [text for column in table for text in _cells(column)]
    names = ["cutter", *(name for column in table for name in column.names)]
    with path.open("w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file, lineterminator="\r\n")
        rows.writerow(names)
        shown = [result.shown] * len(result.samples)
        rows.writerows(zip(shown, *cells, strict=True))


def _cells(column: Column) -> list[list[Any]]:
    """Make the cells of a column, one list for each column of the file."""
    values = column.values
    if column.words is not None:
        codes, index = np.unique(values, return_inverse=True)
        words = np.array([column.words[code] for code in codes.tolist()], object)
        return [words[index].tolist()]
    if values.dtype.kind != "f":
        return [values.tolist()]
    # Adding zero turns -0.0 into 0.0.
    rounded = np.round(values, column.digits) + 0.0
    cells = rounded.astype(object)
    cells[~np.isfinite(rounded)] = ""
    return [each.tolist() for each in np.atleast_2d(cells.T)]
