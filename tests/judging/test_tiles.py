"""Tiles of a face's grid: all of its parameters once, each about its own grid line, and each with a number of its own."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from OCP.BRepPrimAPI import BRepPrimAPI_MakeCylinder

from cad_io import read_part
from plan_cutters import Options
from plan_cutters.domain.verdicts import FIXTURE
from plan_cutters.judging.between import _key
from plan_cutters.judging.cells import _halved, _rectangles, _tiles, laid
from plan_cutters.judging.judge import judge
from plan_cutters.judging.phases import access
from plan_cutters.pipeline import prepare
from plan_cutters.scene.conditions import Context
from tests.support.cad_parts import box, ring

LINE = np.array([1.0, 2.0, 4.0, 5.0])


@pytest.mark.parametrize(
    ("span", "trim", "closed", "ends", "node"),
    [
        ((0.5, 5.5), (0.5, 5.5), False, [0.5, 1.5, 3.0, 4.5, 5.5], [0, 1, 2, 3]),
        # The trim ends within the range, and beyond it: there are tiles without a line.
        ((0.5, 5.5), (0.8, 5.2), False, [0.5, 1.5, 3.0, 4.5, 5.5], [0, 1, 2, 3]),
        ((0.5, 5.5), (0.1, 5.5), False, [0.1, 0.5, 1.5, 3.0, 4.5, 5.5], [-1, 0, 1, 2, 3]),
        ((0.5, 5.5), (0.5, 6.5), False, [0.5, 1.5, 3.0, 4.5, 5.5, 6.5], [0, 1, 2, 3, -1]),
        ((0.5, 5.5), (0.1, 6.5), False, [0.1, 0.5, 1.5, 3.0, 4.5, 5.5, 6.5], [-1, 0, 1, 2, 3, -1]),
        # Rounding is no tile.
        ((0.5, 5.5), (0.5 - 1e-9, 5.5 + 1e-9), False, [0.5, 1.5, 3.0, 4.5, 5.5], [0, 1, 2, 3]),
        # Lines beyond their range are in a tile all the same.
        ((1.2, 4.8), (1.2, 4.8), False, [1.0, 1.5, 3.0, 4.5, 5.0], [0, 1, 2, 3]),
        # At a seam the first line has a tile on either side.
        ((1.0, 6.0), (1.0, 6.0), True, [1.0, 1.5, 3.0, 4.5, 5.5, 6.0], [0, 1, 2, 3, 0]),
    ],
)
def test_tiles_go_half_way_to_the_next_line_and_as_far_as_the_trim(span, trim, closed, ends, node):
    made, of = _tiles(LINE, closed, span, trim)
    assert made == pytest.approx(np.array(ends), abs=1e-8)
    assert of.tolist() == node
    assert made[0] <= trim[0]
    assert made[-1] >= trim[1]


@given(st.lists(st.floats(0.1, 3.0), min_size=1, max_size=6))
def test_a_halved_line_has_the_middles_and_rectangles_are_the_tiles(steps):
    line = np.cumsum([0.0, *steps])
    half = _halved(line)
    assert half[::2] == pytest.approx(line)
    assert half[1::2] == pytest.approx(0.5 * (line[1:] + line[:-1]))
    tile = np.argwhere(np.ones((len(line) - 1, len(half) - 1), bool))
    middle, span = _rectangles((line, half), tile)
    assert middle - 0.5 * span == pytest.approx(np.column_stack([line[tile[:, 0]], half[tile[:, 1]]]))
    assert middle + 0.5 * span == pytest.approx(np.column_stack([line[tile[:, 0] + 1], half[tile[:, 1] + 1]]))


@pytest.mark.parametrize("shape", [(1, 2100), (2100, 1), (3, 4)])
def test_each_tile_of_each_level_has_a_number_of_its_own(shape):
    tiles = np.array(shape) << 10
    keys = [
        _key(np.full(tile.shape[0], level), tile, tiles)
        for level in range(2)
        for tile in [np.argwhere(np.ones(tuple(np.array(shape) << level), bool))]
    ]
    every = np.concatenate(keys)
    assert len(np.unique(every)) == len(every)


@pytest.fixture(scope="module", params=[lambda: BRepPrimAPI_MakeCylinder(30.0, 2.0).Shape(), ring], ids=["rod", "ring"])
def ready(request):
    return prepare(read_part(request.param()), Options.of({"cutters": "R3L40", "faces": "all", "grid": 5, "area_budget": 0}))


def test_the_cells_of_a_face_are_all_of_it_in_both_parameters(ready):
    """A low wide rod, around its axis from 0 to 2 pi, and 2 mm along it; and a ring, which is closed both ways."""
    context = Context.of(ready.cutters[0], ready.conditions)
    verdicts = judge(ready, ready.cutters[0])
    part = ready.scene.part
    for grid in ready.samples.grids:
        field, mine, bare = laid(part, ready.scene.orientation, ready.samples, grid, verdicts, context.conditions)
        for k, line in enumerate(field.lines[0]):
            assert (np.diff(line) > 0.0).all()
            low, high = grid.span[2 * k : 2 * k + 2]
            first, last = part.trim(grid.face).box[2 * k : 2 * k + 2]
            nodes = (grid.u, grid.v)[k]
            assert line[0] == pytest.approx(min(low, first, nodes[0]))
            assert line[-1] == pytest.approx(max(high, last, nodes[-1]))
        if part.faces[grid.face - 1].shape in ("cylinder", "torus"):
            # All of it is about some sample.
            assert (field.index >= 0).all()
            assert not len(bare.area)
        assert mine.area.sum() + bare.area.sum() == pytest.approx(part.faces[grid.face - 1].area)


def test_without_bodies_to_lie_in_samples_among_fixtures_are_judged_as_if_they_lay_in_none():
    options = {"cutters": "R3L40", "faces": "all", "grid": 3, "area_budget": 0, "fixtures": "box:30,80,60@31,-20,5"}
    ready = prepare(box(30, 20, 10), Options.of(options))
    context, n = Context.of(ready.cutters[0], ready.conditions), len(ready.samples)
    free = np.zeros(n, bool)
    none = access(ready.samples, free, context, inside=None)
    nowhere = access(ready.samples, free, context, inside=np.full(n, -1, np.int32))
    assert np.array_equal(none.verdict, nowhere.verdict)
    assert np.array_equal(none.reason, nowhere.reason)
    assert (none.reason == FIXTURE).any()
