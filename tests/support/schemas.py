"""Outputs of commands against the schemas in the package."""

import functools
import json

import jsonschema

from tests.support.places import ROOT


@functools.cache
def _schema(name):
    return jsonschema.Draft202012Validator(json.loads((ROOT / f"plugin/plan_cutters/{name}.schema.json").read_text()))


def valid(name, output):
    """An output, once it is known to be as the schema of that name says, with its format and version."""
    _schema(name).validate(output)
    assert output["format"] == f"plan-cutters-{name}"
    assert output["format_version"] == 1
    return output
