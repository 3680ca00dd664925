"""Freeform surfaces: B-splines whose poles are the truth, and whose curvatures are known by hand."""

import numpy as np

from conformance.made.part import Answer, MadePart
from conformance.made.patches import Spline, placed
from conformance.tool import Floats, Tool

_UP = (0.0, 0.0, 1.0)
_FLAT, _BALL, _BULL = Tool.flat(8.0, 30.0), Tool.ball(8.0, 30.0), Tool.flat(8.0, 30.0, corner=1.5)
_TOOLS = (_FLAT, _BALL, _BULL)
_S2 = float(np.sqrt(0.5))


def _upward(tangent_x: Floats, tangent_y: Floats) -> Floats:
    """Return the unit normals (n, 3) of slopes dz/dx and dz/dy."""
    normal = np.column_stack([-tangent_x, -tangent_y, np.ones(len(tangent_x))])
    return normal / np.linalg.norm(normal, axis=1)[:, None]


def _deg(sine: float) -> float:
    return float(np.degrees(np.arcsin(sine)))


def _parabola_end(c: float, length: float) -> float:
    """Return the tilt (deg) at which the side through the contact meets a rising parabola of vertex radius c at the tool's top.

    `L sin(t)^2 = 2 c cos t`.
    """
    return float(np.degrees(np.arccos((-c + np.hypot(c, length)) / length)))


def _rear(c: float, radius: float) -> float:
    """Return the tilt (deg) from which the rear of the edge is clear of a parabola of vertex radius c: `R cos(t)^2 = c sin t`."""
    return _deg((-c + np.hypot(c, 2 * radius)) / (2 * radius))


def _ruling_end(c: float, radius: float, length: float) -> float:
    """Return the tilt (deg) along a ruling of z = x y / c at which the side of a flat end meets the twist at its top.

    The generator at angle s of the edge leaves the surface by `h (cos t - sin t R sin s / c) + m R (sin t + cos t R sin s / c)`, m = 1 - cos s: linear in
    the height h, so the two ends decide, h = 0 (the edge) and h = L.
    """
    from scipy.optimize import brentq, minimize_scalar

    def least(t: float) -> float:
        def over(s: float) -> float:
            k = radius * np.sin(s) / c
            return float(length * (np.cos(t) - np.sin(t) * k) + radius * (1 - np.cos(s)) * (np.sin(t) + np.cos(t) * k))

        return float(minimize_scalar(over, bounds=(0.0, np.pi), method="bounded", options={"xatol": 1e-12}).fun)

    return float(np.degrees(brentq(least, np.radians(20.0), np.radians(89.9))))


def _product(half: float, xx: float, xy: float, yy: float) -> Spline:
    """Return z = xx x^2 + xy x y + yy y^2 over a square, degree 2 in both: the poles are its blossom."""
    ends = ((-half, -half), (-half, half), (half, half))
    poles = [[(0.5 * (a + b), 0.5 * (c + d), xx * a * b + xy * 0.25 * (a + b) * (c + d) + yy * c * d) for c, d in ends] for a, b in ends]
    return Spline(np.array(poles, float), (2, 2))


# A wave: parabolas that join smoothly, poles _H apart and +-_A high.
_H, _A, _PERIODS, _WIDE = 14.0, 3.0, 3, 70.0
_PW = _H**2 / (4 * _A)


def _wave() -> Spline:
    """Return the wave: middle spans about x = 0 are a trough, neighbours are crests."""
    k = np.arange(-2 * _PERIODS, 2 * _PERIODS + 1)
    x, z = k * _H, np.where(k % 2 == 0, -_A, _A)
    # The ends of a clamped knot vector are points of the curve: midway between two poles.
    x = np.concatenate([[0.5 * (x[0] + x[1])], x[1:-1], [0.5 * (x[-2] + x[-1])]])
    z = np.concatenate([[0.0], z[1:-1], [0.0]])
    poles = np.array([[(a, y, b) for y in (-_WIDE, _WIDE)] for a, b in zip(x, z, strict=True)], float)
    return Spline(poles, (2, 1))


def _wave_contacts(rng: np.random.Generator, n: int) -> tuple[Floats, Floats]:
    x, y = rng.uniform(-1.5 * _H, 1.5 * _H, n), rng.uniform(-10.0, 10.0, n)
    k = np.round(x / _H)
    sign, off = np.where(k % 2 == 0, 1.0, -1.0), x - k * _H
    z = sign * (off**2 / (2 * _PW) - 0.5 * _A)
    return np.column_stack([x, y, z]), _upward(sign * off / _PW, np.zeros(n))


WAVE = MadePart(
    "wave",
    "freeform",
    "Extruded wave, a quadratic B-spline of uniform knots",
    """Poles h = 14 apart, A = 3 up and down in turn: each span is a parabola z = +-(x^2 / (2 p) - A / 2) with p = h^2 / (4 A), and |x| <= h / 2. A ball in a
    trough: r - sqrt(r^2 - x^2) >= x^2 / (2 r), so r <= p is enough, and needed at x = 0; beyond the span the wave lies below its parabola. A
    flat end that tilts along y touches with the edge across the wave: R <= p sin t at the contact, and (1 - cos s) R sin t >= (R sin s)^2 / (2 p) for
    the whole edge is the same condition. On a crest (convex near it) a ball end is free at tilt 0.""",
    lambda: _wave().solid(30.0),
    _wave().bodies("wave", (101, 41), 30.0),
    _TOOLS,
    _wave_contacts,
    answers=(
        Answer("largest_radius", _PW, "r = h^2 / (4 A)", given=placed((0.0, 0.0, -0.5 * _A), _UP, axis=[0.0, 0.0, 1.0], end="ball", length=40.0)),
        Answer(
            "largest_radius",
            _PW * 0.5,
            "R = p sin t, t = 30 deg",
            given=placed((0.0, 0.0, -0.5 * _A), _UP, axis=[0.0, 0.5, float(np.sqrt(0.75))], end="flat", length=40.0),
        ),
        Answer(
            "free_tilts",
            [[_deg(4.0 / _PW), 90.0]],
            "sin t = R / p, tilted along the trough",
            tool=_FLAT.name,
            given=placed((0.0, 0.0, -0.5 * _A), _UP, (0.0, 1.0, 0.0)),
        ),
    ),
)


# A ruled twist: z = x y / c between two skew lines.
_C = 30.0


def _twist() -> Spline:
    side = 32.0
    return Spline(np.array([[(x, y, x * y / _C) for y in (-side, side)] for x in (-side, side)], float), (1, 1))


def _twist_contacts(rng: np.random.Generator, n: int) -> tuple[Floats, Floats]:
    x, y = rng.uniform(-8.0, 8.0, n), rng.uniform(-8.0, 8.0, n)
    return np.column_stack([x, y, x * y / _C]), _upward(y / _C, x / _C)


TWIST = MadePart(
    "twist",
    "freeform",
    "Ruled surface between two skew lines",
    """z = x y / c, c = 30, a B-spline of degree 1. Let the edge's point be contact - m R cos t f + R sin s w + m R sin t z, m = 1 - cos s, f the direction
    of the tilt, w across; x y is harmonic, so the edge decides for the whole flat. Tilt along a ruling: x y = -m R cos t R sin s, free when
    R cos t <= c sin t, up to where the side meets the twist (`_ruling_end`). Tilt up the valley, f = (1, 1): (a^2 - b^2) / 2 is largest at
    the rear, m = 2: R cos(t)^2 <= c sin t; the side meets the rise at the tool's top, L sin(t)^2 = 2 c cos t. Tilt down, f = (1, -1): largest at
    m = 0: R <= c sin t, the local bound. A ball: |x y| <= (x^2 + y^2) / 2, so r = c, and the diagonal needs it.""",
    lambda: _twist().solid(60.0),
    _twist().bodies("twist", (65, 65), 60.0),
    _TOOLS,
    _twist_contacts,
    answers=(
        Answer(
            "free_tilts",
            [[float(np.degrees(np.arctan(4.0 / _C))), _ruling_end(_C, 4.0, 30.0)]],
            "tan t = R / c along a ruling; the side at the top: freeform._ruling_end",
            tool=_FLAT.name,
            given=placed((0.0, 0.0, 0.0), _UP, (1.0, 0.0, 0.0)),
        ),
        Answer(
            "free_tilts",
            [[_rear(_C, 4.0), _parabola_end(_C, 30.0)]],
            "R cos(t)^2 = c sin t; L sin(t)^2 = 2 c cos t",
            tool=_FLAT.name,
            given=placed((0.0, 0.0, 0.0), _UP, (_S2, _S2, 0.0)),
        ),
        Answer("free_tilts", [[_deg(4.0 / _C), 90.0]], "sin t = R / c down the ridge", tool=_FLAT.name, given=placed((0.0, 0.0, 0.0), _UP, (_S2, -_S2, 0.0))),
        Answer("largest_radius", _C, "r = c", given=placed((0.0, 0.0, 0.0), _UP, axis=[0.0, 0.0, 1.0], end="ball", length=70.0)),
    ),
)


# A saddle with two curvatures: z = x^2 / (2 p) - y^2 / (2 q).
_P, _Q = 15.0, 25.0


def _saddle_contacts(rng: np.random.Generator, n: int) -> tuple[Floats, Floats]:
    x, y = rng.uniform(-8.0, 8.0, n), rng.uniform(-8.0, 8.0, n)
    return np.column_stack([x, y, x**2 / (2 * _P) - y**2 / (2 * _Q)]), _upward(x / _P, -y / _Q)


def _saddle() -> Spline:
    return _product(32.0, 1 / (2 * _P), 0.0, -1 / (2 * _Q))


SADDLE = MadePart(
    "saddle",
    "freeform",
    "Saddle of two curvatures, degree 2",
    """z = x^2 / (2 p) - y^2 / (2 q), p = 15, q = 25, subharmonic as p <= q: the edge decides for the whole flat. With m = 1 - cos s as in the twist: tilted
    along x, R (cos(t)^2 m / p - (2 - m) / q) <= 2 sin t is worst at the rear, m = 2: R cos(t)^2 <= p sin t; the side meets the rise at the tool's
    top, L sin(t)^2 = 2 p cos t. Tilted along y, R ((2 - m) / p - cos(t)^2 m / q) <= 2 sin t is worst at the contact: R <= p sin t. A ball: r = p.""",
    lambda: _saddle().solid(60.0),
    _saddle().bodies("saddle", (65, 65), 60.0),
    _TOOLS,
    _saddle_contacts,
    answers=(
        Answer(
            "free_tilts",
            [[_rear(_P, 4.0), _parabola_end(_P, 30.0)]],
            "R cos(t)^2 = p sin t; L sin(t)^2 = 2 p cos t",
            tool=_FLAT.name,
            given=placed((0.0, 0.0, 0.0), _UP, (1.0, 0.0, 0.0)),
        ),
        Answer("free_tilts", [[_deg(4.0 / _P), 90.0]], "sin t = R / p", tool=_FLAT.name, given=placed((0.0, 0.0, 0.0), _UP, (0.0, 1.0, 0.0))),
        Answer("largest_radius", _P, "r = p", given=placed((0.0, 0.0, 0.0), _UP, axis=[0.0, 0.0, 1.0], end="ball", length=60.0)),
    ),
)


# A bowl: z = (x^2 + y^2) / (2 p), the corner of the square at x = y.
_PB = 20.0


def _bowl() -> Spline:
    return _product(32.0, 1 / (2 * _PB), 0.0, 1 / (2 * _PB))


def _bowl_contacts(rng: np.random.Generator, n: int) -> tuple[Floats, Floats]:
    x, y = rng.uniform(-12.0, 12.0, n), rng.uniform(-12.0, 12.0, n)
    return np.column_stack([x, y, (x**2 + y**2) / (2 * _PB)]), _upward(x / _PB, y / _PB)


def _in_bowl(d: float) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    return (d, 0.0, d**2 / (2 * _PB)), (-d, 0.0, _PB)


PARABOLOID = MadePart(
    "paraboloid",
    "freeform",
    "Paraboloid bowl, degree 2",
    """z = (x^2 + y^2) / (2 p), p = 20. At distance d from the axis the sphere about the axis that touches has radius sqrt(p^2 + d^2): along the surface the
    squared distance from its centre has the derivative (w - d^2) / (2 p^2) by w = x^2 + y^2, least at w = d^2, so that ball fits and no larger one.
    Flat end at the vertex: R (cos(t)^2 m + 2 - m) <= 2 p sin t is worst at the contact, m = 0: R <= p sin t. The side through the contact, worst again,
    meets the bowl at the tool's top: L sin(t)^2 = 2 p cos t.""",
    lambda: _bowl().solid(60.0),
    _bowl().bodies("bowl", (65, 65), 60.0),
    _TOOLS,
    _bowl_contacts,
    answers=(
        *(
            Answer(
                "free_tilts",
                [[_deg(4.0 / _PB), _parabola_end(_PB, 30.0)]],
                "sin t = R / p; L sin(t)^2 = 2 p cos t",
                tool=_FLAT.name,
                given=placed((0.0, 0.0, 0.0), _UP, f),
            )
            for f in ((1.0, 0.0, 0.0), (0.6, 0.8, 0.0))
        ),
        *(
            Answer("largest_radius", float(np.hypot(_PB, d)), "r = sqrt(p^2 + d^2)", given=placed(*_in_bowl(d), axis=[0.0, 0.0, 1.0], end="ball", length=70.0))
            for d in (0.0, 10.0)
        ),
    ),
)

PARTS = (WAVE, TWIST, SADDLE, PARABOLOID)
