"""Which face of one plan is which of another one, and which cutter: the numbers of faces shift as soon as one is added.

Each step pairs what is left of those before it, and what has two candidates is paired with neither: a wrong pair would tell a
loss that is none, or hide one.
"""

import math
from collections import defaultdict
from collections.abc import Callable, Hashable, Iterable, Sequence
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from plan_cutters.comparison.model import CutterMatch, FaceMatch
from plan_cutters.plan_file.model import CutterEntry, FaceEntry, Plan

#: Areas that differ by less than this share, and places by less than this share of the part's diagonal, are the same.
SAME = 1e-5
#: Likeness: how far a face may have moved, in diagonals of the part, plus the logarithm of how much its area grew or shrank.
FARTHEST = 0.25
#: The next best candidate must be as many times less like it.
CLEARLY = 1.5
#: Pairs that are looked at for likeness, at most: beyond, faces stay unknown and are told.
_MOST_PAIRS = 4_000_000

Item = TypeVar("Item")


def match_faces(old: Plan, new: Plan) -> list[tuple[FaceEntry, FaceEntry, FaceMatch]]:
    """Pairs of faces, in the order of the old numbers, and how each was known again.

    In turn: both plans are of the same bytes in the same unit, so that numbers agree; form, area and place agree; a plan of an
    older version says no place, then number, form and area agree; a name stands once on each side and the form agrees; of what
    is left, two are each other's nearest in place and area, by far, and of one form.
    """
    bytes_of = [(plan.part.sha256, plan.part.references, plan.effective.unit) for plan in (old, new)]
    if old.part.sha256 and bytes_of[0] == bytes_of[1]:
        there = {face.id: face for face in new.faces}
        return [(face, there[face.id], "same file") for face in old.faces if face.id in there]
    size = math.hypot(*(max(a, b) for a, b in zip(old.part.size_mm, new.part.size_mm, strict=True)))
    pairs: list[tuple[FaceEntry, FaceEntry, FaceMatch]] = []
    open_faces = list(old.faces), list(new.faces)

    def take(matched: Iterable[tuple[FaceEntry, FaceEntry]], how: FaceMatch) -> None:
        nonlocal open_faces
        pairs.extend((a, b, how) for a, b in matched)
        mine, theirs = {a.id for a, _, _ in pairs}, {b.id for _, b, _ in pairs}
        open_faces = [f for f in open_faces[0] if f.id not in mine], [f for f in open_faces[1] if f.id not in theirs]

    take(_in_place(*open_faces, size), "place")
    if any(all(face.centre_mm is None for face in plan.faces) for plan in (old, new)):
        take(_alone(*open_faces, _numbered), "number")
    take(_alone(*open_faces, _named), "name")
    take(_alike(*open_faces, size), "likeness")
    return sorted(pairs, key=lambda pair: int(pair[0].id[1:]))


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


def _in_place(old: Sequence[FaceEntry], new: Sequence[FaceEntry], size: float) -> list[tuple[FaceEntry, FaceEntry]]:
    """Pairs of one form whose area and place agree; several in one place are paired in the order of their numbers."""
    pairs = []
    for mine, theirs, far, grown in _distances(old, new, size):
        rows, columns = set[int](), set[int]()
        for i, j in np.argwhere((far <= SAME) & (grown <= SAME)).tolist():
            if i not in rows and j not in columns:
                rows.add(i)
                columns.add(j)
                pairs.append((mine[i], theirs[j]))
    return pairs


def _alike(old: Sequence[FaceEntry], new: Sequence[FaceEntry], size: float) -> list[tuple[FaceEntry, FaceEntry]]:
    """Pairs of one form that are each other's nearest, by far."""
    pairs = []
    for mine, theirs, far, grown in _distances(old, new, size):
        unlike = far + grown
        for i, j in enumerate(unlike.argmin(axis=1).tolist()):
            best = unlike[i, j]
            others = np.append(np.delete(unlike[i], j), np.delete(unlike[:, j], i))
            # `best` is 0 where a place agrees, but other faces stand there, too.
            if best <= FARTHEST and (not len(others) or others.min() >= CLEARLY * max(best, SAME)):
                pairs.append((mine[i], theirs[j]))
    return pairs


def _distances(
    old: Sequence[FaceEntry], new: Sequence[FaceEntry], size: float
) -> Iterable[tuple[list[FaceEntry], list[FaceEntry], NDArray[np.float64], NDArray[np.float64]]]:
    """For each form: faces with a place and an area, distances (n, m) in sizes, logarithms (n, m) of the ratios of areas."""
    sides: list[dict[str, list[FaceEntry]]] = []
    for side in (old, new):
        distances = defaultdict(list)
        for face in side:
            if face.centre_mm is not None and math.isfinite(face.area_mm2) and face.area_mm2 > 0.0:
                distances[face.shape].append(face)
        sides.append(distances)
    for shape, mine in sides[0].items():
        theirs = sides[1].get(shape, [])
        if not theirs or len(mine) * len(theirs) > _MOST_PAIRS:
            continue
        at, other = (np.array([f.centre_mm for f in each]) for each in (mine, theirs))
        area, its = (np.log([f.area_mm2 for f in each]) for each in (mine, theirs))
        far = np.linalg.norm(at[:, None] - other[None], axis=2) / max(size, 1e-300)
        yield mine, theirs, far, np.abs(area[:, None] - its[None])
