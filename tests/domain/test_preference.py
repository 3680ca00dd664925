"""Which cutter is wanted first: the kind before the size, and of equal ones the first that was given."""

import itertools
import random

from hypothesis import given
from hypothesis import strategies as st

from plan_cutters import Cutter
from plan_cutters.domain.preference import by_radius, free_form_share, group_of, wanted
from plan_cutters.library.milling import Ask, entry_of
from plan_cutters.library.raw_tool import Listed
from plan_cutters.operations.plans import considered, of_wanted_kinds

BALL, BULL, FLAT = Cutter.parse("R3L40rc3"), Cutter.parse("R5L60rc1"), Cutter.parse("R8L80")
TAPERED = Cutter.parse("R1L40rc1T5")
BARREL = Cutter.barrel(radius=6, flank_radius=85, tip_radius=2, length=70, flutes=22.0)
LENS = Cutter.lens(radius=6, bottom_radius=20, corner_radius=1, length=60)
LOLLIPOP = Cutter.lollipop(radius=4, neck_radius=2, length=60)
ENGRAVING = Cutter.form([(0, 0), (0.15, 0), (3, 16)], length=31)
V_BIT, DOVETAIL = Cutter.parse("R0.1L40T30F8"), Cutter.parse("R6L40T-10F5")
EVERY = [BALL, BULL, FLAT, TAPERED, BARREL, LENS, LOLLIPOP, ENGRAVING, V_BIT, DOVETAIL]


@given(st.permutations(EVERY), st.sampled_from([0.0, 0.05, 0.1, 0.5, 1.0]))
def test_the_order_in_which_cutters_are_given_does_not_decide(order, share):
    assert wanted(order, free_form=share) == wanted(EVERY, free_form=share)
    assert by_radius(order) == by_radius(EVERY)


def test_equal_tools_keep_the_order_in_which_they_were_given():
    same = [Cutter.flat(radius=6, length=60, flutes=20.0 + k, name=f"tool {9 - k}") for k in range(4)]
    for order in itertools.permutations(same):
        assert wanted(order, free_form=0.0) == list(order)


@given(st.floats(0.5, 20.0), st.floats(0.5, 20.0))
def test_no_radius_lifts_a_kind_over_another(one, other):
    ball, flat = Cutter.ball(radius=one, length=60), Cutter.flat(radius=other, length=60)
    assert wanted([flat, ball], free_form=1.0) == [ball, flat]
    assert wanted([flat, ball], free_form=0.0) == [flat, ball]
    engraving = Cutter.form([(0, 0), (0.15, 0), (20, 50)], length=60)
    assert all(wanted([engraving, flat, ball], free_form=share)[-1] == engraving for share in (0.0, 1.0))


@given(st.lists(st.integers(1, 40), min_size=2, max_size=6, unique=True))
def test_of_a_kind_the_largest_comes_first(diameters):
    for kind in (Cutter.ball, Cutter.flat):
        ranked = wanted([kind(diameter=each, length=90) for each in diameters], free_form=1.0)
        assert [2 * each.radius for each in ranked] == sorted(diameters, reverse=True)


def test_kinds_on_free_form_faces_and_on_planes():
    assert wanted(EVERY, free_form=1.0) == [BULL, BALL, LENS, BARREL, LOLLIPOP, TAPERED, FLAT, DOVETAIL, ENGRAVING, V_BIT]
    assert wanted(EVERY, free_form=0.0) == [FLAT, BULL, BALL, LENS, BARREL, LOLLIPOP, TAPERED, DOVETAIL, ENGRAVING, V_BIT]


def test_a_round_tip_of_a_steep_cone_is_no_engraving_bit_and_a_draft_is_a_flat_end():
    assert group_of(Cutter.parse("R0.5L40rc0.5T10F12")) == "special"
    assert group_of(Cutter.parse("R4L40T3F20")) == "flat"


def test_what_a_library_calls_a_chamfer_mill_comes_last():
    values = {"DC": 6.0, "LCF": 17.0, "LPR": 31.0, "TA": 10.0, "TIP": 0.3, "DMM": 6.0}
    listed = Listed("tool 1", values=values, kind="chamfer mill", name="Two Flute Engraving Bit")
    assert group_of(entry_of(listed, Ask(holder="none")).cutter) == "last"


def test_shares_of_free_form_faces():
    assert free_form_share([("plane", 90.0), ("torus", 5.0), ("sculptured", 5.0)]) == 0.1
    assert free_form_share([("plane", float("nan")), ("cylinder", 1.0)]) == 0.0


def test_operations_are_compared_of_each_kind_and_what_is_needed_is_kept():
    balls = [Cutter.ball(diameter=each, length=60) for each in (12, 10, 8, 6, 4)]
    every = wanted([*balls, FLAT, ENGRAVING], free_form=0.5)
    assert considered(of_wanted_kinds(every, [balls[-1]], 0.5), [balls[-1]], 4) == (balls[0], balls[1], balls[-1], FLAT)
    # Where nearly all is free-form, a flat end is compared only if it is needed; an engraving bit never is otherwise.
    assert FLAT not in of_wanted_kinds(every, [balls[-1]], 1.0)
    assert FLAT in of_wanted_kinds(every, [FLAT], 1.0)
    assert ENGRAVING in of_wanted_kinds(every, [balls[0], ENGRAVING], 1.0)
    for seed in range(20):
        mixed = random.Random(seed).sample(every, len(every))
        needed = mixed[:2]
        assert set(needed) <= set(considered(of_wanted_kinds(mixed, needed, seed / 20), needed, 1))
