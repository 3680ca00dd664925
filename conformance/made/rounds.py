"""Rounds: fillets and rounded edges, tori and cylinders, and extruded curves."""

from typing import Any

import numpy as np

from conformance.forms import Prism, Surface, section
from conformance.made.part import Answer, MadePart
from conformance.made.patches import TURN, Inner, boxes_round, descent, inner, past_edge, placed, revolved_arc, revolved_line
from conformance.tool import Floats, Tool

_FLAT, _BALL, _BULL = Tool.flat(8.0, 40.0), Tool.ball(6.0, 40.0), Tool.flat(8.0, 40.0, corner=1.5)
_TOOLS = (_FLAT, _BALL, _BULL)
_UP = (0.0, 0.0, 1.0)
_S2 = float(np.sqrt(0.5))


def _block(half: float, low: float, high: float) -> Any:
    import cadquery as cq

    return cq.Workplane("XY", origin=(0, 0, low)).box(2 * half, 2 * half, high - low, centered=(True, True, False))


def _about(rng: np.random.Generator, n: int, low: float, high: float) -> tuple[Floats, Floats]:
    """Return outward directions (n, 3) about z, and angles (rad) between two."""
    turn = rng.uniform(-np.pi, np.pi, n)
    return np.column_stack([np.cos(turn), np.sin(turn), np.zeros(n)]), rng.uniform(low, high, n)


def _mix(out: Floats, angle: Floats) -> Floats:
    return np.cos(angle)[:, None] * out + np.outer(np.sin(angle), [0.0, 0.0, 1.0])


# A mast on a plate with a torus fillet at its foot: the mast is higher than any tool reaches.
_RM, _RF, _MAST = 10.0, 6.0, 110.0


def _mast() -> Any:
    import cadquery as cq

    foot = (
        cq.Workplane("XZ")
        .moveTo(0, -1)
        .lineTo(_RM + _RF, -1)
        .lineTo(_RM + _RF, 0)
        .threePointArc((_RM + _RF * (1 - _S2), _RF * (1 - _S2)), (_RM, _RF))
        .lineTo(_RM, _MAST)
        .lineTo(0, _MAST)
        .close()
        .revolve(360, (0, 0, 0), (0, 1, 0))
    )
    return _block(70.0, -20.0, 0.0).union(foot)


def _fillet_contacts(rng: np.random.Generator, n: int) -> tuple[Floats, Floats]:
    out, angle = _about(rng, n, 0.05, np.pi / 2 - 0.05)
    normal = _mix(out, angle)
    return (_RM + _RF) * out + np.array([0.0, 0.0, _RF]) - _RF * normal, normal


_IN_FILLET = (_RM + _RF * (1 - _S2), 0.0, _RF * (1 - _S2))

TORUS_FILLET = MadePart(
    "torus_fillet",
    "rounds",
    "Mast on a plate with a torus fillet",
    """A mast of radius 10, a fillet of radius F = 6 at its foot. In the middle of the fillet the largest ball has r = F: the fillet's section is
    concave, and the ball touches mast and plate there at once. A smaller one has its centre F - (F - r) / sqrt 2 above the plate, and as far
    from the mast: tilted to either, the rim of its flat top touches it (patches.descent; for the mast in the plane of both axes, where the rim is nearest), so
    both intervals end at 45 deg + b.""",
    _mast,
    (
        revolved_line("mast", (_RM, _RF), (_RM, _MAST), (61, 41)),
        Inner(Prism("in the mast", ((0.0, 0.0, 0.0),), _UP, (1.0, 0.0, 0.0), 0.0, 2 * np.pi, _RM)),
        revolved_arc("fillet", (_RM + _RF, _RF), _RF, (-np.pi, -np.pi / 2), (15, 91)),
        revolved_line("top", (_RM + _RF, 0.0), (69.9, 0.0), (25, 121)),
        inner("plate", (-70.0, -70.0, -20.0), (70.0, 70.0, 0.0)),
    ),
    _TOOLS,
    _fillet_contacts,
    answers=(
        *(
            Answer(
                "free_tilts",
                [[0.0, 45.0 + descent(_RF - (_RF - 3.0) * _S2, 3.0, 40.0)]],
                "(L - r) sin b + r cos b = F - (F - r) / sqrt 2; 45 deg + b",
                tool=_BALL.name,
                given=placed(_IN_FILLET, (1.0, 0.0, 1.0), f),
            )
            for f in ((-1.0, 0.0, 1.0), (1.0, 0.0, -1.0))
        ),
        Answer("largest_radius", _RF, "r = F", given=placed(_IN_FILLET, (1.0, 0.0, 1.0), axis=[_S2, 0.0, _S2], end="ball", length=40.0)),
    ),
)


# A boss with a rounded edge.
_RB, _HB, _RE = 15.0, 20.0, 4.0


def _boss() -> Any:
    import cadquery as cq

    return _block(70.0, -20.0, 0.0).union(cq.Workplane("XY", origin=(0, 0, -1)).circle(_RB).extrude(_HB + 1).faces(">Z").edges().fillet(_RE))


def _edge_contacts(rng: np.random.Generator, n: int) -> tuple[Floats, Floats]:
    out, angle = _about(rng, n, 0.02, np.pi / 2 - 0.02)
    normal = _mix(out, angle)
    return (_RB - _RE) * out + np.array([0.0, 0.0, _HB - _RE]) + _RE * normal, normal


_ON_EDGE = (_RB - _RE + _RE * _S2, 0.0, _HB - _RE + _RE * _S2)
_LONG = Tool.ball(6.0, 60.0)

ROUNDED_BOSS = MadePart(
    "rounded_boss",
    "rounds",
    "Boss with a rounded edge: a convex torus",
    """A boss 20 high, radius 15, its edge rounded by E = 4: convex. A ball end r at 45 deg has its centre 16 + (E + r) / sqrt 2 above the plate; the rim of
    its flat top meets the plate (patches.descent). Where the torus meets the wall the normal is horizontal, 16 high: the ball end that touches
    there and the plate has r = 16. Over the top nothing is in the way.""",
    _boss,
    (
        revolved_arc("edge", (_RB - _RE, _HB - _RE), _RE, (0.0, np.pi / 2), (11, 81)),
        revolved_line("wall", (_RB, 0.0), (_RB, _HB - _RE), (17, 81)),
        revolved_line("roof", (0.0, _HB), (_RB - _RE, _HB), (12, 61)),
        revolved_line("top", (_RB, 0.0), (69.9, 0.0), (28, 121)),
        inner("inside", (-7.0, -7.0, -20.0), (7.0, 7.0, _HB)),
        inner("plate", (-70.0, -70.0, -20.0), (70.0, 70.0, 0.0)),
    ),
    (_FLAT, _LONG, _BULL),
    _edge_contacts,
    answers=(
        Answer(
            "free_tilts",
            [[0.0, 45.0 + descent(_HB - _RE + (_RE + 3.0) * _S2, 3.0, 60.0)]],
            "(L - r) sin b + r cos b = 16 + (E + r) / sqrt 2; 45 deg + b",
            tool=_LONG.name,
            given=placed(_ON_EDGE, (1.0, 0.0, 1.0), (1.0, 0.0, -1.0)),
        ),
        Answer("free_tilts", [[0.0, 90.0]], "the way over a convex body is free", tool=_FLAT.name, given=placed(_ON_EDGE, (1.0, 0.0, 1.0), (-1.0, 0.0, 1.0))),
        Answer("largest_radius", _HB - _RE, "r = 20 - E", given=placed((_RB, 0.0, _HB - _RE), (1.0, 0.0, 0.0), axis=[_S2, 0.0, _S2], end="ball", length=60.0)),
    ),
)


# A channel along y: wall, fillet, floor, fillet, wall.
_W, _HC, _FC, _Y = 15.0, 25.0, 5.0, 100.0


def _channel() -> Any:
    import cadquery as cq

    k = _FC * (1 - _S2)
    return (
        cq.Workplane("XZ")
        .moveTo(-40, -20)
        .lineTo(40, -20)
        .lineTo(40, _HC)
        .lineTo(_W, _HC)
        .lineTo(_W, _FC)
        .threePointArc((_W - k, k), (_W - _FC, 0))
        .lineTo(_FC - _W, 0)
        .threePointArc((k - _W, k), (-_W, _FC))
        .lineTo(-_W, _HC)
        .lineTo(-40, _HC)
        .close()
        .extrude(_Y, both=True)
    )


def _channel_fillet(name: str, side: float) -> Surface:
    def at(u: Floats, v: Floats) -> Floats:
        return np.stack([side * (_W - _FC + _FC * np.sin(u)), v, _FC * (1 - np.cos(u))], axis=-1)

    return Surface(name, at, (0.0, np.pi / 2), (-_Y, _Y), (11, 161))


def _channel_contacts(rng: np.random.Generator, n: int) -> tuple[Floats, Floats]:
    angle, y, side = rng.uniform(0.05, np.pi / 2 - 0.05, n), rng.uniform(-5, 5, n), rng.choice([-1.0, 1.0], n)
    normal = np.column_stack([-side * np.sin(angle), np.zeros(n), np.cos(angle)])
    return np.column_stack([side * (_W - _FC), y, np.full(n, _FC)]) - _FC * normal, normal


# A ball end r 3 in the middle of the fillet at +x: its centre.
_CF = (_W - _FC + (_FC - 3.0) * _S2, _FC - (_FC - 3.0) * _S2)

FILLET_PAIR = MadePart(
    "fillet_pair",
    "rounds",
    "Channel: wall, floor and wall with two fillets",
    """A channel 30 wide, 25 deep, fillets F = 5. The void is convex, so a ball on the floor's middle line fits when its centre is its radius inside
    of all planes that support the void: (r - F) tan(s / 2) <= 10 for directions s from down to a wall, worst at the wall: r = 15. In the middle of a fillet
    r = F. A ball end r 3 tilted there to either wall meets that wall's upper edge with its side (patches.past_edge), its face not: the centre is
    more than r away from it.""",
    _channel,
    (
        section("right wall", (_W, _FC), (_W, _HC), (40.0, _HC), (40.0, _FC)),
        section("left wall", (-_W, _FC), (-_W, _HC), (-40.0, _HC), (-40.0, _FC)),
        _channel_fillet("right fillet", 1.0),
        _channel_fillet("left fillet", -1.0),
        section("floor", (_FC - _W, 0.0), (_W - _FC, 0.0), (_W - _FC, -20.0), (_FC - _W, -20.0)),
    ),
    _TOOLS,
    _channel_contacts,
    answers=(
        Answer("largest_radius", _W, "r = half the width", given=placed((0.0, 0.0, 0.0), _UP, axis=[0.0, 0.0, 1.0], end="ball", length=60.0)),
        Answer(
            "largest_radius",
            _FC,
            "r = F",
            given=placed((_W - _FC * (1 - _S2), 0.0, _FC * (1 - _S2)), (-1.0, 0.0, 1.0), axis=[0.0, 0.0, 1.0], end="ball", length=40.0),
        ),
        *(
            Answer(
                "free_tilts",
                [[0.0, float(first + past_edge(_W - side * _CF[0], _HC - _CF[1], 3.0))]],
                "across cos b - up sin b = r at the wall's upper edge; 45 deg from the normal to z",
                tool=_BALL.name,
                given=placed((_W - _FC * (1 - _S2), 0.0, _FC * (1 - _S2)), (-1.0, 0.0, 1.0), (side, 0.0, side)),
            )
            for side, first in ((1.0, 45.0), (-1.0, -45.0))
        ),
    ),
)


# A pocket with an elliptic wall.
_EA, _EB, _ED = 20.0, 10.0, 20.0


def _ellipse_pocket() -> Any:
    import cadquery as cq

    return _block(45.0, -40.0, 0.0).cut(cq.Workplane("XY", origin=(0, 0, -_ED)).ellipse(_EA, _EB).extrude(_ED + 1))


def _ellipse(name: str, low: tuple[float, float], high: tuple[float, float], grid: tuple[int, int]) -> Surface:
    """Return a ruled surface of ellipses: (scale, z) of the first and the last."""

    def at(u: Floats, v: Floats) -> Floats:
        k = low[0] + u * (high[0] - low[0])
        return np.stack([k * _EA * np.cos(v), k * _EB * np.sin(v), low[1] + u * (high[1] - low[1])], axis=-1)

    return Surface(name, at, (0.0, 1.0), TURN, grid)


def _ellipse_contacts(rng: np.random.Generator, n: int) -> tuple[Floats, Floats]:
    turn, z = rng.uniform(-np.pi, np.pi, n), rng.uniform(-16.0, -1.0, n)
    normal = -np.column_stack([_EB * np.cos(turn), _EA * np.sin(turn), np.zeros(n)])
    return np.column_stack([_EA * np.cos(turn), _EB * np.sin(turn), z]), normal / np.linalg.norm(normal, axis=1)[:, None]


_SMALL = Tool.flat(4.0, 40.0)

ELLIPSE_POCKET = MadePart(
    "ellipse_pocket",
    "rounds",
    "Pocket with an elliptic wall",
    """Half axes a = 20, b = 10, depth 20. A circle that touches an ellipse at the end of its long axis is inside if and only if its radius is at most that
    of curvature there, b^2 / a = 5. The bottom plane of a flat end at tilt t towards z cuts the wall in an ellipse of half axes a / sin t and b:
    R <= 5 sin t. At the end of the short axis the opposite wall decides, r = b.""",
    _ellipse_pocket,
    (
        _ellipse("wall", (1.0, -_ED), (1.0, 0.0), (17, 121)),
        _ellipse("top", (1.0, 0.0), (2.2, 0.0), (17, 121)),
        _ellipse("floor", (0.0, -_ED), (1.0, -_ED), (15, 81)),
        *boxes_round((20.1, 10.1), (45.0, 45.0), (-40.0, 0.0)),
        inner("under", (-21.0, -11.0, -40.0), (21.0, 11.0, -_ED)),
    ),
    (_SMALL, _BALL, Tool.flat(6.0, 40.0, corner=1.0)),
    _ellipse_contacts,
    answers=(
        Answer("largest_radius", _EB**2 / _EA, "r = b^2 / a", given=placed((_EA, 0.0, -8.0), (-1.0, 0.0, 0.0), axis=[-0.6, 0.0, 0.8], end="ball", length=60.0)),
        Answer("largest_radius", _EB, "r = b", given=placed((0.0, _EB, -8.0), (0.0, -1.0, 0.0), axis=[0.0, 0.0, 1.0], end="ball", length=60.0)),
        Answer(
            "largest_radius",
            0.8 * _EB**2 / _EA,
            "R = b^2 / a sin t, sin t = 0.8",
            given=placed((_EA, 0.0, -6.0), (-1.0, 0.0, 0.0), axis=[-0.6, 0.0, 0.8], end="flat", length=60.0),
        ),
    ),
)

PARTS = (TORUS_FILLET, ROUNDED_BOSS, FILLET_PAIR, ELLIPSE_POCKET)
