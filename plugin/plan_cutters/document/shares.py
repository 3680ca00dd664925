"""How much of a surface has each verdict: by samples, and by the area that they stand for."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from cad_io import Part, SurfaceSamples
from plan_cutters.document.frozen import Frozen
from plan_cutters.domain.verdicts import INACCESSIBLE, REASONS, UNDECIDED, WORDS, Reach


class Verdicts(Frozen):
    """How many samples have each verdict."""

    interference_free: int = 0
    accessible: int = 0
    inaccessible: int = 0
    undecided: int = 0
    unjudged: int = 0


class AreaShare(Frozen):
    """Shares of an area, 0 to 1, by the verdicts of the samples that stand for it; together they are 1."""

    interference_free: float = 0.0
    accessible: float = 0.0
    inaccessible: float = 0.0
    undecided: float = 0.0
    unjudged: float = 0.0
    lost_by: dict[str, float] = Field(
        default={}, description="of inaccessible and undecided together, by reason; reasons that there are"
    )


class FaceVerdicts(Verdicts):
    """What a cutter reaches of a face."""

    area_share: AreaShare = Field(default=AreaShare(), description="of the face's area")


def counts(verdict: NDArray[np.uint8]) -> dict[str, Any]:
    """How many samples have each verdict."""
    return {name: int((verdict == code).sum()) for code, name in WORDS.items()}


def face_verdicts(samples: SurfaceSamples, reach: Reach) -> dict[str, FaceVerdicts]:
    """What is reached of each face that has samples, by its id."""
    found = {}
    numbers, first = np.unique(np.sort(samples.face), return_index=True)
    groups = np.split(np.argsort(samples.face, kind="stable"), first[1:])
    for number, mine in zip(numbers.tolist(), groups, strict=False):
        area = samples.area[mine]
        if not area.sum() > 0.0:
            # How large the face is, is not known: each of its samples stands for as much of it.
            area = np.ones(len(mine))
        share = _share(reach.verdict[mine], reach.reason[mine], area)
        found[f"F{number}"] = FaceVerdicts(**counts(reach.verdict[mine]), area_share=share)
    return found


def whole_share(faces: Mapping[str, FaceVerdicts], samples: SurfaceSamples, part: Part) -> AreaShare:
    """What is reached of all target faces: those without samples are not judged; those of unknown area do not count.

    Where the area of none is known, every face counts as one.
    """
    targets = [*((name, each.area_share) for name, each in faces.items()),
               *((f"F{number}", AreaShare(unjudged=1.0)) for number, _ in samples.empty)]  # fmt: skip
    areas = np.array([part.faces[int(name[1:]) - 1].area for name, _ in targets])
    areas = np.where(np.isfinite(areas), np.maximum(areas, 0.0), 0.0)
    areas = areas if areas.sum() > 0.0 else np.ones(len(targets))
    weights = (areas / max(1e-300, areas.sum())).tolist()
    parts = [(weight, share) for weight, (_, share) in zip(weights, targets, strict=True)]
    sums = {word: min(1.0, sum(weight * getattr(share, word) for weight, share in parts)) for word in WORDS.values()}
    lost = {
        reason: min(1.0, sum(weight * share.lost_by.get(reason, 0.0) for weight, share in parts)) for reason in REASONS
    }
    return AreaShare(**sums, lost_by={reason: share for reason, share in lost.items() if share})


def _share(verdict: NDArray[np.uint8], reason: NDArray[np.uint8], area: NDArray[np.float64]) -> AreaShare:
    area = area / area.sum()
    shares = {name: min(1.0, float(area[verdict == code].sum())) for code, name in WORDS.items()}
    lost = (verdict == INACCESSIBLE) | (verdict == UNDECIDED)
    by = {
        name: min(1.0, float(area[lost & (reason == i)].sum()))
        for i, name in enumerate(REASONS)
        if (reason[lost] == i).any()
    }
    return AreaShare(**shares, lost_by=by)
