"""Near a contact: how far curvature alone keeps the surface from going too deep.

The lemmas are those of `docs/between_samples.md`, "Near the contact: curvature".
"""

import numpy as np

from plan_cutters.kernels.area.zone import distance_of, held_below
from plan_cutters.kernels.jit import kernel

#: Most halvings of a patch that are told apart: how often until it may be served (`codes.NEVER`: none will do).
MOST_HALVINGS = 3
#: Largest turn of the normal (rad) within a patch, and between normals within `extent`: up to it, the surface is a graph over
#: its tangent planes.
MOST_TURN, _STEEPEST = 0.2, 0.5
#: Lemma B5 (arcs): an arc over its chord, and an angle over its chord on the unit sphere, for turns up to 1 rad.
STRETCH = 1.05
#: Lemma B6 (lift): height over the tangent plane within a patch, in K h^2.
LIFT = 0.55
#: Lemma B7 (frames): change of H where its frame turns by `more`, in K more; 3 sec^3(0.5) <= _SECANT _SLOPES, and what is of
#: second order.
_SECANT, _SLOPES, _TURNS = 1.3, 3.5, 2.0
#: Lemma B6 (lift), as far as `extent`: the height over the tangent plane, in K D^2, up to which a triangle may count as near.
_HIGH = 0.6


@kernel
def spared(distance, depth, chord):
    """Return by how much a paraboloid may curve more than the nose within a distance and gouge no deeper than is allowed, 1/mm.

    Lemma B4.
    """
    return 2.0 * max(0.0, depth - chord) / max(distance * distance, 1e-12)


@kernel
def extent(most, last, full, h, pose, flat, psi, turn, nose, depth, chord, near):
    """Find the largest distance up to row `last` within which curvature alone keeps the surface from going too deep.

    Lemmas B3 and B4; B8 where `flat`. B7 bounds what the frames' turns add to curvature.

    Returns its row, -1 if there is none. Writes what `near_by` takes.
    """
    ff, tt, ft, whole, spread, angle, cell = -np.inf, -np.inf, 0.0, 0.0, 0.0, 0.0, 0.0
    held = -1
    for row in range(last + 1):
        distance = h * distance_of(row)
        ff, tt, ft = max(ff, most[row, 0]), max(tt, most[row, 1]), max(ft, most[row, 2])
        whole, spread, angle = max(whole, most[row, 3]), max(spread, most[row, 4]), max(angle, most[row, 5])
        cell = max(cell, most[row, 6])
        if distance > full:
            break
        # Between nodes and between contacts normals turn some more than from node to node.
        more = STRETCH * whole * (h + cell)
        steep = STRETCH * np.sqrt(angle) + more
        if not steep <= _STEEPEST:
            break
        tangent = np.tan(steep)
        extra = _SECANT * whole * more * (_SLOPES * tangent + _TURNS * more)
        less = spared(distance, depth, chord)
        if flat or not nose.offset > 0.0:
            # In whatever direction it is tilted.
            top = 0.5 * (ff + tt) + 0.5 * spread + extra
            if flat:
                if not 0.5 * max(0.0, top) * distance * distance <= depth:
                    break
            elif not held_below(pose, turn, top - less, 0.0, top - less, distance, nose):
                break
            near[2], near[3], near[4] = top, top, 0.0
        else:
            extra += STRETCH * spread * (psi + turn * turn)
            if not held_below(pose, turn, ff + extra - less, ft, tt + extra - less, distance, nose):
                break
            near[2], near[3], near[4] = ff + extra, tt + extra, ft
        near[0], near[1] = distance - h - chord, _HIGH * whole * distance * distance + chord
        held = row
    near[5] = chord + 1e-9
    return held


@kernel
def halvings(most, h, pose, flat, nose, depth, chord, near):
    """How often a patch must be halved until curvature holds right at its contact, as far as the nodes about it now tell."""
    halved = h
    for count in range(1, MOST_HALVINGS):
        halved *= 0.5
        turn = STRETCH * most[0, 3] * halved
        if turn <= MOST_TURN and not too_steep(pose, turn, flat, nose):
            psi = 0.0 if flat or nose.offset == 0.0 else turn / (pose[0] - turn)
            if extent(most, 0, np.inf, halved, pose, flat, psi, turn, nose, depth, chord, near) == 0:
                return count
    return MOST_HALVINGS


@kernel
def too_steep(pose, turn, flat, nose):
    """Whether the normal turns too much within a patch for the tilt: the cutter must be tilted, and touch with the same mode, all
    over it.
    """
    if flat:
        return False
    sine, cosine = pose
    if (nose.offset != 0.0 and sine <= 2.0 * turn) or (nose.offset >= 0.0 and cosine <= 2.0 * turn):
        return True
    tilt = np.arctan2(sine, cosine)
    return (nose.low > 0.0 and tilt - turn < nose.low) or tilt + turn > nose.high
