"""What stages made is found again if nothing that it follows from has changed, and is made anew if it is damaged."""

import hashlib
import math
import os
import pickle
import stat
from pathlib import Path
from typing import ClassVar

import numpy as np
import pytest

import cad_io
import plan_cutters
from plan_cutters_base import stage_cache
from plan_cutters_base.stage_cache import NO_CACHE, RunCache, StageCache, settle
from plan_cutters_base.user_cache import CacheWarning
from plan_cutters_base.values import sources


@pytest.fixture(autouse=True)
def _worth(monkeypatch):
    monkeypatch.setattr(stage_cache, "_WORTH", 0.0)


@pytest.fixture
def cache(tmp_path):
    folder = tmp_path / "stages"
    folder.mkdir(mode=0o700)
    return StageCache(folder)


def made(cache, follows_from, value=1.0, **more):
    """What is kept, and how often it was made."""
    calls = []

    def make():
        calls.append(1)
        return np.full(5, value)

    result = cache.cached("stage", follows_from, make, **more)
    settle()
    return result, len(calls)


def entries(cache):
    return sorted(cache.folder.iterdir())


def test_the_same_is_made_once(cache):
    follows_from = [np.arange(3.0), {"a": 1}, None, "x"]
    first, once = made(cache, follows_from)
    again, twice = made(cache, [np.arange(3.0), {"a": 1}, None, "x"], 2.0)
    assert (once, twice) == (1, 0)
    assert np.array_equal(first, again)
    assert cache.holds("stage", follows_from)
    assert again.flags.writeable


@pytest.mark.parametrize("other", [[np.arange(3.0), 2], [np.arange(3), 1], [np.arange(4.0), 1], [-np.arange(3.0), 1], []])
def test_anything_else_is_made_anew(cache, other):
    made(cache, [np.arange(3.0), 1])
    assert not cache.holds("stage", other)
    assert made(cache, other, 7.0)[1] == 1


def test_another_program_finds_nothing(cache, monkeypatch):
    made(cache, 1)
    monkeypatch.setattr(stage_cache, "made_by", lambda: b"another one")
    assert made(cache, 1)[1] == 1


@pytest.mark.parametrize("damage", [lambda b: b[:-1], lambda b: b[:40], lambda b: b"", lambda b: b[:50] + b"?" + b[51:],
                                    lambda b: b + b"x"])  # fmt: skip
def test_what_is_damaged_is_made_anew_and_written_again(cache, damage):
    made(cache, 1)
    (entry,) = entries(cache)
    entry.write_bytes(damage(entry.read_bytes()))
    result, calls = made(cache, 1, 3.0)
    assert calls == 1
    assert (result == 3.0).all()
    assert made(cache, 1)[1] == 0


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="rights are those of POSIX")
def test_what_others_may_write_is_not_read(cache, monkeypatch):
    made(cache, 1)
    (entry,) = entries(cache)
    assert stat.S_IMODE(entry.stat().st_mode) == 0o600
    entry.chmod(0o666)
    assert made(cache, 1)[1] == 1
    cache.folder.chmod(0o777)
    monkeypatch.setenv(stage_cache.FOLDER, str(cache.folder))
    with pytest.warns(CacheWarning, match="nobody else may write there"):
        assert StageCache.of_user() is None


def test_an_entry_of_another_question_is_none_under_this_name(cache):
    """As somebody copies it, or a file system mixes up its names."""
    made(cache, 1)
    (one,) = entries(cache)
    made(cache, 2, 2.0)
    other = next(each for each in entries(cache) if each != one)
    one.write_bytes(other.read_bytes())
    result, calls = made(cache, 1, 3.0)
    assert calls == 1
    assert (result == 3.0).all()


def test_nothing_is_unpickled(cache):
    """Even with its checksum made anew: what would run code where it is unpickled is made again."""
    made(cache, 1)
    (entry,) = entries(cache)
    content = pickle.dumps(Trap())
    entry.write_bytes(hashlib.sha256(entry.name.encode() + content).digest() + content)
    assert made(cache, 1)[1] == 1
    assert not Trap.sprung


class Trap:
    sprung: ClassVar[list[int]] = []

    def __reduce__(self):
        return Trap.sprung.append, (1,)


def test_nan_is_a_value_of_its_own_in_questions_and_answers(cache):
    assert made(cache, [math.nan], math.nan)[1] == 1
    result, calls = made(cache, [math.nan], 0.0)
    assert calls == 0
    assert np.isnan(result).all()
    assert made(cache, [0.0])[1] == made(cache, [None])[1] == made(cache, [math.inf])[1] == 1


def test_an_edit_of_any_file_of_the_program_counts(tmp_path):
    for name in ("a/one.py", "a/page.css", "a/__pycache__/one.pyc"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("1")
    first = sources(tmp_path / "a")
    (tmp_path / "a/__pycache__/one.pyc").write_text("2")
    assert sources(tmp_path / "a") == first
    seen = {first}
    for name in ("a/one.py", "a/page.css", "a/new.py"):
        (tmp_path / name).write_text("2")
        seen.add(sources(tmp_path / "a"))
    assert len(seen) == 4
    assert sources(tmp_path / "none") is None
    assert sources(*(Path(each.__file__).parent for each in (cad_io, plan_cutters)))


def test_what_may_not_be_kept_is_made_each_time(cache):
    for _ in range(2):
        assert made(cache, 1, keep=lambda result: False)[1] == 1
    assert entries(cache) == []


def test_what_is_made_at_once_is_not_kept(cache, monkeypatch):
    monkeypatch.setattr(stage_cache, "_WORTH", 10.0)
    made(cache, 1)
    assert entries(cache) == []


def test_what_was_used_least_lately_goes_first(cache):
    for k in range(4):
        made(cache, k)
        os.utime(entries(cache)[-1], (k, k)) if k == 0 else None
    size = entries(cache)[0].stat().st_size
    oldest = cache.folder / next(each.name for each in entries(cache) if each.stat().st_mtime == 0)
    # Reading is use.
    smaller = StageCache(cache.folder, 4 * size)
    assert made(smaller, 0)[1] == 0
    assert oldest.stat().st_mtime > 0
    for k, each in enumerate(entries(cache)):
        os.utime(each, (1000 + k, 1000 + k)) if each != oldest else None
    made(smaller, 4)
    assert len(entries(cache)) == 4
    assert oldest.exists()
    assert made(StageCache(cache.folder, 3 * size // 2), 5)[1] == 1
    assert len(entries(cache)) == 1


def test_what_is_larger_than_the_cache_is_not_kept_and_nothing_half_written_stays(cache):
    small = StageCache(cache.folder, 100)
    assert made(small, 1)[1] == 1
    assert entries(cache) == []
    left = cache.folder / ".stage-1234.stage"
    left.write_bytes(b"half")
    made(cache, 1)
    assert left.exists()
    os.utime(left, (1, 1))
    made(cache, 2)
    assert not left.exists()


def test_a_folder_that_cannot_be_written_costs_time_alone(cache):
    gone = StageCache(cache.folder / "none")
    assert made(gone, 1)[1] == made(gone, 1)[1] == 1


@pytest.mark.parametrize(
    ("folder", "size", "there"),
    [("", "", False), ("here", "", True), ("here", "0", False), ("here", "5", True), ("here", "many", False)],
)
def test_the_environment_says_where_and_how_much(tmp_path, monkeypatch, folder, size, there):
    monkeypatch.setenv(stage_cache.FOLDER, str(tmp_path / folder) if folder else "")
    monkeypatch.setenv(stage_cache.SIZE, size)
    cache = StageCache.of_user()
    assert (cache is not None) == there
    if cache is not None:
        assert cache.folder == tmp_path / "here"
        assert cache.most == (5 << 20 if size else stage_cache.MOST)


def test_without_a_cache_all_is_made():
    assert not NO_CACHE.holds("stage", 1)
    assert made(NO_CACHE, 1)[1] == made(NO_CACHE, 1)[1] == 1


def test_a_run_makes_nothing_twice_and_keeps_what_lasts(cache):
    for lasting in (NO_CACHE, cache):
        run = RunCache(lasting)
        assert not run.holds("stage", [1])
        first, times = made(run, [1])
        again, more = made(run, [1], value=2.0)
        assert (times, more) == (1, 0)
        assert again is first
        assert run.holds("stage", [1])
        assert not run.holds("another", [1])
        assert made(run, [2], value=3.0)[1] == 1
    # Another run finds what the cache behind it has, and nothing where none is.
    assert made(RunCache(cache), [1])[1] == 0
    assert made(RunCache(NO_CACHE), [1])[1] == 1
