"""What a surface is in shape, whatever the file calls it: plane, cylinder, cone, sphere, torus or sculptured.

Many systems write quadrics as rational B-splines. Curvature rejects nearly every sculptured surface at once; what is
left is fitted, and the fit counts only if every point lies within a tolerance of it.
"""

import numpy as np

from cad_io.arrays import Floats
from cad_io.face.curvature import curvature
from cad_io.surface import Surface

#: Farthest that a point may lie from the simple shape: mm, and as a share of the face's size.
WITHIN, WITHIN_SHARE = 1e-3, 1e-4
_NODES = 8
#: Relative spread of a curvature that may still be constant: written shapes wobble, the fit decides.
_WOBBLE = 0.1


def recognise(surface: Surface, box: tuple[float, float, float, float]) -> str:
    """One of SIMPLE_KINDS or `sculptured`, for the surface over a parameter box."""
    share = (np.arange(_NODES) + 0.5) / _NODES
    u, v = (g.ravel() for g in np.meshgrid(box[0] + share * (box[1] - box[0]), box[2] + share * (box[3] - box[2])))
    derivatives = surface.second(u, v)
    geometry = curvature(derivatives)
    if geometry.bad.any():
        return "sculptured"
    point, normal, kappa = derivatives[:, 0], geometry.normal, geometry.curvature
    size = float(np.linalg.norm(np.ptp(point, axis=0)))
    within = min(WITHIN, WITHIN_SHARE * size)
    if _off_plane(point) <= within:
        return "plane"
    large = float(np.abs(kappa).max())
    if large * size < 1e-3:
        return "sculptured"
    spread = np.ptp(kappa, axis=0)
    constant = spread <= _WOBBLE * np.abs(kappa).max(axis=0)
    flat = np.abs(kappa).max(axis=0) <= 1e-2 * large
    if constant.all() and not flat.any() and abs(kappa.mean(axis=0) @ (1, -1)) <= _WOBBLE * large:
        centre = (point + normal / kappa.mean(axis=1)[:, None]).mean(axis=0)
        return "sphere" if np.ptp(np.linalg.norm(point - centre, axis=1)) <= 2 * within else "sculptured"
    if flat.any():
        return _ruled(point, normal, within)
    for tube in np.nonzero(constant)[0]:
        if _is_torus(point, normal, float(kappa[:, tube].mean()), within):
            return "torus"
    return "sculptured"


def _off_plane(point: Floats) -> float:
    centred = point - point.mean(axis=0)
    return float(np.abs(centred @ np.linalg.svd(centred, full_matrices=False)[2][2]).max())


def _circle(flat: Floats) -> tuple[Floats, float, Floats]:
    """Centre, radius and residuals of the circle through points (n, 2), by least squares."""
    design = np.column_stack([2 * flat, np.ones(len(flat))])
    solution = np.linalg.lstsq(design, (flat**2).sum(axis=1), rcond=None)[0]
    centre = solution[:2]
    radius = float(np.sqrt(max(solution[2] + centre @ centre, 0.0)))
    return centre, radius, np.linalg.norm(flat - centre, axis=1) - radius


def _ruled(point: Floats, normal: Floats, within: float) -> str:
    """Cylinder or cone: the normals of either lie on a circle about the axis."""
    axes = np.linalg.svd(normal - normal.mean(axis=0), full_matrices=False)[2]
    axis = axes[2]
    lean = normal @ axis  # sine of the half angle: constant on a cone, zero on a cylinder
    if np.ptp(lean) > 1e-2:
        return "sculptured"
    slope = float(lean.mean())
    flat, height = point @ axes[:2].T, point @ axis
    if abs(slope) < 1e-4:
        return "cylinder" if np.abs(_circle(flat)[2]).max() <= within else "sculptured"
    # A cone's points stand off its axis along the normals' part across it, by a distance that is linear in the height.
    across = normal @ axes[:2].T
    across /= np.linalg.norm(across, axis=1)[:, None]
    # flat = centre + (r0 + k height) across, unknown: centre, r0, k.
    n = len(point)
    design = np.zeros((2 * n, 4))
    design[:n, 0] = design[n:, 1] = 1.0
    design[:, 2] = across.T.ravel()
    design[:, 3] = (across * height[:, None]).T.ravel()
    centre_x, centre_y, r0, k = np.linalg.lstsq(design, flat.T.ravel(), rcond=None)[0]
    radius = np.hypot(flat[:, 0] - centre_x, flat[:, 1] - centre_y)
    side = np.sign(r0 + k * height)
    off = (radius - side * (r0 + k * height)) / np.hypot(1.0, k)
    return "cone" if np.abs(off).max() <= within else "sculptured"


def _is_torus(point: Floats, normal: Floats, kappa: float, within: float) -> bool:
    """Tube of constant curvature kappa about a circle."""
    spine = point + normal / kappa
    centre = spine.mean(axis=0)
    axes = np.linalg.svd(spine - centre, full_matrices=False)[2]
    height = (point - centre) @ axes[2]
    flat = (spine - centre) @ axes[:2].T
    middle, radius, _ = _circle(flat)
    outward = np.linalg.norm((point - centre) @ axes[:2].T - middle, axis=1) - radius
    spine_height = float(((spine - centre) @ axes[2]).mean())
    off = np.hypot(outward, height - spine_height) - 1 / abs(kappa)
    return bool(np.abs(off).max() <= within)
