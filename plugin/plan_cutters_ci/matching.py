"""Which face of one plan is which of another one, and which cutter: the numbers of faces shift as soon as one is added.

Faces are matched as the same surface only: where they stood, or on the same carrier. Each step pairs what is left of those before
it, and what has two candidates is paired with neither: a wrong pair would tell a loss that is none, or hide one.
"""

import math
from collections import Counter, defaultdict
from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from itertools import product
from typing import Any, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from plan_cutters.plan_file.model import CutterEntry, FaceEntry, Plan
from plan_cutters_ci.model import CutterMatch, FaceMatch

#: Areas that differ by less than this share, and places by less than this share of the part's diagonal, are the same.
SAME = 1e-5
#: The next best candidate must be as many times farther off.
CLEARLY = 1.5
#: A free-form face has no carrier: trimmed anew, its area changes by less than this factor, and its middle hardly moves, as a
#: share of how long it is.
_TRIMMED, _HARDLY = 1.25, 0.25
#: Pairs of free-form faces that are looked at, at most: beyond, faces stay unknown and are told.
_MOST_PAIRS = 1_000_000
#: Share of the part's area that must be found at other places for a part that was moved as a whole.
_MOVED = 0.5
#: A face on the same carrier whose middle is off by less, as a share of the part's diagonal, stays: exports differ by so much.
_STAYS = 1e-3
#: Carriers are the same where their points, radii and angles (rad) differ by less than this share of the part's diagonal.
_SAME_CARRIER = 1e-4
#: Cosine of the angle between the normals, or the axes, of two faces that may be one face, changed.
_AGREE = 0.7
#: Share of the fewer paired neighbours that must correspond where two faces lie on one carrier.
_SHARED = 0.5
#: A face whose middle is no farther from a plane, as a share of the part's diagonal, is on no side of it.
_OFF = 1e-4

Item = TypeVar("Item", FaceEntry, CutterEntry)
Pair = tuple[FaceEntry, FaceEntry]
Matched = list[tuple[FaceEntry, FaceEntry, FaceMatch]]


class _Surroundings:
    """Paired neighbours of faces of both plans, in ids of the new one; `size` of the part, mm."""

    def __init__(self, pairs: Iterable[Pair], size: float) -> None:
        self._pair: dict[str, Pair] = {b.id: (a, b) for a, b in pairs}
        self._paired = {a.id: name for name, (a, _) in self._pair.items()}
        self._size = size

    def of_old(self, face: FaceEntry) -> frozenset[str]:
        """Which faces the paired neighbours of an old face have become."""
        return frozenset(self._paired[name] for name in face.neighbours or () if name in self._paired)

    def of_new(self, face: FaceEntry) -> frozenset[str]:
        """The paired neighbours of a new face."""
        return frozenset(name for name in face.neighbours or () if name in self._pair)

    def supports(self, a: FaceEntry, b: FaceEntry) -> bool:
        """Whether two faces on one carrier are rather one face than two: their neighbours agree, or they are near."""
        mine, theirs = self.of_old(a), self.of_new(b)
        if len(mine) > 1 and mine == theirs:
            # Whatever the box of a spline says of where its middle is.
            return True
        for name in mine & theirs:
            # On the same side of each plane that both adjoin: a wall of a pocket and one of a boss are not.
            sides = [_height(face, plane) for face, plane in zip((a, b), self._pair[name], strict=True)]
            if min(abs(side) for side in sides) > _OFF * self._size and (sides[0] > 0.0) != (sides[1] > 0.0):
                return False
        if mine and theirs:
            return len(mine & theirs) >= _SHARED * min(len(mine), len(theirs))
        return _near(a, b)


def _height(face: FaceEntry, plane: FaceEntry) -> float:
    """How far the middle of a face is out of a plane, mm; 0 where that is not known."""
    carrier = plane.carrier
    if plane.shape != "plane" or carrier is None or carrier.direction is None or carrier.outward is None or not face.centre_mm:
        return 0.0
    out = sum(n * (x - y) for n, x, y in zip(carrier.direction, face.centre_mm, carrier.point_mm, strict=True))
    return out if carrier.outward else -out


def match_faces(old: Plan, new: Plan) -> Matched:
    """Pairs of faces, in the order of the old numbers, and how each was known again.

    In turn: both plans are of the same bytes in the same unit, so that numbers agree; form, area and place agree; carriers
    agree; a name stands once on each side and the form agrees; of free-form faces place and area agree nearly.
    """
    bytes_of = [(plan.part.sha256, plan.effective.unit) for plan in (old, new)]
    if old.part.sha256 and bytes_of[0] == bytes_of[1]:
        there = {face.id: face for face in new.faces}
        return [(face, there[face.id], "same file") for face in old.faces if face.id in there]
    size, faces = _size(old, new), _Matching(old.faces, new.faces)

    def spread() -> None:
        """Go on from what is paired: same radii first, and again as soon as one is paired."""
        again = True
        while again and all(faces.open):
            by = _Surroundings(((a, b) for a, b, _ in faces.pairs), size)
            again = any(faces.take(_on_carriers(*faces.open, size, by, radius=radius), "carrier") for radius in (True, False))

    faces.take(_in_place(*faces.open, size), "place")
    spread()
    named = _alone(*faces.open, lambda face: (face.name, face.shape) if face.name else None)
    faces.take((pair for pair in named if not _opposed(*pair)), "name")
    faces.take(_in_one_pair(_trimmed(*faces.open)), "trim")
    spread()
    return sorted(faces.pairs, key=lambda pair: int(pair[0].id[1:]))


class _Matching(Generic[Item]):
    """What is paired of two sides, and how; and what is open still of either."""

    def __init__(self, old: Iterable[Item], new: Iterable[Item]) -> None:
        self.pairs: list[tuple[Item, Item, Any]] = []
        self.open = [*old], [*new]

    def take(self, matched: Iterable[tuple[Item, Item]], how: str) -> bool:
        """Pair some; whether there are any."""
        more = [(a, b, how) for a, b in matched]
        self.pairs += more
        mine, theirs = {a.id for a, _, _ in more}, {b.id for _, b, _ in more}
        self.open = (
            [each for each in self.open[0] if each.id not in mine],
            [each for each in self.open[1] if each.id not in theirs],
        )
        return bool(more)


def with_others(
    old: Iterable[Item], new: Iterable[Item], pairs: Iterable[tuple[Item, Item, Any]]
) -> Iterator[tuple[Item | None, Item | None, Any]]:
    """The pairs of two sides, then what the old one has alone, then what the new one has."""
    mine, theirs = set[str](), set[str]()
    for a, b, how in pairs:
        mine.add(a.id)
        theirs.add(b.id)
        yield a, b, how
    yield from ((each, None, None) for each in old if each.id not in mine)
    yield from ((None, each, None) for each in new if each.id not in theirs)


def _size(old: Plan, new: Plan) -> float:
    """The diagonal of a box that holds either part, mm."""
    return math.hypot(*(max(a, b) for a, b in zip(old.part.size_mm, new.part.size_mm, strict=True)))


def moved_faces(old: Plan, new: Plan, pairs: Matched) -> int:
    """How many faces of both plans stand at other places, where they are most of the part; else 0.

    The part was moved, turned or mirrored as a whole then, or drawn about another origin. Two faces on one carrier of which one
    is the other one shifted count as well: of a part that moved these are two features as often as one.
    """
    off = _STAYS * _size(old, new)
    stay = [(a.id, b.id) for a, b, how in pairs if how != "carrier" or _away(a, b) <= off]
    sides = [[f for f in plan.faces if 0.0 < f.area_mm2 < math.inf] for plan in (old, new)]
    rest = [
        Counter((f.shape, f"{f.area_mm2:.4g}") for f in side if f.id not in known)
        for side, known in zip(sides, zip(*stay, strict=True) if stay else ((), ()), strict=True)
    ]
    shifted = rest[0] & rest[1]
    area = sum(float(each) * number for (_, each), number in shifted.items())
    whole = max(sum(f.area_mm2 for f in side) for side in sides)
    return shifted.total() if area > _MOVED * whole else 0


def _away(a: FaceEntry, b: FaceEntry) -> float:
    """How far the middles of two faces are from each other, mm; infinite where one is not known."""
    return math.dist(a.centre_mm, b.centre_mm) if a.centre_mm and b.centre_mm else math.inf


def _trimmed(old: Sequence[FaceEntry], new: Sequence[FaceEntry]) -> Iterator[Pair]:
    """Free-form faces that have nearly the same place and area."""
    for mine, theirs in _grouped(old, new, _placed_form):
        if mine[0].shape != "sculptured" or len(mine) * len(theirs) > _MOST_PAIRS:
            continue
        for a, b in product(mine, theirs):
            ratio, away = a.area_mm2 / b.area_mm2, _away(a, b)
            if 1.0 / _TRIMMED <= ratio <= _TRIMMED and away <= _HARDLY * math.sqrt(max(a.area_mm2, b.area_mm2)):
                yield a, b


def _on_carriers(
    old: Sequence[FaceEntry], new: Sequence[FaceEntry], size: float, by: _Surroundings, *, radius: bool
) -> list[Pair]:
    """Pairs on one carrier that are in no other such pair; of several, those with the same neighbours, or nearest by far."""
    pairs = [pair for pair in _on_one_carrier(old, new, size, radius=radius) if by.supports(*pair)]
    for some in (
        _in_one_pair(pairs),
        _in_one_pair((a, b) for a, b in pairs if by.of_old(a) and by.of_old(a) == by.of_new(b)),
        list(_nearest(pairs, size)),
    ):
        if some:
            return some
    return []


def _nearest(pairs: Sequence[Pair], size: float) -> Iterator[Pair]:
    """Of pairs those whose faces are nearer to each other than to any other, by far."""
    away = [_away(*pair) for pair in pairs]
    rows, columns = defaultdict[str, list[float]](list), defaultdict[str, list[float]](list)
    for (a, b), far in zip(pairs, away, strict=True):
        rows[a.id].append(far)
        columns[b.id].append(far)
    for (a, b), far in zip(pairs, away, strict=True):
        # Once in its row and once in its column the pair itself is nearest: the second entry is the next best.
        others = [sorted(each)[1] for each in (rows[a.id], columns[b.id]) if len(each) > 1]
        first = far == min(rows[a.id]) == min(columns[b.id])
        if first and _near(a, b) and all(other >= CLEARLY * max(far, SAME * size) for other in others):
            yield a, b


def match_cutters(old: Plan, new: Plan) -> list[tuple[CutterEntry, CutterEntry, CutterMatch]]:
    """Pairs of cutters by id; else by the name, then by the cutting part, where it stands once on each side."""
    cutters = _Matching(sorted(old.cutters, key=lambda c: c.id), sorted(new.cutters, key=lambda c: c.id))
    steps: tuple[tuple[CutterMatch, Callable[[CutterEntry], Hashable]], ...] = (
        ("id", lambda c: c.id),
        ("name", lambda c: c.name or None),
        ("cutting part", lambda c: (c.shape, c.radius, c.corner_radius, c.taper_deg)),
    )
    for how, key in steps:
        cutters.take(_alone(*cutters.open, key), how)
    return sorted(cutters.pairs, key=lambda pair: pair[0].id)


def _alone(old: Iterable[Item], new: Iterable[Item], key: Callable[[Item], Hashable]) -> Iterable[tuple[Item, Item]]:
    """Pairs whose key stands once on each side; None is no key."""
    yield from ((mine[0], theirs[0]) for mine, theirs in _grouped(old, new, key) if len(mine) == len(theirs) == 1)


def _grouped(
    old: Iterable[Item], new: Iterable[Item], key: Callable[[Item], Hashable]
) -> Iterator[tuple[list[Item], list[Item]]]:
    """What both sides have of each key, but None."""
    sides = defaultdict[Hashable, list[Item]](list), defaultdict[Hashable, list[Item]](list)
    for side, groups in zip((old, new), sides, strict=True):
        for each in side:
            groups[key(each)].append(each)
    yield from ((mine, sides[1][word]) for word, mine in sides[0].items() if word is not None and word in sides[1])


def _in_place(old: Sequence[FaceEntry], new: Sequence[FaceEntry], size: float) -> list[Pair]:
    """Pairs of one form whose area and place agree; several in one place are paired in the order of their numbers."""

    def placed(faces: Sequence[FaceEntry]) -> NDArray[np.float64]:
        """Rows (n, 4): places in sizes of the part, and logarithms of areas."""
        at = np.array([face.centre_mm for face in faces]) / max(size, 1e-300)
        return np.column_stack([at, np.log([face.area_mm2 for face in faces])])

    pairs: list[Pair] = []
    for mine, theirs in _grouped(old, new, _placed_form):
        taken = set[int]()
        for face, rows in zip(mine, cKDTree(placed(theirs)).query_ball_point(placed(mine), SAME), strict=True):
            row = next((j for j in sorted(rows) if j not in taken and not _opposed(face, theirs[j])), None)
            if row is not None:
                taken.add(row)
                pairs.append((face, theirs[row]))
    return pairs


def _placed_form(face: FaceEntry) -> str | None:
    """The form of a face that has a place and an area; else None."""
    return face.shape if face.centre_mm is not None and 0.0 < face.area_mm2 < math.inf else None


def _on_one_carrier(old: Sequence[FaceEntry], new: Sequence[FaceEntry], size: float, *, radius: bool) -> Iterator[Pair]:
    """Pairs of faces of one form on the same carrier, of one angle; with `radius`, their radii agree, too."""
    within = _SAME_CARRIER * size

    def row(face: FaceEntry, sign: float = 1.0) -> tuple[float, ...]:
        """Six lengths, mm, that say where a carrier is."""
        assert face.carrier is not None
        return *face.carrier.point_mm, *(sign * size * x for x in face.carrier.direction or (0.0, 0.0, 0.0))

    for mine, theirs in _grouped(old, new, lambda face: None if face.carrier is None else face.shape):
        # A direction and its opposite are the same.
        tree = cKDTree(np.array([row(face, sign) for sign in (1.0, -1.0) for face in theirs]))
        near = tree.query_ball_point(np.array([row(face) for face in mine]), within, p=np.inf)
        for a, rows in zip(mine, near, strict=True):
            for b in (theirs[j] for j in sorted({row % len(theirs) for row in rows})):
                one, other = a.carrier, b.carrier
                if one is None or other is None or _opposed(a, b):
                    continue
                if abs((one.half_angle_deg or 0.0) - (other.half_angle_deg or 0.0)) > math.degrees(_SAME_CARRIER):
                    continue
                # A face without a radius has none to differ in.
                radii = ((one.radius_mm, other.radius_mm), (one.minor_radius_mm, other.minor_radius_mm))
                if not radius or all(r is None or s is None or abs(r - s) <= within for r, s in radii):
                    yield a, b


def _opposed(a: FaceEntry, b: FaceEntry) -> bool:
    """Whether two faces of one form have their material on other sides, or other directions, as far as they state it."""
    if a.carrier is None or b.carrier is None:
        return False
    way, other = a.carrier.direction, b.carrier.direction
    stated = way is not None and other is not None and any(way) and any(other)
    inner = float(np.dot(way, other)) if stated else 1.0  # type: ignore[arg-type]
    known = None not in (a.carrier.outward, b.carrier.outward)
    same = a.carrier.outward == b.carrier.outward
    if a.shape == "plane":
        return (abs(inner) if not (known and stated) else inner if same else -inner) < _AGREE
    return (known and not same) or abs(inner) < _AGREE


def _in_one_pair(pairs: Iterable[Pair]) -> list[Pair]:
    every = list(pairs)
    olds, news = Counter(a.id for a, _ in every), Counter(b.id for _, b in every)
    return [(a, b) for a, b in every if olds[a.id] == news[b.id] == 1]


def _near(a: FaceEntry, b: FaceEntry) -> bool:
    """Whether two faces are no farther from each other than the larger one is long, about."""
    area = max((face.area_mm2 for face in (a, b) if math.isfinite(face.area_mm2)), default=0.0)
    return _away(a, b) <= math.sqrt(max(area, 0.0))
