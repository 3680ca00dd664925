"""Rows shared out over threads: the same pieces, sums and progress however many threads, and none for a single piece."""

import threading

import numpy as np
import pytest

from plan_cutters.scene.threads import in_chunks


def asked(count, jobs, chunk=10):
    """Sum, pieces by their first rows, progress, and whether all of it was done in this thread."""
    seen, told, here = [], [], []

    def work(piece):
        seen.append((int(piece[0]), len(piece)))
        here.append(threading.current_thread() is threading.main_thread())
        return len(piece)

    total = in_chunks(work, np.arange(count), jobs, lambda done, of: told.append((done, of)), chunk)
    return total, sorted(seen), told, all(here)


@pytest.mark.parametrize("count", [0, 7, 10, 11, 35])
def test_the_number_of_threads_changes_nothing(count):
    alone, many = asked(count, 1), asked(count, 3)
    assert alone[:3] == many[:3]
    pieces = -(-count // 10)
    assert alone[0] == count
    assert alone[2] == [(k, pieces) for k in range(1, pieces + 1)]
    assert alone[3]
    assert many[3] == (pieces <= 1)


@pytest.mark.parametrize("jobs", [1, 3])
@pytest.mark.parametrize("count", [5, 35])
def test_an_error_is_raised_and_nothing_begins_behind_it(jobs, count):
    begun = []

    def fails(piece):
        begun.append(piece[0])
        raise ValueError("no room")

    with pytest.raises(ValueError, match="no room"):
        in_chunks(fails, np.arange(count), jobs, chunk=10)
    assert 1 <= len(begun) <= (1 if jobs == 1 else -(-count // 10))
