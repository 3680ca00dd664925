"""Faces split along the boundaries of labels on them; all other faces stay, and so do solids, shells and gaps.

All boundary curves of all faces cut the part in one call of the kernel. The result is accepted by checks of our own; if
it fails them, the faces that spoil it are found by halving, tried with other curves and, as a last resort, left whole.
"""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np

from cad_io.arrays import FaceLabels, Ints
from cad_io.contour import LabelGrid, boundaries
from cad_io.cut import Cut, cut
from cad_io.errors import CadIoError
from cad_io.face_grid import label_grid
from cad_io.kernel import translated
from cad_io.surface_edge import surface_edge
from cad_io.uv_region import inside, interior_point, outline

#: Label of a piece about which nothing is known, and of a face left whole although its labels differ.
UNKNOWN, MIXED = -1, -2

#: Fits tried for the boundary curves, cells of root mean square distance.
_FITS = (0.1, 0.05, 0.2)


@dataclass(frozen=True, slots=True)
class Piece:
    """A face of the result.

    Attributes
    ----------
    face : int
        Number of the part's face that it is or is a piece of.
    label : int
        The most frequent known label inside; without a node inside, that of the nearest known node. UNKNOWN, MIXED.
    shape : TopoDS_Face
        As it stands in `Split.shape`, in part coordinates.
    shares : dict
        Label -> share of the known nodes inside, 0 to 1; empty if there are none.
    """

    face: int
    label: int
    shape: Any
    shares: dict[int, float] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Split:
    """A part with some faces split.

    Attributes
    ----------
    shape : TopoDS_Shape
        What is to be written. The part's own shape if no face was split, else a copy.
    pieces : tuple of Piece
        Of every face of the part, by face number.
    whole : dict
        Face number -> why a face of several labels was left whole; its piece is MIXED.
    dropped : dict
        Face number -> how many known nodes were single-node islands and got no piece of their own.
    """

    shape: Any
    pieces: tuple[Piece, ...]
    whole: dict[int, str]
    dropped: dict[int, int]


@dataclass(slots=True)
class _Work:
    """A face with a boundary on it."""

    face: Any
    grid: LabelGrid
    known: Ints
    edges: list[Any] = field(default_factory=list)

    def draw(self, fit: float) -> None:
        self.edges = [surface_edge(self.face, spline) for spline in boundaries(self.grid, fit)]


def split(part: Any, labels: Sequence[FaceLabels], *, seconds: float = 60) -> Split:
    """Split faces along the boundaries of their labels.

    Parameters
    ----------
    part : Part
    labels : sequence of FaceLabels
        At most one a face. The boundary runs between nodes of different label, smooth, within about half a cell. Faces
        not mentioned, or of one label, stay whole.
    seconds : float
        Limit for the kernel's work; faces not split by then stay whole.

    Returns
    -------
    Split

    Raises
    ------
    ValueError
        A face has two label fields, or a field does not fit its grid.
    """
    fields = {f.face: f for f in labels}
    if len(fields) < len(labels):
        raise ValueError("a face has two label fields")
    for f in labels:
        if f.label.shape != (len(f.u), len(f.v)):
            raise ValueError(f"F{f.face}: labels {f.label.shape} on a grid of {len(f.u)} x {len(f.v)}")
    whole: dict[int, str] = {}
    dropped: dict[int, int] = {}
    work: dict[int, _Work] = {}
    for number in sorted(fields):
        if len(_shares(fields[number].label)) < 2:
            continue
        face = part.face(number)
        try:
            with translated("drawing label boundaries"):
                grid, known, specks = label_grid(face, fields[number])
                drawn = _Work(face, grid, known)
                drawn.draw(_FITS[0])
        except (ValueError, CadIoError) as error:
            whole[number] = str(error)
            continue
        if specks:
            dropped[number] = specks
        if drawn.edges:
            work[number] = drawn
    found = _search(part, work, whole, seconds) if work else None
    pieces: list[Piece] = []
    for info in part.faces:
        number = info.number
        shapes = [part.face(number)] if found is None else found.pieces[number]
        shares = _shares(fields[number].label) if number in fields else {}
        if number in work and number not in whole:
            pieces += [_labelled(number, shape, work[number]) for shape in shapes]
        else:
            label = MIXED if number in whole else max(shares, key=lambda k: shares[k], default=UNKNOWN)
            pieces += [Piece(number, label, shape, shares) for shape in shapes]
    return Split(part.shape if found is None else found.shape, tuple(pieces), whole, dropped)


def _search(part: Any, work: dict[int, _Work], whole: dict[int, str], seconds: float) -> Cut | None:
    """The cut with the most faces that passes the checks; faces that had to be left out are added to `whole`."""
    deadline = time.monotonic() + seconds
    faces = {info.number: part.face(info.number) for info in part.faces}

    def attempt(numbers: list[int]) -> Cut | str:
        edges = {n: work[n].edges for n in numbers}
        # Half of what is left, so that one endless call does not cost all faces their turn.
        return cut(part.shape, faces, edges, 0.5 * (deadline - time.monotonic()))

    def redraw(number: int, fit: float) -> bool:
        try:
            with translated("drawing label boundaries"):
                work[number].draw(fit)
        except (ValueError, CadIoError):
            return False
        return True

    best = None
    done: list[int] = []
    groups = [list(work)]
    while groups:
        group = groups.pop()
        tries: list[Callable[[], bool]] = [lambda: True]
        if len(group) == 1:
            tries += [partial(redraw, group[0], fit) for fit in _FITS[1:]]
        reason = ""
        for prepare in tries:
            found = attempt(done + group) if prepare() else "its boundary cannot be drawn"
            if isinstance(found, Cut):
                best, done = found, done + group
                break
            reason = reason or found
        else:
            if len(group) == 1:
                whole[group[0]] = reason
            else:
                half = len(group) // 2
                groups += [group[half:], group[:half]]
    return best


def _shares(label: Ints) -> dict[int, float]:
    value, count = np.unique(label[label >= 0], return_counts=True)
    return {int(k): float(n / count.sum()) for k, n in zip(value, count, strict=True)}


def _labelled(number: int, shape: Any, work: _Work) -> Piece:
    """A piece with the label of the nodes inside it."""
    segments = outline(shape)
    nu, nv = work.known.shape
    u, v = work.grid.u[:nu], work.grid.v[:nv]
    within = np.zeros((nu, nv), bool)
    for du in _turns(segments[..., 0], work.grid.u, work.grid.closed_u):
        for dv in _turns(segments[..., 1], work.grid.v, work.grid.closed_v):
            within |= inside(segments - (du, dv), u, v)
    shares = _shares(work.known[within])
    if shares:
        return Piece(number, max(shares, key=lambda k: shares[k]), shape, shares)
    # Nearest in cells, among known nodes.
    at_u, at_v = interior_point(segments)
    if work.grid.closed_u:
        at_u = u[0] + (at_u - u[0]) % (work.grid.u[-1] - u[0])
    if work.grid.closed_v:
        at_v = v[0] + (at_v - v[0]) % (work.grid.v[-1] - v[0])
    i, j = np.nonzero(work.known >= 0)
    away = np.hypot(i - np.interp(at_u, u, np.arange(nu)), j - np.interp(at_v, v, np.arange(nv)))
    k = int(np.argmin(away))
    return Piece(number, int(work.known[i[k], j[k]]), shape)


def _turns(segments: Any, line: Any, closed: bool) -> list[float]:
    """Whole periods by which a piece lies off the grid in a closed direction."""
    if not closed or not segments.size:
        return [0.0]
    period = float(line[-1] - line[0])
    slack = 1e-6 * period
    first = int(np.floor((segments.min() - line[0] + slack) / period))
    last = int(np.ceil((segments.max() - line[-1] - slack) / period))
    return [n * period for n in range(first, max(first, last) + 1)]
