"""What programs rely on: schemas of all outputs, and lists of codes, are what the models and the code say."""

import json
import re
from typing import get_args

import pytest

from plan_cutters.domain.answers import MEANS
from plan_cutters.domain.verdicts import REASONS as CODES
from plan_cutters.domain.verdicts import WORDS
from plan_cutters.plan_file.reasons import REASONS
from plan_cutters.plan_file.words.notes import NoteCode
from plan_cutters.report.to_json import schema
from tests.support.forked import run
from tests.support.places import ROOT, SAMPLES
from tests.support.schemas import valid

PAGE = (ROOT / "docs/json.md").read_text(encoding="utf-8")


def listed(title):
    """The rows of the table under a heading: code and meaning."""
    return dict(re.findall(r"^\| `(\w+)` \| (.*) \|$", PAGE.partition(f"\n## {title}\n")[2].partition("\n## ")[0], re.MULTILINE))


def test_the_schema_of_a_plan_is_that_of_its_model_and_all_are_told():
    package = ROOT / "plugin/plan_cutters"
    made = json.dumps(schema(), indent=2) + "\n"
    assert (package / "plan.schema.json").read_text() == made, "run: python -m plan_cutters.report.to_json"
    schemas = sorted(package.glob("*.schema.json"))
    assert len(schemas) == 5
    assert all(f"`{each.name}`" in PAGE for each in schemas)


def test_codes_are_listed_as_the_code_has_them():
    assert listed("Codes of reasons") == {each.code: each.sentence for each in REASONS.values()}
    assert set(listed("Codes of reasons")) == set(CODES)
    assert set(listed("Codes of notes")) == set(get_args(NoteCode))
    assert set(listed("Codes of verdicts")) == set(WORDS.values())
    assert list(listed("Codes of changes")) == list(MEANS)


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("tools", ["tools", SAMPLES / "shop.toml", "--json"]),
        ("tools", ["tools", "--cutter", "D12L80", "--json"]),
        ("holders", ["tools", "--list-holders", "--json"]),
        ("machines", ["machines", "--json"]),
        ("machines", ["machines", "trunnion-ac", "tilt:30", "unlimited", "--json"]),
        ("machines", ["machines", "trunnion-ac", "--angles", "0.3,0,1", "--axis", "A=30", "--json"]),
    ],
)
def test_an_output_is_as_its_schema_says(tmp_path, name, words):
    done = run(*words[1:], cwd=tmp_path, command=f"plan-cutters-{words[0]}")
    assert (done.returncode, done.stderr) == (0, "")
    valid(name, json.loads(done.stdout))
