"""Cut all faces that can be cut, in a copy of the process that can be ended; what fails or hangs costs its own face alone.

Cost is linear in the length of the curves. Time decides nothing but whether a call of the kernel is endless, in processor
seconds (`cad_io.kernel.limited`): what comes out does not depend on how busy the machine is.
"""

import io
import math
import mmap
import os
import pickle
import time
from collections import defaultdict
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from OCP.BinTools import BinTools
from OCP.BRepBuilderAPI import BRepBuilderAPI_Copy
from OCP.TopAbs import TopAbs_FACE
from OCP.TopoDS import TopoDS, TopoDS_Shape

from cad_io.arrays import FaceLabels
from cad_io.kernel import edges_of, shape_map
from cad_io.kernel.components import as_one, children, components, compound
from cad_io.kernel.limited import ChildDied, TimeLimit, limited
from cad_io.split.build import Placed, pieces, rewired
from cad_io.split.check import valid, wrong_pieces, wrong_whole
from cad_io.split.contour import smoothed
from cad_io.split.drawing import Drawing, in_words
from cad_io.split.net import Net
from cad_io.surface import Surface

#: Why a face is not cut if the limit ended the work.
TOO_LONG = "splitting it takes too long"
#: Copies of the process that may hang or crash before the rest is left whole.
_HANGS = 3
#: Processor seconds that a node of the labels adds to the limit.
_A_NODE = 1e-4
#: Limit of a whole copy: that of so many faces, and a part of those of all of them.
_WHOLE, _EACH = 4, 0.2


@dataclass(slots=True)
class Found:
    """What came of it.

    Attributes
    ----------
    faces : dict
        Number of a face that changed -> TopoDS_Face list.
    labels : dict
        Number of a face that is cut -> label of each piece, and how many of its known nodes have which label.
    failed : dict
        Number -> why a face was not cut.
    specks, joined : dict
        Number -> nodes that were islands of one node; slivers that went to the label around them.
    """

    faces: dict[int, list[Any]] = field(default_factory=dict)
    labels: dict[int, list[tuple[int, dict[int, int]]]] = field(default_factory=dict)
    failed: dict[int, str] = field(default_factory=dict)
    specks: dict[int, int] = field(default_factory=dict)
    joined: dict[int, int] = field(default_factory=dict)


def cut_faces(
    shape: Any, faces: dict[int, Any], labels: dict[int, FaceLabels], worst: int, seconds: float
) -> tuple[Any, Found]:
    """Cut faces of a shape along the boundaries of their labels.

    Parameters
    ----------
    shape : TopoDS_Shape
        Left as it is.
    faces : dict
        Number -> TopoDS_Face, all faces of the shape.
    labels : dict
        Number -> FaceLabels, of the faces to cut.
    worst : int
        As in `split`.
    seconds : float
        Of processor time, after which the work on one face is taken for endless; more for fine grids.

    Returns
    -------
    shape : TopoDS_Shape
        Components that changed are copies; the shape itself if there is none.
    found : Found
    """
    lost: dict[int, str] = {}
    surfaces = {number: Surface(faces[number]) for number in labels}
    for number, surface in surfaces.items():
        # Once here: code that is yet to be compiled may wait for ever in a copy of the process.
        surface.first(labels[number].u[:1], labels[number].v[:1])
    for _ in range(_HANGS):
        rest = {number: each for number, each in labels.items() if number not in lost}
        if not rest:
            break
        watch = _Watch({number: seconds + _A_NODE * each.label.size for number, each in rest.items()})
        try:
            answer = limited(partial(_answer, shape, faces, rest, surfaces, worst, watch), watch.whole, processor=True)
        except (TimeLimit, ChildDied) as error:
            why = TOO_LONG if isinstance(error, TimeLimit) else f"splitting it fails: {error}"
            lost |= dict.fromkeys(watch.seen() & rest.keys() or rest, why)
            continue
        result, found = _unpacked(answer, shape)
        found.failed |= lost
        return result, found
    return shape, Found(failed=lost | {n: "too many other faces could not be split" for n in labels if n not in lost})


class _Watch:
    """Which faces a copy of the process works on, told to the one that waits for it; and how long it may."""

    def __init__(self, limits: dict[int, float]) -> None:
        self._limits = limits
        self.whole = _WHOLE * max(limits.values()) + _EACH * sum(limits.values())
        self._page = mmap.mmap(-1, 8 * (len(limits) + 1))

    def works_on(self, numbers: set[int]) -> None:
        """From now on, until it is told anew."""
        told = sorted(numbers & self._limits.keys())
        for i, number in enumerate((len(told), *told)):
            self._page[8 * i : 8 * i + 8] = number.to_bytes(8, "little")
        if hasattr(os, "fork") and told:
            import resource  # of systems that can fork

            _, hard = resource.getrlimit(resource.RLIMIT_CPU)
            most = time.process_time() + max(self._limits[n] for n in told)
            resource.setrlimit(resource.RLIMIT_CPU, (math.ceil(min(most, self.whole)), hard))

    def seen(self) -> set[int]:
        """What was told last."""
        numbers = [int.from_bytes(self._page[8 * i : 8 * i + 8], "little") for i in range(len(self._limits) + 1)]
        return set(numbers[1 : 1 + numbers[0]])


def _answer(
    shape: Any, faces: dict[int, Any], labels: dict[int, FaceLabels], surfaces: dict[int, Surface], worst: int, watch: _Watch
) -> bytes:
    """What `_unpacked` takes."""
    found = Found()
    drawings: dict[int, Drawing] = {}
    for number, mine in labels.items():
        watch.works_on({number})
        try:
            drawing = drawings[number] = Drawing(faces[number], surfaces[number], mine)
        except Exception as error:
            found.failed[number] = in_words(error)
            continue
        if drawing.specks:
            found.specks[number] = drawing.specks
    watch.works_on(set(drawings))
    for drawing, lines in zip(drawings.values(), smoothed([d.grid for d in drawings.values()]), strict=True):
        drawing.lines = lines
    wanted, net = set(drawings), Net(shape)
    while True:
        for number in sorted(wanted):
            watch.works_on({number})
            if reason := drawings[number].plan(net, worst):
                found.failed[number] = reason
                del drawings[number]
        attempt = _Attempt(shape, faces, drawings, watch)
        if not attempt.wrong:
            break
        wanted = attempt.wrong.keys() - attempt.hopeless
        found.failed |= attempt.wrong
        for number in attempt.hopeless:
            del drawings[number]
    found.labels = {n: [(part.label, part.counts) for part in d.parts] for n, d in drawings.items()}
    found.joined = {n: d.joined for n, d in drawings.items() if d.joined}
    found.failed = {n: why for n, why in found.failed.items() if n not in drawings}
    return pickle.dumps((attempt.packed(), found))


class _Attempt:
    """All faces of a part cut as they are drawn, on a copy of the part: vertices of it get looser.

    Attributes
    ----------
    wrong : dict
        Number of a face -> why it cannot be cut so.
    hopeless : set of int
        Faces among them that other curves would not help.
    """

    def __init__(self, shape: Any, faces: dict[int, Any], drawings: dict[int, Drawing], watch: _Watch) -> None:
        self.wrong: dict[int, str] = {}
        self.hopeless: set[int] = set()
        self._watch = watch
        own = BRepBuilderAPI_Copy(shape, False, False).Shape()
        net = self._net = Net(own)
        before = shape_map(shape, TopAbs_FACE)
        index = {number: before.FindIndex(face) for number, face in faces.items()}
        cutting = {n: d for n, d in drawings.items() if len(d.parts) > 1}
        places = {number: drawing.places() for number, drawing in cutting.items()}
        net.cut(place for mine in places.values() for place in mine)
        self._cutters: dict[int, set[int]] = defaultdict(set)
        for number, mine in places.items():
            for key, _ in mine:
                self._cutters[key].add(number)
        # Cut there, its neighbour across the edge would not be valid either; no other curve helps.
        for key, off in net.loose.items():
            self.hopeless |= self._cutters[key]
            self.wrong |= dict.fromkeys(self._cutters[key], f"an edge of it lies {off:.2g} mm off the face")
        changed: dict[int, list[Any]] = {}
        for number, drawing in cutting.items():
            if number not in self.wrong:
                watch.works_on({number})
                face = TopoDS.Face_s(net.faces.FindKey(index[number]))
                changed[number] = self._pieces(number, face, drawing)
        for number, at in index.items():
            if number not in cutting:
                face = TopoDS.Face_s(net.faces.FindKey(at))
                if (fresh := self._rewired(number, face)) is not None:
                    changed[number] = [fresh]
        self.units: list[Placed | None] = []
        if not self.wrong:
            numbers = {at: number for number, at in index.items()}
            for unit, old in zip(components(own), components(shape), strict=True):
                self.units.append(self._placed(unit, old, numbers, changed))

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

    def _rewired(self, number: int, face: Any) -> Any | None:
        """A neighbour of faces that are cut, with the cut edges; None if there is none of them."""
        cutters = {n for e in edges_of(face) for n in self._cutters.get(self._net.edges.FindIndex(e), ())}
        if not cutters:
            return None
        self._watch.works_on(cutters)
        fresh = rewired(self._net, face)
        if not cutters & self.wrong.keys() and not valid(fresh) and valid(face):
            self.wrong |= dict.fromkeys(cutters, f"with its edges cut there, F{number} beside it is not valid")
        return fresh

    def _placed(
        self, unit: Any, old: Any, numbers: dict[int, int], changed: dict[int, list[Any]]
    ) -> Placed | None:
        """A component again, if a face of it changed."""
        mine = shape_map(unit, TopAbs_FACE)
        within = {numbers[self._net.faces.FindIndex(mine.FindKey(i))] for i in range(1, mine.Extent() + 1)}
        if within.isdisjoint(changed):
            return None
        cut = {n for cutters in self._cutters.values() for n in cutters} | {n for n in changed if len(changed[n]) > 1}
        self._watch.works_on(within & cut)
        placed = Placed(unit, numbers, self._net.faces, changed)
        if reason := wrong_whole(old, as_one(placed.shapes)):
            self.wrong |= dict.fromkeys(within & cut, reason)
        return placed

    def packed(self) -> list[tuple[list[int], bytes] | None]:
        """Of each component that changed, the numbers of its faces, and it with their pieces: sharing survives."""
        out: list[tuple[list[int], bytes] | None] = []
        for unit in self.units:
            if unit is None:
                out.append(None)
                continue
            stream = io.BytesIO()
            BinTools.Write_s(compound([compound(unit.shapes), *map(compound, unit.faces.values())]), stream)
            out.append((list(unit.faces), stream.getvalue()))
        return out


def _unpacked(answer: bytes, shape: Any) -> tuple[Any, Found]:
    units, found = pickle.loads(answer)
    made: list[Any] = []
    for old, unit in zip(components(shape), units, strict=True):
        if unit is None:
            made.append(old)
            continue
        whole = TopoDS_Shape()
        BinTools.Read_s(whole, io.BytesIO(unit[1]))
        result, *groups = children(whole)
        made += children(result)
        found.faces |= {n: [TopoDS.Face_s(f) for f in children(g)] for n, g in zip(unit[0], groups, strict=True)}
    return (as_one(made) if any(units) else shape), found
