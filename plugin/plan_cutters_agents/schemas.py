"""The schemas of the tools as an agent reads them, before its first question: short, for every word costs.

Limits of lengths and defaults of None are left out: a call that breaks one is refused in a line. What a question shares with
that of `plan_part` is described there alone. Of an answer the fields and their types are stated, but not what lists and objects
hold: their names say it in the answer itself.
"""

from typing import Any

from pydantic import BaseModel

#: What a program needs to make a call; the rest is checked when it comes.
_FIELDS = (
    "type",
    "enum",
    "const",
    "items",
    "prefixItems",
    "minimum",
    "exclusiveMinimum",
    "maximum",
    "pattern",
    "default",
    "description",
)
#: A longer pattern says less than the description.
_PATTERN = 40
#: The same of a field that is described elsewhere.
_SHARED = ("type", "items")


def question_schema(model: type[BaseModel], known: type[BaseModel] | None = None) -> dict[str, Any]:
    """The schema of a question; fields that `known` describes in the same words have no description."""
    schema = model.model_json_schema()
    described = {} if known is None or known is model else known.model_json_schema()["properties"]
    fields = {}
    for name, field in schema["properties"].items():
        short = _short(field, schema.get("$defs", {}))
        known_words = described.get(name, {}).get("description")
        fields[name] = (
            {key: short[key] for key in _SHARED if key in short} if known_words == field.get("description", "") else short
        )
    required = {"required": schema["required"]} if "required" in schema else {}
    return {"type": "object", "properties": fields, **required, "additionalProperties": False}


def answer_schema(model: type[BaseModel]) -> dict[str, Any]:
    """The schema of an answer: its fields and their types."""
    schema = model.model_json_schema(mode="serialization")
    fields = {}
    for name, field in schema["properties"].items():
        short = _short(field, schema.get("$defs", {}), nullable=True)
        fields[name] = {key: value for key, value in short.items() if key in ("type", "const", "enum")}
    # An answer has all its fields; to list them again would say nothing new.
    return {"type": "object", "properties": fields}


def _short(field: dict[str, Any], definitions: dict[str, Any], *, nullable: bool = False) -> dict[str, Any]:
    """A field without what need not be read; `nullable`: that it may be null is said."""
    field = _named(field, definitions)
    short = {key: field[key] for key in _FIELDS if key in field and field[key] not in (None, [], "")}
    if len(short.get("pattern", "")) > _PATTERN:
        del short["pattern"]
    if choices := field.get("anyOf"):
        made = [_short(each, definitions) for each in choices]
        types = [each["type"] for each in made if "type" in each]
        merged = next((each for each in made if each.get("type") != "null"), {})
        short = {**merged, **short}
        if nullable and len(types) > 1:
            short["type"] = types
    if "prefixItems" in short:
        # Points and ranges: so many numbers.
        items = short.pop("prefixItems")
        short |= {"items": {"type": "number"}, "minItems": len(items), "maxItems": len(items)}
    if isinstance(short.get("items"), dict):
        short["items"] = {
            key: value for key, value in _short(short["items"], definitions).items() if key not in ("description", "pattern")
        }
    return short


def _named(field: dict[str, Any], definitions: dict[str, Any]) -> dict[str, Any]:
    """The field with what it refers to in place of the reference."""
    reference = field.get("$ref", "")
    if not reference:
        return field
    there = definitions[reference.rpartition("/")[2]]
    return {key: value for key, value in there.items() if key in ("type", "enum", "const")} | {
        key: value for key, value in field.items() if key != "$ref"
    }
