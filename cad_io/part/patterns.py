"""Patterns: motions that carry a part, or some faces, onto equal faces; and bodies and faces that lie where earlier ones lie.

Candidates come from what any motion keeps: the middles of borders, their lengths and second moments. Each candidate is then
compared face by face (`equal_faces.equal`) within a millionth of the part's size: a part that is nearly a pattern is none, and
a copy that is nearly there, or mirrored, is another body, and so is one that shares some of its faces only. What follows from
it for verdicts is `docs/operations_proof.md`, lemma P2. A motion of the whole part keeps the middle of all borders and their
second moment: few axes and planes can be its own.
"""

import math
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from OCP.TopAbs import TopAbs_SHELL, TopAbs_SOLID
from scipy.spatial import cKDTree

from cad_io.arrays import Floats, Record
from cad_io.graphs import connected
from cad_io.kernel import explore
from cad_io.part.equal_faces import FaceShape, Motion, axis_of, equal, face_shape
from cad_io.part.part import NO_AREA, Part

Kind = Literal["rotation", "mirror", "shift"]
Which = NDArray[np.int64]
#: Faces are equal within this share of the part's size; candidates are looked for within that one.
EXACT, _NEAR = 1e-6, 2e-5
#: Parts with more faces are not looked at; orders of a rotation; copies of a shift; patterns of some faces.
_MOST_FACES, _MOST_ORDER, _MOST_COPIES, _MOST_PATTERNS = 3000, 360, 2000, 24
#: Axes and planes that are tried, at most, and times that two faces are compared.
_MOST_TRIED, _MOST_COMPARED = 200, 20_000
#: Copies that some faces have at least.
_LEAST_COPIES = 3


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Pattern(Record):
    """Faces that are equal under motions."""

    #: `rotation`, `mirror` or `shift`.
    kind: Kind
    #: How many copies there are: the whole turn over the angle of a rotation, 2 of a mirror.
    order: int
    #: Whether each motion carries each face of the part onto a face of it.
    whole: bool
    #: Of the first copy to each other one, `order` - 1.
    motions: tuple[Motion, ...]
    #: Of each motion: which face goes onto which, by their numbers; all faces of a whole part, else those of the first copy.
    images: tuple[Mapping[int, int], ...]
    #: By class of equal faces, the first copy's first; of a whole part without faces that go onto themselves.
    faces: tuple[tuple[int, ...], ...]


@dataclass(frozen=True, eq=False)
class _Faces:
    """All faces of a part that can be compared."""

    shape: list[FaceShape]
    #: (n,); Class of each: those of one class are alike as far as area, border and its moments say.
    kind: Which
    #: (n, 3)
    centre: Floats
    #: Of the part, mm.
    size: float
    #: Whether these are all faces of the part.
    whole: bool
    compared: list[int]

    @property
    def near(self) -> float:
        return _NEAR * self.size

    def classes(self) -> Iterator[Which]:
        """Faces of each class with more than one of them, the largest area first."""
        every = [np.flatnonzero(self.kind == k) for k in np.unique(self.kind)]
        several = [each for each in every if len(each) > 1]
        yield from sorted(several, key=lambda rows: (-sum(self.shape[k].area for k in rows), int(rows[0])))

    def equal(self, one: int, other: int, motion: Motion) -> bool:
        """Whether a face, moved, is another one; False where enough was compared."""
        self.compared[0] += 1
        if self.compared[0] > _MOST_COMPARED:
            return False
        return equal(self.shape[one], self.shape[other], motion, EXACT * self.size)


def patterns(part: Part, at: Callable[[int], None] = lambda face: None, without: Collection[int] = ()) -> tuple[Pattern, ...]:
    """The patterns of a part: first those that carry all of it onto itself, then those of some faces.

    `at` is told which face is looked at; `without` are numbers of faces that are left out, as if they were not there.

    No face is in two patterns of some faces. Where nothing is alike, it takes a few ms.
    """
    faces = _faces_of(part, at, without)
    if faces is None or not any(True for _ in faces.classes()):
        return ()
    whole = [*_whole(faces)] if faces.whole else []
    # A plate of pockets goes onto itself by half a turn, and its pockets are shifted all the same.
    taken = {number for each in whole if each.order >= _LEAST_COPIES for ring in each.faces for number in ring}
    return (*whole, *_of_some(faces, taken))


def _faces_of(part: Part, at: Callable[[int], None], without: Collection[int]) -> _Faces | None:
    size = float(np.linalg.norm(part.size))
    there = [f for f in part.faces if f.number not in without]
    judged = [f for f in there if f.unjudged is None]
    if not 1 < len(judged) <= _MOST_FACES or not np.isfinite(size):
        return None
    shapes = list[FaceShape]()
    for face in judged:
        at(face.number)
        shape = face_shape(part, face.number, size)
        if shape is not None:
            shapes.append(shape)
    whole = not part.lost and not part.aside and len(shapes) == sum(f.unjudged != NO_AREA for f in there)
    if not shapes:
        return None
    # Class of each face, by its kind, area, border length and second moments.
    kinds = {kind: k for k, kind in enumerate(sorted({each.kind for each in shapes}))}
    # In lengths, so that one distance tells; kinds are far apart.
    feature = np.array([
        [kinds[each.kind] * 10.0 * size, math.sqrt(abs(each.area)), each.length,
         *np.sqrt(np.maximum(0.0, np.linalg.eigvalsh(each.tensor))).tolist()] for each in shapes
    ])  # fmt: skip
    kind = connected(len(shapes), cKDTree(feature).query_pairs(1e-4 * size, output_type="ndarray")).astype(np.int64)
    return _Faces(shapes, kind, np.array([each.centre for each in shapes]), size, whole, [0])


# Motions of the whole part.


def _whole(faces: _Faces) -> Iterator[Pattern]:
    """Rotations about each axis, of the highest order, then mirrors."""
    weight = np.array([each.length for each in faces.shape])
    middle = weight @ faces.centre / weight.sum()
    away = faces.centre - middle
    tensor = (away * weight[:, None]).T @ away / weight.sum() + sum(
        w * each.tensor for w, each in zip(weight, faces.shape, strict=True)
    ) / weight.sum()  # fmt: skip
    own = np.linalg.eigh(tensor)[1].T
    axes = list(_axes(faces, middle, own))
    for place, direction in axes[:_MOST_TRIED]:
        for order in _orders(faces, place, direction):
            images = _images(faces, Motion.turn(place, direction, 2.0 * math.pi / order))
            if images is not None:
                yield _rotation(faces, place, direction, order, images)
                break
    for normal in list(_normals(faces, middle, own, axes))[:_MOST_TRIED]:
        motion = Motion.mirror(middle, normal)
        images = _images(faces, motion)
        if images is not None:
            yield Pattern("mirror", 2, True, (motion,), (_numbers(faces, images),), _rings(faces, [images]))


def _axes(faces: _Faces, middle: Floats, own: Floats) -> Iterator[tuple[Floats, Floats]]:
    """Axes through the middle: of faces of revolution, across circles of alike faces, and the principal ones."""
    directions = list[tuple[Floats, Floats]]()
    for axis in map(axis_of, faces.shape):
        if axis is not None:
            place, direction = axis
            foot = place + ((middle - place) @ direction) * direction
            if np.linalg.norm(foot - middle) <= faces.near:
                directions.append((foot, direction))
    for rows in faces.classes():
        if len(rows) >= 3:
            spread, across = np.linalg.svd(faces.centre[rows] - faces.centre[rows].mean(axis=0))[1:]
            if spread[2] <= faces.near and spread[1] > faces.near:
                directions.append((middle, across[2]))
    yield from _each_once([*directions, *((middle, each) for each in own)])


def _signed(direction: Floats) -> Floats:
    """A direction, or its opposite: its longest component is positive."""
    return np.asarray(direction * (1.0 if direction[np.abs(direction).argmax()] > 0.0 else -1.0))


def _each_once(axes: Iterable[tuple[Floats, Floats]]) -> Iterator[tuple[Floats, Floats]]:
    """Axes without those that have the direction of an earlier one."""
    tried = np.zeros((0, 3))
    for place, direction in axes:
        direction = _signed(direction)
        if not (np.linalg.norm(tried - direction, axis=1) < 1e-5).any():
            tried = np.concatenate([tried, direction[None]])
            yield place, direction


def _orders(faces: _Faces, place: Floats, direction: Floats) -> Iterator[int]:
    """Orders that a rotation of all faces about an axis may have, the highest first, by the middles of faces alone."""
    away = faces.centre - place
    radius = np.linalg.norm(away - np.outer(away @ direction, direction), axis=1)
    off = radius > faces.near
    counts = np.bincount(faces.kind[off])
    common = int(np.gcd.reduce(counts[counts > 0])) if off.any() else 1
    for order in range(min(common, _MOST_ORDER), 1, -1):
        if common % order == 0 and _moved(faces, Motion.turn(place, direction, 2.0 * math.pi / order)) is not None:
            yield order


def _moved(faces: _Faces, motion: Motion) -> Which | None:
    """Onto which face of its class each one is moved, by their middles; None where one has none."""
    far = 10.0 * faces.size
    there = np.column_stack([faces.centre, far * faces.kind])
    moved = np.column_stack([motion.points(faces.centre), far * faces.kind])
    off, image = cKDTree(there).query(moved)
    if (off > faces.near).any() or len(np.unique(image)) < len(image):
        # Faces of one class and middle: each is told apart by its border.
        return _sorted_out(faces, motion, there, moved) if (off <= faces.near).all() else None
    return np.asarray(image, np.int64)


def _sorted_out(faces: _Faces, motion: Motion, there: Floats, moved: Floats) -> Which | None:
    """As `_moved`, for faces that share their middle with others."""
    image, taken = np.full(len(moved), -1, np.int64), set[int]()
    for k, near in enumerate(cKDTree(there).query_ball_point(moved, faces.near)):
        mine = next((j for j in near if j not in taken and faces.equal(k, j, motion)), None)
        if mine is None:
            return None
        taken.add(mine)
        image[k] = mine
    return image


def _images(faces: _Faces, motion: Motion) -> Which | None:
    """Onto which face each one is moved, compared; None where one is moved onto none."""
    image = _moved(faces, motion)
    if image is None:
        return None
    # Those that go elsewhere tell sooner.
    order = np.argsort(image == np.arange(len(image)), kind="stable").tolist()
    return image if all(faces.equal(k, int(image[k]), motion) for k in order) else None


def _rotation(faces: _Faces, place: Floats, direction: Floats, order: int, images: Which) -> Pattern:
    powers, step = [images], images
    for _ in range(order - 2):
        step = images[step]
        powers.append(step)
    motions = tuple(Motion.turn(place, direction, 2.0 * math.pi * k / order) for k in range(1, order))
    return Pattern("rotation", order, True, motions, tuple(_numbers(faces, each) for each in powers), _rings(faces, powers))


def _rings(faces: _Faces, powers: Sequence[Which]) -> tuple[tuple[int, ...], ...]:
    """Faces that go onto others: the first one of each class, then its images."""
    rings, seen = list[tuple[int, ...]](), set[int]()
    for k in range(len(faces.shape)):
        ring = tuple(dict.fromkeys([k, *(int(each[k]) for each in powers)]))
        if k not in seen and len(ring) > 1:
            rings.append(tuple(faces.shape[j].number for j in ring))
        seen |= set(ring)
    area = {each.number: each.area for each in faces.shape}
    return tuple(sorted(rings, key=lambda ring: (-area[ring[0]], ring[0])))


def _numbers(faces: _Faces, images: Which) -> dict[int, int]:
    return {each.number: faces.shape[j].number for each, j in zip(faces.shape, images.tolist(), strict=True)}


def _normals(faces: _Faces, middle: Floats, own: Floats, axes: Sequence[tuple[Floats, Floats]]) -> Iterator[Floats]:
    """Normals of planes through the middle that may mirror the part: by the middles of faces."""
    some = [*own]
    # With equal principal moments there may be others: one face goes onto another one of its class.
    rows = min(faces.classes(), key=len, default=np.zeros(0, np.int64))
    for k in rows[1:_MOST_TRIED]:
        away = faces.centre[k] - faces.centre[rows[0]]
        if np.linalg.norm(away) > faces.near:
            some.append(away / np.linalg.norm(away))
    some += [np.cross(direction, faces.centre[rows[0]] - middle) for _, direction in axes if len(rows)]
    units = ((middle, each / length) for each in some if (length := np.linalg.norm(each)) > 1e-9)
    yield from (normal for _, normal in _each_once(units))


# Motions of some faces.


def _of_some(faces: _Faces, taken: set[int]) -> Iterator[Pattern]:
    """Rings of faces that a rotation carries round, and faces that shifts carry onto each other: those with most area first."""
    groups: dict[tuple[str, tuple[float, ...]], tuple[list[Motion], list[Which]]] = {}
    for rows in faces.classes():
        free = rows[[faces.shape[k].number not in taken for k in rows]]
        for kind, motions, copies in (*_ring(faces, free), *_shifted(faces, free)):
            # Classes that the same motions carry round are one pattern.
            step = np.concatenate([motions[0].linear.ravel(), *(each.shift / faces.size for each in motions)])
            key = kind, tuple(np.round(step, 4).tolist())
            common = groups.get(key, (motions, []))[0]
            if all(faces.equal(int(copies[0]), int(k), m) for k, m in zip(copies[1:], common, strict=True)):
                groups.setdefault(key, (common, []))[1].append(copies)
                if kind == "rotation":
                    break
    area = {key: sum(faces.shape[c[0]].area for c in each[1]) for key, each in groups.items()}
    for key in sorted(groups, key=lambda key: -area[key])[:_MOST_PATTERNS]:
        motions, every = groups[key]
        number = [tuple(faces.shape[k].number for k in copies) for copies in every]
        images = tuple({ring[0]: ring[k] for ring in number} for k in range(1, len(motions) + 1))
        yield Pattern(key[0], len(motions) + 1, False, tuple(motions), images, tuple(number))  # type: ignore[arg-type]


def _ring(faces: _Faces, rows: Which) -> Iterator[tuple[str, list[Motion], Which]]:
    """Faces evenly spread on one circle, with the rotations that carry the first one to each other one."""
    n = len(rows)
    if not _LEAST_COPIES <= n <= _MOST_ORDER:
        return
    middle = faces.centre[rows].mean(axis=0)
    away = faces.centre[rows] - middle
    across = np.linalg.svd(away, full_matrices=False)[2]
    direction = across[2] if n > 3 else np.cross(away[0], away[1])
    if n == 3 and np.linalg.norm(direction) > 0.0:
        direction = direction / np.linalg.norm(direction)
    radius = np.linalg.norm(away, axis=1)
    if np.abs(away @ direction).max() > faces.near or np.ptp(radius) > faces.near or radius.min() <= faces.near:
        return
    direction = _signed(direction)
    x = away[0] / radius[0]
    angle = np.remainder(np.arctan2(away @ np.cross(direction, x), away @ x), 2.0 * math.pi)
    order = np.argsort(np.where(angle > 2.0 * math.pi - 1e-6, 0.0, angle), kind="stable")
    if np.abs(angle[order] - 2.0 * math.pi * np.arange(n) / n)[1:].max() * radius[0] > faces.near:
        return
    yield "rotation", [Motion.turn(middle, direction, 2.0 * math.pi * k / n) for k in range(1, n)], rows[order]


def _shifted(faces: _Faces, rows: Which) -> Iterator[tuple[str, list[Motion], Which]]:
    """Faces that are shifted copies of each other: those whose borders have the second moment of the first one left."""
    left = rows
    while len(left) >= _LEAST_COPIES:
        first = faces.shape[left[0]]
        alike = [_parallel(first, faces.shape[k], faces.near) for k in left]
        mine, left = left[alike], left[~np.array(alike)]
        if not _LEAST_COPIES <= len(mine) <= _MOST_COPIES:
            continue
        # In one order whatever the class: along the coordinates, to what can be told apart.
        place = np.round((faces.centre[mine] - faces.centre[mine[0]]) / (50.0 * faces.near))
        order = np.lexsort(place.T[::-1])
        mine = mine[order]
        yield "shift", [Motion.translation(faces.centre[k] - faces.centre[mine[0]]) for k in mine[1:]], mine


def _parallel(one: FaceShape, other: FaceShape, near: float) -> bool:
    """Whether a face may be another one shifted, by what a shift keeps."""
    if np.abs(one.tensor - other.tensor).max() > near * one.length:
        return False
    return bool(np.abs(one.side * one.vector - other.side * other.vector).max() <= 1e-3 * one.area)


#: Middles of boxes, and roots of areas, of faces that may be one differ by less than this share of the part's size: the smaller
#: ones for parts of which too many faces lie so near.
_NEAR_SHARES = (1e-3, 1e-4, 1e-5)
#: Pairs of faces that are looked at, at most, to a face.
_MOST_PAIRS = 50


@dataclass(frozen=True, slots=True)
class Repeat:
    """Solids, or faces, that lie in one place."""

    #: Face numbers of each, in the order of the part; of all the same face is at the same place.
    faces: tuple[tuple[int, ...], ...]
    #: Numbers of the solids in the part, from 1, and 0 of a shell; empty of loose faces and of faces that one solid has twice.
    bodies: tuple[int, ...] = ()


def repeats(part: Part) -> tuple[Repeat, ...]:
    """Find what a part has more than once in one place; it is looked for once."""
    if part.repeats is None:
        part.repeats = tuple(_each(part))
    return part.repeats


def repeated_faces(part: Part, ignored: Collection[int] = ()) -> dict[int, int]:
    """Which faces repeat others and are left out, each with the face that stands for it.

    Of what lies in one place that stays of which no face is ignored, the first one; where some of each is ignored, all stay as
    they are.
    """
    result: dict[int, int] = {}
    for each in repeats(part):
        whole = [faces for faces in each.faces if not set(faces) & set(ignored)]
        if whole:
            others = [faces for faces in each.faces if faces != whole[0]]
            result |= {n: stays for faces in others for n, stays in zip(faces, whole[0], strict=True) if n != stays}
    # Where a face that stands for another is left out itself, what stands for that.
    for number, stays in result.items():
        while stays in result:
            stays = result[stays]
        result[number] = stays
    return {number: stays for number, stays in result.items() if number not in ignored}


def doubled(part: Part) -> Mapping[int, int]:
    """Loose faces, and faces that one solid has twice, that repeat an earlier one: by number, which time it is, from 1."""
    return {faces[0]: nth for each in repeats(part) if not each.bodies for nth, faces in enumerate(each.faces) if nth}


def _each(part: Part) -> Iterator[Repeat]:
    compared = _Compared(part)
    if not compared.near:
        return
    # A solid may stand there once more as its shell.
    solids, shells = (
        [tuple(dict.fromkeys(n for n, _ in part.members(each) if n)) for each in shapes]
        for shapes in (part.solid_shapes(), explore(part.shape, TopAbs_SHELL, TopAbs_SOLID))
    )
    for faces in solids:
        yield from _faces(compared, faces, sided=True)
    groups: list[list[tuple[int, tuple[int, ...]]]] = []
    for number, faces in [*enumerate(solids, 1), *((0, each) for each in shells)]:
        for group in groups:
            _, first = group[0]
            there = compared.onto(first, faces)
            if there is not None and first != there:
                group.append((number, there))
                break
        else:
            if number:
                groups.append([(number, faces)])
    for group in groups:
        if len(group) > 1:
            yield Repeat(tuple(faces for _, faces in group), tuple(number for number, _ in group))
    in_solids = {n for faces in solids for n in faces}
    yield from _faces(compared, [f.number for f in part.faces if f.number not in in_solids], sided=False)


def _faces(compared: "_Compared", numbers: Sequence[int], *, sided: bool) -> Iterator[Repeat]:
    """Faces of a set that lie where others of it lie; `sided`: only with the same outer side."""
    groups: dict[int, list[int]] = {}
    taken: set[int] = set()
    mine = set(numbers)
    for first in sorted(mine):
        if first in taken:
            continue
        more = [n for n in compared.near.get(first, ()) if n > first and n in mine and compared.same(first, n, sided=sided)]
        groups[first] = [first, *more]
        taken.update(more)
    for group in groups.values():
        if len(group) > 1:
            yield Repeat(tuple((n,) for n in group))


class _Compared:
    """The faces of a part as they are compared, each made when first asked for."""

    def __init__(self, part: Part) -> None:
        self.size = float(np.linalg.norm(part.size))
        self._shape = cache(partial(face_shape, part, size=self.size))
        self.near: dict[int, list[int]] = {}
        usable = [f for f in part.faces if f.area > 0.0 and part.centre(f.number) is not None]
        feature = np.array([[*(part.centre(f.number) or ()), np.sqrt(f.area)] for f in usable]).reshape(-1, 4)
        if len(usable) < 2 or not np.isfinite(feature).all():
            return
        tree, most = cKDTree(feature), (1 + 2 * _MOST_PAIRS) * len(usable)
        near = next((each * self.size for each in _NEAR_SHARES if tree.count_neighbors(tree, each * self.size) <= most), 0.0)
        for i, j in sorted(tree.query_pairs(near)):
            a, b = usable[i].number, usable[j].number
            self.near.setdefault(a, []).append(b)
            self.near.setdefault(b, []).append(a)

    def onto(self, faces: Sequence[int], others: Sequence[int]) -> tuple[int, ...] | None:
        """The faces of another solid in the order of those of one in whose place it lies; None where it does not."""
        remaining = set(others)
        if len(faces) != len(others):
            return None
        there: list[int] = []
        for n in faces:
            same = n if n in remaining else next((m for m in self.near.get(n, ()) if m in remaining and self.same(n, m)), None)
            if same is None:
                return None
            remaining.discard(same)
            there.append(same)
        return tuple(there)

    def same(self, one: int, other: int, *, sided: bool = False) -> bool:
        """Whether two faces are one; `sided`: with the same outer side, too."""
        a, b = self._shape(one), self._shape(other)
        if a is None or b is None:
            return False
        return any(
            equal(a, replace(b, side=way * b.side), Motion.translation(np.zeros(3)), EXACT * self.size)
            for way in ((1.0,) if sided else (1.0, -1.0))
        )
