"""Directions of a part along the spindle that may be worth planning: where they come from, and how the part stands in each."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Record, Triangles
from plan_cutters.scene.preparation import Prepared

#: Families of parallel planes whose normals are tried, and directions spread over the sphere.
_FAMILIES, _SPREAD = 40, 60
#: Directions nearer than this are one: cosine of 0.1 deg.
_ONE = float(np.cos(np.radians(0.1)))


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Candidates(Record):
    """Directions of the part along the spindle that are compared.

    Attributes
    ----------
    axis : (m, 3) float
        Unit directions.
    stands_on : tuple of tuple of int
        For each the numbers of the planar faces that lie on the table.
    lowest : (m,) float
        Height along each of the part's lowest point, mm.
    tall : (m,) float
        How high the part stands along each, mm.
    """

    axis: Floats
    stands_on: tuple[tuple[int, ...], ...]
    lowest: Floats
    tall: Floats

    @classmethod
    def of(cls, ready: Prepared) -> "Candidates":
        """Directions of a cube's corners, edges and faces, normals of planes both ways, and some all over the sphere."""
        triangles, planar = _of_part(ready)
        axis = distinct(np.concatenate([cube(), _normals(triangles.vertex, triangles.face, planar), fibonacci(_SPREAD)]))
        return cls(axis, *planes_below(ready, axis), np.ptp(triangles.vertex.reshape(-1, 3) @ axis.T, axis=0))


def _of_part(ready: Prepared) -> tuple[Triangles, list[int]]:
    """The triangles of the part alone, and the numbers of its planes."""
    surroundings = ready.conditions.surroundings
    planar = [face.number for face in ready.scene.part.faces if face.shape == "plane"]
    return (surroundings.alone or surroundings).certain.triangles, planar


def planes_below(ready: Prepared, axis: Floats) -> tuple[tuple[tuple[int, ...], ...], Floats]:
    """On which planes a part stands, by their numbers, and the height of its lowest point (m,), along some axes (m, 3)."""
    triangles, planar = _of_part(ready)
    height = triangles.vertex.reshape(-1, 3) @ axis.T
    lowest, flat = height.min(axis=0), triangles.chord_error + 1e-6 * float(np.linalg.norm(ready.scene.part.size))
    face = np.repeat(triangles.face, 3)
    tops = {number: height[face == number].max(axis=0) for number in planar if (face == number).any()}
    stands = [tuple(number for number, top in tops.items() if top[k] <= lowest[k] + flat) for k in range(len(axis))]
    return tuple(stands), lowest


def touching(ready: Prepared, axis: Floats) -> tuple[tuple[int, ...], ...]:
    """Faces with which a part touches the plane below it, by their numbers, along some axes (m, 3)."""
    triangles, _ = _of_part(ready)
    height = triangles.vertex.reshape(-1, 3) @ axis.T
    reach = triangles.chord_error + 1e-6 * float(np.linalg.norm(ready.scene.part.size))
    low, face = height <= height.min(axis=0) + reach, np.repeat(triangles.face, 3)
    return tuple(tuple(int(n) for n in np.unique(face[low[:, k]]) if n > 0) for k in range(len(axis)))


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
        if not result or (axis[result] @ axis[k]).max() < _ONE:
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
        same = next((k for k, (_, known) in enumerate(normals) if abs(known @ normal) >= _ONE * size), None)
        if same is None:
            normals.append((size, normal / size))
        else:
            normals[same] = normals[same][0] + size, normals[same][1]
    normals = sorted(normals, key=lambda each: -each[0])[:_FAMILIES]
    return np.array([way * normal for _, normal in normals for way in (1.0, -1.0)]).reshape(-1, 3)
