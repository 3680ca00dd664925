"""Read IGES, with guards: the kernel reads a file that was cut off as a success."""

import re
from collections import defaultdict

from OCP.IFSelect import IFSelect_RetDone
from OCP.IGESCAFControl import IGESCAFControl_Reader
from OCP.TCollection import TCollection_ExtendedString, TCollection_HAsciiString
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_FACE
from OCP.XCAFDoc import XCAFDoc_DocumentTool

from cad_io.arrays import LostFace
from cad_io.errors import ReadError
from cad_io.kernel import faces, shape_map
from cad_io.kernel.components import unwrapped
from cad_io.read.document import Read, add_attributes
from cad_io.read.faults import Model
from cad_io.read.iges_names import add_names, any_names
from cad_io.read.iges_units import FLAGS, IgesUnit, unit_of
from cad_io.read.unread_iges import FACES, fell_apart, unread_of_iges

#: Faults in the statement of the unit, which is read here.
_OF_UNIT = re.compile(r"Global Section \(Parameter 1[345]\b")
_COUNTS = re.compile(rb"S\s*(\d+)G\s*(\d+)D\s*(\d+)P\s*(\d+)")


class Loaded:
    """An IGES file whose entities are loaded, but not yet made into shapes.

    What it takes, has and raises is as of `step.Loaded`; there is nothing for `careful` to leave out.
    """

    alone = True

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
        _set_unit(self.reader, self.unit.unit)
        self.model = Model(self.reader.WS())
        self.faults = [fault for fault in self.model.faults() if not _OF_UNIT.match(fault.text)]
        self.risky = bool(self.faults)

    def transfer(self) -> Read:
        """Make the shape.

        Raises
        ------
        ReadError
            It holds no shape that can be read.
        """
        text = f" ({self.faults[0].short}, {len(self.faults)} faults)" if self.faults else ""
        document = TDocStd_Document(TCollection_ExtendedString("XmlXCAF"))
        # In metres: the kernel divides by it.
        XCAFDoc_DocumentTool.SetLengthUnit_s(document, 1e-3 * self.unit.scale)
        self.reader.Transfer(document)
        shape = self.reader.OneShape()
        if shape.IsNull():
            raise ReadError(f"nothing in it could be read{text}: export it again, or as STEP", file=self.file)
        result = Read(unwrapped(shape), unit_readings=self.unit.readings)
        add_attributes(document, result)
        result.tree = ()  # its roots are surfaces rather than products
        # Two lines an entity: the first starts with its number.
        directory = self.sections[b"D"]
        if self.names and any_names(directory):
            add_names(self.reader, result, self.model, directory)
        kinds = [line[:8].strip() for line in directory[::2]]
        written = sum(kind.isdigit() and int(kind) in FACES for kind in kinds)
        face_count = shape_map(shape, TopAbs_FACE).Extent()
        split = fell_apart(self.model)
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


def _set_unit(reader: IGESCAFControl_Reader, unit: str) -> None:
    model = reader.WS().Model()
    section = model.GlobalSection()
    section.SetUnitFlag(next(flag for flag, name in FLAGS.items() if name == unit))
    section.SetUnitName(TCollection_HAsciiString(unit.upper()))
    model.SetGlobalSection(section)
