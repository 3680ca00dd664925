"""The plan stands as soon as the verdicts do: who ends the run later keeps a whole plan that says what is missing."""

import itertools
import json
import os
import signal
import time
from dataclasses import replace

import pytest

from plan_cutters import plan
from plan_cutters.agents.plan_answers import planned
from plan_cutters.answers import ask
from plan_cutters.command import retry
from plan_cutters.comparison.plans import compare
from plan_cutters.document.clock import Clock
from plan_cutters.judged_part import JudgedPart
from plan_cutters.operations import planning
from plan_cutters.options import Options
from plan_cutters.pipeline import run as run_stages
from plan_cutters.plan_file.load import plan_of
from plan_cutters.report.to_json import dumps
from plan_cutters.workers.assignment import TIMED_OUT
from plan_cutters.workers.errors import OutOfTime
from tests.support.commands import leftovers
from tests.support.forked import run
from tests.support.places import SAMPLES

PART = SAMPLES / "v_groove.step"
WORDS = (PART, "--cutter", "R6L80", "--grid", "3", "--area-budget", "50", "--answers", "mend", "--operations", "fewest")
BETWEEN, ANSWERS, OPERATIONS = "the proof between the samples", "--answers mend", "--operations fewest"
#: Where the work of a stage begins, and what a plan is without that was written before it.
STAGES = {
    "area": ((JudgedPart, "between"), (BETWEEN, ANSWERS, OPERATIONS)),
    "answers": ((ask, "nearest"), (ANSWERS, OPERATIONS)),
    "operations": ((planning, "search_fewest"), (OPERATIONS,)),
}


@pytest.fixture(scope="module", autouse=True)
def _warm():
    """What copies of this process need is planned once here, before any stage is replaced."""
    run("--version")


def interrupted(*_, **__):
    """Let an interrupt come to the command, as from a terminal, while its worker listens."""
    os.kill(os.getppid(), signal.SIGINT)
    time.sleep(60)


def interrupted_in_c(*_, **__):
    """The same while one call does not come back, as of the CAD kernel: the worker is killed."""
    os.kill(os.getppid(), signal.SIGINT)
    any(itertools.repeat(False))


def out_of_memory(*_, **__):
    raise MemoryError


def unfinished(folder, *absent):
    """The plan of a folder, alone there: it is one, and says once, in front, what it is without."""
    assert leftovers(folder) == ["plan.json"]
    whole = plan_of((folder / "plan.json").read_bytes(), "plan.json")
    (text,) = [text for code, text in zip(whole.note_codes, whole.notes, strict=True) if code == "run_unfinished"]
    every = (BETWEEN, ANSWERS, OPERATIONS)
    assert [each for each in every if each in text] == [each for each in every if each in absent]
    assert whole.process.doubts[0] == text
    assert " ".join(line.strip() for line in whole.text.lines[:3]).startswith(text)
    assert (BETWEEN in absent) == (whole.cutters[0].area is None)
    assert whole.operations is None
    assert whole.files == {}
    return whole


@pytest.mark.parametrize("stage", STAGES)
@pytest.mark.parametrize("ended", [interrupted, interrupted_in_c], ids=["asked", "killed"])
def test_an_interrupt_leaves_the_plan_of_the_verdicts(tmp_path, monkeypatch, stage, ended):
    where, absent = STAGES[stage]
    monkeypatch.setattr(*where, ended)
    done = run(*WORDS, "-o", "out", cwd=tmp_path)
    assert (done.returncode, done.stdout) == (130, "")
    last = done.stderr.splitlines()[-1]
    assert last.startswith("plan-cutters: interrupted; the plan of the verdicts is in ")
    assert "out/plan.json. " in last
    assert all(each in last for each in absent)
    assert leftovers(tmp_path) == ["out"]
    whole = unfinished(tmp_path / "out", *absent)
    assert set(whole.not_written.values()) == {"interrupted"}


@pytest.mark.slow
@pytest.mark.parametrize("stage", ["answers", "operations"])
def test_a_time_limit_leaves_it(tmp_path, monkeypatch, stage):
    where, absent = STAGES[stage]
    monkeypatch.setattr(*where, lambda *_, **__: time.sleep(60))
    done = run(*WORDS, "-o", "out", "--timeout", "8", cwd=tmp_path)
    assert done.returncode == TIMED_OUT
    last = done.stderr.splitlines()[-1]
    assert "v_groove.step: not done within 8 s: " in last
    assert "out/plan.json. " in last
    assert all(each in last for each in absent)
    assert leftovers(tmp_path) == ["out"]
    assert set(unfinished(tmp_path / "out", *absent).not_written.values()) == {"not done within 8 s"}


def test_what_a_part_that_is_left_says_of_its_plan(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(*STAGES["operations"][0], interrupted)
    run(*WORDS, "-o", "out", cwd=tmp_path)

    def late(*_, **__):
        raise OutOfTime(0, 0, tmp_path / "out")

    monkeypatch.setattr(retry, "supervise", late)
    assert retry.supervised((), parts=("a.step",), read_timeout=9.0, memory=1, timeout=9.0, since=3.0) == TIMED_OUT
    said = capsys.readouterr().err
    assert f"the plan of the verdicts is in {tmp_path / 'out' / 'plan.json'}. The run was not done: " in said


def test_a_stage_that_fails_leaves_it_and_the_error_is_the_last_line(tmp_path, monkeypatch):
    monkeypatch.setattr(*STAGES["operations"][0], out_of_memory)
    done = run(*WORDS, "-o", "out", cwd=tmp_path)
    assert (done.returncode, done.stdout) == (3, "")
    before, last = done.stderr.splitlines()[-2:]
    assert "the plan of the verdicts is in out/plan.json. " in before
    assert "out of memory" in last
    unfinished(tmp_path / "out", OPERATIONS)


def test_files_of_an_earlier_run_do_not_stand_beside_it(tmp_path, monkeypatch):
    plan(PART, cutters="R2L30", grid=3, area_budget=0).write(tmp_path / "out", ("json", "npz"))
    monkeypatch.setattr(*STAGES["answers"][0], interrupted)
    run(*WORDS, "-o", "out", cwd=tmp_path)
    assert unfinished(tmp_path / "out", ANSWERS, OPERATIONS).cutters[0].id == "R6L80"


def test_without_a_plan_among_the_formats_nothing_is_left(tmp_path, monkeypatch):
    monkeypatch.setattr(*STAGES["answers"][0], interrupted)
    done = run(*WORDS, "-o", "out", "--formats", "npz", cwd=tmp_path)
    assert done.returncode == 130
    assert done.stderr.splitlines()[-1] == "plan-cutters: interrupted; no file is half-written"
    assert leftovers(tmp_path) == []


def scrubbed(document):
    """A plan as text, without what every run has of its own."""
    cutters = [each.model_copy(update={"seconds": 0.0}) for each in document.cutters]
    run = document.run.model_copy(update={"seconds": {}, "total": 0.0, "time": ""})
    return dumps(document.model_copy(update={"run": run, "cutters": cutters}))


@pytest.fixture(scope="module")
def stages():
    """A plan with all later stages, those that stood before it, and the same without anyone who looks at those."""
    options = Options(cutters=("R6L80",), grid=3, area_budget=50, answers="mend", operations="fewest", posture_maps=True)
    before = []
    return (
        run_stages(PART, options, Clock(), stands=lambda result: before.append(result.plan)),
        before,
        run_stages(PART, options, Clock()),
    )


def test_each_plan_that_stands_is_without_less(stages):
    last, before, alone = stages
    told = [next(text for code, text in zip(p.note_codes, p.notes, strict=True) if code == "run_unfinished") for p in before]
    maps = "--posture-maps"
    every = (BETWEEN, ANSWERS, OPERATIONS, maps)
    assert [[each for each in every if each in text] for text in told] == [list(every[k:]) for k in range(4)]
    assert [p.operations is None for p in before] == [True, True, True, False]
    # What stands is not changed by what follows.
    assert all(p.faces == last.plan.faces and p.selected == last.plan.selected for p in before)
    assert "run_unfinished" not in last.plan.note_codes
    assert scrubbed(last.plan) == scrubbed(alone.plan)


def test_a_plan_that_nothing_follows_is_written_once():
    before = []
    run_stages(
        PART, Options(cutters=("R6L80",), grid=3, area_budget=0), Clock(), stands=lambda result: before.append(result.plan)
    )
    assert before == []


def test_readers_take_a_plan_that_is_unfinished(stages, tmp_path):
    last, before, _ = stages
    for number, each in enumerate(before):
        assert compare(each, each).comparable
        difference = compare(each, last.plan)
        assert difference.comparable
        assert (difference.lost, difference.won) == (False, False)
        assert any(note.code == "run_unfinished" for note in planned(each, 1, 50, {}).notes)
        written = replace(last, plan=each, maps=None).write(tmp_path / str(number), ("json", "html", "npz"))
        assert "html" in written.files
    assert json.loads((tmp_path / "0" / "plan.json").read_text())["process"]["doubts"]
