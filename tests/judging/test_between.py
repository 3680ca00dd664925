"""Cells that are called served, against the exact surface: random contacts in them."""

import math
from dataclasses import replace

import numpy as np
import pytest

from cad_io import read_part
from cad_io.part.bodies import orient
from cad_io.tessellate import tessellate
from plan_cutters import Cutter, Machine, Options
from plan_cutters.domain.posture import PostureRange
from plan_cutters.judging import between as between_module
from plan_cutters.judging.cells import CellContacts, Field, quartered, tensors
from plan_cutters.judging.face_cells import FaceCells, _cover
from plan_cutters.judging.judge import judge
from plan_cutters.kernels.codes import NEVER
from plan_cutters.pipeline import prepare
from plan_cutters.scene.conditions import Conditions, Context
from plan_cutters.scene.obstacles import Obstacles
from plan_cutters.scene.surroundings import Surroundings
from tests.support import shapes
from tests.support.cad_parts import box
from tests.support.contacts import UP, deepest, dense, served
from tests.support.places import SAMPLES


@pytest.mark.slow("draws many surfaces", only=("1",))
@pytest.mark.parametrize("seed", range(2))
def test_no_contact_of_a_served_cell_gouges_a_random_surface(seed):
    rng = np.random.default_rng(seed)
    part = read_part(shapes.shell(shapes.Patch.random(rng, height=6.0).face()))
    cutter = Cutter.flat(radius=2.0, length=40.0)
    found, geometry, whole = served(part, cutter, budget=12_000, grid=91)
    assert found.cells.face.size > 1000, "nothing to look at"
    assert deepest(found, geometry, whole, cutter, dense(whole, 0.5), 150, rng) < 0.01


def test_all_of_a_gentle_block_is_served():
    cutter = Cutter.flat(radius=8.0, length=90.0)
    found, geometry, whole = served(SAMPLES / "pocket_top.step", cutter, budget=60_000)
    assert found.share == 1
    assert found.left == 0
    assert deepest(found, geometry, whole, cutter, dense(whole, 0.5), 150, np.random.default_rng(0)) < 0.01


@pytest.mark.slow("judges thousands of contacts on a sample part")
@pytest.mark.parametrize(("name", "cutter", "how"), [
    ("peaks_and_valleys", Cutter.flat(radius=6, length=80), {"grid": 201}),
    ("blade", Cutter.flat(radius=2, length=30), {}),
])  # fmt: skip
def test_no_contact_of_a_served_cell_gouges_a_sample_part(name, cutter, how):
    found, geometry, whole = served(SAMPLES / f"{name}.step", cutter, budget=60_000, **how)
    worst = deepest(found, geometry, whole, cutter, dense(whole, 0.4), 3000, np.random.default_rng(1))
    print(name, found.share, found.contacts, f"deepest {worst:.4f} mm")
    assert worst < 0.01


def test_flat_surfaces_are_served_by_their_samples():
    """On planes and ridges nothing changes between the samples."""
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox

    found, _, _ = served(BRepPrimAPI_MakeBox(40, 30, 10).Solid(), Cutter.flat(radius=5, length=60), budget=0, spacing=3.0)
    assert found.share == 1


@pytest.mark.slow("judges many samples")
def test_more_budget_never_serves_less_and_threads_do_not_matter():
    part = read_part(SAMPLES / "pocket_top.step")
    cutter = Cutter.flat(radius=8.0, length=90.0)
    looks = [served(part, cutter, budget=b)[0] for b in (0, 400, 2000, 20_000)]
    shares = [found.share for found in looks]
    assert shares == sorted(shares)
    assert shares[0] < shares[-1]
    for budget, found in zip((0, 400, 2000), looks, strict=False):
        assert found.contacts - looks[0].contacts <= budget
    alone = served(part, cutter, budget=2000, jobs=1)[0]
    for name in ("face", "uv", "span", "axis"):
        assert (getattr(alone.cells, name) == getattr(looks[2].cells, name)).all()
    assert (alone.share, alone.left, alone.short) == (looks[2].share, looks[2].left, looks[2].short)


@pytest.mark.slow("looks at the same cells with four budgets")
def test_every_budget_looks_at_the_cells_of_a_smaller_one():
    """On a surface where not all can be served: shares never fall, and what is left is told apart."""
    part = read_part(shapes.shell(shapes.Patch.random(np.random.default_rng(0), height=6.0).face()))
    cutter = Cutter.flat(radius=2.0, length=40.0)
    looks = [served(part, cutter, budget=b, grid=61, tolerance=0.02)[0] for b in (0, 40, 1500, 6000)]
    shares = [found.share for found in looks]
    assert shares == sorted(shares)
    assert shares[0] < shares[-1] < 1
    for found in looks:
        assert 0 <= found.short + found.dropped <= found.left
        assert found.contacts - looks[0].contacts <= 6000


def test_it_stops_where_nothing_is_gained():
    """On a surface too wild for its samples no cell is served, however large the budget."""
    part = read_part(shapes.shell(shapes.Patch.random(np.random.default_rng(3), height=9.0).face()))
    found = served(part, Cutter.flat(radius=3.0, length=40.0), budget=200_000, grid=31, tolerance=0.02)[0]
    assert found.contacts < 20_000
    assert found.left > 0
    assert found.short == 0


def test_no_smaller_patch_is_served_where_none_is_said_to_be():
    part = read_part(shapes.shell(shapes.Patch.random(np.random.default_rng(3), height=9.0).face()))
    cutter, sites = Cutter.flat(radius=3.0, length=40.0), []
    with pytest.MonkeyPatch.context() as patch:
        made = FaceCells.refine
        patch.setattr(FaceCells, "refine", lambda site, *asked: (sites.append(site), made(site, *asked))[1])
        served(part, cutter, budget=2000, grid=31, tolerance=0.02)
    (site,) = sites
    never = 0
    for contacts, outlook in site.pools:
        rows = np.flatnonzero(outlook == NEVER)
        never += len(rows)
        for smaller in (0.7, 0.5, 0.25):
            shrunk = replace(contacts, patch=smaller * contacts.patch)
            tensor = tensors(shrunk.normal, shrunk.direction_max, shrunk.curvature)
            again = _cover(shrunk, tensor, contacts.axis, contacts.flat, site, rows)
            assert (again != 0).all()
    assert never > 15


@pytest.mark.slow("judges many samples")
def test_leans_too_small_to_know_their_side_serve_no_cell_beside_a_wall():
    """A ridge beside a wall, tilts of a quarter degree: within a cell the cutter would swing over to the wall, but in few small
    ones."""
    part, cutter = ridge_beside_a_wall(), Cutter.flat(radius=5.0, length=30.0)
    turn = math.pi / 2
    for low, high in ((0.1, 0.4), (0.5, 20.0)):
        found, geometry, whole = served(part, cutter, budget=20_000, spacing=4.0, faces="1", rotation=(turn, turn + 0.01),
                                        tilt=(math.radians(low), math.radians(high)))  # fmt: skip
        if len(found.cells.face):
            assert deepest(found, geometry, whole, cutter, dense(whole, 0.4), 400, np.random.default_rng(0)) < 0.01
        # Farther than a diameter from the wall, at x = 9, it does not matter on which side the cutter stands.
        near = geometry(1, found.cells.uv)[0][:, 0] > 9.0 - 2.0 * cutter.radius
        assert low > 0.4 or found.cells.area[near].sum() < 0.05 * found.surrounding_area.sum()


def ridge_beside_a_wall():
    x, y = np.meshgrid(np.linspace(-6, 6, 11), np.linspace(0, 12, 5), indexing="ij")
    ridge = shapes.Patch(np.stack([x, y, 30 * np.cos(x / 30) - 30], axis=-1)).face()
    return read_part(shapes.shell(ridge, shapes.plane((-10, 22), (-3, 20), (9, 0, 0), (-1, 0, 0), (0, 1, 0))))


@pytest.mark.slow("judges many samples")
def test_a_cutter_that_leans_along_a_ridge_moves_farther_across_it_than_its_contact():
    """Twice as far: as the ridge bends, the cutter swings over to the wall."""
    part, cutter, tilt = ridge_beside_a_wall(), Cutter.flat(radius=5.0, length=30.0), math.radians(10.0)
    found, geometry, whole = served(part, cutter, budget=6000, spacing=2.0, faces="1", rotation=(0.0, 0.01),
                                    tilt=(tilt, tilt + 0.001))  # fmt: skip
    assert len(found.cells.face) > 800
    assert deepest(found, geometry, whole, cutter, dense(whole, 0.4), 1000, np.random.default_rng(0)) < 0.01


def test_axes_between_samples_keep_the_machines_limit():
    """Quarters of an interference-free cell lean with their own normals, where the machine can."""
    x, y = np.meshgrid(np.linspace(-20, 20, 9), np.linspace(-20, 20, 9), indexing="ij")
    part = read_part(shapes.shell(shapes.Patch(np.stack([x, y, -(x**2 + y**2) / 60], axis=-1)).face()))
    cutter, limit = Cutter.flat(radius=3.0, length=40.0), math.cos(math.radians(10)) - 1e-12
    found, geometry, whole = served(part, cutter, budget=4000, spacing=6.0, machine="tilt:10")
    assert len(found.cells.face) > 1000
    assert (found.cells.axis @ UP >= limit).all()

    # A cell that reaches from within the limit to beyond it.
    uv = np.array([[0.5, 0.62]])
    point, normal, direction, curvature = geometry(1, uv)
    lines = [(np.array([0.3, 0.7]), np.array([0.42, 0.82]))]
    field = Field(whole, orient(whole, towards=UP, flip=False), 1, whole.trim(1), lines, np.zeros((1, 1), np.int32),
                  np.zeros(2, bool), point, normal, np.zeros((1, 3, 3)))  # fmt: skip
    cell = CellContacts(point, normal, direction, curvature, normal, np.array([True]), np.ones(1), np.zeros((1, 2), np.int32),
                    np.zeros((1, 2), np.int64), uv, np.full((1, 2), 0.4), np.array([True]), np.ones(1), np.ones(1),
                    np.zeros(1, bool), direction, np.zeros(1, np.int64))  # fmt: skip
    plane = Surroundings.sheet(Obstacles(tessellate(part, 0.002)))
    conditions = Conditions(Machine.parse("tilt:10"), UP, PostureRange(), plane, 0.01, 1)
    quarters = quartered(cell, field, 0, conditions)
    within = quarters.normal @ UP >= limit
    assert 0 < within.sum() < 4
    assert (np.isfinite(quarters.axis).all(axis=1) == within).all()
    assert quarters.axis[within] == pytest.approx(quarters.normal[within])


@pytest.mark.parametrize("most", [math.inf, 40_000.0])
def test_each_face_books_the_work_that_its_contacts_took(monkeypatch, most):
    """All work is that of some face; where it is limited, the last contacts that are begun may go beyond."""
    made, part = [], read_part(box(30, 20, 10))
    monkeypatch.setattr(between_module, "FaceCells", lambda *given: made.append(FaceCells(*given)) or made[-1])
    ready = prepare(part, Options.of({"cutters": "R3L40", "faces": "all", "grid": 5, "area_budget": 0}))
    context = Context.of(ready.cutters[0], ready.conditions)
    found = between_module.between(
        ready.samples, judge(ready, ready.cutters[0]), context, part, ready.scene.orientation, budget=2000, most=most
    )
    work = made[0].work
    assert len(made) == 6
    assert all(each.work is work for each in made)
    assert sum(each.spent for each in made) == work.looked > 0
    assert sum(each.seen for each in made) == found.contacts > 50


@pytest.mark.slow("judges many samples")
def test_what_a_wall_hides_between_samples_is_not_served():
    """A thin rib between two rows of samples: no cell next to it may be called served by an axis that hits it."""
    rng = np.random.default_rng(5)
    part = shapes_with_rib()
    cutter = Cutter.flat(radius=4.0, length=40.0)
    found, geometry, whole = served(part, cutter, budget=4000, spacing=4.0, faces="all")
    assert deepest(found, geometry, whole, cutter, dense(whole, 0.25), 300, rng) < 0.01


def shapes_with_rib():
    from OCP.BRepAlgoAPI import BRepAlgoAPI_Fuse
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox
    from OCP.gp import gp_Pnt

    base = BRepPrimAPI_MakeBox(40, 40, 5).Solid()
    return BRepAlgoAPI_Fuse(base, BRepPrimAPI_MakeBox(gp_Pnt(17.3, 0, 4), 0.4, 40, 8).Solid()).Shape()
