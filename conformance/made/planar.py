"""Tilts at which a tool meets edges and planes across its tilt: the closed forms that parts of planes share.

All is in the plane of the tilt. The contact is the origin, `h` runs along the normal, `d` along the direction that the axis
tilts to: the axis is `(sin t, cos t)`. Corners are edges of material across this plane, seen as points `(d, h)`; on both sides
of the plane a round tool is narrower, so what happens in the plane decides. Angles are degrees.

A ball end of radius R has its centre at `(0, R)`, whatever the tilt: its side is a strip of half-width R about the ray from
there along the axis. A flat end stands on the edge of its disk: `x_T = (cos t, -sin t)` goes from the middle of the disk to the
contact, so the front side is the ray from the contact along the axis, and the heel, the other end of the disk, is at `2 R (-cos
t, sin t)`.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from conformance.tool import Tool, Vertex

Corner = tuple[float, float]
Vector = tuple[float, float, float]


def ball_until(corner: Corner, radius: float) -> float:
    """Return the tilt at which the side of a ball end comes to a corner before it.

    The corner's distance from the ray is `d cos t - (h - R) sin t = p cos(t + f)`, `p = hypot(d, h - R)`, `f = atan2(h - R,
    d)`; it is R at `t = acos(R / p) - f`.
    """
    d, h = corner
    return float(np.degrees(np.arccos(radius / np.hypot(d, h - radius)) - np.arctan2(h - radius, d)))


def ball_from(corner: Corner, radius: float) -> float:
    """Return the tilt from which the side of a ball end passes a corner behind it.

    The distance is `(h - R) sin t - d cos t = p sin(t - f)`, `f = atan2(d, h - R)`; it is R at `t = f + asin(R / p)`.
    """
    d, h = corner
    return float(np.degrees(np.arctan2(d, h - radius) + np.arcsin(radius / np.hypot(d, h - radius))))


def ball_end_until(distance: float, radius: float, length: float) -> float:
    """Return the tilt at which the upper end of a ball end, or of its shank, comes to a plane `d = distance` that is higher
    than the tool.

    The end's far corner is at `d = A sin t + R cos t`, `A = length - R`, so `t = atan2(A, R) - acos(distance / hypot(A, R))`.
    """
    return end_until(distance, length - radius, radius)


def end_until(distance: float, along: float, radius: float) -> float:
    """Return the tilt at which a disk `along` the axis from the ball's centre comes to a plane `d = distance`."""
    return float(np.degrees(np.arctan2(along, radius) - np.arccos(distance / np.hypot(along, radius))))


def ball_end_from(height: float, radius: float, length: float) -> float:
    """Return the tilt from which the upper end of a ball end stays below a plane `h = height` opposite the contact.

    The end's highest corner is at `h = R + A cos t + R sin t`, so `t = atan2(R, A) + acos((height - R) / hypot(A, R))`.
    """
    along = length - radius
    return float(np.degrees(np.arctan2(radius, along) + np.arccos((height - radius) / np.hypot(along, radius))))


def flat_until(corner: Corner) -> float:
    """Return the tilt at which the front side of a flat end comes to a corner before it: the ray from the contact goes through
    the corner."""
    return float(np.degrees(np.arctan2(corner[0], corner[1])))


def flat_from(corner: Corner, radius: float) -> float:
    """Return the tilt from which the back of a flat end passes a corner behind it.

    The corner's distance from the front side is `h sin t - d cos t = p sin(t - f)`; it is the diameter at `t = f + asin(2 R /
    p)`.
    """
    d, h = corner
    return float(np.degrees(np.arctan2(d, h) + np.arcsin(2.0 * radius / np.hypot(d, h))))


def heel_from(corner: Corner, radius: float, nose: float = 0.0) -> float:
    """Return the tilt from which the heel of a flat end or bull nose is clear of a wall behind it, at distance `d`, of height
    `h`.

    The heel reaches back to `2 r cos t + nose`, `r` the flat's radius: clear of the wall from `acos((d - nose) / (2 r))`. A
    flat end whose disk passes above the wall's corner is clear as well, from `atan2(h, d)`.
    """
    flat = radius - nose
    before = float(np.degrees(np.arccos((corner[0] - nose) / (2.0 * flat)))) if corner[0] - nose < 2.0 * flat else 0.0
    return min(before, float(np.degrees(np.arctan2(corner[1], corner[0])))) if nose == 0 else before


def holder(stickout: float, radius: float, height: float = 10.0) -> tuple[Vertex, ...]:
    """Return the outline of a round holder that begins at `stickout` above the tip."""
    return ((stickout, radius), (stickout + height, radius))


def at(contact: Vector, normal: Vector, tilts_to: Vector) -> dict[str, list[float]]:
    """Return what a question about tilts states: contact, normal and the direction that the axis tilts to, as a unit vector."""
    return {"contact": [float(x) for x in contact], "normal": unit(normal), "lean": unit(tilts_to)}


def along(contact: Vector, normal: Vector, axis: Vector, ball: Tool | None = None) -> dict[str, Any]:
    """Return what a question about a fixed axis states; with a ball end as long as `ball`, what one about its largest radius does."""
    end = {} if ball is None else {"end": "ball", "length": ball.length}
    return {"contact": [float(x) for x in contact], "normal": unit(normal), "axis": unit(axis), **end}


def unit(v: Sequence[float]) -> list[float]:
    """Return a direction of length 1, as a list."""
    return [float(x) for x in np.array(v, float) / np.linalg.norm(v)]
