"""Why can a face not be judged? It has no area or no border, its border runs wrong, or it runs through itself."""

from collections.abc import Callable
from itertools import pairwise

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.GeomAbs import GeomAbs_Cone, GeomAbs_OtherSurface, GeomAbs_SurfaceOfRevolution, GeomAbs_Torus
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Face

from cad_io.arrays import Floats
from cad_io.face.measure import Measure
from cad_io.face.trim import Trim
from cad_io.kernel import edges_of
from cad_io.kernel.natural import ENDLESS, endless
from cad_io.surface import Surface

#: Reasons that others look at.
NO_AREA = "has no area"
ROUND_TWICE = "its border runs round it more than once"
WRONG_WAY = "its border runs the wrong way round, and its area would be negative"
CROSSES = "crosses itself (its curve of revolution crosses its axis)"
#: Of faces with these neither the area nor what they enclose is to be believed.
UNMEASURED = (ROUND_TWICE, WRONG_WAY, CROSSES)
#: A border that encloses more than its box does by more than this share runs round it more than once.
_ROUNDED = 1e-3
_TURNED = (GeomAbs_SurfaceOfRevolution, GeomAbs_Torus, GeomAbs_Cone)
#: Points along the curve, halvings of the interval in which it meets the axis, and the share of the face's size that is none.
_POINTS, _HALVINGS, _NONE = 129, 50, 1e-6


def why_unjudged(face: TopoDS_Face, surface: Surface, trim: Trim | None, measured: Measure | None, least: float) -> str | None:
    """Why a face cannot be judged; None if it can.

    Parameters
    ----------
    face : TopoDS_Face
    surface : Surface
    trim, measured : Trim, Measure, optional
        None where its border cannot be read.
    least : float
        Areas up to this are none, mm2.
    """
    if surface.adaptor.GetType() == GeomAbs_OtherSurface:
        if BRep_Tool.Triangulation_s(face, TopLoc_Location()) is not None:
            return "holds only triangles, no surface: export exact geometry (B-rep)"
        return "has no surface that can be evaluated"
    if not edges_of(face):
        return ENDLESS if endless(face) else "has no edges"
    if trim is None or measured is None:
        return "its edges have no finite curve on the surface"
    if not np.isfinite(measured.area):
        return "its surface cannot be evaluated everywhere"
    if trim.closed and trim.uv_area > (1 + _ROUNDED) * trim.box_area:
        return ROUND_TWICE
    if measured.area < -least:
        return WRONG_WAY
    if measured.area <= least:
        return NO_AREA
    return CROSSES if crosses_axis(surface, trim) else None


def crosses_axis(surface: Surface, trim: Trim) -> bool:
    """Whether the curve that makes a surface of revolution leads through the axis, within the border of a face.

    `dS/du` is as long as the distance from the axis, square to the half plane of the curve, and changes its sign with the side of
    the axis. A curve that ends on the axis, or passes it at a distance, does not cross it.
    """
    if surface.adaptor.GetType() not in _TURNED:
        return False
    u0, u1, low, high = trim.box

    def across(v: Floats) -> Floats:
        return surface.first(np.full(len(v), 0.5 * (u0 + u1)), v)[:, 1]

    v = np.linspace(low, high, _POINTS)
    along = across(v)
    if not np.isfinite(along).all():
        return False
    away = np.linalg.norm(along, axis=1)
    none = _NONE * max(float(away.max()), float(trim.scale[1] * (high - low)))
    side = along @ along[int(away.argmax())]
    side = np.sign(side) * (away > none)
    known = np.flatnonzero(side)
    return any(side[a] != side[b] and _least(across, along[a], v[a], v[b]) <= none for a, b in pairwise(known.tolist()))


def _least(across: Callable[[Floats], Floats], reference: Floats, low: float, high: float) -> float:
    """Distance from the axis where the curve changes sides between two parameters, by halving: `reference` is `dS/du` at the
    lower one."""
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if float(across(np.array([middle]))[0] @ reference) > 0.0 else (low, middle)
    return float(np.linalg.norm(across(np.array([low, high])), axis=1).min())
