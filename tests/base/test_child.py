"""A child knows what its parent says, finds no modules where it works, and is gone when it is ended, with all that it started."""

import os
import signal
import subprocess
import time
from dataclasses import fields, replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from plan_cutters_base.workers.child import VARIABLE, Assignment, Child, assignment

TEXT = st.text(st.characters(codec=None), max_size=20)
NUMBER = st.none() | st.integers(0, 1 << 50)
ASSIGNMENTS = st.builds(
    Assignment, parent=NUMBER, report=NUMBER, go=NUMBER, memory=NUMBER, began=st.none() | st.floats(allow_nan=False),
    done=st.integers(0, 99), excluded=st.dictionaries(st.integers(1, 999), TEXT), job=st.none() | TEXT,
)  # fmt: skip


@given(ASSIGNMENTS)
def test_what_is_written_is_read_again(there):
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(VARIABLE, str(there))
        assert assignment() == there


def test_nobody_of_ours_started_this_process(monkeypatch):
    monkeypatch.delenv(VARIABLE, raising=False)
    assert assignment() == Assignment()
    assert {each.name for each in fields(Assignment) if getattr(Assignment(), each.name)} == set()


def test_files_beside_the_part_are_no_modules(tmp_path):
    for name in ("json", "plan_cutters", "numpy"):
        (tmp_path / f"{name}.py").write_text("raise SystemExit(9)")
    code = "import json, plan_cutters, numpy; from plan_cutters_base.workers.child import assignment as a; print(a().done)"
    child = Child(["-c", code], Assignment(done=7), cwd=tmp_path, stdout=subprocess.PIPE, text=True)
    said, _ = child.process.communicate(timeout=60)
    assert (child.ended(), said) == (0, "7\n")


#: Starts another process that never ends, says both numbers, and takes its end by SIGTERM in so many seconds, or not at all.
STUBBORN = """
import os, signal, subprocess, sys, time
other = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(600)"])
def end(*_):
    time.sleep({seconds})
    other.kill(); other.wait()
    os._exit(5)
signal.signal(signal.SIGTERM, end)
print(os.getpid(), other.pid, flush=True)
while True:
    time.sleep(600)
"""


def gone(pid):
    until = time.monotonic() + 5
    while time.monotonic() < until:
        try:
            os.kill(pid, 0)
            with open(f"/proc/{pid}/stat") as stat:
                if stat.read().rpartition(")")[2].split()[0] in "ZX":
                    return True
        except (ProcessLookupError, FileNotFoundError):
            return True
        time.sleep(0.02)
    return False


@pytest.mark.parametrize(("seconds", "grace", "code"), [
    (0.0, 20.0, 5),  # asked, it ends in order
    (600.0, 0.2, -signal.SIGKILL),  # asked, it does not
    (0.0, 0.0, -signal.SIGKILL),  # it is not asked
])  # fmt: skip
def test_nothing_of_it_is_left(seconds, grace, code):
    child = Child(["-c", STUBBORN.format(seconds=seconds)], Assignment(), stdout=subprocess.PIPE, text=True)
    pids = [int(word) for word in child.process.stdout.readline().split()]
    assert child.ended(0.0) is None
    child.end(grace)
    child.process.stdout.close()
    assert child.ended() == code
    assert all(map(gone, pids))
    child.end(grace)  # once more is as well


def test_one_without_a_session_ends_with_the_session_of_its_parent():
    code = """
import os, subprocess
from plan_cutters_base.workers.child import Assignment
from plan_cutters_base.workers.child import Child
sleep = "import time; time.sleep(600)"
own, mine = (Child(["-c", sleep], Assignment(), session=session) for session in (True, False))
print(own.process.pid, mine.process.pid, flush=True)
own.process.wait()
"""
    parent = Child(["-c", code], Assignment(), stdout=subprocess.PIPE, text=True)
    own, mine = (int(word) for word in parent.process.stdout.readline().split())
    parent.end()
    parent.process.stdout.close()
    assert gone(mine)
    os.kill(own, 0)
    os.killpg(own, signal.SIGKILL)


def test_an_assignment_is_not_handed_on_by_itself(monkeypatch):
    """Who starts a child says anew what it is to know: it does not report on a pipe of its grandparent."""
    monkeypatch.setenv(VARIABLE, str(replace(Assignment(), report=3, parent=1)))
    code = "from plan_cutters_base.workers.child import assignment, is_child; print(is_child(), assignment().parent)"
    child = Child(["-c", code], Assignment(), stdout=subprocess.PIPE, text=True)
    assert child.process.communicate(timeout=60)[0] == "False None\n"
