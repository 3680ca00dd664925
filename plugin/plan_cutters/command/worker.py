"""The child process that does the whole job: how it is begun and ended, and what it knows of its parent."""

import atexit
import contextlib
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Mapping, Sequence
from pathlib import Path

#: Environment variables by which the child knows its number of the pipe to report on, its memory limit in bytes, when the
#: command began, and its parent.
REPORT, MEMORY = "PLAN_CUTTERS_REPORT", "PLAN_CUTTERS_MEMORY"
BEGAN, PARENT = "PLAN_CUTTERS_BEGAN", "PLAN_CUTTERS_PARENT"
#: And the number of the pipe on which it is told that its words are in order, where it began before they were looked at.
GO = "PLAN_CUTTERS_GO"
#: One line at a time: stages tell from their threads.
_WRITING = threading.Lock()
#: Exit code of an interrupted run.
INTERRUPTED = 130
#: Of a run with a part that took longer than it may: as of `timeout`, the program.
TIMED_OUT = 124


def can_supervise() -> bool:
    """Whether this system lets one process hand a pipe to another and end it with all its copies (not Windows)."""
    return hasattr(os, "killpg") and hasattr(os, "sysconf")


def is_child() -> bool:
    """Whether this process was started by `supervise`."""
    return REPORT in os.environ


def report(word: str, text: str) -> None:
    """Tell the parent, if there is one: `part FILE`, `staging FOLDER`, `stage NAME`, `detail TEXT`, `at DONE TOTAL`,
    `work WHOSE FACE`, `say TEXT`, `show TEXT`, `safe CODE FOLDER`, `done CODE`.

    `say`: for people; `show`: for them, on standard output; `safe`: the plan of this part is in the folder, models follow;
    `done`: so are they.
    """
    if not is_child():
        return
    # Names of files may hold line ends, and bytes that are no text.
    line = f"{word} ".encode() + text.encode("unicode_escape") + b"\n"
    try:
        with _WRITING:
            while line:
                line = line[os.write(int(os.environ[REPORT]), line) :]
    except BrokenPipeError:
        # Who asked for the plan is gone, killed in a way that could not be passed on.
        raise KeyboardInterrupt from None


def report_work(whose: str, face: int) -> None:
    """Tell the parent whose work goes on in this stage, `kernel` or `own`, and at which face (0: all)."""
    report("work", f"{whose} F{face}" if face else whose)


def began() -> float:
    """When the command began, as `time.monotonic()` counts, which does so alike in all processes that there are parents of.

    Where the system does not tell, it is what the processor has spent on this process ago, or longer.
    """
    if is_child():
        return float(os.environ[BEGAN])
    age = time.process_time()
    with contextlib.suppress(OSError, ValueError, AttributeError, IndexError):  # only Linux has all of it
        ticks = int(Path("/proc/self/stat").read_text().rpartition(")")[2].split()[19])
        age = max(age, time.clock_gettime(time.CLOCK_BOOTTIME) - ticks / os.sysconf("SC_CLK_TCK"))
    return time.monotonic() - age


def follow_parent() -> None:
    """End when the parent does, however it ends: nobody else would wait for what this process makes."""
    if PARENT in os.environ:
        from cad_io.lifetime import end_with

        end_with(int(os.environ[PARENT]))


class Worker:
    """A child process: a session of its own, that an interrupt from the terminal reaches through us alone."""

    def __init__(
        self, words: Sequence[str], name: str, memory: int | None = None, *, waits: bool = False,
        more: Mapping[str, str] | None = None,
    ) -> None:  # fmt: skip
        self.words, self.waits = list(words), waits
        self.here, there = os.pipe()
        reports, self.go = os.pipe() if waits else (-1, -1)
        environment = {**os.environ, REPORT: str(there), BEGAN: str(began()), PARENT: str(os.getpid())}
        environment |= {GO: str(reports)} if waits else {}
        environment |= {} if memory is None else {MEMORY: str(memory)}
        environment |= more or {}
        run = f"from plan_cutters.command.entry import begin; begin({name!r})"
        self.process = subprocess.Popen([sys.executable, "-c", run, *words], env=environment, start_new_session=True,
                                        pass_fds=(there, reports) if waits else (there,))  # fmt: skip
        os.close(there)
        if waits:
            os.close(reports)

    def begin(self, memory: int | None) -> None:
        """Let it begin, if it waits for that."""
        if self.waits:
            with contextlib.suppress(BrokenPipeError):
                os.write(self.go, f"{'' if memory is None else memory}\n".encode())
            os.close(self.go)
            self.waits = False

    def drop(self) -> None:
        """End it if it still waits to begin."""
        if self.waits:
            self.end()

    def kill(self) -> None:
        """Kill it, the copies that it has made of itself for the kernel, and who compiles for it."""
        with contextlib.suppress(ProcessLookupError, PermissionError):  # macOS says so of those that have ended
            os.killpg(self.process.pid, signal.SIGKILL)

    def end(self) -> None:
        """Leave nothing of it running."""
        self.kill()
        self.process.wait()


#: The child that waits for `supervise`.
_early: list[Worker] = []


def begin_early(words: Sequence[str]) -> None:
    """Start the child before the words are looked at, if they name a file: it loads the kernel meanwhile, and waits.

    It is killed where the words are wrong after all, and where `supervise` is never called.
    """
    helped = not {"--help", "-h", "--version"}.isdisjoint(words)
    if is_child() or helped or not can_supervise() or not any(map(os.path.isfile, words)):
        return
    with contextlib.suppress(OSError, ValueError):
        for number in range(3):
            os.fstat(number)  # one that is closed is to be opened first
        worker = Worker(words, "plan-cutters", waits=True)
        _early.append(worker)
        atexit.register(worker.drop)


def wait_to_begin() -> None:
    """Wait for the word that the words are in order, in a child that began before they were looked at."""
    if GO not in os.environ:
        return
    with os.fdopen(int(os.environ.pop(GO)), encoding="ascii") as pipe:
        word = pipe.readline()
    if not word.endswith("\n"):
        os._exit(INTERRUPTED)  # who started it has ended, or needs it no more
    if word.strip():
        os.environ[MEMORY] = word.strip()


def early(words: Sequence[str]) -> Worker | None:
    """The child that was begun for these words already."""
    return _early.pop() if _early and _early[0].words == list(words) else None
