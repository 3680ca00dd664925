"""Sample faces on parameter grids, with the kernel's exact normals and curvatures."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import FaceGrid, Floats, Ints, Orientation, SurfaceSamples
from cad_io.errors import SampleError
from cad_io.face.curvature import curvature
from cad_io.face.trim import Trim
from cad_io.kernel import translated
from cad_io.part import Part
from cad_io.sample.at_point import locate
from cad_io.sample.gap import border_gap
from cad_io.sample.grid_lines import Lines, spaced, uniform
from cad_io.sample.joints import smooth_joints
from cad_io.tessellate.mesh import uv_meshes

__all__ = ["locate", "sample"]

#: Why a sample may have no normal or curvature.
REASONS = ("the surface has no normal or curvature there",)
_DOUBLINGS = 4  # of a grid that misses a thin face
_CORRECTIONS = 4  # of a spacing that the probes underrated
_LEAST_SHARE = 0.125  # of its cell that a sample on the trim stands for


class _FaceSamples(NamedTuple):
    """Samples of one face before they are put together; pairs and index count within the face."""

    number: int
    derivatives: Floats
    uv: Floats
    weight: Floats
    pairs: Ints
    grid: FaceGrid | None


def sample(
    part: Part,
    orientation: Orientation,
    *,
    grid: int | None = None,
    spacing: float | Mapping[int, float] | None = None,
    faces: Sequence[int],
) -> SurfaceSamples:
    """Sample faces of a part.

    Parameters
    ----------
    part : Part
    orientation : Orientation
        Which side of each face is out of the material.
    grid : int, optional
        That many lines each way, at least 2, uniform over the surface's own domain, ends included, a closed seam once,
        a border that is a single point 1e-4 of the range inward. Surfaces without end use the box of the trim.
    spacing : float or mapping of int to float, optional
        Instead of `grid`: grid neighbours at most so many mm apart, for all faces or by face number.
    faces : sequence of int
        Face numbers.

    Returns
    -------
    SurfaceSamples
        Points on the trim count as inside. A face too thin for its grid gets a finer one, then the middles of its
        triangles; one without any sample is in `empty`.

    Raises
    ------
    SampleError
        Both or neither of grid and spacing given, or one that has no meaning.
    """
    if (grid is None) == (spacing is None):
        raise SampleError("give either a grid or a spacing", file=part.file)
    if grid is not None and grid < 2:
        raise SampleError(f"a grid needs at least 2 lines each way, not {grid}", file=part.file)
    taken, empty = [], []
    for number in faces:
        info, trim = part.faces[number - 1], part.trim(number)
        if info.unjudged is not None or trim is None:
            empty.append((number, info.unjudged or "has no border"))
            continue
        step = None if spacing is None else spacing[number] if isinstance(spacing, Mapping) else spacing
        if step is not None and not step > 0:
            raise SampleError(f"the spacing must be positive, not {step}", file=part.file, face=info.id)
        with translated("sampling", error=SampleError, file=part.file, face=info.id):
            found = _sample_face(part, number, trim, grid, step)
        if found is None:
            empty.append((number, "no sample lies inside its border"))
        else:
            taken.append(found)
    return _together(part, orientation, taken, tuple(empty))


def _sample_face(part: Part, number: int, trim: Trim, grid: int | None, step: float | None) -> _FaceSamples | None:
    surface = part.surface(number)
    more = np.ones(2)
    for doubling in range(_DOUBLINGS + 1):
        finer = 2**doubling
        for _ in range(_CORRECTIONS):
            if grid is not None:
                lines = uniform(surface, trim, finer * (grid - 1) + 1)
            else:
                lines = spaced(surface, trim, float(step or 0) / finer, (float(more[0]), float(more[1])))
            inside = trim.inside_grid(lines.u, lines.v)
            if not inside.any():
                break
            found = _on_grid(part, number, trim, lines, inside)
            if step is None:
                return found
            worst = _widest(found, lines) / step
            if (worst <= 1 + 1e-9).all():
                return found
            more *= np.where(worst > 1, 1.02 * worst, 1.0)
        else:
            return found
    return _in_triangles(part, number)


def _on_grid(part: Part, number: int, trim: Trim, lines: Lines, inside: NDArray[np.bool_]) -> _FaceSamples:
    i, j = np.nonzero(inside)
    index = np.full(inside.shape, -1, np.int32)
    index[i, j] = np.arange(len(i))
    uv = np.stack([lines.u[i], lines.v[j]], axis=1)
    derivatives = part.surface(number).second(uv[:, 0], uv[:, 1])
    _, width_u = _cells(lines.u, lines.closed_u, *lines.span[:2])
    _, width_v = _cells(lines.v, lines.closed_v, *lines.span[2:])
    weight = _density(derivatives) * width_u[i] * width_v[j]
    if not inside.all():
        weight *= _share_inside(trim, lines)[i, j]
    pairs = [_adjacent(index), _adjacent(index.T)]
    if lines.closed_u:
        pairs.append(_linked(index[-1], index[0]))
    if lines.closed_v:
        pairs.append(_linked(index[:, -1], index[:, 0]))
    face_grid = FaceGrid(number, lines.u, lines.v, index, lines.closed_u, lines.closed_v, lines.span)
    return _FaceSamples(number, derivatives, uv, weight, np.concatenate(pairs), face_grid)


def _in_triangles(part: Part, number: int) -> _FaceSamples | None:
    """Middles of the face's triangles, for a face that no grid hits."""
    size = float(np.linalg.norm(part.size))
    mesh = uv_meshes(part, [number], 1e-3 * size, 0.5).get(number)
    if mesh is None:
        return None
    corners = mesh.uv[mesh.corner]
    uv = corners.mean(axis=1)
    derivatives = part.surface(number).second(uv[:, 0], uv[:, 1])
    (a, b) = (corners[:, k] - corners[:, 0] for k in (1, 2))
    weight = _density(derivatives) * np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    # Triangles that share two corners are neighbours.
    sides = np.sort(np.concatenate([mesh.corner[:, [0, 1]], mesh.corner[:, [1, 2]], mesh.corner[:, [2, 0]]]), axis=1)
    owner = np.tile(np.arange(len(uv)), 3)
    order = np.lexsort(sides.T)
    same = (sides[order][1:] == sides[order][:-1]).all(axis=1)
    pairs = np.stack([owner[order][:-1][same], owner[order][1:][same]], axis=1).astype(np.int32)
    return _FaceSamples(number, derivatives, uv, weight, pairs, None)


def _together(
    part: Part, orientation: Orientation, taken: Sequence[_FaceSamples], empty: tuple[tuple[int, str], ...]
) -> SurfaceSamples:
    size = float(np.linalg.norm(part.size))
    start = np.concatenate([[0], np.cumsum([len(f.uv) for f in taken])]).astype(np.int64)
    geometry = [curvature(f.derivatives, float(orientation.sign[f.number - 1]), size) for f in taken]
    point = _stack([f.derivatives[:, 0] for f in taken], 3)
    normal = _stack([g.normal for g in geometry], 3)
    face = np.repeat(np.array([f.number for f in taken], np.int32), np.diff(start))
    within = [f.pairs + s for f, s in zip(taken, start[:-1], strict=True)]
    gaps = [_gap(point, pairs) for pairs in within]
    to_border = [
        border_gap(part, f.number, f.derivatives[:, 0], gap)
        for f, gap in zip(taken, gaps, strict=True)
        if f.grid is None or not _all_along(part.trim(f.number), f.grid)
    ]
    neighbours = np.concatenate([*within, smooth_joints(part, orientation, point, face, dict(
        zip([f.number for f in taken], gaps, strict=True)))]).astype(np.int32)  # fmt: skip
    bad = np.concatenate([g.bad for g in geometry]) if geometry else np.zeros(0, bool)
    return SurfaceSamples(
        point=point,
        normal=normal,
        direction_max=_stack([g.direction_max for g in geometry], 3),
        curvature=_stack([g.curvature for g in geometry], 2),
        uv=_stack([f.uv for f in taken], 2),
        face=face,
        area=np.concatenate([np.zeros(0), *(_area(f.weight, part.faces[f.number - 1].area) for f in taken)]),
        neighbours=neighbours.reshape(-1, 2),
        unjudged=np.where(bad, 0, -1).astype(np.int32),
        reasons=REASONS if bad.any() else (),
        grids=tuple(_moved(f.grid, int(s)) for f, s in zip(taken, start[:-1], strict=True) if f.grid is not None),
        max_gap=max(gaps + to_border, default=0.0),
        empty=empty,
    )  # fmt: skip


def _density(derivatives: Floats) -> Floats:
    return np.linalg.norm(np.cross(derivatives[:, 1], derivatives[:, 2]), axis=1)


def _moved(grid: FaceGrid, by: int) -> FaceGrid:
    return replace(grid, index=np.where(grid.index < 0, -1, grid.index + by).astype(np.int32))


def _stack(rows: Sequence[Floats], width: int) -> Floats:
    return np.concatenate(rows) if rows else np.zeros((0, width))


def _area(weight: Floats, area: float) -> Floats:
    weight = np.where(np.isfinite(weight), weight, 0.0)
    total = weight.sum()
    return weight * (area / total) if total > 0 else np.full(len(weight), area / len(weight))


def _gap(point: Floats, pairs: Ints) -> float:
    if not len(pairs):
        return 0.0
    return float(np.nanmax(np.linalg.norm(point[pairs[:, 0]] - point[pairs[:, 1]], axis=1), initial=0.0))


def _all_along(trim: Trim | None, grid: FaceGrid) -> bool:
    """True if nodes stand all along the border: it is no farther from them than they are from each other."""
    return trim is not None and trim.rectangular and bool((grid.index >= 0).all())


def _linked(first: Ints, second: Ints) -> Ints:
    both = (first >= 0) & (second >= 0)
    return np.stack([first[both], second[both]], axis=1)


def _adjacent(index: Ints) -> Ints:
    return _linked(index[:-1].ravel(), index[1:].ravel())


def _widest(found: _FaceSamples, lines: Lines) -> Floats:
    """Largest distance between neighbours along u and along v, mm."""
    point, pairs = found.derivatives[:, 0], found.pairs
    distance = np.linalg.norm(point[pairs[:, 0]] - point[pairs[:, 1]], axis=1)
    along_v = found.uv[pairs[:, 0], 0] == found.uv[pairs[:, 1], 0]
    return np.array([np.nanmax(distance[~along_v], initial=0.0), np.nanmax(distance[along_v], initial=0.0)])


def _cells(lines: Floats, closed: bool, low: float, high: float) -> tuple[Floats, Floats]:
    """Half widths (n, 2) of each line's cell to its left and right, and the whole widths (n,)."""
    half = 0.5 * np.diff(lines)
    if closed:
        seam = 0.5 * (high - low - (lines[-1] - lines[0]))
        left, right = np.concatenate([[seam], half]), np.concatenate([half, [seam]])
    else:
        # Up to the ends of the range: lines beside a border that is a point stand off it.
        left = np.concatenate([[max(lines[0] - low, 0.0)], half])
        right = np.concatenate([half, [max(high - lines[-1], 0.0)]])
    return np.stack([left, right], axis=1), left + right


def _share_inside(trim: Trim, lines: Lines) -> Floats:
    """Share of each node's cell that lies inside the trim, from the middles of its quarters: (nu, nv)."""

    def quarters(line: Floats, closed: bool, low: float, high: float) -> tuple[Floats, NDArray[np.intp]]:
        half, _ = _cells(line, closed, low, high)
        at = (line[:, None] + 0.5 * half * (-1.0, 1.0)).ravel()
        if closed:
            at = low + np.mod(at - low, high - low)
        order = np.argsort(at, kind="stable")
        back = np.empty_like(order)
        back[order] = np.arange(len(order))
        return at[order], back

    u, back_u = quarters(lines.u, lines.closed_u, *lines.span[:2])
    v, back_v = quarters(lines.v, lines.closed_v, *lines.span[2:])
    inside = trim.inside_grid(u, v, beside=False)[np.ix_(back_u, back_v)]
    share = inside.reshape(len(lines.u), 2, len(lines.v), 2).mean(axis=(1, 3))
    return np.maximum(share, _LEAST_SHARE)
