"""Find the depth of a point in one convex piece of a tool, its support, and whether a polygon reaches into it.

A piece is a row of `COLUMNS` numbers, as in `codes`, its heights counted from the centre about which
the tool tilts. All kinds are convex functions of (distance from the axis q, height w) below a bound, between two heights: so a
polygon, cut off at the heights, reaches in exactly if the least value over it is below the bound.
"""

import numpy as np

from plan_cutters.kernels.codes import ARC, BOTTOM, CONE, CYLINDER, HIGH, KIND, LOW, RADIUS, ROUND, SCALE, SLOPE, TOP, WIDE
from plan_cutters.kernels.jit import kernel

#: Polygons thinner than this share of their length have no normal.
_NEEDLE = 1e-10
#: A shadow whose area is less than this share of the square of its farthest corner's distance has none.
_FLAT = 1e-13
#: Halvings of a line within which a point well inside a piece is looked for.
_HALVINGS = 6


@kernel
def inset(piece, k, height, square):
    """How deep at least a point at a height, by the square of its distance from the axis, lies in piece k; negative outside."""
    q = np.sqrt(square)
    if piece[k, KIND] == ARC:
        r = max(0.0, q - piece[k, RADIUS])
        away = height - piece[k, SLOPE]
        deep = piece[k, ROUND] - np.sqrt(r * r + away * away)
        return min(deep, min(height - piece[k, LOW], piece[k, HIGH] - height))
    side = piece[k, RADIUS] - q
    if piece[k, KIND] == CONE:
        side = (side + piece[k, SLOPE] * (height - piece[k, LOW])) * piece[k, SCALE]
    return min(min(height - piece[k, LOW], piece[k, HIGH] - height), side)


@kernel
def support(piece, k, along, across):
    """How far a piece goes, from height 0 on the axis, in a unit direction with these parts along the axis and across it.

    Never less than that; exact for cylinders, cones and whole arcs about no farther side.
    """
    if piece[k, KIND] == ARC:
        if piece[k, RADIUS] >= 0.0:
            whole = piece[k, SLOPE] * along + piece[k, RADIUS] * across + piece[k, ROUND]
            if piece[k, BOTTOM] == piece[k, SLOPE] - piece[k, ROUND] and piece[k, TOP] == piece[k, SLOPE] + piece[k, ROUND]:
                return whole
            return min(whole, max(piece[k, BOTTOM] * along, piece[k, TOP] * along) + piece[k, WIDE] * across)
        return max(piece[k, BOTTOM] * along, piece[k, TOP] * along) + piece[k, WIDE] * across
    low, high = max(0.0, piece[k, RADIUS]), max(0.0, piece[k, WIDE])
    return max(piece[k, LOW] * along + low * across, piece[k, HIGH] * along + high * across)


@kernel
def cut(source, count, target, level, keep):
    """Keep the part of a polygon with `keep * (height - level) >= 0` (Sutherland and Hodgman, one side)."""
    written = 0
    for i in range(count):
        j = i + 1 if i + 1 < count else 0
        here, there = keep * (source[i, 0] - level), keep * (source[j, 0] - level)
        if here >= 0.0:
            for k in range(3):
                target[written, k] = source[i, k]
            written += 1
        if (here > 0.0 and there < 0.0) or (here < 0.0 and there > 0.0):
            part = here / (here - there)
            target[written, 0] = level
            for k in range(1, 3):
                target[written, k] = source[i, k] + part * (source[j, k] - source[i, k])
            written += 1
    return written


@kernel
def clipped(corner, count, least, most, low, high, polygon, spare):
    """Cut a polygon off at two heights: (where the rest is: 0 unchanged, 1 in `polygon`, 2 in `spare`; its corners)."""
    where = 0
    if least < low:
        count, where = cut(corner, count, polygon, low, 1.0), 1
    if most > high:
        count, where = cut(corner if where == 0 else polygon, count, spare, high, -1.0), 2
    return where, count


@kernel
def shadow_area(polygon, count):
    """Twice the signed area of a polygon's shadow; 0 where it is rounding, as of a polygon whose plane holds the axis.

    Then the signs of turns say nothing. An axis that goes through such a shadow passes its sides within rounding.
    """
    area, longest = 0.0, 0.0
    for i in range(count):
        j = i + 1 if i + 1 < count else 0
        area += polygon[i, 1] * polygon[j, 2] - polygon[j, 1] * polygon[i, 2]
        longest = max(longest, polygon[i, 1] * polygon[i, 1] + polygon[i, 2] * polygon[i, 2])
    return area if abs(area) > _FLAT * longest else 0.0


@kernel
def nearest(polygon, count):
    """Point of a convex polygon whose shadow is nearest to the axis: (height, x, y, squared distance)."""
    area = shadow_area(polygon, count)
    inside = abs(area) > 0.0
    best, height, px, py = np.inf, polygon[0, 0], polygon[0, 1], polygon[0, 2]
    for i in range(count):
        j = i + 1 if i + 1 < count else 0
        xi, yi = polygon[i, 1], polygon[i, 2]
        ex, ey = polygon[j, 1] - xi, polygon[j, 2] - yi
        if (xi * ey - yi * ex) * area < 0.0:
            inside = False
        square = ex * ex + ey * ey
        part = 0.0
        if square > 0.0:
            part = min(1.0, max(0.0, -(xi * ex + yi * ey) / square))
        x, y = xi + part * ex, yi + part * ey
        distance = x * x + y * y
        if distance < best:
            best, px, py = distance, x, y
            height = polygon[i, 0] + part * (polygon[j, 0] - polygon[i, 0])
    if not inside:
        return height, px, py, best
    # The axis goes through the polygon: find the crossing in the fan of triangles about its first corner.
    hit, at = _on_axis(polygon, count, area)
    if hit:
        return at, 0.0, 0.0, 0.0
    return height, px, py, best


@kernel
def _on_axis(polygon, count, area):
    """Whether the axis goes through a polygon whose shadow has an area of this sign, and at which height."""
    for i in range(1, count - 1):
        a = polygon[i, 1] * polygon[i + 1, 2] - polygon[i + 1, 1] * polygon[i, 2]
        b = polygon[i + 1, 1] * polygon[0, 2] - polygon[0, 1] * polygon[i + 1, 2]
        c = polygon[0, 1] * polygon[i, 2] - polygon[i, 1] * polygon[0, 2]
        if a * area >= 0.0 and b * area >= 0.0 and c * area >= 0.0 and abs(a + b + c) > 0.0:
            return True, (a * polygon[0, 0] + b * polygon[i, 0] + c * polygon[i + 1, 0]) / (a + b + c)
    return False, 0.0


@kernel
def _in_cone(polygon, count, piece, k, grow):
    """Whether a polygon within the heights of a cone, widened by `grow`, reaches into it, and a point that does.

    Over a plane, q - slope w has its least where the axis crosses it or on the polygon's sides; along a side it is least where
    its derivative vanishes.
    """
    slope = piece[k, SLOPE]
    base = piece[k, RADIUS] - slope * piece[k, LOW] + grow / piece[k, SCALE]
    area = shadow_area(polygon, count)
    has_area = abs(area) > 0.0
    for i in range(count):
        j = i + 1 if i + 1 < count else 0
        w, x, y = polygon[i, 0], polygon[i, 1], polygon[i, 2]
        bound = base + slope * w
        if bound > 0.0 and x * x + y * y < bound * bound:
            return True, w, x, y
        ew, ex, ey = polygon[j, 0] - w, polygon[j, 1] - x, polygon[j, 2] - y
        turn = x * ey - y * ex
        if turn * area < 0.0:
            has_area = False
        square, rise = ex * ex + ey * ey, slope * ew
        remainder = square - rise * rise
        if remainder <= 0.0:
            continue
        part = (rise * abs(turn) / np.sqrt(remainder) - (x * ex + y * ey)) / square
        if 0.0 < part < 1.0:
            bound += part * rise
            x, y = x + part * ex, y + part * ey
            if bound > 0.0 and x * x + y * y < bound * bound:
                return True, w + part * ew, x, y
    if has_area:
        hit, w = _on_axis(polygon, count, area)
        if hit and base + slope * w > 0.0:
            return True, w, 0.0, 0.0
    return False, 0.0, 0.0, 0.0


@kernel
def _end_of_side(w, ew, q, along, at_axis, radius):
    """The squared distance from a disk of a side's end, at height `w` and `q` from the axis, and its slope along the side."""
    value, slope, r = w * w, 2.0 * w * ew, q - radius
    if r > 0.0:
        value += r * r
        slope += 2.0 * r * (along / q if q > 0.0 else at_axis)
    return value, slope


@kernel
def _side_in_arc(aw, ax, ay, ew, ex, ey, radius, square):
    """The share along a side, from the centre's height, at which it reaches into an arc; -1 if nowhere. Its ends do not.

    The squared distance is convex along the side: two tangents meet below it, which ends most cases; then false position on
    its derivative. What is not decided to rounding counts as in.
    """
    e2, e1, e0 = ex * ex + ey * ey, ax * ex + ay * ey, ax * ax + ay * ay
    if radius == 0.0:
        all2 = e2 + ew * ew
        part = -(e1 + aw * ew) / all2 if all2 > 0.0 else 0.0
        if not 0.0 < part < 1.0:
            return -1.0
        w, x, y = aw + part * ew, ax + part * ex, ay + part * ey
        return part if w * w + x * x + y * y < square else -1.0
    low, high = 0.0, 1.0
    value_low, slope_low = _end_of_side(aw, ew, np.sqrt(e0), e1, np.sqrt(e2), radius)
    if slope_low >= 0.0:
        return -1.0
    value_high, slope_high = _end_of_side(aw + ew, ew, np.sqrt(max(0.0, e0 + 2.0 * e1 + e2)), e1 + e2, -np.sqrt(e2), radius)
    if slope_high <= 0.0:
        return -1.0
    weight_low, weight_high, last, part = slope_low, slope_high, 0, 0.5
    for _ in range(60):
        part = (value_high - value_low + slope_low * low - slope_high * high) / (slope_low - slope_high)
        if value_low + slope_low * (part - low) >= square:
            return -1.0
        part = low - weight_low * (high - low) / (weight_high - weight_low)
        if not low < part < high:
            part = 0.5 * (low + high)
        q = np.sqrt(max(0.0, e0 + part * (2.0 * e1 + part * e2)))
        w, r = aw + part * ew, q - radius
        value, slope = w * w, 2.0 * w * ew
        if r > 0.0:
            value += r * r
            if q > 0.0:
                slope += 2.0 * r * (e1 + part * e2) / q
        if value < square:
            return part
        if slope < 0.0:
            low, value_low, slope_low, weight_low = part, value, slope, slope
            weight_high *= 0.5 if last == -1 else 1.0
            last = -1
        elif slope > 0.0:
            high, value_high, slope_high, weight_high = part, value, slope, slope
            weight_low *= 0.5 if last == 1 else 1.0
            last = 1
        else:
            return -1.0
        if high - low < 1e-13:
            break
    return part


@kernel
def _holds(polygon, count, w, x, y, nw, nx, ny):
    """Whether a point of the plane of a polygon, of normal (nw, nx, ny), lies in it."""
    for i in range(count):
        j = i + 1 if i + 1 < count else 0
        ew, ex, ey = polygon[j, 0] - polygon[i, 0], polygon[j, 1] - polygon[i, 1], polygon[j, 2] - polygon[i, 2]
        vw, vx, vy = w - polygon[i, 0], x - polygon[i, 1], y - polygon[i, 2]
        if (ey * vw - ew * vy) * nx + (ew * vx - ex * vw) * ny + (ex * vy - ey * vx) * nw < 0.0:
            return False
    return True


@kernel
def _normal_of(polygon, count):
    """A polygon's normal, as long as twice its area, its length, and the square of the longest way from the first corner."""
    nx, ny, nw, longest, w, x, y = 0.0, 0.0, 0.0, 0.0, polygon[0, 0], polygon[0, 1], polygon[0, 2]
    for i in range(1, count):
        aw, ax, ay = polygon[i, 0] - w, polygon[i, 1] - x, polygon[i, 2] - y
        longest = max(longest, aw * aw + ax * ax + ay * ay)
        if i + 1 < count:
            bw, bx, by = polygon[i + 1, 0] - w, polygon[i + 1, 1] - x, polygon[i + 1, 2] - y
            nx, ny = nx + (ay * bw - aw * by), ny + (aw * bx - ax * bw)
            nw += ax * by - ay * bx
    return nx, ny, nw, np.sqrt(nx * nx + ny * ny + nw * nw), longest


@kernel
def _in_arc(polygon, count, piece, k, grow):
    """Whether a polygon reaches into an arc widened by `grow`, between whose heights it lies, and a point that does.

    Its corners, the least point over its plane, its sides: over a plane a convex function has its least at one point, and if that
    is not in the polygon, on a side. A plane that is far enough from the disk (the circle's far side) parts the two.
    """
    radius, centre, ring_radius = piece[k, RADIUS], piece[k, SLOPE], piece[k, ROUND] + grow
    square = ring_radius * ring_radius
    for i in range(count):
        q = np.sqrt(polygon[i, 1] ** 2 + polygon[i, 2] ** 2) - radius
        value = (polygon[i, 0] - centre) ** 2
        if q > 0.0:
            value += q * q
        if value < square:
            return True, polygon[i, 0], polygon[i, 1], polygon[i, 2]
    nx, ny, nw, size, longest = _normal_of(polygon, count)
    # The normal of a needle is rounding: its sides say all.
    if size > _NEEDLE * longest:
        across = np.sqrt(nx * nx + ny * ny)
        reach = across / size
        away = (nx * polygon[0, 1] + ny * polygon[0, 2] + nw * (polygon[0, 0] - centre)) / size
        sign = 1.0
        if away < 0.0:
            away, sign = -away, -1.0
        # Whatever the direction, it parts the two only if all corners lie beyond.
        least = np.inf
        for i in range(count):
            least = min(least, sign * (nx * polygon[i, 1] + ny * polygon[i, 2] + nw * (polygon[i, 0] - centre)) / size)
        ux, uy = 1.0, 0.0
        if across > 0.0:
            ux, uy = sign * nx / across, sign * ny / across
        rest = away - radius * reach
        if radius >= 0.0 and rest <= 0.0:
            # The plane cuts the disk: the middle of the chord.
            far = away / reach if reach > 0.0 else 0.0
            w, x, y = 0.0, far * ux, far * uy
        elif radius + rest * reach >= 0.0:
            if least - radius * reach >= ring_radius:
                return False, 0.0, 0.0, 0.0
            out = radius + rest * reach
            w, x, y = rest * sign * nw / size, out * ux, out * uy
        else:
            w, x, y = sign * away * size / nw, 0.0, 0.0
        q = np.sqrt(x * x + y * y) - radius
        value = w * w
        if q > 0.0:
            value += q * q
        if value < square and _holds(polygon, count, w + centre, x, y, nw, nx, ny):
            return True, w + centre, x, y
    for i in range(count):
        j = i + 1 if i + 1 < count else 0
        aw, ax, ay = polygon[i, 0] - centre, polygon[i, 1], polygon[i, 2]
        ew, ex, ey = polygon[j, 0] - polygon[i, 0], polygon[j, 1] - polygon[i, 1], polygon[j, 2] - polygon[i, 2]
        part = _side_in_arc(aw, ax, ay, ew, ex, ey, radius, square)
        if part >= 0.0:
            return True, polygon[i, 0] + part * ew, ax + part * ex, ay + part * ey
    return False, 0.0, 0.0, 0.0


@kernel
def _well_inside(polygon, count, piece, k, w, x, y):
    """From a point of a polygon in a piece, one that says more than one on the rim: towards the polygon's centre."""
    mw, mx, my = 0.0, 0.0, 0.0
    for i in range(count):
        mw += polygon[i, 0] / count
        mx += polygon[i, 1] / count
        my += polygon[i, 2] / count
    part = 1.0
    for _ in range(_HALVINGS):
        hw, hx, hy = w + part * (mw - w), x + part * (mx - x), y + part * (my - y)
        if inset(piece, k, hw, hx * hx + hy * hy) > 0.0:
            return hw, hx, hy
        part *= 0.5
    return w, x, y


@kernel
def polygon_hit(polygon, count, piece, k, grow):
    """Whether a convex polygon of rows (height, x, y), cut off at a piece's heights, reaches into it, and a point that does.

    With the piece widened by `grow`; the point then need not lie in the piece itself.
    """
    if piece[k, KIND] == CYLINDER:
        radius = piece[k, RADIUS] + grow
        height, px, py, square = nearest(polygon, count)
        if square >= radius * radius:
            return False, 0.0, 0.0, 0.0
        # A point well inside says more than one on the rim: go from the nearest point half way to where the line
        # to the polygon's centre leaves the cylinder.
        mh, mx, my = 0.0, 0.0, 0.0
        for i in range(count):
            mh += polygon[i, 0] / count
            mx += polygon[i, 1] / count
            my += polygon[i, 2] / count
        if mx * mx + my * my < radius * radius:
            return True, mh, mx, my
        dx, dy = mx - px, my - py
        a, b = dx * dx + dy * dy, px * dx + py * dy
        part = 0.0
        if a > 0.0:
            part = 0.5 * (np.sqrt(max(0.0, b * b + a * (radius * radius - square))) - b) / a
        part = min(1.0, max(0.0, part))
        return True, height + part * (mh - height), px + part * dx, py + part * dy
    if piece[k, KIND] == CONE:
        hit, w, x, y = _in_cone(polygon, count, piece, k, grow)
    else:
        hit, w, x, y = _in_arc(polygon, count, piece, k, grow)
    if not hit:
        return False, 0.0, 0.0, 0.0
    w, x, y = _well_inside(polygon, count, piece, k, w, x, y)
    return True, w, x, y
