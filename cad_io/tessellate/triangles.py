"""Triangles close to a part's surface, with the distance proved.

They start with a few in each face's parameter plane, to which gaps between them and the true ends of border curves are
added. Every triangle is cut until a bound says that it is near enough: the bound follows from how the surface and the border
curves bend about it, so nothing needs measuring but what only the kernel can evaluate.
"""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray
from OCP.BRepTools import BRepTools

from cad_io.arrays import Floats, Ints, Triangles
from cad_io.kernel import translated
from cad_io.part import Part
from cad_io.surface import Surface
from cad_io.tessellate.bounds import COARSE, FINE, MIDDLE, Ground, Table, table_of
from cad_io.tessellate.curves import Curves, packed, reach
from cad_io.tessellate.mesh import UVMesh
from cad_io.tessellate.refine import RefinedMesh, Start, refined
from cad_io.tessellate.start import At, expected, starts

#: Measured distances count this much larger, for what lies between the points measured.
MARGIN = 1.05
#: Where triangles are measured that must be: shares of their corners.
_MEASURED = np.array([(a, b, 4 - a - b) for a in range(5) for b in range(5 - a) if max(a, b, 4 - a - b) < 4]) / 4
#: Triangles measured at once.
_AT_ONCE = 1 << 16
#: How often a guess that does not hold is made again, and how much larger than measured.
_GUESSES, _LARGER = 6, 1.02

#: Triangles from which a table of so many cells takes less time than the triangles that it saves.
_FINER = ((400, MIDDLE), (8000, FINE))

Indices = NDArray[np.int64]


def workspace(triangles: int) -> RefinedMesh:
    """Room for so many triangles of a face, and as many nodes."""
    return RefinedMesh(np.empty((triangles, 2)), np.empty((triangles, 3), np.int64))


EMPTY = workspace(0)


class Laid(NamedTuple):
    """Finished triangles of a face: nodes (n, 3) in mm, corners (t, 3), the bound of their distance from it, mm, their area in
    the parameter plane, and whether they are all that it takes."""

    point: Floats
    corner: Indices
    off: float
    area: float
    whole: bool = True


class Patch(NamedTuple):
    """A face before its triangles are cut.

    proved: whether the bound of the table and the curves holds everywhere; else it is a guess, and distances are measured.
    """

    number: int
    surface: Surface
    start: Start
    ground: Ground
    table: Table
    curves: Curves
    proved: bool

    @staticmethod
    def of(part: Part, number: int, mesh: UVMesh, chord: float = np.inf) -> "Patch":
        """The patch of a face that begins with a mesh; for a chord error, mm, its bounds need not be much closer than that."""
        surface = part.surface(number)
        curves, exact = packed(
            [b.curve for b in mesh.border], [(float(b.parameter.min()), float(b.parameter.max())) for b in mesh.border]
        )
        curve, ends = _edges(mesh)
        start = Start(np.ascontiguousarray(mesh.uv), mesh.corner.astype(np.int64), curve, ends)
        low, high = reach(curves, mesh.uv, curve, ends)
        box = (low[0], high[0], low[1], high[1])
        ground = Ground.of(surface, box, chord)
        table, proved = table_of(ground)
        return Patch(number, surface, start, ground, table, curves, proved and exact)

    def begun(self, chord: float, most: int, workspace: RefinedMesh) -> tuple["Patch", "Tried"]:
        """The patch with a table as fine as is worth while for a chord error, and its triangles."""
        before = COARSE
        for many, cells in _FINER if self.ground.whole else ():
            tried = self.tried(chord, many, workspace)
            if tried.triangles <= many:
                return self, tried
            # Lines may be dense already.
            if any(len(a) > len(b) for a, b in zip(self.ground.finer(cells), self.ground.finer(before), strict=True)):
                self, before = self._replace(table=table_of(self.ground, cells)[0]), cells
        return self, self.tried(chord, most, workspace)

    def tried(self, chord: float, most: int, workspace: RefinedMesh) -> "Tried":
        """Triangles for a chord error, counted, and kept if there is room for them."""
        count, number, off, strayed, area = refined(self.start, self.table, self.curves, self._asked(chord), most, workspace)
        own = None
        if count <= min(most, len(workspace.corner)) and number <= len(workspace.uv):
            own = RefinedMesh(workspace.uv[:number].copy(), workspace.corner[:count].copy())
        return Tried(chord, count, number, own, off, strayed, area, count <= most)

    def _asked(self, chord: float) -> float:
        return chord if self.proved else chord / MARGIN

    def laid(self, tried: "Tried", most: int) -> Laid:
        """Triangles that were counted, and no more than `most` where that was a guess."""
        chord = tried.chord
        for guess in range(_GUESSES):
            mesh, off = tried.found, tried.off
            if mesh is None:
                mesh = RefinedMesh(np.empty((tried.nodes, 2)), np.empty((tried.triangles, 3), np.int64))
                refined(self.start, self.table, self.curves, self._asked(chord), tried.triangles, mesh)
            point = self.surface.values(mesh.uv[:, 0], mesh.uv[:, 1])
            if not self.proved:
                off = MARGIN * _measured(self.surface, mesh, point) + tried.strayed
            laid = Laid(point, mesh.corner, off, tried.area, tried.whole)
            if self.proved or off <= chord or not np.isfinite(off) or tried.triangles >= most or guess + 1 == _GUESSES:
                break
            self = self._replace(table=self.table._replace(node=_LARGER * off / chord * self.table.node))
            tried = self.tried(chord, most, EMPTY)
        return laid


class Tried(NamedTuple):
    """Triangles counted for a chord error, mm, kept or not, with what `refined` tells of them; whole: all were counted."""

    chord: float
    triangles: int
    nodes: int
    found: RefinedMesh | None
    off: float
    strayed: float
    area: float
    whole: bool


def _measured(surface: Surface, mesh: RefinedMesh, point: Floats) -> float:
    """Largest distance found between points of triangles and of the surface with the same parameters, mm."""
    worst = 0.0
    for first in range(0, len(mesh.corner), _AT_ONCE):
        corner = mesh.corner[first : first + _AT_ONCE]
        for share in _MEASURED:
            uv = np.einsum("c,tcx->tx", share, mesh.uv[corner])
            off = surface.values(uv[:, 0], uv[:, 1]) - np.einsum("c,tcx->tx", share, point[corner])
            # Not a number counts as far.
            worst = max(worst, float(np.nan_to_num(np.linalg.norm(off, axis=1), nan=np.inf).max(initial=0.0)))
    return worst


def _edges(mesh: UVMesh) -> tuple[Indices, Floats]:
    """`curve` and `ends` of a mesh's triangles, as in `Start`."""
    n = len(mesh.uv)
    curve, ends = np.full(mesh.corner.shape, -1, np.int64), np.zeros((*mesh.corner.shape, 2))
    if not mesh.border:
        return curve, ends
    keys, first, last = [], [], []
    for border in mesh.border:
        a, b = border.nodes[:-1].astype(np.int64), border.nodes[1:].astype(np.int64)
        keys.append(np.concatenate([a * n + b, b * n + a]))
        first.append(np.concatenate([border.parameter[:-1], border.parameter[1:]]))
        last.append(np.concatenate([border.parameter[1:], border.parameter[:-1]]))
    index = np.repeat(np.arange(len(keys)), [len(each) for each in keys])
    key = np.concatenate(keys)
    order = np.argsort(key, kind="stable")
    wanted = mesh.corner.astype(np.int64) * n + np.roll(mesh.corner, -1, axis=1)
    at = order[np.minimum(np.searchsorted(key, wanted, sorter=order), len(key) - 1)]
    hit = key[at] == wanted
    curve[hit] = index[at[hit]]
    ends[hit] = np.stack([np.concatenate(first), np.concatenate(last)], axis=1)[at[hit]]
    return curve, ends


#: The start is this much coarser than wanted: cutting is quicker, and halves twice each way go on evenly.
_COARSER = 16.0
#: A face is missing if more than this share of it has no triangles.
_UNCOVERED = 0.01
#: Times the budget at which counting ends; how much the chord error grows at least where the budget binds.
_TOO_MANY, _STEP = 4, 1.02
#: No smaller chord error is looked for where triangles fill so much of the budget, or so many have been tried; what is aimed at.
_FILLED, _AIMED, _TURNS = 0.95, 0.98, 5
#: Where the budget binds, all faces have a chord error that is up to so many times as large as asked. Where that is not enough,
#: or where faces with no more than such a share of the area are the cause, these have one of their own, and such a share of the
#: budget: few enough that each may stand as a body.
_ALIKE, _FEW, _OWN = 100.0, 0.05, 0.01
#: So many faces in a row that are too dear end the search for ones that are not.
_PATIENCE = 8
#: A face is loose if its bound is so many times the chord error of the others.
_LOOSE = 1.25
#: Triangles of a face that are kept as they are counted; more are counted first and laid then.
_LARGEST = 1 << 19

Item = TypeVar("Item")
Done = TypeVar("Done")


def _gathered(
    part: Part, patches: Sequence[Patch], laid: list[Laid], ends: Ints, chord: float
) -> tuple[Floats, NDArray[np.bool_], dict[int, float], dict[int, str]]:
    """Put the triangles of all faces into one array, and let go of `laid`.

    Returns vertex (ends[-1], 3, 3), those of a patch are the rows from its end to the next; which (ends[-1],) of them are finite;
    face number -> chord error, mm, of faces that are covered; face number -> why not, of the others.
    """
    vertex = np.empty((ends[-1], 3, 3))
    whole = np.ones(len(vertex), bool)
    off: dict[int, float] = {}
    missing: dict[int, str] = {}
    for patch, first, last in zip(patches, ends[:-1], ends[1:], strict=True):
        # One after the other, and let go: here memory is at its most.
        each, rows = laid.pop(0), slice(first, last)
        np.take(each.point, each.corner, axis=0, out=vertex[rows])
        if not np.isfinite(each.off) or not np.isfinite(each.point).all():
            whole[rows] = np.isfinite(vertex[rows]).all(axis=(1, 2))
            missing[patch.number] = "its surface cannot be evaluated everywhere"
            continue
        if not each.whole:
            missing[patch.number] = "it takes more triangles than the budget allows"
            continue
        off[patch.number] = each.off
        if uncovered := _uncovered(part, patch.number, each.area, chord):
            missing[patch.number] = f"its triangles leave up to {math.ceil(100.0 * uncovered)} % of it uncovered"
    return vertex, whole, off, missing


def tessellate(
    part: Part,
    chord: float,
    *,
    budget: int = 2_000_000,
    faces: Sequence[int] | None = None,
    jobs: int = 1,
    at: At = lambda who, face: None,
) -> Triangles:
    """Triangles whose distance from the surface is at most `chord`, mm; any mesh that the part's shape carries is removed.

    budget: most triangles, but for those that it begins with. Where it binds, a few faces are laid for a larger chord error, and
    `loose` says which, or all of them are, and `chord_error` says for which one. faces: numbers, default all. jobs: faces at a
    time; triangles do not depend on it. at: told who is at work, `kernel` or `own`, and at which face.

    `chord_error` bounds the distance between a point of a triangle and the point of the surface, or of the face's border, that
    has the same parameters. On the faces in `measured` it is the largest distance found there, with a margin for what lies
    between the points measured.
    """
    if not chord > 0:
        raise ValueError(f"the chord error must be positive, not {chord}")
    numbers = list(faces) if faces is not None else [f.number for f in part.faces]
    missing = {n: str(part.faces[n - 1].unjudged) for n in numbers if part.faces[n - 1].unjudged is not None}
    wanted = [n for n in numbers if n not in missing]
    with translated("meshing", file=part.file):
        BRepTools.Clean_s(part.shape)
        patches, guess, why = _begun(part, wanted, chord, budget, at)
        missing.update(why)
        patches, tried = _affordable(part, patches, (chord, guess), budget, jobs, at)
        most = min((each.chord for each in tried), default=chord)
        laid = []
        for patch, each in zip(patches, _each(lambda i: patches[i].laid(tried[i], budget), range(len(tried)), jobs), strict=True):
            at("own", patch.number)
            laid.append(each)
        tried.clear()
    ends = np.cumsum([0, *(len(each.corner) for each in laid)])
    vertex, whole, off, uncovered = _gathered(part, patches, laid, ends, chord)
    missing.update(uncovered)
    loose = {number: error for number, error in off.items() if error > _LOOSE * most}
    if len(loose) == len(off):
        # Nothing is closer: all of it is as close as it is.
        loose = {}
    face = np.repeat(np.array([patch.number for patch in patches], np.int32), np.diff(ends))
    rows = slice(None) if whole.all() else whole
    return Triangles(
        vertex=vertex[rows],
        face=face[rows],
        chord_error=max((error for number, error in off.items() if number not in loose), default=0.0),
        missing=tuple(sorted(missing.items())),
        measured=tuple(patch.number for patch in patches if not patch.proved),
        loose=tuple(sorted(loose.items())),
        errors=tuple(sorted(off.items())),
    )


def _begun(part: Part, numbers: Sequence[int], chord: float, budget: int, at: At) -> tuple[list[Patch], float, dict[int, str]]:
    """Patches of faces, the chord error for which the budget is expected to do, and why a face has no patch."""
    guess, size = chord, float(np.linalg.norm(part.size))
    while (count := expected(part, numbers, guess)) > budget and guess < size:
        guess *= max(_STEP, count / budget)
    meshes, why = starts(part, numbers, _COARSER * guess, at)
    patches = []
    for number in list(meshes):
        at("own", number)
        patches.append(Patch.of(part, number, meshes.pop(number), chord))
    return patches, guess, why


def _affordable(
    part: Part, patches: Sequence[Patch], requested: tuple[float, float], budget: int, jobs: int, at: At
) -> tuple[list[Patch], list[Tried]]:
    """Patches with tables as fine as is worth while, and triangles of each that are within the budget: for the chord error that
    was requested where that is possible, else for the smallest ones found; `requested`: the chord error asked for, and the one at
    which to begin to look."""
    finer, tried = _alike(part, patches, requested, budget, jobs, at)
    least, chord = requested[0], max((each.chord for each in tried), default=requested[0])
    if chord <= least or len(finer) < 2:
        return finer, tried
    # A face costs so many triangles for its area: those that cost least are laid as close as was asked.
    area = np.array([part.faces[patch.number - 1].area for patch in finer])
    cost = np.array([each.triangles for each in tried]) / np.maximum(area, np.finfo(float).tiny)
    close: dict[int, Tried] = {}
    own_budget = max(1, int(_OWN * budget))
    remaining, dear = budget - own_budget, 0
    for i in np.argsort(cost, kind="stable").tolist():
        each = finer[i].tried(least, remaining, EMPTY)
        dear = dear + 1 if each.triangles > remaining else 0
        if dear > _PATIENCE:
            break
        if not dear:
            close[i], remaining = each, remaining - each.triangles
    loose = [i for i in range(len(finer)) if i not in close]
    if not close or not loose or (area[loose].sum() > _FEW * area.sum() and chord <= _ALIKE * least):
        return finer, tried
    # Begun anew: what was begun for all of the budget may be finer than their own one allows.
    row = {finer[i].number: i for i in loose}
    begun, guess, why = _begun(part, list(row), least, own_budget, at)
    begun += [finer[row[number]] for number in why]
    for patch, each in zip(*_alike(part, begun, (least, guess), own_budget, jobs, at), strict=True):
        finer[row[patch.number]], close[row[patch.number]] = patch, each
    return finer, [close[i] for i in range(len(finer))]


def _alike(
    part: Part, patches: Sequence[Patch], requested: tuple[float, float], budget: int, jobs: int, at: At
) -> tuple[list[Patch], list[Tried]]:
    """Patches with tables as fine as is worth while, and triangles of each for the smallest chord error found, one for all, at
    which they are within the budget; `requested` as above."""
    size, most = float(np.linalg.norm(part.size)), _TOO_MANY * budget
    # Room to work in: one for each thread.
    workspaces = [workspace(min(budget, _LARGEST)) for _ in range(jobs)]
    least, chord = requested

    def work(how: Callable[[float, int, RefinedMesh], Done]) -> Done:
        mine = workspaces.pop()
        try:
            return how(chord, most, mine if total <= budget else EMPTY)
        finally:
            workspaces.append(mine)

    finer, tried, total = [], [], 0
    for patch, each in _each(lambda patch: work(patch.begun), patches, jobs):
        at("own", patch.number)
        finer.append(patch)
        tried.append(each)
        total += each.triangles
    over, within, turn = 0.0, math.inf, 0
    while True:
        if total <= budget:
            within, best = chord, tried
        else:
            over = chord
        turn += 1
        if within <= max(least, _STEP * over) or (within < math.inf and (turn > _TURNS or total >= _FILLED * budget)):
            return finer, best
        if over > size:
            return finer, tried
        # Their number falls about as the chord error grows.
        chord *= total / (_AIMED * budget)
        chord = min(max(least, chord, _STEP**0.5 * over), within * _STEP**-0.5)
        tried, total = [], 0
        for each in _each(lambda patch: work(patch.tried), finer, jobs):
            tried.append(each)
            total += each.triangles
            if total > most and chord <= size:
                break


def _each(work: Callable[[Item], Done], items: Iterable[Item], jobs: int) -> Iterator[Done]:
    """Yield the result of `work` for each item, in order, `jobs` at a time; if the caller stops, items not begun are dropped."""
    if jobs == 1:
        yield from map(work, items)
        return
    with ThreadPoolExecutor(jobs) as pool:
        try:
            for future in [pool.submit(work, item) for item in items]:
                yield future.result()
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise


def _uncovered(part: Part, number: int, area: float, chord: float) -> float:
    """Share of a face that its triangles leave out, by their area in the parameter plane; 0 if it is but a sliver."""
    trim = part.trim(number)
    if trim is None or not trim.closed:
        return 0.0
    share = 1.0 - area / trim.uv_area if trim.uv_area > 0 else 0.0
    border = float(np.linalg.norm((trim.segments[:, 1] - trim.segments[:, 0]) * trim.scale, axis=1).sum())
    return share if share > _UNCOVERED and share * part.faces[number - 1].area > 2 * chord * border else 0.0
