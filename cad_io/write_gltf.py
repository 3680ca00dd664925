"""A split part as GLB: metres, Y up, one node a face of the part and below it one a piece, facts in their `extras`.

An own writer, because trimesh (5.2) rounds linear colours to 8 bits, which shows in dark ones, and ties the bytes of a
file to its version. The format asked for here is small: see the glTF 2.0 specification, sections 3.6 and 4.4.
"""

import json
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepBuilderAPI import BRepBuilderAPI_Copy
from OCP.BRepMesh import BRepMesh_IncrementalMesh
from OCP.TopAbs import TopAbs_REVERSED
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS

from cad_io.arrays import Floats, Style
from cad_io.aside import aside
from cad_io.errors import WriteError
from cad_io.kernel import first_derivatives, translated
from cad_io.split import Piece, Split

#: Largest angle between neighbouring facets, rad.
ANGLE = 0.35
#: Default chord error as a share of the part's diagonal.
FINE = 5e-4
_METRE = 1e-3
_FLOAT, _INDEX = 5126, 5125  # component types: 32-bit float, 32-bit unsigned integer
_VERTICES, _TRIANGLES = 34962, 34963  # what a buffer view is for


class _Mesh(NamedTuple):
    """Points (n, 3) mm and unit normals (n, 3) in part coordinates; triangles (m, 3) counter-clockwise from outside."""

    point: Floats
    normal: Floats
    triangle: NDArray[np.uint32]


def write_gltf(
    split: Split,
    path: str | Path,
    style: Callable[[Piece], Style],
    *,
    extras: Callable[[int], dict[str, Any]],
    piece_extras: Callable[[Piece], dict[str, Any]],
    deflection: float | None = None,
) -> tuple[int, ...]:
    """Write all pieces as triangles.

    Parameters
    ----------
    split : Split
    path : path-like
        Appears whole or not at all.
    style : callable
        Name and sRGB colour of a piece; the file has the linear colour that glTF asks for, and looks the same.
    extras : callable
        Facts (JSON values) about a face, by number: `extras` of the node `F<number>`.
    piece_extras : callable
        Facts about a piece: `extras` of its node, which has the style's name.
    deflection : float, optional
        Chord error of the triangles, mm; default FINE times the part's diagonal.

    Returns
    -------
    tuple of int
        Places in `split.pieces` that the kernel could not mesh; their nodes have no mesh.

    Raises
    ------
    WriteError
        The file cannot be written, or there is no triangle to write.
    """
    with aside(path) as temporary:
        with translated("meshing", error=WriteError, file=str(path)):
            meshes = _meshes(split, deflection)
        if not any(meshes):
            raise WriteError("the CAD kernel made no triangle of the part", file=str(path))
        temporary.write_bytes(_glb(split, meshes, style, extras, piece_extras))
    return tuple(i for i, mesh in enumerate(meshes) if mesh is None)


def linear(rgb: tuple[float, float, float]) -> list[float]:
    """Linear light of an sRGB colour (IEC 61966-2-1), 0 to 1."""
    c = np.asarray(rgb, float)
    light = np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)
    return [round(float(x), 6) for x in light]


def _meshes(split: Split, deflection: float | None) -> list[_Mesh | None]:
    # A copy without triangles: the part is not to carry ours, and finer ones that it carries would change the file.
    copy = BRepBuilderAPI_Copy(split.shape, False, False)
    if deflection is None:
        deflection = FINE * _diagonal(split)
    BRepMesh_IncrementalMesh(copy.Shape(), deflection, False, ANGLE, False)
    return [_mesh(piece.shape, TopoDS.Face_s(copy.ModifiedShape(piece.shape))) for piece in split.pieces]


def _diagonal(split: Split) -> float:
    from OCP.Bnd import Bnd_Box
    from OCP.BRepBndLib import BRepBndLib

    box = Bnd_Box()
    BRepBndLib.Add_s(split.shape, box, False)
    return float(np.sqrt(box.SquareExtent()))


def _mesh(face: Any, meshed: Any) -> _Mesh | None:
    location = TopLoc_Location()
    triangulation = BRep_Tool.Triangulation_s(meshed, location)
    if triangulation is None or not triangulation.HasUVNodes():
        return None
    uv = np.array([triangulation.UVNode(i + 1).Coord() for i in range(triangulation.NbNodes())])
    triangle = np.array([triangulation.Triangle(i + 1).Get() for i in range(triangulation.NbTriangles())]) - 1
    # The mesh's own nodes, not the surface's points: along an edge both faces have the same ones, and no cracks.
    place = location.Transformation()
    nodes = (triangulation.Node(i + 1).Transformed(place).Coord() for i in range(triangulation.NbNodes()))
    point = np.array(list(nodes))
    s = first_derivatives(BRepAdaptor_Surface(face, False), uv[:, 0], uv[:, 1])
    normal = np.cross(s[:, 1], s[:, 2])
    if face.Orientation() == TopAbs_REVERSED:
        triangle, normal = triangle[:, ::-1], -normal
    # Corners that are one point in 32 bits make a triangle without a normal or an inside.
    corner = (point * _METRE).astype(np.float32)[triangle]
    facet = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]).astype(float)
    kept = (facet**2).sum(1) > 0
    triangle, facet = triangle[kept], facet[kept]
    if not len(triangle):
        return None
    used, triangle = np.unique(triangle, return_inverse=True)
    point, normal, tangents = point[used], normal[used], s[used, 1:]
    length = np.linalg.norm(normal, axis=1)
    # At a pole the tangents give no normal: there the facets around it do.
    pole = ~(length > 1e-6 * np.linalg.norm(tangents, axis=2).prod(axis=1))
    around = np.zeros_like(point)
    np.add.at(around, triangle.reshape(-1, 3), facet[:, None] / np.linalg.norm(facet, axis=1)[:, None, None])
    normal = np.where(pole[:, None], around, normal / np.where(pole, 1.0, length)[:, None])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    return _Mesh(point, normal, triangle.reshape(-1, 3).astype(np.uint32))


def _glb(
    split: Split,
    meshes: list[_Mesh | None],
    style: Callable[[Piece], Style],
    extras: Callable[[int], dict[str, Any]],
    piece_extras: Callable[[Piece], dict[str, Any]],
) -> bytes:
    data = bytearray()
    views: list[dict[str, Any]] = []
    accessors: list[dict[str, Any]] = []
    materials: list[dict[str, Any]] = []
    material_of: dict[tuple[float, ...], int] = {}
    nodes: list[dict[str, Any]] = [{"name": "part", "children": []}]
    drawn: list[dict[str, Any]] = []
    node_of: dict[int, dict[str, Any]] = {}

    def accessor(array: NDArray[Any], kind: str, target: int, **more: Any) -> int:
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": array.nbytes, "target": target})
        component = _INDEX if array.dtype == np.uint32 else _FLOAT
        accessors.append(
            {"bufferView": len(views) - 1, "componentType": component, "count": len(array), "type": kind, **more}
        )
        data.extend(array.tobytes())  # all items have 4 bytes: every view starts aligned
        return len(accessors) - 1

    for piece, mesh in zip(split.pieces, meshes, strict=True):
        name, rgb = style(piece)
        if piece.face not in node_of:
            node_of[piece.face] = {"name": f"F{piece.face}", "extras": extras(piece.face), "children": []}
            nodes[0]["children"].append(len(nodes))
            nodes.append(node_of[piece.face])
        node: dict[str, Any] = {"name": name, "extras": piece_extras(piece)}
        node_of[piece.face]["children"].append(len(nodes))
        nodes.append(node)
        if mesh is None:
            continue
        if rgb not in material_of:
            material_of[rgb] = len(materials)
            pbr = {"baseColorFactor": [*linear(rgb), 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.8}
            # Open shells are looked at from both sides.
            materials.append({"name": _hex(rgb), "pbrMetallicRoughness": pbr, "doubleSided": True})
        point = _y_up(mesh.point * _METRE)
        ends = {"min": point.min(axis=0).tolist(), "max": point.max(axis=0).tolist()}
        primitive = {
            "attributes": {
                "POSITION": accessor(point, "VEC3", _VERTICES, **ends),
                "NORMAL": accessor(_y_up(mesh.normal), "VEC3", _VERTICES),
            },
            "indices": accessor(mesh.triangle.reshape(-1), "SCALAR", _TRIANGLES),
            "material": material_of[rgb],
        }
        node["mesh"] = len(drawn)
        drawn.append({"name": name, "primitives": [primitive]})

    document = {
        "asset": {"version": "2.0", "generator": "plan-cutters"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": nodes,
        "meshes": drawn,
        "materials": materials,
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(data)}],
    }
    text = json.dumps(document, sort_keys=True, separators=(",", ":"), allow_nan=False).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + bytes(data)
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def _y_up(xyz: Floats) -> NDArray[np.float32]:
    """Part coordinates (Z up) as glTF's (Y up), in 32 bits."""
    # Adding zero turns -0.0 into 0.0.
    return np.ascontiguousarray(np.stack([xyz[:, 0], xyz[:, 2], -xyz[:, 1]], axis=1) + 0.0, np.float32)


def _hex(rgb: tuple[float, ...]) -> str:
    return "#" + "".join(f"{round(255 * c):02X}" for c in rgb)
