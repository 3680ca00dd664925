"""Split faces along the boundaries of their labels.

Every face with more than one label gets its boundary curves, drawn in its parameter plane (`face_grid`, `contour`). There they
and the face's border are a planar arrangement (`arrangement`), whose regions become faces (`regions`, `build`); edges are
cut once for all faces that share them (`net`). Results are accepted by checks of our own (`check`); a face that cannot be
cut is left whole, and why is said (`cut_faces`).
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from cad_io.arrays import FaceLabels, Ints
from cad_io.split.cut_faces import cut_faces

#: Label of a piece about which nothing is known, and of a face left whole although its labels differ.
UNKNOWN, MIXED = -1, -2


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
    #: Face number -> the labels of a face left whole.
    labels: dict[int, FaceLabels] = field(default_factory=dict)
    #: Face number -> how many slivers joined a worse label around them.
    joined: dict[int, int] = field(default_factory=dict)


def split(part: Any, labels: Sequence[FaceLabels], *, worst: int = -1, seconds: float = 5) -> Split:
    """Split faces along the boundaries of their labels.

    Parameters
    ----------
    part : Part
    labels : sequence of FaceLabels
        At most one a face. The boundary runs between nodes of different label, smooth, within about half a cell. Faces
        not mentioned, or of one label, stay whole.
    worst : int
        Labels up to this one are worse the higher they are: slivers (three nodes at most, less area than a cell) join the
        label around them where that one is worse. By default no label is worse: only slivers without any node join.
    seconds : float
        Of processor time, after which the work on one face is taken for endless; more for fine grids.

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
    faces = {info.number: part.face(info.number) for info in part.faces}
    shares = {number: _shares(fields[number].label) if number in fields else {} for number in faces}
    mixed = {number: fields[number] for number in faces if len(shares[number]) > 1}
    shape, cut = cut_faces(part.shape, faces, mixed, part.surface, worst, seconds)
    pieces: list[Piece] = []
    for number, face in faces.items():
        shapes = cut.faces.get(number, [face])
        if number in cut.labels:
            for (label, counts), piece in zip(cut.labels[number], shapes, strict=True):
                known = sum(counts.values())
                pieces.append(Piece(number, label, piece, {k: n / known for k, n in counts.items()}))
        else:
            label = MIXED if number in mixed else max(shares[number], key=lambda k: shares[number][k], default=UNKNOWN)
            pieces += [Piece(number, label, piece, shares[number]) for piece in shapes]
    failed = {number: fields[number] for number in sorted(cut.failed)}
    return Split(shape, tuple(pieces), cut.failed, cut.missed, failed, cut.joined)


def _shares(label: Ints) -> dict[int, float]:
    value, count = np.unique(label[label >= 0], return_counts=True)
    return {int(k): float(n / count.sum()) for k, n in zip(value, count, strict=True)}
