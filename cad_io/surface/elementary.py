"""Planes, cylinders, cones, spheres and tori in closed form, in the CAD kernel's parameters.

Each is a frame (origin, X, Y, Z) and `S = O + r(v) (cos u X + sin u Y) + h(v) Z`, a plane `S = O + u X + v Y`.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from cad_io.arrays import Floats

#: r, r', r'', h, h', h'' at v (n,).
Profile = Callable[[Floats], tuple[Floats, Floats, Floats, Floats, Floats, Floats]]


def frame_of(position: Any) -> Floats:
    """Rows O, X, Y, Z (4, 3) of a surface's position in the kernel."""
    directions = (position.XDirection(), position.YDirection(), position.Direction())
    return np.array([position.Location().Coord(), *(d.Coord() for d in directions)])


def plane(frame: Floats, u: Floats, v: Floats, count: int) -> Floats:
    """S, Su, Sv, Suu, Svv, Suv of a plane, the first `count` of them, as (n, count, 3)."""
    out = np.zeros((len(u), count, 3))
    out[:, 0] = frame[0] + u[:, None] * frame[1] + v[:, None] * frame[2]
    if count > 1:
        out[:, 1], out[:, 2] = frame[1], frame[2]
    return out


def revolved(frame: Floats, profile: Profile, u: Floats, v: Floats, count: int) -> Floats:
    """The same of a surface of revolution with a profile (r, h)."""
    out = np.empty((len(u), count, 3))
    cosine, sine = np.cos(u)[:, None], np.sin(u)[:, None]
    outward, along = cosine * frame[1] + sine * frame[2], cosine * frame[2] - sine * frame[1]
    r, r1, r2, h, h1, h2 = (np.broadcast_to(each, v.shape)[:, None] for each in profile(v))
    axis = frame[3]
    out[:, 0] = frame[0] + r * outward + h * axis
    if count > 1:
        out[:, 1], out[:, 2] = r * along, r1 * outward + h1 * axis
    if count > 3:
        out[:, 3], out[:, 4], out[:, 5] = -r * outward, r2 * outward + h2 * axis, r1 * along
    return out


def cylinder(radius: float) -> Profile:
    one, none = np.ones(1), np.zeros(1)
    return lambda v: (radius * one, none, none, v, one, none)


def cone(radius: float, half_angle: float) -> Profile:
    one, none, slope, rise = np.ones(1), np.zeros(1), np.sin(half_angle), np.cos(half_angle)
    return lambda v: (radius + v * slope, slope * one, none, v * rise, rise * one, none)


def torus(major: float, minor: float) -> Profile:
    """A sphere is one whose major radius is zero."""

    def profile(v: Floats) -> tuple[Floats, Floats, Floats, Floats, Floats, Floats]:
        c, s = minor * np.cos(v), minor * np.sin(v)
        return major + c, -s, -c, s, c, -s

    return profile
