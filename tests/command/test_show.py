"""`plan-cutters show`: page and models of a folder are those that the run itself writes, and what cannot be made has a line."""

import itertools
import os
import shutil
import signal

import pytest

from plan_cutters.answers import ask
from plan_cutters.plan_file.load import load_plan
from plan_cutters_base.workers import supervise
from tests.support.commands import in_lines, leftovers
from tests.support.forked import run
from tests.support.places import SAMPLES

PART = SAMPLES / "v_groove.step"
WORDS = (PART, "--cutter", "R6L80", "--grid", "3", "--area-budget", "50", "--answers", "mend", "--operations", "fewest")


def interrupted_in_c(*_, **__):
    """Let an interrupt come while one call does not come back, as of the CAD kernel: the worker is killed."""
    signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
    os.kill(os.getppid(), signal.SIGINT)
    any(itertools.repeat(False))


MODELS = ("annotated.glb", "annotated.step", "review.html")
#: Everything that a page shows: two setups, a machine of rotary axes, a fixture, largest radii, operations.
WHOLE = (PART, "--cutter", "R6L80", "--cutter", "R2L30rc2", "--grid", "5", "--area-budget", "0", "--machine", "trunnion-ac",
         "--setup", "+z", "--setup", "+x", "--fixture", "box:5,5,5@0,0,-40", "--answers", "radius", "--operations", "both",
         "--feed", "1000")  # fmt: skip


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The folder of a plan, with its part."""
    folder = tmp_path_factory.mktemp("shown")
    done = run(*WHOLE, "-o", "out", cwd=folder)
    assert done.returncode in (0, 1), done.stderr
    shutil.copy(PART, folder)
    return folder


def copied(whole, tmp_path, *without):
    """A copy of the folder, lacking some files."""
    shutil.copytree(whole, tmp_path, dirs_exist_ok=True)
    for name in without:
        (tmp_path / "out" / name).unlink()
    return tmp_path / "out"


def content(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.name != "plan.json"}


@pytest.mark.slow("plans with operations in two setups")
def test_what_is_made_is_what_the_run_writes(whole, tmp_path):
    """To the byte: the page has the postures, the largest radii and the operations, the models of both plans have their steps."""
    models = [name for name in leftovers(whole / "out") if name.endswith((".glb", ".step", ".html"))]
    assert {*MODELS, "operations.glb", "operations.step"} <= {*models}
    out = copied(whole, tmp_path, *models)
    done = run("show", "out", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert content(out) == content(whole / "out")
    before, after = (load_plan(folder / "plan.json") for folder in (whole / "out", out))
    assert (after.files, after.not_written, after.split) == (before.files, before.not_written, before.split)
    assert in_lines(done.stdout).startswith(before.text.headline)
    assert done.stdout.splitlines()[-1] == "Review page: out/review.html"


@pytest.mark.slow("plans with operations in two setups", together="whole")
def test_where_nothing_is_missing_the_part_is_not_asked_for(whole, tmp_path):
    copied(whole, tmp_path)
    (tmp_path / PART.name).unlink()
    done = run("show", "out", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert in_lines(done.stdout).startswith(load_plan(tmp_path / "out" / "plan.json").text.headline)


def gone(out):
    (out.parent / PART.name).unlink()
    return "its part is gone (v_groove.step, here or with the plan): give its file with --part"


def changed(out):
    shutil.copy(SAMPLES / "blade.step", out.parent / PART.name)
    return "its part was changed since: the SHA-256 of v_groove.step is not "


def no_samples(out):
    (out / "samples.npz").unlink()
    return "samples.npz: not in out, and models are made of it: plan the part again"


def other_samples(out):
    (out / "samples.npz").write_bytes(b"")
    return "samples.npz: not the file that plan.json names: plan the part again"


@pytest.mark.slow("plans with operations in two setups", together="whole")
@pytest.mark.parametrize("cause", [gone, changed, no_samples, other_samples])
def test_what_cannot_be_made_has_one_line_and_the_summary_is_shown(whole, tmp_path, cause):
    out = copied(whole, tmp_path, "annotated.glb", "review.html")
    line = cause(out)
    before = (out / "plan.json").read_bytes()
    done = run("show", "out", cwd=tmp_path)
    assert done.returncode == 3
    assert done.stderr.splitlines()[-1].startswith(f"plan-cutters show: not made: review.html, annotated.glb: {line}")
    assert in_lines(done.stdout).startswith(load_plan(out / "plan.json").text.headline)
    assert "review.html" not in done.stdout
    assert (out / "plan.json").read_bytes() == before
    assert leftovers(tmp_path) == sorted({"out", PART.name} - ({PART.name} if cause is gone else set()))


def test_a_folder_without_a_plan(tmp_path):
    done = run("show", ".", cwd=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == "plan-cutters show: .: has no plan.json: give the folder of a plan\n"


@pytest.mark.slow("plans, and is killed")
def test_a_run_that_was_killed_is_shown(tmp_path, monkeypatch):
    """Plan and samples are on disk as soon as the verdicts stand: all that a page and models need."""
    with monkeypatch.context() as patched:
        patched.setattr(ask, "nearest", interrupted_in_c)
        patched.setattr(supervise, "BEGINNING", 0.5)
        done = run(*WORDS, "-o", "out", cwd=tmp_path)
    assert done.returncode == 130
    assert leftovers(tmp_path / "out") == ["plan.json", "samples.npz"]
    assert (
        f"There was no time to write review.html, annotated.step, annotated.glb: plan-cutters show {tmp_path / 'out'} does."
        in (done.stderr)
    )
    done = run("show", "out", "--part", PART, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert leftovers(tmp_path / "out") == [*MODELS[:2], "plan.json", "review.html", "samples.npz"]
    plan = load_plan(tmp_path / "out" / "plan.json")
    assert plan.not_written == {}
    assert "run_unfinished" in plan.note_codes
    assert "The run was not done: this plan is without --answers mend and --operations fewest." in in_lines(done.stdout)
