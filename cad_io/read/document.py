"""Read products, names, colours and layers of numbered faces from the kernel's document, in the same way for STEP and IGES."""

import re
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from OCP.Quantity import Quantity_Color, Quantity_TOC_sRGB
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_Label, TDF_LabelSequence
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_FACE
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Shape
from OCP.XCAFDoc import XCAFDoc_ColorGen, XCAFDoc_ColorSurf, XCAFDoc_ColorTool, XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

from cad_io.kernel import explore, shape_map
from cad_io.kernel.shapes import Node
from cad_io.part.content import PartContent

Colour = tuple[float, float, float]


class DroppedNames(NamedTuple):
    """Names that a document has not: of products by what stands there instead, of instances by both that stand there."""

    products: Mapping[str, str]
    instances: Mapping[tuple[str, str], str]


def add_attributes(document: TDocStd_Document, result: PartContent, dropped: DroppedNames) -> None:
    """Fill in the tree of products, names, colours and layers that a document has for the faces of its shape."""
    walk, start = _Walk(result, dropped), _Inherited(TopLoc_Location())
    result.tree = tuple(walk.node(label, start) for label in each(roots(document)))


def roots(document: TDocStd_Document) -> TDF_LabelSequence:
    """Labels of what the document holds and nothing else is part of."""
    labels = TDF_LabelSequence()
    XCAFDoc_DocumentTool.ShapeTool_s(document.Main()).GetFreeShapes(labels)
    return labels


def each(labels: TDF_LabelSequence) -> Iterator[TDF_Label]:
    """The labels of a sequence, which counts from 1."""
    for i in range(1, labels.Length() + 1):
        yield labels.Value(i)


class FaceMarks:
    """Names, colours and layers of faces, by the numbers that they have in the whole shape; `taken`: those with a component."""

    def __init__(self, shape: TopoDS_Shape) -> None:
        self.map = shape_map(shape, TopAbs_FACE)
        self.names: dict[int, str] = {}
        self.colours: dict[int, Colour] = {}
        self.layers: dict[int, tuple[str, ...]] = {}
        self.taken: set[int] = set()

    def paint(self, numbers: list[int], name: str = "", colour: Colour | None = None, layers: tuple[str, ...] = ()) -> None:
        """Mark faces; what is empty leaves what they have."""
        if name:
            self.names.update(dict.fromkeys(numbers, name))
        if colour:
            self.colours.update(dict.fromkeys(numbers, colour))
        if layers:
            self.layers.update(dict.fromkeys(numbers, layers))

    def numbers(self, shape: TopoDS_Shape, place: TopLoc_Location) -> list[int]:
        """Numbers of the faces of a shape that stands in a place."""
        moved = shape.Moved(place)
        return list(dict.fromkeys(n for face in explore(moved, TopAbs_FACE) if (n := self.map.FindIndex(face))))

    def take(self, numbers: list[int]) -> list[int]:
        """Those that stand in no component yet: now they do."""
        mine = [n for n in numbers if n not in self.taken]
        self.taken.update(mine)
        return mine


class _Walk(FaceMarks):
    """Products, names, colours and layers of faces, gathered from the document: the innermost label that has one wins."""

    def __init__(self, result: PartContent, dropped: DroppedNames) -> None:
        super().__init__(result.shape)
        self.dropped = dropped
        self.names, self.colours, self.layers = result.names, result.colours, result.layers

    def node(self, label: TDF_Label, inherited: "_Inherited") -> Node:
        instance, place = "", TopLoc_Location()
        if XCAFDoc_ShapeTool.IsReference_s(label):
            instance, place = _name(label), XCAFDoc_ShapeTool.GetLocation_s(label)
            inherited = inherited.at(label, place)
            product = TDF_Label()
            XCAFDoc_ShapeTool.GetReferredShape_s(label, product)
            label = product
            instance = self.dropped.instances.get((instance, _name(label)), instance)
        name = self.dropped.products.get(_name(label), _name(label))
        inherited = inherited.at(label)
        if XCAFDoc_ShapeTool.IsAssembly_s(label):
            inner = TDF_LabelSequence()
            XCAFDoc_ShapeTool.GetComponents_s(label, inner, False)
            return Node(name, instance, place, children=tuple(self.node(one, inherited) for one in each(inner)))
        return Node(name, instance, place, faces=tuple(self.take(self.leaf(label, inherited))))

    def leaf(self, label: TDF_Label, inherited: "_Inherited") -> list[int]:
        """Paint the faces of a product; their numbers."""
        shape, inner = XCAFDoc_ShapeTool.GetShape_s(label), TDF_LabelSequence()
        numbers = self.numbers(shape, inherited.place)
        self.paint(numbers, "", inherited.colour, inherited.layers)
        XCAFDoc_ShapeTool.GetSubShapes_s(label, inner)
        parts = [(sub, XCAFDoc_ShapeTool.GetShape_s(sub)) for sub in each(inner)]
        parts = [(sub, part) for sub, part in parts if part.ShapeType().value <= TopAbs_FACE.value]
        # Solids before shells before faces, so that the innermost has the last word.
        for sub, part in sorted(parts, key=lambda pair: int(pair[1].ShapeType().value)):
            name = _name(sub) if part.ShapeType() == TopAbs_FACE else ""
            self.paint(self.numbers(part, inherited.place), name, _colour(sub), _layers(sub))
        return numbers


class _Inherited(NamedTuple):
    """This record holds the attributes of enclosing labels: the colour of an enclosing instance replaces the product's own."""

    place: TopLoc_Location
    colour: Colour | None = None
    layers: tuple[str, ...] = ()

    def at(self, label: TDF_Label, place: TopLoc_Location | None = None) -> "_Inherited":
        return _Inherited(
            self.place.Multiplied(place) if place else self.place, self.colour or _colour(label), self.layers or _layers(label)
        )


def _colour(label: TDF_Label) -> Colour | None:
    colour = Quantity_Color()
    for kind in (XCAFDoc_ColorSurf, XCAFDoc_ColorGen):
        if XCAFDoc_ColorTool.GetColor_s(label, kind, colour):
            red, green, blue = colour.Values(Quantity_TOC_sRGB)
            return round(red, 6), round(green, 6), round(blue, 6)
    return None


def _layers(label: TDF_Label) -> tuple[str, ...]:
    labels = TDF_LabelSequence()  # asked for strings, the kernel gives none (OCCT 7.9)
    XCAFDoc_DocumentTool.LayerTool_s(label).GetLayers(label, labels)
    return tuple(sorted(filter(None, map(_name, each(labels)))))


def _name(label: TDF_Label) -> str:
    # Asking for a name that is not there ends the process, so look first.
    if not label.IsAttribute(TDataStd_Name.GetID_s()):
        return ""
    name = TDataStd_Name()
    label.FindAttribute(TDataStd_Name.GetID_s(), name)
    text = str(name.Get().ToExtString()).strip()
    # SolidWorks' word for no name, and the kernel's for an instance that has none.
    return "" if text == "NONE" or re.fullmatch(r"=>\[[\d:]+\]", text) else text
