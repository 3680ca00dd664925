"""Calls of the CAD kernel in copies of this process: what hangs or crashes is ended, and costs that call alone.

A copy makes one call (`limited`), one after another (`each`), or one while this process does other work (`SideProcess`).
"""

import contextlib
import os
import time
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import BinaryIO, Generic, TypeVar, cast

from plan_cutters_base.forks import Copy, end_within, tell

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
