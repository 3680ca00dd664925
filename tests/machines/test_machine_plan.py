"""A machine in a plan: postures that it holds, positions of its axes, and what the axis limit alone loses."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest

from plan_cutters import Cutter, Machine, Options, plan, posture_map
from plan_cutters.domain.machine import Axis, builtin_machines
from plan_cutters.domain.placement import frame_of
from plan_cutters.domain.verdicts import REASONS
from plan_cutters.judging.judge import judge
from plan_cutters.judging.limits import within_limits
from plan_cutters.machines import to_toml
from plan_cutters.pipeline import prepare
from tests.support import cad_parts, shapes
from tests.support.closed_forms import floor, wall

CUTTER = Cutter.flat(radius=2, length=40)


@pytest.mark.slow("plans and writes for each machine", but=("setup1-trunnion-ac", "setup1-head-table-bc"))
@pytest.mark.parametrize("name", sorted(builtin_machines()))
@pytest.mark.parametrize("setup", [(0, 0, 1), (1, -2, 0.5)])
def test_postures_found_are_held(name, setup, tmp_path):
    found = plan("samples/blade.step", cutters=CUTTER, machine=name, setup=setup, grid=13, area_budget=0)
    reach = found.reaches[CUTTER.id]
    assert reach.reached.any()
    machine = builtin_machines()[name]
    kinematics = machine.kinematics(frame_of(np.array(setup) / np.linalg.norm(setup)))
    assert kinematics.allows(reach.axis[reach.reached]).all()
    found.write(tmp_path, ["json", "npz"])
    with np.load(tmp_path / "samples.npz") as arrays:
        angles, taken = np.radians(arrays[f"rotary_{CUTTER.id}"]), arrays[f"rotary_taken_{CUTTER.id}"]
    assert angles.shape == (len(found.samples), 2, len(machine.rotary))
    assert ((taken >= 0) == reach.reached).all()
    rows = np.flatnonzero(reach.reached)
    if machine.rotary:
        # The chain forward, at the positions given, is the axis given.
        held = kinematics.axis(angles[rows, taken[rows]])
        assert np.abs(held - reach.axis[rows]).max() < 2e-6
    entry = json.loads((tmp_path / "plan.json").read_text())["machine"]
    assert (entry["name"], len(entry["rotary"])) == (name, len(machine.rotary))


def test_a_machine_holds_no_more_than_none_and_no_less_than_its_cone():
    """A trunnion of 8 deg about the spindle, its table turning on, is a plain limit of 8 deg: the same verdicts."""
    tilting = Axis("A", "rotary", "part", (1, 0, 0), (-math.radians(8), math.radians(8)))
    axes = (Axis("C", "rotary", "part", (0, 0, 1)), tilting)
    reaches = []
    for machine in (Machine("table", axes=axes), Machine.parse("tilt:8"), Machine()):
        ready = prepare("samples/peaks_and_valleys.step", Options(cutters=CUTTER, grid=21, machine=machine, area_budget=0))
        reaches.append(judge(ready, CUTTER))
    table, cone, free = reaches
    assert (table.reached == cone.reached).all()
    assert (table.verdict == cone.verdict).all()
    assert (free.reached | ~table.reached).all()
    assert free.reached.sum() > table.reached.sum() > 0


def test_a_machine_whose_axes_stand_still_reaches_what_one_of_three_axes_does():
    still = tuple(replace(axis, limits=(0.0, 0.0)) for axis in builtin_machines()["head-table-bc"].axes)
    first = builtin_machines()["head-table-bc"].axes[0]
    asked = {"cutters": CUTTER, "grid": 8, "area_budget": 0, "setup": (0.3, -0.2, 0.9), "other_setups": [(0, 0, -1)]}
    alone = plan("samples/blade.step", machine="3-axis", **asked).reaches[CUTTER.id]
    assert 0 < alone.reached.sum() < len(alone.reached)
    for axes in (still, (first, still[1])):
        found = plan("samples/blade.step", machine=Machine("still", axes=axes), **asked).reaches[CUTTER.id]
        assert (found.verdict == alone.verdict).all()


def test_the_map_of_one_point_knows_the_machine():
    """The same free tilts as under the plain limit that it amounts to; and none that it cannot hold."""
    tilting = Axis("A", "rotary", "part", (1, 0, 0), (-math.radians(8), math.radians(8)))
    table = Machine("table", axes=(Axis("C", "rotary", "part", (0, 0, 1)), tilting))
    asked = {"point": (0, 0, 0), "cutter": CUTTER, "rotations": [0.0, 0.7, 2.0], "setup": (0.05, 0, 1)}
    one, other = (posture_map(floor(), machine=machine, **asked) for machine in (table, "tilt:8"))
    for mine, theirs in zip(one.free + one.axis_limit, other.free + other.axis_limit, strict=True):
        assert mine == pytest.approx(theirs, abs=1e-6)
    assert all(len(intervals) for intervals in one.axis_limit)
    uneven = replace(tilting, limits=(0.0, math.radians(30)))
    machine = Machine("uneven", axes=(replace(table.axes[0], limits=(-1.0, 1.0)), uneven))
    found = posture_map(floor(), machine=machine, **asked)
    kinematics = machine.kinematics(frame_of(np.array(asked["setup"]) / np.linalg.norm(asked["setup"])))
    assert any(len(intervals) for intervals in found.free)
    for i, intervals in enumerate(found.free):
        for tilt in intervals.ravel().tolist():
            assert kinematics.allows(found.axis(i, tilt)[None])[0]


def test_the_map_of_one_point_takes_a_machine_file(tmp_path):
    file = tmp_path / "mill.toml"
    file.write_text(to_toml(Machine.parse("trunnion-ac")))
    asked = {"point": (0, 0, 0), "cutter": CUTTER, "rotations": [0.3], "setup": (-1, 0, 0)}
    named, read = (posture_map(floor(), machine=machine, **asked) for machine in ("trunnion-ac", file))
    assert len(named.axis_limit[0])
    np.testing.assert_array_equal(named.free[0], read.free[0])
    np.testing.assert_array_equal(named.axis_limit[0], read.axis_limit[0])


def test_an_underside_does_not_change_the_choice():
    """A plate's underside is beyond a limit of 60 deg: the cutter that leaves nothing else is told for this setup."""
    block = cad_parts.box(20, 20, 6)
    found = plan(block, cutters=[CUTTER, Cutter.flat(radius=1, length=30)], faces="all", machine="tilt:60", grid=4, area_budget=0)
    document = found.plan
    under = [face.id for face in document.faces if found.samples.normal[found.samples.face == int(face.id[1:]), 2].max() < -0.9]
    (entry, _) = document.cutters
    assert len(under) == 1
    assert entry.beyond_setup == 16 == entry.inaccessible == entry.faces[under[0]].inaccessible
    assert entry.by_reason["axis_limit"] == 16
    assert (document.selected, document.selected_for_setup) == (None, entry.id)
    shares = {each.axis: each.within for each in document.setups}
    # Sides are reached at tilt 90 from a spindle along Z, which is 60 deg off at best: not beyond, for a flank cuts there.
    assert shares[(0.0, 0.0, 1.0)] == shares[(0.0, 0.0, -1.0)] == len(found.samples) - 16
    assert document.setups[0].axis == (0.0, 0.0, 1.0)


def test_no_limit_loses_nothing():
    document = plan(cad_parts.box(20, 20, 6), cutters=CUTTER, faces="all", grid=3, area_budget=0).plan
    assert (document.cutters[0].beyond_setup, document.selected_for_setup, document.setups) == (0, None, [])
    assert document.machine.rotary is None


def test_what_is_within_the_limits_is_what_some_cutter_could_touch():
    """A slow twin: no sample beyond is reached by any cutter, each within has an axis in the cone about its normal."""
    part = shapes.bowl(15.0)
    cutters = (Cutter.flat(radius=0.5, length=60), Cutter.ball(radius=0.5, length=60))
    ready = prepare(part, Options(cutters=cutters, faces="all", machine="tilt:20", tilt=(0.0, 0.5), grid=9, area_budget=0))
    within = within_limits(ready.samples, ready.cutters, ready.conditions)
    away = np.arccos(np.clip(ready.samples.normal @ [0, 0, 1.0], -1, 1))
    sure = np.abs(away - math.radians(20) - 0.5) > 0.02
    # Rotations are 10 deg apart: the one towards the spindle is missed by 5 deg at most.
    assert (within == (away < math.radians(20) + 0.5))[sure].all()
    for cutter in cutters:
        reach = judge(ready, cutter)
        assert not (reach.reached & ~within).any()
        assert (reach.reason[~within] == REASONS.index("axis_limit")).all()


def test_three_axes_on_a_floor_by_a_wall():
    """The one axis that there is serves the floor up to the wall, and the sculptured slope where it is not too steep."""
    part = cad_parts.compound(shapes.plane((-10, 0), (-5, 5)), wall(0.0, 0.0, 30.0, -1), floor(-200, 0))
    found = plan(part, cutters=CUTTER, faces=[1], machine="3-axis", grid=3, area_budget=0)
    reach = found.reaches[CUTTER.id]
    assert reach.reached.all()
    assert np.abs(reach.axis - [0, 0, 1]).max() < 2e-6


def test_several_setups_reach_more_together(tmp_path):
    """On a machine of three axes each setup reaches what a plan with it reaches; together they are what any of them does."""
    axes = [(0.0, 0.0, 1.0), (0.0, 1.0, 0.0), (0.0, -1.0, 0.0)]
    found = plan(
        "samples/blade.step", cutters=CUTTER, machine="3-axis", setup=axes[0], other_setups=axes[1:], grid=13, area_budget=0
    )
    alone = [
        plan("samples/blade.step", cutters=CUTTER, machine="3-axis", setup=axis, grid=13, area_budget=0).reaches[CUTTER.id]
        for axis in axes
    ]
    (entry,) = found.plan.cutters
    assert [each.axis for each in entry.setups] == axes
    for each, reach in zip(entry.setups, alone, strict=True):
        assert each.accessible + each.interference_free == reach.reached.sum()
    together = np.logical_or.reduce([reach.reached for reach in alone])
    assert entry.lost_in_all == (~together).sum()
    assert together.sum() > max(reach.reached.sum() for reach in alone)
    assert found.plan.selected_over_setups == (CUTTER.id if together.all() else None)
    found.write(tmp_path, ["npz"])
    with np.load(tmp_path / "samples.npz") as arrays:
        assert arrays["setups"].tolist() == [list(axis) for axis in axes]
        assert (arrays[f"reached_in_{CUTTER.id}"] == np.stack([reach.reached for reach in alone], axis=1)).all()


@pytest.mark.slow("plans parts whole")
@pytest.mark.parametrize("machine", ["tilt:40", "trunnion-ac"])
def test_another_setup_finds_what_a_plan_with_it_finds(machine):
    """Postures that are handed over are held there, and none is missed."""
    found = plan("samples/blade.step", cutters=CUTTER, machine=machine, other_setups=[(0, 1, 0.2)], grid=13, area_budget=0)
    ((axis, reaches),) = found.over_setups.each[1:]
    alone = plan("samples/blade.step", cutters=CUTTER, machine=machine, setup=(0, 1, 0.2), grid=13, area_budget=0)
    assert (reaches[CUTTER.id].reached == alone.reaches[CUTTER.id].reached).all()
    reach, machine = reaches[CUTTER.id], Machine.of(machine)
    held = reach.axis[reach.reached] @ np.array(axis) >= machine.limit_cos - 1e-9
    assert held.all()
    kinematics = machine.kinematics(frame_of(np.array(axis)))
    assert kinematics is None or kinematics.allows(reach.axis[reach.reached]).all()


def test_a_turned_setup_says_that_it_turns_open_faces():
    """A plane's side is a guess towards the setup axis: from below it is the other one, and the plan says so."""
    notes = [plan(shapes.plane((-5, 5), (-5, 5)), cutters=CUTTER, setup=setup, grid=3, area_budget=0).plan.notes
             for setup in ((0, 0, 1), (0, 0, -1))]  # fmt: skip
    assert [any("decides the side of open faces" in note for note in each) for each in notes] == [False, True]
