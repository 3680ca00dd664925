"""A tool that is moved along a surface: how wide a pass is by brute force. It shares no formula with the program."""

import math

import numpy as np


def centre_of_tip(radius, corner, point, normal, axis):
    """The middle of the circle (of radius less corner) on which the corner's balls lie, of a tool that touches a point."""
    rho, inward = radius - corner, normal - (normal @ axis) * axis
    size = np.linalg.norm(inward)
    return point + corner * normal + (rho * inward / size if rho else 0.0)


def heights(radius, corner, middle, axis, feed, across, turns):
    """Height of a tip over places at distances `across` (n,) beside the feed through the origin; inf where it is not."""
    rho, side = radius - corner, np.array([-feed[1], feed[0], 0.0])
    u = np.cross(axis, [0.0, 1.0, 0.0])
    u /= np.linalg.norm(u)
    circle = middle + rho * (np.cos(turns)[:, None] * u + np.sin(turns)[:, None] * np.cross(axis, u))
    if corner == 0.0:
        # Where the circle itself crosses the line.
        along, beside, up = circle[:, :2] @ feed, circle @ side, circle[:, 2]
        k = np.flatnonzero(np.signbit(along[:-1]) != np.signbit(along[1:]))
        part = along[k] / (along[k] - along[k + 1])
        y, z = beside[k] + part * (beside[k + 1] - beside[k]), up[k] + part * (up[k + 1] - up[k])
        found = np.full(len(across), np.inf)
        step = across[1] - across[0]
        inside = (y > across[0]) & (y < across[-1])
        np.minimum.at(found, np.rint((y[inside] - across[0]) / step).astype(int), z[inside])
        return found
    # Each point of the circle carries a ball.
    near = circle[circle[:, 2] < corner + 0.5]
    beside = (near @ side)[:, None] - across
    left = corner**2 - (near[:, :2] @ feed)[:, None] ** 2 - beside**2
    return np.where(left >= 0.0, near[:, 2:] - np.sqrt(np.maximum(left, 0.0)), np.inf).min(axis=0)


def width_left(radius, corner, tilt, form, feed, scallop):
    """Width of the strip that is left within the scallop height by a tool moved in a direction, its axis kept.

    The surface is z = x form x / 2; the width is counted at right angles to the feed through the origin.
    """
    feed = feed / np.linalg.norm(feed)
    side = np.array([-feed[1], feed[0]])
    axis = np.array([math.sin(tilt), 0.0, math.cos(tilt)])
    wide = 2.0 * math.sqrt(2.0 * scallop * radius / max(math.sin(tilt), 0.05))
    across = np.linspace(-wide, wide, 401)
    turns = np.linspace(-math.pi, math.pi, 3001) if corner < radius else np.zeros(1)
    lowest = np.full(len(across), np.inf)
    for step in np.linspace(-1.2, 1.2, 2401 if corner == 0.0 else 121):
        place = step * feed
        normal = np.array([*(-form @ place), 1.0])
        point = np.array([*place, 0.5 * place @ form @ place])
        middle = centre_of_tip(radius, corner, point, normal / np.linalg.norm(normal), axis)
        lowest = np.minimum(lowest, heights(radius, corner, middle, axis, feed, across, turns))
    known = np.flatnonzero(np.isfinite(lowest))
    place = across[:, None] * side
    gap = np.interp(across, across[known], lowest[known]) - 0.5 * np.einsum("ij,jk,ik->i", place, form, place)
    middle, high = len(across) // 2, np.flatnonzero(gap > scallop)
    right, left = high[high > middle][0], high[high < middle][-1]
    return _crossing(across, gap, right, -1, scallop) - _crossing(across, gap, left, 1, scallop)


def _crossing(across, gap, k, inward, scallop):
    part = (gap[k] - scallop) / (gap[k] - gap[k + inward])
    return across[k] + part * (across[k + inward] - across[k])
