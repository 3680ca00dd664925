"""Cut all faces that can be cut: everything in one go, and only where that fails, less and less at a time.

How often is counted in advance (`Effort`): what comes out does not depend on how busy the machine is. What remains of
time is a guard against calls of the kernel that never end, in processor seconds (`cad_io.kernel.limited`). Ended by it, one
call in two runs might do what it could not in the other only where it takes as long as the guard, minutes.
"""

from collections.abc import Callable, Hashable, Iterable
from dataclasses import dataclass
from typing import Any, Protocol

from OCP.BRepBuilderAPI import BRepBuilderAPI_Sewing
from OCP.TopAbs import TopAbs_FACE
from OCP.TopoDS import TopoDS

from cad_io.kernel import faces as faces_of
from cad_io.kernel import shape_map
from cad_io.kernel.components import components, compound
from cad_io.split.cut import FUZZY, TOO_LONG, Cut, Fault, Job, cut

#: Fits of the drawn curves that are tried, cells of root mean square distance; the first one first.
FITS = (0.1, 0.05, 0.2)
#: Into how many parts the spans of a face's surface are cut: a remedy for rough ones.
DENSITIES = (1, 4, 8)


#: Work above which a call gets more than the usual time, in proportion.
_USUAL = 10_000


@dataclass(slots=True)
class Effort:
    """What may still be tried on a part: counts, which are the same on any machine.

    Attributes
    ----------
    work : int
        Of the calls after the first of each shape, as `Job.work` counts it.
    hangs : int
        Calls that may run into the time limit.
    """

    work: int = 100_000
    hangs: int = 2

    def cut(self, jobs: list[Job], seconds: float) -> list[Cut | Fault]:
        """As `cut`, where there is effort left."""
        if self.work <= 0 or self.hangs <= 0:
            return [Fault(TOO_LONG if self.hangs <= 0 else "too many other splits were tried")] * len(jobs)
        wanted = sum(job.work for job in jobs)
        self.work -= wanted
        found = cut(jobs, seconds * max(1.0, wanted / _USUAL))
        self.hangs -= Fault(TOO_LONG) in found
        return found


class Drawing(Protocol):
    """Edges on a face that are to cut it."""

    edges: list[Any]

    def draw(self, fit: float) -> str:
        """Draw the edges anew; why that is not possible, or nothing."""

    def differs(self, pieces: list[Any]) -> str:
        """Why these pieces are not what was asked for, or nothing."""


@dataclass(slots=True)
class _Unit:
    """A component of the part, its faces by number, and the result."""

    shape: Any
    faces: dict[int, Any]
    cut: Cut | None = None


def cut_faces(
    shape: Any, faces: dict[int, Any], drawings: dict[int, Drawing], seconds: float, effort: Effort
) -> tuple[Any, dict[int, list[Any]], dict[int, str]]:
    """Cut faces of a shape along the edges drawn on them.

    Components of the shape (solids, shells, loose faces) are cut one by one. Where the cut of a component fails, its
    faces are halved until the ones that spoil it are found; those are tried with denser
    surfaces and other curves.

    Parameters
    ----------
    shape : TopoDS_Shape
    faces : dict
        Number -> TopoDS_Face, all faces of the shape.
    drawings : dict
        Number -> Drawing, of the faces to cut; drawn.
    seconds : float
        Of processor time, after which a call of the kernel is taken for endless.
    effort : Effort
        What may be tried; less afterwards.

    Returns
    -------
    shape : TopoDS_Shape
        Components that were cut are copies; the shape itself if there is none.
    pieces : dict
        Number -> list of TopoDS_Face, all faces.
    failed : dict
        Number -> why a face was not cut.
    """
    units = _units(shape, faces)
    failed: dict[int, str] = {}

    def attempt(jobs: list[Job], numbers: list[list[int]]) -> list[Cut | Fault]:
        found = effort.cut(jobs, seconds)
        for i, mine in enumerate(numbers):
            result = found[i]
            if isinstance(result, Cut):
                faults = (Fault(reason, n) for n in mine if (reason := drawings[n].differs(result.pieces[n])))
                found[i] = next(faults, result)
        return found

    asked = [(unit, [n for n in unit.faces if n in drawings]) for unit in units]
    asked = [(unit, numbers) for unit, numbers in asked if numbers]
    jobs = [Job(unit.shape, unit.faces, _edges(drawings, numbers)) for unit, numbers in asked]
    for (unit, numbers), result in zip(asked, attempt(jobs, [n for _, n in asked]), strict=True):
        if isinstance(result, Cut):
            unit.cut = result
        else:
            failed |= _rescue(unit, numbers, drawings, lambda job, numbers: attempt([job], [numbers])[0], result)

    pieces = {number: [face] for number, face in faces.items()}
    for unit in units:
        if unit.cut:
            pieces |= unit.cut.pieces
    if not any(unit.cut for unit in units):
        return shape, pieces, failed
    shapes = [unit.cut.shape if unit.cut else unit.shape for unit in units]
    return shapes[0] if len(shapes) == 1 else compound(shapes), pieces, failed


def _units(shape: Any, faces: dict[int, Any]) -> list[_Unit]:
    numbers = list(faces)
    known = shape_map(shape, TopAbs_FACE)
    units = []
    for part in components(shape):
        mine = {numbers[known.FindIndex(face) - 1]: face for face in faces_of(part)}
        units.append(_Unit(part, mine))
    return units


def _bases(unit: _Unit) -> list[tuple[Any, dict[int, Any]]]:
    """Shapes to try the cut on, with their faces by number."""
    bases = [(unit.shape, unit.faces)]
    if unit.shape.ShapeType() == TopAbs_FACE:
        # IGES closes a face with two edges in one place; the kernel splits it only with a true seam.
        sewing = BRepBuilderAPI_Sewing(FUZZY)
        sewing.Add(unit.shape)
        sewing.Perform()
        sewn = sewing.SewedShape()
        if sewn.ShapeType() == TopAbs_FACE:
            bases.append((sewn, {n: TopoDS.Face_s(sewn) for n in unit.faces}))
    return bases


def _edges(drawings: dict[int, Drawing], numbers: Iterable[int]) -> list[Any]:
    return [edge for n in numbers for edge in drawings[n].edges]


def _rescue(
    unit: _Unit, numbers: list[int], drawings: dict[int, Drawing], attempt: Callable[[Job, list[int]], Cut | Fault],
    first: Fault,
) -> dict[int, str]:  # fmt: skip
    """Cut as many of the faces as possible; why the others were not cut. `first`: why all of them could not be."""
    failed: dict[int, str] = {}
    bases = _bases(unit)
    done: list[int] = []
    rough: dict[int, int] = {}
    fits = dict.fromkeys(numbers, FITS[0])

    def way(group: list[int], base: int, dense: dict[int, int]) -> Hashable:
        return base, frozenset((n, fits[n]) for n in done + group), frozenset(dense.items())

    # What is left of a group when half of it is done is the same attempt again.
    tried = {way(numbers, 0, rough): first}
    groups = [numbers]
    while groups:
        group = groups.pop()
        alone = len(group) == 1
        faults = []
        ways = [(b, f, d) for f in FITS for d in DENSITIES for b in range(len(bases))] if alone else [(0, FITS[0], 1)]
        for base, fit, dense in ways:
            if alone:
                fits[group[0]] = fit
                if reason := drawings[group[0]].draw(fit):
                    faults.append(Fault(reason))
                    continue
            denser = rough | ({group[0]: dense} if dense > 1 else {})
            this = way(group, base, denser)
            if this in tried:
                faults.append(tried[this])
                continue
            found = attempt(Job(*bases[base], _edges(drawings, done + group), denser), done + group)
            if isinstance(found, Cut):
                unit.cut = found
                done += group
                rough = denser
                break
            tried[this] = found
            faults.append(found)
        else:
            culprit = faults[0].face
            if alone:
                failed[group[0]] = faults[0].reason
            elif culprit in group:
                groups += [[culprit], [n for n in group if n != culprit]]
            else:
                half = len(group) // 2
                groups += [group[half:], group[:half]]
    return failed
