"""Nothing is left running: every process ends with the one that asked for it, also while the CAD kernel does not come back."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from plan_cutters_base.workers import supervise
from plan_cutters_base.workers.child import Child
from tests.support.commands import leftovers
from tests.support.forked import ENV
from tests.support.places import SAMPLES

pytestmark = [
    pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="looks at processes in /proc"),
    pytest.mark.slow(
        "starts commands and ends them on the way",
        but=(
            "test_a_command_that_is_ended_leaves_nothing_running[SIGINT-split:]",
            "test_a_command_that_is_ended_leaves_nothing_running[SIGKILL-read:copy",
            "test_copies_end_with_the_program_that_plans",
        ),
    ),
]

#: An interpreter that begins with this is stuck in the stage asked for: in one call of C that never lets go of the interpreter,
#: as the kernel does. `where` is a stage's name; with `copy` a forked copy is stuck, and the stage waits for it.
STUCK = """
import contextlib, importlib.util, itertools, os, sys, time
from pathlib import Path
where, how = os.environ.get("STUCK", ":").split(":")

def spin():
    Path(os.environ["STUCK_SIGN"]).touch()
    any(itertools.repeat(False))

def trap(name):
    if name == where and how == "copy":
        from plan_cutters_base.forks import limited
        limited(lambda: spin() or b"", 600.0)
    elif name == where and how == "sleep":
        Path(os.environ["STUCK_SIGN"]).touch()
        time.sleep(600)
    elif name == where:
        spin()

def patch(module):
    real = module.Clock.stage
    @contextlib.contextmanager
    def stage(clock, what, **more):
        with real(clock, what, **more) as tell:
            trap(what)
            yield tell
    module.Clock.stage = stage

class Finder:
    after = {"plan_cutters_base.workers.supervise":
                 lambda module: vars(module).update(dict.fromkeys(("BEGINNING", "WRITING"), float(os.environ["WRITING"]))),
             "plan_cutters.document.clock": patch, "plan_cutters.point": lambda _: trap("map"),
             "plan_cutters.scene.conditions":
                 lambda _: "plan_cutters.command.background_compile" in sys.orig_argv and trap("ahead"),
             "plan_cutters.command.tools": lambda _: trap("tools"), "plan_cutters.command.machines": lambda _: trap("machines")}

    def find_spec(self, name, path=None, target=None):
        if name not in self.after:
            return None
        sys.meta_path.remove(self)
        spec = importlib.util.find_spec(name)
        sys.meta_path.insert(0, self)
        load = spec.loader.exec_module
        def run(module):
            load(module)
            self.after[name](module)
        spec.loader.exec_module = run
        return spec

if where:
    sys.meta_path.insert(0, Finder())
"""
WORDS = (str(SAMPLES / "v_groove.step"), "--cutter", "R6L80", "--grid", "5", "--area-budget", "100", "-o", "out")
#: Before a plan is written, and after it: that of the verdicts stands before the area between the samples is looked at.
EARLY = ("read", "measure", "sew", "sample", "tessellate", "compile", "R6L80")
LATE = ("area", "html", "split", "step")


class Run:
    """A command that is stuck somewhere, and all processes that belong to it."""

    def __init__(self, folder, where, *, words=WORDS, command=("-m", "plan_cutters"), wrapped=(), writing=0.5):
        hooks = folder / "hooks"
        hooks.mkdir()
        (hooks / "sitecustomize.py").write_text(STUCK)
        self.sign, self.folder = hooks / "stuck", folder
        environment = ENV | {"STUCK": where, "STUCK_SIGN": str(self.sign), "MARK": str(folder),
                             "WRITING": str(writing)}  # fmt: skip
        environment["PYTHONPATH"] = f"{hooks}{os.pathsep}{ENV['PYTHONPATH']}"
        self.process = subprocess.Popen(
            [*wrapped, sys.executable, *command, *words], cwd=folder, env=environment, stderr=subprocess.PIPE, text=True,
            start_new_session=True, preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
        )  # fmt: skip

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for pid in self.alive():
            os.kill(pid, signal.SIGKILL)
        self.process.communicate()

    def until_stuck(self):
        until = time.monotonic() + 120
        while not self.sign.exists():
            assert self.process.poll() is None, self.process.stderr.read()
            assert time.monotonic() < until
            time.sleep(0.02)

    def alive(self):
        """All processes that began with this one's environment, but for those that have ended and are not waited for."""
        found, mark = [], f"MARK={self.folder}".encode()
        for each in Path("/proc").iterdir():
            try:
                ours = each.name.isdigit() and mark in (each / "environ").read_bytes().split(b"\0")
                if ours and (each / "stat").read_text().rpartition(")")[2].split()[0] not in "ZX":
                    found.append(int(each.name))
            except OSError:
                continue
        return found

    def gone_within(self, seconds):
        until = time.monotonic() + seconds
        while self.alive():
            assert time.monotonic() < until
            time.sleep(0.02)


#: Half a second on a machine that does nothing else; tests run beside others.
SOON = 2.0


COPIES = ("read:copy", "split:copy")
#: SIGTERM takes the way of an interrupt, and where it was does not matter to SIGKILL: some stages are enough for these.
ENDED = [
    *((signal.SIGINT, where) for where in (*(f"{stage}:" for stage in (*EARLY, *LATE)), *COPIES)),
    *((signal.SIGTERM, where) for where in ("R6L80:", "split:", "read:copy")),
    *((signal.SIGKILL, where) for where in ("tessellate:", "step:", *COPIES)),
]


@pytest.mark.parametrize(("number", "where"), [pytest.param(*each, id=f"{each[0].name}-{each[1]}") for each in ENDED])
def test_a_command_that_is_ended_leaves_nothing_running(tmp_path, number, where):
    with Run(tmp_path, where) as run:
        run.until_stuck()
        assert len(run.alive()) >= (3 if "copy" in where else 2)  # and copies that make the page or the GLB
        run.process.send_signal(number)
        # Where a plan is there, its summary is shown when the worker is gone.
        run.gone_within(SOON if where.partition(":")[0] in EARLY else 4 * SOON)
        _, said = run.process.communicate(timeout=5)
    assert "Traceback" not in said
    stage, late = where.partition(":")[0], where.partition(":")[0] in LATE
    if number != signal.SIGKILL:
        assert run.process.returncode == 130
        assert "interrupted" in said.splitlines()[-1]
        assert leftovers(tmp_path, "hooks") == (["out"] if late else [])
    if late:
        plan = json.loads((tmp_path / "out" / "plan.json").read_text())
        assert stage in ("area", "split") or stage in plan["not_written"]
        assert ("run_unfinished" in plan["note_codes"]) == (stage == "area")
        assert number == signal.SIGKILL or set(plan["not_written"].values()) == {"interrupted"}
    if number == signal.SIGKILL:
        # Whatever was killed could not tidy: the next run into that folder does.
        assert any(each.name.startswith(".out-") for each in tmp_path.iterdir())
        from plan_cutters.report.folder import Staging

        Staging(tmp_path / "out").discard()
        assert leftovers(tmp_path, "hooks", "out") == []


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL], ids=lambda n: n.name)
@pytest.mark.parametrize("command", ["point_map", "tools", "machines"])
def test_the_other_commands_end_too(tmp_path, command, number):
    """The map of a point asks the kernel, in a child; the others are plain Python and end in order where they are."""
    entry = ("-c", f"from plan_cutters.command.entry import {command}; {command}()")
    words = (WORDS[0], "--at", "0,0,0", "--cutter", "R6L80") if command == "point_map" else ("list",)
    with Run(tmp_path, "map:" if command == "point_map" else f"{command}:sleep", words=words, command=entry) as run:
        run.until_stuck()
        assert len(run.alive()) == (2 if command == "point_map" else 1)
        run.process.send_signal(number)
        run.gone_within(SOON)
        _, said = run.process.communicate(timeout=5)
    assert "Traceback" not in said
    assert run.process.returncode in ((-number,) if number == signal.SIGKILL else (130, -number))
    assert leftovers(tmp_path, "hooks") == []


@pytest.mark.slow("waits for a time limit")
def test_what_hangs_where_verdicts_stand_is_given_time_and_no_more(tmp_path):
    with Run(tmp_path, "area:", writing=supervise.BEGINNING) as run:
        run.until_stuck()
        run.process.send_signal(signal.SIGINT)
        run.gone_within(10.0 + SOON)
        _, said = run.process.communicate(timeout=5)
    assert "There was no time to write " in said.splitlines()[-1]


def test_who_gives_up_on_a_command_waits_for_no_files(tmp_path):
    """A batch or an agent ends a command in order, and nobody reads what it would still write."""
    with Run(tmp_path, "area:", writing=60.0) as run:
        run.until_stuck()
        command = Child.__new__(Child)
        command.process, command._session = run.process, True
        began = time.monotonic()
        command.end(20.0)
        assert time.monotonic() - began < 10
        run.gone_within(SOON)
    assert leftovers(tmp_path, "hooks") == ["out"]


def test_asked_twice_it_ends_at_once(tmp_path):
    with Run(tmp_path, "step:", writing=60.0) as run:
        run.until_stuck()
        for _ in range(2):
            run.process.send_signal(signal.SIGINT)
            time.sleep(0.02)
        run.gone_within(SOON)
        _, said = run.process.communicate(timeout=5)
    assert (run.process.returncode, "Traceback" in said) == (130, False)
    assert leftovers(tmp_path, "hooks") == ["out"]


@pytest.mark.parametrize("number", ["TERM", "KILL"])
def test_a_time_limit_from_outside_ends_it_all(tmp_path, number):
    """`timeout` sends to the command and its group: the worker is in neither. Its own alarm is its limit come early."""
    with Run(tmp_path, "measure:", wrapped=("timeout", "-s", number, "600")) as run:
        run.until_stuck()
        run.process.send_signal(signal.SIGALRM)
        assert run.process.wait(timeout=30) in (124, 137, -9)
        run.gone_within(SOON)


def test_a_script_that_gives_up_is_not_held(tmp_path):
    """`subprocess.run` kills on its time limit, then waits for the pipes that the worker had, too."""
    with Run(tmp_path, "measure:") as run:
        run.until_stuck()
        run.process.kill()
        began = time.monotonic()
        run.process.communicate(timeout=30)
        assert time.monotonic() - began < SOON


CALLER = """
import itertools, os, sys, threading
from pathlib import Path
import plan_cutters_base.forks as forks
from plan_cutters_base.forks import each
from plan_cutters_base.forks import limited
if sys.argv[3] == "looked after":
    forks._killed_by_the_system = lambda: False
def spin():
    Path(sys.argv[1]).touch()
    any(itertools.repeat(False))
calls = {"one call": lambda: limited(lambda: spin() or b"", 600.0),
         "each of many": lambda: list(each(lambda _: spin(), [1], seconds=600.0))}
work = threading.Thread(target=calls[sys.argv[2]])
work.start()
work.join()
"""


@pytest.mark.parametrize("call", ["one call", "each of many"])
@pytest.mark.parametrize("how", ["killed by the system", "looked after"])
def test_copies_end_with_the_program_that_plans(tmp_path, how, call):
    """Whoever calls `plan` from Python and dies leaves no copy behind: on Linux, and by the way of all others."""
    with Run(tmp_path, ":", command=("-c", CALLER), words=(str(tmp_path / "hooks" / "stuck"), call, how)) as run:
        run.until_stuck()
        assert len(run.alive()) == (3 if how == "looked after" else 2)
        run.process.kill()
        run.process.wait()
        run.gone_within(SOON)


def test_a_parent_that_was_gone_before_it_was_followed(tmp_path):
    code = "import os; from plan_cutters_base.forks import end_with; end_with(os.getppid() + 1); print('alive')"
    done = subprocess.run([sys.executable, "-c", code], env=ENV, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (-signal.SIGKILL, "")


def test_the_process_that_compiles_ends_with_the_worker(tmp_path, monkeypatch):
    monkeypatch.setitem(ENV, "NUMBA_CACHE_DIR", str(tmp_path / "cache"))
    with Run(tmp_path, "ahead:", words=(*WORDS, "--jobs", "2")) as run:
        run.until_stuck()
        assert len(run.alive()) >= 3
        run.process.kill()
        run.gone_within(SOON)
