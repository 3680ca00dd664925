"""Cells whose axis is near the normal, or along it: random contacts in them against the exact surface."""

from dataclasses import replace

import numpy as np
import pytest

from cad_io import read_part
from plan_cutters import Cutter
from tests.support import shapes
from tests.support.contacts import UP, dense, served
from tests.support.tool_profile import deepest

TOOLS = {"flat": Cutter.flat(radius=2, length=40), "bull": Cutter.bull(radius=2.5, corner_radius=1, length=40),
         "tapered": Cutter.bull(radius=2, corner_radius=0.5, length=40, taper=0.07),
         "holder": Cutter.flat(radius=2, length=9, holder="R8L40")}  # fmt: skip


def hills(rng):
    """A gentle random surface and two walls that stand on it: near its tops axes are near the normal."""
    x, y = np.meshgrid(np.linspace(-30, 30, 13), np.linspace(-30, 30, 13), indexing="ij")
    z = -(x**2 + y**2) / rng.uniform(120, 300) + rng.normal(0, 0.05, x.shape)
    z += rng.uniform(0, 0.7) * np.cos(x / rng.uniform(6, 9)) * np.cos(y / rng.uniform(6, 9))
    walls = [
        shapes.plane((-8, 8), (-2, 20), (*rng.uniform(-15, 15, 2), 0), (*rng.normal(size=2), 0), (0, 0, 1)) for _ in range(2)
    ]
    return shapes.shell(shapes.Patch(np.stack([x, y, z], axis=-1)).face(), *walls)


def near(found, geometry, turn):
    """The served cells in whose middle the normal is within an angle of the axis."""
    cells = found.cells
    normal = np.concatenate([geometry(1, cells.uv[i : i + 1])[1] for i in np.flatnonzero(cells.face == 1)])
    mine = np.flatnonzero(cells.face == 1)[(normal * cells.axis[cells.face == 1]).sum(axis=1) > np.cos(turn)]
    return replace(found, cells=replace(cells, **{k: getattr(cells, k)[mine] for k in cells.__slots__}))


@pytest.mark.slow("draws many surfaces", but=("1-flat", "1-holder"))
@pytest.mark.parametrize("kind", TOOLS)
@pytest.mark.parametrize("seed", range(2))
def test_no_contact_of_a_cell_with_its_axis_near_the_normal_gouges(kind, seed):
    rng = np.random.default_rng(seed)
    part = read_part(hills(rng))
    axes = rng.normal(0, 0.1, (4, 3)) + UP
    axes = np.concatenate([UP[None], axes / np.linalg.norm(axes, axis=1)[:, None]])
    found, geometry, whole = served(part, TOOLS[kind], budget=4000, grid=61, faces="1", axes=axes,
                                    tolerance=0.02)  # fmt: skip
    assert (abs(found.cells.axis[:, None] - axes).max(axis=2).min(axis=1) == 0).all(), "no other posture is tried"
    some = near(found, geometry, 0.05)
    print(found.share, len(some.cells.face))
    assert len(some.cells.face) > 40, "nothing to look at"
    assert deepest(some, geometry, whole, TOOLS[kind], dense(whole, 0.5), 150, rng) < 0.02 + 2e-3


@pytest.mark.slow("another cutter of the same law", but=("flat",))
@pytest.mark.parametrize("kind", ["flat", "bull"])
def test_a_dome_is_served_over_its_top(kind):
    """With one axis along the normal at the top: before, no cell near it was served."""
    part = read_part(shapes.shell(shapes.Patch(cap()).face()))
    found, geometry, whole = served(part, TOOLS[kind], budget=4000, grid=41, axes=UP[None], tolerance=0.01)
    assert found.share > 0.999
    assert deepest(found, geometry, whole, TOOLS[kind], dense(whole, 0.5), 300, np.random.default_rng(2)) < 0.01 + 2e-3


def cap():
    x, y = np.meshgrid(np.linspace(-15, 15, 9), np.linspace(-15, 15, 9), indexing="ij")
    return np.stack([x, y, -(x**2 + y**2) / 120], axis=-1)


@pytest.mark.slow("another side of the same law", but=("-1",))
@pytest.mark.parametrize("side", [1, -1])
def test_a_plane_beside_a_wall_is_served_on_one_side(side):
    """A wall along Y at one side of a plane, tool radius 2.5: with the axis upright the cutter stands on one side all over.

    Its bottom centre lies against the first principal direction, X here, unless a wall is there: then it lies on another side,
    and cells whose samples have different sides are served one by one.
    """
    base = shapes.plane((-10, 10), (-12, 12))
    wall = shapes.plane((-12, 12), (0, 30), (10.0 * side, 0, 0), (-side, 0, 0), (0, 1, 0))
    cutter = Cutter.flat(radius=2.5, length=40)
    found, geometry, whole = served(read_part(shapes.shell(base, wall)), cutter, budget=20_000, spacing=1.0, faces="1",
                                    axes=UP[None], tolerance=0.01)  # fmt: skip
    middle = found.cells.uv - cutter.radius * found.cells.side[:, :2]
    past = np.maximum(0.0, np.abs(middle[:, 1]) - 12.0)
    assert (np.hypot(10.0 - side * middle[:, 0], past) >= cutter.radius - 0.011).all()
    first = np.abs(found.cells.side[:, 0] - 1.0) < 1e-9
    assert first.any()
    assert first.all() == (side == 1)
    assert found.share == pytest.approx(1.0) if side == 1 else 15.0 / 20.0 < found.share < 1.0
    assert deepest(found, geometry, whole, cutter, dense(whole, 0.25), 300, np.random.default_rng(0)) < 0.01 + 2e-3
