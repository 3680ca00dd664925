"""Seconds by stage: no second twice, hardly one in no stage."""

import json
import os
import subprocess
import sys
import time

import pytest

from plan_cutters.document import clock as module
from plan_cutters.document.clock import Clock
from plan_cutters.plan_file.model import Run
from tests.support.places import ROOT

BLADE = ROOT / "samples" / "blade.step"


@pytest.fixture
def at(monkeypatch):
    """Sets what the clock on the wall says."""
    now = [0.0]
    monkeypatch.setattr(module.time, "monotonic", lambda: now[0])
    return lambda seconds: now.__setitem__(0, float(seconds))


def test_stages_are_parts_of_the_total(at):
    at(10)
    clock = Clock(began=7.0)
    assert (clock.seconds, clock.total) == ({"start": 3.0}, 3.0)
    for begins, ends, name in ((11, 13, "read"), (13, 14, "split"), (16, 18, "read")):
        at(begins)
        with clock.stage(name):
            at(ends)
    at(19)
    assert clock.seconds == {"start": 3.0, "read": 4.0, "split": 1.0}
    assert clock.total == 12.0


def test_what_fails_has_taken_its_time_too(at):
    clock = Clock()

    def fails():
        at(4)
        raise OSError("disk full")

    with pytest.raises(OSError, match="full"), clock.stage("step"):
        fails()
    assert clock.seconds == {"step": 4.0}


def test_writing_goes_on_where_planning_ended(at):
    at(100)
    clock = Clock.after(Run(time="", seconds={"read": 2.0}, total=3.0))
    at(101)
    with clock.stage("glb"):
        at(105)
    assert clock.seconds == {"read": 2.0, "glb": 4.0}
    assert clock.total == 8.0


def test_progress_is_told_of_the_stages_that_are_shown():
    told = []
    clock = Clock(lambda *words: told.append(words))
    with clock.stage("read") as tell:
        tell(1, 2)
    with clock.stage("json", shown=False) as tell:
        tell(1, 2)
    assert told == [("read", 0, 1), ("read", 1, 2), ("read", 1, 1)]


@pytest.mark.slow("starts commands and ends them on the way")
def test_the_seconds_of_a_command_are_nearly_all_of_it(tmp_path):
    """Of a whole run, start and imports included: in stages at least 95 %, and never more than was measured from outside."""
    environment = {**os.environ, "PYTHONPATH": f"{ROOT / 'plugin'}{os.pathsep}{ROOT}"}
    began = time.monotonic()
    subprocess.run([sys.executable, "-m", "plan_cutters", str(BLADE), "--cutter", "R6L80", "--area-budget", "500", "-o",
                    str(tmp_path / "out")], env=environment, check=True, capture_output=True)  # fmt: skip
    outside = time.monotonic() - began
    run = json.loads((tmp_path / "out" / "plan.json").read_text())["run"]
    assert set(run["seconds"]) == {
        "start", "read", "measure", "sew", "orient", "holes", "patterns", "sample", "classify", "tessellate", "tree", "compile",
        "bodies", "process", "R6L80", "reasons", "area", "plan", "json", "show", "html", "split", "glb", "step",
    }  # fmt: skip
    assert all(seconds >= 0 for seconds in run["seconds"].values())
    assert 0.95 * run["total"] < sum(run["seconds"].values()) <= run["total"] * (1 + 1e-9)
    # The kernel counts the start of a process in hundredths of a second.
    assert run["total"] <= outside + 0.02
