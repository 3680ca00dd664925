"""Agents read short answers: numbers in four significant digits, lists up to a length, schemas without what need not be read.

Angles and axes that an agent hands back, and tilts that are free, stay as they are: rounded, they might not be safe.
"""

import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from pydantic import BaseModel

_DIGITS = 4
#: Of places, behind the point, mm.
_PLACE = 4
#: Fields that stay as they are, also below.
_EXACT = frozenset({"axis", "angles", "free", "tilt_deg"})
#: Fields that stay as they are where they are lists: as numbers they are shares.
_RANGES = frozenset({"undecided", "forbidden"})
_PLACES = frozenset({"point", "obstacle_point", "place_mm", "normal", "direction_max", "under_flat_mm"})
#: What is never told larger than it is.
_DOWN = frozenset({"clearance_mm"})
#: Lists that are cut; the field `more_NAME` behind each says how many entries are left out.
LISTS = ("cutters", "differ", "faces", "in_the_way", "leaves", "left", "machines", "missing", "not_judged", "notes", "rotations",
         "steps", "tools", "unreachable", "unused", "witnesses", "would_help")  # fmt: skip
#: What a program needs to make a call; the rest is checked when it comes.
_FIELDS = ("type", "enum", "const", "items", "prefixItems", "minimum", "exclusiveMinimum", "maximum", "pattern", "default",
           "description")  # fmt: skip
#: A longer pattern says less than the description.
_PATTERN = 40


def short(value: Any, lengths: Mapping[str, int] = MappingProxyType({}), name: str = "") -> Any:
    """The value with short numbers, and with the first entries of the lists that have one of `lengths`, by their names.

    A share below 1 stays below 1, and one above 0 above 0.

    Examples
    --------
    >>> short({"reached": 0.99999, "lost": 1e-9, "area_mm2": 12345.678, "depth_mm": 0.7808438})
    {'reached': 0.9999, 'lost': 1e-09, 'area_mm2': 12350.0, 'depth_mm': 0.7808}
    >>> short({"clearance_mm": 0.19999, "angles": {"A": 63.43494882}, "point": [1.00000049, 0.0, -2.5]})
    {'clearance_mm': 0.1999, 'angles': {'A': 63.43494882}, 'point': [1.0, 0.0, -2.5]}
    >>> short({"faces": ["F3", "F1", "F2"], "axes": ["A", "C"]}, {"faces": 1})
    {'faces': ['F3'], 'more_faces': 2, 'axes': ['A', 'C']}
    """
    if name in _EXACT:
        return value
    if isinstance(value, dict):
        if name in _RANGES and any(isinstance(each, list) for each in value.values()):
            return value
        made = {}
        for key, each in value.items():
            cut = lengths.get(key) if isinstance(each, list) else None
            made[key] = short(each if cut is None else each[:cut], lengths, key)
            if cut is not None:
                made[f"more_{key}"] = max(0, len(each) - cut)
        return made
    if isinstance(value, list):
        return value if name in _RANGES else [short(each, lengths, name) for each in value]
    return _number(value, name) if isinstance(value, float) and math.isfinite(value) else value


def _number(value: float, name: str) -> float:
    if name in _PLACES:
        return round(value, _PLACE) + 0.0
    made = float(f"{value:.{_DIGITS}g}")
    if abs(made) > abs(value) and (name in _DOWN or abs(value) < 1.0 <= abs(made)):
        step = 10.0 ** (math.floor(math.log10(abs(value))) + 1 - _DIGITS)
        made = float(f"{math.copysign(math.floor(abs(value) / step) * step, value):.{_DIGITS}g}")
    return made


def question_schema(model: type[BaseModel], known: type[BaseModel]) -> dict[str, Any]:
    """The schema of a question; fields that `known`, another one, describes in the same words have no description."""
    schema = model.model_json_schema()
    described = {} if known is model else known.model_json_schema()["properties"]
    fields = {}
    for name, field in schema["properties"].items():
        fields[name] = _field(field)
        if described.get(name, {}).get("description") == field.get("description", ""):
            fields[name] = {key: fields[name][key] for key in ("type", "items") if key in fields[name]}
    required = {"required": schema["required"]} if "required" in schema else {}
    return {"type": "object", "properties": fields, **required, "additionalProperties": False}


def answer_schema(model: type[BaseModel]) -> dict[str, Any]:
    """The schema of an answer: its fields and their types, but not what lists and objects hold: their names say it."""
    fields: dict[str, Any] = {}
    for name, field in model.model_json_schema(mode="serialization")["properties"].items():
        either = {"type": [each["type"] for each in field["anyOf"]]} if "anyOf" in field else field
        fields[name] = {key: either[key] for key in ("type", "enum", "const") if key in either}
        if name in LISTS:
            fields[f"more_{name}"] = {"type": "integer"}
    # An answer has all its fields; to list them again would say nothing new.
    return {"type": "object", "properties": fields}


def _field(field: dict[str, Any]) -> dict[str, Any]:
    """A field without what need not be read, as that it may be null."""
    needed = {key: field[key] for key in _FIELDS if key in field and field[key] not in (None, [], "")}
    if len(needed.get("pattern", "")) > _PATTERN:
        del needed["pattern"]
    if choices := field.get("anyOf"):
        needed = {**_field(next(each for each in choices if each.get("type") != "null")), **needed}
    if "prefixItems" in needed:
        # Points and ranges: so many numbers.
        items = needed.pop("prefixItems")
        needed |= {"items": {"type": "number"}, "minItems": len(items), "maxItems": len(items)}
    if isinstance(needed.get("items"), dict):
        items = _field(needed["items"])
        needed["items"] = {key: value for key, value in items.items() if key not in ("description", "pattern")}
    return needed
