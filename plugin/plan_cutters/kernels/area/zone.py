"""How the surface around a contact is held below a paraboloid: bounds of curvature over the nodes of its face's grid.

Near a contact curvature alone keeps the surface from going too deep (`extent`): the lemmas are those of
`docs/between_samples.md`, "Near the contact: curvature".
"""

from collections import namedtuple
from typing import NamedTuple

import numpy as np

from plan_cutters.kernels.jit import kernel, maker

#: Distances tried for `extent`, and the largest of them in patch radii.
EXTENTS, FARTHEST = 17, 10.0
#: Grid lines looked at on each side of a contact.
_MOST_LINES = 40


class Nose(NamedTuple):
    """This record describes the part of a cutter that is compared with the surface around its contact."""

    offset: float  #: Of its centre of curvature from the axis, mm; negative, as of a barrel: it is a ball alone.
    radius: float  #: Of curvature there, mm.
    #: `widen_cos`, `widen_sin`: of the angle by which it widens along the axis, where it goes on without end.
    widen_cos: float
    widen_sin: float
    #: `low`, `high`: the first and the last tilt at which it touches, rad.
    low: float
    high: float


#: A face's grid: index (nu, nv) int32 into the rows of `about`, -1 outside the trim; closed (2,) bool.
#: about (k, 16): point (3) and normal (3) of a node; its curvature tensor's elements xx, xy, xz, yy, yz, zz; then how far the
#: tensor may differ in the node's cell, 1/mm; the radius of that cell, mm; and the most that a principal curvature, and the
#: difference of two, may be in it, 1/mm. nan where these are not known.
Nodes = namedtuple("Nodes", "index closed about")


@kernel
def near_by(vertex, triangle_face, i, frame, face, near):
    """Whether triangle i is part of the surface that the contact lies on, and bent no more than was believed.

    `near` holds the distance up to which, the largest height over the tangent plane, the bounds of curvature along f,
    along t and mixed, and the chord error.
    """
    p, n, f, t = frame
    if triangle_face[i] != face:
        return False
    for corner in range(3):
        dx, dy, dz = vertex[i, corner, 0] - p[0], vertex[i, corner, 1] - p[1], vertex[i, corner, 2] - p[2]
        height = dx * n[0] + dy * n[1] + dz * n[2]
        if not (dx * dx + dy * dy + dz * dz <= near[0] * near[0] and abs(height) <= near[1]):
            return False
        x, y = dx * f[0] + dy * f[1] + dz * f[2], dx * t[0] + dy * t[1] + dz * t[2]
        if not height <= 0.5 * (near[2] * x * x + near[3] * y * y) + near[4] * abs(x * y) + near[5]:
            return False
    v = vertex[i]
    ax, ay, az = v[1, 0] - v[0, 0], v[1, 1] - v[0, 1], v[1, 2] - v[0, 2]
    bx, by, bz = v[2, 0] - v[0, 0], v[2, 1] - v[0, 1], v[2, 2] - v[0, 2]
    x, y, z = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
    up = x * n[0] + y * n[1] + z * n[2]
    return up * up >= 0.25 * (x * x + y * y + z * z)


@kernel
def held_below(pose, turn, k_ff, k_ft, k_tt, extent, nose):
    """Whether the paraboloid with these curvatures stays below the nose of a cutter within `extent` of the contact.

    At every tilt within `turn` of that of `pose`, its sine and cosine: lemma B3 of `docs/between_samples.md`. The surface offset
    by the nose's radius stays below the same nose of no radius (B9).
    """
    sine, cosine = pose
    offset, radius, widen_cos, widen_sin = max(0.0, nose.offset), nose.radius, nose.widen_cos, nose.widen_sin
    least, extent = sine - turn, extent + radius
    # How far a line of the side is tilted from the normal at most.
    side_sin, side_cos = sine * widen_cos + cosine * widen_sin + turn, cosine * widen_cos - sine * widen_sin - turn
    margin = np.inf
    if offset > 0.0:
        margin = least / (offset + radius * least) - k_tt
    elif radius * k_tt < 1.0:
        margin = max(1.0, abs(k_tt))
        if radius > 0.0:
            margin = 1.0 / radius - k_tt
    if not 0.0 < margin < np.inf:
        return False
    for share in (0.5, 0.25, 0.75, 0.1):
        mix = share * margin
        if offset == 0.0 and k_ft == 0.0:
            mix = 0.0
        along, across = max(0.0, k_ff + (k_ft * k_ft / mix if mix > 0.0 else 0.0)), max(0.0, k_tt + mix)
        if not (radius * along < 1.0 and radius * across < 1.0):
            continue
        along, across = along / (1.0 - radius * along), across / (1.0 - radius * across)
        remainder = least - offset * across
        if offset > 0.0 and not remainder >= 0.5 * along * extent * (cosine + turn):
            continue
        if nose.offset < 0.0 or side_cos >= 0.5 * (along * extent * side_sin + across * widen_sin * (extent + offset)):
            return True
    return False


#: It holds what was found out about the surface around a contact.
#: most (EXTENTS, 7): row k holds, over the nodes whose cells come within distance k of any contact of the patch, but not within
#: distance k - 1: the largest normal curvature along f and t, the largest mixed term, the largest curvature and spread of
#: curvatures, the largest square of the distance between the nodes' normals and n, and the largest radius of a cell. lines (4,)
#: int: grid lines looked at before and after the home node, along u and along v. nearest (4,): how far from the patch the nodes
#: on the outermost of them are at least. gap (4,) bool: some of these lie outside the trim. looked (1,) int: nodes looked at
#: since this record was made.
Seen = namedtuple("Seen", "most lines nearest gap looked")


@maker
def seen():
    """Make a record for it."""
    return Seen(np.empty((EXTENTS, 7)), np.empty(4, np.int64), np.empty(4), np.empty(4, np.bool_), np.zeros(1, np.int64))


@kernel
def distance_of(k):
    """Distance of row k, in patch radii."""
    return 2.0 + (FARTHEST - 2.0) * (k / (EXTENTS - 1)) ** 2


@kernel
def _line(frame, h, nodes, axis, line, first, last, most):
    """Enter the nodes of a piece of a grid line into their rows.

    Returns how far the nearest of them, the first and the last are from the patch, inf where there is no node, and whether one
    lies outside the trim; nan if a node in row 0 has no curvature.
    """
    p, n, f, t = frame
    index, about = nodes.index, nodes.about
    length, closed = index.shape[1 - axis], nodes.closed[1 - axis]
    p0, p1, p2, n0, n1, n2 = p[0], p[1], p[2], n[0], n[1], n[2]
    f0, f1, f2, t0, t1, t2 = f[0], f[1], f[2], t[0], t[1], t[2]
    scale, shift = 1.0 / (h * (FARTHEST - 2.0)), 2.0 / (FARTHEST - 2.0)
    nearest, ends, gap = np.inf, (np.inf, np.inf), False
    for step in range(first, last + 1):
        across = step
        if across < 0 or across >= length:
            if not closed:
                continue
            across %= length
        node = index[line, across] if axis == 0 else index[across, line]
        away = np.inf
        if node < 0:
            gap = True
        else:
            k = about[node]
            dx, dy, dz = k[0] - p0, k[1] - p1, k[2] - p2
            # The node's cell against a disk about any contact of the patch.
            away = np.sqrt(dx * dx + dy * dy + dz * dz) - h
            if k[13] >= 0.0:
                away -= k[13]
            nearest = min(nearest, away)
        if step == first:
            ends = (away, ends[1])
        if step == last:
            ends = (ends[0], away)
        x = away * scale - shift
        if not x <= 1.0:
            continue
        k = about[node]
        row = 0 if x <= 0.0 else min(EXTENTS - 1, int(np.ceil(np.sqrt(x) * (EXTENTS - 1))))
        m0, m1, m2 = k[3], k[4], k[5]
        upright = m0 * n0 + m1 * n1 + m2 * n2
        # Nothing here is a number if something of the node is not known.
        if not upright >= 0.5 or not k[12] + k[13] >= 0.0:
            if row == 0:
                return np.nan, np.nan, np.nan, True
            most[row, 3] = np.inf
            continue
        # Second derivatives there of the surface as a graph over the tangent plane at the contact: f and t are lifted to the
        # node's own tangent plane.
        share = 1.0 / upright
        lift = -share * (m0 * f0 + m1 * f1 + m2 * f2)
        x, y, z = f0 + lift * n0, f1 + lift * n1, f2 + lift * n2
        lift = -share * (m0 * t0 + m1 * t1 + m2 * t2)
        u, v, w = t0 + lift * n0, t1 + lift * n1, t2 + lift * n2
        kx = k[6] * x + k[7] * y + k[8] * z
        ky = k[7] * x + k[9] * y + k[10] * z
        kz = k[8] * x + k[10] * y + k[11] * z
        tt = u * u * k[6] + v * v * k[9] + w * w * k[11] + 2.0 * (u * v * k[7] + u * w * k[8] + v * w * k[10])
        most[row, 0] = max(most[row, 0], share * (x * kx + y * ky + z * kz) + k[12])
        most[row, 1] = max(most[row, 1], share * tt + k[12])
        most[row, 2] = max(most[row, 2], share * abs(u * kx + v * ky + w * kz))
        most[row, 3] = max(most[row, 3], k[14])
        most[row, 4] = max(most[row, 4], k[15])
        most[row, 5] = max(most[row, 5], (m0 - n0) ** 2 + (m1 - n1) ** 2 + (m2 - n2) ** 2)
        most[row, 6] = max(most[row, 6], k[13])
    return nearest, ends[0], ends[1], gap


@kernel
def begin(frame, h, home, nodes, out):
    """Look at the home node alone; False if it has no curvature."""
    for k in range(EXTENTS):
        out.most[k, 0], out.most[k, 1] = -np.inf, -np.inf
        for c in range(2, 7):
            out.most[k, c] = 0.0
    nearest, _, _, gap = _line(frame, h, nodes, 0, home[0] + 0, home[1] + 0, home[1] + 0, out.most)
    for side in range(4):
        out.lines[side], out.nearest[side], out.gap[side] = 0, nearest, False
    return not (gap or np.isnan(nearest))


@kernel
def _outer(frame, h, home, nodes, out, side):
    """Look at one more line on a side; False if a node in row 0 has no curvature."""
    lines, axis, other = out.lines, side // 2, 1 - side // 2
    length, closed = nodes.index.shape[axis], nodes.closed[axis]
    out.nearest[side], out.gap[side] = np.inf, False
    if closed and lines[2 * axis] + lines[2 * axis + 1] + 1 >= length:
        return True
    lines[side] += 1
    line = home[axis] + (lines[side] if side % 2 else -lines[side])
    if line < 0 or line >= length:
        if not closed:
            return True
        line %= length
    low, high = 2 * other, 2 * other + 1
    out.looked[0] += lines[low] + lines[high] + 1
    nearest, first, last, gap = _line(frame, h, nodes, axis, line, home[other] - lines[low], home[other] + lines[high], out.most)
    out.nearest[side], out.gap[side] = nearest, gap
    # The ends of the line lie on the sides beside it, too.
    out.nearest[low], out.nearest[high] = min(out.nearest[low], first), min(out.nearest[high], last)
    out.gap[low], out.gap[high] = out.gap[low] or (gap and first == np.inf), out.gap[high] or (gap and last == np.inf)
    return not np.isnan(nearest)


@kernel
def look_round(frame, h, home, nodes, out, upto):
    """Look at the nodes around a contact until all within a distance of its patch are seen.

    The rectangle of grid lines about the home node grows on each side until all of that side is farther away, so that what lies
    outside is farther, too. Where a side has nodes outside the trim there may be more of the face behind them: there it grows as
    far as any other side does.

    Returns the distance up to which all nodes were looked at, inf if `upto` was reached; -1 if a node in row 0 has no curvature.
    """
    full = np.inf
    while True:
        longest = max(max(out.lines[0], out.lines[1]), max(out.lines[2], out.lines[3]))
        grown = False
        for side in range(4):
            if out.nearest[side] > upto and not (out.gap[side] and out.lines[side] < longest):
                continue
            if out.lines[side] >= _MOST_LINES:
                full = min(full, out.nearest[side])
                out.nearest[side], out.gap[side] = np.inf, False
            elif not _outer(frame, h, home, nodes, out, side):
                return -1.0
            grown = True
        if not grown:
            return full


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
    """Return by how much a paraboloid may curve more than the nose within a distance and gouge within limits (lemma B4)."""
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
    """Whether the normal turns too much within a patch for the cutter to be tilted, and touch in the same mode, all over it."""
    if flat:
        return False
    sine, cosine = pose
    if (nose.offset != 0.0 and sine <= 2.0 * turn) or (nose.offset >= 0.0 and cosine <= 2.0 * turn):
        return True
    tilt = np.arctan2(sine, cosine)
    return (nose.low > 0.0 and tilt - turn < nose.low) or tilt + turn > nose.high
