"""Faces that are known again by what is around them: the faces across their edges that are already paired."""

import math
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

from plan_cutters.plan_file.model import FaceEntry
from plan_cutters_ci.carriers import SAME_CARRIER, opposed, same_radii

#: Faces whose areas differ by less than this factor may be one face, changed.
_GROWN = 4.0
#: The same of free-form faces, of which nothing else is known.
_GROWN_FREE = 1.25
#: Share of the fewer paired neighbours that must correspond where two faces lie on one carrier.
_SHARED = 0.5
#: A face whose middle is no farther from a plane, as a share of the part's diagonal, is on no side of it.
_OFF = 1e-4
#: Faces of one form with the same paired neighbours, at most: of more, none is told from the others.
_MOST_ALIKE = 100


class Surroundings:
    """Paired neighbours of faces of both plans, in ids of the new one.

    Parameters
    ----------
    old, new : mapping
        All faces of both plans by their ids.
    pairs : iterable of (FaceEntry, FaceEntry)
        What is paired so far.
    size : float
        Of the part, mm.
    """

    def __init__(
        self,
        old: Mapping[str, FaceEntry],
        new: Mapping[str, FaceEntry],
        pairs: Iterable[tuple[FaceEntry, FaceEntry]],
        size: float,
    ) -> None:
        self._old, self._new = old, new
        self._pair = {b.id: (a, b) for a, b in pairs}
        self._paired = {a.id: name for name, (a, _) in self._pair.items()}
        self._size = size

    def of_old(self, face: FaceEntry) -> frozenset[str]:
        """Which faces the paired neighbours of an old face have become."""
        return frozenset(self._paired[name] for name in face.neighbours or () if name in self._paired)

    def of_new(self, face: FaceEntry) -> frozenset[str]:
        """The paired neighbours of a new face."""
        return frozenset(name for name in face.neighbours or () if name in self._pair)

    def consistent(self, a: FaceEntry, b: FaceEntry) -> bool:
        """Whether two faces may be one by what is in front of them: unpaired faces rise from both, or from none of them.

        They do from the floor of a pocket, and not from the top of a boss.
        """
        mine = self._rising(a, [self._old[name] for name in a.neighbours or () if name in self._old and name not in self._paired])
        theirs = self._rising(b, [self._new[name] for name in b.neighbours or () if name in self._new and name not in self._pair])
        return self.on_one_side(a, b) and (mine is None or theirs is None or mine == theirs)

    def on_one_side(self, a: FaceEntry, b: FaceEntry) -> bool:
        """Whether two faces lie on the same side of each plane that both adjoin: a wall of a pocket and one of a boss do not."""
        for name in self.of_old(a) & self.of_new(b):
            sides = [_height(face, plane) for face, plane in zip((a, b), self._pair[name], strict=True)]
            if min(abs(side) for side in sides) > _OFF * self._size and (sides[0] > 0.0) != (sides[1] > 0.0):
                return False
        return True

    def _rising(self, face: FaceEntry, others: Sequence[FaceEntry]) -> bool | None:
        """Whether one of some other faces is in front of a plane; None where nothing tells."""
        heights = [_height(other, face) for other in others]
        off = [each for each in heights if abs(each) > _OFF * self._size]
        return max(off) > 0.0 if off else None

    def supports(self, a: FaceEntry, b: FaceEntry) -> bool:
        """Whether two faces on one carrier are rather one face than two: their neighbours agree, or they are near."""
        mine, theirs = self.of_old(a), self.of_new(b)
        if len(mine) > 1 and mine == theirs:
            # Whatever the box of a spline says of where its middle is.
            return True
        if not self.on_one_side(a, b):
            return False
        if mine and theirs:
            return len(mine & theirs) >= _SHARED * min(len(mine), len(theirs))
        return near(a, b)

    def may_be(self, a: FaceEntry, b: FaceEntry) -> bool:
        """Whether a face with the same neighbours may be another one, changed or moved."""
        if a.shape != b.shape or opposed(a, b) or not self.consistent(a, b):
            return False
        if near(a, b):
            return True
        if a.shape not in ("plane", "sculptured"):
            return a.carrier is not None and b.carrier is not None and same_radii(a, b, SAME_CARRIER * self._size)
        if len(self.of_old(a)) < 2:
            # Walls of two pockets in one face have no more in common.
            return False
        return grown(a, b) <= math.log(_GROWN if a.shape == "plane" else _GROWN_FREE)

    def pairs(
        self, old: Sequence[FaceEntry], new: Sequence[FaceEntry], enough: Callable[[int, bool], bool]
    ) -> Iterator[tuple[FaceEntry, FaceEntry]]:
        """Pairs of unpaired faces of one form whose paired neighbours are the same ones, and no other face's.

        `enough` says of the number of these, and of whether they are all neighbours of both faces, whether they suffice.
        """
        groups: dict[tuple[str, frozenset[str]], tuple[list[FaceEntry], list[FaceEntry]]] = defaultdict(lambda: ([], []))
        for face in old:
            groups[face.shape, self.of_old(face)][0].append(face)
        for face in new:
            groups[face.shape, self.of_new(face)][1].append(face)
        for (_, shared), (mine, theirs) in groups.items():
            if not shared or max(len(mine), len(theirs)) > _MOST_ALIKE:
                continue
            for a, b in alone((a, b) for a in mine for b in theirs if self.may_be(a, b)):
                if enough(len(shared), len(shared) == len(a.neighbours or ()) == len(b.neighbours or ())):
                    yield a, b


def _height(face: FaceEntry, plane: FaceEntry) -> float:
    """How far the middle of a face is out of a plane, mm; 0 where that is not known."""
    carrier = plane.carrier
    if plane.shape != "plane" or carrier is None or carrier.direction is None or carrier.outward is None or not face.centre_mm:
        return 0.0
    out = sum(n * (x - y) for n, x, y in zip(carrier.direction, face.centre_mm, carrier.point_mm, strict=True))
    return out if carrier.outward else -out


def alone(pairs: Iterable[tuple[FaceEntry, FaceEntry]]) -> list[tuple[FaceEntry, FaceEntry]]:
    """The pairs whose faces are in no other pair."""
    every = list(pairs)
    counts: tuple[dict[str, int], dict[str, int]] = defaultdict(int), defaultdict(int)
    for a, b in every:
        counts[0][a.id] += 1
        counts[1][b.id] += 1
    return [(a, b) for a, b in every if counts[0][a.id] == counts[1][b.id] == 1]


def near(a: FaceEntry, b: FaceEntry) -> bool:
    """Whether two faces are no farther from each other than the larger one is long, about."""
    if a.centre_mm is None or b.centre_mm is None:
        return False
    area = max((face.area_mm2 for face in (a, b) if math.isfinite(face.area_mm2)), default=0.0)
    return math.dist(a.centre_mm, b.centre_mm) <= math.sqrt(max(area, 0.0))


def grown(a: FaceEntry, b: FaceEntry) -> float:
    """Logarithm of the ratio of two areas, infinite where one is not known."""
    if not (0.0 < a.area_mm2 < math.inf and 0.0 < b.area_mm2 < math.inf):
        return math.inf
    return abs(math.log(a.area_mm2 / b.area_mm2))
