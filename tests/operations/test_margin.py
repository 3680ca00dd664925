"""Neck, shank and holder keep 1 mm from everything where any posture does, and a step that has less says so."""

import cadquery as cq
import numpy as np
import pytest

from plan_cutters import plan
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.operations import columns_of
from plan_cutters.judging.judge import judge
from plan_cutters.operations.probes import Probes, roomy, with_margin
from plan_cutters.options import Options
from plan_cutters.pipeline import prepare
from plan_cutters.plan_file.operations import MARGIN
from tests.support.cad_parts import box

HOW = {"faces": "all", "area_budget": 0, "feed": 1000.0, "machine": "trunnion-ac", "grid": 9, "operations": "fastest"}
#: The holder comes down to the top of a block of 40 mm, at its foot.
TIGHT = "D12L40HR20L30"


def step():
    """A low ledge beside a tower: upright, the holder passes the tower 0.3 mm away; the ledge may be cut with a lean, too."""
    return cq.Workplane().box(60, 40, 10).union(cq.Workplane().box(20, 40, 60).translate((-20, 0, 35))).val()


def test_a_tool_with_room_is_the_same_tool_and_asks_for_no_less():
    for own, wanted in ((None, MARGIN), (0.2, MARGIN), (3.0, 3.0)):
        wide = roomy(Cutter.flat(radius=6, length=40, clearance=own))
        assert (wide.clearance, wide.radius, wide.length) == (wanted, 6.0, 40.0)


def test_where_a_posture_has_room_no_step_goes_without():
    """All of a block lower than the tool is long, less the room, is cut with room; of one as high nothing at its foot can be."""
    low, high = (plan(box(30, 30, tall), cutters=TIGHT, **HOW) for tall in (38.0, 39.9))
    clear = [min(s.clearance_mm for s in each.plan.process.steps if s.clearance_mm is not None) for each in (low, high)]
    assert clear[0] >= MARGIN
    assert 0.0 < clear[1] < MARGIN
    assert high.plan.process.finished_share == low.plan.process.finished_share
    lines = " ".join(high.plan.text.lines)
    assert "where no orientation of the plan has 1 mm" in lines
    assert "where no orientation of the plan has 1 mm" not in " ".join(low.plan.text.lines)


@pytest.mark.parametrize("cutter", ["D8L30HR15L30", "D8L30"])
def test_what_serves_with_room_serves_without(cutter):
    """Where the same tool with a clearance of its own reaches a sample, there is room; a bare tool has it anywhere."""
    ready = prepare(step(), Options(cutters=cutter, **HOW))
    (tool,) = ready.cutters
    everywhere, open_ = [{tool: judge(ready, tool)}], ready.machinable
    rows = np.flatnonzero(everywhere[0][tool].reached & open_[0])
    room = with_margin(ready.samples, rows, everywhere, ready.setups, open_)
    assert room[rows].any()
    assert (room[rows] == judge(ready, roomy(tool)).reached[rows]).all()
    probes = [Probes(ready.samples, ready.cutters, ready.setups, open_, margin=each) for each in (room, None)]
    columns = columns_of(np.array([[0.0, 0.0, 1.0], [np.sin(0.3), 0.0, np.cos(0.3)]]), np.zeros((2, 2)))
    with_, without = (each.table(rows, columns) for each in probes)
    assert not (with_ & ~without).any()
    assert (probes[0].tight(rows, columns) == without).all()
    if not tool.stages:
        assert (with_ == without).all()
