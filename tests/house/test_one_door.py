"""Who reads a file of a user opens it in `user_files` of the base: kept answers count it, and a service keeps to its folders."""

import ast
from collections import Counter

import pytest

from tests.support.places import ROOT

#: Rooms in which files of users are read, and modules that read none of them: locks, sources, the cache.
ROOMS = ("cad_io/read", "plugin/plan_cutters/library", "plugin/plan_cutters/machines", "plugin/plan_cutters/files",
         "plugin/plan_cutters/scene", "plugin/plan_cutters/judging", "plugin/plan_cutters/domain")  # fmt: skip
OTHERS = {f"plugin/plan_cutters/files/{name}.py" for name in ("lock", "markup", "digest", "stage_cache")}
OPENS = {"open", "fdopen", "read_text", "read_bytes", "fromfile", "loadtxt", "genfromtxt", "memmap", "load", "ReadFile", "Read_s",
         "run", "Popen"}  # fmt: skip
#: The CAD kernel opens what `sniff.load` has read and noted; the rest reads bytes that are there already.
KNOWN = {
    "cad_io/read/step.py": {"self.reader.ReadFile": 1},
    "cad_io/read/iges.py": {"self.reader.ReadFile": 1},
    "cad_io/read/read.py": {"BRepTools.Read_s": 1, "BinTools.Read_s": 1, "load": 2},
    "cad_io/read/mesh.py": {"trimesh.load": 1},
    "plugin/plan_cutters/files/content.py": {"archive.open": 1},
    "plugin/plan_cutters/files/arrays.py": {"self._archive.open": 2},
}


def opened(text):
    """Calls by which a module may open a file, each with how often it stands there."""
    calls = (node.func for node in ast.walk(ast.parse(text)) if isinstance(node, ast.Call))
    named = (call for call in calls if isinstance(call, ast.Name | ast.Attribute))
    return Counter(ast.unparse(call) for call in named if ast.unparse(call).rpartition(".")[2] in OPENS)


def test_files_of_users_have_one_door():
    found = {}
    for path in (path for room in ROOMS for path in (ROOT / room).rglob("*.py")):
        name = path.relative_to(ROOT).as_posix()
        if name not in OTHERS and (calls := opened(path.read_text(encoding="utf-8"))):
            found[name] = dict(calls)
    assert found == KNOWN


@pytest.mark.parametrize(
    "line", ["open(f)", "Path(f).read_text()", "np.load(f)", "os.fdopen(os.open(f, 0))", "BRepTools.Read_s(a, f, b)"]
)
def test_another_door_is_seen(line):
    assert opened(f"def read(f):\n    return {line}\n")
