"""All made parts, by name."""

from conformance.made import balls, cones, freeform, grooves, rods, rounds, twins
from conformance.made.part import MadePart

#: The modules of the families; a new one is added here, and lists its parts as PARTS.
FAMILIES = (grooves, balls, cones, rounds, rods, freeform)

_ANALYTIC = tuple(part for family in FAMILIES for part in family.PARTS)
PARTS: dict[str, MadePart] = {part.name: part for part in (*_ANALYTIC, *twins.twins(_ANALYTIC))}
