"""Machines: limits of the axis, a table, and the least number of fixed directions."""

import numpy as np

from conformance.forms import box, half_space
from conformance.made.blocks import cuboid, extruded, on_lines, on_rectangles, prism, rectangle
from conformance.made.part import Answer, MadePart, Setup, directions
from conformance.made.planar import along, at, ball_end_until, ball_from, ball_until
from conformance.tool import Floats, Tool

_X, _Y, _Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
_BACK, _ASIDE, _DOWN = (-1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, -1.0)
_FLAT, _BALL, _BULL = Tool.flat(8.0, 40.0), Tool.ball(6.0, 40.0), Tool.flat(8.0, 40.0, corner=1.5)
Vector = tuple[float, float, float]


_BLOCK = ((-10.0, -10.0, 0.0), (10.0, 10.0, 30.0))
_TILTING = 100.0
_LIMIT = Setup("limit 100", limit_deg=_TILTING)
_TABLE = Setup("table and limit 100", limit_deg=_TILTING, fixtures=(half_space("table", (0.0, 0.0, 0.0), _Z),), table=0.0)

TABLE = MadePart(
    "block_on_table",
    "machines",
    "A block on a table, the axis at its limit",
    """One box. The table is all below z = 0. The axis may be at most 100 degrees from z, 10 below a side's normal. A ball end
    that tilts down comes to the limit at 10 degrees, and to the table with its upper end (planar.ball_end_until): at z = 12 the
    limit is first, at z = 6 the table.""",
    lambda: cuboid(*_BLOCK),
    (box("block", *_BLOCK),),
    (_BALL, _FLAT, _BULL),
    on_rectangles(((10, -10, 2), (10, 10, 28), _X), ((-10, -10, 2), (10, -10, 28), _ASIDE), ((-10, -10, 30), (10, 10, 30), _Z)),
    setups=(_LIMIT, _TABLE),
    answers=(
        Answer("free_tilts", [[0.0, min(_TILTING - 90.0, ball_end_until(12.0, 3.0, 40.0))]], "the limit", _BALL.name, _TABLE.name, at((10, 0, 12), _X, _DOWN)),
        Answer(
            "free_tilts",
            [[0.0, min(_TILTING - 90.0, ball_end_until(6.0, 3.0, 40.0))]],
            "planar.ball_end_until: the table",
            _BALL.name,
            _TABLE.name,
            at((10, 0, 6), _X, _DOWN),
        ),
        Answer("free_tilts", [[0.0, _TILTING - 90.0]], "the limit", _BALL.name, _LIMIT.name, at((10, 0, 6), _X, _DOWN)),
        Answer("free_tilts", [[0.0, 90.0]], "up, table and limit are farther", _BALL.name, _TABLE.name, at((10, 0, 6), _X, _Z)),
    ),
)

_SQUARE = ((-25.0, -25.0, -10.0), (25.0, 25.0, 0.0))
_THIRTY = Setup("limit 30", limit_deg=30.0)

PLATE_LIMIT = MadePart(
    "plate_limit",
    "machines",
    "A plate under a limit of the axis",
    """One box. On its top all material is behind the contact, so that the limit alone decides: the axis may be at most 30
    degrees from z, the normal.""",
    lambda: cuboid(*_SQUARE),
    (box("plate", *_SQUARE),),
    (_FLAT, _BALL, _BULL),
    on_rectangles(((-25, -25, 0), (25, 25, 0), _Z)),
    setups=(_THIRTY,),
    answers=tuple(
        Answer("free_tilts", [[0.0, 30.0]], "the limit", tool.name, _THIRTY.name, at((2, 3, 0), _Z, way))
        for tool, way in ((_FLAT, _X), (_BALL, _Y), (_BULL, (1.0, 1.0, 0.0)))
    ),
)

_SLOPE = 20.0
_RISE = float(np.tan(np.radians(_SLOPE)))
_RAMP = ((-20.0, -10.0), (20.0, -10.0), (20.0, 20.0 * _RISE), (-20.0, -20.0 * _RISE))
_UPHILL = (float(np.cos(np.radians(_SLOPE))), 0.0, float(np.sin(np.radians(_SLOPE))))
_OUT = (-_UPHILL[2], 0.0, _UPHILL[0])

RAMP_LIMIT = MadePart(
    "ramp_limit",
    "machines",
    "A ramp under a limit of the axis",
    """One convex bar whose top rises by 20 degrees along x. The normal is 20 degrees from z. At the tilt t uphill the axis is
    |t - 20| from z, downhill t + 20, and along the ramp's level lines acos(cos 20 cos t), by the right-angled triangle on the
    sphere. All are compared with 30.""",
    lambda: extruded(_RAMP, 20.0),
    (prism("ramp", _RAMP, 20.0),),
    (_FLAT, _BALL, _BULL),
    on_lines(((-20, -20 * _RISE), (20, 20 * _RISE)), wide=18.0),
    setups=(_THIRTY,),
    answers=(
        Answer("free_tilts", [[0.0, 30.0 + _SLOPE]], "30 + 20", _FLAT.name, _THIRTY.name, at((0, 0, 0), _OUT, _UPHILL)),
        Answer("free_tilts", [[0.0, 30.0 - _SLOPE]], "30 - 20", _BALL.name, _THIRTY.name, at((0, 0, 0), _OUT, (-_UPHILL[0], 0.0, -_UPHILL[2]))),
        Answer(
            "free_tilts",
            [[0.0, float(np.degrees(np.arccos(np.cos(np.radians(30.0)) / np.cos(np.radians(_SLOPE)))))]],
            "acos(cos 30 / cos 20)",
            _BULL.name,
            _THIRTY.name,
            at((0, 0, 0), _OUT, _Y),
        ),
    ),
)

_CUBE = ((-10.0, -10.0, -10.0), (10.0, 10.0, 10.0))
_FIVE = (((10.0, 1.0, 2.0), _X), ((-10.0, 1.0, 2.0), _BACK), ((1.0, 10.0, 2.0), _Y), ((1.0, -10.0, 2.0), _ASIDE), ((1.0, 2.0, 10.0), _Z))

CUBE = MadePart(
    "cube_five_faces",
    "machines",
    "A cube with five faces to be reached",
    """One box, all of it behind the plane of each contact: a posture is free where the axis is on the outer side of the face.
    With tilts below 90 degrees no direction serves two opposite faces, for a.n > 0 and a.(-n) > 0 exclude each other: at least
    2, and (1, 1, 1) and (-1, -1, 1) do. With tilts up to 50 no direction serves three faces that are at right angles, for the
    sum of the squares of their cosines is 1 and 3 cos(50)^2 > 1: each serves two of the five at most, at least 3, and (1, 1,
    0), (-1, -1, 0), z do.""",
    lambda: cuboid(*_CUBE),
    (box("cube", *_CUBE),),
    (_FLAT, _BALL, _BULL),
    on_rectangles(((10, -9, -9), (10, 9, 9), _X), ((-10, -9, -9), (-10, 9, 9), _BACK), ((-9, 10, -9), (9, 10, 9), _Y), ((-9, -9, 10), (9, 9, 10), _Z)),
    answers=(
        Answer("orientations", 2, "opposite faces need a direction each", _FLAT.name, given=directions(((1, 1, 1), (-1, -1, 1)), _FIVE, 89.0, (0, 1))),
        Answer(
            "orientations",
            3,
            "3 cos(50)^2 > 1: two faces a direction at most",
            _BALL.name,
            given=directions(((1, 1, 0), (-1, -1, 0), (0, 0, 1)), _FIVE, 50.0, ()),
        ),
    ),
)

_SIDES = (((20.0, 5.0, 0.0), _Z), ((-5.0, 3.0, -10.0), _DOWN))

BOTH_SIDES = MadePart(
    "plate_both_sides",
    "machines",
    "A plate that is cut on both sides",
    """One box. Contacts on its top and on its bottom: their normals are opposite, so that no direction is on the outer side of
    both: at least 2, and z and -z do.""",
    lambda: cuboid(*_SQUARE),
    (box("plate", *_SQUARE),),
    (_BALL, _FLAT, _BULL),
    on_rectangles(((-25, -25, 0), (25, 25, 0), _Z), ((-25, -25, -10), (25, 25, -10), _DOWN)),
    answers=(Answer("orientations", 2, "opposite normals", _BALL.name, given=directions((_Z, _DOWN), _SIDES, 89.0, (0, 1))),),
)

_ANGLES = np.radians([90.0, 210.0, 330.0])
_TRIANGLE = tuple((float(20 * np.cos(a)), float(20 * np.sin(a))) for a in _ANGLES)
_FACETS = tuple(
    ((float(-10 * np.cos(a)), y, float(-10 * np.sin(a))), (float(-np.cos(a)), 0.0, float(-np.sin(a)))) for a, y in zip(_ANGLES, (1.0, 2.0, 3.0), strict=True)
)


def _on_facets(rng: np.random.Generator, n: int) -> tuple[Floats, Floats]:
    pick, s = rng.integers(3, size=n), rng.uniform(-14.0, 14.0, n)
    normal = np.array([f[1] for f in _FACETS])[pick]
    side = np.column_stack([-normal[:, 2], np.zeros(n), normal[:, 0]])
    return 10.0 * normal + s[:, None] * side + np.column_stack([np.zeros(n), rng.uniform(-15, 15, n), np.zeros(n)]), normal


THREE_SIDES = MadePart(
    "three_sides",
    "machines",
    "A bar with three sides",
    """One convex bar along y, its outline a triangle with equal sides. The three normals add up to zero, so that no direction
    has a positive part along all: at least 2. Two of them at 60 degrees from the direction between, and the third along itself,
    do.""",
    lambda: extruded(_TRIANGLE, 20.0),
    (prism("bar", _TRIANGLE, 20.0),),
    (_BALL, _FLAT, _BULL),
    _on_facets,
    answers=(
        Answer(
            "orientations", 2, "the normals add up to zero", _BALL.name, given=directions((tuple(-x for x in _FACETS[0][1]), _FACETS[0][1]), _FACETS, 89.0, ())
        ),
    ),
)

_PHI, _DEEP, _HALF, _WIDE = np.radians(30.0), 20.0, 4.0, 7.0
_SHIFT = float(_DEEP * np.tan(_PHI))
_LOW, _HIGH = -20.0 - 8.0, 0.0
_FRONT = rectangle(-35, 35, _LOW, _HIGH)
#: Between the slots a piece that widens upwards, and one outside each of them.
_MIDDLE = ((-_WIDE + _HALF, -_DEEP), (_WIDE - _HALF, -_DEEP), (_WIDE - _HALF + _SHIFT, 0.0), (-_WIDE + _HALF - _SHIFT, 0.0))
_RIGHT = ((_WIDE + _HALF, -_DEEP), (35.0, -_DEEP), (35.0, 0.0), (_WIDE + _HALF + _SHIFT, 0.0))
_LEFT = tuple((-x, z) for x, z in _RIGHT)
_CUTS = tuple(
    tuple((side * x, z) for x, z in ((_WIDE - _HALF, -_DEEP), (_WIDE + _HALF, -_DEEP), (_WIDE + _HALF + _SHIFT, 0.0), (_WIDE - _HALF + _SHIFT, 0.0)))
    for side in (-1.0, 1.0)
)
_THIN = Tool.ball(4.0, 40.0)
_NEAR, _AWAY = (_SHIFT - _HALF, _DEEP), (_SHIFT + _HALF, _DEEP)
_BOTTOMS = (((-_WIDE, 0.0, -_DEEP), _Z), ((_WIDE, 0.0, -_DEEP), _Z))


def _slotted() -> object:
    body = cuboid((-35.0, -20.0, _LOW), (35.0, 20.0, _HIGH))
    for cut in _CUTS:
        body = body.cut(extruded(cut, _HALF))
    return body


def _into(rng: np.random.Generator, points: Floats, normals: Floats) -> Floats:
    """Draw axes about the slots' own directions, so that some are free."""
    out = np.sign(points[:, 0])
    across, y = np.radians(rng.uniform(22.0, 40.0, len(points))), rng.uniform(-0.08, 0.08, len(points))
    axis = np.column_stack([out * np.sin(across), y, np.cos(across)])
    return axis / np.linalg.norm(axis, axis=1)[:, None]


OPPOSED_SLOTS = MadePart(
    "opposed_slots",
    "machines",
    "Two pockets that slant to opposite sides",
    """Six convex bodies side by side: below, before and behind the pockets, between and outside them. Each pocket is 8 by 8 mm
    wide and slants by 30 degrees. Nowhere is a pocket 25 mm long, and the tool is 38 above its ball's centre: its axis leaves
    by the mouth, which is wholly on one side of the contact, x from 7.5 to 15.5. So the axis goes to -x from the one pocket and
    to x from the other: no direction serves both, and the two slants do. In the middle plane the side of a ball end passes the
    near edge and comes to the far one (planar.ball_from, ball_until). The ball end's radius is limited by the overhanging side,
    b cos f - R sin f = R.""",
    _slotted,
    (
        box("below", (-35.0, -20.0, _LOW), (35.0, 20.0, -_DEEP)),
        box("before", (-35.0, -20.0, -_DEEP), (35.0, -_HALF, 0.0)),
        box("behind", (-35.0, _HALF, -_DEEP), (35.0, 20.0, 0.0)),
        prism("between", _MIDDLE, _HALF),
        prism("right", _RIGHT, _HALF),
        prism("left", _LEFT, _HALF),
    ),
    (_THIN, Tool.flat(3.0, 40.0), Tool.flat(4.0, 45.0, corner=1.0)),
    on_lines(*(((side * _WIDE - 1.5, -_DEEP), (side * _WIDE + 1.5, -_DEEP)) for side in (-1.0, 1.0)), wide=1.0),
    answers=(
        Answer(
            "orientations",
            2,
            "the mouths are on opposite sides",
            _THIN.name,
            given=directions(((-np.sin(_PHI), 0.0, np.cos(_PHI)), (np.sin(_PHI), 0.0, np.cos(_PHI))), _BOTTOMS, 89.0, (0, 1)),
        ),
        Answer("free_tilts", [[ball_from(_NEAR, 2.0), ball_until(_AWAY, 2.0)]], "planar.ball_from, ball_until", _THIN.name, given=at(_BOTTOMS[1][0], _Z, _X)),
        Answer(
            "largest_radius",
            float(_HALF * np.cos(_PHI) / (1 + np.sin(_PHI))),
            "b cos f / (1 + sin f)",
            given=along(_BOTTOMS[0][0], _Z, (-np.sin(_PHI), 0.0, np.cos(_PHI)), ball=_THIN),
        ),
    ),
    axes=_into,
)

PARTS = (TABLE, PLATE_LIMIT, RAMP_LIMIT, CUBE, BOTH_SIDES, THREE_SIDES, OPPOSED_SLOTS)
