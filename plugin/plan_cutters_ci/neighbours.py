"""Whether two faces on one carrier are rather one face than two: by the faces across their edges that are already paired."""

import math
from collections import defaultdict
from collections.abc import Iterable, Mapping

from plan_cutters.plan_file.model import FaceEntry

#: Share of the fewer paired neighbours that must correspond where two faces lie on one carrier.
_SHARED = 0.5
#: A face whose middle is no farther from a plane, as a share of the part's diagonal, is on no side of it.
_OFF = 1e-4


class Surroundings:
    """Paired neighbours of faces of both plans, in ids of the new one; `size` of the part, mm."""

    def __init__(self, pairs: Iterable[tuple[FaceEntry, FaceEntry]], size: float) -> None:
        self._pair: Mapping[str, tuple[FaceEntry, FaceEntry]] = {b.id: (a, b) for a, b in pairs}
        self._paired = {a.id: name for name, (a, _) in self._pair.items()}
        self._size = size

    def of_old(self, face: FaceEntry) -> frozenset[str]:
        """Which faces the paired neighbours of an old face have become."""
        return frozenset(self._paired[name] for name in face.neighbours or () if name in self._paired)

    def of_new(self, face: FaceEntry) -> frozenset[str]:
        """The paired neighbours of a new face."""
        return frozenset(name for name in face.neighbours or () if name in self._pair)

    def _on_one_side(self, a: FaceEntry, b: FaceEntry) -> bool:
        """Whether two faces lie on the same side of each plane that both adjoin: a wall of a pocket and one of a boss do not."""
        for name in self.of_old(a) & self.of_new(b):
            sides = [_height(face, plane) for face, plane in zip((a, b), self._pair[name], strict=True)]
            if min(abs(side) for side in sides) > _OFF * self._size and (sides[0] > 0.0) != (sides[1] > 0.0):
                return False
        return True

    def supports(self, a: FaceEntry, b: FaceEntry) -> bool:
        """Whether two faces on one carrier are rather one face than two: their neighbours agree, or they are near."""
        mine, theirs = self.of_old(a), self.of_new(b)
        if len(mine) > 1 and mine == theirs:
            # Whatever the box of a spline says of where its middle is.
            return True
        if not self._on_one_side(a, b):
            return False
        if mine and theirs:
            return len(mine & theirs) >= _SHARED * min(len(mine), len(theirs))
        return near(a, b)


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
