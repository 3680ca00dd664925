"""Does a triangle stay out of the body at all tilts of a gap? Its polygon has rows (x, z, y) from the contact."""

import numpy as np

from plan_cutters.kernels.jit import kernel
from plan_cutters.kernels.tool.pieces import nearest

#: Triangles that reach no farther along the line of turning, in radii, see the rim as one line.
_FLAT = 0.03
#: Slabs that what lies next to the contact is cut into.
_SLABS = 8


@kernel
def _clip(source, count, target, a, b, level):
    """Keep the part of a polygon of rows (x, z, y) with `a x + b z >= level`."""
    kept = 0
    for i in range(count):
        j = i + 1 if i + 1 < count else 0
        here = a * source[i, 0] + b * source[i, 1] - level
        there = a * source[j, 0] + b * source[j, 1] - level
        if here >= 0.0:
            for k in range(3):
                target[kept, k] = source[i, k]
            kept += 1
        if (here > 0.0 and there < 0.0) or (here < 0.0 and there > 0.0):
            part = here / (here - there)
            for k in range(3):
                target[kept, k] = source[i, k] + part * (source[j, k] - source[i, k])
            kept += 1
    return kept


@kernel
def _side(polygon, count, cosine, sine, radius, shrunk, turned):
    """On which side of the cylinder at a tilt the shadow of a polygon of rows (x, z, y) lies: 1 front, -1 back, 0 neither.

    The front is where the contact is. 2: beside it, out of reach at every tilt. `turned` is scratch.
    """
    least, most = np.inf, -np.inf
    for i in range(count):
        x, z, y = polygon[i, 0], polygon[i, 1], polygon[i, 2]
        turned[i, 0], turned[i, 1], turned[i, 2] = cosine * z + sine * x, cosine * x - sine * z + radius, y
        least, most = min(least, y), max(most, y)
    if least >= shrunk or most <= -shrunk:
        return 2
    _, px, _, square = nearest(turned, count)
    if square < shrunk * shrunk:
        return 0
    return 1 if px >= 0.0 else -1


@kernel
def _rim(y, radius, shrunk):
    """Tangent at y to the rim's distance from the line of turning, as (slope, value at 0): elsewhere the rim is farther."""
    y = max(-0.98 * shrunk, min(0.98 * shrunk, y))
    q = np.sqrt(shrunk * shrunk - y * y)
    slope = y / q
    return slope, radius - q - slope * y


@kernel
def _facing(nx, nz, ca, sa, cb, sb):
    """A direction (x, z), up or down as it may be, turned to where the body is at all tilts of a gap.

    It then leans from the axis to the front or to the back by no more than 90 deg at any of them.
    """
    if sa * nx + ca * nz < 0.0:
        nx, nz = -nx, -nz
    if sa * nx + ca * nz <= 0.0:
        nx, nz = ca, -sa
    if sb * nx + cb * nz <= 0.0:
        nx, nz = -cb, sb
    return nx, nz


@kernel
def _from_plane(nx, nz, c, s, tool):
    """How far along a direction (x, z) the body begins at a tilt: (distance, and to be added for each mm of room at the rim)."""
    up, out = nx * s + nz * c, nz * s - nx * c
    return tool.low * up + 2.0 * tool.radius * min(0.0, out), abs(out)


@kernel
def _plane_passes(corner, ca, sa, cb, sb, tool):
    """Whether a plane, nearly that of the triangle, has it on one side and the body on the other at all tilts of a gap."""
    x0, z0, y0 = corner[0, 0], corner[0, 1], corner[0, 2]
    x1, z1, y1 = corner[1, 0], corner[1, 1], corner[1, 2]
    x2, z2, y2 = corner[2, 0], corner[2, 1], corner[2, 2]
    slope, room = _rim((y0 + y1 + y2) / 3.0, tool.radius, tool.shrunk)
    nx, nz = (y1 - y0) * (z2 - z0) - (z1 - z0) * (y2 - y0), (x1 - x0) * (y2 - y0) - (y1 - y0) * (x2 - x0)
    nx, nz = _facing(nx, nz, ca, sa, cb, sb)
    h0, h1, h2 = nx * x0 + nz * z0, nx * x1 + nz * z1, nx * x2 + nz * z2
    for c, s in ((ca, sa), (cb, sb)):
        begins, share = _from_plane(nx, nz, c, s, tool)
        d = share * slope
        if max(h0 - d * y0, max(h1 - d * y1, h2 - d * y2)) > begins + share * room:
            return False
    return True


@kernel
def _never(polygon, count, radius, shrunk):
    """Whether a polygon of rows (x, z, y) is out of reach at every tilt.

    So near the line of turning that the disk, which touches that line at the contact, has curved away. The room grows with
    the square of y: its tangent bounds it from below, and what is left of it is least at a corner.
    """
    low, high, middle = np.inf, -np.inf, 0.0
    for i in range(count):
        x, z, y = polygon[i, 0], polygon[i, 1], polygon[i, 2]
        low, high, middle = min(low, y), max(high, y), middle + y / count
        square = shrunk * shrunk - y * y
        if square > 0.0:
            room = radius - np.sqrt(square)
            if x * x + z * z > room * room:
                return False
    pieces = 1 if high - low < 0.1 * shrunk else _SLABS
    wide = (high - low) / pieces
    for piece in range(pieces):
        at = low + piece * wide
        slope, room = _rim(middle if pieces == 1 else at + 0.5 * wide, radius, shrunk)
        for i in range(count):
            j = i + 1 if i + 1 < count else 0
            yi, yj = polygon[i, 2], polygon[j, 2]
            if max(yi, yj) < at or min(yi, yj) > at + wide:
                continue
            first, last = 0.0, 1.0
            if pieces > 1 and yi != yj:
                u, v = (at - yi) / (yj - yi), (at + wide - yi) / (yj - yi)
                first, last = max(0.0, min(u, v)), min(1.0, max(u, v))
            for part in (first, last):
                x = polygon[i, 0] + part * (polygon[j, 0] - polygon[i, 0])
                z = polygon[i, 1] + part * (polygon[j, 1] - polygon[i, 1])
                gone = slope * (yi + part * (yj - yi)) + room
                if gone < 0.0 or x * x + z * z > gone * gone:
                    return False
    return True


@kernel
def _parts_pass(polygon, count, ca, sa, cb, sb, tool):
    """`_boxes_pass` for a polygon, in two parts where need be: what the bottom sweeps over, and what it stays below."""
    radius, shrunk, low, high, _ = tool
    middle = 0.0
    for k in range(count):
        middle += polygon[k, 2]
    slope, room = _rim(middle / count, radius, shrunk)
    upper, lower, under, never, behind, top = -np.inf, -np.inf, -np.inf, True, np.inf, True
    k = count - 1
    x, z, y = polygon[k, 0], polygon[k, 1], polygon[k, 2]
    last, last_front = cb * z + sb * x, sb * z - cb * x - slope * y - room
    for k in range(count):
        before_x, before_z, before_y = x, z, y
        x, z, y = polygon[k, 0], polygon[k, 1], polygon[k, 2]
        height, front = cb * z + sb * x, sb * z - cb * x - slope * y - room
        below = max(z - sa * (slope * y + room) - ca * low, z - sb * (slope * y + room) - cb * low)
        behind = min(behind, sa * z - ca * x + slope * y)
        top = top and height >= high
        if height >= 0.0:
            upper = max(upper, front)
        if height <= 0.0:
            lower = max(lower, below)
            gone = slope * y + room
            never = never and gone >= 0.0 and x * x + z * z <= gone * gone
        if (height > 0.0 and last < 0.0) or (height < 0.0 and last > 0.0):
            # Where the side of the polygon crosses from one part to the other.
            part = last / (last - height)
            cx, cz = before_x + part * (x - before_x), before_z + part * (z - before_z)
            cy = before_y + part * (y - before_y)
            upper = max(upper, last_front + part * (front - last_front))
            gone = slope * cy + room
            lower = max(lower, max(cz - sa * gone - ca * low, cz - sb * gone - cb * low))
            never = never and gone >= 0.0 and cx * cx + cz * cz <= gone * gone
        under = max(under, below)
        last, last_front = height, front
    if top or under <= 0.0 or behind >= 2.0 * radius - room:
        return True
    return upper <= 0.0 and (lower <= 0.0 or never)


@kernel
def _passes(corner, cf, sf, cl, sl, tool, first, second):
    """Whether a triangle, rows (x, z, y) from the contact, stays out of the body at all tilts of a gap.

    With growing tilt a point of the part turns about the contact down and back in the tool's frame. So one that is
    below the bottom or behind the body where the gap begins stays so; one that is in front of it, and no lower than the
    contact, or above its top where the gap ends was so before. Each point must be one of these; the rest of the triangle
    is cut off in turn.
    """
    radius, shrunk, low, high, _ = tool
    if _plane_passes(corner, cf, sf, cl, sl, tool):
        return True
    count = _clip(corner, 3, first, sf, cf, low * min(1.0, cf * min(cf + sf, cl + sl)))
    if count == 0 or _parts_pass(first, count, cf, sf, cl, sl, tool):
        return True
    least, most = np.inf, -np.inf
    for k in range(count):
        least, most = min(least, first[k, 2]), max(most, first[k, 2])
    if most - least < _FLAT * radius:
        return False
    # Too large for one tangent to the rim.
    lower = _clip(first, count, second, -sl, -cl, 0.0)
    if lower == 0 or _never(second, lower, radius, shrunk):
        upper = _clip(first, count, second, sl, cl, 0.0)
        upper = _clip(second, upper, first, -sl, -cl, -high)
        return upper == 0 or _side(first, upper, cl, sl, radius, shrunk, second) > 0
    side = _side(first, count, cf, sf, radius, shrunk, second)
    return side == -1 or side == 2
