"""Posture maps of tools of every kind: against exact probes and against ranges halved one by one."""

import numpy as np
import pytest

from plan_cutters import Cutter
from plan_cutters.domain.assembly import assembly
from plan_cutters.kernels.linear import tree as lanes
from plan_cutters.kernels.maps import cuts, planes
from plan_cutters.kernels.maps import planes as bounds
from plan_cutters.kernels.search.search import probe
from plan_cutters.scene.conditions import tool_of
from tests.support import slow_map, waves

NARROWEST, ROOM, DEPTH = np.radians(0.1), 8, 0.04
HOLDER = "R8L4+R8:12L6+R12L10+R11:13L6+R13L8+R20L30"
TOOLS = {
    "flat": Cutter.flat(radius=4, length=40),
    "flat with stages": Cutter.flat(radius=4, length=36, flutes=12.0, shank_radius=4.0, holder=HOLDER),
    "bull": Cutter.parse("R4L40rc1"),
    "bull with stages": Cutter.bull(radius=4, corner_radius=1, length=36, flutes=12.0, shank_radius=5.0, holder=HOLDER),
    "ball": Cutter.parse("R4L40rc4"),
    "tapered ball": Cutter.parse("R2L40rc2T5"),
    "tapered flat": Cutter.parse("R3L40T8"),
    "lollipop": Cutter.lollipop(radius=3, neck_radius=1.5, length=40),
    "barrel": Cutter.barrel(radius=4, flank_radius=60, height=10, length=20),
    "barrel with tip": Cutter.barrel(radius=4, flank_radius=60, tip_radius=1, length=30),
    "lens": Cutter.lens(radius=4, bottom_radius=9, corner_radius=0.5, length=40),
}  # fmt: skip
KINDS = tuple(TOOLS)


@pytest.fixture(scope="module")
def scene():
    """Waves as obstacles, contacts on them, and which postures there are."""
    tree = waves.tree_of(waves.triangles(41))
    return waves.samples(6), tree, waves.ranges(2 * np.pi * np.arange(12) / 12)


def room(contacts):
    n = len(contacts.point)
    return np.zeros((n, 12, ROOM, 2)), np.zeros((n, 12), np.int32), np.zeros((n, 12))


def width(part, count):
    return np.where(np.arange(ROOM) < count[..., None], part[..., 1] - part[..., 0], 0).sum(-1)


def mapped(scene, tool):
    contacts, tree, ranges = scene
    return waves.mapped(np.arange(len(contacts.point)), contacts, ranges, tool, tree, ROOM)


def assert_free(kind, scene):
    """That no tilt of a free interval is hit; how wide the intervals are at each rotation, rad."""
    contacts, tree, ranges = scene
    made = assembly(TOOLS[kind], DEPTH, DEPTH)
    part, count, _ = mapped(scene, tool_of(made))
    place, turn, which = np.nonzero(np.arange(ROOM) < count[..., None])
    assert len(place) > 20
    rng = np.random.default_rng(len(kind))
    low, high = part[place, turn, which].T
    share = np.concatenate([np.zeros(len(low)), np.ones(len(low)), rng.random(8 * len(low))])
    place, turn = np.tile(place, 10), np.tile(turn, 10)
    tilt = np.tile(low, 10) + share * np.tile(high - low, 10)
    n, e1 = contacts.normal[place], contacts.direction_max[place]
    cosine, sine = ranges.rotation_cos[turn, None], ranges.rotation_sin[turn, None]
    tilt_direction = cosine * e1 + sine * np.cross(n, e1)
    axis = np.cos(tilt)[:, None] * n + np.sin(tilt)[:, None] * tilt_direction
    # A hair shallower than what the map was made with: the ends are exact.
    tool = tool_of(assembly(TOOLS[kind], DEPTH + 1e-8, DEPTH + 1e-8))
    hit, piece = np.zeros(len(tilt), np.int32), np.zeros(len(tilt), np.int32)
    probe(np.arange(len(tilt)), contacts.point[place], n, axis, tilt_direction, tool, tree, hit, piece)
    assert (hit == -1).all()
    return width(part, count)


@pytest.mark.parametrize("kind", KINDS)
def test_no_tilt_of_a_free_interval_is_hit(kind, scene):
    assert_free(kind, scene)


@pytest.mark.parametrize("kind", ["flat with stages", "bull with stages"])
def test_what_is_farther_away_than_the_flutes_reach_is_in_the_way_of_the_holder(kind):
    """A wall alone, more than 18 mm from every contact."""
    a, b, c, d = np.array([(52.0, -20, 20), (52, 60, 20), (52, 60, 90), (52, -20, 90)])
    wall, contacts, turns = np.array([[a, b, c], [a, c, d]]), waves.samples(4), waves.ranges(2 * np.pi * np.arange(12) / 12)
    free = assert_free(kind, (contacts, waves.tree_of(wall), turns))
    away = contacts, waves.tree_of(wall + np.array([500.0, 0.0, 0.0])), turns
    assert (free < assert_free(kind, away) - 0.1).mean() > 0.1


@pytest.mark.slow("draws many cases", only=("flat", "bull"))
@pytest.mark.parametrize("kind", KINDS)
def test_ranges_halved_one_by_one_leave_the_same(kind, scene):
    contacts, tree, ranges = scene
    tool = tool_of(assembly(TOOLS[kind], DEPTH, DEPTH))
    part, count, unsure = mapped(scene, tool)
    rows = np.arange(0, len(contacts.point), 5)
    found, few, doubt = room(contacts)
    found, few, doubt = found[: len(rows)], few[: len(rows)], doubt[: len(rows)]
    slow_map.tool_map(rows, contacts, ranges, tool, NARROWEST, tree, found, few, doubt)
    mine, other = width(part, count)[rows], width(found, few)
    # What one calls free the other calls free or undecided.
    assert (mine <= other + doubt + 1e-6).all()
    assert (other <= mine + unsure[rows] + 1e-6).all()
    assert other.sum() > 1.0


@pytest.mark.parametrize("kind", KINDS)
def test_little_stays_undecided(kind, scene):
    part, count, unsure = mapped(scene, tool_of(assembly(TOOLS[kind], DEPTH, DEPTH)))
    ends = 2.0 * count[count > 0].sum()
    # A tenth of a degree an end, but where grazing planes show nothing: a lens's bottom most of all.
    assert unsure.sum() < (16.0 if kind == "lens" else 7.0) * NARROWEST * ends
    assert (width(part, count) + unsure <= np.pi + 1e-6).all()


def test_a_flat_end_through_the_planes_is_the_same(scene):
    """Its eight sides are a short cut: without them the same tilts are free, up to what is undecided."""
    tool = tool_of(assembly(TOOLS["flat"], DEPTH, DEPTH))
    part, count, unsure = mapped(scene, tool)
    # They want tilts up to 90 deg: a little more is requested.
    plain = tool._replace(mode=np.array([[*tool.mode[0, :3], np.pi / 2 + 1e-6, tool.mode[0, 4]]]))
    wide, few, doubt = mapped((*scene[:2], scene[2]._replace(tilt_high=np.pi / 2 + 1e-6)), plain)
    _, _, eight = bounds.turning_of(tool.piece[0], tool.mode[0, 0], 0.0, np.pi / 2)
    _, _, none = bounds.turning_of(tool.piece[0], tool.mode[0, 0], 0.0, np.pi / 2 + 1e-6)
    assert (eight, none) == (1, 0)
    mine, other = width(part, count), width(wide, few)
    # What triangles cut off at both ends is known to be forbidden only to the width of ends.
    assert (mine <= other + doubt + 2e-6).all()
    assert (other <= mine + unsure + 3.0 * NARROWEST).all()


def deepest(points, ends, offset, row):
    """How far inside a piece points (k, 3), along f, t and n from the centre, come at most at 61 tilts, mm."""
    tilt = np.linspace(*ends, 61)[:, None]
    c, s = np.cos(tilt), np.sin(tilt)
    x, y, z = points.T
    height, q = s * x + c * z, np.hypot(offset + c * x - s * z, y)
    if row[0] == 2.0:
        deep = row[5] - np.hypot(np.maximum(0.0, q - row[3]), height - row[4])
    else:
        deep = (row[3] + row[4] * (height - row[1]) - q) * row[6]
    return np.minimum(deep, np.minimum(height - row[1], row[2] - height)).max()


@pytest.mark.parametrize("kind", KINDS)
def test_what_planes_call_clear_never_enters(kind):
    made = assembly(TOOLS[kind], DEPTH, DEPTH)
    rng = np.random.default_rng(7)
    seen, box = np.zeros((11, lanes.LANES)), np.zeros((planes.BOXES, lanes.LANES))
    end, clear, view = np.zeros((planes.ENDS, lanes.LANES)), np.zeros(lanes.LANES), np.zeros((1, 16, lanes.LANES))
    weights = np.array([(i, j, 8 - i - j) for i in range(9) for j in range(9 - i)]) / 8
    cube = np.stack(np.meshgrid(*[np.linspace(-1, 1, 4)] * 3), -1).reshape(-1, 3)
    passed, asked = 0, 0
    for mode in range(len(made.mode)):
        offset, piece = made.mode[mode, 0], made.piece[mode]
        turning = bounds.Turning(offset, piece, *bounds.turning_of(piece, offset, 0.0, made.mode[mode, 3]))
        for _ in range(60):
            k = rng.integers(len(piece))
            ends = np.sort(rng.uniform(0, made.mode[mode, 3], 2))
            low = max(piece[k, 7], -50)
            high = min(piece[k, 8], low + 60)
            corners, sides = np.zeros((lanes.LANES, 3, 3)), np.zeros((lanes.LANES, 4, 3))
            for lane in range(lanes.LANES):
                # Near the surface of the piece at a tilt of the gap.
                tilt, turn, size = rng.uniform(*ends), rng.uniform(0, 7), 10 ** rng.uniform(-2, 1)
                q, height = (piece[k, 9] + size * rng.exponential() * rng.choice([1, -0.1]), rng.uniform(low - size, high))
                x, y = q * np.cos(turn) - offset, q * np.sin(turn)
                c, s = np.cos(tilt), np.sin(tilt)
                place = np.array([c * x + s * height, y, c * height - s * x])
                corners[lane] = place + size * rng.standard_normal((3, 3))
                sides[lane, 0] = place
                sides[lane, 1:] = (np.linalg.qr(rng.standard_normal((3, 3)))[0] * size * rng.random(3)).T
                planes.put_ends(end, lane, np.cos(ends[0]), np.sin(ends[0]), np.cos(ends[1]), np.sin(ends[1]))
                seen[:9, lane] = corners[lane].ravel()
                view[0, :3, lane] = place
                for side in range(3):
                    view[0, 3 + side, lane], view[0, 6 + side, lane], view[0, 9 + side, lane] = sides[lane, 1 + side]
            planes.distances(seen)
            planes.triangles_clear(seen, end, turning, k, clear)
            for lane in np.flatnonzero(clear):
                assert deepest(weights @ corners[lane], ends, offset, piece[k]) <= 1e-9
            passed, asked = passed + int(clear.sum()), asked + lanes.LANES
            planes.turn_boxes(view, 0, 1.0, 0.0, box)
            planes.boxes_clear(box, end, turning, k, clear)
            for lane in np.flatnonzero(clear):
                assert deepest(sides[lane, 0] + cube @ sides[lane, 1:], ends, offset, piece[k]) <= 1e-9
    assert 0.1 * asked < passed < asked


@pytest.mark.parametrize("kind", ["flat", "bull with stages", "tapered ball", "barrel", "lens"])
def test_an_interval_shrinks_until_a_triangle_passes_and_no_more(kind):
    """From its first tilt up and from its last one down."""
    made = assembly(TOOLS[kind], DEPTH, DEPTH)
    rng, work, shrunk = np.random.default_rng(3), cuts.cut_workspace(), {1.0: 0, -1.0: 0}
    weights = np.array([(i, j, 8 - i - j) for i in range(9) for j in range(9 - i)]) / 8

    def passes(corner, first, last, turning, k):
        return cuts._out(corner, np.cos(first), np.sin(first), np.cos(last), np.sin(last), turning, k, work)

    for _ in range(250):
        mode = rng.integers(len(made.mode))
        offset, piece = made.mode[mode, 0], made.piece[mode]
        turning = bounds.Turning(offset, piece, *bounds.turning_of(piece, offset, 0.0, made.mode[mode, 3]))
        k = rng.integers(len(piece))
        first, last = np.sort(rng.uniform(0, made.mode[mode, 3], 2))
        tilt, turn, size = rng.choice([first, last]), rng.uniform(0, 7), 10 ** rng.uniform(-2, 0.5)
        q, height = piece[k, 9] - 0.1 * size * rng.exponential(), rng.uniform(piece[k, 7], min(piece[k, 8], piece[k, 7] + 60))
        x, y, c, s = q * np.cos(turn) - offset, q * np.sin(turn), np.cos(tilt), np.sin(tilt)
        corner = np.array([c * x + s * height, y, c * height - s * x]) + size * rng.standard_normal((3, 3))
        if passes(corner, first, last, turning, k):
            continue
        interval = np.array([[first, last, np.cos(first), np.sin(first), np.cos(last), np.sin(last), 0.0, 0.0]] * 2)
        for sign in shrunk:
            passed, failed = cuts._shrink(corner, interval, 0, sign, NARROWEST, turning, k, work)
            ends = [(first + move, last) if sign > 0 else (first, last - move) for move in (passed, failed)]
            if passed == np.inf:
                assert failed == last - first
                continue
            assert 0 < passed - failed <= NARROWEST
            assert passes(corner, *ends[0], turning, k)
            assert deepest(weights @ corner, ends[0], offset, piece[k]) <= 1e-9
            assert not passes(corner, *ends[1], turning, k)
            shrunk[sign] += 1
    assert min(shrunk.values()) > 10
