"""How far a body reaches from an axis at each height: lines in a half-plane through the axis that enclose it.

A line stands for the part of the body at its heights: the body is nowhere farther from the axis there. Faces that turn about the
axis give the line of their own, or tangents and chords of their arc; all others are enclosed by their triangles and what these
may be off.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve, BRepAdaptor_Curve2d, BRepAdaptor_Surface
from OCP.BRepTools import BRepTools
from OCP.GeomAbs import GeomAbs_Circle, GeomAbs_Line

from cad_io.arrays import Floats, Record
from cad_io.errors import ReadError
from cad_io.face.carrier import CLOSED
from cad_io.kernel import edges_of, kind_of, translated
from cad_io.part import Part
from cad_io.tessellate.triangles import tessellate

#: Distance from the axis, mm, and angle to it up to which a surface turns about it.
_ON = 1e-7
#: Parameters that differ by no more are the same, mm and rad.
_SAME = 1e-7
#: Parameters beyond this are none: a face that is not trimmed.
_FARTHEST = 1e6


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Meridian(Record):
    """Lines that enclose a body."""

    #: (n, 4); distance from the axis and height of both ends, mm, the lower end first.
    line: Floats
    #: (n,); the line is on the body; others lie outside of it by up to `off`.
    exact: NDArray[np.bool_]
    #: mm.
    off: float
    #: Height of the body's lowest point, or a little less where that is not known exactly; lines are made for this one.
    foot: float
    #: Numbers of the faces that do not turn about the axis.
    loose: tuple[int, ...]


def meridian(part: Part, origin: Sequence[float], direction: Sequence[float], chord: float) -> Meridian:
    """Lines that enclose a part about an axis, mm, and may lie so far (`chord`, mm) outside of it; heights count from `origin`
    along `direction`.

    Raises ReadError where a face cannot be meshed, so that it is not known how far it reaches.
    """
    base, along = np.array(origin, float), np.array(direction, float)
    along = along / np.linalg.norm(along)
    lines: list[tuple[float, float, float, float]] = []
    exact: list[bool] = []
    meshed, loose = [], []
    with translated("looking for the outline of a body of revolution", error=ReadError):
        for face in part.faces:
            turning = _turning(part.face(face.number), base, along, chord)
            if not turning:
                meshed.append(face.number)
            if turning is None:
                loose.append(face.number)
            for (q, w, r, h), on_body in turning or ():
                lines.append((q, w, r, h) if w <= h else (r, h, q, w))
                exact.append(on_body)
    off = 0.0 if all(exact) else chord
    line, own, foot = (np.array(lines).reshape(-1, 4), np.array(exact, bool), min((row[1] for row in lines), default=math.inf))
    if meshed:
        triangles = tessellate(part, chord, faces=meshed)
        if triangles.missing:
            number, why = triangles.missing[0]
            raise ReadError(f"how far it reaches is not known: {why}", face=f"F{number}")
        error = triangles.chord_error
        sides, upward = _sides(triangles.vertex, base, along), error
        lowest = float(sides[:, 1].min()) - error
        if lowest < foot:
            # The true foot is at most twice the error higher: lines hold wherever it is.
            foot, upward = lowest, 3.0 * error
            line, own = _grown(line, 0.0, 2.0 * error), np.zeros(2 * len(line), bool)
        line = np.vstack([line, _grown(sides, error, upward)])
        own = np.append(own, np.zeros(len(line) - len(own), bool))
        off = max(off, error + upward)
    return Meridian(line, own, off, foot, tuple(loose))


_Lines = list[tuple[tuple[float, float, float, float], bool]]


def _disk(face: Any, plane: Any, base: Floats, along: Floats) -> _Lines | None:
    """The line of a plane face that turns about the axis: across it, to its farthest circle."""
    if not _coaxial(None, plane.Axis().Direction(), base, along):
        return None
    height = float((_xyz(plane.Location()) - base) @ along)
    radii = [_circle(edge, base, along) for edge in edges_of(face)]
    known = [radius for radius in radii if radius is not None]
    return [((0.0, height, max(known), height), True)] if radii and len(known) == len(radii) else None


def _turning(face: Any, base: Floats, along: Floats, chord: float) -> _Lines | None:
    """Lines of a face that turns about the axis, none where they are not known; None where it does not turn about it."""
    surface = BRepAdaptor_Surface(face)
    kind = kind_of(surface)
    _, _, v0, v1 = BRepTools.UVBounds_s(face)
    if kind == "Plane":
        return _disk(face, surface.Plane(), base, along)
    if kind == "SurfaceOfRevolution":
        axis = surface.AxeOfRevolution()
        return [] if _coaxial(axis.Location(), axis.Direction(), base, along) else None
    if kind not in CLOSED.values() or max(abs(v0), abs(v1)) > _FARTHEST:
        return None
    body = getattr(surface, kind)()
    upward = body.Position().Direction()
    if not _coaxial(body.Location(), upward, base, along):
        # A sphere turns about every line through its centre; but in a frame that does not, its parameters are no heights.
        return [] if kind == "Sphere" and _coaxial(body.Location(), None, base, along) else None
    if not _ends(face, v0, v1):
        return []
    up = math.copysign(1.0, float(_xyz(upward) @ along))
    foot = float((_xyz(body.Location()) - base) @ along)
    if kind == "Sphere":
        return list(_arc(0.0, foot, body.Radius(), up, v0, v1, chord))
    if kind == "Torus":
        return list(_arc(body.MajorRadius(), foot, body.MinorRadius(), up, v0, v1, chord))
    if kind == "Cylinder":
        return [((body.Radius(), foot + up * v0, body.Radius(), foot + up * v1), True)]
    slope = body.SemiAngle()
    ends = [(abs(body.RefRadius() + v * math.sin(slope)), foot + up * v * math.cos(slope)) for v in (v0, v1)]
    return [((*ends[0], *ends[1]), True)]


def _ends(face: Any, v0: float, v1: float) -> bool:
    """Whether a face goes just as far as the bounds of its second parameter say.

    These are loose around curved borders, and a foot that is too low would lift the whole outline.
    """
    ends = []
    for edge in edges_of(face):
        curve = BRepAdaptor_Curve2d(edge, face)
        if curve.GetType() == GeomAbs_Line:
            ends += [curve.Value(end).Y() for end in (curve.FirstParameter(), curve.LastParameter())]
    return bool(ends) and abs(min(ends) - v0) <= _SAME and abs(max(ends) - v1) <= _SAME


def _arc(
    centre: float, foot: float, radius: float, up: float, first: float, last: float, chord: float
) -> Iterator[tuple[tuple[float, float, float, float], bool]]:
    """Lines around an arc: tangents where it bulges away from the axis, chords where it bulges towards it."""
    turns = [first, *(0.5 * math.pi * k for k in range(-9, 10) if k % 2 and first < 0.5 * math.pi * k < last), last]
    for start, end in pairwise(turns):
        outer = math.cos(0.5 * (start + end)) >= 0.0
        step = 2.0 * math.acos(max(0.0, 1.0 - min(1.0, chord / (2.0 * radius))))
        count = max(1, math.ceil((end - start) / min(step, 0.25 * math.pi)))
        angles = [start + (end - start) * k / count for k in range(count + 1)]
        on = [(centre + radius * math.cos(a), foot + up * radius * math.sin(a)) for a in angles]
        if outer:
            half = 0.5 * (end - start) / count
            out = radius / math.cos(half)
            tips = [(centre + out * math.cos(a + half), foot + up * out * math.sin(a + half)) for a in angles[:-1]]
            on = [on[0], *tips, on[-1]]
        for (q, w), (r, h) in pairwise(on):
            yield (abs(q), w, abs(r), h), False


def _sides(vertex: Floats, base: Floats, along: Floats) -> Floats:
    """Lines (n, 4) that enclose triangles (t, 3, 3).

    The distance from an axis is convex along a line: between its ends it lies below the chord, and on a triangle it is largest
    on a side.
    """
    height = (vertex - base) @ along
    radius = np.linalg.norm(vertex - base - height[..., None] * along, axis=2)
    ends = np.stack([radius, height, np.roll(radius, -1, axis=1), np.roll(height, -1, axis=1)], axis=-1).reshape(-1, 4)
    return np.unique(np.where((ends[:, 1] <= ends[:, 3])[:, None], ends, ends[:, [2, 3, 0, 1]]), axis=0)


def _grown(line: Floats, out: float, up: float) -> Floats:
    """Lines (2 n, 4) that enclose others, moved out by up to `out` and up or down by up to `up`."""
    rising = line[:, 0] < line[:, 2]
    moved, level = line.copy(), line.copy()
    moved[:, [1, 3]] += np.where(rising, -up, up)[:, None]
    top = np.where(rising, line[:, 3], line[:, 1])
    level[:, [0, 2]] = line[:, [0, 2]].max(axis=1)[:, None]
    level[:, 1], level[:, 3] = top - up, top + up
    return np.vstack([moved, level]) + np.array([out, 0.0, out, 0.0])


def _xyz(point: Any) -> Floats:
    return np.array([point.X(), point.Y(), point.Z()])


def _coaxial(location: Any, direction: Any, base: Floats, along: Floats) -> bool:
    """Whether a place lies on the axis and a direction along it; without either the other one counts."""
    away = np.zeros(3) if location is None else _xyz(location) - base
    turned = 0.0 if direction is None else float(np.linalg.norm(np.cross(_xyz(direction), along)))
    return turned <= _ON and float(np.linalg.norm(away - (away @ along) * along)) <= _ON


def _circle(edge: Any, base: Floats, along: Floats) -> float | None:
    """Radius of an edge that is an arc about the axis; 0 for an edge without length, None for any other."""
    if BRep_Tool.Degenerated_s(edge):
        return 0.0
    curve = BRepAdaptor_Curve(edge)
    if curve.GetType() != GeomAbs_Circle:
        return None
    circle = curve.Circle()
    if not _coaxial(circle.Location(), circle.Axis().Direction(), base, along):
        return None
    return float(circle.Radius())
