"""The surface of a face at given parameters."""

from typing import Any

import numpy as np

from cad_io.arrays import Floats, Orientation
from cad_io.curvature import Curvature, curvature
from cad_io.kernel import second_derivatives


def evaluate(part: Any, orientation: Orientation, face: int, uv: Floats) -> tuple[Floats, Curvature]:
    """Points (n, 3), mm, and differential geometry of a face's surface at parameters (n, 2), inside the trim or not."""
    derivatives = second_derivatives(part.adaptor(face), uv[:, 0], uv[:, 1])
    sign = float(orientation.sign[face - 1])
    return derivatives[:, 0], curvature(derivatives, sign, float(np.linalg.norm(part.size)))
