"""A process is started, copied and ended in one place each, and a file takes the place of another one in few."""

import ast
from collections import Counter

import pytest

from tests.support.places import ROOT

#: Calls that start or copy a process, or put a file in place of another.
CALLS = {"subprocess.Popen", "subprocess.run", "subprocess.call", "subprocess.check_output", "os.fork", "os.system", "os.spawnv",
         "os.posix_spawn", "anyio.open_process", "os.killpg", "os.replace", "os.rename", "tempfile.mkstemp"}  # fmt: skip
KNOWN = {
    "plugin/plan_cutters_base/workers/child.py": {"subprocess.Popen": 1, "os.killpg": 1},
    "plugin/plan_cutters_ci/changed.py": {"subprocess.run": 1},  # git
    "plugin/plan_cutters_base/forks.py": {"os.fork": 2},
    "plugin/plan_cutters_base/workers/prompt.py": {"os.fork": 1},  # the copy behind a prompt
    "plugin/plan_cutters_base/whole.py": {"os.replace": 1},
    # All files of a folder at once, or one that is whole already.
    "plugin/plan_cutters_batch/store.py": {"os.rename": 2},
    "plugin/plan_cutters/report/folder.py": {"os.replace": 1},
    "plugin/plan_cutters_base/jit.py": {"os.rename": 1},  # a folder in place of a file of machine code, moved away
}


def called(text):
    names = (node.func for node in ast.walk(ast.parse(text)) if isinstance(node, ast.Call))
    calls = (ast.unparse(name) for name in names if isinstance(name, ast.Attribute))  # each of `CALLS` is of a module
    return Counter(call for call in calls if call in CALLS)


def test_processes_and_whole_files_have_one_way():
    found = {}
    for path in (path for room in ("cad_io", "plugin") for path in (ROOT / room).rglob("*.py")):
        if calls := called(path.read_text(encoding="utf-8")):
            found[path.relative_to(ROOT).as_posix()] = dict(calls)
    assert found == KNOWN


@pytest.mark.parametrize("call", sorted(CALLS))
def test_another_way_is_seen(call):
    assert called(f"def begin(a):\n    return {call}(a)\n")
