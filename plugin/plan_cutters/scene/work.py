"""Work as it is counted, not timed: what stops by it stops at the same place on every machine, under any load."""

import threading
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


class Meter:
    """Counts the boxes that all kernels of this process have looked at, whoever called them: stages are told apart by it."""

    def __init__(self) -> None:
        self._lock, self._boxes = threading.Lock(), 0

    def add(self, looked: int) -> None:
        """Count what a kernel has looked at."""
        with self._lock:
            self._boxes += looked

    @property
    def boxes(self) -> int:
        """So many so far."""
        return self._boxes


#: That of this process.
METER = Meter()


class Budget:
    """So much work from now on, of this process.

    Parameters
    ----------
    most : float
        Boxes.
    """

    def __init__(self, most: float) -> None:
        self._most, self._begun = most, METER.boxes

    @property
    def left(self) -> float:
        """Boxes that may still be looked at, 0 where it is spent."""
        return max(0.0, self._most - (METER.boxes - self._begun))
