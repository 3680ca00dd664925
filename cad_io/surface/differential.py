"""Normals, principal curvatures and directions of many points in compiled code; the formulas are told in `face.curvature`."""

import numpy as np

from plan_cutters_base.jit import entry, kernel


@kernel
def _frame(d, sign, parallel, normal, a, b):
    """Write the normal and the tangent frame (a along Su, b) of derivatives (6, 3); (|Su|, whether there is a frame)."""
    x = d[1, 1] * d[2, 2] - d[1, 2] * d[2, 1]
    y = d[1, 2] * d[2, 0] - d[1, 0] * d[2, 2]
    z = d[1, 0] * d[2, 1] - d[1, 1] * d[2, 0]
    area = np.sqrt(x * x + y * y + z * z)
    length_u = np.sqrt(d[1, 0] * d[1, 0] + d[1, 1] * d[1, 1] + d[1, 2] * d[1, 2])
    length_v = np.sqrt(d[2, 0] * d[2, 0] + d[2, 1] * d[2, 1] + d[2, 2] * d[2, 2])
    if not (area > parallel * length_u * length_v and area > 1e-200 and area < np.inf):
        return 0.0, False
    x, y, z = x / area, y / area, z / area
    normal[0], normal[1], normal[2] = sign * x, sign * y, sign * z
    for k in range(3):
        a[k] = d[1, k] / length_u
    b[0], b[1], b[2] = y * a[2] - z * a[1], z * a[0] - x * a[2], x * a[1] - y * a[0]
    return length_u, True


@kernel
def _dot(d, k, v):
    return d[k, 0] * v[0] + d[k, 1] * v[1] + d[k, 2] * v[2]


@kernel
def _one(d, sign, size, parallel, umbilic, a, b, normal, curvature, direction):
    """Write what is known at one point, a and b being scratch; whether that is something."""
    total = d[0, 0] + d[0, 1] + d[0, 2]
    length, good = _frame(d, sign, parallel, normal, a, b)
    if not good or total - total != 0.0:
        return False
    # S(u, v) in arc lengths along a and b: d/da = (1/|Su|) d/du, d/db = (d/dv - (Sv.a) d/da) / (Sv.b).
    skew, height = _dot(d, 2, a), _dot(d, 2, b)
    uu, vv, uv = _dot(d, 3, normal), _dot(d, 4, normal), _dot(d, 5, normal)
    aa = uu / (length * length)
    ab = (uv / length - skew * aa) / height
    bb = (vv - 2.0 * skew * uv / length + skew * skew * aa) / (height * height)
    mean, half = 0.5 * (aa + bb), 0.5 * (aa - bb)
    radius = np.hypot(half, ab)
    # The eigenvalue farther from zero is a sum of equal signs; the other follows from the determinant.
    far = mean + radius if mean >= 0.0 else mean - radius
    other = (aa * bb - ab * ab) / far if far != 0.0 else 0.0
    top, low = max(far, other), min(far, other)
    if top - top != 0.0 or low - low != 0.0:
        return False
    curvature[0], curvature[1] = top, low
    cosine, sine = 1.0, 0.0
    if top - low > umbilic * max(max(abs(top), abs(low)), 1.0 / size):
        # The eigenvector of the larger eigenvalue lies at half the angle of (half, ab).
        angle = 0.5 * np.arctan2(ab, half)
        cosine, sine = np.cos(angle), np.sin(angle)
    total = 0.0
    for k in range(3):
        direction[k] = cosine * a[k] + sine * b[k]
        total += direction[k] * direction[k]
    for k in range(3):
        direction[k] /= np.sqrt(total)
    return True


@kernel
def _all(derivatives, sign, size, parallel, umbilic, a, b, normal, curvature, direction, bad):
    for i in range(len(derivatives)):
        good = _one(derivatives[i], sign, size, parallel, umbilic, a, b, normal[i], curvature[i], direction[i])
        bad[i] = not good
        if not good:
            normal[i], curvature[i], direction[i] = np.nan, np.nan, np.nan


@entry
def differential(derivatives, sign, size, parallel, umbilic, normal, curvature, direction, bad):
    """Write normals (n, 3), curvatures (n, 2), directions (n, 3) and `bad` (n,) for derivatives (n, 6, 3).

    The other parameters are those of `face.curvature.curvature` and its constants.
    """
    _all(derivatives, sign, size, parallel, umbilic, np.empty(3), np.empty(3), normal, curvature, direction, bad)
