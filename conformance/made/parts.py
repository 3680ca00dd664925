"""All made parts, by name."""

from conformance.made import balls, bodies, cones, freeform, grooves, holders, machines, rods, rounds, slots, twins, walls
from conformance.made.part import MadePart

#: The modules of the families; a new one is added here, and lists its parts as PARTS.
FAMILIES = (grooves, walls, slots, holders, bodies, machines, balls, cones, rounds, rods, freeform)

_ANALYTIC = tuple(part for family in FAMILIES for part in family.PARTS)
PARTS: dict[str, MadePart] = {part.name: part for part in (*_ANALYTIC, *twins.twins(_ANALYTIC))}
