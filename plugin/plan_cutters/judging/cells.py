"""Cells of a face: the tiles about its grid's nodes as far as they lie in the trim, a contact in each of them, and how far they
reach.

A tile whose own node lies outside the trim has a contact of its own, in what the trim leaves of it. Every point of the
face lies in a cell: their areas are counted from the trim, not from the nodes.
"""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import FaceGrid, Floats, Ints, Orientation, SurfaceSamples
from cad_io.face.curvature import density, evaluate
from cad_io.face.trim import Clipped, Trim, clipped
from cad_io.part import Part
from plan_cutters.domain.verdicts import INTERFERENCE_FREE, Verdicts, not_reached
from plan_cutters.scene.conditions import Conditions

#: The patch about a node is at least half the way to its diagonal neighbours; some more, for cells that are bent.
WIDER = 1.1
#: In a cell, the curvature tensor may differ from its node's this many times as much as half way to the next nodes.
WILDER = 2.0


def tensors(normal: Floats, direction_max: Floats, curvature: Floats) -> Floats:
    """Second fundamental form (n, 3, 3) in part coordinates, 1/mm, concave positive."""
    across = np.cross(normal, direction_max)
    high, low = curvature[:, 0, None, None], curvature[:, 1, None, None]
    e1, e2 = direction_max[:, :, None], across[:, :, None]
    return np.asarray(high * e1 * e1.transpose(0, 2, 1) + low * e2 * e2.transpose(0, 2, 1))


def steepest(tensor: Floats, variation: Floats) -> tuple[Floats, Floats]:
    """Most that a principal curvature (n,) and the difference of two (n,) may be where tensors differ by a wobble, 1/mm."""
    trace = np.einsum("nii->n", tensor)
    spread = np.sqrt(np.maximum(0.0, 2.0 * np.einsum("nij,nij->n", tensor, tensor) - trace * trace))
    return 0.5 * (np.abs(trace) + spread) + variation, spread + 2.0 * variation


def from_neighbours(point: Floats, tensor: Floats, grid: FaceGrid, index: NDArray[np.integer]) -> tuple[Floats, Floats]:
    """How far curvature may differ in each sample's cell, 1/mm, and how far the cell reaches, mm.

    `point`, `tensor` (n, 3), (n, 3, 3) float: the samples of the face. `index` (nu, nv) int: row of the sample at each node,
    negative where there is none. Returns `wobble, radius` (n,) float: nan where no neighbour tells them.
    """
    on = index >= 0
    at = np.where(on[..., None], point[index], np.nan)
    bend = tensor[index].reshape(*on.shape, 9)
    differs_by = np.zeros(on.shape)
    for axis, closed in ((0, grid.closed_u), (1, grid.closed_v)):
        differs = np.linalg.norm(_next(bend, axis, closed) - bend, axis=2)
        differs[~(on & (_next(on.astype(float), axis, closed) == 1))] = 0.0
        differs_by += np.maximum(differs, np.roll(differs, 1, axis))
    variation, radius = np.full(len(point), np.nan), np.full(len(point), np.nan)
    variation[index[on]], radius[index[on]] = 0.5 * WILDER * differs_by[on], _radius(at, grid)[on]
    return variation, radius


def _next(field: Floats, axis: int, closed: bool) -> Floats:
    """Each node's next one along an axis; nan past the end of a grid that is not closed."""
    moved = np.roll(field, -1, axis)
    if not closed:
        moved[(-1,) if axis == 0 else (slice(None), -1)] = np.nan
    return moved


def _radius(point: Floats, grid: FaceGrid) -> Floats:
    """Half the largest distance to the diagonal neighbours; beyond an end of the face, as on this side of it."""
    next_u, next_v = _next(point, 0, grid.closed_u), _next(point, 1, grid.closed_v)
    sides = []
    for axis, following in ((0, next_u), (1, next_v)):
        gap = np.linalg.norm(following - point, axis=2)
        sides.append(np.fmax(gap, np.roll(gap, 1, axis)))
    straight = np.hypot(*sides)
    both = _next(next_u, 1, grid.closed_v)
    down = np.linalg.norm(both - point, axis=2)
    up = np.linalg.norm(next_u - next_v, axis=2)
    corners = [down, np.roll(down, (1, 1), (0, 1)), np.roll(up, 1, 0), np.roll(up, 1, 1)]
    longest = np.fmax(straight, np.fmax.reduce(corners))
    return np.asarray(0.5 * WIDER * np.where(np.isfinite(straight), longest, np.nan))


Indices = NDArray[np.int64]

#: Where a box is looked at to tell how large it is, and how curvature changes in it.
_ROUND = np.array([(0, 0), (0.5, 0), (1, 0), (1, 0.5), (1, 1), (0.5, 1), (0, 1), (0, 0.5)])
_NEIGHBOURS = ((-1, 0), (1, 0), (0, -1), (0, 1), (-1, -1), (-1, 1), (1, -1), (1, 1))


@dataclass(slots=True)
class CellContacts:
    """Contacts on one face, each for a cell.

    point, normal, direction_max, curvature : as in SurfaceSamples. axis (n, 3), flat (n,): posture to start from, nan
    where there is none, and whether it leans nowhere. patch (n,): radius about the contact, mm, within which its cell
    lies. home (n, 2): the grid's tile, of which the cell is a part. tile (n, 2): among the lines of its level. middle,
    span (n, 2): rectangle in parameters. whole (n,): it lies in the trim altogether. size (n,): largest distance from its
    middle, mm, nan where that is not known. area (n,): mm2 of what lies in the trim.
    not_reached (n,): a posture was searched for, and there is none. side (n, 3): unit tilt direction where the axis is the normal
    all over the cell. sample (n,): the row of the sample whose posture it starts from, -1 for none.
    """

    point: Floats
    normal: Floats
    direction_max: Floats
    curvature: Floats
    axis: Floats
    flat: NDArray[np.bool_]
    patch: Floats
    home: Ints
    tile: Indices
    middle: Floats
    span: Floats
    whole: NDArray[np.bool_]
    size: Floats
    area: Floats
    not_reached: NDArray[np.bool_]
    side: Floats
    sample: Indices

    def of(self, rows: NDArray[Any]) -> "CellContacts":
        return CellContacts(*(getattr(self, name)[rows] for name in self.__slots__))

    @staticmethod
    def joined(*parts: "CellContacts") -> "CellContacts":
        return CellContacts(*(np.concatenate([getattr(each, n) for each in parts]) for n in CellContacts.__slots__))

    def __len__(self) -> int:
        return len(self.point)


@dataclass(slots=True)
class Field:
    """A face, its grid's tiles and what is known of the surface at their nodes.

    `part`, `orientation`, `number`, `trim`: the face.
    `lines` (list of (u, v)): lines between tiles, level by level, each halving the one before.
    `index` (nu, nv) int32: each tile's node, -1: nothing of it lies in the trim, or its node was not judged.
    `closed` (2,) bool.
    `point`, `normal`, `tensor`, `wobble`, `radius` (k, ...) float: of the nodes. How far the curvature may differ in the cell,
        1/mm, and how far it reaches, mm; nan: not known.
    """

    part: Part
    orientation: Orientation
    number: int
    trim: Trim
    lines: list[tuple[Floats, Floats]]
    index: Ints
    closed: NDArray[np.bool_]
    point: Floats
    normal: Floats
    tensor: Floats
    variation: Floats = field(default_factory=lambda: np.zeros(0))
    radius: Floats = field(default_factory=lambda: np.zeros(0))

    @property
    def about(self) -> Floats:
        """Put the nodes into the form that kernels take (`kernels.area.zone.Nodes`)."""
        upper = self.tensor.reshape(-1, 9)[:, [0, 1, 2, 4, 5, 8]]
        largest, spread = steepest(self.tensor, self.variation)
        return np.column_stack([self.point, self.normal, upper, self.variation, self.radius, largest, spread])

    def at(self, uv: Floats) -> tuple[Floats, Floats, Floats, Floats]:
        """Points, normals, larger principal directions and curvatures at parameters (n, 2)."""
        point, shape = evaluate(self.part, self.orientation, self.number, uv)
        return point, shape.normal, shape.direction_max, shape.curvature

    def weight(self, clip: Clipped) -> Floats:
        """Areas (n,) on the surface, mm2, by the density at the middle."""
        per = density(self.part, self.number, clip.middle)
        known = per[np.isfinite(per)]
        return np.asarray(clip.area * np.where(np.isfinite(per), per, known.mean() if len(known) else 1.0))

    def around(self, low: Floats, high: Floats, point: Floats, tensor: Floats | None) -> tuple[Floats, Floats]:
        """How far (n,) boxes reach from their contacts, mm, and how far curvature may differ in them, 1/mm."""
        uv = low[:, None] + _ROUND * (high - low)[:, None]
        there, *shape = self.at(uv.reshape(-1, 2))
        reach = WIDER * np.linalg.norm(there.reshape(-1, len(_ROUND), 3) - point[:, None], axis=2).max(axis=1)
        if tensor is None:
            return reach, np.zeros(len(reach))
        bend = tensors(*shape).reshape(-1, len(_ROUND), 9) - tensor.reshape(-1, 1, 9)
        return reach, WILDER * np.linalg.norm(bend, axis=2).max(axis=1)


def laid(
    part: Part, orientation: Orientation, samples: SurfaceSamples, grid: FaceGrid, reach: Verdicts, conditions: Conditions
) -> tuple[Field, CellContacts, CellContacts]:
    """The field of a face, the contacts at its samples, and those of tiles whose node lies outside the trim."""
    trim = part.trim(grid.face)
    assert trim is not None, "a face without a border has no samples"
    u, node_u = _tiles(grid.u, grid.closed_u, grid.span[:2], trim.box[:2])
    v, node_v = _tiles(grid.v, grid.closed_v, grid.span[2:], trim.box[2:])
    start = int(grid.index[grid.index >= 0].min())
    rows = np.arange(start, start + int((grid.index >= 0).sum()))
    tensor = tensors(samples.normal[rows], samples.direction_max[rows], samples.curvature[rows])
    local = np.where(grid.index < 0, -1, grid.index - start)
    index = local[np.ix_(node_u, node_v)].astype(np.int32)
    index[node_u < 0], index[:, node_v < 0] = -1, -1
    field = Field(part, orientation, grid.face, trim, [(u, v)], index, np.array([grid.closed_u, grid.closed_v]),
                  samples.point[rows], samples.normal[rows], tensor)  # fmt: skip
    field.variation, field.radius = from_neighbours(field.point, tensor, grid, local)
    tile = np.argwhere(np.ones(index.shape, bool))
    clip = clipped(trim, u, v, tile)
    chosen = np.flatnonzero(clip.area > 0)
    tile, clip = tile[chosen], clip.at(chosen)
    area = field.weight(clip)
    area *= part.faces[grid.face - 1].area / max(area.sum(), 1e-300)
    node = index[tile[:, 0], tile[:, 1]]
    # What is known of nodes without a neighbour along some line comes from the boxes of their cells.
    lone = np.flatnonzero((node >= 0) & np.isnan(field.radius[node]))
    if len(lone):
        own = node[lone]
        reaches, variation = field.around(clip.low[lone], clip.high[lone], field.point[own], field.tensor[own])
        field.radius[own] = 0.0
        np.maximum.at(field.radius, own, reaches)
        np.maximum.at(field.variation, own, variation)
    judged = (node >= 0) & (samples.unjudged[rows[node]] < 0)
    mine = rows[node[judged]]
    middle, span = _rectangles((u, v), tile)
    size = field.radius[node]
    contacts = CellContacts(
        samples.point[mine], samples.normal[mine], samples.direction_max[mine], samples.curvature[mine],
        reach.axis[mine], reach.verdict[mine] == INTERFERENCE_FREE, size[judged], tile[judged].astype(np.int32), tile[judged],
        middle[judged], span[judged], clip.whole[judged], size[judged], area[judged], not_reached(reach.verdict[mine]),
        reach.tilt_direction[mine], mine,
    )  # fmt: skip
    bare = node < 0
    geometry = field.at(clip.middle[bare])
    neighbours = _neighbours(index, tile[bare], rows, reach)
    axis, side = (
        np.where((neighbours < 0)[:, None], np.nan, column[neighbours]) for column in (reach.axis, reach.tilt_direction)
    )
    flat = (reach.verdict[neighbours] == INTERFERENCE_FREE) & (neighbours >= 0)
    strips = CellContacts(
        *geometry, _started(axis, flat, geometry[1], conditions), flat, np.zeros(len(flat)),
        tile[bare].astype(np.int32), tile[bare], middle[bare], span[bare], clip.whole[bare], np.full(len(flat), np.nan),
        area[bare], np.zeros(len(flat), bool), side, neighbours,
    )  # fmt: skip
    # Contacts on their own become nodes, with how far their cells reach.
    tensor = tensors(strips.normal, strips.direction_max, strips.curvature)
    radius, variation = np.zeros(0), np.zeros(0)
    if len(strips):
        radius, variation = field.around(clip.low[bare], clip.high[bare], strips.point, tensor)
    field.index[strips.tile[:, 0], strips.tile[:, 1]] = len(field.point) + np.arange(len(strips))
    strips.patch[:] = radius
    for name, more in (
        ("point", strips.point), ("normal", strips.normal), ("tensor", tensor), ("variation", variation), ("radius", radius)
    ):  # fmt: skip
        setattr(field, name, np.concatenate([getattr(field, name), more]))
    return field, contacts, strips


def quartered(contacts: CellContacts, field: Field, level: int, conditions: Conditions) -> CellContacts:
    """Up to four contacts for each, in the quarters of its cell that lie in the trim; `level`: how often these were cut."""
    while len(field.lines) < level + 2:
        field.lines.append((_halved(field.lines[-1][0]), _halved(field.lines[-1][1])))
    lines = field.lines[level + 1]
    four = np.array([[0, 0], [0, 1], [1, 0], [1, 1]])
    tile = (2 * contacts.tile[:, None] + four).reshape(-1, 2)
    parent = np.repeat(np.arange(len(contacts)), 4)
    middle, span = _rectangles(lines, tile)
    clip = Clipped(span.prod(axis=1), middle.copy(), middle - 0.5 * span, middle + 0.5 * span, np.ones(len(tile), bool))
    cut = np.flatnonzero(~contacts.whole[parent])
    if len(cut):
        for column, result in zip(clip, clipped(field.trim, *lines, tile[cut]), strict=True):
            column[cut] = result
    nonempty = np.flatnonzero(clip.area > 0)
    tile, parent, middle, span = tile[nonempty], parent[nonempty], middle[nonempty], span[nonempty]
    clip = clip.at(nonempty)
    weight = field.weight(clip)
    whole = np.bincount(parent, weight, len(contacts))[parent]
    geometry = field.at(clip.middle)
    size = 0.5 * contacts.size[parent]
    patch = np.where(clip.whole, size, np.nan)
    boxed = np.flatnonzero(np.isnan(patch))
    if len(boxed):
        patch[boxed] = field.around(clip.low[boxed], clip.high[boxed], geometry[0][boxed], None)[0]
    flat = contacts.flat[parent]
    return CellContacts(*geometry, _started(contacts.axis[parent], flat, geometry[1], conditions), flat, patch,
                    contacts.home[parent], tile, middle, span, clip.whole, size,
                    contacts.area[parent] * weight / np.where(whole > 0, whole, 1.0), np.zeros(len(flat), bool),
                    contacts.side[parent], contacts.sample[parent])  # fmt: skip


def _tiles(line: Floats, closed: bool, span: tuple[float, float], box: tuple[float, float]) -> tuple[Floats, NDArray[np.intp]]:
    """Lines between tiles, half way between grid lines and out to the ends, and the grid line (-1: none) of each tile.

    A seam lies between two tiles of the line on it. Where the trim reaches beyond the grid there are tiles without a line.
    """
    between = 0.5 * (line[1:] + line[:-1])
    node = np.arange(len(line))
    if closed:
        between, node = np.append(between, 0.5 * (line[-1] + span[1])), np.append(node, 0)
    ends = np.concatenate([[min(span[0], line[0])], between, [max(span[1], line[-1])]])
    slack = 1e-6 * (ends[-1] - ends[0])
    if box[0] < ends[0] - slack:
        ends, node = np.concatenate([[box[0]], ends]), np.concatenate([[-1], node])
    if box[1] > ends[-1] + slack:
        ends, node = np.append(ends, box[1]), np.append(node, -1)
    ends[0], ends[-1] = min(ends[0], box[0]), max(ends[-1], box[1])
    return ends, node


def _halved(line: Floats) -> Floats:
    return np.sort(np.concatenate([line, 0.5 * (line[1:] + line[:-1])]))


def _rectangles(lines: tuple[Floats, Floats], tile: Indices) -> tuple[Floats, Floats]:
    """Middles and spans (n, 2) of tiles."""
    low = np.stack([line[tile[:, axis]] for axis, line in enumerate(lines)], axis=1)
    high = np.stack([line[tile[:, axis] + 1] for axis, line in enumerate(lines)], axis=1)
    return 0.5 * (low + high), high - low


def _started(axis: Floats, flat: NDArray[np.bool_], normal: Floats, conditions: Conditions) -> Floats:
    """Axes to start from; an interference-free contact leans nowhere: about its own normal, if the machine can."""
    own = np.where(conditions.upright(normal)[:, None], normal, np.nan)
    return np.where(flat[:, None], own, axis)


def _neighbours(index: Ints, tile: Indices, rows: NDArray[np.intp], reach: Verdicts) -> Indices:
    """Row (n,) of a sample in the next tile that has an axis; -1 where there is none."""
    neighbours = np.full(len(tile), -1, np.int64)
    known = np.isfinite(reach.axis[rows, 0])
    for step in _NEIGHBOURS:
        i, j = (tile + step).T
        on = (i >= 0) & (j >= 0) & (i < index.shape[0]) & (j < index.shape[1])
        node = np.where(on, index[np.where(on, i, 0), np.where(on, j, 0)], -1)
        new = (neighbours < 0) & (node >= 0) & known[np.maximum(node, 0)]
        neighbours[new] = rows[node[new]]
    return neighbours
