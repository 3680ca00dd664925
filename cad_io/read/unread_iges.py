"""Which faces written in an IGES file are not in the part, or not as written?"""

from collections.abc import Collection, Sequence
from typing import Any

from OCP.TopoDS import TopoDS_Face

from cad_io.arrays import LostFace
from cad_io.read.face_comparison import edge_count, misfit, open_border
from cad_io.read.faults import Fault, Model
from cad_io.read.iges_names import name_of

#: Entity numbers that must each become a face: bounded surface, trimmed surface, face.
FACES = (143, 144, 510)
#: What borders are made of: a face whose border fails comes without it.
_BORDERS = (102, 141, 142, 508)
_FACE, _LOOP, _WHOLES = 510, 508, (186, 514)


def fell_apart(model: Model) -> bool:
    """Whether the transfer could not put faces together to the solids and shells that are written."""
    return any(model.entities[fault.number].TypeNumber() in _WHOLES for fault in model.trouble(fails=False) if fault.number)


def _felt(model: Model, faults: Sequence[Fault], split: bool) -> dict[int, list[Fault]]:
    """Faults that faces felt, by the number of the entity; with `split` those that felt none, too."""
    felt: dict[int, list[Fault]] = {n: [] for n, entity in model.entities.items() if entity.TypeNumber() == _FACE and split}
    for fault in (*faults, *model.trouble(fails=True)):
        for n in model.users(fault.number, _is_face):
            if n and _is_face(model.entities[n]):
                felt.setdefault(n, []).append(fault)
    return felt


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

    Parameters
    ----------
    model : Model
        Transferred.
    faults : sequence of Fault
        Found in it before.
    shapes : sequence of TopoDS_Face
        Faces of the part.
    split : bool
        Count the edges of every face, since solids fell apart.
    """
    results = model.results()
    felt = _felt(model, faults, split)
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
