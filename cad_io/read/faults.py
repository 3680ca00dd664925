"""Faults that the kernel's check finds in a loaded file, and entities that use them; whether a face came out as it was written.

The kernel's lists give entities by number and take them by number: its Python binding loses an entity that is handed
back to it. So everything here goes by number, from 1.

Which faces written in a STEP file are not in the part, or not as written, is told from what became of each entity. Words of the
kernel's messages decide little: it complains of dates and of lost shells alike, and loses a face without a word. A face is lost
where its entity has no shape in the part. One that had trouble on the way (a fault of the model or of the transfer, in something
that it uses) must show that it is whole: all edges there, every border closed, and the border, which is written by itself, on the
surface. What cannot be shown so counts as altered.
"""

import re
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve, BRepAdaptor_Curve2d
from OCP.gp import gp_Pnt
from OCP.StepGeom import StepGeom_BSplineSurface, StepGeom_CartesianPoint, StepGeom_Pcurve, StepGeom_Surface
from OCP.StepRepr import (
    StepRepr_ItemDefinedTransformation,
    StepRepr_MappedItem,
    StepRepr_NextAssemblyUsageOccurrence,
    StepRepr_RepresentationMap,
)
from OCP.StepShape import (
    StepShape_ConnectedFaceSet,
    StepShape_EdgeLoop,
    StepShape_FaceSurface,
    StepShape_GeometricSet,
    StepShape_HArray1OfFace,
    StepShape_HArray1OfFaceBound,
    StepShape_Loop,
    StepShape_SolidModel,
    StepShape_TopologicalRepresentationItem,
)
from OCP.TopAbs import TopAbs_EDGE, TopAbs_WIRE
from OCP.TopExp import TopExp
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS, TopoDS_Face

from cad_io.arrays import Floats, LostFace
from cad_io.kernel import edges_of, explore, may_refuse, shape_map
from cad_io.surface import Surface

_WORD = re.compile(r"(?<=[a-z0-9])(?=[A-Z])")

_TEXT = "not a quoted String"
#: Entities to pass, one by one, in search of those that made shapes.
_MOST_STEPS = 50_000_000


@dataclass(frozen=True, slots=True)
class Fault:
    """One fault: the number of its entity (0 where none is known), and what the kernel says."""

    number: int
    text: str

    @property
    def parameter(self) -> str:
        """Name of the entity's parameter that is wrong, empty if the fault names none."""
        match = re.search(r"\((?:\w+\.)?(\w+)\)|^Enumeration (\w+)", self.text)
        return (match[1] or match[2]) if match else ""

    @property
    def short(self) -> str:
        """Return the kernel's message without its numbering of parameters."""
        text = re.sub(r"^Parameter n\d+\.\d+ \(([\w.]+)\) ?:? ?", r"\1: ", self.text)
        text = re.sub(r", Ent\.Id\.#-?\d+ Param\.n\d+ \d+ \(Id\.(#\d+)\)", r" to \1", text)
        return text.replace("%d ", "").rstrip(".")


class Model:
    """The entities of a loaded file."""

    def __init__(self, work: Any) -> None:
        self.work = work

    @cached_property
    def entities(self) -> dict[int, Any]:
        """By number. Held here, so that one entity stays one Python object."""
        model = self.work.Model()
        return {i: model.Value(i) for i in range(1, model.NbEntities() + 1)}

    def value(self, number: int) -> Any:
        """One entity."""
        return self.work.Model().Value(number)

    @cached_property
    def _numbers(self) -> dict[int, int]:
        return {id(entity): number for number, entity in self.entities.items()}

    @cached_property
    def _users(self) -> Any:
        return self.work.Graph().SharingTable()

    def number(self, entity: Any) -> int:
        """0 for what is no entity of the file."""
        return self._numbers.get(id(entity), 0)

    def users(self, number: int, stop: Callable[[Any], bool] = lambda entity: False) -> Iterator[int]:
        """The entity and all that use it, directly or not; those that use one at which to stop are left out."""
        seen, waiting = {number}, [number]
        while waiting:
            at = waiting.pop()
            yield at
            if at and not stop(self.entities[at]):
                new = set(self._users.Value(at)) - seen
                seen |= new
                waiting += new

    def faults(self) -> list[Fault]:
        """Return the faults of the model, found before anything is transferred. A missing text does not count as a fault."""
        return [fault for fault in faults_of(self.work.ModelCheckList(True), fails=True) if _TEXT not in fault.text]

    @cached_property
    def process(self) -> Any:
        """The kernel's transfer process: what became of each entity."""
        return self.work.TransferReader().TransientProcess()

    def trouble(self, *, fails: bool) -> list[Fault]:
        """Return the fails of the transfer or, if not `fails`, its warnings: entities that it repaired or doubted."""
        return faults_of(self.process.CheckList(fails), fails=fails)

    def makers(self, shapes: Mapping[int, Any]) -> dict[int, int] | None:
        """Entities from which the transfer made shapes, by the shapes' keys; None where it would take too long."""
        reader = self.work.TransferReader()
        if len(shapes) * self.process.NbMapped() > _MOST_STEPS:
            return None
        numbers = {
            key: self.number(reader.EntityFromShapeResult(shape.Located(TopLoc_Location()), 1)) for key, shape in shapes.items()
        }
        return {key: number for key, number in numbers.items() if number}

    def results(self) -> dict[int, str]:
        """Entities that the transfer gave a shape for, and the kind of shape."""
        process, result = self.process, {}
        for i in range(1, process.NbMapped() + 1):
            binder = process.MapItem(i)
            if binder is not None and binder.HasResult() and (number := self.number(process.Mapped(i))):
                result[number] = str(binder.ResultTypeName())
        return result


def faults_of(checks: Any, *, fails: bool) -> list[Fault]:
    """Fails, or else warnings, of the kernel's list of checks."""
    faults = []
    checks.Start()
    while checks.More():
        check = checks.Value()
        count, text = (check.NbFails(), check.CFail) if fails else (check.NbWarnings(), check.CWarning)
        faults += [Fault(checks.Number(), " ".join(text(i + 1).split())) for i in range(count)]
        checks.Next()
    return faults


def type_of(entity: Any) -> str:
    """A STEP entity's type as files write it: `EDGE_CURVE`."""
    return _WORD.sub("_", type(entity).__name__.split("_", 1)[-1]).upper()


#: Borders this near to the surface, mm, or in shares of the face's size, lie on it.
_NEAR, _NEAR_SHARE = 1e-2, 1e-4
#: Where the other faces of the file are looser than that, as far as this, mm, so may the one in question be.
_LOOSEST = 0.1
_ALONG = np.linspace(0.0, 1.0, 9)


def open_border(face: TopoDS_Face) -> bool:
    """True if some border of the face does not close."""
    return not all(BRep_Tool.IsClosed_s(wire) for wire in explore(face, TopAbs_WIRE))


def edge_count(face: TopoDS_Face) -> int:
    """Edges that have a length; a seam counts once."""
    edges = shape_map(face, TopAbs_EDGE)
    return sum(not BRep_Tool.Degenerated_s(TopoDS.Edge_s(edges.FindKey(i + 1))) for i in range(edges.Extent()))


def misfit(face: TopoDS_Face, others: Sequence[TopoDS_Face] = ()) -> str:
    """Why a face's border and surface cannot both be right; empty where they fit.

    Border curves are written by themselves: where all of them lie on the surface, both are as meant. `others`: faces of the same
    file that had no trouble, to see how closely its borders lie on its surfaces.
    """

    def gap(face: TopoDS_Face) -> tuple[float, float]:
        """Largest distance of a face's border curves and their ends from its surface, and their extent, mm."""
        with may_refuse():
            off, points = _measured(face)
            return off, float(np.linalg.norm(np.ptp(points, axis=0))) if len(points) else np.inf
        return np.inf, np.inf

    off, size = gap(face)
    if not np.isfinite(size):
        return "it has no border that could confirm its surface"
    if off <= max(_NEAR, _NEAR_SHARE * size):
        return ""
    usual = max((away for away, _ in map(gap, others) if np.isfinite(away)), default=0.0)
    return "" if off <= min(usual, _LOOSEST) else f"its border leaves its surface by {off:.3g} mm"


def _measured(face: TopoDS_Face) -> tuple[float, Floats]:
    """Largest distance of border curves from the surface and of their ends from the vertices, mm; their points (n, 3)."""
    surface, off, seen = Surface(face), 0.0, [np.zeros((0, 3))]
    for edge in edges_of(face):
        if BRep_Tool.Degenerated_s(edge) or BRep_Tool.Curve_s(edge, 0.0, 0.0) is None:
            continue
        curve, flat = BRepAdaptor_Curve(edge), BRepAdaptor_Curve2d(edge, face)
        first, last = curve.FirstParameter(), curve.LastParameter()
        parameters = (first + (last - first) * _ALONG).tolist()
        there = np.array([curve.Value(t).Coord() for t in parameters])
        uv = np.array([flat.Value(t).Coord() for t in parameters])
        distance = np.linalg.norm(surface.values(uv[:, 0], uv[:, 1]) - there, axis=1)
        ends = [TopExp.FirstVertex_s(edge), TopExp.LastVertex_s(edge)]
        beyond = [
            0.0 if v.IsNull() else BRep_Tool.Pnt_s(v).Distance(gp_Pnt(*there[k])) for v, k in zip(ends, (0, -1), strict=True)
        ]
        off = max(off, *beyond, float(distance.max() if np.isfinite(distance).all() else np.inf))
        seen.append(there)
    return off, np.concatenate(seen)


#: Parameters that carry no geometry.
_WORDS = frozenset(
    ("name", "description", "id", "curve_form", "surface_form", "closed_curve", "u_closed", "v_closed",
     "self_intersect", "knot_spec", "knot_type", "b_spline_curve_form", "b_spline_surface_form", "master_representation",
     "preferred_surface_curve_representation")
)  # fmt: skip
_PLACES = (StepRepr_ItemDefinedTransformation, StepRepr_MappedItem, StepRepr_RepresentationMap)
_CRASHES = "the CAD kernel may crash on it"
_NO_ENDS = "an edge of it has no vertex at its end"
_NO_BOUND = "a bound of it (a hole or the border) is missing"
#: Faces without trouble that are looked at to see how closely borders lie on surfaces in a file.
_OTHERS = 40


def is_face(entity: Any) -> bool:
    """Whether an entity must become a face."""
    return isinstance(entity, StepShape_FaceSurface)


def is_whole(entity: Any) -> bool:
    """Whether an entity puts faces together: a shell or a solid."""
    return isinstance(entity, StepShape_ConnectedFaceSet | StepShape_SolidModel)


def name_of(entity: Any) -> str:
    """Name that a representation item has in the file."""
    try:
        text = entity.Name()
        return str(text.ToCString()).strip() if text is not None else ""
    except UnicodeDecodeError:  # as bytes of another encoding
        return ""


def touched(model: Model, faults: Iterable[Fault]) -> tuple[dict[int, list[Fault]], list[Fault]]:
    """Faults by the face entities that use what is faulty, and those that no face feels."""
    result: dict[int, list[Fault]] = {}
    harmless = []
    of_entity = defaultdict[int, list[Fault]](list)
    for fault in faults:
        of_entity[fault.number].append(fault)
    for number, each in of_entity.items():
        felt = [n for n in model.users(number, is_face) if n and is_face(model.entities[n])]
        geometry = [fault for fault in each if fault.parameter not in _WORDS]
        for n in felt:
            result.setdefault(n, []).extend(geometry)
        harmless += [fault for fault in each if not felt or fault not in geometry]
    return {n: each for n, each in result.items() if each}, harmless


def repair(model: Model, faults: Sequence[Fault] = ()) -> dict[int, str]:
    """Take out, before the transfer, what makes the kernel crash or throw away a whole solid, and faces that use what has
    `faults`.

    Returns by number what is taken from a face: a bound, or the face itself from its shells.
    """
    bad = dict.fromkeys(touched(model, faults)[0], _CRASHES)
    for number, entity in model.entities.items():
        if is_face(entity) and number not in bad:
            edges = [edge for edge in _edges(entity) if hasattr(edge, "EdgeStart")]
            if any(edge.EdgeStart() is None or edge.EdgeEnd() is None for edge in edges):
                bad[number] = _NO_ENDS
            elif None in _loops(entity):
                bad[number] = _NO_BOUND
                _unbound(entity)
    whole = {number for number, why in bad.items() if why != _NO_BOUND}
    for shell in model.entities.values() if whole else ():
        if isinstance(shell, StepShape_ConnectedFaceSet) and shell.CfsFaces() is not None:
            inner = [shell.CfsFacesValue(i + 1) for i in range(shell.NbCfsFaces())]
            retained = [face for face in inner if model.number(face) not in whole]
            if retained and len(retained) < len(inner):
                array = StepShape_HArray1OfFace(1, len(retained))
                for i, face in enumerate(retained):
                    array.SetValue(i + 1, face)
                shell.SetCfsFaces(array)
    return bad


def _unbound(face: Any) -> None:
    """Keep the bounds that are there; where none is, the kernel makes a face without edges."""
    bounds = [face.BoundsValue(i + 1) for i in range(face.NbBounds())] if face.Bounds() is not None else []
    bounds = [bound for bound in bounds if bound is not None and bound.Bound() is not None]
    array = StepShape_HArray1OfFaceBound(1, len(bounds)) if bounds else StepShape_HArray1OfFaceBound()
    for i, bound in enumerate(bounds):
        array.SetValue(i + 1, bound)
    face.SetBounds(array)


def _loops(face: Any) -> list[Any]:
    """Loops of a face, None for one that is missing."""
    if face.Bounds() is None:
        return [None]
    bounds = [face.BoundsValue(i + 1) for i in range(face.NbBounds())]
    return [None if bound is None else bound.Bound() for bound in bounds]


def _edges(face: Any) -> list[Any]:
    """Edges of a face, one each time that it is used; None for what is missing."""
    edges: list[Any] = []
    for loop in _loops(face):
        if isinstance(loop, StepShape_EdgeLoop):
            if loop.EdgeList() is None:
                edges.append(None)
                continue
            uses = [loop.EdgeListValue(i + 1) for i in range(loop.NbEdgeList())]
            edges += [None if use is None else use.EdgeElement() for use in uses]
    return edges


def missing_faces(model: Model) -> Iterator[tuple[int, int]]:
    """Shells that list what is no face, by number, and how many such."""
    for number, entity in model.entities.items():
        oriented = hasattr(entity, "ClosedShellElement") or hasattr(entity, "OpenShellElement")  # lists none itself
        if isinstance(entity, StepShape_ConnectedFaceSet) and not oriented:
            if entity.CfsFaces() is None:
                yield number, 1
            elif none := sum(entity.CfsFacesValue(i + 1) is None for i in range(entity.NbCfsFaces())):
                yield number, none


class UnreadFaces:
    """Find the unread faces of a transferred file.

    idents: the name of an entity in the file, `#12`, by its number. faults: of the model, before the transfer. repaired: the
    faces, or bounds of faces, that `repair` took out before the transfer, entity number -> text. shapes: faces of the part.
    numbers: those in the part of each face entity that is there. scale: of the file's coordinates, mm.
    """

    def __init__(
        self, model: Model, idents: Mapping[int, str], faults: Sequence[Fault], repaired: Mapping[int, str],
        shapes: Sequence[TopoDS_Face], numbers: Mapping[int, Sequence[int]], scale: float,
    ) -> None:  # fmt: skip
        self.model, self.idents, self.mended = model, idents, repaired
        self.shapes, self.numbers, self.scale = shapes, numbers, scale
        self.felt, self.harmless = touched(model, faults)
        self.failed, _ = touched(model, model.trouble(fails=True))
        doubts = model.trouble(fails=False)
        self.doubted, _ = touched(model, doubts)
        # Faces that do not fit together: one of them has lost an edge, or had none.
        self.split = any(is_whole(model.value(doubt.number)) for doubt in doubts if doubt.number)
        self.results = model.results()

    def found(self) -> list[LostFace]:
        """Every face that is lost or altered, in the order of the file."""
        unread: list[LostFace] = []
        # The part has faces of which no one knows what they were in the file.
        unnamed = sum(map(len, self.numbers.values())) < len(self.shapes)
        for number, entity in self.model.entities.items():
            if is_face(entity):
                here = self.numbers.get(number, ())
                if not here and not (number in self.results and unnamed):
                    unread += self._gone(number)
                unread += [
                    LostFace(self.ident(number), name_of(entity), self._said(why, number), n)
                    for n in here
                    if (why := self._altered(number, self.shapes[n - 1]))
                ]
        for number, count in missing_faces(self.model):
            why = self._cause("a face that the shell lists is missing or invalid", [number])
            unread += [LostFace(self.ident(number), "", why)] * count
        unread += self._places()
        unread += self._not_placed()
        return unread

    def ident(self, number: int) -> str:
        return self.idents.get(number, "")

    def _gone(self, number: int) -> Iterator[LostFace]:
        """A face that is not in the part: once for each place at which its shell is."""
        entity = self.model.entities[number]
        shells = [n for n in self.model.users(number) if isinstance(self.model.entities[n], StepShape_ConnectedFaceSet)]
        why = "the CAD kernel could not make it" if shells else "no shell takes it"
        why = "it was read, but stands in no product" if number in self.results else why
        why = self._said(self.mended.get(number, why), number)
        siblings = [self.model.entities[n] for n in shells if self.model.entities[n].CfsFaces() is not None]
        inner = [self.model.number(s.CfsFacesValue(i + 1)) for s in siblings for i in range(s.NbCfsFaces())]
        places: list[TopLoc_Location] = []
        for n in (n for sibling in inner for n in self.numbers.get(sibling, ())):
            place = self.shapes[n - 1].Location()
            if not any(place.IsEqual(other) for other in places):
                places.append(place)
        for box in [self._box(entity, place) for place in places] or [None]:
            yield LostFace(self.ident(number), name_of(entity), why, box=box)

    def _said(self, why: str, number: int) -> str:
        """With the first cause that is known."""
        for felt in (self.felt, self.failed):
            for fault in felt.get(number, ()):
                return self._with(why, fault)
        return why

    def _cause(self, why: str, numbers: Sequence[int]) -> str:
        for fault in self.harmless:
            if fault.number in numbers:
                return self._with(why, fault)
        return why

    def _with(self, why: str, fault: Fault) -> str:
        where = " ".join(filter(None, (self.ident(fault.number), type_of(self.model.entities[fault.number]))))
        return f"{why} ({where}: {fault.short})"

    def _altered(self, number: int, shape: TopoDS_Face) -> str:
        """How a face differs from what is written; empty where it was no trouble or shows that it is whole."""
        edges = _edges(self.model.entities[number])
        count = edge_count(shape)
        if edges and not count:
            return "it came without its edges"
        felt, failed = self.felt.get(number, []), self.failed.get(number, [])
        if self.split and count < len({self.model.number(edge) for edge in edges}):
            return "an edge of it is missing"
        if not (felt or failed or number in self.doubted):
            return ""
        if number in self.mended or any(isinstance(self.model.entities[fault.number], StepShape_Loop) for fault in failed):
            return _NO_BOUND
        if open_border(shape):
            return "its border is open"
        if not (felt or failed):
            return ""
        if None in edges or count < len({self.model.number(edge) for edge in edges}):
            return "an edge of it is missing"
        if any(self._beyond_proof(fault, number) for fault in felt):
            return "its geometry is not as written"
        # Beside some that had no trouble.
        quiet = [ns[0] for n, ns in self.numbers.items() if ns and n not in self.felt and n not in self.failed]
        return misfit(shape, [self.shapes[n - 1] for n in quiet[:_OTHERS]])

    def _beyond_proof(self, fault: Fault, number: int) -> bool:
        """Faults whose effect no border can show: in topology, and between the borders of free-form surfaces."""
        entity = self.model.entities[fault.number]
        if isinstance(entity, StepShape_TopologicalRepresentationItem):
            return True
        if not isinstance(entity, StepGeom_BSplineSurface) or "rounded" in fault.text:
            return False
        # By a curve in its parameters, a surface is used for the face on its other side, too.
        return number in self.model.users(fault.number, lambda user: is_face(user) or isinstance(user, StepGeom_Pcurve))

    def _places(self) -> Iterator[LostFace]:
        """Instances of products, and bare surfaces, that something harmless to any face has moved."""
        faulty = {fault.number for fault in self.harmless if fault.number and fault.parameter not in _WORDS}
        reported: set[int] = set()
        for number in sorted(faulty):
            users = [self.model.entities[n] for n in self.model.users(number) if n]
            place = next((user for user in users if isinstance(user, _PLACES)), None)
            if place is not None:
                at = self.model.number(place)
                if at not in reported:
                    reported.add(at)
                    yield LostFace(self.ident(at), "", self._cause("it may put a component in the wrong place", [number]))
            elif any(isinstance(user, StepGeom_Surface) for user in users) and any(
                isinstance(user, StepShape_GeometricSet) for user in users
            ):
                yield LostFace(self.ident(number), "", self._cause("a surface may not be as written", [number]))

    def _not_placed(self) -> Iterator[LostFace]:
        """Components of the assembly that are nowhere in what was read."""
        for number, entity in self.model.entities.items():
            if isinstance(entity, StepRepr_NextAssemblyUsageOccurrence) and number not in self.results:
                product = entity.RelatedProductDefinition()
                if product is None or self.model.number(product) in self.results:
                    name = text.ToCString() if (text := entity.Name()) is not None else ""
                    yield LostFace(self.ident(number), name, "a component of the assembly has not been placed")

    def _box(self, face: Any, place: TopLoc_Location) -> Any:
        corners = []
        for edge in _edges(face):
            for vertex in (edge.EdgeStart(), edge.EdgeEnd()) if hasattr(edge, "EdgeStart") else ():
                point = vertex.VertexGeometry() if hasattr(vertex, "VertexGeometry") else None
                if isinstance(point, StepGeom_CartesianPoint) and point.NbCoordinates() == 3:
                    xyz = gp_Pnt(*(self.scale * point.CoordinatesValue(i) for i in (1, 2, 3)))
                    corners.append(xyz.Transformed(place.Transformation()).Coord())
        if not corners:
            return None
        return tuple(tuple(f(axis) for axis in zip(*corners, strict=True)) for f in (min, max))
