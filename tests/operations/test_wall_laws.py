"""Laws of passes along walls (`docs/operations_proof.md`, lemmas W1 to W3), on a wall of two triangles over a floor."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from cad_io.arrays import SurfaceSamples
from plan_cutters import Machine, PostureRange
from plan_cutters.domain.cutter import Cutter
from plan_cutters.operations.passes import Extents, Paths, flank_of
from plan_cutters.operations.probes import Probes
from plan_cutters.operations.walls import Walls
from plan_cutters.scene.conditions import Conditions
from plan_cutters.scene.fixed_axis import along, at_fixed_axis, held_at
from tests.support.serving import serves
from tests.support.sheets import around

TOLERANCE, SCALLOP, ACCURACY, WIDE = 0.01, 0.02, math.radians(0.5), 60.0
#: Two shanks as wide as the flutes, two thinner ones, and flutes that are no cylinder.
CUTTERS = [
    Cutter(6.0, 90.0, flutes=15.0), Cutter(6.0, 90.0, 1.0, flutes=15.0), Cutter(6.0, 90.0, 1.0, flutes=15.0, shank_radius=4.0),
    Cutter(6.0, 90.0, flutes=90.0), Cutter(3.0, 60.0, 0.5, taper=math.radians(3.0)), Cutter(6.0, 60.0, taper=math.radians(-4.0)),
]  # fmt: skip
ROWS = 21
#: What a wall that is off the flutes by the accuracy shifts a height by, mm, and rounding.
OFF = 2e-4


def wall(cutter, off, height, foot, seed):
    """The passes along a wall that is off the flutes by an angle, rad, at samples from its lower to its upper end.

    It begins at the foot over the floor, mm.
    """
    elevation = cutter.taper + off
    normal = np.array([math.cos(elevation), 0.0, math.sin(elevation)])
    up = np.array([-math.sin(elevation), 0.0, math.cos(elevation)])
    side = np.array([0.0, WIDE, 0.0])
    ends = foot * np.array([0.0, 0.0, 1.0]) + np.multiply.outer([0.0, height], up)
    corner = [ends[0] - side, ends[0] + side, ends[1] + side, ends[1] - side]
    flat = [np.array([x, y, 0.0]) for x, y in ((-WIDE, -WIDE), (WIDE, -WIDE), (WIDE, WIDE), (-WIDE, WIDE))]
    turn = Rotation.random(random_state=seed).as_matrix()
    vertex = np.array([[quad[i] for i in three] for quad in (corner, flat) for three in ((0, 1, 2), (0, 2, 3))]) @ turn.T
    above = np.linspace(0.0, height, ROWS)
    y = np.random.default_rng(seed).uniform(-5.0, 5.0, ROWS)
    point = (ends[0] + above[:, None] * up + y[:, None] * [0.0, 1.0, 0.0]) @ turn.T
    rows, face = np.arange(ROWS), np.ones(ROWS, np.int32)
    samples = SurfaceSamples(
        point, np.tile(turn @ normal, (ROWS, 1)), np.tile(turn[:, 1], (ROWS, 1)), np.zeros((ROWS, 2)), np.zeros((ROWS, 2)), face,
        np.ones(ROWS), np.zeros((0, 2), np.int32), np.full(ROWS, -1, np.int32), (), (), 1.0, (),
    )  # fmt: skip
    axis, surroundings = turn[:, 2], around(vertex, [1, 1, 2, 2])
    conditions = Conditions(Machine(), axis, PostureRange(), surroundings, TOLERANCE, 1, accuracy=ACCURACY)
    probes = Probes(samples, [cutter], [conditions], [np.ones(ROWS, bool)])
    paths = Paths(SCALLOP, 1.0, None, ACCURACY, Extents(samples, conditions.obstacles))
    passes = Walls(probes, paths).passes(0, 0, axis, rows)
    return SimpleNamespace(
        passes=passes, point=point, above=above, axis=axis, up=turn @ up, vertex=vertex, across=turn[:, 1], samples=samples,
        context=probes.contexts[0][0],
    )  # fmt: skip


def flutes_of(made, cutter, k):
    """The pass at a sample: its contact, and the directions out of the wall and up the flutes."""
    out = made.passes.normal[k]
    up = (made.axis - math.sin(cutter.taper) * out) / math.cos(cutter.taper)
    return made.passes.point[k], out, up


OFFS = st.floats(-1.0, 1.0).map(lambda share: share * ACCURACY) | st.just(0.0)
DRAWN = {
    "which": st.integers(0, len(CUTTERS) - 1), "off": OFFS, "height": st.floats(0.1, 70.0),
    "foot": st.sampled_from([0.0, 0.3, 5.0]), "seed": st.integers(0, 2**31),
}  # fmt: skip


@settings(max_examples=40, deadline=None)
@given(**DRAWN)
def test_a_sample_lies_behind_the_flutes_within_the_scallop_and_these_cut_no_deeper_than_the_tolerance(
    which, off, height, foot, seed
):
    cutter = CUTTERS[which]
    made, (begins, length) = wall(cutter, off, height, foot, seed), flank_of(cutter)
    strip = made.passes.strip
    for k in np.flatnonzero(np.isfinite(strip)).tolist():
        contact, out, up = flutes_of(made, cutter, k)
        away = made.point[k] - contact
        assert -2e-6 <= away @ up <= length + 2e-6
        assert -SCALLOP - 1e-9 <= away @ out <= 1e-9
        assert abs(away @ made.across) <= 1e-9
        assert strip[k] <= length + 2e-6
        assert strip[k] * math.sin(abs(off)) <= SCALLOP
        # What of the wall lies along the flutes is nowhere deeper in them than the tolerance: it is straight, so ends tell.
        low, high = made.above[k] - made.above[[0, -1]]
        for h in np.clip([away @ up - low, away @ up - high], 0.0, length):
            on_wall = made.point[k] + (h - away @ up) * made.up
            assert (on_wall - contact) @ out <= TOLERANCE + 1e-9
        # Neither is the floor in the tip.
        tip = contact @ made.axis - begins
        assert tip >= made.vertex[2:].reshape(-1, 3)[0] @ made.axis - TOLERANCE - 1e-9


@settings(max_examples=40, deadline=None)
@given(**DRAWN)
def test_passes_lie_one_on_the_other_up_to_the_end_of_the_wall_and_no_fewer_would_do(which, off, height, foot, seed):
    cutter = CUTTERS[which]
    made, (begins, length) = wall(cutter, off, height, foot, seed), flank_of(cutter)
    strip = made.passes.strip
    corner = begins / math.cos(cutter.taper)
    cut = np.flatnonzero(np.isfinite(strip))
    first = np.array([made.above[k] - (made.point[k] - flutes_of(made, cutter, k)[0]) @ made.up for k in cut])
    assert (first >= -OFF).all()
    assert (first <= made.above[cut] + OFF).all()
    assert (made.above[cut] <= first + strip[cut] + OFF).all()
    # They begin at the foot, or where the corner of a tool that stands on the floor ends; then all above that is cut.
    if not len(cut) or not np.isfinite(strip[made.above >= corner]).all() or np.ptp(strip[cut]) > OFF:
        return
    start, gap = float(first.min()), height / (ROWS - 1)
    assert start <= corner + gap + OFF
    most = min(length, SCALLOP / math.sin(abs(off))) if off else length
    passes = (height - start) / strip[cut[0]]
    assert abs(passes - round(passes)) <= 1e-3
    assert round(passes) <= max(1, math.ceil((height - start) / most + 1e-3))
    assert len(np.unique(np.round(first / (2.0 * OFF)))) <= 2 * round(passes)


def test_a_wall_in_the_open_is_cut_in_the_fewest_passes():
    """The laws above are about something: 42 mm take 3 passes of flutes of 15 mm, whichever way it leans a little."""
    for off in (-1e-4, 0.0, 1e-4):
        assert wall(CUTTERS[2], off, 42.0, 5.0, 1).passes.strip == pytest.approx(np.full(ROWS, 14.0))


@settings(max_examples=40, deadline=None)
@given(st.sampled_from([0, 2, 3]), OFFS, st.floats(0.1, 40.0), st.integers(0, 2**31))
def test_a_flank_that_keeps_the_tolerance_from_a_wall_cuts_it_within_the_tolerance_to_either_side(which, off, height, seed):
    """As a fixed axis serves a wall: what stays at the sample is the tolerance, and nothing of the wall is deeper than that."""
    cutter = CUTTERS[which]
    made, (begins, length) = wall(cutter, off, height, 5.0, seed), flank_of(cutter)
    served = serves(np.arange(ROWS), made.axis, made.samples, made.context)
    held = held_at(made.axis[None], np.where(served, 0, -1), made.samples, made.context)
    contact = at_fixed_axis(made.samples, held, TOLERANCE)
    for k in np.flatnonzero(along(held) & served).tolist():
        out, away = contact.normal[k], contact.point[k] - made.point[k]
        assert abs(out @ made.axis) <= 1e-12
        assert away @ out == pytest.approx(TOLERANCE)
        assert np.linalg.norm(away) == pytest.approx(TOLERANCE)
        for above in np.clip(made.above[[0, -1]] - made.above[k], -begins, length):
            assert (above * made.up - away) @ out <= TOLERANCE + 1e-9
