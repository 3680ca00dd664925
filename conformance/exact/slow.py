"""The slow twin: margins by points of the exact surface, no triangles, no closed form.

A grid of points of every face, kept where the trim has them, then from the deepest a shrinking pattern on the face itself. What it
gives is a margin that is never too small: points alone cannot miss the other way.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve, BRepAdaptor_Surface
from OCP.BRepTools import BRepTools
from OCP.BRepTopAdaptor import BRepTopAdaptor_FClass2d
from OCP.gp import gp_Pnt2d
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE, TopAbs_IN, TopAbs_ON
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS, TopoDS_Face, TopoDS_Shape

from conformance.tool import Floats, Tool


@dataclass(frozen=True, eq=False)
class Face:
    """A trimmed face with its points: `points (n, 3)`, `uv (n, 2)`, pitch `du`, `dv` of the grid, and `edges (m, 3)`, points of its edges.

    No point of the face is farther than `near` (mm) from all of these, so no search from them gains more.
    """

    adaptor: BRepAdaptor_Surface
    trim: BRepTopAdaptor_FClass2d
    points: Floats
    uv: Floats
    pitch: tuple[float, float]
    edges: Floats
    near: float = np.inf

    def at(self, u: float, v: float) -> Floats:
        """Return a point of the surface."""
        p = self.adaptor.Value(u, v)
        return np.array([p.X(), p.Y(), p.Z()])

    def holds(self, u: float, v: float) -> bool:
        """Whether the face has the parameters."""
        return self.trim.Perform(gp_Pnt2d(u, v)) in (TopAbs_IN, TopAbs_ON)


def read(path: Path) -> TopoDS_Shape:
    """Read a STEP file, in mm."""
    from OCP.IFSelect import IFSelect_RetDone
    from OCP.STEPControl import STEPControl_Reader

    reader = STEPControl_Reader()
    if reader.ReadFile(str(path)) != IFSelect_RetDone:
        raise ValueError(f"{path.name}: no STEP file that can be read")
    reader.TransferRoots()
    return reader.OneShape()


def faces(shape: TopoDS_Shape, pitch: float) -> list[Face]:
    """Return the faces of a shape with points at most about `pitch` (mm) apart."""
    out, walk = [], TopExp_Explorer(shape, TopAbs_FACE)
    while walk.More():
        out.append(_face(TopoDS.Face_s(walk.Current()), pitch))
        walk.Next()
    return out


def _face(face: TopoDS_Face, pitch: float) -> Face:
    adaptor = BRepAdaptor_Surface(face, True)
    trim = BRepTopAdaptor_FClass2d(face, 1e-9)
    u0, u1, v0, v1 = BRepTools.UVBounds_s(face)

    def steps(lines: list[tuple[tuple[float, float], tuple[float, float]]]) -> int:
        longest = 0.0
        for a, b in lines:
            walk = np.array([_point(adaptor, a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])) for t in np.linspace(0, 1, 33)])
            longest = max(longest, float(np.sum(np.linalg.norm(np.diff(walk, axis=0), axis=1))))
        return int(np.clip(np.ceil(longest / pitch), 2, 400))

    vm, um = 0.5 * (v0 + v1), 0.5 * (u0 + u1)
    nu = steps([((u0, v), (u1, v)) for v in (v0, vm, v1)])
    nv = steps([((u, v0), (u, v1)) for u in (u0, um, u1)])
    uv = np.array([(u, v) for u in np.linspace(u0, u1, nu + 1) for v in np.linspace(v0, v1, nv + 1)])
    kept = np.array([trim.Perform(gp_Pnt2d(u, v)) in (TopAbs_IN, TopAbs_ON) for u, v in uv])
    uv = uv[kept]
    points = np.array([_point(adaptor, u, v) for u, v in uv]).reshape(-1, 3)
    return Face(adaptor, trim, points, uv, ((u1 - u0) / nu, (v1 - v0) / nv), _edges(face, pitch), 1.5 * pitch)


def _point(adaptor: BRepAdaptor_Surface, u: float, v: float) -> list[float]:
    p = adaptor.Value(u, v)
    return [p.X(), p.Y(), p.Z()]


def _edges(face: TopoDS_Face, pitch: float) -> Floats:
    out, walk = [], TopExp_Explorer(face, TopAbs_EDGE)
    while walk.More():
        edge = TopoDS.Edge_s(walk.Current())
        walk.Next()
        if BRep_Tool.Degenerated_s(edge):
            continue
        curve = BRepAdaptor_Curve(edge)
        # Ten times as dense as the faces: an edge has no second direction to search.
        for t in np.linspace(curve.FirstParameter(), curve.LastParameter(), max(9, min(4000, int(_span(curve) / pitch * 10)))):
            p = curve.Value(t)
            out.append([p.X(), p.Y(), p.Z()])
    return np.array(out).reshape(-1, 3)


def _span(curve: BRepAdaptor_Curve) -> float:
    walk = []
    for t in np.linspace(curve.FirstParameter(), curve.LastParameter(), 17):
        p = curve.Value(t)
        walk.append([p.X(), p.Y(), p.Z()])
    return float(np.sum(np.linalg.norm(np.diff(walk, axis=0), axis=1)))


def least(face: Face, tool: Tool, tip: Floats, axis: Floats, *, below: float = np.inf, rounds: int = 45, seeds: int = 4) -> float:
    """Return the least signed distance of one posture's tool from a face: negative is a depth; where it is not `below`, any such number."""
    best = float(np.min(tool.signed(face.edges, tip, axis), initial=np.inf))
    if not len(face.points):
        return best
    values = tool.signed(face.points, tip, axis)
    for k in _apart(face.points, values, seeds, 2.0 * face.near):
        (u, v), value, (du, dv) = face.uv[k], float(values[k]), face.pitch
        if min(best, value) - face.near > below:
            break
        for turns in range(rounds):
            # The pattern turns: along the crease that an edge of the tool makes, few directions go down.
            angles = 2.4 * turns + np.arange(16) * np.pi / 8
            scale = np.where(np.arange(16) % 2 == 0, 1.0, 0.35)
            tries = list(zip(u + du * scale * np.cos(angles), v + dv * scale * np.sin(angles), strict=True))
            tries = [t for t in tries if face.holds(*t)]
            if tries:
                new = tool.signed(np.array([face.at(*t) for t in tries]), tip, axis)
                pick = int(np.argmin(new))
                if new[pick] < value:
                    value, (u, v) = float(new[pick]), tries[pick]
            du, dv = du * 0.7, dv * 0.7
        best = min(best, value)
    return best


def _apart(points: Floats, values: Floats, count: int, way: float) -> list[int]:
    """Return the lowest points, no two within `way` (mm): a tool that touches at one point may enter the face at another."""
    values, out = values.copy(), []
    for _ in range(min(count, len(values))):
        k = int(np.argmin(values))
        if not np.isfinite(values[k]):
            break
        out.append(k)
        values[np.linalg.norm(points - points[k], axis=1) < (way if np.isfinite(way) else 0.0)] = np.inf
        values[k] = np.inf
    return out


def margin(listed: list[Face], exempt: list[bool], tool: Tool, tip: Floats, axis: Floats, touch: float = 1e-6) -> float:
    """Return the margin of one posture by points: depth counts on every face, clearance on those that are not `exempt`."""
    worst = 1000.0
    first = [float(np.min(tool.signed(np.vstack([f.edges, f.points]), tip, axis), initial=np.inf)) for f in listed]
    for k in np.argsort(first, kind="stable"):
        value = least(listed[k], tool, tip, axis, below=-touch if exempt[k] else worst)
        worst = min(worst, 1000.0 if exempt[k] and value > -touch else value)
    return worst
