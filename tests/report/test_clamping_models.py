"""Vises and chucks in what is written: the STEP and GLB models, the page, and the checker's own bodies."""

import numpy as np
import pytest

from cad_io import read_part
from plan_cutters import plan
from plan_cutters.domain.fixture import Fixture
from plan_cutters.report import models
from plan_cutters.report.models import clamping_shape
from plan_cutters_check.asking import bodies_of
from plan_cutters_check.fixtures import PlacedFixture
from plan_cutters_check.question import Setup
from tests.support import gltf
from tests.support.cad_parts import box, rod

HOW = {"cutters": "R2L60", "faces": "all", "grid": 5, "area_budget": 0, "machine": "trunnion-ac"}


@pytest.fixture(scope="module", params=["vise", "chuck"])
def held(request):
    return plan(box(40, 30, 20) if request.param == "vise" else rod(12, 30), fixtures=request.param, **HOW)


@pytest.mark.slow("plans a part in a vise")
def test_models_have_the_bodies(held, tmp_path):
    split = models.split_result(held)
    models.write_step(held, split, tmp_path / "a.step")
    (entry,) = held.plan.fixtures
    assert f"PRODUCT('{entry.name}'" in (tmp_path / "a.step").read_text()
    assert "fixture_not_cad" not in held.plan.note_codes
    # The part and each body of the clamping: a solid.
    bodies = len(Fixture.parse(entry.clamping).clamping.solids(0.01, shown=True))
    assert len([*read_part(tmp_path / "a.step").solid_shapes()]) == 1 + bodies
    models.write_glb(held, split, tmp_path / "a.glb")
    document, _ = gltf.read(tmp_path / "a.glb")
    (node,) = [each for each in document["nodes"] if each["name"] == entry.name]
    assert node["extras"]["clamping"] == entry.clamping
    assert node["extras"]["grips"] == entry.grips


def test_what_is_drawn_ends_a_little_beside_the_riser(held):
    (fixture,) = held.conditions.surroundings.fixtures
    assert np.ptp(fixture.shown, axis=(0, 1)).max() < 500.0
    assert np.ptp(fixture.obstacles.triangles.vertex, axis=(0, 1)).max() > 4000.0


def test_the_cad_bodies_are_the_obstacles(held):
    """Volume of the kernel's solids against that of the triangles, by the divergence theorem."""
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps

    (fixture,) = held.conditions.surroundings.fixtures
    properties = GProp_GProps()
    BRepGProp.VolumeProperties_s(clamping_shape(fixture.fixture.clamping, 0.01), properties)
    vertex = fixture.shown
    volume = float(np.einsum("ni,ni->n", vertex[:, 0], np.cross(vertex[:, 1], vertex[:, 2])).sum()) / 6.0
    assert properties.Mass() == pytest.approx(volume, rel=1e-4)


def test_the_checker_builds_the_same_bodies_by_itself(held):
    """Points about the jaws lie in the checker's bodies where they lie in the obstacles."""
    from plan_cutters.kernels.material import windings

    (fixture,) = held.conditions.surroundings.fixtures
    setup = Setup((0.0, 0.0, 1.0), None, None, (), frozenset())
    low, high = np.array([-60.0, -60.0, -60.0]), np.array([60.0, 60.0, 20.0])
    placed = [PlacedFixture(each, setup, low, high) for each in bodies_of(fixture.fixture)]
    points = np.random.default_rng(7).uniform(low, high, (600, 3))
    theirs = np.logical_or.reduce([each.holds(points) for each in placed])
    number = np.empty(len(points))
    windings(np.ascontiguousarray(points), fixture.obstacles.solids, number)
    assert 0.05 < theirs.mean() < 0.9
    # What lies within the error of an arc may go either way.
    assert (theirs == (number > 0.5)).mean() > 0.99
