"""Bodies, and loose faces, that lie where earlier ones of the part lie: the same surface twice.

Candidates come from the middles of faces' boxes and their areas, so a part without any costs next to nothing. Each candidate is
compared as a face of a pattern is (`equal_faces.equal`), within a millionth of the part's size: a copy that is nearly there, or
mirrored, is another body, and so is one that shares some of its faces only.
"""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from OCP.TopAbs import TopAbs_FACE, TopAbs_REVERSED, TopAbs_SHELL, TopAbs_SOLID
from scipy.spatial import cKDTree

from cad_io.kernel import explore, shape_map
from cad_io.part.equal_faces import FaceShape, equal, face_shape
from cad_io.part.motion import Motion
from cad_io.part.part import Part
from cad_io.part.patterns import EXACT

#: Middles of boxes, and roots of areas, of faces that may be one differ by less than this share of the part's size: the smaller
#: ones for parts of which too many faces lie so near.
_NEAR = (1e-3, 1e-4, 1e-5)
#: Pairs of faces that are looked at, at most, to a face.
_MOST_PAIRS = 50


@dataclass(frozen=True, slots=True)
class Repeat:
    """Solids, or faces, that lie in one place.

    Attributes
    ----------
    faces : tuple of tuple of int
        Face numbers of each, in the order of the part; of all the same face is at the same place.
    bodies : tuple of int
        Numbers of the solids in the part, from 1, and 0 of a shell; empty of loose faces and of faces that one solid has twice.
    """

    faces: tuple[tuple[int, ...], ...]
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
            result |= {
                n: stays
                for faces in each.faces
                if faces != whole[0]
                for n, stays in zip(faces, whole[0], strict=True)
                if n != stays
            }
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
    numbers = shape_map(part.shape, TopAbs_FACE)
    solids = [
        tuple(dict.fromkeys(n for face in explore(each, TopAbs_FACE) if (n := numbers.FindIndex(face))))
        for each in part.solid_shapes()
    ]
    for faces in solids:
        yield from _faces(compared, faces, sided=True)
    # A solid may stand there once more as its shell.
    shells = [
        tuple(dict.fromkeys(numbers.FindIndex(face) for face in explore(each, TopAbs_FACE)))
        for each in explore(part.shape, TopAbs_SHELL, TopAbs_SOLID)
    ]
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


@dataclass(slots=True)
class _Compared:
    """The faces of a part as they are compared, each made when first asked for."""

    part: Part
    shapes: dict[int, FaceShape | None] = field(default_factory=dict)
    near: dict[int, list[int]] = field(init=False)

    def __post_init__(self) -> None:
        part, self.near = self.part, {}
        usable = [f for f in part.faces if f.area > 0.0 and part.centre(f.number) is not None]
        feature = np.array([[*(part.centre(f.number) or ()), np.sqrt(f.area)] for f in usable]).reshape(-1, 4)
        if len(usable) < 2 or not np.isfinite(feature).all():
            return
        tree, most = cKDTree(feature), (1 + 2 * _MOST_PAIRS) * len(usable)
        near = next((each * self.size for each in _NEAR if tree.count_neighbors(tree, each * self.size) <= most), 0.0)
        for i, j in sorted(tree.query_pairs(near)):
            a, b = usable[i].number, usable[j].number
            self.near.setdefault(a, []).append(b)
            self.near.setdefault(b, []).append(a)

    @property
    def size(self) -> float:
        return float(np.linalg.norm(self.part.size))

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

    def _shape(self, number: int) -> FaceShape | None:
        if number not in self.shapes:
            part, info = self.part, self.part.faces[number - 1]
            trim, measured = part.trim(number), part.measure(number)
            side = -1.0 if part.face(number).Orientation() == TopAbs_REVERSED else 1.0
            self.shapes[number] = (
                None
                if trim is None or measured is None
                else face_shape(number, info.surface, side, part.surface(number), trim, measured, self.size)
            )
        return self.shapes[number]
