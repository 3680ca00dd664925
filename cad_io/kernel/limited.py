"""A time limit for kernel calls: Python cannot interrupt them, but it can end a forked copy of the process."""

import faulthandler
import math
import os
import select
import signal
import time
import warnings
from collections.abc import Callable
from contextvars import ContextVar

from cad_io.lifetime import end_with

#: How many threads of the kernel's own a copy may use. They are kept in a pool that does not survive a fork: more than one only
#: where this process has never had the kernel use any.
KERNEL_THREADS: ContextVar[int] = ContextVar("KERNEL_THREADS", default=1)

#: Looks, one a second, at a copy that sleeps and does nothing before it is taken for stuck.
_ASLEEP = 60


class TimeLimit(Exception):
    """The call did not end in time."""


class ChildDied(Exception):
    """The call ended without an answer: it crashed the process, or raised what its text says."""


def limited(call: Callable[[], bytes], seconds: float, *, processor: bool = False) -> bytes:
    """Result of `call()`, run in a forked copy of this process for at most `seconds`.

    Also survives a crash of the kernel. The copy ends with this process, whatever ends that. Where the system cannot fork
    (Windows), the call runs here, without a limit.
    By the clock a busy machine may get another result than an idle one; by processor time it gets the same, later.

    Parameters
    ----------
    call : callable
        Must use nothing but Python and the kernel: threads of the parent do not exist in the copy.
    seconds : float
        Not positive: nothing is run.
    processor : bool
        Count the copy's processor time, not the clock's. A copy that does nothing at all for a minute, waiting for a
        lock for one, is ended, too (only on Linux: elsewhere nothing tells).

    Raises
    ------
    TimeLimit, ChildDied
    """
    if seconds <= 0:
        raise TimeLimit
    if not hasattr(os, "fork"):
        return call()
    end, start = os.pipe()
    caller = os.getpid()
    with warnings.catch_warnings():
        # Python 3.12 warns of locks held by other threads; at worst the copy waits for one until the limit.
        warnings.simplefilter("ignore", DeprecationWarning)
        child = os.fork()
    if child == 0:
        # By the clock the other side ends it.
        _answer(call, start, seconds if processor else seconds + 2, caller)
    os.close(start)
    answer = b""
    try:
        answer = _read(end, _stuck(child) if processor else _until(seconds))
    finally:
        os.close(end)
        os.kill(child, signal.SIGKILL)
        _, status = os.waitpid(child, 0)
    if os.WIFSIGNALED(status) and os.WTERMSIG(status) == getattr(signal, "SIGXCPU", None):
        raise TimeLimit
    if not answer.startswith(b"+"):
        raise ChildDied(answer[1:].decode() or f"the kernel crashed (status {status})")
    return answer[1:]


def _read(end: int, late: Callable[[], float]) -> bytes:
    """All that comes until the other side closes; `late` gives the seconds to wait before it is asked again."""
    parts: list[bytes] = []
    while True:
        wait = late()
        if wait <= 0:
            raise TimeLimit
        if select.select([end], [], [], wait)[0]:
            part = os.read(end, 1 << 20)
            if not part:
                return b"".join(parts)
            parts.append(part)


def _until(seconds: float) -> Callable[[], float]:
    deadline = time.monotonic() + seconds
    return lambda: deadline - time.monotonic()


def _stuck(child: int) -> Callable[[], float]:
    """Never late while the process works, or waits for a processor: only after so many looks at it sleeping."""
    idle, before = 0, ""

    def late() -> float:
        nonlocal idle, before
        try:
            with open(f"/proc/{child}/stat", encoding="ascii", errors="replace") as file:
                state, *fields = file.read().rpartition(")")[2].split()
        except OSError:
            return 1.0
        spent = " ".join(fields[10:12])
        idle = idle + 1 if state in "SDT" and spent == before else 0
        before = spent
        return 1.0 if idle < _ASLEEP else 0.0

    return late


def _answer(call: Callable[[], bytes], start: int, seconds: float, caller: int) -> None:
    """The copy's side: write the answer, `+` and the result or `-` and what was raised, and end without clean-up."""
    try:
        try:
            faulthandler.disable()  # a crash here is told by the other side
            end_with(caller)
            _end_alone(seconds)
            answer = b"+" + call()
        except Exception as error:
            answer = b"-" + f"{type(error).__name__} {error}".encode()
        with os.fdopen(start, "wb") as pipe:
            pipe.write(answer)
    finally:
        os._exit(0)


def _end_alone(seconds: float) -> None:
    """Have the system end this process after so much processor time, even if the one that watches is gone; no dump."""
    import resource  # of systems that can fork

    soft, hard = resource.getrlimit(resource.RLIMIT_CPU)
    known = [limit for limit in (soft, hard, math.ceil(min(seconds, 1e9))) if limit != resource.RLIM_INFINITY]
    resource.setrlimit(resource.RLIMIT_CPU, (min(known), hard))
    resource.setrlimit(resource.RLIMIT_CORE, (0, resource.getrlimit(resource.RLIMIT_CORE)[1]))
