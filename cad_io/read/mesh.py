"""Triangle meshes: STL, OBJ, PLY and GLB files, or objects that hold triangles, as they are; and which of them enclose something.

Skins without an open edge enclose: where each edge is run along as often one way as the other, windings are whole numbers, and
the skin encloses what is within it: a body or, as little to be got into, a void. Skins whose triangles run both ways are put
right where no edge has more than two.
"""

import hashlib
import io
import json
import os
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from cad_io.arrays import Floats, Record
from cad_io.errors import ReadError
from cad_io.graphs import connected
from cad_io.read.sniff import reported
from cad_io.units import in_mm
from plan_cutters_base import user_files as files

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
    again = _shells(vertex, connected(len(points), near)[corner.reshape(-1, 3)])
    return again if again.open < shells.open else shells


def _shells(vertex: Floats, corner: NDArray[Any]) -> Shells:
    n = len(corner)
    ends = np.stack([corner, np.roll(corner, -1, axis=1)], axis=2).reshape(-1, 2)
    owner, real = np.repeat(np.arange(n), 3), ends[:, 0] != ends[:, 1]
    ends, owner = ends[real], owner[real]
    way = np.where(ends[:, 0] < ends[:, 1], 1, -1)
    _, edge = np.unique(np.sort(ends, axis=1), axis=0, return_inverse=True)
    edge = edge.reshape(-1)
    edges = int(edge.max(initial=-1)) + 1
    # Triangles and edges in one graph: what is connected is a skin.
    label = connected(n + edges, np.column_stack([owner, n + edge]))
    count, shell, of_edge = int(label.max(initial=-1)) + 1, label[:n], label[n:]
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
    label = connected(2 * n, np.column_stack([a, b]))
    mine = np.unique(np.concatenate([one, other]))
    mine = mine[label[mine] != label[mine + n]]
    sense[mine] = np.where(label[mine] < label[mine + n], 1, -1)
    return sense, mine


#: Kinds of files by their suffix.
KINDS = {".stl": "stl", ".obj": "obj", ".ply": "ply", ".glb": "glb"}
#: Beyond this, mm, a coordinate has too few digits left for any tolerance.
_FARTHEST = 1e9


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Mesh(Record):
    """Triangles as a file has them."""

    #: (n, 3, 3); corners, mm.
    vertex: Floats
    #: The triangles that enclose something.
    shells: Shells
    #: The unit that the file's lengths were taken to be in.
    unit: str
    #: The assumptions that were made.
    notes: tuple[str, ...]
    file: str | None = None
    sha256: str | None = None


def read_mesh(source: Any, unit: str | None = None) -> Mesh:
    """Read a mesh: an STL, OBJ, PLY or GLB file, told by its suffix, or an object with `triangles` (n, 3, 3), as trimesh has it.

    unit: one of `um`, `mm`, `cm`, `m`, `km`, `mil`, `in`, `ft`; default metres for GLB, as its specification has it, else mm.
    Raises ReadError with the fault and its remedy in one line.
    """
    notes: tuple[str, ...] = ()
    file = sha256 = None
    kind = ""
    if isinstance(source, str | os.PathLike):
        file = os.fspath(source)
        kind = KINDS.get(Path(file).suffix.lower(), "")
        if not kind:
            raise ReadError("is no mesh that can be read: give STL, OBJ, PLY or GLB", file=file)
        with reported(file):
            data = files.content(file)
        sha256 = hashlib.sha256(data).hexdigest()
        vertex = _triangles(data, kind, file)
    else:
        try:
            vertex = np.array(source.triangles, dtype=float)
        except (AttributeError, TypeError, ValueError):
            raise ReadError(f"the {type(source).__name__} holds no triangles") from None
    if vertex.ndim != 3 or vertex.shape[1:] != (3, 3) or not len(vertex):
        raise ReadError("holds no triangles: export it as a mesh of them", file=file)
    if not np.isfinite(vertex).all():
        raise ReadError("has corners that are no points (nan or infinite): export it again", file=file)
    if kind == "glb":
        # glTF has Y up.
        vertex = np.stack([vertex[..., 0], -vertex[..., 2], vertex[..., 1]], axis=-1) + 0.0
        notes = (f"its lengths are {'metres' if unit is None else unit}, and its Y axis is the part's Z, as GLB has it",)
    elif unit is None and file is not None:
        notes = (f"{kind.upper()} files name no unit: mm was assumed",)
    unit = unit or ("m" if kind == "glb" else "mm")
    vertex = np.ascontiguousarray(vertex * in_mm(unit))
    if not np.abs(vertex).max() <= _FARTHEST:
        raise ReadError(f"reaches more than {_FARTHEST:.0e} mm from the origin: is its unit right?", file=file)
    return Mesh(vertex, shells(vertex), unit, notes, file, sha256)


def is_mesh(source: Any) -> bool:
    """Whether an object holds triangles, as a trimesh mesh does, and no shape of the kernel."""
    return not hasattr(source, "wrapped") and hasattr(source, "triangles") and hasattr(source, "vertices")


def _triangles(data: bytes, kind: str, file: str) -> Floats:
    """Triangles (n, 3, 3) of a file's bytes, nothing cleaned up."""
    import trimesh

    if not data.strip():
        raise ReadError("is empty", file=file)
    if kind == "stl" and len(data) != 84 + 50 * int.from_bytes(data[80:84], "little") and b"endsolid" not in data:
        raise ReadError("is not a whole STL file: its end is missing; export it again", file=file)
    if kind == "glb" and (other := _external_buffer(data)):
        raise ReadError(f"has its numbers in another file ({other}): export it as one file", file=file)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            # Cleaning up would drop in silence what is no number.
            mesh = trimesh.load(io.BytesIO(data), file_type=kind, process=False)
        parts = list(_placed(mesh))
    except Exception as error:
        # Whatever a broken file makes of the reader's code.
        cause = " ".join(str(error).split())[:80]
        raise ReadError(
            f"is not a whole {kind.upper()} file ({cause or type(error).__name__}): export it again", file=file
        ) from None
    return np.concatenate([np.zeros((0, 3, 3)), *parts])


def _external_buffer(data: bytes) -> str:
    """Name of a file that a GLB takes numbers from; empty where it holds them all, or is none."""
    try:
        head = json.loads(data[20 : 20 + int.from_bytes(data[12:16], "little")])
        names = [str(each.get("uri", "data:")) for each in head.get("buffers", ())]
    except (ValueError, AttributeError, TypeError, RecursionError):
        return ""
    return next((ascii(name)[1:-1][:80] for name in names if not name.startswith("data:")), "")


def _placed(scene: Any) -> Iterator[NDArray[np.float64]]:
    """Triangles of a mesh, or of each mesh of a scene where it stands."""
    if not hasattr(scene, "graph"):
        if hasattr(scene, "faces"):
            yield _corners(scene)
        return
    for node in scene.graph.nodes_geometry:
        place, name = scene.graph[node]
        mesh = scene.geometry[name]
        if hasattr(mesh, "faces"):
            yield _corners(mesh) @ np.asarray(place)[:3, :3].T + np.asarray(place)[:3, 3]


def _corners(mesh: Any) -> NDArray[np.float64]:
    return np.asarray(mesh.vertices, float)[np.asarray(mesh.faces)].reshape(-1, 3, 3)
