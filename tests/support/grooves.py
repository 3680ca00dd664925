"""Grooves along Y through a block, drawn by their outline across Y: walls that lean, a T, a floor that is not quite level."""

import math

LENGTH, HALF, TOP = 30.0, 30.0, 25.0


def groove(*outline):
    """A block on z = 0 with a groove; its outline (x, z) goes from its left rim at the top to the right one."""
    import cadquery as cq

    rim = [(-HALF, 0.0), (-HALF, TOP), *outline, (HALF, TOP), (HALF, 0.0)]
    return cq.Workplane("XZ").polyline(rim).close().extrude(LENGTH).val()


def leaning(degrees, height, half=10.0):
    """A groove so deep whose walls lean inward by an angle: it is wider at its floor."""
    more = height * math.tan(math.radians(degrees))
    return groove((-half, TOP), (-half - more, TOP - height), (half + more, TOP - height), (half, TOP))


def tee(half=6.0, wide=10.0, low=5.0, high=11.5):
    """A T-slot: narrow from the top down to a height, and wide between two."""
    left = [(-half, TOP), (-half, high), (-wide, high), (-wide, low)]
    return groove(*left, *((-x, z) for x, z in reversed(left)))


def off_level(degrees, half=7.0, depth=6.0):
    """A groove between upright walls, its floor off the level by an angle."""
    more = half * math.tan(math.radians(degrees))
    return groove((-half, TOP), (-half, TOP - depth - more), (half, TOP - depth + more), (half, TOP))
