"""Which face of one plan is which of another one, and which cutter: the numbers of faces shift as soon as one is added.

Each step pairs what is left of those before it, and what has two candidates is paired with neither: a wrong pair would tell a
loss that is none, or hide one.
"""

import math
from collections import defaultdict
from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from plan_cutters.plan_file.model import CutterEntry, FaceEntry, Plan
from plan_cutters_ci.carriers import on_one_carrier, opposed, opposing
from plan_cutters_ci.model import CutterMatch, FaceMatch
from plan_cutters_ci.motion import PlanMotion, motions_of
from plan_cutters_ci.neighbours import Surroundings, alone, near

#: Areas that differ by less than this share, and places by less than this share of the part's diagonal, are the same.
SAME = 1e-5
#: Likeness: how far a face may have moved, in diagonals of the part, plus the logarithm of how much its area grew or shrank.
FARTHEST = 0.25
#: The next best candidate must be as many times less like it.
CLEARLY = 1.5
#: Pairs that are looked at for likeness, at most: beyond, faces stay unknown and are told.
_MOST_PAIRS = 4_000_000

Item = TypeVar("Item")
Pair = tuple[FaceEntry, FaceEntry]
Matched = list[tuple[FaceEntry, FaceEntry, FaceMatch]]


class KnownFaces(NamedTuple):
    """Pairs of faces, and how the new part lies to the old one where it was mirrored, moved or turned as a whole.

    Of several motions nobody knows which it was.
    """

    pairs: Matched
    motions: tuple[PlanMotion, ...] = ()
    #: Whether the pairs are those that the motion makes.
    moved: bool = False


def match_faces(old: Plan, new: Plan) -> Matched:
    """Pairs of faces, in the order of the old numbers, and how each was known again: see `known_faces`."""
    return known_faces(old, new).pairs


def known_faces(old: Plan, new: Plan) -> KnownFaces:
    """Pairs of faces, in the order of the old numbers, and how each was known again.

    In turn: both plans are of the same bytes in the same unit, so that numbers agree; form, area and place agree; a plan of an
    older version says no place, then number, form and area agree; carriers agree, or neighbours that are paired; a name stands
    once on each side and the form agrees; of what is left, two are each other's nearest in place and area, by far, and of one
    form. Where faces are left over, and the part was mirrored, moved or turned as a whole, the old faces are compared at the
    places to which that brings them.
    """
    bytes_of = [(plan.part.sha256, plan.part.references, plan.effective.unit) for plan in (old, new)]
    if old.part.sha256 and bytes_of[0] == bytes_of[1]:
        there = {face.id: face for face in new.faces}
        return KnownFaces([(face, there[face.id], "same file") for face in old.faces if face.id in there])
    size = math.hypot(*(max(a, b) for a, b in zip(old.part.size_mm, new.part.size_mm, strict=True)))
    still = _pairs(old.faces, new.faces, size)
    placed = sum(how == "place" for _, _, how in still)
    if placed == len(old.faces) == len(new.faces):
        return KnownFaces(still)
    motions = motions_of(old.faces, new.faces, size)
    if not any(face.shape == "sculptured" for face in old.faces):
        # A part of simple shapes that several motions carry onto the new one is its own image: each of them is right.
        motions = motions[:1]
    if not motions or motions[0].carried <= placed:
        return KnownFaces(still)
    carried = motions[0].carried
    if len(still) == len(old.faces) == len(new.faces) and 2 * placed > len(still):
        # A hole that moved to the other side: most of the part is where it was.
        return KnownFaces(still, tuple(motions))
    whole = carried == len(old.faces) == len(new.faces)
    # Pairs by carrier or likeness count for nothing here: in a part that moved they are of two features.
    if not whole and 2 * placed > carried:
        return KnownFaces(still)
    own = {face.id: face for face in old.faces}
    every = [_pairs([motion.face(face) for face in old.faces], new.faces, size) for motion in motions]
    agreed = set.intersection(*({(a.id, b.id) for a, b, _ in pairs} for pairs in every))
    # Half of the pairs at least, or else the first motion is as good as any: of a flat part whose both sides are alike, all pairs
    # differ between a turn and a mirror.
    if 2 * len(agreed) < carried:
        agreed = {(a.id, b.id) for a, b, _ in every[0]}
    moved = [(own[a.id], b, how) for a, b, how in every[0] if (a.id, b.id) in agreed]
    return KnownFaces(moved, tuple(motions), moved=True)


def _pairs(old: Sequence[FaceEntry], new: Sequence[FaceEntry], size: float) -> Matched:
    """Pairs of faces that stand at their places, in the order of the old numbers."""
    pairs: Matched = []
    open_faces = list(old), list(new)

    def take(matched: Iterable[Pair], how: FaceMatch) -> bool:
        nonlocal open_faces
        more = list(matched)
        pairs.extend((a, b, how) for a, b in more)
        mine, theirs = {a.id for a, _ in more}, {b.id for _, b in more}
        open_faces = [f for f in open_faces[0] if f.id not in mine], [f for f in open_faces[1] if f.id not in theirs]
        return bool(more)

    def surroundings() -> Surroundings:
        return Surroundings({f.id: f for f in old}, {f.id: f for f in new}, ((a, b) for a, b, _ in pairs), size)

    def spread() -> None:
        """Go on from what is paired: what is surest first, and again from the first as soon as one is paired."""
        again = True
        while again and all(open_faces):
            by = surroundings()
            again = (
                any(take(_on_carriers(*open_faces, size, by, radius=radius), "carrier") for radius in (True, False))
                or take(by.pairs(*open_faces, lambda _, every: every), "neighbours")
                or take(by.pairs(*open_faces, lambda shared, _: shared > 1), "neighbours")
                or take(by.pairs(*open_faces, lambda shared, _: shared > 0), "neighbours")
            )

    take(_in_place(*open_faces, size), "place")
    if any(all(face.centre_mm is None for face in faces) for faces in (old, new)):
        take(_alone(*open_faces, _numbered), "number")
    spread()
    by = surroundings()
    take((pair for pair in _alone(*open_faces, _named) if not opposed(*pair) and by.consistent(*pair)), "name")
    by = surroundings()
    take((pair for pair in _alike(*open_faces, size) if by.consistent(*pair)), "likeness")
    spread()
    return sorted(pairs, key=lambda pair: int(pair[0].id[1:]))


def _on_carriers(
    old: Sequence[FaceEntry], new: Sequence[FaceEntry], size: float, by: Surroundings, *, radius: bool
) -> list[Pair]:
    """Pairs on one carrier that are in no other such pair; of several, those with the same neighbours, or nearest by far."""
    pairs = [pair for pair in on_one_carrier(old, new, size, radius=radius) if by.supports(*pair)]
    for some in (
        alone(pairs),
        alone((a, b) for a, b in pairs if by.of_old(a) and by.of_old(a) == by.of_new(b)),
        list(_nearest(pairs, size)),
    ):
        if some:
            return some
    return []


def _nearest(pairs: Sequence[Pair], size: float) -> Iterator[Pair]:
    """Of pairs those whose faces are nearer to each other than to any other, by far."""
    away = [math.dist(a.centre_mm, b.centre_mm) if a.centre_mm and b.centre_mm else math.inf for a, b in pairs]
    rows, columns = defaultdict[str, list[float]](list), defaultdict[str, list[float]](list)
    for (a, b), far in zip(pairs, away, strict=True):
        rows[a.id].append(far)
        columns[b.id].append(far)
    for (a, b), far in zip(pairs, away, strict=True):
        # Once in its row and once in its column the pair itself is nearest: the second entry is the next best.
        others = [sorted(each)[1] for each in (rows[a.id], columns[b.id]) if len(each) > 1]
        first = far == min(rows[a.id]) == min(columns[b.id])
        if first and near(a, b) and all(other >= CLEARLY * max(far, SAME * size) for other in others):
            yield a, b


def match_cutters(old: Plan, new: Plan) -> list[tuple[CutterEntry, CutterEntry, CutterMatch]]:
    """Pairs of cutters by id; else by the name, then by the cutting part, where it stands once on each side."""
    pairs: list[tuple[CutterEntry, CutterEntry, CutterMatch]] = []
    open_cutters = sorted(old.cutters, key=lambda c: c.id), sorted(new.cutters, key=lambda c: c.id)
    steps: tuple[tuple[CutterMatch, Callable[[CutterEntry], Hashable]], ...] = (
        ("id", lambda c: c.id),
        ("name", lambda c: c.name or None),
        ("cutting part", lambda c: (c.shape, c.radius, c.corner_radius, c.taper_deg)),
    )
    for how, key in steps:
        matched = list(_alone(*open_cutters, key))
        pairs += [(a, b, how) for a, b in matched]
        mine, theirs = {a.id for a, _ in matched}, {b.id for _, b in matched}
        open_cutters = ([c for c in open_cutters[0] if c.id not in mine], [c for c in open_cutters[1] if c.id not in theirs])
    return sorted(pairs, key=lambda pair: pair[0].id)


def _alone(old: Iterable[Item], new: Iterable[Item], key: Callable[[Item], Hashable]) -> Iterable[tuple[Item, Item]]:
    """Pairs whose key stands once on each side; None is no key."""
    sides: list[dict[Hashable, list[Item]]] = []
    for side in (old, new):
        groups = defaultdict(list)
        for each in side:
            groups[key(each)].append(each)
        sides.append(groups)
    for word, mine in sides[0].items():
        if word is not None and len(mine) == len(theirs := sides[1].get(word, [])) == 1:
            yield mine[0], theirs[0]


def _numbered(face: FaceEntry) -> Hashable:
    return (face.id, face.shape, f"{face.area_mm2:.5g}")


def _named(face: FaceEntry) -> Hashable:
    return (face.name, face.shape) if face.name else None


def _in_place(old: Sequence[FaceEntry], new: Sequence[FaceEntry], size: float) -> list[Pair]:
    """Pairs of one form whose area and place agree; several in one place are paired in the order of their numbers."""
    pairs: list[Pair] = []
    for mine, theirs in _of_one_form(old, new):
        tree = cKDTree(_placed(theirs, size))
        taken = set[int]()
        for face, rows in zip(mine, tree.query_ball_point(_placed(mine, size), SAME), strict=True):
            row = next((j for j in sorted(rows) if j not in taken and not opposed(face, theirs[j])), None)
            if row is not None:
                taken.add(row)
                pairs.append((face, theirs[row]))
    return pairs


def _placed(faces: Sequence[FaceEntry], size: float) -> NDArray[np.float64]:
    """Rows (n, 4): places in sizes of the part, and logarithms of areas."""
    at = np.array([face.centre_mm for face in faces]) / max(size, 1e-300)
    return np.column_stack([at, np.log([face.area_mm2 for face in faces])])


def _alike(old: Sequence[FaceEntry], new: Sequence[FaceEntry], size: float) -> list[Pair]:
    """Pairs of one form that are each other's nearest, by far."""
    pairs = []
    for mine, theirs in _of_one_form(old, new):
        if len(mine) * len(theirs) > _MOST_PAIRS:
            continue
        one, other = _placed(mine, size), _placed(theirs, size)
        unlike = np.linalg.norm(one[:, None, :3] - other[None, :, :3], axis=2) + np.abs(one[:, None, 3] - other[None, :, 3])
        unlike[opposing(mine, theirs)] = np.inf
        ends = [_two_least(unlike), _two_least(unlike.T)]
        column = unlike.argmin(axis=1)
        for i, j in enumerate(column.tolist()):
            best, others = unlike[i, j], min(ends[0][i, 1], ends[1][j, 1])
            # `best` is 0 where a place agrees, but other faces stand there, too.
            if best == ends[1][j, 0] and best <= FARTHEST and others >= CLEARLY * max(best, SAME):
                pairs.append((mine[i], theirs[j]))
    return pairs


def _two_least(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """The two least values of each row (n, m), as (n, 2); infinite where there is no second one."""
    return np.partition(np.column_stack([values, np.full(len(values), np.inf)]), 1, axis=1)[:, :2]


def _of_one_form(old: Sequence[FaceEntry], new: Sequence[FaceEntry]) -> Iterator[tuple[list[FaceEntry], list[FaceEntry]]]:
    """For each form the faces of both sides that have a place and an area."""
    sides: list[dict[str, list[FaceEntry]]] = []
    for side in (old, new):
        forms = defaultdict(list)
        for face in side:
            if face.centre_mm is not None and math.isfinite(face.area_mm2) and face.area_mm2 > 0.0:
                forms[face.shape].append(face)
        sides.append(forms)
    for shape, mine in sides[0].items():
        if theirs := sides[1].get(shape):
            yield mine, theirs
