"""Which sample a point of a drawn face belongs to: grids of all faces side by side in one picture (an atlas).

A vertex carries its place in the atlas; the page rounds the place of each pixel to a texel, which names a sample: sharp cells
around each sample. Faces that were sampled without a grid have a texel a sample, and each of their triangles stands for one.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt
from scipy.spatial import cKDTree

from cad_io.arrays import FaceGrid, Floats, Ints, SurfaceSamples
from cad_io.write.render_mesh import Mesh

#: Largest width and height: a place is counted in 16ths of a texel in 16 bits; the last number says that there is none.
_LONGEST = 4094
STEPS, NOWHERE = 16, 65535
#: Lines this far from equal steps, in steps, count as equal ones.
_EVEN = 0.05
#: Other lines get steps of their least distance, at most so many times more; less where the atlas is too large; 0: no grid.
_FINER = (8, 3, 1, 0)
#: Texels that an atlas may have for a finer grid.
_TEXELS = 4_000_000


@dataclass(frozen=True, slots=True)
class Sheet:
    """The samples of one face as they lie in the atlas (h, w): rows along u, columns along v. Where it has a grid, the ends of u
    and of v."""

    index: Ints
    ends: tuple[tuple[float, float], tuple[float, float]] | None


@dataclass(frozen=True, slots=True)
class Atlas:
    """All sheets side by side."""

    #: (height, width); row of the sample; -1 where no sheet lies.
    index: Ints
    #: Face number -> row and column at which its sheet begins.
    corner: Mapping[int, tuple[int, int]]
    #: Face number -> Sheet.
    sheets: Mapping[int, Sheet]


def sheet_of(grid: FaceGrid, finer: int = _FINER[0]) -> Sheet:
    """A face's grid with its seams at both ends, at equal steps, at most `finer` times as many, and no node without a sample."""
    known = grid.index >= 0
    _, (i, j) = distance_transform_edt(~known, return_indices=True)
    index, u, v = grid.index[i, j], grid.u, grid.v
    if grid.closed_u:
        u, index = np.append(u, grid.span[1]), np.vstack([index, index[:1]])
    if grid.closed_v:
        v, index = np.append(v, grid.span[3]), np.hstack([index, index[:, :1]])
    rows, columns = _even(u, finer), _even(v, finer)
    ends = ((float(u[0]), float(u[-1])), (float(v[0]), float(v[-1])))
    return Sheet(index[np.ix_(rows, columns)].astype(np.int32), ends)


def _even(line: Floats, finer: int) -> NDArray[np.intp]:
    """The nearest grid line (k,) at each of k equal steps from the first to the last: so many that each line is one."""
    count, span = len(line), line[-1] - line[0]
    if np.abs((line - line[0]) / span * (count - 1) - np.arange(count)).max() < _EVEN:
        return np.arange(count)
    cell = np.diff(np.concatenate([line[:1], 0.5 * (line[1:] + line[:-1]), line[-1:]]))[1:-1].min(initial=span)
    steps = min(int(np.ceil(span / cell)) + 1, finer * count, max(count, _LONGEST - 1))
    at = np.linspace(line[0], line[-1], steps)
    return np.searchsorted(0.5 * (line[1:] + line[:-1]), at)


def _list_of(rows: NDArray[np.int64]) -> Sheet:
    """Samples without a grid, in lines."""
    width = max(1, int(np.ceil(np.sqrt(len(rows)))))
    index = np.full(-(-len(rows) // width) * width, -1, np.int32)
    index[: len(rows)] = rows
    return Sheet(index.reshape(-1, width), None)


def atlas_of(samples: SurfaceSamples) -> Atlas:
    """Lay out the sheets of all sampled faces, with as fine steps as there is room for."""
    grids = {grid.face: grid for grid in samples.grids}
    rows = samples.by_face()
    for finer in _FINER:
        sheets = {}
        for number, mine in rows.items():
            grid = grids.get(number)
            fits = grid is not None and max(grid.index.shape) < _LONGEST
            sheets[number] = sheet_of(grid, finer) if grid is not None and fits and finer else _list_of(mine)
        atlas = _laid_out(sheets)
        if atlas.index.shape[0] <= _LONGEST and (finer <= 1 or atlas.index.size <= _TEXELS):
            break
    return atlas


def _laid_out(sheets: Mapping[int, Sheet]) -> Atlas:
    """Put sheets side by side, the highest first, in shelves."""
    size = {number: sheet.index.shape for number, sheet in sheets.items()}
    area = sum(h * w for h, w in size.values())
    width = min(_LONGEST, max(*(w for _, w in size.values()), math.ceil(1.1 * math.sqrt(area)), 1))
    corner, row, column, high = {}, 0, 0, 0
    for number in sorted(sheets, key=lambda n: (-size[n][0], n)):
        h, w = size[number]
        if column + w > width:
            row, column, high = row + high, 0, 0
        corner[number] = (row, column)
        column, high = column + w, max(high, h)
    index = np.full((max(1, row + high), max(1, width)), -1, np.int32)
    for number, (row, column) in corner.items():
        h, w = size[number]
        index[row : row + h, column : column + w] = sheets[number].index
    return Atlas(index, corner, sheets)


def placed_in(
    atlas: Atlas, samples: SurfaceSamples, number: int, mesh: Mesh, period: tuple[float, float]
) -> tuple[Mesh, NDArray[np.uint16]]:
    """A face's mesh with the places (n, 2) of its vertices: column and row in the atlas, in 16ths of a texel."""
    sheet = atlas.sheets.get(number)
    if sheet is None:
        return mesh, np.full((len(mesh.point), 2), NOWHERE, np.uint16)
    row, column = atlas.corner[number]
    if sheet.ends is not None:
        at = [_share(mesh.uv[:, k], sheet.ends[k], period[k]) * (sheet.index.shape[k] - 1) for k in (1, 0)]
        place = np.stack(at, axis=1) + np.array([column, row])
        return mesh, np.round(STEPS * place).astype(np.uint16)
    rows = np.flatnonzero(samples.face == number)
    corner = mesh.triangle.reshape(-1)
    apart = Mesh(mesh.point[corner], mesh.normal[corner], np.arange(len(corner), dtype=np.uint32).reshape(-1, 3), mesh.uv[corner])
    _, nearest = cKDTree(samples.point[rows]).query(apart.point.reshape(-1, 3, 3).mean(axis=1))
    width = sheet.index.shape[1]
    place = np.stack([column + nearest % width, row + nearest // width], axis=1)
    return apart, np.repeat((STEPS * place).astype(np.uint16), 3, axis=0)


def _share(at: Floats, ends: tuple[float, float], period: float) -> Floats:
    """Where parameters lie between ends, 0 to 1; moved by whole periods to there."""
    low, high = ends
    turns = np.round((at.mean() - 0.5 * (low + high)) / period) * period if period else 0.0
    return np.clip((at - turns - low) / (high - low), 0.0, 1.0)
