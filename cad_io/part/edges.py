"""Edges between two faces: smooth ones of blends (fillets and rounds that lead from one face to another), and sharp inside edges.

A blend is a torus, a sphere, a cone or a cylinder in shape, whatever the file calls it; a cone or cylinder turns less than
half a turn. It joins at least two other faces smoothly, each along an edge across which it bends: a wall between two
fillets bends along its edges, not across them, and is no blend. Faces that carry on one and the same surface count as one, so
that a hole of four quarters is a hole.

A sharp inside edge is one at an angle below 180 deg through the air, without a fillet. The border of a sheet, a seam, an edge
across which the surface goes on smoothly and an outside edge are none. Edges, normals and curvatures are the kernel's.
"""

from collections.abc import Collection
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from OCP.BRepAdaptor import BRepAdaptor_Curve2d
from OCP.TopoDS import TopoDS_Edge

from cad_io.arrays import Floats, Orientation, Record, cross
from cad_io.face.curvature import curvature
from cad_io.face.trim import Trim
from cad_io.graphs import connected
from cad_io.kernel import along, may_refuse
from cad_io.part.sew import edge_uses

#: Normals on both sides of a smooth edge agree within this, rad, at so large a share of the points looked at.
SMOOTH, _MOSTLY = np.deg2rad(3.0), 0.75
#: Cones and cylinders that turn as much as this, rad, are no blends: half a turn, less what files are off.
HALF = np.pi - np.deg2rad(1.0)
#: Shapes that a blend may have, and those of them that are none from half a turn on.
_ROUND, _RULED = ("torus", "sphere", "cone", "cylinder"), ("cone", "cylinder")
#: Least share of its largest curvature with which a blend bends across its edges.
_ACROSS = 0.5
#: Two faces of one kind carry on the same surface where their curvatures differ by no more than this share.
_SAME = 0.02
#: Points along an edge, as shares of it, none at its ends; lines each way over a face to tell how far it turns.
_ALONG, _LINES = (np.arange(7) + 0.5) / 7, 9
#: Singular values below this share mean that normals do not turn at all.
_FLAT = 1e-3


class _BlendSide(NamedTuple):
    """A face along its edges, k edges with p points each: unit normals (k, p, 3), curvatures (k, p, 2), how it bends across
    the edge (k, p), all with the surface's own normal; `turned` (n, 3): normals away from its axis, all over it.
    """

    normal: Floats
    curvature: Floats
    across: Floats
    turned: Floats


def _agreements(
    agree: Floats, normal: Floats, kappa: Floats, across: Floats
) -> tuple[NDArray[np.bool_], NDArray[np.bool_], NDArray[np.bool_]]:
    """Whether two faces go on smoothly over their edge (k,), each bends most across it (k, 2), and both bend alike (k,).

    agree (k,): 1 where the two faces' normals are on the same side, -1 where they are not. normal (k, 2, points, 3), kappa (k, 2,
    points, 2), across (k, 2, points): normals, principal curvatures and the curvature across the edge, nan where there are none.
    """
    with np.errstate(invalid="ignore"):
        dot = agree[:, None] * (normal[:, 0] * normal[:, 1]).sum(axis=2)
        smooth = (dot > np.cos(SMOOTH)).mean(axis=1) >= _MOSTLY
        most = np.abs(kappa).max(axis=3)
        least = np.maximum(_ACROSS * most, (1 - _SAME) * np.abs(across[:, ::-1]))
        bends = (np.abs(across) >= least).mean(axis=2) >= _MOSTLY
        # Seen from the other side, what is largest is smallest, with the other sign.
        there = np.where(agree[:, None, None] > 0, kappa[:, 1], -kappa[:, 1, :, ::-1])
        alike = (np.abs(kappa[:, 0] - there).max(axis=2) <= _SAME * most.max(axis=1)).mean(axis=1) >= _MOSTLY
    return smooth, bends, alike


def blends(part: Any) -> frozenset[int]:
    """Numbers of the faces of a part that are blends.

    An edge, or a face, that the kernel cannot evaluate joins nothing smoothly.
    """
    infos, shape = part.faces, [part.joined(info.number) for info in part.faces]
    trims = [part.trim(info.number) for info in infos]
    rounded = [info.shape in _ROUND and info.unjudged is None for info in infos]
    # Those of two different faces, one of them at least of a round shape.
    edges = [
        (edge, users)
        for edge, users in edge_uses(shape)
        if len(users) == 2 and users[0][0] != users[1][0] and (rounded[users[0][0]] or rounded[users[1][0]])
    ]
    if not edges:
        return frozenset()
    owner = np.array([[i for i, _ in users] for _, users in edges])
    # Two faces that follow an edge in opposite directions have their normals on the same side.
    agree = -np.array([users[0][1] * users[1][1] for _, users in edges], float)
    points = len(_ALONG)
    normal = np.full((len(edges), 2, points, 3), np.nan)
    kappa, across = np.full((len(edges), 2, points, 2), np.nan), np.full((len(edges), 2, points), np.nan)
    turned: dict[int, Floats] = {}
    for i in np.unique(owner).tolist():
        mine, which = np.nonzero(owner == i)
        blend = _blend_side(part, i + 1, trims[i], [edges[k][0] for k in mine.tolist()])
        if blend is not None:
            normal[mine, which], kappa[mine, which], across[mine, which], turned[i] = blend
    smooth, bends, alike = _agreements(agree, normal, kappa, across)
    kind = np.array([info.shape for info in infos])
    rounds = np.array(rounded)[owner].all(axis=1)
    on = smooth & alike & rounds & (kind[owner[:, 0]] == kind[owner[:, 1]])
    one = connected(len(infos), owner[on])
    joined: dict[int, set[int]] = {}
    for k, s in zip(*np.nonzero(smooth[:, None] & bends & (one[owner[:, :1]] != one[owner[:, 1:]])), strict=True):
        joined.setdefault(int(one[owner[k, s]]), set()).add(int(one[owner[k, 1 - s]]))
    several = {i for i in turned if rounded[i] and len(joined.get(int(one[i]), ())) > 1}

    def of_one(i: int) -> Floats:
        """Normals (n, 3) of all faces that carry on the same surface as face `i`."""
        return np.concatenate([turned[j] for j in np.flatnonzero(one == one[i]).tolist() if j in turned])

    return frozenset(infos[i].number for i in several if kind[i] not in _RULED or _turn(of_one(i)) < HALF)


def _blend_side(part: Any, number: int, trim: Trim | None, edges: list[TopoDS_Edge]) -> _BlendSide | None:
    """One face along some of its edges; None where it cannot be evaluated."""
    if trim is None:
        return None
    points, (u0, u1, v0, v1) = len(_ALONG), trim.box
    lines, none = [_parameters(edge, part.joined(number), _ALONG) for edge in edges], np.full((points, 2, 2), np.nan)
    line = np.concatenate([none if each is None else each for each in lines])
    share = np.linspace(0.0, 1.0, _LINES)
    u, v = (g.ravel() for g in np.meshgrid(u0 + share * (u1 - u0), v0 + share * (v1 - v0)))
    uv, n, d = line[:, 0], len(line), None
    with may_refuse():
        d = part.surface(number).second(np.concatenate([uv[:, 0], u]), np.concatenate([uv[:, 1], v]))
    if d is None:
        return None
    with np.errstate(all="ignore"):
        geometry = curvature(d, 1.0, float(np.linalg.norm(part.size)))
        tangent = d[:n, 1] * line[:, 1, :1] + d[:n, 2] * line[:, 1, 1:]
        inward = np.cross(geometry.normal[:n], tangent)
        cosine = (inward * geometry.direction_max[:n]).sum(axis=1) / np.linalg.norm(inward, axis=1)
        high, low = geometry.curvature[:n].T
        across = low + (high - low) * cosine**2
        # Where the surface rises round the point, its own normal points at its axis.
        away = -np.sign(geometry.curvature[n:].sum(axis=1))[:, None] * geometry.normal[n:]
    shaped = (len(edges), points)
    return _BlendSide(
        geometry.normal[:n].reshape(*shaped, 3),
        geometry.curvature[:n].reshape(*shaped, 2),
        across.reshape(shaped),
        away[np.isfinite(away).all(axis=1)],
    )


def _parameters(edge: TopoDS_Edge, face: Any, shares: Floats) -> Floats | None:
    """Places (u, v) at shares of an edge of a face, and its directions there: (p, 2, 2); None where it has none."""
    with may_refuse():
        curve = BRepAdaptor_Curve2d(edge, face)
        low, high = curve.FirstParameter(), curve.LastParameter()
        # Parameters beyond this are infinite to the kernel.
        if max(-low, high) < 1e50:
            return along(curve, low + (high - low) * shares)
    return None


def _turn(normal: Floats) -> float:
    """How far normals (n, 3) turn about the axis of the cone or cylinder that they stand on, rad."""
    if len(normal) < 2:
        return 2 * np.pi
    values, axes = np.linalg.svd(normal - normal.mean(axis=0), full_matrices=False)[1:]
    if values[1] < _FLAT * np.sqrt(len(normal)):
        # Less than a tenth of a turn, too little to tell the axis.
        return 0.0
    flat = normal @ axes[:2].T
    angle = np.sort(np.arctan2(flat[:, 1], flat[:, 0]))
    return float(2 * np.pi - np.diff(angle, append=angle[0] + 2 * np.pi).max())


#: Points along an edge, as shares of its parameter: none at its ends, where a face may have no normal.
_SHARES = np.concatenate([[1e-6], np.arange(1, 64) / 64, [1 - 1e-6]])


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class InsideEdge(Record):
    """A sharp inside edge between two faces, at k points along it."""

    #: (int, int); Numbers of the two faces.
    faces: tuple[int, int]
    #: (k, 3); mm.
    point: Floats
    #: (2, k, 3); Unit normals of the two faces, out of the material.
    normal: Floats
    #: (2, k, 3); Unit tangents of the two faces, square to the edge, from it into the face.
    inward: Floats
    #: (2, k); Normal curvature of the two faces in these directions, 1/mm, positive where the material rises (concave).
    curvature: Floats
    #: (k,); Points at which the edge is sharp and inside; at the others it is smooth or outside.
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


def inside_edges(part: Any, orientation: Orientation, without: Collection[int] = ()) -> tuple[InsideEdge, ...]:
    """Find the sharp inside edges of a part, in the order of the kernel's edges.

    An edge that the kernel cannot evaluate on both of its faces is left out, as are faces that cannot be judged, and those with
    numbers in `without`, as if they were not there.
    """
    edges: list[InsideEdge] = []
    shapes = [part.joined(info.number) for info in part.faces]
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


def folded_faces(part: Any, numbers: Collection[int]) -> dict[int, int]:
    """Which of some faces fold back onto a neighbour, each with that: both go the same way from all of an edge between them.

    A smooth surface goes on beyond an edge. One that turns back there bounds a body of no thickness: it is the other part of its
    whole surface than was meant.
    """
    shapes = [part.joined(info.number) for info in part.faces]
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
    part: Any, edge: TopoDS_Edge, shape: Any, place: int, way: int, sign: float
) -> tuple[Floats, Floats, Floats, Floats] | None:
    """A face along one of its edges: points, normals, directions into the face and curvatures there; None where it has none."""
    line = _parameters(edge, shape, _SHARES)
    if line is None:
        return None
    with may_refuse():
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
