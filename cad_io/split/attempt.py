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
from cad_io.surface import Surface


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
        surface_of: Callable[[int], Surface],
        works_on: Callable[[set[int]], None],
        careful: bool,
    ) -> None:
        """Try it.

        Parameters
        ----------
        given : TopoDS_Shape
            The part, to which the result is compared.
        base : TopoDS_Shape
            A copy of it.
        faces : dict
            Number -> TopoDS_Face, all faces of the copy.
        drawings : dict
            Number -> Drawing.
        surface_of : callable
            A face's surface, by its number among the faces of the copy.
        works_on : callable
            To be told the faces about which the kernel is asked next.
        careful : bool
            Ask about the validity of each face alone, also while the whole is valid.
        """
        self.wrong: dict[int, str] = {}
        self._works_on = works_on
        own, fresh = copied(base, faces)
        net = self._net = Net(own, surface_of)
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
        beside: dict[int, set[int]] = {}
        for number, face in fresh.items():
            cutters = {n for e in edges_of(face) for n in self._cutters.get(net.edges.FindIndex(e), ())}
            if number not in self._cut and cutters:
                beside[number] = cutters
                works_on(cutters)
                changed[number] = [rewired(net, face)]
        if careful:
            self._ask(changed, beside)
        self._units: list[Placed | None] = []
        if self.wrong:
            return
        numbers = {net.faces.FindIndex(face): number for number, face in fresh.items()}
        for unit, old in zip(components(own), components(given), strict=True):
            mine = shape_map(unit, TopAbs_FACE)
            within = {numbers[net.faces.FindIndex(mine.FindKey(i))] for i in range(1, mine.Extent() + 1)}
            self._units.append(None if within.isdisjoint(changed) else Placed(unit, numbers, net.faces, changed))
            if (placed := self._units[-1]) is None:
                continue
            works_on(within & self._cut)
            if reason := wrong_whole(old, as_one(placed.shapes)):
                known = len(self.wrong)
                self._ask({n: changed[n] for n in within & changed.keys()}, beside)
                if len(self.wrong) == known:
                    self.wrong |= dict.fromkeys(within & self._cut, reason)

    def _ask(self, changed: dict[int, list[Any]], beside: dict[int, set[int]]) -> None:
        """Find faces that are not valid, though they were, and whose fault that is."""
        for number, made in changed.items():
            cutters = beside.get(number, {number})
            self._works_on(cutters)
            if cutters & self.wrong.keys() or all(map(valid, made)) or not valid(self._given[number]):
                continue
            why = (
                f"with its edges cut there, F{number} beside it is not valid"
                if number in beside
                else "a piece of it is not valid"
            )
            self.wrong |= dict.fromkeys(cutters, why)

    def _pieces(self, number: int, face: Any, drawing: Drawing) -> list[Any]:
        regions = [part.region for part in drawing.parts]
        try:
            made = pieces(self._net, face, drawing.surface, drawing.found, regions)
            reason = wrong_pieces(drawing.face, made)
        except Exception as error:
            made, reason = [], in_words(error)
        if reason:
            self.wrong[number] = reason
        return made

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
