"""What a setup grips and stands on is left to the setups before it, as far as the cutters reach it there."""

import cadquery as cq
import numpy as np
import pytest

from plan_cutters import Placement, plan

HOW = {"faces": "all", "machine": "3-axis", "operations": "fastest", "feed": 600, "cutters": "D16L60F32S16", "spacing": 3.0}


@pytest.fixture(scope="module")
def turned():
    """A block that is turned over, and stands on its side then: most of it could be cut in several setups."""
    block = cq.Workplane().box(60, 50, 40)
    setups = [
        Placement(z=(0, 0, 1), fixtures=("stock:box:1,1,6",)),
        Placement(z=(0, 0, -1), stands_on=("F6",)),
        Placement(z=(0, 1, 0), stands_on=("F3", "F5")),
    ]
    return plan(block, setup=setups[0], other_setups=setups[1:], **HOW)


def test_no_later_step_cuts_what_is_held_before(turned):
    face, process = turned.samples.face, turned.answers.operations.plans[0]
    setup = np.array([each.setup for each in process.operations])
    for number, names in ((1, ("F6",)), (2, ("F3", "F5"))):
        rows = np.isin(face, [int(name[1:]) for name in names]) & (process.label >= 0)
        earlier = np.logical_or.reduce([v.reached for each in turned.over_setups.each[:number] for v in each[1].values()])
        assert (setup[process.label[rows & earlier]] < number).all()
        assert (rows & earlier).sum() > 20


def test_all_is_finished_still(turned):
    assert turned.plan.process.finished_share > 0.99
