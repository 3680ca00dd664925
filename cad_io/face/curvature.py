"""Normals, principal curvatures and directions from first and second derivatives of a surface."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Orientation, cross

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
    """Curvature of a surface of which the derivatives S, Su, Sv, Suu, Svv, Suv are given, (n, 6, 3).

    sign: +1 where Su x Sv points out of the material, -1 where it points in. size: of the part, mm: curvatures far below one over
    it have no direction.

    Worked out in an orthonormal frame (a, b) of the tangent plane, a along Su, in which the second fundamental form is a
    symmetric 2 x 2 matrix: its eigenvalues are the curvatures, and the difference of the larger one comes without cancellation.
    With the normal out of the material, S'' . n > 0 means that the surface rises: concave is positive. At umbilics the direction
    is a, the kernel's u tangent.
    """
    from cad_io.surface.differential import differential

    n = len(derivatives)
    result = Curvature(np.empty((n, 3)), np.empty((n, 2)), np.empty((n, 3)), np.empty(n, bool))
    differential(np.ascontiguousarray(derivatives), sign, size, PARALLEL, UMBILIC, result.normal, result.curvature,
                 result.direction_max, result.bad)  # fmt: skip
    return result


def evaluate(part: Any, orientation: Orientation, face: int, uv: Floats) -> tuple[Floats, Curvature]:
    """Points (n, 3), mm, and differential geometry of a face's surface at parameters (n, 2), inside the trim or not."""
    derivatives = part.surface(face).second(uv[:, 0], uv[:, 1])
    sign = float(orientation.sign[face - 1])
    # A column of its own: kernels are compiled again for one with steps between its rows.
    point = np.ascontiguousarray(derivatives[:, 0])
    return point, curvature(derivatives, sign, float(np.linalg.norm(part.size)))


def density(part: Any, face: int, uv: Floats) -> Floats:
    """Area of the surface, mm2, per unit of area in its parameters (n, 2): (n,)."""
    derivatives = part.surface(face).first(uv[:, 0], uv[:, 1])
    return np.linalg.norm(cross(derivatives[:, 1], derivatives[:, 2]), axis=1)
