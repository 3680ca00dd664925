"""Kernels are linked into entries, and only entries are made machine code."""

import ast
import os
import subprocess
import sys

import pytest

from cad_io.jit import cache_folder
from tests.support.forked import ENV

SOURCE = """
import sys
import numpy as np
from cad_io.jit import decorators

entry, kernel = decorators(__file__)

@kernel
def deepest(x):
    return np.sqrt(x) + 1.0

@kernel
def middle(x, i):
    return deepest(x[i]) * 2.0

@entry
def total(x):
    found = 0.0
    for i in range(len(x)):
        found += middle(x, i)
    return found

@entry
def first(x):
    return middle(x, 0)
"""

RUN = """
from llvmlite.binding import ObjectFileRef
import kernels_of_test as k

def told(each):
    code = 0
    for made in each.overloads.values():
        kept = made.library.serialize_using_object_code()[2][0] if sum(each.stats.cache_misses.values()) else None
        code = None if kept is None else sum(s.size() for s in ObjectFileRef.from_data(kept).sections() if s.is_text())
    return code, sum(each.stats.cache_misses.values()), sum(each.stats.cache_hits.values())

x = k.np.array([4.0, 9.0])
print([{call}], {{each: told(getattr(k, each)) for each in ("deepest", "middle", "total", "first")}})
"""


@pytest.fixture
def run(tmp_path):
    (tmp_path / "kernels_of_test.py").write_text(SOURCE)
    environment = {**ENV, "NUMBA_CACHE_DIR": str(tmp_path / "cache"), "PYTHONPATH": str(tmp_path)}

    def run(call):
        said = subprocess.run(
            [sys.executable, "-c", RUN.format(call=call)], env=environment, capture_output=True, text=True, check=True
        ).stdout
        values, rest = said.split("] ", 1)
        return ast.literal_eval(values + "]"), ast.literal_eval(rest)

    return run


def test_only_entries_are_made_machine_code(run):
    value, told = run("k.total(x)")
    assert value == [14.0]
    assert told["total"][0] > 0
    assert told["deepest"][0] == told["middle"][0] == 0
    assert [told[name][1] for name in ("deepest", "middle", "total", "first")] == [1, 1, 1, 0]


def test_a_kernel_that_is_kept_is_linked_into_the_next_entry(run):
    run("k.total(x)")
    assert run("k.total(x)")[1]["total"][1:] == (0, 1)
    value, told = run("k.first(x), k.total(x)")
    assert value == [6.0, 14.0]
    assert told["first"][0] > 0
    assert told["middle"][1:] == (0, 1)


def test_python_calls_a_kernel(run):
    for _ in range(2):
        assert run("k.middle(x, 1), k.deepest(4.0), k.deepest(9), k.first(x)")[0] == [8.0, 3.0, 4.0, 6.0]


def test_the_same_sources_elsewhere_and_later_are_not_compiled_again(tmp_path):
    """As in another environment, or in a new checkout: its files have other places and other times."""
    told = []
    for k, place in enumerate(("one", "two")):
        room = tmp_path / place / "room"
        room.mkdir(parents=True)
        (room / "kernels_of_test.py").write_text(SOURCE)
        os.utime(room / "kernels_of_test.py", (1e9 + k, 1e9 + k))
        environment = {**ENV, "NUMBA_CACHE_DIR": str(tmp_path / "cache"), "PYTHONPATH": str(room)}
        done = subprocess.run([sys.executable, "-c", RUN.format(call="k.total(x)")], env=environment, capture_output=True,
                              text=True, check=True)  # fmt: skip
        told.append(ast.literal_eval(done.stdout.split("] ", 1)[1])["total"][1:])
    assert told == [(1, 0), (0, 1)]


def test_sources_in_rooms_below_count(tmp_path, monkeypatch):
    """A kernel in one room calls those in others: what changes in any of them must not be answered by old machine code."""
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "cache"))
    room = tmp_path / "sources" / "room"
    room.mkdir(parents=True)
    (tmp_path / "sources" / "jit.py").write_text("")
    folders = []
    for name, text in (("a.py", "x = 1"), ("a.py", "x = 2"), ("b.py", "x = 2")):
        for old in room.iterdir():
            old.unlink()
        (room / name).write_text(text)
        folders.append(cache_folder.__wrapped__(tmp_path / "sources"))
    assert len(set(folders)) == 3
