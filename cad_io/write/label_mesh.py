"""Triangles of a face cut along a grid of labels, where the face itself could not be split.

Each node of the grid stands for the cell around it, and one without a label for the nearest that has one. Triangles are
cut along the borders of these cells, in the parameter plane, wherever labels differ in their boxes. New corners lie on
the old triangles, so no cracks open.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from OCP.BRep import BRep_Tool

from cad_io.arrays import FaceLabels, Floats, Ints
from cad_io.split.contour import fill


class LabelledMesh(NamedTuple):
    """Parameters (n, 2) and points (n, 3) mm of corners; triangles (m, 3); a label (m,) each."""

    uv: Floats
    point: Floats
    triangle: NDArray[np.int64]
    label: Ints


def label_mesh(face: Any, uv: Floats, point: Floats, triangle: NDArray[np.int64], labels: FaceLabels) -> LabelledMesh:
    """Triangles with the labels of a grid.

    Parameters
    ----------
    face : TopoDS_Face
    uv, point : (n, 2), (n, 3) float
        Corners: surface parameters, and mm.
    triangle : (m, 3) int
    labels : FaceLabels
        At least one node known.

    Returns
    -------
    LabelledMesh
        The same surface in as many triangles or more.
    """
    surface = BRep_Tool.Surface_s(face)
    cell_u, turns_u, shut_u = _cells(uv[:, 0], labels.u, surface.UPeriod() if surface.IsUPeriodic() else 0.0)
    cell_v, turns_v, shut_v = _cells(uv[:, 1], labels.v, surface.VPeriod() if surface.IsVPeriodic() else 0.0)
    known = labels.label[:-1] if shut_u else labels.label
    known = np.tile(known[:, :-1] if shut_v else known, (turns_u, turns_v))
    filled = fill(known)
    mixed = _Mixed(filled)
    corner: Floats = np.column_stack([cell_u, cell_v, uv, point])[triangle]
    done = []
    while len(corner):
        low, high = corner[:, :, :2].min(axis=1), corner[:, :, :2].max(axis=1)
        # Borders are at whole numbers and a half: the first and the last one strictly inside the box.
        first, last = np.floor(low + 0.5) + 0.5, np.ceil(high - 0.5) - 0.5
        across = (first <= last) & mixed(low, high)[:, None]
        done.append(corner[~across.any(axis=1)])
        axis = np.where(across, last - first, -1.0).argmax(axis=1)
        rows = np.flatnonzero(across.any(axis=1))
        at = np.floor(0.5 * (first + last))[rows, axis[rows]] + 0.5
        corner = _cut(corner[rows], axis[rows], at)
    joined = np.concatenate(done)
    node = np.clip(np.rint(joined[:, :, :2].mean(axis=1)), 0, np.array(filled.shape) - 1).astype(int)
    each, index = np.unique(joined.reshape(-1, joined.shape[2]), axis=0, return_inverse=True)
    return LabelledMesh(each[:, 2:4], each[:, 4:], index.reshape(-1, 3), filled[node[:, 0], node[:, 1]])


class _Mixed:
    """Whether nodes of different label have a part in boxes of cells, low and high (n, 2)."""

    def __init__(self, label: Ints) -> None:
        self.last = np.array(label.shape) - 1
        steps = np.zeros((2, *label.shape), np.int64)
        steps[0, 1:] = label[1:] != label[:-1]
        steps[1, :, 1:] = label[:, 1:] != label[:, :-1]
        self.count = np.pad(steps.cumsum(1).cumsum(2), ((0, 0), (1, 0), (1, 0)))

    def __call__(self, low: Floats, high: Floats) -> NDArray[np.bool_]:
        i, j = np.clip(np.rint(low), 0, self.last).astype(int).T
        m, n = np.clip(np.rint(high), 0, self.last).astype(int).T + 1
        mixed = np.zeros(len(low), bool)
        # A step leads to its node from the one before: the first ones lead into the box, not through it.
        for count, a, b in ((self.count[0], i + 1, j), (self.count[1], i, j + 1)):
            a, b = np.minimum(a, m), np.minimum(b, n)
            mixed |= count[m, n] - count[a, n] - count[m, b] + count[a, b] > 0
        return mixed


def _cut(corner: Floats, axis: NDArray[np.intp], at: Floats) -> Floats:
    """Triangles (3 n, 3, k) after cutting each of (n, 3, k) along the line on which its column `axis` is `at`.

    Both sides of the line hold a corner.
    """
    each = np.arange(len(corner))
    above = corner[each, :, axis] > at[:, None]
    # The corner that is alone on its side becomes the first.
    lone = np.where(above.sum(axis=1) == 1, above.argmax(axis=1), (~above).argmax(axis=1))
    p, q, r = corner[each[:, None], (lone[:, None] + np.arange(3)) % 3].transpose(1, 0, 2)

    def crossing(other: Floats) -> Floats:
        far, near = other[each, axis] - at, p[each, axis] - at
        share = (near / (near - far))[:, None]
        out = p + share * (other - p)
        out[each, axis] = at
        return out

    pq, pr = crossing(q), crossing(r)
    return np.concatenate([np.stack(t, axis=1) for t in ((p, pq, pr), (pq, q, r), (pq, r, pr))])


def _cells(at: Floats, line: Floats, period: float) -> tuple[Floats, int, bool]:
    """Parameters counted in cells of a grid line; over how many turns; whether the line's ends are one place."""
    if not period:
        return np.interp(at, line, np.arange(len(line))), 1, False
    if line[-1] - line[0] < period * (1 - 1e-6):
        # The corners may lie whole periods off the grid.
        off = np.round((at.mean() - 0.5 * (line[0] + line[-1])) / period) * period
        return np.interp(at - off, line, np.arange(len(line))), 1, False
    excess = at - line[0]
    turn = np.floor(excess / period + 1e-9)
    turn -= turn.min()
    inner = np.interp(excess - np.floor(excess / period + 1e-9) * period, line - line[0], np.arange(len(line)))
    return inner + turn * (len(line) - 1), int(turn.max()) + 2, True
