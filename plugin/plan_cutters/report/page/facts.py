"""What is counted for the page: areas by verdict, the worst faces and spots of each cutter."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters.domain.verdicts import (
    ACCESSIBLE,
    INACCESSIBLE,
    INTERFERENCE_FREE,
    NO_REASON,
    REASONS,
    UNDECIDED,
    UNJUDGED,
    Reach,
)

#: Verdicts by their codes, from best to worst.
WORDS = {
    INTERFERENCE_FREE: "interference_free",
    ACCESSIBLE: "accessible",
    UNDECIDED: "undecided",
    INACCESSIBLE: "inaccessible",
    UNJUDGED: "unjudged",
}
#: Faces that are named for each cutter; spots of the cutter that is shown, and of each other one.
_WORST_FACES, _SPOTS, _OTHER_SPOTS = 5, 20, 8


@dataclass(frozen=True, slots=True)
class WorstFace:
    """A face on which a cutter loses samples: how much of it, mm2 and share, why most of it, and the deepest witness there."""

    id: str
    name: str
    area: float
    share: float
    reason: str
    depth: float | None
    obstacle: str | None


@dataclass(frozen=True, slots=True)
class Spot:
    """A witness of the plan, and the row of its sample."""

    cutter: str
    sample: int
    witness: Any


def shares(result: Any, reach: Reach) -> dict[str, float]:
    """Share of the target faces' area by verdict; exactly 1 or 0 where all of it or none has that verdict."""
    area = result.samples.area
    by = np.bincount(reach.verdict, weights=area, minlength=256)
    missing = unsampled(result)
    whole = float(area.sum()) + missing
    found = {word: float(by[code]) for code, word in WORDS.items()}
    found["unjudged"] += missing
    held = [word for word, each in found.items() if each > 0.0]
    if len(held) == 1:
        return {word: float(word == held[0]) for word in found}
    return {word: each / whole if whole else 0.0 for word, each in found.items()}


def unsampled(result: Any) -> float:
    """Area of target faces without any sample, mm2."""
    return float(sum(f.area_mm2 for f in result.plan.faces if f.target and not f.samples))


def reached_of(result: Any, reach: Reach) -> dict[int, tuple[float, float]]:
    """By face number the shares of its area that are reached, and lost (inaccessible or undecided)."""
    samples = result.samples
    most = int(samples.face.max(initial=0)) + 1
    whole, reached, lost = (
        np.bincount(samples.face, weights=samples.area * chosen, minlength=most)
        for chosen in (np.ones(len(samples)), reach.reached, reach.lost)
    )
    counted = [np.bincount(samples.face[chosen], minlength=most) for chosen in (reach.reached, reach.lost)]
    each = np.bincount(samples.face, minlength=most)
    found = {}
    for number in np.flatnonzero(each).tolist():
        pair = []
        for area, count in zip((reached, lost), counted, strict=True):
            exact = 0.0 if not count[number] else 1.0 if count[number] == each[number] else None
            share = area[number] / whole[number] if whole[number] > 0 else count[number] / each[number]
            pair.append(float(share) if exact is None else exact)
        found[number] = (pair[0], pair[1])
    return found


def worst_faces(result: Any, entry: Any, most: int = _WORST_FACES) -> list[WorstFace]:
    """Faces with the largest lost area first."""
    samples, reach = result.samples, result.reaches[entry.id]
    faces = {int(f.id[1:]): f for f in result.plan.faces}
    lost = np.bincount(samples.face, weights=samples.area * reach.lost)
    each = reached_of(result, reach)
    found = []
    order = sorted((n for n, (_, share) in each.items() if share > 0.0), key=lambda n: (-lost[n], n))
    for number in order[:most]:
        mine = (samples.face == number) & reach.lost
        reasons = np.bincount(reach.reason[mine], weights=samples.area[mine], minlength=256)
        main = int(reasons.argmax()) if reasons.any() else int(reach.reason[mine][0])
        deepest = max(
            (w for w in entry.witnesses if w.face == f"F{number}"), key=lambda w: w.depth_mm or 0.0, default=None
        )
        found.append(WorstFace(
            f"F{number}", faces[number].name, float(lost[number]), each[number][1],
            REASONS[main] if main != NO_REASON else "", deepest and deepest.depth_mm, deepest and deepest.obstacle_face,
        ))  # fmt: skip
    return found


def main_reason(result: Any, reach: Reach) -> str:
    """The reason for which a cutter loses the most area; empty where it loses none."""
    lost = reach.lost
    if not lost.any():
        return ""
    area = np.bincount(reach.reason[lost], weights=result.samples.area[lost], minlength=256)
    code = int(area.argmax()) if area.any() else int(reach.reason[lost][0])
    return REASONS[code] if code != NO_REASON else ""


def spots_of(result: Any) -> tuple[list[Spot], dict[str, int]]:
    """The worst spots, those of the cutter that is shown first; and by cutter how many more the plan has."""
    found, more = [], {}
    entries = sorted(result.plan.cutters, key=lambda c: c.id != result.shown)
    for entry in entries:
        most = _SPOTS if entry.id == result.shown else _OTHER_SPOTS
        ranked = _ranked(entry.witnesses)
        found += [Spot(entry.id, _row(result.samples, w), w) for w in ranked[:most]]
        if len(ranked) > most:
            more[entry.id] = len(ranked) - most
    return found, more


def _ranked(witnesses: Sequence[Any]) -> list[Any]:
    """The deepest of each face and reason first, then the others; the deepest first in both."""
    deepest = sorted(enumerate(witnesses), key=lambda x: (-(x[1].depth_mm or 0.0), x[0]))
    seen: set[tuple[str, str]] = set()
    first, rest = [], []
    for _, w in deepest:
        (rest if (w.face, w.reason) in seen else first).append(w)
        seen.add((w.face, w.reason))
    return first + rest


def _row(samples: Any, witness: Any) -> int:
    """The sample that a witness of the plan is about."""
    mine = np.flatnonzero(samples.face == int(witness.face[1:]))
    away: Floats = np.linalg.norm(samples.point[mine] - np.array(witness.point), axis=1)
    return int(mine[int(np.nanargmin(away))])


def tilt_and_lean(samples: Any, reach: Reach) -> tuple[NDArray[np.uint16], NDArray[np.int16]]:
    """Postures found: tilt, 65535 where there is none, and the angle from `direction_max` to the lean, hundredths of degrees."""
    known = np.isfinite(reach.tilt) & reach.reached
    tilt = np.where(known, np.round(100 * np.degrees(np.where(known, reach.tilt, 0.0))), 65535).astype(np.uint16)
    lean, first, normal = (np.nan_to_num(a) for a in (reach.lean, samples.direction_max, samples.normal))
    angle = np.degrees(np.arctan2((lean * np.cross(normal, first)).sum(axis=1), (lean * first).sum(axis=1)))
    return tilt, np.where(known, np.round(100 * angle), 0).astype(np.int16)
