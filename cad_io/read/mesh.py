"""Triangle meshes: STL, OBJ, PLY and GLB files, or objects that hold triangles, as they are; and what they enclose."""

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

from cad_io.arrays import Floats, Record
from cad_io.errors import ReadError
from cad_io.read.shells import Shells, shells
from cad_io.units import in_mm
from plan_cutters_base import user_files as files

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
    """Read a mesh.

    Parameters
    ----------
    source : path or object
        Path of an STL, OBJ, PLY or GLB file, told by its suffix; or an object with `triangles` (n, 3, 3), as trimesh has it.
    unit : str, optional
        One of `um`, `mm`, `cm`, `m`, `km`, `mil`, `in`, `ft`. Default: metres for GLB, as its specification has it, else mm.

    Raises
    ------
    ReadError
        In one line: the fault and its remedy.
    """
    notes: tuple[str, ...] = ()
    file = sha256 = None
    kind = ""
    if isinstance(source, str | os.PathLike):
        file = os.fspath(source)
        kind = KINDS.get(Path(file).suffix.lower(), "")
        if not kind:
            raise ReadError("is no mesh that can be read: give STL, OBJ, PLY or GLB", file=file)
        data = _content(file)
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


def _content(file: str) -> bytes:
    try:
        return files.content(file)
    except FileNotFoundError:
        raise ReadError("no such file", file=file) from None
    except files.IrregularError:
        raise ReadError("is no file: a folder, a pipe or a device", file=file) from None
    except MemoryError:
        raise ReadError("is too large for the memory allowed: give more, or a coarser mesh", file=file) from None
    except (OSError, ValueError) as error:
        raise ReadError(f"cannot be read: {getattr(error, 'strerror', None) or error}", file=file) from None


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
