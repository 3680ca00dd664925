"""The surface of a face at given parameters."""

from typing import Any

import numpy as np

from cad_io.arrays import Floats, Orientation, cross
from cad_io.face.curvature import Curvature, curvature


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
