"""Verdicts that the cache of this user holds are not searched for again: the same question has the same answer, bit for bit."""

from collections.abc import Callable
from dataclasses import replace

from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.verdicts import Verdicts
from plan_cutters.judging.judge import judge
from plan_cutters.scene.ground import GroundDigests
from plan_cutters.scene.preparation import Prepared
from plan_cutters.scene.work import Work


class CachedJudge:
    """Judge as `judge` does, but for what a part's cache holds.

    An entry belongs to the ground, the cutter, and what was known of its samples from other cutters.
    """

    def __init__(self) -> None:
        self._grounds = GroundDigests()

    def __call__(
        self, ready: Prepared, cutter: Cutter, *, known: Verdicts | None = None,
        progress: Callable[[int, int], None] | None = None, work: Work | None = None,
    ) -> Verdicts:  # fmt: skip
        """Find the verdicts of a cutter; parameters and result as of `judge`. The work is that of the run that judged."""

        def searched() -> tuple[Verdicts, int]:
            counted = Work()
            return judge(ready, cutter, known=known, progress=progress, work=counted), counted.looked

        follows_from = (self._grounds.of(ready), replace(cutter, name=""), known)
        verdicts, looked = ready.cache.cached("verdicts", follows_from, searched)
        if work is not None:
            work.add(looked)
        return verdicts
