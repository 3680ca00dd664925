"""Does a triangle reach into a tool that is drawn out along y_T: what a cutter sweeps while its contact wanders?

A piece drawn out by `half` to either side meets a triangle exactly if the piece itself meets the triangle drawn out: a prism,
whose faces are polygons.
"""

import numpy as np

from plan_cutters.kernels.codes import BOTTOM, CYLINDER, HIGH, KIND, LOW, RADIUS, TOP, WIDE
from plan_cutters.kernels.jit import kernel
from plan_cutters.kernels.tool.apart import HALF
from plan_cutters.kernels.tool.hit import into_frame
from plan_cutters.kernels.tool.pieces import clipped, polygon_hit, shadow_area


@kernel
def _to_segment(px, py, half):
    """Squared distance of a point from the segment (0, -half) (0, half)."""
    py -= min(half, max(-half, py))
    return px * px + py * py


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
        best = min(best, _to_segment(xi, yi, half))
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
    """Those of the pieces of a mask, drawn out as the body says, into which triangle i reaches.

    Parameters
    ----------
    vertex : (n, 3, 3) float64
    body : (14,) float64
    piece : (k, COLUMNS) float64
    mask : int
    workspace : Scratch
    """
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
                workspace.drawn[c, j] = corner[at, j]
            workspace.drawn[c, 2] += away
        where, count = clipped(
            workspace.drawn, count, least, most, piece[k, LOW], piece[k, HIGH], workspace.polygon, workspace.spare
        )
        source = workspace.drawn if where == 0 else workspace.polygon if where == 1 else workspace.spare
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
