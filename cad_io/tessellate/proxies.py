"""Make proxy geometry for faces that could not be meshed within the chord error: they are obstacles all the same.

A face that holds only triangles stands with them, any other one with the box around it. A face without area is no wider
than its own edges: these stand for it, as triangles without area.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from OCP.BRep import BRep_Tool
from OCP.TopLoc import TopLoc_Location
from scipy.sparse import coo_array
from scipy.sparse.csgraph import breadth_first_order, connected_components
from scipy.spatial import cKDTree

from cad_io.arrays import Floats, Ints, Record
from cad_io.graphs import connected
from cad_io.kernel import edges_of
from cad_io.part.bodies import coned, polyline
from cad_io.part.part import NO_AREA, Part, face_box
from cad_io.tessellate.mesh import nodes_of

_CORNERS = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)])
#: Nodes each way to estimate the area of a face that is said to have none; the share of the part's squared diagonal up to
#: which that is believed.
_GRID, _SLIVER = 64, 1e-9
#: Nodes of triangles so near, as a share of their extent, are one.
_SAME = 1e-5
#: Triangles of the box with these corners, outward.
_SIDES = np.array([(1, 3, 0), (4, 1, 0), (0, 3, 2), (2, 4, 0), (1, 7, 3), (5, 1, 4),
                   (5, 7, 1), (3, 7, 2), (6, 4, 2), (2, 7, 6), (6, 5, 4), (7, 5, 6)])  # fmt: skip


def boxed(low: Floats, high: Floats) -> Floats:
    """Triangles (12, 3, 3) of the box between two corners (3,), counter-clockwise from outside."""
    return np.asarray((low + _CORNERS * (high - low))[_SIDES])


StandIn = Literal["triangles", "box", "edges", "none"]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class StandIns(Record):
    """Triangles in place of faces."""

    #: (t, 3, 3); corners, mm.
    vertex: Floats
    #: (t,); face number, 0 for a face that is only in the file.
    face: Ints
    #: (t,); 1 where the triangle is part of a skin that encloses something and its corners run counter-clockwise seen from
    #: outside, -1 where they run clockwise, 0 where nothing is known to be enclosed.
    weight: NDArray[np.int8]
    #: Face number -> `triangles`, `box`, `edges`, or `none` where its place is not known.
    how: dict[int, StandIn]


def stand_ins(part: Part, missing: Sequence[tuple[int, str]], chord: float) -> StandIns:
    """Stand-ins for the faces that `Triangles.missing` lists, and boxes for those of `Part.lost` whose place is known.

    chord: distance of edges' polygons from the edges, mm.
    """
    vertex, owner, weight = [np.zeros((0, 3, 3))], [np.zeros(0, np.int32)], [np.zeros(0, np.int8)]
    how: dict[int, StandIn] = {}
    own: dict[int, Floats] = {}

    def add(triangles: Floats, number: int, sign: int) -> None:
        vertex.append(triangles)
        owner.append(np.full(len(triangles), number, np.int32))
        weight.append(np.full(len(triangles), sign, np.int8))

    for number, reason in missing:
        made, sign = np.zeros((0, 3, 3)), 0
        if reason == NO_AREA and len(edges := _edges(part, number, chord)):
            how[number], made = "edges", edges
        elif (triangles := _own_triangles(part, number)) is not None:
            how[number], own[number] = "triangles", triangles
        elif np.isfinite(box := face_box(part.face(number), tight=False)).all():
            how[number], sign, made = "box", 1, boxed(*box)
        else:
            how[number] = "none"
        add(made, number, sign)
    for known in (each.box for each in part.lost if each.face is None and each.box is not None):
        # A face of the file that is not here at all: it stood at least about there.
        add(boxed(*map(np.array, known)), 0, 1)
    if own:
        for number, mine in own.items():
            add(mine, number, 0)
        turned, caps = _enclosing(np.concatenate(list(own.values())))
        weight[-len(own) :] = [turned]
        add(caps, 0, 1)
    return StandIns(np.concatenate(vertex), np.concatenate(owner), np.concatenate(weight), how)


def _own_triangles(part: Part, number: int) -> Floats | None:
    """Triangles (t, 3, 3) that a face without a surface carries."""
    place = TopLoc_Location()
    mesh = BRep_Tool.Triangulation_s(part.face(number), place)
    if mesh is None or not mesh.NbTriangles():
        return None
    corner = np.array([mesh.Triangle(i + 1).Get() for i in range(mesh.NbTriangles())]) - 1
    points = np.asarray(nodes_of(mesh, place)[corner])
    return points if np.isfinite(points).all() else None


def _enclosing(vertex: Floats) -> tuple[NDArray[np.int8], Floats]:
    """Weights (t,) of triangles that enclose something, and caps (k, 3, 3) of weight 1 that close what is open.

    Nodes that are nearly one are one, triangles that repeat others count once. Triangles are joined along edges that two
    of them share; each may be turned in whatever sense its file has it.
    """
    nodes = vertex.reshape(-1, 3)
    near = _SAME * float(np.ptp(nodes, axis=0).max())
    corner = connected(len(nodes), cKDTree(nodes).query_pairs(near, output_type="ndarray")).reshape(-1, 3)
    count, weight = len(vertex), np.zeros(len(vertex), np.int8)
    _, first_of = np.unique(np.sort(corner, axis=1), axis=0, return_index=True)
    counted = np.zeros(count, bool)
    counted[first_of] = True
    counted &= (corner != np.roll(corner, 1, axis=1)).all(axis=1)
    use = np.flatnonzero(np.repeat(counted, 3))
    # Directed edges; two triangles agree if they run along their common edge in opposite directions.
    tail, head = corner.ravel(), np.roll(corner, -1, axis=1).ravel()
    key = np.minimum(tail, head) * np.int64(len(nodes)) + np.maximum(tail, head)
    order = use[np.argsort(key[use], kind="stable")]
    _, start, uses = np.unique(key[order], return_index=True, return_counts=True)
    one, other = order[start[uses == 2]], order[start[uses == 2] + 1]
    agree = np.where(tail[one] == tail[other], -1, 1)
    links = coo_array((np.ones(len(one), np.int8), (one // 3, other // 3)), shape=(count, count)).tocsr()
    way = dict(zip(zip((one // 3).tolist(), (other // 3).tolist(), strict=True), agree.tolist(), strict=True))
    shell_of = connected_components(links, directed=False)[1]
    caps = [np.zeros((0, 3, 3))]
    for shell in np.unique(shell_of[counted]).tolist():
        rows, before = breadth_first_order(links, int(np.argmax((shell_of == shell) & counted)), directed=False)
        for here in rows.tolist():
            back = int(before[here])
            weight[here] = 1 if back < 0 else weight[back] * way.get((back, here), way.get((here, back), 0))
        # How often the skin runs along each of its edges, one way less the other.
        mine = order[shell_of[order // 3] == shell]
        edges, which = np.unique(key[mine], return_inverse=True)
        net = np.bincount(which, weights=weight[mine // 3] * np.where(tail[mine] < head[mine], 1, -1), minlength=len(edges))
        open_edges = [(edges[i] // len(nodes), edges[i] % len(nodes), int(net[i])) for i in np.flatnonzero(net)]
        place = {c: nodes[i] for i, c in enumerate(corner.ravel().tolist())} if open_edges else {}
        cap = coned([(np.array([place[low], place[high]]), n) for low, high, n in open_edges], near)
        origin = vertex[rows[0], 0]
        solid = np.concatenate([vertex[rows] * 1.0, cap]) - origin
        turn = np.concatenate([weight[rows], np.ones(len(cap))])
        if (np.einsum("ij,ij->i", solid[:, 0], np.cross(solid[:, 1], solid[:, 2])) * turn).sum() < 0:
            weight[rows], cap = -weight[rows], cap[:, ::-1]
        caps.append(cap)
    return weight, np.concatenate(caps)


def _edges(part: Part, number: int, chord: float) -> Floats:
    """Edges of a face as triangles (t, 3, 3) without area; none where they may not tell where the face is."""
    trim, pieces = part.trim(number), [np.zeros((0, 3, 3))]
    if trim is None:
        return pieces[0]
    # An area may be zero because one part of the border runs the wrong way round: here none is counted as negative.
    u0, u1, v0, v1 = trim.box
    grid = np.linspace(0.0, 1.0, _GRID)
    share = trim.inside_grid(u0 + grid * (u1 - u0), v0 + grid * (v1 - v0), border=False).mean()
    if share * (u1 - u0) * (v1 - v0) * trim.scale.prod() > _SLIVER * float(np.dot(part.size, part.size)):
        return pieces[0]
    for edge in edges_of(part.face(number)):
        if BRep_Tool.Degenerated_s(edge):
            continue
        line = polyline(edge, chord)
        if not len(line):
            return pieces[0]
        pieces.append(np.stack([line[:-1], line[1:], line[1:]], axis=1))
    return np.concatenate(pieces)
