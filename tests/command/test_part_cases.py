"""`--junit` and `--sarif`: each part that was requested has cases, whatever became of it."""

import json
import math

import pytest

from plan_cutters.cases.files import CaseFiles
from plan_cutters.command import partial_plan
from plan_cutters.command.progress import Display, PartCases
from plan_cutters_base.workers.child import TIMED_OUT
from plan_cutters_base.workers.supervise import OutOfTime
from tests.support.commands import assert_one_line, leftovers
from tests.support.forked import run
from tests.support.junit import cases, outcomes
from tests.support.places import SAMPLES
from tests.support.sarif import findings

QUICK = ("--cutter", "R6L80", "--grid", "3", "--area-budget", "0", "--quiet")


def test_planned_unreadable_and_missing_parts_are_in_one_file(tmp_path):
    (tmp_path / "bad.step").write_text("no part")
    (tmp_path / "good.step").write_bytes((SAMPLES / "v_groove.step").read_bytes())
    done = run("good.step", "bad.step", "none.step", *QUICK, "--machine", "tilt:20", "--formats", "json", "-o", "out", "--junit",
               "ci/junit.xml", "--sarif", "ci/plan.sarif", cwd=tmp_path)  # fmt: skip
    assert done.returncode == 3
    found = cases((tmp_path / "ci/junit.xml").read_bytes())
    plan = json.loads((tmp_path / "out/good-plan/plan.json").read_text())
    faces = [each["id"] for each in plan["faces"] if each["target"]]
    good = [each for each in found if each.part == "good.step"]
    assert [each.name.split()[0] for each in good] == ["process", *faces]
    for each in good[1:]:
        assert (each.outcome == "passed") == (plan["cutters"][0]["faces"][each.name.split()[0]]["inaccessible"] == 0)
    assert good[0].outcome == "failure"
    assert good[0].message == plan["text"]["headline"]
    assert {each.part: (each.outcome, each.kind) for each in found[len(good) :]} == {
        "bad.step": ("error", "not_planned"), "none.step": ("error", "not_planned"),
    }  # fmt: skip
    assert "no such file" in found[-1].message
    failing = [each for each in found if each.outcome in ("failure", "error")]
    same = findings((tmp_path / "ci/plan.sarif").read_bytes())
    assert [(each.part, each.rule) for each in same] == [(each.part, each.kind) for each in failing]
    assert leftovers(tmp_path / "ci") == ["junit.xml", "plan.sarif"]


def test_no_file_of_a_plan_is_needed(tmp_path):
    done = run(SAMPLES / "v_groove.step", *QUICK, "--json", "-", "--junit", "junit.xml", cwd=tmp_path)
    assert (done.returncode, leftovers(tmp_path)) == (0, ["junit.xml"])
    assert outcomes(cases((tmp_path / "junit.xml").read_bytes())) == {"passed"}
    assert json.loads(done.stdout)["selected"]


def test_where_no_part_can_be_read_the_file_says_so(tmp_path):
    assert_one_line(run("none.step", "--junit", "junit.xml", cwd=tmp_path), 3, "no such file")
    (found,) = cases((tmp_path / "junit.xml").read_bytes())
    assert (found.part, found.outcome) == ("none.step", "error")


@pytest.mark.parametrize("words", [("--junit", "-"), ("--sarif", "."), ("--sarif", "a.sarif", "--check-operations", "plan.json")])
def test_what_is_no_file_or_plans_nothing_is_refused(words, tmp_path):
    assert_one_line(run(SAMPLES / "v_groove.step", *words, cwd=tmp_path), 2, words[0])
    assert leftovers(tmp_path) == []


def test_a_part_that_takes_too_long_is_an_error(monkeypatch, tmp_path):
    """The parts before and behind it keep their cases; one that was never begun is an error, too."""
    path = tmp_path / "junit.xml"
    display = Display(True, 1, 0.0)
    display.part_cases = PartCases(CaseFiles(str(path)), ("a", "b", "c"))

    def children(words, *, done, **_):
        display.begins("a" if done == 0 else "c")
        display.cases(json.dumps([["a" if done == 0 else "c", "process", "passed", "", "", "", 1.0]]))
        if done == 0:
            display.begins("b")
            raise OutOfTime(1, 0, None)
        return 0

    monkeypatch.setattr(partial_plan, "supervise", children)
    code = partial_plan.supervised(
        (), parts=("a", "b", "c"), read_timeout=math.inf, memory=1, timeout=9.0, since=0.0, display=display
    )
    assert code == TIMED_OUT
    display.part_cases.write()
    assert [(each.part, each.outcome) for each in cases(path.read_bytes())] == [("a", "passed"), ("b", "error"), ("c", "passed")]
    assert "not done within 9 s" in path.read_text()
    PartCases(CaseFiles(str(path)), ("a",)).write("interrupted")
    assert cases(path.read_bytes())[0].message == "interrupted"
