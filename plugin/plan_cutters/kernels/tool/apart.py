"""Which pieces of a tool may a box of the tree reach into? The others are parted from it by a slab or a plane.

Bodies and pieces as in `hit`; a box is a row of the tree (`linear.tree`).
"""

import numpy as np

from plan_cutters.kernels.codes import (
    ARC,
    BOTTOM,
    CENTRE,
    CYLINDER,
    DIAGONAL,
    HALVES,
    HIGH,
    KIND,
    LOW,
    RADIUS,
    ROUND,
    SCALE,
    SIDES,
    SLOPE,
    TOP,
)
from plan_cutters.kernels.jit import kernel
from plan_cutters.kernels.tool.pieces import support

#: Where the numbers of a body stand in its row, and how many there are.
P, A, X, Y, OFFSET, HALF, BODY = 0, 3, 6, 9, 12, 13, 14
#: A box is long where it is longer than the tool is wide, and its sides differ so many times.
_LONG = 3.0


@kernel
def half_width(box, i, x, y, z):
    """Half the extent of box i along a unit direction."""
    return (
        box[i, HALVES] * abs(x * box[i, SIDES] + y * box[i, SIDES + 1] + z * box[i, SIDES + 2])
        + box[i, HALVES + 1] * abs(x * box[i, SIDES + 3] + y * box[i, SIDES + 4] + z * box[i, SIDES + 5])
        + box[i, HALVES + 2] * abs(x * box[i, SIDES + 6] + y * box[i, SIDES + 7] + z * box[i, SIDES + 8])
    )


@kernel
def _thin_apart(box, i, body, piece, k, grow, dx, dy, dz):
    """Whether a plane across the box's third side, the thin one, parts it from piece k."""
    mx, my, mz = box[i, SIDES + 6], box[i, SIDES + 7], box[i, SIDES + 8]
    along = mx * body[A] + my * body[A + 1] + mz * body[A + 2]
    side = mx * body[X] + my * body[X + 1] + mz * body[X + 2]
    sideways = mx * body[Y] + my * body[Y + 1] + mz * body[Y + 2]
    apart = mx * dx + my * dy + mz * dz + body[OFFSET] * side
    across = np.sqrt(max(0.0, 1.0 - along * along))
    if piece[k, KIND] == CYLINDER:
        low, high = piece[k, LOW] - grow, piece[k, HIGH] + grow
        apart = abs(apart - 0.5 * (low + high) * along)
        extent = 0.5 * (high - low) * abs(along) + (piece[k, RADIUS] + grow) * across + body[HALF] * abs(sideways)
        return apart > extent + box[i, HALVES + 2] + 1e-9
    if apart < 0.5 * (piece[k, BOTTOM] + piece[k, TOP]) * along:
        apart, along = -apart, -along
    # Widened, a piece with square edges goes as far as in any direction along the axis and across it together.
    extent = support(piece, k, along, across) + grow * (abs(along) + across) + body[HALF] * abs(sideways)
    return apart > extent + box[i, HALVES + 2] + 1e-9


@kernel
def stays(body, piece, k):
    """Whether turning leaves piece k where it is: a whole ball about the line of turning."""
    about = piece[k, KIND] == ARC and piece[k, RADIUS] == 0.0 and piece[k, SLOPE] == 0.0 and body[OFFSET] == 0.0
    return about and piece[k, BOTTOM] == -piece[k, ROUND] and piece[k, TOP] == piece[k, ROUND]


@kernel
def alive(box, i, body, piece, mask, rate):
    """Those of the pieces of a mask into which a point of box i may reach: the others are parted from it by a slab or a plane."""
    dx, dy, dz = box[i, CENTRE] - body[P], box[i, CENTRE + 1] - body[P + 1], box[i, CENTRE + 2] - body[P + 2]
    diagonal = box[i, DIAGONAL]
    widening = 0.0
    height = dx * body[A] + dy * body[A + 1] + dz * body[A + 2]
    across = dx * body[X] + dy * body[X + 1] + dz * body[X + 2]
    if rate > 0.0:
        widening = rate * (np.sqrt(height * height + across * across) + diagonal)
    across += body[OFFSET]
    sideways = dx * body[Y] + dy * body[Y + 1] + dz * body[Y + 2]
    sideways -= min(body[HALF], max(-body[HALF], sideways))
    square = across * across + sideways * sideways
    extent = -1.0
    for k in range(len(piece)):
        if not (mask >> k) & 1:
            continue
        gone = 1 << k
        grow = 0.0 if widening > 0.0 and stays(body, piece, k) else widening
        low, high = piece[k, BOTTOM] - grow, piece[k, TOP] + grow
        if height + diagonal < low or height - diagonal > high:
            mask ^= gone
            continue
        if height < low or height > high:
            if extent < 0.0:
                extent = half_width(box, i, body[A], body[A + 1], body[A + 2])
            if height + extent < low or height - extent > high:
                mask ^= gone
                continue
        if piece[k, KIND] == CYLINDER:
            radius = piece[k, RADIUS] + grow
            if square > radius * radius:
                if square > (radius + diagonal) * (radius + diagonal):
                    mask ^= gone
                    continue
                distance = np.sqrt(square)
                ux, uy = across / distance, sideways / distance
                wide = half_width(
                    box, i, ux * body[X] + uy * body[Y], ux * body[X + 1] + uy * body[Y + 1], ux * body[X + 2] + uy * body[Y + 2]
                )
                if distance - wide > radius:
                    mask ^= gone
                    continue
        elif _beyond(box, i, body, piece, k, grow, height, across, sideways, square):
            mask ^= gone
            continue
        if _thin_apart(box, i, body, piece, k, grow, dx, dy, dz):
            mask ^= gone
    if mask == 0 or diagonal < piece[0, RADIUS] + piece[0, ROUND] or rate > 0.0 or body[HALF] > 0.0:
        return mask
    return _passed(box, i, body, piece, mask, height, across, sideways)


@kernel
def _passed(box, i, body, piece, mask, height, across, sideways):
    """Those of the pieces of a mask that no plane parts from a box i if that is long; with its centre in the tool's frame.

    The box of long thin triangles may pass by a tool though its centre is far away: seen from there nothing parts them. So the
    plane is taken where the middle line along the box comes nearest to the piece.
    """
    long = 0 if box[i, HALVES] >= box[i, HALVES + 1] else 1
    half, at = box[i, HALVES + long], SIDES + 3 * long
    if half < _LONG * box[i, HALVES + 1 - long]:
        return mask
    sx, sy, sz = box[i, at], box[i, at + 1], box[i, at + 2]
    up = sx * body[A] + sy * body[A + 1] + sz * body[A + 2]
    side = sx * body[X] + sy * body[X + 1] + sz * body[X + 2]
    out = sx * body[Y] + sy * body[Y + 1] + sz * body[Y + 2]
    for k in range(len(piece)):
        if not (mask >> k) & 1:
            continue
        along, square = across * side + sideways * out, side * side + out * out
        if piece[k, KIND] == ARC:
            along, square = along + (height - piece[k, SLOPE]) * up, 1.0
        t = min(half, max(-half, -along / square)) if square > 1e-12 else 0.0
        x, y, z = across + t * side, sideways + t * out, height + t * up
        q = np.sqrt(x * x + y * y)
        if not q > 0.0:
            continue
        over, out_of, up_of = _tangent(piece, k, z, q)
        ux, uy = out_of * x / q, out_of * y / q
        # At the centre, and about it.
        over -= t * (ux * side + uy * out + up_of * up)
        if over > 0.0 and over > _half_width_there(box, i, body, up_of, ux, uy):
            mask ^= 1 << k
    return mask


@kernel
def _tangent(piece, k, height, q):
    """How far a point is out of piece k beside its ends, and how that grows across the axis and along it.

    It is convex: anywhere no less than this tangent. Within an arc no growth is told.
    """
    if piece[k, KIND] == CYLINDER:
        return q - piece[k, RADIUS], 1.0, 0.0
    if piece[k, KIND] == ARC:
        r, away = max(0.0, q - piece[k, RADIUS]), height - piece[k, SLOPE]
        value = np.sqrt(r * r + away * away)
        if value <= piece[k, ROUND]:
            return value - piece[k, ROUND], 0.0, 0.0
        return value - piece[k, ROUND], r / value, away / value
    over = (q - piece[k, RADIUS] - piece[k, SLOPE] * (height - piece[k, LOW])) * piece[k, SCALE]
    return over, piece[k, SCALE], -piece[k, SLOPE] * piece[k, SCALE]


@kernel
def _half_width_there(box, i, body, up, x, y):
    """`half_width` along a direction in the frame of a tool."""
    return half_width(
        box,
        i,
        up * body[A] + x * body[X] + y * body[Y],
        up * body[A + 1] + x * body[X + 1] + y * body[Y + 1],
        up * body[A + 2] + x * body[X + 2] + y * body[Y + 2],
    )


@kernel
def _beyond(box, i, body, piece, k, grow, height, across, sideways, square):
    """Whether box i lies beyond a cone or an arc, by the tangent at the box's centre."""
    q = np.sqrt(square)
    over, out, up = _tangent(piece, k, height, q)
    over -= grow
    if over <= 0.0:
        return False
    if over > box[i, DIAGONAL]:
        return True
    ux, uy = 1.0, 0.0
    if q > 0.0:
        ux, uy = out * across / q, out * sideways / q
    elif out > 0.0:
        # On the axis a cone has no tangent but its own height's.
        return False
    return over > _half_width_there(box, i, body, up, ux, uy)
