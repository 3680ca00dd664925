"""Parts made of objects of CAD hosts: one shape, its components with names and colours, and the numbers of picked faces.

CadQuery and build123d are not imported: their objects are told by what they can do. A picked face is a target, not a
part: the part is the shape that it belongs to, for what stands around a face is in the way of a cutter.
"""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.GeomAbs import GeomAbs_Plane
from OCP.gp import gp_Ax1, gp_Dir, gp_Pnt
from OCP.Quantity import Quantity_ColorRGBA, Quantity_TOC_sRGB
from OCP.TopAbs import TopAbs_FACE
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Shape
from OCP.TopTools import TopTools_IndexedMapOfShape

from cad_io.errors import CadIoError, ReadError
from cad_io.kernel import explore, faces, shape_map, translated
from cad_io.kernel.shapes import Node, as_one, compound, turned, unwrapped
from cad_io.kernel.shapes import children as children_of
from cad_io.part import Part
from cad_io.part.content import PartContent
from cad_io.read.document import FaceMarks

Colour = tuple[float, float, float]

#: Names that CadQuery makes up for assemblies without one: other ones in each run.
_MADE_UP = re.compile(r"[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}")
#: Places that differ by less, mm and sines, are the same.
_SAME_PLACE = 1e-9


@dataclass(frozen=True, slots=True)
class Mark:
    """A mark gives the attributes of faces in a component: their shape at its place there, a name, a colour, a layer."""

    shape: TopoDS_Shape
    name: str
    colour: Colour | None
    layer: str = ""


@dataclass(frozen=True, slots=True)
class Item:
    """A component: its shape as it stands in the component around it, whose location is its place."""

    shape: TopoDS_Shape
    name: str = ""
    colour: Colour | None = None
    inner: tuple["Item", ...] = ()
    marks: tuple[Mark, ...] = ()


@dataclass(slots=True)
class Held:
    """This record collects the components, the picked faces and the warnings of an object."""

    items: list[Item] = field(default_factory=list)
    picked: list[Mark] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    parents: dict[int, tuple[Any, TopTools_IndexedMapOfShape]] = field(default_factory=dict)

    def add(self, item: Item) -> None:
        """Take a component once, however many of its faces are picked."""
        if not any(item.shape.IsSame(known.shape) for known in self.items):
            self.items.append(item)


def same_place(a: TopLoc_Location, b: TopLoc_Location) -> bool:
    a_move, b_move = a.Transformation(), b.Transformation()
    ends = [(a_move.Value(i, j), b_move.Value(i, j)) for i in range(1, 4) for j in range(1, 5)]
    return all(abs(x - y) <= _SAME_PLACE for x, y in ends)


def gather(source: Any, held: Held) -> None:
    """Find components and picked faces in an object."""
    if _is_assembly(source):
        held.add(_assembly(source))
    elif isinstance(source, list | tuple):
        for i, each in enumerate(source, 1):
            if not (_is_host(each) or isinstance(each, list | tuple)):
                raise ReadError(f"item {i} of the list is of type {type(each).__name__}, which is no shape")
            gather(each, held)
    elif callable(getattr(source, "vals", None)):
        _workplane(source, held)
    elif not _is_host(source):
        raise ReadError(
            f"a value of type {type(source).__name__} is not a part: give a path, a kernel shape, a CadQuery or a build123d "
            "object, or a list of shapes"
        )
    elif hasattr(source, "part") and not _has_shape(source):
        gather(source.part, held)
    else:
        _shape(source, held)


def _shape(source: Any, held: Held) -> None:
    """A shape; a face that knows where it was taken from is picked there."""
    parent = getattr(source, "topo_parent", None)
    shape = _wrapped(source)
    if parent is None or shape.ShapeType() != TopAbs_FACE:
        held.add(_item(source, held))
        return
    if id(parent) not in held.parents:
        # Looked at once for all faces picked on it; kept, so that its id stays its own.
        held.parents[id(parent)] = parent, shape_map(_wrapped(parent), TopAbs_FACE)
        held.add(_item(parent, held))
    if not held.parents[id(parent)][1].Contains(shape):
        raise ReadError(
            "a face does not stand in the shape that it was taken from (topo_parent): pick it again, or set "
            "its topo_parent to None to plan it alone"
        )
    held.picked.append(Mark(shape, _label(source), _colour(source)))


def _missing(faces: Sequence[Any], bodies: Sequence[Any]) -> list[Any]:
    """The faces that none of the bodies holds."""
    here = TopTools_IndexedMapOfShape()
    for body in bodies:
        for face in explore(_wrapped(body), TopAbs_FACE):
            here.Add(face)
    return [face for face in faces if not here.Contains(_wrapped(face))]


def _workplane(source: Any, held: Held) -> None:
    """The shapes on a stack; faces there are picked on the nearest shape in the chain that holds them."""
    on_stack = [value for value in source.vals() if _has_shape(value)]
    faces = [value for value in on_stack if _wrapped(value).ShapeType() == TopAbs_FACE]
    if not faces:
        bodies = list(filter(_is_body, on_stack))
        if not bodies:
            raise ReadError(
                f"the stack of the {type(source).__name__} holds no solid and no face: plan after a solid, or after faces(...)"
            )
        for body in bodies:
            held.add(_item(body, held))
        return
    missing, before, node = list(faces), 0, source
    while missing and node is not None:
        bodies = [value for value in node.vals() if _has_shape(value) and _is_body(value)]
        rest = _missing(missing, bodies)
        if len(rest) < len(missing):
            for body in bodies:
                held.add(_item(body, held))
            if before:
                held.warnings.append(
                    f"{len(missing) - len(rest)} of the picked faces belong to an earlier shape in the chain: the later "
                    "ones are no obstacles"
                )
        before += bool(bodies)
        missing, node = rest, getattr(node, "parent", None)
    if missing:
        raise ReadError(
            f"{len(missing)} of the {len(faces)} faces on the stack belong to no solid in the chain, so what is around "
            "them is not known: pick them on the solid, or give the faces themselves (.vals()) to plan them alone"
        )
    held.picked += [Mark(_wrapped(face), _label(face), _colour(face)) for face in faces]


def _assembly(source: Any) -> Item:
    """A CadQuery assembly: its own object, if any, and its children."""
    shapes = [shape for shape in source.shapes if _has_shape(shape)]
    marks: dict[Any, list[Any]] = {}
    for word, at in (("_subshape_names", 1), ("_subshape_colors", 2), ("_subshape_layers", 3)):
        for shape, value in (getattr(source, word, None) or {}).items():
            marks.setdefault(shape, [_wrapped(shape), "", None, ""])[at] = value
    mine = tuple(Mark(s, _text(n), _rgb(c), _text(l)) for s, n, c, l in marks.values())
    name, colour, place = _text(source.name), _rgb(source.color), source.loc.wrapped
    own = as_one([_wrapped(shape) for shape in shapes]) if shapes else None
    inner = tuple(map(_assembly, source.children))
    if not inner:
        whole = compound([own] if own is not None else [])
        return Item(whole.Located(place), name, colour, marks=mine)
    if own is not None:
        inner = (Item(compound([own]), name, colour, marks=mine), *inner)
    return Item(compound([item.shape for item in inner]).Located(place), name, colour, inner)


def _item(source: Any, held: Held, shape: TopoDS_Shape | None = None) -> Item:
    """A shape with its label and, of a build123d compound, its children.

    What counts is the compound's own shape; a copy's children have shapes of their own, which stand in none. `shape` is
    where the source stands in the compound around it.
    """
    shape = _wrapped(source) if shape is None else shape
    children = getattr(source, "children", ())
    inner: tuple[Item, ...] = ()
    if children and isinstance(children, tuple | list):
        stand = children_of(shape, located=False)
        if [_face_count(s) for s in stand] == [_face_count(_wrapped(child)) for child in children]:
            pairs = list(zip(children, stand, strict=True))
            moved = [c for c, s in pairs if not same_place(_wrapped(c).Location(), s.Location())]
            held.warnings += [
                f"{_label(child) or 'a child'} was moved after its compound was made: it is planned where it stood then"
                for child in moved
            ]
            inner = tuple(_item(child, held, s) for child, s in pairs)
        else:
            held.warnings.append(
                f"the children of {_label(source) or 'a compound'} are not what its shape holds: their names are left out"
            )
    return Item(shape, _label(source), _colour(source), inner)


def _is_assembly(source: Any) -> bool:
    # Asked of the class: a CadQuery assembly gives its children as attributes of any name.
    return all(hasattr(type(source), word) for word in ("toCompound", "traverse", "shapes"))


def _is_host(source: Any) -> bool:
    """Whether it is, or may hold, a shape."""
    if isinstance(source, TopoDS_Shape) or _is_assembly(source) or callable(getattr(source, "vals", None)):
        return True
    return any(hasattr(type(source), word) for word in ("wrapped", "part")) or "wrapped" in getattr(source, "__dict__", ())


def _wrapped(source: Any) -> TopoDS_Shape:
    """The kernel shape in an object; ReadError where it has none."""
    shape = source
    if not isinstance(source, TopoDS_Shape):
        try:
            shape = source.wrapped
        except Exception:  # build123d's empty shapes raise when asked
            shape = None
    if not isinstance(shape, TopoDS_Shape) or shape.IsNull():
        raise ReadError(f"the {type(source).__name__} holds no shape")
    return shape


def _has_shape(source: Any) -> bool:
    try:
        return bool(_wrapped(source))
    except ReadError:
        return False


def _is_body(source: Any) -> bool:
    """Whether it is a shape with faces that is more than a face."""
    shape = _wrapped(source)
    return shape.ShapeType() != TopAbs_FACE and next(explore(shape, TopAbs_FACE), None) is not None


def each_of(source: Any) -> Iterator[Any]:
    """Objects in lists, one by one."""
    if isinstance(source, list | tuple):
        for each in source:
            yield from each_of(each)
    else:
        yield source


def shapes_of(source: Any) -> list[TopoDS_Shape]:
    """The shapes of one object, as they are given: nothing is looked for around them."""
    if _is_assembly(source):
        return [_wrapped(source.toCompound())]
    if callable(getattr(source, "vals", None)):
        return [_wrapped(value) for value in source.vals() if _has_shape(value)]
    if not _is_host(source):
        raise ReadError(f"a value of type {type(source).__name__} is no face of the part")
    return [_wrapped(source)]


def _face_count(shape: TopoDS_Shape) -> int:
    return int(shape_map(shape, TopAbs_FACE).Extent())


def _label(source: Any) -> str:
    return _text(getattr(source, "label", ""))


def _colour(source: Any) -> Colour | None:
    return _rgb(getattr(source, "color", None))


def _text(name: Any) -> str:
    """A host's name, if it is one; half a pair of surrogates, which no file can hold, becomes a question mark."""
    if not isinstance(name, str) or _MADE_UP.fullmatch(name.strip()):
        return ""
    return name.strip().encode("utf-8", "replace").decode()


def _rgb(colour: Any) -> Colour | None:
    """sRGB, 0 to 1, of a host's colour."""
    value = getattr(colour, "wrapped", None)
    if not isinstance(value, Quantity_ColorRGBA):
        return None
    red, green, blue = value.GetRGB().Values(Quantity_TOC_sRGB)
    return round(red, 6), round(green, 6), round(blue, 6)


def from_object(source: Any) -> PartContent:
    """Return what makes a `Part` of an object.

    The object is a kernel shape; one with `.wrapped` (CadQuery, build123d); a CadQuery Workplane or Assembly; a build123d
    builder; a list or tuple of such. Faces that know the shape which they were taken from are picked on it.

    Raises ReadError where it holds no shape, or a picked face whose shape is not known.
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
    return PartContent(shape, names=walk.names, colours=walk.colours, layers=walk.layers, tree=tree if named else (),
                       picked=tuple(sorted(picked)), warnings=held.warnings)  # fmt: skip


def face_numbers(part: Part, value: Any) -> tuple[int, ...]:
    """Numbers of faces that are given as objects, ascending; the objects are as for `from_object`, of a shape that is no face all
    its faces.

    Raises ReadError where there is no face, or one that the part has not, or has in another place.
    """
    known = shape_map(part.shape, TopAbs_FACE)
    numbers = set()
    try:
        shapes = [shape for each in each_of(value) for shape in shapes_of(each)]
    except RecursionError:
        raise ReadError("the list of faces holds itself") from None
    for face in (face for shape in shapes for face in explore(shape, TopAbs_FACE)):
        # The kernel compares how a place was made, not where it is.
        if not (number := known.FindIndex(face)):
            partners = [n for n in range(1, known.Extent() + 1) if known.FindKey(n).IsPartner(face)]
            number = next((n for n in partners if same_place(known.FindKey(n).Location(), face.Location())), 0)
            if not number:
                raise ReadError(
                    f"a given face is F{partners[0]} of the part, but in another place: pick it on the part as it is placed"
                    if partners
                    else "a given face is not a face of the part: pick it on the shape that is planned, after its last change"
                )
        numbers.add(number)
    if not numbers:
        raise ReadError(f"no faces in a value of type {type(value).__name__}: give faces of the part")
    return tuple(sorted(numbers))


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


#: Angle, rad, and distance, mm, up to which a profile's plane holds the axis.
_FLAT, _ON = 1e-6, 1e-4


def turned_part(source: Any, origin: Sequence[float], direction: Sequence[float]) -> Part:
    """The part that an object stands for: solids and shells as they are; planar faces, wires and edges turned about an axis, mm.

    The object is a kernel shape, a CadQuery or build123d object, or a list of such. Raises ReadError where it holds no shape, or
    a profile that lies in no plane through the axis, or is not joined.
    """
    if isinstance(source, Part):
        return source
    if any(getattr(getattr(each, "ctx", None), "pendingEdges", ()) for each in each_of(source)):
        raise ReadError("the lines of the Workplane are not joined to a profile: close() it, or wire()")
    with translated("reading a body of revolution", error=ReadError):
        axis = gp_Ax1(gp_Pnt(*origin), gp_Dir(*direction))
        profiles = [_turned(shape, axis, origin, direction) for each in each_of(source) for shape in shapes_of(each)]
    if not profiles:
        raise ReadError(f"the {type(source).__name__} holds no shape")
    return Part(as_one(profiles))


def _turned(shape: Any, axis: gp_Ax1, origin: Sequence[float], direction: Sequence[float]) -> Any:
    mine = faces(shape)
    flat = [adaptor.Plane() for face in mine if (adaptor := BRepAdaptor_Surface(face)).GetType() == GeomAbs_Plane]
    coplanar = (flat[0].Axis().IsParallel(plane.Axis(), _FLAT) and flat[0].Distance(plane.Location()) <= _ON for plane in flat)
    if mine and not (len(flat) == len(mine) and all(coplanar)):
        return shape
    for plane in flat[:1]:
        across = abs(plane.Axis().Direction().Dot(axis.Direction()))
        if across > _FLAT or plane.Distance(axis.Location()) > _ON:
            raise ReadError("the profile lies in no plane through the axis: draw it there, or give the axis that it turns about")
    try:
        return turned(shape, origin, direction)
    except CadIoError:
        raise ReadError("the profile cannot be turned about the axis: draw its one half, on one side of the axis") from None
