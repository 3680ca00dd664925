"""The fingerprint of a module changes with what it means and with what it imports, and with nothing else."""

import os
import re
import shutil
import subprocess
import sys
import zipfile

import pytest

from tests.support.forked import ENV
from tests.support.places import ROOT

OURS = ("cad_io", "plan_cutters", "plan_cutters_base")
#: In a process of its own, as every run: the fingerprints of all modules with machine code.
LOOK = """
import sys
from pathlib import Path
from plan_cutters_base.fingerprint import fingerprint
root, notes = sys.argv[1], None if sys.argv[2] == "none" else Path(sys.argv[2])
for name in sys.argv[3:]:
    file = f"{root}/{name.replace('.', '/')}.py"
    package = name.rpartition(".")[0]
    print(name, fingerprint(name, package, file, frozenset({"cad_io", "plan_cutters", "plan_cutters_base"}), notes))
"""
SEARCH, HIT, CODES, MAP, REFINE = (
    "plan_cutters.kernels.search.search",
    "plan_cutters.kernels.tool.hit",
    "plan_cutters.kernels.codes",
    "plan_cutters.kernels.maps.free_map",
    "cad_io.tessellate.refine",
)


@pytest.fixture
def sources(tmp_path):
    """A copy of our sources."""
    for package in (ROOT / "cad_io", ROOT / "plugin" / "plan_cutters", ROOT / "plugin" / "plan_cutters_base"):
        shutil.copytree(package, tmp_path / "sources" / package.name, ignore=shutil.ignore_patterns("__pycache__", "*.js"))
    return tmp_path / "sources"


def with_machine_code(sources):
    rooms = ("plan_cutters/kernels/**", "cad_io/surface", "cad_io/tessellate")
    files = [file for room in rooms for file in sources.glob(f"{room}/*.py")]
    names = [".".join(file.relative_to(sources).with_suffix("").parts) for file in sorted(files)]
    return [name for name in names if re.search("^@(entry|kernel)$", file_of(sources, name).read_text(), re.M)]


def file_of(sources, name):
    return sources.joinpath(*name.split(".")).with_suffix(".py")


def looked(sources, names, notes="none", path=None):
    done = subprocess.run([sys.executable, "-c", LOOK, str(path or sources), str(notes), *names], capture_output=True, text=True,
                          check=True, env={**ENV, "PYTHONPATH": str(path or sources)}, cwd=sources.parent)  # fmt: skip
    return dict(line.split() for line in done.stdout.splitlines())


def edit(sources, name, old, new):
    file = file_of(sources, name)
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new, 1))


def changed(before, after):
    return {name for name in before if before[name] != after[name]}


def imports(text, name):
    package, _, stem = name.rpartition(".")
    for line in map(str.strip, text.splitlines()):
        if line.startswith((f"from {name} import ", f"import {name}")):
            return True
        if line.startswith(f"from {package} import ") and stem in line.replace(",", " ").split():
            return True
    return False


def users(sources, name):
    """Modules that import one at any distance, by the text of their lines: as slow and as plain as can be."""
    packages = [sources / each for each in OURS]
    text = {".".join(f.relative_to(sources).with_suffix("").parts).removesuffix(".__init__"): f.read_text()
            for package in packages for f in package.rglob("*.py")}  # fmt: skip
    found = {name}
    while True:
        more = {each for each in text.keys() - found if any(imports(text[each], one) for one in found)}
        if not more:
            return found
        found |= more


@pytest.mark.slow("imports the package anew")
def test_words_and_blank_lines_change_nothing(sources):
    names = with_machine_code(sources)
    assert len(names) > 20
    before = looked(sources, names)
    for file in sources.rglob("*.py"):
        text = file.read_text()
        if text.startswith('"""'):
            text = '"""Another word, ' + text.removeprefix('"""')
        file.write_text("# A remark.\n\n" + text + "\n\n# The end.\n")
    assert looked(sources, names) == before


@pytest.mark.slow("copies the sources for each change", but=("map",))
@pytest.mark.parametrize(("name", "old", "new"), [
    (SEARCH, "_FINEST = 1e-5", "_FINEST = 1e-6"),
    (HIT, "return", "1 + 1\n    return"),
    (CODES, "= 1", "= 1 + 0"),
    (MAP, "import numpy as np", "import numpy as np\n_NEW = 1"),
    ("cad_io.surface.bspline", "import numpy as np", "import numpy as np\n_NEW = 1"),
    ("plan_cutters_base.jit", "_CHECKSUM = 32", "_CHECKSUM = 16"),
], ids=["search", "hit", "codes", "map", "bspline", "jit"])  # fmt: skip
def test_a_change_counts_for_the_module_and_its_users_alone(sources, name, old, new):
    names = with_machine_code(sources)
    before = looked(sources, names)
    edit(sources, name, old, new)
    those = users(sources, name) & set(names)
    assert those
    assert changed(before, looked(sources, names)) == those


@pytest.mark.slow("runs each form from an archive once more", only=("True",))
@pytest.mark.parametrize("line", [
    "from . import beneath",
    "from .beneath import NUMBER",
    "from room import beneath",
    "import room.beneath",
    "from room.beneath import NUMBER as number",
    "from .deep.far import NUMBER",
    "from . import NUMBER",
    "from .beneath import *",
    "def f():\n    from room.beneath import NUMBER\n    return NUMBER",
    "def f():\n    from .deep import far\n    return far",
    "if 1 > 2:\n    import room.beneath as b",
    "try:\n    from room.deep import far\nexcept ImportError:\n    far = None",
])  # fmt: skip
@pytest.mark.parametrize("zipped", [False, True])
def test_every_form_of_import_is_seen(tmp_path, line, zipped):
    """Of `beneath`, whose number changes, each imports it, at some distance."""
    look = (
        "import sys; from plan_cutters_base.fingerprint import fingerprint\n"
        "print(fingerprint('room.above', 'room', f'{sys.path[1]}/room/above.py', frozenset({'room'})))"
    )

    def printed(number):
        folder = tmp_path / f"{number}"
        texts = {"__init__": "from .beneath import NUMBER", "above": line, "beneath": f"NUMBER = {number}", "other": "",
                 "deep/__init__": "", "deep/far": "from ..beneath import NUMBER"}  # fmt: skip
        if zipped:
            with zipfile.ZipFile(tmp_path / f"{number}.zip", "w") as archive:
                for name, text in texts.items():
                    archive.writestr(f"room/{name}.py", text)
            folder = tmp_path / f"{number}.zip"
        else:
            (folder / "room" / "deep").mkdir(parents=True, exist_ok=True)
            for name, text in texts.items():
                (folder / "room" / f"{name}.py").write_text(text)
        run = [sys.executable, "-c", look]
        return subprocess.run(run, env={**ENV, "PYTHONPATH": f"{folder}{os.pathsep}{ROOT / 'plugin'}"}, cwd=tmp_path, check=True,
                              capture_output=True, text=True).stdout  # fmt: skip

    assert printed(1) == printed(1) != printed(2)


@pytest.mark.slow("imports the package anew")
def test_notes_change_no_fingerprint(sources, tmp_path):
    """Whether they are missing, there, damaged or cannot be written."""
    names, notes = [SEARCH, REFINE], tmp_path / "notes"
    truth = looked(sources, names)
    assert looked(sources, names, notes) == looked(sources, names, notes) == truth
    for note in notes.iterdir():
        note.write_bytes(note.read_bytes().replace(b"cad_io", b"cad_xo")[:-3])
    assert looked(sources, names, notes) == truth
    (tmp_path / "no folder").write_text("")
    assert looked(sources, names, tmp_path / "no folder") == truth


def test_a_note_is_never_out_of_date(sources, tmp_path):
    """Even where a source changes while its size and its time stay."""
    file = file_of(sources, CODES)
    before, time = looked(sources, [SEARCH], tmp_path / "notes"), file.stat()
    edit(sources, CODES, "ACCESSIBLE", "ACCESSIBLF")
    os.utime(file, ns=(time.st_atime_ns, time.st_mtime_ns))
    assert file.stat().st_size == time.st_size
    assert looked(sources, [SEARCH], tmp_path / "notes") != before


def test_two_versions_side_by_side_have_each_its_own(sources, tmp_path):
    other = tmp_path / "other"
    shutil.copytree(sources, other)
    edit(other, HIT, "return", "1 + 1\n    return")
    names, notes = [SEARCH, MAP], tmp_path / "notes"
    one, two = looked(sources, names, notes), looked(other, names, notes)
    assert (looked(sources, names, notes), looked(other, names, notes)) == (one, two)
    assert one[SEARCH] != two[SEARCH]


def test_without_its_source_a_module_has_none(tmp_path):
    assert looked(tmp_path, ["nowhere"], path=ROOT / "plugin") == {"nowhere": "None"}


@pytest.mark.slow("imports the package anew")
def test_the_kernels_import_no_module_by_a_computed_name():
    """Such an import is not seen: none of the modules that machine code is made of may hide one."""
    script = (
        "from plan_cutters_base import fingerprint as f\n"
        "import plan_cutters.kernels.search.search, plan_cutters.kernels.maps.free_map\n"
        "import plan_cutters.kernels.area.cover, cad_io.tessellate.refine, cad_io.surface.bspline, cad_io.tessellate.planar\n"
        "import cad_io.surface.differential, inspect\n"
        "from plan_cutters_base.jit import cache_folder\n"
        "seen, ahead = set(), [n for n, m in __import__('sys').modules.items() if hasattr(m, 'kernel') and hasattr(m, 'entry')]\n"
        "while ahead:\n"
        "    each = ahead.pop()\n"
        "    if each not in seen:\n"
        "        seen.add(each); ahead += f._direct(each, frozenset(f.PROGRAM), None)[1]\n"
        "print(*seen)"
    )
    done = subprocess.run([sys.executable, "-c", script], env=ENV, cwd=ROOT, capture_output=True, text=True, check=True)
    seen = done.stdout.split()
    assert {SEARCH, CODES, "cad_io.tessellate.bounds"} <= set(seen)
    for name in seen:
        (text,) = [
            file.read_text()
            for root in (ROOT / "plugin", ROOT)
            for file in (file_of(root, name), file_of(root, f"{name}.__init__"))
            if file.exists()
        ]
        assert not re.search(r"import_module\(|__import__\(|exec\(|def __getattr__", text), name
