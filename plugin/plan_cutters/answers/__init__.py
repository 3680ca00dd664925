"""What a planner asks next: how short a cutter may stand out, how large one may be where, what would make it feasible."""
