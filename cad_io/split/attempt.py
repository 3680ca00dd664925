"""Faces with boundaries of their labels drawn on them, a part with all of them cut so and put together again, and its checks."""

import io
from collections import defaultdict
from collections.abc import Callable
from typing import Any

import numpy as np
from OCP.BinTools import BinTools
from OCP.BRep import BRep_Tool
from OCP.BRepBuilderAPI import BRepBuilderAPI_Copy
from OCP.TopAbs import TopAbs_FACE, TopAbs_SHELL, TopAbs_SOLID
from OCP.TopoDS import TopoDS

from cad_io.arrays import FaceLabels
from cad_io.face.uv_region import uv_areas
from cad_io.kernel import edges_of, explore, is_kernel_error, shape_map
from cad_io.kernel.shapes import as_one, compound
from cad_io.split.arrangement import Arrangement
from cad_io.split.border import Border, CannotSplit
from cad_io.split.build import Placed, pieces, rewired
from cad_io.split.contour import Line, curves, label_grid
from cad_io.split.net import Net, valid
from cad_io.split.regions import Judged, joined, judged, regions_of, slivers
from cad_io.surface import Surface

#: Fits of the drawn curves that are tried, cells of root mean square distance; the first one first.
FITS = (0.1, 0.05, 0.02)


class Drawing:
    """Where one face is to be split.

    Attributes
    ----------
    number : int
    face : TopoDS_Face
    surface : Surface
        The face's own.
    grid, known
        As of `label_grid`.
    lines : list of Line
        Along the boundaries of the labels; to be set before `plan`.
    found : Arrangement
    parts : list of Judged
        One for each piece.
    joined : int
        Slivers that went to the label around them.
    missed : int
        Nodes that have no piece of their label.
    fault : str
        Why the curves tried last are no good.
    """

    def __init__(self, face: Any, surface: Surface, labels: FaceLabels) -> None:
        self.number, self.face, self.surface = labels.face, face, surface
        self.grid, self.known, self._specks = label_grid(face, labels)
        self.lines: list[Line] = []
        self.parts: list[Judged] = []
        self.joined = self.missed = 0
        self._border: Border | None = None
        self.fault = ""
        self._tried = 0

    def plan(self, net: Net, worst: int) -> bool:
        """Plan pieces with the next fit that works; False if there is none, then `fault` says why.

        Parameters
        ----------
        net : Net
            Of the part.
        worst : int
            As in `split`.
        """
        while self._tried < len(FITS):
            self._tried += 1
            try:
                self._border = self._border or Border(self.face, self.surface, self.grid, net.edges, net.vertices)
                self._draw(self._border, FITS[self._tried - 1], net.at_end, worst)
                return True
            except Exception as error:
                self.fault = in_words(error)
                if self._border is None:
                    break  # no curve is to blame
        return False

    def renew(self) -> None:
        """Have `plan` look at the border anew and try the last fit again."""
        self._border, self._tried = None, max(self._tried - 1, 0)

    def places(self) -> list[tuple[int, float]]:
        """Where edges of the part are to be cut: number of the edge, parameter."""
        ends = (self.found.crossings[c] for c in self.found.used())
        return [(self.found.border.sides[c.side].key, c.s) for c in ends if c.end is None]

    def _draw(self, border: Border, fit: float, at_end: Callable[[int, float], int | None], worst: int) -> None:
        self.found = Arrangement(border, curves(self.grid, self.lines, fit), at_end)
        regions = regions_of(self.found)
        self.parts = judged(regions, border.scale, self.grid, self.known)
        # Some lie next to the border, and their boundary runs outside.
        missing = self._specks | ((self.known >= 0) & ~np.isin(self.known, [part.label for part in self.parts]))
        self.missed = int(missing.sum())
        group_kept, group, self.joined = slivers(self.found, self.parts, worst)
        if self.joined:
            self.found.keep(group_kept)
            self.parts = joined(self.parts, group, regions_of(self.found))


def in_words(error: Exception) -> str:
    """Why a face cannot be split; errors that are no such reason are raised again."""
    if isinstance(error, CannotSplit):
        return str(error)
    if is_kernel_error(error) or isinstance(error, ValueError | np.linalg.LinAlgError):
        return f"splitting it fails: {type(error).__name__} {error}".strip()
    raise error


#: Relative error of a face's parameter area that is still the same area.
_SAME_AREA = 1e-5


def wrong_pieces(face: Any, pieces: list[Any]) -> str:
    """Why pieces do not stand for a face, or nothing.

    Areas are those of the region in the parameter plane, integrated exactly along its boundary: pieces that tile the
    region there tile the face, and the kernel's own areas in mm2 are off by up to 9 % on some surfaces.
    """
    before, *areas = uv_areas([face, *pieces])
    if not all(area * before > 0 for area in areas):
        return "a piece of it has no area"
    if not abs(sum(areas) - before) <= _SAME_AREA * abs(before):
        return "its pieces do not have its area"
    return ""


def wrong_whole(before: Any, after: Any) -> str:
    """Why a shape with other faces does not stand for the one before, or nothing."""
    if _shells(before) != _shells(after):
        return "splitting changes solids or shells"
    return "splitting makes the shape invalid" if not valid(after) and valid(before) else ""


def _shells(shape: Any) -> tuple[int, list[bool]]:
    """Number of solids; closedness of all shells, sorted."""
    closed = [bool(BRep_Tool.IsClosed_s(shell)) for shell in explore(shape, TopAbs_SHELL)]
    return shape_map(shape, TopAbs_SOLID).Extent(), sorted(closed)


def copied(shape: Any, faces: dict[int, Any]) -> tuple[Any, dict[int, Any]]:
    """A copy of a shape, which may be changed, and of its faces; curves and surfaces are shared."""
    own = BRepBuilderAPI_Copy(shape, False, False).Shape()
    before, after = shape_map(shape, TopAbs_FACE), shape_map(own, TopAbs_FACE)
    return own, {n: TopoDS.Face_s(after.FindKey(before.FindIndex(face))) for n, face in faces.items()}


class Trial:
    """A component of a part, of which attempts are made; and what they may keep from each other.

    Attributes
    ----------
    given, base : TopoDS_Shape
        The component, to which results are compared, and a copy of it, which is mended.
    faces : dict
        Number -> TopoDS_Face, all faces of the copy.
    net : Net
        Of the copy.
    works_on : callable
        To be told the faces about which the kernel is asked next.
    careful : bool
        Ask about the validity of each face alone, also while the whole is valid.
    """

    def __init__(
        self,
        inputs: Any,
        base: Any,
        faces: dict[int, Any],
        surface_of: Callable[[int], Surface],
        works_on: Callable[[set[int]], None],
        careful: bool,
    ) -> None:
        """`surface_of` gives a face's surface by its number."""
        self.given, self.base, self.faces, self.works_on, self.careful = inputs, base, faces, works_on, careful
        known = shape_map(base, TopAbs_FACE)
        numbers = {known.FindIndex(face): n for n, face in faces.items()}
        self._surface_of = lambda i: surface_of(numbers[i])
        self.net = Net(base, self._surface_of)

    def copied(self) -> tuple[Any, dict[int, Any], Net]:
        """Copy the base: the copy, its faces by number, its net."""
        own, fresh = copied(self.base, self.faces)
        return own, fresh, Net(own, self._surface_of, self.net.off)


class Attempt:
    """A component with all its faces cut as they are drawn, on a copy: vertices of it get looser.

    Attributes
    ----------
    loose : dict
        Number of an edge -> how far it is off a face at the same parameter, mm, and the faces that cut it. Then nothing is built.
    wrong : dict
        Number of a face -> why it cannot be cut so. Then nothing is put together.
    """

    def __init__(self, trial: Trial, drawings: dict[int, Drawing]) -> None:
        """Try it; `drawings` by the number of the face."""
        self.wrong: dict[int, str] = {}
        self._placed: Placed | None = None
        self._works_on = works_on = trial.works_on
        own, fresh, net = trial.copied()
        self._net = net
        before = shape_map(trial.given, TopAbs_FACE)
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
        neighbours = self._neighbours(fresh)
        for number, cutters in neighbours.items():
            works_on(cutters)
            changed[number] = [rewired(net, fresh[number])]
        if trial.careful:
            self._ask(changed, neighbours)
        if self.wrong or not changed:
            return
        numbers = {net.faces.FindIndex(face): number for number, face in fresh.items()}
        self._placed = Placed(own, numbers, net.faces, changed)
        works_on(self._cut)
        if reason := wrong_whole(trial.given, as_one(self._placed.shapes)):
            self._ask(changed, neighbours)
            if not self.wrong:
                self.wrong = dict.fromkeys(self._cut, reason)

    def _neighbours(self, fresh: dict[int, Any]) -> dict[int, set[int]]:
        """Faces that stay whole and have edges that others cut, and those others."""
        cutters = {
            number: {n for e in edges_of(face) for n in self._cutters.get(self._net.edges.FindIndex(e), ())}
            for number, face in fresh.items()
            if number not in self._cut
        }
        return {number: those for number, those in cutters.items() if those}

    def _ask(self, changed: dict[int, list[Any]], neighbours: dict[int, set[int]]) -> None:
        """Find faces that are not valid, though they were, and whose fault that is."""
        for number, made in changed.items():
            cutters = neighbours.get(number, {number})
            self._works_on(cutters)
            if cutters & self.wrong.keys() or all(map(valid, made)) or not valid(self._given[number]):
                continue
            why = (
                f"with its edges cut there, F{number} next to it is not valid"
                if number in neighbours
                else "a piece of it is not valid"
            )
            self.wrong |= dict.fromkeys(cutters, why)

    def _pieces(self, number: int, face: Any, drawing: Drawing) -> list[Any]:
        arrangement, regions = drawing.found, [part.region for part in drawing.parts]
        mark = tuple(tuple(cut.stops) if (cut := self._net.cuts.get(side.key)) else () for side in arrangement.border.sides)
        try:
            made = pieces(self._net, face, drawing.surface, arrangement, regions)
            reason = "" if mark in arrangement.sound else wrong_pieces(face, made)
        except Exception as error:
            made, reason = [], in_words(error)
        if reason:
            self.wrong[number] = reason
        else:
            arrangement.sound.add(mark)
        return made

    def packed(self) -> tuple[list[int], bytes] | None:
        """Numbers of the faces, and the component with their pieces: sharing survives. None if nothing changed."""
        if self._placed is None:
            return None
        stream = io.BytesIO()
        shapes, faces = self._placed.shapes, self._placed.faces
        BinTools.Write_s(compound([compound(shapes), *map(compound, faces.values())]), stream)
        return list(faces), stream.getvalue()
