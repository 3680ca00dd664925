"""Which triangles of a mesh enclose something: skins without an open edge, by the triangles that share edges.

Where each edge is run along as often one way as the other, windings are whole numbers, and the skin encloses what is within
it: a body or, as little to be got into, a void. Skins whose triangles run both ways are put right where no edge has more than
two.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from cad_io.arrays import Floats, Record

#: Corners so near to each other, as a share of the mesh's size, are one where the mesh is open otherwise.
_SAME = 1e-6


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Shells(Record):
    """This record tells which triangles of a mesh enclose something."""

    #: (n,); of each triangle: 1 where its normal points out of what its skin encloses, -1 where it points in, 0 where the skin
    #: is open.
    weight: NDArray[np.int8]
    #: Skins of each kind.
    closed: int
    open: int
    #: Closed skins whose triangles run both ways, or all of them the wrong way.
    turned: int


def shells(vertex: Floats) -> Shells:
    """The skins of triangles with corners (n, 3, 3)."""
    points, corner = np.unique(vertex.reshape(-1, 3), axis=0, return_inverse=True)
    shells = _shells(vertex, corner.reshape(-1, 3))
    if not shells.open:
        return shells
    # Corners that differ in their last digits alone.
    near = cKDTree(points).query_pairs(_SAME * float(np.ptp(points, axis=0).max()), output_type="ndarray")
    if not len(near):
        return shells
    graph = coo_array((np.ones(len(near), np.int8), (near[:, 0], near[:, 1])), shape=(len(points),) * 2)
    _, joined = connected_components(graph, directed=False)
    again = _shells(vertex, joined[corner.reshape(-1, 3)])
    return again if again.open < shells.open else shells


def _shells(vertex: Floats, corner: NDArray[np.int64]) -> Shells:
    n = len(corner)
    ends = np.stack([corner, np.roll(corner, -1, axis=1)], axis=2).reshape(-1, 2)
    owner, real = np.repeat(np.arange(n), 3), ends[:, 0] != ends[:, 1]
    ends, owner = ends[real], owner[real]
    way = np.where(ends[:, 0] < ends[:, 1], 1, -1)
    _, edge = np.unique(np.sort(ends, axis=1), axis=0, return_inverse=True)
    edge = edge.reshape(-1)
    edges = int(edge.max(initial=-1)) + 1
    # Triangles and edges in one graph: what is connected is a skin.
    graph = coo_array((np.ones(len(owner), np.int8), (owner, n + edge)), shape=(n + edges, n + edges))
    count, label = connected_components(graph, directed=False)
    shell, of_edge = label[:n], label[n:]
    closed = np.ones(count, bool)
    closed[of_edge[np.bincount(edge, way, edges) != 0]] = False
    # A triangle that is but a point has no edge and encloses nothing.
    closed[shell[np.bincount(owner, minlength=n) == 0]] = False
    pairs = np.ones(count, bool)
    pairs[of_edge[np.bincount(edge, minlength=edges) != 2]] = False
    sense, corrected = _put_right(edge, owner, way, pairs[of_edge] & ~closed[of_edge], n)
    fixed = np.zeros(count, bool)
    fixed[shell[corrected]] = True
    weight = np.where((closed | fixed)[shell], sense, 0)
    centre = vertex.mean(axis=(0, 1))
    a, b, c = np.moveaxis(vertex - centre, 1, 0)
    volume = np.bincount(shell, weight * (np.cross(a, b) * c).sum(axis=1), count)
    inward = volume < 0
    weight = np.where(inward[shell], -weight, weight).astype(np.int8)
    present = np.unique(shell)
    shut = (closed | fixed)[present]
    return Shells(weight, int(shut.sum()), int((~shut).sum()), int((shut & (fixed | inward)[present]).sum()))


def _put_right(
    edge: NDArray[np.int64], owner: NDArray[np.int64], way: NDArray[np.int64], requested: NDArray[np.bool_], n: int
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Senses (n,) in which triangles run the same way round as their neighbours, and those of skins that have such senses.

    `requested` (edges,): those of the skins to put right, each of two triangles.
    """
    sense = np.ones(n, np.int64)
    rows = np.flatnonzero(requested[edge])
    if not len(rows):
        return sense, rows
    rows = rows[np.argsort(edge[rows], kind="stable")]
    one, other = owner[rows[::2]], owner[rows[1::2]]
    turned = way[rows[::2]] == way[rows[1::2]]
    # Each triangle twice, as it is and turned over: in a skin with two sides the two are never connected.
    a = np.concatenate([one, one + n])
    b = np.concatenate([other + n * turned, other + n * ~turned])
    graph = coo_array((np.ones(len(a), np.int8), (a, b)), shape=(2 * n, 2 * n))
    _, label = connected_components(graph, directed=False)
    mine = np.unique(np.concatenate([one, other]))
    mine = mine[label[mine] != label[mine + n]]
    sense[mine] = np.where(label[mine] < label[mine + n], 1, -1)
    return sense, mine
