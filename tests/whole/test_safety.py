"""No posture that is called free gouges: against dense sampling of the exact surface that shares no code with the search."""

import math

import numpy as np
import pytest
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepTools import BRepTools
from OCP.BRepTopAdaptor import BRepTopAdaptor_FClass2d
from OCP.gp import gp_Pnt2d
from OCP.TopAbs import TopAbs_OUT
from scipy.spatial import cKDTree

from cad_io import read_part
from cad_io.tessellate import tessellate
from plan_cutters import Cutter, plan
from plan_cutters.domain.verdicts import ACCESSIBLE, INTERFERENCE_FREE
from plan_cutters.kernels.search import search
from plan_cutters.scene.obstacles import Obstacles
from tests.support import shapes, waves
from tests.support.places import SAMPLES
from tests.support.reference import depth_in_cutter, posture, random_frame


def refined_depth(patch, contact, normal, axis, tilt_direction, radius, length, grid, lines):
    """Deepest point of a patch in the cutter: a dense grid, then ever finer grids about its deepest nodes."""
    depth = depth_in_cutter(grid, contact, normal, axis, tilt_direction, radius, length)
    best = float(depth.max())
    step = lines[1] - lines[0]
    for flat in np.argpartition(depth.ravel(), -6)[-6:]:
        i, j = np.unravel_index(flat, depth.shape)
        u, v, h = lines[i], lines[j], step
        for _ in range(5):
            du, dv = np.meshgrid(np.linspace(-h, h, 9), np.linspace(-h, h, 9))
            us, vs = np.clip(u + du.ravel(), 0, 1), np.clip(v + dv.ravel(), 0, 1)
            near = depth_in_cutter(patch.at(us, vs), contact, normal, axis, tilt_direction, radius, length)
            k = int(near.argmax())
            u, v, h, best = us[k], vs[k], h / 4, max(best, float(near[k]))
    return best


@pytest.mark.slow("searches a surface of its own for each seed", only=("1", "2"))
@pytest.mark.parametrize("seed", range(3))
def test_verdicts_equal_those_of_the_exact_surface_outside_the_band(seed):
    """Random surfaces, random postures: the fast verdict and the slow depth differ by no more than twice the chord error."""
    rng = np.random.default_rng(seed)
    patch = shapes.Patch.random(rng)
    triangles = tessellate(read_part(shapes.shell(patch.face())), 0.01)
    obstacles, error = Obstacles(triangles), triangles.chord_error
    assert error < 0.012
    grid, lines = patch.grid(161)
    n = 160
    point, normal = rng.uniform([0, 0, -8], [60, 60, 20], (n, 3)), np.empty((n, 3))
    axis, tilt_direction = np.empty((n, 3)), np.empty((n, 3))
    radius, length = 5.0, 40.0
    for i in range(n):
        normal[i], direction = random_frame(rng)
        axis[i], tilt_direction[i] = posture(normal[i], direction, rng.uniform(0, math.pi / 2), rng.uniform(0, 2 * math.pi))
    exact = np.array([
        refined_depth(patch, point[i], normal[i], axis[i], tilt_direction[i], radius, length, grid, lines) for i in range(n)
    ])  # fmt: skip
    blocked = exact > 0.05
    assert 20 < blocked.sum() < 140
    # Thresholds at random, and many just around each posture's own depth.
    for offset in (-3, -2.01, -1, 0, 1, 2.01, 3):
        depths = np.clip(exact + offset * error, 1e-3, 2.0)
        triangle = np.full(n, -1, np.int32)
        for i in range(n):
            tool = waves.flat(radius, length, depths[i])
            search.probe(np.array([i]), point, normal, axis, tilt_direction, tool, obstacles.tree, triangle, triangle.copy())
        assert (triangle[exact > depths + 2 * error] >= 0).all()
        assert (triangle[exact < depths - 2 * error] < 0).all()


def dense_points(part, n):
    """Points of the exact surface of all faces, by the kernel's own evaluation and classifier."""
    found = []
    for face in part.faces:
        shape = part.face(face.number)
        surface = BRepAdaptor_Surface(shape)
        u0, u1, v0, v1 = BRepTools.UVBounds_s(shape)
        inside = BRepTopAdaptor_FClass2d(shape, 1e-7)
        whole = BRep_Tool.NaturalRestriction_s(shape)
        for u in np.linspace(u0, u1, n):
            for v in np.linspace(v0, v1, n):
                if whole or inside.Perform(gp_Pnt2d(float(u), float(v))) != TopAbs_OUT:
                    found.append(surface.Value(float(u), float(v)).Coord())
    return np.array(found)


def deepest_of_free_postures(name, cutter, count, dense, grid):
    part = read_part(SAMPLES / f"{name}.step")
    result = plan(part, cutters=[cutter], grid=grid, tolerance=0.01, area_budget=0)
    reach, samples = result.reaches[cutter.id], result.samples
    rng = np.random.default_rng(7)
    rows = rng.choice(np.flatnonzero(reach.reached), count)
    surface = dense_points(part, dense)
    tree = cKDTree(surface)
    deepest, radius = -np.inf, cutter.radius
    for row in rows:
        normal, axis, tilt_direction = samples.normal[row], reach.axis[row], reach.tilt_direction[row]
        if reach.verdict[row] == INTERFERENCE_FREE:
            # Free in every rotation at tilt 0.
            axis, tilt_direction = posture(normal, samples.direction_max[row], 0.0, rng.uniform(0, 2 * math.pi))
        else:
            assert reach.verdict[row] == ACCESSIBLE
        # Balls strung along the axis cover the cutter.
        x_t = (axis @ normal) * tilt_direction - (axis @ tilt_direction) * normal
        heights = np.arange(radius, cutter.length + radius, 2 * radius)
        centres = samples.point[row] - radius * x_t + heights[:, None] * axis
        near = surface[np.unique(np.concatenate(tree.query_ball_point(centres, 1.4143 * radius)).astype(int))]
        if len(near) == 0:
            continue
        depth = depth_in_cutter(near, samples.point[row], normal, axis, tilt_direction, cutter.radius, cutter.length)
        deepest = max(deepest, float(depth.max()))
    return deepest


CASES = [
    ("v_groove", Cutter.flat(radius=8, length=90), 41),
    ("peaks_and_valleys", Cutter.flat(radius=6, length=80), 61),
    ("pocket_top", Cutter.flat(radius=4, length=60), 41),
    ("blade", Cutter.flat(radius=6, length=60), 41),
    ("control_arm", Cutter.flat(radius=3, length=60), 21),
]


@pytest.mark.slow("searches long", only=("pocket", "blade", "control"))
@pytest.mark.parametrize(("name", "cutter", "grid"), CASES)
def test_reported_postures_do_not_gouge(name, cutter, grid):
    deepest = deepest_of_free_postures(name, cutter, 150, 40 if name == "control_arm" else 200, grid)
    # Contact is the deepest that a safe posture should come, up to the tolerance.
    assert -0.01 < deepest <= 0.01


@pytest.mark.slow("looks at ten thousand postures")
@pytest.mark.parametrize(("name", "cutter", "grid"), CASES)
def test_ten_thousand_reported_postures_do_not_gouge(name, cutter, grid):
    deepest = deepest_of_free_postures(name, cutter, 10_000, 60 if name == "control_arm" else 300, grid)
    print(f"{name}: deepest penetration {deepest:.6f} mm")
    assert -0.01 < deepest <= 0.01
