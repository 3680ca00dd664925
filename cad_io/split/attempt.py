"""A part with all its faces cut as they are drawn, put together again and checked."""

import io
from collections import defaultdict
from collections.abc import Callable
from typing import Any

from OCP.BinTools import BinTools
from OCP.BRepBuilderAPI import BRepBuilderAPI_Copy
from OCP.TopAbs import TopAbs_FACE
from OCP.TopoDS import TopoDS

from cad_io.kernel import edges_of, shape_map
from cad_io.kernel.components import as_one, components, compound
from cad_io.split.build import Placed, pieces, rewired
from cad_io.split.check import valid, wrong_pieces, wrong_whole
from cad_io.split.drawing import Drawing, in_words
from cad_io.split.net import Net


def copied(shape: Any, faces: dict[int, Any]) -> tuple[Any, dict[int, Any]]:
    """A copy of a shape, which may be changed, and of its faces; curves and surfaces are shared."""
    own = BRepBuilderAPI_Copy(shape, False, False).Shape()
    before, after = shape_map(shape, TopAbs_FACE), shape_map(own, TopAbs_FACE)
    return own, {n: TopoDS.Face_s(after.FindKey(before.FindIndex(face))) for n, face in faces.items()}


class Attempt:
    """All faces of a part cut as they are drawn, on a copy of the part: vertices of it get looser.

    Attributes
    ----------
    loose : dict
        Number of an edge -> how far it is off a face at the same parameter, mm, and the faces that cut it. Then nothing is built.
    wrong : dict
        Number of a face -> why it cannot be cut so. Then nothing is put together.
    """

    def __init__(
        self,
        given: Any,
        base: Any,
        faces: dict[int, Any],
        drawings: dict[int, Drawing],
        works_on: Callable[[set[int]], None],
    ) -> None:
        """Try it: `given` is the part, to which the result is compared, `base` a copy of it and `faces` that one's faces."""
        self.wrong: dict[int, str] = {}
        self._works_on = works_on
        own, fresh = copied(base, faces)
        net = self._net = Net(own)
        before = shape_map(given, TopAbs_FACE)
        self._given = {n: TopoDS.Face_s(before.FindKey(net.faces.FindIndex(face))) for n, face in fresh.items()}
        self._cut = {n for n, drawing in drawings.items() if len(drawing.parts) > 1}
        places = {n: drawings[n].places() for n in sorted(self._cut)}
        net.cut(place for mine in places.values() for place in mine)
        self._cutters: dict[int, set[int]] = defaultdict(set)
        for number, mine in places.items():
            for key, _ in mine:
                self._cutters[key].add(number)
        self.loose = {key: (off, self._cutters[key]) for key, off in net.loose.items()}
        if self.loose:
            return
        changed: dict[int, list[Any]] = {}
        for number in sorted(self._cut):
            works_on({number})
            changed[number] = self._pieces(number, fresh[number], drawings[number])
        for number, face in fresh.items():
            if number not in self._cut and (new := self._rewired(number, face)) is not None:
                changed[number] = [new]
        self._units: list[Placed | None] = []
        if not self.wrong:
            numbers = {net.faces.FindIndex(face): number for number, face in fresh.items()}
            for unit, old in zip(components(own), components(given), strict=True):
                self._units.append(self._placed(unit, old, numbers, changed))

    def _pieces(self, number: int, face: Any, drawing: Drawing) -> list[Any]:
        regions = [part.region for part in drawing.parts]
        try:
            made = pieces(self._net, face, drawing.surface, drawing.found, regions)
            reason = wrong_pieces(drawing.face, made, self._given[number])
        except Exception as error:
            made, reason = [], in_words(error)
        if reason:
            self.wrong[number] = reason
        return made

    def _rewired(self, number: int, face: Any) -> Any | None:
        """A neighbour of faces that are cut, with the cut edges; None if there is none of them."""
        cutters = {n for e in edges_of(face) for n in self._cutters.get(self._net.edges.FindIndex(e), ())}
        if not cutters:
            return None
        self._works_on(cutters)
        fresh = rewired(self._net, face)
        if not cutters & self.wrong.keys() and not valid(fresh) and valid(self._given[number]):
            self.wrong |= dict.fromkeys(cutters, f"with its edges cut there, F{number} beside it is not valid")
        return fresh

    def _placed(self, unit: Any, old: Any, numbers: dict[int, int], changed: dict[int, list[Any]]) -> Placed | None:
        """A component again, if a face of it changed."""
        mine = shape_map(unit, TopAbs_FACE)
        within = {numbers[self._net.faces.FindIndex(mine.FindKey(i))] for i in range(1, mine.Extent() + 1)}
        if within.isdisjoint(changed):
            return None
        self._works_on(within & self._cut)
        placed = Placed(unit, numbers, self._net.faces, changed)
        if reason := wrong_whole(old, as_one(placed.shapes)):
            self.wrong |= dict.fromkeys(within & self._cut, reason)
        return placed

    def packed(self) -> list[tuple[list[int], bytes] | None]:
        """Of each component that changed, the numbers of its faces, and it with their pieces: sharing survives."""
        out: list[tuple[list[int], bytes] | None] = []
        for unit in self._units:
            if unit is None:
                out.append(None)
                continue
            stream = io.BytesIO()
            BinTools.Write_s(compound([compound(unit.shapes), *map(compound, unit.faces.values())]), stream)
            out.append((list(unit.faces), stream.getvalue()))
        return out
