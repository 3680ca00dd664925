"""Save a cutter a part of its search, because it lies within cutters that were judged, or they lie within it."""

from collections.abc import Mapping, Sequence

from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.shapes import SAME, flute_length
from plan_cutters.domain.verdicts import ACCESSIBLE, INACCESSIBLE, UNJUDGED, Verdicts, blank


def order(cutters: Sequence[Cutter]) -> list[Cutter]:
    """In which order to judge cutters that are ranked: the least first, then the others from the top.

    The first hands the samples that it does not reach up to those around it, the others their postures down.
    """
    return [cutters[-1], *cutters[:-1]] if cutters else []


def inside(cutter: Cutter, other: Cutter) -> bool:
    """True if, touching the same contact with the same axis at any tilt, one cutter lies within another.

    Of straight end mills alone: Lemma N2 of `docs/nested_cutters_proof.md`.
    The disk of the one's corner lies in the other's, its corner radius is
    no larger; what stands above may be shifted against the other by as much as these differ, and what does not cut lies in
    what does not cut either and has no less clearance.
    """
    if any(each.shape != "end" or each.taper for each in (cutter, other)) or cutter.allowance != other.allowance:
        return False
    taller = other.corner_radius - cutter.corner_radius
    excess = other.radius - cutter.radius
    if taller < 0.0 or excess < taller:
        return False
    bands = _bands(other)
    looser = (cutter.clearance or 0.0) > (other.clearance or 0.0)
    for cuts, low, high, _, most in _bands(cutter):
        met = low
        for their_cuts, their_low, their_high, least, _ in bands:
            if their_high <= low or their_low >= high + taller:
                continue
            if their_low > met + SAME or most + excess > least + SAME or (not cuts and (their_cuts or looser)):
                return False
            met = their_high
        if met < high + taller - SAME:
            return False
    return True


def _bands(cutter: Cutter) -> list[tuple[bool, float, float, float, float]]:
    """From the tip up: whether it cuts, from which height to which, its least and largest radius, mm."""
    bands = [(True, 0.0, flute_length(cutter), cutter.radius, cutter.radius)]
    for _, low, stage in cutter.stages:
        ends = stage.radius, stage.upper_radius
        bands.append((False, low, low + stage.length, min(ends), max(ends)))
    return bands


def handed(cutter: Cutter, judged: Mapping[Cutter, Verdicts], n: int) -> Verdicts:
    """Infer verdicts on a cutter from cutters already judged: known postures, and samples that it cannot reach either.

    A posture that is safe for a cutter is safe for every cutter inside it: an obstacle that reaches into the smaller body reaches
    at least as deep into the larger one. So a sample at which the smaller one is blocked at every posture is inaccessible to the
    larger one too.

    Returns
    -------
    Verdicts
        UNJUDGED where nothing follows; where inaccessible, the reason of the smaller cutter.
    """
    known = blank(n)
    for other, verdicts in judged.items():
        if inside(cutter, other):
            rows = verdicts.reached & (known.verdict == UNJUDGED)
            known.verdict[rows] = ACCESSIBLE
            known.take_posture(rows, verdicts)
        elif inside(other, cutter):
            rows = (verdicts.verdict == INACCESSIBLE) & (known.verdict == UNJUDGED)
            known.verdict[rows], known.reason[rows] = INACCESSIBLE, verdicts.reason[rows]
    return known.freeze()
