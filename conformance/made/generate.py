"""Write the made half of the suite: STEP files, `made.json`, `made.parquet`."""

import json
import re
from collections.abc import Callable, Collection
from pathlib import Path
from typing import Any

import numpy as np

from conformance.exact.slow import read as shape_of
from conformance.made.check import write_step
from conformance.made.confirm import Around, confirmed
from conformance.made.part import MadePart, postures
from conformance.made.parts import PARTS
from conformance.posture import Postures
from conformance.suite import DATA, document, read, setup_entry, sha256, tool_entry

#: Postures of each part.
EACH = 150


def generate(folder: Path = DATA, each: int = EACH, tell: Callable[[str], None] = lambda line: None, only: Collection[str] = ()) -> None:
    """Write all made parts with their truths to a folder; of `only` some the twins, too, and what the folder has of the others stays."""
    (folder / "made").mkdir(parents=True, exist_ok=True)
    before = read("made", folder).postures if only else None
    entries, made = {}, {}
    if only:
        entries = {entry["name"]: entry for entry in json.loads((folder / "made.json").read_text(encoding="utf-8"))["parts"]}
    for part in PARTS.values():
        if before is not None and not {part.name, part.twin_of} & set(only):
            if part.name in entries:
                made[part.name] = before[np.flatnonzero(before.part == part.name)]
            continue
        path = folder / "made" / f"{part.name}.step"
        write_step(part, path)
        _without_date(path)
        # A twin is asked the same postures as its analytic form, so that the two can be compared row by row.
        if part.twin_of:
            table, wrong = made[part.twin_of].renamed(part.name), 0
        else:
            table, wrong = confirmed(Around(part, shape_of(path)), postures(part, each))
        made[part.name], entries[part.name] = table, _entry(part, path)
        tell(f"{part.name}: {len(table)} postures, {(table.verdict == 'safe').sum()} safe; bounds in place of the form: {wrong}")
    Postures.joined(made.values()).write(folder / "made.parquet")
    (folder / "made.json").write_text(document("made", [entries[name] for name in made]), encoding="utf-8")


def _entry(part: MadePart, path: Path) -> dict[str, Any]:
    """Return a part as the file has it."""
    answers = [
        {"kind": a.kind, "value": a.value, "formula": a.formula, **({"tool": a.tool} if a.tool else {}), "setup": a.setup, **a.given} for a in part.answers
    ]
    return {
        "name": part.name,
        "family": part.family,
        "title": part.title,
        "file": path.name,
        "sha256": sha256(path),
        "licence": "CC0-1.0",
        **({"twin_of": part.twin_of} if part.twin_of else {}),
        "derivation": " ".join(part.derivation.split()),
        "tools": {t.name: tool_entry(t) for t in part.tools},
        "setups": {s.name: setup_entry(s.axis, s.limit_deg, s.boxes, s.table) for s in part.setups},
        "answers": answers,
    }


def _without_date(path: Path) -> None:
    """Take the date and the number of the export out of a STEP file: the same part gives the same bytes."""
    text = re.sub(r"'\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d'", "'2026-01-01T00:00:00'", path.read_text(encoding="utf-8"))
    path.write_text(re.sub(r"'(Open CASCADE STEP translator \d+\.\d+)[ .\d]*'", r"'\1'", text), encoding="utf-8")
