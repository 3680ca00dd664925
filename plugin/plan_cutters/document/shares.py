"""Verdicts of samples are summed up here into counts and shares of area."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io import Part, SurfaceSamples
from plan_cutters.domain.area import weights
from plan_cutters.domain.verdicts import INACCESSIBLE, REASONS, UNDECIDED, WORDS, Verdicts
from plan_cutters.plan_file.shares import AreaShare, FaceVerdicts


def counts(
    verdict: NDArray[np.uint8], inside: NDArray[np.bool_] | None = None, exempt: NDArray[np.bool_] | None = None
) -> dict[str, Any]:
    """How many samples have each verdict; `inside`, `exempt` (n,): those inside other bodies of the part, and not required."""
    of = {name: int((verdict == code).sum()) for code, name in WORDS.items()}
    return {
        **of,
        "inside_bodies": 0 if inside is None else int(inside.sum()),
        "exempt": 0 if exempt is None else int(exempt.sum()),
    }


def face_verdicts(
    samples: SurfaceSamples, reach: Verdicts, inside: NDArray[np.bool_] | None = None, exempt: NDArray[np.bool_] | None = None
) -> dict[str, FaceVerdicts]:
    """Sum up the verdicts on each face that has samples, by its id; `inside` and `exempt` as in `counts`."""
    nowhere = np.zeros(len(samples.face), bool)
    inside, exempt = nowhere if inside is None else inside, nowhere if exempt is None else exempt
    entries = {}
    for number, mine in samples.by_face().items():
        area = weights(samples.area[mine])
        within, free = inside[mine], exempt[mine]
        required = ~within & ~free
        seen = mine[required]
        share = _share(reach.verdict[seen], reach.reason[seen], area[required])
        part = min(1.0, float(area[within].sum() / area.sum())) if not within.all() else 1.0
        edges = min(1.0 - part, float(area[free].sum() / area.sum())) if len(seen) else 1.0 - part
        entries[f"F{number}"] = FaceVerdicts(
            **counts(reach.verdict[mine], within, free), area_share=share, inside_share=part, exempt_share=edges
        )
    return entries


def covered(faces: Mapping[str, FaceVerdicts], samples: SurfaceSamples, part: Part) -> tuple[float, float]:
    """Area of the target faces that lies inside other bodies of the part, mm2, and its share of all of it."""
    areas = _areas([*faces, *(f"F{number}" for number, _ in samples.empty)], part)
    area = float(sum(areas[name] * each.inside_share for name, each in faces.items()))
    return area, min(1.0, area / max(1e-300, sum(areas.values())))


def whole_share(faces: Mapping[str, FaceVerdicts], samples: SurfaceSamples, part: Part) -> AreaShare:
    """Give the shares of the verdicts in the finished part's surface of all target faces.

    Faces without samples are not judged; those of unknown area do not count. Where the area of none is known, every face counts
    as one.
    """
    targets = [
        *((name, each.area_share, 1.0 - each.inside_share - each.exempt_share) for name, each in faces.items()),
        *((f"F{number}", AreaShare(unjudged=1.0), 1.0) for number, _ in samples.empty),
    ]
    areas = _areas([name for name, _, _ in targets], part)
    seen = np.array([areas[name] * finished for name, _, finished in targets])
    weights = (seen / max(1e-300, seen.sum())).tolist()
    parts = [(weight, share) for weight, (_, share, _) in zip(weights, targets, strict=True)]
    sums = {word: min(1.0, sum(weight * getattr(share, word) for weight, share in parts)) for word in WORDS.values()}
    not_reached = {
        reason: min(1.0, sum(weight * share.lost_by.get(reason, 0.0) for weight, share in parts)) for reason in REASONS
    }
    return AreaShare(**sums, lost_by={reason: share for reason, share in not_reached.items() if share})


def sample_areas(faces: Mapping[str, FaceVerdicts], samples: SurfaceSamples, part: Part) -> tuple[NDArray[np.float64], float]:
    """Give the area that each sample (n,) stands for, and that of faces without samples, mm2, weighed as in `whole_share`."""
    areas = _areas([*faces, *(f"F{number}" for number, _ in samples.empty)], part)
    result = np.zeros(len(samples))
    for number, mine in samples.by_face().items():
        weight = weights(samples.area[mine])
        result[mine] = areas[f"F{number}"] * weight / weight.sum()
    return result, float(sum(areas[f"F{number}"] for number, _ in samples.empty))


def _areas(names: Sequence[str], part: Part) -> dict[str, float]:
    """Areas of faces by their ids, mm2; 1 each where none is known."""
    areas = weights(np.array([part.faces[int(name[1:]) - 1].area for name in names]))
    return dict(zip(names, areas.tolist(), strict=True))


def _share(verdict: NDArray[np.uint8], reason: NDArray[np.uint8], area: NDArray[np.float64]) -> AreaShare:
    if not len(area):
        return AreaShare()
    area = weights(area)
    area = area / area.sum()
    shares = {name: min(1.0, float(area[verdict == code].sum())) for code, name in WORDS.items()}
    not_reached = (verdict == INACCESSIBLE) | (verdict == UNDECIDED)
    by = {
        name: min(1.0, float(area[not_reached & (reason == i)].sum()))
        for i, name in enumerate(REASONS)
        if (reason[not_reached] == i).any()
    }
    return AreaShare(**shares, lost_by=by)
