"""The bound over all axes: coverings of the sphere that are known, and free axes, which lie in no cell that is called blocked."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plan_cutters import Cutter, plan
from plan_cutters.domain.columns import columns_of
from plan_cutters.domain.operations import Fewest
from plan_cutters.operations.over_all_axes import Cells, OpenCells, apart, bodies, over_all_axes
from plan_cutters.operations.probes import Probes
from plan_cutters.options import Options
from plan_cutters.pipeline import prepare
from plan_cutters.scene.conditions import Context
from plan_cutters.scene.fixed_axis import served_by
from tests.support.cad_parts import ball
from tests.support.places import SAMPLES
from tests.support.shapes import ridge, trough

BALL = "R1L60rc1"


@pytest.mark.slow("searches long", only=("63",))
@pytest.mark.parametrize(
    ("tilt", "caps"),
    [
        (63.44, 5),
        (37.38, 12),
        *(pytest.param(*each, marks=pytest.mark.slow("searches long")) for each in ((70.53, 4), (54.74, 6), (51.03, 7))),
    ],
)
def test_it_never_passes_the_least_number_of_caps_that_cover_a_sphere(tilt, caps):
    """Samples all over a ball, every one of them with a weight; the answer is said to be far above."""
    ready = prepare(ball(), Options(cutters=[BALL], grid=9, faces="all", tilt=(0.0, math.radians(tilt))))
    probes = Probes(ready.samples, ready.cutters, ready.setups, [ready.finished])
    rows, many = np.flatnonzero(ready.finished), columns_of(np.zeros((40, 3)), np.zeros((40, 2)))
    found = Fewest(many, np.arange(40), rows, np.ones(len(rows), np.int64), 1, 0.0, 0.0, 0.0, rows[:0], len(rows))
    least, cells = over_all_axes(probes, found, rows)
    # A cap is this share of the sphere.
    assert 0.8 * 2.0 / (1.0 - math.cos(math.radians(tilt))) <= least <= caps
    assert cells > 0.0


@given(st.integers(0, 2**31), st.floats(5.0, 89.0))
@settings(max_examples=60, deadline=None)
def test_no_two_samples_that_are_said_to_be_apart_share_an_axis(seed, tilt):
    rng = np.random.default_rng(seed)
    normal = rng.normal(size=(40, 3))
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    some = normal[apart(normal, math.radians(tilt))]
    for i in range(len(some)):
        for j in range(i):
            # The axis that comes nearest to both is their mean.
            mean = some[i] + some[j]
            assert some[i] @ mean < math.cos(math.radians(tilt)) * np.linalg.norm(mean)


# Cells


def test_cells_are_all_directions_and_their_radius_is_that_of_the_farthest():
    cells, rng = Cells.whole(1), np.random.default_rng(0)
    axis = rng.normal(size=(4000, 3))
    axis /= np.linalg.norm(axis, axis=1)[:, None]
    a, b, c = (cells.corner[:, k] for k in range(3))
    sign = np.sign(np.einsum("ij,ij->i", np.cross(a, b), c))
    sides = np.stack([np.cross(a, b) @ axis.T, np.cross(b, c) @ axis.T, np.cross(c, a) @ axis.T]) * sign[:, None]
    inside = (sides >= -1e-12).all(axis=0)
    assert inside.any(axis=0).all()
    angle = np.arccos(np.clip(cells.middle @ axis.T, -1.0, 1.0))
    assert (angle <= cells.radius[:, None])[inside].all()
    small = cells.parted()
    assert len(small) == 4 * len(cells)
    assert (np.repeat(np.arccos(np.clip((cells.middle * small.middle[::4]).sum(axis=1), -1, 1)), 1) < cells.radius).all()


def inside_of(cells, axis):
    """The cell (k,) that holds each of some axes (k, 3)."""
    a, b, c = (cells.corner[:, k] for k in range(3))
    sign = np.sign(np.einsum("ij,ij->i", np.cross(a, b), c))
    sides = np.stack([np.cross(a, b) @ axis.T, np.cross(b, c) @ axis.T, np.cross(c, a) @ axis.T]) * sign[:, None]
    return sides.min(axis=0).argmax(axis=0)


PARTS = {"groove": lambda: SAMPLES / "v_groove.step", "trough": lambda: trough(12.0, 20.0),
         "peaks": lambda: SAMPLES / "peaks_and_valleys.step", "pocket": lambda: SAMPLES / "pocket_top.step"}  # fmt: skip


@pytest.mark.slow("searches long", only=("peaks", "pocket", "trough"))
@pytest.mark.parametrize(
    ("part", "cutter", "holder", "most"),
    [("groove", "R6L40", "R15L40", 90.0), ("trough", "R4L30rc1", None, 90.0), ("peaks", "R6L40rc6", "R15L40+R25L60", 80.0),
     ("pocket", "R3L20rc1F10S3", "R15L40", 90.0),
     ("peaks", Cutter.lollipop(radius=5.0, neck_radius=3.0, length=40.0), None, 120.0)],
)  # fmt: skip
def test_axes_that_are_free_lie_in_no_cell_that_is_called_blocked(part, cutter, holder, most):
    """The certified test of 400 random axes at 60 samples, against cells of four sizes."""
    more = {} if holder is None else {"holder": holder}
    ready = prepare(PARTS[part](), Options(cutters=[cutter], grid=15, faces="all", tilt=(0.0, math.radians(most)), **more))
    probes = Probes(ready.samples, ready.cutters, ready.setups, [ready.finished])
    rng = np.random.default_rng(1)
    rows = np.sort(rng.choice(np.flatnonzero(ready.finished), 60, replace=False))
    axis = rng.normal(size=(400, 3))
    axis /= np.linalg.norm(axis, axis=1)[:, None]
    # The samples' own normals, too: there an end that stands beside its axis turns about.
    axis = np.concatenate([axis, ready.samples.normal[rows[::6]]])
    free, _ = served_by(rows, axis, ready.samples, Context.of(ready.cutters[0], ready.setups[0]))
    assert free.any()
    cells, at, blocked = Cells.whole(1), OpenCells(probes, rows), []
    open_ = at.table(cells)
    for level in range(4):
        mine = inside_of(cells, axis)
        wrong = free & ~open_[mine, 0]
        assert not wrong.any()
        blocked.append(1.0 - open_.mean())
        if level < 3:
            some = np.unique(mine)
            cells, open_ = cells.of(some).parted(), np.repeat(open_[some], 4, axis=0)
            open_ = at.table(cells, open_)
    assert blocked[-1] > 0.0


@pytest.mark.parametrize("most", [20.0, 60.0])
def test_no_cell_is_open_that_the_machine_cannot_tilt_to(most):
    """Over a ball every direction is somewhere free: what is left is within the limit, but for the size of a cell."""
    ready = prepare(ball(), Options(cutters=[BALL], grid=7, faces="all", machine=f"tilt:{most:g}"))
    probes = Probes(ready.samples, ready.cutters, ready.setups, [ready.finished])
    cells = Cells.whole(3)
    open_ = OpenCells(probes, np.flatnonzero(ready.finished)).table(cells)[:, 0].any(axis=1)
    tilt = np.degrees(np.arccos(np.clip(cells.middle[:, 2], -1.0, 1.0)))
    wide = math.degrees(cells.radius.max())
    assert tilt[open_].max() <= most + wide + 1e-6
    assert open_[tilt <= most].all()


def test_more_than_the_tilts_is_called_blocked():
    """A holder over a groove: cells find obstacles, and not tilts alone."""
    ready = prepare(SAMPLES / "v_groove.step", Options(cutters=["R6L40rc6"], holder="R25L60", grid=9))
    probes = Probes(ready.samples, ready.cutters, ready.setups, [ready.finished])
    rows = np.flatnonzero(ready.finished)[::3]
    cells = Cells.whole(3)
    told = []
    open_ = OpenCells(probes, rows, lambda done, total: told.append(done / total)).table(cells)[:, 0]
    assert len(set(told)) > 10
    assert told == sorted(told)
    assert told[-1] <= 1.0
    tilt = np.arccos(np.clip(cells.middle @ ready.samples.normal[rows].T, -1.0, 1.0))
    low = tilt < math.pi / 2.0 - cells.radius.max()
    assert 0.02 < (~open_ & low).sum() / low.sum() < 0.98


def test_a_tool_that_turns_too_far_has_no_body_left():
    ready = prepare(ridge(10.0, 10.0), Options(cutters=["R6L40"], grid=5))
    context = Context.of(ready.cutters[0], ready.setups[0])
    few, many = (sum(each.piece.shape[1] for each in bodies(context, 0, turn)) for turn in (1.5, 0.02))
    assert few == 0 < many


def test_it_costs_nothing_where_one_orientation_does():
    ready = prepare(ridge(10.0, 10.0), Options(cutters=[BALL], grid=5, operations="fewest"))
    probes = Probes(ready.samples, ready.cutters, ready.setups, [ready.finished])
    found = plan(ridge(10.0, 10.0), cutters=BALL, grid=5, operations="fewest", area_budget=0).answers.operations.fewest
    assert len(found.chosen) == 1
    assert over_all_axes(probes, found, found.rows)[0] == 1
    assert probes.made == 0
