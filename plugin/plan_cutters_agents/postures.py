"""A posture map as an agent reads it: shares of the postures, and a row for each rotation."""

import json
import math
from typing import Any

from plan_cutters.plan_file.reasons import INTERVALS
from plan_cutters_agents.answers import Postures, RotationRow, first

#: Digits behind the point, deg.
_DIGITS = 3


def postures_of(output: bytes, most: int) -> Postures:
    """The postures in the output of the command."""
    answer = json.loads(output)
    rows, tilt = answer["rotations"], answer["tilt_deg"]
    wide = max(1e-12, (tilt[1] - tilt[0]) * len(rows))
    forbidden = {word: sum(_width(row[word]) for row in rows) / wide for word in INTERVALS}
    gouge = sum(_below(row["local_gouge"], tilt) for row in rows) / wide
    forbidden = {word: min(1.0, share) for word, share in {"local_gouge": gouge, **forbidden}.items() if share > 0.0}
    rotations, more = first([_row(row) for row in rows], most)
    return Postures(
        point=answer["point"], face=answer["face"], off_mm=answer["off_mm"], normal=answer["normal"],
        direction_max=answer["direction_max"], certified=answer["certified"],
        free_share=min(1.0, sum(_width(row["free"]) for row in rows) / wide),
        undecided_share=min(1.0, sum(_width(row["undecided"]) for row in rows) / wide),
        forbidden=forbidden, rotations=rotations, more_rotations=more, missing=len(answer["missing"]),
        under_flat_mm=answer["under_flat_mm"], flank_axis=answer["flank_axis"],
    )  # fmt: skip


def _width(intervals: list[list[float]]) -> float:
    return sum(high - low for low, high in intervals)


def _below(least: float | None, tilt: tuple[float, float]) -> float:
    return (tilt[1] if least is None else min(max(least, tilt[0]), tilt[1])) - tilt[0]


def _row(row: dict[str, Any]) -> RotationRow:
    return RotationRow(
        deg=round(row["deg"], _DIGITS),
        free=_inward(row["free"]),
        undecided=_rounded(row["undecided"]),
        local_gouge_below=row["local_gouge"],
        forbidden={word: _rounded(row[word]) for word in INTERVALS if row[word]},
    )


def _rounded(intervals: list[list[float]]) -> list[tuple[float, float]]:
    return [(round(low, _DIGITS), round(high, _DIGITS)) for low, high in intervals]


def _inward(intervals: list[list[float]]) -> list[tuple[float, float]]:
    """Free tilts, none told wider than it is; those too narrow for the digits are left out."""
    unit = 10**_DIGITS
    ranges = [(math.ceil(low * unit) / unit, math.floor(high * unit) / unit) for low, high in intervals]
    return [(low, high) for low, high in ranges if low <= high]
