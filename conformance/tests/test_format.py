"""The format: files are read as they were written, and the schemas refuse what is wrong."""

import copy
import json
import shutil
import subprocess
from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest

from conformance.posture import KNOWN, Postures
from conformance.schema.check import parts_errors, postures_errors, schema, suite_errors
from conformance.suite import Suite, tool_entry, tool_of
from conformance.tool import Tool


@pytest.mark.parametrize("suffix", [".csv", ".parquet"])
def test_a_table_is_read_as_it_was_written(small: Suite, tmp_path: Path, suffix: str):
    path = tmp_path / f"postures{suffix}"
    small.postures.write(path)
    again = Postures.read(path)
    for field in fields(Postures):
        np.testing.assert_array_equal(getattr(again, field.name), getattr(small.postures.rounded(), field.name), err_msg=field.name)


def test_the_exported_table_has_row_numbers_and_hides_answers_where_it_is_asked_to(small: Suite, tmp_path: Path):
    small.postures.write_csv(tmp_path / "all.csv")
    small.postures.write_csv(tmp_path / "blind.csv", answers=False)
    heads = [(tmp_path / name).read_text().splitlines()[0].replace('"', "").split(",") for name in ("all.csv", "blind.csv")]
    assert heads[0] == ["id", *(entry["name"] for entry in schema("postures")["fields"])]
    assert set(heads[0]) - set(heads[1]) == set(KNOWN)
    again = Postures.read(tmp_path / "all.csv")
    np.testing.assert_array_equal(again.low, small.postures.low)


def test_the_small_suite_is_of_the_format(small: Suite, small_folder: Path):
    assert parts_errors(json.loads((small_folder / "made.json").read_text())) == []
    assert suite_errors(small) == []


def _without(key):
    return lambda document: document["parts"][0].pop(key)


@pytest.mark.parametrize("spoil", [
    _without("tools"), _without("sha256"), lambda d: d.update(unit="in"), lambda d: d["parts"][0].update(colour="red"),
    lambda d: d["parts"][0]["setups"]["free"].update(axis=[0, 0]),
    lambda d: d["parts"][0]["setups"]["free"].update(boxes=[[[0, 0, 0]]]),
    lambda d: d["parts"][0]["tools"].update(bad={"cutter": [[0.0, -1.0], [5.0, 1.0]]}),
    lambda d: d["parts"][0].update(name="a|b"),
])  # fmt: skip
def test_the_schema_is_strict(small_folder: Path, spoil):
    document = copy.deepcopy(json.loads((small_folder / "made.json").read_text()))
    spoil(document)
    assert len(parts_errors(document)) == 1


def test_setups_with_limit_boxes_and_table_are_of_the_format(small_folder: Path):
    document = json.loads((small_folder / "made.json").read_text())
    document["parts"][0]["setups"]["held"] = {"axis": [0, 0, 1], "limit_deg": 60, "boxes": [[[0, 0, 0], [1, 2, 3]]], "table": -15.0}
    assert parts_errors(document) == []


@pytest.mark.parametrize(("column", "value", "word"), [
    ("verdict", "maybe", "verdict"), ("proof", "guess", "proof"), ("low", np.nan, "low"), ("low", 99.0, "low"),
    ("axis", 2.0, "axis"),
    ("reason", "luck", "reason"),
])  # fmt: skip
def test_what_a_column_cannot_hold_is_named(small: Suite, column: str, value: object, word: str):
    values = getattr(small.postures, column).astype("U9" if isinstance(value, str) else float)
    values[3] = value
    errors = postures_errors(replace(small.postures, **{column: values}))
    assert errors
    assert any(error.startswith(word) for error in errors)


def test_a_tip_that_is_elsewhere_and_a_part_that_is_unknown_are_named(small: Suite):
    assert "tip is 1 mm" in suite_errors(Suite(small.parts, replace(small.postures, tip=small.postures.tip + np.array([0, 0, 1.0]))))[0]
    other = small.postures.part.astype("U12")
    other[0] = "nowhere"
    assert "nowhere" in suite_errors(Suite(small.parts, replace(small.postures, part=other)))[0]


@pytest.mark.parametrize("tool", [
    Tool.flat(16.0, 90.0),
    Tool.ball(8.0, 60.0, flutes=20.0, shank=6.0, holder=((60.0, 12.0), (80.0, 15.0), (80.0, 20.0), (120.0, 20.0))),
    Tool.flat(6.0, 50.0, corner=1.0),
], ids=lambda tool: tool.name)  # fmt: skip
def test_tools_are_read_as_they_were_written(tool: Tool):
    assert tool_of(tool.name, json.loads(json.dumps(tool_entry(tool)))) == tool


def test_the_figure_is_a_picture():
    figure = Path(__file__).parents[1] / "docs" / "frames.svg"
    if shutil.which("xmllint"):
        subprocess.run(["xmllint", "--noout", str(figure)], check=True)
    text = figure.read_text(encoding="utf-8")
    for word in ("contact", "normal", "axis", "tip", "tilt", "margin"):
        assert word in text
