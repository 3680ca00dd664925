"""Whether files are of the format: parts by JSON Schema, tables of postures by their columns."""

import json
from pathlib import Path
from typing import Any

import numpy as np

from conformance.posture import Postures
from conformance.suite import Suite

_FOLDER = Path(__file__).parent
#: How far a unit vector may be from length 1, and a tip (mm) from where its tool stands at the contact.
_UNIT, _TIP = 1e-9, 1e-6


def schema(name: str) -> dict[str, Any]:
    """Return the schema `parts` or `postures`."""
    return dict(json.loads((_FOLDER / f"{name}.schema.json").read_text(encoding="utf-8")))


def parts_errors(document: Any) -> list[str]:
    """Return a line for each place of a `made.json` or `real.json` that is not of the format."""
    import jsonschema

    checker = jsonschema.Draft202012Validator(schema("parts"))
    return [f"{'/'.join(map(str, error.absolute_path)) or 'document'}: {error.message[:200]}" for error in checker.iter_errors(document)]


def postures_errors(table: Postures) -> list[str]:
    """Return a line for each column of a table that holds what it cannot."""
    columns, errors = table.columns(), []
    described = {entry["name"]: entry for entry in schema("postures")["fields"]}
    if list(columns) != list(described):
        errors.append(f"columns: {', '.join(columns)}; the schema has {', '.join(described)}")
    for name, entry in described.items():
        values, rules = columns.get(name), entry.get("constraints", {})
        if values is None:
            continue
        if "enum" in rules and not np.isin(values, rules["enum"]).all():
            errors.append(f"{name}: {sorted(set(values.tolist()) - set(rules['enum']))[0]!r} is none of {rules['enum']}")
        if entry["type"] == "number" and rules.get("required") and not np.isfinite(values.astype(float)).all():
            errors.append(f"{name}: a number is missing")
        if "minimum" in rules and (np.abs(values.astype(float)) > rules["maximum"] + _UNIT).any():
            errors.append(f"{name}: beyond {rules['minimum']} and {rules['maximum']}")
    for name in ("normal", "axis"):
        if (np.abs(np.linalg.norm(getattr(table, name), axis=1) - 1.0) > _UNIT).any():
            errors.append(f"{name}: no unit vector")
    if (table.low > table.high).any():
        errors.append("low: larger than high")
    wrong = (table.verdict == "safe") != ((table.low >= 0) & ~(table.limit_deg < 0))
    if wrong[table.proof == "form"].any():
        errors.append("verdict: it does not agree with low and limit_deg")
    return errors


def suite_errors(suite: Suite) -> list[str]:
    """Return a line for each posture's name that no part has, and for each tip where its tool does not stand."""
    errors = postures_errors(suite.postures)
    known = {(p.name, t, s) for p in suite.parts.values() for t in p.tools for s in p.setups}
    t = suite.postures
    for key in sorted(set(zip(t.part.tolist(), t.tool.tolist(), t.setup.tolist(), strict=True)) - known):
        errors.append(f"no such part, tool and setup: {', '.join(key)}")
    if errors:
        return errors
    for part, tool, _, rows in suite.groups():
        tilted = rows[np.linalg.norm(t.axis[rows] - t.normal[rows], axis=1) > 1e-6]
        if len(tilted):
            off = np.linalg.norm(tool.stands(t.contact[tilted], t.normal[tilted], t.axis[tilted]) - t.tip[tilted], axis=1)
            if off.max() > _TIP:
                errors.append(f"{part.name}, {tool.name}: a tip is {off.max():.2g} mm from where the tool stands")
    return errors
