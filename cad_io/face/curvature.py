"""Normals, principal curvatures and directions from first and second derivatives: closed form, no kernel here."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats

#: Below this share of |Su| |Sv|, the two tangents count as parallel.
PARALLEL = 1e-10
#: Principal curvatures closer than this share of the larger one, or of one over the part's size, are taken as equal:
#: rounding alone makes them differ by 1e-8.
UMBILIC = 1e-6


class Curvature(NamedTuple):
    """Differential geometry of n points; rows of `bad` are NaN.

    normal (n, 3) out of the material; curvature (n, 2) = kappa_max, kappa_min, positive where the material rises;
    direction_max (n, 3) unit, of kappa_max; bad (n,) where the derivatives span no plane.
    """

    normal: Floats
    curvature: Floats
    direction_max: Floats
    bad: NDArray[np.bool_]


def curvature(derivatives: Floats, sign: float = 1.0, size: float = np.inf) -> Curvature:
    """Curvature of a surface at n points.

    Parameters
    ----------
    derivatives : (n, 6, 3) float
        S, Su, Sv, Suu, Svv, Suv.
    sign : float
        +1 where Su x Sv points out of the material, -1 where it points in.
    size : float
        Of the part, mm: curvatures far below one over it have no direction.

    Notes
    -----
    Worked out in an orthonormal frame (a, b) of the tangent plane, a along Su, in which the second fundamental form is
    a symmetric 2 x 2 matrix: its eigenvalues are the curvatures, and the difference of the larger one comes without
    cancellation. With the normal out of the material, S'' . n > 0 means that the surface rises: concave is positive.
    At umbilics the direction is a, the kernel's u tangent.
    """
    su, sv = derivatives[:, 1], derivatives[:, 2]
    with np.errstate(all="ignore"):
        cross = np.cross(su, sv)
        area = np.linalg.norm(cross, axis=1)
        length_u, length_v = np.linalg.norm(su, axis=1), np.linalg.norm(sv, axis=1)
        bad = ~(np.isfinite(derivatives).all(axis=(1, 2)) & (area > PARALLEL * length_u * length_v) & (area > 1e-200))
        geometric = cross / area[:, None]
        normal = sign * geometric
        a = su / length_u[:, None]
        b = np.cross(geometric, a)
        # S(u, v) in arc lengths along a and b: d/da = (1/|Su|) d/du, d/db = (d/dv - (Sv.a) d/da) / (Sv.b).
        skew, height = (sv * a).sum(axis=1), (sv * b).sum(axis=1)
        uu, vv, uv = ((derivatives[:, k] * normal).sum(axis=1) for k in (3, 4, 5))
        aa = uu / length_u**2
        ab = (uv / length_u - skew * aa) / height
        bb = (vv - 2 * skew * uv / length_u + skew**2 * aa) / height**2
        mean, half = 0.5 * (aa + bb), 0.5 * (aa - bb)
        radius = np.hypot(half, ab)
        # The eigenvalue farther from zero is a sum of equal signs; the other follows from the determinant.
        far = mean + np.where(mean >= 0, radius, -radius)
        other = (aa * bb - ab * ab) / np.where(far == 0, 1.0, far)
        top, low = np.maximum(far, other), np.minimum(far, other)
        # Eigenvector of the larger eigenvalue at half the angle of (half, ab), which is undefined at an umbilic only.
        angle = 0.5 * np.arctan2(ab, half)
        umbilic = top - low <= UMBILIC * np.maximum(np.maximum(np.abs(top), np.abs(low)), 1.0 / size)
        angle = np.where(umbilic, 0.0, angle)
        direction = np.cos(angle)[:, None] * a + np.sin(angle)[:, None] * b
        direction /= np.linalg.norm(direction, axis=1)[:, None]
    result = np.stack([top, low], axis=1)
    bad |= ~np.isfinite(result).all(axis=1)
    normal[bad] = result[bad] = direction[bad] = np.nan
    return Curvature(normal, result, direction, bad)
