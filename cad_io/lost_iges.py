"""Which faces written in an IGES file are not in the part, or not as written?"""

from collections.abc import Sequence
from typing import Any

from OCP.TopoDS import TopoDS_Face

from cad_io.altered import edge_count, misfit, open_border
from cad_io.arrays import LostFace
from cad_io.faults import Fault, Model
from cad_io.iges_names import name_of

#: Entity numbers that must each become a face: bounded surface, trimmed surface, face.
FACES = (143, 144, 510)
#: What borders are made of: a face whose border fails comes without it.
_BORDERS = (102, 141, 142, 508)


def lost_of_iges(model: Model, faults: Sequence[Fault], shapes: Sequence[TopoDS_Face]) -> list[LostFace]:
    """Faces without a shape, and those that had trouble and cannot show that they are whole.

    Parameters
    ----------
    model : Model
        Transferred.
    faults : sequence of Fault
        Found in it before.
    shapes : sequence of TopoDS_Face
        Faces of the part.
    """
    results = model.results()
    felt: dict[int, list[Fault]] = {}
    for fault in (*faults, *model.trouble(fails=True)):
        for n in model.users(fault.number, _is_face):
            if n and _is_face(model.entities[n]):
                felt.setdefault(n, []).append(fault)
    gone = [n for n, entity in model.entities.items() if _is_face(entity) and n not in results]
    lost = [_lost(model, n, "the CAD kernel could not make it", felt.get(n, [])) for n in gone]
    numbers: dict[int, int] = {}
    if felt and (made := model.makers(dict(enumerate(shapes, 1)))) is not None:
        numbers = {entity: n for n, entity in made.items() if _is_face(model.entities[entity])}
        # A face that failed may stand there as its bare surface.
        unknown = [n for n in range(1, len(shapes) + 1) if n not in numbers.values()]
        missed = [n for n, entity in model.entities.items() if _is_face(entity) and n in results and n not in numbers]
        if len(unknown) == len(missed):
            numbers.update(zip(missed, unknown, strict=True))
    for entity, told in felt.items():
        if entity in numbers and (why := _altered(model, told, shapes[numbers[entity] - 1])):
            lost.append(_lost(model, entity, why, told, numbers[entity]))
        elif entity not in numbers and entity in results:
            lost.append(_lost(model, entity, "it may not be as written", told))
    return lost


def _altered(model: Model, felt: Sequence[Fault], shape: TopoDS_Face) -> str:
    if not edge_count(shape):
        return "it came without its edges"
    if any(model.entities[fault.number].TypeNumber() in _BORDERS for fault in felt if fault.number):
        return "a bound of it (a hole or the border) may be missing"
    return "its border is open" if open_border(shape) else misfit(shape)


def _lost(model: Model, number: int, why: str, felt: Sequence[Fault], face: int | None = None) -> LostFace:
    said = f"{why} ({_ident(felt[0].number)}: {felt[0].short})" if felt else why
    return LostFace(_ident(number), name_of(model.entities[number]), said, face)


def _ident(number: int) -> str:
    """An entity by the line of the directory section at which it starts: two lines each."""
    return f"D{2 * number - 1}" if number else "the file"


def _is_face(entity: Any) -> bool:
    return entity.TypeNumber() in FACES
