"""A plan can be read and put into words without the CAD kernel, the compiler, scipy or a picture, and at once."""

import json
import re
import subprocess
import sys

import pytest

from plan_cutters.errors import PlanError
from plan_cutters.plan_file import load_plan
from plan_cutters.plan_file.words.process import WIDTH
from plan_cutters.plan_file.words.text import MOST, text_of, with_text
from tests.support.plan_files import cutter, face, made, verdicts

HEAVY = ("OCP", "numba", "llvmlite", "scipy", "shapely", "matplotlib", "trimesh", "rich", "jinja2")
READER = f"""
import sys
from plan_cutters.plan_file import load_plan
plan = load_plan(sys.argv[1])
print(plan.text.headline)
assert not {{*{HEAVY}}} & {{*sys.modules}}, sorted({{*{HEAVY}}} & {{*sys.modules}})
"""


@pytest.fixture
def written(tmp_path):
    path = tmp_path / "plan.json"
    path.write_text(with_text(plan()).model_dump_json(), encoding="utf-8")
    return path


def plan(cutters=2, **more):
    entries = [cutter(f"R{k}L80", {"F1": verdicts(inaccessible=10 * (k - 1))}, radius=float(k)) for k in range(1, cutters + 1)]
    return made([face(1)], entries[::-1], **more)


def test_reading_loads_nothing_heavy(written):
    made = subprocess.run([sys.executable, "-c", READER, written], capture_output=True, text=True, check=False)
    assert made.returncode == 0, made.stderr
    assert made.stdout.startswith("Take flat end D2 x 80: it finishes all 100 mm².")


def test_a_folder_is_read_as_the_plan_in_it(written, tmp_path):
    assert load_plan(tmp_path) == load_plan(written)
    (tmp_path / "empty").mkdir()
    with pytest.raises(PlanError, match=r"empty.plan\.json: cannot be read"):
        load_plan(tmp_path / "empty")


def test_what_is_read_is_what_was_written(written):
    assert load_plan(written) == with_text(plan())


def test_the_text_is_short_however_many_cutters_there_are():
    for number in (1, 2, 12, 60):
        text = text_of(plan(number))
        assert len(text.lines) <= MOST
        assert max(map(len, text.lines)) <= WIDTH
        assert len(text.cutters) == number
    told = " ".join(text.lines)
    named, more = re.search(r"Each alone reaches: (.*) and (\d+) more\.", told).groups()
    assert named.count(" %") + int(more) == 60


def test_tones():
    assert text_of(plan(1)).tone == "good"
    lost = cutter("R6L80", {"F1": verdicts(inaccessible=5)})
    unsure = cutter("R6L80", {"F1": verdicts(undecided=5)})
    assert text_of(made([face(1)], [lost])).tone == "partly"
    most = cutter("R6L80", {"F1": verdicts(inaccessible=600)})
    assert text_of(made([face(1)], [most])).tone == "bad"
    assert text_of(made([face(1)], [unsure])).tone == "unsure"


@pytest.mark.parametrize(
    ("content", "why"),
    [
        ("", "is empty"),
        ("{", "is no JSON or is half-written"),
        ("[1]", "no plan of plan-cutters"),
        ('{"format": "plan-cutters-plan", "format_version": 9}', "has format version 9"),
        ('{"format": "plan-cutters-plan", "format_version": 1}', "text: field required"),
    ],
)
def test_what_is_no_plan_is_refused_in_one_line(tmp_path, content, why):
    path = tmp_path / "plan.json"
    path.write_text(content, encoding="utf-8")
    with pytest.raises(PlanError, match=why) as caught:
        load_plan(path)
    assert "\n" not in str(caught.value)
    assert str(path) in str(caught.value)
    with pytest.raises(PlanError, match="cannot be read"):
        load_plan(tmp_path / "none.json")


def test_a_plan_that_shows_a_cutter_that_it_has_not_is_refused(written):
    data = json.loads(written.read_text()) | {"shown": "R9L80"}
    written.write_text(json.dumps(data))
    with pytest.raises(PlanError, match="the one shown is none of them"):
        load_plan(written)
