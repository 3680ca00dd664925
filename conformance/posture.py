"""The table of postures: what is asked, and the answer that is known.

A posture is a tool that stands at a contact point: unit mm, part coordinates, axis from the tip to the spindle, normal out of the material.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from conformance.tool import Floats

Words = NDArray[np.str_]

#: Decimal places of the tables: nanometres, and 1e-12 of a unit vector.
_PLACES_MM, _PLACES_UNIT = 9, 12
#: Columns that hold three numbers each, and those of words.
_VECTORS = ("contact", "normal", "axis", "tip")
#: Columns that are the known answers.
KNOWN = ("verdict", "low", "high", "limit_deg", "reason", "proof")
_TEXTS = ("part", "tool", "setup", "verdict", "reason", "proof")


@dataclass(frozen=True, eq=False)
class Postures:
    """Postures with their known answers, one row each.

    Attributes
    ----------
    part, tool, setup : (n,) str
        Names in `parts.json`.
    contact, normal, axis, tip : (n, 3) float
        mm and unit vectors, part coordinates.
    verdict : (n,) str
        `safe` or `blocked`.
    low, high : (n,) float
        The margin, mm, lies between the two: minus the depth of a blocked posture, the clearance of a safe one. Equal in a closed form. The
        clearance leaves out the body (of a real part: the face and its neighbours) that the tool touches at its contact.
    limit_deg : (n,) float
        Angle to the machine's limit, positive within; nan without a limit.
    reason : (n,) str
        Of a blocked posture: `cutter`, `shank`, `holder` (the piece that the material reaches deepest), `fixture`, `limit`; else empty.
    proof : (n,) str
        `form` (closed form) or `bound` (branch and bound on the exact surface).
    """

    part: Words
    tool: Words
    setup: Words
    contact: Floats
    normal: Floats
    axis: Floats
    tip: Floats
    verdict: Words
    low: Floats
    high: Floats
    limit_deg: Floats
    reason: Words
    proof: Words

    def __len__(self) -> int:
        return len(self.part)

    def __getitem__(self, rows: NDArray[np.generic] | slice | Sequence[int]) -> "Postures":
        return Postures(*(getattr(self, f.name)[rows] for f in fields(self)))

    @classmethod
    def joined(cls, tables: Iterable["Postures"]) -> "Postures":
        """Return several tables as one."""
        listed = list(tables)
        return cls(*(np.concatenate([getattr(t, f.name) for t in listed]) for f in fields(cls)))

    def renamed(self, part: str) -> "Postures":
        """Return the same postures of another part."""
        return replace(self, part=np.full(len(self), part))

    def columns(self) -> dict[str, NDArray[np.generic]]:
        """Return the flat columns, as the files have them."""
        out: dict[str, NDArray[np.generic]] = {}
        for f in fields(self):
            values = getattr(self, f.name)
            if f.name in _VECTORS:
                for i, letter in enumerate("xyz"):
                    out[f"{f.name}_{letter}"] = values[:, i]
            else:
                out[f.name] = values
        return out

    @classmethod
    def of_columns(cls, columns: dict[str, NDArray[np.generic]]) -> "Postures":
        """Return the table of flat columns; a column that is missing is a ValueError."""
        try:
            return cls(
                *(
                    np.column_stack([np.asarray(columns[f"{f.name}_{x}"], float) for x in "xyz"])
                    if f.name in _VECTORS
                    else np.asarray(columns[f.name], str if f.name in _TEXTS else float)
                    for f in fields(cls)
                )
            )
        except KeyError as error:
            raise ValueError(f"the table of postures has no column {error.args[0]}") from None

    def rounded(self) -> "Postures":
        """Return the table as the files keep it."""

        def short(name: str, values: NDArray[np.generic]) -> NDArray[np.generic]:
            if name in _TEXTS:
                return values
            return np.round(values.astype(float), _PLACES_UNIT if name in ("normal", "axis") else _PLACES_MM) + 0.0

        return Postures(*(short(f.name, getattr(self, f.name)) for f in fields(self)))

    def write_csv(self, path: Path, *, answers: bool = True) -> None:
        """Write a CSV file with a column `id`, the row from 0; without `answers`, what is asked alone."""
        import pyarrow as pa
        import pyarrow.csv

        columns = self.rounded().columns()
        kept = [name for name in columns if answers or name not in KNOWN]
        pyarrow.csv.write_csv(pa.table({"id": pa.array(np.arange(len(self))), **{n: pa.array(columns[n].tolist()) for n in kept}}), path)

    def write(self, path: Path) -> None:
        """Write a CSV or a Parquet file, by the suffix."""
        import pyarrow as pa
        import pyarrow.csv
        import pyarrow.parquet

        columns = self.rounded().columns()
        words = {n: pa.array(v.tolist()).dictionary_encode() if path.suffix == ".parquet" else pa.array(v.tolist()) for n, v in columns.items() if n in _TEXTS}
        table = pa.table({n: words[n] if n in words else pa.array(v) for n, v in columns.items()})
        if path.suffix == ".parquet":
            pyarrow.parquet.write_table(table, path, compression="zstd")
        elif path.suffix == ".csv":
            pyarrow.csv.write_csv(table, path)
        else:
            raise ValueError(f"{path.name}: a table of postures is a .csv or a .parquet")

    @classmethod
    def read(cls, path: Path) -> "Postures":
        """Read a CSV or a Parquet file."""
        import pyarrow.csv
        import pyarrow.parquet

        if path.suffix == ".csv":
            keep = pyarrow.csv.ConvertOptions(strings_can_be_null=False, column_types=dict.fromkeys(_TEXTS, "string"))
            table = pyarrow.csv.read_csv(path, convert_options=keep)
        else:
            table = pyarrow.parquet.read_table(path)
        return cls.of_columns({n: np.array(table[n].to_pylist()) for n in table.column_names})
