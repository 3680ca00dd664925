"""Kernels are linked into entries, and only entries are made machine code."""

import ast
import errno
import importlib.util
import os
import shutil
import subprocess
import sys
import tempfile
import warnings
import zipfile
from pathlib import Path

import numpy as np
import pytest

from plan_cutters_base import jit
from plan_cutters_base.jit import cache_folder
from tests.support.forked import ENV
from tests.support.places import ROOT

SOURCE = """
import sys
import tempfile
import numpy as np
from plan_cutters_base.jit import entry, kernel

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
    environment = {**ENV, "NUMBA_CACHE_DIR": str(tmp_path / "cache"), "PYTHONPATH": f"{tmp_path}{os.pathsep}{ROOT / 'plugin'}"}

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


@pytest.mark.slow("compiles anew in processes of its own")
def test_a_kernel_that_is_kept_is_linked_into_the_next_entry(run):
    run("k.total(x)")
    assert run("k.total(x)")[1]["total"][1:] == (0, 1)
    value, told = run("k.first(x), k.total(x)")
    assert value == [6.0, 14.0]
    assert told["first"][0] > 0
    assert told["middle"][1:] == (0, 1)


@pytest.mark.slow("compiles kernels")
def test_python_calls_a_kernel(run):
    for _ in range(2):
        assert run("k.middle(x, 1), k.deepest(4.0), k.deepest(9), k.first(x)")[0] == [8.0, 3.0, 4.0, 6.0]


@pytest.mark.slow("compiles anew in processes of its own")
def test_the_same_sources_elsewhere_and_later_are_not_compiled_again(tmp_path):
    """As in another environment, or in a new checkout: its files have other places and other times."""
    told = []
    for k, place in enumerate(("one", "two")):
        room = tmp_path / place / "room"
        room.mkdir(parents=True)
        (room / "kernels_of_test.py").write_text(SOURCE)
        os.utime(room / "kernels_of_test.py", (1e9 + k, 1e9 + k))
        environment = {**ENV, "NUMBA_CACHE_DIR": str(tmp_path / "cache"), "PYTHONPATH": f"{room}{os.pathsep}{ROOT / 'plugin'}"}
        done = subprocess.run([sys.executable, "-c", RUN.format(call="k.total(x)")], env=environment, capture_output=True,
                              text=True, check=True)  # fmt: skip
        told.append(ast.literal_eval(done.stdout.split("] ", 1)[1])["total"][1:])
    assert told == [(1, 0), (0, 1)]


@pytest.mark.slow("compiles anew in processes of its own")
def test_a_line_above_a_function_is_no_other_function(run, tmp_path):
    run("k.total(x)")
    source = (tmp_path / "kernels_of_test.py").read_text()
    (tmp_path / "kernels_of_test.py").write_text(source.replace("import sys", "# A remark.\n\n\nimport sys"))
    assert [told[1:] for told in run("k.total(x)")[1].values()] == [(0, 0), (0, 0), (0, 1), (0, 0)]


TWO = """
import sys
import numpy as np
from plan_cutters_base.jit import entry, kernel
if len(sys.argv) > 1:
    @entry
    def number():
        return 1
else:
    @entry
    def number():
        return 2

print(number())
"""


@pytest.mark.slow("compiles anew in processes of its own")
def test_two_functions_under_one_name_are_two(tmp_path):
    """Sources alone do not tell which of them a process defines."""
    (tmp_path / "two.py").write_text(TWO)
    environment = {**ENV, "NUMBA_CACHE_DIR": str(tmp_path / "cache")}
    for words, value in ((["other"], "1"), ([], "2"), (["other"], "1")):
        done = subprocess.run([sys.executable, str(tmp_path / "two.py"), *words], env=environment, capture_output=True,
                              text=True, check=True)  # fmt: skip
        assert done.stdout.strip() == value


@pytest.mark.slow("compiles in several processes")
def test_kernels_in_an_archive_are_compiled_once_and_by_what_stands_there(tmp_path):
    def total(one):
        with zipfile.ZipFile(tmp_path / "room.zip", "w") as archive:
            archive.writestr("kernels_of_test.py", SOURCE.replace("+ 1.0", f"+ {one}"))
        environment = {**ENV, "NUMBA_CACHE_DIR": str(tmp_path / "cache"), "PYTHONPATH": str(tmp_path / "room.zip")}
        done = subprocess.run([sys.executable, "-c", RUN.format(call="k.total(x)")], env=environment, capture_output=True,
                              text=True, check=True)  # fmt: skip
        value, told = done.stdout.split("] ", 1)
        return ast.literal_eval(value + "]"), ast.literal_eval(told)["total"][1:]

    assert [total(one) for one in ("1.0", "1.0", "2.0", "1.0")] == [
        ([14.0], (1, 0)), ([14.0], (0, 1)), ([18.0], (1, 0)), ([14.0], (0, 1)),
    ]  # fmt: skip


def test_machine_code_of_a_module_without_its_source_is_not_shared(tmp_path, monkeypatch):
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "cache"))
    folder, lasts = cache_folder.__wrapped__("bare", "", str(tmp_path / "bare.pyc"))
    assert not lasts
    assert not Path(folder).is_relative_to(tmp_path / "cache")


@pytest.fixture
def loaded(tmp_path, monkeypatch):
    """Import the kernels anew, as a later process does; the entry that was requested, its hits, and what was warned of."""
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "cache"))
    (tmp_path / "sources").mkdir()
    source = tmp_path / "sources" / "kernels_of_test.py"
    source.write_text(SOURCE)

    def load(x=(4.0, 9.0), writable=True):
        monkeypatch.setattr(jit, "_warned", set())
        spec = importlib.util.spec_from_file_location("kernels_of_test", source)
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        numbers = np.array(x)
        numbers.setflags(write=writable)
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            found = module.total(numbers)
        return found, sum(module.total.stats.cache_hits.values()), [str(each.message) for each in caught]

    return load


def cached(folder, pattern):
    (found,) = folder.glob(f"cache/plan-cutters/kernels_of_test/*/{pattern}")
    return found


def middle_zeroed(content):
    half = len(content) // 2
    return content[:half] + bytes(64) + content[half + 64 :]


DAMAGES = {
    "empty": lambda content: b"",
    "cut off": lambda content: content[: len(content) // 2],
    "last byte": lambda content: content[:-1],
    "zeros": middle_zeroed,
}


@pytest.mark.parametrize("kind", ["nbi", "nbc"])
@pytest.mark.parametrize("damage", list(DAMAGES))
def test_damaged_machine_code_is_not_run_but_made_anew(loaded, tmp_path, kind, damage):
    assert loaded() == (14.0, 0, [])
    assert loaded() == (14.0, 1, [])
    file = cached(tmp_path, f"*.total-*.{kind}")
    file.write_bytes(DAMAGES[damage](file.read_bytes()))
    value, hits, (said,) = loaded()
    assert (value, hits) == (14.0, 0)
    assert str(file) in said
    assert "is damaged" in said
    assert "\n" not in said
    assert loaded() == (14.0, 1, [])


def test_each_damaged_file_is_warned_of_once_in_a_process(loaded, tmp_path):
    loaded()
    for file in (tmp_path / "cache").rglob("*.nbi"):
        file.write_bytes(b"")
    assert len(loaded()[2]) == 1
    assert loaded() == (14.0, 1, [])


def test_missing_machine_code_is_no_damage(loaded, tmp_path):
    loaded()
    cached(tmp_path, "*.total-*.nbc").unlink()
    assert loaded() == (14.0, 0, [])
    assert loaded() == (14.0, 1, [])


def test_a_pipe_in_place_of_machine_code_is_not_opened(loaded, tmp_path):
    loaded()
    file = cached(tmp_path, "*.total-*.nbi")
    file.unlink()
    os.mkfifo(file)
    value, hits, (said,) = loaded()
    assert (value, hits) == (14.0, 0)
    assert "no regular file" in said
    assert loaded() == (14.0, 1, [])


@pytest.mark.parametrize("kind", ["nbi", "nbc"])
def test_a_folder_in_place_of_machine_code_is_one_line_and_moved_away_once(loaded, tmp_path, kind):
    loaded()
    file = cached(tmp_path, f"*.total-*.{kind}")
    file.unlink()
    file.mkdir()
    (file / "note").write_text("not ours")
    value, hits, (said,) = loaded()
    assert (value, hits) == (14.0, 0)
    assert str(file) in said
    assert "no regular file" in said
    assert loaded() == (14.0, 1, [])
    assert [note.read_text() for note in file.parent.glob(f"{file.name}.*/note")] == ["not ours"]


def test_a_full_disk_costs_time_alone(loaded, tmp_path, monkeypatch):
    def full(*_):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with monkeypatch.context() as patch:
        patch.setattr(os, "replace", full)
        value, hits, (said,) = loaded()
    assert (value, hits) == (14.0, 0)
    assert "cannot be cached (No space left on device)" in said
    assert not any((tmp_path / "cache").rglob("*.tmp.*"))
    assert loaded() == (14.0, 0, [])
    assert loaded() == (14.0, 1, [])


def test_a_cache_that_disappears_costs_time_alone(loaded, tmp_path):
    loaded()
    shutil.rmtree(tmp_path / "cache")
    (tmp_path / "cache").write_text("a file")
    value, hits, (said,) = loaded()
    assert (value, hits) == (14.0, 0)
    assert "cannot be cached" in said


def test_an_entry_under_the_name_of_another_one_is_not_run(loaded, tmp_path):
    """Two processes that add to an index at a time may both call their first entry the first one."""
    loaded()
    first = cached(tmp_path, "*.total-*.1.nbc")
    loaded(writable=False)
    second = cached(tmp_path, "*.total-*.2.nbc")
    second.write_bytes(first.read_bytes())
    assert loaded(writable=False) == (14.0, 0, [])
    assert loaded(writable=False) == (14.0, 1, [])
    assert loaded() == (14.0, 1, [])


def folder_of(tmp_path):
    (tmp_path / "room.py").write_text("")
    return Path(cache_folder.__wrapped__("room", "", str(tmp_path / "room.py"))[0])


@pytest.fixture
def no_home(tmp_path, monkeypatch):
    """A user who is not registered, as in many containers; temporary files lie in `tmp`."""
    for name in ("NUMBA_CACHE_DIR", "XDG_CACHE_HOME"):
        monkeypatch.delenv(name, raising=False)

    def none():
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.setattr(Path, "home", none)
    (tmp_path / "tmp").mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "tmp"))
    jit._of_this_process.cache_clear()
    yield tmp_path / "tmp"
    jit._of_this_process.cache_clear()


def test_without_a_home_machine_code_lies_among_temporary_files(tmp_path, no_home):
    folder = folder_of(tmp_path)
    assert folder.parents[1] == no_home / f"plan-cutters-{os.getuid()}"
    assert folder.parents[1].stat().st_mode & 0o777 == 0o700
    assert folder_of(tmp_path) == folder


def test_what_another_user_put_among_temporary_files_is_not_run(tmp_path, no_home, monkeypatch):
    theirs = folder_of(tmp_path)
    user = os.getuid()
    monkeypatch.setattr(os, "getuid", lambda: user + 1)
    theirs.parents[1].rename(no_home / f"plan-cutters-{user + 1}")
    found = folder_of(tmp_path)
    assert found.parent == no_home
    assert found.name.startswith("plan-cutters-")


def test_where_nothing_can_be_written_it_works_without_a_cache(loaded, no_home, monkeypatch):
    def none(**_):
        raise OSError(errno.EROFS, os.strerror(errno.EROFS))

    monkeypatch.setattr(os, "access", lambda *_: False)
    monkeypatch.setattr(tempfile, "mkdtemp", none)
    monkeypatch.setenv("NUMBA_CACHE_DIR", "/proc/nowhere")
    value, hits, (said,) = loaded()
    assert (value, hits) == (14.0, 0)
    assert "cannot be cached" in said
