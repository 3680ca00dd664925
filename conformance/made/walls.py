"""Walls and steps: planes that stand in the way of a tool."""

import numpy as np

from conformance.forms import box
from conformance.made.blocks import bars, cuboid, fused, on_lines, on_rectangles, rectangle
from conformance.made.part import Answer, MadePart
from conformance.made.planar import along, at, ball_end_until, ball_from, ball_until, flat_from, flat_until, heel_from, holder
from conformance.tool import Tool

_X, _Y, _Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
_BACK, _DOWN = (-1.0, 0.0, 0.0), (0.0, 0.0, -1.0)
_FLAT, _WIDE, _BALL = Tool.flat(8.0, 40.0), Tool.flat(16.0, 40.0), Tool.ball(6.0, 40.0)

_D, _H = 10.0, 25.0
_BULL = Tool.flat(14.0, 40.0, corner=2.0)
_MATERIALS, _build = bars(plate=rectangle(-40, _D, -8, 0), wall=rectangle(_D, _D + 8, -8, _H), plate_behind=rectangle(_D + 8, 40, -8, 0))

PLATE_AND_WALL = MadePart(
    "plate_and_wall",
    "walls",
    "A plate with a wall across it",
    """Three convex bars side by side: the plate below z = 0, the wall from x = 10 to 18, up to z = 25, and the plate behind it:
    the whole part. Towards the wall, the side of the tool comes to the wall's upper edge (planar.flat_until, ball_until); away
    from it, the heel has to be clear of the wall (planar.heel_from), and the rest of the tool goes away from it. Along the wall
    the tool is as wide as its diameter: no tilt is blocked.""",
    _build,
    _MATERIALS,
    (_FLAT, _WIDE, _BULL, _BALL),
    on_lines(((-12, 0), (_D, 0)), ((_D, 0), (_D, _H)), ((_D, _H), (_D + 8, _H)), ((_D + 8, _H), (_D + 8, 0)), ((_D + 8, 0), (30, 0))),
    answers=(
        Answer("free_tilts", [[0.0, flat_until((_D, _H))]], "atan(d / h): the front side comes to the edge", _FLAT.name, given=at((0, 0, 0), _Z, _X)),
        Answer("free_tilts", [[0.0, ball_until((_D, _H), 3.0)]], "planar.ball_until", _BALL.name, given=at((0, 0, 0), _Z, _X)),
        Answer("free_tilts", [[heel_from((_D, _H), 8.0), 90.0]], "acos(d / 2R): the heel is before the wall", _WIDE.name, given=at((0, 0, 0), _Z, _BACK)),
        Answer(
            "free_tilts",
            [[heel_from((_D, _H), 7.0, 2.0), 90.0]],
            "acos((d - c) / 2r), r the flat's radius, c the corner",
            _BULL.name,
            given=at((0, 0, 0), _Z, _BACK),
        ),
        Answer("free_tilts", [[0.0, 90.0]], "along the wall the tool is 2R wide: R < d", _WIDE.name, given=at((0, 0, 0), _Z, _Y)),
    ),
)

_STEP = 14.0
_MATERIALS, _build = bars(floor=rectangle(-50, 0, -8, 0), block=rectangle(0, 25, -8, _STEP))
_TOE = Tool.flat(12.0, 40.0)

STEP = MadePart(
    "step",
    "walls",
    "A step: floor, riser and top",
    """Two convex bars, the floor below z = 0 and the block from x = 0 up to z = 14. Contacts on the riser look along -x. A tool
    that tilts up has its heel below the contact: clear of the floor from acos(z / 2R). A ball end that tilts down comes to the
    floor with its upper end. On the top all material lies behind the plane of the contact.""",
    _build,
    _MATERIALS,
    (_TOE, _BALL, Tool.flat(8.0, 40.0, corner=1.5)),
    on_lines(((-12, 0), (0, 0)), ((0, 0), (0, _STEP)), ((0, _STEP), (12, _STEP))),
    answers=(
        Answer("free_tilts", [[heel_from((8.0, 50.0), 6.0), 90.0]], "acos(z / 2R)", _TOE.name, given=at((0, 0, 8), _BACK, _Z)),
        Answer(
            "free_tilts",
            [[0.0, ball_end_until(8.0, 3.0, 40.0)]],
            "planar.ball_end_until, the plane is the floor",
            _BALL.name,
            given=at((0, 0, 8), _BACK, _DOWN),
        ),
        Answer("free_tilts", [[0.0, 90.0]], "all material is behind the plane of the contact", _TOE.name, given=at((5, 0, _STEP), _Z, _BACK)),
    ),
)

_CORNER = (((0.0, 0.0, -8.0), (60.0, 60.0, 0.0)), ((-8.0, -8.0, -8.0), (0.0, 60.0, 50.0)), ((0.0, -8.0, -8.0), (60.0, 0.0, 50.0)))


def _diagonal(distance: float, radius: float, length: float) -> float:
    """Return the tilt at which the end of a ball end that tilts between two walls comes to both.

    Across one wall the axis has the part `sin t / sqrt 2 = sin q`, and the end reaches `A sin q + R cos q`: as far as at the
    tilt q straight to it.
    """
    return float(np.degrees(np.arcsin(np.sqrt(2.0) * np.sin(np.radians(ball_end_until(distance, radius, length))))))


CORNER_OF_THREE = MadePart(
    "corner_of_three",
    "walls",
    "An inside corner of three planes",
    """Three boxes: the floor, a wall behind x = 0 and one behind y = 0. The walls are 50 mm high, more than any tool: its upper
    end comes to them first. A ball end on the floor keeps its centre above the contact: its radius is at most the distance of
    the contact from each wall, and upright it fits.""",
    lambda: fused(*(cuboid(*c) for c in _CORNER)),
    tuple(box(name, *c) for name, c in zip(("floor", "wall x", "wall y"), _CORNER, strict=True)),
    (_BALL, _FLAT, Tool.flat(10.0, 35.0, corner=2.0)),
    on_rectangles(((0, 0, 0), (25, 25, 0), _Z), ((0, 0, 0), (0, 20, 30), _X), ((0, 0, 0), (20, 0, 30), _Y)),
    answers=(
        Answer("free_tilts", [[0.0, ball_end_until(12.0, 3.0, 40.0)]], "planar.ball_end_until", _BALL.name, given=at((12, 12, 0), _Z, _BACK)),
        Answer("free_tilts", [[0.0, _diagonal(12.0, 3.0, 40.0)]], "sin t = sqrt 2 sin q: walls._diagonal", _BALL.name, given=at((12, 12, 0), _Z, (-1, -1, 0))),
        Answer("largest_radius", min(9.0, 12.0), "the nearer wall", given=along((9, 12, 0), _Z, _Z, ball=_BALL)),
    ),
)

_OPEN, _SLANT = np.radians(80.0), 60.0
_UP = (float(np.sin(_OPEN / 2)), float(np.cos(_OPEN / 2)))
_RIM = (_SLANT * _UP[0], _SLANT * _UP[1])
_MATERIALS, _build = bars(right=((0, 0), (0, -8), (_RIM[0], -8), _RIM), left=((0, 0), (-_RIM[0], _RIM[1]), (-_RIM[0], -8), (0, -8)))
_V_NORMAL, _V_DOWN = (-_UP[1], 0.0, _UP[0]), (-_UP[0], 0.0, -_UP[1])


def _on_v(s: float) -> tuple[float, float, float]:
    return (s * _UP[0], 0.0, s * _UP[1])


def _v_until(s: float, radius: float, length: float) -> float:
    """Return the tilt at which the upper end of a ball end, `s` up one wall and tilted down it, comes to the other wall.

    The other wall's normal makes the angle `b = w - t` with the axis reversed, `w` the opening. The ball's centre is `s sin w -
    R cos w` from its plane, the end `A cos b + R sin b` nearer: equal at `b = atan2(R, A) + acos((s sin w - R cos w) / hypot(A,
    R))`.
    """
    a = length - radius
    b = np.arctan2(radius, a) + np.arccos((s * np.sin(_OPEN) - radius * np.cos(_OPEN)) / np.hypot(a, radius))
    return float(np.degrees(_OPEN - b))


SHARP_V = MadePart(
    "sharp_v",
    "walls",
    "A sharp V of two planes at 80 degrees",
    """Two convex bars with a corner in the bottom line, each behind one plane of 60 mm; no tool reaches past the rims from low
    contacts. A ball end that touches one plane at s from the bottom line touches the other when its centre is on the bisector:
    R = s tan(w / 2).""",
    _build,
    _MATERIALS,
    (_BALL, _FLAT, Tool.flat(6.0, 40.0, corner=1.0)),
    on_lines(((0, 0), (25 * _UP[0], 25 * _UP[1])), ((-25 * _UP[0], 25 * _UP[1]), (0, 0))),
    answers=(
        Answer("largest_radius", float(10.0 * np.tan(_OPEN / 2)), "s tan(w / 2)", given=along(_on_v(10.0), _V_NORMAL, _Z, ball=_BALL)),
        Answer("free_tilts", [[0.0, _v_until(20.0, 3.0, 40.0)]], "walls._v_until", _BALL.name, given=at(_on_v(20.0), _V_NORMAL, _V_DOWN)),
        Answer(
            "free_tilts", [[0.0, 90.0]], "up the wall the axis goes away from the other", _BALL.name, given=at(_on_v(20.0), _V_NORMAL, (_UP[0], 0.0, _UP[1]))
        ),
    ),
)

_RIB, _WALLS, _ACROSS = 12.0, 14.0, 20.0
_MATERIALS, _build = bars(
    left_wall=rectangle(-_ACROSS - 8, -_ACROSS, -8, _WALLS),
    left_floor=rectangle(-_ACROSS, -2, -8, 0),
    rib=rectangle(-2, 2, -8, _RIB),
    right_floor=rectangle(2, _ACROSS, -8, 0),
    right_wall=rectangle(_ACROSS, _ACROSS + 8, -8, _WALLS),
)
_NINE = Tool.flat(9.0, 40.0)

RIB = MadePart(
    "rib_between_walls",
    "walls",
    "A rib between two walls",
    """Five convex bars side by side: wall, floor, rib, floor, wall. On the floor at x = 10 a flat end that tilts to the wall
    needs its heel clear of the rib, 8 mm behind, and its front side before the wall's edge, 10 mm ahead. On the rib only the
    walls' edges, 2 mm higher, are in the way.""",
    _build,
    _MATERIALS,
    (_NINE, _BALL, Tool.flat(10.0, 40.0, corner=1.0)),
    on_lines(((-2, _RIB), (2, _RIB)), ((2, _RIB), (2, 0)), ((2, 0), (_ACROSS, 0)), ((_ACROSS, 0), (_ACROSS, _WALLS)), ((-_ACROSS, 0), (-2, 0))),
    answers=(
        Answer(
            "free_tilts", [[heel_from((8.0, _RIB), 4.5), flat_until((10.0, _WALLS))]], "acos(8 / 2R) to atan(10 / 14)", _NINE.name, given=at((10, 0, 0), _Z, _X)
        ),
        Answer("free_tilts", [[0.0, flat_until((8.0, _RIB))]], "atan(8 / 12); the heel, 9 mm, is before the wall", _NINE.name, given=at((10, 0, 0), _Z, _BACK)),
        Answer("free_tilts", [[0.0, ball_until((_ACROSS, _WALLS - _RIB), 3.0)]], "planar.ball_until", _BALL.name, given=at((0, 0, _RIB), _Z, _X)),
        Answer("largest_radius", 0.5 * (_ACROSS - 2.0), "half the way from rib to wall", given=along((11, 0, 0), _Z, _Z, ball=_BALL)),
    ),
)

_ROOT = 15.0
_MATERIALS, _build = bars(left_root=rectangle(-_ROOT, -1, -10, 0), blade=rectangle(-1, 1, -10, 30), right_root=rectangle(1, _ROOT, -10, 0))

BLADE = MadePart(
    "blade_on_root",
    "walls",
    "A thin blade on a root",
    """Three convex bars side by side: the blade, 2 mm thick and 30 high, between the halves of the root below z = 0 to x = 15.
    Contacts on the blade look along x. Down, the side of the tool comes to the root's edge, 14 mm out; up, the heel of a flat
    end has to be clear of the root.""",
    _build,
    _MATERIALS,
    (_FLAT, _BALL, Tool.flat(8.0, 25.0, corner=1.0, holder=holder(25.0, 9.0))),
    on_lines(((1, 30), (1, 0)), ((-1, 30), (1, 30)), ((1, 0), (_ROOT, 0))),
    answers=(
        Answer("free_tilts", [[0.0, ball_until((10.0, _ROOT - 1), 3.0)]], "planar.ball_until", _BALL.name, given=at((1, 0, 10), _X, _DOWN)),
        Answer("free_tilts", [[0.0, flat_until((10.0, _ROOT - 1))]], "atan(z / 14)", _FLAT.name, given=at((1, 0, 10), _X, _DOWN)),
        Answer("free_tilts", [[heel_from((5.0, _ROOT - 1), 4.0), 90.0]], "acos(z / 2R)", _FLAT.name, given=at((1, 0, 5), _X, _Z)),
        Answer("free_tilts", [[0.0, 90.0]], "on the tip of the blade nothing is in the way", _FLAT.name, given=at((0, 0, 30), _Z, _X)),
    ),
)

_UNDER, _THICK, _INNER = 14.0, 6.0, 6.0
_MATERIALS, _build = bars(floor=rectangle(-22, 40, -8, 0), post=rectangle(-30, -22, -8, _UNDER + _THICK), shelf=rectangle(-22, 0, _UNDER, _UNDER + _THICK))
_LONG = Tool.ball(6.0, 25.0, holder=holder(25.0, 8.0), name="ball_D6_holder_D16")


def _stickout(tilt: float, radius: float, wide: float) -> float:
    """Return the least stick-out of a ball end that tilts by `tilt` deg out from under the shelf, with a holder of radius `wide`.

    The shelf's edge is the line from `(d, h)` up to `(d, h + e)`. A point of it at height z is `(z - R) sin t - d cos t` from
    the axis and `R + d sin t + (z - R) cos t` above the tip: the holder begins above the highest one that is nearer than its
    radius.
    """
    t = np.radians(tilt)
    z = min(radius + (wide + _INNER * np.cos(t)) / np.sin(t), _UNDER + _THICK)
    return float(radius + _INNER * np.sin(t) + (z - radius) * np.cos(t))


SHELF = MadePart(
    "shelf",
    "walls",
    "An undercut under a shelf",
    """Three convex bars: floor, post and the shelf from z = 14 to 20, which ends at x = 0. A tool on the floor at x = -6 comes
    out below the shelf's lower edge, 6 mm ahead: planar.ball_from, flat_from. The largest ball end between floor and shelf has
    half their distance as its radius, its axis along x.""",
    _build,
    _MATERIALS,
    (_BALL, _FLAT, _LONG),
    on_lines(((-20, 0), (0, 0)), ((0, 0), (15, 0)), ((0, _UNDER), (-20, _UNDER)), ((0, _UNDER + _THICK), (0, _UNDER))),
    answers=(
        Answer("free_tilts", [[ball_from((_INNER, _UNDER), 3.0), 90.0]], "planar.ball_from", _BALL.name, given=at((-_INNER, 0, 0), _Z, _X)),
        Answer("free_tilts", [[flat_from((_INNER, _UNDER), 4.0), 90.0]], "planar.flat_from", _FLAT.name, given=at((-_INNER, 0, 0), _Z, _X)),
        Answer(
            "least_stickout",
            _stickout(60.0, 3.0, 8.0),
            "walls._stickout",
            _LONG.name,
            given=along((-_INNER, 0, 0), _Z, (float(np.sin(np.radians(60.0))), 0.0, float(np.cos(np.radians(60.0))))),
        ),
        Answer("largest_radius", 0.5 * _UNDER, "half the height under the shelf", given=along((-_INNER, 0, 0), _Z, _X, ball=_BALL)),
    ),
)

PARTS = (PLATE_AND_WALL, STEP, CORNER_OF_THREE, SHARP_V, RIB, BLADE, SHELF)
