"""Words of vises and chucks: what they mean, and that they are written as they are read."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plan_cutters.domain.clamping import CHUCKS, VISES, Block, Chuck, Disc, Vise, chuck_about, chuck_for, requested, vises_for
from plan_cutters.domain.fixture import Fixture
from plan_cutters.errors import FixtureError
from plan_cutters.setups.solids import triangles_of


@pytest.mark.parametrize(
    ("word", "sizes"),
    [
        ("vise", ()),
        ("vise:5", (5.0,)),
        ("VISE:77x30x120", (77.0, 30.0, 120.0, 3.0)),
        ("vise:77x30x120:4", (77.0, 30.0, 120.0, 4.0)),
        ("vise:3x1x5:in", (76.2, 25.4, 127.0, 3.0)),
        ("chuck", ()),
        ("chuck:4x40", (4.0, 40.0, 3.0)),
        ("chuck:3x2:in", (3.0, 50.8, 3.0)),
    ],
)
def test_a_word_is_to_be_placed_and_says_its_sizes(word, sizes):
    fixture = Fixture.parse(word)
    assert fixture.to_place
    assert fixture.follows_setup
    assert fixture.clamping is None
    assert fixture.sizes == pytest.approx(sizes)
    assert fixture.name == word.split(":")[0].lower()


@pytest.mark.parametrize("word", ["vise:77x30x120:3:50@1,2,3,0,90,0", "chuck:3x40:3:50@1,2,3", "vise:46x25x65:3:0.5"])
def test_all_numbers_are_a_place_of_its_own_and_are_read_as_they_are_written(word):
    fixture = Fixture.parse(word)
    assert not fixture.to_place
    assert not fixture.follows_setup
    assert fixture.text == word
    assert Fixture.parse(fixture.text) == fixture
    assert fixture.source == fixture.clamping.word


@pytest.mark.parametrize(
    "word",
    [
        "vise:0x1x1", "vise:nan", "vise:inf", "vise:", "vise:77x30", "vise:77x30x120:3:130", "vise:77x30x120:0",
        "vise:77x3x120:3",
        "vise:axbxc", "vise:1x2x3x4", "vise:-3", "vise:77x30x120:3:50:7", "vise:3:50", "vise:1e7x30x120",
        "vise@0,0,5", "vise:nanx1x1",
        "chuck:1x5", "chuck:7x40", "chuck:2.5x40", "chuck:3x2:3", "chuck:3x40:3:0", "chuck:nanx5", "chuck@1,2,3",
    ],
)  # fmt: skip
def test_what_says_nothing_is_refused_in_a_line(word):
    with pytest.raises(FixtureError) as error:
        Fixture.parse(word)
    assert "\n" not in str(error.value)
    assert len(str(error.value)) < 220


def test_the_smallest_size_that_takes_a_part():
    assert vises_for(65.0)[0].opening == 65.0
    assert vises_for(65.1)[0].opening == 120.0
    assert vises_for(max(each[2] for each in VISES) + 1.0) == ()
    assert chuck_for(56.0) == 80.0
    assert chuck_for(56.1) == 100.0
    assert [*VISES] == sorted(VISES)
    assert [*CHUCKS] == sorted(CHUCKS)


def volume(vertex):
    """By the divergence theorem: positive where triangles run counter-clockwise seen from outside."""
    return float(np.einsum("ni,ni->n", vertex[:, 0], np.cross(vertex[:, 1], vertex[:, 2])).sum()) / 6.0


def closed(vertex):
    """Each edge is run along as often one way as the other."""
    ends = np.round(np.stack([vertex, np.roll(vertex, -1, axis=1)], axis=2).reshape(-1, 6), 9) + 0.0
    turned = np.concatenate([ends[:, 3:], ends[:, :3]], axis=1)
    return sorted(map(tuple, ends)) == sorted(map(tuple, turned))


@pytest.mark.parametrize(
    "clamping",
    [
        Vise(77, 30, 120, 3, 50),
        Vise(46, 25, 65, 3, 4),
        Vise(46, 25, 65, 21.5, 40, bored=True),
        chuck_about(50.0, 3.0),
        Chuck(6, 30, 3, 5),
    ],
)
def test_bodies_are_closed_and_hold_what_their_sizes_say(clamping):
    """Independent truth: areas of rectangles and circles times heights; of a bored jaw, the trapezium less a circle's segment."""
    vertex, error = triangles_of(clamping, 0.001)
    assert closed(vertex)
    expected = 0.0
    for solid in clamping.solids(0.001):
        high = solid.high - solid.low
        if isinstance(solid, Disc):
            expected += math.pi * solid.radius**2 * high
            continue
        loop = np.array([*solid.inner, *reversed(solid.outer)])
        x, y = loop.T
        area = 0.5 * float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum())
        assert area > 0.0
        expected += area * high
    assert volume(vertex) == pytest.approx(expected, rel=1e-4)
    assert error <= 0.0011


@given(st.floats(2.0, 100.0), st.floats(0.0, 1.0), st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
def test_bored_jaws_fill_what_is_below_the_middle_of_a_cylinder_and_nothing_of_it(radius, across, along, up):
    """But for steps no higher and no wider than a fifteenth of the radius."""
    vise = Vise(46.0, radius + 5.0, 2.0 * radius, radius + 1.5, 2.0 * radius, bored=True)
    place = np.array([across * radius, 23.0 * along, 0.5 * radius * (1.0 + up)])
    blocks = [each for each in vise.solids(0.01) if isinstance(each, Block) and each.low == 0.0]
    inside = any(
        low <= place[2] <= each.high and min(x) <= place[0] <= max(x)
        for each in blocks
        for x, low in [([each.inner[0][0], each.outer[0][0]], each.low)]
    )
    away = math.hypot(place[0], place[2] - radius)
    assert not inside or away >= radius
    # The farthest corner of a step is its width and its height from the cylinder.
    assert inside or away <= radius * (1.0 + math.pi / 48.0 * math.sqrt(2.0)) + 0.02 or place[0] >= radius


def test_the_word_of_bored_jaws_has_what_they_are_bored_to():
    vise = Vise(46.0, 25.0, 65.0, 21.5, 40.0, bored=True)
    assert vise.word == "vise:46x25x65:21.5:40:40"
    assert requested("vise", "46x25x65:21.5:40:40", 1.0, "fixture").clamping == vise
    with pytest.raises(FixtureError, match="give vise"):
        requested("vise", "46x25x65:21.5:40:39", 1.0, "fixture")


@pytest.mark.parametrize(("jaws", "diameter"), [(3, 50.0), (4, 20.0), (2, 300.0), (6, 4.0)])
def test_jaws_of_a_chuck_stand_outside_of_what_they_grip_and_touch_it(jaws, diameter):
    chuck = Chuck(jaws, 40.0, 3.0, diameter)
    upper = [each for each in chuck.solids(0.002) if isinstance(each, Block) and each.high == 3.0]
    assert len(upper) == jaws
    for jaw in upper:
        inner = np.array(jaw.inner)
        middles = 0.5 * (inner[1:] + inner[:-1])
        assert np.linalg.norm(middles, axis=1) == pytest.approx(0.5 * diameter)
        assert (np.linalg.norm(inner, axis=1) >= 0.5 * diameter).all()
        assert np.linalg.norm(inner, axis=1).max() <= 0.5 * diameter + 0.002
