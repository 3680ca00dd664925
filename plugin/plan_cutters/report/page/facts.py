"""What is found for the page: the worst spots of each cutter with their samples, and the postures found as numbers."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters.document.model import WitnessEntry
from plan_cutters.domain.verdicts import Reach

#: Spots of the cutter that is shown, and of each other one.
_SPOTS, _OTHER_SPOTS = 20, 6
#: Instead of a tilt: there is none.
NO_TILT = 65535


@dataclass(frozen=True, slots=True)
class Spot:
    """A witness of the plan, and the row of its sample."""

    cutter: str
    sample: int
    witness: WitnessEntry


def spots_of(result: Any) -> tuple[list[Spot], dict[str, int]]:
    """The worst spots, those of the cutter that is shown first; and by cutter how many more the plan has."""
    found, more = [], {}
    for entry in sorted(result.plan.cutters, key=lambda c: c.id != result.shown):
        most = _SPOTS if entry.id == result.shown else _OTHER_SPOTS
        ranked = ranked_spots(entry.witnesses)
        found += [Spot(entry.id, _row(result.samples, w), w) for w in ranked[:most]]
        if len(ranked) > most:
            more[entry.id] = len(ranked) - most
    return found, more


def ranked_spots(witnesses: Sequence[WitnessEntry]) -> list[WitnessEntry]:
    """The deepest of each face and reason first, then the others; the deepest first in both."""
    seen: set[tuple[str, str]] = set()
    first: list[WitnessEntry] = []
    rest: list[WitnessEntry] = []
    for w in sorted((w for w in witnesses if not w.inside_bodies), key=lambda w: -(w.depth_mm or 0.0)):
        (rest if (w.face, w.reason) in seen else first).append(w)
        seen.add((w.face, w.reason))
    return first + rest


def _row(samples: Any, witness: WitnessEntry) -> int:
    """The sample that a witness of the plan is about."""
    mine = np.flatnonzero(samples.face == int(witness.face[1:]))
    away: Floats = np.linalg.norm(samples.point[mine] - np.array(witness.point), axis=1)
    return int(mine[int(np.nanargmin(away))])


def tilt_and_lean(samples: Any, reach: Reach) -> tuple[NDArray[np.uint16], NDArray[np.int16]]:
    """Postures found: tilts (n,), NO_TILT where there is none, and angles (n,) from `direction_max` to the lean, in hundredths of
    degrees."""
    known = np.isfinite(reach.tilt) & reach.reached
    tilt = np.where(known, np.round(100 * np.degrees(np.where(known, reach.tilt, 0.0))), NO_TILT).astype(np.uint16)
    lean, first, normal = (np.nan_to_num(a) for a in (reach.lean, samples.direction_max, samples.normal))
    angle = np.degrees(np.arctan2((lean * np.cross(normal, first)).sum(axis=1), (lean * first).sum(axis=1)))
    return tilt, np.where(known, np.round(100 * angle), 0).astype(np.int16)
