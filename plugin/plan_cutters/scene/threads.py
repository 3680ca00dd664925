"""Sharing rows out over threads: kernels release the GIL and write only their own rows."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor, as_completed

import numpy as np
from numpy.typing import NDArray

#: Rows a call; fixed, so that results do not depend on the number of threads.
CHUNK = 512

Progress = Callable[[int, int], None]


def in_chunks(
    work: Callable[[NDArray[np.int64]], None],
    rows: NDArray[np.int64],
    jobs: int,
    progress: Progress | None = None,
    chunk: int = CHUNK,
) -> None:
    """Call `work` on consecutive pieces of `rows`, `chunk` rows each, `jobs` at a time.

    An interrupt or an error drops the pieces that have not begun and is raised once those under way end.
    """
    pieces = [rows[i : i + chunk] for i in range(0, len(rows), chunk)]
    with ThreadPoolExecutor(jobs) as pool:
        futures = [pool.submit(work, piece) for piece in pieces]
        try:
            for done, future in enumerate(as_completed(futures), 1):
                future.result()
                if progress:
                    progress(done, len(pieces))
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise
