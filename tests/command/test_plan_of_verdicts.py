"""The plan stands as soon as the verdicts do: who ends the run later keeps a whole plan that says what is missing."""

import itertools
import json
import os
import signal
import time
from dataclasses import replace

import pytest

from plan_cutters import pipeline, plan, proposal
from plan_cutters.answers import ask
from plan_cutters.command import partial_plan
from plan_cutters.document.clock import Clock
from plan_cutters.interim import Interim
from plan_cutters.judged_part import JudgedPart
from plan_cutters.judging.reasons import Reasons
from plan_cutters.operations import planning
from plan_cutters.options import Options
from plan_cutters.pipeline import run as run_stages
from plan_cutters.plan_file.load import plan_of
from plan_cutters.plan_file.words.names import as_fields
from plan_cutters.report import models
from plan_cutters.report.to_json import dumps
from plan_cutters_agents.plan_answers import planned
from plan_cutters_base.workers import supervise
from plan_cutters_base.workers.child import TIMED_OUT
from plan_cutters_base.workers.supervise import OutOfTime
from plan_cutters_ci.plans import compare
from tests.support.commands import in_lines, leftovers
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
    signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
    os.kill(os.getppid(), signal.SIGINT)
    any(itertools.repeat(False))


def out_of_memory(*_, **__):
    raise MemoryError


#: What is written of verdicts by default.
WRITTEN = ["annotated.glb", "annotated.step", "plan.json", "process.toml", "review.html", "samples.npz"]


def unfinished(folder, *absent, alone=True):
    """The plan of a folder, alone there with its samples: it is one, and says once, in front, what it is without."""
    assert leftovers(folder) == (["plan.json", "samples.npz"] if alone else WRITTEN)
    whole = plan_of((folder / "plan.json").read_bytes(), "plan.json")
    (text,) = [text for code, text in zip(whole.note_codes, whole.notes, strict=True) if code == "run_unfinished"]
    every = (BETWEEN, ANSWERS, OPERATIONS)
    assert [each for each in every if each in text] == [each for each in every if each in absent]
    assert whole.process.doubts[0] == text
    assert " ".join(line.strip() for line in whole.text.lines[:3]).startswith(as_fields(text))
    assert (BETWEEN in absent) == (whole.cutters[0].area is None)
    assert whole.operations is None
    assert sorted(entry.name for entry in whole.files.values()) == sorted({*leftovers(folder)} - {"plan.json"})
    return whole


def told(done, code, *absent):
    """The last line of a command that was ended: it says where the plan is, and what that is without, as the summary does."""
    assert done.returncode == code
    assert done.stdout.startswith("Take flat end D12 x 80: it finishes all 13,300 mm².\nThe run was ")
    assert all(each in in_lines(done.stdout) for each in absent)
    last = done.stderr.splitlines()[-1]
    assert "the plan of the verdicts is in " in last
    assert "out/plan.json. The run was " in last
    assert all(each in last for each in absent)
    return last


@pytest.mark.slow("plans and writes all files for each stage", only=("answers",))
@pytest.mark.parametrize("stage", STAGES)
def test_an_interrupt_leaves_page_samples_and_models_of_the_verdicts(tmp_path, monkeypatch, stage):
    where, absent = STAGES[stage]
    monkeypatch.setattr(*where, interrupted)
    # One after the other: side by side it is up to the machine which of them ends first.
    last = told(run(*WORDS, "--jobs", "1", "-o", "out", cwd=tmp_path), 130, *absent)
    assert last.startswith("plan-cutters: interrupted; ")
    assert "The run was interrupted while " in last
    assert leftovers(tmp_path) == ["out"]
    assert unfinished(tmp_path / "out", *absent, alone=False).not_written == {}


def waits(*_, **__):
    time.sleep(60)


@pytest.mark.parametrize(("wait", "more", "code"), [(interrupted, (), 130), (waits, ("--timeout", "10"), 124)])
def test_while_setups_are_compared_the_plan_of_z_is_left(tmp_path, monkeypatch, wait, more, code):
    """Interrupted or out of time: summary, plan, samples and page, which say that setups were not compared."""
    monkeypatch.setattr(proposal, "proposed", wait)
    done = run(PART, "--cutter", "R6L80", "--machine", "trunnion-ac", "--setup", "auto", "--operations", "fewest", "-o", "out",
               *more, cwd=tmp_path)  # fmt: skip
    assert done.returncode == code
    assert leftovers(tmp_path / "out") == WRITTEN
    whole = plan_of((tmp_path / "out" / "plan.json").read_bytes(), "plan.json")
    assert (whole.effective.setup, whole.setup_proposal) == ((0.0, 0.0, 1.0), None)
    absent = "without a setup that was chosen and what holds the part (--setup auto)"
    assert absent in in_lines(done.stdout)
    assert absent in done.stderr.splitlines()[-1]
    assert "Setup 1: +Z up, nothing holds it yet" in in_lines(done.stdout)


@pytest.mark.slow("plans and writes all files for each stage", only=("area",))
@pytest.mark.parametrize("stage", ["area", "answers"])
def test_where_the_kernel_does_not_come_back_the_plan_is_left_and_told(tmp_path, monkeypatch, stage):
    """The worker is killed: what it had written stands, the summary is shown of that, and the files that lack are named."""
    where, absent = STAGES[stage]
    monkeypatch.setattr(*where, interrupted_in_c)
    monkeypatch.setattr(supervise, "BEGINNING", 0.5)
    last = told(run(*WORDS, "-o", "out", cwd=tmp_path), 130, *absent)
    assert "There was no time to write review.html, annotated.step, annotated.glb: plan-cutters show " in last
    assert leftovers(tmp_path) == ["out"]
    assert set(unfinished(tmp_path / "out", *absent).not_written.values()) == {"interrupted"}


def test_an_interrupt_before_the_reasons_leaves_the_verdicts(tmp_path, monkeypatch):
    """The cutter whose reasons were not looked for is named."""
    monkeypatch.setattr(Reasons, "of", interrupted)
    done = run(*WORDS, "--machine", "tilt:10", "-o", "out", cwd=tmp_path)
    assert done.returncode == 130
    assert "the reasons of R6L80, witnesses, --answers mend and --operations fewest. What it names in their place" in done.stderr
    assert "interrupted while finding the reasons" in in_lines(done.stdout)
    whole = plan_of((tmp_path / "out" / "plan.json").read_bytes(), "plan.json")
    assert whole.cutters[0].inaccessible > 0
    assert sum(whole.cutters[0].by_reason.values()) == whole.cutters[0].inaccessible + whole.cutters[0].undecided
    assert whole.cutters[0].witnesses == []
    assert leftovers(tmp_path / "out") == WRITTEN


def test_an_interrupt_before_the_part_is_ready_leaves_nothing(tmp_path, monkeypatch):
    monkeypatch.setattr(pipeline, "conditions_of", interrupted)
    done = run(*WORDS, "-o", "out", cwd=tmp_path)
    assert (done.returncode, done.stdout, done.stderr.splitlines()[-1]) == (
        130,
        "",
        "plan-cutters: interrupted; no file is half-written",
    )
    assert leftovers(tmp_path) == []


def test_answers_that_are_found_stay(tmp_path, monkeypatch):
    """Of three questions the first one is answered."""
    monkeypatch.setattr(ask, "radius_in_any", interrupted)
    done = run(*WORDS, "--answers", "stick-out,radius", "-o", "out", cwd=tmp_path)
    told(done, 130, "--answers radius,mend")
    whole = plan_of((tmp_path / "out" / "plan.json").read_bytes(), "plan.json")
    assert whole.cutters[0].least_stick_out is not None
    assert "stick-out" not in next(
        text for code, text in zip(whole.note_codes, whole.notes, strict=True) if code == "run_unfinished"
    )


@pytest.mark.slow("runs whole commands")
def test_operations_that_are_planned_meanwhile_stay(tmp_path, monkeypatch):
    def late(*_, **__):
        time.sleep(3.0)
        interrupted()

    monkeypatch.setattr(ask, "nearest", late)
    done = run(*WORDS, "--jobs", "2", "-o", "out", cwd=tmp_path)
    told(done, 130, "--answers mend")
    assert "--operations" not in done.stderr.splitlines()[-1]
    assert plan_of((tmp_path / "out" / "plan.json").read_bytes(), "plan.json").operations is not None
    assert {"operations.step", "operations.csv"} <= {*leftovers(tmp_path / "out")}


def test_an_interrupt_of_the_writing_waits_for_the_files(tmp_path, monkeypatch):
    """All is found by then, and the files become whole; the exit code says that it was interrupted."""
    real = models.split_result

    def split(result):
        os.kill(os.getppid(), signal.SIGINT)
        time.sleep(0.5)
        return real(result)

    monkeypatch.setattr(models, "split_result", split)
    done = run(PART, "--cutter", "R6L80", "--grid", "3", "--area-budget", "0", "-o", "out", cwd=tmp_path)
    assert done.returncode == 130
    assert done.stdout.startswith("Take flat end D12 x 80: it finishes all 13,300 mm².\n")
    assert done.stderr.splitlines()[-1].startswith("plan-cutters: interrupted; its plan is in ")
    assert leftovers(tmp_path / "out") == WRITTEN


def test_what_is_being_written_is_given_longer_than_what_hangs(tmp_path, monkeypatch):
    """A large page or model takes more than the time in which the writing must have begun."""
    real = models.split_result

    def slowly(result):
        time.sleep(2.0)
        return real(result)

    monkeypatch.setattr(supervise, "BEGINNING", 0.7)
    monkeypatch.setattr(*STAGES["answers"][0], interrupted)
    monkeypatch.setattr(models, "split_result", slowly)
    told(run(*WORDS, "-o", "out", cwd=tmp_path), 130, ANSWERS, OPERATIONS)
    assert unfinished(tmp_path / "out", ANSWERS, OPERATIONS, alone=False).not_written == {}


def test_a_second_interrupt_ends_it_at_once(tmp_path, monkeypatch):
    """Nothing is half-written: what became whole is there, and the plan says what is not."""

    def twice(*_, **__):
        os.kill(os.getppid(), signal.SIGINT)
        time.sleep(60)

    monkeypatch.setattr(*STAGES["answers"][0], interrupted)
    monkeypatch.setattr(models, "split_result", twice)
    began = time.monotonic()
    done = run(*WORDS, "-o", "out", cwd=tmp_path)
    assert time.monotonic() - began < 30
    last = told(done, 130, ANSWERS, OPERATIONS)
    assert "There was no time to write annotated.glb, annotated.step: " in last
    assert leftovers(tmp_path / "out") == ["plan.json", "process.toml", "review.html", "samples.npz"]


def test_a_plan_without_a_folder_is_told_and_handed_out(tmp_path, monkeypatch):
    monkeypatch.setattr(*STAGES["answers"][0], interrupted)
    done = run(*WORDS, "--json", "-", cwd=tmp_path)
    assert done.returncode == 130
    whole = plan_of(done.stdout.encode(), "plan.json")
    assert "run_unfinished" in whole.note_codes
    assert leftovers(tmp_path) == []


@pytest.mark.slow("runs whole commands")
def test_a_proposal_that_is_interrupted_keeps_its_setups(tmp_path, monkeypatch):
    monkeypatch.setattr(Reasons, "of", interrupted)
    done = run(SAMPLES / "pocket_top.step", "--cutter", "R2L30", "--grid", "3", "--area-budget", "0", "--setup", "auto",
               "-o", "out", cwd=tmp_path)  # fmt: skip
    assert done.returncode == 130
    whole = plan_of((tmp_path / "out" / "plan.json").read_bytes(), "plan.json")
    assert whole.setup_proposal is not None
    assert {"setup-1.toml", "review.html"} <= {*leftovers(tmp_path / "out")}


@pytest.mark.slow("waits for a time limit")
def test_a_time_limit_leaves_them_too(tmp_path, monkeypatch):
    where, absent = STAGES["operations"]
    monkeypatch.setattr(*where, lambda *_, **__: time.sleep(60))
    done = run(*WORDS, "-o", "out", "--timeout", "8", cwd=tmp_path)
    last = told(done, TIMED_OUT, *absent)
    assert "v_groove.step: not done within 8 s: " in last
    assert leftovers(tmp_path) == ["out"]
    assert unfinished(tmp_path / "out", *absent, alone=False).not_written == {}


def test_what_a_part_that_is_left_says_of_its_plan(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(*STAGES["operations"][0], interrupted)
    run(*WORDS, "-o", "out", cwd=tmp_path)

    def late(*_, **__):
        raise OutOfTime(0, 0, tmp_path / "out")

    monkeypatch.setattr(partial_plan, "supervise", late)
    assert partial_plan.supervised((), parts=("a.step",), read_timeout=9.0, memory=1, timeout=9.0, since=3.0) == TIMED_OUT
    said = capsys.readouterr().err
    assert f"the plan of the verdicts is in {tmp_path / 'out' / 'plan.json'}. The run was interrupted while " in said


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
    assert unfinished(tmp_path / "out", ANSWERS, OPERATIONS, alone=False).cutters[0].id == "R6L80"


def test_without_a_plan_among_the_formats_the_others_are_written(tmp_path, monkeypatch):
    monkeypatch.setattr(*STAGES["answers"][0], interrupted)
    done = run(*WORDS, "-o", "out", "--formats", "npz", cwd=tmp_path)
    assert done.returncode == 130
    assert done.stderr.splitlines()[-1] == f"plan-cutters: interrupted; what stands is in {tmp_path / 'out'}"
    assert "samples.npz" in leftovers(tmp_path / "out")


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
        run_stages(PART, options, Clock(), interim=Interim(Clock(), lambda result: before.append(result.plan))),
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
    options = Options(cutters=("R6L80",), grid=3, area_budget=0)
    run_stages(PART, options, Clock(), interim=Interim(Clock(), lambda result: before.append(result.plan)))
    assert before == []


def test_readers_take_a_plan_that_is_unfinished(stages, tmp_path):
    last, before, _ = stages
    for number, each in enumerate(before):
        assert compare(each, each).comparable
        difference = compare(each, last.plan)
        assert difference.comparable
        assert (difference.lost, difference.won) == (False, False)
        assert any(note["code"] == "run_unfinished" for note in planned(each, 1, {}).notes)
        written = replace(last, plan=each, maps=None).write(tmp_path / str(number), ("json", "html", "npz"))
        assert "html" in written.files
    assert json.loads((tmp_path / "0" / "plan.json").read_text())["process"]["doubts"]


def test_the_first_line_is_told_as_soon_as_verdicts_stand(tmp_path):
    words = (SAMPLES / "v_groove.step", "--cutter", "R6L80", "--grid", "9", "--operations", "fewest", "--formats", "json")
    told = run(*words, cwd=tmp_path).stderr
    assert told.count("So far: ") == 1
    assert told.index("So far: ") < told.index("planning the operations")
    assert "So far" not in run(*words, "--quiet", cwd=tmp_path).stderr
    assert "So far" not in run(*words[:5], "--formats", "json", cwd=tmp_path).stderr
