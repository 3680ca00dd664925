"""Faces split along the boundaries of labels on them; all other faces stay, and so do solids, shells and gaps.

A boundary is drawn in the face's parameter plane (`contour`), laid on its surface (`surface_edge`), and cuts the part
together with all others (`cut_faces`). Results are accepted by checks of our own (`cut`); a face that cannot be cut is
split as a copy of itself beside the part; if that fails too it is left whole; which of these is said.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray
from OCP.BRepBuilderAPI import BRepBuilderAPI_Copy
from OCP.TopAbs import TopAbs_FACE
from OCP.TopoDS import TopoDS
from scipy.ndimage import maximum_filter, minimum_filter

from cad_io.arrays import FaceLabels, Floats, Ints
from cad_io.errors import CadIoError
from cad_io.face.uv_region import inside, interior_point, outline
from cad_io.kernel import shape_map, translated
from cad_io.kernel.components import compound, flat
from cad_io.split.contour import LabelGrid, Line, curves, smoothed
from cad_io.split.cut_faces import FITS, Effort, cut_faces
from cad_io.split.face_grid import label_grid
from cad_io.split.surface_edge import surface_edge
from cad_io.surface import Surface

#: Label of a piece about which nothing is known, and of a face left whole although its labels differ.
UNKNOWN, MIXED = -1, -2

#: Share of the nodes off the boundary that may end up in a piece of another label.
_ASTRAY = 0.01


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
    beside : dict
        Face number -> pieces of a copy of such a face, which could be split alone: they stand beside `shape`.
    dropped : dict
        Face number -> how many known nodes were single-node islands and got no piece of their own.
    labels : dict
        Face number -> the labels of a face left whole.
    """

    shape: Any
    pieces: tuple[Piece, ...]
    whole: dict[int, str]
    dropped: dict[int, int]
    beside: dict[int, tuple[Piece, ...]] = field(default_factory=dict)
    labels: dict[int, FaceLabels] = field(default_factory=dict)


@dataclass(slots=True)
class _Work:
    """A face with a boundary on it."""

    face: Any
    grid: LabelGrid
    known: Ints
    lines: Sequence[Line] = ()
    edges: list[Any] = field(default_factory=list)
    outlines: dict[int, tuple[Any, Floats]] = field(default_factory=dict)

    def outline(self, piece: Any) -> Floats:
        """As `uv_region.outline`, once for each piece."""
        if id(piece) not in self.outlines:
            self.outlines[id(piece)] = piece, outline(piece)  # kept with the piece, so that no other has its id
        return self.outlines[id(piece)][1]

    def draw(self, fit: float) -> str:
        """Draw the boundary; why that is not possible, or nothing."""
        try:
            with translated("drawing label boundaries"):
                surface = Surface(self.face)
                self.edges = [surface_edge(self.face, surface, each) for each in curves(self.grid, self.lines, fit)]
        except (ValueError, CadIoError) as error:
            return str(error)
        return ""

    def differs(self, pieces: list[Any]) -> str:
        """Whether too many nodes off the boundary lie in a piece of another label: a curve did not cut."""
        field, closed = self.grid.field, (self.grid.closed_u, self.grid.closed_v)
        modes = ["wrap" if c else "nearest" for c in closed]
        calm = maximum_filter(field, 3, mode=modes) == minimum_filter(field, 3, mode=modes)
        calm &= self.known >= 0
        astray = 0
        for shape in pieces:
            ranks = field[calm & self.within(self.outline(shape))]
            astray += len(ranks) - np.bincount(ranks, minlength=1).max()
        if astray > _ASTRAY * calm.sum():
            return f"{astray} of {calm.sum()} nodes end up in a piece of another label"
        return ""

    def within(self, segments: Floats) -> NDArray[np.bool_]:
        """Nodes (nu, nv) inside an outline, also one that lies whole periods off the grid."""
        nu, nv = self.known.shape
        found = np.zeros((nu, nv), bool)
        for du in _turns(segments[..., 0], self.grid.u, self.grid.closed_u):
            for dv in _turns(segments[..., 1], self.grid.v, self.grid.closed_v):
                found |= inside(segments - (du, dv), self.grid.u[:nu], self.grid.v[:nv])
        return found

    def labelled(self, number: int, shape: Any) -> Piece:
        """A piece with the label of the nodes inside it, or of the nearest one (in cells)."""
        segments = self.outline(shape)
        shares = _shares(self.known[self.within(segments)])
        if shares:
            return Piece(number, max(shares, key=lambda k: shares[k]), shape, shares)
        at = list(interior_point(segments))
        for axis, (line, closed) in enumerate(((self.grid.u, self.grid.closed_u), (self.grid.v, self.grid.closed_v))):
            if closed:
                at[axis] = line[0] + (at[axis] - line[0]) % (line[-1] - line[0])
            at[axis] = float(np.interp(at[axis], line, np.arange(len(line))))
        i, j = np.nonzero(self.known >= 0)
        nearest = int(np.argmin(np.hypot(i - at[0], j - at[1])))
        return Piece(number, int(self.known[i[nearest], j[nearest]]), shape)


def split(part: Any, labels: Sequence[FaceLabels], *, seconds: float = 120) -> Split:
    """Split faces along the boundaries of their labels.

    Parameters
    ----------
    part : Part
    labels : sequence of FaceLabels
        At most one a face. The boundary runs between nodes of different label, smooth, within about half a cell. Faces
        not mentioned, or of one label, stay whole.
    seconds : float
        Of processor time, after which a call of the kernel is taken for endless; how many calls are made is counted.

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
    faces = {info.number: part.face(info.number) for info in part.faces}
    for number in sorted(fields):
        if len(_shares(fields[number].label)) < 2:
            continue
        try:
            with translated("reading the face's border"):
                grid, known, specks = label_grid(faces[number], fields[number])
        except (ValueError, CadIoError) as error:
            whole[number] = str(error)
            continue
        if specks:
            dropped[number] = specks
        work[number] = _Work(faces[number], grid, known)
    for drawn, lines in zip(work.values(), smoothed([drawn.grid for drawn in work.values()]), strict=True):
        drawn.lines = lines
    whole |= {number: reason for number, drawn in work.items() if (reason := drawn.draw(FITS[0]))}
    work = {number: drawn for number, drawn in work.items() if drawn.edges and number not in whole}
    effort = Effort()
    shape, shapes = part.shape, {number: [face] for number, face in faces.items()}
    if work:
        shape, shapes, failed = cut_faces(part.shape, faces, dict(work), seconds, effort)
        whole |= failed
    # A loose face was tried alone already.
    loose = shape_map(compound([s for s in flat(part.shape) if s.ShapeType() == TopAbs_FACE]), TopAbs_FACE)
    again = [n for n in sorted(whole.keys() & work.keys()) if not loose.Contains(faces[n])]
    beside = {n: found for n in again if (found := _alone(n, work[n], seconds, effort))}
    pieces: list[Piece] = []
    for number in faces:
        shares = _shares(fields[number].label) if number in fields else {}
        if number in work and number not in whole:
            pieces += [work[number].labelled(number, piece) for piece in shapes[number]]
        else:
            label = MIXED if number in whole else max(shares, key=lambda k: shares[k], default=UNKNOWN)
            pieces += [Piece(number, label, piece, shares) for piece in shapes[number]]
    return Split(shape, tuple(pieces), whole, dropped, beside, {number: fields[number] for number in sorted(whole)})


def _alone(number: int, work: _Work, seconds: float, effort: Effort) -> tuple[Piece, ...]:
    """Pieces of a copy of a face that could not be cut where it stands; none if it cannot be cut alone either."""
    face = TopoDS.Face_s(BRepBuilderAPI_Copy(work.face, False, False).Shape())
    copy = _Work(face, work.grid, work.known, work.lines)
    if copy.draw(FITS[0]):
        return ()
    _, pieces, failed = cut_faces(face, {number: face}, {number: copy}, seconds, effort)
    return () if failed else tuple(copy.labelled(number, piece) for piece in pieces[number])


def _shares(label: Ints) -> dict[int, float]:
    value, count = np.unique(label[label >= 0], return_counts=True)
    return {int(k): float(n / count.sum()) for k, n in zip(value, count, strict=True)}


def _turns(segments: Any, line: Any, closed: bool) -> list[float]:
    """Whole periods by which a piece lies off the grid in a closed direction."""
    if not closed or not segments.size:
        return [0.0]
    period = float(line[-1] - line[0])
    slack = 1e-6 * period
    first = int(np.floor((segments.min() - line[0] + slack) / period))
    last = int(np.ceil((segments.max() - line[-1] - slack) / period))
    return [n * period for n in range(first, max(first, last) + 1)]
