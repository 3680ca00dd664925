"""A process of this program that another one starts: what it knows, what it reports, how it begins and ends."""

import atexit
import contextlib
import functools
import json
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any, NamedTuple

from plan_cutters_base.forks import end_with, process_status

#: Environment variable with the record, as JSON.
VARIABLE = "PLAN_CUTTERS_ASSIGNMENT"
#: One line at a time: stages tell from their threads.
_WRITING = threading.Lock()
#: Exit code of an interrupted run.
INTERRUPTED = 130
#: Of a run with a part that took longer than it may: as of `timeout`, the program.
TIMED_OUT = 124


@dataclass(frozen=True, slots=True)
class Assignment:
    """An assignment says to a process what it is to know."""

    #: The process with which it is to end.
    parent: int | None = None
    #: Number of the pipe to report on: only a worker of the command has one.
    report: int | None = None
    #: Number of the pipe on which it is told that its words are in order, where it began before they were looked at.
    go: int | None = None
    #: Bytes of address space that it may use.
    memory: int | None = None
    #: When the command began (`time.monotonic`).
    began: float | None = None
    #: Parts that are done.
    done: int = 0
    #: Of the next one, by face number, why nothing more is to be asked about a face.
    excluded: Mapping[int, str] = field(default_factory=dict)
    #: The file with a job of a batch (`job_input`).
    job: str | None = None

    def __str__(self) -> str:
        return json.dumps(asdict(self))


@functools.lru_cache(maxsize=1)
def _decoded(text: str) -> Assignment:
    record = json.loads(text)
    return Assignment(**record | {"excluded": {int(face): why for face, why in record["excluded"].items()}})


def assignment() -> Assignment:
    """The record of this process; an empty one where nobody of ours has started it."""
    text = os.environ.get(VARIABLE)
    return _decoded(text) if text else Assignment()


class JobInput(NamedTuple):
    """Options and a part of a batch, for the process that plans it; in a file, for the words of a command cannot hold them.

    Both are pickled; None where the words have them. To unpickle a part loads the CAD kernel. Only the `Assignment` names the
    file: a pickle must come from nobody but ourselves.
    """

    options: bytes | None = None
    part: bytes | None = None


def job_input() -> JobInput:
    """Return what was handed to this process: nothing where no batch has started it."""
    if (file := assignment().job) is None:
        return JobInput()
    import pickle

    return JobInput(*pickle.loads(Path(file).read_bytes()))


def is_child() -> bool:
    """Whether this process was started by `supervise`."""
    return assignment().report is not None


def report(word: str, text: str) -> None:
    """Tell the parent, if there is one: `part FILE`, `staging FOLDER`, `stage NAME`, `detail TEXT`, `at DONE TOTAL`,
    `work WHOSE FACE`, `say TEXT`, `show TEXT`, `cases JSON`, `failed TEXT`, `stands`, `safe CODE FOLDER`,
    `summarised`, `done CODE`.

    `cases`: of this part, for a report; `failed`: why there are none; `say`: for people; `show`: for them, on standard output;
    `stands`: verdicts of this part stand, so that an interrupt has something to write; `safe`: the plan of this part is in the
    folder, models follow; `summarised`: its summary was shown; `done`: all is done.
    """
    pipe = assignment().report
    if pipe is None:
        return
    # Names of files may hold line ends, and bytes that are no text.
    line = f"{word} ".encode() + text.encode("unicode_escape") + b"\n"
    try:
        with _WRITING:
            while line:
                line = line[os.write(pipe, line) :]
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
    if (stated := assignment().began) is not None:
        return stated
    age = time.process_time()
    with contextlib.suppress(OSError, ValueError, AttributeError, IndexError):  # only Linux has all of it
        age = max(age, time.clock_gettime(time.CLOCK_BOOTTIME) - int(process_status("self")[19]) / os.sysconf("SC_CLK_TCK"))
    return time.monotonic() - age


def follow_parent() -> None:
    """End when the parent does, however it ends: nobody else would wait for what this process makes."""
    if (parent := assignment().parent) is not None:
        end_with(parent)


def limit_memory() -> None:
    """Keep to the memory limit that the parent set."""
    if (memory := assignment().memory) is not None:
        import resource

        with contextlib.suppress(ValueError, OSError):  # macOS has no such limit
            resource.setrlimit(resource.RLIMIT_AS, (memory, memory))


def wait_to_begin() -> None:
    """Wait for the word that the words are in order, in a child that began before they were looked at."""
    here = assignment()
    if here.go is None:
        return
    with os.fdopen(here.go, encoding="ascii") as pipe:
        word = pipe.readline()
    if not word.endswith("\n"):
        os._exit(INTERRUPTED)  # who started it has ended, or needs it no more
    os.environ[VARIABLE] = str(replace(here, go=None, memory=int(word) if word.strip() else here.memory))


#: Seconds after which a child that was asked to end is asked again.
_TWICE = 0.5


def can_supervise() -> bool:
    """Whether this system lets one process hand a pipe to another and end it with all its copies (not Windows)."""
    return hasattr(os, "killpg") and hasattr(os, "sysconf")


class Child:
    """A child process in a session of its own: an interrupt from the terminal reaches it through us alone.

    It does not find modules in the folder that it works in, where users keep files of any name. `words` are of the interpreter,
    `there` is what it is to know. Without a `session` of its own, it ends with that of this process. `environment` stands in
    place of that of this process; `streams` are more words of `subprocess.Popen`.
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
    """The child that does the whole job of a command of a name, and reports on a pipe; `waits`: for `begin`."""

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
