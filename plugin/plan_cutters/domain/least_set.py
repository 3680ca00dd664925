"""The fewest runs, a cutter in a setup each, that reach all that any of them reaches."""

from dataclasses import dataclass

from plan_cutters.domain.cutter import Cutter


@dataclass(frozen=True, slots=True)
class Run:
    """A cutter in a setup, and what it takes: what no run before it reaches.

    Attributes
    ----------
    cutter : Cutter
    setup : (float, float, float)
        Its axis.
    number : int
        Of the setup, 0 for the first one.
    samples : int
    area, share : float
        mm2, and of the finished area, 0 to 1.
    faces : tuple of str
        Ids of those on which it takes samples, ascending.
    alone : int
        Samples that it reaches and no other run of the set.
    """

    cutter: Cutter
    setup: tuple[float, float, float]
    number: int
    samples: int
    area: float
    share: float
    faces: tuple[str, ...]
    alone: int


@dataclass(frozen=True, slots=True)
class LeastSet:
    """The fewest runs; of sets of as many that in fewer setups, then that of the more wanted cutters.

    Attributes
    ----------
    runs : tuple of Run
        In the order of setups, then of rank; none where nothing is reached.
    reached, left : int
        Samples of the finished surface that they reach, and that nothing given reaches for sure.
    share, left_share : float
        Of the finished area, 0 to 1.
    proven : bool
        Whether it is proved that no fewer do.
    """

    runs: tuple[Run, ...]
    reached: int
    left: int
    share: float
    left_share: float
    proven: bool
