"""Faults that the kernel's check finds in a loaded file, and entities that use them; whether a face came out as it was written.

The kernel's lists give entities by number and take them by number: its Python binding loses an entity that is handed
back to it. So everything here goes by number, from 1.
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
from OCP.TopAbs import TopAbs_EDGE, TopAbs_WIRE
from OCP.TopExp import TopExp
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS, TopoDS_Face

from cad_io.arrays import Floats
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


def by_number(faults: Iterable[Fault]) -> dict[int, list[Fault]]:
    """Faults of each entity."""
    numbered: dict[int, list[Fault]] = defaultdict(list)
    for fault in faults:
        numbered[fault.number].append(fault)
    return dict(numbered)


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
