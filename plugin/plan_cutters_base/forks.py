"""Forked copies of this process, and processes that end with the one that started them.

Whatever ended that one, and whatever they are doing themselves: Linux kills them at once. Elsewhere a copy of each looks after
its parent: a thread could not, for the CAD kernel does not let go of the interpreter while it works.
"""

import contextlib
import ctypes
import faulthandler
import math
import mmap
import os
import pickle
import select
import signal
import struct
import sys
import time
import warnings
from collections.abc import Callable, Iterator
from typing import Any, BinaryIO, Self

_SET_DEATH_SIGNAL = 1  # PR_SET_PDEATHSIG
#: Seconds between two looks at a parent, where the system itself does not look.
_PARENT_LOOK = 0.1
#: Seconds between two looks at a copy, and looks at one that sleeps and does nothing before it is taken for stuck.
_LOOK, _ASLEEP = 1.0, 60
#: Answers begin with their length in bytes.
_LENGTH = struct.Struct("<q")
_COUNTS = struct.Struct("<qq")


class Copy:
    """A copy of this process that does some work, without clean-up at its end. It ends with the block of `with`.

    Parameters
    ----------
    work : callable
        Gets a pipe to answer on. What it raises is lost.
    seconds : float
        Of processor time, after which the system ends the copy, by SIGXCPU.

    Attributes
    ----------
    status : int
        How it ended, once it has; 0, as if by itself, where someone else has waited for it: a program that ignores SIGCHLD, or
        waits for whatever ends.

    Raises
    ------
    OSError
        There is no room for another process.
    """

    def __init__(self, work: Callable[[BinaryIO], None], seconds: float) -> None:
        self.status = 0
        self._end, start = os.pipe()
        caller = os.getpid()
        try:
            with warnings.catch_warnings():
                # Python 3.12 warns of locks held by other threads; at worst the copy waits for one, which is noticed.
                warnings.simplefilter("ignore", DeprecationWarning)
                self._child = os.fork()
        except OSError:
            os.close(self._end)
            os.close(start)
            raise
        if self._child:
            os.close(start)
            return
        try:
            faulthandler.disable()  # a crash here is told by the other side
            end_with(caller)
            _end_alone(seconds)
            signal.signal(signal.SIGPROF, signal.SIG_DFL)
            with os.fdopen(start, "wb") as pipe:
                work(pipe)
        finally:
            os._exit(0)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        os.close(self._end)
        with contextlib.suppress(ChildProcessError, ProcessLookupError):
            # Asked first: the number of one that is waited for may be another process's by now.
            done, self.status = os.waitpid(self._child, os.WNOHANG)
            if not done:
                os.kill(self._child, signal.SIGKILL)
                self.status = os.waitpid(self._child, 0)[1]

    @property
    def out_of_time(self) -> bool:
        """Whether it was ended for its processor time."""
        return os.WIFSIGNALED(self.status) and os.WTERMSIG(self.status) in (signal.SIGPROF, signal.SIGXCPU)

    @property
    def speaks(self) -> bool:
        """Whether it has said something that is not read, or has ended."""
        ready = select.poll()
        ready.register(self._end, select.POLLIN)
        return bool(ready.poll(0))

    def parts(self, late: Callable[[], float] | None = None) -> Iterator[bytes]:
        """Yield all that it says, as it comes, until its side closes; `late` gives the seconds to wait before it is asked again.

        By default it is waited for as long as it does not sleep without end.

        Raises
        ------
        TimeoutError
            There is nothing left to wait.
        """
        late = late or _stuck(self._child)
        ready = select.poll()  # `select` itself knows no numbers above 1023
        ready.register(self._end, select.POLLIN)
        while (wait := late()) > 0:
            if ready.poll(1000.0 * min(wait, _LOOK)):
                part = os.read(self._end, 1 << 20)
                if not part:
                    return
                yield part
        raise TimeoutError

    def answers(self, waiting: Callable[[], None] | None = None) -> Iterator[Any]:
        """Yield what it tells by `tell`, as it comes, until it ends: half an answer is none.

        Parameters
        ----------
        waiting : callable, optional
            Called about once a second for as long as the copy works.

        Raises
        ------
        TimeoutError
            It sleeps and does nothing.
        """
        data, late = bytearray(), _stuck(self._child)

        def looked() -> float:
            if waiting is not None:
                waiting()
            return late()

        for part in self.parts(looked):
            data += part
            while len(data) >= _LENGTH.size:
                whole = _LENGTH.size + _LENGTH.unpack_from(data)[0]
                if len(data) < whole:
                    break
                yield pickle.loads(bytes(data[_LENGTH.size : whole]))
                del data[:whole]


class Gauge:
    """How far the work is, in memory that a process and its copies share: who tells it never waits for who reads it."""

    def __init__(self) -> None:
        self._memory = mmap.mmap(-1, _COUNTS.size)
        self.tell(0, 1)

    def tell(self, done: int, total: int) -> None:
        """Say how many pieces are done, of how many."""
        _COUNTS.pack_into(self._memory, 0, done, total)

    @property
    def counts(self) -> tuple[int, int]:
        """Pieces that are done, and all of them; (0, 1) before anything was told."""
        done, total = _COUNTS.unpack_from(self._memory)
        return min(done, total), total  # it may be told just now


def end_within(seconds: float) -> None:
    """Have the system end this copy after so much more processor time, by SIGPROF; zero: not any more."""
    # Unlike the limit of a process, it counts fractions of a second.
    signal.setitimer(signal.ITIMER_PROF, seconds)


def tell(pipe: BinaryIO, answer: object) -> None:
    """Write an answer for `Copy.answers` to read."""
    data = pickle.dumps(answer)
    pipe.write(_LENGTH.pack(len(data)) + data)
    pipe.flush()


def _stuck(child: int) -> Callable[[], float]:
    """Seconds to wait until it is asked again; none once the copy has slept at so many looks. Never while it works."""
    idle, before, looked = 0, "", -math.inf

    def late() -> float:
        nonlocal idle, before, looked
        # Asked after each part of a long answer, too: a copy sleeps while its words are taken.
        if time.monotonic() - looked < _LOOK:
            return _LOOK
        looked = time.monotonic()
        try:
            with open(f"/proc/{child}/stat", encoding="ascii", errors="replace") as file:
                state, *fields = file.read().rpartition(")")[2].split()
        except OSError:
            return _LOOK
        spent = " ".join(fields[10:12])
        idle = idle + 1 if state in "SDT" and spent == before else 0
        before = spent
        return _LOOK if idle < _ASLEEP else 0.0

    return late


def _end_alone(seconds: float) -> None:
    """Have the system end this process after so much processor time, even if the one that watches is gone; no dump."""
    import resource  # of systems that can fork

    soft, hard = resource.getrlimit(resource.RLIMIT_CPU)
    known = [limit for limit in (soft, hard, math.ceil(min(seconds, 1e9))) if limit != resource.RLIM_INFINITY]
    resource.setrlimit(resource.RLIMIT_CPU, (min(known), hard))
    resource.setrlimit(resource.RLIMIT_CORE, (0, resource.getrlimit(resource.RLIMIT_CORE)[1]))


def end_with(parent: int) -> None:
    """Have this process killed as soon as its parent has ended.

    On Linux the end of the thread that started it counts, too: it must be one that waits. Where there is no fork (Windows),
    nothing is done.

    Parameters
    ----------
    parent : int
        Its process number, asked for before this process began: it may have ended meanwhile.
    """
    if not hasattr(os, "fork"):
        return
    if not _killed_by_the_system():
        _looked_after(parent)
    if os.getppid() != parent:
        os.kill(os.getpid(), signal.SIGKILL)


def outlive() -> None:
    """Take `end_with` back, on Linux."""
    _killed_by_the_system(0)


def _killed_by_the_system(number: int = signal.SIGKILL) -> bool:
    """Ask Linux to end this process by a signal, 0 for none; False where it cannot be asked."""
    if sys.platform != "linux":
        return False
    none = ctypes.c_ulong(0)
    return ctypes.CDLL(None).prctl(_SET_DEATH_SIGNAL, ctypes.c_ulong(number), none, none, none) == 0


def _looked_after(parent: int) -> None:
    """Start a copy that kills this process once its parent is gone, and has been waited for where it had a parent itself."""
    me = os.getpid()
    if os.fork():
        return
    try:
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        os.closerange(0, 1 << 12)  # who waits for the end of a pipe must not wait for this copy
        while os.getppid() == me:
            try:
                os.kill(parent, 0)
            except ProcessLookupError:
                os.kill(me, signal.SIGKILL)
            except PermissionError:
                pass
            time.sleep(_PARENT_LOOK)
    finally:
        os._exit(0)
