"""The surface point of a part at a given place."""

import itertools
from collections.abc import Container, Sequence
from typing import Any

import numpy as np
from OCP.Bnd import Bnd_Box
from OCP.BRep import BRep_Tool
from OCP.BRepBndLib import BRepBndLib
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeVertex
from OCP.BRepExtrema import BRepExtrema_DistShapeShape
from OCP.gp import gp_Pnt
from OCP.ShapeAnalysis import ShapeAnalysis_Surface

from cad_io.arrays import Floats, Orientation, SurfaceSamples
from cad_io.errors import SampleError
from cad_io.face.curvature import evaluate
from cad_io.face.trim import Trim
from cad_io.face.trim import nearest as nearest_segment
from cad_io.kernel import periods, translated
from cad_io.kernel.shapes import compound
from cad_io.part import Part
from plan_cutters_base.forks import Ended, each

_PRECISION = 1e-9  # mm, asked of the projection
#: Processor seconds that a projection may take, and a distance more for each face: they take milliseconds.
SECONDS, _A_FACE = 5.0, 0.1


def locate(
    part: Part, orientation: Orientation, point: Sequence[float], within: float = 1e-3, *, ignore: Container[int] = ()
) -> SurfaceSamples:
    """The sample nearest to a point (3,) in part coordinates, mm, of length 1; its area is 0, for it stands for no part of the
    face.

    within: farthest that the surface may be, mm. Between faces that are equally near, the lowest number counts; numbers in
    `ignore` are not looked at. Raises SampleError where no face is that near, or it has no normal or curvature there.
    """
    place = _place(part, point)
    target = gp_Pnt(*place.tolist())
    near = []
    for number in (f.number for f in part.faces if f.number not in ignore and f.unjudged is None):
        box = Bnd_Box()
        BRepBndLib.Add_s(part.face(number), box, False)
        box.Enlarge(within)
        if not box.IsOut(target):
            near.append(number)

    def projected(number: int) -> tuple[float, tuple[float, float]] | None:
        with translated("projecting a point", error=SampleError, file=part.file, face=f"F{number}"):
            return _projected(part, number, place, within)

    best: tuple[float, int, tuple[float, float]] | None = None
    for number, projection in zip(near, each(projected, near, seconds=SECONDS, hangs=1), strict=True):
        if isinstance(projection, Ended):
            # The face may be the nearest one: without it there is no answer.
            cause = f"projecting a point on it {projection}: give a point on another face, or export the part again"
            raise SampleError(cause, file=part.file, face=f"F{number}")
        if projection is not None and (best is None or projection[0] < best[0] - _PRECISION):
            best = (projection[0], number, projection[1])
    if best is None:
        foot, distance = nearest(part, point, ignore=ignore)
        where, there = (", ".join(f"{x:.6g}" for x in each) for each in (place, foot))
        cause = f"no face within {within:g} mm of ({where}): the nearest is {distance:.4g} mm away, at ({there})"
        raise SampleError(cause, file=part.file)
    _, number, uv = best
    on_face, geometry = evaluate(part, orientation, number, np.array([uv]))
    if geometry.bad.any():
        raise SampleError("the surface has no normal or curvature at this point", file=part.file, face=f"F{number}")
    return SurfaceSamples(
        point=on_face, normal=geometry.normal, direction_max=geometry.direction_max, curvature=geometry.curvature,
        uv=np.array([uv]), face=np.array([number], np.int32), area=np.zeros(1),
        neighbours=np.zeros((0, 2), np.int32), unjudged=np.full(1, -1, np.int32), reasons=(), grids=(), max_gap=0.0,
        empty=(),
    )  # fmt: skip


def foot_on(part: Part, face: int, point: Sequence[float] | Floats, within: float) -> tuple[float, float] | None:
    """Parameters of the point of a trimmed face that is nearest to a place, None if none is within so many mm of it.

    Raises SampleError where the kernel fails on the face.
    """
    with translated("projecting a point", error=SampleError, file=part.file, face=f"F{face}"):
        foot = _projected(part, face, np.asarray(point, float), within)
    return None if foot is None else foot[1]


def nearest(part: Part, point: Sequence[float], *, ignore: Container[int] = ()) -> tuple[Floats, float]:
    """The point (3,) of a part's faces that is nearest to a place (3,) in part coordinates, and its distance, mm.

    Faces with numbers in `ignore` are not looked at. Raises SampleError where there is no face, or the kernel finds no distance.
    """
    place = _place(part, point)
    looked_at = [part.face(info.number) for info in part.faces if info.number not in ignore]

    def measured(shapes: list[Any]) -> tuple[tuple[float, float, float], float] | None:
        with translated("measuring a distance", error=SampleError, file=part.file):
            vertex = BRepBuilderAPI_MakeVertex(gp_Pnt(*place.tolist())).Vertex()
            distance = BRepExtrema_DistShapeShape(vertex, compound(shapes))
            return (distance.PointOnShape2(1).Coord(), float(distance.Value())) if distance.NbSolution() else None

    (measurement,) = each(measured, [looked_at], seconds=SECONDS + _A_FACE * len(looked_at))
    if isinstance(measurement, Ended):
        raise SampleError(f"measuring the distance of a point {measurement}", file=part.file)
    if measurement is None:
        raise SampleError("the part has no face to measure a distance from", file=part.file)
    return np.array(measurement[0]), measurement[1]


def _place(part: Part, point: Sequence[float]) -> Floats:
    place = np.asarray(point, float)
    if place.shape != (3,) or not np.isfinite(place).all():
        raise SampleError(f"a point has three finite coordinates, not {point}", file=part.file)
    return place


def _projected(part: Part, number: int, place: Floats, within: float) -> tuple[float, tuple[float, float]] | None:
    """Distance and parameters of the nearest point of a trimmed face; None if it is not within reach."""
    trim = part.trim(number)
    if trim is None:
        return None
    surface = ShapeAnalysis_Surface(BRep_Tool.Surface_s(part.face(number)))
    uv = surface.ValueOfUV(gp_Pnt(*place.tolist()), _PRECISION)
    adaptor = part.adaptor(number)
    # The kernel may answer on another turn of a periodic surface than the face uses.
    bounds = trim.box[:2], trim.box[2:]
    for u, v in itertools.product(*map(_turns, periods(adaptor), (uv.X(), uv.Y()), bounds)):
        distance = float(np.linalg.norm(np.array(adaptor.Value(u, v).Coord()) - place))
        if distance <= within and _on_face(trim, u, v, within):
            return distance, (u, v)
    return None


def _turns(period: float, value: float, bounds: Sequence[float]) -> list[float]:
    """The value, moved by whole periods into or next to the bounds."""
    if not period:
        return [value]
    first = int(np.floor((bounds[0] - value) / period))
    turns = (value + k * period for k in range(first, first + 3))
    return sorted(turns, key=lambda x: max(bounds[0] - x, x - bounds[1], 0.0))


def _on_face(trim: Trim, u: float, v: float, within: float) -> bool:
    """True if (u, v) lies in the trim, or at most `within` mm beside it: a point on an edge is on both its faces."""
    if trim.inside(np.array([u]), np.array([v]))[0]:
        return True
    return nearest_segment(trim.segments * trim.scale, np.array([u, v]) * trim.scale)[2] <= within
