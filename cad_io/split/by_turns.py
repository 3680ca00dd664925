"""Faces split along labels that have no order: by halves of their labels, turn by turn.

`split` draws a boundary of its own for each label between two that meet, which is right for labels that have an order: there few
meet that are far apart. Labels without an order are split into two halves of them, then each piece into halves of its labels, and
so on: each turn draws one boundary, and where three labels meet the later boundary ends on the earlier one.
"""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from OCP.BRep import BRep_Tool

from cad_io.arrays import FaceLabels, Floats, Ints
from cad_io.face.uv_region import inside, outline
from cad_io.split.pieces import MIXED, UNKNOWN, Piece, Split, split


class _Numbered(NamedTuple):
    number: int


@dataclass(slots=True)
class _Stage:
    """The pieces so far, as `split` takes a part: the number of a face is the place of a piece, from 1."""

    part: Any
    shape: Any
    pieces: list[tuple[Piece, tuple[int, ...]]]

    @property
    def faces(self) -> list[_Numbered]:
        return [_Numbered(i) for i in range(1, len(self.pieces) + 1)]

    def face(self, number: int) -> Any:
        return self.pieces[number - 1][0].shape

    def surface(self, number: int) -> Any:
        return self.part.surface(self.pieces[number - 1][0].face)


def _requests(stage: _Stage, roomy: dict[int, FaceLabels]) -> Iterator[FaceLabels]:
    """Labels that part each piece of several labels into two halves of them."""
    taken = _taken(stage.pieces, roomy)
    for i, (piece, group) in enumerate(stage.pieces, 1):
        if len(group) > 1:
            field = roomy[piece.face]
            off = np.isin(taken[piece.face], [0, i], invert=True)
            yield FaceLabels(i, field.u, field.v, _halves(field, off, group))


def _halved(each: Piece, before: Piece, group: tuple[int, ...]) -> tuple[Piece, tuple[int, ...]]:
    """A piece of the original face, and the labels on it, from a piece of the stage and what it was cut from."""
    if len(group) <= 1:
        return Piece(before.face, before.label, each.shape, before.shares), group
    middle = len(group) // 2
    group = () if each.label < 0 else group[:middle] if each.label == 0 else group[middle:]
    label = group[0] if len(group) == 1 else MIXED
    own = before.shares.get(MIXED, 1.0) * each.shares.get(each.label, 0.0)
    return Piece(before.face, label, each.shape, {label: own} if own else {}), group


def split_by_turns(part: Any, labels: Sequence[FaceLabels], *, seconds: float = 5) -> Split:
    """Split faces along the boundaries of labels that have no order.

    Islands of one node get pieces, too. Slivers without a node join what is around them.

    Parameters
    ----------
    part : Part
    labels : sequence of FaceLabels
        At most one a face, as for `split`.
    seconds : float
        As for `split`, in each turn.

    Returns
    -------
    Split
        `dropped` counts the nodes that lie within a piece of another label.
    """
    fields = {each.face: each for each in labels}
    roomy = {number: with_margin(each) for number, each in fields.items()}
    start = split(part, [])
    stage = _Stage(part, start.shape, [_first(each, roomy.get(each.face)) for each in start.pieces])
    whole, remaining, joined = dict[int, str](), dict[int, FaceLabels](), Counter[int]()
    while any(len(group) > 1 for _, group in stage.pieces):
        done = split(stage, list(_requests(stage, roomy)), seconds=seconds)
        pieces = [_halved(each, *stage.pieces[each.face - 1]) for each in done.pieces]
        for i, why in done.whole.items():
            whole[stage.pieces[i - 1][0].face] = why
            remaining[stage.pieces[i - 1][0].face] = fields[stage.pieces[i - 1][0].face]
        for i, n in done.joined.items():
            joined[stage.pieces[i - 1][0].face] += n
        stage = _Stage(part, done.shape, pieces)
    last = tuple(each for each, _ in stage.pieces)
    strays = {number: _strays(each, [piece for piece in last if piece.face == number]) for number, each in fields.items()}
    return Split(stage.shape, last, whole, {k: n for k, n in strays.items() if n}, remaining, dict(joined))


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
    surface = BRep_Tool.Surface_s(face)
    turns = [
        [0.0, period, -period] if closed else [0.0]
        for closed, period in (
            (surface.IsUPeriodic(), surface.UPeriod() if surface.IsUPeriodic() else 0.0),
            (surface.IsVPeriodic(), surface.VPeriod() if surface.IsVPeriodic() else 0.0),
        )
    ]
    on_face = np.zeros(labels.label.shape, bool)
    for du in turns[0]:
        for dv in turns[1]:
            on_face |= inside(segments, labels.u + du, labels.v + dv)
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
