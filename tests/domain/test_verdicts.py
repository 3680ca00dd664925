"""A buffer is written, its result is read: nobody writes into verdicts that somebody else holds."""

import pickle
from dataclasses import fields, replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plan_cutters.domain.verdicts import ACCESSIBLE, INACCESSIBLE, INTERFERENCE_FREE, Verdicts, blank

COLUMNS = [each.name for each in fields(Verdicts)]


def filled(n, seed=0):
    """A buffer with something else in every place."""
    rng, buffer = np.random.default_rng(seed), blank(n)
    for name in COLUMNS:
        column = getattr(buffer, name)
        column[:] = rng.integers(0, 5, column.shape)
    return buffer


@pytest.mark.parametrize("made", ["freeze", "of", "replace", "pickle", "constructor"])
@pytest.mark.parametrize("name", COLUMNS)
def test_results_are_read_only(name, made):
    result = filled(4).freeze()
    result = {
        "freeze": lambda: result,
        "of": lambda: result.of(np.array([0, 2])),
        "replace": lambda: replace(result, verdict=np.zeros(4, np.uint8), tilt=np.zeros(4)),
        "pickle": lambda: pickle.loads(pickle.dumps(result)),
        "constructor": lambda: Verdicts(*(getattr(filled(4), each) for each in COLUMNS)),
    }[made]()
    with pytest.raises(ValueError, match="read-only"):
        getattr(result, name)[0] = 1
    assert result == pickle.loads(pickle.dumps(result))


@pytest.mark.parametrize("name", COLUMNS)
def test_what_is_frozen_cannot_be_written_through_its_buffer(name):
    buffer = filled(3)
    result, before = buffer.freeze(), getattr(buffer, name).copy()
    with pytest.raises(ValueError, match="read-only"):
        getattr(buffer, name)[:] = 0
    with pytest.raises(ValueError, match="read-only"):
        buffer.take(slice(None), blank(3))
    assert np.array_equal(getattr(result, name), before)


@given(st.integers(0, 12), st.integers(0, 99), st.data())
def test_what_is_taken_over_is_so_at_the_rows_given_alone(n, seed, data):
    other, rows = filled(n, seed).freeze(), np.array(data.draw(st.lists(st.booleans(), min_size=n, max_size=n)), bool)
    all_of_it, posture = blank(n), blank(n)
    all_of_it.take(rows, other)
    posture.take_posture(np.flatnonzero(rows), other)
    for name in COLUMNS:
        new, old = getattr(other, name), getattr(blank(n), name)
        mask = rows.reshape(-1, *[1] * (new.ndim - 1))
        assert np.array_equal(getattr(all_of_it, name), np.where(mask, new, old), equal_nan=new.dtype.kind == "f")
        kept = old if name in ("verdict", "reason") else np.where(mask, new, old)
        assert np.array_equal(getattr(posture, name), kept, equal_nan=new.dtype.kind == "f")


def test_a_posture_may_come_from_another_place():
    buffer, other = blank(3), filled(1)
    buffer.take_posture(2, other, 0)
    assert buffer.axis[2].tolist() == other.axis[0].tolist()
    assert np.isnan(buffer.tilt).tolist() == [True, True, False]


def test_upright_is_a_posture_along_the_normal():
    buffer, rows = blank(3), np.array([True, False, True])
    normal, across = np.eye(3), np.roll(np.eye(3), 1, axis=1)
    buffer.verdict[:] = [ACCESSIBLE, INACCESSIBLE, ACCESSIBLE]
    buffer.stand_upright(rows, normal, across)
    assert buffer.verdict.tolist() == [INTERFERENCE_FREE, INACCESSIBLE, INTERFERENCE_FREE]
    found = buffer.freeze().of(np.flatnonzero(rows))
    assert (found.axis == normal[rows]).all()
    assert (found.tilt_direction == across[rows]).all()
    assert (found.tilt == 0).all()
    assert (found.rotation == 0).all()
