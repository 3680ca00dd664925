"""Adapters: each answers the small suite, none sees the truth, and their meshes lie within the tool."""

import os

import numpy as np
import pytest

from conformance.made.part import FAR
from conformance.programs import program
from conformance.programs.meshes import fixture_meshes, frames, outlines, segments, turned
from conformance.programs.protocol import ANSWERS, BLOCKED, SAFE, Unavailable, below_table, beyond_limit, blind
from conformance.run import run
from conformance.score import Known, counts
from conformance.suite import Held, Suite, read
from conformance.tool import Tool

TOOL = Tool.ball(8.0, 60.0, flutes=20.0, shank=6.0, holder=((60.0, 12.0), (80.0, 15.0), (80.0, 20.0), (120.0, 20.0)))
TOOLS = [Tool.flat(16.0, 90.0), Tool.flat(6.0, 50.0, corner=1.0), TOOL]


def available(name: str):
    """Return a program, or skip where its library is not installed."""
    try:
        return program(name)
    except Unavailable as error:
        pytest.skip(str(error))


def test_a_program_sees_no_answers(small: Suite):
    shown = blind(small.postures)
    assert set(shown.verdict.tolist()) == set(shown.reason.tolist()) == {""}
    assert np.isnan(np.concatenate([shown.low, shown.high, shown.limit_deg])).all()
    np.testing.assert_array_equal(shown.tip, small.postures.tip)


@pytest.mark.parametrize("name", ["fcl", "embree", "trimesh", "naive", "opencamlib", "undecided", "plan-cutters", "plan-cutters-check"])
def test_an_adapter_answers_each_posture_and_mostly_right(small: Suite, name: str):
    made = available(name)
    some = small.some(6 if name == "plan-cutters" else 72)
    answers = np.full(len(some.postures), "", dtype="U9")
    for part, tool, setup, rows in some.groups():
        made.prepare(part)
        answers[rows] = made.answer(part, tool, part.setups[setup], blind(some.postures[rows]))
    assert np.isin(answers, ANSWERS).all()
    counted = counts(some.postures, answers)
    if name in ("opencamlib", "undecided"):
        assert counted["score"] == 0.0
    else:
        assert counted["score"] > 0.8
    if name in ("plan-cutters", "plan-cutters-check"):
        assert counted["false_safe"] == 0


@pytest.mark.parametrize("name", ["fcl", "embree", "trimesh", "naive"])
def test_boxes_and_limits_block(small: Suite, name: str):
    made = available(name)
    part = small.parts["v_groove"]
    tool = part.tools["ball_D8L60"]
    free = np.flatnonzero((small.postures.tool == tool.name) & Known.of(small.postures).free)
    table = blind(small.postures[free[small.postures.axis[free, 2] > 0.6]])
    made.prepare(part)
    tops = table.tip + 50.0 * table.axis
    low, high = tops.min(axis=0) - 1.0, tops.max(axis=0) + 1.0
    boxed = Held((0.0, 0.0, 1.0), None, ((tuple(low.tolist()), tuple(high.tolist())),), None)
    assert set(made.answer(part, tool, Held((0.0, 0.0, 1.0), None, (), None), table).tolist()) == {SAFE}
    assert set(made.answer(part, tool, boxed, table).tolist()) == {BLOCKED}
    assert set(made.answer(part, tool, Held((0.0, 0.0, 1.0), None, (), 12.0), table).tolist()) == {BLOCKED}
    assert set(made.answer(part, tool, Held((0.0, 0.0, -1.0), 60.0, (), None), table).tolist()) == {BLOCKED}


def test_drop_cutter_answers_along_the_axis(small: Suite):
    made = available("opencamlib")
    part = small.parts["v_groove"]
    tool = part.tools["ball_D8L60"]
    table = small.postures[np.flatnonzero(small.postures.tool == tool.name)[:3]]
    up, normal = np.tile([0.0, 0.0, 1.0], (3, 1)), table.normal
    tip = tool.stands(table.contact, normal, up) + np.array([[0, 0, 0.0], [0, 0, -0.5], [0, 0, 0.5]])
    asked = type(table)(*(up if n == "axis" else tip if n == "tip" else getattr(table, n) for n in table.__dataclass_fields__))
    made.prepare(part)
    assert made.answer(part, tool, Held((0.0, 0.0, 1.0), None, (), None), blind(asked)).tolist() == [SAFE, BLOCKED, SAFE]
    assert made.answer(part, tool, Held((1.0, 0.0, 0.0), None, (), None), blind(asked)).tolist() == ["undecided"] * 3


@pytest.mark.parametrize("tool", TOOLS, ids=lambda tool: tool.name)
@pytest.mark.parametrize("shrunk", [0.0, 0.01, 0.3])
def test_the_mesh_of_a_tool_lies_within_it_and_is_closed(tool: Tool, shrunk: float):
    sides = segments(tool, 0.005)
    zero, up = np.zeros(3), np.array([0.0, 0.0, 1.0])
    for line in outlines(tool, shrunk, 0.005):
        mesh = turned(line, sides)
        corners = mesh.vertices[mesh.faces]
        signed = tool.signed(corners.mean(axis=1), zero, up)
        assert signed.max() <= -shrunk + 1e-9
        assert tool.signed(mesh.vertices, zero, up).max() <= -shrunk + 1e-9
        edges = np.sort(np.vstack([mesh.faces[:, [0, 1]], mesh.faces[:, [1, 2]], mesh.faces[:, [2, 0]]]), axis=1)
        assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()
        # Six times the volume: positive where the triangles look outwards.
        assert np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() > 0


def test_fixtures_look_outwards_and_a_table_lies_below_its_height():
    held = Held((0.6, 0.0, 0.8), None, (((0.0, 0.0, 0.0), (1.0, 2.0, 3.0)),), -5.0)
    box, block = fixture_meshes(held)
    for mesh, volume in ((box, 6.0), (block, None)):
        corners = mesh.vertices[mesh.faces]
        six = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum()
        assert six > 0
        assert volume is None or abs(six / 6 - volume) < 1e-9
    assert abs((block.vertices @ np.array(held.axis)).max() + 5.0) < 1e-9


def test_table_and_limit_are_those_of_the_setup():
    axis, tip = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]), np.array([[0.0, 0.0, 2.0], [0.0, 0.0, 2.0]])
    flat = Tool.flat(6.0, 40.0)
    assert below_table(flat, Held((0.0, 0.0, 1.0), None, (), 1.0), axis, tip, 0.01).tolist() == [False, True]
    assert beyond_limit(Held((0.0, 0.0, 2.0), 89.0, (), None), axis).tolist() == [False, True]


def test_frames_are_rotations_to_the_axis():
    axis = np.random.default_rng(0).normal(size=(50, 3))
    axis /= np.linalg.norm(axis, axis=1)[:, None]
    turn = frames(axis)
    np.testing.assert_allclose(np.linalg.det(turn), 1.0, atol=1e-12)
    np.testing.assert_allclose(turn @ [0.0, 0.0, 1.0], axis, atol=1e-12)


@pytest.mark.parametrize("tool", [*TOOLS, Tool("taper", ((0.0, 3.0), (20.0, 5.0)), ((20.0, 12.0), (60.0, 20.0)))], ids=lambda tool: tool.name)
def test_a_cutter_of_the_product_is_the_tool(tool: Tool):
    pytest.importorskip("plan_cutters")
    from conformance.programs.plan_cutters import cutter_of

    cutter = cutter_of(tool)
    stages = [(part, height, stage.radius, stage.upper_radius, stage.length) for part, height, stage in cutter.stages]
    pieces = [piece for piece in tool.pieces if piece.part != "cutter"]
    assert [(height, r0, r1, length) for _, height, r0, r1, length in stages] == [(p.h0, p.r0, p.r1, p.h1 - p.h0) for p in pieces]
    assert cutter.radius == tool.flat_radius + tool.corner
    if tool.name == "taper":
        assert abs(np.tan(cutter.taper) * 20.0 - 2.0) < 1e-12
    assert cutter.corner_radius == tool.corner


def test_a_cutter_that_cannot_be_is_refused():
    pytest.importorskip("plan_cutters")
    from conformance.programs.plan_cutters import cutter_of

    with pytest.raises(ValueError, match="taper"):
        cutter_of(Tool("round taper", ((0.0, 2.0), (1.0, 3.0, 1.0), (20.0, 5.0))))


class Dies:
    """Ends its process on the second group."""

    name, libraries = "undecided", ()

    def __init__(self):
        self.settings, self.why, self.seen = {}, {}, 0

    def prepare(self, part):
        """Do nothing."""

    def answer(self, part, tool, setup, postures):
        """Return safe, but for the ball end, at which it dies."""
        if tool.name.startswith("ball"):
            os._exit(3)
        return np.full(len(postures), SAFE)


def dying(name: str) -> Dies:
    """Return the program that dies, whatever the name."""
    return Dies()


def test_a_program_that_dies_leaves_its_group_undecided_and_goes_on(small: Suite):
    ran = run("undecided", small, make=dying)
    by_tool = {str(tool): set(ran.answers[ran.postures.tool == tool].tolist()) for tool in np.unique(ran.postures.tool)}
    assert by_tool == {"ball_D8L60": {"undecided"}, "bull1_D6L50": {"safe"}, "flat_D16L90": {"safe"}}
    assert ran.why == {"its process ended with code 3": 24}


def test_claims_are_judged_by_form_and_by_bounds(small: Suite):
    from conformance.truth import truth

    part = small.parts["v_groove"]
    for _, tool, setup, rows in small.groups():
        mine = rows[np.abs(small.postures.low[rows]) > 0]
        low, high = truth("v_groove", tool, setup, small.postures[mine], part.path)
        np.testing.assert_allclose(low, small.postures.low[mine], atol=1e-9)
        np.testing.assert_allclose(high, low)
        break
    made = read("made")
    part, table = made.parts["cone_boss"], made.postures
    one = table[np.flatnonzero((table.part == part.name) & (table.low < -0.02) & (table.low > -0.5))[:1]]
    assert len(one) == 1
    tool = part.tools[str(one.tool[0])]
    low, high = truth("no form", tool, "free", one, part.path)
    assert low[0] - 1e-4 <= one.low[0] <= high[0] + 1e-4
    assert high[0] - low[0] < 5e-3
    away = type(one)(*(getattr(one, n) + 500.0 * one.axis if n in ("tip", "contact") else getattr(one, n) for n in one.__dataclass_fields__))
    assert truth("no form", tool, "free", away, part.path)[1][0] >= min(FAR, 100.0)
