"""What is Linux only has a fall-back: the same plan on a system without it."""

import json
import subprocess
import sys

import pytest

from tests.support.forked import ENV
from tests.support.places import SAMPLES

pytestmark = pytest.mark.slow("starts commands and ends them on the way")

SAMPLE = SAMPLES / "v_groove.step"
#: What Windows, and in part macOS, has not.
CODE = """
import os, sys
for name in {gone}:
    delattr(os, name)
sys.modules["resource"] = None
from plan_cutters.command.cli import main
main([{part!r}, "--cutter", "R6L80", "--cutter", "R2L30", "--grid", "9", "--area-budget", "200", "--quiet", "-o", {out!r}])
"""
GONE = {"Windows": ["fork", "killpg", "getuid", "sysconf", "sched_getaffinity", "setsid"], "macOS": ["sched_getaffinity"]}


def planned(gone, out):
    code = CODE.format(gone=gone, part=str(SAMPLE), out=str(out))
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=ENV, timeout=300)
    assert (done.returncode, done.stderr) == (0, "")
    return json.loads((out / "plan.json").read_text()) | {"run": None}


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The plan where nothing is missing."""
    return planned([], tmp_path_factory.mktemp("all"))


@pytest.mark.parametrize("system", GONE)
def test_the_same_plan_where_functions_are_missing(system, whole, tmp_path):
    assert planned(GONE[system], tmp_path / "without") == whole
    assert whole["selected"] == "R6L80"


def test_reading_needs_no_copy_of_the_process(monkeypatch):
    import os

    from cad_io import read_part

    monkeypatch.delattr(os, "fork")
    assert len(read_part(SAMPLE, guarded=True).faces) == len(read_part(SAMPLE).faces)
