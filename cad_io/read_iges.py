"""Read IGES, with guards: the kernel reads a file that was cut off as a success."""

import re
from collections import defaultdict

from OCP.IFSelect import IFSelect_RetDone
from OCP.IGESCAFControl import IGESCAFControl_Reader
from OCP.TCollection import TCollection_ExtendedString, TCollection_HAsciiString
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_FACE

from cad_io.errors import ReadError
from cad_io.iges_names import add_names, any_names
from cad_io.kernel import shape_map
from cad_io.part import unwrapped
from cad_io.read_step import Read, add_attributes, faults_of, lost_faces

#: Entity numbers that must each become a face: bounded surface, trimmed surface, face.
_FACES = (143, 144, 510)
#: The standard's numbers of units.
_FLAGS = {"in": 1, "mm": 2, "ft": 4, "m": 6, "km": 7, "mil": 8, "um": 9, "cm": 10}
_COUNTS = re.compile(rb"S\s*(\d+)G\s*(\d+)D\s*(\d+)P\s*(\d+)")


def read(file: str, data: bytes, unit: str | None = None) -> Read:
    """Read an IGES file.

    Parameters
    ----------
    file : str
    data : bytes
        Its content, for the checks that the kernel does not make.
    unit : str, optional
        Length unit to take instead of the file's, one of `units.UNITS`.

    Raises
    ------
    ReadError
        Cut off, faulty, or without a shape.
    """
    sections: dict[bytes, list[bytes]] = defaultdict(list)
    for line in data.splitlines():
        sections[line[72:73]].append(line)
    last = sections[b"T"]
    if not last:
        raise ReadError("is cut off (it has no terminate record): fetch or export it again", file=file)
    counts = _COUNTS.match(last[-1])
    if counts:
        for section, written in zip((b"S", b"G", b"D", b"P"), map(int, counts.groups()), strict=True):
            if len(sections[section]) < written:
                raise ReadError(
                    f"has lost lines ({len(sections[section])} of {written} in section {section.decode()}): fetch it again",
                    file=file,
                )
    reader = IGESCAFControl_Reader()
    reader.SetColorMode(True)
    reader.SetLayerMode(True)
    reader.SetNameMode(False)
    if reader.ReadFile(file) != IFSelect_RetDone:
        raise ReadError("is not valid IGES: export it again", file=file)
    if unit is not None:
        _set_unit(reader, unit)
    faults = faults_of(reader)
    fault = f" ({faults[0].replace('%d ', '').rstrip('.')}, {len(faults)} faults)" if faults else ""
    document = TDocStd_Document(TCollection_ExtendedString("XmlXCAF"))
    reader.Transfer(document)
    shape = reader.OneShape()
    if shape.IsNull():
        raise ReadError(f"nothing in it could be read{fault}: export it again, or as STEP", file=file)
    result = Read(unwrapped(shape))
    add_attributes(document, result)
    result.tree = ()  # its roots are surfaces rather than products
    # Two lines an entity: the first starts with its number.
    directory = sections[b"D"]
    if any_names(directory):
        add_names(reader, result)
    kinds = [line[:8].strip() for line in directory[::2]]
    written = sum(kind.isdigit() and int(kind) in _FACES for kind in kinds)
    found = shape_map(shape, TopAbs_FACE).Extent()
    if found < written:
        result.warnings.append(lost_faces(found, written))
    if faults:
        result.warnings.append(f"the file has faults{fault}")
    return result


def _set_unit(reader: IGESCAFControl_Reader, unit: str) -> None:
    model = reader.WS().Model()
    section = model.GlobalSection()
    section.SetUnitFlag(_FLAGS[unit])
    section.SetUnitName(TCollection_HAsciiString(unit.upper()))
    model.SetGlobalSection(section)
