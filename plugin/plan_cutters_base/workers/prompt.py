"""A shell at its prompt waits for the process that it started: that one may end while a copy of it goes on.

The first process does nothing but wait for its copy, which does what the command does. It ends with the exit code of the copy, or
with the one that the copy hands over before its end (`let_go`).
"""

import contextlib
import os
import select
import signal
import sys
from typing import NoReturn

from plan_cutters_base.forks import end_with, outlive

#: What ends a command in order.
_SIGNALS = (signal.SIGINT, signal.SIGTERM, *([signal.SIGHUP] if hasattr(signal, "SIGHUP") else []))
#: How often the first process looks what its copy says, s.
_LOOK = 0.05
#: The pipe to the first process, in the copy.
_waiting: list[int] = []


def at_prompt() -> bool:
    """Whether a shell at its prompt started this process: it leads the job on a terminal, and the session is another one's.

    What a script starts is in the job of the script, and what a container starts is the session. Only Linux lets a process end
    with another one until further notice.
    """
    with contextlib.suppress(OSError):
        return sys.platform == "linux" and all(map(os.isatty, range(3))) and os.getsid(0) != os.getpid() == os.getpgrp()
    return False


def copy_and_wait() -> None:
    """Go on in a copy of this process, which waits for it. The copy ends with this one, unless `let_go` was called."""
    here, there = os.pipe()
    first = os.getpid()
    signal.pthread_sigmask(signal.SIG_BLOCK, _SIGNALS)
    try:
        copy = os.fork()
    except OSError:  # no room for another process: this one does all
        copy, first = 0, 0
        os.close(there)
    if copy:
        os.close(there)
        _wait(copy, here)
    os.close(here)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, _SIGNALS)
    if first:
        end_with(first)
        _waiting.append(there)


def is_waited_for() -> bool:
    """Whether a first process waits for this one, which may be let go."""
    return bool(_waiting)


def let_go(code: int) -> None:
    """Let the first process end with an exit code. This one goes on by itself, and has no more to do with the terminal."""
    os.setsid()
    outlive()
    nowhere = os.open(os.devnull, os.O_RDWR)
    for number in range(3):
        os.dup2(nowhere, number)
    os.close(nowhere)
    with contextlib.suppress(BrokenPipeError):
        os.write(there := _waiting.pop(), f"{code}\n".encode())
        os.close(there)


def _wait(copy: int, here: int) -> NoReturn:
    """End as the copy does, or as it says; a signal to this process alone is handed on, for those of a terminal reach both."""
    while not select.select([here], [], [], 0.0)[0]:
        came = signal.sigtimedwait(_SIGNALS, _LOOK)
        if came is not None and came.si_code <= 0:  # of a process
            with contextlib.suppress(ProcessLookupError):
                os.kill(copy, came.si_signo)
    word = os.read(here, 64)
    if word:
        os._exit(int(word))
    ended = os.waitstatus_to_exitcode(os.waitpid(copy, 0)[1])
    os._exit(ended if ended >= 0 else 128 - ended)
