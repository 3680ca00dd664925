"""Convert the arguments that make a part to plain bytes and back: to pass them between processes, or to store them."""

import io
from collections.abc import Iterator, Sequence
from typing import Any

from OCP.BinTools import BinTools
from OCP.BRep import BRep_Builder
from OCP.gp import gp_Pnt
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS, TopoDS_Face, TopoDS_Shape, TopoDS_Vertex

from cad_io.kernel.shapes import Node, children, compound

#: What `Part` is made of, by the names of its parameters.
PartContent = dict[str, Any]


def packed(content: PartContent) -> PartContent:
    """Without kernel objects: the shape as bytes, and behind it one vertex for the place of each node of the tree."""
    vertex = TopoDS_Vertex()
    BRep_Builder().MakeVertex(vertex, gp_Pnt(), 1e-7)
    tree = content.get("tree", ())
    stream = io.BytesIO()
    BinTools.Write_s(compound([content["shape"], *(vertex.Located(place) for place in _places(tree))]), stream)
    return content | {"shape": stream.getvalue(), "tree": [_bare(node) for node in tree]}


def unpacked(packed: PartContent) -> PartContent:
    """Return the arguments that were given to `packed`, with new copies of the shape and of the locations."""
    whole = TopoDS_Shape()
    BinTools.Read_s(whole, io.BytesIO(packed["shape"]))
    shape, *vertices = children(whole)
    places = iter([vertex.Location() for vertex in vertices])
    return packed | {"shape": shape, "tree": tuple(_placed(bare, places) for bare in packed["tree"])}


def comes_back(packed_content: PartContent) -> bool:
    """Whether what is unpacked is what was packed to the last bit: the kernel makes directions unit vectors again as it reads."""
    return bool(packed(unpacked(packed_content))["shape"] == packed_content["shape"])


def packed_faces(faces: Sequence[TopoDS_Face]) -> bytes:
    """Faces with the edges that they share."""
    stream = io.BytesIO()
    BinTools.Write_s(compound(list(faces)), stream)
    return stream.getvalue()


def unpacked_faces(form: bytes) -> list[TopoDS_Face]:
    """Return new copies of the faces that were given to `packed_faces`, in their order."""
    whole = TopoDS_Shape()
    BinTools.Read_s(whole, io.BytesIO(form))
    return [TopoDS.Face_s(each) for each in children(whole)]


def _places(tree: tuple[Node, ...]) -> Iterator[TopLoc_Location]:
    for node in tree:
        yield node.place
        yield from _places(node.children)


def _bare(node: Node) -> tuple[Any, ...]:
    return node.name, node.instance, [_bare(child) for child in node.children], node.faces


def _placed(bare: tuple[Any, ...], places: Iterator[TopLoc_Location]) -> Node:
    name, instance, inner, numbers = bare
    place = next(places)
    return Node(name, instance, place, tuple(_placed(child, places) for child in inner), numbers)
