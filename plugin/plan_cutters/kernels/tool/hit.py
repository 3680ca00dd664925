"""Does a triangle, or any triangle of a tree, reach into a tool?

A tool stands where a body puts it, a row of 14 numbers: the centre about which it tilts (3), its axis a (3), x_T (3), y_T (3),
the distance of that centre from the axis along x_T, and by how much all is drawn out along y_T to either side (0 for a tool).
Its pieces are those of `pieces`, heights measured from that centre along a. For a flat end the centre is the contact.

A triangle cut off at the two heights of a piece is a convex polygon, and it meets a cylinder exactly when its shadow along the
axis comes nearer to the axis than the radius (`docs/at_a_sample.md`, lemma S3). No subdivision, no trigonometry, no tolerance.
One walk of the tree serves all pieces: a piece that is apart from a box is not asked for again below it.

`rate` widens all pieces, at a point Q, by `rate` times the distance of Q from the line through the centre along y_T. Tilting
turns the tool about that line, and turning by at most `rate` moves Q by no more than that in the tool's frame: a miss with
`rate` is a miss at every tilt within that turn (lemma S5).

A piece drawn out by `half` to either side, what a cutter sweeps while its contact wanders, meets a triangle exactly if the piece
itself meets the triangle drawn out: a prism, whose faces are polygons (`extruded_hit`).
"""

import numpy as np

from plan_cutters.kernels.codes import BOTTOM, CENTRE, CYLINDER, HIGH, KIND, LOW, RADIUS, TOP, WIDE
from plan_cutters.kernels.jit import kernel, maker
from plan_cutters.kernels.linear.tree import half, half_of
from plan_cutters.kernels.rows import Scratch
from plan_cutters.kernels.tool.apart import HALF, OFFSET, A, P, X, Y, alive, stays
from plan_cutters.kernels.tool.pieces import clipped, inset, polygon_hit, shadow_area


@maker
def scratch():
    """Make a workspace for walks of a tree."""
    return Scratch(
        np.empty(64, np.int64), np.empty(64, np.int64), np.empty((3, 3)), np.empty((4, 3)), np.empty((8, 3)), np.empty((8, 3)),
        np.empty((64, 3, 3)), np.zeros(1, np.int64), np.empty((64, 5)), np.zeros(2, np.int64),
    )  # fmt: skip


@kernel
def stand(body, frame, tilt_cos, tilt_sin, offset, rise):
    """Write the body tilted from the normal of a frame towards its direction: `rise` over the contact, `offset` from the axis."""
    p, n, f, t = frame.p, frame.n, frame.f, frame.t
    for k in range(3):
        body[P + k] = p[k] + rise * n[k]
        body[A + k] = tilt_cos * n[k] + tilt_sin * f[k]
        body[X + k] = tilt_cos * f[k] - tilt_sin * n[k]
        body[Y + k] = t[k]
    body[OFFSET], body[HALF] = offset, 0.0


@kernel
def into_frame(vertex, i, body, rate, corner):
    """Write triangle i as rows (height, x, y) in the tool's frame, from its axis; (how much `rate` widens it at most, least and
    most height, a sum that is no number if any of it is none).
    """
    widening, least, most, total = 0.0, np.inf, -np.inf, 0.0
    for c in range(3):
        dx = vertex[i, c, 0] - body[P]
        dy = vertex[i, c, 1] - body[P + 1]
        dz = vertex[i, c, 2] - body[P + 2]
        height = dx * body[A] + dy * body[A + 1] + dz * body[A + 2]
        across = dx * body[X] + dy * body[X + 1] + dz * body[X + 2]
        corner[c, 0] = height
        corner[c, 1] = across + body[OFFSET]
        corner[c, 2] = dx * body[Y] + dy * body[Y + 1] + dz * body[Y + 2]
        if rate > 0.0:
            widening = max(widening, rate * np.sqrt(height * height + across * across))
        least, most = min(least, height), max(most, height)
        total += height + corner[c, 1] + corner[c, 2]
    return widening, least, most, total


@kernel
def triangle_hit(vertex, i, body, piece, mask, rate, scratch):
    """Whether triangle i reaches into a piece of a mask, and a point of it that does. A number that is none counts as a hit.

    `vertex` (n, 3, 3) float64. `body` (14,) float64. `piece` (k, COLUMNS) float64. `mask` (int): a bit for each piece that is
    requested. Returns `which` (int): the piece, -1 for none. `height`, `px`, `py` (float): with `rate` 0, a point of the triangle
    in the piece, in the tool's frame from its axis.
    """
    corner = scratch.corner
    widening, least, most, total = into_frame(vertex, i, body, rate, corner)
    # What is no number is in the way: comparisons below would let it pass.
    total += widening
    if total - total != 0.0:
        return 0, 0.0, 0.0, 0.0
    for k in range(len(piece)):
        grow = 0.0 if widening > 0.0 and stays(body, piece, k) else widening
        if not (mask >> k) & 1 or most <= piece[k, BOTTOM] - grow or least >= piece[k, TOP] + grow:
            continue
        low, high = piece[k, LOW] - grow, piece[k, HIGH] + grow
        where, count = clipped(corner, 3, least, most, low, high, scratch.polygon, scratch.spare)
        if count == 0:
            continue
        source = corner if where == 0 else scratch.polygon if where == 1 else scratch.spare
        hit, height, px, py = polygon_hit(source, count, piece, k, grow)
        if hit:
            return k, height, px, py
    return -1, 0.0, 0.0, 0.0


@kernel
def _swept_hit(vertex, i, body, piece, mask, rate, scratch):
    """`triangle_hit` with a rate, for triangles that reach from near the line of turning to far from it.

    The widening is that of the farthest corner; where this hits, the longest side is halved until the widening is
    about the same all over the piece.
    """
    spare, pieces = scratch.spare, scratch.pieces
    for corner in range(3):
        for k in range(3):
            pieces[0, corner, k] = vertex[i, corner, k]
    top = 1
    while top > 0:
        top -= 1
        which, _, _, _ = triangle_hit(pieces, top, body, piece, mask, rate, scratch)
        if which < 0:
            continue
        # Distances from the line of turning: only they make the widening differ over the piece.
        farthest, longest, side = 0.0, -1.0, 0
        for corner in range(3):
            height, across = 0.0, 0.0
            for k in range(3):
                height += (pieces[top, corner, k] - body[P + k]) * body[A + k]
                across += (pieces[top, corner, k] - body[P + k]) * body[X + k]
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
def everything(piece):
    """The mask of all pieces."""
    return (1 << len(piece)) - 1


@kernel
def _depth_of(box, i, body, piece, mask):
    """How deep at least the centre of box i lies in the pieces of a mask; negative outside."""
    dx, dy, dz = box[i, CENTRE] - body[P], box[i, CENTRE + 1] - body[P + 1], box[i, CENTRE + 2] - body[P + 2]
    height = dx * body[A] + dy * body[A + 1] + dz * body[A + 2]
    across = dx * body[X] + dy * body[X + 1] + dz * body[X + 2] + body[OFFSET]
    sideways = dx * body[Y] + dy * body[Y + 1] + dz * body[Y + 2]
    square, best = across * across + sideways * sideways, -np.inf
    for k in range(len(piece)):
        if (mask >> k) & 1:
            best = max(best, inset(piece, k, height, square))
    return best


@kernel
def tree_hit(tree, body, piece, rate, hint, scratch, deep=False):
    """First triangle found that reaches into the tool, the piece, and with `rate` 0 its point.

    `body` (14,) float64. `piece` (k, COLUMNS) float64. `hint` (int): triangle to try first (the last one that was in the way), or
    -1. `deep`: of two boxes the one that lies deeper comes first: where something is in the way, it is found sooner there.
    `scratch` (Scratch): 64 pieces let a triangle be halved often enough where `rate` > 0. Returns `triangle`, `which` (int):
    -1 if none. `height`, `px`, `py` (float): its point, as `triangle_hit` gives it.
    """
    stack, masks, whole = scratch.stack, scratch.masks, everything(piece)
    if hint >= 0:
        vertex, row = half_of(tree, hint)
        which, height, px, py = triangle_hit(vertex, row, body, piece, whole, rate, scratch)
        if which >= 0 and (rate == 0.0 or _swept_hit(vertex, row, body, piece, whole, rate, scratch)):
            return hint, which, height, px, py
    for k in range(2):
        vertex, box, depth, begin = half(tree, k)
        n, first, top = len(vertex), (1 << depth) - 1, 1 if len(vertex) else 0
        stack[0], masks[0] = 0, whole
        while top > 0:
            top -= 1
            node = stack[top]
            scratch.looked[0] += 1
            mask = alive(box, node, body, piece, masks[top], rate)
            if mask == 0:
                continue
            if node < first:
                left, right = 2 * node + 1, 2 * node + 2
                if deep and _depth_of(box, left, body, piece, mask) < _depth_of(box, right, body, piece, mask):
                    left, right = right, left
                stack[top], masks[top] = right, mask
                stack[top + 1], masks[top + 1] = left, mask
                top += 2
                continue
            leaf = node - first
            for i in range((n * leaf) >> depth, (n * (leaf + 1)) >> depth):
                which, height, px, py = triangle_hit(vertex, i, body, piece, mask, rate, scratch)
                if which >= 0 and (rate == 0.0 or _swept_hit(vertex, i, body, piece, mask, rate, scratch)):
                    return begin + i, which, height, px, py
    return -1, -1, 0.0, 0.0, 0.0


@kernel
def _shadow_distance(polygon, count, half):
    """Squared distance between the shadow of a convex polygon and the segment (0, -half) (0, half)."""
    area = shadow_area(polygon, count)
    inside = abs(area) > 0.0
    best = np.inf
    for i in range(count):
        j = i + 1 if i + 1 < count else 0
        xi, yi = polygon[i, 1], polygon[i, 2]
        ex, ey = polygon[j, 1] - xi, polygon[j, 2] - yi
        off = yi - min(half, max(-half, yi))
        best = min(best, xi * xi + off * off)
        # The segment's ends against the side, and whether one of them (the lower) lies within the polygon.
        square = ex * ex + ey * ey
        for end in (-half, half):
            part = 0.0
            if square > 0.0:
                part = min(1.0, max(0.0, (-xi * ex + (end - yi) * ey) / square))
            x, y = xi + part * ex, yi + part * ey - end
            best = min(best, x * x + y * y)
        if (xi * ey - (yi + half) * ex) * area < 0.0:
            inside = False
        # The side crosses the segment.
        if (xi < 0.0) != (xi + ex < 0.0) and abs(yi - xi / ex * ey) <= half:
            return 0.0
    return 0.0 if inside else best


@kernel
def extruded_hit(vertex, i, body, piece, mask, workspace):
    """Those of the pieces of a mask, drawn out as the body says, into which triangle i of `vertex` (n, 3, 3) reaches."""
    corner, half = workspace.corner, body[HALF]
    _, least, most, total = into_frame(vertex, i, body, 0.0, corner)
    # What is no number is in the way.
    total += half
    if total - total != 0.0:
        return mask
    hit = 0
    for k in range(len(piece)):
        if not (mask >> k) & 1 or most <= piece[k, BOTTOM] or least >= piece[k, TOP]:
            continue
        if _extruded(corner, least, most, half, piece, k, workspace):
            hit |= 1 << k
    return hit


@kernel
def _extruded(corner, least, most, half, piece, k, workspace):
    """Whether a triangle of rows (height, x, y) reaches into a piece that is drawn out."""
    # What holds the piece: as wide as it ever is.
    where, count = clipped(corner, 3, least, most, piece[k, BOTTOM], piece[k, TOP], workspace.polygon, workspace.spare)
    source = corner if where == 0 else workspace.polygon if where == 1 else workspace.spare
    wide = max(0.0, max(piece[k, RADIUS], piece[k, WIDE]))
    if count == 0 or _shadow_distance(source, count, half) >= wide * wide:
        return False
    if piece[k, KIND] == CYLINDER:
        return True
    # The faces of the prism, then whether the piece lies within it: the middle of its axis tells.
    for side in range(5):
        count = 3 if side < 2 else 4
        for c in range(count):
            at, away = c, -half if side == 0 else half
            if side >= 2:
                at = (side - 2 + (1 if c == 1 or c == 2 else 0)) % 3
                away = -half if c < 2 else half
            for j in range(3):
                workspace.face[c, j] = corner[at, j]
            workspace.face[c, 2] += away
        where, count = clipped(
            workspace.face, count, least, most, piece[k, LOW], piece[k, HIGH], workspace.polygon, workspace.spare
        )
        source = workspace.face if where == 0 else workspace.polygon if where == 1 else workspace.spare
        if count > 0 and polygon_hit(source, count, piece, k, 0.0)[0]:
            return True
    middle = 0.5 * (piece[k, BOTTOM] + piece[k, TOP])
    return _through(corner, half, middle)


@kernel
def _through(corner, half, height):
    """Whether a point of the axis lies in a drawn triangle: the line through it along y_T crosses the triangle nearby."""
    # In the shadow along y_T: rows (height, x).
    area = 0.0
    for c in range(3):
        d = c + 1 if c < 2 else 0
        area += corner[c, 0] * corner[d, 1] - corner[d, 0] * corner[c, 1]
    if area == 0.0:
        return False
    y = 0.0
    for c in range(3):
        d = c + 1 if c < 2 else 0
        e = d + 1 if d < 2 else 0
        share = ((corner[d, 0] - height) * corner[e, 1] - (corner[e, 0] - height) * corner[d, 1]) / area
        if share < 0.0:
            return False
        y += share * corner[c, 2]
    return abs(y) <= half
