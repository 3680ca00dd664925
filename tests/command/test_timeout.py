"""The time for the whole of a part: one line and an exit code of its own, nothing half-written, and the next part is planned."""

import json
import math

import pytest

from plan_cutters import plan
from plan_cutters.command import partial_plan
from plan_cutters.report.to_json import PENDING
from plan_cutters_base.workers.child import TIMED_OUT
from plan_cutters_base.workers.supervise import OutOfTime
from tests.support.commands import assert_one_line, leftovers
from tests.support.forked import run
from tests.support.places import SAMPLES

PARTS = ("a.step", "b.step", "c.step")


def test_a_part_that_is_not_done_leaves_a_line_and_nothing_else(tmp_path):
    # The first part's time begins with the command: nothing is so quick. A first look stands after less than 1 s.
    done = run(SAMPLES / "peaks_and_valleys.step", "--grid", "401", "--timeout", "0.1", cwd=tmp_path)
    said = assert_one_line(done, TIMED_OUT, "peaks_and_valleys.step: not done within 0.1 s", "--timeout")
    assert done.stderr.splitlines()[-1] == said
    assert leftovers(tmp_path) == []


def test_time_that_is_enough_changes_nothing(tmp_path):
    quick = ("--cutter", "R6L80", "--grid", "3", "--area-budget", "0", "--formats", "json", "--quiet")
    done = run(SAMPLES / "v_groove.step", *quick, "--timeout", "600", "-o", "out", cwd=tmp_path)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


class Children:
    """In place of children: what becomes of each, and what it was told of parts that are done and of its time."""

    def __init__(self, monkeypatch, *ends):
        self.ends, self.told = list(ends), []
        monkeypatch.setattr(partial_plan, "supervise", self)

    def __call__(self, words, *, done, timeout, since, **_):
        self.told.append((done, since))
        end = self.ends.pop(0)
        if isinstance(end, Exception):
            raise end
        return end


def planned(timeout=9.0):
    return partial_plan.supervised((), parts=PARTS, read_timeout=math.inf, memory=1, timeout=timeout, since=3.0)


def test_the_next_part_is_planned_with_time_of_its_own(monkeypatch, capsys):
    children = Children(monkeypatch, OutOfTime(1, 4, None), 1)
    assert planned() == TIMED_OUT
    assert children.told == [(0, 3.0), (2, None)]
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("plan-cutters: b.step: not done within 9 s: ")


def test_the_last_part_ends_it(monkeypatch, capsys):
    children = Children(monkeypatch, OutOfTime(2, 0, None))
    assert planned() == TIMED_OUT
    assert (children.ends, len(capsys.readouterr().err.splitlines())) == ([], 1)


@pytest.mark.parametrize("code", [0, 4])
def test_parts_that_are_done_keep_their_code_where_only_the_end_is_slow(monkeypatch, capsys, code):
    Children(monkeypatch, OutOfTime(3, code, None))
    assert planned() == code
    assert capsys.readouterr().err == ""


def test_a_plan_that_is_there_already_stays_and_says_what_is_missing(monkeypatch, capsys, tmp_path):
    out = tmp_path / "out"
    plan(SAMPLES / "v_groove.step", cutters=["R6L80"], grid=3, area_budget=0).write(out, ("json",))
    document = json.loads((out / "plan.json").read_text()) | {"not_written": {"step": PENDING}}
    (out / "plan.json").write_text(json.dumps(document))
    Children(monkeypatch, OutOfTime(2, 0, out))
    assert planned() == TIMED_OUT
    assert f"the plan is in {out}, without annotated.step; " in capsys.readouterr().err
    assert json.loads((out / "plan.json").read_text())["not_written"] == {"step": "not done within 9 s"}
