"""What is loaded when: who waits loads next to nothing; who works begins early, and loads nothing that no plan needs."""

import os
import subprocess
import sys

import pytest

from plan_cutters_base.workers import child
from plan_cutters_base.workers.child import VARIABLE
from tests.support.commands import leftovers
from tests.support.forked import ENV
from tests.support.places import SAMPLES

GROOVE = str(SAMPLES / "v_groove.step")

ASK = """
import sys
from plan_cutters.command import cli, partial_plan
def instead(words, **more):
    print(*sys.modules)
    return 0
partial_plan.supervised = instead
cli.main()
"""
LOAD = "import sys\nfrom plan_cutters.command import cli\ncli.load()\nprint(*sys.modules)"


def loaded(code, *words, cwd):
    done = subprocess.run([sys.executable, "-c", code, *words], cwd=cwd, env=ENV, capture_output=True, text=True, check=True)
    return {name.partition(".")[0] for name in done.stdout.split()}


def test_what_waits_loads_neither_the_kernel_nor_the_compiler(tmp_path):
    found = loaded(ASK, GROOVE, "--cutter", "R6L80", "--quiet", cwd=tmp_path)
    assert "plan_cutters" in found
    assert not found & {"OCP", "numba", "llvmlite", "scipy", "pydantic", "shapely", "matplotlib", "rich"}


def test_what_works_loads_nothing_that_no_plan_needs(tmp_path):
    found = loaded(LOAD, cwd=tmp_path)
    assert found >= {"OCP", "numba", "pydantic"}
    assert not found & {"matplotlib", "PIL", "trimesh", "build123d", "cadquery", "pytest", "openpyxl", "IPython", "pandas"}


def test_what_says_why_models_are_missing_loads_nothing(tmp_path):
    """An interrupted command has half a second."""
    code = "import sys, pathlib\nfrom plan_cutters.report.folder import ended\n"
    code += "from plan_cutters.command.partial_plan import without_models\n"
    found = loaded(f"{code}ended(pathlib.Path('out'), 'interrupted')\nprint(*sys.modules)", cwd=tmp_path)
    assert not found & {"OCP", "numba", "scipy", "pydantic", "rich", "numpy"}


@pytest.mark.parametrize(
    ("words", "begun"),
    [
        ((GROOVE,), True),
        ((GROOVE, "--cutter", "R6L80"), True),
        ((GROOVE, "--help"), False),
        (("--version",), False),
        (("none.step",), False),
        ((), False),
    ],
)
def test_it_begins_early_where_there_is_a_part(monkeypatch, words, begun):
    made = []
    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.setattr(child, "_early", [])
    monkeypatch.setattr(child.atexit, "register", lambda call: None)

    class Made:
        drop = None

    monkeypatch.setattr(child, "Worker", lambda words, name, *, waits: made.append((words, waits)) or Made)
    child.begin_early(words)
    assert made == ([(words, True)] if begun else [])
    assert len(child._early) == len(made)


def test_one_that_waits_ends_where_the_words_are_wrong(tmp_path):
    """It is ended when the command ends, and it has touched nothing."""
    mark = f"MARK_OF_START={tmp_path}"
    name, _, value = mark.partition("=")
    words = [sys.executable, "-m", "plan_cutters", GROOVE, "--cutter", "R6Q"]
    done = subprocess.run(words, cwd=tmp_path, env=ENV | {name: value}, capture_output=True, text=True, check=False, timeout=60)
    assert done.returncode == 2
    assert len(done.stderr.splitlines()) == 1
    assert leftovers(tmp_path) == []
    for each in filter(str.isdigit, os.listdir("/proc") if os.path.isdir("/proc") else []):
        try:
            with open(f"/proc/{each}/environ", "rb") as file:
                assert mark.encode() not in file.read().split(b"\0")
        except OSError:
            continue
