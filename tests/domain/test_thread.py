"""Threads by their designations, and tolerances of holes."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cad_io.arrays import SizeNote
from plan_cutters.domain.thread import Tolerance, thread_in, thread_of, tolerance_in


@pytest.mark.parametrize(("text", "name", "diameter", "pitch", "fit", "left"), [
    ("M4", "M4", 4.0, 0.7, "", False), ("M4x0.7 - 6H", "M4", 4.0, 0.7, "6H", False),
    ("M8 x 1", "M8x1", 8.0, 1.0, "", False),
    ("M2,5", "M2.5", 2.5, 0.45, "", False), ("4X M10x1.25-6H THRU", "M10x1.25", 10.0, 1.25, "6H", False),
    ("M6 x 12 deep", "M6", 6.0, 1.0, "", False), ("M5-LH", "M5", 5.0, 0.8, "", True),
    ("M12-6H LH", "M12", 12.0, 1.75, "6H", True),
    ("1/4-20 UNC-2B", "1/4-20 UNC", 6.35, 1.27, "2B", False), ("#10-32 UNF", "#10-32 UNF", 4.826, 0.79375, "", False),
    ("10-24 UNC - 2B", "10-24 UNC", 4.826, 1.058333, "2B", False), (".250-28 UNF", ".250-28 UNF", 6.35, 0.907143, "", False),
    ("1-8 UNC", "1-8 UNC", 25.4, 3.175, "", False), ("1-14 UNS", "1-14 UNS", 25.4, 1.814286, "", False),
    ("2X 1 1/4-7 UNC-2B", "1 1/4-7 UNC", 31.75, 3.628571, "2B", False),
])  # fmt: skip
def test_a_designation_is_a_thread(text, name, diameter, pitch, fit, left):
    thread = thread_of(text)
    assert (thread.name, thread.fit, thread.left) == (name, fit, left)
    assert (thread.diameter, thread.pitch) == pytest.approx((diameter, pitch), abs=1e-5)


@pytest.mark.parametrize("text", [
    "", "4X", "theoretical", "DIM4", "M", "M0", "M99", "M7.3", "0/4-20 UNC", "1/0-20 UNC", "20-20", "M8 BOLT",
    "for M8", "M16 clearance", "UNC", "#13-20 UNC", "10-24", "H7", "12 deep",
])  # fmt: skip
def test_other_texts_are_none(text):
    assert thread_of(text) is None


@given(st.text("M0123456789x.,-/ #UNCFLH", max_size=12))
def test_any_text_is_read_or_is_none(text):
    thread = thread_of(text)
    assert thread is None or (0.0 < thread.pitch < thread.diameter and thread.core > 0.0)


def test_a_hole_of_another_size_has_not_the_thread_of_its_note():
    sizes = [SizeNote((1,), notes=("M4",))]
    fits = [diameter for diameter in (2.9, 3.242, 3.3, 3.6, 4.0, 4.3, 5.0) if thread_in(sizes, diameter)]
    assert fits == [3.242, 3.3, 3.6, 4.0]
    assert thread_in([*sizes, SizeNote((1,), notes=("M4x0.5",))], 3.3) is None
    assert thread_in([], 3.3) is None


def test_a_tolerance_is_one_that_is_stated():
    assert tolerance_in([SizeNote((1,), 8.0)], 8.0) is None
    assert tolerance_in([SizeNote((1,), 8.0, -0.01, 0.02)], 8.0) == Tolerance(8.0, -0.01, 0.02, "")
    assert tolerance_in([SizeNote((1,), 8.0, fit="H7"), SizeNote((1,), 8.0, fit="H8")], 8.0) is None


@pytest.mark.parametrize(("tolerance", "reamed"), [
    (Tolerance(10.0, None, None, "H7"), True), (Tolerance(10.0, None, None, "H9"), True),
    (Tolerance(10.0, None, None, "H11"), False),
    (Tolerance(10.0, 0.0, 0.015, ""), True), (Tolerance(10.0, 0.0, 0.036, ""), True), (Tolerance(10.0, 0.0, 0.05, ""), False),
    (Tolerance(10.0, -0.1, 0.1, ""), False), (Tolerance(50.0, 0.0, 0.06, ""), True),
])  # fmt: skip
def test_what_a_drill_does_not_hold_is_reamed(tolerance, reamed):
    """ISO 286: H9 of 10 mm is 36 um, of 50 mm 62 um."""
    assert tolerance.reamed == reamed
