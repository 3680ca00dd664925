"""Columns, codes and thresholds that the compiled kernels and the rest of the program share. It imports nothing.

It stands beside the kernels, for the compiler freezes these numbers: a change of one compiles all kernels again.
"""

#: Verdicts of a sample.
INACCESSIBLE, ACCESSIBLE, INTERFERENCE_FREE, UNDECIDED, UNJUDGED = 0, 1, 2, 3, 255

#: Why no posture is left, in the order in which the attributes are applied; `Verdicts.reason` is an index into it.
#: `buried`: under or within a body; `tolerance`: that is too coarse for the cutter, which is undecided everywhere then;
#: `fixture`: without the fixtures the sample would be reached; `sharp_edge`: the fillet beside a sharp inside edge. Kernels
#: write none of these three.
REASONS = (
    "axis_limit", "local_gouge", "rear_gouge", "collision", "buried", "tolerance", "neck", "shank", "holder", "fixture",
    "sharp_edge",
)  # fmt: skip
(
    AXIS_LIMIT, LOCAL_GOUGE, REAR_GOUGE, COLLISION, INSIDE, TOLERANCE, BY_NECK, BY_SHANK, BY_HOLDER, FIXTURE, SHARP_EDGE,
) = range(11)  # fmt: skip
NO_REASON = 255

#: Kinds of a piece: below `radius + slope (w - low)` for the first two; the third has a cross section of an arc: what is
#: nearer than `round` to the disk of radius `radius` (negative: to all of the circle on its far side) at the height `centre`.
CYLINDER, CONE, ARC = 0.0, 1.0, 2.0
#: Columns of a piece: its kind, its heights, and for an arc, in place of slope: the height of its centre. Then the numbers made
#: of these: 1 / sqrt(1 + slope^2); its lowest and highest point; its radius at the upper height (arcs: the largest); its part.
KIND, LOW, HIGH, RADIUS, SLOPE, ROUND, SCALE, BOTTOM, TOP, WIDE, PART, COLUMNS = range(12)
#: Columns of a node's box: centre, three unit sides (the last along the mean normal), three half sides, half diagonal.
CENTRE, SIDES, HALVES, DIAGONAL, BOX = 0, 3, 12, 15, 16
#: Parts of an assembly.
FLUTES, NECK, SHANK, HOLDER = 0, 1, 2, 3
#: Columns of the modes in which a tool touches: offset of the centre of curvature from the axis, radius of curvature, the tilts
#: from and to, rad, and the centre's height over the tip.
OFFSET_OF, RISE, TILT_FROM, TILT_TO, OVER_TIP = 0, 1, 2, 3, 4

#: Directions this close to each other, rad, are one; axes that are as near to being parallel turn a tool like one alone.
PARALLEL = 1e-6
#: Distance of a point from the contact and radius of a ball about it that tell whether the contact lies in a body, in depths
#: beyond which a posture is surely blocked: the ball is to be free of the skin that the contact lies on, and its radius more than
#: sqrt(2).
AWAY, BALL = 2.0, 1.5
#: Surfaces that are farther off the tilt of a flank are never along it, rad.
BEYOND = 0.1
#: Angles this close to a limit are on it, rad.
ON_LIMIT = 1e-9

#: Outlook of a contact whose posture serves its patch in no halving.
NEVER = 255
