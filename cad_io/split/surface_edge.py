"""An edge that lies on a face, made from a curve in the face's parameter plane."""

from typing import Any, NamedTuple

import numpy as np
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.gp import gp_Pnt
from OCP.TopAbs import TopAbs_FORWARD, TopAbs_REVERSED
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Edge

from cad_io.arrays import Floats
from cad_io.kernel.splines import cubic
from cad_io.split.contour import Spline
from cad_io.surface import Surface

#: Most that an edge's curve in space may leave its curve on the surface, mm.
DEVIATION = 1e-4
_MOST_POINTS = 5000


class Followed(NamedTuple):
    """A curve on a surface: in space and in the parameter plane, range, ends in space, deviation in mm."""

    space: Any
    plane: Any
    first: float
    last: float
    ends: tuple[Any, Any]
    tolerance: float


def trimmed(spline: Spline, a: float, b: float) -> Spline:
    """The same cubic between two of its parameters."""
    from scipy.interpolate import BSpline, make_interp_spline  # half a second to load

    near = 1e-6 * (b - a)
    inner = spline.knots[(spline.knots > a + near) & (spline.knots < b - near)]
    knots = np.concatenate([[a] * 4, inner, [b] * 4])
    # By rounding, means of equal knots lie beyond them.
    averages = np.clip(np.convolve(knots[1:-1], np.ones(3) / 3, mode="valid"), a, b)
    poles = make_interp_spline(averages, BSpline(spline.knots, spline.poles, 3)(averages), k=3, t=knots).c
    return Spline(knots, np.array(poles), False)


def followed(surface: Surface, spline: Spline) -> Followed:
    """Find the cubic curve in space of the same parameter as a parameter curve.

    The kernel's own builder of curves in space stops silently up to 1 mm off (OCCT 7.9); here the surface is
    interpolated and sites are added where the error, measured between the sites, is above DEVIATION.

    Parameters
    ----------
    surface : Surface
    spline : Spline
        In surface parameters.

    Returns
    -------
    Followed

    Raises
    ------
    ValueError
        The deviation cannot be reached.
    """
    from scipy.interpolate import BSpline, make_interp_spline

    curve = BSpline(spline.knots, spline.poles, 3)

    def at(t: Floats) -> Floats:
        return surface.values(*curve(t).T)

    knots = np.unique(spline.knots)
    averages = np.linspace(knots[0], knots[-1], 9) if len(knots) < 5 else np.union1d(knots, 0.5 * (knots[1:] + knots[:-1]))
    while True:
        space = make_interp_spline(averages, at(averages), k=3)
        gap = np.diff(averages)
        between = np.stack([averages[:-1] + share * gap for share in (0.25, 0.5, 0.75)])
        error = np.linalg.norm(space(between.ravel()) - at(between.ravel()), axis=1).reshape(between.shape).max(axis=0)
        worst = float(error.max())
        if worst < DEVIATION:
            break
        if len(averages) > _MOST_POINTS or not np.isfinite(worst):
            raise ValueError(f"a curve on the surface stays {worst:.1e} mm off its curve in space")
        averages = np.union1d(averages, between[1][error >= DEVIATION])

    ends = gp_Pnt(*space(averages[0]).tolist()), gp_Pnt(*space(averages[-1]).tolist())
    plane = cubic(spline.knots, spline.poles)
    return Followed(cubic(space.t, space.c), plane, float(averages[0]), float(averages[-1]), ends, max(1.2 * worst, 1e-7))


def surface_edge(face: Any, curve: Followed, start: Any, stop: Any) -> Any:
    """Edge along a curve on a face's surface, in part coordinates; its tolerance is the measured deviation.

    Parameters
    ----------
    face : TopoDS_Face
    curve : Followed
        On the face's surface.
    start, stop : TopoDS_Vertex
        Its ends; their tolerance grows where they are farther off.

    Returns
    -------
    TopoDS_Edge
    """
    builder, edge, location = BRep_Builder(), TopoDS_Edge(), TopLoc_Location()
    basis = BRep_Tool.Surface_s(face, location)
    builder.MakeEdge(edge, curve.space, curve.tolerance)
    builder.UpdateEdge(edge, curve.plane, basis, location, curve.tolerance)
    for vertex, orientation, end in zip((start, stop), (TopAbs_FORWARD, TopAbs_REVERSED), curve.ends, strict=True):
        off = BRep_Tool.Pnt_s(vertex).Distance(end)
        builder.UpdateVertex(vertex, max(curve.tolerance, 1.01 * off + 1e-9))
        builder.Add(edge, vertex.Oriented(orientation))
    builder.Range(edge, curve.first, curve.last)
    builder.SameRange(edge, True)
    builder.SameParameter(edge, True)
    return edge
