"""Grooves: the seed's first example, and a groove with a round bottom between bounded walls."""

from typing import Any

import numpy as np

from conformance.forms import Surface, section
from conformance.made.part import Answer, MadePart
from conformance.tool import Floats, Tool

# The seed's first example: two planes at 120 degrees, 25 mm wide, joined by 60 degrees of a cylinder of radius 5 about the y direction.
_RC, _LP, _HALF = 5.0, 25.0, 110.0
_SLOPE = np.radians(30.0)
_JOIN = (_RC * np.sin(_SLOPE), _RC * (1 - np.cos(_SLOPE)))
_RIM = (_JOIN[0] + _LP * np.cos(_SLOPE), _JOIN[1] + _LP * np.sin(_SLOPE))


def _v_groove() -> Any:
    import cadquery as cq

    profile = (
        cq.Workplane("XZ")
        .moveTo(*_RIM)
        .lineTo(*_JOIN)
        .threePointArc((0.0, 0.0), (-_JOIN[0], _JOIN[1]))
        .lineTo(-_RIM[0], _RIM[1])
        .lineTo(-_RIM[0], -10.0)
        .lineTo(_RIM[0], -10.0)
        .close()
    )
    return profile.extrude(_HALF, both=True)


def _v_contacts(rng: np.random.Generator, n: int) -> tuple[Floats, Floats]:
    angle, y = rng.uniform(-_SLOPE * 0.98, _SLOPE * 0.98, n), rng.uniform(-5.0, 5.0, n)
    inward = np.column_stack([-np.sin(angle), np.zeros(n), np.cos(angle)])
    return np.column_stack([np.zeros(n), y, np.full(n, _RC)]) - _RC * inward, inward


def _arc(u: Floats, v: Floats) -> Floats:
    return np.stack([_RC * np.sin(u), v, _RC * (1 - np.cos(u))], axis=-1)


def _free_tilts(rotation: float) -> list[list[float]]:
    """Return the free tilts (deg) of the flat end R 8, L 90 at the middle of the bottom line, `rotation` deg from across the groove.

    The axis leans by `t` towards `f = (cos q, sin q, 0)`; the edge's centre lies at `-R x_T`, `x_T = cos t f - sin t n`. The lower end of the tilt
    is where the rim touches the plane of the opposite wall, `m.(-R x_T - p0) = R hypot(m.x_T, m.y_T)`, or local gouging,
    `sin t = R sin(q)^2 / Rc`, whichever is later. The upper end is where the side of the cylinder meets the rim line of the wall that it leans to: that line
    is at distance R from the axis.
    """
    from scipy.optimize import brentq

    q, big = np.radians(rotation), 8.0
    f, t = np.array([np.cos(q), np.sin(q), 0.0]), np.array([0.0, 0.0, 1.0])
    local = big * np.sin(q) ** 2 / _RC
    if local > 1:
        return []

    def rim(tilt: float, side: float) -> float:
        x = np.cos(tilt) * f - np.sin(tilt) * t
        y = np.cross(np.cos(tilt) * t + np.sin(tilt) * f, x)
        m = np.array([-side * np.sin(_SLOPE), 0.0, np.cos(_SLOPE)])
        return float(m @ (-big * x - np.array([side * _JOIN[0], 0.0, _JOIN[1]])) - big * np.hypot(m @ x, m @ y))

    def side_line(tilt: float) -> float:
        a, x = np.cos(tilt) * t + np.sin(tilt) * f, np.cos(tilt) * f - np.sin(tilt) * t
        across = np.cross(a, [0.0, 1.0, 0.0])
        return float(abs((np.array([_RIM[0], 0.0, _RIM[1]]) + big * x) @ across) / np.linalg.norm(across) - big)

    tilts = np.linspace(1e-6, np.radians(89.9), 4000)
    worst = np.array([min(rim(s, -1.0), rim(s, 1.0)) for s in tilts])
    free = (worst >= 0) & (np.sin(tilts) >= local)
    if not free.any():
        return []
    first = int(np.argmax(free))
    low = brentq(lambda s: min(min(rim(s, -1.0), rim(s, 1.0)), np.sin(s) - local), tilts[first - 1], tilts[first])
    meets = np.array([side_line(s) for s in tilts[first:]])
    if not (meets < 0).any():
        return [[float(np.degrees(low)), 90.0]]
    if meets[0] < 0:
        return []
    k = first + int(np.argmax(meets < 0))
    return [[float(np.degrees(low)), float(np.degrees(brentq(side_line, tilts[k - 1], tilts[k])))]]


_GROOVE_TOOL = Tool.flat(16.0, 90.0)

V_GROOVE = MadePart(
    "v_groove",
    "grooves",
    "V-groove with a round bottom, the seed's first example",
    """Two planes at 120 degrees, each 25 mm wide, joined by 60 degrees of a cylinder of radius 5. Walls are convex prisms between join
    and rim (form: separating planes); the bottom is a Surface. Free tilts at the middle of the bottom line: see `_free_tilts`. The seed's rule for rear
    gouging takes a point that is free at tilt 0 as free for good; the true lower ends lie up to 13 degrees higher, and none is left at 50 degrees.""",
    _v_groove,
    (
        section("right wall", _JOIN, _RIM, (_RIM[0], -10.0), (_JOIN[0], -10.0)),
        section("left wall", (-_JOIN[0], _JOIN[1]), (-_RIM[0], _RIM[1]), (-_RIM[0], -10.0), (-_JOIN[0], -10.0)),
        Surface("bottom", _arc, (-_SLOPE, _SLOPE), (-_HALF, _HALF), (25, 221)),
    ),
    (_GROOVE_TOOL, Tool.ball(8.0, 60.0), Tool.flat(6.0, 50.0, corner=1.0)),
    _v_contacts,
    answers=tuple(
        Answer(
            "free_tilts",
            _free_tilts(turn),
            "rim on the opposite wall, side on the rim line, local gouging: grooves._free_tilts",
            tool=_GROOVE_TOOL.name,
            given={
                "contact": [0.0, 0.0, 0.0],
                "normal": [0.0, 0.0, 1.0],
                "lean": [float(np.cos(np.radians(turn))), float(np.sin(np.radians(turn))), 0.0],
                "rotation_deg": turn,
            },
        )
        for turn in (0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 90.0)
    ),
)

PARTS = (V_GROOVE,)
