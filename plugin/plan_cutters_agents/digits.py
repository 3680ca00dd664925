"""Numbers of an answer, in four significant digits: more of them cost an agent's memory, and say nothing.

Angles and axes that an agent hands back, and tilts that are free, stay as they are: rounded, they might not be safe.
"""

import math
from typing import Any

_DIGITS = 4
#: Of places, behind the point, mm.
_PLACE = 4
#: Fields that stay as they are, also below.
_EXACT = frozenset({"axis", "angles", "free", "tilt_deg"})
#: Fields that stay as they are where they are lists: as numbers they are shares.
_RANGES = frozenset({"undecided", "forbidden"})
_PLACES = frozenset({"point", "obstacle_point", "place_mm", "normal", "direction_max", "under_flat_mm"})
#: What is never told larger than it is.
_DOWN = frozenset({"clearance_mm"})


def short(value: Any, name: str = "") -> Any:
    """The value with short numbers.

    A share below 1 stays below 1, and one above 0 above 0.

    Examples
    --------
    >>> short({"reached": 0.99999, "lost": 1e-9, "area_mm2": 12345.678, "depth_mm": 0.7808438})
    {'reached': 0.9999, 'lost': 1e-09, 'area_mm2': 12350.0, 'depth_mm': 0.7808}
    >>> short({"clearance_mm": 0.19999, "angles": {"A": 63.43494882}, "point": [1.00000049, 0.0, -2.5]})
    {'clearance_mm': 0.1999, 'angles': {'A': 63.43494882}, 'point': [1.0, 0.0, -2.5]}
    """
    if name in _EXACT:
        return value
    if isinstance(value, dict):
        ranges = name in _RANGES and any(isinstance(each, list) for each in value.values())
        return value if ranges else {key: short(each, key) for key, each in value.items()}
    if isinstance(value, list):
        if name in _RANGES:
            return value
        return [short(each, name) for each in value]
    return _number(value, name) if isinstance(value, float) and math.isfinite(value) else value


def _number(value: float, name: str) -> float:
    if name in _PLACES:
        return round(value, _PLACE) + 0.0
    made = float(f"{value:.{_DIGITS}g}")
    if abs(made) > abs(value) and (name in _DOWN or abs(value) < 1.0 <= abs(made)):
        step = 10.0 ** (math.floor(math.log10(abs(value))) + 1 - _DIGITS)
        made = float(f"{math.copysign(math.floor(abs(value) / step) * step, value):.{_DIGITS}g}")
    return made
