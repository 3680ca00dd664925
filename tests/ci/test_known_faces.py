"""Laws of knowing faces again by carriers and neighbours: numbers do not matter, nor which plan is the old one."""

import math
import random

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plan_cutters.plan_file.part_info import CarrierEntry
from plan_cutters_ci.matching import match_faces, moved_faces
from tests.support.plan_files import cutter, face, made

AXES = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


def carrier(shape, axis, place, radius, outward):
    """A carrier across or along an axis of the coordinates, through a place."""
    if shape == "sculptured":
        return None
    direction = np.array(AXES[axis])
    along = (direction @ place) * direction
    point = along if shape == "plane" else np.array(place) - along
    radii = None if shape == "plane" else radius
    return CarrierEntry(point_mm=tuple(point.tolist()), direction=AXES[axis], radius_mm=radii, outward=outward)


@st.composite
def features(draw, number):
    """A face at a place that no other one has."""
    shape = draw(st.sampled_from(["plane", "plane", "cylinder", "sculptured"]))
    axis, outward = draw(st.integers(0, 2)), draw(st.sampled_from([True, False, None]))
    place = (11.0 * number + 1.0, 7.0 * (number * number % 13), draw(st.sampled_from([0.0, 5.0, 20.0])))
    radius, area = draw(st.sampled_from([2.0, 3.0, 5.0])), draw(st.sampled_from([50.0, 80.0, 81.0, 200.0]))
    return {"shape": shape, "axis": axis, "outward": outward, "place": place, "radius": radius, "area": area}


@st.composite
def parts(draw):
    """Two lists of features, the second an edited copy of the first one, and for each pairs of numbers that are neighbours."""
    number = draw(st.integers(2, 9))
    old = {k: draw(features(k)) for k in range(number)}
    new = {}
    for k, feature in old.items():
        edit = draw(st.sampled_from(["", "", "area", "radius", "place", "gone"]))
        if edit == "area":
            feature = {**feature, "area": feature["area"] * draw(st.sampled_from([0.7, 1.1, 2.0]))}
        elif edit == "radius":
            feature = {**feature, "radius": feature["radius"] + 1.0, "area": feature["area"] * 1.3}
        elif edit == "place":
            x, y, z = feature["place"]
            feature = {**feature, "place": (x + draw(st.sampled_from([0.5, 3.0])), y, z)}
        if edit != "gone":
            new[k] = feature
    new |= {k: draw(features(k)) for k in range(number, number + draw(st.integers(0, 2)))}
    every = st.tuples(st.integers(0, number + 1), st.integers(0, number + 1))
    joints = draw(st.sets(every.filter(lambda pair: pair[0] < pair[1]), max_size=20))
    return old, new, joints


def planned(part, joints, numbers, sha):
    """A plan of features, each with its number."""
    across = {k: {b if a == k else a for a, b in joints if k in (a, b)} & part.keys() for k in part}
    faces = [
        face(numbers[k], area=f["area"], centre=f["place"], shape=f["shape"], neighbours=[f"F{numbers[j]}" for j in across[k]],
             carrier=carrier(f["shape"], f["axis"], f["place"], f["radius"], f["outward"]))
        for k, f in sorted(part.items(), key=lambda each: numbers[each[0]])
    ]  # fmt: skip
    return made(faces, [cutter("R6L80", {})], sha=sha)


def shuffled(part, seed):
    numbers = list(range(1, len(part) + 1))
    random.Random(seed).shuffle(numbers)
    return dict(zip(part, numbers, strict=True))


def pairs(old, new, mine, theirs):
    """What was paired, by the features' own names."""
    named = [{f"F{n}": k for k, n in numbers.items()} for numbers in (mine, theirs)]
    return {(named[0][a.id], named[1][b.id], how) for a, b, how in match_faces(old, new)}


@settings(deadline=None, max_examples=150)
@given(parts(), st.integers(0, 999), st.integers(0, 999))
def test_numbers_of_faces_do_not_matter(case, seed, other):
    old, new, joints = case
    straight = [{k: i + 1 for i, k in enumerate(part)} for part in (old, new)]
    turned = [shuffled(old, seed), shuffled(new, other)]
    first, second = (
        pairs(planned(old, joints, mine, "a"), planned(new, joints, theirs, "b"), mine, theirs)
        for mine, theirs in (straight, turned)
    )
    assert first == second


@settings(deadline=None, max_examples=150)
@given(parts())
def test_which_plan_is_the_old_one_does_not_matter(case):
    old, new, joints = case
    mine, theirs = ({k: i + 1 for i, k in enumerate(part)} for part in (old, new))
    one, other = planned(old, joints, mine, "a"), planned(new, joints, theirs, "b")
    assert pairs(one, other, mine, theirs) == {(b, a, how) for a, b, how in pairs(other, one, theirs, mine)}


@settings(deadline=None, max_examples=150)
@given(parts())
def test_pairs_are_one_to_one_of_one_form_and_of_one_side_of_the_material(case):
    old, new, joints = case
    mine, theirs = ({k: i + 1 for i, k in enumerate(part)} for part in (old, new))
    known = match_faces(planned(old, joints, mine, "a"), planned(new, joints, theirs, "b"))
    assert len({a.id for a, _, _ in known}) == len({b.id for _, b, _ in known}) == len(known)
    for a, b, _ in known:
        assert a.shape == b.shape
        if a.shape == "cylinder" and None not in (a.carrier.outward, b.carrier.outward):
            assert a.carrier.outward == b.carrier.outward


@settings(deadline=None, max_examples=60)
@given(parts(), st.integers(0, 999))
def test_a_part_that_was_only_numbered_anew_is_known_whole(case, seed):
    old, _, joints = case
    mine, theirs = {k: i + 1 for i, k in enumerate(old)}, shuffled(old, seed)
    found = pairs(planned(old, joints, mine, "a"), planned(old, joints, theirs, "b"), mine, theirs)
    assert found == {(k, k, "place") for k in old}


def bores(*each, sha="a"):
    """A plan of cylinders along z: place, radius, and whether they are bosses."""
    faces = [
        face(k + 1, shape="cylinder", centre=(x, y, 0.0), area=20.0 * radius,
             carrier=carrier("cylinder", 2, (x, y, 0.0), radius, outward))
        for k, (x, y, radius, outward) in enumerate(each)
    ]  # fmt: skip
    return made(faces, [cutter("R6L80", {})], sha=sha)


@pytest.mark.parametrize(
    ("now", "how"),
    [
        ((0.0, 0.0, 3.0, False), ["place"]),
        ((0.0, 0.0, 4.0, False), ["carrier"]),
        ((0.0, 0.0, 4.0, None), ["carrier"]),
        ((0.0, 0.0, 3.0, True), []),
        ((0.0, 0.0, 4.0, True), []),
    ],
)
def test_a_bore_that_grew_is_the_same_bore_and_never_a_boss(now, how):
    assert [each[2] for each in match_faces(bores((0.0, 0.0, 3.0, False)), bores(now, sha="b"))] == how


def test_of_two_on_one_carrier_neither_is_taken():
    """A plane that was cut into two: which of them it is nobody knows."""

    def floor(sha, *each):
        return made(
            [face(k + 1, shape="plane", centre=(x, 0.0, 0.0), area=area, carrier=carrier("plane", 2, (x, 0.0, 0.0), 0.0, True))
             for k, (x, area) in enumerate(each)], [cutter("R6L80", {})], sha=sha)  # fmt: skip

    whole, cut = floor("a", (0.0, 900.0)), floor("b", (-8.0, 400.0), (8.0, 400.0))
    assert match_faces(whole, cut) == []
    assert match_faces(cut, whole) == []
    # A large rest and a small piece far off are told apart.
    rest = floor("b", (-2.0, 700.0), (70.0, 50.0))
    assert [(a.id, b.id, how) for a, b, how in match_faces(whole, rest)] == [("F1", "F1", "carrier")]


def test_coplanar_faces_far_from_each_other_are_two():
    def top(x, sha):
        top_of = carrier("plane", 2, (x, 0.0, 30.0), 0.0, True)
        return made([face(1, shape="plane", centre=(x, 0.0, 30.0), carrier=top_of)], [cutter("R6L80", {})], sha=sha)

    assert match_faces(top(0.0, "a"), top(60.0, "b")) == []


@settings(deadline=None, max_examples=60)
@given(st.integers(0, 5), st.tuples(*[st.floats(-200.0, 200.0)] * 3), st.integers(0, 99))
def test_a_part_that_moved_as_a_whole_is_told_as_such_or_is_where_it_was(which, shift, seed):
    """Whatever pairs are made: nothing is compared where the part has no face at its place."""
    places = [(0.0, 0.0, 0.0), (40.0, 3.0, 1.0), (7.0, 30.0, 2.0), (25.0, 17.0, 9.0), (13.0, 5.0, 28.0), (31.0, 29.0, 6.0)]
    linear = [*map(np.diag, ((1, 1, 1), (-1, 1, 1), (1, 1, -1), (-1, -1, 1))), np.eye(3)[[1, 2, 0]], np.eye(3)[[1, 0, 2]]][which]
    numbers = random.Random(seed).sample(range(1, 7), 6)

    def standing(matrix, by, ids):
        return [
            face(n, shape="sculptured", centre=tuple((matrix @ place + by).tolist()), area=50.0 + k)
            for k, (place, n) in enumerate(zip(np.array(places), ids, strict=True))
        ]

    tools = [cutter("R6L80", {})]
    old = made(standing(np.eye(3), np.zeros(3), range(1, 7)), tools)
    new = made(standing(linear, np.round(shift, 3), numbers), tools, sha="b")
    known = match_faces(old, new)
    if not moved_faces(old, new, known):
        # Hardly at all.
        assert which == 0
        assert math.dist(shift, (0.0, 0.0, 0.0)) < 4.0


def test_a_free_form_face_that_was_trimmed_anew_is_the_same_one():
    def free(sha, *each):
        faces = [face(k + 1, shape="sculptured", centre=(x, 0.0, 0.0), area=area) for k, (x, area) in enumerate(each)]
        return made(faces, [cutter("R6L80", {})], sha=sha)

    whole = free("a", (0.0, 900.0))
    assert [how for *_, how in match_faces(whole, free("b", (2.0, 850.0)))] == ["trim"]
    assert match_faces(whole, free("b", (2.0, 600.0))) == match_faces(whole, free("b", (20.0, 850.0))) == []
    # Of two that may be it, neither.
    assert match_faces(whole, free("b", (2.0, 850.0), (-2.0, 850.0))) == []


def test_an_export_that_rounds_otherwise_did_not_move():
    """Areas and middles of two programs differ by more than those of one: the faces stay on their carriers."""

    def block(sha, off):
        places = [(0.0, 0.0, 15.0), (40.0, 0.0, 0.0), (0.0, 30.0, 0.0), (0.0, 0.0, -15.0), (-40.0, 0.0, 0.0), (0.0, -30.0, 0.0)]
        faces = [
            face(k + 1, shape="plane", centre=(x + (off if k % 3 != 1 else 0.0), y, z), area=100.0 * (k + 1),
                 carrier=carrier("plane", (2, 0, 1)[k % 3], (x, y, z), 0.0, k < 3))
            for k, (x, y, z) in enumerate(places)
        ]  # fmt: skip
        return made(faces, [cutter("R6L80", {})], sha=sha)

    old, close, moved = block("a", 0.0), block("b", 0.01), block("c", 5.0)
    assert not moved_faces(old, close, match_faces(old, close))
    assert moved_faces(old, moved, match_faces(old, moved)) == 4
