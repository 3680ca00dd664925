"""Triangles drawn into an image with a depth at each pixel: pictures without a screen."""

import numpy as np

from plan_cutters.kernels.jit import entry


@entry
def draw(corner, brightness, owner, depth, seen, shade):
    """Draw triangles over what an image has; where two are equally near, the first one stays.

    `corner` (n, 3, 3) float64: corners in pixels: x to the right, y downwards, and nearness. The centre of pixel (i, j) is at x =
      j, y = i.
    `brightness` (n, 3) float64: brightness at the corners.
    `owner` (n,) int32: what each triangle belongs to.
    `depth` (h, w) float64, written: largest nearness so far; -inf at first.
    `seen` (h, w) int32, written: the owner of the nearest triangle.
    `shade` (h, w) float64, written: its brightness.
    """
    height, width = depth.shape
    for t in range(len(corner)):
        x0, y0, z0 = corner[t, 0, 0], corner[t, 0, 1], corner[t, 0, 2]
        x1, y1, z1 = corner[t, 1, 0], corner[t, 1, 1], corner[t, 1, 2]
        x2, y2, z2 = corner[t, 2, 0], corner[t, 2, 1], corner[t, 2, 2]
        area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
        if area == 0.0:
            continue
        first_column = max(0, int(np.ceil(min(x0, min(x1, x2)))))
        right = min(width - 1, int(np.floor(max(x0, max(x1, x2)))))
        top = max(0, int(np.ceil(min(y0, min(y1, y2)))))
        bottom = min(height - 1, int(np.floor(max(y0, max(y1, y2)))))
        for i in range(top, bottom + 1):
            for j in range(first_column, right + 1):
                a = ((x1 - j) * (y2 - i) - (x2 - j) * (y1 - i)) / area
                b = ((x2 - j) * (y0 - i) - (x0 - j) * (y2 - i)) / area
                c = 1.0 - a - b
                if a < 0.0 or b < 0.0 or c < 0.0:
                    continue
                near = a * z0 + b * z1 + c * z2
                if near > depth[i, j]:
                    depth[i, j], seen[i, j] = near, owner[t]
                    shade[i, j] = a * brightness[t, 0] + b * brightness[t, 1] + c * brightness[t, 2]
