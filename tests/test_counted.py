"""What is counted: the area that served cells cover of trimmed faces, gaps up to the border, chords up to true borders."""

import math

import numpy as np
import pytest
import shapes
from cad_parts import box, compound, cut, rod
from moulds import put
from OCP.BRepTopAdaptor import BRepTopAdaptor_FClass2d
from OCP.gp import gp_Pnt2d
from OCP.TopAbs import TopAbs_OUT
from test_between import deepest, dense, served

from cad_io import read_part
from cad_io.clip import clipped, inside
from cad_io.evaluate import density
from cad_io.kernel import faces
from plan_cutters import Cutter

WIDE = 60.0


def gentle(bend=300.0):
    """A shallow dome over a square of WIDE mm, from its middle."""
    x, y = np.meshgrid(*[np.linspace(-0.5 * WIDE, 0.5 * WIDE, 7)] * 2, indexing="ij")
    return shapes.Patch(np.stack([x, y, -(x**2 + y**2) / bend], axis=-1)).face()


def wall(x, high=30.0, y=(-40.0, 80.0)):
    """A plate that stands beside the line at x and is no target."""
    return box(1.0, y[1], high, (x, y[0], -20.0))


def trimmed(*tools):
    """The dome without what lies in the tools."""
    shape = gentle()
    for tool in tools:
        shape = cut(shape, tool)
    return shape


#: Trims of the dome, and what stands beside them. Grid lines of the 25 x 25 grid are 2.5 mm apart.
TRIMS = {
    "between lines, a wall beside": lambda: compound(trimmed(box(40, 90, 60, (11.2, -45, -40))), wall(11.25)),
    "oblique line": lambda: trimmed(put(box(90, 90, 80, (0, -45, -40)), 0.4, (0, 0, 1), (9.3, 0, 0))),
    "circles": lambda: trimmed(rod(11.3, 80, (4.1, 3.7, -40)), rod(5.2, 80, (-17.3, -12.9, -40))),
    "thin neck": lambda: trimmed(box(30, 40, 60, (-14.1, 0.9, -40)), box(30, 40, 60, (-14.1, -40.7, -40))),
    "a strip between two lines": lambda: trimmed(box(40, 90, 60, (1.9, -45, -40)), box(40, 90, 60, (-39.6, -45, -40))),
}


def random_points(whole, number, count, rng):
    """Parameters (count, 2) of random points of a face, evenly spread over its area; the kernel says what is inside."""
    u0, u1, v0, v1 = whole.trim(number).box
    kernel = BRepTopAdaptor_FClass2d(whole.face(number), 1e-9)
    most = 1.05 * density(whole, number, rng.uniform((u0, v0), (u1, v1), (4000, 2))).max()
    found = np.zeros((0, 2))
    while len(found) < count:
        uv = rng.uniform((u0, v0), (u1, v1), (2 * count, 2))
        uv = uv[rng.uniform(0, most, len(uv)) < density(whole, number, uv)]
        uv = uv[[kernel.Perform(gp_Pnt2d(*at)) != TopAbs_OUT for at in uv.tolist()]]
        found = np.concatenate([found, uv])
    return found[:count]


def within(cells, uv):
    """Which points lie in one of the cells."""
    low, high = cells.uv - 0.5 * cells.span, cells.uv + 0.5 * cells.span
    found = np.zeros(len(uv), bool)
    for rows in np.array_split(np.arange(len(uv)), 40):
        at = uv[rows, None]
        found[rows] = ((at >= low) & (at <= high)).all(axis=2).any(axis=1)
    return found


@pytest.mark.parametrize("budget", [0, 3000])
@pytest.mark.parametrize("make", TRIMS.values(), ids=TRIMS.keys())
def test_the_share_is_that_of_random_points_in_served_cells(make, budget):
    rng = np.random.default_rng(3)
    cutter = Cutter.flat(radius=4.0, length=60.0)
    found, geometry, whole = served(make(), cutter, budget=budget, grid=25, faces="1", tolerance=0.02)
    count = 4000
    share = within(found.cells, random_points(whole, 1, count, rng)).mean()
    spread = math.sqrt(max(share * (1 - share), 1 / count) / count)
    assert found.share == pytest.approx(share, abs=4 * spread)
    if budget:
        assert deepest(found, geometry, whole, cutter, dense(whole, 0.5), 300, rng) < 0.02
