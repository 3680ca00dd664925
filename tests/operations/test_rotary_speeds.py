"""What simultaneous motion and turns take by the speeds of rotary axes that a machine's file states."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cad_io.arrays import SurfaceSamples
from plan_cutters import Machine, plan
from plan_cutters.machines import read_machine, to_toml
from plan_cutters.operations.moving_axes import turning_times
from plan_cutters.operations.orientations import index_times
from tests.support.places import DATA
from tests.support.shapes import dome

OPTIONS = {
    "cutters": "D10L60rc1F20", "operations": "fastest", "feed": 1200.0, "area_budget": 0, "grid": 13, "setup": "+z",
    "max_orientations": 1,
}  # fmt: skip


def machine(*rates):
    trunnion = Machine.parse("trunnion-ac")
    axes = [replace(axis, rate=math.radians(rate)) for axis, rate in zip(trunnion.axes, rates, strict=True)]
    return replace(trunnion, axes=tuple(axes))


def around(radius, lean, count=12, apart=0.5):
    """Samples of a cylinder about z with axes that lean from z in each radial plane, and their grid."""
    turn, high = (each.ravel() for each in np.meshgrid(np.linspace(0.3, 1.2, count), apart * np.arange(5), indexing="ij"))
    out = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(len(turn))])
    index = np.arange(len(turn)).reshape(count, 5)
    edges = np.concatenate([
        np.column_stack([index[:-1].ravel(), index[1:].ravel()]), np.column_stack([index[:, :-1].ravel(), index[:, 1:].ravel()])
    ])  # fmt: skip
    n, up = len(turn), np.array([0.0, 0.0, 1.0])
    samples = SurfaceSamples(
        point=radius * out + high[:, None] * up, normal=out, direction_max=np.tile(up, (n, 1)), uv=np.zeros((n, 2)),
        curvature=np.tile([0.0, -1.0 / radius], (n, 1)), face=np.ones(n, np.int32), area=np.ones(n),
        neighbours=edges.astype(np.int32), unjudged=np.full(n, -1, np.int32), reasons=(), grids=(), max_gap=apart, empty=(),
    )  # fmt: skip
    return samples, math.sin(lean) * out + math.cos(lean) * up, np.cross(up, out)


@settings(deadline=None, max_examples=20)
@given(st.floats(3.0, 80.0), st.floats(0.1, 1.4), st.floats(0.1, 5.0))
def test_round_a_cylinder_the_table_turns_once_a_circumference(radius, lean, rate):
    samples, axis, along = around(radius, lean)
    rows = np.arange(len(axis))
    kinematics = Machine.parse("trunnion-ac").kinematics(np.eye(3))
    found = turning_times(samples, rows, axis, kinematics, np.array([rate, 1.0]))
    needed = np.einsum("mki,mi->mk", found, along)
    # Chords are a little shorter than arcs.
    assert np.abs(needed[:, 0]) == pytest.approx(1.0 / (radius * rate), rel=2e-3)
    assert np.abs(needed[:, 1]).max() < 1e-9
    assert np.abs(found[:, :, 2]).max() < 1e-9, "nothing turns along the cylinder"


@settings(deadline=None, max_examples=30)
@given(st.floats(0.01, 3.0), st.floats(0.1, 3.0), st.floats(0.1, 50.0))
def test_a_turn_takes_as_long_as_an_axis_that_gets_faster_and_slower_again(turn, rate, acceleration):
    """Against steps of time: as fast as the rate, the acceleration, and the way that is left let it be."""
    limit = np.array([[-math.pi, math.pi]])
    (found,) = index_times([[[turn]]], limit, np.array([rate]), np.array([acceleration]))
    at = speed = seconds = 0.0
    step = found / 20_000.0
    while at < turn - 1e-9 and seconds < 2.0 * found:
        stops = math.sqrt(max(0.0, 2.0 * acceleration * (turn - at)))
        speed = min(rate, speed + acceleration * step, stops)
        at, seconds = at + max(speed, 1e-12) * step, seconds + step
    assert found == pytest.approx(seconds, rel=0.02)
    (free,) = index_times([[[turn]]], limit, np.array([rate]))
    assert free == pytest.approx(turn / rate)
    assert free <= found


def test_files_state_accelerations_of_rotary_axes_too(tmp_path):
    """The file of a real machine: 60 deg/s and 200 deg/s2 of each rotary axis."""
    read = read_machine(DATA / "machines" / "linuxcnc_5axis.ini")
    (tmp_path / "own.toml").write_text(to_toml(read), encoding="utf-8")
    for each in (read, read_machine(tmp_path / "own.toml")):
        assert each.rates_deg == pytest.approx(dict.fromkeys(each.rates_deg, 60.0))
        assert [math.degrees(axis.acceleration) for axis in each.rotary] == pytest.approx([200.0, 200.0])
    assert Machine.parse("trunnion-ac").rates_deg == {}


@pytest.fixture(scope="module")
def timed():
    """The dome in simultaneous motion by the rates of C and A, deg/s; None: none is stated."""
    rates = [None, (1e6, 1e6), (90.0, 90.0), (20.0, 20.0), (20.0, 40.0), (1.0, 1.0)]
    return {
        each: plan(dome(20.0), machine="trunnion-ac" if each is None else machine(*each), **OPTIONS)
        for each in rates
    }  # fmt: skip


@pytest.mark.slow("plans a dome by six machines")
def test_motion_takes_as_long_as_its_slowest_axis_and_is_left_where_it_takes_too_long(timed):
    plans = {rates: made.plan.operations.plans[0] for rates, made in timed.items()}
    seconds = {rates: each.operations[0].seconds for rates, each in plans.items()}
    assert all(plans[rates].orientations == 0 for rates in plans if rates != (1.0, 1.0))
    assert seconds[None] == pytest.approx(seconds[1e6, 1e6])
    assert seconds[None] < seconds[90.0, 90.0] < seconds[20.0, 40.0] <= seconds[20.0, 20.0]
    made, other = (timed[rates].answers.operations.plans[0] for rates in ((20.0, 20.0), (1e6, 1e6)))
    assert (made.seconds >= other.seconds * (1.0 - 1e-9)).all()
    assert made.length == pytest.approx(other.length), "the path is as long"
    # A fixed orientation takes minutes where the axes would take hours.
    assert plans[1.0, 1.0].orientations == 1
    assert timed[20.0, 40.0].plan.effective.rotary_rates_deg_s == pytest.approx({"C": 20.0, "A": 40.0})
    assert timed[None].plan.effective.rotary_rates_deg_s == {}
