"""Necks of several sections, and how many sections an assembly may have: the search has a bit for each of its pieces."""

import numpy as np
import pytest

from plan_cutters import Cutter, CutterError, Holder, Options, Segment
from plan_cutters.domain.assembly import assembly
from plan_cutters.domain.preference import inside
from plan_cutters.domain.shapes import MOST_PIECES, pieces_at_most
from tests.support.tool_reference import random_cutter


@pytest.mark.parametrize("spec", ["R3L60F12N2.5x4N2.5:4x6S4", "R3L60F12N2.5:4x6S4", "R3L60F12N2.5x4N3x5N2x6"])
def test_a_spec_with_several_necks_is_the_id_of_its_cutter(spec):
    assert Cutter.parse(spec).id == spec


def test_one_neck_has_one_form():
    one, same = (Cutter.flat(radius=3, length=40, flutes=10.0, neck=neck) for neck in (Segment(2, 5), [Segment(2, 5)]))
    assert one == same
    assert one.neck == Segment(2, 5)
    assert Cutter.flat(radius=3, length=40, neck=()) == Cutter.flat(radius=3, length=40)
    with pytest.raises(CutterError, match="a Segment or several"):
        Cutter.flat(radius=3, length=40, neck=(Segment(2, 5), 3))


def test_a_neck_in_parts_is_nested_as_the_whole():
    whole = Cutter.parse("R3L60F12N2x10S3")
    parts = Cutter.parse("R3L60F12N2x4N2x6S3")
    wider = Cutter.parse("R3L60F12N2x4N2.5x6S3")
    assert inside(whole, parts)
    assert inside(parts, whole)
    assert inside(whole, wider)
    assert not inside(wider, whole)


def test_no_assembly_has_more_pieces_than_are_counted():
    """Of all kinds, under every offset that the search and the depth of witnesses ask for."""
    rng, seen = np.random.default_rng(5), 0
    for kind in ("flat", "ball", "taper ball", "lollipop", "barrel", "oval", "lens", "form", "form re-entrant"):
        for _ in range(40):
            cutter = random_cutter(rng, kind)
            most = pieces_at_most(cutter)
            for flutes, rest in ((0.008, -0.002), (0.012, 0.002), (0.4, 0.4), (2.0, 2.0)):
                for how in ("outer", "inner"):
                    count = assembly(cutter, flutes, rest, kind=how).piece.shape[1]
                    assert count <= most
                    seen = max(seen, count)
    assert seen > 10


def test_more_sections_than_there_are_bits_are_refused():
    """Beyond them a piece would be forgotten, and what it hits called free."""
    rings = Holder(tuple(Segment(10 + i % 2, 1.0) for i in range(30)))
    with pytest.raises(CutterError, match="too many to judge"):
        Cutter.flat(radius=3, length=30, holder=rings)
    with pytest.raises(CutterError, match="too many to judge"):
        Options(cutters="R3L30", holder=rings).judged  # noqa: B018
    many = [(0.0, 0.0), *((1.0 + 0.01 * i, 0.1 * i) for i in range(70))]
    with pytest.raises(CutterError, match="too many to judge"):
        Cutter.form(many, length=30)
    assert 14 * 4 < MOST_PIECES < 64
