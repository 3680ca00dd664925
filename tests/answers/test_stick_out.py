"""Least stick-out: closed forms, a slow twin, laws, and that the search says the same at the value and just below it."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plan_cutters import Cutter, Options
from plan_cutters.answers.stick_out import BEYOND, EXACT, least_stick_out
from plan_cutters.domain.assembly import assembly
from plan_cutters.domain.holder import Holder
from plan_cutters.domain.stick_out import floor_of, held, outline
from plan_cutters.domain.verdicts import ACCESSIBLE, INACCESSIBLE, INTERFERENCE_FREE, UNDECIDED
from plan_cutters.errors import CutterError
from plan_cutters.judging.judge import judge
from plan_cutters.pipeline import prepare
from plan_cutters.scene.conditions import Context
from tests.support import cad_parts, shapes
from tests.support.closed_forms import floor, wall


def asked(part, cutter, **options):
    """The least stick-out of a cutter on face 1 of a part, and what it was asked of."""
    ready = prepare(part, Options(cutters=(cutter,), faces=[1], area_budget=0, jobs=1, **options))
    reach = judge(ready, cutter)
    return least_stick_out(ready, cutter, reach), ready, reach


def certain(found, ready, cutter):
    """With it every sample is reached, and just below it the one that limits it is not."""
    rows = np.flatnonzero(judge(ready, cutter).reached)
    assert judge(ready, held(cutter, found.least), rows).reached.all()
    assert found.served == len(rows)
    assert found.beyond == pytest.approx(found.least - BEYOND, abs=1e-9)
    shorter = judge(ready, held(cutter, found.beyond), np.array([found.sample]))
    assert shorter.verdict[0] == found.verdict
    assert shorter.verdict[0] not in (ACCESSIBLE, INTERFERENCE_FREE)


@pytest.mark.parametrize("clearance", [0.0, 0.7])
def test_upright_over_a_wall(clearance):
    """The nose stands as high as the wall: its rim lies over it wherever the cutter touches."""
    part = cad_parts.compound(floor(-8.0, 8.0), floor(9.0, 60.0, 21.3), wall(9.0, 0.0, 21.3, -1))
    cutter = Cutter.flat(radius=3, length=60, flutes=10, holder="R25L40", clearance=clearance)
    found, ready, _ = asked(part, cutter, grid=5, tilt=(0.0, 0.0))
    assert found.least == pytest.approx(21.3 + clearance, abs=0.01)
    assert (found.why, found.floor, found.longest) == ("obstacle", 10.0, 60.0)
    assert found.obstacle_face in (2, 3)  # the edge is of both
    assert found.obstacle_point[2] == pytest.approx(21.3, abs=1e-6)
    certain(found, ready, cutter)


def by_a_wall(radius, nose, away, turns):
    """The least stick-out next to an endless wall at `away` from the contact, over all tilts and the leans given, by a scan.

    The nose's disk about O + h a, its radius `nose`, must not reach the wall x = away nor the floor z = 0, and the flutes' not
    the wall.
    """
    best = math.inf
    tilt = np.linspace(1e-4, math.pi / 2 - 1e-4, 200_001)
    for turn in turns:
        fx = math.cos(turn)
        axis, across = np.sin(tilt) * fx, np.cos(tilt) * fx
        # The axis's foot lies `radius` behind the contact.
        foot = -radius * across
        spread = np.sqrt(1.0 - axis**2)
        possible = (foot + radius * spread < away) & (axis < -1e-9)
        height = np.maximum((nose * np.sin(tilt) - radius * np.sin(tilt)) / np.cos(tilt),
                            (away - foot - nose * spread) / np.where(possible, axis, -1.0))  # fmt: skip
        height = np.where(possible, height, math.inf)
        best = min(best, float(height.min()))
    return best


def test_leaning_beside_a_wall():
    """Away from a wall too high to pass over; by how much, the floor decides."""
    part = cad_parts.compound(shapes.plane((-0.5, 0.0), (-1, 1)), wall(5.0, 0.0, 400.0, -1), floor(-300.0, 5.0))
    cutter = Cutter.flat(radius=2, length=60, flutes=2.5, holder="R12L30")
    found, ready, reach = asked(part, cutter, grid=2, tolerance=0.002)
    assert reach.reached.all()
    e1 = ready.samples.direction_max[0]
    turns = ready.conditions.postures.rotations + math.atan2(e1[1], e1[0])
    nearest = float(5.0 - ready.samples.point[:, 0].max())
    assert found.least == pytest.approx(by_a_wall(2.0, 12.0, nearest, turns), abs=0.01)
    certain(found, ready, cutter)


def test_nothing_limits():
    """A floor without anything on it: the holder comes down to the flutes."""
    part = cad_parts.compound(floor(-20.0, 20.0), floor(-20.0, 20.0, -5.0))
    cutter = Cutter.flat(radius=3, length=60, flutes=10, shank_radius=3, holder="R25L40")
    found, _, _ = asked(part, cutter, grid=3)
    assert (found.least, found.why, found.sample, found.obstacle_face) == (10.0, "floor", -1, None)
    assert math.isnan(found.beyond)


@pytest.mark.parametrize(("holder", "why"), [(None, "no holder"), ("R10L20", "reaches nothing")])
def test_nothing_to_ask(holder, why):
    part = cad_parts.compound(shapes.plane((-2.0, 2.0), (-2, 2)), wall(-2.5, 0, 50, 1), wall(2.5, 0, 50, -1))
    cutter = Cutter.flat(radius=3, length=5, holder=holder)
    found, _, reach = asked(part, cutter, grid=2, tilt=(0.0, 0.1))
    assert holder is None or not reach.reached.any()
    assert found.why == why
    assert math.isnan(found.least)


def test_every_sample_agrees_with_a_slow_twin():
    """Each sample by itself, by halving with whole judgements."""
    part = cad_parts.compound(floor(-8.0, 8.0), floor(9.0, 60.0, 21.3), wall(9.0, 0.0, 21.3, -1))
    cutter = Cutter.bull(radius=3, corner_radius=1, length=60, flutes=8, shank_radius=2.5, holder="R10:16L12+R16L40")
    ready = prepare(part, Options(cutters=(cutter,), faces=[1], area_budget=0, grid=4, jobs=1))
    reach = judge(ready, cutter)
    found = least_stick_out(ready, cutter, reach)
    rows, each = np.flatnonzero(reach.reached), []
    for row in rows.tolist():
        low, high = 8.0, 60.0
        if judge(ready, held(cutter, low), np.array([row])).reached[0]:
            high = low
        while high - low > 0.01:
            middle = 0.5 * (low + high)
            one = judge(ready, held(cutter, middle), np.array([row])).reached[0]
            low, high = (low, middle) if one else (middle, high)
        each.append(high)
    assert found.least == pytest.approx(max(each), abs=0.02)
    assert each[rows.tolist().index(found.sample)] == max(each)
    assert found.least > found.floor


def undercut():
    """A block with a pocket that is wider than its mouth."""
    whole = cad_parts.cut(cad_parts.box(60, 60, 50), cad_parts.box(40, 40, 30, (10, 10, 10)))
    return cad_parts.cut(whole, cad_parts.box(20, 40, 30, (20, 10, 30)))


def beside_a_wall():
    return cad_parts.compound(floor(-8.0, 8.0), wall(9.0, 0.0, 39.0959, -1))


@pytest.mark.slow("searches long", only=("neck",))
@pytest.mark.parametrize(
    ("part", "cutter", "options"),
    [
        (undercut, {"spec": "R4.329892926L32.36271038rc3.846910513F17.08663416", "holder": "R10:8L6+R16L9+R12L8"},
         {"grid": 3, "machine": "tilt:44"}),
        (undercut, {"spec": "R2.748679295L20.96405785rc2.748679295T7.695966687F3.602612681", "holder": "R9:14L12+R20L10"},
         {"grid": 3, "machine": "tilt:70"}),
        (beside_a_wall, {"spec": "R1.584514072L16.65287811T13.40908979F2.946779381N1.287101045x1.091786895",
                         "holder": "R12:25L10"}, {"grid": 6}),
    ],
    ids=["bull", "taper", "neck"],
)  # fmt: skip
def test_a_judgement_says_the_same_where_a_hair_of_tilts_is_left(part, cutter, options):
    """With the least stick-out all is reached, and with less it is not."""
    cutter = replace(Cutter.parse(cutter["spec"]), holder=Holder.parse(cutter["holder"]))
    ready = prepare(part(), Options(cutters=(cutter,), faces="all", area_budget=0, jobs=1, **options))
    found = least_stick_out(ready, cutter, judge(ready, cutter))
    assert found.verdict in (INACCESSIBLE, UNDECIDED)
    certain(found, ready, cutter)


@pytest.mark.parametrize("clearance", [0.0, 1.0])
def test_what_is_in_the_way_is_in_the_holder(clearance):
    """Of triangles as long as the part the very point that stops a shorter one."""
    cutter = Cutter.ball(radius=2, length=50, flutes=5, holder="R12:20L30", clearance=clearance)
    ready = prepare("samples/v_groove.step", Options(cutters=(cutter,), machine="tilt:45", grid=13, area_budget=0, jobs=1))
    found = least_stick_out(ready, cutter, judge(ready, cutter))
    outer_tool, row = Context.of(held(cutter, found.beyond), ready.conditions).outer_tool, found.sample
    samples = ready.samples
    deep = outer_tool.depth(found.obstacle_point[None], samples.point[row], samples.normal[row], found.tilt_direction, found.tilt)
    assert 0.0 < deep[0] <= BEYOND + EXACT


@pytest.mark.slow("plans parts whole")
def test_the_same_on_any_number_of_threads():
    cutter = Cutter.ball(radius=3, length=70, flutes=6, holder="R12:20L6+R20L40")
    found = []
    for jobs in (1, 3):
        ready = prepare("samples/peaks_and_valleys.step", Options(cutters=(cutter,), grid=21, area_budget=0, jobs=jobs))
        found.append(least_stick_out(ready, cutter, judge(ready, cutter)))
    assert found[0] == found[1]
    certain(found[0], ready, cutter)


sizes = st.floats(0.5, 30.0)


@settings(max_examples=60, deadline=None)
@given(st.lists(st.tuples(sizes, sizes, sizes), min_size=1, max_size=4), st.sampled_from([0.0, 0.4]), st.integers(0, 10**6))
def test_the_outline_lies_under_the_holder(stages, clearance, seed):
    """A point that the outline leaves out is in no piece of the holder, however far that comes up, and little more is left in."""
    stages = [(max(r, 2.0), length, max(u, 2.0)) for r, length, u in stages]
    spec = "+".join(f"R{r}:{u}L{length}" for r, length, u in stages)
    cutter = Cutter.flat(radius=2, length=50, flutes=10, holder=spec, clearance=clearance)
    outer_tool = assembly(cutter, 0.008, -0.002)
    rows = outline(outer_tool, 50.0)
    assert (rows[:, 1] >= rows[:, 0]).all()
    assert (np.diff(rows[:, 0]) >= -1e-9).all()
    rng = np.random.default_rng(seed)
    q, w = rng.uniform(0, rows[-1, 3], 300), rng.uniform(40, 50 + sum(s[1] for s in stages), 300)
    k = np.searchsorted(rows[:, 3], q, side="left").clip(0, len(rows) - 1)
    v0, v1, q0, q1 = rows[k].T
    v = v0 + np.where(v1 > v0, (q - q0) * (v1 - v0) / (q1 - q0), 0.0)
    points = np.stack([q, np.zeros(300), w], axis=1)
    holder = outer_tool.only(3)
    deep = holder.depth(points, np.array([2.0, 0, 0]), np.array([0, 0, 1.0]), np.array([1.0, 0, 0]), 0.0)
    assert (w[deep > 1e-9] - 50.0 >= v[deep > 1e-9] - 1e-6).all()


def test_held_otherwise():
    cutter = Cutter.flat(radius=3, length=60, flutes=10, neck=None, shank_radius=4, holder="R25L40")
    assert held(cutter, 40.0).length == 40.0
    assert held(cutter, 10.0).shank_radius is None
    assert floor_of(cutter, 0.01) == 10.0
    with pytest.raises(CutterError):
        held(cutter, 9.0)
    # Its flutes are wider than the holder's nose: something of the shank must stand out.
    wide = Cutter.flat(radius=8, length=60, flutes=10, shank_radius=4, holder="R5L40")
    assert 10.0 < floor_of(wide, 0.01) < 10.001
    # No flutes were given: all that stands out may cut, and the corner must.
    assert floor_of(Cutter.ball(radius=3, length=60, holder="R25L40"), 0.01) == pytest.approx(3.0, abs=1e-5)
