"""Read IGES, with guards: the kernel reads a file that was cut off as a success."""

import re
from collections import Counter

from OCP.IFSelect import IFSelect_RetDone
from OCP.IGESControl import IGESControl_Reader
from OCP.TopAbs import TopAbs_FACE

from cad_io.errors import ReadError
from cad_io.kernel import shape_map
from cad_io.part import unwrapped
from cad_io.read_step import Read, faults_of, lost_faces

#: Entity numbers that must each become a face: bounded surface, trimmed surface, face.
_FACES = (143, 144, 510)
_COUNTS = re.compile(rb"S\s*(\d+)G\s*(\d+)D\s*(\d+)P\s*(\d+)")


def read(file: str, data: bytes) -> Read:
    """Read an IGES file.

    Parameters
    ----------
    file : str
    data : bytes
        Its content, for the checks that the kernel does not make.

    Raises
    ------
    ReadError
        Cut off, faulty, or without a shape.
    """
    lines = [line for line in re.split(rb"\r\n|\n|\r", data) if line.strip()]
    sections = Counter(line[72:73] for line in lines if len(line) > 72)
    last = [line for line in lines if line[72:73] == b"T"]
    if not last:
        raise ReadError("is cut off (it has no terminate record): fetch or export it again", file=file)
    counts = _COUNTS.match(last[-1])
    if counts:
        for section, written in zip((b"S", b"G", b"D", b"P"), map(int, counts.groups()), strict=True):
            if sections[section] < written:
                raise ReadError(
                    f"has lost lines ({sections[section]} of {written} in section {section.decode()}): fetch it again",
                    file=file,
                )
    reader = IGESControl_Reader()
    if reader.ReadFile(file) != IFSelect_RetDone:
        raise ReadError("is not valid IGES: export it again", file=file)
    faults = faults_of(reader)
    fault = f" ({faults[0].replace('%d ', '').rstrip('.')}, {len(faults)} faults)" if faults else ""
    reader.TransferRoots()
    shape = reader.OneShape()
    if shape.IsNull():
        raise ReadError(f"nothing in it could be read{fault}: export it again, or as STEP", file=file)
    warnings = []
    # Two lines an entity: the first starts with its number, and so does the second, so every other line counts.
    directory = [line[:8].strip() for line in lines if line[72:73] == b"D"][::2]
    written = sum(number.isdigit() and int(number) in _FACES for number in directory)
    found = shape_map(shape, TopAbs_FACE).Extent()
    if found < written:
        warnings.append(lost_faces(found, written))
    if faults:
        warnings.append(f"the file has faults{fault}")
    return Read(unwrapped(shape), warnings=warnings)
