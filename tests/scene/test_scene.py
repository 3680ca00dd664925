"""A scene is what was requested; what stands in the way of it is made when it is requested, once, and handed on."""

import inspect
import pickle
from functools import cached_property

import numpy as np
import pytest

from cad_io.arrays import Orientation
from cad_io.part.bodies import Body
from plan_cutters import plan, posture_map
from plan_cutters.domain.fixture import Fixture
from plan_cutters.options import Options
from plan_cutters.pipeline import prepare
from plan_cutters.scene import inside_material
from plan_cutters.scene import scene as scenes
from plan_cutters.scene.inside_material import inside_bodies
from plan_cutters.scene.preparation import Prepared
from plan_cutters.scene.scene import Scene
from plan_cutters.scene.work import METER, Budget
from tests.support.cad_parts import box
from tests.support.places import ROOT

GROOVE = ROOT / "samples" / "v_groove.step"
SMALL = {"cutters": "R3L40", "grid": 9, "area_budget": 0}


@pytest.fixture
def made(monkeypatch):
    """Calls that tessellate, read fixtures or orient."""
    calls = []

    def count(name, real):
        monkeypatch.setattr(scenes, name, lambda *given, **more: calls.append(name) or real(*given, **more))

    for name in ("surroundings", "joined", "read", "orient"):
        count(name, getattr(scenes, name))
    return calls


def test_a_scene_computes_nothing_when_it_is_looked_at(made):
    scene = Scene.of(GROOVE, fixtures="box:4,4,4@0,0,40")
    del made[:]
    assert not [name for name, each in vars(Scene).items() if isinstance(each, cached_property)]
    for name in {*dir(scene)} - {"around", "tolerance", "turned"}:  # its former names ask `surround`
        getattr(scene, name)
    repr(scene)
    assert scene == Scene.of(scene)
    assert made == []


def test_surroundings_are_made_once_and_handed_on(made):
    scene = Scene.of(GROOVE, tolerance=0.02)
    around = scene.surround()
    result = plan(scene, **SMALL)
    posture_map(scene, point=(0, 0, 0), cutter="R3L40", rotations=[0.0])
    assert made.count("surroundings") == made.count("joined") == 1
    assert scene.surround() is around is result.conditions.surroundings
    with pytest.raises(AttributeError):
        around.possible = None


def test_a_scene_with_other_fixtures_has_its_own_surroundings():
    scene = Scene.of(GROOVE)
    alone = scene.surround()
    other = scene.clamped("box:4,4,4@0,0,40")
    assert other.surround().alone is alone
    assert scene.surround() is alone
    assert other.clamped([]).surround() is alone


def test_a_kept_scene_is_not_tessellated_again(made):
    scene = Scene.of(GROOVE)
    scene.surround()
    again = pickle.loads(pickle.dumps(scene))
    del made[:]
    assert (again.surround().possible.triangles.vertex == scene.surround().possible.triangles.vertex).all()
    assert made == []


@pytest.mark.parametrize("jobs", [1, 2])
def test_meshing_comes_before_sampling_however_many_work(jobs):
    told = []
    ready = plan(GROOVE, progress=lambda stage, done, total: told.append(stage), jobs=jobs, **SMALL).ready
    order = list(dict.fromkeys(told))
    assert order.index("tessellate") < order.index("classify")
    assert len(told) - 1 - told[::-1].index("sample") > told.index("tessellate")
    assert ready.conditions.tolerance == ready.conditions.surroundings.tolerance(ready.scene.asked)


def test_a_tolerance_is_kept_or_raised_to_what_triangles_allow():
    around = Scene.of(GROOVE).surround()
    error = around.certain.triangles.chord_error
    assert around.tolerance(10.0) == 10.0
    assert around.tolerance(1e-9) == pytest.approx(4.0 * error)


def test_what_is_inside_bodies_is_found_once(monkeypatch):
    calls, real = [], inside_material.voids
    ready = prepare(GROOVE, Options.of(SMALL))
    monkeypatch.setattr(inside_material, "voids", lambda *given: calls.append(1) or real(*given))
    assert not isinstance(inspect.getattr_static(Prepared, "inside_bodies", None), property)
    assert (ready.inside_bodies | ready.finished | (ready.samples.unjudged >= 0)).all()
    assert calls == []
    with pytest.raises(ValueError, match="read-only"):
        ready.inside_bodies[0] = True


def test_the_wall_of_a_void_and_what_fixtures_hold_is_surface_of_the_part():
    """Body 0 is material about face 1; body 1 is a void about face 2; index 2 is a fixture's."""
    none = np.zeros((0, 3, 3))
    bodies = (Body((1,), (1,), True, none), Body((2,), (1,), True, none))
    sides = Orientation(np.array([1.0, -1.0]), "given", True)
    found = inside_bodies(np.array([-1, 0, 1, 2], np.int32), bodies, sides)
    assert found.tolist() == [False, True, False, False]


def test_rows_of_each_face_are_those_of_its_number():
    samples = plan(ROOT / "samples/pocket_top.step", cutters=["R3L60rc3"], faces="all", grid=4, area_budget=0).samples
    rows = samples.by_face()
    assert set(rows) == set(samples.face.tolist())
    assert all((mine == np.flatnonzero(samples.face == number)).all() for number, mine in rows.items())


def test_what_is_round_is_as_fine_in_another_setup_as_in_the_first():
    part, held = box(), Fixture.parse("cylinder:4,11@60,3,8")
    first = Scene.of(part, setup=(0.0, 0.0, 1.0), fixtures=(held,)).surround()
    turned = Scene.of(part, setup=(0.0, 0.0, 1.0))
    turned.surround()
    other = turned.surround_in((0.0, 0.0, -1.0), (), (held,))
    assert len(other.certain.triangles) == len(first.certain.triangles) > 100
    assert other.certain.triangles.chord_error == first.certain.triangles.chord_error


def test_a_budget_is_what_was_given_less_what_was_looked_at_since():
    METER.add(50)
    budget = Budget(100.0)
    assert budget.left == 100.0
    METER.add(30)
    assert budget.left == 70.0
    METER.add(90)
    assert budget.left == 0.0
