"""Names of faces in an IGES file.

The kernel's document reader names only what has a colour or a level, and its own way back from a face to its entity
takes a walk through all entities for each. So entities and shapes are walked down together from the roots.
"""

from collections.abc import Callable, Sequence
from typing import Any

from OCP.TCollection import TCollection_ExtendedString
from OCP.TopAbs import TopAbs_FACE

from cad_io.kernel import shape_map
from cad_io.kernel.components import children, unwrapped
from cad_io.read.document import Read
from cad_io.read.encodings import CALLED, decoded, encoding_of
from cad_io.read.faults import Model

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


def add_names(reader: Any, result: Read, model: Model, directory: Sequence[bytes]) -> None:
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
