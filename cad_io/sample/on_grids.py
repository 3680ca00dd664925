"""Samples of faces on grids, with the kernel's exact normals and curvatures, linked within faces and across smooth joints."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve2d
from scipy.spatial import cKDTree

from cad_io.arrays import FaceGrid, Floats, Ints, Orientation, SurfaceSamples, cross, rows_by_face
from cad_io.errors import SampleError
from cad_io.face.curvature import curvature
from cad_io.face.trim import Trim
from cad_io.kernel import points_on, translated
from cad_io.part import Part
from cad_io.part.sew import edge_uses
from cad_io.sample.at_point import locate
from cad_io.sample.grid_lines import Lines, border_probes, denser, halved, inner_probes, spaced, uniform
from cad_io.surface import Surface
from cad_io.tessellate.start import starts

#: Normals (out of the material) on both sides of a smooth joint agree within this, rad.
SMOOTH = np.deg2rad(1.0)
#: Samples are linked when not farther apart than so many gaps.
REACH = 1.5
_POINTS = (3, 200)  # least and most points looked at along one edge


def smooth_joints(part: Part, orientation: Orientation, point: Floats, face: Ints, gap: Mapping[int, float]) -> NDArray[np.intp]:
    """Pairs (m, 2) of samples of different faces, nearest to the same point of a smooth common edge.

    point (n, 3), face (n,): samples, in the order of their faces, and their face numbers. gap: largest distance between grid
    neighbours, mm, by face number; its keys are the sampled faces.
    """
    finite = np.flatnonzero(np.isfinite(point).all(axis=1))
    rows_of = {number: finite[rows] for number, rows in rows_by_face(face[finite]).items()}

    @cache
    def known(number: int) -> tuple[cKDTree, NDArray[np.intp]]:
        rows = rows_of.get(number, finite[:0])
        return cKDTree(point[rows]), rows

    numbers, pairs = list(gap), [np.zeros((0, 2), np.intp)]
    shapes = [part.joined(number) for number in numbers]
    for edge, users in edge_uses(shapes):
        if len(users) != 2 or users[0][0] == users[1][0]:
            continue
        both, ends = [numbers[place] for place, _ in users], BRep_Tool.Range_s(edge)
        reach = REACH * max(gap[number] for number in both)
        curves = [_Curve(part.surface(numbers[i]), BRepAdaptor_Curve2d(edge, shapes[i]), *ends) for i, _ in users]
        share = _shares(curves[0], reach)
        if share is None:
            continue
        (at, normal_a), (_, normal_b) = (_side(part, orientation, *each, share) for each in zip(both, curves, strict=True))
        smooth = (normal_a * normal_b).sum(axis=1) > np.cos(SMOOTH)
        if not smooth.any():
            continue
        nearest = [rows[tree.query(at[smooth])[1]] for tree, rows in map(known, both)]
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


__all__ = ["bends", "locate", "sample"]

#: Why a sample may have no normal or curvature.
REASONS = ("the surface has no normal or curvature there",)
_DOUBLINGS = 4  # of a grid that misses a thin face
_CORRECTIONS = 4  # of a spacing that the probes underrated
_HALVINGS = 12  # of cells at the border that leave the face too far from its samples
_MOST_MORE, _FEW_SAMPLES = 4, 2000  # so many times as many samples, or so many, are taken for that
_NODES = 40_000  # of a grid for that, whether in the face or not
_MOST_OF_AREA = 50.0  # samples to a square of the spacing that a face of its area may have, beside the few
_FEW = 100  # samples: a face with fewer may be too thin for grids
_LEAST_SAMPLES = 4  # of a face, as far as its grid can be finer
_NEIGHBOURS = 2  # middles of triangles that each is linked with
_LEAST_SHARE = 0.125  # of its cell that a sample on the trim stands for


class _FaceSamples(NamedTuple):
    """Samples of one face before they are put together; pairs and index count within the face. `gap`: how far the face is
    from them where its border cuts cells, mm.
    """

    number: int
    derivatives: Floats
    uv: Floats
    weight: Floats
    pairs: Ints
    grid: FaceGrid | None
    gap: float = 0.0


def sample(
    part: Part,
    orientation: Orientation,
    *,
    grid: int | None = None,
    spacing: float | Mapping[int, float] | None = None,
    faces: Sequence[int],
    at: Callable[[int], None] = lambda face: None,
) -> SurfaceSamples:
    """Sample faces of a part, by their numbers; `orientation` says which side of each is out of the material.

    grid: that many lines each way, at least 2, uniform over the surface's own domain, ends included, a closed seam once, a border
    that is a single point 1e-4 of the range inward. Surfaces without end use the box of the trim. spacing: instead of `grid`,
    grid neighbours at most so many mm apart, and no point of the face farther from its nearest sample, for all faces or by face
    number; `max_gap` says where that was not to be had. at: told at which face the work is; 0: at none of them.

    Points on the trim count as inside. A face too thin for its grid gets a finer one, then the middles of triangles; one without
    any sample is in `empty`. Raises SampleError where both or neither of grid and spacing are given, or one that has no meaning.
    """
    if (grid is None) == (spacing is None):
        raise SampleError("give either a grid or a spacing", file=part.file)
    if grid is not None and grid < 2:
        raise SampleError(f"a grid needs at least 2 lines each way, not {grid}", file=part.file)
    taken, empty = _taken(part, grid, spacing, faces, at)
    at(0)
    return _together(part, orientation, taken, tuple(empty))


def bends(part: Part, orientation: Orientation, faces: Sequence[int], grid: int) -> dict[int, Floats]:
    """The larger of the two curvatures, 1/mm, at each sample of a coarse grid, by the number of each face that has samples.

    Samples are not linked with those of other faces, which takes longer than to take so few.
    """
    size = float(np.linalg.norm(part.size))
    return {
        each.number: np.abs(curvature(each.derivatives, float(orientation.sign[each.number - 1]), size).curvature).max(axis=1)
        for each in _taken(part, grid, None, faces)[0]
    }


def _taken(
    part: Part,
    grid: int | None,
    spacing: float | Mapping[int, float] | None,
    faces: Sequence[int],
    at: Callable[[int], None] = lambda face: None,
) -> tuple[list[_FaceSamples], list[tuple[int, str]]]:
    """The samples of each face, and why others have none."""
    taken, empty = [], []
    for number in faces:
        at(number)
        info, trim = part.faces[number - 1], part.trim(number)
        if info.unjudged is not None or trim is None:
            empty.append((number, info.unjudged or "has no border"))
            continue
        step = None if spacing is None else spacing[number] if isinstance(spacing, Mapping) else spacing
        if step is not None and not step > 0:
            raise SampleError(f"the spacing must be positive, not {step}", file=part.file, face=info.id)
        with translated("sampling", error=SampleError, file=part.file, face=info.id):
            samples = _sample_face(part, number, trim, grid, step)
        if samples is None:
            empty.append((number, "no sample lies inside its border"))
        else:
            taken.append(samples)
    return taken, empty


def _sample_face(part: Part, number: int, trim: Trim, grid: int | None, step: float | None) -> _FaceSamples | None:
    samples = None if step is None else _spaced(part, number, trim, step)
    # On so many lines each way, on more where none hits the face.
    for doubling in range(_DOUBLINGS + 1) if step is None else ():
        lines = uniform(part.surface(number), trim, 2**doubling * (int(grid or 2) - 1) + 1)
        inside = trim.inside_grid(lines.u, lines.v)
        if inside.any():
            samples = _on_grid(part, number, trim, lines, inside)
            break
    if samples is None:
        return _in_triangles(part, number, step)
    # Nodes stand all over the face and along its border: it is no farther from them than they are from each other.
    if trim.rectangular and samples.grid is not None and (samples.grid.index >= 0).all():
        return samples
    samples = _covering(part, number, trim, samples, step)
    if step is not None and samples.gap > step and len(samples.uv) < _FEW:
        # A needle that grids hardly hit.
        thin = _in_triangles(part, number, step)
        return thin if thin is not None and thin.gap < samples.gap else samples
    return samples


def _spaced(part: Part, number: int, trim: Trim, step: float) -> _FaceSamples | None:
    """Samples on lines so near that grid neighbours are at most a step apart, on more where few hit the face.

    Of a damaged border, or an uneven surface, grids would take any number of them: the area of the face bounds it.
    """
    surface, samples = part.surface(number), None
    most, more = max(_MOST_OF_AREA * part.faces[number - 1].area / step / step, _FEW_SAMPLES), np.ones(2)
    # Where the border does not close, the kernel is asked about each node.
    nodes = np.inf if trim.closed else max(most, _NODES)
    for doubling in range(_DOUBLINGS + 1):
        for _ in range(_CORRECTIONS):
            lines = spaced(surface, trim, step, (float(more[0]), float(more[1])), 2**doubling, nodes)
            inside = trim.inside_grid(lines.u, lines.v)
            if not inside.any():
                break
            if inside.sum() > most:
                if samples is not None:
                    return samples
                nodes = 0.9 * most * inside.size / inside.sum()
                continue
            samples = _on_grid(part, number, trim, lines, inside)
            worst = _widest(samples, lines) / step
            if (worst <= 1 + 1e-9).all():
                break
            more *= np.where(worst > 1, 1.02 * worst, 1.0)
        if samples is not None and len(samples.uv) >= _LEAST_SAMPLES:
            break
    return samples


def _covering(part: Part, number: int, trim: Trim, samples: _FaceSamples, step: float | None) -> _FaceSamples:
    """Samples with how far the face is from them; with a step, on more lines where it is farther than that."""
    grid = samples.grid
    assert grid is not None, "samples in triangles have no lines"
    lines = Lines(grid.u, grid.v, grid.closed_u, grid.closed_v, grid.span)
    near = _gap(samples.derivatives[:, 0], samples.pairs)
    border = border_probes(part, number, near if step is None else step)
    if not trim.closed:  # only the kernel knows what is inside, a node at a time
        return samples._replace(gap=float(border.distance(samples.derivatives[:, 0]).max(initial=0.0)))
    most, nodes = max(_MOST_MORE * len(samples.uv), _FEW_SAMPLES), max(_MOST_MORE * grid.index.size, _NODES)
    for _ in range(_HALVINGS + 1):
        finer = trim.inside_grid(*halved(lines), border=False)
        probes = [border, inner_probes(part, number, lines, finer)]
        away = np.concatenate([each.distance(samples.derivatives[:, 0]) for each in probes])
        samples = samples._replace(gap=float(away.max(initial=0.0)))
        far = away > (np.inf if step is None else step)
        if not far.any():
            break
        lines = denser(lines, finer, np.concatenate([each.uv for each in probes])[far], trim)
        inside = trim.inside_grid(lines.u, lines.v)
        if inside.sum() > most or inside.size > nodes:
            break
        samples = _on_grid(part, number, trim, lines, inside)._replace(gap=samples.gap)
    return samples


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
    pairs = [_linked(each[:-1].ravel(), each[1:].ravel()) for each in (index, index.T)]
    if lines.closed_u:
        pairs.append(_linked(index[-1], index[0]))
    if lines.closed_v:
        pairs.append(_linked(index[:, -1], index[:, 0]))
    face_grid = FaceGrid(number, lines.u, lines.v, index, lines.closed_u, lines.closed_v, lines.span)
    return _FaceSamples(number, derivatives, uv, weight, np.concatenate(pairs), face_grid)


def _in_triangles(part: Part, number: int, step: float | None) -> _FaceSamples | None:
    """Middles of the face's triangles, halved down to a step, for a face that no grid hits."""
    size = float(np.linalg.norm(part.size))
    mesh = starts(part, [number], 1e-3 * size)[0].get(number)
    if mesh is None:
        return None
    corners = _halved_to(part, number, mesh.uv[mesh.corner], step or np.inf)
    uv = corners.mean(axis=1)
    derivatives = part.surface(number).second(uv[:, 0], uv[:, 1])
    (a, b) = (corners[:, k] - corners[:, 0] for k in (1, 2))
    weight = _density(derivatives) * np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    # The face is thin: what lies next to a middle is nearest to it.
    known = np.flatnonzero(np.isfinite(derivatives[:, 0]).all(axis=1))
    pairs = np.zeros((0, 2), np.int32)
    if len(known) > 1:
        tree = cKDTree(derivatives[known, 0])
        neighbours = tree.query(derivatives[known, 0], min(_NEIGHBOURS + 1, len(known)))[1]
        both = np.stack([np.repeat(np.arange(len(known)), neighbours.shape[1]), neighbours.ravel()], axis=1)
        both = np.unique(np.sort(both[both[:, 0] != both[:, 1]], axis=1), axis=0)
        pairs = known[both].astype(np.int32)
    gap = border_probes(part, number, step or 0.0).distance(derivatives[:, 0]).max(initial=0.0)
    return _FaceSamples(number, derivatives, uv, weight, pairs, None, float(gap))


def _halved_to(part: Part, number: int, corners: Floats, step: float) -> Floats:
    """Triangles (n, 3, 2) in parameters, halved across their longest sides until these are at most a step long, mm."""
    while True:
        there = part.surface(number).values(corners[..., 0].ravel(), corners[..., 1].ravel()).reshape(-1, 3, 3)
        side = np.linalg.norm(np.roll(there, -1, axis=1) - there, axis=2)
        longest = np.nan_to_num(side).argmax(axis=1)
        long = np.nan_to_num(side).max(axis=1) > step
        if not long.any() or len(corners) + long.sum() > _FEW_SAMPLES:
            return corners
        rows = np.arange(len(corners))[:, None]
        a, b, c = np.moveaxis(corners[rows, (longest[:, None] + np.arange(3)) % 3][long], 1, 0)
        middle = 0.5 * (a + b)
        corners = np.concatenate([corners[~long], np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)])


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
    whole = [max(gap, f.gap) for f, gap in zip(taken, gaps, strict=True)]
    neighbours = np.concatenate(
        [*within, smooth_joints(part, orientation, point, face, dict(zip([f.number for f in taken], gaps, strict=True)))]
    ).astype(np.int32)
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
        grids=tuple(
            replace(f.grid, index=np.where(f.grid.index < 0, -1, f.grid.index + s).astype(np.int32))
            for f, s in zip(taken, start[:-1], strict=True)
            if f.grid is not None
        ),
        max_gap=max(whole, default=0.0),
        empty=empty,
        face_gaps=tuple((f.number, gap) for f, gap in zip(taken, whole, strict=True)),
    )


def _density(derivatives: Floats) -> Floats:
    return np.linalg.norm(cross(derivatives[:, 1], derivatives[:, 2]), axis=1)


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


def _linked(first: Ints, second: Ints) -> Ints:
    both = (first >= 0) & (second >= 0)
    return np.stack([first[both], second[both]], axis=1)


def _widest(samples: _FaceSamples, lines: Lines) -> Floats:
    """Largest distance between neighbours along u and along v, mm."""
    point, pairs = samples.derivatives[:, 0], samples.pairs
    distance = np.linalg.norm(point[pairs[:, 0]] - point[pairs[:, 1]], axis=1)
    along_v = samples.uv[pairs[:, 0], 0] == samples.uv[pairs[:, 1], 0]
    return np.array([np.nanmax(distance[~along_v], initial=0.0), np.nanmax(distance[along_v], initial=0.0)])


def _cells(lines: Floats, closed: bool, low: float, high: float) -> tuple[Floats, Floats]:
    """Half widths (n, 2) of each line's cell to its left and right, and the whole widths (n,)."""
    half = 0.5 * np.diff(lines)
    if closed:
        seam = 0.5 * (high - low - (lines[-1] - lines[0]))
        lower, upper = np.concatenate([[seam], half]), np.concatenate([half, [seam]])
    else:
        # Up to the ends of the range: lines beside a border that is a point stand off it.
        lower = np.concatenate([[max(lines[0] - low, 0.0)], half])
        upper = np.concatenate([half, [max(high - lines[-1], 0.0)]])
    return np.stack([lower, upper], axis=1), lower + upper


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
    inside = trim.inside_grid(u, v, border=False)[np.ix_(back_u, back_v)]
    share = inside.reshape(len(lines.u), 2, len(lines.v), 2).mean(axis=(1, 3))
    return np.maximum(share, _LEAST_SHARE)
