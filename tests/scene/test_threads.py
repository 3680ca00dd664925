"""Rows are shared out over threads: each piece once, the same pieces whatever the number of threads, none where one is enough."""

import threading
import time

import numpy as np
import pytest

from plan_cutters.scene.work import in_chunks

ROWS = np.arange(3, 1203, 2)


@pytest.mark.parametrize("fixed", [False, True])
@pytest.mark.parametrize(("jobs", "chunk"), [(1, 100), (2, 100), (2, 5000)])
def test_every_row_is_in_one_piece_and_progress_and_sum_are_of_all(jobs, chunk, fixed):
    pieces, told, threads = [], [], set()

    def work(rows):
        pieces.append(rows)
        threads.add(threading.current_thread())
        return len(rows)

    assert in_chunks(work, ROWS, jobs, lambda *done: told.append(done), chunk, fixed=fixed) == len(ROWS)
    assert sorted(np.concatenate(pieces).tolist()) == ROWS.tolist()
    assert told == [(k + 1, len(pieces)) for k in range(len(pieces))]
    if fixed:
        assert all(len(set((rows // chunk).tolist())) == 1 for rows in pieces)
    # A thread is started only where there are others, and pieces for them.
    assert (threads == {threading.current_thread()}) == (jobs == 1 or len(pieces) == 1)
    assert in_chunks(work, ROWS[:0], jobs) == 0


@pytest.mark.parametrize("jobs", [1, 2])
def test_an_error_is_raised_and_drops_what_has_not_begun(jobs):
    begun = []

    def work(rows):
        begun.append(rows)
        if rows[0] == ROWS[0]:
            raise KeyboardInterrupt
        time.sleep(0.02)  # all of them would take seconds

    with pytest.raises(KeyboardInterrupt):
        in_chunks(work, ROWS, jobs, chunk=1)
    assert len(begun) < len(ROWS)
