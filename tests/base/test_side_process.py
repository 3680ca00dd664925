"""Work in a copy of the process: the same result as here, whatever becomes of the copy, and nothing left of it."""

import contextlib
import os
import resource
import signal
import struct
import time
from dataclasses import replace
from multiprocessing.connection import Connection
from pathlib import Path

import numpy as np
import pytest

from plan_cutters import pipeline, plan
from plan_cutters.report import folder, models
from plan_cutters.report.folder import write_all
from plan_cutters_base import forks
from plan_cutters_base.forks import SideProcess, TimeLimit, each, limited
from tests.support.places import ROOT

GROOVE = ROOT / "samples" / "v_groove.step"
HERE = os.getpid()


def children():
    return (Path("/proc/self/task") / str(HERE) / "children").read_text().split()


def test_a_long_answer_comes_whole_and_the_copy_made_it():
    with SideProcess(lambda: (os.getpid(), np.arange(2_000_000)), 20.0) as copy:
        assert copy.works
        number, long = copy.result()
    assert number != os.getpid()
    assert (long == np.arange(2_000_000)).all()
    assert not copy.works


def spin():
    while os.getpid() != HERE:
        pass
    return "here"


def crash():
    if os.getpid() != HERE:
        os.kill(os.getpid(), signal.SIGSEGV)
    return "here"


def fail():
    if os.getpid() != HERE:
        raise ValueError
    return "here"


def no_words():
    if os.getpid() != HERE:
        return lambda: None  # cannot be pickled
    return "here"


@pytest.mark.parametrize("fault", [spin, crash, fail, no_words])
def test_whatever_becomes_of_the_copy_the_result_is_made_here(fault):
    with SideProcess(fault, 0.4) as copy:
        assert copy.result() == "here"
        assert not copy.works


@pytest.mark.parametrize("part", [b"", b"\0", struct.pack("!i", 9) + b"half"])
def test_half_an_answer_is_none(monkeypatch, part):
    monkeypatch.setattr(Connection, "send", lambda pipe, answer: os.write(pipe.fileno(), part))
    with SideProcess(lambda: "here", 5.0) as copy:
        assert copy.result() == "here"


def test_what_is_raised_here_is_raised():
    def wrong():
        raise ValueError("so it is")

    with SideProcess(wrong, 5.0) as copy, pytest.raises(ValueError, match="so it is"):
        copy.result()


def test_nothing_is_left_of_a_copy_that_nobody_asked():
    def asleep():
        time.sleep(60)

    def interrupted():
        with SideProcess(asleep, 60.0):
            assert len(children()) == len(before) + 1
            raise KeyboardInterrupt

    before = children()
    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert children() == before


def test_without_a_copy_the_work_is_done_here(monkeypatch):
    with SideProcess(os.getpid, 5.0, worth=False) as copy:
        assert not copy.works
        assert copy.result() == os.getpid()
    monkeypatch.setattr("plan_cutters_base.forks.Copy", lambda *_: (_ for _ in ()).throw(OSError("no more processes")))
    with SideProcess(os.getpid, 5.0) as copy:
        assert copy.result() == os.getpid()


def test_a_copy_whose_words_are_taken_slowly_is_not_stuck(monkeypatch):
    # It sleeps whenever the pipe is full, and is looked at once a second however often its words come.
    monkeypatch.setattr(forks, "_ASLEEP", 3)
    with SideProcess(lambda: b"x" * 30_000_000, 20.0) as copy:
        assert copy.result(lambda: b"") == b"x" * 30_000_000


@pytest.mark.slow("plans and writes all files", only=("10000",))
@pytest.mark.parametrize("faces", [1, 10_000])
def test_samples_and_files_are_the_same_with_copies_and_without(tmp_path, monkeypatch, faces):
    monkeypatch.setattr(pipeline, "_MANY_FACES", faces)
    asked = {"cutters": "R2L30", "grid": 9, "area_budget": 0, "jobs": 2}
    one, other = plan(GROOVE, **asked), plan(GROOVE, **asked | {"jobs": 1})
    assert one.samples == other.samples
    wanted = ("json", "npz", "html", "glb", "step")
    written = [write_all(each, tmp_path / str(k), wanted) for k, each in enumerate((one, other))]
    assert [set(each.files) for each in written] == 2 * [{*wanted, "process"} - {"json"}]
    assert not any(each.not_written for each in written)
    assert written[0].split == written[1].split
    for name in ("npz", "glb"):
        assert written[0].files[name].sha256 == written[1].files[name].sha256


def test_a_split_that_fails_costs_the_models_not_the_page(tmp_path, monkeypatch):
    def fails(*_):
        raise RuntimeError("no faces")

    monkeypatch.setattr(models, "split_result", fails)
    result = plan(GROOVE, cutters="R2L30", grid=9, area_budget=0, jobs=2)
    document = write_all(result, tmp_path / "out", ("json", "html", "glb", "step"))
    assert set(document.files) == {"html", "process"}
    assert set(document.not_written) == {"glb", "step"}
    assert all("no faces" in why for why in document.not_written.values())


def test_a_page_whose_copy_crashes_is_written_here(tmp_path, monkeypatch):
    made = folder.Making.file

    def file(self, name, split=None):
        if os.getpid() != HERE:
            os.kill(os.getpid(), signal.SIGSEGV)
        return made(self, name, split)

    monkeypatch.setattr(folder.Making, "file", file)
    result = plan(GROOVE, cutters="R2L30", grid=9, area_budget=0, jobs=2)
    document = write_all(result, tmp_path / "out", ("json", "html", "glb", "step"))
    assert set(document.files) == {"html", "glb", "step", "process"}


def test_one_thread_asked_for_is_one_process(tmp_path, monkeypatch):
    begun = []
    monkeypatch.setattr("plan_cutters_base.forks.Copy", lambda *given: begun.append(given))
    result = plan(GROOVE, cutters="R2L30", grid=9, area_budget=0, jobs=1)
    write_all(replace(result), tmp_path / "out", ("json", "html"))
    assert not begun


def ignored():
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)


def waited_for():
    def wait(*_):
        with contextlib.suppress(ChildProcessError):
            while os.waitpid(-1, os.WNOHANG)[0]:
                pass

    signal.signal(signal.SIGCHLD, wait)


def in_a_process(work):
    """What became of some work in a process of its own: 0 where it came to its end."""
    if not (child := os.fork()):
        try:
            work()
            os._exit(0)
        finally:
            os._exit(1)
    return os.waitpid(child, 0)[1]


@pytest.mark.slow("starts processes")
@pytest.mark.parametrize("host", [ignored, waited_for])
def test_a_program_may_wait_for_the_copies_itself(host):
    # A server ignores SIGCHLD, or its handler waits for all that ends: then there is nothing left to wait for.
    def work():
        host()
        assert limited(lambda: b"done", 20.0) == b"done"
        assert list(each(str, [1, 2], seconds=20.0)) == ["1", "2"]
        with SideProcess(os.getpid, 20.0) as copy:
            time.sleep(0.2)
            assert copy.result() != os.getpid()
        with pytest.raises(TimeLimit):
            limited(lambda: time.sleep(60), 0.1)

    assert in_a_process(work) == 0


def test_a_program_may_have_many_files_open():
    def work():
        resource.setrlimit(resource.RLIMIT_NOFILE, (1100, resource.getrlimit(resource.RLIMIT_NOFILE)[1]))
        opened = [os.open(os.devnull, os.O_RDONLY) for _ in range(1060)]
        assert opened
        assert limited(lambda: b"done", 20.0) == b"done"

    assert in_a_process(work) == 0


def test_no_pipe_is_left_where_there_is_no_room_for_a_copy(monkeypatch):
    def no_room():
        raise BlockingIOError("no more processes")

    before = os.listdir("/proc/self/fd")
    monkeypatch.setattr(os, "fork", no_room)
    with SideProcess(os.getpid, 5.0) as copy:
        assert copy.result() == os.getpid()
    assert os.listdir("/proc/self/fd") == before


def test_whether_it_has_ended_is_asked_without_waiting_or_working_here():
    here = os.getpid()

    def crash():
        assert os.getpid() != here, "the call was made here"
        os._exit(3)

    with SideProcess(lambda: time.sleep(60), 60.0) as slow:
        assert slow.ended() is None
    with SideProcess(lambda: "done", 60.0) as quick:
        until = time.monotonic() + 30
        while (answer := quick.ended()) is None and time.monotonic() < until:
            time.sleep(0.01)
        assert answer == "done"
    with SideProcess(crash, 60.0) as crashed:
        time.sleep(0.5)
        assert crashed.ended() is None
    with SideProcess(crash, 60.0, worth=False) as none:
        assert none.ended() is None
