"""What the README and the docstrings show is what happens."""

import doctest
import importlib
import pkgutil
import re
import shutil

import pytest

import cad_io
import plan_cutters
from tests.support.places import ROOT

MODULES = sorted(
    module.name
    for package in (cad_io, plan_cutters)
    for module in pkgutil.walk_packages(package.__path__, package.__name__ + ".")
    if not module.name.endswith("__main__")
)
#: What a script calls, each shown at work in its docstring.
SHOWN = ["plan", "posture_map", "Scene", "Options", "Cutter", "Machine", "PostureRange"]


@pytest.mark.parametrize("name", MODULES)
def test_examples_in_docstrings(name, monkeypatch):
    monkeypatch.chdir(ROOT)
    assert doctest.testmod(importlib.import_module(name), optionflags=doctest.ELLIPSIS).failed == 0


def test_what_scripts_call_is_shown_at_work():
    found = {name for name in SHOWN if ">>>" in _text(getattr(plan_cutters, name))}
    assert found == set(SHOWN)
    assert ">>>" in cad_io.read_part.__doc__


def _text(thing):
    return "".join(filter(None, (thing.__doc__, *(getattr(getattr(thing, n, None), "__doc__", "") for n in ("of", "parse")))))


def blocks(page):
    """Name the kind and the text of each code fence of a page."""
    return re.findall(r"^```(\w*)\n(.*?)^```$", (ROOT / page).read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)


@pytest.fixture
def somewhere(tmp_path, monkeypatch):
    """A folder with the samples, and nothing else."""
    shutil.copytree(ROOT / "samples", tmp_path / "samples")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_the_first_two_fences_are_the_main_job_and_the_tests():
    (main, run), (tests, check) = blocks("README.md")[:2]
    assert main == tests == "sh"
    assert run.startswith("sh setup.sh && .venv/bin/plan-cutters samples/peaks_and_valleys.step ")
    assert check == "sh setup.sh dev && .venv/bin/python -m pytest -n auto\n"


def test_the_python_block_of_the_readme_runs_as_it_stands(somewhere, capsys):
    (code,) = [text for kind, text in blocks("README.md") if kind == "python"]
    exec(compile(code, "README.md", "exec"), {})
    (chosen,) = capsys.readouterr().out.splitlines()
    assert chosen.startswith("R8L90 True {")
    assert sorted(p.name for p in (somewhere / "v_groove-plan").iterdir()) == [
        "annotated.glb", "annotated.step", "plan.json", "process.toml", "review.html", "samples.npz",
    ]  # fmt: skip


def test_the_python_block_of_the_page_runs_as_it_stands(somewhere, capsys):
    (code,) = [text for kind, text in blocks("docs/python.md") if kind == "python"]
    exec(compile(code, "docs/python.md", "exec"), {})
    chosen, intervals = capsys.readouterr().out.splitlines()
    assert chosen.startswith("R8L90 {")
    assert intervals.startswith("[[")
