"""Parts made of objects: one shape, its components with names and colours, and the numbers of picked faces."""

from collections.abc import Iterator, Sequence
from typing import Any

from OCP.TopAbs import TopAbs_FACE
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Shape
from OCP.TopTools import TopTools_IndexedMapOfShape

from cad_io.errors import ReadError
from cad_io.kernel import explore, shape_map
from cad_io.kernel.assembly import Node
from cad_io.kernel.components import as_one, unwrapped
from cad_io.part import Part
from cad_io.read.document import FaceMarks
from cad_io.read.host_objects import Colour, Held, Item, Mark, each_of, gather, same_place, shapes_of


def from_object(source: Any) -> dict[str, Any]:
    """Return the arguments that make a `Part` of an object, by the names of its parameters.

    Parameters
    ----------
    source : object
        A kernel shape; an object with `.wrapped` (CadQuery, build123d); a CadQuery Workplane or Assembly; a build123d
        builder; a list or tuple of such. Faces that know the shape which they were taken from are picked on it.

    Raises
    ------
    ReadError
        It holds no shape, or a picked face whose shape is not known.
    """
    held = Held()
    try:
        gather(source, held)
    except RecursionError:
        raise ReadError("the part holds itself") from None
    if not held.items:
        raise ReadError(f"the {type(source).__name__} holds no shape")
    shape = unwrapped(as_one([item.shape for item in held.items]))
    walk = _Walk(shape)
    tree = tuple(walk.node(item, TopLoc_Location(), None, root=True) for item in held.items)
    walk.mark(held.picked, TopLoc_Location())
    picked = {walk.map.FindIndex(mark.shape) for mark in held.picked}
    named = any(item.name or item.inner for item in held.items)
    return {
        "shape": shape,
        "names": walk.names,
        "colours": walk.colours,
        "layers": walk.layers,
        "tree": tree if named else (),
        "picked": tuple(sorted(picked)),
        "warnings": tuple(held.warnings),
    }


def face_numbers(part: Part, value: Any) -> tuple[int, ...]:
    """Numbers of faces that are given as objects, ascending.

    Parameters
    ----------
    part : Part
    value : object
        As for `from_object`; of a shape that is no face, all its faces.

    Raises
    ------
    ReadError
        It holds no face, or one that the part has not, or has in another place.
    """
    known = shape_map(part.shape, TopAbs_FACE)
    numbers = set()
    try:
        shapes = [shape for each in each_of(value) for shape in shapes_of(each)]
    except RecursionError:
        raise ReadError("the list of faces holds itself") from None
    for face in (face for shape in shapes for face in explore(shape, TopAbs_FACE)):
        # The kernel compares how a place was made, not where it is.
        number = known.FindIndex(face) or next(_in_same_place(known, face), 0)
        if not number:
            partner = next((n for n in range(1, known.Extent() + 1) if known.FindKey(n).IsPartner(face)), None)
            raise ReadError(
                "a given face is not a face of the part: pick it on the shape that is planned, after its last change"
                if partner is None
                else f"a given face is F{partner} of the part, but in another place: pick it on the part as it is placed"
            )
        numbers.add(number)
    if not numbers:
        raise ReadError(f"no faces in a value of type {type(value).__name__}: give faces of the part")
    return tuple(sorted(numbers))


def _in_same_place(known: TopTools_IndexedMapOfShape, face: TopoDS_Shape) -> Iterator[int]:
    for number in range(1, known.Extent() + 1):
        other = known.FindKey(number)
        if other.IsPartner(face) and same_place(other.Location(), face.Location()):
            yield number


class _Walk(FaceMarks):
    """The tree of components and what is said of faces."""

    def node(self, item: Item, location: TopLoc_Location, colour: Colour | None, *, root: bool = False) -> Node:
        place, colour = item.shape.Location(), item.colour or colour
        instance = "" if root else item.name
        if item.inner:
            inside = location.Multiplied(place)
            return Node(item.name, instance, place, children=tuple(self.node(i, inside, colour) for i in item.inner))
        mine = self.take(self.numbers(item.shape, location))
        self.paint(mine, "", colour)
        self.mark(item.marks, location.Multiplied(place))
        return Node(item.name, instance, place, faces=tuple(mine))

    def mark(self, marks: Sequence[Mark], location: TopLoc_Location) -> None:
        for mark in marks:
            self.paint(self.numbers(mark.shape, location), mark.name, mark.colour, (mark.layer,) if mark.layer else ())
