"""The width of the strip that one pass leaves within the scallop height, and the feed direction in which it is widest.

At a contact the gap between the tool and the surface is, to second order, a quadratic form `D = S_tool - S_surface` in the
tangent plane. Its inverse gives the width of a pass in the feed direction d, with e at right angles to d, as
`2 sqrt(2 h e D^-1 e)`: the pass is widest where e is the eigenvector of the largest eigenvalue of `D^-1`
(`docs/operations_proof.md`, lemma O6). Where that is wider than a quarter of the tool's radius the second order is not enough,
and the section across the feed is taken: a circle on a circle for a ball, an ellipse for a flat end, a line parallel to an
ellipse for a bull nose on a plane. For a bull nose on a curved surface, and for a flat end there, the ellipse with the same
second order stands for the section.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Record, SurfaceSamples, cross
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.shapes import modes

#: Widths beyond this part of the radius are those of a section; curvatures below the other count as a plane, 1/mm.
_WIDE, _PLANE = 0.25, 1e-9
#: Halvings by which a section is found.
_HALVINGS = 40
#: Tilts are within a mode up to this, rad; sines below it are that of an axis along the normal.
_HAIR = 1e-9
#: A gap is round within this share, and the centre runs no more than so many times as far as the contact.
_ROUND, _MOST = 1e-6, 50.0


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Strips(Record):
    """Widest strips at contacts.

    Attributes
    ----------
    width : (n,) float
        mm, at most the step-over that is allowed; nan where the tool does not touch at that tilt.
    feed : (n, 3) float
        Unit feed direction of the widest strip, in the tangent plane.
    free_width : (n,) float
        Largest eigenvalue of `D^-1`, mm, the radius of a ball that leaves the same gap; infinite where curvatures match. The
        smaller it is, the farther is the tool from gouging.
    narrow : (n,) float
        Width of the strip that is fed at right angles to that, mm.
    any_feed : (n,) bool
        Whether the strip is as wide in all feed directions.
    """

    width: Floats
    feed: Floats
    free_width: Floats
    narrow: Floats
    any_feed: NDArray[np.bool_]


def strips(cutter: Cutter, samples: SurfaceSamples, axis: Floats, scallop: float, stepover: float) -> Strips:
    """Find the widest strips of a cutter at samples.

    Parameters
    ----------
    cutter : Cutter
    samples : SurfaceSamples
        n of them.
    axis : (n, 3) float
        Unit tool axis at each; nan where there is none.
    scallop : float
        Height of the cusps between passes, mm.
    stepover : float
        Widest distance of passes, in diameters.
    """
    return strips_at(cutter, samples.normal, samples.direction_max, samples.curvature, axis, scallop, stepover)


def strips_at(
    cutter: Cutter, normal: Floats, direction: Floats, curvature: Floats, axis: Floats, scallop: float, stepover: float
) -> Strips:
    """Find the widest strips at points with these normals (n, 3), curvatures (n, 2) and directions (n, 3) of the larger one."""
    cosine = np.clip((normal * axis).sum(axis=1), -1.0, 1.0)
    across = axis - cosine[:, None] * normal
    sine = np.linalg.norm(across, axis=1)
    tilt = np.arctan2(sine, cosine)
    f = np.where((sine > _HAIR)[:, None], across / np.maximum(sine, 1e-300)[:, None], direction)
    t = cross(normal, f)
    offset, radius = _touching(cutter, tilt)
    inverse = np.zeros((len(axis), 2, 2))
    with np.errstate(divide="ignore", invalid="ignore"):
        wide = radius + np.where(offset == 0.0, 0.0, offset / sine)
        inverse[:, 0, 0], inverse[:, 1, 1] = radius, wide
        inverse[np.isinf(wide), 1, 1] = 1e12
        relative = np.eye(2) - inverse @ _surface(normal, direction, curvature, f)
        gap, det = _product(relative, inverse)
    largest, e = _largest(np.where(np.isfinite(gap), gap, 0.0))
    trace = relative[:, 0, 0] + relative[:, 1, 1]
    # Where D is not positive the curvatures match within the tolerance: the strip is as wide as is allowed.
    matched = (det <= 0.0) | (largest <= 0.0) | (trace <= 0.0)
    free_width = np.where(matched, np.inf, largest)
    most = stepover * 2.0 * cutter.radius
    other = np.where(matched, largest, np.maximum(0.0, gap[:, 0, 0] + gap[:, 1, 1] - largest))

    def width_of(free: Floats, curvature: Floats) -> Floats:
        with np.errstate(invalid="ignore"):
            width = 2.0 * np.sqrt(2.0 * scallop * np.maximum(0.0, free))
            bent = ((width > _WIDE * cutter.radius) | (offset == 0.0)) & np.isfinite(width)
            width[bent] = _section(width[bent], curvature[bent], offset[bent], radius[bent], sine[bent], scallop)
            return np.minimum(most, width)

    width, narrow = width_of(free_width, curvature), width_of(other, curvature[:, ::-1])
    feed = e[:, :1] * t - e[:, 1:] * f
    known = np.isfinite(radius) & np.isfinite(axis).all(axis=1)
    with np.errstate(invalid="ignore"):
        round_gap = np.hypot(gap[:, 0, 1], 0.5 * (gap[:, 0, 0] - gap[:, 1, 1])) <= _ROUND * np.abs(largest)
    return Strips(
        np.where(known, width, np.nan),
        feed,
        np.where(known, free_width, np.nan),
        np.where(known, narrow, np.nan),
        known & round_gap,
    )


def centre_path(
    cutter: Cutter, normal: Floats, direction: Floats, curvature: Floats, axis: Floats, feed: Floats,
    mode: tuple[Floats, Floats] | None = None, *, turning: bool = False,
) -> Floats:  # fmt: skip
    """How far the centre of a tool runs for each mm that its contact runs, (n,); 0 where it stands still.

    A contact p with the normal n is cut by a circle of the corner: its centre is p + r n, and the axis is o farther along h, the
    unit part of n across the axis. So the centre runs by t + r dn + o dh where the contact runs by t. At a fixed axis h turns
    with n; where the tool turns with the surface, both turn by n x dn, and with them the way from the centre of the tip to the
    contact. `docs/operations_proof.md`, lemma O11.

    Parameters
    ----------
    cutter : Cutter
    normal, direction, axis, feed : (n, 3) float
        Unit normals, directions of the larger curvature, tool axes, and feed directions in the surface.
    curvature : (n, 2) float
        Of the surface, the larger first, concave positive, 1/mm.
    mode : ((n,) float, (n,) float), optional
        o and r, mm; None: those of the part of the tip that touches.
    turning : bool
        Whether the tool turns with the surface: simultaneous motion.
    """
    cosine = (normal * axis).sum(axis=1)[:, None]
    across = normal - cosine * axis
    sine = np.linalg.norm(across, axis=1)
    h = across / np.maximum(sine, 1e-300)[:, None]
    o, r = _touching(cutter, np.arctan2(sine, cosine[:, 0])) if mode is None else mode
    o, r = o[:, None], r[:, None]
    second = cross(normal, direction)
    dn = -(curvature[:, :1] * (feed * direction).sum(axis=1)[:, None] * direction
           + curvature[:, 1:] * (feed * second).sum(axis=1)[:, None] * second)  # fmt: skip
    upright = (sine <= _HAIR)[:, None]
    if turning:
        ball = o == 0.0
        arm = r * normal + np.where(upright, 0.0, o * h) - np.where(ball, 0.0, r * axis)
        path = feed + cross(cross(normal, dn), arm)
    else:
        flat = dn - (dn * axis).sum(axis=1)[:, None] * axis
        dh = (flat - (flat * h).sum(axis=1)[:, None] * h) / np.maximum(sine, _HAIR)[:, None]
        # Under the flat of a tip any of its points may touch.
        path = feed + np.where(upright & (o != 0.0), 0.0, r * dn + o * np.where(upright, 0.0, dh))
    return np.asarray(np.minimum(np.linalg.norm(path, axis=1), _MOST))


def _touching(cutter: Cutter, tilt: Floats) -> tuple[Floats, Floats]:
    """Of the part that touches at each tilt (n,): how far its centre of curvature is off the axis, and its radius, mm."""
    offset, radius = np.full((2, len(tilt)), np.nan)
    for mode in reversed(modes(cutter)):
        mine = (tilt >= mode.low - _HAIR) & (tilt <= mode.high + _HAIR)
        offset[mine], radius[mine] = mode.offset, mode.radius
    return offset, radius


def _section(width: Floats, curvature: Floats, offset: Floats, radius: Floats, sine: Floats, scallop: float) -> Floats:
    """Widths (n,) of passes that are wide for the tool, by its section across the feed.

    Parameters
    ----------
    width : (n,) float
        By the second order, mm.
    curvature : (n, 2) float
        Of the surface, the larger first.
    offset, radius : (n,) float
        Of the part that touches, mm.
    sine : (n,) float
        Of the tilt.
    scallop : float
    """
    # The ellipse of the largest half width: w^2 = w2^2 - (w2 / 2)^4 / a^2, until its sides are reached.
    half = np.maximum(np.abs(radius + offset), radius)
    section = np.where(
        width >= math.sqrt(8.0) * half, 2.0 * half, width * np.sqrt(np.maximum(0.0, 1.0 - (0.25 * width / half) ** 2))
    )
    ball = offset == 0.0
    section[ball] = _circles(radius[ball], curvature[ball, 0], scallop)
    bull = (offset > 0.0) & (radius > 0.0) & (np.abs(curvature).max(axis=1, initial=0.0) <= _PLANE)
    section[bull] = _parallel(offset[bull], sine[bull], radius[bull], scallop)
    return np.asarray(section)


def _circles(radius: Floats, curvature: Floats, scallop: float) -> Floats:
    """Width of the part of a circle or line that a ball leaves within the scallop height, along the surface."""
    with np.errstate(divide="ignore", invalid="ignore"):
        c = -1.0 / curvature
        # By the sine of a quarter of the arc: the cosine of half of it loses its digits where the circle is nearly flat.
        square = scallop * (2.0 * radius - scallop) / (4.0 * (c + radius) * (c + scallop))
        bent = 4.0 * np.abs(c) * np.arcsin(np.sqrt(np.clip(square, 0.0, 1.0)))
    flat = 2.0 * np.sqrt(np.maximum(0.0, 2.0 * radius * scallop - scallop**2))
    flat = np.where(scallop >= radius, 2.0 * radius, flat)
    return np.where(np.abs(curvature) * radius < 1e-4, flat, bent)


def _parallel(offset: Floats, sine: Floats, radius: Floats, scallop: float) -> Floats:
    """Width of a bull nose on a plane, fed along its tilt: by the line parallel to its circle's ellipse at the corner radius."""
    low, high = np.zeros(len(offset)), np.full(len(offset), 0.5 * math.pi)
    for _ in range(_HALVINGS):
        turn = 0.5 * (low + high)
        below = _height(turn, offset, sine, radius)[1] < scallop
        low, high = np.where(below, turn, low), np.where(below, high, turn)
    return np.asarray(2.0 * _height(low, offset, sine, radius)[0])


def _height(turn: Floats, offset: Floats, sine: Floats, radius: Floats) -> tuple[Floats, Floats]:
    """How far aside, and how high over the plane, the line parallel to the ellipse is at an angle of it."""
    tall = offset * sine
    along, up = tall * np.sin(turn), offset * np.cos(turn)
    size = np.maximum(np.hypot(along, up), 1e-300)
    return offset * np.sin(turn) + radius * along / size, radius + tall * (1.0 - np.cos(turn)) - radius * up / size


def _surface(normal: Floats, direction: Floats, curvature: Floats, f: Floats) -> Floats:
    """Second fundamental forms (n, 2, 2) in the frame of f and n x f, concave positive."""
    c = (f * direction).sum(axis=1)
    s = (cross(normal, direction) * f).sum(axis=1)
    high, low = curvature.T
    form = np.empty((len(f), 2, 2))
    form[:, 0, 0] = high * c**2 + low * s**2
    form[:, 1, 1] = high * s**2 + low * c**2
    form[:, 0, 1] = form[:, 1, 0] = (low - high) * s * c
    return form


def _largest(form: Floats) -> tuple[Floats, Floats]:
    """The larger eigenvalues (n,) of symmetric matrices (n, 2, 2), and their unit eigenvectors (n, 2)."""
    middle, half, side = 0.5 * (form[:, 0, 0] + form[:, 1, 1]), 0.5 * (form[:, 0, 0] - form[:, 1, 1]), form[:, 0, 1]
    turn = 0.5 * np.arctan2(side, half)
    return middle + np.hypot(half, side), np.column_stack([np.cos(turn), np.sin(turn)])


def _product(relative: Floats, inverse: Floats) -> tuple[Floats, Floats]:
    """`relative^-1 inverse` (n, 2, 2), made symmetric, and the determinants of `relative`, which may be singular."""
    det = relative[:, 0, 0] * relative[:, 1, 1] - relative[:, 0, 1] * relative[:, 1, 0]
    turned = np.empty_like(relative)
    turned[:, 0, 0], turned[:, 1, 1] = relative[:, 1, 1], relative[:, 0, 0]
    turned[:, 0, 1], turned[:, 1, 0] = -relative[:, 0, 1], -relative[:, 1, 0]
    product = (turned @ inverse) / det[:, None, None]
    return np.asarray(0.5 * (product + product.transpose(0, 2, 1))), det
