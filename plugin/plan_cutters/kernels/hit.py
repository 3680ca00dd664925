"""Does a triangle, or any triangle of a tree, reach into a solid cylinder?

A body is a row of 17 numbers: contact P (3), axis a (3), x_T (3), y_T (3), then the distance from the cylinder's
axis to P along x_T, its radius, the two heights between which it is solid, measured from P along a, and by how much it is
drawn out along y_T to either side (0 for a cylinder). A cutter `(R, L)` shrunk by s is `(R, R - s, s, L - s, 0)`; its dummy
`(0, 2R - s, s, L - s, 0)`.

The clever part: a triangle cut off at the two heights is a convex polygon, and it meets the cylinder exactly when
its shadow along the axis comes nearer to the axis than the radius. No subdivision, no trigonometry, no tolerance.

`rate` widens the body, at a point Q, by `rate` times the distance of Q from the line through P along y_T. Tilting turns
the tool about that line, and turning by at most `rate` moves Q by no more than that in the tool's frame: a miss with
`rate` is a miss at every tilt within that turn.
"""

import numpy as np

from plan_cutters.kernels.jit import entry, kernel
from plan_cutters.kernels.rows import Scratch

P, A, X, Y, OFFSET, RADIUS, LOW, HIGH, HALF, BODY = 0, 3, 6, 9, 12, 13, 14, 15, 16, 17


@entry
def scratch():  # type: ignore[no-untyped-def]
    """Room for walks of a tree."""
    return Scratch(np.empty(64, np.int64), np.empty((8, 3)), np.empty((8, 3)), np.empty((64, 3, 3)))


@kernel
def dot(a, b):  # type: ignore[no-untyped-def]
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@kernel
def cross(a, b, out):  # type: ignore[no-untyped-def]
    """Write a x b."""
    out[0], out[1], out[2] = a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@kernel
def perpendicular(n, out):  # type: ignore[no-untyped-def]
    """Write any unit direction across a unit direction."""
    k = 0 if abs(n[0]) < 0.6 else 1
    for i in range(3):
        out[i] = -n[k] * n[i]
    out[k] += 1.0
    size = np.sqrt(dot(out, out))
    for i in range(3):
        out[i] /= size


@kernel
def lean_frame(e1, e2, cosine, sine, f, t):  # type: ignore[no-untyped-def]
    """Write the lean direction f at a rotation, and t = n x f."""
    for k in range(3):
        f[k] = cosine * e1[k] + sine * e2[k]
        t[k] = cosine * e2[k] - sine * e1[k]


@kernel
def stand(body, frame, tilt_cos, tilt_sin, offset, radius, low, high):  # type: ignore[no-untyped-def]
    """Write the body whose axis leans from the normal of a frame towards its lean direction by a tilt."""
    p, n, f, t = frame.p, frame.n, frame.f, frame.t
    for k in range(3):
        body[P + k] = p[k]
        body[A + k] = tilt_cos * n[k] + tilt_sin * f[k]
        body[X + k] = tilt_cos * f[k] - tilt_sin * n[k]
        body[Y + k] = t[k]
    body[OFFSET], body[RADIUS], body[LOW], body[HIGH], body[HALF] = offset, radius, low, high, 0.0


@kernel
def _half_width(box, i, x, y, z):  # type: ignore[no-untyped-def]
    """Half the extent of box i along a unit direction."""
    return (
        box[i, 12] * abs(x * box[i, 3] + y * box[i, 4] + z * box[i, 5])
        + box[i, 13] * abs(x * box[i, 6] + y * box[i, 7] + z * box[i, 8])
        + box[i, 14] * abs(x * box[i, 9] + y * box[i, 10] + z * box[i, 11])
    )


@kernel
def _thin_apart(box, i, body, low, high, radius, dx, dy, dz):  # type: ignore[no-untyped-def]
    """Whether a plane across the box's third side, the thin one, parts it from the body."""
    mx, my, mz = box[i, 9], box[i, 10], box[i, 11]
    along = mx * body[3] + my * body[4] + mz * body[5]
    side = mx * body[6] + my * body[7] + mz * body[8]
    aside = mx * body[9] + my * body[10] + mz * body[11]
    apart = abs(mx * dx + my * dy + mz * dz + body[OFFSET] * side - 0.5 * (low + high) * along)
    extent = 0.5 * (high - low) * abs(along) + radius * np.sqrt(max(0.0, 1.0 - along * along)) + body[HALF] * abs(aside)
    return apart > extent + box[i, 14] + 1e-9


@kernel
def _box_apart(box, i, body, rate):  # type: ignore[no-untyped-def]
    """True only if no point of box i lies in the body (separating slab along the axis, then across it)."""
    dx, dy, dz = box[i, 0] - body[0], box[i, 1] - body[1], box[i, 2] - body[2]
    diagonal = box[i, 15]
    grow = 0.0
    height = dx * body[3] + dy * body[4] + dz * body[5]
    across = dx * body[6] + dy * body[7] + dz * body[8]
    if rate > 0.0:
        grow = rate * (np.sqrt(height * height + across * across) + diagonal)
    across += body[OFFSET]
    low, high = body[LOW] - grow, body[HIGH] + grow
    if height + diagonal < low or height - diagonal > high:
        return True
    if height < low or height > high:
        extent = _half_width(box, i, body[3], body[4], body[5])
        if height + extent < low or height - extent > high:
            return True
    along = dx * body[9] + dy * body[10] + dz * body[11]
    along -= min(body[HALF], max(-body[HALF], along))
    square = across * across + along * along
    radius = body[RADIUS] + grow
    if square <= radius * radius:
        return _thin_apart(box, i, body, low, high, radius, dx, dy, dz)
    if square > (radius + diagonal) * (radius + diagonal):
        return True
    distance = np.sqrt(square)
    ux, uy = across / distance, along / distance
    extent = _half_width(
        box, i, ux * body[6] + uy * body[9], ux * body[7] + uy * body[10], ux * body[8] + uy * body[11]
    )  # fmt: skip
    return distance - extent > radius or _thin_apart(box, i, body, low, high, radius, dx, dy, dz)


@kernel
def _cut(source, count, target, level, keep):  # type: ignore[no-untyped-def]
    """Keep the part of a polygon with `keep * (height - level) >= 0` (Sutherland and Hodgman, one side)."""
    kept = 0
    for i in range(count):
        j = i + 1 if i + 1 < count else 0
        here, there = keep * (source[i, 0] - level), keep * (source[j, 0] - level)
        if here >= 0.0:
            for k in range(3):
                target[kept, k] = source[i, k]
            kept += 1
        if (here > 0.0 and there < 0.0) or (here < 0.0 and there > 0.0):
            part = here / (here - there)
            target[kept, 0] = level
            for k in range(1, 3):
                target[kept, k] = source[i, k] + part * (source[j, k] - source[i, k])
            kept += 1
    return kept


@kernel
def _nearest(polygon, count):  # type: ignore[no-untyped-def]
    """Point of a convex polygon whose shadow is nearest to the axis: (height, x, y, squared distance)."""
    area = 0.0
    for i in range(count):
        j = i + 1 if i + 1 < count else 0
        area += polygon[i, 1] * polygon[j, 2] - polygon[j, 1] * polygon[i, 2]
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
    for i in range(1, count - 1):
        a = polygon[i, 1] * polygon[i + 1, 2] - polygon[i + 1, 1] * polygon[i, 2]
        b = polygon[i + 1, 1] * polygon[0, 2] - polygon[0, 1] * polygon[i + 1, 2]
        c = polygon[0, 1] * polygon[i, 2] - polygon[i, 1] * polygon[0, 2]
        if a * area >= 0.0 and b * area >= 0.0 and c * area >= 0.0 and abs(a + b + c) > 0.0:
            height = (a * polygon[0, 0] + b * polygon[i, 0] + c * polygon[i + 1, 0]) / (a + b + c)
            return height, 0.0, 0.0, 0.0
    return height, px, py, best


@kernel
def triangle_hit(vertex, i, body, rate, polygon, spare):  # type: ignore[no-untyped-def]
    """Whether triangle i reaches into the body, and a point of it that does. A number that is none counts as a hit.

    Parameters
    ----------
    vertex : (n, 3, 3) float64
    body : (17,) float64
    rate : float
    polygon, spare : (8, 3) float64
        Scratch.

    Returns
    -------
    hit : bool
    height, px, py : float
        With `rate` 0, a point of the triangle in the body, in the tool's frame from the cylinder's axis.
    """
    low, high, radius = body[LOW], body[HIGH], body[RADIUS]
    grow, least, most, total = 0.0, np.inf, -np.inf, 0.0
    for corner in range(3):
        dx = vertex[i, corner, 0] - body[0]
        dy = vertex[i, corner, 1] - body[1]
        dz = vertex[i, corner, 2] - body[2]
        height = dx * body[3] + dy * body[4] + dz * body[5]
        across = dx * body[6] + dy * body[7] + dz * body[8]
        polygon[corner, 0] = height
        polygon[corner, 1] = across + body[OFFSET]
        polygon[corner, 2] = dx * body[9] + dy * body[10] + dz * body[11]
        if rate > 0.0:
            grow = max(grow, rate * np.sqrt(height * height + across * across))
        least, most = min(least, height), max(most, height)
        total += height + polygon[corner, 1] + polygon[corner, 2]
    low, high, radius = low - grow, high + grow, radius + grow
    # What is no number is in the way: comparisons below would let it pass.
    total += low + high + radius
    if total - total != 0.0:
        return True, 0.0, 0.0, 0.0
    if most <= low or least >= high or radius <= 0.0 or high <= low:
        return False, 0.0, 0.0, 0.0
    source, count = polygon, 3
    if least < low:
        count = _cut(source, count, spare, low, 1.0)
        source = spare
    if most > high:
        target = polygon if least < low else spare
        count = _cut(source, count, target, high, -1.0)
        source = target
    if count == 0:
        return False, 0.0, 0.0, 0.0
    height, px, py, square = _nearest(source, count)
    if square >= radius * radius:
        return False, 0.0, 0.0, 0.0
    # A point well inside says more than one on the rim: go from the nearest point half way to where the line
    # to the polygon's centre leaves the cylinder.
    mh, mx, my = 0.0, 0.0, 0.0
    for k in range(count):
        mh += source[k, 0] / count
        mx += source[k, 1] / count
        my += source[k, 2] / count
    if mx * mx + my * my < radius * radius:
        return True, mh, mx, my
    dx, dy = mx - px, my - py
    a, b = dx * dx + dy * dy, px * dx + py * dy
    part = 0.0
    if a > 0.0:
        part = 0.5 * (np.sqrt(max(0.0, b * b + a * (radius * radius - square))) - b) / a
    part = min(1.0, max(0.0, part))
    return True, height + part * (mh - height), px + part * dx, py + part * dy


@kernel
def _swept_hit(vertex, i, body, rate, scratch):  # type: ignore[no-untyped-def]
    """`triangle_hit` with a rate, for triangles that reach from near the line of turning to far from it.

    The widening is that of the farthest corner; where this hits, the longest side is halved until the widening is
    about the same all over the piece.
    """
    polygon, spare, pieces = scratch.polygon, scratch.spare, scratch.pieces
    for corner in range(3):
        for k in range(3):
            pieces[0, corner, k] = vertex[i, corner, k]
    top = 1
    while top > 0:
        top -= 1
        hit, _, _, _ = triangle_hit(pieces, top, body, rate, polygon, spare)
        if not hit:
            continue
        # Distances from the line of turning: only they make the widening differ over the piece.
        farthest, longest, side = 0.0, -1.0, 0
        for corner in range(3):
            height, across = 0.0, 0.0
            for k in range(3):
                height += (pieces[top, corner, k] - body[k]) * body[3 + k]
                across += (pieces[top, corner, k] - body[k]) * body[6 + k]
            spare[corner, 0], spare[corner, 1] = height, across
            farthest = max(farthest, height * height + across * across)
        for corner in range(3):
            other = corner + 1 if corner < 2 else 0
            length = (spare[corner, 0] - spare[other, 0]) ** 2 + (spare[corner, 1] - spare[other, 1]) ** 2
            if length > longest:
                longest, side = length, corner
        if longest <= 0.04 * farthest or rate * np.sqrt(farthest) < 1e-9 or top + 2 > len(pieces):
            return True
        other = side + 1 if side < 2 else 0
        for corner in range(3):
            for k in range(3):
                pieces[top + 1, corner, k] = pieces[top, corner, k]
        for k in range(3):
            middle = 0.5 * (pieces[top, side, k] + pieces[top, other, k])
            pieces[top, side, k] = middle
            pieces[top + 1, other, k] = middle
        top += 2
    return False


@kernel
def tree_hit(tree, body, rate, hint, scratch):  # type: ignore[no-untyped-def]
    """First triangle found that reaches into the body, its point with `rate` 0.

    Parameters
    ----------
    tree : Tree
    body : (17,) float64
    rate : float
    hint : int
        Triangle to try first (the last one that was in the way), or -1.
    scratch : Scratch
        64 pieces let a triangle be halved often enough where `rate` > 0.

    Returns
    -------
    triangle : int
        -1 if none.
    height, px, py : float
        Its point, as `triangle_hit` gives it.
    """
    vertex, box, depth = tree.vertex, tree.box, tree.depth
    stack, polygon, spare = scratch.stack, scratch.polygon, scratch.spare
    if hint >= 0:
        hit, height, px, py = triangle_hit(vertex, hint, body, rate, polygon, spare)
        if hit and (rate == 0.0 or _swept_hit(vertex, hint, body, rate, scratch)):
            return hint, height, px, py
    n, first, top = len(vertex), (1 << depth) - 1, 1
    stack[0] = 0
    while top > 0:
        top -= 1
        node = stack[top]
        if _box_apart(box, node, body, rate):
            continue
        if node < first:
            stack[top] = 2 * node + 2
            stack[top + 1] = 2 * node + 1
            top += 2
            continue
        leaf = node - first
        for i in range((n * leaf) >> depth, (n * (leaf + 1)) >> depth):
            hit, height, px, py = triangle_hit(vertex, i, body, rate, polygon, spare)
            if hit and (rate == 0.0 or _swept_hit(vertex, i, body, rate, scratch)):
                return i, height, px, py
    return -1, 0.0, 0.0, 0.0


@kernel
def _inset(box, i, body):  # type: ignore[no-untyped-def]
    """How deep the centre of box i lies in a cylinder; negative outside."""
    dx, dy, dz = box[i, 0] - body[0], box[i, 1] - body[1], box[i, 2] - body[2]
    height = dx * body[3] + dy * body[4] + dz * body[5]
    across = dx * body[6] + dy * body[7] + dz * body[8] + body[OFFSET]
    aside = dx * body[9] + dy * body[10] + dz * body[11]
    return min(min(height - body[LOW], body[HIGH] - height), body[RADIUS] - np.sqrt(across * across + aside * aside))


@kernel
def deep_hit(tree, body, scratch):  # type: ignore[no-untyped-def]
    """`tree_hit` with `rate` 0, of two boxes the one that lies deeper first: where something is in the way, sooner there."""
    vertex, box, depth = tree.vertex, tree.box, tree.depth
    stack, n, first, top = scratch.stack, len(vertex), (1 << depth) - 1, 1
    stack[0] = 0
    while top > 0:
        top -= 1
        node = stack[top]
        if _box_apart(box, node, body, 0.0):
            continue
        if node < first:
            left = 1 if _inset(box, 2 * node + 1, body) >= _inset(box, 2 * node + 2, body) else 0
            stack[top] = 2 * node + 1 + left
            stack[top + 1] = 2 * node + 2 - left
            top += 2
            continue
        leaf = node - first
        for i in range((n * leaf) >> depth, (n * (leaf + 1)) >> depth):
            hit, height, px, py = triangle_hit(vertex, i, body, 0.0, scratch.polygon, scratch.spare)
            if hit:
                return i, height, px, py
    return -1, 0.0, 0.0, 0.0
