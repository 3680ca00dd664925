"""Bodies in closed form, each as the CAD kernel makes it, and what booleans make of them: inside or outside, and the exact skin.

Nothing here asks the product: the kernel makes the shape, and the formulas say what it must be.
"""

import math
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform
from OCP.BRepPrimAPI import BRepPrimAPI_MakePrism
from OCP.gp import gp_Trsf, gp_Vec
from scipy.interpolate import RectBivariateSpline
from scipy.spatial.transform import Rotation

from tests.support import cad_parts, moulds, shapes

#: Half of the way, mm, by which a point of a skin is looked at from both sides.
_HAIR = 1e-5
Way = tuple[float, float, float]


class Face(NamedTuple):
    """A piece of a skin: points (n, 3) and outward directions (n, 3) at parameters within 0 to 1, and its two lengths, mm."""

    at: Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]
    long: float
    wide: float


def _flat(origin, a, b, out):
    origin, a, b, out = (np.asarray(each, float) for each in (origin, a, b, out))

    def at(u, v):
        return origin + u[:, None] * a + v[:, None] * b, np.broadcast_to(out, (len(u), 3))

    return Face(at, float(np.linalg.norm(a)), float(np.linalg.norm(b)))


def _around(q, h, out_q, out_h, long, wide):
    """A surface of revolution about z: radius, height and outward direction along its generatrix, as functions of v."""

    def at(u, v):
        c, s = np.cos(2 * math.pi * u), np.sin(2 * math.pi * u)
        r, n = q(v), out_q(v) + 0 * v
        return np.stack([r * c, r * s, h(v) + 0 * v], 1), np.stack([n * c, n * s, out_h(v) + 0 * v], 1)

    return Face(at, long, wide)


def _disk(radius, height, out):
    return _around(lambda v: radius * v, lambda v: height, lambda v: 0.0, lambda v: out, 2 * math.pi * radius, radius)


@dataclass(frozen=True)
class Body:
    """A body of a kind with its sizes, mm, turned by angles about the fixed x, y and z, degrees, and then shifted.

    `box` (x, y, z) with a corner, `rod` (r, h) and `cone` (r0, r1, h) with the middle of their foot, `ball` (r) and `ring` (R, r)
    with their middle at the origin; `field` (size, height, depth, seed) is a block under a random free-form surface.
    """

    kind: str
    sizes: tuple[float, ...]
    turn: Way = (0.0, 0.0, 0.0)
    at: Way = (0.0, 0.0, 0.0)

    @cached_property
    def matrix(self):
        return Rotation.from_euler("xyz", self.turn, degrees=True).as_matrix()

    @cached_property
    def patch(self):
        """The surface of a field, over Greville abscissae: x and y are straight in its parameters."""
        size, height, _, seed = self.sizes
        count = 6
        made = shapes.Patch.random(np.random.default_rng(int(seed)), size=size, height=height, n=count)
        knots = made.knots[0]
        line = size * np.array([knots[i + 1 : i + 4].mean() for i in range(count)])
        made.net[..., 0], made.net[..., 1] = line[:, None], line[None, :]
        return made

    @cached_property
    def _heights(self):
        points, lines = self.patch.grid(201)
        return RectBivariateSpline(lines, lines, points[..., 2])

    def _height(self, x, y):
        """Of a field, exact to rounding at its own parameters."""
        size = self.sizes[0]
        u, v = np.clip(x / size, 0, 1), np.clip(y / size, 0, 1)
        return self.patch.at(u, v)[:, 2] if len(u) else np.zeros(0)

    def value(self, points):
        """Negative inside, positive outside (n,), mm; a distance but for fields, next to a side."""
        p = (np.asarray(points) - self.at) @ self.matrix
        x, y, z = p.T
        if self.kind == "box":
            half = 0.5 * np.array(self.sizes)
            return (np.abs(p - half) - half).max(axis=1)
        if self.kind == "ball":
            return np.linalg.norm(p, axis=1) - self.sizes[0]
        q = np.hypot(x, y)
        if self.kind == "rod":
            r, h = self.sizes
            return np.max([q - r, -z, z - h], axis=0)
        if self.kind == "cone":
            r0, r1, h = self.sizes
            lean = math.hypot(h, r1 - r0)
            return np.max([(q - r0 - (r1 - r0) * z / h) * h / lean, -z, z - h], axis=0)
        if self.kind == "ring":
            return np.hypot(q - self.sizes[0], z) - self.sizes[1]
        size, _, depth, _ = self.sizes
        top = self._height(x, y)
        return np.max([z - top, top - depth - z, -x, x - size, -y, y - size], axis=0)

    @cached_property
    def faces(self) -> tuple[Face, ...]:
        """Its skin, where it stands."""

        def placed(face):
            def at(u, v):
                point, out = face.at(u, v)
                return point @ self.matrix.T + self.at, out @ self.matrix.T

            return face._replace(at=at)

        return tuple(placed(each) for each in self._own_faces())

    def _own_faces(self):
        s, eye = self.sizes, np.eye(3)
        if self.kind == "box":
            for k in range(3):
                i, j = (k + 1) % 3, (k + 2) % 3
                for far in (0.0, 1.0):
                    yield _flat(far * s[k] * eye[k], s[i] * eye[i], s[j] * eye[j], (2 * far - 1) * eye[k])
        elif self.kind == "rod":
            r, h = s
            yield _around(lambda v: r + 0 * v, lambda v: h * v, lambda v: 1.0, lambda v: 0.0, 2 * math.pi * r, h)
            yield from (_disk(r, 0.0, -1.0), _disk(r, h, 1.0))
        elif self.kind == "cone":
            r0, r1, h = s
            lean = math.hypot(h, r1 - r0)
            yield _around(lambda v: r0 + (r1 - r0) * v, lambda v: h * v, lambda v: h / lean, lambda v: (r0 - r1) / lean,
                          2 * math.pi * max(r0, r1), lean)  # fmt: skip
            yield from (_disk(r0, 0.0, -1.0), _disk(r1, h, 1.0))
        elif self.kind == "ball":
            (r,) = s
            yield _around(lambda v: r * np.sin(math.pi * v), lambda v: -r * np.cos(math.pi * v), lambda v: np.sin(math.pi * v),
                          lambda v: -np.cos(math.pi * v), 2 * math.pi * r, math.pi * r)  # fmt: skip
        elif self.kind == "ring":
            big, r = s
            yield _around(lambda v: big + r * np.cos(2 * math.pi * v), lambda v: r * np.sin(2 * math.pi * v),
                          lambda v: np.cos(2 * math.pi * v), lambda v: np.sin(2 * math.pi * v), 2 * math.pi * (big + r),
                          2 * math.pi * r)  # fmt: skip
        else:
            yield from self._field_faces()

    def _field_faces(self):
        size, _, depth, _ = self.sizes

        def top(sign, low):
            def at(u, v):
                du, dv = (self._heights.ev(u, v, **{k: 1}) / size for k in ("dx", "dy"))
                out = np.stack([-du, -dv, np.ones_like(u)], 1)
                out *= sign / np.linalg.norm(out, axis=1)[:, None]
                return np.stack([size * u, size * v, self.patch.at(u, v)[:, 2] - low], 1), out

            return Face(at, size, size)

        def side(k, far):
            out = np.zeros(3)
            out[k] = 2 * far - 1

            def at(u, v):
                x, y = (np.full_like(u, far), u) if k == 0 else (u, np.full_like(u, far))
                return (
                    np.stack([size * x, size * y, self.patch.at(x, y)[:, 2] - depth * v], 1),
                    np.broadcast_to(out, (len(u), 3)),
                )

            return Face(at, size, depth)

        yield from (top(1.0, 0.0), top(-1.0, depth), *(side(k, far) for k in (0, 1) for far in (0.0, 1.0)))

    def shape(self):
        """As the kernel makes it."""
        made = {
            "box": cad_parts.box, "rod": cad_parts.rod, "cone": cad_parts.cone, "ball": cad_parts.ball, "ring": cad_parts.ring,
            "field": lambda *_: BRepPrimAPI_MakePrism(self.patch.face(), gp_Vec(0, 0, -self.sizes[2])).Shape(),
        }[self.kind](*self.sizes)  # fmt: skip
        return moved(made, self.matrix, self.at)


def angles_of(matrix):
    """The turns of a `Body`, degrees, that a rotation matrix (3, 3) is."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # where two of the axes are one, any of the turns about them will do
        return tuple(Rotation.from_matrix(matrix).as_euler("xyz", degrees=True).tolist())


def moved(shape, matrix=((1, 0, 0), (0, 1, 0), (0, 0, 1)), shift=(0, 0, 0), scale=1.0):
    """A shape turned by a matrix (3, 3), made larger, and shifted."""
    turn = gp_Trsf()
    turn.SetValues(*(float(x) for row, by in zip(np.asarray(matrix), shift, strict=True) for x in (*row, by)))
    if scale != 1.0:
        larger = gp_Trsf()
        larger.SetScaleFactor(float(scale))
        turn = turn.Multiplied(larger)
    return BRepBuilderAPI_Transform(shape, turn, True).Shape()


class Skin(NamedTuple):
    """Points (n, 3) of a skin with outward directions (n, 3), the face (n,) that each is of, and its parameters (n, 2)."""

    point: np.ndarray
    out: np.ndarray
    face: np.ndarray
    uv: np.ndarray
    area: np.ndarray


class Material:
    """What bodies make that are added and cut out, one after the other: where it is, and its exact skin.

    `steps` are pairs of a sign (1: added, -1: cut out) and a body. `sheet` is the first face alone, which has no inside.
    """

    def __init__(self, steps, *, sheet=False):
        self.steps, self.sheet = tuple(steps), sheet
        self.faces = [face for _, body in self.steps for face in body.faces][: 1 if sheet else None]

    def value(self, points):
        """Negative inside the material (n,); the distance from its skin at most, but for fields."""
        found = np.full(len(points), np.inf)
        for sign, body in self.steps:
            found = np.minimum(found, body.value(points)) if sign > 0 else np.maximum(found, -body.value(points))
        return found

    def within(self, points):
        """Which points (n,) lie within it by more than rounding."""
        return np.zeros(len(points), bool) if self.sheet else self.value(points) < -1e-7

    def on(self, face, u, v):
        """Points of a face at parameters (n,), those that are of the skin, with their directions out of the material."""
        point, out = self.faces[face].at(u, v)
        if self.sheet:
            kept, sign = np.ones(len(u), bool), np.ones(len(u))
        else:
            front, back = self.value(point + _HAIR * out) < 0, self.value(point - _HAIR * out) < 0
            kept, sign = front != back, np.where(front, -1.0, 1.0)
        return point[kept], (sign[:, None] * out)[kept], np.stack([u, v], 1)[kept], kept

    def skin(self, apart, most=600):
        """Points of the whole skin, some mm apart and no more than `most` in a row, each of a cell of an area, mm2."""
        found = []
        for k, face in enumerate(self.faces):
            n, m = (int(min(most, max(4, math.ceil(size / apart)))) for size in (face.long, face.wide))
            u, v = (each.ravel() for each in np.meshgrid((np.arange(n) + 0.5) / n, (np.arange(m) + 0.5) / m, indexing="ij"))
            point, out, uv, kept = self.on(k, u, v)
            step = 1e-4
            along = [(face.at(u + a, v + b)[0] - face.at(u - a, v - b)[0]) / (2 * step) for a, b in ((step, 0), (0, step))]
            area = np.linalg.norm(np.cross(*along), axis=1)[kept] / (n * m)
            found.append(Skin(point, out, np.full(len(point), k), uv, area))
        return Skin(*(np.concatenate(each) for each in zip(*found, strict=True)))

    def edged(self, count):
        """Points of the skin on a grid of so many by as many on each face, up to its edges."""
        line = np.linspace(1e-6, 1.0 - 1e-6, count)
        u, v = (each.ravel() for each in np.meshgrid(line, line))
        return np.concatenate([self.on(k, u, v)[0] for k in range(len(self.faces))])

    def shape(self):
        """As the kernel makes it."""
        (_, first), *rest = self.steps
        if self.sheet:
            return shapes.shell(first.patch.face())
        made = first.shape()
        for sign, body in rest:
            made = moulds.fuse(made, body.shape()) if sign > 0 else cad_parts.cut(made, body.shape())
        return made
