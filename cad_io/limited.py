"""A time limit for kernel calls: Python cannot interrupt them, but it can end a forked copy of the process."""

import faulthandler
import os
import select
import signal
import time
import warnings
from collections.abc import Callable


class TimeLimit(Exception):
    """The call did not end in time."""


class ChildDied(Exception):
    """The call ended without an answer: it crashed the process, or raised what its text says."""


def limited(call: Callable[[], bytes], seconds: float) -> bytes:
    """Result of `call()`, run in a forked copy of this process for at most `seconds`.

    Also survives a crash of the kernel. Where the system cannot fork (Windows), the call runs here, without a limit.

    Parameters
    ----------
    call : callable
        Must use nothing but Python and the kernel: threads of the parent do not exist in the copy.
    seconds : float
        Not positive: nothing is run.

    Raises
    ------
    TimeLimit, ChildDied
    """
    if seconds <= 0:
        raise TimeLimit
    if not hasattr(os, "fork"):
        return call()
    deadline = time.monotonic() + seconds
    end, start = os.pipe()
    with warnings.catch_warnings():
        # Python 3.12 warns of locks held by other threads; at worst the copy waits for one until the limit.
        warnings.simplefilter("ignore", DeprecationWarning)
        child = os.fork()
    if child == 0:
        _answer(call, start, seconds)
    os.close(start)
    parts: list[bytes] = []
    try:
        while select.select([end], [], [], max(deadline - time.monotonic(), 0))[0]:
            part = os.read(end, 1 << 20)
            if not part:
                break
            parts.append(part)
        else:
            raise TimeLimit
    finally:
        os.close(end)
        os.kill(child, signal.SIGKILL)
        _, status = os.waitpid(child, 0)
    answer = b"".join(parts)
    if not answer.startswith(b"+"):
        raise ChildDied(answer[1:].decode() or f"the kernel crashed (status {status})")
    return answer[1:]


def _answer(call: Callable[[], bytes], start: int, seconds: float) -> None:
    """The copy's side: write the answer, `+` and the result or `-` and what was raised, and end without clean-up."""
    try:
        try:
            faulthandler.disable()  # a crash here is told by the other side
            _end_alone(seconds)
            answer = b"+" + call()
        except Exception as error:
            answer = b"-" + f"{type(error).__name__} {error}".encode()
        with os.fdopen(start, "wb") as pipe:
            pipe.write(answer)
    finally:
        os._exit(0)


def _end_alone(seconds: float) -> None:
    """Come to an end even if the process that watches is killed."""
    import resource  # of systems that can fork

    soft, hard = resource.getrlimit(resource.RLIMIT_CPU)
    known = [limit for limit in (soft, hard, int(min(seconds, 1e9)) + 2) if limit != resource.RLIM_INFINITY]
    resource.setrlimit(resource.RLIMIT_CPU, (min(known), hard))
