"""Holders: what stands beside the contact is lower or farther than the cutter reaches, but not than its holder."""

import numpy as np

from conformance.made.blocks import bars, on_lines, rectangle
from conformance.made.part import Answer, MadePart
from conformance.made.planar import along, at, holder
from conformance.tool import Tool

_X, _Z, _BACK = (1.0, 0.0, 0.0), (0.0, 0.0, 1.0), (-1.0, 0.0, 0.0)

_D, _H, _R = 8.0, 22.0, 3.0
_OUT, _WIDE = 20.0, 12.0
_MATERIALS, _build = bars(plate=rectangle(-70, _D, -8, 0), wall=rectangle(_D, _D + 8, -8, _H))
_TALL = Tool.ball(6.0, 30.0, holder=holder(30.0, _WIDE), name="ball_D6_stickout30_holder_D24")
_LOW = Tool.ball(6.0, _OUT, holder=holder(_OUT, _WIDE), name="ball_D6_stickout20_holder_D24")


def _tilts_away() -> list[list[float]]:
    """Return the free tilts (deg) away from the wall with the holder 20 mm above the tip, lower than the wall is high.

    The ball's centre is at (0, R). The wall's corner (d, h) is below the holder's lower face when `(h - R) cos t - d sin t <= s
    - R`, or the holder's corner is before the wall, `Rh cos t - (s - R) sin t <= d`: each of the form `k cos(t + f) <= c`. The
    other corner of the holder is above the plate while `R + (s - R) cos t - Rh sin t >= 0`.
    """
    up = _OUT - _R
    above = np.arccos(up / np.hypot(_H - _R, _D)) - np.arctan2(_D, _H - _R)
    before = np.arccos(_D / np.hypot(_WIDE, up)) - np.arctan2(up, _WIDE)
    plate = np.arccos(-_R / np.hypot(up, _WIDE)) - np.arctan2(_WIDE, up)
    return [[float(np.degrees(min(above, before))), float(np.degrees(plate))]]


HOLDER_AT_WALL = MadePart(
    "holder_at_wall",
    "holders",
    "A holder against a wall of height h at distance d",
    """Two convex bars: the plate and a wall, 22 mm high, 8 mm from the contact; the holder's radius is 12. Upright, the holder
    has to stay above the wall. With 20 mm of stick-out the tool has to tilt away, until its holder is beside the wall or above
    its edge, and not so far that it comes to the plate.""",
    _build,
    _MATERIALS,
    (_TALL, _LOW, Tool.flat(8.0, 25.0, corner=1.0, holder=holder(25.0, 10.0))),
    on_lines(((-10, 0), (_D, 0)), ((_D, 0), (_D, _H)), ((_D, _H), (_D + 8, _H))),
    answers=(
        Answer("least_stickout", _H, "the wall's height", _TALL.name, given=along((0, 0, 0), _Z, _Z)),
        Answer("free_tilts", _tilts_away(), "holders._tilts_away", _LOW.name, given=at((0, 0, 0), _Z, _BACK)),
    ),
)

_FAR, _HIGH, _FLAT, _ROUND = 11.0, 25.0, 5.0, 12.0
_MATERIALS, _build = bars(plate=rectangle(-70, _FAR, -8, 0), wall=rectangle(_FAR, _FAR + 8, -8, _HIGH))
_LEANT = Tool.flat(2 * _FLAT, 28.0, holder=holder(28.0, _ROUND), name="flat_D10_holder_D24")


def _least(tilt: float) -> float:
    """Return the least stick-out (mm) of a flat end that tilts away from the wall by `tilt` deg.

    In the plane, the heel's side is `b = (cos t, sin t)` from the contact, the axis `a = (-sin t, cos t)`, the tip `R b`. Two
    convex bodies are apart by a line: the holder from the quarter behind the wall's corner by its lower face, `s >= h cos t - d
    sin t`, or by the wall's plane, its corner `(R + Rh) b + s a` before it: `s >= ((R + Rh) cos t - d) / sin t`. No direction
    between the two does better, for the holder's corner is the same.
    """
    t = np.radians(tilt)
    return float(min(_HIGH * np.cos(t) - _FAR * np.sin(t), ((_FLAT + _ROUND) * np.cos(t) - _FAR) / np.sin(t)))


def _away(tilt: float) -> tuple[float, float, float]:
    return (float(-np.sin(np.radians(tilt))), 0.0, float(np.cos(np.radians(tilt))))


HOLDER_TILTED = MadePart(
    "holder_tilted_at_wall",
    "holders",
    "A tilted holder against a wall",
    """Two convex bars: the plate and a wall, 25 mm high, 11 mm from the contact. A flat end of radius 5 tilts away from it: its
    heel is before the wall, and its holder of radius 12 is above the wall's edge or before the wall, whichever needs less
    stick-out.""",
    _build,
    _MATERIALS,
    (_LEANT, Tool.flat(10.0, 35.0), Tool.ball(8.0, 22.0, holder=((22.0, 6.0), (34.0, 14.0)))),
    on_lines(((-10, 0), (_FAR, 0)), ((_FAR, 0), (_FAR, _HIGH)), ((_FAR, _HIGH), (_FAR + 8, _HIGH))),
    answers=tuple(
        Answer("least_stickout", _least(t), "min(h cos t - d sin t, ((R + Rh) cos t - d) / sin t)", _LEANT.name, given=along((0, 0, 0), _Z, _away(t)))
        for t in (8.0, 15.0, 25.0)
    ),
)

_STEPS = ((6.0, 8.0), (14.0, 20.0))
_MATERIALS, _build = bars(
    floor=rectangle(-40, _STEPS[0][0], -8, 0), low=rectangle(_STEPS[0][0], _STEPS[1][0], -8, _STEPS[0][1]), high=rectangle(_STEPS[1][0], 30, -8, _STEPS[1][1])
)
_SMALL = Tool.ball(6.0, 24.0, holder=holder(24.0, 10.0), name="ball_D6_holder_D20")
_LARGE = Tool.ball(6.0, 24.0, holder=holder(24.0, 16.0), name="ball_D6_holder_D32")
_CONE = Tool.ball(6.0, 24.0, holder=((24.0, 7.0), (34.0, 16.0)), name="ball_D6_holder_cone")


def _above(low: float, slope: float) -> float:
    """Return the least stick-out (mm) of an upright holder of radius `low`, which grows by `slope` a mm.

    The holder begins above each step that is nearer than its radius; a cone reaches the distance d at `(d - low) / slope` above
    its beginning.
    """
    needs = [h - max((d - low) / slope, 0.0) if slope else h * (d < low) for d, h in _STEPS]
    return float(max(needs))


HOLDER_OVER_STEP = MadePart(
    "holder_over_step",
    "holders",
    "A holder over two steps",
    """Three convex bars side by side: floor, a step of 8 mm at 6 mm from the contact and one of 20 mm at 14 mm. A holder of
    radius 10 has to clear the first, one of radius 16 both; a conical holder clears the second with that part of it which is as
    wide.""",
    _build,
    _MATERIALS,
    (_SMALL, _LARGE, _CONE),
    on_lines(((-10, 0), (6, 0)), ((6, 0), (6, 8)), ((6, 8), (14, 8)), ((14, 8), (14, 20)), ((14, 20), (22, 20))),
    answers=(
        Answer("least_stickout", _above(10.0, 0.0), "the first step's height", _SMALL.name, given=along((0, 0, 0), _Z, _Z)),
        Answer("least_stickout", _above(16.0, 0.0), "the second step's height", _LARGE.name, given=along((0, 0, 0), _Z, _Z)),
        Answer("least_stickout", _above(7.0, 0.9), "max(h1, h2 - (d2 - r) / slope)", _CONE.name, given=along((0, 0, 0), _Z, _Z)),
    ),
)

PARTS = (HOLDER_AT_WALL, HOLDER_TILTED, HOLDER_OVER_STEP)
