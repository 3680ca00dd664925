"""Faces along a flank or on a flat: off by what the tolerance allows, touched anywhere, above the flutes as below."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plan_cutters import Cutter, Options, plan, posture_map
from plan_cutters.domain.holder import Segment
from plan_cutters.domain.travel import tips
from plan_cutters.judging.judge import judge
from plan_cutters.pipeline import prepare
from plan_cutters.scene.scene import Scene
from tests.support.grooves import HALF, LENGTH, TOP, groove, leaning, off_level, tee

TOLERANCE = 0.01
FLAT = Cutter.parse("D8L40F25S8")
#: A T-slot cutter: flutes of 16 x 4 below a neck of 6.
SLOT = Cutter(8.0, 50.0, 0.0, shape="form", outline=((0, 0), (8, 0), (8, 4), (3, 4)), neck=Segment(3.0, 30.0), shank_radius=4.0)
MACHINES = ("3-axis", "4-axis-a", "trunnion-ac")


def options_of(cutter, machine, spacing, **options):
    return {"cutters": [cutter], "machine": machine, "faces": "all", "spacing": spacing, "area_budget": 0, **options}


def judged(part, cutter=FLAT, machine="3-axis", spacing=3.0, **options):
    """Samples and verdicts, and nothing of what a plan makes of them."""
    ready = prepare(part, Options.of(options_of(cutter, machine, spacing, **options)))
    return SimpleNamespace(samples=ready.samples, reaches={cutter.id: judge(ready, cutter)})


def within_groove(result, *, up=0.5):
    """Samples on the walls of a groove: inside the block, their normals nearly across Z."""
    point, normal = result.samples.point, result.samples.normal
    return (np.abs(point[:, 0]) < HALF - 1) & (np.abs(normal[:, 2]) < up) & (np.abs(normal[:, 0]) > 0.5)


def verdicts(result):
    (found,) = result.reaches.values()
    return found


def limit(height):
    return math.degrees(math.asin(TOLERANCE / height))


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize("share", [1e-3, 0.5, 0.98])
def test_a_wall_that_leans_inward_within_the_tolerance_is_reached(machine, share):
    result = judged(leaning(share * limit(5.0), 5.0), machine=machine)
    found, walls = verdicts(result), within_groove(result)
    assert walls.sum() > 20
    assert found.reached[walls].all()


@pytest.mark.parametrize("lean", [-3.0, -0.02, -1e-4])
def test_a_wall_that_leans_outward_is_reached(lean):
    result = judged(leaning(lean, 10.0))
    assert verdicts(result).reached[within_groove(result)].all()


def test_a_wall_that_leans_inward_by_more_is_not():
    result = judged(leaning(1.1 * limit(5.0), 5.0))
    assert not verdicts(result).reached[within_groove(result)].any()


def test_it_is_the_flank_that_is_in_the_way_not_the_axis_limit():
    """A wall of the right lean under a ledge: the axis that there is would do."""
    from plan_cutters.domain.verdicts import AXIS_LIMIT, REASONS

    ledge = [(-10.0, TOP), (-10.0, TOP - 3.0), (-13.0, TOP - 3.0), (-13.00001, TOP - 10.0)]
    result = plan(groove(*ledge, *((-x, z) for x, z in reversed(ledge))), **options_of(FLAT, "3-axis", 3.0))
    under = within_groove(result) & (np.abs(result.samples.point[:, 0]) > 11.0)
    # At the ends of the groove another axis would reach what is under the ledge.
    under &= np.abs(result.samples.point[:, 1] + 0.5 * LENGTH) < 5.0
    found = verdicts(result)
    assert under.any()
    assert not found.reached[under].any()
    assert AXIS_LIMIT not in found.reason[under], [REASONS[k] for k in np.unique(found.reason[under])]


@settings(max_examples=12, deadline=None)
@given(st.floats(2.0, 20.0), st.floats(0.0, 2.0), st.sampled_from(MACHINES))
def test_no_wall_is_cut_deeper_than_the_tolerance_and_none_keeps_more(height, share, machine):
    """The rim of the groove is what stands out farthest: how deep it lies in the flutes is known in closed form."""
    result = judged(leaning(share * limit(height), height), machine=machine, spacing=max(1.5, height / 4))
    found, samples = verdicts(result), result.samples
    rows = np.flatnonzero(within_groove(result) & found.reached & (found.axis[:, 2] > 1.0 - 1e-12))
    side = np.abs(tips(FLAT, samples.point, samples.normal, found)[rows, 0]) + FLAT.radius
    assert (side - 10.0 <= TOLERANCE + 1e-9).all()
    assert (np.abs(samples.point[rows, 0]) - side <= TOLERANCE + 1e-9).all()


@pytest.mark.parametrize("share", [1e-3, 0.3, 0.7])
def test_a_shank_as_wide_as_the_flutes_does_not_touch_a_wall_that_is_higher(share):
    """It stands off by the tolerance at most, and less than that stays."""
    result = judged(leaning(share * limit(20.0), 20.0), Cutter.parse("D8L60F5S8"))
    assert verdicts(result).reached[within_groove(result)].all()


@pytest.mark.slow("another lean of the same law", only=("1.5",))
@pytest.mark.parametrize("share", [0.5, 1.5])
def test_a_machine_with_more_axes_reaches_no_less(share):
    part = leaning(share * limit(8.0), 8.0)
    few, more, most = (verdicts(judged(part, machine=machine)).reached for machine in MACHINES)
    assert not (few & ~more).any()
    assert not (more & ~most).any()


@pytest.mark.parametrize(("share", "reached"), [(0.9, True), (1.1, False)])
def test_along_short_flutes_lies_as_much_of_a_wall_as_they_are_long(share, reached):
    """And no machine of fewer axes reaches a strip of it that one of more does not."""
    part = leaning(share * limit(4.0), 8.0)
    each = [judged(part, Cutter.parse("D8L40F4N6x20S6"), machine, axis_accuracy_deg=0.01) for machine in MACHINES]
    found = [verdicts(one).reached for one in each]
    walls = within_groove(each[0]) & (np.abs(each[0].samples.point[:, 1] + 0.5 * LENGTH) < 5.0)
    walls &= (each[0].samples.point[:, 2] < TOP - 1.0) & (each[0].samples.point[:, 2] > TOP - 7.0)
    assert walls.any()
    assert (found[0][walls] == reached).all()
    assert not (found[0] & ~found[1]).any()
    assert not (found[1] & ~found[2]).any()


def test_the_accuracy_of_the_axes_makes_walls():
    """30 mm high, off by 0.03 deg: the flank cuts the upper part of it within the tolerance."""
    part = leaning(0.03, 20.0)
    reached = [verdicts(judged(part, axis_accuracy_deg=deg)).reached[within_groove(judged(part))].mean() for deg in (0.01, 0.05)]
    assert reached[0] == 0.0
    assert 0.5 < reached[1] < 1.0


@pytest.mark.slow("another machine of the same law", only=("trunnion-ac",))
@pytest.mark.parametrize("machine", ["3-axis", "trunnion-ac"])
def test_a_t_slot_is_finished_by_its_cutter(machine):
    result = judged(tee(), SLOT, machine, spacing=1.5)
    samples, found = result.samples, verdicts(result)
    inside = (np.abs(samples.point[:, 0]) < 10.1) & (samples.point[:, 2] > 4.9) & (samples.point[:, 2] < 11.6)
    ceiling = inside & (samples.normal[:, 2] < -0.5)
    assert ceiling.sum() > 20
    assert found.reached[inside].all()
    # Upright: tip no lower than the floor, the upper face no higher than the ceiling, each sample at the flutes.
    tip = tips(SLOT, samples.point, samples.normal, found)
    # Not past the ends of the groove.
    rows = np.flatnonzero(inside & (found.axis[:, 2] > 1.0 - 1e-12) & (np.abs(tip[:, 1] + 0.5 * LENGTH) < 0.5 * LENGTH - 8.0))
    tip = tip[rows]
    assert (tip[:, 2] >= 5.0 - TOLERANCE).all()
    assert (tip[:, 2] + 4.0 <= 11.5 + TOLERANCE).all()
    assert (np.abs(tip[:, 0]) + 8.0 <= 10.0 + TOLERANCE).all()
    height = samples.point[rows, 2] - tip[:, 2]
    assert (height >= -TOLERANCE).all()
    assert (height <= 4.0 + TOLERANCE).all()
    if machine == "3-axis":
        # Not with the ends of the flutes alone.
        walls = rows[np.abs(samples.normal[rows, 0]) > 0.5]
        assert ((found.shift[walls, 2] < -0.5) & (found.shift[walls, 2] > -3.5)).any()


def test_a_ceiling_is_reached_whichever_way_its_cutter_must_stand():
    """Where axis and normal are parallel, the contact may be anywhere over the flutes."""
    result = judged(tee(), SLOT, spacing=1.0, tilt_deg=(0, 180))
    samples, found = result.samples, verdicts(result)
    ceiling = np.flatnonzero((samples.normal[:, 2] < -0.5) & (samples.point[:, 2] > 1.0))
    assert found.reached[ceiling].all()
    away = np.hypot(*(tips(SLOT, samples.point, samples.normal, found)[ceiling] - samples.point[ceiling])[:, :2].T)
    assert (away <= 8.0 + 1e-9).all()
    assert (away >= 3.0).all()


def test_tilts_are_searched_as_far_as_a_cutter_touches():
    assert Options(cutters=[FLAT]).tilt == (0.0, 0.5 * math.pi)
    assert Options(cutters=[FLAT, SLOT]).tilt == (0.0, math.pi)
    assert Options(cutters=[SLOT], tilt_deg=(0, 60)).tilt[1] == pytest.approx(math.radians(60))
    dovetail = Cutter.flat(
        radius=6.0, length=30.0, flutes=8.0, neck=Segment(3.0, 10.0), shank_radius=3.0, taper=math.radians(-15.0)
    )
    assert Options(cutters=[dovetail]).tilt[1] == pytest.approx(math.radians(105))


@pytest.mark.slow("another machine of the same law", only=("unlimited",))
@pytest.mark.parametrize(("machine", "cutter"), [("unlimited", SLOT), ("trunnion-ac", FLAT)])
def test_map_and_plan_agree(machine, cutter):
    result, scene = judged(tee(), cutter, machine, spacing=6.0), Scene.of(tee())
    found, rng = verdicts(result), np.random.default_rng(3)
    judged_rows = np.flatnonzero(found.reached | (found.verdict == 0))
    for row in rng.choice(judged_rows, 8, replace=False):
        there = posture_map(
            scene,
            point=result.samples.point[row],
            cutter=cutter,
            rotations_deg=range(0, 360, 10),
            machine=machine,
            tolerance=0.01,
        )
        free = any(len(each) for each in there.free) or there.lies_flat or there.lies_along
        if found.reached[row]:
            assert free, result.samples.point[row]
        else:
            assert not free, result.samples.point[row]


@pytest.mark.slow("another lean of the same law", only=("0.0001",))
@pytest.mark.parametrize("degrees", [1e-4, 0.02])
def test_a_floor_that_is_not_quite_level_is_a_floor(degrees):
    """Across its width neither side of the tip alone touches all of it."""
    level, off = (verdicts(judged(off_level(each), Cutter.parse("D10L40F25S10"), spacing=1.5)) for each in (0.0, degrees))
    assert level.reached.mean() == pytest.approx(off.reached.mean(), abs=0.005)


def test_a_floor_off_by_more_than_the_flat_allows_is_none():
    result = judged(off_level(1.0), Cutter.parse("D10L40F25S10"), spacing=1.5)
    floor = (result.samples.normal[:, 2] > 0.9) & (result.samples.point[:, 2] < TOP - 1)
    assert 0.0 < verdicts(result).reached[floor].mean() < 0.9
