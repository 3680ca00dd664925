"""An assignment is what a process knows of the one that started it, as one environment variable; reports go back to that."""

import contextlib
import functools
import json
import os
import threading
import time
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path

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
    """An assignment says to a process what it is to know.

    Attributes
    ----------
    parent : int, optional
        The process with which it is to end.
    report : int, optional
        Number of the pipe to report on: only a worker of the command has one.
    go : int, optional
        Number of the pipe on which it is told that its words are in order, where it began before they were looked at.
    memory : int, optional
        Bytes of address space that it may use.
    began : float, optional
        When the command began (`time.monotonic`).
    done : int
        Parts that are done.
    excluded : mapping
        Of the next one, by face number, why nothing more is to be asked about a face.
    job : str, optional
        The file with a job of a batch (`job_input`).
    """

    parent: int | None = None
    report: int | None = None
    go: int | None = None
    memory: int | None = None
    began: float | None = None
    done: int = 0
    excluded: Mapping[int, str] = field(default_factory=dict)
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


@dataclass(frozen=True)
class JobInput:
    """Options and a part of a batch, for the process that plans it; in a file, for the words of a command cannot hold them.

    Only the `Assignment` names the file: a pickle must come from nobody but ourselves.

    Attributes
    ----------
    options, part : bytes, optional
        Pickled; None where the words of the command have them. To unpickle a part loads the CAD kernel.
    """

    options: bytes | None = None
    part: bytes | None = None


def job_input() -> JobInput:
    """Return what was handed to this process: nothing where no batch has started it."""
    if (file := assignment().job) is None:
        return JobInput()
    import pickle

    result: JobInput = pickle.loads(Path(file).read_bytes())
    return result


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
        ticks = int(Path("/proc/self/stat").read_text().rpartition(")")[2].split()[19])
        age = max(age, time.clock_gettime(time.CLOCK_BOOTTIME) - ticks / os.sysconf("SC_CLK_TCK"))
    return time.monotonic() - age


def follow_parent() -> None:
    """End when the parent does, however it ends: nobody else would wait for what this process makes."""
    if (parent := assignment().parent) is not None:
        from plan_cutters_base.forks import end_with

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
