"""A split part as GLB: metres, Y up, one node a face of the part and below it one a piece, facts in their `extras`.

Each colour is a material, which every program shows; vertex colours are shown by few. Only the merged variant (one mesh for
all, for parts of thousands of faces, with the face number at each vertex as `_FACE`) has vertex colours under a white material:
viewers multiply the two, so that no mesh may have both.

An own writer, because trimesh (5.2) rounds linear colours to 8 bits, which shows in dark ones, and ties the bytes of a
file to its version. The format asked for here is small: see the glTF 2.0 specification, sections 3.6 and 4.4.
"""

import json
import struct
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from OCP.TopAbs import TopAbs_REVERSED

from cad_io.arrays import Floats, Style
from cad_io.errors import WriteError
from cad_io.kernel import translated
from cad_io.split.pieces import Piece, Split
from cad_io.surface import Surface
from cad_io.tessellate.mesh import meshed
from cad_io.write.render_mesh import ANGLE, FINE, Mesh, diagonal, with_normals
from plan_cutters_base.whole import whole

_METRE = 1e-3
_COMPONENT = {"float32": 5126, "uint32": 5125, "uint16": 5123}
_VERTICES, _TRIANGLES = 34962, 34963  # what a buffer view is for


class Other(NamedTuple):
    """A body that is none of the part: its name, corners (n, 3, 3) mm in part coordinates counter-clockwise from outside, sRGB
    colour, facts for its node's `extras`, and the name of the node that it stands below."""

    name: str
    vertex: Floats
    rgb: tuple[float, float, float]
    extras: dict[str, Any]
    below: str = "fixtures"


class _Mesh(NamedTuple):
    """A piece as vertex attributes: by name, arrays of n vertices; and its triangles (m, 3)."""

    attributes: dict[str, NDArray[Any]]
    triangle: NDArray[np.uint32]


def write_gltf(
    split: Split,
    path: str | Path,
    style: Callable[[Piece], Style],
    *,
    extras: Callable[[int], dict[str, Any]],
    piece_extras: Callable[[Piece], dict[str, Any]],
    merged: bool = False,
    others: Sequence[Other] = (),
) -> tuple[int, ...]:
    """Write all pieces as triangles.

    path: appears whole or not at all. style: name, sRGB colour and kind of a piece; the file has the linear colour that glTF asks
    for, and looks the same. Pieces of one kind and colour share a material, which has the name of the kind. extras, piece_extras:
    facts (JSON values) about a face, by number, in the node `F<number>`, and about a piece, in its node, which has the style's
    name. The triangles' chord error is FINE times the part's diagonal. merged: one node and mesh for
    everything: `extras` of the node holds a list of the faces' facts, and each vertex its face number as `_FACE`. others: bodies
    beside the part, a node each below those that they name.

    Returns numbers of faces of which the kernel could not mesh all pieces; what is missing has a node without a mesh. Raises
    WriteError where the file cannot be written, or there is no triangle to write.
    """
    with whole(path, WriteError) as temporary:
        with translated("meshing", error=WriteError, file=str(path)):
            meshes = list(meshes_of(split))
        if not any(mesh for _, mesh in meshes):
            raise WriteError("the CAD kernel made no triangle of the part", file=str(path))
        pieces = [piece for piece, _ in meshes]
        drawings = [_draw(mesh, style(piece).rgb if merged else None) if mesh else None for piece, mesh in meshes]
        glb = _Glb()
        if merged:
            _fill_merged(glb, pieces, drawings, extras)
        else:
            node_of, root = dict[int, int](), glb.node({"name": "part"})
            for piece, mesh in zip(pieces, drawings, strict=True):
                if piece.face not in node_of:
                    node_of[piece.face] = glb.node({"name": f"F{piece.face}", "extras": extras(piece.face)}, root)
                name, rgb, kind = style(piece)
                shown = glb.mesh(name, mesh, kind or name, rgb)
                glb.node({"name": name, "extras": piece_extras(piece), **shown}, node_of[piece.face])
        _fill_others(glb, others)
        temporary.write_bytes(glb.bytes())
    return tuple(sorted({piece.face for piece, mesh in meshes if mesh is None}))


def linear(rgb: tuple[float, float, float]) -> list[float]:
    """Linear light of an sRGB colour (IEC 61966-2-1), 0 to 1."""
    c = np.asarray(rgb, float)
    light = np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)
    return [round(float(x), 6) for x in light]


def meshes_of(split: Split) -> Iterator[tuple[Piece, Mesh | None]]:
    """The pieces of a split part with triangles to draw them; None where the kernel made none."""
    surfaces: dict[int, Surface] = {}
    shapes = [piece.shape for piece in split.pieces]
    for piece, triangles in zip(split.pieces, meshed(shapes, FINE * diagonal(split.shape), ANGLE), strict=True):
        # To see whether a surface is one that we evaluate takes longer than a small piece: those of a face share it.
        surface = surfaces.get(piece.face) or surfaces.setdefault(piece.face, Surface(piece.shape))
        turned = piece.shape.Orientation() == TopAbs_REVERSED
        yield piece, with_normals(surface, *triangles, turned=turned) if triangles else None


def _draw(mesh: Mesh, vertex_rgb: tuple[float, float, float] | None = None) -> _Mesh:
    attributes: dict[str, NDArray[Any]] = {"POSITION": _y_up(mesh.point * _METRE), "NORMAL": _y_up(mesh.normal)}
    if vertex_rgb is not None:
        light = np.round(np.array([*linear(vertex_rgb), 1.0]) * 65535).astype(np.uint16)
        attributes["COLOR_0"] = np.tile(light, (len(mesh.point), 1))
    return _Mesh(attributes, mesh.triangle)


def _fill_merged(
    glb: "_Glb", pieces: Sequence[Piece], meshes: Sequence[_Mesh | None], extras: Callable[[int], dict[str, Any]]
) -> None:
    shown = [(piece, mesh) for piece, mesh in zip(pieces, meshes, strict=True) if mesh]
    sizes = [len(mesh.attributes["POSITION"]) for _, mesh in shown]
    starts = np.cumsum([0, *sizes[:-1]])
    attributes = {k: np.concatenate([mesh.attributes[k] for _, mesh in shown]) for k in shown[0][1].attributes}
    attributes["_FACE"] = np.repeat(np.array([piece.face for piece, _ in shown], np.float32), sizes)
    triangle = np.concatenate([mesh.triangle + np.uint32(a) for a, (_, mesh) in zip(starts, shown, strict=True)])
    facts = [extras(number) for number in dict.fromkeys(piece.face for piece in pieces)]
    glb.node({"name": "part", "extras": {"faces": facts}, **glb.mesh("part", _Mesh(attributes, triangle), "verdicts")})


def _fill_others(glb: "_Glb", others: Sequence[Other]) -> None:
    """Bodies with flat facets; those without a facet have a node without a mesh."""
    root: dict[str, int] = {}
    for other in others:
        if other.below not in root:
            root[other.below] = glb.node({"name": other.below})
        corner = (other.vertex * _METRE).astype(np.float32)
        normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]).astype(float)
        length = np.linalg.norm(normal, axis=1)
        valid = length > 0
        points = other.vertex[valid].reshape(-1, 3)
        unit = np.repeat(normal[valid] / length[valid, None], 3, axis=0)
        mesh = Mesh(points, unit, np.arange(len(points), dtype=np.uint32).reshape(-1, 3), np.zeros((len(points), 2)))
        other_mesh = glb.mesh(other.name, _draw(mesh) if valid.any() else None, "others", other.rgb)
        glb.node({"name": other.name, "extras": other.extras, **other_mesh}, root[other.below])


class _Glb:
    """The file as it grows."""

    def __init__(self) -> None:
        self.data = bytearray()
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []
        self.nodes: list[dict[str, Any]] = []
        self.roots: list[int] = []
        self.meshes: list[dict[str, Any]] = []
        self.materials: list[dict[str, Any]] = []

    def node(self, node: dict[str, Any], parent: int | None = None) -> int:
        if parent is None:
            self.roots.append(len(self.nodes))
        else:
            self.nodes[parent].setdefault("children", []).append(len(self.nodes))
        self.nodes.append(node)
        return len(self.nodes) - 1

    def mesh(self, name: str, mesh: _Mesh | None, material: str, rgb: tuple[float, float, float] | None = None) -> dict[str, int]:
        """The `mesh` of a node, with a material by name and colour; nothing of either where nothing could be drawn."""
        if mesh is None:
            return {}
        attributes = {key: self._accessor(array, key) for key, array in mesh.attributes.items()}
        indices = self._accessor(mesh.triangle.reshape(-1))
        # White without a colour; open shells are looked at from both sides.
        surface: dict[str, Any] = {"metallicFactor": 0.0, "roughnessFactor": 0.8}
        if rgb is not None:
            surface["baseColorFactor"] = [*linear(rgb), 1.0]
        made = {"name": material, "doubleSided": True, "pbrMetallicRoughness": surface}
        if made not in self.materials:
            self.materials.append(made)
        primitive = {"attributes": attributes, "indices": indices, "material": self.materials.index(made)}
        self.meshes.append({"name": name, "primitives": [primitive]})
        return {"mesh": len(self.meshes) - 1}

    def _accessor(self, array: NDArray[Any], attribute: str = "") -> int:
        target = _VERTICES if attribute else _TRIANGLES
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": array.nbytes, "target": target})
        item: dict[str, Any] = {
            "bufferView": len(self.views) - 1,
            "componentType": _COMPONENT[array.dtype.name],
            "count": len(array),
            "type": "SCALAR" if array.ndim == 1 else f"VEC{array.shape[1]}",
        }
        if attribute == "POSITION":
            item |= {"min": array.min(axis=0).tolist(), "max": array.max(axis=0).tolist()}
        if array.dtype == np.uint16:
            item["normalized"] = True
        self.accessors.append(item)
        self.data.extend(array.tobytes())  # every item has a multiple of 4 bytes: every view starts aligned
        return len(self.accessors) - 1

    def bytes(self) -> bytes:
        document = {
            "asset": {"version": "2.0", "generator": "plan-cutters"},
            "scene": 0,
            "scenes": [{"nodes": self.roots}],
            "nodes": self.nodes,
            "meshes": self.meshes,
            "materials": self.materials,
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{"byteLength": len(self.data)}],
        }
        text = json.dumps(document, sort_keys=True, separators=(",", ":"), allow_nan=False).encode()
        text += b" " * (-len(text) % 4)
        data = bytes(self.data)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def _y_up(xyz: Floats) -> NDArray[np.float32]:
    """Part coordinates (Z up) as glTF's (Y up), in 32 bits."""
    # Adding zero turns -0.0 into 0.0.
    return np.ascontiguousarray(np.stack([xyz[:, 0], xyz[:, 2], -xyz[:, 1]], axis=1) + 0.0, np.float32)
