"""Cut all faces that can be cut, in a copy of the process that can be ended; what fails or hangs costs its own face alone.

Boundaries of labels are drawn on faces in the parameter plane, with the first fit that works; a part with all of them cut so is
put together again and checked: whether what was built can be trusted.

Cost is linear in the length of the curves. Time decides nothing but whether a call of the kernel is endless, in processor
seconds (`plan_cutters_base.forks`): what comes out does not depend on how busy the machine is.
"""

import mmap
import os
from collections import defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepBuilderAPI import BRepBuilderAPI_Copy
from OCP.TopAbs import TopAbs_FACE, TopAbs_SHELL, TopAbs_SOLID
from OCP.TopoDS import TopoDS

from cad_io.arrays import FaceLabels
from cad_io.face.trim import uv_areas
from cad_io.kernel import edges_of, explore, is_kernel_error, shape_map
from cad_io.kernel.shapes import as_bytes, as_one, children, components, compound, of_bytes
from cad_io.split.arrangement import Arrangement, Judged, joined, judged, regions_of, slivers
from cad_io.split.border import Border, CannotSplit
from cad_io.split.build import Net, pieces, placed, repair, rewired, valid
from cad_io.split.contour import Line, curves, label_grid, smoothed
from cad_io.surface import Surface
from plan_cutters_base.forks import ChildDied, TimeLimit, end_within, limited

#: Fits of the drawn curves that are tried, cells of root mean square distance; the first one first.
FITS = (0.1, 0.05, 0.02)


class Drawing:
    """Where one face is to be split.

    grid, known: as of `label_grid`. lines: along the boundaries of the labels; to be set before `plan`. parts: one for each
    piece. joined: slivers that went to the label around them. missed: nodes that have no piece of their label. fault: why the
    curves tried last are no good.
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
        """Plan pieces with the next fit that works; False if there is none, then `fault` says why. `worst` is as in `split`."""
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


#: The numbers of the faces of a component, and the component with their pieces, as bytes.
_Packed = tuple[list[int], bytes]
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

    def shells(shape: Any) -> tuple[int, list[bool]]:
        """Number of solids; closedness of all shells, sorted."""
        closed = [bool(BRep_Tool.IsClosed_s(shell)) for shell in explore(shape, TopAbs_SHELL)]
        return shape_map(shape, TopAbs_SOLID).Extent(), sorted(closed)

    if shells(before) != shells(after):
        return "splitting changes solids or shells"
    return "splitting makes the shape invalid" if not valid(after) and valid(before) else ""


def copied(shape: Any, faces: dict[int, Any]) -> tuple[Any, dict[int, Any]]:
    """A copy of a shape, which may be changed, and of its faces; curves and surfaces are shared."""
    own = BRepBuilderAPI_Copy(shape, False, False).Shape()
    before, after = shape_map(shape, TopAbs_FACE), shape_map(own, TopAbs_FACE)
    return own, {n: TopoDS.Face_s(after.FindKey(before.FindIndex(face))) for n, face in faces.items()}


@dataclass
class Trial:
    """A component of a part, of which attempts are made; and what they may keep from each other.

    given, base: the component, to which results are compared, and a copy of it, which is repaired. faces: number -> TopoDS_Face,
    all faces of the copy. surface_of: gives a face's surface by its number. net: of the copy. works_on: to be told the faces
    about which the kernel is asked next. careful: ask about the validity of each face alone, also while the whole is valid.
    """

    given: Any
    base: Any
    faces: dict[int, Any]
    surface_of: Callable[[int], Surface]
    works_on: Callable[[set[int]], None]
    careful: bool

    def __post_init__(self) -> None:
        known = shape_map(self.base, TopAbs_FACE)
        numbers = {known.FindIndex(face): n for n, face in self.faces.items()}
        self._in_net = lambda i: self.surface_of(numbers[i])
        self.net = Net(self.base, self._in_net)

    def copied(self) -> tuple[Any, dict[int, Any], Net]:
        """Copy the base: the copy, its faces by number, its net."""
        own, fresh = copied(self.base, self.faces)
        return own, fresh, Net(own, self._in_net, self.net.off)


class Attempt:
    """A component with all its faces cut as they are drawn, on a copy: vertices of it get looser.

    loose: number of an edge -> how far it is off a face at the same parameter, mm, and the faces that cut it; then nothing is
    built. wrong: number of a face -> why it cannot be cut so; then nothing is put together.
    """

    def __init__(self, trial: Trial, drawings: dict[int, Drawing]) -> None:
        """Try it; `drawings` by the number of the face."""
        self.wrong: dict[int, str] = {}
        self._placed: tuple[list[Any], dict[int, list[Any]]] | None = None
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
        self._placed = placed(own, numbers, net.faces, changed)
        works_on(self._cut)
        if reason := wrong_whole(trial.given, as_one(self._placed[0])):
            self._ask(changed, neighbours)
            if not self.wrong:
                self.wrong = dict.fromkeys(self._cut, reason)

    def _neighbours(self, fresh: dict[int, Any]) -> dict[int, set[int]]:
        """Faces that stay whole and have edges that others cut, and those others."""
        whole = {number: edges_of(face) for number, face in fresh.items() if number not in self._cut}
        cutters = {i: {n for e in es for n in self._cutters.get(self._net.edges.FindIndex(e), ())} for i, es in whole.items()}
        return {number: those for number, those in cutters.items() if those}

    def _ask(self, changed: dict[int, list[Any]], neighbours: dict[int, set[int]]) -> None:
        """Find faces that are not valid, though they were, and whose fault that is."""
        for number, made in changed.items():
            cutters = neighbours.get(number, {number})
            self._works_on(cutters)
            if cutters & self.wrong.keys() or all(map(valid, made)) or not valid(self._given[number]):
                continue
            next_to = f"with its edges cut there, F{number} next to it is not valid"
            self.wrong |= dict.fromkeys(cutters, next_to if number in neighbours else "a piece of it is not valid")

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

    def packed(self) -> _Packed | None:
        """Numbers of the faces, and the component with their pieces: sharing survives. None if nothing changed."""
        if self._placed is None:
            return None
        shapes, faces = self._placed
        return list(faces), as_bytes(compound([compound(shapes), *map(compound, faces.values())]))


#: Why a face is not cut if the limit ended the work.
TOO_LONG = "splitting it takes too long"
#: Copies of the process that may hang or crash before the rest is left whole.
_HANGS = 3
#: Nodes of the labels that double the limit.
_NODES = 50_000
#: Limit of a whole copy: that of so many faces, and a part of those of all of them.
_WHOLE, _EACH = 4, 0.2


@dataclass(slots=True)
class CutFaces:
    """The result of `cut_faces`."""

    #: Number of a face that changed -> TopoDS_Face list.
    faces: dict[int, list[Any]] = field(default_factory=dict)
    #: Number of a face that is cut -> label of each piece, and how many of its known nodes have which label.
    labels: dict[int, list[tuple[int, dict[int, int]]]] = field(default_factory=dict)
    #: Number -> why a face was not cut.
    failed: dict[int, str] = field(default_factory=dict)
    #: Number -> nodes that have no piece of their label; slivers that went to the label around them.
    missed: dict[int, int] = field(default_factory=dict)
    joined: dict[int, int] = field(default_factory=dict)


class Job(NamedTuple):
    """Faces to cut (by number, all of a shape, those that have labels), their surfaces by number, and `worst` as in `split`."""

    shape: Any
    faces: dict[int, Any]
    labels: dict[int, FaceLabels]
    surface_of: Callable[[int], Surface]
    worst: int


def cut_faces(job: Job, seconds: float) -> tuple[Any, CutFaces]:
    """Cut faces along the boundaries of their labels; the shape is left as it is.

    seconds: of processor time, after which the work on one face is taken for endless; more for fine grids. Components that
    changed are copies; it is the shape itself if there is none.
    """
    labels = job.labels
    if labels:
        # Here once, not in each copy: half a second.
        import scipy.interpolate
        import scipy.optimize  # noqa: F401
    failed: dict[int, str] = {}
    for number, each in labels.items():
        # Once here: code that is yet to be compiled may wait for ever in a copy of the process.
        job.surface_of(number).first(each.u[:1], each.v[:1])
    careful = False
    for _ in range(_HANGS):
        rest = {number: each for number, each in labels.items() if number not in failed}
        if not rest:
            break
        watch = _Watch({number: seconds * (1 + each.label.size / _NODES) for number, each in rest.items()})
        try:
            work = partial(_answer, job._replace(labels=rest), watch, careful)
            units, pieces = limited(work, watch.whole, processor=True)
        except (TimeLimit, ChildDied) as error:
            seen = watch.seen() & rest.keys()
            if careful or len(seen) < 2:
                why = TOO_LONG if isinstance(error, TimeLimit) else f"splitting it fails: {error}"
                failed |= dict.fromkeys(seen or rest, why)
            careful = careful or len(seen) > 1
            continue
        result = _unpacked(units, pieces, job.shape)
        pieces.failed |= failed
        return result, pieces
    return job.shape, CutFaces(failed=failed | {n: "too many other faces could not be split" for n in labels if n not in failed})


class _Watch:
    """Which faces a copy of the process works on, told to the one that waits for it; and how long it may."""

    def __init__(self, limits: dict[int, float]) -> None:
        self._limits = limits
        self.whole = _WHOLE * max(limits.values()) + _EACH * sum(limits.values())
        #: In memory that both share: how many they are, and their numbers.
        self._page = np.frombuffer(mmap.mmap(-1, 8 * (len(limits) + 1)), np.int64)

    def works_on(self, numbers: set[int]) -> None:
        """From now on, until it is told anew."""
        reported = sorted(numbers & self._limits.keys())
        self._page[: len(reported) + 1] = len(reported), *reported
        if hasattr(os, "fork") and reported:
            end_within(max(self._limits[n] for n in reported))

    def seen(self) -> set[int]:
        """Return the numbers of the faces that the copy named last in `works_on`."""
        return set(self._page[1 : 1 + self._page[0]].tolist())


def _answer(job: Job, watch: _Watch, careful: bool) -> tuple[list[_Packed | None], CutFaces]:
    """Cut the faces: the packed components, which `_unpacked` reads, and all else."""
    answer = CutFaces()
    base, faces = copied(job.shape, job.faces)
    drawings: dict[int, Drawing] = {}
    for number, mine in job.labels.items():
        watch.works_on({number})
        try:
            drawings[number] = Drawing(faces[number], job.surface_of(number), mine)
        except Exception as error:
            answer.failed[number] = in_words(error)
    watch.works_on(set(drawings))
    for drawing, lines in zip(drawings.values(), smoothed([d.grid for d in drawings.values()]), strict=True):
        drawing.lines = lines
    done: dict[int, Drawing] = {}
    units: list[_Packed | None] = []
    # Components share no edge: what is wrong with one is no reason to build the others again.
    for part_unit, unit in zip(components(job.shape), components(base), strict=True):
        inside = shape_map(unit, TopAbs_FACE)
        here = {n: face for n, face in faces.items() if inside.FindIndex(face)}
        in_component = {n: drawing for n, drawing in drawings.items() if n in here}
        trial = Trial(part_unit, unit, here, job.surface_of, watch.works_on, careful)
        units.append(_settled(trial, in_component, job.worst, answer).packed() if in_component else None)
        done |= in_component
    answer.labels = {n: [(part.label, part.counts) for part in d.parts] for n, d in done.items()}
    answer.missed = {n: d.missed for n, d in done.items() if d.missed}
    answer.joined = {n: d.joined for n, d in done.items() if d.joined}
    return units, answer


def _settled(trial: Trial, drawings: dict[int, Drawing], worst: int, result: CutFaces) -> Attempt:
    """The first attempt at which nothing is wrong; drawings that cannot be cut are taken out, and why is put down."""
    net, faces = trial.net, trial.faces
    wanted, repaired = set(drawings), set[int]()
    while True:
        for number in sorted(wanted):
            trial.works_on({number})
            if not drawings[number].plan(net, worst):
                result.failed[number] = drawings.pop(number).fault
        attempt = Attempt(trial, drawings)
        wanted = set(attempt.wrong)
        for number, why in attempt.wrong.items():
            drawings[number].fault = why
        for key, (off, cutters) in attempt.loose.items():
            trial.works_on(cutters)
            if key not in repaired:
                repaired.add(key)
                repair(net, key)
                net.forget(key)
                users = {net.faces.FindIndex(face) for face, _ in net.users(key)}
                concerned = {n for n in drawings if net.faces.FindIndex(faces[n]) in users}
                for number in concerned:
                    drawings[number].renew()
                wanted |= concerned
                continue
            # Cut there, its neighbour across the edge would not be valid either; no other curve helps.
            for number in cutters & drawings.keys():
                result.failed[number] = f"an edge of it lies {off:.2g} mm off the face"
                del drawings[number]
        wanted &= drawings.keys()
        if not (attempt.loose or attempt.wrong):
            return attempt


def _unpacked(units: Sequence[_Packed | None], pieces: CutFaces, shape: Any) -> Any:
    """The whole of its components, cut or as they were; `pieces` takes the faces."""
    made: list[Any] = []
    for old, unit in zip(components(shape), units, strict=True):
        if unit is None:
            made.append(old)
            continue
        result, *groups = children(of_bytes(unit[1]))
        made += children(result)
        pieces.faces |= {n: [TopoDS.Face_s(f) for f in children(g)] for n, g in zip(unit[0], groups, strict=True)}
    return as_one(made) if any(units) else shape
