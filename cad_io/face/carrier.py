"""The carrier of a face: the whole plane, cylinder, cone, sphere or torus that the face is a part of, in part coordinates.

It stays the same where the border of a face changes, and where another system stores the surface in another form.
"""

from dataclasses import replace
from typing import Any

import numpy as np

from cad_io.arrays import Carrier, Floats
from cad_io.surface import Surface

#: Components of a direction that differ by less are equally long: the first of them is positive.
_EQUAL = 1e-6


_FORMS = {"cylinder": "Cylinder", "cone": "Cone", "sphere": "Sphere", "torus": "Torus"}


def stored_carrier(kind: str, adaptor: Any) -> Carrier | None:
    """The carrier of a surface that the kernel stores in closed form; None of others.

    Parameters
    ----------
    kind : str
        As of `FaceInfo.surface`.
    adaptor : BRepAdaptor_Surface
    """
    if kind == "plane":
        position = adaptor.Plane().Position()
        return plane(_array(position.Location()), _array(position.Direction()))
    if kind not in _FORMS:
        return None
    form: Any = getattr(adaptor, _FORMS[kind])()
    if kind == "sphere":
        return sphere(_array(form.Location()), form.Radius())
    axis = form.Axis()
    place, direction = _array(axis.Location()), _array(axis.Direction())
    if kind == "cylinder":
        return cylinder(place, direction, form.Radius())
    if kind == "cone":
        return cone(_array(form.Apex()), direction, abs(form.SemiAngle()))
    return torus(place, direction, form.MajorRadius(), form.MinorRadius())


def plane(place: Floats, normal: Floats) -> Carrier:
    """A plane through a place."""
    direction = _signed(normal)
    return Carrier(_point((place @ direction) * direction), _point(direction))


def cylinder(place: Floats, direction: Floats, radius: float) -> Carrier:
    """A cylinder about an axis through a place."""
    direction = _signed(direction)
    return Carrier(_point(place - (place @ direction) * direction), _point(direction), float(radius))


def cone(apex: Floats, direction: Floats, half_angle: float) -> Carrier:
    """A cone with an apex and an axis."""
    return Carrier(_point(apex), _point(_signed(direction)), half_angle=float(half_angle))


def sphere(centre: Floats, radius: float) -> Carrier:
    """A sphere about a centre."""
    return Carrier(_point(centre), radius=float(radius))


def torus(centre: Floats, direction: Floats, radius: float, minor_radius: float) -> Carrier:
    """A tube about a circle."""
    return Carrier(_point(centre), _point(_signed(direction)), float(radius), float(minor_radius))


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
