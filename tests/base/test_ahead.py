"""Machine code that is made by a second process while the first one reads and meshes."""

import json
import os
import subprocess
import sys

import pytest

from plan_cutters.command import background_compile
from plan_cutters.kernels import jit
from plan_cutters_base.workers.child import VARIABLE, Assignment
from tests.support.forked import ENV
from tests.support.places import ROOT


@pytest.fixture(scope="module")
def made_ahead():
    return subprocess.run(
        [sys.executable, "-m", "plan_cutters.command.background_compile", "maps"],
        env={**os.environ, **ENV},
        cwd=ROOT,
        timeout=300,
        check=False,
    )


def test_what_is_made_ahead_is_a_plan(made_ahead):
    """What it compiles it runs: nothing of it fails, and the area between samples is among it.

    It is the first test of all: what it makes on a fresh machine, all others load (`tests/conftest.py`).
    """
    assert made_ahead.returncode == 0


def test_nothing_is_made_where_it_is_at_hand(monkeypatch):
    monkeypatch.setattr(subprocess, "Popen", lambda *words, **more: pytest.fail("a process was started"))
    for found in (True, None):
        monkeypatch.setattr(jit, "at_hand", lambda name, found=found: found)
        assert background_compile.begin(maps=False) is None


@pytest.mark.parametrize("maps", [False, True])
def test_the_second_process_is_waited_for(monkeypatch, maps):
    started, real = [], subprocess.Popen

    def popen(words, **more):
        started.append(words)
        there = json.loads(more["env"][VARIABLE])
        assert (there["report"], there["parent"]) == (None, os.getpid())  # it must not speak for this one
        return real([sys.executable, "-c", "import time; time.sleep(0.2)"], **more)

    monkeypatch.setenv(VARIABLE, str(Assignment(report=1)))
    monkeypatch.setattr(jit, "at_hand", lambda name: False)
    monkeypatch.setattr(subprocess, "Popen", popen)
    wait = background_compile.begin(maps)
    assert wait is not None
    wait("search.search.search_rows")
    assert started[0][3:] == ["plan_cutters.command.background_compile", *(["maps"] if maps else [])]


def test_it_is_waited_for_until_an_entry_is_there(monkeypatch):
    """Not to its end: what else it makes is needed later."""
    made, there, real = [], [], subprocess.Popen
    monkeypatch.setattr(jit, "at_hand", lambda name: name in there)
    monkeypatch.setattr(subprocess, "Popen", lambda words, **more: made.append(
        real([sys.executable, "-c", "import time; time.sleep(600)"], **more)) or made[0])  # fmt: skip
    wait = background_compile.begin(maps=False)
    there.append("search.search.search_rows")
    try:
        wait("search.search.search_rows")
        assert made[0].poll() is None
    finally:
        made[0].kill()
        made[0].wait()


def test_one_that_does_not_end_is_not_waited_for_for_ever(monkeypatch):
    made, real = [], subprocess.Popen
    monkeypatch.setattr(jit, "at_hand", lambda name: False)
    monkeypatch.setattr(background_compile, "_PATIENCE", 0.2)
    monkeypatch.setattr(subprocess, "Popen", lambda words, **more: made.append(
        real([sys.executable, "-c", "import time; time.sleep(600)"], **more)) or made[0])  # fmt: skip
    background_compile.begin(maps=False)("search.search.search_rows")
    assert made[0].returncode is not None


@pytest.mark.slow("compiles anew in processes of its own")
def test_machine_code_is_found_where_the_compiler_keeps_it(tmp_path):
    """In a process of its own: where the folder is, is asked once."""
    look = "from plan_cutters.kernels.jit import at_hand; print(at_hand('material.none'), at_hand('material.moments'))"
    make = "import numpy as np; from plan_cutters.kernels.material import moments; moments(np.zeros((1, 3, 3)), np.ones(1), 0)"
    environment = {**ENV, "NUMBA_CACHE_DIR": str(tmp_path)}

    def run(text):
        return subprocess.run([sys.executable, "-c", text], env=environment, capture_output=True, text=True, check=True).stdout

    assert run(look).split() == ["False", "False"]
    run(make)
    assert run(look).split() == ["False", "True"]


#: Tells which entries a process has loaded or compiled after each of three plans.
LOADED = """
import re, sys
from pathlib import Path
import plan_cutters.kernels as room
from plan_cutters import plan
from plan_cutters.command.background_compile import compile_all

def told():
    found = []
    home = Path(room.__file__).parent
    for source in home.rglob("*.py"):
        module = sys.modules.get(".".join([room.__name__, *source.relative_to(home).with_suffix("").parts]))
        for entry in re.findall(r"^@entry\\ndef (\\w+)", source.read_text(), re.M) if module else ():
            if getattr(module, entry).overloads:
                found.append(f"{source.stem}.{entry}")
    print(*sorted(found))

compile_all(maps=False)
told()
for maps in (False, True):
    plan("samples/v_groove.step", cutters=["R6L80"], grid=9, posture_maps=maps)
    told()
"""


@pytest.mark.slow("compiles anew in processes of its own")
def test_a_plain_cutter_loads_what_it_needs_and_nothing_else(made_ahead):
    """No posture maps, largest radius, stick-out, fixed axis or picture: each would take seconds to compile on the first run."""
    # Made before: where an entry is compiled just now, those that it calls are there as well.
    assert made_ahead.returncode == 0
    said = subprocess.run(
        [sys.executable, "-c", LOADED], env={**os.environ, **ENV}, cwd=ROOT, capture_output=True, text=True, check=True
    ).stdout
    ahead, plain, maps = (set(line.split()) for line in said.splitlines())
    searched = {"search.dummy_clear", "search.probe", "search.search_rows"}
    assert plain == {"cover.cover", "material.windings", "tree.build", "flats_and_flanks.upright", *searched}
    assert ahead == plain, "what is made ahead is what a plan needs"
    assert maps - plain == {"free_map.free_map", "tree.wide_tree"}
