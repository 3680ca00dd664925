"""The cluster of a batch, lent to its large parts: other workers judge samples of them, so that nobody waits for one part."""

import contextlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plan_cutters.batch import cluster
from plan_cutters.batch.distributed_judge import LARGE, DistributedJudge
from plan_cutters.batch.job_input import Offer
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.verdicts import Verdicts
from plan_cutters.errors import PlanError
from plan_cutters.files.lock import Lock
from plan_cutters.scene.preparation import Prepared
from plan_cutters.scene.work import Work
from plan_cutters.stages.judge import judge


class SharedCluster:
    """Judge as `stages.judge.judge` does; large parts by the workers of the batch, as soon as there is one to judge.

    Parameters
    ----------
    offer : Offer
    large : int
        Samples from which on the offer is taken.
    """

    def __init__(self, offer: Offer, large: int = LARGE) -> None:
        self._offer, self._large = offer, large
        self._rows: DistributedJudge | None = None
        self._open = contextlib.ExitStack()
        self._asked = False

    def __call__(
        self,
        ready: Prepared,
        cutter: Cutter,
        rows: NDArray[np.int64] | None = None,
        known: Verdicts | None = None,
        *,
        progress: Callable[[int, int], None] | None = None,
        work: Work | None = None,
    ) -> Verdicts:
        """Find the verdicts of a cutter; parameters and result as of `judge`."""
        if rows is None and len(ready.samples) >= self._large and not self._asked:
            self._asked = True
            self._take()
        if self._rows is not None:
            try:
                return self._rows(ready, cutter, rows, known, progress=progress, work=work)
            except PlanError:
                self.close()
        return judge(ready, cutter, rows, known, progress=progress, work=work)

    def _take(self) -> None:
        """Take the offer; where another part has it, or the cluster cannot be reached or is lost, this process judges."""
        with contextlib.suppress(PlanError, OSError), contextlib.ExitStack() as stack:
            stack.callback(Lock(Path(self._offer.turn)).release)
            client: Any = stack.enter_context(cluster.opened(self._offer.scheduler))
            Path(self._offer.said).touch()
            self._rows = DistributedJudge(client, large=self._large)
            self._open = stack.pop_all()

    def close(self) -> None:
        """Give the cluster back."""
        self._rows = None
        self._open.close()
