"""Fixtures as exact surfaces, and whether a point lies within one."""

import math

import numpy as np
from numpy.typing import NDArray

from cad_io import Part, read_part
from cad_io.arrays import Floats
from cad_io.read.mesh import Mesh, is_mesh, read_mesh
from plan_cutters_check.question import Body, Setup, frame_of
from plan_cutters_check.surface import Face, Source, Triangles

#: A table reaches so much farther than the part, mm: as far as any tool.
_TABLE = 2000.0
#: Sides of a cylinder; each lies within r (1 - cos(pi / sides)) of it.
_SIDES = 720
#: So many triangles are seen from points at a time.
_AT_ONCE = 100_000
_MESH = (".stl", ".obj", ".ply", ".glb")
#: Corners of the triangles of a box, counter-clockwise from outside.
_BOX = np.array([
    (0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4), (2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2), (1, 3, 7),
    (1, 7, 5),
])  # fmt: skip


def rotation_of(body: Body) -> Floats:
    """The matrix (3, 3) of a placement: about x, then about y, then about z, all fixed in the part."""
    rotation = np.eye(3)
    for k, angle in enumerate(body.placement[3:]):
        c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
        turn = np.eye(3)
        i, j = (k + 1) % 3, (k + 2) % 3
        turn[i, i], turn[i, j], turn[j, i], turn[j, j] = c, -s, s, c
        rotation = turn @ rotation
    return rotation


class PlacedFixture:
    """A fixture where it stands in a setup.

    Attributes
    ----------
    sources : list of Source
        Its surfaces.
    """

    def __init__(self, body: Body, setup: Setup, low: Floats, high: Floats) -> None:
        self.name = f"fixture:{body.name}"
        rotation, shift = rotation_of(body), np.array(body.placement[:3], float)
        self._vertex: Floats | None = None
        if body.kind:
            own = _word(body, setup, rotation, shift, low, high)
            self._vertex = own @ rotation.T + shift
            self.sources: list[Source] = [Triangles(self._vertex, self.name)]
            return
        read = _read(body)
        if isinstance(read, Part):
            self.sources = [
                Face(read, face.number, self.name, rotation, shift) for face in read.faces if read.trim(face.number) is not None
            ]
        else:
            self._vertex = read.vertex @ rotation.T + shift
            self.sources = [Triangles(self._vertex, self.name)]

    @property
    def known(self) -> bool:
        """Whether `holds` knows what lies within."""
        return self._vertex is not None

    def holds(self, points: Floats) -> NDArray[np.bool_]:
        """Which points (n, 3) lie within it, by the solid angle of its triangles; of a CAD file none is known to."""
        if self._vertex is None:
            return np.zeros(len(points), bool)
        inside, corners = np.zeros(len(points)), self._vertex.transpose(1, 0, 2)[:, :, None]
        together = max(1, _AT_ONCE // max(1, len(self._vertex)))
        for start in range(0, len(points), together):
            some = slice(start, start + together)
            p, q, r = corners - points[some]
            u, v, w = (np.linalg.norm(each, axis=2) for each in (p, q, r))
            top = (p * np.cross(q, r)).sum(axis=2)
            under = u * v * w + (p * q).sum(axis=2) * w + (q * r).sum(axis=2) * u + (r * p).sum(axis=2) * v
            inside[some] = 2.0 * np.arctan2(top, under).sum(axis=0)
        return np.asarray(np.abs(inside) > 2.0 * math.pi)


def _read(body: Body) -> Part | Mesh:
    if isinstance(body.source, str):
        if body.source.lower().endswith(_MESH):
            return read_mesh(body.source, body.unit)
        return read_part(body.source, unit=body.unit)
    return read_mesh(body.source, body.unit) if is_mesh(body.source) else read_part(body.source, unit=body.unit)


def _word(body: Body, setup: Setup, rotation: Floats, shift: Floats, low: Floats, high: Floats) -> Floats:
    """Triangles (n, 3, 3), in its own frame, of a fixture that is described by a word, about a part from `low` to `high` (3,)."""
    if body.kind == "box":
        return _box(np.zeros(3), np.array(body.sizes))
    if body.kind == "cylinder":
        radius, height = body.sizes
        # Around the true cylinder, so that nothing of it is left out.
        wide = radius / math.cos(math.pi / _SIDES)
        turn = 2.0 * math.pi * np.arange(_SIDES) / _SIDES
        a = np.column_stack([wide * np.cos(turn), wide * np.sin(turn), np.zeros(_SIDES)])
        b, up, middle = np.roll(a, -1, axis=0), np.array([0.0, 0.0, height]), np.zeros_like(a)
        sides = [(a, b, b + up), (a, b + up, a + up), (b, a, middle), (a + up, b + up, middle + up)]
        return np.concatenate([np.stack(each, axis=1) for each in sides])
    if body.kind == "prism":
        return _prism(body.sizes[0], body.sizes[1], np.array(body.sizes[2:]).reshape(2, -1, 2))
    # A table lies across the setup axis or, if it is turned, across its own z; all below its top is in the way.
    frame = np.eye(3) if any(body.placement[3:]) else frame_of(setup)
    corners = np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])
    own = (corners - shift) @ rotation @ frame.T
    start, end = own.min(axis=0) - _TABLE, own.max(axis=0) + _TABLE
    end[2] = body.sizes[0]
    start[2] = min(start[2], end[2] - _TABLE)
    return np.asarray(_box(start, end) @ frame)


def _prism(low: float, high: float, lines: Floats) -> Floats:
    """Triangles (n, 3, 3) between two polylines (2, m, 2), which need not be convex together: a fan over each piece of both."""
    triangles = []
    (inner, outer), count = lines, lines.shape[1]
    for k in range(count - 1):
        ring = [inner[k], inner[k + 1], outer[k + 1], outer[k]]
        for i, j in ((1, 2), (2, 3)):
            triangles.append([(*ring[0], high), (*ring[i], high), (*ring[j], high)])
            triangles.append([(*ring[0], low), (*ring[j], low), (*ring[i], low)])
    loop = [*inner, *outer[::-1]]
    for p, q in zip(loop, [*loop[1:], loop[0]], strict=True):
        triangles += [[(*p, low), (*q, low), (*q, high)], [(*p, low), (*q, high), (*p, high)]]
    return np.array(triangles, float)


def _box(low: Floats, high: Floats) -> Floats:
    corner = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)])
    return np.asarray((low + corner * (high - low))[_BOX])
