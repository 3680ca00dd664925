"""Each slow test has its day: eleven parts are the whole, none is in two, and a mark says why and names what there is."""

import doctest
import os
import shutil
import subprocess
import sys
from types import SimpleNamespace

import pytest

from tests.support import record, slow
from tests.support.places import ROOT

SUITE = """
import pytest

@pytest.mark.slow("long", only=("7", "test_some[8"))
@pytest.mark.parametrize("k", range(10))
def test_some(k): pass

@pytest.mark.slow("needs a program", together="a program")
def test_program(): pass
"""
QUICK = {f"test_some[{k}]" for k in range(10) if k not in (7, 8)}


def items(name, cases, *args, **more):
    """A test of several cases with a mark, as pytest collects it."""
    mark = pytest.mark.slow(*args, **more).mark
    return [
        SimpleNamespace(
            name=f"{name}[{case}]", path="tests/test_a.py", nodeid=f"tests/test_a.py::{name}[{case}]",
            callspec=SimpleNamespace(id=case), iter_markers=lambda _: [mark], user_properties=[],
        )
        for case in cases
    ]  # fmt: skip


@pytest.fixture
def run(tmp_path):
    """A run with these words of the suite."""
    shutil.copy(ROOT / "tests/conftest.py", tmp_path)
    (tmp_path / "test_suite.py").write_text(SUITE)
    environment = {key: value for key, value in os.environ.items() if not key.startswith("PYTEST_")} | {"PYTHONPATH": str(ROOT)}

    def run(*words):
        command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "--rootdir", str(tmp_path), *words]
        return subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)

    return run


def test_a_run_has_what_is_quick_and_its_part_of_what_is_slow(run):
    def collected(*words):
        return {line.partition("::")[2] for line in run("--co", *words).stdout.splitlines() if "::" in line}

    part = f"{slow.part_of('a program')}/{slow.PARTS}"
    assert collected() == QUICK
    assert collected("--slow", part) >= QUICK | {"test_program"}
    done = run("--slow", "all")
    assert f"{len(QUICK) + 3} passed" in done.stdout
    assert "slow tests, all parts: 3 passed, 0 failed, 0 error, 0 skipped, 0 xfailed" in done.stdout


@pytest.mark.parametrize(
    ("more", "quick"),
    [({}, ""), ({"only": ("7", "test_it[8")}, "0123456"), ({"but": ("1", "3")}, "13"), ({"together": "a program"}, "")],
    ids=str,
)
def test_eleven_parts_are_the_whole_and_none_is_in_two(more, quick):
    found = items("test_it", "012345678", "long", **more)
    runs, left = slow.select(found, slow.chosen("none"), whole=True)
    assert "".join(each.callspec.id for each in runs) == quick
    parts = [slow.select(left, frozenset({k}), whole=False)[0] for k in range(slow.PARTS)]
    assert sorted(each.name for part in parts for each in part) == sorted(each.name for each in left)
    if "together" in more:
        assert parts[slow.part_of("a program")] == found
    assert slow.select(found, slow.chosen("all"), whole=True) == (found, [])


@pytest.mark.parametrize(
    ("args", "more", "word"),
    [
        ((), {}, "it takes a reason"),
        ((" ",), {}, "it takes a reason"),
        (("long",), {"only": ("3",)}, "names '3'"),
        (("long",), {"but": ("test_none",)}, "names 'test_none'"),
        (("long",), {"only": "1"}, "give a tuple"),
        (("long",), {"only": ("1",), "but": ("2",)}, "only= or but="),
        (("long",), {"onyl": ("1",)}, "onyl"),
    ],
)
def test_a_mark_without_a_reason_or_with_names_of_nothing_is_refused(args, more, word):
    # A mark without any word is taken for a decorator where it stands, so it has none of its own either.
    found = items("test_it", "12", "long")
    mark = SimpleNamespace(name="slow", args=args, kwargs=more)
    for each in found:
        each.iter_markers = lambda _: [mark]
    with pytest.raises(pytest.UsageError) as refused:
        slow.select(found, slow.chosen("none"), whole=True)
    assert word in str(refused.value)


@pytest.mark.parametrize("text", ["", "some", "11/11", "-1/11", "3/12", "3", "1.5/11"])
def test_a_part_that_there_is_not_is_refused(text):
    with pytest.raises(pytest.UsageError, match="0/11 to 10/11"):
        slow.chosen(text)


@pytest.mark.parametrize("words", [["--record"], ["--record", "--slow", "all", "-k", "long"]], ids=str)
def test_a_record_is_of_a_whole_run(run, words):
    done = run(*words)
    assert done.returncode == pytest.ExitCode.USAGE_ERROR
    assert "whole run" in done.stderr


def test_the_page_keeps_the_newest_runs_and_what_is_red_in_the_last():
    text = ""
    for k in range(record.RUNS + 2):
        text = record.page(text, f"c{k}", "2026-01-02", k, {"passed": 5, "failed": k % 2}, ["tests/a.py::test_b"] * (k % 2))
    rows = [line for line in text.splitlines() if line.startswith("| `")]
    assert [row.split("`")[1] for row in rows] == [f"c{k}" for k in range(record.RUNS + 1, 1, -1)]
    assert text.count("tests/a.py::test_b") == 1
    assert "None." in record.page(text, "d", "2026-01-02", 1.0, {}, [])


def test_a_run_that_is_no_longer_the_answer_is_warned_of(monkeypatch):
    text = record.page("", "abc", "2026-01-02", 1.0, {}, [])
    for count, told in (("0", ""), ("100", ""), ("101", "101 commits old"), ("", "no commit of this history")):
        monkeypatch.setattr(record, "git", lambda *_, count=count: count)
        assert (told in record.behind(text)) == bool(told) or record.behind(text) == told
    assert "has no whole run" in record.behind("")


@pytest.mark.parametrize("module", [record, slow], ids=["record", "slow"])
def test_examples_of_the_docstrings(module):
    assert doctest.testmod(module).failed == 0
