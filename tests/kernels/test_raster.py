"""An image of triangles: each pixel shows the nearest one that covers it, and nothing beside the image is written."""

import numpy as np
import pytest

from plan_cutters.kernels.linear.raster import draw

WIDE, HIGH, BESIDE = 17, 11, 12


def test_each_pixel_shows_the_nearest_triangle_that_covers_it():
    rng = np.random.default_rng(4)
    # Some reach beyond the image on all sides, but no farther than there are rows beside it.
    corner = rng.uniform((-8, -8, 0), (WIDE + 8, HIGH + 8, 9), (25, 3, 3))
    brightness, owner = rng.uniform(0, 1, (25, 3)), np.arange(25, dtype=np.int32)
    depth = np.full((HIGH + 2 * BESIDE, WIDE), -np.inf)
    seen, shade = np.full(depth.shape, -1, np.int32), np.zeros(depth.shape)
    image = slice(BESIDE, BESIDE + HIGH)
    draw(corner, brightness, owner, depth[image], seen[image], shade[image])
    shares = np.linalg.inv(np.concatenate([corner[:, :, :2], np.ones((25, 3, 1))], axis=2).swapaxes(1, 2))
    for i in range(-BESIDE, HIGH + BESIDE):
        for j in range(WIDE):
            near, who, light = -np.inf, -1, 0.0
            for t in range(25) if 0 <= i < HIGH else ():
                share = shares[t] @ (j, i, 1.0)
                if share.min() >= 0.0 and share @ corner[t, :, 2] > near:
                    near, who, light = share @ corner[t, :, 2], t, share @ brightness[t]
            there = BESIDE + i, j
            assert seen[there] == who
            assert (depth[there], shade[there]) == pytest.approx((near, light))
    assert (seen[image] >= 0).mean() > 0.5
