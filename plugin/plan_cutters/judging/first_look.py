"""A first look at a few hundred samples says about what each cutter reaches, long before all of them are judged."""

from dataclasses import dataclass

import numpy as np

from cad_io.arrays import Floats
from plan_cutters.domain.cutter import Cutter
from plan_cutters.judging.judge import judge
from plan_cutters.scene.copied import some_of
from plan_cutters.scene.preparation import Prepared

#: Samples that are looked at, fewer with many cutters, at least so many; where all cutters at all samples are fewer pairs than
#: the last, their verdicts come as soon.
_MOST, _PAIRS, _LEAST, _WORTH = 400, 4_000, 100, 40_000


@dataclass(frozen=True)
class FirstLook:
    """A first look has the share of area that each cutter reaches at some samples, and that they reach together.

    Attributes
    ----------
    setup : (3,) float64
        The setup axis.
    samples, of : int
        How many were looked at, of how many.
    shares : tuple of (Cutter, float)
        In the order of the request.
    together : float
    """

    setup: Floats
    samples: int
    of: int
    shares: tuple[tuple[Cutter, float], ...]
    together: float


def first_look(ready: Prepared) -> FirstLook | None:
    """Judge all cutters at some samples of the first setup; None where all samples are hardly more work.

    Parameters
    ----------
    ready : Prepared

    Returns
    -------
    FirstLook or None
        Its verdicts are those of the plan in this setup, but for what is nothing beside the whole: copies, and cutters that
        others decide.
    """
    every = np.flatnonzero(ready.finished)
    if len(every) * len(ready.cutters) < _WORTH:
        return None
    few = min(_MOST, max(_LEAST, _PAIRS // len(ready.cutters)), len(every))
    rows = every[np.linspace(0, len(every) - 1, few).astype(np.int64)]
    some = some_of(ready, rows)
    reached = [judge(some, cutter).reached for cutter in ready.cutters]
    area = np.nan_to_num(some.samples.area)
    shares = np.array([*reached, np.any(reached, axis=0)]) @ area / max(1e-300, float(area.sum()))
    alone = tuple(zip(ready.cutters, shares[:-1].tolist(), strict=True))
    return FirstLook(np.array(ready.scene.setup), len(rows), len(every), alone, float(shares[-1]))
