"""Which of several cutters is wanted first, by kind, as the faces ask for it, then by size; and which lies within which."""

import math
from collections.abc import Iterable, Mapping, Sequence

from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.shapes import SAME, flute_length, top_radius
from plan_cutters.domain.verdicts import ACCESSIBLE, INACCESSIBLE, UNJUDGED, Verdicts, blank

#: Kinds in the order in which they are wanted, those of one rank together: on free-form faces, and on planes and cylinders.
_FREE_FORM = (("ball", "bull"), ("special",), ("flat",), ("last",))
_PRISMATIC = (("flat", "bull"), ("ball",), ("special",), ("last",))
#: A sharp tip that is less than so much of its flutes' width is that of a V-shaped cutter.
_POINTED = 0.5
#: Share of the area of all targets from which on free-form faces decide; and from which on there is nearly nothing else.
FREE_FORM, NEARLY_ALL = 0.1, 0.9
#: Shapes of faces that are bent in both directions.
_BENT = ("sculptured", "sphere", "torus")


def group_of(cutter: Cutter) -> str:
    """The kind of a cutter as it is ranked: `ball`, `bull`, `flat`, `special` or `last`.

    Special are tapered cutters with a round tip, barrels, lenses and lollipops. Last come those that finish a surface only where
    nothing else does: engraving, chamfer and form cutters, V-shaped ones and dovetails.

    >>> [group_of(Cutter.parse(each)) for each in ("R6L80", "R6L80rc1", "R3L40rc3", "R1L40rc1T5", "R0.2L40T15F10", "R6L40T-10F5")]
    ['flat', 'bull', 'ball', 'special', 'last', 'last']
    """
    if cutter.shape == "form" or cutter.taper < 0.0:
        return "last"
    if cutter.shape != "end" or (cutter.taper and cutter.corner_radius):
        return "special"
    if cutter.taper:
        return "last" if cutter.radius < _POINTED * top_radius(cutter) else "flat"
    if not cutter.corner_radius:
        return "flat"
    return "ball" if cutter.corner_radius >= cutter.radius else "bull"


def ranks(*, free_form: float) -> tuple[tuple[str, ...], ...]:
    """Groups in the order in which they are wanted, those of one rank together, for a share of free-form faces."""
    return _FREE_FORM if is_free_form(free_form) else _PRISMATIC


def rank(group: str, *, free_form: float) -> int:
    """The rank of a group, 0 for the most wanted; behind all others for a group that another program wrote.

    >>> rank("ball", free_form=1.0), rank("laser", free_form=1.0)
    (0, 4)
    """
    every = ranks(free_form=free_form)
    return next((k for k, groups in enumerate(every) if group in groups), len(every))


def size(cutter: Cutter) -> tuple[float, float, float]:
    """Sort cutters by this, the largest first: by radius, then the smaller corner, then the shorter one."""
    return -cutter.radius, cutter.corner_radius, cutter.length


def wanted(cutters: Iterable[Cutter], *, free_form: float) -> list[Cutter]:
    """Cutters from the most to the least wanted: by kind, then by size, then as they were given.

    `free_form`: share of the area of the faces to machine that is free-form (`free_form_share`).

    >>> given = [Cutter.parse(each) for each in ("R8L80", "R3L40rc3", "R5L60rc1")]
    >>> [each.id for each in wanted(given, free_form=1.0)], [each.id for each in wanted(given, free_form=0.0)]
    (['R5L60rc1', 'R3L40rc3', 'R8L80'], ['R8L80', 'R5L60rc1', 'R3L40rc3'])
    """
    return sorted(cutters, key=lambda c: (rank(group_of(c), free_form=free_form), *size(c)))


def by_radius(cutters: Iterable[Cutter]) -> list[Cutter]:
    """Cutters by size, whatever their kind, but for those that come last in any case."""
    return sorted(cutters, key=lambda c: (group_of(c) == "last", *size(c)))


def free_form_share(faces: Iterable[tuple[str, float]]) -> float:
    """The share of area of free-form faces, and of spheres and tori, which are bent in both directions as well.

    `faces`: of each target face its shape, and its area, mm2; one that is not known counts as none. Returns 0 to 1. Where no area
    is known: 1 if any of the faces is free-form, else 0.

    >>> free_form_share([("plane", 30.0), ("sculptured", 10.0)]), free_form_share([])
    (0.25, 0.0)
    >>> free_form_share([("sphere", math.nan)])
    1.0
    """
    known = list(faces)
    sizes = [area if math.isfinite(area) else 0.0 for _, area in known]
    whole = math.fsum(sizes)
    if not whole > 0.0:
        return float(any(shape in _BENT for shape, _ in known))
    return math.fsum(area for (shape, _), area in zip(known, sizes, strict=True) if shape in _BENT) / whole


def is_bent(shape: str) -> bool:
    """Whether a face of this shape is bent in both directions.

    >>> is_bent("sculptured"), is_bent("cylinder")
    (True, False)
    """
    return shape in _BENT


def is_free_form(share: float) -> bool:
    """Whether free-form faces are enough of the targets to decide which kind of cutter is wanted first."""
    return share >= FREE_FORM


def order(cutters: Sequence[Cutter]) -> list[Cutter]:
    """In which order to judge cutters that are ranked: the least first, then the others from the top.

    The first hands the samples that it does not reach up to those around it, the others their postures down.
    """
    return [cutters[-1], *cutters[:-1]] if cutters else []


def inside(cutter: Cutter, other: Cutter) -> bool:
    """True if, touching the same contact with the same axis at any tilt, one cutter lies within another.

    Of straight end mills alone: Lemma N2 of `docs/proofs.md`. The disk of the one's corner lies in the other's, its corner radius
    is no larger; what stands above may be shifted against the other by as much as these differ, and what does not cut lies in
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

    Returns UNJUDGED where nothing follows; where inaccessible, the reason of the smaller cutter.
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
