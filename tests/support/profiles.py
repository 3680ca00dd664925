"""Solids of one profile in the plane x, z, extruded along y."""

import math

from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakePolygon
from OCP.BRepPrimAPI import BRepPrimAPI_MakePrism
from OCP.gp import gp_Pnt, gp_Vec


def extruded(corners, length=40.0):
    """The solid over a polygon of corners (x, z)."""
    polygon = BRepBuilderAPI_MakePolygon()
    for x, z in corners:
        polygon.Add(gp_Pnt(float(x), 0.0, float(z)))
    polygon.Close()
    return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(polygon.Wire()).Face(), gp_Vec(0.0, length, 0.0)).Shape()


def grooved(opening, depth=12.0):
    """A block with a V-groove of an opening angle, rad, whose bottom runs along y through (0, 0, 0)."""
    half = depth * math.tan(0.5 * opening)
    side = half + 10.0
    return extruded([(-side, -10), (side, -10), (side, depth), (half, depth), (0, 0), (-half, depth), (-side, depth)])


def slotted(bottom, top, depth=12.0):
    """A block with a slot that is so wide at its floor z = 0 and at its top: a dovetail where it is wider at the floor."""
    side, low, high = max(bottom, top), 0.5 * bottom, 0.5 * top
    return extruded(
        [(-side, -10), (side, -10), (side, depth), (high, depth), (low, 0), (-low, 0), (-high, depth), (-side, depth)]
    )
