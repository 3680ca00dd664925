"""Triangles close to a part's surface, with the distance measured, not wished.

The kernel's mesher gives a start: triangles in each face's parameter plane, to which gaps between the mesh and the true
ends of border curves are added. Every triangle is then measured against
the true surface at points of its edges and its inside, border edges against the true border curve, and what is too far
is split there. Neighbours may be split differently: the result is a soup, each of whose triangles is near the surface.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Triangles
from cad_io.kernel import translated
from cad_io.part import Part
from cad_io.tessellate.mesh import UVMesh, folded, uv_meshes
from cad_io.tessellate.soup import Indices, Rows, Soup

#: Measured distances count this much larger, for what lies between the points measured.
MARGIN = 1.05
#: The start is asked of the kernel's mesher this much coarser than wanted: splitting is quicker.
_COARSER = 32.0
_COARSE = 3e-4  # of the part's size: never asked to be finer than this
_ANGLE = 0.5
_OLDEST = 24  # no triangle is split more often
#: A face is missing if more than this share of it has no triangles.
_UNCOVERED = 0.01


#: Told who is at work, `kernel` or `own`, and at which face (0: all of them): for who watches the time.
At = Callable[[str, int], None]


def tessellate(
    part: Part, chord: float, *, budget: int = 2_000_000, faces: Sequence[int] | None = None,
    at: At = lambda who, face: None,
) -> Triangles:  # fmt: skip
    """Triangles whose distance from the surface is at most `chord`.

    Parameters
    ----------
    part : Part
        Any mesh that its shape carries is removed.
    chord : float
        mm, positive.
    budget : int
        Most triangles. Where it binds, the farthest are split first, and `chord_error` says what was reached.
    faces : sequence of int, optional
        Face numbers; default all.
    at : callable, optional
        Told who is at work, `kernel` or `own`, and at which face; all are split together, so the one that has the most
        triangles still too far is named.

    Returns
    -------
    Triangles
        `chord_error` is the largest distance measured between a point of a triangle and the point of the surface, or
        of the face's border, that has the same parameters, with a margin for what lies between the points measured.
    """
    if not chord > 0:
        raise ValueError(f"the chord error must be positive, not {chord}")
    numbers = list(faces) if faces is not None else [f.number for f in part.faces]
    missing = {n: str(part.faces[n - 1].unjudged) for n in numbers if part.faces[n - 1].unjudged is not None}
    wanted = [n for n in numbers if n not in missing]
    with translated("meshing", file=part.file):
        meshes = _start(part, wanted, chord, budget, at)
        missing.update({n: "the kernel's mesher fails on it" for n in wanted if n not in meshes})
        done = _refined(part, meshes, chord / MARGIN, budget, at)
    missing.update(_uncovered(part, done, chord))
    whole = np.isfinite(done.vertex).all(axis=(1, 2)) & np.isfinite(done.off)
    if not whole.all():
        missing.update({int(n): "its surface cannot be evaluated everywhere" for n in np.unique(done.face[~whole])})
        done = _Done(done.vertex[whole], done.uv[whole], done.face[whole], done.off[whole])
    # A middle on a bent border may lie beyond the opposite corner: such a child is folded over.
    over = folded(done.uv)
    done.vertex[over] = done.vertex[over][:, [0, 2, 1]]
    return Triangles(
        vertex=done.vertex,
        face=done.face.astype(np.int32),
        chord_error=MARGIN * float(done.off.max(initial=0.0)),
        missing=tuple(sorted(missing.items())),
    )


class _Done(NamedTuple):
    """Finished triangles: corners in mm and in the parameter plane, face, measured distance."""

    vertex: Floats
    uv: Floats
    face: Indices
    off: Floats


def _start(part: Part, wanted: Sequence[int], chord: float, budget: int, at: At) -> dict[int, UVMesh]:
    """The kernel's triangles; coarser where they would take the whole budget, finer where a face gets none."""
    if not wanted:
        return {}
    size = float(np.linalg.norm(part.size))
    deflection = max(_COARSER * chord, _COARSE * size)
    at("kernel", 0)
    meshes = uv_meshes(part, wanted, deflection, _ANGLE)
    while sum(len(m.corner) for m in meshes.values()) > budget and deflection < size:
        deflection *= 4
        meshes = uv_meshes(part, wanted, deflection, 2 * _ANGLE)
    for number in wanted:
        if number not in meshes:
            at("kernel", number)
            meshes.update(uv_meshes(part, [number], 0.1 * chord, 0.2 * _ANGLE))
    return meshes


def _refined(part: Part, meshes: Mapping[int, UVMesh], chord: float, budget: int, at: At) -> _Done:
    """Split until every triangle is within `chord` or the budget is spent, the farthest first where it binds."""
    soup = Soup(part)
    new = Rows.joined([soup.add(number, mesh) for number, mesh in meshes.items()])
    finished: list[_Done] = []
    count = 0
    waiting, waiting_off, waiting_marked = Rows.joined([]), np.zeros(0), np.zeros((0, 3), bool)
    scarce = False
    while len(new.face):
        at("own", int(np.bincount(new.face).argmax()))
        off, marked = soup.measured(new, chord, wholly=scarce)
        far = np.asarray(marked.any(axis=1))
        finished.append(_done(soup, new.at(~far), off[~far]))
        count += int((~far).sum())
        waiting = Rows.joined([waiting, new.at(far)])
        waiting_off = np.concatenate([waiting_off, off[far]])
        waiting_marked = np.concatenate([waiting_marked, marked[far]])
        left = budget - count - len(waiting.face)
        if not scarce and waiting_marked.sum() > left:
            # Which is farthest matters from now on.
            scarce = True
            waiting_off, waiting_marked = soup.measured(waiting, chord, wholly=True)
        chosen = _affordable(waiting, waiting_off, waiting_marked.sum(axis=1), left)
        new = soup.split(waiting.at(chosen), waiting_marked[chosen])
        waiting, waiting_off, waiting_marked = waiting.at(~chosen), waiting_off[~chosen], waiting_marked[~chosen]
    finished.append(_done(soup, waiting, soup.measured(waiting, chord, wholly=True)[0]))
    # Column by column, the pieces let go on the way: here memory is at its most.
    del soup, new, waiting
    columns = [list(pieces) for pieces in zip(*finished, strict=True)]
    finished.clear()
    return _Done(*(np.concatenate(columns.pop(0)) for _ in _Done._fields))


def _affordable(rows: Rows, off: Floats, grow: Indices, left: int) -> NDArray[np.bool_]:
    """Which triangles to split next so that at most `left` are added: all, or the farther half of distances first."""
    young = rows.age < _OLDEST
    if grow[young].sum() <= left:
        return young
    order = np.argsort(np.where(young, -off, 0.0), kind="stable")
    chosen = np.zeros(len(off), bool)
    chosen[order[np.cumsum(grow[order]) <= left]] = True
    return chosen & young & (off >= 0.5 * off[young].max(initial=0.0))


def _done(soup: Soup, rows: Rows, off: Floats) -> _Done:
    return _Done(soup.point[rows.corner], soup.uv[rows.corner], rows.face, off)


def _uncovered(part: Part, done: _Done, chord: float) -> dict[int, str]:
    """Faces whose triangles leave out more than a sliver, by the area in the parameter plane."""
    a, b = done.uv[:, 1] - done.uv[:, 0], done.uv[:, 2] - done.uv[:, 0]
    area = 0.5 * np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    found: dict[int, str] = {}
    for number in np.unique(done.face).tolist():
        trim = part.trim(number)
        if trim is None or not trim.closed:
            continue
        p, q = trim.segments[:, 0], trim.segments[:, 1]
        whole = abs(0.5 * float((p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]).sum()))
        left = 1.0 - float(area[done.face == number].sum()) / whole if whole > 0 else 0.0
        border = float(np.linalg.norm((q - p) * trim.scale, axis=1).sum())
        if left > _UNCOVERED and left * part.faces[number - 1].area > 2 * chord * border:
            found[number] = f"its triangles leave {100 * left:.0f} % of it uncovered"
    return found
