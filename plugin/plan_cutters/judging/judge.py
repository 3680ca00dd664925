"""One cutter on samples of a part that is ready: the seed's two phases, one after the other."""

from collections.abc import Callable
from dataclasses import replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.verdicts import CONVEX, FIXTURE, INSIDE, Verdicts
from plan_cutters.judging.access import access
from plan_cutters.judging.decompose import decompose
from plan_cutters.scene.conditions import Context
from plan_cutters.scene.preparation import Prepared
from plan_cutters.scene.threads import with_company
from plan_cutters.scene.work import Work


class Judge(Protocol):
    """`judge` at all samples, and whatever gives the same verdicts in another way."""

    def __call__(
        self, ready: Prepared, cutter: Cutter, *, known: Verdicts | None = None,
        progress: Callable[[int, int], None] | None = None, work: Work | None = None,
    ) -> Verdicts: ...  # fmt: skip


def judge(
    ready: Prepared,
    cutter: Cutter,
    rows: NDArray[np.int64] | None = None,
    known: Verdicts | None = None,
    *,
    progress: Callable[[int, int], None] | None = None,
    work: Work | None = None,
) -> Verdicts:
    """Find the verdicts of a cutter on some samples, or on all; nothing else is looked at or changed.

    Parameters
    ----------
    ready : Prepared
    cutter : Cutter
    rows : (m,) int64, optional
        Samples, ascending. However they are divided, each gets the same answer, bit for bit: the search of its neighbours is
        repeated.
    known : Verdicts, optional
        Verdicts that follow from other cutters (`nesting.handed`), for all samples.
    progress : callable, optional
        Called with the number of pieces of work that are done, and the number of all.
    work : Work, optional
        Counter of the work done.

    Returns
    -------
    Verdicts
        Of the m samples.
    """
    samples, context = ready.samples, Context.of(cutter, ready.conditions)
    whole = None if rows is None else with_company(rows, len(samples))
    free = decompose(samples, ready.surface_class == CONVEX, context, inside=ready.shut, rows=whole, work=work)
    verdicts = access(samples, free, context, inside=ready.shut, known=known, rows=whole, progress=progress, work=work)
    # What is clamped is lost to what holds it, if nothing was found that loses it all the same.
    held = ready.clamped & (ready.inside < 0) & (verdicts.reason == INSIDE)
    if held.any():
        verdicts = replace(verdicts, reason=np.where(held, FIXTURE, verdicts.reason).astype(np.uint8))
    return verdicts if rows is None else verdicts.of(rows)
