"""Cutters by their feeds: without one, no operation whose time is requested is planned with a cutter."""

from collections.abc import Mapping, Sequence

from plan_cutters.domain.answers import LeastSet
from plan_cutters.domain.cutter import Cutter
from plan_cutters.operations.plans import of_wanted_kinds
from plan_cutters.options import Options
from plan_cutters.scene.preparation import Prepared


def comparable(ready: Prepared, least: LeastSet | None) -> list[Cutter]:
    """The cutters with a feed, without kinds that come after all that are needed, if these have feeds."""
    unpriced = without_feed(ready)
    priced, needed = [each for each in ready.cutters if each not in unpriced], [run.cutter for run in least.runs] if least else []
    if not needed or any(each in unpriced for each in needed):
        return priced
    return of_wanted_kinds(priced, needed, ready.chosen.free_form)


def feeds(options: Options, cutters: Sequence[Cutter]) -> Mapping[Cutter, float] | None:
    """The feed of each cutter, mm/min; None where one has none."""
    stated = options.feeds if options.feed is None else dict.fromkeys(cutters, options.feed)
    return {each: stated[each] for each in cutters} if all(each in stated for each in cutters) else None


def without_feed(ready: Prepared) -> tuple[Cutter, ...]:
    """The cutters that no operation is planned with, for times are requested and they have no feed."""
    if ready.options.operations not in ("fastest", "both"):
        return ()
    stated = ready.options.feeds
    return tuple(each for each in ready.cutters if each not in stated)
