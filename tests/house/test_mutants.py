"""Faults that the tests of a room are tried with are what they say, a seed gives the same ones, and a test that fails is seen."""

import ast
import json
import os
import subprocess

import pytest

from tests.mutants import __main__ as tried
from tests.mutants.faults import drawn, places
from tests.mutants.plugins import Verdict

#: A statement in a function, and all that it may become.
CHANGED = {
    "a < b": {"a <= b", "a > b"},
    "a <= b < c": {"a < b < c", "a <= b <= c", "a <= b > c"},
    "a == b": {"a != b"},
    "a is b": {"a is not b"},
    "a + b": {"a - b"},
    "a / b": {"a * b"},
    "a & b": {"a | b"},
    "-a": {"a"},
    "not a": {"a"},
    "a and b": {"a or b"},
    "np.minimum(a, b)": {"np.maximum(a, b)", "pass"},
    "min(a, b)": {"max(a, b)", "pass"},
    "abs(a)": {"a", "pass"},
    "np.nextafter(a, b)": {"a", "pass"},
    "3": {"4", "2"},
    "0": {"1"},
    "True": {"False"},
    "5.0": {"5.05", "10.0"},
    "1e-06": {"0.0", "2e-06"},
    "a[i]": {"a[i + 1]"},
    "a[1]": {"a[2]", "a[0]"},
    "a += b": {"pass"},
    "f(a)": {"pass"},
    "raise ValueError('above 3')": {"pass"},
    "return a - b": {"return a + b", "return -(a - b)"},
    "a if b else c": {"a if True else c", "a if False else c"},
    "[a for a in b if c]": {"[a for a in b if True]"},
    "lambda a=2: a": {"lambda a=1: a", "lambda a=3: a"},
    # These are texts, types and sizes.
    "f'{a + 1}'": set(),
    "a: tuple[3] = b": set(),
    "chunk: int = 3": set(),
    "f(chunk=3) + b": {"f(chunk=3) - b"},
    "warnings.warn('a', stacklevel=2)": set(),
    "isinstance(a, b | c)": {"pass"},
    "a + 'b'": set(),
}


def changes(statement):
    source = f"def f():\n    'Of 3.'\n    {statement}\n".encode()
    return [(each, each.applied(source)) for place in places("m.py", source) for each in place], source


@pytest.mark.parametrize("statement", CHANGED)
def test_each_fault_changes_a_statement_in_its_way(statement):
    found, _ = changes(statement)
    become = {ast.unparse(ast.parse(text).body[0].body[1]) for _, text in found}
    assert become == {ast.unparse(ast.parse(each)) for each in CHANGED[statement]}
    assert {each.lines for each, _ in found} <= {(3, 3)}


def test_a_fault_of_a_module_or_of_a_default_is_run_by_whoever_imports_it():
    source = b'__all__ = ["f"]\nLIMIT = 3\nCHUNK = 5\nWord = int | str\ndef f(a=True):\n    return a\n'
    assert [[(each.line, each.lines, each.after) for each in place] for place in places("m.py", source)] == [
        [(2, (0, 0), "(4)"), (2, (0, 0), "(2)")],
        [(5, (0, 0), "(False)")],
    ]


def test_a_seed_draws_the_same_faults_from_every_place_once(tmp_path):
    (tmp_path / "m.py").write_text("def f(a, b):\n    if a < b + 0:\n        return a * 2\n    return b * 2 - a\n")
    first, again, other = ([each.name for each in drawn(tmp_path, ["m.py"], seed)] for seed in ("1", "1", "2"))
    assert first == again != other
    every = places("m.py", (tmp_path / "m.py").read_bytes())
    assert len(first) == len(set(first)) == len(every)
    assert all(sum(fault.name in first for fault in place) == 1 for place in every)


def test_what_is_compiled_to_the_same_is_no_fault(tmp_path):
    (tmp_path / "m.py").write_text("def f():\n    return 1**1\n")
    names = [each.name for each in drawn(tmp_path, ["m.py"], "1")]
    assert names
    assert not any("-> (1 * 1)" in name for name in names)


FUNCTION = "def larger(a, b):\n    if a > b:\n        return a\n    return b\n"
TEST = """
from plan_cutters.m import larger

def test_of_two():
    assert larger(1, 2) == larger(2, 1) == 2

def test_of_none():
    pass
"""


@pytest.fixture(scope="module")
def checkout(tmp_path_factory):
    """A small checkout with one function and its tests."""
    root = tmp_path_factory.mktemp("checkout")
    files = {
        "plugin/plan_cutters/__init__.py": "",
        "plugin/plan_cutters/m.py": FUNCTION,
        "cad_io/__init__.py": "",
        "tests/__init__.py": "",
        "tests/room/test_m.py": TEST,
        "pyproject.toml": '[tool.pytest.ini_options]\npythonpath = ["plugin", "."]\n',
    }
    for name, text in files.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text)
    subprocess.run(["git", "init", "-q"], cwd=root, check=True)
    return root


@pytest.fixture
def reached(checkout, tmp_path, monkeypatch):
    monkeypatch.setattr(tried, "ROOT", checkout)
    (tmp_path / "common").mkdir()
    return tried.reach(["tests/room"], tmp_path)


def verdicts(reached, tmp_path):
    copy = tried.Copy(tmp_path, 1)
    found = drawn(tried.ROOT, ["plugin/plan_cutters/m.py"], "1")
    return {(each.before, each.after): tried.judged(each, copy, reached) for each in found}


def rewritten(copy, text):
    """Put a source in the place of another one of the same second, and perhaps of the same length: no byte code is older."""
    place = copy.folder / "plugin/plan_cutters/m.py"
    place.write_text(text)
    os.utime(place, (1e9, 1e9))


def test_a_fault_that_a_test_notices_is_killed_by_it(reached, tmp_path):
    tests = reached["tests/room/test_m.py"]["tests"]
    lines = {test.rpartition("::")[2]: each["lines"] for test, each in tests.items()}
    assert lines["test_of_two"] == {"plugin/plan_cutters/m.py": f"{1 << 1 | 1 << 2 | 1 << 3 | 1 << 4:x}"}
    assert lines["test_of_none"] == {}
    rows = verdicts(reached, tmp_path)
    assert rows
    for (_, after), row in rows.items():
        # Of equals either is the larger one.
        assert row["verdict"] == (tried.SURVIVED if after == "(a >= b)" else tried.KILLED), row
        assert row["verdict"] == tried.SURVIVED or row["by"].endswith("::test_of_two (1.)")
    copy = tried.Copy(tmp_path, 2)
    assert tried.void(list(rows.values()), copy) == ""
    rewritten(copy, FUNCTION.replace(">", "<"))
    assert tried.void(list(rows.values()), copy) == "tests/room/test_m.py::test_of_two (1.)"


@pytest.mark.slow("reads all files")
def test_in_functions_that_are_there_a_fault_is_the_same(reached, tmp_path):
    """Each is put into a copy of a process that has collected the tests."""
    faults, out = list(drawn(tried.ROOT, ["plugin/plan_cutters/m.py"], "1")), tmp_path / "out"
    assert all(tried.soon(each, reached) for each in faults)
    process = os.fork()
    if process == 0:
        tried.work(faults, tried.Copy(tmp_path, 1), reached, 60.0, {"room": "room"}, out)
    os.waitpid(process, 0)
    rows = [json.loads(line) for line in out.read_text().splitlines()]
    assert {(row["before"], row["after"]): row["verdict"] for row in rows} == {
        key: row["verdict"] for key, row in verdicts(reached, tmp_path).items()
    }


def test_functions_get_the_code_of_another_source(tmp_path, monkeypatch):
    source = """from functools import cache
@cache
def f(a):
    return [x + 1 for x in a]
class C:
    def f(self):
        return 3
"""
    (tmp_path / "swapped_module.py").write_text(source)
    monkeypatch.syspath_prepend(tmp_path)
    import swapped_module

    f, method = swapped_module.f, swapped_module.C().f
    tried.swapped(tmp_path / "swapped_module.py", source.replace("x + 1", "(\n x - 1)").replace("3", "4").encode())
    assert (f((1, 2)), method()) == ([0, 1], 4)


def test_a_test_that_takes_too_long_is_ended(reached, tmp_path, monkeypatch):
    copy = tried.Copy(tmp_path, 1)
    rewritten(copy, FUNCTION.replace("if", "while").replace("return a", "a + b"))
    note, test = tmp_path / "note", "tests/room/test_m.py::test_of_two"
    assert copy.run(["tests/room/test_m.py"], Verdict([test], [], {test: 0.3}, note), tmp_path / "result") is None
    assert note.read_text() == f"{test} (1.)"


def test_a_fault_that_no_test_runs_survives_without_one(tmp_path, reached):
    (fault,) = (each for each in drawn(tried.ROOT, ["plugin/plan_cutters/m.py"], "1") if each.kind == "condition")
    assert tried.ordered(reached, fault)[0] == ["tests/room/test_m.py"]
    assert tried.ordered(reached, fault._replace(lines=(9, 9)))[0] == []


def test_equivalents_have_a_reason_each():
    text = tried.EQUIVALENT.read_text(encoding="utf-8").splitlines()
    assert [line for line in text if line and not line.startswith("#")] == [
        line for name, why in tried.equivalents().items() for line in (name, f"  {why}")
    ]


def test_the_table_counts_equivalents_apart(monkeypatch):
    monkeypatch.setattr(tried, "equivalents", lambda: {"same": "nobody sees it"})
    rows = [{"room": "room", "verdict": verdict, "name": name, "seconds": 2.0} for verdict, name in (
        (tried.KILLED, "a"), (tried.TIMED_OUT, "b"), (tried.SURVIVED, "same"), (tried.SURVIVED, "c"))]  # fmt: skip
    assert tried.table(rows).splitlines()[-1] == "| room | 4 | 1 | 1 | 2 | 1 | 50 % | 66 % | 8 |"
