"""Pieces of tools against outlines with exact distances: never optimistic, and no point further out than what is stated."""

import math

import numpy as np
import pytest

from plan_cutters import Cutter, CutterError
from plan_cutters.domain import pieces as domain
from plan_cutters.domain.assembly import assembly
from plan_cutters.kernels.jit import kernel
from plan_cutters.kernels.rows import Frame
from plan_cutters.kernels.tool import apart, hit
from plan_cutters.scene.conditions import tool_of
from tests.support.reference import random_frame
from tests.support.tool_reference import KINDS, Reference, end_of, in_row, random_cutter

#: mm to which exact pieces agree.
EXACT = 1e-9
#: Shares of the corners of points in which a triangle is looked at first.
GRID = np.array([(i, j, 7 - i - j) for i in range(8) for j in range(8 - i)]) / 7.0


@kernel
def _hits(vertex, bodies, piece, mask, scratch, which, met):
    for i in range(len(vertex)):
        which[i], met[i, 0], met[i, 1], met[i, 2] = hit.triangle_hit(vertex, i, bodies[i], piece, mask, 0.0, scratch)


def stood(rng, tool, reference, n):
    """n postures of a tool in one mode: bodies (n, 14), tips (n, 3) and frames (n, 3, 3), and the mode."""
    mode = rng.integers(len(tool.mode))
    low, high = tool.mode[mode, 2:4]
    bodies, tips, frames = np.empty((n, apart.BODY)), np.empty((n, 3)), np.empty((n, 3, 3))
    # A few postures serve many triangles.
    for i in range(0, n, 50):
        normal, direction = random_frame(rng)
        tilt = float(rng.choice([rng.uniform(low, high), low, high], p=[0.8, 0.1, 0.1]))
        contact, some = rng.normal(0, 5, 3), slice(i, i + 50)
        body, left = np.empty(apart.BODY), np.cross(normal, direction)
        # At an end of the range another mode touches the same place.
        hit.stand(body, Frame(contact, normal, direction, left), math.cos(tilt), math.sin(tilt), *tool.mode[mode, :2])
        body[apart.P : apart.P + 3] = contact + tool.mode[mode, 1] * normal
        bodies[some] = body
        tips[some], frames[some] = reference.frame(contact, normal, direction, tilt, 0.5 * (low + high))
    return bodies, tips, frames, mode


def triangles(rng, reference, over, n):
    """Triangles (n, 3, 3) as seen from the tip, x_T, y_T, axis: of all sizes, needles, points, across the axis, in seam planes;
    most with a point next to where points begin to count.
    """
    wide, high = reference.wide, reference.end
    place = rng.uniform([-1.3 * wide, -1.3 * wide, -0.15 * high], [1.3 * wide, 1.3 * wide, 1.15 * high], (n, 3))
    # Go along a line from a point inside to one outside until what counts ends.
    inner = np.stack([np.zeros(n), np.zeros(n), rng.uniform(0.02, 0.98, n) * high], 1)
    inner[:, :2] += 0.3 * rng.normal(0, 1, (n, 2))
    a, b = np.zeros(n), np.ones(n)
    for _ in range(50):
        middle = 0.5 * (a + b)
        p = inner + middle[:, None] * (place - inner)
        counts = over(np.hypot(p[:, 0], p[:, 1]), p[:, 2]) > 0
        a, b = np.where(counts, middle, a), np.where(counts, b, middle)
    off = 10.0 ** rng.uniform(-10, -1, n) * rng.choice([-1, 1], n)
    share = np.where(rng.random(n) < 0.8, a + off, rng.random(n))
    place = inner + share[:, None] * (place - inner)
    size = 10.0 ** rng.uniform(-3, 1.7, n)
    sides = size[:, None, None] * rng.standard_normal((n, 2, 3))
    shape = rng.integers(0, 6, n)
    sides[shape == 1, 1] = sides[shape == 1, 0] * (1 + 1e-9)
    sides[shape == 2] = 0.0
    # Tangent: across the way in.
    way = place - inner
    way /= np.linalg.norm(way, axis=1)[:, None]
    flat = shape == 3
    sides[flat] -= np.einsum("nij,nj->ni", sides[flat], way[flat])[..., None] * way[flat][:, None, :]
    seam = shape == 4
    sides[seam, :, 2] = 0.0
    planes = np.array([0.0, reference.top, reference.end, *(e[2] for e in reference.whole.elements if e[0] == "line")])
    place[seam, 2] = rng.choice(planes, int(seam.sum()))
    corner = np.stack([place, place + sides[:, 0], place + sides[:, 1]], 1)
    # Some corner, side or inner point is where the place was.
    inside = shape == 5
    corner[inside] -= (0.3 * sides[inside, 0] + 0.3 * sides[inside, 1])[:, None]
    return np.ascontiguousarray(corner)


def deepest(corner, over):
    """The largest of what points of triangles count by, or less than 0: over a grid, then about the best of it ever closer.

    What a point counts by changes by no more than it is moved, and each point of a triangle lies within a seventh of its longest
    side of one of the grid.
    """
    longest = np.linalg.norm(corner - np.roll(corner, 1, axis=1), axis=2).max(1)
    best, shares, open_ = np.full(len(corner), -np.inf), np.broadcast_to(GRID, (len(corner), *GRID.shape)), np.arange(len(corner))
    for turn in range(5):
        points = np.einsum("nkc,ncd->nkd", shares, corner[open_])
        value = over(np.hypot(points[..., 0], points[..., 1]), points[..., 2])
        at = value.argmax(1)
        best[open_] = np.maximum(best[open_], value[np.arange(len(open_)), at])
        if turn < 4:
            centre = shares[np.arange(len(open_)), at]
            if turn == 0:
                some = best + longest / 7 >= 0.0
                open_, centre = open_[some], centre[some]
            shares = centre[:, None] + (GRID - 1 / 3) * 0.3 ** (turn + 1)
            shares = np.clip(shares, 0, 1)
            shares = shares / shares.sum(2, keepdims=True)
    return best


def check(rng, kind, sort, cutters, n):
    """Random cutters of a kind, their pieces against the reference; how many triangles hit and missed."""
    scratch, hits, misses = hit.scratch(), 0, 0
    for _ in range(cutters):
        error, asked = float(10.0 ** rng.uniform(-3, -1.5)), rng.random() < 0.7
        # As a plan asks for them; and as deep everywhere, as witnesses do.
        flutes, rest = (4 * error, -error if sort == "outer" else error) if asked else (0.2, 0.2)
        cutter = random_cutter(rng, kind, loose=asked)
        reference = Reference(cutter)
        made = assembly(cutter, flutes, rest, kind=sort)
        inset, above = flutes - (cutter.allowance or 0.0), rest - (cutter.clearance or 0.0)
        if not made.piece.shape[1]:
            continue

        def over(q, w, reference=reference, inset=inset, above=above):
            return reference.over(q, w, inset, above)

        tool = tool_of(made)
        bodies, tips, frames, mode = stood(rng, tool, reference, n)
        local = triangles(rng, reference, over, n)
        vertex = np.ascontiguousarray(np.einsum("ncd,nde->nce", local, frames) + tips[:, None])
        which, met = np.empty(n, np.int64), np.empty((n, 3))
        piece = tool.piece[mode]
        _hits(vertex, bodies, piece, (1 << len(piece)) - 1, scratch, which, met)
        slack = EXACT + 1e-12 * np.abs(vertex).max()
        if sort == "outer":
            beside = local[which < 0]
            missed = deepest(beside, over) > slack
            assert not missed.any(), (cutter, flutes, rest, beside[missed][0])
        some = which >= 0
        w = met[some, 0] + made.mode[mode, 4]
        q = np.hypot(met[some, 1], met[some, 2])
        out = over(q, w) < -made.slack - slack
        assert not out.any(), (cutter, flutes, rest, q[out][0], w[out][0], over(q, w)[out].min())
        # The point it names is one of the triangle.
        named = np.stack([met[some, 1], met[some, 2], w], 1)
        assert off_triangle(local[some], named).max(initial=0.0) < 1e-7 * (1 + np.abs(local[some]).max(initial=0.0))
        hits, misses = hits + int(some.sum()), misses + int((~some).sum())
    return hits, misses


def off_triangle(corner, point):
    """How far points are from triangles at most: from their planes and beyond their sides."""
    a, b = corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]
    to = point - corner[:, 0]
    aa, ab, bb = ((x * y).sum(1) for x, y in ((a, a), (a, b), (b, b)))
    at, bt = (to * a).sum(1), (to * b).sum(1)
    area = aa * bb - ab * ab
    thin = area <= 1e-5 * (aa + bb) ** 2
    with np.errstate(all="ignore"):
        u, v = (bb * at - ab * bt) / area, (aa * bt - ab * at) / area
    u, v = np.where(thin, 0.0, u), np.where(thin, 0.0, v)
    plane = np.linalg.norm(to - u[:, None] * a - v[:, None] * b, axis=1)
    beyond = np.maximum(0.0, np.maximum.reduce([-u, -v, u + v - 1])) * np.sqrt(aa + bb)
    return np.where(thin, 0.0, plane + beyond)


@pytest.mark.parametrize(
    ("cutter", "corner"),
    [
        (Cutter.form([(0, 0), (3, 0), (3, 20), (6, 20), (6, 40)], length=40.0), (3.0, 20.0)),
        (Cutter.form([(0, 0), (6, 0), (6, 20), (3, 20), (3, 40)], length=40.0), (3.0, 20.0)),
        (Cutter.flat(radius=3, length=40, flutes=20, shank_radius=6), (3.0, 20.0)),
        (Cutter.bull(radius=6, corner_radius=2, length=40, flutes=20, shank_radius=3), (3.0, 20.0)),
        (Cutter.flat(radius=3, length=20, holder="R9L10+R14L10"), (9.0, 30.0)),
        (Cutter.lollipop(radius=4, neck_radius=2, length=40), (2.0, 4 + math.sqrt(12))),
    ],
    ids=["neck under shank", "wide under narrow", "shank", "thin shank", "holder", "lollipop"],
)
def test_nothing_hides_in_a_re_entrant_corner(cutter, corner):
    """What lies over the corner is deeper than either side, moved in by as much, says: moved in alone, both would miss it."""
    depth, reference = 0.2, Reference(cutter)
    turn = np.linspace(0, 2 * math.pi, 2000)[:, None]
    away = depth * np.linspace(1 + 1e-9, 1.5, 60)
    q, w = (corner[0] + away * np.cos(turn)).ravel(), (corner[1] + away * np.sin(turn)).ravel()
    deep = reference.whole.depth(q, w) > depth
    rows = assembly(cutter, depth, depth).piece[0].copy()
    height = assembly(cutter, depth, depth).mode[0, 4]
    rows[:, [domain.LOW, domain.HIGH]] += height
    rows[rows[:, domain.KIND] == domain.ARC, domain.SLOPE] += height
    held = np.max([in_row(row, q, w) for row in rows], axis=0) > 0
    assert held[deep].all()
    # The trap is there: pieces moved in one by one leave some of these points out.
    apart = assembly(cutter, depth, depth, kind="inner")
    rows = apart.piece[0].copy()
    rows[:, [domain.LOW, domain.HIGH]] += height
    rows[rows[:, domain.KIND] == domain.ARC, domain.SLOPE] += height
    assert not (np.max([in_row(row, q, w) for row in rows], axis=0) > 0)[deep].all()


@pytest.mark.slow("draws many cases", but=("ball", "bull", "barrel", "form re-entrant"))
@pytest.mark.parametrize("sort", ["outer", "inner"])
@pytest.mark.parametrize("kind", KINDS)
def test_pieces_hold_what_counts_and_no_more(kind, sort):
    rng = np.random.default_rng([KINDS.index(kind), sort == "outer"])
    hits, misses = check(rng, kind, sort, 12, 400)
    assert min(hits, misses) > 400


def about_corners(rng, cutter, flutes, rest, n=2000):
    """Points about corners of a cutter's outlines, as far off as its pieces are moved: by how much each is held, by how much each
    counts, and what the pieces may hold too much, mm; None where there are no pieces.
    """
    reference, made = Reference(cutter), assembly(cutter, flutes, rest)
    if not made.piece.shape[1]:
        return None
    inset, above = flutes - (cutter.allowance or 0.0), rest - (cutter.clearance or 0.0)
    outlines = [each for each in (reference.flutes, reference.whole, reference.above) if each is not None]
    corners = np.array([end_of(element) for outline in outlines for element in outline.elements])
    corner = corners[rng.integers(len(corners), size=n)]
    away, turn = rng.choice(np.abs([inset, above]), n) * rng.uniform(0, 2, n), rng.uniform(0, 2 * math.pi, n)
    q, w = np.abs(corner[:, 0] + away * np.cos(turn)), corner[:, 1] + away * np.sin(turn)
    rows, height = made.piece[0].copy(), made.mode[0, 4]
    rows[:, [domain.LOW, domain.HIGH]] += height
    rows[rows[:, domain.KIND] == domain.ARC, domain.SLOPE] += height
    return np.max([in_row(row, q, w) for row in rows], axis=0), reference.over(q, w, inset, above), made.slack


def depths(rng):
    error = float(10.0 ** rng.uniform(-3, -1.5))
    return (4 * error, -error) if rng.random() < 0.7 else (0.2, 0.2)


@pytest.mark.parametrize("kind", KINDS)
def test_about_corners_nothing_is_missed_and_no_more_is_held_than_is_stated(kind):
    rng = np.random.default_rng([KINDS.index(kind), 3])
    for _ in range(40):
        flutes, rest = depths(rng)
        cutter = random_cutter(rng, kind, loose=flutes != rest)
        if (found := about_corners(rng, cutter, flutes, rest)) is not None:
            held, over, slack = found
            assert not ((held < -EXACT) & (over > 10 * EXACT)).any(), cutter
            assert over[held > 0.0].min(initial=0.0) > -slack - 10 * EXACT, (cutter, flutes, rest)


def random_form(rng, convex):
    """A form with sides of all lengths that lean in and out, pointed tips, flats, steps; at times with stock or a clearance."""
    while True:
        n = rng.integers(2, 7)
        if convex:
            lean = np.sort(rng.uniform(-1.4, 1.4, n))[::-1]
            length = rng.choice([0.05, 0.5, 2.0], n) * rng.uniform(0.5, 1.5, n)
            out, up = length * np.sin(lean), length * np.cos(lean)
        else:
            out, up = (rng.choice([0.0, 0.05, 0.5, 2.0], n) * rng.uniform(least, 1.5, n) for least in (-1.2, 0.5))
        q = rng.choice([0.0, 1.0, 2.0]) + np.concatenate([[0.0], np.cumsum(out)])
        points = [(0.0, 0.0), *zip(q.tolist(), [0.0, *np.cumsum(up).tolist()], strict=True)]
        points = [point for i, point in enumerate(points) if i == 0 or point != points[i - 1]]
        more = {"shank_radius": float(rng.uniform(0.3, 1.3) * points[-1][0])} if rng.random() < 0.5 else {}
        if rng.random() < 0.3:
            more |= (
                {"allowance": 0.3}
                if convex
                else {"allowance": float(rng.choice([0.02, 0.3])), "clearance": rng.choice([0.0, 1.5])}
            )
        if q.min() >= 0.0 and points[-1][1] > 0.0 and points[-1][0] > 0.05:
            try:
                return Cutter.form(points, length=points[-1][1] + float(rng.uniform(2, 20)), **more)
            except CutterError:
                continue


@pytest.mark.parametrize("convex", [True, False], ids=["convex", "re-entrant"])
def test_about_corners_of_any_form_nothing_is_missed(convex):
    """Between sides of any leans and lengths, below a shank on a side that leans in or on a thin flange, at a pointed tip."""
    rng = np.random.default_rng(convex)
    for _ in range(100 if convex else 400):
        flutes, rest = depths(rng)
        cutter = random_form(rng, convex)
        if (found := about_corners(rng, cutter, flutes, rest)) is not None:
            held, over, slack = found
            assert not ((held < -EXACT) & (over > 10 * EXACT)).any(), (cutter, flutes, rest)
            if convex:
                assert over[held > 0.0].min(initial=0.0) > -slack - 10 * EXACT, (cutter, flutes, rest)


@pytest.mark.parametrize("kind", ["flat", "taper flat", "form"])
def test_the_clearance_of_a_shank_is_kept_below_a_flange_that_is_thinner(kind):
    """A point under a thin flange, or beside a taper hardly wider than shank and clearance, may be too near to the shank."""
    rng, more = np.random.default_rng(1), {"length": 30.0, "shank_radius": 4.0, "clearance": 1.02, "allowance": 0.05}
    for more_flutes in np.linspace(0.0, 0.1, 11).tolist():  # whatever the seam's height is rounded to
        cutter = {
            "flat": Cutter.flat(radius=5, flutes=0.4 + more_flutes, **more),
            "taper flat": Cutter.flat(radius=3, flutes=10 + more_flutes, taper=math.atan(0.2), **more),
            "form": Cutter.form([(0, 0), (3, 0), (3, 4), (5, 4), (5, 4.3 + more_flutes)], **more),
        }[kind]
        held, over, _ = about_corners(rng, cutter, 0.02, -0.005, 20_000)
        assert (over > 10 * EXACT).any()
        assert not ((held < -EXACT) & (over > 10 * EXACT)).any()


def test_a_dovetail_under_a_shank_of_its_own_width_misses_nothing_in_the_corner():
    """What lies a hair deeper than the depth from the corner, towards the axis, whatever the side leans by."""
    depth, grown = 0.02, 0.001
    for lean in (5, 15, 30, 45, 60):
        cutter = Cutter.flat(radius=20, length=40, taper=-math.radians(lean), flutes=8)
        reference, made = Reference(cutter), assembly(cutter, depth, -grown)
        turn = np.radians(np.linspace(0, lean, 200))
        q, w = reference.top_radius - depth * 1.001 * np.cos(turn), reference.top - depth * 1.001 * np.sin(turn)
        assert (reference.over(q, w, depth, -grown) > 0.0).all()
        rows = made.piece[0].copy()
        rows[:, [domain.LOW, domain.HIGH]] += made.mode[0, 4]
        assert (np.max([in_row(row, q, w) for row in rows], axis=0) > 0.0).all(), lean


@pytest.mark.parametrize("lean", [0, 10])
@pytest.mark.parametrize("grown", [0.001, 0.005, 0.02, 0.1])
def test_what_a_narrow_shank_holds_in_the_flutes_is_no_farther_off_than_is_stated(grown, lean):
    """Beside the shank, as far as it is grown, where what lies in the flutes is as far from deep enough as from the shank."""
    depth = 0.02
    cutter = Cutter.flat(radius=6, length=40, flutes=20, shank_radius=4, taper=math.radians(lean))
    reference, made = Reference(cutter), assembly(cutter, depth, -grown)
    below = np.linspace(0.0, depth, 500)
    over = reference.over(np.full(500, 4.0 + grown), 20.0 - below, depth, -grown).min()
    assert over == pytest.approx(-(depth**2) / (2.0 * (depth + grown)), abs=1e-4)
    assert over > -made.slack - 10 * EXACT


@pytest.mark.parametrize("points", [
    [(0, 0), (2, 0), (0.3, 0), (0.3, 2)], [(0, 0), (1, 0), (1, 2), (3, 2), (2, 2), (2, 5)],
    [(0, 0), (1, 0), (1, 2), (0.5, 2), (1, 2), (1, 3)], [(0, 0), (1, 0), (1, 2), (3, 2)],
])  # fmt: skip
def test_a_disk_without_thickness_is_no_cutter(points):
    with pytest.raises(CutterError, match="a disk without thickness"):
        Cutter.form(points, length=20)


@pytest.mark.parametrize(("flutes", "length"), [(11.77, 46.96), (9.62, 30.77), (6.26, 27.26)])
def test_round_edges_do_not_hang_on_rounding(flutes, length):
    """A nose that narrows upwards, with a clearance, wherever its height rounds: its pieces hold what is near enough, no more."""
    cutter = Cutter.flat(radius=4.5, length=length, shank_radius=2.3, flutes=flutes, holder="R10:8L6+R16L9", clearance=0.5)
    held, over, _ = about_corners(np.random.default_rng(0), cutter, 0.01, -0.002, 20_000)
    assert over[held > 0.0].min() > -0.03


@pytest.mark.slow("tests a million triangles of each kind of tool")
@pytest.mark.parametrize("kind", KINDS)
def test_a_million_triangles_of_each_kind(kind):
    rng = np.random.default_rng([KINDS.index(kind), 7])
    hits, misses = check(rng, kind, "outer", 500, 2000)
    assert hits + misses > 900_000
    check(rng, kind, "inner", 100, 2000)


def test_a_triangle_without_area_hits_where_its_longest_side_does():
    """Its normal is nothing but rounding: no plane across it may part it from a piece."""
    from plan_cutters.domain.pieces import row_of
    from plan_cutters.kernels.codes import ARC, FLUTES
    from plan_cutters.kernels.tool.pieces import polygon_hit

    rng, met = np.random.default_rng(0), 0
    for radius, around in ((0.0, 3.0), (2.0, 1.5), (12.0, 1.5), (-20.0, 26.0)):
        piece = np.array([row_of(ARC, -math.inf, math.inf, radius, 0.5, around, FLUTES)])
        for _ in range(400):
            through = rng.normal(0.0, 0.5 * (abs(radius) + around), 3)
            along = rng.standard_normal(3) * 40.0
            corner = np.stack([through - 0.3 * along, through + 0.7 * along, through + 0.7 * along * (1 + 1e-9)])
            points = corner[0] + np.linspace(0.0, 1.0, 20_001)[:, None] * (corner[1] - corner[0])
            q = np.hypot(points[:, 1], points[:, 2])
            deep = (around - np.hypot(np.maximum(0.0, q - radius), points[:, 0] - 0.5)).max()
            if abs(deep) > 1e-3:
                assert polygon_hit(corner.copy(), 3, piece, 0, 0.0)[0] == (deep > 0.0)
                met += deep > 0.0
    assert met > 200
