"""Compute ranges of tilt in closed form: those that an obstacle point forbids, and that a local gouge or an axis limit leaves."""

import numpy as np

from plan_cutters.kernels.jit import kernel

#: A bound this close to zero is zero: planes and ridges are free at tilt 0.
ROUNDING = 1e-9

#: No arc: empty, and beyond every tilt both ways, so that widening it about a tilt gives that tilt's neighbourhood.
NOTHING = (9.0, -9.0)

#: Cosines this close to an axis limit are on it: a limit of 0 deg leaves the setup axis itself, which rounding moves.
#: 1e-6 rad at that limit, less at any other.
ON_LIMIT = 5e-13


@kernel
def point_arc(height, px, py, tilt, radius_offset, radius, low, high):
    """Tilts at which an obstacle point lies in the cylinder, the rotation held.

    Turning the tool about the line through P along y_T keeps the point's distance d from P across that line and
    shifts its polar angle `alpha` about P, counted from the direction P -> bottom centre towards the spindle. The
    point is inside while `|d cos(alpha) - offset| < sqrt(radius^2 - py^2)` and `low < d sin(alpha) < high`.

    Parameters
    ----------
    height, px, py : float
        The point at `tilt`: height along the axis from P, x and y from the cylinder's axis, mm.
    tilt : float
        rad.
    radius_offset, radius, low, high : float
        Distance of the axis from P, radius, solid heights; `low >= 0`, `radius <= radius_offset`, mm. A body without
        volume (`radius <= 0` or `low >= high`) forbids nothing.

    Returns
    -------
    first, last : float
        The forbidden tilts, rad; `NOTHING` if there are none. One arc suffices: with the radius no larger than
        the offset, alpha stays within 0 to 90 deg, where the top cuts off one end only.
    """
    square = radius * radius - py * py
    if square <= 0.0 or radius <= 0.0 or low >= high:
        return NOTHING
    r = np.sqrt(square)
    back = radius_offset - px
    d = np.sqrt(back * back + height * height)
    if d <= low or d <= radius_offset - r:
        return NOTHING
    alpha = np.arctan2(height, back)
    least = np.arcsin(low / d)
    most = np.arccos((radius_offset - r) / d)
    if d > radius_offset + r:
        least = max(least, np.arccos((radius_offset + r) / d))
    if d > high:
        most = min(most, np.arcsin(high / d))
    if least > most:
        return NOTHING
    return tilt + alpha - most, tilt + alpha - least


@kernel
def local_gouge(kappa_max, kappa_min, cosine, sine, offset, radius):
    """Tilts without local gouging at a rotation, from and to, rad; nan if there are none.

    A tool that touches with a centre of curvature `offset` from its axis and a radius of curvature there, mm, curves by 1 /
    radius along the tilt direction and by sin(tilt) / (offset + radius sin(tilt)) across it; the surface may nowhere curve more.
    With a negative offset, a barrel, that is an upper bound of the tilt; the tilts beyond 90 deg that it would leave again are
    not given.
    """
    across = kappa_max * sine * sine + kappa_min * cosine * cosine
    if radius > 0.0:
        along = kappa_max * cosine * cosine + kappa_min * sine * sine
        if offset == 0.0:
            return (0.0, np.pi) if radius * kappa_max <= 1.0 + ROUNDING else (np.nan, np.nan)
        mixed = (kappa_max - kappa_min) * sine * cosine
        margin = 1.0 - radius * along
        if margin <= 0.0:
            return np.nan, np.nan
        across += mixed * mixed * radius / margin
        remainder = 1.0 - radius * across
        if offset < 0.0:
            if remainder >= 0.0:
                return 0.0, np.pi
            bound = offset * across / remainder
            return 0.0, np.arcsin(bound) if bound < 1.0 else np.pi
        if remainder <= 0.0:
            return (0.0, np.pi) if across <= 0.0 else (np.nan, np.nan)
        across /= remainder
    bound = offset * across
    if bound <= ROUNDING:
        return 0.0, np.pi
    if bound > 1.0:
        return np.nan, np.nan
    return np.arcsin(bound), np.pi - np.arcsin(bound)


@kernel
def axis_arcs(along_n, along_f, limit_cos, low, high, out):
    """Tilts within [low, high] whose axis stays within a cone about the setup axis m.

    Parameters
    ----------
    along_n, along_f : float
        m . n and m . f.
    limit_cos : float
        Cosine of the cone's half angle; -1 or less: no limit. Kept to `ON_LIMIT`.
    low, high : float
        Range asked for, rad, within 0 to pi/2.
    out : (3, 2) float64
        Written: the intervals, ascending.

    Returns
    -------
    count : int
    """
    if limit_cos <= -1.0:
        out[0, 0], out[0, 1] = low, high
        return 1
    limit_cos -= ON_LIMIT
    amplitude = np.hypot(along_n, along_f)
    if amplitude <= abs(limit_cos):
        # m is nearly across the great circle: all of it within the cone or none.
        if limit_cos <= 0.0:
            out[0, 0], out[0, 1] = low, high
            return 1
        return 0
    middle = np.arctan2(along_f, along_n)
    half = np.arccos(limit_cos / amplitude)
    count = 0
    for turn in range(-1, 2):
        first = max(low, middle + 2.0 * np.pi * turn - half)
        last = min(high, middle + 2.0 * np.pi * turn + half)
        if first <= last:
            out[count, 0], out[count, 1] = first, last
            count += 1
    return count
