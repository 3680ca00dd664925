"""Sharing rows out over threads: kernels release the GIL and write only their own rows."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor, as_completed

import numpy as np
from numpy.typing import NDArray

from plan_cutters.scene.work import METER

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
    work: Callable[[NDArray[np.int64]], int | None],
    rows: NDArray[np.int64],
    jobs: int,
    progress: Progress | None = None,
    chunk: int = CHUNK,
    *,
    fixed: bool = False,
) -> int:
    """Call `work` on consecutive pieces of `rows`, `chunk` rows each, `jobs` at a time; the sum of what it returns, boxes.

    `fixed`: where pieces end follows from the rows' own numbers, so that a row is in the company of the same ones whatever
    others are requested (`with_company`).

    An interrupt or an error drops the pieces that have not begun and is raised once those under way end.
    """
    ends = np.flatnonzero(np.diff(rows // chunk)) + 1 if fixed else np.arange(chunk, len(rows), chunk)
    pieces = [piece for piece in np.split(rows, ends) if len(piece)]
    total = 0
    if min(jobs, len(pieces)) <= 1:  # starting a thread takes longer than most single pieces do
        for done, piece in enumerate(pieces, 1):
            total += work(piece) or 0
            if progress:
                progress(done, len(pieces))
        METER.add(total)
        return total
    with ThreadPoolExecutor(jobs) as pool:
        futures = [pool.submit(work, piece) for piece in pieces]
        try:
            for done, future in enumerate(as_completed(futures), 1):
                total += future.result() or 0
                if progress:
                    progress(done, len(pieces))
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise
    METER.add(total)
    return total


def with_company(rows: NDArray[np.int64], n: int) -> NDArray[np.int64]:
    """Of n rows, all that are in one fixed piece with some of these."""
    numbers = np.arange(n, dtype=np.int64)
    return numbers[np.isin(numbers // CHUNK, rows // CHUNK)]
