"""What a cutter need not search, because of cutters that it lies within or that lie within it."""

from collections.abc import Mapping, Sequence

from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.verdicts import ACCESSIBLE, INACCESSIBLE, UNJUDGED, Reach, blank


def order(cutters: Sequence[Cutter]) -> list[Cutter]:
    """In which order to judge cutters that are ranked: the least first, then the others from the top.

    The first hands the samples that it does not reach up to those around it, the others their postures down.
    """
    return [cutters[-1], *cutters[:-1]] if cutters else []


def handed(cutter: Cutter, judged: Mapping[Cutter, Reach], n: int) -> Reach:
    """What follows for a cutter from those already judged: postures, and samples that it cannot reach either.

    A posture that is safe for a cutter is so for every cutter inside it: what reaches into the smaller body reaches at
    least as deep into the larger one, and local gouging asks for less tilt. So a sample at which the smaller one is
    blocked at every posture is lost to the larger one too.

    Returns
    -------
    Reach
        UNJUDGED where nothing follows; where inaccessible, the reason of the smaller cutter.
    """
    known = blank(n)
    for other, reach in judged.items():
        if cutter.inside(other):
            rows = reach.reached & (known.verdict == UNJUDGED)
            known.verdict[rows] = ACCESSIBLE
            for name in ("axis", "lean", "tilt", "rotation"):
                getattr(known, name)[rows] = getattr(reach, name)[rows]
        elif other.inside(cutter):
            rows = (reach.verdict == INACCESSIBLE) & (known.verdict == UNJUDGED)
            known.verdict[rows], known.reason[rows] = INACCESSIBLE, reach.reason[rows]
    return known
