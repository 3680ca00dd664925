"""A part is made of what a reader has found: its record, and a form of it without anything of the kernel's."""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import Any

from OCP.BRep import BRep_Builder
from OCP.gp import gp_Pnt
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Vertex

from cad_io.arrays import LostFace, SizeNote
from cad_io.kernel.shapes import Node, as_bytes, children, compound, of_bytes
from cad_io.units import UnitReading


@dataclass(slots=True)
class PartContent:
    """A reader has found this, and a `Part` is made of it."""

    #: One shape, located, lengths in mm.
    shape: Any
    #: Where it was read from, and the checksum of those bytes.
    file: str | None = None
    sha256: str | None = None
    #: The unit that its lengths were taken to be in, where that is not what the source says.
    unit: str | None = None
    #: By face number: names, sRGB colours (0 to 1) and layers in the file.
    names: dict[int, str] = field(default_factory=dict)
    colours: dict[int, tuple[float, float, float]] = field(default_factory=dict)
    layers: dict[int, tuple[str, ...]] = field(default_factory=dict)
    #: The products in the file; default one without a name.
    tree: tuple[Any, ...] = ()
    #: What the reader found odd; odd sizes are added by the part.
    warnings: list[str] = field(default_factory=list)
    #: Numbers of the faces that were picked on the object which the part was made from.
    picked: tuple[int, ...] = ()
    #: Faces written in the file that are not here, or not as written; the part adds those without a finite size.
    lost: list[LostFace] = field(default_factory=list)
    #: What is doubtful of what the file says about its unit.
    unit_readings: tuple[UnitReading, ...] = ()
    #: What the encoding of its names is called, where the file has an older one.
    encoding: str = ""
    #: Diameters with tolerances and notes that the file states of faces.
    sizes: tuple[SizeNote, ...] = ()


def packed(content: PartContent) -> PartContent:
    """Without kernel objects: the shape as bytes, and behind it one vertex for the place of each node of the tree."""
    vertex = TopoDS_Vertex()
    BRep_Builder().MakeVertex(vertex, gp_Pnt(), 1e-7)
    places = (vertex.Located(node.place) for root in content.tree for node, *_ in root.walk())
    return replace(content, shape=as_bytes(compound([content.shape, *places])), tree=tuple(map(_bare, content.tree)))


def unpacked(packed: PartContent) -> PartContent:
    """Return what was given to `packed`, with new copies of the shape and of the locations."""
    shape, *vertices = children(of_bytes(packed.shape))
    places = iter([vertex.Location() for vertex in vertices])
    return replace(packed, shape=shape, tree=tuple(_placed(bare, places) for bare in packed.tree))


def comes_back(packed_content: PartContent) -> bool:
    """Whether what is unpacked is what was packed to the last bit: the kernel makes directions unit vectors again as it reads."""
    return bool(packed(unpacked(packed_content)).shape == packed_content.shape)


def _bare(node: Node) -> tuple[Any, ...]:
    return node.name, node.instance, [_bare(child) for child in node.children], node.faces


def _placed(bare: tuple[Any, ...], places: Iterator[TopLoc_Location]) -> Node:
    name, instance, inner, numbers = bare
    place = next(places)
    return Node(name, instance, place, tuple(_placed(child, places) for child in inner), numbers)
