"""Balls: bosses, hollows and a lens whose skins are spheres."""

from typing import Any

import numpy as np

from conformance.forms import ball, box
from conformance.made.part import Answer, MadePart, Setup, directions, frame
from conformance.made.patches import Inner, boxes_round, descent, inner, placed, revolved_arc, revolved_line
from conformance.tool import Floats, Tool

_FLAT, _BALL, _BULL = Tool.flat(8.0, 40.0), Tool.ball(6.0, 40.0), Tool.flat(8.0, 40.0, corner=2.0)
_TOOLS = (_FLAT, _BALL, _BULL)
_UP = (0.0, 0.0, 1.0)


def _block(half: float, low: float, high: float) -> Any:
    import cadquery as cq

    return cq.Workplane("XY", origin=(0, 0, low)).box(2 * half, 2 * half, high - low, centered=(True, True, False))


def _ball(radius: float, z: float) -> Any:
    import cadquery as cq

    return cq.Workplane("XY", origin=(0, 0, z)).sphere(radius)


def _directions(rng: np.random.Generator, n: int, low: float, high: float) -> Floats:
    """Return unit vectors (n, 3) whose z is between two numbers."""
    turn, z = rng.uniform(-np.pi, np.pi, n), rng.uniform(low, high, n)
    return np.column_stack([np.sqrt(1 - z**2) * np.cos(turn), np.sqrt(1 - z**2) * np.sin(turn), z])


def _at(deg: float) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    """Return the direction `deg` from z in the x z plane, and the way down from it."""
    t = np.radians(deg)
    return (float(np.sin(t)), 0.0, float(np.cos(t))), (float(np.cos(t)), 0.0, float(-np.sin(t)))


def _on(radius: float, deg: float, z: float = 0.0) -> tuple[float, float, float]:
    n = _at(deg)[0]
    return radius * n[0], 0.0, z + radius * n[2]


# A hemisphere on a plate, the plate's top at z = 0.
_RB = 12.0


def _boss_contacts(rng: np.random.Generator, n: int) -> tuple[Floats, Floats]:
    normal = _directions(rng, n, 0.1, 1.0)
    return _RB * normal, normal


HEMISPHERE = MadePart(
    "hemisphere",
    "balls",
    "Hemisphere on a plate",
    """A ball of radius Rb = 12 whose centre is in the top of a plate: the lower half lies in the plate, so ball and box are the whole.
    At angle q from z, a ball end r has its centre (Rb + r) cos q above the plate: it touches both when r = Rb cos q / (1 - cos q). Tilted down, the
    lowest point of a ball end is the rim of its flat top (patches.descent); to the other side nothing is in the way of a convex body.""",
    lambda: _block(70.0, -20.0, 0.0).union(_ball(_RB, 0.0)),
    (
        ball("hemisphere", (0.0, 0.0, 0.0), _RB),
        revolved_line("top", (_RB, 0.0), (69.9, 0.0), (25, 121)),
        inner("plate", (-70.0, -70.0, -20.0), (70.0, 70.0, 0.0)),
    ),
    _TOOLS,
    _boss_contacts,
    answers=(
        *(
            Answer(
                "free_tilts",
                [[0.0, min(90.0, 90.0 - q + descent((_RB + 3.0) * np.cos(np.radians(q)), 3.0, 40.0))]],
                "(L - r) sin b + r cos b = (Rb + r) cos q; tilt = 90 - q + b",
                tool=_BALL.name,
                given=placed(_on(_RB, q), *_at(q)),
            )
            for q in (45.0, 60.0, 70.0)
        ),
        Answer(
            "free_tilts",
            [[0.0, 90.0]],
            "the way over the top of a convex body is free",
            tool=_FLAT.name,
            given=placed(_on(_RB, 45.0), _at(45.0)[0], tuple(-x for x in _at(45.0)[1])),
        ),
        Answer(
            "largest_radius",
            _RB * 0.5 / (1 - 0.5),
            "r = Rb cos q / (1 - cos q), q = 60 deg",
            given=placed(_on(_RB, 60.0), _at(60.0)[0], axis=list(_at(30.0)[0]), end="ball", length=60.0),
        ),
    ),
)


# A shallow spherical pocket: centre 8 above the block's top, radius 20.
_RP, _ZP = 20.0, 8.0
_RIM = float(np.sqrt(_RP**2 - _ZP**2))
_DEEP = _RP - _ZP


def _pocket_contacts(rng: np.random.Generator, n: int) -> tuple[Floats, Floats]:
    normal = _directions(rng, n, _ZP / _RP + 0.03, 1.0)
    return np.array([0.0, 0.0, _ZP]) - _RP * normal, normal


def _rising(tool: Tool) -> Answer:
    low = np.degrees(np.arcsin(tool.flat_radius / _RP))
    return Answer(
        "free_tilts",
        [[float(low), float(np.degrees(np.arctan2(_RIM, _DEEP)))]],
        "sin t = R / Rb; the side through the contact meets the rim: tan t = rim / depth",
        tool=tool.name,
        given=placed((0.0, 0.0, -_DEEP), _UP, (1.0, 0.0, 0.0)),
    )


SPHERE_POCKET = MadePart(
    "sphere_pocket",
    "balls",
    "Spherical cap pocket in a block",
    """A sphere of radius Rb = 20, its centre 8 above the top, cut from a block: 12 deep, rim radius sqrt(Rb^2 - 8^2). The plane of a flat end at tilt
    t cuts the sphere in a circle of radius Rb sin t that touches the edge's circle at the contact: free if and only if R <= Rb sin t, so local and rear
    gouging begin together. The cylinder's side through the contact runs along the axis and meets the rim at tan t = rim radius / depth; of the points
    of the rim, the squared distance from the axis is concave in cos(turn), so the least is at the two ends of the diameter in the plane.
    Form: the bowl and the top as Surfaces, and boxes inside.""",
    lambda: _block(45.0, -40.0, 0.0).cut(_ball(_RP, _ZP)),
    (
        revolved_arc("bowl", (0.0, _ZP), _RP, (-np.pi / 2, -float(np.arcsin(_ZP / _RP))), (21, 81)),
        revolved_line("top", (_RIM, 0.0), (44.9, 0.0), (17, 73)),
        *boxes_round((18.6, 18.6), (45.0, 45.0), (-40.0, 0.0)),
        inner("under", (-18.6, -18.6, -40.0), (18.6, 18.6, -12.1)),
        inner("at +x", (13.5, -5.0, -12.1), (18.6, 5.0, -7.0)),
        inner("at -x", (-18.6, -5.0, -12.1), (-13.5, 5.0, -7.0)),
    ),
    _TOOLS,
    _pocket_contacts,
    answers=(
        _rising(_FLAT),
        Answer(
            "largest_radius", _RP * 0.5, "R = Rb sin t, t = 30 deg", given=placed((0.0, 0.0, -_DEEP), _UP, axis=list(_at(30.0)[0]), end="flat", length=40.0)
        ),
        Answer(
            "largest_radius",
            _RP,
            "r = Rb: the ball end fills the bowl, and its cylinder begins above the top",
            given=placed((0.0, 0.0, -_DEEP), _UP, axis=list(_UP), end="ball", length=60.0),
        ),
    ),
)


# Two balls that overlap, with a sharp concave circle between them.
_RT, _DT = 15.0, 22.0
_CUT = float(np.arcsin(0.5 * _DT / _RT))


def _two_contacts(rng: np.random.Generator, n: int) -> tuple[Floats, Floats]:
    # Towards the other ball up to the circle, cos = D / 2 / R.
    normal = _directions(rng, n, -0.6, 0.5 * _DT / _RT - 0.02)
    side = rng.choice([-1.0, 1.0], n)
    normal[:, 2] *= side
    return _RT * normal - np.outer(side, [0.0, 0.0, 0.5 * _DT]), normal


def _touching(r: float, q: float) -> float:
    """Return the angle (deg) at which the side of a cylinder through the centre of a ball end r touches the other ball.

    The other centre is `d` away from the ball end's; the axis misses it by R + r: the angle to the line of centres is asin((R + r) / d).
    """
    t = np.radians(q)
    centre = (_RT + r) * np.array([np.sin(t), np.cos(t)])
    way = np.array([0.0, _DT]) - centre
    d = np.hypot(*way)
    angle = np.arccos((np.array([np.sin(t), np.cos(t)]) @ way) / d)
    return float(np.degrees(angle - np.arcsin((_RT + r) / d)))


TWO_BALLS = MadePart(
    "two_balls",
    "balls",
    "Two balls that overlap: a sharp concave circle",
    """Balls of radius R = 15, centres D = 22 apart on z. At angle q from the line of centres a ball end r has its centre at (R + r) n; it touches the
    other ball when |(R + r) n - D z| = R + r, so r = D / (2 cos q) - R. Tilted towards the other ball its side touches when the axis misses the other
    centre by R + r: an angle of asin((R + r) / d) from the line between both centres, d apart.""",
    lambda: _ball(_RT, -0.5 * _DT).union(_ball(_RT, 0.5 * _DT)),
    (
        revolved_arc("lower", (0.0, -0.5 * _DT), _RT, (-np.pi / 2, _CUT), (33, 73)),
        revolved_arc("upper", (0.0, 0.5 * _DT), _RT, (-_CUT, np.pi / 2), (33, 73)),
        Inner(ball("within the lower", (0.0, 0.0, -0.5 * _DT), _RT)),
        Inner(ball("within the upper", (0.0, 0.0, 0.5 * _DT), _RT)),
    ),
    _TOOLS,
    _two_contacts,
    answers=(
        Answer(
            "largest_radius",
            _DT - _RT,
            "r = D / (2 cos q) - R, q = 60 deg",
            given=placed(_on(_RT, 60.0, -0.5 * _DT), _at(60.0)[0], axis=list(_at(90.0)[0]), end="ball", length=60.0),
        ),
        *(
            Answer(
                "free_tilts",
                [[0.0, _touching(3.0, q)]],
                "the axis misses the other centre by R + r: balls._touching",
                tool=_BALL.name,
                given=placed(_on(_RT, q, -0.5 * _DT), _at(q)[0], tuple(-x for x in _at(q)[1])),
            )
            for q in (60.0, 75.0)
        ),
    ),
)


# Two spheres' intersection: a lens with a sharp edge.
_RL, _CL = 30.0, 24.0
_EDGE = float(np.sqrt(_RL**2 - _CL**2))
_ANGLE = float(np.arcsin(_EDGE / _RL))
_CLAMP = ((-2.0, 18.05, -30.0), (2.0, 30.0, 30.0))


def _lens_contacts(rng: np.random.Generator, n: int) -> tuple[Floats, Floats]:
    normal = _directions(rng, n, float(np.cos(_ANGLE)) + 1e-3, 1.0)
    side = rng.choice([-1.0, 1.0], n)
    normal[:, 2] *= side
    return _RL * normal - np.outer(side, [0.0, 0.0, _CL]), normal


def _lens_axes(rng: np.random.Generator, points: Floats, normals: Floats) -> Floats:
    """Return tilts up to 88 degrees, half of them towards +y, where the clamp stands."""
    e1, e2 = frame(normals)
    turn, tilt = rng.uniform(0, 2 * np.pi, len(points)), np.radians(rng.uniform(0.05, 88.0, len(points)))
    across = np.cos(turn)[:, None] * e1 + np.sin(turn)[:, None] * e2
    across = np.where((np.arange(len(points)) % 2 == 0)[:, None] & (across[:, 1:2] < 0), -across, across)
    return np.cos(tilt)[:, None] * normals + np.sin(tilt)[:, None] * across


LENS = MadePart(
    "lens",
    "balls",
    "Two-sphere lens with a sharp edge",
    """The intersection of two balls of radius 30, centres 24 above and below: 12 thick, edge radius sqrt(30^2 - 24^2) = 18. It is convex, so the
    plane that touches it at a contact separates it from a tool at any tilt below 90 degrees: all postures are free of the part. Only the clamp at +y and
    the machine's limit block. One direction has less than 90 degrees to the normals of one cap only (its opposite pole has the opposite normal), and
    +z and -z serve both: normals lie within asin(18 / 30) of them. Form: two caps as Surfaces;
    no core of a tool fits in.""",
    lambda: _ball(_RL, -_CL).intersect(_ball(_RL, _CL)),
    (
        revolved_arc("upper cap", (0.0, -_CL), _RL, (np.pi / 2 - _ANGLE, np.pi / 2), (17, 73)),
        revolved_arc("lower cap", (0.0, _CL), _RL, (-np.pi / 2, -np.pi / 2 + _ANGLE), (17, 73)),
    ),
    _TOOLS,
    _lens_contacts,
    setups=(Setup(), Setup("clamp", fixtures=(box("clamp", *_CLAMP),), boxes=(_CLAMP,)), Setup("tilting table", limit_deg=50.0)),
    axes=_lens_axes,
    answers=(
        *(
            Answer(
                "free_tilts",
                [[0.0, 90.0]],
                "a convex body is free on the outer side of its tangent plane",
                tool=_FLAT.name,
                given=placed(_on(_RL, q, -_CL), _at(q)[0], _at(q)[1]),
            )
            for q in (0.0, 30.0)
        ),
        Answer(
            "orientations",
            2,
            "the poles have opposite normals; each cap's normals are within 37 deg of its pole's",
            tool=_BALL.name,
            given=directions(
                (_UP, (0.0, 0.0, -1.0)),
                [(_on(_RL, q, -_CL), _at(q)[0]) for q in (0.0, 20.0, 35.0)]
                + [((p[0], 0.0, -p[2]), (n[0], 0.0, -n[2])) for p, n in ((_on(_RL, q, -_CL), _at(q)[0]) for q in (0.0, 20.0, 35.0))],
                89.0,
                (0, 3),
            ),
        ),
    ),
)

PARTS = (HEMISPHERE, SPHERE_POCKET, TWO_BALLS, LENS)
