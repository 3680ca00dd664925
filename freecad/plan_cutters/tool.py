"""Where a tool stands at a posture, and its assembly as a shape.

The centres of a cutter's corner lie on a circle around its axis: a point for a ball, the edge itself for a flat end. At a contact
one of them is `corner_radius` + allowance away along the normal, and so the tip is known.
"""

from __future__ import annotations

import math
from typing import Any

import FreeCAD as App
import Part

from .words import tr

#: Colours of the parts of an assembly.
COLOURS = {"flutes": (0.55, 0.60, 0.65), "neck": (0.45, 0.50, 0.55), "shank": (0.45, 0.50, 0.55), "holder": (0.25, 0.27, 0.30)}
#: Shapes of cutters whose dimensions in the plan say all.
DRAWN = ("end", "lollipop")


def tip(cutter: dict[str, Any], point, normal, axis, lean) -> tuple[float, float, float] | None:
    """The tip of a cutter that touches a point; None where the plan does not say enough of its shape.

    Parameters
    ----------
    cutter : dict
        Its entry in the plan.
    point, normal, axis : sequence of float
        Contact (mm), unit normal out of the material, unit tool axis towards the spindle.
    lean : sequence of float
        Direction in the tangent plane that the axis is tilted to; it counts where the axis is the normal alone.
    """
    if cutter["shape"] not in DRAWN:
        return None
    corner = cutter["radius"] if cutter["shape"] == "lollipop" else cutter["corner_radius"]
    normal, axis = (App.Vector(*map(float, each)) for each in (normal, axis))
    # From the contact across the axis, towards it.
    across = normal - axis * normal.dot(axis)
    if across.Length < 1e-9:
        across = App.Vector(*map(float, lean)) * -1.0
    if not across.Length > 0.0:  # not a number is none, either
        return None
    centre = App.Vector(*map(float, point)) + normal * (corner + cutter["allowance_mm"])
    found = centre + across.normalize() * (cutter["radius"] - corner) - axis * corner
    return tuple(found)


def assembly(cutter: dict[str, Any]) -> tuple[Any, list[str]]:
    """A tool assembly with its tip at the origin and +Z to the spindle; of each of its solids the part that it is.

    Raises
    ------
    ValueError
        The plan does not say enough of its shape.
    """
    if cutter["shape"] not in DRAWN:
        raise ValueError(tr("a {shape} cutter is not drawn here: the review page shows it").format(shape=cutter["shape"]))
    solids, parts = [_flutes(cutter)], ["flutes"]
    for stage in cutter["stages"]:
        low, high, length = stage["radius_mm"], stage["upper_radius_mm"], stage["length_mm"]
        base = App.Vector(0, 0, stage["low_mm"])
        same = abs(low - high) < 1e-9
        solids.append(Part.makeCylinder(low, length, base) if same else Part.makeCone(low, high, length, base))
        parts.append(stage["part"])
    return Part.Compound(solids), parts


def _flutes(cutter: dict[str, Any]):
    """The part that cuts, revolved."""
    radius, top = cutter["radius"], cutter["flutes_mm"] or cutter["length"]
    if cutter["shape"] == "lollipop":
        return Part.makeSphere(radius, App.Vector(0, 0, radius))
    corner, taper = cutter["corner_radius"], math.radians(cutter["taper_deg"])

    def at(r: float, z: float):
        return App.Vector(r, 0, z)

    # The corner ends where the flank is a tangent of it; a straight flank at its own height.
    middle = radius - corner
    foot = at(middle + corner * math.cos(taper), corner - corner * math.sin(taper))
    end = at(foot.x + (top - foot.z) * math.tan(taper), top)
    sides: list[Any] = []
    here = at(0, 0)
    if middle > 1e-9:
        sides.append(Part.LineSegment(here, at(middle, 0)))
        here = at(middle, 0)
    if corner > 1e-9:
        # Half way between straight down and the normal of the flank.
        bend = (-math.pi / 2 - taper) / 2
        through = at(middle + corner * math.cos(bend), corner + corner * math.sin(bend))
        sides.append(Part.Arc(here, through, foot))
        here = foot
    for corner_of in (end, at(0, top), at(0, 0)):
        if (corner_of - here).Length > 1e-9:
            sides.append(Part.LineSegment(here, corner_of))
            here = corner_of
    wire = Part.Wire([each.toShape() for each in sides])
    return Part.Face(wire).revolve(App.Vector(0, 0, 0), App.Vector(0, 0, 1), 360)


def placement(tip_at, axis) -> Any:
    """Where an assembly stands with its tip at a point and +Z along a unit axis."""
    return App.Placement(App.Vector(*tip_at), App.Rotation(App.Vector(0, 0, 1), App.Vector(*axis)))
