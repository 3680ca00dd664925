"""The area between samples for tools of other kinds: random contacts in served cells, against the exact surface."""

import math

import numpy as np
import pytest

from cad_io import read_part
from plan_cutters import Cutter
from plan_cutters.domain.shapes import flute_length
from tests.support import shapes
from tests.support.contacts import dense, served, wandering
from tests.support.places import SAMPLES

HOLDER = "R10:20L5+R20L55"
TOOLS = {
    "bull": Cutter.bull(radius=2, corner_radius=0.5, length=40),
    "ball": Cutter.ball(radius=2, length=40),
    "taper": Cutter.ball(radius=1.5, length=40, taper=math.radians(4)),
    "tapered bull": Cutter.bull(radius=2, corner_radius=0.5, length=40, taper=math.radians(4)),
    "tapered flat": Cutter.flat(radius=2, length=40, taper=math.radians(3)),
    "lollipop": Cutter.lollipop(radius=2, neck_radius=1, length=40),
    "barrel": Cutter.barrel(radius=2, flank_radius=20, tip_radius=0.7, length=40, flutes=7.0),
    "lens": Cutter.lens(radius=3, bottom_radius=15, corner_radius=0.5, length=40),
    "holder": Cutter.bull(radius=2, corner_radius=1, length=12, flutes=6.0, shank_radius=2.0, holder=HOLDER),
}


def profile(cutter, n=4000):
    """Radius of the whole tool over heights (n,), from its words alone."""
    r, corner, top = cutter.radius, cutter.corner_radius, cutter.length
    stages = [] if cutter.holder is None else cutter.holder.stages
    w = np.linspace(0.0, top + sum(stage.length for stage in stages), n)
    tilt_direction, offset = cutter.taper, r - corner
    tangent = corner * (1.0 - math.sin(tilt_direction))
    flank = offset + corner * math.cos(tilt_direction) + (w - tangent) * math.tan(tilt_direction)
    nose = offset + np.sqrt(np.maximum(0.0, corner**2 - (corner - w) ** 2))
    q = np.where(w < tangent, nose, flank)
    if cutter.shape == "lollipop":
        q = np.where(w < r, np.sqrt(np.maximum(0.0, r * r - (w - r) ** 2)),
                     np.maximum(cutter.shank_radius, np.sqrt(np.maximum(0.0, r * r - (w - r) ** 2))))  # fmt: skip
    if cutter.shape == "barrel":
        flank = r - cutter.arc_radius + np.sqrt(np.maximum(0.0, cutter.arc_radius**2 - (w - cutter.arc_height) ** 2))
        tip = np.sqrt(np.maximum(0.0, corner**2 - (w - corner) ** 2))
        joint = (cutter.arc_radius - r) / (cutter.arc_radius - corner)
        q = np.where(w < corner * (1.0 - math.sqrt(1.0 - joint**2)), tip, flank)
        q = np.where(w > cutter.flutes, flank[np.argmin(abs(w - cutter.flutes))], q)
    if cutter.shape == "lens":
        centre = cutter.arc_radius - math.sqrt((cutter.arc_radius - corner) ** 2 - offset**2)
        bottom = np.sqrt(np.maximum(0.0, cutter.arc_radius**2 - (cutter.arc_radius - w) ** 2))
        joint = cutter.arc_radius * (1.0 - math.cos(math.asin(offset / (cutter.arc_radius - corner))))
        side = offset + np.sqrt(np.maximum(0.0, corner**2 - (np.minimum(w, centre) - centre) ** 2))
        q = np.where(w < joint, bottom, side)
    low = top
    for stage in stages:
        share = (w - low) / stage.length
        q = np.where((w >= low) & (share <= 1.0), stage.radius + share * (stage.upper_radius - stage.radius), q)
        low += stage.length
    return w, q


def touching(cutter, normal, axis, x_t):
    """From the contact to the tip on the axis: the point of the flutes farthest towards the surface touches it."""
    w, q = profile(cutter, 40_000)
    q = np.where(w <= flute_length(cutter), q, -np.inf)
    best = int(np.argmax(q * (x_t @ -normal) + w * (axis @ -normal)))
    return -max(q[best], 0.0) * x_t - w[best] * axis


def deepest(found, geometry, whole, cutter, cloud, count, rng):
    """Largest of the depths of the surface in the tool over random contacts in served cells, mm, to the profile's grain."""
    worst, (w, q) = -math.inf, profile(cutter)
    for contact, normal, axis, x_t, surface in wandering(found, geometry, whole, cloud, count, rng):
        points = surface - contact - touching(cutter, normal, axis, x_t)
        height = points @ axis
        radial = np.linalg.norm(points - height[:, None] * axis, axis=1)
        inside = (height > 0.0) & (height < w[-1])
        inside &= radial < np.interp(height, w, q)
        for point in np.flatnonzero(inside):
            # To the outline and its mirror image; a jump of the radius is a side, too.
            steps = np.linspace(0.0, 1.0, 20)[:, None]
            near_w = np.concatenate([w, [w[-1]], np.repeat(w[-1], 20)])
            near_q = np.concatenate([q, [0.0], (steps * q[-1]).ravel()])
            apart = np.hypot(near_w - height[point], near_q - radial[point]).min()
            worst = max(worst, float(min(apart, max(height[point], 0.0) + 1e9 * (q[0] == 0.0))))
    return worst


@pytest.mark.parametrize("kind", TOOLS)
def test_no_contact_of_a_served_cell_gouges_a_random_surface(kind):
    cutter = TOOLS[kind]
    rng = np.random.default_rng(1)
    part = read_part(shapes.shell(shapes.Patch.random(rng, height=4.0).face()))
    # Of a lens little is served where samples are far apart.
    budget, grid = (8000, 81) if kind == "lens" else (3000, 51)
    found, geometry, whole = served(part, cutter, budget=budget, grid=grid)
    print(kind, found.share, found.contacts)
    assert found.cells.face.size > 50, "nothing to look at"
    assert deepest(found, geometry, whole, cutter, dense(whole, 0.5), 120, rng) < 0.01 + 2e-3


def test_no_contact_between_samples_gouges_deeper_than_is_allowed():
    """A ball of twice the radius of a shallow trough: the border of the trough lies deepest in it, whatever the axis.

    At an angle phi from the contact the surface lies `r - sqrt(R^2 + d^2 + 2 R d cos(phi))` deep, d = r - R. The samples near the
    middle are reached. In the outer part of the cells of the last of them a contact gouges too deep: there, less than a cell is
    served.
    """
    R, r, half = 100.0, 200.0, 0.05
    d = r - R

    def depth(phi):
        return r - np.sqrt(R * R + d * d + 2.0 * R * d * np.cos(phi))

    allowed = float(depth(1.44 * half))
    part = read_part(shapes.shell(shapes.trough(R, half * R, 2.0 * half)))
    found, _, whole = served(part, Cutter.ball(radius=r, length=6 * r), budget=2000, grid=7, tolerance=allowed,
                             chord=0.01 * allowed)  # fmt: skip
    u0, u1 = whole.trim(1).box[:2]
    to_border = np.abs(found.cells.uv[:, 0] - 0.5 * (u0 + u1)) + 0.5 * found.cells.span[:, 0] + half
    assert found.share > 0.15
    assert depth(to_border).max() <= allowed


@pytest.mark.slow
@pytest.mark.parametrize("kind", TOOLS)
def test_no_contact_of_a_served_cell_gouges_a_sample_part(kind):
    cutter = TOOLS[kind]
    found, geometry, whole = served(SAMPLES / "blade.step", cutter, budget=60_000)
    worst = deepest(found, geometry, whole, cutter, dense(whole, 0.4), 2000, np.random.default_rng(1))
    print(kind, found.share, found.contacts, f"deepest {worst:.4f} mm")
    assert worst < 0.01 + 2e-3
