"""Forked copies of this process, and processes that end with the one that started them.

Calls of the CAD kernel are made in copies: what hangs or crashes is ended, and costs that call alone. A copy makes one call
(`limited`), one after another (`each`), or one while this process does other work (`SideProcess`). Calls must use nothing but
Python and the kernel, for threads of this process do not exist in a copy; results are pickled. Where the system cannot fork
(Windows), calls are made here, without a limit.

Copies end with the process that made them, whatever ended it and whatever they are doing: Linux kills them at once. Elsewhere a
copy of each looks after its parent: a thread could not, for the CAD kernel does not let go of the interpreter while it works.
"""

import contextlib
import ctypes
import faulthandler
import math
import mmap
import os
import signal
import struct
import sys
import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, Generic, Self, TypeVar, cast

if TYPE_CHECKING:
    from multiprocessing.connection import Connection

Item = TypeVar("Item")
Done = TypeVar("Done")

_SET_DEATH_SIGNAL = 1  # PR_SET_PDEATHSIG
#: Seconds between two looks at a parent, where the system itself does not look.
_PARENT_LOOK = 0.1
#: Seconds between two looks at a copy, and looks at one that sleeps and does nothing before it is taken for stuck.
_LOOK, _ASLEEP = 1.0, 60
_COUNTS = struct.Struct("<qq")


class TimeLimit(Exception):
    """The call did not end in time."""


class ChildDied(Exception):
    """The call ended without an answer: it crashed the process, or raised what its text says."""


class Ended(Exception):
    """There is no answer about an item: `str` says why, as the end of a sentence about it."""


class Copy:
    """A copy of this process that does some work, without clean-up at its end. It ends with the block of `with`.

    `work` gets a pipe to `send` answers on; what it raises is lost. After so many `seconds` of processor time the system ends the
    copy, by SIGXCPU. An OSError where there is no room for another process. `status` says how it ended, once it has; 0, as if by
    itself, where someone else has waited for it: a program that ignores SIGCHLD, or waits for whatever ends.
    """

    def __init__(self, work: Callable[["Connection"], None], seconds: float) -> None:
        from multiprocessing import Pipe  # most processes make no copy

        self.status = 0
        self._here, there = Pipe(duplex=False)
        caller = os.getpid()
        try:
            with warnings.catch_warnings():
                # Python 3.12 warns of locks held by other threads; at worst the copy waits for one, which is noticed.
                warnings.simplefilter("ignore", DeprecationWarning)
                self._child = os.fork()
        except OSError:
            self._here.close()
            there.close()
            raise
        if self._child:
            there.close()
            return
        try:
            faulthandler.disable()  # a crash here is told by the other side
            end_with(caller)
            _end_alone(seconds)
            signal.signal(signal.SIGPROF, signal.SIG_DFL)
            work(there)
        finally:
            os._exit(0)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._here.close()
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

    def speaks(self, seconds: float = 0.0) -> bool:
        """Whether it has said something that is not read, or has ended; waited for, at most so long."""
        return self._here.poll(seconds)

    def answers(self, waiting: Callable[[], None] = lambda: None, until: float = math.inf) -> Iterator[Any]:
        """Yield what it sends, as it comes, until it ends: half an answer is none.

        `waiting` is called about once a second for as long as the copy works. A TimeoutError where it is given up: at `until`, as
        `time.monotonic` counts, or, without that, once it sleeps and does nothing.
        """
        stuck = _stuck(self._child)
        while (wait := min(_LOOK, until - time.monotonic())) > 0.0:
            waiting()
            if math.isinf(until) and stuck():
                break
            if not self.speaks(wait):
                continue
            try:
                answer = self._here.recv()
            except (EOFError, OSError):
                return
            yield answer
        raise TimeoutError


def limited(
    call: Callable[[], Done], seconds: float, *, processor: bool = False, passing: tuple[type[Exception], ...] = ()
) -> Done:
    """Result of `call()`, made in a copy for at most `seconds`, which also survives a crash of the kernel.

    By the clock a busy machine may get another result than an idle one; by processor time (`processor`) it gets the same, later.
    A copy that does nothing at all for a minute, waiting for a lock for one, is ended then, too (only on Linux: elsewhere nothing
    tells). Where `seconds` are not positive, nothing is run. A TimeLimit or ChildDied where there is no result; errors of the
    kinds in `passing` are raised as they are.
    """
    if seconds <= 0:
        raise TimeLimit
    if not hasattr(os, "fork"):
        return call()

    def work(pipe: "Connection") -> None:
        try:
            pipe.send(call())
        except passing as error:
            pipe.send(error)
        except Exception as error:
            pipe.send(ChildDied(f"{type(error).__name__} {error}"))

    # By the clock this side ends it.
    until = math.inf if processor else time.monotonic() + seconds
    with Copy(work, seconds if processor else seconds + 2) as copy:
        try:
            for answer in copy.answers(until=until):
                if isinstance(answer, Exception) and isinstance(answer, (ChildDied, *passing)):
                    raise answer
                return cast(Done, answer)
        except TimeoutError:
            raise TimeLimit from None
    raise TimeLimit if copy.out_of_time else ChildDied(f"the kernel crashed (status {copy.status})")


def each(call: Callable[[Item], Done], items: Sequence[Item], *, seconds: float, hangs: int = 2) -> Iterator[Done | Ended]:
    """Yield the result of `call` for each item, in their order, or an `Ended` for an item that has no answer.

    They are made in a copy, which is made again behind an item that ends it. What `call` raises is raised here. An item may take
    so many `seconds` of processor time; so many items, `hangs`, may take longer or crash the copy: behind the last of them,
    nothing is tried any more.
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
            ended = f"does not come to an end within {seconds:g} s" if copy.out_of_time else f"crashes (status {copy.status})"
            yield Ended(why or ended)


def _work(call: Callable[[Item], Done], items: Sequence[Item], seconds: float, pipe: "Connection") -> None:
    """The copy's side: an answer for each item, up to the first that raises."""
    for item in items:
        end_within(seconds)
        try:
            answer: object = call(item)
        except Exception as error:
            answer = error
        end_within(0.0)
        pipe.send(answer)
        if isinstance(answer, Exception):
            break


class SideProcess(Generic[Done]):
    """A call that may be under way in a copy of this process, while the process itself does other work.

    Nothing depends on the copy, which ends with the block of `with`: where it crashes, raises, hangs or cannot be made, the call
    is made here, with all the care that is taken here; so it repeats all that it does when called again. The copy is given up
    after so many `seconds` of processor time. `worth`: whether to make one at all: that takes some hundredths of a second.
    """

    def __init__(self, call: Callable[[], Done], seconds: float, *, worth: bool = True) -> None:
        self._call, self._seconds = call, seconds
        self._worth = worth and hasattr(os, "fork")
        self._copy: Copy | None = None

    def __enter__(self) -> Self:
        if self._worth:
            with contextlib.suppress(OSError):
                self._copy = Copy(lambda pipe: pipe.send(self._call()), self._seconds)
        return self

    def __exit__(self, *_: object) -> None:
        if self._copy is not None:
            copy, self._copy = self._copy, None
            copy.__exit__()

    @property
    def works(self) -> bool:
        """Whether there is a copy: then this process should do something else before it asks for the result."""
        return self._copy is not None

    def ended(self) -> Done | None:
        """Return the result if the call has ended in the copy; None otherwise: nothing is waited for, and nothing done here."""
        if self._copy is not None and self._copy.speaks():
            with contextlib.suppress(TimeoutError):
                for answer in self._copy.answers():
                    return cast(Done, answer)
        return None

    def result(self, here: Callable[[], Done] | None = None, waiting: Callable[[], None] = lambda: None) -> Done:
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


def process_status(number: int | str | None) -> list[str]:
    """What Linux says of a process, from its state on (`man proc_pid_stat`, field 3); empty where the system does not tell."""
    try:
        with open(f"/proc/{number}/stat", encoding="utf-8", errors="replace") as file:
            return file.read().rpartition(")")[2].split()
    except OSError:
        return []


def _stuck(child: int) -> Callable[[], bool]:
    """Whether a copy has slept at so many looks, whoever asks how often: a copy sleeps while its words are taken, too."""
    idle, before, looked = 0, [""], -math.inf

    def stuck() -> bool:
        nonlocal idle, before, looked
        if time.monotonic() - looked >= _LOOK and (fields := process_status(child)):
            looked = time.monotonic()
            idle = idle + 1 if fields[0] in "SDT" and fields[11:13] == before else 0
            before = fields[11:13]
        return idle >= _ASLEEP

    return stuck


def _end_alone(seconds: float) -> None:
    """Have the system end this process after so much processor time, even if the one that watches is gone; no dump."""
    import resource  # of systems that can fork

    soft, hard = resource.getrlimit(resource.RLIMIT_CPU)
    known = [limit for limit in (soft, hard, math.ceil(min(seconds, 1e9))) if limit != resource.RLIM_INFINITY]
    resource.setrlimit(resource.RLIMIT_CPU, (min(known), hard))
    resource.setrlimit(resource.RLIMIT_CORE, (0, resource.getrlimit(resource.RLIMIT_CORE)[1]))


def end_with(parent: int) -> None:
    """Have this process killed as soon as its parent has ended; where there is no fork (Windows), nothing is done.

    On Linux the end of the thread that started it counts, too: it must be one that waits. `parent`: its process number, asked for
    before this process began, for it may have ended meanwhile.
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


def _killed_by_the_system(number: int = 9) -> bool:
    """Ask Linux to end this process by a signal (9, SIGKILL, has no name on Windows), 0 for none; False where it cannot be."""
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
