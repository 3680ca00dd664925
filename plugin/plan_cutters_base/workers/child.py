"""A process of this program that another one starts, and leaves nothing of."""

import atexit
import contextlib
import os
import signal
import subprocess
import sys
from collections.abc import Mapping, Sequence
from typing import Any

from plan_cutters_base.workers.assignment import VARIABLE, Assignment, assignment, began, is_child

#: Seconds after which a child that was asked to end is asked again.
_TWICE = 0.5


def can_supervise() -> bool:
    """Whether this system lets one process hand a pipe to another and end it with all its copies (not Windows)."""
    return hasattr(os, "killpg") and hasattr(os, "sysconf")


class Child:
    """A child process in a session of its own: an interrupt from the terminal reaches it through us alone.

    It does not find modules in the folder that it works in, where users keep files of any name.

    Parameters
    ----------
    words : sequence of str
        Of the interpreter.
    there : Assignment
        What it is to know.
    session : bool
        Whether it has a session of its own; without, it ends with the session of this process.
    environment : mapping, optional
        In place of that of this process.
    streams
        More words of `subprocess.Popen`.
    """

    def __init__(
        self, words: Sequence[str], there: Assignment, *, session: bool = True,
        environment: Mapping[str, str] | None = None, **streams: Any,
    ) -> None:  # fmt: skip
        known = os.environ if environment is None else environment
        self._session = session
        self.process = subprocess.Popen(
            [sys.executable, "-P", *words], env={**known, VARIABLE: str(there)}, start_new_session=session, **streams
        )

    def ended(self, seconds: float | None = None) -> int | None:
        """Its exit code once it has ended; None where it has not within some seconds."""
        with contextlib.suppress(subprocess.TimeoutExpired):
            return self.process.wait(seconds)
        return None

    def kill(self) -> None:
        """Kill it, the copies that it has made of itself for the kernel, and who compiles for it."""
        if not self._session or not hasattr(os, "killpg"):
            self.process.kill()
            return
        with contextlib.suppress(ProcessLookupError, PermissionError):  # macOS says so of those that have ended
            os.killpg(self.process.pid, signal.SIGKILL)

    def end(self, grace: float = 0.0) -> None:
        """Leave nothing of it running: it is asked first where it has some seconds to end in order, then killed.

        It is asked twice: a command that has something to write ends at once then.
        """
        if grace and self.process.poll() is None:
            self.process.terminate()
            if self.ended(min(grace, _TWICE)) is None:
                self.process.terminate()
                self.ended(grace)
        self.kill()
        self.process.wait()


def command(name: str, words: Sequence[str]) -> list[str]:
    """Words of the interpreter by which it runs a command of a name that `command.entry.begin` takes."""
    return ["-c", f"from plan_cutters.command.entry import begin; begin({name!r})", *words]


def compiler(maps: bool) -> Child:
    """The process that compiles what every plan needs, and what posture maps do. It ends with this one."""
    words = ["-m", "plan_cutters.command.background_compile", *(["maps"] if maps else [])]
    nowhere = subprocess.DEVNULL
    return Child(words, Assignment(parent=os.getpid()), session=False, stdin=nowhere, stdout=nowhere, stderr=nowhere)


class Worker(Child):
    """The child that does the whole job of a command, and reports on a pipe.

    Parameters
    ----------
    words : sequence of str
        Of the command.
    name : str
        Its name.
    memory, done, excluded
        As of `Assignment`.
    waits : bool
        Whether it waits for `begin`.
    """

    def __init__(
        self, words: Sequence[str], name: str, memory: int | None = None, *, waits: bool = False, done: int = 0,
        excluded: Mapping[int, str] | None = None,
    ) -> None:  # fmt: skip
        self.words, self.waits = list(words), waits
        self.here, report = os.pipe()
        go, self.go = os.pipe() if waits else (None, -1)
        there = Assignment(parent=os.getpid(), report=report, go=go, memory=memory, began=began(), done=done,
                           excluded=excluded or {}, job=assignment().job)  # fmt: skip
        fds = tuple(each for each in (report, go) if each is not None)
        super().__init__(command(name, words), there, pass_fds=fds)
        for each in fds:
            os.close(each)

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


def early(words: Sequence[str]) -> Worker | None:
    """The child that was begun for these words already."""
    return _early.pop() if _early and _early[0].words == list(words) else None
