"""Directions of a part along the spindle that may be worth planning: where they come from, and how the part stands in each."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Record, Triangles, rows_by_face
from plan_cutters.domain.placement import frame_of
from plan_cutters.scene.holes import made_of
from plan_cutters.scene.preparation import Prepared
from plan_cutters.setups.workpiece import Bearing, rods_of

#: Families of parallel planes whose normals are tried, and directions spread over the sphere.
_FAMILIES, _SPREAD = 40, 60
#: Triangles of a face whose heights are reckoned at once.
_AT_ONCE = 10_000
#: Planes whose areas differ by less than this factor are as large, and heights by this share of the lowest.
_LARGER, _LOWER = 1.1, 1e-3
#: Directions nearer than this are one: cosine of 0.1 deg.
SAME = float(np.cos(np.radians(0.1)))


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Candidates(Record):
    """Directions of the part along the spindle that are compared."""

    axis: Floats  #: (m, 3) float: unit directions.
    stands_on: tuple[tuple[int, ...], ...]  #: For each the numbers of the planar faces that lie on the table.
    lowest: Floats  #: (m,) float: height along each of the part's lowest point, mm.
    tall: Floats  #: (m,) float: how high the part stands along each, mm.
    bearing: tuple[Bearing, ...]  #: How the part stands on these planes.
    #: Those along which the part is round about cylinders of its own: seen askew a disk may look as round.
    turned: frozenset[int] = frozenset()

    @classmethod
    def of(cls, ready: Prepared) -> "Candidates":
        """Directions of a cube's corners, edges and faces, normals of planes both ways, and some all over the sphere."""
        triangles, planar = _of_part(ready)
        mesh = ready.scene.mesh(triangles)
        # From where drills of the libraries come, if there are any.
        holes = [way * hole.axis for hole in ready.holes if made_of(ready.options.libraries) for way in (1.0, -1.0)]
        normals = _normals(triangles.vertex, triangles.face, planar)
        axis = distinct(np.concatenate([cube(), normals, fibonacci(_SPREAD), np.array(holes).reshape(-1, 3)]))
        heights = _Heights.of(ready, axis)
        stands_on, tall = heights.stood_on(planar), heights.high.max(axis=0) - heights.lowest
        rows, (_, centre) = rows_by_face(mesh.face), mesh.enclosed
        bearing = []
        for k, faces in enumerate(stands_on):
            across = frame_of(axis[k])[:2].T
            below = np.concatenate([np.zeros((0, 3)), *(mesh.vertex[rows[n]].reshape(-1, 3) for n in faces)])
            bearing.append(Bearing.of(mesh.outer @ across, below @ across, centre @ across, float(tall[k])))
        rods = np.array([*rods_of(ready.scene.part.faces).values()]).reshape(-1, 3)
        along = np.flatnonzero((np.abs(axis @ rods.T) > SAME).any(axis=1)).tolist()
        turned = frozenset(k for k in along if bearing[k].round)
        return cls(axis, stands_on, heights.lowest, tall, tuple(bearing), turned)

    def preferred(self, every: Sequence[int]) -> list[int]:
        """Some of them in the order in which one would stand the part: firmly, on a large plane, low, along its own axes."""
        least = max(1e-300, min(each.slender for each in self.bearing))

        def place(k: int) -> tuple[object, ...]:
            mine = self.bearing[k]
            large = round(np.log(mine.area) / np.log(_LARGER)) if mine.firm else 0
            off = np.abs(self.axis[k]).max() < SAME
            return not mine.firm, -large, round(mine.slender / (_LOWER * least)) if np.isfinite(mine.slender) else np.inf, off, k

        return sorted(every, key=place)


class _Heights(NamedTuple):
    """How far faces (f,) reach along axes: heights (f, m) of their lowest and highest corners, and of the lowest of all (m,), mm.
    What is below `bottom` (m,) lies at the bottom: heights that differ by less are one.
    """

    face: NDArray[np.int64]
    low: Floats
    high: Floats
    lowest: Floats
    bottom: Floats

    @classmethod
    def of(cls, ready: Prepared, axis: Floats) -> "_Heights":
        """Of all faces that have triangles, face by face: all heights at once would take gigabytes."""
        triangles = _of_part(ready)[0]
        faces = rows_by_face(triangles.face)
        low, high = np.full((len(faces), len(axis)), np.inf), np.full((len(faces), len(axis)), -np.inf)
        for k, rows in enumerate(faces.values()):
            for part in np.array_split(rows, 1 + len(rows) // _AT_ONCE):
                height = triangles.vertex[part].reshape(-1, 3) @ axis.T
                low[k], high[k] = np.minimum(low[k], height.min(axis=0)), np.maximum(high[k], height.max(axis=0))
        lowest = low.min(axis=0)
        near = triangles.chord_error + 1e-6 * float(np.linalg.norm(ready.scene.part.size))
        return cls(np.array(list(faces), np.int64), low, high, lowest, lowest + near)

    def named(self, which: NDArray[np.bool_]) -> tuple[tuple[int, ...], ...]:
        """Of each axis the numbers of some faces (f, m)."""
        return tuple(tuple(sorted(self.face[mine].tolist())) for mine in which.T)

    def stood_on(self, planar: Sequence[int]) -> tuple[tuple[int, ...], ...]:
        """Of each axis the planes that lie at the bottom."""
        return self.named(np.isin(self.face, planar)[:, None] & (self.high <= self.bottom))


def _of_part(ready: Prepared) -> tuple[Triangles, list[int]]:
    """The triangles of the part alone, and the numbers of its planes."""
    surroundings = ready.conditions.surroundings
    planar = [face.number for face in ready.scene.part.faces if face.shape == "plane"]
    return (surroundings.alone or surroundings).certain.triangles, planar


def planes_below(ready: Prepared, axis: Floats) -> tuple[tuple[int, ...], ...]:
    """On which planes a part stands along some axes (m, 3), by their numbers."""
    return _Heights.of(ready, axis).stood_on(_of_part(ready)[1])


def touching(ready: Prepared, axis: Floats) -> tuple[tuple[int, ...], ...]:
    """Faces with which a part touches the plane below it, by their numbers, along some axes (m, 3)."""
    heights = _Heights.of(ready, axis)
    return heights.named((heights.face > 0)[:, None] & (heights.low <= heights.bottom))


def cube() -> Floats:
    """Directions (26, 3) of a cube's faces, edges and corners; the part's own axes come first, +z as the first of all."""
    every = np.array([(x, y, z) for z in (1, 0, -1) for y in (0, 1, -1) for x in (0, 1, -1) if (x, y, z) != (0, 0, 0)], float)
    every = every[np.argsort(np.abs(every).sum(axis=1), kind="stable")]
    return np.asarray(every / np.linalg.norm(every, axis=1)[:, None])


def fibonacci(count: int) -> Floats:
    """So many unit directions (count, 3), evenly spread."""
    step = np.arange(count) + 0.5
    z, turn = 1.0 - 2.0 * step / count, np.pi * (1.0 + np.sqrt(5.0)) * step
    across = np.sqrt(1.0 - z * z)
    return np.stack([across * np.cos(turn), across * np.sin(turn), z], axis=1)


def distinct(axis: Floats) -> Floats:
    """Directions without those that are nearly one before them."""
    result: list[int] = []
    for k in range(len(axis)):
        if not result or (axis[result] @ axis[k]).max() < SAME:
            result.append(k)
    return axis[result]


def _normals(vertex: Floats, face: NDArray[np.int32], planar: Sequence[int]) -> Floats:
    """Normals of the families of parallel planes with the most area, both ways: the machine may look at them or away."""
    wide = np.cross(vertex[:, 1] - vertex[:, 0], vertex[:, 2] - vertex[:, 0])
    normals: list[tuple[float, Floats]] = []
    for number in planar:
        normal = wide[face == number].sum(axis=0)
        size = float(np.linalg.norm(normal))
        if not size > 0.0:
            continue
        same = next((k for k, (_, known) in enumerate(normals) if abs(known @ normal) >= SAME * size), None)
        if same is None:
            normals.append((size, normal / size))
        else:
            normals[same] = normals[same][0] + size, normals[same][1]
    normals = sorted(normals, key=lambda each: -each[0])[:_FAMILIES]
    return np.array([way * normal for _, normal in normals for way in (1.0, -1.0)]).reshape(-1, 3)
