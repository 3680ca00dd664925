"""Read STEP through the kernel's document reader: products, names, colours and layers, guarded against half a part.

The reader's return codes mean little: a file with "NaN" in it hangs the transfer, and one with a bad knot loses faces
without a word. So the model is checked before the transfer, and faces are counted after it.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from OCP.IFSelect import IFSelect_RetDone
from OCP.Interface import Interface_Static
from OCP.Quantity import Quantity_Color, Quantity_TOC_sRGB
from OCP.STEPCAFControl import STEPCAFControl_Controller, STEPCAFControl_Reader
from OCP.STEPConstruct import STEPConstruct_UnitContext
from OCP.StepData import StepData_Factors
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_Label, TDF_LabelSequence
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_FACE
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Shape
from OCP.TopTools import TopTools_IndexedMapOfShape
from OCP.XCAFDoc import XCAFDoc_ColorGen, XCAFDoc_ColorSurf, XCAFDoc_ColorTool, XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

from cad_io.assembly import Node
from cad_io.errors import ReadError
from cad_io.kernel import explore, shape_map
from cad_io.part import as_one, unwrapped
from cad_io.units import in_mm

Colour = tuple[float, float, float]

#: Faults of the model that do not touch geometry: a missing name, for one.
_HARMLESS = re.compile(r"not a quoted String|\(name\)|\(description\)")
#: Each a pattern that starts with plain text, which is searched for ten times as fast as alternatives.
_FACES = [re.compile(rb"%s\s*\(" % kind) for kind in (b"ADVANCED_FACE", b"FACE_SURFACE")]


@dataclass
class Read:
    """What a reader found: one shape, its products, and by face number names, sRGB colours and layers."""

    shape: TopoDS_Shape
    names: dict[int, str] = field(default_factory=dict)
    colours: dict[int, Colour] = field(default_factory=dict)
    layers: dict[int, tuple[str, ...]] = field(default_factory=dict)
    tree: tuple[Node, ...] = ()
    warnings: list[str] = field(default_factory=list)


def read(file: str, data: bytes, unit: str | None = None) -> Read:
    """Read a STEP file.

    Parameters
    ----------
    file : str
    data : bytes
        Its content, to count faces in.
    unit : str, optional
        Length unit to take instead of the file's, one of `units.UNITS`.

    Raises
    ------
    ReadError
        Cut off, faulty, or without a shape.
    """
    STEPCAFControl_Controller.Init_s()
    Interface_Static.SetIVal_s("read.stepcaf.subshapes.name", 1)
    reader = STEPCAFControl_Reader()
    reader.SetColorMode(True)
    reader.SetNameMode(True)
    reader.SetLayerMode(True)
    if reader.ReadFile(file) != IFSelect_RetDone:
        cut = b"END-ISO-10303-21" not in data[-4096:]
        raise ReadError(
            "is cut off (its end is missing): fetch or export it again"
            if cut
            else "is not valid STEP (syntax): export it again",
            file=file,
        )
    faults = [fault for fault in faults_of(reader.ChangeReader()) if not _HARMLESS.search(fault)]
    if any(fault.startswith("DATA NOT AVAILABLE") for fault in faults):
        raise ReadError("is not valid STEP (syntax): export it again", file=file)
    if faults:
        more = f" and {len(faults) - 1} more" if len(faults) > 1 else ""
        raise ReadError(f"is faulty STEP ({faults[0]}{more}): export it again", file=file)
    document = TDocStd_Document(TCollection_ExtendedString("XmlXCAF"))
    if unit is not None:
        # The kernel divides by the document's unit, in metres: chosen so that numbers come out as if in the unit wanted.
        XCAFDoc_DocumentTool.SetLengthUnit_s(document, 1e-3 * _length_unit(reader) / in_mm(unit))
    if not reader.Transfer(document):
        raise ReadError("holds no shape that can be read: export it as a solid or surface model", file=file)
    labels = _roots(document)
    roots = [XCAFDoc_ShapeTool.GetShape_s(label) for label in _each(labels)]
    if not roots:
        raise ReadError("holds no shape that can be read: export it as a solid or surface model", file=file)
    result = Read(unwrapped(as_one(roots)))
    add_attributes(document, result)
    written, found = sum(len(kind.findall(data)) for kind in _FACES), _distinct_faces(result.shape)
    if found < written:
        result.warnings.append(lost_faces(found, written))
    return result


def add_attributes(document: TDocStd_Document, result: Read) -> None:
    """Fill in the tree of products, names, colours and layers that a document has for the faces of its shape."""
    _Walk(result).roots(_roots(document))


def _roots(document: TDocStd_Document) -> TDF_LabelSequence:
    labels = TDF_LabelSequence()
    XCAFDoc_DocumentTool.ShapeTool_s(document.Main()).GetFreeShapes(labels)
    return labels


def _length_unit(reader: STEPCAFControl_Reader) -> float:
    """Length unit of a loaded file's first geometry, mm."""
    model = reader.ChangeReader().StepModel()
    for i in range(1, model.NbEntities() + 1):
        context = getattr(model.Value(i), "GlobalUnitAssignedContext", None)
        if context is not None:
            units = STEPConstruct_UnitContext()
            units.ComputeFactors(context(), StepData_Factors())
            if units.LengthDone():
                return float(units.LengthFactor())
    return 1.0


def lost_faces(found: int, written: int) -> str:
    """The warning for a file whose faces could not all be read."""
    return f"{written - found} of the {written} faces written in the file could not be read: the part has holes"


def faults_of(reader: Any) -> list[str]:
    """What the kernel's check of a loaded (not yet transferred) model finds wrong."""
    checks = reader.WS().ModelCheckList(True)
    found = []
    checks.Start()
    while checks.More():
        check = checks.Value()
        found += [" ".join(check.CFail(i + 1).split()) for i in range(check.NbFails())]
        checks.Next()
    return found


def _distinct_faces(shape: TopoDS_Shape) -> int:
    """Faces counted once however often the assembly shows them."""
    placed_once = TopTools_IndexedMapOfShape()
    for face in explore(shape, TopAbs_FACE):
        placed_once.Add(face.Located(TopLoc_Location()))
    return placed_once.Extent()


def _each(labels: TDF_LabelSequence) -> Iterator[TDF_Label]:
    for i in range(1, labels.Length() + 1):
        yield labels.Value(i)


class _Walk:
    """Products, names, colours and layers of faces, gathered from the document: the innermost label that has one wins."""

    def __init__(self, result: Read) -> None:
        self.result, self.map = result, shape_map(result.shape, TopAbs_FACE)
        self.taken: set[int] = set()

    def roots(self, labels: TDF_LabelSequence) -> None:
        start = _Inherited(TopLoc_Location())
        self.result.tree = tuple(self.node(label, start) for label in _each(labels))

    def node(self, label: TDF_Label, given: "_Inherited") -> Node:
        instance, place = "", TopLoc_Location()
        if XCAFDoc_ShapeTool.IsReference_s(label):
            instance, place = _name(label), XCAFDoc_ShapeTool.GetLocation_s(label)
            given = given.at(label, place)
            product = TDF_Label()
            XCAFDoc_ShapeTool.GetReferredShape_s(label, product)
            label = product
        given = given.at(label)
        if XCAFDoc_ShapeTool.IsAssembly_s(label):
            inner = TDF_LabelSequence()
            XCAFDoc_ShapeTool.GetComponents_s(label, inner, False)
            return Node(_name(label), instance, place, children=tuple(self.node(each, given) for each in _each(inner)))
        mine = [n for n in self.leaf(label, given) if n not in self.taken]
        self.taken.update(mine)
        return Node(_name(label), instance, place, faces=tuple(mine))

    def leaf(self, label: TDF_Label, given: "_Inherited") -> list[int]:
        """Paint the faces of a product; their numbers."""
        shape, inner = XCAFDoc_ShapeTool.GetShape_s(label), TDF_LabelSequence()
        numbers = self.numbers(shape, given.place)
        self.paint(numbers, given.colour, given.layers)
        XCAFDoc_ShapeTool.GetSubShapes_s(label, inner)
        parts = [(sub, XCAFDoc_ShapeTool.GetShape_s(sub)) for sub in _each(inner)]
        parts = [(sub, part) for sub, part in parts if part.ShapeType().value <= TopAbs_FACE.value]
        # Solids before shells before faces, so that the innermost has the last word.
        for sub, part in sorted(parts, key=lambda pair: int(pair[1].ShapeType().value)):
            covered = self.numbers(part, given.place)
            self.paint(covered, _colour(sub), _layers(sub))
            if part.ShapeType() == TopAbs_FACE and (name := _name(sub)):
                self.result.names.update(dict.fromkeys(covered, name))
        return numbers

    def paint(self, numbers: list[int], colour: Colour | None, layers: tuple[str, ...]) -> None:
        if colour:
            self.result.colours.update(dict.fromkeys(numbers, colour))
        if layers:
            self.result.layers.update(dict.fromkeys(numbers, layers))

    def numbers(self, shape: TopoDS_Shape, place: TopLoc_Location) -> list[int]:
        moved = shape.Moved(place)
        return list(dict.fromkeys(n for face in explore(moved, TopAbs_FACE) if (n := self.map.FindIndex(face))))


class _Inherited(NamedTuple):
    """What the labels around give: an enclosing instance's colour beats the product's own."""

    place: TopLoc_Location
    colour: Colour | None = None
    layers: tuple[str, ...] = ()

    def at(self, label: TDF_Label, place: TopLoc_Location | None = None) -> "_Inherited":
        return _Inherited(
            self.place.Multiplied(place) if place else self.place,
            self.colour or _colour(label),
            self.layers or _layers(label),
        )


def _colour(label: TDF_Label) -> Colour | None:
    found = Quantity_Color()
    for kind in (XCAFDoc_ColorSurf, XCAFDoc_ColorGen):
        if XCAFDoc_ColorTool.GetColor_s(label, kind, found):
            red, green, blue = found.Values(Quantity_TOC_sRGB)
            return round(red, 6), round(green, 6), round(blue, 6)
    return None


def _layers(label: TDF_Label) -> tuple[str, ...]:
    found = TDF_LabelSequence()  # asked for strings, the kernel gives none (OCCT 7.9)
    XCAFDoc_DocumentTool.LayerTool_s(label).GetLayers(label, found)
    return tuple(sorted(filter(None, map(_name, _each(found)))))


def _name(label: TDF_Label) -> str:
    # Asking for a name that is not there ends the process, so look first.
    if not label.IsAttribute(TDataStd_Name.GetID_s()):
        return ""
    name = TDataStd_Name()
    label.FindAttribute(TDataStd_Name.GetID_s(), name)
    text = str(name.Get().ToExtString()).strip()
    return "" if text == "NONE" else text  # SolidWorks' word for no name
