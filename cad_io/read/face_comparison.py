"""Did a face come out as it was written? Asked where the transfer had trouble with it."""

from collections.abc import Sequence

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve, BRepAdaptor_Curve2d
from OCP.gp import gp_Pnt
from OCP.TopAbs import TopAbs_EDGE, TopAbs_WIRE
from OCP.TopExp import TopExp
from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Face

from cad_io.arrays import Floats
from cad_io.kernel import edges_of, explore, may_refuse, shape_map
from cad_io.surface import Surface

#: Borders this near to the surface, mm, or in shares of the face's size, lie on it.
_NEAR, _NEAR_SHARE = 1e-2, 1e-4
#: Where the other faces of the file are looser than that, as far as this, mm, so may the one in question be.
_LOOSEST = 0.1
_ALONG = np.linspace(0.0, 1.0, 9)


def open_border(face: TopoDS_Face) -> bool:
    """True if some border of the face does not close."""
    return not all(BRep_Tool.IsClosed_s(wire) for wire in explore(face, TopAbs_WIRE))


def edge_count(face: TopoDS_Face) -> int:
    """Edges that have a length; a seam counts once."""
    edges = shape_map(face, TopAbs_EDGE)
    return sum(not BRep_Tool.Degenerated_s(TopoDS.Edge_s(edges.FindKey(i + 1))) for i in range(edges.Extent()))


def misfit(face: TopoDS_Face, others: Sequence[TopoDS_Face] = ()) -> str:
    """Why a face's border and surface cannot both be right; empty where they fit.

    Border curves are written by themselves: where all of them lie on the surface, both are as meant.

    Parameters
    ----------
    face : TopoDS_Face
    others : sequence of TopoDS_Face
        Faces of the same file that had no trouble, to see how closely its borders lie on its surfaces.
    """
    off, size = _gap(face)
    if not np.isfinite(size):
        return "it has no border that could confirm its surface"
    if off <= max(_NEAR, _NEAR_SHARE * size):
        return ""
    usual = max((gap for gap, _ in map(_gap, others) if np.isfinite(gap)), default=0.0)
    return "" if off <= min(usual, _LOOSEST) else f"its border leaves its surface by {off:.3g} mm"


def _gap(face: TopoDS_Face) -> tuple[float, float]:
    """Largest distance of a face's border curves and their ends from its surface, and their extent, mm."""
    with may_refuse():
        off, points = _measured(face)
        return off, float(np.linalg.norm(np.ptp(points, axis=0))) if len(points) else np.inf
    return np.inf, np.inf


def _measured(face: TopoDS_Face) -> tuple[float, Floats]:
    """Largest distance of border curves from the surface and of their ends from the vertices, mm; their points (n, 3)."""
    surface, off, seen = Surface(face), 0.0, [np.zeros((0, 3))]
    for edge in edges_of(face):
        if BRep_Tool.Degenerated_s(edge) or not _has_curve(edge):
            continue
        curve, flat = BRepAdaptor_Curve(edge), BRepAdaptor_Curve2d(edge, face)
        first, last = curve.FirstParameter(), curve.LastParameter()
        parameters = (first + (last - first) * _ALONG).tolist()
        there = np.array([curve.Value(t).Coord() for t in parameters])
        uv = np.array([flat.Value(t).Coord() for t in parameters])
        distance = np.linalg.norm(surface.values(uv[:, 0], uv[:, 1]) - there, axis=1)
        ends = [TopExp.FirstVertex_s(edge), TopExp.LastVertex_s(edge)]
        beyond = [
            0.0 if v.IsNull() else BRep_Tool.Pnt_s(v).Distance(gp_Pnt(*there[k])) for v, k in zip(ends, (0, -1), strict=True)
        ]
        off = max(off, *beyond, float(distance.max() if np.isfinite(distance).all() else np.inf))
        seen.append(there)
    return off, np.concatenate(seen)


def _has_curve(edge: TopoDS_Edge) -> bool:
    return BRep_Tool.Curve_s(edge, 0.0, 0.0) is not None
