"""Plates with holes of which all is known, by a script: each with what must be found in it, and things that are no holes."""

import math

import cadquery as cq

#: Of a hole: diameter, depth, through, bottom, countersink (diameter, angle) and counterbore (diameter, depth).
Known = tuple[float, float, bool, str, tuple[float, float] | None, tuple[float, float] | None]


def block(x=60.0, y=40.0, z=16.0):
    """A box with its top at 0."""
    return cq.Workplane("XY").box(x, y, z).translate((0, 0, -0.5 * z)).faces(">Z").workplane(origin=(0, 0, 0))


def turned(*profile, at=(0.0, 0.0), top=0.0):
    """What a profile of (radius, height) sweeps about an axis along Z."""
    first, last = (0.0, profile[0][1]), (0.0, profile[-1][1])
    made = cq.Workplane("XZ").polyline([*(() if profile[0] == first else (first,)), *profile, last]).close()
    return made.revolve(360, (0, 0, 0), (0, 1, 0)).translate((at[0], at[1], top))


def drilled(diameter, depth, angle=118.0, at=(0.0, 0.0)):
    """What a drill takes away from the top."""
    r = 0.5 * diameter
    return turned((0.0, -depth - r / math.tan(math.radians(0.5 * angle))), (r, -depth), (r, 1.0), at=at)


def _grid(diameter):
    made = block().rarray(10, 10, 4, 2).hole(diameter)
    return made, [(diameter, 16.0, True, "open", None, None)] * 8


def _points():
    made, known = block(80), []
    for k, angle in enumerate((118.0, 120.0, 130.0, 135.0, 140.0)):
        made = made.cut(drilled(3.3, 10.0, angle, (12.0 * k - 24.0, 0.0)))
        known.append((3.3, 10.0, False, "cone", None, None))
    return made, known


def _flat():
    return block().rarray(15, 1, 3, 1).hole(6, 8), [(6.0, 8.0, False, "flat", None, None)] * 3


def _round():
    made = block().cut(cq.Workplane("XY").circle(4).extrude(8).translate((0, 0, -7))).cut(
        cq.Workplane("XY").sphere(4.0).translate((0, 0, -7)))  # fmt: skip
    return made, [(8.0, 7.0, False, "round", None, None)]


def _corner():
    tool = cq.Workplane("XY").circle(5).extrude(10).faces("<Z").edges().fillet(1.0).translate((0, 0, -8))
    return block().cut(tool), [(10.0, 7.0, False, "round", None, None)]


def _sunk():
    made = block().rarray(20, 1, 2, 1).cskHole(4.5, 9.0, 90.0)
    return made, [(4.5, 16.0, True, "open", (9.0, 90.0), None)] * 2


def _bored():
    made = block().rarray(20, 1, 2, 1).cboreHole(5.5, 10.0, 6.0)
    return made, [(5.5, 16.0, True, "open", None, (10.0, 6.0))] * 2


def _both():
    tool = turned((2.0, -17.0), (2.0, -6.0), (4.0, -6.0), (4.0, -1.0), (5.0, 0.0), (5.0, 1.0))
    return block().cut(tool), [(4.0, 16.0, True, "open", (10.0, 90.0), (8.0, 6.0))]


def _two_sides():
    tool = turned((5.0, -17.0), (5.0, -12.0), (2.5, -12.0), (2.5, -1.0), (3.5, 0.0), (4.5, 1.0))
    return block().cut(tool), [(5.0, 16.0, True, "open", (7.0, 90.0), (10.0, 4.0))]


def _step_point():
    tool = turned((0.0, -12.0), (1.5, -11.1), (1.5, -6.0), (4.0, -4.5), (4.0, 1.0))
    return block().cut(tool), [(3.0, 11.1, False, "cone", None, (8.0, 4.5))]


def _halves():
    made = block()
    for way in (1, -1):
        cut = cq.Workplane("XY").rect(60, 20).extrude(20).translate((0, 10.0 * way, -18))
        made = made.cut(cq.Workplane("XY").circle(3).extrude(20).translate((0, 0, -18)).intersect(cut), clean=False)
    return made, [(6.0, 16.0, True, "open", None, None)]


def _crossing():
    made = block(40, 40, 40)
    made = made.cut(cq.Workplane("XZ").circle(4).extrude(60, both=True).translate((0, 0, -20)))
    made = made.cut(cq.Workplane("XY").circle(2.5).extrude(60).translate((0, 0, -50)))
    return made, [(8.0, 40.0, True, "open", None, None), (5.0, 40.0, True, "open", None, None)]


def _crossing_alike():
    made = block(40, 40, 40)
    made = made.cut(cq.Workplane("XZ").circle(3).extrude(60, both=True).translate((0, 0, -20)))
    made = made.cut(cq.Workplane("XY").circle(3).extrude(60).translate((0, 0, -50)))
    return made, [(6.0, 40.0, True, "open", None, None)] * 2


def _into_another():
    made = block(40, 40, 40)
    made = made.cut(cq.Workplane("XZ").circle(6).extrude(60, both=True).translate((0, 0, -20)))
    made = made.cut(cq.Workplane("XY").circle(1.5).extrude(21).translate((0, 0, -20)))
    # Its lower end lies where the wall of the other hole is farthest away.
    return made, [(12.0, 40.0, True, "open", None, None), (3.0, 20.0 - (36.0 - 2.25) ** 0.5, True, "open", None, None)]


def _manifold():
    """A gallery D10 that goes on past ports of nearly its size from three sides, one with a counterbore."""
    made = block(80, 40, 40).cut(cq.Workplane("YZ").circle(5).extrude(60).translate((-20, 0, -20)))
    made = made.cut(cq.Workplane("XY").circle(4).extrude(-20)).cut(cq.Workplane("XY").circle(7).extrude(-6))
    made = made.cut(cq.Workplane("XZ").circle(4.25).extrude(20).translate((12, 0, -20)))
    made = made.cut(cq.Workplane("XZ").circle(3.4).extrude(-20).translate((25, 0, -20)))
    ports = {4.0: (14.0, 6.0), 4.25: None, 3.4: None}
    deep = {r: 20.0 - (25.0 - r * r) ** 0.5 for r in ports}
    return made, [(10.0, 60.0, False, "flat", None, None), *((2 * r, deep[r], True, "open", None, ports[r]) for r in ports)]


def _slanted():
    made = block()
    tool = cq.Workplane("XY").circle(2.5).extrude(60, both=True).rotate((0, 0, 0), (0, 1, 0), 30).translate((0, 0, -8))
    deep = 16.0 / math.cos(math.radians(30)) + 5.0 * math.tan(math.radians(30))
    return made.cut(tool), [(5.0, deep, True, "open", None, None)]


def _from_sides():
    made = block(60, 40, 30)
    made = made.cut(cq.Workplane("YZ").circle(2).extrude(12).translate((20, 0, -15)))
    made = made.cut(cq.Workplane("XZ").circle(3).extrude(10).translate((0, -11, -15)))
    return made, [(4.0, 10.0, False, "flat", None, None), (6.0, 9.0, False, "flat", None, None)]


def _stacked():
    one = block(60, 40, 10).circle(3).cutThruAll()
    other = one.translate((0, 0, -10))
    return cq.Workplane(cq.Compound.makeCompound([one.val(), other.val()])), [(6.0, 20.0, True, "open", None, None)]


def _groove():
    tool = turned((5.0, -17.0), (5.0, -8.0), (6.0, -8.0), (6.0, -6.5), (5.0, -6.5), (5.0, 1.0))
    return block().cut(tool), [(10.0, 16.0, True, "open", None, None)]


def _in_a_pocket():
    made = block().rect(30, 20).cutBlind(-6).faces("<Z[1]").workplane(origin=(0, 0, -6))
    made = made.cut(cq.Workplane("XY").circle(2).extrude(30).translate((0, 0, -20)))
    return made, [(4.0, 10.0, True, "open", None, None)]


def _clevis():
    made = block(60, 40, 40).cut(cq.Workplane("XY").box(60, 20, 30).translate((0, 0, -15)))
    made = made.cut(cq.Workplane("XZ").circle(4).extrude(60, both=True).translate((0, 0, -15)))
    return made, [(8.0, 10.0, True, "open", None, None)] * 2


def _broken():
    """A cavity breaks through the point of a drill."""
    made = block().cut(drilled(4.0, 8.0)).cut(cq.Workplane("XY").sphere(3.5).translate((0, 0, -12)))
    return made, [(4.0, 8.0, False, "cone", None, None)]


def _shaft():
    return cq.Workplane("YZ").circle(15).extrude(60)


def _in_a_shaft():
    """Across it, and down into it beside that: mouths on a curved face are where it is highest."""
    made = _shaft().cut(cq.Workplane("XY").circle(2.5).extrude(40).translate((15, 0, -20)))
    made = made.cut(drilled(5.0, 8.0, at=(40.0, 0.0)).translate((0, 0, 15)))
    return made, [(5.0, 30.0, True, "open", None, None), (5.0, 8.0, False, "cone", None, None)]


def _in_a_ball():
    made = cq.Workplane("XY").sphere(20).cut(cq.Workplane("XY").circle(3).extrude(60, both=True))
    return made, [(6.0, 2.0 * (400.0 - 9.0) ** 0.5, True, "open", None, None)]


def _three_ways():
    made = block(40, 40, 40)
    for plane, radius in (("XZ", 3), ("YZ", 2)):
        made = made.cut(cq.Workplane(plane).circle(radius).extrude(60, both=True).translate((0, 0, -20)))
    made = made.cut(cq.Workplane("XY").circle(3).extrude(60).translate((0, 0, -50)))
    return made, [(6.0, 40.0, True, "open", None, None)] * 2 + [(4.0, 40.0, True, "open", None, None)]


def _opposite():
    """Two blind ones on one axis that do not meet, and two of other diameters that do."""
    made = block(60, 40, 30)
    for x in (-15.0, 15.0):
        made = made.cut(drilled(5.0, 8.0, at=(x, 0.0)))
    made = made.cut(drilled(5.0, 8.0).rotate((0, 0, 0), (1, 0, 0), 180).translate((-15, 0, -30)))
    made = made.cut(cq.Workplane("XY").circle(3).extrude(-15)).cut(
        cq.Workplane("XY").circle(2).extrude(20).translate((0, 0, -30))
    )
    return made, [(5.0, 8.0, False, "cone", None, None)] * 3 + [(4.0, 30.0, True, "open", None, (6.0, 15.0))]


def _bolted():
    """Each of two bodies has its own diameter."""
    one, other = (block(60, 40, 10).rarray(20, 1, 2, 1).hole(diameter) for diameter in (5.0, 4.2))
    made = cq.Compound.makeCompound([one.val(), other.val().translate(cq.Vector(0, 0, -10))])
    return cq.Workplane(made), [(5.0, 10.0, True, "open", None, None)] * 2 + [(4.2, 10.0, True, "open", None, None)] * 2


def _halves_with_a_floor():
    made = block()
    for way in (1, -1):
        cut = cq.Workplane("XY").rect(20, 10).extrude(-20).translate((0, 5.0 * way, 0))
        made = made.cut(cq.Workplane("XY").circle(3).extrude(-8).intersect(cut), clean=False)
    return made, [(6.0, 8.0, False, "flat", None, None)]


def _broken_out():
    """At the edge of a plate, with more than half a turn of it left; and one with a keyway."""
    made = block().pushPoints([(-15, 19)]).hole(6).cut(cq.Workplane("XY").circle(4).extrude(-20))
    made = made.cut(cq.Workplane("XY").rect(4, 20).extrude(-20).translate((0, -8, 0)))
    return made, [(6.0, 16.0, True, "open", None, None), (8.0, 16.0, True, "open", None, None)]


#: By name, each with the holes that are in it.
PLATES = {
    "grid": lambda: _grid(3.3), "large": lambda: _grid(8.0), "points": _points, "flat": _flat, "round": _round, "corner": _corner,
    "sunk": _sunk, "bored": _bored, "both": _both, "two_sides": _two_sides, "step_point": _step_point, "halves": _halves,
    "crossing": _crossing, "crossing_alike": _crossing_alike, "into_another": _into_another, "slanted": _slanted,
    "from_sides": _from_sides, "stacked": _stacked, "groove": _groove, "in_a_pocket": _in_a_pocket, "clevis": _clevis,
    "broken": _broken, "in_a_shaft": _in_a_shaft, "in_a_ball": _in_a_ball, "three_ways": _three_ways, "opposite": _opposite,
    "bolted": _bolted, "halves_with_a_floor": _halves_with_a_floor, "broken_out": _broken_out, "manifold": _manifold,
}  # fmt: skip


def _slot():
    return block().slot2D(20, 6).cutThruAll()


def _mitre():
    """A pipe whose two legs end in the plane between them: no drill ends so."""
    leg = cq.Workplane("XY").circle(4).extrude(-60).translate((0, 0, 30))
    leg = leg.intersect(cq.Workplane().box(200, 200, 100).translate((0, 0, 50)).rotate((0, 0, 0), (0, 1, 0), -45))
    both = leg.union(leg.rotate((0, 0, 0), (1, 0, 1), 180))
    return block(40, 40, 40).cut(both.translate((0, 0, -20)))


def _pocket():
    return block().cut(cq.Workplane("XY").box(30, 20, 16).edges("|Z").fillet(4))


def _ring():
    return block().circle(10).circle(4).cutBlind(-5)


def _tall_boss():
    return block().circle(5).extrude(10)


def _island():
    made = block().circle(6).cutBlind(-5)
    return made.union(cq.Workplane("XY").circle(1).extrude(5).translate((3, 0, -5)))


def _slanted_floor():
    tool = cq.Workplane("XY").circle(4).extrude(12).translate((0, 0, -10))
    plane = cq.Workplane("XY").box(40, 40, 20).rotate((0, 0, 0), (0, 1, 0), 20).translate((0, 0, -17))
    return block().cut(tool.cut(plane))


def _bowl():
    return block().cut(cq.Workplane("XY").sphere(6))


def _void():
    return block().cut(cq.Workplane("XY").circle(4).extrude(6).translate((0, 0, -12)))


def _pipe(bend):
    """A bent pipe: no drill goes round its bend."""
    share = bend * (1.0 - 0.5**0.5)
    way = cq.Workplane("XZ").lineTo(0, 30).threePointArc((share, 30 + bend - share), (bend, 30 + bend)).lineTo(60, 30 + bend)
    return cq.Workplane("XY").circle(6).circle(5).sweep(way)


def _channel():
    way = cq.Workplane("XZ").moveTo(0, -50).lineTo(0, -30).threePointArc((5.858, -15.858), (20, -10)).lineTo(60, -10)
    return block(80, 60, 50).cut(cq.Workplane("XY").workplane(offset=-50).circle(5).sweep(way))


def _bow():
    ring = cq.Workplane("XY").circle(20).circle(14).extrude(-20)
    return block(80, 80, 10).cut(ring.cut(cq.Workplane("XY").rect(60, 30).extrude(-20).translate((0, -15, 0))))


#: By name: none of these has a hole.
NONE = {
    "slot": _slot, "pocket": _pocket, "ring": _ring, "boss": _tall_boss, "island": _island, "slanted_floor": _slanted_floor,
    "bowl": _bowl, "void": _void, "sphere": lambda: cq.Workplane("XY").sphere(10),
    "rod": lambda: cq.Workplane("XY").circle(5).extrude(30),
    "round_plate": lambda: cq.Workplane("XY").box(60, 40, 16).edges("|Z").fillet(6).faces(">Z").edges().fillet(1),
    "pipe": lambda: _pipe(20.0), "tight_pipe": lambda: _pipe(12.0), "channel": _channel, "mitre": _mitre, "bow": _bow,
    "torus": lambda: cq.Workplane(obj=cq.Solid.makeTorus(20, 5)), "taper": lambda: block().cut(turned((3.0, -17.0), (4.0, 1.0))),
    "half_round": lambda: block().cut(cq.Workplane("XZ").circle(5).extrude(60, both=True)),
}  # fmt: skip
