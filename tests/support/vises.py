"""Machine vises as triangle meshes: a bed and two jaws, each a closed body, of as many triangles as wanted."""

import numpy as np

from cad_io.arrays import Triangles
from plan_cutters import Scene
from plan_cutters.domain.fixture import Fixture
from plan_cutters.scene.fixtures import entered
from plan_cutters.scene.obstacles import Obstacles
from plan_cutters.scene.triangles import divided
from plan_cutters.setups.solids import box


def block(low, high, longest=np.inf):
    """A box as triangles (n, 3, 3) with no side longer than `longest`."""
    low, high = np.array(low, float), np.array(high, float)
    return divided(box(low, high), low - 1, high + 1, longest)


def vise(size, depth=15.0, jaw=30.0, longest=np.inf):
    """Around a part from the origin to `size`, its jaws along y and up to `depth`."""
    x, y, _ = size
    return np.concatenate([
        block((-jaw, -3 * jaw, -40), (x + jaw, y + 3 * jaw, 0), longest),
        block((-jaw, -jaw, 0), (x + jaw, 0, depth), longest),
        block((-jaw, y, 0), (x + jaw, y + jaw, depth), longest),
    ])  # fmt: skip


def hold_of(part, word, setup=(0.0, 0.0, 1.0), targets=()):
    """How a vise or chuck is placed on a part for a setup axis."""
    scene = Scene.of(part).for_targets(targets)
    scene.surround()
    return scene.hold(Fixture.parse(word), setup)


def stands_in(clamping, points, deep, place=(0.0,) * 6):
    """Whether some of points (n, 3) in the frame of a vise or chuck is seen deeper in it than asked, wherever it stands."""
    fixture = Fixture(clamping.word, place)
    vertex = np.repeat(fixture.placed(points)[:, None], 3, axis=1)
    return entered(Obstacles(Triangles(vertex, np.ones(len(points), np.int32), 0.0, ())), fixture, clamping, deep)
