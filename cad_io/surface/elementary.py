"""Planes, cylinders, cones, spheres and tori in closed form, in the CAD kernel's parameters, and how they bend over cells.

Each is a frame (origin, X, Y, Z) and `S = O + r(v) (cos u X + sin u Y) + h(v) Z`, a plane `S = O + u X + v Y`.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from cad_io.arrays import Floats


class Bends(NamedTuple):
    """Bounds over a grid of cells.

    middle (a, b, 3, 3): Suu, Svv, Suv, none of which differs from its middle by more than spread (a, b, 3) anywhere in the
    cell. first (a, b, 2): neither Su nor Sv is longer.
    """

    middle: Floats
    spread: Floats
    first: Floats

    @staticmethod
    def none(u: Floats, v: Floats) -> "Bends":
        """Room for the cells between lines."""
        shape = len(u) - 1, len(v) - 1
        return Bends(np.zeros((*shape, 3, 3)), np.zeros((*shape, 3)), np.zeros((*shape, 2)))


class Limits(NamedTuple):
    """Bounds of a profile C over intervals of v (b,): its distance r from the axis, |C'|, |C''|, and how far C'' may differ
    from its value in the middle; the speed |Sv| once more."""

    reach: Floats
    first: Floats
    second: Floats
    spread: Floats
    speed: Floats


class Profile(NamedTuple):
    """A curve that is turned about an axis: r, r', r'', h, h', h'' at v (n,), and its limits between lines of v (b + 1,)."""

    at: Callable[[Floats], tuple[Floats, Floats, Floats, Floats, Floats, Floats]]
    limits: Callable[[Floats], Limits]


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
    r, r1, r2, h, h1, h2 = (each[:, None] for each in profile.at(v))
    axis = frame[3]
    out[:, 0] = frame[0] + r * outward + h * axis
    if count > 1:
        out[:, 1], out[:, 2] = r * along, r1 * outward + h1 * axis
    if count > 3:
        out[:, 3], out[:, 4], out[:, 5] = -r * outward, r2 * outward + h2 * axis, r1 * along
    return out


def cylinder(radius: float) -> Profile:
    one, none = np.ones(1), np.zeros(1)
    return Profile(lambda v: (radius * one, none, none, v, one, none), lambda v: _limits(v, radius, 0.0, 0.0, 0.0, 1.0))


def cone(radius: float, half_angle: float) -> Profile:
    one, none, slope, rise = np.ones(1), np.zeros(1), np.sin(half_angle), np.cos(half_angle)

    def limits(v: Floats) -> Limits:
        ends = np.abs(radius + v * slope)
        return _limits(v, np.maximum(ends[1:], ends[:-1]), abs(slope), 0.0, 0.0, 1.0)

    return Profile(lambda v: (radius + v * slope, slope * one, none, v * rise, rise * one, none), limits)


def torus(major: float, minor: float) -> Profile:
    """A sphere is one whose major radius is zero."""

    def at(v: Floats) -> tuple[Floats, Floats, Floats, Floats, Floats, Floats]:
        c, s = minor * np.cos(v), minor * np.sin(v)
        return major + c, -s, -c, s, c, -s

    def limits(v: Floats) -> Limits:
        # The distance changes by no more than the way along the tube, and is never more than both radii.
        reach = np.abs(major + minor * np.cos(0.5 * (v[1:] + v[:-1]))) + 0.5 * minor * np.diff(v)
        return _limits(v, np.minimum(reach, major + minor), minor, minor, 0.5 * minor * np.diff(v), minor)

    return Profile(at, limits)


def _limits(v: Floats, *each: Floats | float) -> Limits:
    return Limits(*(np.broadcast_to(np.asarray(one, float), (len(v) - 1,)) for one in each))


def plane_bends(u: Floats, v: Floats) -> Bends:
    """How a plane bends: not at all."""
    bends = Bends.none(u, v)
    bends.first[:] = 1.0
    return bends


def bends(frame: Floats, profile: Profile, u: Floats, v: Floats) -> Bends:
    """How a surface of revolution bends over the cells between lines of u and v."""
    return turned_bends(lambda s, t, count: revolved(frame, profile, s, t, count), profile.limits(v), u, v)


def turned_bends(evaluate: Callable[[Floats, Floats, int], Floats], limits: Limits, u: Floats, v: Floats) -> Bends:
    """The same from the surface's values and its profile's limits.

    Along u the profile is turned as a whole: a derivative along it turns the vector by a right angle and drops its part
    along the axis, so none is longer than the profile's own.
    """
    bends = Bends.none(u, v)
    s, t = (each.ravel() for each in np.meshgrid(0.5 * (u[1:] + u[:-1]), 0.5 * (v[1:] + v[:-1]), indexing="ij"))
    bends.middle[:] = evaluate(s, t, 6)[:, 3:].reshape(bends.middle.shape)
    half_u, half_v = 0.5 * np.diff(u)[:, None], 0.5 * np.diff(v)[None]
    bends.spread[..., 0] = limits.reach * half_u + limits.first * half_v
    bends.spread[..., 1] = limits.second * half_u + limits.spread
    bends.spread[..., 2] = limits.first * half_u + limits.second * half_v
    bends.first[..., 0], bends.first[..., 1] = limits.reach, limits.speed
    return bends
