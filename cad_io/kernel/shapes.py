"""Shapes divided, put together, made, bounded and written as bytes; points in solids; the tree of a file's products.

The annotated model is built up as that tree again.
"""

import io
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from OCP.BinTools import BinTools
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepBuilderAPI import (
    BRepBuilderAPI_MakeEdge,
    BRepBuilderAPI_MakeFace,
    BRepBuilderAPI_MakePolygon,
    BRepBuilderAPI_MakeWire,
)
from OCP.BRepClass3d import BRepClass3d_SolidClassifier
from OCP.BRepPrimAPI import BRepPrimAPI_MakePrism, BRepPrimAPI_MakeRevol
from OCP.GC import GC_MakeArcOfCircle
from OCP.gp import gp_Ax1, gp_Dir, gp_Pln, gp_Pnt, gp_Trsf, gp_Vec
from OCP.Poly import Poly_Array1OfTriangle, Poly_Triangle, Poly_Triangulation
from OCP.Precision import Precision
from OCP.TColgp import TColgp_Array1OfPnt
from OCP.TopAbs import TopAbs_COMPOUND, TopAbs_EDGE, TopAbs_FORWARD, TopAbs_IN
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS, TopoDS_Compound, TopoDS_Face, TopoDS_Iterator, TopoDS_Shape
from OCP.TopTools import TopTools_IndexedMapOfShape

from cad_io.arrays import Floats
from cad_io.graphs import connected
from cad_io.kernel import edges_of, faces, may_refuse, shape_map, translated


def components(shape: Any) -> list[Any]:
    """Parts of a shape that share no edge, in order; several that do are one compound. Not a compound: itself."""
    parts = flat(shape)
    edges = TopTools_IndexedMapOfShape()
    owner: dict[int, int] = {}
    pairs = set()
    for i, part in enumerate(parts):
        mine = shape_map(part, TopAbs_EDGE)
        pairs |= {(i, owner.setdefault(edges.Add(mine.FindKey(k)), i)) for k in range(1, mine.Extent() + 1)}
    groups: dict[int, list[Any]] = {}
    for part, group in zip(parts, connected(len(parts), np.array(sorted(pairs), int).reshape(-1, 2)).tolist(), strict=True):
        groups.setdefault(group, []).append(part)
    return [as_one(group) for group in groups.values()]


def corner(side: float, gap: float) -> TopoDS_Compound:
    """A square face in the plane of x and y, and beside it, at a gap, one across it: next to the smallest part in which something
    is in the way."""
    floor = BRepBuilderAPI_MakeFace(gp_Pln(), 0.0, side, 0.0, side).Face()
    across = gp_Pln(gp_Pnt(-gap, 0.0, 0.0), gp_Dir(1.0, 0.0, 0.0))
    return compound([floor, BRepBuilderAPI_MakeFace(across, -side, side, -side, side).Face()])


def compound(shapes: list[Any]) -> Any:
    """A compound of shapes, without a location."""
    builder, whole = BRep_Builder(), TopoDS_Compound()
    builder.MakeCompound(whole)
    for shape in shapes:
        builder.Add(whole, shape)
    return whole


def children(shape: Any, *, located: bool = True) -> list[Any]:
    """Sub-shapes one level down, located and oriented as they stand in the shape; or without the shape's own location."""
    out = []
    each = TopoDS_Iterator(shape, True, located)
    while each.More():
        out.append(each.Value())
        each.Next()
    return out


def as_bytes(shape: Any) -> bytes:
    """A shape in the kernel's own form, in which sharing survives."""
    stream = io.BytesIO()
    BinTools.Write_s(shape, stream)
    return stream.getvalue()


def of_bytes(form: bytes) -> TopoDS_Shape:
    """A new copy of the shape that was given to `as_bytes`."""
    whole = TopoDS_Shape()
    BinTools.Read_s(whole, io.BytesIO(form))
    return whole


def flat(shape: Any) -> list[Any]:
    """Solids, shells, loose faces and all else that is no compound, in order."""
    if shape.ShapeType() != TopAbs_COMPOUND:
        return [shape]
    return [part for child in children(shape) for part in flat(child)]


def as_one(shapes: list[Any]) -> Any:
    """The shape itself if there is one, else a compound."""
    return shapes[0] if len(shapes) == 1 else compound(shapes)


def unwrapped(shape: Any) -> Any:
    """A compound of one shape is that shape."""
    while shape.ShapeType() == TopAbs_COMPOUND and len(inner := children(shape)) == 1:
        shape = inner[0]
    return shape


def with_edges(face: TopoDS_Face, instead: Callable[[TopoDS_Shape], Iterable[TopoDS_Shape]]) -> TopoDS_Face:
    """A face on the same surface, with the edges that `instead` gives for each edge of its borders, as they stand there."""
    builder, forward = BRep_Builder(), face.Oriented(TopAbs_FORWARD)
    made = forward.EmptyCopied()
    for border in children(forward):
        plain = border.Oriented(TopAbs_FORWARD)
        fresh = plain.EmptyCopied()
        for part in (part for edge in children(plain) for part in instead(edge)):
            builder.Add(fresh, part)
        fresh.Closed(border.Closed())
        builder.Add(made, fresh.Oriented(border.Orientation()))
    return TopoDS.Face_s(made.Oriented(face.Orientation()))


class Side(NamedTuple):
    """A side of a profile: from where the last one ended to `end`, straight, or as an arc through `middle`. Points are distances
    from the axis and heights along it."""

    end: tuple[float, float]
    middle: tuple[float, float] | None = None


def revolved(start: tuple[float, float], sides: Iterable[Side]) -> Any:
    """The solid that a closed profile makes when it is turned about the z axis, of sides from `start` on that end there again.

    Raises CadIoError where the kernel makes no solid of it.
    """

    def point(at: tuple[float, float]) -> gp_Pnt:
        return gp_Pnt(at[0], 0.0, at[1])

    with translated("turning a profile"):
        wire, at = BRepBuilderAPI_MakeWire(), start
        for side in sides:
            if side.middle is None:
                edge = BRepBuilderAPI_MakeEdge(point(at), point(side.end)).Edge()
            else:
                arc = GC_MakeArcOfCircle(point(at), point(side.middle), point(side.end)).Value()
                edge = BRepBuilderAPI_MakeEdge(arc).Edge()
            wire.Add(edge)
            at = side.end
        return turned(BRepBuilderAPI_MakeFace(wire.Wire()).Face(), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0))


def turned(shape: Any, origin: Sequence[float], direction: Sequence[float]) -> Any:
    """Revolve a face, a wire or an edge by a full turn about an axis."""
    with translated("turning a profile"):
        made = BRepPrimAPI_MakeRevol(shape, gp_Ax1(gp_Pnt(*origin), gp_Dir(*direction)))
        return made.Shape()


def prism(outline: Sequence[tuple[float, float]], low: float, high: float) -> Any:
    """The solid over a polygon of x and y, from a height along the z axis to another; CadIoError where the kernel makes none."""
    with translated("sweeping a profile"):
        wire = BRepBuilderAPI_MakePolygon()
        for x, y in outline:
            wire.Add(gp_Pnt(x, y, low))
        wire.Close()
        return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(wire.Wire()).Face(), gp_Vec(0.0, 0.0, high - low)).Shape()


def of_triangles(vertex: Floats) -> Any:
    """A compound of a face that is made of triangles (n, 3, 3) alone: it is to be looked at, and has no surface."""
    points, index = np.unique(vertex.reshape(-1, 3), axis=0, return_inverse=True)
    nodes = TColgp_Array1OfPnt(1, len(points))
    for i, point in enumerate(points.tolist(), 1):
        nodes.SetValue(i, gp_Pnt(*point))
    triangles = Poly_Array1OfTriangle(1, len(vertex))
    for i, corner in enumerate((index.reshape(-1, 3) + 1).tolist(), 1):
        triangles.SetValue(i, Poly_Triangle(*corner))
    face = TopoDS_Face()
    BRep_Builder().MakeFace(face, Poly_Triangulation(nodes, triangles))
    return compound([face])


def placed(shape: Any, place: Floats) -> Any:
    """A shape put in its place (3, 4): a rotation and a shift, mm."""
    move = gp_Trsf()
    move.SetValues(*(float(value) for value in place.ravel()))
    return shape.Moved(TopLoc_Location(move))


#: Parameters of the kernel's endless surfaces are 2e100.
_ENDLESS = 1e50
#: Precision of vertices that are made, mm.
_PRECISION = 1e-7
#: Why a face that is endless cannot be judged.
ENDLESS = "has no edges and no end: bound it"


def endless(face: TopoDS_Face) -> bool:
    """Whether a face has no edges, on a surface without end."""
    if edges_of(face):
        return False
    surface = BRep_Tool.Surface_s(face)
    return surface is not None and any(abs(each) > _ENDLESS for each in surface.Bounds())


def bound_naturally(shape: TopoDS_Shape) -> None:
    """Give each face that has no edges, and whose surface has an end, the border of that surface.

    The shape itself gets them, so that its faces stay the ones that a host knows: it is what it was, said in full.
    """
    for face in faces(shape):
        with may_refuse():
            if not edges_of(face) and not endless(face):
                _bound(face)


def _bound(face: TopoDS_Face) -> None:
    bare, place = TopoDS.Face_s(face.Located(TopLoc_Location()).Oriented(TopAbs_FORWARD)), TopLoc_Location()
    surface = BRep_Tool.Surface_s(bare, place)
    # Those that hold triangles alone have none.
    if surface is None or edges_of(bare):
        return
    whole = BRepBuilderAPI_MakeFace(surface, _PRECISION)
    if not whole.IsDone():
        return
    free = bare.Free()
    bare.Free(True)
    for wire in children(whole.Face()):
        BRep_Builder().Add(bare, wire.Moved(place))
    bare.Free(free)


def within(solids: Iterable[TopoDS_Shape], points: Floats) -> NDArray[np.bool_]:
    """Which points (n, 3), mm, lie in one of some solids, by the kernel's own exact surfaces, off them by more than its
    tolerance.

    Raises CadIoError where the kernel cannot tell.
    """
    inside = np.zeros(len(points), bool)
    for solid in solids:
        with translated("asking whether points lie in a solid"):
            classifier = BRepClass3d_SolidClassifier(solid)
            for k, (x, y, z) in enumerate(points.tolist()):
                if not inside[k]:
                    classifier.Perform(gp_Pnt(x, y, z), Precision.Confusion_s())
                    inside[k] = classifier.State() == TopAbs_IN
    return inside


@dataclass(frozen=True, slots=True)
class Node:
    """An instance of a product: an assembly of other instances, or a leaf with faces."""

    #: Of the product; empty if it has none.
    name: str
    #: Of this use of it; empty for a root.
    instance: str
    #: In the assembly around it.
    place: TopLoc_Location
    #: Of an assembly.
    children: tuple["Node", ...] = ()
    #: Face numbers of a leaf, no number in two leaves.
    faces: tuple[int, ...] = ()

    def walk(self, above: str = "", location: TopLoc_Location | None = None) -> Iterator[tuple["Node", str, TopLoc_Location]]:
        """Itself and all that is in it, each with its path of names (`wheel/rim`) and its location in the part."""
        path = "/".join(filter(None, (above, self.instance or self.name)))
        place = location.Multiplied(self.place) if location else self.place
        yield self, path, place
        for child in self.children:
            yield from child.walk(path, place)

    def leaves(self) -> Iterator[tuple["Node", str, TopLoc_Location]]:
        """Every leaf, as of `walk`."""
        return (each for each in self.walk() if not each[0].children)

    def numbers(self) -> Iterator[int]:
        """Face numbers of all leaves."""
        return (number for node, *_ in self.walk() for number in node.faces)


def component_of(tree: Sequence[Node]) -> dict[int, str]:
    """Face number -> path of names down to the leaf that the face belongs to."""
    return {number: path for root in tree for leaf, path, _ in root.leaves() for number in leaf.faces}


def faces_of(tree: Sequence[Node], name: str) -> set[int]:
    """Face numbers of every instance called so, with all that is in it.

    An exact path counts alone; where there is none, a trailing part of a path (`wheel/rim`) or a product's name.
    """
    nodes = [(node, path) for root in tree for node, path, _ in root.walk()]
    result = [node for node, path in nodes if path == name] or [
        node for node, path in nodes if path.endswith(f"/{name}") or node.name == name
    ]
    return {number for node in result for number in node.numbers()}
