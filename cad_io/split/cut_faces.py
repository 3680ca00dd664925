"""Cut all faces that can be cut, in a copy of the process that can be ended; what fails or hangs costs its own face alone.

Cost is linear in the length of the curves. Time decides nothing but whether a call of the kernel is endless, in processor
seconds (`plan_cutters_base.forks`): what comes out does not depend on how busy the machine is.
"""

import io
import mmap
import os
import pickle
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from OCP.BinTools import BinTools
from OCP.TopAbs import TopAbs_FACE
from OCP.TopoDS import TopoDS, TopoDS_Shape

from cad_io.arrays import FaceLabels
from cad_io.kernel import shape_map
from cad_io.kernel.components import as_one, children, components
from cad_io.split.attempt import Attempt, Trial, copied
from cad_io.split.contour import smoothed
from cad_io.split.drawing import Drawing, in_words
from cad_io.split.repair import repair
from cad_io.surface import Surface
from plan_cutters_base.forks import ChildDied, TimeLimit, end_within, limited

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
    """This record holds the result of `cut_faces`."""

    #: Number of a face that changed -> TopoDS_Face list.
    faces: dict[int, list[Any]] = field(default_factory=dict)
    #: Number of a face that is cut -> label of each piece, and how many of its known nodes have which label.
    labels: dict[int, list[tuple[int, dict[int, int]]]] = field(default_factory=dict)
    #: Number -> why a face was not cut.
    failed: dict[int, str] = field(default_factory=dict)
    #: Number -> nodes that have no piece of their label; slivers that went to the label around them.
    missed: dict[int, int] = field(default_factory=dict)
    joined: dict[int, int] = field(default_factory=dict)


def cut_faces(
    shape: Any,
    faces: dict[int, Any],
    labels: dict[int, FaceLabels],
    surface_of: Callable[[int], Surface],
    worst: int,
    seconds: float,
) -> tuple[Any, CutFaces]:
    """Cut faces of a shape along the boundaries of their labels.

    Parameters
    ----------
    shape : TopoDS_Shape
        Left as it is.
    faces : dict
        Number -> TopoDS_Face, all faces of the shape.
    labels : dict
        Number -> FaceLabels, of the faces to cut.
    surface_of : callable
        A face's surface, by its number.
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
    if labels:
        # Here once, not in each copy: half a second.
        import scipy.interpolate
        import scipy.optimize  # noqa: F401
    failed: dict[int, str] = {}
    for number, each in labels.items():
        # Once here: code that is yet to be compiled may wait for ever in a copy of the process.
        surface_of(number).first(each.u[:1], each.v[:1])
    careful = False
    for _ in range(_HANGS):
        rest = {number: each for number, each in labels.items() if number not in failed}
        if not rest:
            break
        watch = _Watch({number: seconds * (1 + each.label.size / _NODES) for number, each in rest.items()})
        job = partial(_answer, shape, faces, rest, surface_of, worst, watch, careful)
        try:
            answer = limited(job, watch.whole, processor=True)
        except (TimeLimit, ChildDied) as error:
            seen = watch.seen() & rest.keys()
            if careful or len(seen) < 2:
                why = TOO_LONG if isinstance(error, TimeLimit) else f"splitting it fails: {error}"
                failed |= dict.fromkeys(seen or rest, why)
            careful = careful or len(seen) > 1
            continue
        result, pieces = _unpacked(answer, shape)
        pieces.failed |= failed
        return result, pieces
    return shape, CutFaces(failed=failed | {n: "too many other faces could not be split" for n in labels if n not in failed})


class _Watch:
    """Which faces a copy of the process works on, told to the one that waits for it; and how long it may."""

    def __init__(self, limits: dict[int, float]) -> None:
        self._limits = limits
        self.whole = _WHOLE * max(limits.values()) + _EACH * sum(limits.values())
        self._page = mmap.mmap(-1, 8 * (len(limits) + 1))

    def works_on(self, numbers: set[int]) -> None:
        """From now on, until it is told anew."""
        reported = sorted(numbers & self._limits.keys())
        for i, number in enumerate((len(reported), *reported)):
            self._page[8 * i : 8 * i + 8] = number.to_bytes(8, "little")
        if hasattr(os, "fork") and reported:
            end_within(max(self._limits[n] for n in reported))

    def seen(self) -> set[int]:
        """Return the numbers of the faces that the copy named last in `works_on`."""
        numbers = [int.from_bytes(self._page[8 * i : 8 * i + 8], "little") for i in range(len(self._limits) + 1)]
        return set(numbers[1 : 1 + numbers[0]])


def _answer(
    shape: Any,
    faces: dict[int, Any],
    labels: dict[int, FaceLabels],
    surface_of: Callable[[int], Surface],
    worst: int,
    watch: _Watch,
    careful: bool,
) -> bytes:
    """Cut the faces, and return the pickled result that `_unpacked` reads."""
    answer = CutFaces()
    base, faces = copied(shape, faces)
    drawings: dict[int, Drawing] = {}
    for number, mine in labels.items():
        watch.works_on({number})
        try:
            drawings[number] = Drawing(faces[number], surface_of(number), mine)
        except Exception as error:
            answer.failed[number] = in_words(error)
    watch.works_on(set(drawings))
    for drawing, lines in zip(drawings.values(), smoothed([d.grid for d in drawings.values()]), strict=True):
        drawing.lines = lines
    done: dict[int, Drawing] = {}
    units: list[tuple[list[int], bytes] | None] = []
    # Components share no edge: what is wrong with one is no reason to build the others again.
    for part_unit, unit in zip(components(shape), components(base), strict=True):
        inside = shape_map(unit, TopAbs_FACE)
        here = {n: face for n, face in faces.items() if inside.FindIndex(face)}
        in_component = {n: drawing for n, drawing in drawings.items() if n in here}
        trial = Trial(part_unit, unit, here, surface_of, watch.works_on, careful)
        units.append(_settled(trial, in_component, worst, answer).packed() if in_component else None)
        done |= in_component
    answer.labels = {n: [(part.label, part.counts) for part in d.parts] for n, d in done.items()}
    answer.missed = {n: d.missed for n, d in done.items() if d.missed}
    answer.joined = {n: d.joined for n, d in done.items() if d.joined}
    return pickle.dumps((units, answer))


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


def _unpacked(answer: bytes, shape: Any) -> tuple[Any, CutFaces]:
    units, pieces = pickle.loads(answer)
    made: list[Any] = []
    for old, unit in zip(components(shape), units, strict=True):
        if unit is None:
            made.append(old)
            continue
        whole = TopoDS_Shape()
        BinTools.Read_s(whole, io.BytesIO(unit[1]))
        result, *groups = children(whole)
        made += children(result)
        pieces.faces |= {n: [TopoDS.Face_s(f) for f in children(g)] for n, g in zip(unit[0], groups, strict=True)}
    return (as_one(made) if any(units) else shape), pieces
