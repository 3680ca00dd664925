"""The scorer: answers against the table of postures.

With a tolerance t (mm) and 0.01 degrees at the machine's limit a posture is

* *blocked*, if it is proved deeper than t (`high < -t`) or beyond the limit by more than 0.01 degrees,
* *free*, if it is proved to have more clearance than t (`low > t`) and to lie within the limit by more than 0.01 degrees,
* at the *border*, if it is neither: there each answer is right, and counts in no share.

`score` is the share of right answers among the postures that are not at the border: one who is always
undecided has 0. It hides nothing: a single false safe answer is one that breaks a part or a spindle, so look at `false_safe`
and `worst_mm` first.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from conformance.posture import Postures
from conformance.programs.protocol import ANSWERS, BLOCKED, SAFE, UNDECIDED, Words

#: The tolerance of depths and clearances (mm), and of angles at the machine's limit (degrees).
TOLERANCE, LIMIT_DEG = 0.01, 0.01
#: How many false answers are listed with their postures.
LISTED = 20

Mask = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Known:
    """What is proved of postures (n,): `blocked`, `free`, or neither."""

    blocked: Mask
    free: Mask

    @classmethod
    def of(cls, table: Postures, tolerance: float = TOLERANCE) -> "Known":
        """Return what the table proves at a tolerance. A number that is nan proves nothing."""
        beyond, within = table.limit_deg < -LIMIT_DEG, ~(table.limit_deg <= LIMIT_DEG)
        return cls(np.asarray((table.high < -tolerance) | beyond), np.asarray((table.low > tolerance) & within))

    @property
    def border(self) -> Mask:
        """Where each answer is right (n,)."""
        return ~(self.blocked | self.free)


def counts(table: Postures, answers: Words, tolerance: float = TOLERANCE, known: Known | None = None) -> dict[str, Any]:
    """Return the numbers of a table: `postures = border + right + false_safe + false_blocked + undecided`.

    `worst_mm` is the depth that is proved of the worst false safe answer, `worst_deg` the angle beyond the limit.
    """
    known = Known.of(table, tolerance) if known is None else known
    false_safe, false_blocked = known.blocked & (answers == SAFE), known.free & (answers == BLOCKED)
    right = (known.blocked & (answers == BLOCKED)) | (known.free & (answers == SAFE))
    undecided = ~known.border & (answers == UNDECIDED)
    judged = int((~known.border).sum())
    return {
        "postures": len(table),
        "border": int(known.border.sum()),
        "right": int(right.sum()),
        "false_safe": int(false_safe.sum()),
        "false_blocked": int(false_blocked.sum()),
        "undecided": int(undecided.sum()),
        "undecided_border": int((known.border & (answers == UNDECIDED)).sum()),
        "score": round(float(right.sum()) / judged, 6) if judged else None,
        "worst_mm": _worst(-table.high[false_safe]),
        "worst_deg": _worst(-table.limit_deg[false_safe]),
        "worst_false_blocked_mm": _worst(table.low[false_blocked]),
    }


def _worst(values: NDArray[np.float64]) -> float:
    """Return the largest positive number, or 0."""
    some = values[np.isfinite(values) & (values > 0)]
    return round(float(some.max()), 6) if len(some) else 0.0


def scored(table: Postures, answers: Words, families: Mapping[str, str], tolerance: float = TOLERANCE, rows: NDArray[np.int64] | None = None) -> dict[str, Any]:
    """Return the counts of all, of each family and of each part, and the worst false answers.

    `rows` are the rows of the suite's table.
    """
    if len(answers) != len(table):
        raise ValueError(f"{len(answers)} answers to {len(table)} postures")
    known = Known.of(table, tolerance)
    family = np.array([families[name] for name in table.part.tolist()], dtype=str)
    rows = np.arange(len(table)) if rows is None else rows

    def groups(words: NDArray[Any]) -> dict[str, Any]:
        out = {}
        for word in dict.fromkeys(words.tolist()):
            mine = np.flatnonzero(words == word)
            out[word] = counts(table[mine], answers[mine], tolerance)
        return out

    return {
        "parts": len(set(table.part.tolist())),
        **counts(table, answers, tolerance, known),
        "tolerance_mm": tolerance,
        "limit_deg": LIMIT_DEG,
        "families": groups(family),
        "by_part": groups(table.part),
        "false_answers": [
            *_listed(table, answers, rows, known.blocked & (answers == SAFE), np.nan_to_num(-table.high, nan=0.0)),
            *_listed(table, answers, rows, known.free & (answers == BLOCKED), np.nan_to_num(table.low, nan=0.0)),
        ],
    }


def _listed(table: Postures, answers: Words, rows: NDArray[np.int64], wrong: Mask, by: NDArray[np.float64]) -> list[dict[str, Any]]:
    """Return the worst of the wrong answers, with all that is needed to repeat them."""
    order = np.flatnonzero(wrong)
    order = order[np.argsort(-by[order], kind="stable")][:LISTED]

    def number(value: float) -> float | None:
        return float(value) if math.isfinite(value) else None

    return [
        {
            "row": int(rows[i]),
            "part": str(table.part[i]),
            "tool": str(table.tool[i]),
            "setup": str(table.setup[i]),
            "answer": str(answers[i]),
            "truth": str(table.verdict[i]),
            "low": number(table.low[i]),
            "high": number(table.high[i]),
            "limit_deg": number(table.limit_deg[i]),
            "reason": str(table.reason[i]),
            **{name: getattr(table, name)[i].tolist() for name in ("contact", "normal", "axis", "tip")},
        }
        for i in order
    ]


def write_answers(path: Path, rows: NDArray[np.int64], answers: Words) -> None:
    """Write answers as a CSV or a Parquet file: `id`, the row of the table from 0, and `answer`."""
    import pyarrow as pa
    import pyarrow.csv
    import pyarrow.parquet

    table = pa.table({"id": pa.array(rows), "answer": pa.array(answers.tolist())})
    if path.suffix == ".parquet":
        pyarrow.parquet.write_table(table, path)
    elif path.suffix == ".csv":
        pyarrow.csv.write_csv(table, path)
    else:
        raise ValueError(f"{path.name}: a file of answers is a .csv or a .parquet")


def read_answers(path: Path, count: int) -> tuple[NDArray[np.int64], Words]:
    """Return the rows and the answers of a file.

    Raises
    ------
    ValueError
        The file is none of answers to `count` postures; the text names the first row that is wrong.
    """
    import pyarrow as pa
    import pyarrow.csv
    import pyarrow.parquet

    if path.suffix not in (".csv", ".parquet"):
        raise ValueError(f"{path.name}: a file of answers is a .csv or a .parquet")
    try:
        if path.suffix == ".csv":
            keep = pyarrow.csv.ConvertOptions(strings_can_be_null=False, column_types={"answer": "string"})
            table = pyarrow.csv.read_csv(path, convert_options=keep)
        else:
            table = pyarrow.parquet.read_table(path)
    except (pa.ArrowInvalid, OSError) as error:
        raise ValueError(f"{path.name}: cannot be read: {str(error).splitlines()[0]}") from None
    for name in ("id", "answer"):
        if name not in table.column_names:
            raise ValueError(f"{path.name}: no column {name}; it has {', '.join(table.column_names)}")
    if not pa.types.is_integer(table["id"].type):
        raise ValueError(f"{path.name}: the column id holds other things than row numbers")
    words = [str(word) for word in table["answer"].to_pylist()]
    _refuse(path.name, table["id"].to_pylist(), words, count)
    return np.array(table["id"].to_pylist(), np.int64), np.array(words, dtype=str)


def _refuse(name: str, rows: Sequence[Any], words: Sequence[str], count: int) -> None:
    """Raise a ValueError about the first answer that has no meaning."""
    seen: set[int] = set()
    for line, (row, word) in enumerate(zip(rows, words, strict=True), 1):
        if row is None or not 0 <= row < count:
            raise ValueError(f"{name}: answer {line}: id {row} is no row of the table, which has 0 to {count - 1}")
        if row in seen:
            raise ValueError(f"{name}: answer {line}: id {row} is answered twice")
        if word not in ANSWERS:
            raise ValueError(f"{name}: answer {line}: {word!r} is none of {', '.join(ANSWERS)}")
        seen.add(row)
