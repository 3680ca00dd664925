"""What is wrong with a command line is said in one line before anything large is begun, and what is meant is taken."""

import os
import subprocess
import sys

import pytest

from plan_cutters import Cutter, plan, plan_many
from plan_cutters.domain.fixture import no_format
from plan_cutters.errors import CutterError, OptionError
from plan_cutters.options import Options
from plan_cutters_base.whole import refusal
from tests.support.commands import leftovers
from tests.support.forked import ENV, run
from tests.support.places import SAMPLES

GROOVE = SAMPLES / "v_groove.step"
ONE = ("--cutter", "R3L40")
#: A folder in which nobody can make a file, whatever rights he has.
NOWHERE = "/proc"
nowhere = pytest.mark.skipif(not os.path.isdir(NOWHERE), reason="there is a folder like that on Linux alone")


def assert_line(done, code, words):
    """One line on standard error, and nothing else."""
    assert done.stdout == ""
    (line,) = done.stderr.strip().splitlines()
    assert line.startswith("plan-cutters")
    assert words in line
    assert done.returncode == code


def batch(*words, cwd):
    """A batch in a process of its own: dask's loop does not outlive a fork."""
    line = [sys.executable, "-m", "plan_cutters", "batch", *map(str, words)]
    return subprocess.run(line, cwd=cwd, env=ENV, capture_output=True, text=True, check=False)


# Before the work is begun. `bare`: neither kernel nor compiler may be loaded, and no process started.


@pytest.mark.slow("imports all of the models of a file once more", only=("words3-",))
@pytest.mark.parametrize(
    ("words", "code", "line"),
    [
        ((GROOVE, *ONE, "--cluster", "nohost"), 2, "--cluster was taken out: one part is judged here"),
        ((GROOVE, *ONE, "--check-operations", "none.json"), 2, "none.json: no such file: give the plan.json of a plan of"),
        ((GROOVE, *ONE, "--fixture", "visee"), 3, "visee: its name does not say its format; did you mean vise? Give STEP"),
        ((GROOVE, *ONE, "--fixture", "vise.dxf"), 3, "vise.dxf: '.dxf' is no format of fixtures: give STEP"),
        (("diff", "a.json", "b.json"), 2, "a.json: no such file or folder"),
        ((GROOVE, "--cutter", "R-6L80"), 2, "cutter 'R-6L80': radius must be a positive number of mm, not -6"),
        ((GROOVE, "--cutter", "R6L80rc9"), 2, "cutter 'R6L80rc9': corner radius 9 must lie between 0 and the radius 6"),
        ((GROOVE, *ONE, "--machine", "broken.toml"), 2, "broken.toml: is no TOML: "),
        ((GROOVE, *ONE, "--machine", "other.toml"), 2, "other.toml: format is missing"),
        (("changed", "--base", "main"), 2, "git rev-parse: fatal: not a git repository"),
    ],
)
def test_it_is_one_line_before_the_kernel_is_loaded(tmp_path, words, code, line):
    (tmp_path / "broken.toml").write_text("name = 'x'\n[[axes\n")
    (tmp_path / "other.toml").write_text("name = 'x'\n")
    before = leftovers(tmp_path)
    assert_line(run(*words, cwd=tmp_path, bare=words[0] != "changed"), code, line)  # that one starts git
    assert leftovers(tmp_path) == before


@nowhere
@pytest.mark.parametrize(
    "words",
    [
        (GROOVE, *ONE, "-o", f"{NOWHERE}/x"),
        (GROOVE, *ONE, "-o", f"{NOWHERE}/x/y"),
        (GROOVE, *ONE, "--junit", f"{NOWHERE}/x.xml"),
        ("map", GROOVE, *ONE, "--at", "0,0,0", "-o", f"{NOWHERE}/x.svg"),
        ("diff", ".", ".", "-o", f"{NOWHERE}/x"),
        ("diff", ".", ".", "--junit", f"{NOWHERE}/x.xml"),
    ],
)
def test_a_place_that_takes_no_file_is_refused_before_the_work(tmp_path, words):
    assert_line(run(*words, cwd=tmp_path, bare=words[0] == GROOVE), 2, f": {NOWHERE}/x")
    assert leftovers(tmp_path) == []


@nowhere
def test_why_a_folder_takes_no_file(tmp_path):
    assert refusal(tmp_path) == refusal(tmp_path / "made/later") == ""
    assert leftovers(tmp_path) == []
    assert refusal(NOWHERE) != ""
    (tmp_path / "file").touch()
    assert refusal(tmp_path / "file/below") == "Not a directory"


# Batch


@pytest.mark.slow("starts a process for each", only=("words1-", "words2-", "words4-"))
@pytest.mark.parametrize(
    ("words", "code", "line"),
    [
        (("none.step", "-o", "out"), 3, "none.step: no such file or folder"),
        (("memory://x", "-o", "out"), 2, "memory://x: memory:// is the memory of one process"),
        ((GROOVE, "-o", "memory://out"), 2, "memory://out: memory:// is the memory of one process"),
        ((GROOVE, "-o", "file"), 2, "file: the output must be a folder, this is a file"),
        ((GROOVE, "-o", f"{NOWHERE}/x"), 2, f"{NOWHERE}/x: cannot write there"),
        ((GROOVE, "-o", "out", "--cluster", "nohost"), 2, "--cluster nohost: no such file, and no address"),
        (("broken.toml", "-o", "out"), 2, "broken.toml: is no TOML"),
    ],
)
def test_a_batch_that_can_plan_nothing_starts_no_worker(tmp_path, words, code, line):
    (tmp_path / "file").touch()
    (tmp_path / "broken.toml").write_text("[[part\n")
    before = leftovers(tmp_path)
    assert_line(batch(*words, *ONE, cwd=tmp_path), code, line)
    assert leftovers(tmp_path) == before


# What is meant


def test_all_operations_are_both(tmp_path):
    assert Options.of({"cutters": "R6L80", "operations": "all", "feed": 500}).operations == "both"
    # The next mistake is said, so this is none.
    assert_line(run(GROOVE, *ONE, "--operations", "all", "--feed", "0", cwd=tmp_path, bare=True), 2, "feed 0")
    assert_line(run(GROOVE, *ONE, "--operations", "al", cwd=tmp_path, bare=True), 2, "is not one of 'fewest', 'fastest', 'both'")


def test_a_cutter_of_numbers_that_cannot_be_is_named():
    with pytest.raises(CutterError) as raised:
        Cutter.parse(" D0L80 ")
    assert str(raised.value) == "cutter 'D0L80': radius must be a positive number of mm, not 0"


def test_in_python_a_word_that_is_no_direction_says_what_is_one():
    with pytest.raises(OptionError, match=r"setup 'W' is no direction, as \+z, -y or \(0, 0, 1\), a setup file, or auto"):
        Options.of({"cutters": "R6L80", "setup": "W"})
    with pytest.raises(OptionError, match=r"none.toml: cannot be read"):
        Options.of({"cutters": "R6L80", "setup": "none.toml"})


def test_no_parts_start_no_worker():
    with pytest.raises(OptionError, match="parts: the list is empty"):
        next(iter(plan_many([], cutters="R6L80")))


def test_a_word_that_is_like_no_clamping_has_no_suggestion():
    assert no_format("jaws") == (
        "its name does not say its format: give STEP, IGES, BREP, STL, OBJ, PLY or GLB, or box:, cylinder:, table, vise or chuck"
    )


def test_formats_are_a_list_or_the_text_of_one(tmp_path):
    result = plan(GROOVE, cutters=["R3L40"], grid=3, area_budget=0)
    with pytest.raises(OptionError, match="format 'jsn' is not built in"):
        result.write(tmp_path / "out", formats="jsn")
    result.write(tmp_path / "out", formats="json,csv")
    assert leftovers(tmp_path / "out") == ["axes.csv", "plan.json", "process.toml"]


def test_tilts_that_hold_no_posture_are_a_plan_without_a_machine():
    """The range of tilts loses all samples for all cutters, and no machine has setups to compare."""
    result = plan(GROOVE, cutters=["R3L40"], grid=3, area_budget=0, tilt_deg=(95, 100))
    assert result.selected is None
    assert result.plan.cutters[0].beyond_setup == result.plan.samples.count
    assert "Area within the limit by setup axis" not in " ".join(result.plan.text.lines)
