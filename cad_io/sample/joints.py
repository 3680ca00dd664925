"""Which samples of different faces lie next to each other across a smooth joint?"""

from collections import defaultdict
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve2d
from OCP.TopoDS import TopoDS_Edge, TopoDS_Face
from OCP.TopTools import TopTools_IndexedMapOfShape
from scipy.spatial import cKDTree

from cad_io.arrays import Floats, Ints, Orientation, cross, rows_by_face
from cad_io.kernel import edges_of, points_on
from cad_io.part import Part
from cad_io.surface import Surface

#: Normals (out of the material) on both sides of a smooth joint agree within this, rad.
SMOOTH = np.deg2rad(1.0)
#: Samples are linked when not farther apart than so many gaps.
REACH = 1.5
_POINTS = (3, 200)  # least and most points looked at along one edge


def smooth_joints(part: Part, orientation: Orientation, point: Floats, face: Ints, gap: Mapping[int, float]) -> NDArray[np.intp]:
    """Pairs (m, 2) of samples of different faces, nearest to the same point of a smooth common edge.

    Parameters
    ----------
    part : Part
    orientation : Orientation
    point : (n, 3) float
        Samples, in the order of their faces.
    face : (n,) int
        Their face numbers.
    gap : mapping
        Largest distance between grid neighbours, mm, by face number; its keys are the sampled faces.
    """
    edges = TopTools_IndexedMapOfShape()
    uses: dict[int, list[tuple[int, TopoDS_Edge]]] = defaultdict(list)
    for number in gap:
        for edge in edges_of(_joined(part, number)):
            uses[edges.Add(edge)].append((number, edge))
    trees: dict[int, tuple[cKDTree, NDArray[np.intp]]] = {}
    finite = np.flatnonzero(np.isfinite(point).all(axis=1))
    rows_of = {number: finite[rows] for number, rows in rows_by_face(face[finite]).items()}
    pairs = [np.zeros((0, 2), np.intp)]
    for users in uses.values():
        if len(users) != 2 or users[0][0] == users[1][0] or BRep_Tool.Degenerated_s(users[0][1]):
            continue
        reach = REACH * max(gap[number] for number, _ in users)
        curves = [_curve(part, number, edge) for number, edge in users]
        share = _shares(curves[0], reach)
        if share is None:
            continue
        (at, normal_a), (_, normal_b) = (
            _side(part, orientation, number, curve, share) for (number, _), curve in zip(users, curves, strict=True)
        )
        smooth = (normal_a * normal_b).sum(axis=1) > np.cos(SMOOTH)
        if not smooth.any():
            continue
        nearest = []
        for number, _ in users:
            if number not in trees:
                rows = rows_of.get(number, finite[:0])
                trees[number] = (cKDTree(point[rows]), rows)
            tree, rows = trees[number]
            nearest.append(rows[tree.query(at[smooth])[1]])
        joints = np.unique(np.stack(nearest, axis=1), axis=0)
        distance = np.linalg.norm(point[joints[:, 0]] - point[joints[:, 1]], axis=1)
        pairs.append(joints[distance <= reach])
    return np.concatenate(pairs)


class _Curve(NamedTuple):
    """An edge's parameter curve on one of its faces; the range is the edge's own, the same for both faces."""

    surface: Surface
    curve: BRepAdaptor_Curve2d
    low: float
    high: float

    def derivatives(self, share: Floats) -> Floats:
        """S, Su, Sv (k, 3, 3) at shares of the range."""
        t = self.low + (self.high - self.low) * share
        uv = points_on(self.curve, t)
        return self.surface.first(uv[:, 0], uv[:, 1])


def _joined(part: Part, number: int) -> TopoDS_Face:
    """A face with the edges that it shares with faces it touches, in a solid or sewn; the surface is the part's own."""
    return part.sewn.faces.get(number) or part.face(number)


def _curve(part: Part, number: int, edge: TopoDS_Edge) -> _Curve:
    low, high = BRep_Tool.Range_s(edge)
    return _Curve(part.surface(number), BRepAdaptor_Curve2d(edge, _joined(part, number)), low, high)


def _shares(curve: _Curve, reach: float) -> Floats | None:
    """Where to look along an edge: two points a reach; None if it cannot be evaluated."""
    if not (np.isfinite([curve.low, curve.high]).all() and max(-curve.low, curve.high) < 1e50):
        return None
    rough = curve.derivatives(np.linspace(0.0, 1.0, 9))[:, 0]
    length = float(np.linalg.norm(np.diff(rough, axis=0), axis=1).sum())
    if not np.isfinite(length):
        return None
    count = int(np.clip(np.ceil(2 * length / max(reach, 1e-12)), *_POINTS))
    return (np.arange(count) + 0.5) / count


def _side(part: Part, orientation: Orientation, number: int, curve: _Curve, share: Floats) -> tuple[Floats, Floats]:
    """Points (k, 3) along an edge and one face's normals (k, 3) there, out of the material."""
    d = curve.derivatives(share)
    with np.errstate(all="ignore"):
        normal = cross(d[:, 1], d[:, 2])
        normal *= orientation.sign[number - 1] / np.linalg.norm(normal, axis=1)[:, None]
    return d[:, 0], normal
