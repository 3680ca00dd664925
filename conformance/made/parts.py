"""All made parts, by name."""

from conformance.made import balls, cones, freeform, grooves, rounds
from conformance.made.part import MadePart

#: The modules of the families; a new one is added here, and lists its parts as PARTS.
FAMILIES = (grooves, balls, cones, rounds, freeform)

PARTS: dict[str, MadePart] = {part.name: part for family in FAMILIES for part in family.PARTS}
