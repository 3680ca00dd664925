"""Work as it is counted, not timed: what stops by it stops at the same place on every machine, under any load."""

from dataclasses import dataclass


@dataclass(slots=True)
class Work:
    """Count the work that kernels have done.

    Attributes
    ----------
    looked : int
        Boxes of the tree, and what else takes as long: nodes of a grid, triangles, and a share of each rotation.
    """

    looked: int = 0

    def add(self, looked: int) -> None:
        """Count what a kernel has looked at."""
        self.looked += looked
