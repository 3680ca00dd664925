"""Samples go with a step that has a margin about neck, shank and holder, if one has; what has less is told."""

import cadquery as cq
import numpy as np
import pytest

from plan_cutters import plan
from plan_cutters.domain.operations import columns_of
from plan_cutters.judging.judge import judge
from plan_cutters.operations.probes import Probes
from plan_cutters.options import Options
from plan_cutters.pipeline import prepare
from plan_cutters.plan_file.operations import MARGIN
from tests.support.cad_parts import box

HOW = {"faces": "all", "area_budget": 0, "feed": 1000.0, "machine": "trunnion-ac", "grid": 9, "operations": "fastest"}
#: The holder comes down to the top of a block of 40 mm, at its foot.
TIGHT = "D12L40HR20L30"


def step():
    """A low ledge beside a tower: upright, the holder passes the tower close by; the ledge may be cut with a lean, too."""
    return cq.Workplane().box(60, 40, 10).union(cq.Workplane().box(20, 40, 60).translate((-20, 0, 35))).val()


def test_less_than_the_margin_is_told_with_the_option_that_asks_for_it():
    low, high = (plan(box(30, 30, tall), cutters=TIGHT, **HOW) for tall in (38.0, 39.9))
    clear = [min(s.clearance_mm for s in each.plan.process.steps if s.clearance_mm is not None) for each in (low, high)]
    assert clear[0] >= MARGIN > clear[1]
    lines = [" ".join(each.plan.text.lines) for each in (low, high)]
    assert ["plan with 1 mm" in each for each in lines] == [False, True]
    asked = plan(box(30, 30, 39.9), cutters=TIGHT, holder_clearance=MARGIN, **HOW)
    assert "plan with 1 mm" not in " ".join(asked.plan.text.lines)


@pytest.mark.parametrize("cutter", ["D8L30HR15L30", "D8L30"])
def test_what_serves_with_a_margin_is_what_the_tool_with_that_clearance_serves(cutter):
    """Of a bare tool, which has no neck, shank or holder, all that it serves."""
    ready = prepare(step(), Options(cutters=cutter, **HOW))
    (tool,) = ready.cutters
    rows = np.flatnonzero(judge(ready, tool).reached)
    columns = columns_of(np.array([[0.0, 0.0, 1.0], [np.sin(0.3), 0.0, np.cos(0.3)]]), np.zeros((2, 2)))
    probes = Probes(ready.samples, ready.cutters, ready.setups, ready.machinable)
    serves = probes.table(rows, columns)
    spacious = probes.spacious(rows, columns, serves)
    wide = prepare(step(), Options(cutters=cutter, holder_clearance=MARGIN, **HOW))
    assert (spacious == Probes(wide.samples, wide.cutters, wide.setups, wide.machinable).table(rows, columns)).all()
    assert serves.any()
    if not tool.stages:
        assert (spacious == serves).all()
    else:
        assert spacious.sum() < serves.sum()
