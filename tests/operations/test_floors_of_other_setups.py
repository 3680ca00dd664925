"""A face that one setup cuts as its floor is not turned to the flank in another."""

import cadquery as cq
import numpy as np
import pytest

from plan_cutters import plan
from plan_cutters.domain.operations import STRATEGIES

pytestmark = pytest.mark.slow("plans two setups")
WALL = STRATEGIES.index("wall")


def block():
    """A block with a pocket above and one below: it is clamped for both, and no wider than the flutes are long."""
    above = cq.Workplane().box(24, 60, 20).faces(">Z").workplane().center(0, 12).rect(14, 20).cutBlind(-6)
    return above.faces("<Z").workplane().center(0, 12).rect(14, 20).cutBlind(-6).val()


def test_the_top_is_a_floor_though_the_flank_would_be_quicker_in_the_other_setup():
    found = plan(
        block(), cutters="D6L60F26", faces="all", area_budget=0, feed=1000.0, machine="trunnion-ac", grid=5, setup=(0, 0, 1),
        other_setups=[(0, 0, -1)], operations="fastest", index_time=0.5,
    )  # fmt: skip
    made, normal = found.answers.operations.plans[0], found.samples.normal
    used = {each.setup for each in made.operations}
    assert used == {0, 1}
    for each in made.operations:
        walls = each.rows[made.strategy[each.rows] == WALL]
        up = np.abs(normal[walls, 2]) > 0.999
        assert not up.any()
    # The sides are walls of the first setup all the same: nothing is turned for that.
    sides = np.flatnonzero(made.strategy == WALL)
    assert len(sides)
    assert all(abs(made.operations[k].axis[2]) > 0.999 for k in np.unique(made.label[sides]).tolist())
