"""Boxes, turns, drawn out tools and nested ones: nothing that reaches into a tool is passed over."""

import math

import numpy as np
import pytest

from plan_cutters import Cutter, CutterError
from plan_cutters.domain.assembly import assembly
from plan_cutters.domain.holder import Segment
from plan_cutters.domain.preference import inside
from plan_cutters.kernels.area import cover as moved_cutter
from plan_cutters.kernels.area import zone
from plan_cutters.kernels.codes import COLUMNS
from plan_cutters.kernels.rows import Frame
from plan_cutters.kernels.tool import apart, hit
from plan_cutters.kernels.tool import hit as extrusion
from plan_cutters.scene.conditions import tool_of
from tests.support import waves
from tests.support.tool_reference import KINDS, Reference, in_row, random_cutter

UP, ALONG, LEFT = np.eye(3)[2], np.eye(3)[0], np.eye(3)[1]
GRID = np.array([(i, j, 12 - i - j) for i in range(13) for j in range(13 - i)]) / 12.0


def stood(rng, made):
    """A body of a tool in a mode, at the origin of a frame: body, mode, tilt."""
    mode = rng.integers(len(made.mode))
    tilt = rng.uniform(*made.mode[mode, 2:4])
    body = np.empty(apart.BODY)
    hit.stand(body, Frame(np.zeros(3), UP, ALONG, LEFT), math.cos(tilt), math.sin(tilt), *made.mode[mode, :2])
    return body, mode, tilt


def seen(points, made, mode, tilt):
    """Heights over the mode's centre and distances from the axis of points (n, 3), touching the origin at a tilt."""
    offset, rise = made.mode[mode, :2]
    x, y, z = points[:, 0], points[:, 1], points[:, 2] - rise
    c, s = math.cos(tilt), math.sin(tilt)
    return np.hypot(offset + c * x - s * z, y), c * z + s * x


def near(rng, made, mode, tilt, size):
    """A place next to the surface of some piece."""
    row = made.piece[mode][rng.integers(made.piece.shape[1])]
    w, turn = rng.uniform(row[7], row[8]), rng.uniform(0, 2 * math.pi)
    wide = row[3] + row[4] * (w - row[1]) if row[0] != 2 else row[3] + math.sqrt(max(0.0, row[5] ** 2 - (w - row[4]) ** 2))
    q = max(0.0, wide) + size * rng.uniform(-1, 2)
    offset, rise = made.mode[mode, :2]
    x, y = q * math.cos(turn) - offset, q * math.sin(turn)
    c, s = math.cos(tilt), math.sin(tilt)
    return np.array([c * x + s * w, y, c * w - s * x + rise])


@pytest.mark.slow("another kind of the same law", but=("ball", "bull", "barrel", "taper bull", "form re-entrant"))
@pytest.mark.parametrize("long", [False, True])
@pytest.mark.parametrize("kind", KINDS)
def test_no_piece_is_dropped_into_which_a_point_of_a_box_reaches(kind, long):
    """Boxes next to the tool; `long`, those of which some point is next to it, and the centre far away."""
    rng = np.random.default_rng([KINDS.index(kind), long])
    kept, dropped = 0, 0
    for _ in range(600):
        made = assembly(random_cutter(rng, kind), 0.02, -0.01)
        body, mode, tilt = stood(rng, made)
        size = 10.0 ** rng.uniform(-2, 1)
        sides = np.linalg.qr(rng.standard_normal((3, 3)))[0].T
        half = size * 10.0 ** rng.uniform(-2, 0, 3)
        half[2] = half.min()
        box = np.zeros((1, 16))
        box[0, :3] = near(rng, made, mode, tilt, size)
        if long:
            side = rng.integers(2)
            half[:2] *= 0.1
            half[side] = 10.0 ** rng.uniform(0.0, 2.0)
            box[0, :3] += rng.uniform(-1.0, 1.0) * half[side] * sides[side]
        box[0, 3:12], box[0, 12:15], box[0, 15] = sides.ravel(), half, np.linalg.norm(half)
        shares = np.concatenate([rng.uniform(-1, 1, (300, 3)), np.sign(rng.standard_normal((60, 3)))])
        shares[-120:, rng.integers(3)] = rng.choice([-1, 1])
        if long:
            # The part that is next to the tool counts.
            at = -((box[0, :3] - body[:3]) @ sides[side]) / half[side]
            shares[:150, side] = np.clip(at + 20.0 / half[side] * rng.uniform(-1, 1, 150), -1, 1)
        points = box[0, :3] + (shares * half) @ sides
        rate = rng.choice([0.0, 10.0 ** rng.uniform(-3, -0.5)])
        mask = apart.alive(box, 0, body, made.piece[mode], (1 << made.piece.shape[1]) - 1, rate)
        # Turned within the rate, too.
        for turn in {0.0, -rate, 0.4 * rate, rate}:
            q, w = seen(points, made, mode, tilt + turn)
            for k, row in enumerate(made.piece[mode]):
                reaches = bool((in_row(row, q, w) > 1e-9).any())
                assert (mask >> k) & 1 or not reaches, (kind, k, rate)
        kept, dropped = kept + bin(mask).count("1"), dropped + made.piece.shape[1] - bin(mask).count("1")
    assert min(kept, dropped) > 100


@pytest.mark.slow("another kind of the same law", but=("bull", "lens", "taper ball", "form re-entrant"))
@pytest.mark.parametrize("kind", KINDS)
def test_a_miss_with_a_rate_is_a_miss_at_every_tilt_of_the_turn(kind):
    rng = np.random.default_rng(KINDS.index(kind))
    scratch, missed, hits = hit.scratch(), 0, 0
    for _ in range(300):
        made = assembly(random_cutter(rng, kind), 0.02, -0.01)
        body, mode, tilt = stood(rng, made)
        size, rate = 10.0 ** rng.uniform(-1.5, 1), 10.0 ** rng.uniform(-3, -0.7)
        corner = near(rng, made, mode, tilt, size) + size * rng.standard_normal((3, 3)) * 10.0 ** rng.uniform(-1.5, 0, 3)
        tree = waves.tree_of(corner[None])
        found = hit.tree_hit(tree, body, made.piece[mode], rate, -1, scratch)[0]
        missed, hits = missed + (found < 0), hits + (found >= 0)
        for turn in np.linspace(-rate, rate, 9):
            q, w = seen(GRID @ corner, made, mode, tilt + turn)
            if found < 0:
                assert max(in_row(row, q, w).max() for row in made.piece[mode]) <= 1e-9, kind
        # What is hit without a rate is hit with one.
        if hit.tree_hit(tree, body, made.piece[mode], 0.0, -1, scratch)[0] >= 0:
            assert found >= 0
    assert min(missed, hits) > 40


@pytest.mark.slow("another kind of the same law", but=("ball", "bull", "barrel", "taper bull", "form re-entrant"))
@pytest.mark.parametrize("kind", KINDS)
def test_a_tool_drawn_out_meets_every_triangle_that_reaches_into_it(kind):
    rng = np.random.default_rng(KINDS.index(kind))
    scratch, met, missed = hit.scratch(), 0, 0
    for _ in range(500):
        made = assembly(random_cutter(rng, kind), 0.02, -0.01)
        body, mode, tilt = stood(rng, made)
        half = rng.choice([0.0, 10.0 ** rng.uniform(-2, 1)])
        body[apart.HALF] = half
        size = 10.0 ** rng.uniform(-2, 1)
        corner = near(rng, made, mode, tilt, size) + size * rng.standard_normal((3, 3)) * 10.0 ** rng.uniform(-2, 0, 3)
        corner[:, 1] += rng.uniform(-1.2, 1.2) * half
        whole = (1 << made.piece.shape[1]) - 1
        mask = extrusion.extruded_hit(corner[None].copy(), 0, body, made.piece[mode], whole, scratch)
        points = GRID @ corner
        deepest = np.full(made.piece.shape[1], -np.inf)
        # The nearest copy of the tool: y is cut down by up to half.
        close = points.copy()
        close[:, 1] -= np.clip(points[:, 1], -half, half)
        q, w = seen(close, made, mode, tilt)
        for k, row in enumerate(made.piece[mode]):
            deepest[k] = in_row(row, q, w).max()
            assert (mask >> k) & 1 or deepest[k] <= 1e-9, (kind, k)
            # What it meets comes near: grid points lie within a twelfth of the longest side of every other.
            side = np.linalg.norm(corner - np.roll(corner, 1, axis=0), axis=1).max()
            if (mask >> k) & 1 and row[0] != 1:
                assert deepest[k] > -side / 12 - 1e-9
        met, missed = met + (mask != 0), missed + (mask == 0)
    assert min(met, missed) > 50


@pytest.mark.slow("another kind of the same law", but=("bull", "barrel"))
@pytest.mark.parametrize("kind", KINDS)
def test_what_a_tool_that_wanders_reaches_its_parts_reach(kind):
    """The whole, and the finest parts along the tilt direction, each drawn out across it."""
    rng = np.random.default_rng(KINDS.index(kind))
    reached, apart_from = 0, 0
    for _ in range(400):
        made = assembly(random_cutter(rng, kind), 0.02, -0.01)
        body, mode, tilt = stood(rng, made)
        body[apart.HALF] = 0.0
        count, h, size = made.piece.shape[1], 10.0 ** rng.uniform(-1, 0.7), 10.0 ** rng.uniform(-2, 0.5)
        bodies, pieces = np.empty((moved_cutter.BODIES, apart.BODY)), np.empty((moved_cutter.BODIES, count, COLUMNS))
        work = moved_cutter.Workspace(
            ALONG, LEFT, bodies, pieces, np.empty((count, COLUMNS)), np.empty(9), zone.seen(), hit.scratch()
        )
        frame = Frame(np.zeros(3), UP, ALONG, LEFT)
        moved_cutter.extruded(body, made.piece[mode], frame, h, (math.sin(tilt), math.cos(tilt)), (1.0, 0.0, 0.0, 1.0, 0.0), 0.0,
                              work, 18)  # fmt: skip
        turn = rng.uniform(0, 2 * math.pi)
        step = h * rng.choice([1.0, math.sqrt(rng.random())]) * (math.cos(turn) * ALONG + math.sin(turn) * LEFT)
        corner = near(rng, made, mode, tilt, size) + size * rng.standard_normal((3, 3))
        q, w = seen(GRID @ corner, made, mode, tilt)
        vertex = (corner + step)[None].copy()
        whole = extrusion.extruded_hit(vertex, 0, bodies[0], pieces[0], (1 << count) - 1, work.scratch)
        for k, row in enumerate(made.piece[mode]):
            parts = moved_cutter._reaches(vertex, 0, 1 << k, work)
            if in_row(row, q, w).max() > 1e-9:
                assert (whole >> k) & 1, (kind, k)
                assert parts, (kind, k)
                reached += 1
            apart_from += not parts
    assert min(reached, apart_from) > 50


def end_mill(rng, larger=None):
    """A straight end mill with stages at random; or one that may lie within a larger one."""
    if larger is None:
        r = rng.uniform(2, 6)
        rc = r * rng.choice([0.0, rng.uniform(0, 1), 1.0])
        flutes = r * rng.uniform(1.5, 4)
        length = flutes + rng.uniform(3, 10)
    else:
        rc = larger.corner_radius * rng.choice([1.0, rng.uniform(0, 1)])
        r = max(rc, larger.radius - (larger.corner_radius - rc) * rng.uniform(0.9, 3))
        taller = larger.corner_radius - rc
        flutes = (larger.flutes or larger.length) + rng.choice([0.0, -taller, -1.0, 0.3])
        length = larger.length + rng.choice([0.0, -taller, -2.0, 0.5])
    more = {}
    if rng.random() < 0.5:
        more["neck"] = Segment(0.9 * r, 2.0)
    if rng.random() < 0.6:
        more["shank_radius"] = r * rng.choice([0.8, 1.0, 1.2])
    if rng.random() < 0.6:
        more["holder"] = rng.choice(["R9L12", "R9:12L8+R12L5", "R8L20"])
    if rng.random() < 0.3:
        more["clearance"] = float(rng.choice([0.5, 1.0]))
    try:
        return Cutter(float(r), float(length), float(rc), flutes=float(flutes), **more)
    except CutterError:
        return None


@pytest.mark.slow("draws many cases")
def test_what_is_called_inside_lies_inside():
    """At the same contact and axis each point of the one, and of what its stages keep clear, is one of the other."""
    rng = np.random.default_rng(0)
    within, apart, rounded = 0, 0, 0
    for _ in range(1600):
        larger = end_mill(rng)
        smaller = end_mill(rng, larger) if larger else None
        if not smaller:
            continue
        if not inside(smaller, larger):
            apart += 1
            continue
        within += 1
        rounded += smaller.corner_radius > 0 and smaller != larger
        mine, theirs = Reference(smaller), Reference(larger)
        clear = -(smaller.clearance or 0.0), -(larger.clearance or 0.0)
        for tilt in [0.0, math.pi / 2, *rng.uniform(0, math.pi / 2, 4)]:
            tip, frame = mine.frame(np.zeros(3), UP, ALONG, tilt, 0.7)
            points = rng.uniform([-14, -14, -1], [14, 14, mine.end + 1], (1500, 3))
            q, w = np.hypot(points[:, 0], points[:, 1]), points[:, 2]
            depth = mine.over(q, w, 0.0, clear[0])
            far, other = theirs.frame(np.zeros(3), UP, ALONG, tilt, 0.7)
            there = (tip + points @ frame - far) @ other.T
            p, h = np.hypot(there[:, 0], there[:, 1]), there[:, 2]
            assert (theirs.over(p, h, 0.0, clear[1])[depth > 1e-7] > -1e-9).all(), (smaller, larger, tilt)
            # What cuts may lie in what does not; what does not cut lies in what does not.
            stage = mine.above.depth(q, w) > 1e-7 if mine.above else np.zeros(len(q), bool)
            if stage.any():
                assert (theirs.above.depth(p, h)[stage] > -1e-9).all(), (smaller, larger, tilt)
    assert within > 40
    assert apart > 40
    assert rounded > 8


def test_inside_at_every_end_of_its_conditions():
    def mill(r, l, rc=0.0, **more):
        return Cutter(r, l, rc, **more)

    assert inside(mill(4, 48, 4.0), mill(6, 60, 6.0))
    assert inside(mill(4, 48, 1.0), mill(5, 60, 2.0))
    # A corner that is larger, a disk that is, the top that would stand out, a holder where the other has flutes.
    assert not inside(mill(4, 48, 2.0), mill(5, 60, 1.0))
    assert not inside(mill(5, 48, 1.0), mill(5.5, 60, 2.0))
    assert not inside(mill(4, 59, 4.0), mill(6, 60, 6.0))
    assert not inside(mill(4, 30, holder="R5L5"), mill(6, 80))
    assert inside(mill(4, 30, holder="R5L5"), mill(6, 30, holder="R8L9"))
    assert not inside(mill(4, 30, holder="R5L5", clearance=1.0), mill(6, 30, holder="R8L9", clearance=0.5))
    assert not inside(Cutter.ball(radius=4, length=40, allowance=0.2), Cutter.ball(radius=4, length=40))


def test_tools_are_what_kernels_take():
    made = assembly(Cutter.parse("R6L80rc1F20N5.5x40S6"), 0.01, -0.002)
    tool = tool_of(made)
    assert tool.piece is made.piece
    assert tool.mode.shape == (1, 5)
    assert made.only(0).piece.shape[1] == 2
    assert made.flutes == 3
