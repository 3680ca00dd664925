"""The carrier of a face: the whole plane, cylinder, cone, sphere or torus that it is a part of, stored or recognised, in part
coordinates. It stays the same where the border of a face changes, and where another system stores the surface in another form.

Many systems write quadrics as rational B-splines. Curvature rejects nearly every sculptured surface at once; what is
left is fitted, and the fit counts only if the whole surface lies within a tolerance of it: a ridge between two nodes is no
quadric. On each polynomial piece of the surface the shape's equation is a polynomial too, and one that is small at enough
Chebyshev nodes is small between them (Ehlich and Zeller, 1964).
"""

from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from OCP.GeomAbs import GeomAbs_CN

from cad_io.arrays import Carrier, Floats
from cad_io.face.curvature import curvature
from cad_io.kernel import interval_ends
from cad_io.surface import Surface
from cad_io.surface.surface import lines_within

#: Components of a direction that differ by less are equally long: the first of them is positive.
_EQUAL = 1e-6


#: Kinds of surfaces about a centre or an axis, as the kernel calls them.
CLOSED = {"cylinder": "Cylinder", "cone": "Cone", "sphere": "Sphere", "torus": "Torus"}


def closed_form(kind: str, adaptor: Any) -> tuple[Floats, Floats, tuple[float, ...]]:
    """A point of the axis, the unit axis and the radii of a surface of one of `CLOSED`; of a cone the apex and its half angle."""
    form: Any = getattr(adaptor, CLOSED[kind])()
    if kind == "sphere":
        return _array(form.Location()), np.array((0.0, 0.0, 1.0)), (form.Radius(),)
    place, direction = _array(form.Axis().Location()), _array(form.Axis().Direction())
    if kind == "cylinder":
        return place, direction, (form.Radius(),)
    if kind == "cone":
        return _array(form.Apex()), direction, (abs(form.SemiAngle()),)
    return place, direction, (form.MajorRadius(), form.MinorRadius())


def stored_carrier(kind: str, adaptor: Any) -> Carrier | None:
    """The carrier of a surface that the kernel stores in closed form, by its kind in `FaceInfo.surface`; None of others."""
    if kind == "plane":
        position = adaptor.Plane().Position()
        return carrier_of(kind, _array(position.Location()), _array(position.Direction()))
    return carrier_of(kind, *closed_form(kind, adaptor)) if kind in CLOSED else None


def carrier_of(kind: str, place: Floats, direction: Floats, sizes: tuple[float, ...] = ()) -> Carrier:
    """The carrier of a kind about a place, with its axis or normal, and its sizes as `closed_form` has them."""
    names = {"cylinder": ("radius",), "cone": ("half_angle",), "sphere": ("radius",), "torus": ("radius", "minor_radius")}
    numbers: dict[str, Any] = dict(zip(names.get(kind, ()), map(float, sizes), strict=True))
    if kind == "sphere":
        return Carrier(_point(place), **numbers)
    direction = _signed(direction)
    if kind == "plane":
        place = (place @ direction) * direction
    elif kind == "cylinder":
        place = place - (place @ direction) * direction
    return Carrier(_point(place), _point(direction), **numbers)


def sided(carrier: Carrier | None, surface: Surface, box: tuple[float, float, float, float]) -> Carrier | None:
    """The carrier with the side to which `dS/du x dS/dv` points, and a cone's axis from its apex to the face.

    None where a number of it is not finite.
    """
    if carrier is None:
        return None
    at = surface.first(np.array([0.5 * (box[0] + box[1])]), np.array([0.5 * (box[2] + box[3])]))[0]
    away = at[0] - np.array(carrier.point)
    direction = None if carrier.direction is None else np.array(carrier.direction)
    if direction is None:
        out = away
    elif carrier.radius is None and carrier.half_angle is None:
        out = direction
    else:
        along = away @ direction
        if carrier.half_angle is not None and along < 0.0:
            carrier = replace(carrier, direction=_point(-direction))
        out = away - along * direction
        if carrier.minor_radius is not None:
            out = away - carrier.radius * out / max(float(np.linalg.norm(out)), 1e-300)
    inner = float(np.cross(at[1], at[2]) @ out)
    carrier = replace(carrier, side=int(np.sign(inner)) if np.isfinite(inner) else 0)
    sizes = (each for each in (carrier.radius, carrier.minor_radius, carrier.half_angle) if each is not None)
    finite = np.isfinite([*carrier.point, *(carrier.direction or ()), *sizes]).all()
    return carrier if finite else None


def _array(place: Any) -> Floats:
    return np.array(place.Coord())


def _signed(direction: Floats) -> Floats:
    """The unit direction, or its opposite: the first of its longest components is positive."""
    direction = direction / np.linalg.norm(direction)
    size = np.abs(direction)
    first = int(np.argmax(size >= size.max() - _EQUAL))
    return np.asarray(direction if direction[first] > 0.0 else -direction)


def _point(vector: Floats) -> tuple[float, float, float]:
    """Three plain numbers, none of them a negative zero."""
    x, y, z = (np.asarray(vector, float) + 0.0).tolist()
    return x, y, z


#: Farthest that a point may lie from the simple shape: mm, and as a share of the face's size.
WITHIN, WITHIN_SHARE = 1e-3, 1e-4
#: Between the nodes that are looked at first, and beyond them to the borders, so many times as far.
_BETWEEN = 3.0
_NODES = 8
#: Relative spread of a curvature that may still be constant: written shapes wobble, the fit decides.
_VARIATION = 0.1
#: Nodes along a piece of degree p: so many p, and more. Between them a quadric's equation (degree 2 p) is at most 1.3 times,
#: a torus's (4 p) at most 4 times as large as at them.
_EACH, _MORE = 6, 2
#: Nodes along what is no polynomial: angles, and surfaces that only the kernel knows.
_SMOOTH = 24
#: Points looked at together.
_AT_ONCE = 1 << 16


class Fit(NamedTuple):
    """A shape, the distances (n,) of points (n, 3) from it, and the shape itself."""

    kind: str
    distance: Callable[[Floats], Floats]
    carrier: Carrier


def recognise(surface: Surface, box: tuple[float, float, float, float]) -> tuple[str, Carrier | None]:
    """One of SIMPLE_KINDS or `sculptured`, for the surface over a parameter box, and its carrier without a side."""
    share = (np.arange(_NODES) + 0.5) / _NODES
    u, v = (g.ravel() for g in np.meshgrid(box[0] + share * (box[1] - box[0]), box[2] + share * (box[3] - box[2])))
    derivatives = surface.second(u, v)
    geometry = curvature(derivatives)
    if geometry.bad.any():
        return "sculptured", None
    point = derivatives[:, 0]
    size = float(np.linalg.norm(np.ptp(point, axis=0)))
    within = min(WITHIN, WITHIN_SHARE * size)
    for kind, distance, fitted in _fits(point, geometry.normal, geometry.curvature, size):
        if distance(point).max() <= within:
            # Only what the nodes agree with is looked at everywhere.
            whole = all(distance(each).max() <= _BETWEEN * within for each in _everywhere(surface, box))
            return (kind, fitted) if whole else ("sculptured", None)
    return "sculptured", None


def _fits(point: Floats, normal: Floats, kappa: Floats, size: float) -> Iterator[Fit]:
    """Shapes that points with their normals and principal curvatures may lie on."""
    middle = point.mean(axis=0)
    across = np.linalg.svd(point - middle, full_matrices=False)[2][2]
    yield Fit("plane", lambda p: np.abs((p - middle) @ across), carrier_of("plane", middle, across))
    large = float(np.abs(kappa).max())
    if large * size < 1e-3:
        return
    spread = np.ptp(kappa, axis=0)
    constant = spread <= _VARIATION * np.abs(kappa).max(axis=0)
    flat = np.abs(kappa).max(axis=0) <= 1e-2 * large
    if constant.all() and not flat.any() and abs(kappa.mean(axis=0) @ (1, -1)) <= _VARIATION * large:
        centre = (point + normal / kappa.mean(axis=1)[:, None]).mean(axis=0)
        far = np.linalg.norm(point - centre, axis=1)
        radius = 0.5 * float(far.min() + far.max())
        fitted = carrier_of("sphere", centre, across, (radius,))
        yield Fit("sphere", lambda p: np.abs(np.linalg.norm(p - centre, axis=1) - radius), fitted)
    elif flat.any():
        yield from _ruled(point, normal)
    else:
        for tube in np.nonzero(constant)[0]:
            yield _torus(point, normal, float(kappa[:, tube].mean()))


def _everywhere(surface: Surface, box: tuple[float, float, float, float]) -> Iterator[Floats]:
    """Points (n, 3) at Chebyshev nodes of all pieces of a surface, some pieces at a time."""
    form, nodes = surface.form, []
    for axis in range(2):
        ends = (box[2 * axis], box[2 * axis + 1])
        degree = form.degree[axis] if form else 0
        if form is not None:
            knots, _ = lines_within(form.knots[axis], form.jumps[axis], form.period[axis], ends)
        else:
            of = surface.adaptor
            count, lines = (of.NbUIntervals, of.UIntervals) if axis == 0 else (of.NbVIntervals, of.VIntervals)
            knots = interval_ends(count(GeomAbs_CN), lines, GeomAbs_CN)
        inner = [t for t in knots.tolist() if ends[0] < t < ends[1]]
        count = _EACH * degree + _MORE if degree else _SMOOTH
        share = 0.5 - 0.5 * np.cos(np.pi * (np.arange(count) + 0.5) / count)
        nodes.append([a + share * (b - a) for a, b in pairwise([ends[0], *inner, ends[1]])])
    u = np.concatenate(nodes[0])
    rows = max(1, _AT_ONCE // len(u))
    v = np.concatenate(nodes[1])
    for first in range(0, len(v), rows):
        s, t = (g.ravel() for g in np.meshgrid(u, v[first : first + rows]))
        yield surface.values(s, t)


def _circle(flat: Floats) -> tuple[Floats, float]:
    """Centre and radius of the circle through points (n, 2), by least squares."""
    design = np.column_stack([2 * flat, np.ones(len(flat))])
    solution = np.linalg.lstsq(design, (flat**2).sum(axis=1), rcond=None)[0]
    centre = solution[:2]
    return centre, float(np.sqrt(max(solution[2] + centre @ centre, 0.0)))


def _ruled(point: Floats, normal: Floats) -> Iterator[Fit]:
    """Cylinder or cone: the normals of either lie on a circle about the axis."""
    axes = np.linalg.svd(normal - normal.mean(axis=0), full_matrices=False)[2]
    axis = axes[2]
    tilt = normal @ axis  # sine of the half angle: constant on a cone, zero on a cylinder
    if np.ptp(tilt) > 1e-2:
        return
    if abs(float(tilt.mean())) < 1e-4:
        middle, radius = _circle(point @ axes[:2].T)
        fitted = carrier_of("cylinder", middle @ axes[:2], axis, (radius,))
        yield Fit("cylinder", lambda p: np.abs(np.linalg.norm(p @ axes[:2].T - middle, axis=1) - radius), fitted)
        return
    # A cone's points stand off its axis along the normals' part across it, by a distance that is linear in the height.
    flat, height = point @ axes[:2].T, point @ axis
    across = normal @ axes[:2].T
    across /= np.linalg.norm(across, axis=1)[:, None]
    # flat = centre + (r0 + k height) across, unknown: centre, r0, k.
    n = len(point)
    design = np.zeros((2 * n, 4))
    design[:n, 0] = design[n:, 1] = 1.0
    design[:, 2] = across.T.ravel()
    design[:, 3] = (across * height[:, None]).T.ravel()
    *centre, r0, k = np.linalg.lstsq(design, flat.T.ravel(), rcond=None)[0]
    side = np.sign(r0 + k * height.mean())

    def distance(p: Floats) -> Floats:
        radius = np.linalg.norm(p @ axes[:2].T - centre, axis=1)
        return np.asarray(np.abs(radius - side * (r0 + k * (p @ axis))) / np.hypot(1.0, k))

    # Where the radius is zero; without a slope there is no apex, and no number of the carrier is finite.
    with np.errstate(divide="ignore", invalid="ignore"):
        apex = np.asarray(centre) @ axes[:2] - np.divide(r0, k) * axis
    yield Fit("cone", distance, carrier_of("cone", apex, axis, (float(np.arctan(abs(k))),)))


def _torus(point: Floats, normal: Floats, kappa: float) -> Fit:
    """Tube of constant curvature kappa about a circle."""
    spine = point + normal / kappa
    centre = spine.mean(axis=0)
    axes = np.linalg.svd(spine - centre, full_matrices=False)[2]
    middle, radius = _circle((spine - centre) @ axes[:2].T)
    spine_height = float(((spine - centre) @ axes[2]).mean())

    def distance(p: Floats) -> Floats:
        outward = np.linalg.norm((p - centre) @ axes[:2].T - middle, axis=1) - radius
        return np.asarray(np.abs(np.hypot(outward, (p - centre) @ axes[2] - spine_height) - 1 / abs(kappa)))

    place = centre + middle @ axes[:2] + spine_height * axes[2]
    return Fit("torus", distance, carrier_of("torus", place, axes[2], (radius, 1 / abs(kappa))))
