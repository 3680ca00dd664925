"""Outlines against the chain that the tests' own reference makes of a cutter, against pieces, and against closed forms."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plan_cutters import Cutter, Holder, OptionError, Segment
from plan_cutters.domain.assembly import assembly
from plan_cutters.domain.outline import outline, points
from tests.support.tool_reference import KINDS, Reference, in_row, random_cutter

SEEDS = st.tuples(st.sampled_from(KINDS), st.integers(0, 1 << 32))


def cutter_of(drawn):
    kind, seed = drawn
    return random_cutter(np.random.default_rng(seed), kind, loose=False)


def chain_length(chain):
    return sum(math.dist(e[:2], e[2:]) if kind == "line" else e[2] * (e[4] - e[3]) for kind, *e in chain.elements)


@settings(deadline=None)
@given(SEEDS)
def test_it_is_the_chain_of_the_reference(drawn):
    cutter = cutter_of(drawn)
    found, chain = outline(cutter), Reference(cutter).whole
    polyline = points(found, 1e-3)
    assert np.abs(chain.distance(*polyline.T)).max() < 1e-9
    assert sum(segment.length for segment in found.segments) == pytest.approx(chain_length(chain), rel=1e-9)
    assert found.height == pytest.approx(chain.high)
    assert found.widest == pytest.approx(max(cutter.radius, Reference(cutter).wide))


@settings(deadline=None)
@given(SEEDS)
def test_segments_follow_each_other_from_axis_to_axis_and_never_fall(drawn):
    found = outline(cutter_of(drawn))
    assert found.segments[0].start == (0.0, 0.0)
    assert found.segments[-1].end == (0.0, found.height)
    for one, other in pairwise(found.segments):
        assert one.end == other.start
    for segment in found.segments:
        assert segment.end[1] >= segment.start[1] - 1e-9
        for share, end in ((0.0, segment.start), (1.0, segment.end)):
            assert math.dist(segment.at(share), end) < 1e-9
        a, b = segment.at(0.5), segment.at(0.5 + 1e-6)
        along = segment.direction(0.5)
        assert math.hypot(*along) == pytest.approx(1.0)
        assert along[0] * (b[0] - a[0]) + along[1] * (b[1] - a[1]) == pytest.approx(math.dist(a, b), rel=1e-4)
    assert [s.part for part in found.parts for s in found.of(part)] == [s.part for s in found.segments]


@settings(deadline=None)
@given(SEEDS, st.floats(0.02, 0.98))
def test_just_within_it_is_in_a_piece_and_just_without_in_none(drawn, share):
    cutter = cutter_of(drawn)
    made = assembly(cutter, 0.0, 0.0)
    rows, lift = made.piece[0], made.mode[0, 4]
    for segment in outline(cutter).segments:
        if segment.length < 1e-3:
            continue
        (q, w), (a, b) = segment.at(share), segment.direction(share)
        # To the left of the way along an outline is the tool.
        for side, inside in ((1e-6, True), (-1e-6, False)):
            r, h = q - side * b, w + side * a
            deepest = max(in_row(row, abs(r), h - lift) for row in rows)
            assert (deepest > 0.0) == inside, (segment, side)


@settings(deadline=None)
@given(SEEDS, st.floats(1e-4, 3.0))
def test_a_polyline_keeps_its_chord(drawn, chord):
    found = outline(cutter_of(drawn))
    polyline, dense = points(found, chord), points(found, 1e-5)
    nearest = np.full(len(dense), np.inf)
    for a, b in pairwise(polyline):
        along = b - a
        share = np.clip((dense - a) @ along / (along @ along), 0.0, 1.0)
        nearest = np.minimum(nearest, np.linalg.norm(dense - a - share[:, None] * along, axis=1))
    assert nearest.max() <= chord * (1.0 + 1e-9) + 1e-12


def test_a_polyline_has_no_more_points_than_its_chord_needs():
    # 2 R sin(t/4)^2 = chord: a quarter of a circle of radius 8 to 0.01 takes chords of 0.1 rad: 16 of them, and 3 lines.
    found = points(outline(Cutter.ball(radius=8, length=40)), 0.01)
    assert len(found) == 1 + 16 + 2
    assert len(points(outline(Cutter.ball(radius=8, length=40)), 100.0)) == 1 + 4 + 2


@pytest.mark.parametrize("chord", [0.0, -1.0, math.nan])
def test_a_chord_is_positive(chord):
    with pytest.raises(OptionError, match="positive number of mm"):
        points(outline(Cutter.parse("R6L80")), chord)


def volume(polyline):
    """Of the solid that a polyline (radius, height) makes about the axis: frusta."""
    (r0, h0), (r1, h1) = polyline[:-1].T, polyline[1:].T
    return math.pi / 3.0 * float(((h1 - h0) * (r0 * r0 + r0 * r1 + r1 * r1)).sum())


def test_volumes_are_those_of_closed_forms():
    def of(cutter):
        return volume(points(outline(cutter), 1e-7))

    ball = Cutter.ball(radius=3, length=20, flutes=8, neck=Segment(2, 4, 2.5), shank_radius=4, holder="R10:12L6+R15L30")
    frustum = math.pi / 3 * (4 * (4 + 5 + 6.25) + 6 * (100 + 120 + 144))
    cylinders = math.pi * (9 * 5 + 16 * 8 + 225 * 30)
    assert of(ball) == pytest.approx(18 * math.pi + frustum + cylinders, rel=1e-6)
    # A ball but for its cap, on a neck.
    lollipop = Cutter.lollipop(radius=5, neck_radius=3, length=30)
    assert of(lollipop) == pytest.approx(math.pi * 81 * (15 - 9) / 3 + math.pi * 9 * 21, rel=1e-6)
    # Pappus: the bull nose's corner is a quarter of a disk, its centroid 4 r / 3 pi from its centre.
    bull = Cutter.bull(radius=6, corner_radius=2, length=10)
    corner = 2 * math.pi * (4 + 8 / (3 * math.pi)) * math.pi
    assert of(bull) == pytest.approx(math.pi * (36 * 8 + 16 * 2) + corner, rel=1e-6)
    # A lens without a corner: a cap of a ball, then a cylinder.
    lens = Cutter.lens(radius=6, bottom_radius=10, corner_radius=0, length=20)
    assert of(lens) == pytest.approx(math.pi * 4 * (30 - 2) / 3 + math.pi * 36 * 18, rel=1e-6)


def test_parts_and_which_of_two_a_step_belongs_to():
    cutter = Cutter.bull(radius=6, corner_radius=1, length=80, flutes=20, neck=Segment(5, 40), shank_radius=7,
                         holder=Holder((Segment(20, 10), Segment(15, 10))))  # fmt: skip
    found = outline(cutter)
    assert found.parts == ("flutes", "neck", "shank", "holder")
    steps = {s.start[1]: s.part for s in found.segments if s.start[1] == s.end[1]}
    assert steps == {0.0: "flutes", 20.0: "flutes", 60.0: "shank", 80.0: "holder", 90.0: "holder", 100.0: "holder"}
    arc = found.segments[1]
    assert (arc.centre, arc.radius, arc.turn) == ((5.0, 1.0), 1.0, pytest.approx(math.pi / 2))
    assert found.widest == 20.0


def test_what_is_as_wide_as_the_next_has_no_step():
    found = outline(Cutter.ball(radius=6, length=60, flutes=6, shank_radius=6))
    assert [(s.part, s.end) for s in found.segments] == [
        ("flutes", pytest.approx((6.0, 6.0))), ("shank", (6.0, 60.0)), ("shank", (0.0, 60.0))]  # fmt: skip


def test_the_tightest_barrels_and_lenses_are_whole():
    # A flank as large as the barrel is a ball's; a lens's bottom as large as its radius is one, too.
    for cutter in (
        Cutter.barrel(radius=5, flank_radius=5, height=2, length=6),
        Cutter.lens(radius=5, bottom_radius=5, corner_radius=1, length=20),
        Cutter.barrel(radius=5, flank_radius=1e7, height=10, length=20),
    ):
        polyline = points(outline(cutter))
        assert np.isfinite(polyline).all()
        assert polyline[:, 0].max() == pytest.approx(5.0, abs=1e-2)
