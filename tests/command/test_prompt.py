"""At a shell's prompt the command ends with its summary, and models are written behind it; elsewhere with the last file."""

import json
import os
import pty
import select
import signal
import subprocess
import sys
import time

import pytest

from plan_cutters.errors import PlanError
from plan_cutters.files.lock import Lock
from plan_cutters_base.workers import prompt
from tests.support.forked import ENV
from tests.support.places import SAMPLES

GROOVE = SAMPLES / "v_groove.step"
WORDS = [str(GROOVE), "--cutter", "R6L80", "--grid", "9", "--area-budget", "0", "-o", "out"]
#: A shell that starts one job in a group of its own, as shells do at a prompt, gives it the terminal, and takes it back.
SHELL = """
import os, signal, subprocess, sys
signal.signal(signal.SIGTTOU, signal.SIG_IGN)
job = subprocess.Popen(sys.argv[1:], process_group=0)
os.tcsetpgrp(0, job.pid)
code = job.wait()
os.tcsetpgrp(0, os.getpgrp())
os.write(1, f"ended {code} .{os.linesep}".encode())
"""
pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="only there the prompt comes back")


def at_prompt(folder, *words, on=lambda text: None, slow="", environment=()):
    """What a command says on a terminal at whose prompt it is started; `slow`: seconds that a model takes more."""
    command = [sys.executable, "-m", "plan_cutters", *words]
    if slow:
        # The process that works is slow, whoever started it.
        (folder / "sitecustomize.py").write_text(SLOW.format(seconds=slow))
    there = {**ENV, "TERM": "dumb", "PLAN_CUTTERS_CACHE": "", **dict(environment)}
    there["PYTHONPATH"] = f"{folder}{os.pathsep}{there['PYTHONPATH']}"
    child, terminal = pty.fork()
    if not child:
        os.chdir(folder)
        os.execve(sys.executable, [sys.executable, "-c", SHELL, *command], there)
    said = b""
    while b" .\r\n" not in said and select.select([terminal], [], [], 120)[0]:
        try:
            data = os.read(terminal, 1 << 16)
        except OSError:
            break
        said += data
        on(said.decode(errors="replace"))
    os.close(terminal)
    os.waitpid(child, 0)
    return said.decode().replace("\r\n", "\n")


#: The STEP file takes longer, whoever loads its module first.
SLOW = """
import sys
class Later:
    def find_spec(self, name, path=None, target=None):
        if name == "plan_cutters.report.models":
            import importlib.machinery, time
            spec = importlib.machinery.PathFinder.find_spec(name, path)
            load = spec.loader.exec_module
            def loaded(module):
                load(module)
                write = module.write_step
                module.write_step = lambda *words, **more: (time.sleep({seconds}), write(*words, **more))[1]
            spec.loader.exec_module = loaded
            return spec
sys.meta_path.insert(0, Later())
"""


def document(folder):
    return json.loads((folder / "out" / "plan.json").read_text())


def whole(folder, seconds=60.0):
    """The plan, once nothing is missing."""
    ends = time.monotonic() + seconds
    while document(folder)["not_written"] and time.monotonic() < ends:
        time.sleep(0.1)
    return document(folder)


def left_over(folder):
    return [each.name for each in folder.iterdir() if each.name.startswith(".out")]


def test_the_prompt_comes_back_before_the_models(tmp_path):
    text = at_prompt(tmp_path, *WORDS, slow="4.0")
    assert "ended 0 " in text
    assert "Models are being written into out meanwhile" in text
    assert "step" in document(tmp_path)["not_written"]
    assert not (tmp_path / "out" / "annotated.step").exists()
    plan = whole(tmp_path)
    assert not plan["not_written"]
    assert {"step", "glb", "html", "npz"} <= plan["files"].keys()
    assert all((tmp_path / "out" / each["name"]).is_file() for each in plan["files"].values())
    time.sleep(1.0)
    assert left_over(tmp_path) == []


@pytest.mark.slow("plans twice")
def test_the_next_question_waits_for_the_models_of_the_one_before(tmp_path):
    at_prompt(tmp_path, *WORDS, slow="4.0")
    again = at_prompt(tmp_path, *WORDS, "--formats", "json,npz")
    assert "ended 0 " in again
    assert document(tmp_path)["files"].keys() == {"npz", "process"}


@pytest.mark.slow("plans to the end")
@pytest.mark.parametrize("more", [("--wait",), ("--formats", "json,npz"), ("--junit", "cases.xml")])
def test_it_ends_with_the_last_file_where_that_is_asked(tmp_path, more):
    text = at_prompt(tmp_path, *WORDS, *more, slow="1.0")
    assert "ended 0 " in text
    assert "meanwhile" not in text
    assert document(tmp_path)["not_written"] == {}
    assert left_over(tmp_path) == []


def test_an_interrupt_at_the_prompt_ends_it_as_ever(tmp_path):
    sent = []

    def interrupts(text):
        if "reading the part" in text and not sent:
            sent.append(terminal_interrupt(tmp_path))

    text = at_prompt(tmp_path, *WORDS, on=interrupts)
    assert "ended 130 " in text
    assert left_over(tmp_path) == []


def terminal_interrupt(folder):
    """Interrupt all processes of the job, as a terminal does."""
    groups = {}
    for each in filter(str.isdigit, os.listdir("/proc")):
        try:
            if os.readlink(f"/proc/{each}/cwd") == str(folder):
                groups[os.getpgid(int(each))] = os.getsid(int(each))
        except OSError:
            continue
    job = next(group for group, session in groups.items() if group != session)
    os.killpg(job, signal.SIGINT)
    return True


def test_no_terminal_no_prompt(tmp_path):
    assert not prompt.at_prompt()
    assert not prompt.is_waited_for()
    done = subprocess.run([sys.executable, "-c", "from plan_cutters_base.workers.prompt import at_prompt; print(at_prompt())"],
                          env=ENV, capture_output=True, text=True, check=True, process_group=0)  # fmt: skip
    assert done.stdout == "False\n"


def test_who_writes_models_is_waited_for_and_no_one_else(tmp_path, monkeypatch):
    from plan_cutters.files import lock

    monkeypatch.setattr(lock, "_PATIENCE", 0.5)
    first = Lock(tmp_path / "out")
    began = time.monotonic()
    with pytest.raises(PlanError, match="is being written"):
        Lock(tmp_path / "out")
    assert time.monotonic() - began < 0.4
    first.ends_soon()
    with pytest.raises(PlanError, match="is being written"):
        Lock(tmp_path / "out")
    assert time.monotonic() - began > 0.5
    first.release()
    second = Lock(tmp_path / "out")
    second.release()
    assert left_over(tmp_path) == []
