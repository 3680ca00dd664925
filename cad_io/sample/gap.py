"""How far is a face, up to its border, from the samples on its grid, and where is the grid too coarse for it?

Between four nodes of the face no point is farther from the nearest of them than half the diagonal, 0.71 of the spacing. Only
where the border cuts cells may points be farther, in a tip that no node hits above all: there are the probes.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from cad_io.arrays import Floats
from cad_io.face.trim import Trim
from cad_io.part import Part
from cad_io.sample.grid_lines import Lines

_STEPS, _FEW = 20_000, 200  # along the border, at most: among many samples, or about one
_A_GAP = 12  # probes of the border to a gap
_STRAIGHT = 0.98  # cosine of the angle between segments of the border from which on they make a corner


class Probes(NamedTuple):
    """Places of a face that the border keeps from nodes: parameters uv (k, 2), and their points (k, 3), mm."""

    uv: Floats
    point: Floats

    def distance(self, samples: Floats) -> Floats:
        """To the nearest of the samples (n, 3), mm: (k,)."""
        samples = samples[np.isfinite(samples).all(axis=1)]
        if not (len(samples) and len(self.point)):
            return np.zeros(len(self.point))
        return np.asarray(cKDTree(samples).query(self.point)[0])


def border_probes(part: Part, number: int, gap: float) -> Probes:
    """Points along the border of a face and at its corners, some to a gap, mm."""
    trim = part.trim(number)
    if trim is None:
        return Probes(np.zeros((0, 2)), np.zeros((0, 3)))
    along = (trim.segments[:, 1] - trim.segments[:, 0]) * trim.scale
    length = np.linalg.norm(along, axis=1)
    end = np.cumsum(length)
    count = _A_GAP * end[-1] / gap if gap else _FEW
    at = np.linspace(0.0, end[-1], int(np.clip(np.ceil(count), 1, _STEPS)), endpoint=False)
    which = np.minimum(np.searchsorted(end, at, "right"), len(end) - 1)
    share = np.clip((at - end[which] + length[which]) / np.maximum(length[which], 1e-300), 0.0, 1.0)[:, None]
    # Corners are the farthest: starts of segments that go another way than the one before.
    before = np.roll(along, 1, axis=0)
    corner = (along * before).sum(axis=1) < _STRAIGHT * length * np.roll(length, 1)
    between = (1 - share) * trim.segments[which, 0] + share * trim.segments[which, 1]
    return _probes(part, number, np.concatenate([between, trim.segments[corner, 0]]))


def inner_probes(part: Part, number: int, lines: Lines, finer: NDArray[np.bool_]) -> Probes:
    """Nodes of the halved grid inside the face, in cells of which not all corners are; `finer` as from `halves_inside`."""
    whole = finer[:-2:2, :-2:2] & finer[2::2, :-2:2] & finer[:-2:2, 2::2] & finer[2::2, 2::2]
    neighbours = np.zeros(finer.shape, bool)
    for du in range(3):
        for dv in range(3):
            neighbours[du : du + 2 * whole.shape[0] - 1 : 2, dv : dv + 2 * whole.shape[1] - 1 : 2] |= ~whole
    neighbours[::2, ::2] = False
    i, j = np.nonzero(finer & neighbours)
    u, v = halved(lines)
    return _probes(part, number, np.stack([u[i], v[j]], axis=1))


def halved(lines: Lines) -> tuple[Floats, Floats]:
    """Grid lines and those half way between; of a closed range up to the seam's other end."""
    halves = []
    for line, closed, low, high in ((lines.u, lines.closed_u, *lines.span[:2]), (lines.v, lines.closed_v, *lines.span[2:])):
        whole = np.append(line, line[0] + high - low) if closed else line
        between = np.empty(2 * len(whole) - 1)
        between[::2], between[1::2] = whole, 0.5 * (whole[1:] + whole[:-1])
        halves.append(between)
    return halves[0], halves[1]


def halves_inside(trim: Trim, lines: Lines) -> NDArray[np.bool_]:
    """Which nodes of the halved grid lie in the face."""
    return trim.inside_grid(*halved(lines), border=False)


def denser(lines: Lines, finer: NDArray[np.bool_], uv: Floats, trim: Trim) -> Lines:
    """Lines with those halved that cut the cells of some places uv (k, 2).

    Along the direction in which the new line has nodes in the face, if one has: along both where none has, and along the
    wider one where both have.
    """
    u, v = halved(lines)
    i = np.clip(np.searchsorted(u[::2], uv[:, 0], "right") - 1, 0, len(u) // 2 - 1)
    j = np.clip(np.searchsorted(v[::2], uv[:, 1], "right") - 1, 0, len(v) // 2 - 1)
    on_u = finer[2 * i + 1, 2 * j] | finer[2 * i + 1, 2 * j + 2]
    on_v = finer[2 * i, 2 * j + 1] | finer[2 * i + 2, 2 * j + 1]
    wide = (u[2 * i + 2] - u[2 * i]) * trim.scale[0] >= (v[2 * j + 2] - v[2 * j]) * trim.scale[1]
    along_u, along_v = np.where(on_u & on_v, wide, ~on_v | on_u), np.where(on_u & on_v, ~wide, ~on_u | on_v)
    return lines._replace(
        u=np.union1d(lines.u, u[2 * np.unique(i[along_u]) + 1]), v=np.union1d(lines.v, v[2 * np.unique(j[along_v]) + 1])
    )


def _probes(part: Part, number: int, uv: Floats) -> Probes:
    point = part.surface(number).values(uv[:, 0], uv[:, 1])
    known = np.isfinite(point).all(axis=1)
    return Probes(uv[known], point[known])
