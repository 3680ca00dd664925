"""All made parts, by name."""

from conformance.made import bodies, grooves, holders, machines, slots, walls
from conformance.made.part import MadePart

#: The modules of the families; a new one is added here, and lists its parts as PARTS.
FAMILIES = (grooves, walls, slots, holders, bodies, machines)

PARTS: dict[str, MadePart] = {part.name: part for family in FAMILIES for part in family.PARTS}
