"""An enclosure of a trimmed shape: flat cells, each with a bound of how far the exact surface leaves it.

A cell is a quadrilateral with a thickness `delta`: the exact surface over its parameters lies within `delta` of the quadrilateral.
For planes, cylinders, cones, spheres and tori the bound follows from second derivatives, `|S - bilinear| <= (hu^2 max|Suu| + hv^2 max|Svv|) / 8`;
for B-splines from the Bezier control net, whose hull holds the surface: each control point lies within `delta` of the corners' bilinear
patch. How far the corners are from one plane is added, so that the quadrilateral may be taken as flat, and split again without asking the surface.

Cells that a trim curve may cross are split down to `EDGE`; what is left of them is `whole = False`: such a cell counts when safety is proved, and never when a
collision is. Points of the trim curves stand in for them there.
"""

from dataclasses import dataclass
from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepTools import BRepTools
from OCP.BRepTopAdaptor import BRepTopAdaptor_FClass2d
from OCP.GeomAbs import GeomAbs_Cone, GeomAbs_Cylinder, GeomAbs_Plane, GeomAbs_Sphere, GeomAbs_Torus
from OCP.gp import gp_Pnt2d
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE, TopAbs_IN, TopAbs_ON
from OCP.TopExp import TopExp_Explorer
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS, TopoDS_Face, TopoDS_Shape

from conformance.tool import Floats

#: How far (mm) the surface may leave a cell; the size (mm) of cells that the trim crosses; points of trim curves (mm).
DELTA, EDGE, POINTS = 1e-3, 0.06, 0.03


class UnfitError(ValueError):
    """A face that no exact enclosure is made for."""


@dataclass(frozen=True, eq=False)
class Cells:
    """The cells of a shape: `corners (n, 4, 3)` in the order 00, 10, 11, 01, `delta (n,)`, `face (n,)`, `whole (n,)`."""

    corners: Floats
    delta: Floats
    face: NDArray[np.int32]
    whole: NDArray[np.bool_]


def cells(shape: TopoDS_Shape, delta: float = DELTA) -> Cells:
    """Return the cells of all faces of a shape; faces are numbered as the explorer meets them."""
    out, walk, number = [], TopExp_Explorer(shape, TopAbs_FACE), 0
    while walk.More():
        corners, thick, whole = _face(TopoDS.Face_s(walk.Current()), delta)
        out.append((corners, thick, np.full(len(thick), number, np.int32), whole))
        number += 1
        walk.Next()
    return Cells(*(np.concatenate(column) for column in zip(*out, strict=True)))


def _face(face: TopoDS_Face, delta: float) -> tuple[Floats, Floats, NDArray[np.bool_]]:
    """Return corners, thickness and wholeness of a face's cells."""
    adaptor = BRepAdaptor_Surface(face, True)
    kind = adaptor.GetType()
    if kind in (GeomAbs_Plane, GeomAbs_Cylinder, GeomAbs_Cone, GeomAbs_Sphere, GeomAbs_Torus):
        corners, thick, rect = _analytic(adaptor, BRepTools.UVBounds_s(face), delta)
    else:
        corners, thick, rect = _patches(face, delta)
    boxes, on_edge = _trim(face, adaptor)
    corners, thick, rect, whole = _trimmed(BRepTopAdaptor_FClass2d(face, 1e-9), corners, thick, rect, boxes)
    points = np.repeat(on_edge[:, None], 4, axis=1)
    return (np.concatenate([corners, points]), np.concatenate([thick, np.zeros(len(points))]), np.concatenate([whole, np.ones(len(points), bool)]))


def _analytic(adaptor: BRepAdaptor_Surface, bounds: tuple[float, ...], delta: float) -> tuple[Floats, Floats, Floats]:
    u0, u1, v0, v1 = bounds
    suu, svv = _second(adaptor, v0, v1)
    # Half of the thickness for the sag in each direction that bends, what remains for the twist.
    count = lambda span, bend: max(1, int(np.ceil(span * np.sqrt(bend / (8 * 0.4 * delta)))))
    nu, nv = count(u1 - u0, suu), count(v1 - v0, svv)
    u, v = np.linspace(u0, u1, nu + 1), np.linspace(v0, v1, nv + 1)
    grid = np.array([_point(adaptor, a, b) for a in u for b in v]).reshape(nu + 1, nv + 1, 3)
    corners = np.stack([grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]], axis=2).reshape(-1, 4, 3)
    sag = ((u1 - u0) / nu) ** 2 * suu / 8 + ((v1 - v0) / nv) ** 2 * svv / 8
    rect = np.stack([np.repeat(u[:-1], nv), np.repeat(u[1:], nv), np.tile(v[:-1], nu), np.tile(v[1:], nu)], axis=1)
    return corners, sag + _twist(corners), rect


def _twist(corners: Floats) -> Floats:
    """Return how far each quadrilateral is from flat: the distance of its diagonals."""
    a, b, c, d = (corners[:, i] for i in range(4))
    across = np.cross(c - a, d - b)
    size = np.linalg.norm(across, axis=1)
    scale = np.linalg.norm(c - a, axis=1) * np.linalg.norm(d - b, axis=1)
    flat = np.abs(np.einsum("ij,ij->i", b - a, across)) / np.where(size > 1e-9 * scale, size, 1.0)
    # Without two diagonals there is no plane to be flat in: the plain twist is a bound.
    plain = np.linalg.norm(a - b + c - d, axis=1) / 4
    return np.where(size > 1e-9 * scale, flat, plain) + 1e-9


def _point(adaptor: BRepAdaptor_Surface, u: float, v: float) -> list[float]:
    p = adaptor.Value(u, v)
    return [p.X(), p.Y(), p.Z()]


def _second(adaptor: BRepAdaptor_Surface, v0: float, v1: float) -> tuple[float, float]:
    """Return bounds of |Suu| and |Svv| of an analytic surface."""
    kind = adaptor.GetType()
    if kind == GeomAbs_Plane:
        return 0.0, 0.0
    if kind == GeomAbs_Cylinder:
        return adaptor.Cylinder().Radius(), 0.0
    if kind == GeomAbs_Cone:
        cone = adaptor.Cone()
        return max(abs(cone.RefRadius() + v * np.sin(cone.SemiAngle())) for v in (v0, v1)), 0.0
    if kind == GeomAbs_Sphere:
        return adaptor.Sphere().Radius(), adaptor.Sphere().Radius()
    torus = adaptor.Torus()
    return torus.MajorRadius() + torus.MinorRadius(), torus.MinorRadius()


def _patches(face: TopoDS_Face, delta: float) -> tuple[Floats, Floats, Floats]:
    """Return cells of a B-spline face, or of one that the kernel makes one of without a change of parameters."""
    from OCP.Geom import Geom_BSplineSurface, Geom_RectangularTrimmedSurface
    from OCP.GeomAbs import GeomAbs_BezierSurface, GeomAbs_BSplineSurface, GeomAbs_SurfaceOfExtrusion, GeomAbs_SurfaceOfRevolution
    from OCP.GeomConvert import GeomConvert, GeomConvert_BSplineSurfaceToBezierSurface

    kind = BRepAdaptor_Surface(face, True).GetType()
    if kind not in (GeomAbs_BSplineSurface, GeomAbs_BezierSurface):
        names = {GeomAbs_SurfaceOfExtrusion: "an extrusion", GeomAbs_SurfaceOfRevolution: "a surface of revolution"}
        raise UnfitError(f"a face is {names.get(kind, 'an offset or other surface')}")
    where = TopLoc_Location()
    surface = BRep_Tool.Surface_s(face, where)
    if isinstance(surface, Geom_RectangularTrimmedSurface):
        surface = surface.BasisSurface()
    spline = surface.Copy() if isinstance(surface, Geom_BSplineSurface) else GeomConvert.SurfaceToBSplineSurface_s(surface)
    spline.Transform(where.Transformation())
    u0, u1, v0, v1 = BRepTools.UVBounds_s(face)
    if spline.IsUPeriodic():
        spline.SetUNotPeriodic()
    if spline.IsVPeriodic():
        spline.SetVNotPeriodic()
    a0, a1, b0, b1 = spline.Bounds()
    spline.Segment(max(u0, a0), min(u1, a1), max(v0, b0), min(v1, b1), 1e-12, 1e-12)
    bezier = GeomConvert_BSplineSurfaceToBezierSurface(spline)
    nets, rects = [], []
    uk, vk = [spline.UKnot(i + 1) for i in range(spline.NbUKnots())], [spline.VKnot(i + 1) for i in range(spline.NbVKnots())]
    for i in range(bezier.NbUPatches()):
        for j in range(bezier.NbVPatches()):
            nets.append(_net(bezier.Patch(i + 1, j + 1)))
            rects.append([uk[i], uk[i + 1], vk[j], vk[j + 1]])
    return _flat(np.array(nets), np.array(rects), delta)


def _net(patch: Any) -> Floats:
    """Return the homogeneous control net (p + 1, q + 1, 4)."""
    p, q = patch.NbUPoles(), patch.NbVPoles()
    net = np.empty((p, q, 4))
    for i in range(p):
        for j in range(q):
            pole, w = patch.Pole(i + 1, j + 1), patch.Weight(i + 1, j + 1)
            net[i, j] = [pole.X() * w, pole.Y() * w, pole.Z() * w, w]
    return net


def _flat(nets: Floats, rect: Floats, delta: float) -> tuple[Floats, Floats, Floats]:
    """Split Bezier nets until each is flat to `delta`."""
    done: list[tuple[Floats, Floats, Floats]] = []
    while len(nets):
        points = nets[..., :3] / nets[..., 3:]
        p, q = points.shape[1] - 1, points.shape[2] - 1
        s, t = np.linspace(0, 1, p + 1)[None, :, None, None], np.linspace(0, 1, q + 1)[None, None, :, None]
        c = [points[:, 0, 0], points[:, -1, 0], points[:, -1, -1], points[:, 0, -1]]
        a, b, d, e = (x[:, None, None] for x in c)
        plane = (1 - s) * (1 - t) * a + s * (1 - t) * b + s * t * d + (1 - s) * t * e
        off = np.linalg.norm(points - plane, axis=-1).reshape(len(nets), -1).max(axis=1)
        corners = np.stack(c, axis=1)
        thick = off + _twist(corners)
        ok = thick <= delta
        done.append((corners[ok], thick[ok], rect[ok]))
        nets, rect, points = nets[~ok], rect[~ok], points[~ok]
        if not len(nets):
            break
        # Along which direction the net bends more.
        bend_u = np.linalg.norm(np.diff(points, 2, axis=1), axis=-1).reshape(len(nets), -1).max(axis=1) if p > 1 else np.zeros(len(nets))
        bend_v = np.linalg.norm(np.diff(points, 2, axis=2), axis=-1).reshape(len(nets), -1).max(axis=1) if q > 1 else np.zeros(len(nets))
        size_u = np.linalg.norm(points[:, -1, 0] - points[:, 0, 0], axis=1)
        size_v = np.linalg.norm(points[:, 0, -1] - points[:, 0, 0], axis=1)
        first = np.where(np.maximum(bend_u, bend_v) < 0.1 * delta, size_u > size_v, bend_u * p * p >= bend_v * q * q)
        halves = [_halves(nets[first], rect[first], 1), _halves(nets[~first], rect[~first], 2)]
        nets, rect = (np.concatenate([h[k] for h in halves]) for k in (0, 1))
    return tuple(np.concatenate(x) for x in zip(*done, strict=True))  # type: ignore[return-value]


def _halves(nets: Floats, rect: Floats, along: int) -> tuple[Floats, Floats]:
    """Split nets in two at the middle of one direction, by de Casteljau."""
    n = nets.shape[along]
    left, right, row = [], [], np.moveaxis(nets, along, 0)
    for _ in range(n):
        left.append(row[0])
        right.append(row[-1])
        row = 0.5 * (row[:-1] + row[1:])
    parts = [np.moveaxis(np.array(left), 0, along), np.moveaxis(np.array(right[::-1]), 0, along)]
    low, high = rect.copy(), rect.copy()
    k = 0 if along == 1 else 2
    low[:, k + 1] = high[:, k] = 0.5 * (rect[:, k] + rect[:, k + 1])
    return np.concatenate(parts), np.concatenate([low, high])


def _trim(face: TopoDS_Face, adaptor: BRepAdaptor_Surface) -> tuple[Floats, Floats]:
    """Return boxes (k, 4) u0 u1 v0 v1 that hold the trim curves, and points (m, 3) on them."""
    from OCP.Geom2d import Geom2d_TrimmedCurve
    from OCP.Geom2dConvert import Geom2dConvert, Geom2dConvert_BSplineCurveToBezierCurve

    boxes, points = [], []
    walk = TopExp_Explorer(face, TopAbs_EDGE)
    while walk.More():
        edge = TopoDS.Edge_s(walk.Current())
        walk.Next()
        first, last = _range(edge, face)
        curve = BRep_Tool.CurveOnSurface_s(edge, face, first, last)
        if curve is None:
            raise UnfitError("an edge has no curve on its face")
        spline = Geom2dConvert.CurveToBSplineCurve_s(Geom2d_TrimmedCurve(curve, first, last))
        bezier = Geom2dConvert_BSplineCurveToBezierCurve(spline)
        for k in range(bezier.NbArcs()):
            arc = bezier.Arc(k + 1)
            net = np.array(
                [[arc.Pole(i + 1).X() * arc.Weight(i + 1), arc.Pole(i + 1).Y() * arc.Weight(i + 1), arc.Weight(i + 1)] for i in range(arc.NbPoles())]
            )
            length = _length(adaptor, net)
            for piece in _pieces(net, max(1, int(np.ceil(length / (0.5 * EDGE))))):
                poles = piece[:, :2] / piece[:, 2:]
                boxes.append([poles[:, 0].min(), poles[:, 0].max(), poles[:, 1].min(), poles[:, 1].max()])
            for t in np.linspace(0, 1, max(3, int(np.ceil(length / POINTS)))):
                u, v = _on(net, t)
                points.append(_point(adaptor, u, v))
    return np.array(boxes).reshape(-1, 4), np.array(points).reshape(-1, 3)


def _range(edge: Any, face: TopoDS_Face) -> tuple[float, float]:
    from OCP.BRepAdaptor import BRepAdaptor_Curve2d

    curve = BRepAdaptor_Curve2d(edge, face)
    return curve.FirstParameter(), curve.LastParameter()


def _on(net: Floats, t: float) -> tuple[float, float]:
    row = net
    while len(row) > 1:
        row = (1 - t) * row[:-1] + t * row[1:]
    return float(row[0, 0] / row[0, 2]), float(row[0, 1] / row[0, 2])


def _length(adaptor: BRepAdaptor_Surface, net: Floats) -> float:
    walk = np.array([_point(adaptor, *_on(net, t)) for t in np.linspace(0, 1, 9)])
    return float(np.sum(np.linalg.norm(np.diff(walk, axis=0), axis=1)))


def _pieces(net: Floats, count: int) -> list[Floats]:
    """Split a curve's net in at least `count` pieces, by halving."""
    pieces = [net]
    while len(pieces) < count:
        out = []
        for piece in pieces:
            left, right, row = [], [], piece
            for _ in range(len(piece)):
                left.append(row[0])
                right.append(row[-1])
                row = 0.5 * (row[:-1] + row[1:])
            out += [np.array(left), np.array(right[::-1])]
        pieces = out
    return pieces


def _trimmed(trim: BRepTopAdaptor_FClass2d, corners: Floats, thick: Floats, rect: Floats, boxes: Floats) -> tuple[Floats, Floats, Floats, NDArray[np.bool_]]:
    """Drop cells outside the trim, split those that it may cross down to EDGE, and tell the whole ones."""
    done: list[tuple[Any, ...]] = []
    order = np.argsort(boxes[:, 0], kind="stable")
    boxes = np.ascontiguousarray(boxes[order])
    widest = float(np.max(boxes[:, 1] - boxes[:, 0])) if len(boxes) else 0.0
    while len(corners):
        crossed = _crossed(rect, boxes, widest)
        clear = np.flatnonzero(~crossed)
        middle = 0.5 * (rect[clear, 0] + rect[clear, 1]), 0.5 * (rect[clear, 2] + rect[clear, 3])
        inside = np.array([trim.Perform(gp_Pnt2d(u, v)) in (TopAbs_IN, TopAbs_ON) for u, v in zip(*middle, strict=True)], bool)
        kept = clear[inside]
        done.append((corners[kept], thick[kept], rect[kept], np.ones(len(kept), bool)))
        long_u = np.maximum(np.linalg.norm(corners[:, 1] - corners[:, 0], axis=1), np.linalg.norm(corners[:, 2] - corners[:, 3], axis=1))
        long_v = np.maximum(np.linalg.norm(corners[:, 3] - corners[:, 0], axis=1), np.linalg.norm(corners[:, 2] - corners[:, 1], axis=1))
        small = crossed & (np.maximum(long_u, long_v) <= EDGE)
        done.append((corners[small], thick[small], rect[small], np.zeros(int(small.sum()), bool)))
        rows = np.flatnonzero(crossed & ~small)
        by_u = rows[long_u[rows] >= long_v[rows]]
        by_v = rows[long_u[rows] < long_v[rows]]
        parts = [_split(corners[by_u], thick[by_u], rect[by_u], True), _split(corners[by_v], thick[by_v], rect[by_v], False)]
        corners, thick, rect = (np.concatenate([p[k] for p in parts]) for k in range(3))
    return tuple(np.concatenate(x) for x in zip(*done, strict=True))  # type: ignore[return-value]


def _split(corners: Floats, thick: Floats, rect: Floats, along_u: bool) -> tuple[Floats, Floats, Floats]:
    a, b, c, d = (corners[:, i] for i in range(4))
    low, high = rect.copy(), rect.copy()
    if along_u:
        e, f = 0.5 * (a + b), 0.5 * (d + c)
        halves = np.stack([a, e, f, d], axis=1), np.stack([e, b, c, f], axis=1)
        low[:, 1] = high[:, 0] = 0.5 * (rect[:, 0] + rect[:, 1])
    else:
        e, f = 0.5 * (a + d), 0.5 * (b + c)
        halves = np.stack([a, b, f, e], axis=1), np.stack([e, f, c, d], axis=1)
        low[:, 3] = high[:, 2] = 0.5 * (rect[:, 2] + rect[:, 3])
    return np.concatenate(halves), np.concatenate([thick, thick]), np.concatenate([low, high])


@numba.njit(cache=True)
def _crossed(rect: Floats, boxes: Floats, widest: float) -> NDArray[np.bool_]:
    """Whether each rectangle meets a box; boxes are sorted by their first side."""
    out = np.zeros(len(rect), np.bool_)
    start = boxes[:, 0].copy()
    for i in range(len(rect)):
        k = np.searchsorted(start, rect[i, 0] - widest)
        while k < len(boxes) and start[k] <= rect[i, 1]:
            if boxes[k, 1] >= rect[i, 0] and boxes[k, 2] <= rect[i, 3] and boxes[k, 3] >= rect[i, 2]:
                out[i] = True
                break
            k += 1
    return out
