"""Read STEP through the kernel's document reader: products, names, colours and layers, and list the unread faces.

The reader's return codes mean little: a file with "NaN" in it hangs the transfer, and one with a bad knot loses faces
without a message. So files that are known to hang are refused before the transfer, files that may hang are left to a copy of
the process (`Loaded.risky`), and the result of each face is checked afterwards.
"""

import io
import os
import re
from collections import defaultdict
from collections.abc import Iterator
from contextlib import suppress
from typing import Any

from OCP.IFSelect import IFSelect_RetDone
from OCP.Interface import Interface_Static
from OCP.StepBasic import StepBasic_NamedUnit, StepBasic_Product
from OCP.STEPCAFControl import STEPCAFControl_Controller, STEPCAFControl_Reader
from OCP.STEPConstruct import STEPConstruct_ExternRefs, STEPConstruct_UnitContext
from OCP.StepData import StepData_Factors
from OCP.StepGeom import StepGeom_CartesianPoint, StepGeom_Direction
from OCP.StepRepr import StepRepr_ItemDefinedTransformation, StepRepr_NextAssemblyUsageOccurrence, StepRepr_RepresentationMap
from OCP.StepShape import StepShape_TopologicalRepresentationItem
from OCP.TCollection import TCollection_ExtendedString, TCollection_HAsciiString
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_FACE
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Face, TopoDS_Shape
from OCP.TopTools import TopTools_IndexedMapOfShape
from OCP.XCAFDoc import XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

from cad_io.arrays import LostFace, SizeNote
from cad_io.errors import ReadError
from cad_io.kernel import explore, faces
from cad_io.kernel.shapes import as_one, unwrapped
from cad_io.part.content import PartContent
from cad_io.read import size_notes
from cad_io.read.document import DroppedNames, add_attributes, each, roots
from cad_io.read.faults import Model, UnreadFaces, is_face, is_whole, name_of, open_border, repair, type_of
from cad_io.read.sniff import reported
from cad_io.read.step_text import adopted, readable
from cad_io.units import UNITS, UnitReading, in_mm
from plan_cutters_base import user_files as files

#: Each a pattern that starts with plain text, which is searched for ten times as fast as alternatives.
_FACES = [re.compile(rb"%s\s*\(" % kind) for kind in (b"ADVANCED_FACE", b"FACE_SURFACE")]
_IDENTS = re.compile(rb"(?:^|;)\s*(#\d+)\s*=", re.MULTILINE)
#: Shells and the faces that they name; statements, by their number, and what they are.
_SHELL = re.compile(rb"\b(?:CLOSED_SHELL|OPEN_SHELL|CONNECTED_FACE_SET)\s*\(\s*'[^']*'\s*,\s*\(([^)]*)\)")
_STATEMENT = re.compile(rb"(?:^|;)\s*(#\d+)\s*=\s*([A-Z_0-9]*)\s*\(", re.MULTILINE)
_FACE_KINDS = (b"ADVANCED_FACE", b"FACE_SURFACE", b"FACE", b"ORIENTED_FACE", b"SUBFACE", b"")  # none: of several kinds at once
#: Numbers so large that the kernel may crash on them, by their exponents.
_HUGE = [re.compile(rb"%s\+?0*[1-9]\d\d" % letter) for letter in (b"E", b"e")]
_BEFORE = tuple(b"%c" % byte for byte in b"0123456789.")
#: What shapes are made of, or placed by.
_SHAPES = (StepShape_TopologicalRepresentationItem, StepRepr_ItemDefinedTransformation, StepRepr_RepresentationMap)
_ASCII = re.compile("[!-~]")
_NO_LENGTH = re.compile("Angle|Mass|Area|Volume|Time|Temperature|Ratio|Derived")
_SUBSHAPES = "read.stepcaf.subshapes.name"
#: Documents beside the shape, which the kernel cannot read and which cost no geometry.
_DOCUMENTS = (".pdf", ".txt", ".doc", ".docx", ".xls", ".xlsx", ".csv", ".htm", ".html", ".jpg", ".jpeg", ".png", ".tif", ".tiff",
              ".svg")  # fmt: skip
#: Entities named in one warning.
_MOST_NAMED = 3


class NothingError(ReadError):
    """No face came out."""


class Loaded:
    """A STEP file whose entities are loaded, but not yet made into shapes.

    data: the content of the file, to count faces in. unit: length unit to take instead of the file's, one of `units.UNITS`.
    names: ask the kernel for names, colours and layers, on which it crashes in some faulty files. careful: leave out every face
    that uses something faulty. `risky`: the transfer may crash or hang, to be run in a copy of the process.

    Raises ReadError where it is cut off, not STEP, known to hang the transfer, or refers to other files.
    """

    def __init__(self, file: str, data: bytes, unit: str | None = None, *, names: bool = True, careful: bool = False) -> None:
        self.file, self.unit, self.names, self.careful, self._written = file, unit, names, careful, data
        self.data, self.encoding = readable(data)
        self._adopted = adopted(self.data)
        if self._adopted:
            self.data = self._adopted.data
        STEPCAFControl_Controller.Init_s()
        self.reader = STEPCAFControl_Reader()
        self.reader.SetColorMode(names)
        self.reader.SetNameMode(names)
        self.reader.SetLayerMode(names)
        # The setting is global: it is put back for the host's own imports.
        before = Interface_Static.IVal_s(_SUBSHAPES)
        Interface_Static.SetIVal_s(_SUBSHAPES, int(names))
        try:
            same = self.data is data
            status = self.reader.ReadFile(file) if same else self.reader.ReadStream(file, io.BytesIO(self.data))
        finally:
            Interface_Static.SetIVal_s(_SUBSHAPES, before)
        if status != IFSelect_RetDone:
            cut = b"END-ISO-10303-21" not in data[-4096:]
            raise ReadError(
                "is cut off (its end is missing): fetch or export it again"
                if cut
                else "is not valid STEP (syntax): export it again",
                file=file,
            )
        self.model = Model(self.reader.ChangeReader().WS())
        self.faults = self.model.faults()
        if any(fault.text.startswith("DATA NOT AVAILABLE") for fault in self.faults):
            raise ReadError("is not valid STEP (syntax): export it again", file=file)
        huge = (data[at.start() - 1 : at.start()] for pattern in _HUGE for at in pattern.finditer(data))
        self.risky = bool(self.faults) or any(before in _BEFORE for before in huge)
        self._refuse()
        self._refuse_references()

    def transfer(self, *, traced: bool = False) -> PartContent:
        """Make the shape; `traced`: find out which face was which entity, too; a file with faults is traced in any case.

        Raises ReadError where it holds no face that can be read.
        """
        traced = traced or bool(self.faults)
        # What is read in another unit than its own has no sizes that are known.
        sizes = size_notes.stated(self.data) if self.unit is None else []
        real = self._mark() if traced or sizes else {}
        repaired = repair(self.model, self.faults if self.careful else ()) if traced else {}
        try:
            result = self._shape()
        except NothingError:
            if self.careful or not self.faults:
                raise
            # One bad vertex can cost a whole solid: without the faces at it, the others may come.
            return self._again(names=self.names, careful=True).transfer()
        made, written = _distinct_faces(result.shape), sum(len(kind.findall(self.data)) for kind in _FACES)
        if not traced:
            # All is well, or else the file is read again with marks: only then can be told what is lost.
            if made >= written and not self.model.trouble(fails=True) and not self._doubtful(result.shape):
                if sizes:
                    result.sizes = self._numbered(sizes, self._unmark(result, faces(result.shape), real))
                return result
            return self._again().transfer(traced=True)
        shapes = faces(result.shape)
        numbers = self._unmark(result, shapes, real)
        result.sizes = self._numbered(sizes, numbers)
        scale = in_mm(self.unit) if self.unit is not None else _length_unit(self.reader)
        unread = UnreadFaces(self.model, self._idents(), self.faults, repaired, shapes, numbers, scale)
        result.lost = unread.found()
        # Faces that the kernel did not even load as such: shells list them, and they are missing in the text, or of a type
        # unknown to it.
        kinds = dict(_STATEMENT.findall(self.data))
        named = dict.fromkeys(ident.strip() for shell in _SHELL.findall(self.data) for ident in shell.split(b","))
        none = [ident.decode(errors="replace") for ident in named if kinds.get(ident, b"?") not in _FACE_KINDS]
        nameless = none[sum(each.face is None for each in result.lost) :]
        result.lost += [LostFace(ident, "", "a shell names it, and no face can be read there") for ident in nameless]
        gone = len({each.entity for each in result.lost if each.face is None})
        result.lost += [LostFace("", "", "it is written, but could not be read")] * max(0, written - made - gone)
        result.warnings += self._warnings(unread)
        return result

    def _again(self, **how: bool) -> "Loaded":
        return Loaded(self.file, self._written, self.unit, **how)

    def _refuse(self) -> None:
        """Points and directions that are no numbers, used by a shape: the transfer would take for ever, or a guess."""
        for fault in self.faults:
            entity = self.model.entities.get(fault.number)
            if isinstance(entity, StepGeom_CartesianPoint | StepGeom_Direction) and fault.parameter != "name":
                users = (self.model.entities[n] for n in self.model.users(fault.number) if n)
                if any(isinstance(user, _SHAPES) for user in users):
                    ident = self._idents().get(fault.number, "")
                    raise ReadError(
                        f"is faulty STEP: {ident} {type_of(entity)} is no numbers ({fault.short}), which the CAD kernel "
                        "cannot read to an end; export it again",
                        file=self.file,
                    )
            length = isinstance(entity, StepBasic_NamedUnit) and not _NO_LENGTH.search(type(entity).__name__)
            if self.unit is None and length and fault.parameter != "dimensions":
                raise ReadError(
                    f"has a faulty length unit ({fault.short}): give the right one with --unit (unit= in Python)", file=self.file
                )

    def _refuse_references(self) -> None:
        """Files that the kernel would open beside this one: it leaves out in silence what it cannot read of them."""
        references = STEPConstruct_ExternRefs(self.reader.ChangeReader().WS())
        references.LoadExternRefs()
        for number in range(1, references.NbExternRefs() + 1):
            name = (references.FileName(number) or "").replace("\\", "/")
            if name.lower().endswith(_DOCUMENTS):
                with reported(self.file):
                    files.permitted(os.path.join(os.path.dirname(self.file), name))
            elif name.strip():
                raise ReadError(f"refers to {name}, and other files are not followed: save it as one file", file=self.file)

    def _shape(self) -> PartContent:
        nothing = "holds no shape that can be read"
        if self.faults:
            nothing += f" ({self.faults[0].short}{_more(len(self.faults) - 1)})"
        document = TDocStd_Document(TCollection_ExtendedString("XmlXCAF"))
        if self.unit is not None:
            # The kernel divides by the document's unit, in metres: chosen so that numbers come out as if in the unit
            # wanted.
            XCAFDoc_DocumentTool.SetLengthUnit_s(document, 1e-3 * _length_unit(self.reader) / in_mm(self.unit))
        done = self.reader.Transfer(document)
        shapes = [XCAFDoc_ShapeTool.GetShape_s(label) for label in each(roots(document))] if done else []
        if not any(any(explore(shape, TopAbs_FACE)) for shape in shapes):
            raise NothingError(f"{nothing}: export it as a solid or surface model", file=self.file)
        result = PartContent(unwrapped(as_one(shapes)), encoding=self.encoding, unit_readings=tuple(self._unit_readings()))
        add_attributes(document, result, self._dropped_names())
        if self._adopted:
            solids = self._adopted.solids
            result.warnings.append(
                f"no product leads to {', '.join(solids[:_MOST_NAMED])}{_more(len(solids) - _MOST_NAMED)}: an incomplete STEP, "
                "whose solids were read all the same, without names and places of an assembly"
            )
        return result

    def _unit_readings(self) -> Iterator[UnitReading]:
        """What is doubtful of what the file says about its unit."""
        if self.unit is not None:
            return
        stated = self._adopted.unit if self._adopted else ""
        if not stated and not all(word in self.data for word in (b"LENGTH_UNIT", b"GLOBAL_UNIT_ASSIGNED_CONTEXT")):
            stated = "no unit is stated"
        if stated:
            factor = _length_unit(self.reader)
            yield UnitReading("not_sure", stated, next((name for name, mm in UNITS.items() if mm == factor), f"{factor:g} mm"))

    def _dropped_names(self) -> DroppedNames:
        """Names without a letter of ASCII, of which the kernel shows the identifier."""
        products: dict[str, set[str]] = defaultdict(set)
        instances: dict[tuple[str, str], set[str]] = defaultdict(set)
        plain = self.data.isascii() and b"\\X" not in self.data
        for entity in () if plain else self.model.entities.values():
            with suppress(AttributeError, UnicodeDecodeError):  # of a damaged file
                if isinstance(entity, StepBasic_Product):
                    products[_shown(entity)].add(name_of(entity))
                elif isinstance(entity, StepRepr_NextAssemblyUsageOccurrence):
                    product = entity.RelatedProductDefinition().Formation().OfProduct()
                    instances[_shown(entity), _shown(product)].add(name_of(entity))
        return DroppedNames(_only(products), _only(instances))

    def _doubtful(self, shape: TopoDS_Shape) -> bool:
        """Whether the transfer doubted how faces fit together, or the border of a face, and one is open."""
        doubted = [self.model.value(doubt.number) for doubt in self.model.trouble(fails=False) if doubt.number]
        if any(map(is_whole, doubted)):
            return True
        border = any(isinstance(entity, StepShape_TopologicalRepresentationItem) for entity in doubted)
        return border and any(open_border(face) for face in faces(shape))

    def _mark(self) -> dict[int, str]:
        """Give each face entity its number for a name, which the kernel hands on; the real names."""
        real = {}
        for number, entity in self.model.entities.items():
            if is_face(entity):
                real[number] = name_of(entity)
                entity.SetName(TCollection_HAsciiString(f"@{number}"))
        return real

    def _unmark(self, result: PartContent, shapes: list[TopoDS_Face], real: dict[int, str]) -> dict[int, list[int]]:
        """Put the names back; the numbers that each face entity has got in the part."""
        numbers: dict[int, list[int]] = defaultdict(list)
        for n, mark in list(result.names.items()):
            if mark.startswith("@") and mark[1:].isdigit():
                numbers[int(mark[1:])].append(n)
                del result.names[n]
        named = {n for ns in numbers.values() for n in ns}
        unnamed = {n: face for n, face in enumerate(shapes, 1) if n not in named}
        for n, number in (self.model.makers(unnamed) or {}).items():
            if is_face(self.model.entities[number]):
                numbers[number].append(n)
        for number, name in real.items():
            self.model.entities[number].SetName(TCollection_HAsciiString(name))
            if name and name != "NONE":
                result.names.update(dict.fromkeys(numbers.get(number, ()), name))
        return dict(numbers)

    def _numbered(self, sizes: Any, numbers: dict[int, list[int]]) -> tuple[SizeNote, ...]:
        """Sizes that are stated, with the numbers of their faces in the part."""
        idents = self._idents() if sizes else {}
        return size_notes.numbered(sizes, {idents[n]: each for n, each in numbers.items() if n in idents})

    def _idents(self) -> dict[int, str]:
        """Return the names (`#12`) of the entities in the file, by number. The kernel knows them, but does not give them."""
        idents = {i: ident.decode() for i, ident in enumerate(_IDENTS.findall(self.data), 1)}
        return idents if len(idents) == len(self.model.entities) else {}

    def _warnings(self, lost: UnreadFaces) -> Iterator[str]:
        felt = {fault for each in lost.felt.values() for fault in each}
        groups: dict[str, dict[str, list[str]]] = defaultdict(lambda: defaultdict(list))
        for fault in self.faults:
            where = "in its text" if not fault.number else "in geometry" if fault in felt else "that touch no face"
            groups[where][fault.short].append(lost.ident(fault.number))
        for where, texts in sorted(groups.items()):
            lines = [f"{text}{_at(idents)}" for text, idents in texts.items()]
            yield (
                f"the file has faults {where} ({sum(map(len, texts.values()))}): "
                f"{'; '.join(lines[:_MOST_NAMED])}{_more(len(lines) - _MOST_NAMED)}"
            )


def _shown(entity: Any) -> str:
    """The name of a product or of an instance as the kernel shows it."""
    name = name_of(entity)
    return name if _ASCII.search(name) else str(entity.Id().ToCString()).strip()


def _only(names: dict[Any, set[str]]) -> dict[Any, str]:
    """Names that are the only one for what is shown: none is better than a wrong one."""
    return {shown: name for shown, each in names.items() if len(each) == 1 and (name := min(each)) and not _ASCII.search(name)}


def _at(idents: list[str]) -> str:
    known = list(filter(None, idents))
    return f" ({known[0]}{_more(len(known) - 1)})" if known else ""


def _more(count: int) -> str:
    return f" and {count} more" if count > 0 else ""


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


def _distinct_faces(shape: TopoDS_Shape) -> int:
    """Faces counted once however often the assembly shows them."""
    placed_once = TopTools_IndexedMapOfShape()
    for face in explore(shape, TopAbs_FACE):
        placed_once.Add(face.Located(TopLoc_Location()))
    return placed_once.Extent()
