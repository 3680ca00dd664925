"""Slots, gaps, bores and pockets: material on both sides of the tool."""

import numpy as np

from conformance.forms import Bore, box
from conformance.made.blocks import bars, cuboid, fused, on_lines, on_rectangles, rectangle
from conformance.made.part import Answer, MadePart
from conformance.made.planar import along, at, ball_end_from, ball_from, ball_until, end_until, flat_from, flat_until, heel_from, holder
from conformance.tool import Floats, Tool

_X, _Y, _Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
_BACK, _DOWN = (-1.0, 0.0, 0.0), (0.0, 0.0, -1.0)
_FLAT, _BALL = Tool.flat(8.0, 40.0), Tool.ball(6.0, 40.0)

_B, _H = 6.0, 5.0
_MATERIALS, _build = bars(floor=rectangle(-_B, _B, -8, 0), left_side=rectangle(-25, -_B, -8, _H), right_side=rectangle(_B, 25, -8, _H))

SLOT = MadePart(
    "slot",
    "slots",
    "A slot with a flat bottom",
    """Three convex bars: the floor between the two sides, 12 mm apart and 5 high. In the middle of the floor a flat end that
    tilts across has its heel before the side behind it or above its edge, and its front side before the other edge. A ball end
    of radius R stands at the height R: the edges are at distance R from its centre where 2 R h = b^2 + h^2, and upright its
    shank is above them.""",
    _build,
    _MATERIALS,
    (_FLAT, _BALL, Tool.flat(10.0, 35.0, corner=1.0)),
    on_lines(((-_B, 0), (_B, 0)), ((_B, 0), (_B, _H)), ((_B, _H), (_B + 8, _H))),
    answers=(
        Answer(
            "free_tilts",
            [[heel_from((_B, _H), 4.0), flat_until((_B, _H))]],
            "atan(h / b), the heel passes above the edge, to atan(b / h)",
            _FLAT.name,
            given=at((0, 0, 0), _Z, _X),
        ),
        Answer("free_tilts", [[0.0, ball_until((_B, _H), 3.0)]], "planar.ball_until", _BALL.name, given=at((0, 0, 0), _Z, _X)),
        Answer("free_tilts", [[0.0, 90.0]], "along the slot: 2R < 12", _FLAT.name, given=at((0, 0, 0), _Z, _Y)),
        Answer("largest_radius", (_B**2 + _H**2) / (2 * _H), "(b^2 + h^2) / 2h", given=along((0, 0, 0), _Z, _Z, ball=_BALL)),
    ),
)

_NECK, _HEAD, _LIP, _TOP = 5.0, 10.0, 8.0, 18.0
_MATERIALS, _build = bars(
    base=rectangle(-_HEAD, _HEAD, -8, 0),
    left_head=rectangle(-25, -_HEAD, -8, _TOP),
    right_head=rectangle(_HEAD, 25, -8, _TOP),
    left_lip=rectangle(-_HEAD, -_NECK, _LIP, _TOP),
    right_lip=rectangle(_NECK, _HEAD, _LIP, _TOP),
)
_DISK, _CUT = 8.0, 5.0
_CUTTER = Tool.flat(2 * _DISK, 40.0, flutes=_CUT, shank=6.0, name="t_slot_D16")


def _disk_until() -> float:
    """Return the tilt along the slot at which the disk of the T-slot cutter comes to the lips.

    Its upper circle at `x = R sin f` is at `z = R sin t + c cos t + R sin t cos f`. Lips begin at `sin f = b / R`, where it is
    highest below them: `R (1 + q) sin t + c cos t = h` with `q = cos f`, so `t = asin(h / k) - atan2(c, R (1 + q))`, `k =
    hypot(R (1 + q), c)`.
    """
    wide = _DISK * (1.0 + np.sqrt(1.0 - (_NECK / _DISK) ** 2))
    return float(np.degrees(np.arcsin(_LIP / np.hypot(wide, _CUT)) - np.arctan2(_CUT, wide)))


T_SLOT = MadePart(
    "t_slot",
    "slots",
    "A T-slot",
    """Five convex bars: base, the sides of the head, 20 mm wide and 8 high, and the lips above it, 10 mm apart, up to z = 18.
    The T-slot cutter tilts along the slot until its disk comes to the lips. A ball end tilts across until its side comes to the
    lip's lower or upper edge. A ball end on the lower side of a lip has to have its upper end below the floor's height:
    planar.ball_end_from.""",
    _build,
    _MATERIALS,
    (_CUTTER, _BALL, Tool.flat(6.0, 40.0)),
    on_lines(((-_HEAD, 0), (_HEAD, 0)), ((_HEAD, 0), (_HEAD, _LIP)), ((_HEAD, _LIP), (_NECK, _LIP)), ((_NECK, _LIP), (_NECK, _TOP))),
    answers=(
        Answer("free_tilts", [[0.0, _disk_until()]], "slots._disk_until", _CUTTER.name, given=at((0, 0, 0), _Z, _Y)),
        Answer(
            "free_tilts",
            [[0.0, min(ball_until((_NECK, z), 3.0) for z in (_LIP, _TOP))]],
            "planar.ball_until, the nearer of two edges",
            _BALL.name,
            given=at((0, 0, 0), _Z, _X),
        ),
        Answer("free_tilts", [[ball_end_from(_LIP, 3.0, 40.0), 90.0]], "planar.ball_end_from", _BALL.name, given=at((6.5, 0, _LIP), _DOWN, _Y)),
    ),
)

_SIDE, _DEEP, _FOOT = np.radians(60.0), 10.0, 12.0
_LEAN = float(1.0 / np.tan(_SIDE))
_MOUTH = _FOOT - _DEEP * _LEAN
_MATERIALS, _build = bars(
    base=((-_FOOT, 0), (-_FOOT - 8 * _LEAN, -8), (_FOOT + 8 * _LEAN, -8), (_FOOT, 0)),
    right=((_FOOT + 8 * _LEAN, -8), (28, -8), (28, _DEEP), (_MOUTH, _DEEP)),
    left=((-_FOOT - 8 * _LEAN, -8), (-_MOUTH, _DEEP), (-28, _DEEP), (-28, -8)),
)
_UP = (float(-np.cos(_SIDE)), 0.0, float(np.sin(_SIDE)))
_IN = (float(-np.sin(_SIDE)), 0.0, float(-np.cos(_SIDE)))
_TAPER = Tool("dovetail_D12", ((0.0, 6.0), (8.0, 3.0), (40.0, 3.0)), cutting=8.0)


def _across(s: float) -> tuple[float, float]:
    """Return the opposite edge `(d, h)` as it is seen from the contact `s` up the right side."""
    x, z = -_MOUTH - (_FOOT + s * _UP[0]), _DEEP - s * _UP[2]
    return x * _UP[0] + z * _UP[2], x * _IN[0] + z * _IN[2]


DOVETAIL = MadePart(
    "dovetail",
    "slots",
    "A dovetail slot",
    """Three convex bars: the base and two sides that hang over it at 60 degrees; each is all material behind its plane up to z
    = 10. A tool on a side comes out by the mouth when its side passes the opposite edge: planar.ball_from, in the plane's own
    directions. A ball end on the floor at s from the foot touches the side when its centre is on the bisector, R = s tan(30),
    and its axis along the side leaves it free.""",
    _build,
    _MATERIALS,
    (_TAPER, _BALL, _FLAT),
    on_lines(((-_FOOT, 0), (_FOOT, 0)), ((_FOOT, 0), (_MOUTH, _DEEP)), ((_MOUTH, _DEEP), (20, _DEEP))),
    answers=(
        Answer(
            "free_tilts",
            [[ball_from(_across(8.0), 3.0), 90.0]],
            "planar.ball_from the opposite edge",
            _BALL.name,
            given=at((_FOOT + 8.0 * _UP[0], 0, 8.0 * _UP[2]), _IN, _UP),
        ),
        Answer(
            "free_tilts",
            [[flat_from(_across(9.0), 4.0), 90.0]],
            "planar.flat_from the opposite edge",
            _FLAT.name,
            given=at((_FOOT + 9.0 * _UP[0], 0, 9.0 * _UP[2]), _IN, _UP),
        ),
        Answer("largest_radius", float(5.0 * np.tan(_SIDE / 2)), "s tan(w / 2)", given=along((_FOOT - 5.0, 0, 0), _Z, _UP, ball=_BALL)),
    ),
)

_GAP, _TALL = 5.0, 25.0
_MATERIALS, _build = bars(
    left_base=rectangle(-25, -_GAP / 2 - 3, -8, 0),
    left_plate=rectangle(-_GAP / 2 - 3, -_GAP / 2, -8, _TALL),
    base=rectangle(-_GAP / 2, _GAP / 2, -8, 0),
    right_plate=rectangle(_GAP / 2, _GAP / 2 + 3, -8, _TALL),
    right_base=rectangle(_GAP / 2 + 3, 25, -8, 0),
)
_THIN_BALL, _THIN = Tool.ball(4.0, 40.0), Tool.flat(3.0, 40.0)
_HELD = Tool.flat(4.0, 30.0, corner=2.0, holder=holder(30.0, 10.0), name="ball_D4_holder_D20")

THIN_GAP = MadePart(
    "thin_gap",
    "slots",
    "A thin gap between two plates",
    """Five convex bars side by side: two plates, 3 mm thick, 25 high and 5 mm apart, between three pieces of the base. From one
    plate a tool comes out by the mouth when its side passes the other plate's inner edge: planar.ball_from, flat_from. A ball
    end between the plates has at most half the gap as its radius. The holder is wider than the gap: it stays above the
    plates.""",
    _build,
    _MATERIALS,
    (_THIN_BALL, _THIN, _HELD),
    on_lines(((-_GAP / 2, _TALL), (-_GAP / 2, 0)), ((-_GAP / 2, 0), (_GAP / 2, 0)), ((_GAP / 2, _TALL), (_GAP / 2 + 3, _TALL))),
    answers=(
        Answer("free_tilts", [[ball_from((5.0, _GAP), 2.0), 90.0]], "planar.ball_from", _THIN_BALL.name, given=at((-_GAP / 2, 0, 20), _X, _Z)),
        Answer("free_tilts", [[flat_from((5.0, _GAP), 1.5), 90.0]], "planar.flat_from", _THIN.name, given=at((-_GAP / 2, 0, 20), _X, _Z)),
        Answer("largest_radius", 0.5 * _GAP, "half the gap", given=along((-_GAP / 2, 0, 15), _X, _Z, ball=_THIN_BALL)),
        Answer("least_stickout", _TALL, "the holder is above the plates", _HELD.name, given=along((0, 0, 0), _Z, _Z)),
    ),
)

_NARROW, _HIGH = 5.0, 15.0
_MATERIALS, _build = bars(
    floor=rectangle(-_NARROW, _NARROW, -8, 0), left_side=rectangle(-25, -_NARROW, -8, _HIGH), right_side=rectangle(_NARROW, 25, -8, _HIGH)
)
_SHORT = Tool.flat(6.0, 40.0, flutes=12.0, shank=12.0, name="flat_D6_flutes12_shank_D12")
_FLUTES = Tool.flat(6.0, 40.0, flutes=16.0, shank=12.0, name="flat_D6_flutes16_shank_D12")


def _shank_until(flutes: float) -> float:
    """Return the tilt along the slot at which the shank's lower circle comes to the slot's edges.

    The circle at `x = Rs sin f` is at `z = R sin t + c cos t - Rs sin t cos f`; at the edges, `sin f = b / Rs`, it is lowest
    above them: `c cos t - (Rs q - R) sin t = h`, `q = cos f`, so `t = acos(h / k) - atan2(Rs q - R, c)`, `k = hypot(c, Rs q -
    R)`.
    """
    side = 6.0 * np.sqrt(1.0 - (_NARROW / 6.0) ** 2) - 3.0
    return float(np.degrees(np.arccos(_HIGH / np.hypot(flutes, side)) - np.arctan2(side, flutes)))


SHANK_IN_SLOT = MadePart(
    "shank_in_slot",
    "slots",
    "A shank that is thicker than the flutes, in a slot",
    """Three convex bars: the floor and two sides, 10 mm apart and 15 high. The flutes, 6 mm, fit; the shank, 12 mm, has to stay
    above the sides: with 12 mm of flutes at no tilt along the slot, for its lower circle is nowhere higher than 12 cos t; with
    16 mm until that circle comes down to the edges.""",
    _build,
    _MATERIALS,
    (_SHORT, _FLUTES, _BALL),
    on_lines(((-_NARROW, 0), (_NARROW, 0)), ((_NARROW, 0), (_NARROW, _HIGH)), ((_NARROW, _HIGH), (15, _HIGH))),
    answers=(
        Answer("free_tilts", [], "c < h: the shank's circle is below the edges at every tilt", _SHORT.name, given=at((0, 0, 0), _Z, _Y)),
        Answer("free_tilts", [[0.0, _shank_until(16.0)]], "slots._shank_until", _FLUTES.name, given=at((0, 0, 0), _Z, _Y)),
        Answer("free_tilts", [], "acos(b / 2R) of the heel is after atan(b / h) of the front side", _FLUTES.name, given=at((0, 0, 0), _Z, _X)),
    ),
)

_BORE = 8.0
_BLOCK = ((-25.0, -25.0, -10.0), (25.0, 25.0, 60.0))
_IN_BORE = Tool.ball(6.0, 40.0, flutes=15.0, shank=10.0, name="ball_D6_shank_D10")


def _bored() -> object:
    import cadquery as cq

    return cuboid(*_BLOCK).cut(cq.Workplane("XY").circle(_BORE).extrude(61.0))


def _on_floor(rng: np.random.Generator, n: int) -> tuple[Floats, Floats]:
    turn, r = rng.uniform(0, 2 * np.pi, n), rng.uniform(0.0, 7.0, n)
    return np.column_stack([r * np.cos(turn), r * np.sin(turn), np.zeros(n)]), np.tile([0.0, 0.0, 1.0], (n, 1))


def _steep(rng: np.random.Generator, points: Floats, normals: Floats) -> Floats:
    turn, t = rng.uniform(0, 2 * np.pi, len(points)), np.radians(rng.uniform(0.05, 15.0, len(points)))
    return np.column_stack([np.sin(t) * np.cos(turn), np.sin(t) * np.sin(turn), np.cos(t)])


SHANK_IN_BORE = MadePart(
    "shank_in_bore",
    "slots",
    "A shank in a deep bore",
    """The form Bore is all that is farther than 8 mm from the z axis, a box is all that is below the bore's floor. The block is
    50 mm wide and the bore 60 deep: tools of 40 mm, tilted by at most 15 degrees, stay within both. From the middle of the
    floor a circle of radius r at the height A above the ball's centre is at most A sin t + r cos t from the axis, so the upper
    end decides: planar.end_until, r the shank's radius.""",
    _bored,
    (Bore("bore", (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), _BORE), box("floor", _BLOCK[0], (25.0, 25.0, 0.0))),
    (_IN_BORE, _BALL, _FLAT),
    _on_floor,
    answers=(
        Answer("free_tilts", [[0.0, end_until(_BORE, 37.0, 5.0)]], "planar.end_until of the shank", _IN_BORE.name, given=at((0, 0, 0), _Z, _X)),
        Answer("free_tilts", [[0.0, end_until(_BORE, 37.0, 3.0)]], "planar.end_until", _BALL.name, given=at((0, 0, 0), _Z, (3, 4, 0))),
        Answer("largest_radius", _BORE - 3.0, "bore's radius less the distance from its axis", given=along((3, 0, 0), _Z, _Z, ball=_BALL)),
    ),
    axes=_steep,
)

_PX, _PY, _PZ = 9.0, 12.0, 30.0
_POCKET = {
    "floor": ((-_PX, -_PY, -8.0), (_PX, _PY, 0.0)),
    "wall +x": ((_PX, -23.0, -8.0), (20.0, 23.0, _PZ)),
    "wall -x": ((-20.0, -23.0, -8.0), (-_PX, 23.0, _PZ)),
    "wall +y": ((-_PX, _PY, -8.0), (_PX, 23.0, _PZ)),
    "wall -y": ((-_PX, -23.0, -8.0), (_PX, -_PY, _PZ)),
}
_DEEP_BALL = Tool.ball(6.0, 50.0)
_WIDE_HOLDER = Tool.ball(6.0, 35.0, holder=holder(35.0, 11.0), name="ball_D6_holder_D22")


def _skew_until() -> float:
    """Return the tilt at which a ball end that tilts between x and y comes to the pocket's edge along y.

    Across that edge only the part of the axis in the x z plane counts: `tan q = tan t / sqrt 2` there is its tilt.
    """
    return float(np.degrees(np.arctan(np.sqrt(2.0) * np.tan(np.radians(ball_until((_PX, _PZ), 3.0))))))


POCKET = MadePart(
    "box_pocket",
    "slots",
    "A deep pocket like a box",
    """Five boxes side by side: the floor and four walls, 18 by 24 mm inside and 30 deep. From the middle of the floor the side
    of a tool that is longer than the pocket is deep comes to an upper edge first. The holder, wider than the pocket, stays
    above it; a ball end's radius is at most the distance of the contact from the nearest wall.""",
    lambda: fused(*(cuboid(*c) for c in _POCKET.values())),
    tuple(box(name, *c) for name, c in _POCKET.items()),
    (_DEEP_BALL, _WIDE_HOLDER, Tool.flat(8.0, 45.0, corner=1.0)),
    on_rectangles(((-_PX, -_PY, 0), (_PX, _PY, 0), _Z), ((_PX, -_PY, 0), (_PX, _PY, _PZ), _BACK), ((_PX, -10, _PZ), (20, 10, _PZ), _Z)),
    answers=(
        Answer("free_tilts", [[0.0, ball_until((_PX, _PZ), 3.0)]], "planar.ball_until", _DEEP_BALL.name, given=at((0, 0, 0), _Z, _X)),
        Answer("free_tilts", [[0.0, ball_until((_PY, _PZ), 3.0)]], "planar.ball_until", _DEEP_BALL.name, given=at((0, 0, 0), _Z, _Y)),
        Answer("free_tilts", [[0.0, _skew_until()]], "tan t = sqrt 2 tan q: slots._skew_until", _DEEP_BALL.name, given=at((0, 0, 0), _Z, (1, 1, 0))),
        Answer("least_stickout", _PZ, "the holder is above the pocket", _WIDE_HOLDER.name, given=along((0, 0, 0), _Z, _Z)),
        Answer("largest_radius", min(_PX - 5.0, _PY - 9.0), "the nearest wall", given=along((5, 9, 0), _Z, _Z, ball=_DEEP_BALL)),
    ),
)

PARTS = (SLOT, T_SLOT, DOVETAIL, THIN_GAP, SHANK_IN_SLOT, SHANK_IN_BORE, POCKET)
