"""Collect facts for the page: the worst spots of each cutter with their samples, and the postures found as numbers."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plan_cutters.domain.verdicts import Verdicts
from plan_cutters.plan_file.model import WitnessEntry
from plan_cutters.plan_file.words.cutters import ranked_spots
from plan_cutters.report.protocol import Judged
from plan_cutters.report.witness import row_of

#: Spots of the cutter that is shown, and of each other one.
_SPOTS, _OTHER_SPOTS = 20, 6
#: Instead of a tilt: there is none.
NO_TILT = 65535
#: Parts of the radius of a flat in which distances from its axis are told; what is so near to the rim is on it.
SHARES, _RIM = 10000, 1e-6


@dataclass(frozen=True, slots=True)
class Spot:
    """A witness of the plan, and the row of its sample."""

    cutter: str
    sample: int
    witness: WitnessEntry


def spots_of(result: Judged) -> tuple[list[Spot], dict[str, int]]:
    """The worst spots, those of the cutter that is shown first; and by cutter how many more the plan has."""
    spots, more = [], {}
    for entry in sorted(result.plan.cutters, key=lambda c: c.id != result.shown):
        most = _SPOTS if entry.id == result.shown else _OTHER_SPOTS
        ranked = ranked_spots(entry.witnesses)
        spots += [Spot(entry.id, row_of(result.samples, w), w) for w in ranked[:most]]
        if len(ranked) > most:
            more[entry.id] = len(ranked) - most
    return spots, more


def turned_by(samples: Any, tilt_direction: Any) -> NDArray[np.int16]:
    """Angles (n,) from `direction_max` to directions (n, 3) about the normal, in hundredths of degrees; 0 where there is none."""
    known = np.isfinite(tilt_direction).all(axis=1)
    tilt_direction, first, normal = (np.nan_to_num(a) for a in (tilt_direction, samples.direction_max, samples.normal))
    angle = np.degrees(np.arctan2((tilt_direction * np.cross(normal, first)).sum(axis=1), (tilt_direction * first).sum(axis=1)))
    return np.where(known, np.round(100 * angle), 0).astype(np.int16)


def shares(tilt_direction: Any) -> NDArray[np.uint16] | None:
    """How far contacts (n,) are from the tool axis, in parts of `SHARES` of the flat's radius, from tilt directions (n, 3); None
    where all are at its rim.
    """
    length = np.linalg.norm(tilt_direction, axis=1)
    short = length < 1.0 - _RIM
    return np.where(short, np.round(SHARES * np.where(short, length, 1.0)), SHARES).astype(np.uint16) if short.any() else None


def tilt_and_direction(samples: Any, reach: Verdicts) -> tuple[NDArray[np.uint16], NDArray[np.int16]]:
    """Postures found: tilts (n,), NO_TILT where there is none, and angles (n,) from `direction_max` to the lean, in hundredths of
    degrees."""
    known = np.isfinite(reach.tilt) & reach.reached
    tilt = np.where(known, np.round(100 * np.degrees(np.where(known, reach.tilt, 0.0))), NO_TILT).astype(np.uint16)
    return tilt, np.where(known, turned_by(samples, reach.tilt_direction), 0).astype(np.int16)
