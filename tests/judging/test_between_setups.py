"""Between the samples of setups that hold the part differently: each cell holds among the fixtures of its own setup."""

import numpy as np
import pytest

from cad_io.face.curvature import evaluate
from plan_cutters import plan
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.placement import Placement
from plan_cutters.judging.between import in_each
from plan_cutters.scene.conditions import Context
from tests.support.cad_parts import box

#: Jaws of 20 x 30 x 22 mm beside a cube of 10 mm, two at its lower end and two at its upper one: their least corners.
JAWS = [[(10, -10, -20), (-20, -10, -20)], [(10, -10, 8), (-20, -10, 8)]]
SIZE = np.array([20.0, 30.0, 22.0])
RADIUS, LENGTH = 2.0, 40.0


def held(axis, corners):
    return Placement(axis, fixtures=tuple(Fixture.parse(f"box:20,30,22@{x},{y},{z}") for x, y, z in corners))


@pytest.fixture(scope="module")
def both():
    first, other = held((0.0, 0.0, 1.0), JAWS[0]), held((0.0, 0.0, -1.0), JAWS[1])
    return plan(box(), cutters="R2L40rc2", faces="all", grid=7, machine="tilt:80", setup=first, other_setups=[other])


@pytest.fixture(scope="module")
def found(both):
    ready, (name,) = both.ready, both.reaches
    contexts = [Context.of(both.judged(), setup) for setup in ready.setups]
    return in_each(both.samples, both.reaches[name], both.served_in[name], contexts, both.part, both.scene.orientation,
                   budget=2000)  # fmt: skip


def into_blocks(contact, normal, axis, blocks):
    """How deep blocks, a corner and a size each, reach into a ball end that touches a contact, mm: by points along its axis."""
    along = contact + RADIUS * normal + np.linspace(0.0, LENGTH - RADIUS, 800)[:, None] * axis
    away = [
        np.linalg.norm(np.maximum(0.0, np.maximum(np.array(low) - along, along - low - size)), axis=1).min()
        for low, size in blocks
    ]
    return RADIUS - min(away)


def test_no_contact_of_a_served_cell_meets_the_part_or_the_jaws_of_its_setup(both, found):
    rng, (name,) = np.random.default_rng(0), both.reaches
    cells, which = found.cells, both.served_in[name]
    assert set(which[cells.sample]) == {0, 1}
    own, others = [], []
    for row in rng.choice(len(cells.face), 600):
        uv = cells.uv[row] + rng.uniform(-0.5, 0.5, 2) * cells.span[row] * 0.999
        if not cells.whole[row]:
            continue
        point, shape = evaluate(both.part, both.scene.orientation, int(cells.face[row]), uv[None])
        at = point[0], shape.normal[0], cells.axis[row]
        setup = which[cells.sample[row]]
        cube = (np.zeros(3), np.full(3, 10.0))
        own.append(into_blocks(*at, [cube, *((low, SIZE) for low in JAWS[setup])]))
        others.append(into_blocks(*at, [(low, SIZE) for low in JAWS[1 - setup]]))
    assert max(own) < 0.01
    # Among the jaws of the other setup many of them would not do.
    assert np.mean(np.array(others) > 0.1) > 0.05


def test_cells_are_counted_once_and_the_plan_says_their_share(both, found):
    (entry,) = both.plan.cutters
    assert entry.not_reached == 0
    assert 0.5 < entry.area.share < 1.0
    assert found.whole == pytest.approx(600.0)
    assert found.cells.area.sum() == pytest.approx(found.served)
    assert found.surrounding_area.sum() <= found.whole * (1 + 1e-9)
    assert found.served <= found.surrounding_area.sum() * (1 + 1e-9)
