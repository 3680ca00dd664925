"""A time limit for kernel calls: Python cannot interrupt them, but it can end a forked copy of the process."""

import os
import time
from collections.abc import Callable
from functools import partial
from typing import BinaryIO

from cad_io.forks import begin, ended, out_of_time, parts_of, stuck


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
    # By the clock this side ends it.
    end, child = begin(partial(_answer, call), seconds if processor else seconds + 2)
    answer, status = b"", 0
    try:
        answer = b"".join(parts_of(end, stuck(child) if processor else _until(seconds)))
    except TimeoutError:
        raise TimeLimit from None
    finally:
        os.close(end)
        status = ended(child)
    if out_of_time(status):
        raise TimeLimit
    if not answer.startswith(b"+"):
        raise ChildDied(answer[1:].decode() or f"the kernel crashed (status {status})")
    return answer[1:]


def _until(seconds: float) -> Callable[[], float]:
    deadline = time.monotonic() + seconds
    return lambda: deadline - time.monotonic()


def _answer(call: Callable[[], bytes], pipe: BinaryIO) -> None:
    """The copy's side: write `+` and the result, or `-` and what was raised."""
    try:
        answer = b"+" + call()
    except Exception as error:
        answer = b"-" + f"{type(error).__name__} {error}".encode()
    pipe.write(answer)
