"""Work: shared out over threads, and counted, not timed.

Kernels release the GIL and write only their own rows. What stops by counted work stops at the same place on every machine.
"""

import threading
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

#: Whoever counts may do so beside others.
_LOCK = threading.Lock()


@dataclass(slots=True)
class Work:
    """Count the work that kernels have done."""

    looked: int = 0  #: Boxes of the tree, and what else takes as long: nodes of a grid, triangles, and a share of each rotation.

    def add(self, looked: int) -> None:
        """Count what a kernel has looked at."""
        with _LOCK:
            self.looked += looked


#: That of all kernels of this process, whoever called them: stages are told apart by it.
METER = Work()


class Budget:
    """So much work from now on, of this process.

    `most`: boxes.
    """

    def __init__(self, most: float) -> None:
        self._most, self._begun = most, METER.looked

    @property
    def left(self) -> float:
        """Boxes that may still be looked at, 0 where it is spent."""
        return max(0.0, self._most - (METER.looked - self._begun))


#: Rows a call; fixed, so that results do not depend on the number of threads.
CHUNK = 512

Progress = Callable[[int, int], None]
#: Steps in which the progress of a part of some work is told.
_STEPS = 1000


def part_of(tell: Progress, part: int, parts: int) -> Progress:
    """Tell the progress of one of several like parts of some work as that of all of it.

    >>> told = []
    >>> part_of(lambda done, total: told.append(done / total), 1, 4)(1, 2)
    >>> told
    [0.375]
    """

    def told(done: int, total: int) -> None:
        tell(_STEPS * part + _STEPS * done // max(1, total), _STEPS * parts)

    return told


def in_chunks(
    work: Callable[[NDArray[np.int64]], int | None], rows: NDArray[np.int64], jobs: int, progress: Progress | None = None,
    chunk: int = CHUNK, *, fixed: bool = False, counted: Work | None = None,
) -> int:  # fmt: skip
    """Call `work` on consecutive pieces of `rows`, `chunk` rows each, `jobs` at a time; the sum of what it returns, boxes.

    `fixed`: where pieces end follows from the rows' own numbers, so that a row is in the company of the same ones whatever
    others are requested (`with_company`). `counted`: takes the boxes, too.

    An interrupt or an error drops the pieces that have not begun and is raised once those under way end.
    """
    ends = np.flatnonzero(np.diff(rows // chunk)) + 1 if fixed else np.arange(chunk, len(rows), chunk)
    # Most calls are for a few rows, which `np.split` takes longer to cut than many a kernel to judge.
    pieces = np.split(rows, ends) if len(ends) else [rows] if len(rows) else []
    if jobs == 1 or len(pieces) <= 1:  # a thread costs more than many a piece
        total = _total(map(work, pieces), len(pieces), progress)
    else:
        with ThreadPoolExecutor(jobs) as pool:
            futures = [pool.submit(work, piece) for piece in pieces]
            try:
                total = _total((future.result() for future in as_completed(futures)), len(pieces), progress)
            except BaseException:
                pool.shutdown(cancel_futures=True)
                raise
    for each in (METER, *([] if counted is None else [counted])):
        each.add(total)
    return total


def _total(results: Iterable[int | None], count: int, progress: Progress | None) -> int:
    total = 0
    for done, result in enumerate(results, 1):
        total += result or 0
        if progress:
            progress(done, count)
    return total


def evenly(rows: NDArray[np.int64], most: int) -> NDArray[np.int64]:
    """At most so many of some rows, evenly spread."""
    return rows if len(rows) <= most else rows[np.unique(np.linspace(0, len(rows) - 1, max(1, most)).astype(np.int64))]


def with_company(rows: NDArray[np.int64], n: int) -> NDArray[np.int64]:
    """Of n rows, all that are in one fixed piece with some of these."""
    numbers = np.arange(n, dtype=np.int64)
    return numbers[np.isin(numbers // CHUNK, rows // CHUNK)]
