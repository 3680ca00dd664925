"""Convex bodies of fixtures are known by their planes, and what is proved to lie under one is what a search does not reach."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cad_io.arrays import Triangles
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.verdicts import INACCESSIBLE, blank
from plan_cutters.options import Options
from plan_cutters.pipeline import prepare
from plan_cutters.scene.conditions import Context, contacts_of, search_postures, under_fixtures
from plan_cutters.scene.obstacles import Obstacles
from tests.support.cad_parts import box

CORNERS = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
SIDES = np.array([[0, 1, 3], [0, 3, 2], [4, 7, 5], [4, 6, 7], [0, 5, 1], [0, 4, 5], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4],
                  [1, 5, 7], [1, 7, 3]])  # fmt: skip


def blocks(*sized):
    """Boxes by size and place, their corners in the sense of the outside."""
    return np.concatenate([(CORNERS * size + place)[SIDES] for size, place in sized])


def convex(vertex, weight=1):
    triangles = Triangles(vertex, np.full(len(vertex), -1, np.int32), 0.0, 0.0)
    return Obstacles(triangles, np.broadcast_to(np.int8(weight), len(vertex)).copy()).convex


@given(st.tuples(*[st.floats(0.5, 50.0)] * 3), st.tuples(*[st.floats(-500.0, 500.0)] * 3), st.tuples(*[st.floats(-0.5, 1.5)] * 3))
def test_a_point_is_in_a_box_where_no_plane_says_no(size, place, at):
    (planes,) = convex(blocks((size, place)))
    assert len(planes) == 6
    within = (planes[:, :3] @ (np.array(place) + np.array(at) * size) + planes[:, 3]).max()
    nearest = max(max(-a, a - 1.0) * s for a, s in zip(at, size, strict=True))
    if nearest <= 0.0:
        assert within == pytest.approx(nearest, abs=1e-9)
    else:
        assert within > -1e-9


def test_each_of_two_boxes_is_a_body():
    assert len(convex(blocks((1.0, 0.0), (2.0, 5.0)))) == 2


def test_an_angle_is_no_convex_body():
    corner = np.array([[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]], float)
    low, high = (np.column_stack([corner, np.full(6, z)]) for z in (0.0, 1.0))
    cap = [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)]
    vertex = [low[[a, c, b]] for a, b, c in cap] + [high[list(each)] for each in cap]
    for i in range(6):
        j = (i + 1) % 6
        vertex += [np.array([low[i], low[j], high[j]]), np.array([low[i], high[j], high[i]])]
    assert convex(np.array(vertex)) == ()


def test_what_is_hollow_or_encloses_nothing_proves_nothing():
    outer, inner = blocks((3.0, 0.0)), blocks((1.0, 1.0))[:, ::-1]
    assert convex(np.concatenate([outer, inner])) == ()
    assert convex(outer, 0) == ()
    assert len(convex(outer)) == 1


@pytest.fixture(scope="module")
def ready():
    """A block that stands out over a table, with a second block that hangs over it; none of its sides is free all round."""
    options = Options.of(
        {"cutters": ["D6L30", "D6L30rc3"], "faces": "all", "grid": 9, "machine": "tilt:120",
         "fixtures": ["box:60,60,8@-20,-20,-9", "box:20,40,6@5,0,14,12,0,0", "table:-12"]}
    )  # fmt: skip
    return prepare(box(20, 30, 10), options)


@pytest.mark.parametrize("number", [0, 1])
def test_a_search_reaches_none_of_them(ready, number):
    context = Context.of(ready.cutters[number], ready.conditions)
    contacts, rows = contacts_of(ready.samples), np.flatnonzero(ready.samples.unjudged < 0)
    under = under_fixtures(contacts, rows, context)
    assert 20 < under.sum() < len(rows) - 20
    verdicts = blank(len(ready.samples))
    search_postures(contacts, rows[under], context, verdicts)
    assert (verdicts.verdict[rows[under]] == INACCESSIBLE).all()


@settings(max_examples=20)
@given(st.floats(0.05, 1.0), st.floats(0.0, 1.0))
def test_a_larger_allowed_depth_proves_no_more(ready, low, more):
    """Of a coarser tolerance balls are larger."""
    fine, coarse = (
        under_fixtures(contacts_of(ready.samples), np.arange(len(ready.samples)), Context.of(Cutter.flat(radius=3, length=30),
                       replace(ready.conditions, tolerance=each)))
        for each in (0.01 * low, 0.01 * (low + more))
    )  # fmt: skip
    assert not (coarse & ~fine).any()
