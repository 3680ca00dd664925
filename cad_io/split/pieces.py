"""Split faces along the boundaries of their labels.

Every face with more than one label gets its boundary curves, drawn in its parameter plane (`contour`). There they
and the face's border are a planar arrangement (`arrangement`), whose regions become faces (`regions`, `build`); edges are
cut once for all faces that share them (`net`). Results are accepted by checks of our own (`attempt`); a face that cannot be
cut is left whole, and why is said (`cut_faces`).

`split` draws a boundary of its own for each label between two that meet, which is right for labels that have an order: there few
meet that are far apart. By turns, labels without an order are split into two halves of them, then each piece into halves of its
labels, and so on: each turn draws one boundary, and where three labels meet the later boundary ends on the earlier one.
"""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray
from OCP.BRep import BRep_Tool

from cad_io.arrays import FaceLabels, Floats, Ints
from cad_io.face.trim import nodes_inside, outline
from cad_io.kernel import periods
from cad_io.split.cut_faces import Job, cut_faces
from cad_io.surface import Surface

#: Label of a piece about which nothing is known, and of a face left whole although its labels differ.
UNKNOWN, MIXED = -1, -2
#: Processor time after which the work on one face is taken for endless, s.
SECONDS = 5.0


@dataclass(frozen=True, slots=True)
class Piece:
    """A face of the result."""

    #: Number of the part's face that it is or is a piece of.
    face: int
    #: The most frequent known label inside; without a node inside, that of the nearest known node. UNKNOWN, MIXED.
    label: int
    #: As it stands in `Split.shape`, in part coordinates.
    shape: Any
    #: Label -> share of the known nodes inside, 0 to 1; empty if there are none.
    shares: dict[int, float] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Split:
    """A part with some faces split."""

    #: What is to be written. The part's own shape if no face was split, else a copy.
    shape: Any
    #: Of every face of the part, by face number.
    pieces: tuple[Piece, ...]
    #: Face number -> why a face of several labels was left whole; its piece is MIXED.
    whole: dict[int, str]
    #: Face number -> how many known nodes got no piece of their label: islands of one node, and nodes so close to the border
    #: that their boundary runs outside.
    dropped: dict[int, int]
    #: Face number -> how many slivers joined a worse label around them.
    joined: dict[int, int] = field(default_factory=dict)


def split(part: Any, labels: Sequence[FaceLabels], *, worst: int = -1, seconds: float = SECONDS) -> Split:
    """Split faces along the boundaries of their labels.

    labels: at most one a face. The boundary runs between nodes of different label, smooth, within about half a cell. Faces not
    mentioned, or of one label, stay whole. worst: labels up to this one are worse the higher they are: slivers (three nodes at
    most, less area than a cell) join the label around them where that one is worse. By default no label is worse: only slivers
    without any node join. seconds: of processor time, after which the work on one face is taken for endless; more for fine grids.

    Raises ValueError where a face has two label fields, or a field does not fit its grid.
    """
    faces = {info.number: part.face(info.number) for info in part.faces}
    return _split(Job(part.shape, faces, {}, part.surface, worst), labels, seconds)


def _split(job: Job, labels: Sequence[FaceLabels], seconds: float) -> Split:
    """Split faces of a job that is without labels yet."""
    fields = {f.face: f for f in labels}
    if len(fields) < len(labels):
        raise ValueError("a face has two label fields")
    for f in labels:
        if f.label.shape != (len(f.u), len(f.v)):
            raise ValueError(f"F{f.face}: labels {f.label.shape} on a grid of {len(f.u)} x {len(f.v)}")
    shares = {number: _shares(fields[number].label) if number in fields else {} for number in job.faces}
    mixed = {number: fields[number] for number in job.faces if len(shares[number]) > 1}
    shape, cut = cut_faces(job._replace(labels=mixed), seconds)
    pieces: list[Piece] = []
    for number, face in job.faces.items():
        shapes = cut.faces.get(number, [face])
        if number in cut.labels:
            for (label, counts), piece in zip(cut.labels[number], shapes, strict=True):
                known = sum(counts.values())
                pieces.append(Piece(number, label, piece, {k: n / known for k, n in counts.items()}))
        else:
            label = MIXED if number in mixed else max(shares[number], key=lambda k: shares[number][k], default=UNKNOWN)
            pieces += [Piece(number, label, piece, shares[number]) for piece in shapes]
    return Split(shape, tuple(pieces), cut.failed, cut.missed, cut.joined)


def _shares(label: Ints) -> dict[int, float]:
    value, count = np.unique(label[label >= 0], return_counts=True)
    return {int(k): float(n / count.sum()) for k, n in zip(value, count, strict=True)}


def _halved(each: Piece, before: Piece, group: tuple[int, ...]) -> tuple[Piece, tuple[int, ...]]:
    """A piece of the original face, and the labels on it, from a piece of this turn and what it was cut from."""
    if len(group) <= 1:
        return Piece(before.face, before.label, each.shape, before.shares), group
    middle = len(group) // 2
    group = () if each.label < 0 else group[:middle] if each.label == 0 else group[middle:]
    label = group[0] if len(group) == 1 else MIXED
    own = before.shares.get(MIXED, 1.0) * each.shares.get(each.label, 0.0)
    return Piece(before.face, label, each.shape, {label: own} if own else {}), group


def split_by_turns(part: Any, labels: Sequence[FaceLabels]) -> Split:
    """Split faces along the boundaries of labels that have no order; labels are as for `split`.

    Islands of one node get pieces, too. Slivers without a node join what is around them. `dropped` counts the nodes that lie
    within a piece of another label.
    """
    fields = {each.face: each for each in labels}
    roomy = {number: with_margin(each) for number, each in fields.items()}
    start = split(part, [])
    shape, pieces = start.shape, [_first(each, roomy.get(each.face)) for each in start.pieces]
    whole, joined = dict[int, str](), Counter[int]()
    while any(len(group) > 1 for _, group in pieces):
        # Labels that part each piece of several labels into two halves of them; the pieces are faces by their places, from 1.
        taken, requests, owner = _taken(pieces, roomy), [], [0, *(piece.face for piece, _ in pieces)]
        for i, (piece, group) in enumerate(pieces, 1):
            if len(group) > 1:
                field = roomy[piece.face]
                off = np.isin(taken[piece.face], [0, i], invert=True)
                requests.append(FaceLabels(i, field.u, field.v, _halves(field, off, group)))

        def surface_of(i: int, owner: list[int] = owner) -> Surface:
            surface: Surface = part.surface(owner[i])
            return surface

        faces = {i: piece.shape for i, (piece, _) in enumerate(pieces, 1)}
        done = _split(Job(shape, faces, {}, surface_of, -1), requests, SECONDS)
        shape, pieces = done.shape, [_halved(each, *pieces[each.face - 1]) for each in done.pieces]
        whole |= {owner[i]: why for i, why in done.whole.items()}
        for i, n in done.joined.items():
            joined[owner[i]] += n
    last = tuple(each for each, _ in pieces)
    strays = {number: _strays(each, [piece for piece in last if piece.face == number]) for number, each in fields.items()}
    return Split(shape, last, whole, {k: n for k, n in strays.items() if n}, dict(joined))


def with_margin(labels: FaceLabels) -> FaceLabels:
    """Lay grid lines close beside nodes whose label none of their neighbours has, so that a boundary goes around each of these.

    `split` leaves out islands of one node: they become three by three of one label.
    """
    field = labels.label
    alone = field >= 0
    for axis in (0, 1):
        same = np.diff(field, axis=axis) == 0
        before, after = [(0, 0), (0, 0)], [(0, 0), (0, 0)]
        before[axis], after[axis] = (1, 0), (0, 1)
        alone &= ~np.pad(same, before) & ~np.pad(same, after)
    (u, rows), (v, columns) = (
        _with_neighbours(line, np.asarray(alone.any(axis=1 - k))) for k, line in enumerate((labels.u, labels.v))
    )
    return FaceLabels(labels.face, u, v, field[np.ix_(rows, columns)])


def _with_neighbours(line: Floats, wanted: NDArray[np.bool_]) -> tuple[Floats, NDArray[np.int64]]:
    """A line of parameters with one more on either side of those wanted, a third of a cell away; and the node each copies."""
    at = np.flatnonzero(wanted)
    low, high = at[at > 0], at[at < len(line) - 1]
    new = np.concatenate([line, line[low] - (line[low] - line[low - 1]) / 3.0, line[high] + (line[high + 1] - line[high]) / 3.0])
    node = np.concatenate([np.arange(len(line)), low, high])
    order = np.argsort(new, kind="stable")
    return new[order], node[order]


def _first(piece: Piece, labels: FaceLabels | None) -> tuple[Piece, tuple[int, ...]]:
    """A whole face, and the labels that it has."""
    group = () if labels is None else tuple(np.unique(labels.label[labels.label >= 0]).tolist())
    if len(group) == 1:
        return Piece(piece.face, group[0], piece.shape, {group[0]: 1.0}), group
    return Piece(piece.face, MIXED if group else UNKNOWN, piece.shape), group


def _taken(pieces: Sequence[tuple[Piece, tuple[int, ...]]], labels: Mapping[int, FaceLabels]) -> dict[int, Ints]:
    """The piece, from 1, that each node (nu, nv) of a face with labels to part lies on; 0 on any border, the face's own too."""
    taken = {piece.face: np.zeros(labels[piece.face].label.shape, np.int32) for piece, group in pieces if len(group) > 1}
    for i, (piece, _) in enumerate(pieces, 1):
        if piece.face in taken:
            taken[piece.face][_on(labels[piece.face], piece.shape)] = i
    return taken


def _halves(labels: FaceLabels, off: NDArray[np.bool_], group: tuple[int, ...]) -> Ints:
    """Which half of a group of labels each node (nu, nv) of a piece belongs to, -1 on other pieces and for other labels."""
    middle = len(group) // 2
    half = np.where(np.isin(labels.label, group[:middle]), 0, np.where(np.isin(labels.label, group[middle:]), 1, -1))
    on = np.where(off, -1, half)
    # A piece too small for a node goes with the nodes around it.
    return np.asarray(on if (on >= 0).any() else half, np.int32)


def _on(labels: FaceLabels, face: Any) -> NDArray[np.bool_]:
    """Which nodes (nu, nv) lie on a face, whatever the turn of the parameters."""
    segments = outline(face)
    if not len(segments):
        return np.ones(labels.label.shape, bool)
    turns = ([0.0, period, -period] if period else [0.0] for period in periods(BRep_Tool.Surface_s(face)))
    on_face = np.zeros(labels.label.shape, bool)
    for du, dv in product(*turns):
        on_face |= nodes_inside(segments, labels.u + du, labels.v + dv)
    return on_face


def _strays(labels: FaceLabels, pieces: Sequence[Piece]) -> int:
    """Nodes that lie on a piece of another label, and on none of their own, or whose label has no piece at all."""
    shown = [piece.label for piece in pieces]
    missing = ~np.isin(labels.label, shown) & (MIXED not in shown)
    if len(pieces) < 2:
        return int((missing & (labels.label >= 0)).sum())
    own, other = np.zeros((2, *labels.label.shape), bool)
    for piece in pieces:
        on = _on(labels, piece.shape)
        same = (labels.label == piece.label) | (piece.label == MIXED)
        own |= on & same
        other |= on & ~same
    return int((((other & ~own) | missing) & (labels.label >= 0)).sum())
