"""Triangles close to a part's surface, with the distance proved.

They start with a few in each face's parameter plane, to which gaps between them and the true ends of border curves are added. Every triangle is cut until a bound says that it is near enough: the bound follows from how
the surface and the border curves bend about it, so nothing needs measuring but what only the kernel can evaluate.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from typing import TypeVar

import numpy as np
from OCP.BRepTools import BRepTools

from cad_io.arrays import Triangles
from cad_io.kernel import translated
from cad_io.part import Part
from cad_io.tessellate.mesh import UVMesh
from cad_io.tessellate.patch import NO_ROOM, Patch, Tried, room
from cad_io.tessellate.refine import Found
from cad_io.tessellate.start import At, starts

#: The start is this much coarser than wanted: cutting is quicker, and halves twice each way go on evenly.
_COARSER = 16.0
#: Triangles of a start that is coarse enough, whatever the budget.
_FEW = 16
#: A face is missing if more than this share of it has no triangles.
_UNCOVERED = 0.01
#: Times the budget at which counting ends; how much the chord error grows at least where the budget binds.
_TOO_MANY, _STEP = 4, 1.02
#: Triangles of a face that are kept as they are counted; more are counted first and laid then.
_ROOM = 1 << 19

Item = TypeVar("Item")
Done = TypeVar("Done")


def tessellate(
    part: Part, chord: float, *, budget: int = 2_000_000, faces: Sequence[int] | None = None,
    jobs: int = 1, at: At = lambda who, face: None,
) -> Triangles:  # fmt: skip
    """Triangles whose distance from the surface is at most `chord`.

    Parameters
    ----------
    part : Part
        Any mesh that its shape carries is removed.
    chord : float
        mm, positive.
    budget : int
        Most triangles, but for those that it begins with. Where it binds, all are laid for a larger chord
        error, and `chord_error` says which.
    faces : sequence of int, optional
        Face numbers; default all.
    jobs : int, optional
        Faces at a time. Triangles do not depend on it.
    at : callable, optional
        Told who is at work, `kernel` or `own`, and at which face.

    Returns
    -------
    Triangles
        `chord_error` bounds the distance between a point of a triangle and the point of the surface, or of the face's
        border, that has the same parameters. On the faces in `measured` it is the largest distance found there, with a
        margin for what lies between the points measured.
    """
    if not chord > 0:
        raise ValueError(f"the chord error must be positive, not {chord}")
    numbers = list(faces) if faces is not None else [f.number for f in part.faces]
    missing = {n: str(part.faces[n - 1].unjudged) for n in numbers if part.faces[n - 1].unjudged is not None}
    wanted = [n for n in numbers if n not in missing]
    with translated("meshing", file=part.file):
        meshes, why = _started(part, wanted, chord, budget, at)
        missing.update(why)
        patches = []
        for number in list(meshes):
            at("own", number)
            patches.append(Patch.of(part, number, meshes.pop(number)))
        patches, tried = _affordable(part, patches, chord, budget, jobs, at)
        laid = []
        for patch, each in zip(
            patches, _each(lambda i: patches[i].laid(tried[i], budget), range(len(tried)), jobs), strict=True
        ):
            at("own", patch.number)
            laid.append(each)
        tried.clear()
    ends = np.cumsum([0, *(len(each.corner) for each in laid)])
    vertex = np.empty((ends[-1], 3, 3))
    whole = np.ones(len(vertex), bool)
    off = 0.0
    for patch, first, last in zip(patches, ends[:-1], ends[1:], strict=True):
        # One after the other, and let go: here memory is at its most.
        each, rows = laid.pop(0), slice(first, last)
        np.take(each.point, each.corner, axis=0, out=vertex[rows])
        if not np.isfinite(each.off) or not np.isfinite(each.point).all():
            whole[rows] = np.isfinite(vertex[rows]).all(axis=(1, 2))
            missing[patch.number] = "its surface cannot be evaluated everywhere"
            continue
        off = max(off, each.off)
        if left := _uncovered(part, patch.number, each.area, chord):
            missing[patch.number] = f"its triangles leave {100 * left:.0f} % of it uncovered"
    face = np.repeat(np.array([patch.number for patch in patches], np.int32), np.diff(ends))
    return Triangles(
        vertex=vertex if whole.all() else vertex[whole],
        face=face if whole.all() else face[whole],
        chord_error=off,
        missing=tuple(sorted(missing.items())),
        measured=tuple(patch.number for patch in patches if not patch.proved),
    )


def _started(
    part: Part, wanted: Sequence[int], chord: float, budget: int, at: At
) -> tuple[dict[int, UVMesh], dict[int, str]]:
    """What the triangles of each face begin with, and why a face has none; coarser where they would take the whole budget."""
    BRepTools.Clean_s(part.shape)
    size, chord = float(np.linalg.norm(part.size)), _COARSER * chord
    meshes, why = starts(part, wanted, chord, at)
    while sum(len(mesh.corner) for mesh in meshes.values()) > budget and chord < size:
        chord *= _COARSER
        again = [number for number in meshes if len(meshes[number].corner) > _FEW]
        meshes.update(starts(part, again, chord, at)[0])
    return {number: meshes[number] for number in wanted if number in meshes}, why


def _affordable(
    part: Part, patches: Sequence[Patch], chord: float, budget: int, jobs: int, at: At
) -> tuple[list[Patch], list[Tried]]:
    """Patches with tables as fine as is worth while, and triangles of each for the smallest chord error found, from that asked
    for upwards, at which they are within the budget."""
    size, most = float(np.linalg.norm(part.size)), _TOO_MANY * budget
    # Room to work in: one for each thread.
    rooms = [room(min(budget, _ROOM)) for _ in range(jobs)]
    total = 0
    tried: list[Tried] = []

    def begun(patch: Patch) -> tuple[Patch, Tried]:
        with _lent(rooms) as mine:
            return patch.begun(chord, most, mine if total <= budget else NO_ROOM)

    def again(patch: Patch) -> Tried:
        with _lent(rooms) as mine:
            return patch.tried(chord, most, mine if total <= budget else NO_ROOM)

    finer = []
    for patch, each in _each(begun, patches, jobs):
        at("own", patch.number)
        finer.append(patch)
        tried.append(each)
        total += each.triangles if total <= most else 0
    while total > budget and chord <= size:
        # Their number falls about as the chord error grows.
        chord *= max(_STEP, total / budget)
        tried, total = [], 0
        for each in _each(again, finer, jobs):
            tried.append(each)
            total += each.triangles
            if total > most and chord <= size:
                break
    return finer, tried


@contextmanager
def _lent(rooms: list[Found]) -> Iterator[Found]:
    mine = rooms.pop()
    try:
        yield mine
    finally:
        rooms.append(mine)


def _each(work: Callable[[Item], Done], items: Iterable[Item], jobs: int) -> Iterator[Done]:
    """What `work` makes of each item, in their order, `jobs` at a time; those not begun are dropped when no more are taken."""
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
    p, q = trim.segments[:, 0], trim.segments[:, 1]
    whole = abs(0.5 * float((p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]).sum()))
    left = 1.0 - area / whole if whole > 0 else 0.0
    border = float(np.linalg.norm((q - p) * trim.scale, axis=1).sum())
    return left if left > _UNCOVERED and left * part.faces[number - 1].area > 2 * chord * border else 0.0
