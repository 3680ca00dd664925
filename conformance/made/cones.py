"""Cones: a pit, a boss, and a cone next to a tapered wall."""

from typing import Any

import numpy as np

from conformance.forms import Hull, box, section
from conformance.made.part import Answer, MadePart
from conformance.made.patches import Inner, boxes_round, descent, inner, past_edge, placed, polygon, revolved_line
from conformance.tool import Floats, Tool

_TOOLS = (Tool.flat(8.0, 40.0), Tool.ball(6.0, 40.0), Tool.flat(8.0, 40.0, corner=1.0))


def _block(half: float, low: float, high: float) -> Any:
    import cadquery as cq

    return cq.Workplane("XY", origin=(0, 0, low)).box(2 * half, 2 * half, high - low, centered=(True, True, False))


def _cone(*profile: tuple[float, float]) -> Any:
    """Return a polygon (radius, z) revolved about z."""
    import cadquery as cq

    return cq.Workplane("XZ").polyline(list(profile)).close().revolve(360, (0, 0, 0), (0, 1, 0))


# A pit: apex at the bottom, half angle from z.
_AP = np.radians(60.0)
_DP = 20.0
_TOP = float(_DP * np.tan(_AP))


def _pit_contacts(rng: np.random.Generator, n: int) -> tuple[Floats, Floats]:
    r, turn = rng.uniform(6.0, _TOP - 0.5, n), rng.uniform(-np.pi, np.pi, n)
    out = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(n)])
    normal = -np.cos(_AP) * out + np.array([0.0, 0.0, np.sin(_AP)])
    return r[:, None] * out + np.column_stack([np.zeros(n), np.zeros(n), r / np.tan(_AP) - _DP]), normal


def _in_pit(r: float) -> tuple[tuple[float, float, float], tuple[float, float, float], tuple[float, float, float]]:
    """Return contact, normal and the way up of a point of the pit at +x."""
    return ((r, 0.0, float(r / np.tan(_AP) - _DP)), (float(-np.cos(_AP)), 0.0, float(np.sin(_AP))), (float(np.sin(_AP)), 0.0, float(np.cos(_AP))))


CONE_PIT = MadePart(
    "cone_pit",
    "cones",
    "Conical pit in a block",
    """Half angle A = 60 deg from z, apex 20 below the top. A ball that touches at distance d from the axis fits when its centre does not lie beyond the
    axis, r <= d / cos A: this is also the radius of curvature across. A flat end that tilts by t up the generator has its bottom plane cut the cone in
    a conic whose vertex, with radius of curvature (d / cos A) sin t, is the contact: the edge's circle is inside if and only if R is
    no larger (a vertex of the long axis has the least radius). Its axis stays among the directions along which nothing leaves the convex void (at
    least 30 deg above the horizon), so the cylinder is free up to 90 deg.""",
    lambda: _block(50.0, -35.0, 0.0).cut(_cone((0.0, -_DP), (_TOP, 0.0), (0.0, 0.0))),
    (
        revolved_line("cone", (0.0, -_DP), (_TOP, 0.0), (31, 81)),
        revolved_line("top", (_TOP, 0.0), (49.9, 0.0), (12, 101)),
        *boxes_round((_TOP + 0.1, _TOP + 0.1), (50.0, 50.0), (-35.0, 0.0)),
        inner("under", (-35.0, -35.0, -35.0), (35.0, 35.0, -20.0)),
    ),
    _TOOLS,
    _pit_contacts,
    answers=(
        *(
            Answer(
                "free_tilts",
                [[float(np.degrees(np.arcsin(4.0 * np.cos(_AP) / d))), 90.0]],
                "sin t = R cos A / d",
                tool=_TOOLS[0].name,
                given=placed(*_in_pit(d)),
            )
            for d in (8.0, 20.0)
        ),
        *(
            Answer("largest_radius", float(d / np.cos(_AP)), "r = d / cos A", given=placed(*_in_pit(d)[:2], axis=[0.0, 0.0, 1.0], end="ball", length=60.0))
            for d in (5.0, 12.0)
        ),
    ),
)


# A pointed boss on a plate.
_AB, _HB = np.radians(25.0), 30.0
_FOOT = float(_HB * np.tan(_AB))


def _cone_contacts(rng: np.random.Generator, n: int) -> tuple[Floats, Floats]:
    z, turn = rng.uniform(1.0, _HB - 1.0, n), rng.uniform(-np.pi, np.pi, n)
    out = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(n)])
    normal = np.cos(_AB) * out + np.array([0.0, 0.0, np.sin(_AB)])
    return ((_HB - z) * np.tan(_AB))[:, None] * out + np.outer(z, [0.0, 0.0, 1.0]), normal


def _on_cone(z: float) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    return (float((_HB - z) * np.tan(_AB)), 0.0, z), (float(np.cos(_AB)), 0.0, float(np.sin(_AB)))


_DOWN = (float(np.sin(_AB)), 0.0, float(-np.cos(_AB)))


def _tilt_down(z: float) -> float:
    """Return the largest tilt (deg) down the generator of the ball end r 3, L 40."""
    return float(min(90.0, np.degrees(_AB) + descent(z + 3.0 * np.sin(_AB), 3.0, 40.0)))


CONE_BOSS = MadePart(
    "cone_boss",
    "cones",
    "Pointed cone on a plate",
    """Half angle A = 25 deg, 30 high. The normal rises by A above the horizon: a ball end that touches at height z has its centre at z + r sin A, and
    touches the plate too when r = z / (1 - sin A). Tilted down the generator, the rim of its flat top meets the plate (patches.descent); tilted up,
    nothing is in the way of a convex body. Form: the cone and the plate's top as Surfaces, polyhedron and box inside.""",
    lambda: _block(60.0, -20.0, 0.0).union(_cone((0.0, -1.0), (_FOOT, -1.0), (_FOOT, 0.0), (0.0, _HB))),
    (
        revolved_line("cone", (_FOOT, 0.0), (0.0, _HB), (35, 61)),
        revolved_line("top", (_FOOT, 0.0), (59.9, 0.0), (25, 121)),
        Inner(Hull("inside", (*polygon(_FOOT - 0.1, 0.0), (0.0, 0.0, _HB - 0.1)))),
        inner("plate", (-60.0, -60.0, -20.0), (60.0, 60.0, 0.0)),
    ),
    _TOOLS,
    _cone_contacts,
    answers=(
        *(
            Answer(
                "free_tilts",
                [[0.0, _tilt_down(z)]],
                "(L - r) sin b + r cos b = z + r sin A; tilt = A + b",
                tool=_TOOLS[1].name,
                given=placed(*_on_cone(z), _DOWN),
            )
            for z in (6.0, 15.0)
        ),
        Answer("free_tilts", [[0.0, 90.0]], "the way up a convex body is free", tool=_TOOLS[0].name, given=placed(*_on_cone(20.0), tuple(-x for x in _DOWN))),
        Answer(
            "largest_radius",
            float(8.0 / (1 - np.sin(_AB))),
            "r = z / (1 - sin A)",
            given=placed(*_on_cone(8.0), axis=[float(np.cos(_AB)), 0.0, float(np.sin(_AB))], end="ball", length=60.0),
        ),
    ),
)


# A truncated cone and a tapered wall on a plate: the wall's foot along y at x = 20.
_AW, _HW, _XW = np.radians(20.0), 25.0, 20.0
_AC, _HC, _RC, _XC = np.radians(15.0), 20.0, 15.0, -20.0
_WT = float(_XW + _HW * np.tan(_AW))
_CT = float(_RC - _HC * np.tan(_AC))
_WALL = ((_XW, 0.0), (_WT, _HW), (60.0, _HW), (60.0, 0.0))


def _moved(part: Any) -> Any:
    return part.translate((_XC, 0.0, 0.0))


def _cone_and_wall() -> Any:
    import cadquery as cq

    wall = cq.Workplane("XZ").polyline([(_XW, -1.0), *_WALL[:3], (60.0, -1.0)]).close().extrude(60.0, both=True)
    cone = _moved(_cone((0.0, -1.0), (_RC, -1.0), (_RC, 0.0), (_CT, _HC), (0.0, _HC)))
    return _block(60.0, -20.0, 0.0).union(wall).union(cone)


def _shifted(name: str, start: tuple[float, float], end: tuple[float, float], grid: tuple[int, int]) -> Any:
    """Return a revolved line about the cone's own axis."""
    from dataclasses import replace

    surface = revolved_line(name, start, end, grid)
    return replace(surface, at=lambda u, v: surface.at(u, v) + np.array([_XC, 0.0, 0.0]))


def _floor_contacts(rng: np.random.Generator, n: int) -> tuple[Floats, Floats]:
    """Return points of the plate between cone and wall, and of the wall."""
    y, share = rng.uniform(-15.0, 15.0, n), rng.uniform(0.03, 0.97, n)
    x = _XC + np.sqrt(_RC**2 - np.clip(y, -14.9, 14.9) ** 2)
    floor = np.column_stack([x + share * (_XW - x), y, np.zeros(n)])
    wall = np.column_stack([_XW + share * (_WT - _XW), y, share * _HW])
    on_wall = (np.arange(n) % 3 == 0)[:, None]
    return np.where(on_wall, wall, floor), np.where(on_wall, [-np.cos(_AW), 0.0, np.sin(_AW)], [0.0, 0.0, 1.0])


def _tilt_to_wall(x: float, tool: Tool) -> float:
    """Return the tilt (deg) at which the side of a ball end on the floor meets the wall's upper edge."""
    r = tool.corner
    return past_edge(_WT - x, _HW - r, r)


CONE_AND_WALL = MadePart(
    "cone_and_wall",
    "cones",
    "Cone and tapered wall on a plate",
    """A wall tapered by B = 20 deg, 25 high, and a truncated cone of half angle A = 15 deg, 20 high. A ball on the plate at distance d from the foot of a
    wall that leans away by an angle touches both when r = d tan(45 deg + angle / 2): in the bisector of the open angle. For the cone the same
    holds in the plane of its axis. The side of a ball end that tilts to the wall meets the wall's upper edge before its face where that edge is
    nearer to the axis than the tilt, `across cos t - up sin t = r` (patches.past_edge): the angle of the tilt exceeds B.""",
    _cone_and_wall,
    (
        section("wall", *_WALL),
        _shifted("cone", (_RC, 0.0), (_CT, _HC), (25, 81)),
        _shifted("top of the cone", (0.0, _HC), (_CT, _HC), (10, 41)),
        Inner(Hull("inside", tuple((x + _XC, y, z) for x, y, z in (*polygon(_RC - 0.1, 0.0), *polygon(_CT - 0.1, _HC))))),
        box("plate", (-60.0, -60.0, -20.0), (_XW, 60.0, 0.0)),
        inner("under the wall", (_XW, -60.0, -20.0), (60.0, 60.0, 0.0)),
    ),
    _TOOLS,
    _floor_contacts,
    answers=(
        Answer(
            "largest_radius",
            float(8.0 * np.tan(np.pi / 4 + _AW / 2)),
            "r = d tan(45 deg + B / 2), d = 8 from the wall",
            given=placed((_XW - 8.0, 0.0, 0.0), (0.0, 0.0, 1.0), axis=[0.0, 0.0, 1.0], end="ball", length=60.0),
        ),
        Answer(
            "largest_radius",
            float(6.0 * np.tan(np.pi / 4 + _AC / 2)),
            "r = d tan(45 deg + A / 2), d = 6 from the cone",
            given=placed((_XC + _RC + 6.0, 0.0, 0.0), (0.0, 0.0, 1.0), axis=[0.0, 0.0, 1.0], end="ball", length=60.0),
        ),
        *(
            Answer(
                "free_tilts",
                [[0.0, _tilt_to_wall(x, _TOOLS[1])]],
                "across cos t - up sin t = r at the wall's upper edge",
                tool=_TOOLS[1].name,
                given=placed((x, 0.0, 0.0), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)),
            )
            for x in (5.0, 14.0)
        ),
    ),
)

PARTS = (CONE_PIT, CONE_BOSS, CONE_AND_WALL)
