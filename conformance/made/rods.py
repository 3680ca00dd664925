"""Rods, bores and a blade: whole cylinders."""

from typing import Any

import numpy as np

from conformance.forms import Prism, Surface, box
from conformance.made.part import Answer, MadePart, directions
from conformance.made.patches import descent, inner, placed, revolved_line
from conformance.tool import Floats, Tool

_FLAT, _BALL, _BULL = Tool.flat(8.0, 40.0), Tool.ball(6.0, 40.0), Tool.flat(8.0, 40.0, corner=1.5)
_TOOLS = (_FLAT, _BALL, _BULL)
_Y = 100.0


def _box(low: tuple[float, float, float], high: tuple[float, float, float]) -> Any:
    import cadquery as cq

    size = [b - a for a, b in zip(low, high, strict=True)]
    return cq.Workplane("XY", origin=low).box(size[0], size[1], size[2], centered=False)


def _rod(radius: float, z: float) -> Any:
    import cadquery as cq

    return cq.Workplane("XZ", origin=(0, 0, z)).circle(radius).extrude(_Y, both=True)


# A cylinder that lies on a plate, sunk into it a little.
_R, _Z = 12.0, 8.0
_FOOT = float(np.sqrt(_R**2 - _Z**2))


def _rod_contacts(rng: np.random.Generator, n: int) -> tuple[Floats, Floats]:
    turn, y = rng.uniform(-1.7, 1.7, n), rng.uniform(-5, 5, n)
    normal = np.column_stack([np.sin(turn), np.zeros(n), np.cos(turn)])
    return _R * normal + np.column_stack([np.zeros(n), y, np.full(n, _Z)]), normal


def _at(deg: float, z: float = _Z, radius: float = _R) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    s, c = float(np.sin(np.radians(deg))), float(np.cos(np.radians(deg)))
    return (radius * s, 0.0, z + radius * c), (s, 0.0, c)


ROD_ON_PLATE = MadePart(
    "rod_on_plate",
    "rods",
    "Cylinder boss lying on a plate",
    """A cylinder of radius Rb = 12 along y, its axis 8 above the plate. At angle q from z a ball end r has its centre 8 + (Rb + r) cos q above the
    plate, and touches both when r = (8 + Rb cos q) / (1 - cos q). Tilted down across the cylinder, the rim of the flat top meets the plate (patches.descent);
    tilted along the cylinder nothing is in the way of a convex body. Form: a rod as a prism of all normals, the plate in two boxes.""",
    lambda: _box((-70, -_Y, -20), (70, _Y, 0)).union(_rod(_R, _Z)),
    (
        Prism("rod", ((0.0, 0.0, _Z),), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0), 0.0, 2 * np.pi, _R),
        box("plate at +x", (_FOOT, -_Y, -20.0), (70.0, _Y, 0.0)),
        box("plate at -x", (-70.0, -_Y, -20.0), (-_FOOT, _Y, 0.0)),
        inner("plate under it", (-_FOOT, -_Y, -20.0), (_FOOT, _Y, 0.0)),
    ),
    _TOOLS,
    _rod_contacts,
    answers=(
        Answer(
            "largest_radius",
            (_Z + _R * 0.5) / 0.5,
            "r = (8 + Rb cos q) / (1 - cos q), q = 60 deg",
            given=placed(*_at(60.0), axis=list(_at(45.0)[1]), end="ball", length=70.0),
        ),
        Answer("free_tilts", [[0.0, 90.0]], "along a convex body the way is free", tool=_FLAT.name, given=placed(*_at(40.0), (0.0, 1.0, 0.0))),
        Answer(
            "free_tilts",
            [[0.0, 30.0 + descent(_Z + 15.0 * 0.5, 3.0, 40.0)]],
            "(L - r) sin b + r cos b = 8 + (Rb + r) cos q; tilt = 90 - q + b",
            tool=_BALL.name,
            given=placed(*_at(60.0), (0.5, 0.0, -float(np.sqrt(0.75)))),
        ),
    ),
)


# A tube, to be reached from both ends; the holder is wider than its bore.
_RI, _RO, _LT = 10.0, 20.0, 80.0
_STICK = 50.0
_HELD = Tool.ball(6.0, _STICK, holder=((_STICK, 12.0), (_STICK + 40.0, 12.0)), name="ball_D6_holder_D24")
_SHORT = Tool.ball(6.0, 30.0, holder=((30.0, 12.0), (70.0, 12.0)), name="ball_D6_short_holder_D24")


def _tube_contacts(rng: np.random.Generator, n: int) -> tuple[Floats, Floats]:
    turn, z = rng.uniform(-np.pi, np.pi, n), rng.uniform(1.0, _LT - 1.0, n)
    out = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(n)])
    return _RI * out + np.outer(z, [0.0, 0.0, 1.0]), -out


def _tube_axes(rng: np.random.Generator, points: Floats, normals: Floats) -> Floats:
    """Return axes out of either end, up to 25 degrees from the bore's axis, to the side of the normal."""
    n = len(points)
    tilt, turn = np.radians(rng.uniform(0.05, 25.0, n)), rng.uniform(-1.2, 1.2, n)
    side = np.cross([0.0, 0.0, 1.0], normals)
    across = np.cos(turn)[:, None] * normals + np.sin(turn)[:, None] * side
    up = np.where(points[:, 2] + rng.uniform(-25, 25, n) > 0.5 * _LT, 1.0, -1.0)
    return np.sin(tilt)[:, None] * across + (np.cos(tilt) * up)[:, None] * np.array([0.0, 0.0, 1.0])


TUBE = MadePart(
    "tube",
    "rods",
    "Tube to be reached from both ends",
    """Bore radius 10, length 80, a holder of radius 12 that does not enter it. Along the axis of the bore, a ball end r that touches the wall at depth d
    has its tip at depth d + r, and the holder its end face: least stick-out d + r. Tilted, the holder's lower disk, wider than the bore, stays
    outside the end as well, so with stick-out S no point deeper than S is within reach of that end: with S = 50 and length 80 one end is not enough,
    and S - r >= 40 on both sides is: two directions, +z and -z.""",
    lambda: _ring(),
    (
        revolved_line("bore", (_RI, 0.0), (_RI, _LT), (55, 49)),
        revolved_line("wall", (_RO, 0.0), (_RO, _LT), (41, 61)),
        revolved_line("upper end", (_RI, _LT), (_RO, _LT), (9, 73)),
        revolved_line("lower end", (_RI, 0.0), (_RO, 0.0), (9, 73)),
    ),
    (_HELD, _SHORT),
    _tube_contacts,
    axes=_tube_axes,
    answers=(
        *(
            Answer("least_stickout", d + 3.0, "depth + r", tool=_HELD.name, given=placed((_RI, 0.0, _LT - d), (-1.0, 0.0, 0.0), axis=[0.0, 0.0, 1.0]))
            for d in (10.0, 30.0)
        ),
        Answer(
            "least_stickout",
            25.0 + 3.0,
            "depth + r, from the lower end",
            tool=_HELD.name,
            given=placed((0.0, -_RI, 25.0), (0.0, 1.0, 0.0), axis=[0.0, 0.0, -1.0]),
        ),
        Answer(
            "orientations",
            2,
            "no point deeper than the stick-out is within reach of an end: 50 < 80; 47 >= 40",
            tool=_HELD.name,
            given=directions(((0.0, 0.0, 1.0), (0.0, 0.0, -1.0)), [((_RI, 0.0, z), (-1.0, 0.0, 0.0)) for z in (5.0, 39.0, 41.0, 75.0)], 90.0, (0, 3)),
        ),
    ),
)


def _ring() -> Any:
    import cadquery as cq

    return cq.Workplane("XY").circle(_RO).circle(_RI).extrude(_LT)


# A rod across a groove.
_GW, _GD, _RR, _ZR = 12.0, 20.0, 6.0, 4.0


def _groove_contacts(rng: np.random.Generator, n: int) -> tuple[Floats, Floats]:
    x, y = rng.uniform(-25, 25, n), rng.uniform(-_GW + 0.5, _GW - 0.5, n)
    return np.column_stack([x, y, np.full(n, -_GD)]), np.tile([0.0, 0.0, 1.0], (n, 1))


def _under(x: float, r: float) -> list[list[float]]:
    """Return the free tilts (deg) along +x of a ball end r on the groove's floor at x, under the rod.

    The axis misses the rod's when their distance is Rr + r: asin((Rr + r) / d) from the line between the centres, d apart.
    """
    way = np.array([-x, _ZR + _GD - r])
    d, line = np.hypot(*way), np.degrees(np.arctan2(way[0], way[1]))
    off = np.degrees(np.arcsin((_RR + r) / d))
    free = [[0.0, float(line - off)]] if line - off > 0 else []
    return [*free, [float(max(0.0, line + off)), 90.0]] if line + off < 90 else free


ROD_OVER_GROOVE = MadePart(
    "rod_over_groove",
    "rods",
    "Cylinder across a groove in a plate",
    """A groove along x, 24 wide and 20 deep, and across it a cylinder of radius Rr = 6 whose axis is 4 above the plate. A ball end r on the groove's floor
    tilts along the groove: it passes the cylinder when its axis is Rr + r away from the cylinder's, asin((Rr + r) / d) to either side of the line between the
    centres, d apart. Upright it stands free where it is Rr + r from under the cylinder's axis.""",
    lambda: _box((-90, -70, -40), (90, 70, 0)).cut(_box((-90, -_GW, -_GD), (90, _GW, 1))).union(_rod(_RR, _ZR)),
    (
        Prism("rod", ((0.0, 0.0, _ZR),), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0), 0.0, 2 * np.pi, _RR),
        box("side at +y", (-90.0, _GW, -40.0), (90.0, 70.0, 0.0)),
        box("side at -y", (-90.0, -70.0, -40.0), (90.0, -_GW, 0.0)),
        box("floor", (-90.0, -_GW, -40.0), (90.0, _GW, -_GD)),
    ),
    _TOOLS,
    _groove_contacts,
    answers=tuple(
        Answer(
            "free_tilts",
            _under(x, 3.0),
            "asin((Rr + r) / d) to both sides of the line of centres",
            tool=_BALL.name,
            given=placed((x, 0.0, -_GD), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)),
        )
        for x in (0.0, 5.0, -15.0)
    ),
)


# A curved blade: two arcs about z, 3 apart, on a root.
_BI, _BO, _BH, _BA = 27.0, 30.0, 40.0, float(np.radians(40.0))


def _blade() -> Any:
    import cadquery as cq

    c, s = np.cos(_BA), np.sin(_BA)
    profile = (
        cq.Workplane("XY", origin=(0, 0, -1))
        .moveTo(_BI * c, -_BI * s)
        .lineTo(_BO * c, -_BO * s)
        .threePointArc((_BO, 0), (_BO * c, _BO * s))
        .lineTo(_BI * c, _BI * s)
        .threePointArc((_BI, 0), (_BI * c, -_BI * s))
        .close()
        .extrude(_BH + 1)
    )
    return _box((-70, -70, -20), (90, 70, 0)).union(profile)


def _blade_surface(name: str, first: tuple[float, float], last: tuple[float, float], grid: tuple[int, int]) -> Surface:
    return revolved_line(name, first, last, grid, (-_BA, _BA))


def _end(name: str, angle: float) -> Surface:
    def at(u: Floats, v: Floats) -> Floats:
        return np.stack([u * np.cos(angle), u * np.sin(angle), v], axis=-1)

    return Surface(name, at, (_BI, _BO), (0.0, _BH), (5, 41))


def _blade_contacts(rng: np.random.Generator, n: int) -> tuple[Floats, Floats]:
    turn, z, inside = rng.uniform(-0.6, 0.6, n), rng.uniform(2.0, _BH - 1.0, n), rng.random(n) < 0.6
    out = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(n)])
    return np.where(inside, _BI, _BO)[:, None] * out + np.outer(z, [0.0, 0.0, 1.0]), np.where(inside[:, None], -out, out)


BLADE = MadePart(
    "blade",
    "rods",
    "Curved blade on a root",
    """Two arcs of radius 27 and 30 about z, 80 deg long, 40 high, on a plate. On the hollow side a ball has r <= 27. The bottom plane of a flat end at tilt t
    towards z cuts the cylinder in an ellipse with half axes 27 / sin t and 27, which the edge's circle touches at the end of the long axis: inside if
    and only if R <= 27 sin t, and the cylinder above it runs up along the wall. A ball on the other side at height z touches the plate when r = z.""",
    _blade,
    (
        _blade_surface("hollow side", (_BI, 0.0), (_BI, _BH), (37, 41)),
        _blade_surface("round side", (_BO, 0.0), (_BO, _BH), (37, 41)),
        _blade_surface("top", (_BI, _BH), (_BO, _BH), (5, 41)),
        _end("end at +y", _BA),
        _end("end at -y", -_BA),
        box("root", (-70.0, -70.0, -20.0), (90.0, 70.0, 0.0)),
    ),
    _TOOLS,
    _blade_contacts,
    answers=(
        *(
            Answer(
                "free_tilts",
                [[float(np.degrees(np.arcsin(4.0 / _BI))), 90.0]],
                "sin t = R / 27",
                tool=_FLAT.name,
                given=placed((_BI, 0.0, z), (-1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
            )
            for z in (15.0, 30.0)
        ),
        Answer("largest_radius", _BI, "r = 27", given=placed((_BI, 0.0, 35.0), (-1.0, 0.0, 0.0), axis=[-0.6, 0.0, 0.8], end="ball", length=70.0)),
        Answer("largest_radius", 12.0, "r = height", given=placed((_BO, 0.0, 12.0), (1.0, 0.0, 0.0), axis=[0.6, 0.0, 0.8], end="ball", length=70.0)),
    ),
)

PARTS = (ROD_ON_PLATE, TUBE, ROD_OVER_GROOVE, BLADE)
