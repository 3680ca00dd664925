"""Length units by name. No kernel here."""

from cad_io.errors import ReadError

#: mm in one of each.
UNITS = {"um": 1e-3, "mm": 1.0, "cm": 10.0, "m": 1000.0, "km": 1e6, "mil": 0.0254, "in": 25.4, "ft": 304.8}


def in_mm(unit: str) -> float:
    """Length of a unit, mm.

    Raises
    ------
    ReadError
        No unit is called so.
    """
    if not isinstance(unit, str):
        raise ReadError(f"a length unit is one of {', '.join(UNITS)}, not a {type(unit).__name__}")
    if unit not in UNITS:
        raise ReadError(f"no length unit is called {unit!r}: give one of {', '.join(UNITS)}")
    return UNITS[unit]
