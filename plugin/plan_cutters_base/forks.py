"""Forked copies of this process, and processes that end with the one that started them.

Calls of the CAD kernel are made in copies: what hangs or crashes is ended, and costs that call alone. A copy makes one call
(`limited`), one after another (`each`), or one while this process does other work (`SideProcess`).

They end with it, whatever ended it and whatever they are doing themselves: Linux kills them at once. Elsewhere a copy of each
looks after its parent: a thread could not, for the CAD kernel does not let go of the interpreter while it works.
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
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import Any, BinaryIO, Generic, Self, TypeVar, cast

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


Item = TypeVar("Item")
Done = TypeVar("Done")


class TimeLimit(Exception):
    """The call did not end in time."""


class ChildDied(Exception):
    """The call ended without an answer: it crashed the process, or raised what its text says."""


class Ended(Exception):
    """There is no answer about an item: `str` says why, as the end of a sentence about it."""


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
    with Copy(partial(_answer, call), seconds if processor else seconds + 2) as copy:
        try:
            answer = b"".join(copy.parts(None if processor else _until(seconds)))
        except TimeoutError:
            raise TimeLimit from None
    if copy.out_of_time:
        raise TimeLimit
    if not answer.startswith(b"+"):
        raise ChildDied(answer[1:].decode() or f"the kernel crashed (status {copy.status})")
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


def each(call: Callable[[Item], Done], items: Sequence[Item], *, seconds: float, hangs: int = 2) -> Iterator[Done | Ended]:
    """Yield the result of `call` for each item, in the order of the items.

    It runs in a forked copy of this process, which ends with it and is made again behind an item that ends it. Where the
    system cannot fork (Windows), it runs here, without a limit.

    Parameters
    ----------
    call : callable
        Must use nothing but Python and the kernel; its results are pickled. What it raises is raised here.
    items : sequence
    seconds : float
        Processor time that one item may take.
    hangs : int
        So many items may take longer, or crash the copy: behind the last of them, nothing is tried any more.

    Yields
    ------
    What `call` returned, or an `Ended` for an item that has no answer.
    """
    if not hasattr(os, "fork"):
        yield from map(call, items)
        return
    first, remaining = 0, hangs
    while first < len(items):
        if remaining <= 0:
            yield from (Ended("was not tried, for others before it did not come to an end") for _ in items[first:])
            return
        why = ""
        with Copy(partial(_work, call, items[first:], seconds), seconds * (len(items) - first + 1)) as copy:
            try:
                for answer in copy.answers():
                    first += 1
                    if isinstance(answer, Exception):
                        raise answer
                    yield cast(Done, answer)
            except TimeoutError:
                why = "waits for ever"
        if first < len(items):
            remaining -= 1
            first += 1
            yield Ended(
                why
                or (f"does not come to an end within {seconds:g} s" if copy.out_of_time else f"crashes (status {copy.status})")
            )


def _work(call: Callable[[Item], Done], items: Sequence[Item], seconds: float, pipe: BinaryIO) -> None:
    """The copy's side: an answer for each item, up to the first that raises."""
    for item in items:
        end_within(seconds)
        try:
            answer: object = call(item)
        except Exception as error:
            answer = error
        end_within(0.0)
        tell(pipe, answer)
        if isinstance(answer, Exception):
            break


class SideProcess(Generic[Done]):
    """A call that may be under way in a copy of this process, while the process itself does other work.

    Nothing depends on the copy, which ends with the block of `with`: where it crashes, raises, hangs or cannot be made, the call
    is made here, with all the care that is taken here.

    Parameters
    ----------
    call : callable
        Its result is pickled. It must not depend on threads of this process, and repeats all that it does when called again.
    seconds : float
        Of processor time, after which the copy is given up.
    worth : bool
        Whether to make a copy at all: that takes some hundredths of a second.
    """

    def __init__(self, call: Callable[[], Done], seconds: float, *, worth: bool = True) -> None:
        self._call, self._seconds = call, seconds
        self._worth = worth and hasattr(os, "fork")
        self._copy: Copy | None = None

    def __enter__(self) -> "SideProcess[Done]":
        if self._worth:
            with contextlib.suppress(OSError):
                self._copy = Copy(lambda pipe: tell(pipe, self._call()), self._seconds)
        return self

    def __exit__(self, *_: object) -> None:
        """Leave nothing of the copy."""
        if self._copy is not None:
            copy, self._copy = self._copy, None
            copy.__exit__()

    @property
    def works(self) -> bool:
        """Whether there is a copy: then this process should do something else before it asks for the result."""
        return self._copy is not None

    def ended(self) -> Done | None:
        """Return the result if the call has ended in the copy; None otherwise: nothing is waited for, and nothing done here."""
        if self._copy is not None and self._copy.speaks:
            with contextlib.suppress(TimeoutError):
                for answer in self._copy.answers():
                    return cast(Done, answer)
        return None

    def result(self, here: Callable[[], Done] | None = None, waiting: Callable[[], None] | None = None) -> Done:
        """Return the result of the call.

        Where the copy gives none, this process makes the call itself: `here` in its place, if that is given, which may
        report its progress. `waiting` is called about once a second for as long as the copy is waited for.
        """
        if self._copy is not None:
            try:
                for answer in self._copy.answers(waiting):
                    return cast(Done, answer)
            except TimeoutError:
                pass
            finally:
                self.__exit__()
        return (here or self._call)()
