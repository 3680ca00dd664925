"""Laws of a plan: what must hold whatever the surface is."""

import json
import math

import jsonschema
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform
from OCP.gp import gp_Ax1, gp_Dir, gp_Pnt, gp_Trsf, gp_Vec

from cad_io import read_part
from plan_cutters import Cutter, Machine, Scene, plan
from plan_cutters.domain.verdicts import ACCESSIBLE, INACCESSIBLE
from plan_cutters.report.to_json import dumps
from tests.support import shapes
from tests.support.places import ROOT


def patch(seed, height=9.0):
    return shapes.shell(shapes.Patch.random(np.random.default_rng(seed), size=40.0, height=height, n=7).face())


def reach(part, cutter, **options):
    return plan(part, cutters=[cutter], **{"grid": 25, "area_budget": 0, **options})


def moved(shape, transformation):
    return BRepBuilderAPI_Transform(shape, transformation, True).Shape()


@pytest.mark.slow("plans two parts for each seed", only=("1", "2"))
@pytest.mark.parametrize("seed", range(3))
def test_rigid_motion_changes_nothing(seed):
    rng = np.random.default_rng(seed)
    turn, shift = gp_Trsf(), gp_Trsf()
    direction = rng.standard_normal(3)
    turn.SetRotation(gp_Ax1(gp_Pnt(1, 2, 3), gp_Dir(*map(float, direction))), float(rng.uniform(0, 6)))
    shift.SetTranslation(gp_Vec(*map(float, rng.uniform(-500, 500, 3))))
    whole = shift.Multiplied(turn)
    up = gp_Vec(0, 0, 1).Transformed(turn).Coord()
    cutter, machine = Cutter.flat(radius=4, length=30), Machine.parse("tilt:50")
    here = reach(patch(seed), cutter, machine=machine)
    there = reach(moved(patch(seed), whole), cutter, machine=machine, setup=up)
    a, b = here.reaches[cutter.id].verdict, there.reaches[cutter.id].verdict
    assert {INACCESSIBLE, ACCESSIBLE} <= set(a.tolist())
    # The triangulation and the start of each search may differ: what lies on the very edge may turn.
    assert (a != b).mean() < 0.01
    assert there.samples.curvature == pytest.approx(here.samples.curvature, abs=1e-6)


@pytest.mark.slow("plans two parts for each scale", only=("7",))
@pytest.mark.parametrize("scale", [0.1, 7.0])
def test_scaling_changes_nothing(scale):
    larger = gp_Trsf()
    larger.SetScale(gp_Pnt(0, 0, 0), scale)
    surface = patch(5, height=14.0)
    here = reach(surface, Cutter.flat(radius=4, length=30), tolerance=0.02)
    there = reach(moved(surface, larger), Cutter.flat(radius=4 * scale, length=30 * scale), tolerance=0.02 * scale)
    a, b = (next(iter(r.reaches.values())).verdict for r in (here, there))
    assert {INACCESSIBLE, ACCESSIBLE} <= set(a.tolist())
    assert (a != b).mean() < 0.01


@given(seed=st.integers(0, 10_000), radius=st.floats(4, 7), share=st.floats(0.5, 0.95), shorter=st.floats(0.3, 1.0))
@settings(max_examples=5, deadline=None)
def test_a_cutter_inside_another_never_has_less(seed, radius, share, shorter):
    scene = Scene.of(patch(seed, height=18.0), tolerance=0.05)
    large, small = Cutter.flat(radius=radius, length=40), Cutter.flat(radius=radius * share, length=40 * shorter)
    # Each alone: together they hand postures to one another, and the law would hold by itself.
    (a,), (b,) = (reach(scene, c, grid=15).reaches.values() for c in (large, small))
    assume(a.reached.any() and (b.verdict == INACCESSIBLE).any() and a.interference_free.any())
    assert not (a.reached & (b.verdict == INACCESSIBLE)).any()
    assert not (a.interference_free & ~b.interference_free).any()


@given(seed=st.integers(0, 10_000), x=st.floats(10, 30), height=st.floats(-2, 8))
@settings(max_examples=5, deadline=None)
def test_more_obstacles_never_give_more(seed, x, height):
    net = shapes.Patch.random(np.random.default_rng(seed), size=40.0, height=4.0, n=7)
    wall = shapes.plane((-5, 5), (0, 20), (x, 20, height), (1, 0, 0), (0, 1, 0))
    cutter = Cutter.flat(radius=4, length=30)
    alone = reach(shapes.shell(net.face()), cutter, faces="1", grid=13, tolerance=0.05)
    walled = reach(shapes.shell(net.face(), wall), cutter, faces="1", grid=13, tolerance=0.05)
    assert walled.samples.point == pytest.approx(alone.samples.point)
    a, b = alone.reaches[cutter.id], walled.reaches[cutter.id]
    # The wall is in the way of something, and not of all.
    assume((a.reached & ~b.reached).any() and b.reached.any())
    assert not (b.reached & (a.verdict == INACCESSIBLE)).any()
    assert not (b.interference_free & ~a.interference_free).any()


def test_a_larger_tolerance_never_turns_safe_into_blocked():
    """The two plans have triangles of their own, 0.04 and 0.004 mm from the surface: they share nothing but the truth."""
    part = read_part(patch(11, height=14.0))
    cutter = Cutter.flat(radius=6, length=30)
    coarse = plan(part, cutters=[cutter], grid=31, tolerance=0.2, area_budget=0).reaches[cutter.id]
    fine = plan(part, cutters=[cutter], grid=31, tolerance=0.02, area_budget=0).reaches[cutter.id]
    assert min(fine.reached.sum(), (coarse.verdict == INACCESSIBLE).sum()) > 20
    assert not (fine.reached & (coarse.verdict == INACCESSIBLE)).any()
    # The tolerance decides, and in this direction alone.
    assert (coarse.reached & (fine.verdict == INACCESSIBLE)).sum() > 5


def test_a_wider_range_of_tilts_never_reaches_less():
    part = read_part(patch(11, height=14.0))
    cutter = Cutter.flat(radius=4, length=30)
    narrow = plan(part, cutters=[cutter], grid=31, area_budget=0, tilt=(0, math.radians(30))).reaches[cutter.id]
    wide = plan(part, cutters=[cutter], grid=31, area_budget=0).reaches[cutter.id]
    assert 20 < narrow.reached.sum() < wide.reached.sum()
    assert not (narrow.reached & (wide.verdict == INACCESSIBLE)).any()


def test_postures_obey_the_ranges_asked_for():
    machine = Machine.parse("tilt:35")
    tilt = (math.radians(5), math.radians(40))
    result = reach(patch(3), Cutter.flat(radius=2, length=30), machine=machine, tilt=tilt, rotation=(0.5, 2.0))
    (found,) = result.reaches.values()
    reached = found.reached
    assert 0 < reached.sum() < len(reached)
    axis, tilt_direction, normal = found.axis[reached], found.tilt_direction[reached], result.samples.normal[reached]
    assert (axis[:, 2] >= math.cos(math.radians(35)) - 1e-12).all()
    angle = np.arccos(np.clip((axis * normal).sum(1), -1, 1))
    assert (angle >= tilt[0] - 1e-9).all()
    assert (angle <= tilt[1] + 1e-9).all()
    assert np.linalg.norm(axis, axis=1) == pytest.approx(1)
    assert (tilt_direction * normal).sum(1) == pytest.approx(0, abs=1e-9)
    e1 = result.samples.direction_max[reached]
    rotation = np.arctan2((np.cross(normal, e1) * tilt_direction).sum(1), (e1 * tilt_direction).sum(1))
    assert (rotation >= 0.5 - 1e-9).all()
    assert (rotation <= 2.0 + 1e-9).all()


def test_the_plan_obeys_its_schema():
    result = reach(patch(1), Cutter.flat(radius=3, length=30))
    schema = json.loads((ROOT / "plugin/plan_cutters/plan.schema.json").read_text())
    plan_file = json.loads(dumps(result.plan))
    jsonschema.Draft202012Validator(schema).validate(plan_file)
    assert plan_file["cutters"][0].keys() >= {"id", "feasible", "by_reason", "witnesses"}
    assert "seconds" not in plan_file["cutters"][0]
    assert result.cutters[0].seconds > 0


def test_a_witness_stands_at_its_depth():
    """The posture named best is blocked at the depth told, by the reference's own measure of the surface."""
    from tests.support.reference import depth_in_cutter

    net = shapes.Patch.random(np.random.default_rng(2), size=40.0, height=14.0, n=7)
    cutter = Cutter.flat(radius=6, length=40)
    result = reach(shapes.shell(net.face()), cutter)
    witnesses = [w for w in result.cutters[0].witnesses if w.best_posture and w.depth_mm]
    assert witnesses
    points, _ = net.grid(400)
    points = points.reshape(-1, 3)
    for w in witnesses:
        row = int(np.linalg.norm(result.samples.point - w.point, axis=1).argmin())
        normal, axis = result.samples.normal[row], np.array(w.best_posture.axis)
        e1 = result.samples.direction_max[row]
        turn = math.radians(w.best_posture.rotation)
        tilt_direction = math.cos(turn) * e1 + math.sin(turn) * np.cross(normal, e1)
        deepest = depth_in_cutter(points, np.array(w.point), normal, axis, tilt_direction, 6.0, 40.0).max()
        assert deepest == pytest.approx(w.depth_mm, abs=0.02)
        assert w.depth_mm > 0.0099


def test_cadquery_and_build123d_objects_are_parts():
    import build123d
    import cadquery

    from plan_cutters.hosts import cadquery as host

    host.register()
    options = {"cutters": [Cutter.flat(radius=2, length=30)], "grid": 7}
    from_cadquery = cadquery.Workplane().box(20, 20, 10).plan_cutters(**options)
    from_build123d = plan(build123d.Box(20, 20, 10), **options)
    for result in (from_cadquery, from_build123d):
        assert result.selected == "R2L30"
        assert result.plan.part.solids == 1
        assert result.plan.part.orientation.confident
        assert result.plan.samples.count == 6 * 49
