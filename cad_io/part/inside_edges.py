"""Where do two faces meet in a sharp inside edge: at an angle below 180 deg through the air, without a fillet?

Edges, normals and curvatures are the kernel's. The border of a sheet, a seam, an edge across which the surface goes on smoothly
and an outside edge are none.
"""

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Curve2d
from OCP.TopoDS import TopoDS_Edge

from cad_io.arrays import Floats, Orientation, Record, cross
from cad_io.face.curvature import curvature
from cad_io.kernel import along, may_refuse
from cad_io.part.blends import SMOOTH
from cad_io.part.part import Part
from cad_io.part.sew import edge_uses

#: Points along an edge, as shares of its parameter: none at its ends, where a face may have no normal.
_SHARES = np.concatenate([[1e-6], np.arange(1, 64) / 64, [1 - 1e-6]])
#: Parameters beyond this are infinite to the kernel.
_INFINITE = 1e50


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class InsideEdge(Record):
    """A sharp inside edge between two faces, at k points along it.

    Attributes
    ----------
    faces : (int, int)
        Numbers of the two faces.
    point : (k, 3) float
        mm.
    normal : (2, k, 3) float
        Unit normals of the two faces, out of the material.
    inward : (2, k, 3) float
        Unit tangents of the two faces, square to the edge, from it into the face.
    curvature : (2, k) float
        Normal curvature of the two faces in these directions, 1/mm, positive where the material rises (concave).
    sharp : (k,) bool
        Points at which the edge is sharp and inside; at the others it is smooth or outside.
    """

    faces: tuple[int, int]
    point: Floats
    normal: Floats
    inward: Floats
    curvature: Floats
    sharp: np.ndarray

    @property
    def angle(self) -> Floats:
        """Angles (k,) between the two faces through the air, rad."""
        return np.asarray(np.arccos(np.clip((self.inward[0] * self.inward[1]).sum(axis=1), -1.0, 1.0)))

    @property
    def length(self) -> float:
        """Length of what is sharp, mm."""
        steps = np.linalg.norm(np.diff(self.point, axis=0), axis=1)
        return float(steps[self.sharp[:-1] & self.sharp[1:]].sum())


def inside_edges(part: Part, orientation: Orientation, without: Collection[int] = ()) -> tuple[InsideEdge, ...]:
    """Find the sharp inside edges of a part, in the order of the kernel's edges.

    An edge that the kernel cannot evaluate on both of its faces is left out, as are faces that cannot be judged.

    Parameters
    ----------
    part : Part
    orientation : Orientation
        The side of each face.
    without : collection of int, optional
        Face numbers that are left out, as if they were not there.
    """
    joined = part.sewn.faces
    edges: list[InsideEdge] = []
    shapes = [joined.get(info.number) or part.face(info.number) for info in part.faces]
    usable = [info.unjudged is None for info in part.faces]
    for edge, every in edge_uses(shapes):
        users = [use for use in every if use[0] + 1 not in without]
        if len(users) != 2 or users[0][0] == users[1][0] or not all(usable[place] for place, _ in users):
            continue
        sides = [_side(part, edge, shapes[place], place, way, float(orientation.sign[place])) for place, way in users]
        if any(side is None for side in sides):
            continue
        (point, *one), (_, *other) = sides  # type: ignore[misc]
        normal, inward, bend = (np.stack(pair) for pair in zip(one, other, strict=True))
        with np.errstate(invalid="ignore"):
            # Into the one face is out of the other's material where the edge is an inside one.
            inside = (inward[0] * normal[1]).sum(axis=1) > np.sin(SMOOTH)
            known = np.isfinite(point).all(axis=1) & np.isfinite(normal).all(axis=(0, 2)) & np.isfinite(bend).all(axis=0)
            opened = (inward[0] * inward[1]).sum(axis=1) < np.cos(SMOOTH)
        sharp = inside & opened
        if (sharp & known).any():
            numbers = (users[0][0] + 1, users[1][0] + 1)
            edges.append(InsideEdge(numbers, point[known], normal[:, known], inward[:, known], bend[:, known], sharp[known]))
    return tuple(edges)


def folded_faces(part: Part, numbers: Collection[int]) -> dict[int, int]:
    """Which of some faces fold back onto a neighbour, each with that: both go the same way from all of an edge between them.

    A smooth surface goes on beyond an edge. One that turns back there bounds a body of no thickness: it is the other part of its
    whole surface than was meant.
    """
    joined = part.sewn.faces
    shapes = [joined.get(info.number) or part.face(info.number) for info in part.faces]
    result: dict[int, int] = {}
    for edge, users in edge_uses(shapes) if numbers else ():
        places = [place for place, _ in users]
        mine = next((n for n in numbers if n - 1 in places), None)
        if mine is None or len(set(places)) != 2 or len(users) != 2:
            continue
        sides = [_side(part, edge, shapes[place], place, way, 1.0) for place, way in users]
        if all(side is not None for side in sides):
            (_, _, one, _), (_, _, other, _) = sides  # type: ignore[misc]
            same = (one * other).sum(axis=1)
            if np.isfinite(same).any() and np.nanmin(same) > np.cos(SMOOTH):
                result.setdefault(mine, next(place + 1 for place in places if place != mine - 1))
    return result


def _side(
    part: Part, edge: TopoDS_Edge, shape: object, place: int, way: int, sign: float
) -> tuple[Floats, Floats, Floats, Floats] | None:
    """A face along one of its edges: points, normals, directions into the face and curvatures there; None where it has none."""
    with may_refuse():
        curve = BRepAdaptor_Curve2d(edge, shape)
        low, high = curve.FirstParameter(), curve.LastParameter()
        if max(-low, high) >= _INFINITE:
            return None
        line = along(curve, low + (high - low) * _SHARES)
        d = part.surface(place + 1).second(line[:, 0, 0].copy(), line[:, 0, 1].copy())
        with np.errstate(all="ignore"):
            geometry = curvature(d, sign, float(np.linalg.norm(part.size)))
            tangent = d[:, 1] * line[:, 1, :1] + d[:, 2] * line[:, 1, 1:]
            # The face is on the left of its border, seen with the surface's own normal towards the eye.
            inward = way * sign * cross(geometry.normal, tangent)
            inward /= np.linalg.norm(inward, axis=1)[:, None]
            cosine = (inward * geometry.direction_max).sum(axis=1)
            high_, low_ = geometry.curvature.T
            return d[:, 0], geometry.normal, inward, low_ + (high_ - low_) * cosine**2
    return None
