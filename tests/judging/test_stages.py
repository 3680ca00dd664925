"""Stages alone, on samples by formula: classes, regions, the march over boundaries, spacing, reasons handed up."""

import math
from collections import deque

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import ndimage

from cad_io import SurfaceSamples, Triangles, read_part
from cad_io.part.bodies import orient
from cad_io.sample import sample
from plan_cutters import Cutter, Machine, PostureRange
from plan_cutters.domain.verdicts import CONCAVE, CONVEX, INACCESSIBLE, REASONS, SADDLE, UNDECIDED, UNJUDGED, blank
from plan_cutters.judging.phases import FLAT, access, classify, march_differs, regions
from plan_cutters.judging.posture_maps import posture_map_of
from plan_cutters.scene.conditions import Conditions, Context
from plan_cutters.scene.obstacles import Obstacles
from plan_cutters.scene.preparation import BUDGET, default_spacing
from plan_cutters.scene.surroundings import Surroundings
from tests.support import shapes
from tests.support.cad_parts import ball, rod

UP = (0.0, 0.0, 1.0)


def samples(curvature, shape=None, normal=UP):
    """Samples with curvatures (n, 2), on a grid of a shape (rows, columns) if there is one."""
    n = len(curvature)
    number = np.arange(n).reshape(shape or (n, 1))
    pairs = [np.stack([number[:-1].ravel(), number[1:].ravel()], 1), np.stack([number[:, :-1].ravel(), number[:, 1:].ravel()], 1)]
    rows, columns = np.divmod(np.arange(n), number.shape[1])
    normal = np.array(normal, float) / np.linalg.norm(normal)
    direction = np.array([normal[2], 0.0, -normal[0]]) / math.hypot(normal[2], normal[0])
    return SurfaceSamples(
        point=np.stack([rows, columns, np.zeros(n)], 1).astype(float), normal=np.tile(normal, (n, 1)),
        direction_max=np.tile(direction, (n, 1)), curvature=np.array(curvature, float), uv=np.zeros((n, 2)),
        face=np.ones(n, np.int32), area=np.ones(n), neighbours=np.concatenate(pairs).astype(np.int32),
        unjudged=np.where(np.isfinite(curvature).all(axis=1), -1, 0).astype(np.int32), reasons=("no curvature",), grids=(),
        max_gap=1.0, empty=(),
    )  # fmt: skip


def test_classes_by_the_signs_of_both_curvatures():
    flat, bent = 0.9 * FLAT / 100, 1.1 * FLAT / 100
    cases = {
        (0.0, 0.0): CONVEX, (0.0, -0.1): CONVEX, (-0.1, -0.2): CONVEX, (0.1, 0.0): CONCAVE, (0.2, 0.1): CONCAVE,
        (0.1, -0.1): SADDLE, (flat, -0.1): CONVEX, (bent, -0.1): SADDLE, (0.1, -flat): CONCAVE, (0.1, -bent): SADDLE,
        (math.nan, math.nan): UNJUDGED, (0.1, math.nan): UNJUDGED,
    }  # fmt: skip
    assert classify(samples(list(cases)), 100.0).tolist() == list(cases.values())


@pytest.mark.parametrize(
    ("shape", "inside", "outside"),
    [(ball(10), CONCAVE, CONVEX), (rod(), CONCAVE, CONVEX)], ids=["ball", "rod"],
)  # fmt: skip
def test_surfaces_of_bodies_have_the_class_of_their_side(shape, inside, outside):
    part = read_part(shape)
    side = orient(part, towards=UP, flip=False)
    found = sample(part, side, grid=7, spacing=None, faces=[1])
    judged = found.unjudged < 0
    assert judged.sum() > 20
    assert set(classify(found, 30.0)[judged]) == {outside}
    other = type(side)(-side.sign, side.method, side.confident)
    turned = sample(part, other, grid=7, spacing=None, faces=[1])
    assert set(classify(turned, 30.0)[judged]) == {inside}


@given(st.lists(st.sampled_from([CONVEX, CONCAVE, SADDLE]), min_size=42, max_size=42))
@settings(max_examples=60, deadline=None)
def test_regions_are_the_connected_samples_of_a_class(classes):
    grid = np.array(classes, np.uint8).reshape(6, 7)
    region = regions(samples(np.zeros((42, 2)), (6, 7)), grid.ravel()).reshape(6, 7)
    expected = 0
    for kind in (CONVEX, CONCAVE, SADDLE):
        label, count = ndimage.label(grid == kind)
        expected += count
        for number in range(1, count + 1):
            assert len(set(region[label == number])) == 1
    assert len(np.unique(region)) == expected
    assert region.min() == 0


def marched(shape, convex, region, free):
    """The seed's march, slowly: from the rim and from other regions inwards, over samples that are not free."""
    rows, columns = shape
    around = {
        (i, j): [(i + a, j + b) for a, b in ((1, 0), (-1, 0), (0, 1), (0, -1)) if 0 <= i + a < rows and 0 <= j + b < columns]
        for i in range(rows) for j in range(columns)
    }  # fmt: skip
    blocked = convex & ~free
    edge = {at for at, near in around.items() if len(near) < 4 or any(region[k] != region[at] for k in near)}
    waiting = deque(at for at in edge if blocked[at])
    prone = set(waiting)
    while waiting:
        here = waiting.popleft()
        for there in around[here]:
            if there not in prone and blocked[there] and region[there] == region[here]:
                prone.add(there)
                waiting.append(there)
    return sum(bool(blocked[at]) and at not in prone for at in around)


def test_a_pocket_that_the_march_does_not_reach():
    """Three blocked samples in the middle of a free region: the march ends before them and would call them free."""
    shape = (7, 9)
    free = np.ones(shape, bool)
    free[3, 3:6] = False
    free[0, 1] = False  # at the rim: the march finds that one
    convex = np.ones(63, bool)
    found = march_differs(samples(np.zeros((63, 2)), shape), convex, np.zeros(63, np.int32), free.ravel())
    assert found == 3


@given(st.lists(st.booleans(), min_size=48, max_size=48), st.lists(st.integers(0, 9), min_size=48, max_size=48))
@settings(max_examples=60, deadline=None)
def test_the_march_is_that_of_the_seed(convex, chance):
    shape = (6, 8)
    convex, free = np.array(convex), np.array(chance) < 6
    free &= convex
    grid = samples(np.zeros((48, 2)), shape)
    region = regions(grid, np.where(convex, CONVEX, CONCAVE).astype(np.uint8))
    slow = marched(shape, convex.reshape(shape), region.reshape(shape), free.reshape(shape))
    assert march_differs(grid, convex, region, free) == slow


def test_default_spacing_follows_cutter_curvature_and_budget():
    small, large = Cutter.flat(radius=2, length=30), Cutter.flat(radius=8, length=60)
    flat = read_part(shapes.plane((0, 40), (0, 40)))
    side = orient(flat, towards=UP, flip=False)
    assert default_spacing(flat, side, [1], [large, small]) == ({1: 0.5}, 1.0)
    assert default_spacing(flat, side, [1], [large]) == ({1: 2.0}, 1.0)
    # A cylinder: the normal turns by at most 0.2 rad from sample to sample, but no more than four times as finely.
    bent = read_part(rod())  # radius 5
    side = orient(bent, towards=UP, flip=False)
    curved = next(f.number for f in bent.faces if f.shape == "cylinder")
    assert default_spacing(bent, side, [curved], [large])[0][curved] == pytest.approx(0.2 * 5)
    assert default_spacing(bent, side, [curved], [Cutter.flat(radius=40, length=99)])[0][curved] == pytest.approx(10 / 4)
    # Too many: coarser on all faces alike.
    wide = read_part(shapes.plane((0, 4000), (0, 1000)))
    spacing, coarser = default_spacing(wide, orient(wide, towards=UP, flip=False), [1], [small])
    assert coarser > 1.0
    found = spacing[1]
    assert 4000 * 1000 / found**2 == pytest.approx(BUDGET)


def test_reasons_are_handed_up_but_for_what_the_larger_cutter_has_of_its_own():
    """A smaller cutter is kept off by what stands in the way; where the larger has no posture at all, that is its reason."""
    curvature = [(0.0, 0.0), (0.2, 0.2), (0.0, 0.0)]
    grid = samples(curvature)
    far = Obstacles(Triangles(np.array([[[0, 0, -50.0], [1, 0, -50], [0, 1, -50]]]), np.ones(1, np.int32), 0.0, ()))
    known = blank(3)
    known.verdict[:], known.reason[:] = INACCESSIBLE, REASONS.index("collision")
    conditions = Conditions(Machine(), np.array(UP), PostureRange(), Surroundings.sheet(far), 0.01, 1)
    cutter = Cutter.flat(radius=8, length=30)
    found = access(grid, np.zeros(3, bool), Context.of(cutter, conditions), known=known)
    assert found.verdict.tolist() == [INACCESSIBLE] * 3
    assert [REASONS[r] for r in found.reason] == ["collision", "local_gouge", "collision"]
    # Normals along x, a machine that holds its axis near z.
    aside = samples(curvature, normal=(1.0, 0.0, 0.01))
    tilted = Conditions(Machine.parse("tilt:5"), np.array(UP), PostureRange(tilt=(0.0, 0.5)), Surroundings.sheet(far), 0.01, 1)
    found = access(aside, np.zeros(3, bool), Context.of(cutter, tilted), known=known)
    assert [REASONS[r] for r in found.reason] == ["axis_limit"] * 3


def test_a_tolerance_too_coarse_for_a_cutter_decides_nothing():
    grid = samples([(0.0, 0.0)] * 2)
    far = Obstacles(Triangles(np.array([[[0, 0, -50.0], [1, 0, -50], [0, 1, -50]]]), np.ones(1, np.int32), 0.0, ()))
    conditions = Conditions(Machine(), np.array(UP), PostureRange(), Surroundings.sheet(far), 0.5, 1)
    for radius, verdict in ((1.9, UNDECIDED), (2.1, 1)):
        found = access(grid, np.zeros(2, bool), Context.of(Cutter.flat(radius=radius, length=30), conditions))
        assert found.verdict.tolist() == [verdict] * 2


def test_a_tolerance_too_coarse_for_a_cutter_finds_no_place_under_its_flat():
    far = Obstacles(Triangles(np.array([[[0, 0, -50.0], [1, 0, -50], [0, 1, -50]]]), np.ones(1, np.int32), 0.0, ()))
    conditions = Conditions(Machine(), np.array(UP), PostureRange(), Surroundings.sheet(far), 0.5, 1)
    for radius, lies in ((1.9, False), (2.1, True)):
        context = Context.of(Cutter.flat(radius=radius, length=30), conditions)
        assert posture_map_of(samples([(0.0, 0.0)]), np.zeros(0), context, 1e-4).lies_flat is lies
