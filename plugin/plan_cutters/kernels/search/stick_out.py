"""How far a holder must stand from the tip to clear everything, at given postures.

A holder that moves towards the spindle along its axis leaves behind every point that is lower than its outline there. Its
outline, as `domain.stick_out.outline` makes it, is the height over its nose at which the holder first becomes wider than a
distance from the axis: rows (v0, v1, q0, q1), the height rising from v0 at q0 to v1 at q1, level where both are the same. A point
at height w and distance q is cleared if the nose is no lower than w - v(q): lemmas H1 and H2 of `docs/proofs.md`.
"""

import numpy as np

from plan_cutters.kernels.codes import OFFSET_OF, OVER_TIP, RISE
from plan_cutters.kernels.jit import entry, kernel
from plan_cutters.kernels.linear.tree import half
from plan_cutters.kernels.linear.vectors import cross
from plan_cutters.kernels.rows import Frame
from plan_cutters.kernels.search.place import mode_at, straightened
from plan_cutters.kernels.tool.apart import BODY, OFFSET, A, P, X, Y, half_width
from plan_cutters.kernels.tool.hit import into_frame, scratch, stand

V0, V1, Q0, Q1 = 0, 1, 2, 3


@kernel
def _level(tri, radius):
    """Largest height over a triangle of rows (height, x, y) nearer to the axis than a radius; -inf if none.

    It is at a corner, at an end of what a side has within the circle, or where the plane is highest on the circle.
    """
    best, square = -np.inf, radius * radius
    for i in range(3):
        j = i + 1 if i < 2 else 0
        w, x, y = tri[i, 0], tri[i, 1], tri[i, 2]
        if x * x + y * y < square:
            best = max(best, w)
        ew, ex, ey = tri[j, 0] - w, tri[j, 1] - x, tri[j, 2] - y
        a, b, c = ex * ex + ey * ey, x * ex + y * ey, x * x + y * y - square
        root = b * b - a * c
        if a > 0.0 and root > 0.0:
            root = np.sqrt(root)
            first, last = max(0.0, (-b - root) / a), min(1.0, (-b + root) / a)
            if first < last:
                best = max(best, max(w + first * ew, w + last * ew))
    return max(best, _on_circle(tri, radius))


@kernel
def _on_circle(tri, radius):
    """Height of a triangle's plane where it is highest on a circle about the axis, -inf if that is not in the triangle."""
    ax, ay, aw = tri[1, 1] - tri[0, 1], tri[1, 2] - tri[0, 2], tri[1, 0] - tri[0, 0]
    bx, by, bw = tri[2, 1] - tri[0, 1], tri[2, 2] - tri[0, 2], tri[2, 0] - tri[0, 0]
    area = ax * by - ay * bx
    if area == 0.0:
        return -np.inf
    up_x, up_y = (aw * by - bw * ay) / area, (bw * ax - aw * bx) / area
    size = np.sqrt(up_x * up_x + up_y * up_y)
    if size == 0.0:
        return -np.inf
    px, py = radius * up_x / size - tri[0, 1], radius * up_y / size - tri[0, 2]
    u, v = (px * by - py * bx) / area, (ax * py - ay * px) / area
    if u >= 0.0 and v >= 0.0 and u + v <= 1.0:
        return tri[0, 0] + u * aw + v * bw
    return -np.inf


@kernel
def _sloped(tri, row):
    """Largest w - v(q) over a triangle nearer to the axis than q1, for v that rises from v0 at q0 (and is v0 within) to v1 at q1.

    That function is concave: its largest value is at a corner, on a side where it is stationary or meets q0 or q1, or on the face
    where the plane is highest on one of the two circles.
    """
    v0, q0, q1 = row[V0], row[Q0], row[Q1]
    slope, best = (row[V1] - v0) / (q1 - q0), -np.inf
    for i in range(3):
        j = i + 1 if i < 2 else 0
        w, x, y = tri[i, 0], tri[i, 1], tri[i, 2]
        ew, ex, ey = tri[j, 0] - w, tri[j, 1] - x, tri[j, 2] - y
        a, b, c = ex * ex + ey * ey, x * ex + y * ey, x * x + y * y
        for at in range(6):
            t = 0.0
            if 0 < at < 5:
                radius = q0 if at < 3 else q1
                root = b * b - a * (c - radius * radius)
                if a <= 0.0 or root < 0.0:
                    continue
                t = ((1.0 if at % 2 else -1.0) * np.sqrt(root) - b) / a
            elif at == 5:
                rise = ew / slope
                square = a - rise * rise
                if square <= 0.0:
                    continue
                t = (rise * np.sqrt(max(0.0, a * c - b * b) / square) - b) / a
            if 0.0 <= t <= 1.0:
                q = np.sqrt(max(0.0, c + t * (2.0 * b + t * a)))
                if q <= q1 * (1.0 + 1e-12):
                    best = max(best, w + t * ew - v0 - slope * max(0.0, q - q0))
    return max(best, max(_on_circle(tri, q0) - v0, _on_circle(tri, q1) - row[V1]))


@kernel
def needed(tri, outline):
    """Least height of the nose that clears a triangle of rows (height, x, y); -inf where any does."""
    best = -np.inf
    for k in range(len(outline)):
        if outline[k, V1] > outline[k, V0]:
            best = max(best, _sloped(tri, outline[k]))
        else:
            best = max(best, _level(tri, outline[k, Q1]) - outline[k, V0])
    return best


@kernel
def _at_most(box, i, body, outline):
    """No less than what is needed for anything within box i; -inf where it is beside the holder."""
    dx, dy, dz = box[i, 0] - body[P], box[i, 1] - body[P + 1], box[i, 2] - body[P + 2]
    height = dx * body[A] + dy * body[A + 1] + dz * body[A + 2]
    x = dx * body[X] + dy * body[X + 1] + dz * body[X + 2] + body[OFFSET]
    y = dx * body[Y] + dy * body[Y + 1] + dz * body[Y + 2]
    q, near = np.sqrt(x * x + y * y), 0.0
    widest = outline[len(outline) - 1, Q1]
    if q - box[i, 15] >= widest:
        return -np.inf
    if q > box[i, 15]:
        ux, uy = x / q, y / q
        near = q - half_width(
            box, i, ux * body[X] + uy * body[Y], ux * body[X + 1] + uy * body[Y + 1], ux * body[X + 2] + uy * body[Y + 2]
        )
        if near >= widest:
            return -np.inf
    low = outline[0, V0]
    for k in range(len(outline)):
        if near < outline[k, Q1]:
            low = outline[k, V0]
            if near > outline[k, Q0]:
                low += (near - outline[k, Q0]) * (outline[k, V1] - low) / (outline[k, Q1] - outline[k, Q0])
            break
    return height + half_width(box, i, body[A], body[A + 1], body[A + 2]) - low


@kernel
def _cleared(tree, body, outline, floor, stack, bound, corner):
    """Least height of the nose, from the centre, at least `floor`, that clears all triangles; the one that asks for it, or -1."""
    best, which = floor, -1
    for k in range(2):
        vertex, box, depth, begin = half(tree, k)
        n, first, top = len(vertex), (1 << depth) - 1, 1 if len(vertex) else 0
        stack[0], bound[0] = 0, np.inf
        while top > 0:
            top -= 1
            node = stack[top]
            if bound[top] <= best:
                continue
            if node >= first:
                leaf = node - first
                for i in range((n * leaf) >> depth, (n * (leaf + 1)) >> depth):
                    _, _, most, _ = into_frame(vertex, i, body, 0.0, corner)
                    if most - outline[0, V0] > best:
                        height = needed(corner, outline)
                        if height > best:
                            best, which = height, begin + i
                continue
            left, right = 2 * node + 1, 2 * node + 2
            a, b = _at_most(box, left, body, outline), _at_most(box, right, body, outline)
            if a > b:
                left, right, a, b = right, left, b, a
            # The one that may ask for more comes off the stack first.
            if a > best:
                stack[top], bound[top] = left, a
                top += 1
            if b > best:
                stack[top], bound[top] = right, b
                top += 1
    return best, which


@entry
def least_stick_outs(rows, point, normal, tilt_direction, tilt, tool, outline, floor, tree, stick_out, triangle):
    """Least stick-out at given postures, no less than `floor`, and the triangle that asks for it.

    `rows` (m,) int64: samples whose posture is known.
    `point`, `normal`, `tilt_direction` (n, 3) float64.
    `tilt` (n,) float64.
    `outline` (k, 4) float64.
    `stick_out` (n,) float64, written.
    `triangle` (n,) int32, written: -1 where the floor is enough.
    """
    body, f, t = np.empty(BODY), np.empty(3), np.empty(3)
    workspace, bound = scratch(), np.empty(64)
    for row in rows:
        n, share = normal[row], straightened(tilt_direction[row], f)
        cross(n, f, t)
        mode = max(0, mode_at(tool, tilt[row]))
        over = tool.mode[mode, OVER_TIP]
        stand(body, Frame(point[row], n, f, t), np.cos(tilt[row]), np.sin(tilt[row]),
              share * tool.mode[mode, OFFSET_OF], tool.mode[mode, RISE])  # fmt: skip
        best, triangle[row] = _cleared(tree, body, outline, floor - over, workspace.stack, bound, workspace.corner)
        stick_out[row] = best + over
