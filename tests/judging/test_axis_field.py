"""Fields of tool axes: what they are between nodes, and random contacts of what is proved, against the exact surface."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cad_io import read_part
from plan_cutters import Cutter
from plan_cutters.judging.axes import AxisField, angle_between
from plan_cutters.kernels.area.cover import swung
from plan_cutters.kernels.codes import COLUMNS
from plan_cutters.kernels.tool.pieces import inset
from plan_cutters.scene.conditions import tools
from tests.support import shapes
from tests.support.contacts import dense
from tests.support.places import SAMPLES
from tests.support.tool_kinds import TOOLS
from tests.support.tool_profile import deepest_of
from tests.support.turning import along, turned_contacts

EVERY = {**TOOLS, "flat": Cutter.flat(radius=2, length=40)}
#: A lens is served where samples are very near.
KINDS = [kind for kind in EVERY if kind != "lens"]


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def grid(u, v, *, closed=False):
    span = (u[0], u[0] + (u[-1] - u[0]) * len(u) / (len(u) - 1), v[0], v[-1])
    return SimpleNamespace(u=u, v=v, closed_u=closed, closed_v=False, span=span)


def wavy(tilt, waves, scale):
    """Axes that lean by a tilt, rad, and sway by so much over so many mm."""

    def axes(point, normal, found):
        lean, turn = tilt + waves * np.sin(point[:, 0] / scale), 2.0 * waves * np.cos(point[:, 1] / scale)
        return np.column_stack([np.sin(lean) * np.cos(turn), np.sin(lean) * np.sin(turn), np.cos(lean)])

    return axes


@given(seed=st.integers(0, 10_000), closed=st.booleans())
def test_no_axis_in_a_rectangle_is_farther_from_its_middle_than_is_said(seed, closed):
    rng = np.random.default_rng(seed)
    u, v = np.sort(rng.uniform(0, 6, 5)), np.sort(rng.uniform(0, 4, 4))
    field = AxisField.of(grid(u, v, closed=closed), unit(rng.standard_normal((5, 4, 3)) * 0.4 + [0, 0, 1]))
    middle, span = rng.uniform([-1, -1], [7, 5], (20, 2)), rng.uniform(0.0, 0.4, (20, 2))
    centre, swing = field.within(middle, span)
    for k in np.flatnonzero(np.isfinite(swing)):
        there = field.at(middle[k] + rng.uniform(-0.5, 0.5, (200, 2)) * span[k])
        assert angle_between(there, np.broadcast_to(centre[k], there.shape)).max() <= swing[k]


def test_a_field_goes_through_its_nodes_and_does_not_jump():
    rng = np.random.default_rng(0)
    u, v = np.array([0.0, 1.0, 2.5, 3.0]), np.array([0.0, 2.0, 3.0])
    nodes = unit(rng.standard_normal((4, 3, 3)) * 0.15 + [0, 0, 1])
    field = AxisField.of(grid(u, v), nodes)
    every = np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1).reshape(-1, 2)
    assert np.allclose(field.at(every), nodes.reshape(-1, 3), atol=1e-12)
    line = np.column_stack([np.linspace(-1, 4, 5001), np.full(5001, 1.7)])
    assert angle_between(field.at(line)[1:], field.at(line)[:-1]).max() < 0.01


def test_there_is_no_axis_beside_a_node_without_one_or_between_axes_far_apart():
    u = v = np.array([0.0, 1.0, 2.0])
    nodes = np.tile([0.0, 0.0, 1.0], (3, 3, 1))
    nodes[2, 2] = np.nan
    field = AxisField.of(grid(u, v), nodes)
    assert np.isnan(field.at(np.array([[1.5, 1.5]]))).all()
    assert np.isfinite(field.at(np.array([[0.5, 0.5], [1.0, 1.5]]))).all()
    assert np.isnan(field.within(np.array([[1.0, 1.0]]), np.array([[0.5, 0.5]]))[1]).all()
    nodes[2, 2] = [1.0, 0.0, 0.0]
    assert np.isnan(AxisField.of(grid(u, v), nodes).at(np.array([[1.5, 1.5]]))).all()


@pytest.mark.parametrize("kind", EVERY)
def test_pieces_hold_the_tool_however_its_axis_turns(kind):
    """Random points of the tool, put down with a turned axis on the same contact, lie in the pieces of lemma B16."""
    rng, outer = np.random.default_rng(3), tools(EVERY[kind], 0.01, 0.002)[0]
    for mode, (offset, _, low, high, _) in enumerate(outer.mode):
        piece = outer.piece[mode]
        for _ in range(30):
            tilt, swing = rng.uniform(low, min(high, 1.4)), rng.uniform(0.0, 0.1)
            if offset != 0.0 and math.sin(tilt) <= 2.5 * swing:
                continue
            # The centre of curvature is the origin, the normal is z, and the tool leans towards x.
            axis = np.array([math.sin(tilt), 0.0, math.cos(tilt)])
            turned = unit(axis + rng.standard_normal(3) * swing)
            angle = float(angle_between(axis, turned))
            if angle > swing or np.linalg.norm(turned[:2]) < 1e-6:
                continue
            out = np.empty((len(piece), COLUMNS))
            swung(piece, out, swing, swing / (math.sin(tilt) - swing) if offset else 0.0, float(offset))
            for k in range(len(piece)):
                w, x, y = (rng.uniform(-1, 1, 500) * each for each in (60.0, 15.0, 15.0))
                inside = np.array([inset(piece, k, a, b * b + c * c) >= 0.0 for a, b, c in zip(w, x, y, strict=True)])
                for a, b, c in np.column_stack([w, x, y])[inside]:
                    side = unit(np.cross([0.0, 0.0, 1.0], turned))
                    point = stand(turned, offset) + a * turned + b * side + c * np.cross(turned, side)
                    away = point - stand(axis, offset)
                    height = float(away @ axis)
                    assert inset(out, k, height, float(away @ away) - height**2) >= -1e-9


def stand(axis, offset):
    """Where the axis of a tool passes whose centre of curvature is the origin, on a surface with the normal z."""
    across = np.array([0.0, 0.0, 1.0]) - axis[2] * axis
    return offset * across / np.linalg.norm(across)


@pytest.mark.slow("judges many samples")
def test_a_field_that_does_not_turn_is_a_fixed_axis():
    """The same cells are served as with the axis kept, for a ball, whose other rules do not count."""
    cutter = Cutter.ball(radius=4, length=60)
    found, *_ = along(SAMPLES / "peaks_and_valleys.step", cutter, wavy(0.4, 0.0, 1.0), budget=2500, grid=51)
    waves, *_ = along(SAMPLES / "peaks_and_valleys.step", cutter, wavy(0.4, 0.2, 15.0), budget=2500, grid=51)
    assert 0.1 < waves.share < found.share < 1.0
    assert np.ptp(found.cells.axis, axis=0).max() < 1e-9
    assert np.ptp(waves.cells.axis, axis=0).max() > 0.2


@pytest.mark.slow("draws many surfaces", but=("holder",))
@pytest.mark.parametrize("kind", KINDS)
def test_no_contact_of_a_piece_gouges_a_random_surface(kind):
    rng = np.random.default_rng(2)
    part = read_part(shapes.shell(shapes.Patch.random(rng, height=3.0).face()))
    found, geometry, whole, fields = along(part, EVERY[kind], wavy(0.35, 0.25, 7.0), budget=2500, grid=51)
    print(kind, found.share, len(found.cells.face))
    assert len(found.cells.face) > 50, "nothing to look at"
    contacts = turned_contacts(found, geometry, whole, fields, dense(whole, 0.5), 120, rng)
    assert deepest_of(EVERY[kind], contacts) < 0.01 + 2e-3


@pytest.mark.slow("searches for counterexamples, of which there are many")
def test_a_turn_that_is_not_allowed_for_gouges(monkeypatch):
    """The search for counterexamples finds some, if the axes of a cell are said not to turn in it."""
    within = AxisField.within
    monkeypatch.setattr(AxisField, "within", lambda *asked: (within(*asked)[0], np.full(len(asked[1]), 1e-9)))
    rng, cutter = np.random.default_rng(2), EVERY["holder"]
    part = read_part(shapes.shell(shapes.Patch.random(rng, height=3.0).face()))
    found, geometry, whole, fields = along(part, cutter, wavy(0.35, 1.0, 2.0), budget=2500, grid=31)
    contacts = turned_contacts(found, geometry, whole, fields, dense(whole, 0.5), 400, rng)
    assert deepest_of(cutter, contacts) > 0.05


@pytest.mark.slow("judges thousands of contacts on a sample part")
@pytest.mark.parametrize("kind", KINDS)
def test_no_contact_of_a_piece_gouges_a_sample_part(kind):
    def found_axes(point, normal, axis):
        return axis

    found, geometry, whole, fields = along(SAMPLES / "blade.step", EVERY[kind], found_axes, budget=40_000, spacing=1.5)
    rng = np.random.default_rng(1)
    worst = deepest_of(EVERY[kind], turned_contacts(found, geometry, whole, fields, dense(whole, 0.4), 1500, rng))
    print(kind, found.share, len(found.cells.face), f"deepest {worst:.4f} mm")
    assert worst < 0.01 + 2e-3
