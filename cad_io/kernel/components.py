"""Divide a shape into components: solids, shells and faces that share no edge can be worked on one by one."""

from typing import Any

from OCP.BRep import BRep_Builder
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
from OCP.gp import gp_Dir, gp_Pln, gp_Pnt
from OCP.TopAbs import TopAbs_COMPOUND, TopAbs_EDGE
from OCP.TopoDS import TopoDS_Compound, TopoDS_Iterator
from OCP.TopTools import TopTools_IndexedMapOfShape

from cad_io.kernel.calls import shape_map


def components(shape: Any) -> list[Any]:
    """Parts of a shape that share no edge, in order; several that do are one compound. Not a compound: itself."""
    parts = flat(shape)
    edges = TopTools_IndexedMapOfShape()
    owner: dict[int, int] = {}
    root = list(range(len(parts)))

    def find(i: int) -> int:
        while root[i] != i:
            i = root[i]
        return i

    for i, part in enumerate(parts):
        mine = shape_map(part, TopAbs_EDGE)
        for k in range(1, mine.Extent() + 1):
            other = owner.setdefault(edges.Add(mine.FindKey(k)), i)
            # The smaller number leads, which keeps the order.
            low, high = sorted((find(i), find(other)))
            root[high] = low
    groups: dict[int, list[Any]] = {}
    for i, part in enumerate(parts):
        groups.setdefault(find(i), []).append(part)
    return [group[0] if len(group) == 1 else compound(group) for group in groups.values()]


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


def children(shape: Any) -> list[Any]:
    """Sub-shapes one level down, located and oriented as they stand in the shape."""
    out = []
    each = TopoDS_Iterator(shape)
    while each.More():
        out.append(each.Value())
        each.Next()
    return out


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
