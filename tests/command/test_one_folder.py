"""Two runs never mix in one folder; a plan there names files that are there, whatever ended the run."""

import contextlib
import errno
import fcntl
import hashlib
import json
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from plan_cutters import PlanError, plan
from plan_cutters.files.lock import Lock, lock_of
from plan_cutters.report.folder import Staging
from plan_cutters_base.whole import sweep
from tests.support.forked import ENV
from tests.support.places import SAMPLES

PARTS = "v_groove.step", "pocket_top.step"


@pytest.fixture(scope="module")
def results():
    return [plan(SAMPLES / part, cutters="R4L60", grid=3, area_budget=0) for part in PARTS]


def whole(out):
    """Whether the plan in a folder, if there is one, names files of its own that are there; the part that it is of."""
    path = out / "plan.json"
    if not path.exists():
        return None
    found = json.loads(path.read_text())
    for each in found["files"].values():
        assert hashlib.sha256((out / each["name"]).read_bytes()).hexdigest() == each["sha256"], each["name"]
    return found["part"]["file"]


def test_a_second_one_is_told_whose_the_folder_is(tmp_path, results):
    out = tmp_path / "out"
    with Staging(out):
        for other in (out, tmp_path / "x" / ".." / "out"):
            with pytest.raises(PlanError, match=rf"is being written by process {os.getpid()} on .*, since 20"):
                Staging(other)
        with pytest.raises(PlanError, match="is being written"):
            results[0].write(out, ["json"])
        (tmp_path / "link").symlink_to(out)
        with pytest.raises(PlanError, match="is being written"):
            Staging(tmp_path / "link")
        with Staging(tmp_path / "elsewhere"):
            pass
    results[0].write(out, ["json", "npz"])
    assert whole(out) == PARTS[0]
    assert sorted(each.name for each in tmp_path.iterdir()) == ["link", "out", "x"]


HOLD = """
import os, sys, time
from pathlib import Path
from plan_cutters.files.lock import Lock
held = Lock(Path(sys.argv[1]))
print("held", flush=True)
time.sleep(60)
"""


def test_what_a_process_that_was_killed_left_is_taken_over(tmp_path):
    out = tmp_path / "out"
    held = subprocess.Popen([sys.executable, "-c", HOLD, str(out)], env=ENV, stdout=subprocess.PIPE, text=True)
    assert held.stdout.readline() == "held\n"
    with pytest.raises(PlanError, match=f"process {held.pid}"):
        Lock(out)
    sweep(lock_of(out))
    assert lock_of(out).exists()
    held.send_signal(signal.SIGKILL)
    held.wait()
    held.stdout.close()
    assert lock_of(out).exists()
    taken = Lock(out)
    assert json.loads(lock_of(out).read_text())["pid"] == os.getpid()
    taken.release()
    assert not lock_of(out).exists()


def test_another_machines_lock_is_left_alone(tmp_path, monkeypatch):
    out = tmp_path / "out"
    lock_of(out).write_text(json.dumps({"host": "elsewhere", "pid": 7, "since": "2026-01-01"}))
    with pytest.raises(PlanError, match="locked by process 7 on elsewhere, since 2026-01-01: if nothing runs there"):
        Lock(out)
    for text in ("", "{", "[1]", '{"host": 5}', "\0" * 9000):
        lock_of(out).write_text(text)
        try:
            Lock(out).release()
        except PlanError as error:
            assert "\n" not in str(error)  # noqa: PT017
            lock_of(out).unlink()


@pytest.mark.parametrize("number", [errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP], ids=errno.errorcode.get)
def test_without_locks_of_the_system_a_file_that_is_there_is_one(tmp_path, monkeypatch, number):
    def without(*_):
        raise OSError(number, os.strerror(number))

    monkeypatch.setattr(fcntl, "flock", without)
    held = Lock(tmp_path / "out")
    with pytest.raises(PlanError, match="if nothing runs there any more, remove"):
        Lock(tmp_path / "out")
    held.release()
    Lock(tmp_path / "out").release()
    assert list(tmp_path.iterdir()) == []


def test_a_lock_that_cannot_be_written_is_none(tmp_path, monkeypatch):
    def full(*_, **__):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_text", full)
    with pytest.raises(OSError, match="No space left"):
        Lock(tmp_path / "out")
    monkeypatch.undo()
    assert list(tmp_path.iterdir()) == []
    Lock(tmp_path / "out").release()


def test_many_that_begin_at_once_have_it_one_after_the_other(tmp_path):
    """The file goes with each owner, and none that finds it going takes one that another has."""
    inside, most = [], 0

    def work():
        nonlocal most
        for _ in range(30):
            try:
                held = Lock(tmp_path / "out")
            except PlanError:
                continue
            inside.append(1)
            most = max(most, len(inside))
            inside.pop()
            held.release()

    threads = [threading.Thread(target=work) for _ in range(8)]
    for each in threads:
        each.start()
    for each in threads:
        each.join()
    assert most == 1
    assert list(tmp_path.iterdir()) == []


class Full(Exception):
    """Raised in place of the end of a process."""


@pytest.mark.parametrize("ends", [OSError(28, "No space left on device"), Full()], ids=["full disk", "killed"])
def test_whatever_step_of_writing_fails_nothing_is_mixed(results, tmp_path, monkeypatch, ends):
    """Each open for writing, each change of a name and each removal fails once: after it no plan names what is not its own."""
    formats, steps = ["json", "npz", "csv"], 0
    real = {"replace": os.replace, "unlink": Path.unlink, "open": Path.open, "mkdir": Path.mkdir}
    for fails in range(60):
        out = tmp_path / f"out{fails}"
        results[0].write(out, formats)
        before = whole(out)
        count = [0]

        def step(count=count, fails=fails):
            count[0] += 1
            if count[0] == fails + 1:
                raise ends

        def replaced(source, target, step=step):
            step()
            real["replace"](source, target)

        def unlinked(path, *words, step=step, **more):
            step()
            real["unlink"](path, *words, **more)

        def opened(path, mode="r", *words, step=step, **more):
            if "w" in mode:
                step()
            return real["open"](path, mode, *words, **more)

        with monkeypatch.context() as patched:
            patched.setattr(os, "replace", replaced)
            patched.setattr(Path, "unlink", unlinked)
            patched.setattr(Path, "open", opened)
            with contextlib.suppress(PlanError, Full, OSError):
                results[1].write(out, formats)
        found = whole(out)
        assert found in (before, PARTS[1], None)
        if found == before:
            assert sorted(p.name for p in out.iterdir()) == ["axes.csv", "plan.json", "process.toml", "samples.npz"]
        results[1].write(out, formats)
        assert whole(out) == PARTS[1]
        steps = max(steps, count[0])
        if count[0] <= fails:
            break
    assert 5 < steps < 60


def run(part, out, *words):
    return subprocess.Popen(
        [sys.executable, "-m", "plan_cutters", str(SAMPLES / part), "--cutter", "R4L60", "--grid", "3", "--area-budget", "0",
         "--formats", "json,npz", "--jobs", "1", "--quiet", "-o", str(out), *words], env=ENV, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip


@pytest.mark.slow("starts forty commands and ends half of them")
def test_runs_at_once_and_runs_that_are_killed(tmp_path):
    """Twenty times two at once, and twenty that are killed with all their processes: one of them, or none, never both."""
    out, won = tmp_path / "out", []
    for turn in range(20):
        first = run(PARTS[turn % 2], out)
        time.sleep(0.05 * (turn % 7))
        second = run(PARTS[1 - turn % 2], out)
        errors = [each.communicate()[1] for each in (first, second)]
        codes = [first.returncode, second.returncode]
        won.append(whole(out))
        assert won[-1] in PARTS
        for code, error in zip(codes, errors, strict=True):
            assert code in (0, 1) or (code == 2 and "is being written by process" in error), error
    for turn in range(20):
        killed = run(PARTS[turn % 2], out)
        time.sleep(0.5 + 0.12 * turn)
        children = subprocess.run(["pgrep", "-P", str(killed.pid)], capture_output=True, text=True, check=False)
        for pid in (killed.pid, *map(int, children.stdout.split())):
            with contextlib.suppress(ProcessLookupError):
                os.kill(pid, signal.SIGKILL)
        killed.communicate()
        assert whole(out) in (*PARTS, None)
    last = run(PARTS[0], out)
    last.communicate()
    assert last.returncode in (0, 1)
    assert whole(out) == PARTS[0]
