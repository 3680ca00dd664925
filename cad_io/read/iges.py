"""Read IGES, with guards: the kernel reads a file that was cut off as a success.

The unit of lengths is stated twice in the global section, and a scale besides. Names of faces: the kernel's document reader names
only what has a colour or a level, and its own way back from a face to its entity takes a walk through all entities for each, so
entities and shapes are walked down together from the roots. Faces that are not in the part, or not as written, are listed.
"""

import re
from collections import defaultdict
from collections.abc import Callable, Collection, Sequence
from typing import Any, NamedTuple

from OCP.IFSelect import IFSelect_RetDone
from OCP.IGESCAFControl import IGESCAFControl_Reader
from OCP.TCollection import TCollection_ExtendedString, TCollection_HAsciiString
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_FACE
from OCP.TopoDS import TopoDS_Face
from OCP.XCAFDoc import XCAFDoc_DocumentTool

from cad_io.arrays import LostFace
from cad_io.errors import ReadError
from cad_io.kernel import faces, shape_map
from cad_io.kernel.shapes import children, unwrapped
from cad_io.part.content import PartContent
from cad_io.read.document import DroppedNames, add_attributes
from cad_io.read.faults import Fault, Model, edge_count, misfit, open_border
from cad_io.read.step_text import CALLED, decoded, encoding_of
from cad_io.units import UNITS, UnitReading

#: Units by the standard's numbers, and the lengths of all of them, mm; in capitals they have the standard's names.
FLAGS = {1: "in", 2: "mm", 4: "ft", 5: "mi", 6: "m", 7: "km", 8: "mil", 9: "um", 10: "cm", 11: "uin"}
_LENGTHS = UNITS | {"mi": 1609344.0, "uin": 2.54e-5}
#: Other names for them that programs write.
_NAMES = {
    "INCH": "in", "INCHES": "in", "MILLIMETER": "mm", "MILLIMETERS": "mm", "MILLIMETRE": "mm", "MILLIMETRES": "mm", "MMS": "mm",
    "FOOT": "ft", "FEET": "ft", "METER": "m", "METERS": "m", "METRE": "m", "METRES": "m", "CENTIMETER": "cm",
    "CENTIMETERS": "cm", "CENTIMETRE": "cm", "CENTIMETRES": "cm", "MICRON": "um", "MICRONS": "um", "MILS": "mil",
}  # fmt: skip
#: Parameters of the global section, counted from 0; the flag that leaves the unit to its name.
_SCALE, _FLAG, _NAME, _BY_NAME = 12, 13, 14, 3
#: Letters of a name that are shown.
_LONGEST = 16
_HOLLERITH = re.compile(rb"\s*(\d+)H")


class IgesUnit(NamedTuple):
    """The unit of a file's numbers, what real length is to model length, and what is doubtful about both."""

    unit: str
    scale: float
    readings: tuple[UnitReading, ...]


def unit_of(lines: Sequence[bytes]) -> IgesUnit:
    """The unit that the lines of a global section state.

    A known flag decides, as the standard says; the name decides where the flag says so, or where it is none of the standard's.
    Where neither is known, mm are taken, but inches, the standard's default, where both are left out. The scale is the ratio
    of model space to real space: lengths are divided by it.

    Examples
    --------
    >>> unit_of([b",,,,,,,,,,,,1.,2,2HMM;"])
    IgesUnit(unit='mm', scale=1.0, readings=())
    >>> unit_of([b",,,,,,,,,,,,1.,1,2HMM;"]).readings[0]
    UnitReading(cause='disagree', stated='flag 1, name "MM"', taken='in', unit='mm', times=0.03937007874015748)
    >>> unit_of([b""]).readings[0].stated, unit_of([b",,,,,,,,,,,,.5,3,2HCM;"]).scale
    ('no flag, no name', 0.5)
    """
    parameters = [*_parameters(b"".join(line[:72].ljust(72) for line in lines)), *[b""] * (_NAME + 1)]
    flag_text, name = (parameters[i].decode("ascii", "replace").strip() for i in (_FLAG, _NAME))
    flag = int(flag_text) if re.fullmatch(r"[+-]?\d{1,9}", flag_text) else None
    by_flag, by_name = FLAGS.get(flag or 0), _named(name)
    stated = ", ".join(
        (f"flag {flag_text[:_LONGEST]}" if flag_text else "no flag", f'name "{name[:_LONGEST]}"' if name else "no name")
    )
    taken = by_flag or by_name or ("mm" if flag_text or name else "in")
    readings = []
    if by_flag and by_name and by_flag != by_name:
        choice = by_name if by_name in UNITS else ""
        readings.append(UnitReading("disagree", stated, taken, choice, _LENGTHS[by_name] / _LENGTHS[by_flag]))
    elif (by_flag and name and not by_name) or (not by_flag and (flag != _BY_NAME or not by_name)):
        readings.append(UnitReading("not_sure", stated, taken))
    scale, doubt = _scale(parameters[_SCALE].decode("ascii", "replace").strip(), taken)
    return IgesUnit(taken, scale, (*readings, *doubt))


def _named(name: str) -> str | None:
    plain = name.upper().rstrip(".")
    return next((unit for unit in _LENGTHS if unit.upper() == plain), _NAMES.get(plain))


def _scale(text: str, taken: str) -> tuple[float, tuple[UnitReading, ...]]:
    number = text.upper().replace("D", "E")
    scale = float(number) if re.fullmatch(r"[+-]?(\d+\.?\d*|\.\d+)(E[+-]?\d{1,2})?", number) else (0.0 if text else 1.0)
    if scale == 1.0:
        return 1.0, ()
    if scale <= 0.0:
        return 1.0, (UnitReading("not_sure", f"model space scale {text[:_LONGEST]}", taken),)
    return scale, (UnitReading("scale", f"{scale:.6g}", taken, taken if taken in UNITS else "", scale),)


def _parameters(text: bytes) -> list[bytes]:
    """Parameters of a section in free format; strings in them are counted, and may hold the delimiters."""
    delimiters, values, at = [b",", b";"], list[bytes](), 0
    while at < len(text):
        value, after = b"", at
        if match := _HOLLERITH.match(text, at):
            after = match.end() + int(match[1][:9])
            value = text[match.end() : after]
        if len(values) < len(delimiters) and len(value) == 1:
            delimiters[len(values)] = value
        ends = [end for each in delimiters if (end := text.find(each, after)) >= 0]
        end = min(ends, default=len(text))
        values.append(value if match else text[at:end])
        if text[end : end + 1] == delimiters[1]:
            break
        at = end + 1
    return values


#: Entity numbers of what holds others: group, solid, shell.
_GROUP, _SOLID, _SHELL = 402, 186, 514
#: Those that become one face: face, trimmed and bounded surface, and bare surfaces.
_FACES = (510, 144, 143, 140, 128, 122, 120, 118, 114, 108, 190, 192, 194, 196, 198)
_PROPERTY, _NAME_FORM = 406, 15


def any_names(directory: Sequence[bytes]) -> bool:
    """Whether the lines of a directory section, two an entity, name a face."""
    for first, second in zip(directory[::2], directory[1::2], strict=False):
        kind = _number(first[:8])
        if kind in _FACES and second[56:64].strip():
            return True
        if kind == _PROPERTY and _number(second[32:40]) == _NAME_FORM:
            return True
    return False


def add_names(reader: Any, result: PartContent, model: Model, directory: Sequence[bytes]) -> None:
    """Fill in the names of faces that a reader has transferred; `directory`: lines of that section."""
    if reader.NbShapes() != reader.NbRootsForTransfer():
        return  # some were lost: no one knows which shape is which root's
    numbers = shape_map(result.shape, TopAbs_FACE)
    names: dict[int, bytes] = {}

    def visit(entity: Any, shape: Any) -> None:
        # The kernel drops labels without a letter of ASCII.
        label = directory[2 * k - 1][56:64].strip() if 0 < 2 * (k := model.number(entity)) <= len(directory) else b""
        if (number := numbers.FindIndex(shape)) and (name := _bytes_of(entity) or label):
            names[number] = name

    for i in range(1, reader.NbRootsForTransfer() + 1):
        _walk(reader.RootForTransfer(i), reader.Shape(i), visit)
    encoding = encoding_of(list(names.values()))
    result.names.update({number: decoded(name, encoding) for number, name in names.items()})
    result.encoding = CALLED.get(encoding, "")


def _walk(entity: Any, shape: Any, visit: Callable[[Any, Any], None]) -> None:
    if entity is None:
        return
    inner = _inside(entity)
    if not inner:
        if (face := unwrapped(shape)).ShapeType() == TopAbs_FACE:
            visit(entity, face)
        return
    parts = children(shape)
    # No name is better than a wrong one.
    if len(inner) == len(parts):
        for sub, part in zip(inner, parts, strict=True):
            _walk(sub, part, visit)


def _inside(entity: Any) -> list[Any]:
    kind = entity.TypeNumber()
    if kind == _GROUP and hasattr(entity, "NbEntities"):
        return [entity.Value(i + 1) for i in range(entity.NbEntities())]
    if kind == _SOLID and hasattr(entity, "Shell"):
        return [entity.Shell(), *(entity.VoidShell(i + 1) for i in range(entity.NbVoidShells()))]
    if kind == _SHELL and hasattr(entity, "NbFaces"):
        return [entity.Face(i + 1) for i in range(entity.NbFaces())]
    return []


def name_of(entity: Any) -> str:
    """The name of one entity, in the encoding that it is most likely in."""
    return decoded(name, encoding_of([name])) if (name := _bytes_of(entity)) else ""


def _bytes_of(entity: Any) -> bytes:
    """The long name where there is one, else the label of eight letters. IGES is ASCII, but not all programs know it."""
    for has, get in ((entity.HasName, entity.NameValue), (entity.HasShortLabel, entity.ShortLabel)):
        # A damaged file may say that there is a name and have none.
        if has() and (text := get()) is not None:
            letters = TCollection_ExtendedString(text.String(), False).ToExtString()
            if name := str(letters).encode("latin-1").strip():
                return name
    return b""


def _number(field: bytes) -> int:
    try:
        return int(field)
    except ValueError:
        return 0


#: Entity numbers that must each become a face: bounded surface, trimmed surface, face.
FACES = (143, 144, 510)
#: What borders are made of: a face whose border fails comes without it.
_BORDERS = (102, 141, 142, 508)
_FACE, _LOOP, _WHOLES = 510, 508, (186, 514)


def _face_numbers(model: Model, results: Collection[int], shapes: Sequence[TopoDS_Face]) -> dict[int, int]:
    """Face numbers of the entities that faces were made of, as far as that is known."""
    made = model.makers(dict(enumerate(shapes, 1)))
    if made is None:
        return {}
    numbers = {entity: n for n, entity in made.items() if _is_face(model.entities[entity])}
    # A face that failed may stand there as its bare surface.
    unknown = [n for n in range(1, len(shapes) + 1) if n not in numbers.values()]
    missed = [n for n, entity in model.entities.items() if _is_face(entity) and n in results and n not in numbers]
    return numbers | dict(zip(missed, unknown, strict=True)) if len(unknown) == len(missed) else numbers


def unread_of_iges(model: Model, faults: Sequence[Fault], shapes: Sequence[TopoDS_Face], *, split: bool) -> list[LostFace]:
    """Faces without a shape, and those that had trouble and cannot show that they are whole.

    The model is transferred, and `faults` were found in it before; `shapes` are faces of the part. split: count the edges of
    every face, since solids fell apart.
    """
    results = model.results()
    # Faults that faces felt, by the number of the entity; where solids fell apart those that felt none, too.
    felt: dict[int, list[Fault]] = {n: [] for n, entity in model.entities.items() if entity.TypeNumber() == _FACE and split}
    for fault in (*faults, *model.trouble(fails=True)):
        for n in model.users(fault.number, _is_face):
            if n and _is_face(model.entities[n]):
                felt.setdefault(n, []).append(fault)
    gone = [n for n, entity in model.entities.items() if _is_face(entity) and n not in results]
    unread = [_unread(model, n, "the CAD kernel could not make it", felt.get(n, [])) for n in gone]
    numbers = _face_numbers(model, results, shapes) if felt else {}
    for entity, fault_list in felt.items():
        if entity in numbers and (why := _altered(model, entity, fault_list, shapes[numbers[entity] - 1])):
            unread.append(_unread(model, entity, why, fault_list, numbers[entity]))
        elif fault_list and entity not in numbers and entity in results:
            unread.append(_unread(model, entity, "it may not be as written", fault_list))
    return unread


def _altered(model: Model, number: int, felt: Sequence[Fault], shape: TopoDS_Face) -> str:
    if not (count := edge_count(shape)):
        return "it came without its edges"
    if count < _edges(model, number):
        return "an edge of it is missing"
    if not felt:
        return ""
    if any(model.entities[fault.number].TypeNumber() in _BORDERS for fault in felt if fault.number):
        return "a bound of it (a hole or the border) may be missing"
    return "its border is open" if open_border(shape) else misfit(shape)


def _edges(model: Model, number: int) -> int:
    """Edges that the loops of a face name; 0 for faces of other kinds."""
    face, edges = model.entities[number], set()
    for i in range(face.NbLoops() if face.TypeNumber() == _FACE else 0):
        loop = face.Loop(i + 1)
        if loop is not None and loop.TypeNumber() == _LOOP:
            edges |= {
                (model.number(loop.Edge(k)), loop.ListIndex(k)) for k in range(1, loop.NbEdges() + 1) if loop.EdgeType(k) == 0
            }
    return len(edges)


def _unread(model: Model, number: int, why: str, felt: Sequence[Fault], face: int | None = None) -> LostFace:
    text = f"{why} ({_ident(felt[0].number)}: {felt[0].short})" if felt else why
    return LostFace(_ident(number), name_of(model.entities[number]), text, face)


def _ident(number: int) -> str:
    """An entity by the line of the directory section at which it starts: two lines each."""
    return f"D{2 * number - 1}" if number else "the file"


def _is_face(entity: Any) -> bool:
    return entity.TypeNumber() in FACES


#: Faults in the statement of the unit, which is read here.
_OF_UNIT = re.compile(r"Global Section \(Parameter 1[345]\b")
_COUNTS = re.compile(rb"S\s*(\d+)G\s*(\d+)D\s*(\d+)P\s*(\d+)")


class Loaded:
    """An IGES file whose entities are loaded, but not yet made into shapes.

    What it takes, has and raises is as of `step.Loaded`; there is nothing for `careful` to leave out.
    """

    def __init__(self, file: str, data: bytes, unit: str | None = None, *, names: bool = True, careful: bool = False) -> None:
        self.file, self.names = file, names
        self.sections: dict[bytes, list[bytes]] = defaultdict(list)
        for line in data.splitlines():
            self.sections[line[72:73]].append(line)
        self._refuse()
        self.reader = IGESCAFControl_Reader()
        self.reader.SetColorMode(names)
        self.reader.SetLayerMode(names)
        self.reader.SetNameMode(False)
        if self.reader.ReadFile(file) != IFSelect_RetDone:
            raise ReadError("is not valid IGES: export it again", file=file)
        # Numbers as they stand are in the unit that a person gives.
        self.unit = unit_of(self.sections[b"G"]) if unit is None else IgesUnit(unit, 1.0, ())
        model = self.reader.WS().Model()
        section = model.GlobalSection()
        section.SetUnitFlag(next(flag for flag, name in FLAGS.items() if name == self.unit.unit))
        section.SetUnitName(TCollection_HAsciiString(self.unit.unit.upper()))
        model.SetGlobalSection(section)
        self.model = Model(self.reader.WS())
        self.faults = [fault for fault in self.model.faults() if not _OF_UNIT.match(fault.text)]
        self.risky = bool(self.faults)

    def transfer(self) -> PartContent:
        """Make the shape; ReadError where it holds no shape that can be read."""
        text = f" ({self.faults[0].short}, {len(self.faults)} faults)" if self.faults else ""
        document = TDocStd_Document(TCollection_ExtendedString("XmlXCAF"))
        # In metres: the kernel divides by it.
        XCAFDoc_DocumentTool.SetLengthUnit_s(document, 1e-3 * self.unit.scale)
        self.reader.Transfer(document)
        shape = self.reader.OneShape()
        if shape.IsNull():
            raise ReadError(f"nothing in it could be read{text}: export it again, or as STEP", file=self.file)
        result = PartContent(unwrapped(shape), unit_readings=self.unit.readings)
        add_attributes(document, result, DroppedNames({}, {}))
        result.tree = ()  # its roots are surfaces rather than products
        # Two lines an entity: the first starts with its number.
        directory = self.sections[b"D"]
        if self.names and any_names(directory):
            add_names(self.reader, result, self.model, directory)
        kinds = [line[:8].strip() for line in directory[::2]]
        written = sum(kind.isdigit() and int(kind) in FACES for kind in kinds)
        face_count = shape_map(shape, TopAbs_FACE).Extent()
        # The transfer could not put faces together to the solids and shells that are written.
        doubts = [self.model.entities[fault.number] for fault in self.model.trouble(fails=False) if fault.number]
        split = any(entity.TypeNumber() in _WHOLES for entity in doubts)
        if face_count < written or self.faults or split or self.model.trouble(fails=True):
            result.lost = unread_of_iges(self.model, self.faults, faces(result.shape), split=split)
            gone = sum(each.face is None for each in result.lost)
            result.lost += [LostFace("", "", "it is written, but could not be read")] * (written - face_count - gone)
        unknown = [fault for fault in self.faults if "(entity type)" in fault.text]
        result.lost += [LostFace("", "", "an entity of no known type stands in the file: it may be a face")] * len(unknown)
        if self.faults:
            result.warnings.append(f"the file has faults{text}")
        return result

    def _refuse(self) -> None:
        """Files that were cut off, which the kernel reads as a success."""
        last = self.sections[b"T"]
        if not last:
            raise ReadError("is cut off (it has no terminate record): fetch or export it again", file=self.file)
        counts = _COUNTS.match(last[-1])
        for section, count in zip((b"S", b"G", b"D", b"P"), counts.groups() if counts else (), strict=False):
            if (here := len(self.sections[section])) < int(count):
                raise ReadError(
                    f"is missing lines ({here} of {int(count)} in section {section.decode()}): fetch it again", file=self.file
                )
