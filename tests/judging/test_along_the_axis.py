"""Walls that a fixed axis runs along: what is served of them, against closed forms and the exact tool."""

import numpy as np
import pytest

from cad_io import read_part
from plan_cutters import Cutter
from tests.support import shapes
from tests.support.contacts import UP, dense, served
from tests.support.tool_profile import deepest

R, WIDE, HIGH = 2.5, 20.0, 16.0
TOOLS = {"flat": Cutter.flat(radius=R, length=40), "bull": Cutter.bull(radius=R, corner_radius=1, length=40),
         "ball": Cutter.ball(radius=R, length=40)}  # fmt: skip


def wall(lean=0.0):
    """A wall of 20 x 16 mm that faces +X and hangs over by an angle, its foot at the origin."""
    normal = (np.cos(lean), 0.0, -np.sin(lean))
    return shapes.plane((-WIDE / 2, WIDE / 2), (0.0, HIGH), (0, 0, 0), normal, (0, 1, 0))


def corner(lean=0.0):
    """That wall between a floor and a wall beside it, which tell on which side of it the material is."""
    floor = shapes.plane((0.0, 30.0), (-WIDE / 2, WIDE / 2))
    beside = shapes.plane((0.0, 30.0), (0.0, HIGH), (0, WIDE / 2, 0), (0, -1, 0), (1, 0, 0))
    return read_part(shapes.shell(wall(lean), floor, beside))


@pytest.mark.slow("another cutter of the same law", only=("ball",))
@pytest.mark.parametrize("kind", TOOLS)
def test_a_wall_along_the_axis_is_served_but_near_what_is_in_the_way(kind):
    """A corner c stays its own height over the floor, every tool its radius from the wall beside."""
    whole_part, cutter = corner(), TOOLS[kind]
    found, geometry, whole = served(whole_part, cutter, budget=8000, spacing=1.0, faces="1", axes=UP[None],
                                    tolerance=0.01, tilt=(0.0, np.pi / 2))  # fmt: skip
    free = (WIDE - R) / WIDE * (HIGH - cutter.corner_radius) / HIGH
    # The tolerance lets a little more be served: sqrt(2 tau c) of height at a corner.
    more = np.sqrt(2 * 0.01 * cutter.corner_radius) / HIGH + 0.02 / WIDE
    assert free - 0.02 < found.share <= free + more
    assert (abs(found.cells.axis - UP).max(axis=1) == 0).all()
    assert deepest(found, geometry, whole, cutter, dense(whole, 0.5), 300, np.random.default_rng(0)) < 0.01 + 2e-3


@pytest.mark.parametrize("lean", [1e-3, 1e-4, 1e-6])
def test_a_wall_that_hangs_over_is_not_taken_for_one(lean):
    """Its flutes reach 40 mm up: what leans by more than 1e-9 is not along the axis, even if less deep than the tolerance."""
    found, *_ = served(corner(lean), TOOLS["flat"], budget=500, spacing=4.0, faces="1", axes=UP[None], tolerance=0.01,
                       tilt=(0.0, np.pi / 2))  # fmt: skip
    assert found.share == 0.0


@pytest.mark.parametrize("towards", [1, -1])
def test_no_contact_of_a_bent_wall_gouges(towards):
    """Round walls, of 200 mm radius, concave or convex, with the axis along their rulings: nothing false may be said."""
    y, z = np.meshgrid(np.linspace(-10, 10, 9), np.linspace(0, 16, 5), indexing="ij")
    points = np.stack([towards * y**2 / 400, -y, z], axis=-1)
    part = read_part(shapes.shell(shapes.Patch(points).face()))
    found, geometry, whole = served(part, TOOLS["flat"], budget=2000, spacing=1.0, axes=UP[None], tolerance=0.01,
                                    tilt=(0.0, np.pi / 2))  # fmt: skip
    if len(found.cells.face):
        assert deepest(found, geometry, whole, TOOLS["flat"], dense(whole, 0.5), 100, np.random.default_rng(1)) < 0.012
