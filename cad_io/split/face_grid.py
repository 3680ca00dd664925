"""A face's labels made ready for contouring: cut where the face's own seam is, reaching to the face's bounds."""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve2d
from scipy.ndimage import maximum_filter

from cad_io.arrays import FaceLabels, Floats, Ints
from cad_io.face.uv_region import inside, outline
from cad_io.kernel import edges_of
from cad_io.split.contour import REACH, LabelGrid, fill, without_specks

#: Curves may end this far past the trim, cells: an end exactly on it could miss the edge it should cut.
_OVER = 0.25


def label_grid(face: Any, labels: FaceLabels) -> tuple[LabelGrid, Ints, NDArray[np.bool_]]:
    """Contourable grid of a face.

    Parameters
    ----------
    face : TopoDS_Face
    labels : FaceLabels
        At least one node known.

    Returns
    -------
    grid : LabelGrid
        Its field holds ranks of the labels that occur, so that absent labels make no boundary.
    known : (nu, nv) int32
        The labels at the grid's nodes, -1 where unknown.
    dropped : (nu, nv) bool
        Known nodes that were islands of one node and went to their surroundings.

    Raises
    ------
    ValueError
        The face has no border.
    """
    segments = outline(face)
    if not len(segments):
        raise ValueError("the face has no border")
    low, high = segments.min(axis=(0, 1)), segments.max(axis=(0, 1))
    surface = BRep_Tool.Surface_s(face)
    u0, u1, v0, v1 = surface.Bounds()
    u_period = surface.UPeriod() if surface.IsUPeriodic() else u1 - u0 if surface.IsUClosed() else 0.0
    v_period = surface.VPeriod() if surface.IsVPeriodic() else v1 - v0 if surface.IsVClosed() else 0.0
    poles = _poles(face)
    over = 0.0 if poles else _OVER

    label, lines, closed = labels.label, [], []
    directions = ((labels.u, u_period, surface.IsUPeriodic(), u0, u1), (labels.v, v_period, surface.IsVPeriodic(), v0, v1))
    for axis, (line, period, periodic, first, last) in enumerate(directions):
        cell = (line[-1] - line[0]) / (len(line) - 1)
        if period and line[-1] - line[0] + 1.5 * cell > period:
            start = low[axis]
            if not periodic:
                start = first
            elif high[axis] - low[axis] < period - 1e-6 * period:
                start = 0.5 * (low[axis] + high[axis] - period)  # the middle of what the face leaves out
            line, label = _from_seam(line, label, axis, float(start), period)
            closed.append(True)
        else:
            if not periodic:
                reach = max(low[axis] - over * cell, first), min(high[axis] + over * cell, last)
            else:
                reach = low[axis] - over * cell, high[axis] + over * cell
            line, label = _reaching(line, label, axis, reach)
            closed.append(False)
        lines.append(line)

    ranks = np.unique(label[label >= 0])
    ranked = np.searchsorted(ranks, fill(label)).astype(np.int32)
    field = ranked.copy()
    for axis, at in poles:
        # One point in space has one label: curves that met in it would not be joined to it by the kernel.
        i = int(np.argmin(np.abs(lines[axis][: label.shape[axis]] - at)))
        row = np.moveaxis(field, axis, 0)
        row[i] = np.bincount(row[i]).argmax()
    despeckled = without_specks(field, closed[0], closed[1])
    modes = ["wrap" if c else "nearest" for c in closed]
    on_face = (label >= 0) | inside(segments, *(line[:n] for line, n in zip(lines, label.shape, strict=True)))
    near = maximum_filter(on_face.astype(np.uint8), size=2 * REACH + 1, mode=modes) > 0
    dropped = (despeckled != field) & (label >= 0)
    return LabelGrid(lines[0], lines[1], despeckled, near, closed[0], closed[1]), label, dropped


def _poles(face: Any) -> list[tuple[int, float]]:
    """Sides of the parameter plane that are a point in space: (0 for u or 1 for v, the side's parameter)."""
    out = []
    for edge in edges_of(face):
        if BRep_Tool.Degenerated_s(edge):
            curve = BRepAdaptor_Curve2d(edge, face)
            start, stop = (curve.Value(t).Coord() for t in (curve.FirstParameter(), curve.LastParameter()))
            axis = int(abs(start[1] - stop[1]) < abs(start[0] - stop[0]))
            out.append((axis, float(start[axis])))
    return out


def _from_seam(line: Floats, label: Ints, axis: int, start: float, period: float) -> tuple[Floats, Ints]:
    """Grid of a closed direction that begins with a line on its seam and ends with the same line a period on."""
    near = 1e-3 * period / len(line)
    if line[-1] - line[0] > period - near:
        line, label = line[:-1], np.delete(label, -1, axis)
    offset = (line - start) % period
    offset[offset > period - near] = 0.0
    order = np.argsort(offset)
    offset, label = offset[order], np.take(label, order, axis)
    if offset[0] > near:
        twin = 0 if offset[0] < period - offset[-1] else -1
        offset = np.insert(offset, 0, 0.0)
        label = np.insert(label, 0, np.take(label, twin, axis), axis)
    offset[0] = 0.0
    return start + np.append(offset, period), label


def _reaching(line: Floats, label: Ints, axis: int, ends: tuple[float, float]) -> tuple[Floats, Ints]:
    """Grid of an open direction that covers the ends: its outer lines are moved there if near, else doubled."""
    line = line.copy()
    cell = (line[-1] - line[0]) / (len(line) - 1)
    for at, end, gap in ((0, ends[0], line[0] - ends[0]), (-1, ends[1], ends[1] - line[-1])):
        if 0 < gap <= 0.5 * cell:
            line[at] = end
        elif gap > 0.5 * cell:
            where = 0 if at == 0 else len(line)
            line = np.insert(line, where, end)
            label = np.insert(label, where, np.take(label, at, axis), axis)
    return line, label
