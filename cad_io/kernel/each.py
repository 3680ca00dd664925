"""The kernel's work on one thing after another, in a copy that can be ended: what hangs or crashes costs that thing alone."""

import os
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import BinaryIO, TypeVar, cast

from cad_io.forks import answers, begin, end_within, ended, out_of_time, tell

Item = TypeVar("Item")
Done = TypeVar("Done")


class Ended(Exception):
    """There is no answer about an item: `str` says why, as the end of a sentence about it."""


def each(
    call: Callable[[Item], Done], items: Sequence[Item], *, seconds: float, hangs: int = 2
) -> Iterator[Done | Ended]:
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
        end, child = begin(partial(_work, call, items[first:], seconds), seconds * (len(items) - first + 1))
        why, status = "", 0
        try:
            for answer in answers(end, child):
                first += 1
                if isinstance(answer, Exception):
                    raise answer
                yield cast(Done, answer)
        except TimeoutError:
            why = "waits for ever"
        finally:
            os.close(end)
            status = ended(child)
        if first < len(items):
            remaining -= 1
            first += 1
            yield Ended(why or _failure(status, seconds))


def _failure(status: int, seconds: float) -> str:
    if out_of_time(status):
        return f"does not come to an end within {seconds:g} s"
    return f"crashes (status {status})"


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
