"""Largest radius that reaches each sample: closed forms, a slow twin, and the laws that the search stands on."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox
from OCP.gp import gp_Ax1, gp_Dir, gp_Pnt, gp_Trsf, gp_Vec

from cad_io import read_part
from cad_io.kernel.shapes import corner
from plan_cutters import Cutter, Machine
from plan_cutters.answers.largest_radius import largest_radius
from plan_cutters.domain.answers import PERCENTILES, RadiusMap
from plan_cutters.domain.assembly import assembly
from plan_cutters.domain.verdicts import INACCESSIBLE, INSIDE, NO_REASON, REASONS, UNDECIDED, UNJUDGED
from plan_cutters.errors import OptionError
from plan_cutters.judging.judge import judge
from plan_cutters.options import Options
from plan_cutters.pipeline import prepare
from tests.support import reference, shapes
from tests.support.cad_parts import ball, box, cut, rod
from tests.support.places import SAMPLES

STEP = 0.02
ENDS = {"flat": Cutter.flat, "ball": Cutter.ball}


def ready(part, **options):
    return prepare(part, Options(**{"cutters": "R1L50", "grid": 15, "jobs": 1, **options}))


def patch(seed, height=9.0, size=40.0):
    return shapes.shell(shapes.Patch.random(np.random.default_rng(seed), size=size, height=height, n=7).face())


def moved(shape, transformation):
    return BRepBuilderAPI_Transform(shape, transformation, True).Shape()


def assert_within_a_step(found, rows, nominal, slack):
    """The radius is the last of the row that is no larger than the closed form; the tolerance may let in `slack` more."""
    radius, nominal = found.radius[rows], np.broadcast_to(nominal, len(found.radius))[rows]
    assert len(radius)
    assert (radius * (1.0 + STEP) > nominal).all(), (radius / nominal).min()
    assert (radius <= nominal + slack).all(), (radius - nominal).max()


# Closed forms


@pytest.fixture(scope="module")
def groove():
    return ready(SAMPLES / "v_groove.step", grid=13, tolerance=0.005)


def test_balls_in_a_v_groove(groove):
    """Two planes at 120 deg, joined by an arc of radius 5: a ball on a flank touches the other one as far from the line in which
    the planes meet, s, and its radius is s tan 60 deg there; a ball on the arc has the arc's radius at most."""
    found = largest_radius(groove, "ball", least=1.0, most=30.0)
    x, z = groove.samples.point[:, 0], groove.samples.point[:, 2]
    line = 5.0 * (1.0 - 1.0 / math.cos(math.radians(30)))
    s = np.hypot(x, z - line)
    limit = np.where(groove.samples.curvature[:, 0] > 0.1, 5.0, s * math.tan(math.radians(60)))
    fits = limit < 29.0
    assert fits.sum() > 30
    assert (~fits).any()
    assert_within_a_step(found, fits, limit, 2.0 * 0.005)
    assert found.no_less[limit > 30.01].all()
    assert found.radius[found.bottleneck] == found.radius.min() < 5.0


def test_every_flat_end_fits_into_a_wide_v_groove(groove):
    """A right angle fits into one of 120 deg, at every point of it: none of the radii tried is too large."""
    found = largest_radius(groove, "flat", least=1.0, most=30.0)
    assert found.no_less.all()
    assert (found.beyond == UNJUDGED).all()
    assert (found.reason == NO_REASON).all()
    assert found.percentiles() == dict.fromkeys(PERCENTILES, found.most)


def tube(radius, length, **options):
    """A hole along Z through a block, of which it is all that is looked at."""
    part = read_part(cut(box(60.0, 60.0, length, (-30, -30, -0.5 * length)), rod(radius, length, (0, 0, -0.5 * length))))
    return ready(part, faces=[next(face.number for face in part.faces if face.shape == "cylinder")], drill_below=0, **options)


@pytest.mark.parametrize("shape", ENDS)
def test_in_a_tube(shape):
    """Across a tube nothing wider fits: flat and ball ends lie along it, and have its radius at most."""
    hole = tube(9.0, 300.0, grid=13, tolerance=0.005)
    found = largest_radius(hole, shape, least=2.0, most=30.0)
    middle = np.abs(hole.samples.point[:, 2]) < 50.0
    assert_within_a_step(found, middle, 9.0, 2.0 * 0.005)
    # So wide, they hardly lean.
    assert np.degrees(found.tilt[middle]).min() > 80.0


def test_a_flat_end_that_leans_along_a_trough():
    """Leaning along it alone, the rim curves by sin(tilt) / R across it: R = rho sin(largest tilt) on the bottom line."""
    along = {"rotation": (math.pi / 2, math.pi / 2), "tilt": (0.0, math.radians(40))}
    trough = ready(shapes.shell(shapes.trough(20.0, 200.0)), tolerance=0.005, **along)
    assert trough.samples.direction_max[:, 1] == pytest.approx(0.0, abs=1e-9)
    found = largest_radius(trough, "flat", least=2.0, most=30.0)
    bottom = (np.abs(trough.samples.point[:, 0]) < 1e-9) & (np.abs(trough.samples.point[:, 1]) < 100)
    # The tolerance lets in a little more: up to where a rim that curves less than the trough is that deep in it.
    strict, tilt = 20.0 * math.sin(math.radians(40)), math.radians(40)
    turn = np.linspace(-0.8, 0.8, 4001)
    points = np.stack([20.0 * np.sin(turn), np.zeros_like(turn), 20.0 * (1.0 - np.cos(turn))], axis=1)
    n, f = np.array([0.0, 0, 1]), np.array([0.0, 1, 0])
    at = [points + np.array([0.0, y, 0]) for y in np.linspace(-4.0, 0.5, 181)]
    axis = math.cos(tilt) * n + math.sin(tilt) * f
    deep = [max(reference.depth_in_cutter(p, np.zeros(3), n, axis, f, r, 10.0 * r).max() for p in at)
            for r in (strict + 0.1, strict + 0.6)]  # fmt: skip
    assert deep[0] < 0.005 < deep[1]
    assert_within_a_step(found, bottom, strict, 0.6)
    assert {REASONS[k] for k in found.reason[bottom]} <= {"local_gouge", "rear_gouge"}


@pytest.fixture(scope="module")
def bowl():
    return ready(shapes.shell(shapes.bowl(10.0)), grid=17, rotation_step=math.radians(5), tolerance=0.005)


def test_balls_in_a_sphere_bowl(bowl):
    assert_within_a_step(largest_radius(bowl, "ball", least=1.0, most=30.0), slice(None), 10.0, 2.0 * 0.005)


def test_flat_ends_in_a_sphere_bowl(bowl):
    """A rim of radius R lies on the sphere at sin(tilt) = R / rho. The side through the contact leaves half a sphere over its
    edge at tilts up to 45 deg and half the contact's own angle from the pole, uphill."""
    found = largest_radius(bowl, "flat", least=1.0, most=30.0)
    polar = np.arccos(np.clip((10.0 - bowl.samples.point[:, 2]) / 10.0, -1.0, 1.0))
    limit = 10.0 * np.sin(math.radians(45) + 0.5 * polar)
    assert polar.min() < 0.2 < 1.5 < polar.max()
    # On the edge itself a cutter that lies across the bowl is in nothing's way, however large.
    assert_within_a_step(found, polar < 1.5, limit, 3.0 * 0.005)
    assert found.no_less[polar > 1.57].all()


def test_interference_free_samples_have_no_largest_radius():
    for part in (shapes.plane((-50, 50), (-50, 50)), shapes.dome(40.0)):
        for shape in ENDS:
            found = largest_radius(ready(shapes.shell(part), grid=9), shape, least=1.0, most=20.0)
            assert found.no_less.all()


def test_a_sample_within_a_body_is_reached_by_no_radius():
    """A block with a smaller one in its middle, whose faces are under the larger one's."""
    outer = BRepPrimAPI_MakeBox(gp_Pnt(-20, -20, -20), 40.0, 40.0, 40.0).Shape()
    inner = BRepPrimAPI_MakeBox(gp_Pnt(-5, -5, -5), 10.0, 10.0, 10.0).Shape()
    both = ready([outer, inner], grid=5, faces=list(range(1, 13)))
    found = largest_radius(both, "flat", least=1.0, most=5.0)
    within = both.inside >= 0
    assert within.any()
    assert not within.all()
    assert found.less[within].all()
    assert (found.beyond[within] == INACCESSIBLE).all()
    assert (found.reason[within] == INSIDE).all()
    assert np.isnan(found.axis[within]).all()
    assert found.no_less[~within].all()
    assert within[found.bottleneck]


# The slow twin, and what is claimed of each sample


@pytest.mark.slow("plans again for each answer")
@pytest.mark.parametrize("shape", ENDS)
@pytest.mark.parametrize("seed", [1, 4])
def test_a_judge_of_every_radius_agrees(shape, seed):
    stands = ready(patch(seed, height=12.0), grid=23, tolerance=0.02, machine=Machine.parse("tilt:60"))
    found = largest_radius(stands, shape, ratio=6.0, step=0.1, least=0.4, most=15.0)
    radii = 0.4 * 1.1 ** np.arange(int(math.log(15.0 / 0.4) / math.log(1.1)) + 1)
    assert found.most == pytest.approx(radii[-1])
    verdict = np.array([judge(stands, ENDS[shape](radius=r, length=6.0 * r)).verdict for r in radii])
    reached = (verdict != INACCESSIBLE) & (verdict != UNDECIDED)
    # Monotone: no radius reaches a sample that a smaller one does not.
    assert not (reached[1:] & ~reached[:-1]).any()
    count = reached.sum(axis=0)
    truth = np.where(count > 0, radii[count - 1], 0.0)
    same = np.isclose(found.radius, truth, rtol=1e-6)
    # A contact under the flat of an upright tip is not looked for: there it may be less, and never more.
    assert same.all() if shape != "flat" else same.mean() > 0.99 and (found.radius <= truth * (1.0 + 1e-6)).all()
    assert 0 < (count == 0).sum() + (count == len(radii)).sum() < 0.9 * len(count)
    after = np.append(verdict, np.full((1, len(count)), UNJUDGED), axis=0)[count, np.arange(len(count))]
    # Of a tool that has no posture both may be found: what is surely in the way is known to its own narrowest gap.
    assert (found.beyond == after)[same].mean() > 0.99
    assert {INACCESSIBLE, UNDECIDED, UNJUDGED} == set(found.beyond.tolist())


@pytest.mark.slow("plans again for each answer")
@pytest.mark.parametrize("shape", ENDS)
def test_the_postures_told_hold_the_tolerance(shape):
    """Independent of tree and search: every corner and middle of a triangle is no deeper in the cutter than the tolerance."""
    stands = ready(patch(7, height=10.0), grid=15, tolerance=0.02)
    found = largest_radius(stands, shape, ratio=5.0, least=0.5, most=20.0)
    vertex = stands.conditions.obstacles.triangles.vertex
    points = np.concatenate([vertex.reshape(-1, 3), vertex.mean(axis=1)])
    samples, deepest = stands.samples, []
    for row in np.flatnonzero(found.radius > 0)[::3]:
        r, n, axis, tilt_direction = found.radius[row], samples.normal[row], found.axis[row], found.tilt_direction[row]
        contact = samples.point[row]
        if shape == "flat":
            depth = reference.depth_in_cutter(points, contact, n, axis, tilt_direction, r, 5.0 * r)
        else:
            from_centre = points - (contact + r * n)
            height = from_centre @ axis
            q = np.linalg.norm(from_centre - height[:, None] * axis, axis=1)
            side = np.minimum(r - q, 4.0 * r - height)
            depth = np.where(height > 0.0, side, r - np.linalg.norm(from_centre, axis=1))
        deepest.append(depth.max())
        assert axis @ n == pytest.approx(math.cos(found.tilt[row]))
    assert len(deepest) > 50
    assert max(deepest) < 0.02
    # The tolerance is used: not every cutter stands clear.
    assert max(deepest) > 0.5 * 0.02


@pytest.mark.slow("plans again for each answer", only=("flat",))
@pytest.mark.parametrize("shape", ENDS)
def test_no_smaller_radius_fails(shape):
    stands = ready(patch(3, height=14.0), grid=19, tolerance=0.02)
    found = largest_radius(stands, shape, ratio=8.0, least=0.5, most=20.0)
    rng = np.random.default_rng(0)
    rows = rng.choice(np.flatnonzero(found.radius > 1.0), 12, replace=False)
    for row in rows:
        for share in (0.3, 0.6, 0.9):
            r = share * found.radius[row]
            assert judge(stands, ENDS[shape](radius=r, length=8.0 * r), np.array([row])).reached[0], (row, share)


@given(
    shape=st.sampled_from(sorted(ENDS)), ratio=st.floats(1.5, 12.0), share=st.floats(0.3, 0.99), depth=st.floats(0.0, 0.05),
    tilt=st.floats(0.0, math.pi / 2), seed=st.integers(0, 1000),
)  # fmt: skip
@settings(max_examples=60, deadline=None)
def test_a_cutter_shrunk_about_its_contact_stays_inside_itself(shape, ratio, share, depth, tilt, seed):
    """So does what is left of it deeper than any depth."""
    rng = np.random.default_rng(seed)
    normal, tilt_direction, _ = np.linalg.qr(rng.standard_normal((3, 3)))[0]
    axis = math.cos(tilt) * normal + math.sin(tilt) * tilt_direction
    points = rng.uniform(-2, 2, (4000, 3)) + ratio * rng.uniform(0, 1, (4000, 1)) * axis
    deep, small = (
        assembly(ENDS[shape](radius=r, length=ratio * r), depth, depth).depth(points, np.zeros(3), normal, tilt_direction, tilt)
        for r in (1.0, share)
    )
    assume((small > 0).sum() > 5)
    assert (deep[small > 0] > -1e-12).all()
    assert (deep > 0).sum() > (small > 0).sum()


@pytest.mark.slow("another kind of the same law", only=("flat",))
@pytest.mark.parametrize("shape", ENDS)
def test_everything_twice_as_large(shape):
    twice = gp_Trsf()
    twice.SetScale(gp_Pnt(0, 0, 0), 2.0)
    one, two = ready(patch(5, height=12.0), tolerance=0.02), ready(moved(patch(5, height=12.0), twice), tolerance=0.04)
    a = largest_radius(one, shape, least=0.5, most=15.0)
    b = largest_radius(two, shape, least=1.0, most=30.0)
    steps = np.log(b.radius / (2.0 * a.radius)) / math.log1p(STEP)
    assert len(np.unique(a.radius)) > 10
    assert np.abs(steps).max() < 1.5
    assert (np.abs(steps) < 0.5).mean() > 0.97


@pytest.mark.slow("another kind of the same law", only=("ball",))
@pytest.mark.parametrize("shape", ENDS)
def test_a_rigid_motion_changes_nothing(shape):
    turn, shift = gp_Trsf(), gp_Trsf()
    turn.SetRotation(gp_Ax1(gp_Pnt(1, 2, 3), gp_Dir(1, -2, 0.5)), 1.3)
    shift.SetTranslation(gp_Vec(70, -20, 400))
    whole, up = shift.Multiplied(turn), gp_Vec(0, 0, 1).Transformed(turn).Coord()
    machine = Machine.parse("tilt:50")
    here = largest_radius(ready(patch(2), machine=machine), shape, least=0.5, most=15.0)
    there = largest_radius(ready(moved(patch(2), whole), machine=machine, setup=up), shape, least=0.5, most=15.0)
    steps = np.log(there.radius / here.radius) / math.log1p(STEP)
    assert len(np.unique(here.radius)) > 10
    assert np.abs(steps).max() < 1.5
    assert (np.abs(steps) < 0.5).mean() > 0.97


@pytest.mark.slow("plans parts whole")
def test_threads_change_no_byte():
    stands, told = ready(patch(2), grid=36, tolerance=0.02), []
    maps = [largest_radius(replace(stands, conditions=replace(stands.conditions, jobs=jobs)), "ball", least=0.5, most=9.0,
                           progress=lambda done, total: told.append((done, total))) for jobs in (1, 3)]  # fmt: skip
    assert maps[0] == maps[1]
    assert told == [(1, 3), (2, 3), (3, 3)] * 2


def test_an_allowance_takes_room():
    """A ball and its allowance together have the arc's radius at most, and what gouges no deeper than the tolerance at its ends,
    30 deg away at least."""
    arc = ready(SAMPLES / "v_groove.step", grid=7, allowance=0.8)
    found = largest_radius(arc, "ball", least=1.0, most=30.0)
    assert_within_a_step(found, arc.samples.curvature[:, 0] > 0.1, 5.0 - 0.8, 0.01 / (1.0 - math.cos(math.radians(30))))


# What is told of it


def test_a_least_radius_that_is_too_large():
    hole = tube(3.0, 50.0, grid=5)
    found = largest_radius(hole, "ball", least=4.0, most=8.0)
    assert found.less.all()
    assert (found.beyond == INACCESSIBLE).all()
    assert {REASONS[k] for k in found.reason} == {"local_gouge"}
    assert found.percentiles()[95] == 0.0
    assert np.isnan(found.tilt).all()
    assert (found.rotation == -1).all()


def test_radii_that_the_tolerance_cannot_judge_are_not_tried():
    stands = ready(corner(20.0, 0.2), grid=3, tolerance=0.05)
    found = largest_radius(stands, "flat", least=0.01, most=2.0, ratio=0.5)
    assert 0.4 < found.least < 0.4 * 1.02 + 1e-9
    assert found.most <= 2.0 < found.most * 1.02
    by_default = largest_radius(stands, "ball")
    assert by_default.least == pytest.approx(0.2)
    assert by_default.most <= 0.5 * max(stands.scene.part.size) < by_default.most * 1.02


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"shape": "bull"}, "flat or ball, not 'bull'"),
        ({"ratio": 0.5}, "length over radius 0.5 of a ball end must lie between 1 and 1000"),
        ({"ratio": "10"}, "length over radius must be a number, not '10'"),
        ({"step": 0.0}, "step of radii 0 must lie between"),
        ({"least": -1.0}, "radii to try, from -1 to"),
        ({"least": 3.0, "most": 2.0}, "radii to try, from 3 to 2 mm, must be positive and ascend"),
        ({"most": math.inf}, "must be positive and ascend"),
        ({"least": 1e-200, "step": 0.001}, "radii from 1e-200 to 20 mm are too many"),
        ({"least": 1e-3, "most": 0.02}, "too coarse for radii up to 0.02 mm: take a finer one, or radii over 0.04 mm"),
    ],
)
def test_what_has_no_meaning_is_refused(given, said):
    stands = ready(corner(20.0, 0.2), grid=3)
    with pytest.raises(OptionError, match=r"^[^\n]*$") as caught:
        largest_radius(stands, given.pop("shape", "ball"), **given)
    assert said in str(caught.value)


def a_map(radius):
    n = len(radius)
    nothing = np.full(n, np.nan)
    return RadiusMap("flat", 10.0, 0.02, 1.0, 8.0, np.array(radius, float), np.full(n, UNJUDGED, np.uint8),
                     np.full(n, NO_REASON, np.uint8), nothing[:, None].repeat(3, 1), nothing[:, None].repeat(3, 1), nothing,
                     np.full(n, -1, np.int32))  # fmt: skip


def test_percentiles_by_number_and_by_area():
    found = a_map([4.0, 2.0, np.nan, 8.0, 2.0])
    assert found.bottleneck == 1
    assert found.judged.tolist() == [True, True, False, True, True]
    assert found.no_less.tolist() == [False, False, False, True, False]
    assert found.percentiles() == {0: 2.0, 5: 2.0, 25: 2.0, 50: 2.0, 75: 4.0, 95: 8.0}
    assert found.percentiles(np.array([1.0, 1.0, 50.0, 98.0, 0.0])) == {0: 2.0, 5: 8.0, 25: 8.0, 50: 8.0, 75: 8.0, 95: 8.0}
    nothing = a_map([np.nan, np.nan])
    assert nothing.bottleneck is None
    assert nothing.percentiles() == {}


@given(st.lists(st.integers(0, 5), min_size=1, max_size=40))
def test_percentiles_by_equal_areas_are_those_by_number(radii):
    found = a_map(radii)
    by_number = found.percentiles()
    assert found.percentiles(np.full(len(radii), 0.1)) == by_number
    for q, radius in by_number.items():
        assert (found.radius <= radius).mean() >= q / 100 - 1e-9
        assert (found.radius < radius).mean() <= q / 100 + 1e-9


def test_a_part_smaller_than_the_usual_least_radius():
    """A pocket of radius 0.03 in a block of 0.1 mm: balls that fit in it are tried without being asked for."""
    part = cut(box(0.1, 0.1, 0.05), ball(0.03, (0.05, 0.05, 0.05)))
    stands = ready(part, cutters="R0.01L0.2", grid=4, faces="all", tolerance=0.0005)
    found = largest_radius(stands, "ball")
    assert found.least < 0.01
    assert 0.03 / 1.02 - 0.0005 < found.radius[found.bottleneck] <= 0.03 + 0.0005
