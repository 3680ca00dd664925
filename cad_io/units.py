"""Length units by name. No kernel here."""

from typing import Literal, NamedTuple

from cad_io.errors import ReadError

#: mm in one of each.
UNITS = {"um": 1e-3, "mm": 1.0, "cm": 10.0, "m": 1000.0, "km": 1e6, "mil": 0.0254, "in": 25.4, "ft": 304.8}
#: Sizes that are rather a wrong unit than a part, mm.
LEAST_SIZE, MOST_SIZE = 1.0, 3000.0


def in_mm(unit: str) -> float:
    """Length of a unit, mm; ReadError where no unit is called so."""
    if not isinstance(unit, str):
        raise ReadError(f"a length unit is one of {', '.join(UNITS)}, not a {type(unit).__name__}")
    if unit not in UNITS:
        raise ReadError(f"no length unit is called {unit!r}: give one of {', '.join(UNITS)}")
    return UNITS[unit]


class UnitReading(NamedTuple):
    """A reading of a length unit that is in doubt is a record of what the file says."""

    #: `disagree`: it says two units, and the one that its flag names is taken. `scale`: its lengths are to be divided by a
    #: scale, which was done. `not_sure`: it says nothing that is known, or a part of what it says is not.
    cause: Literal["disagree", "scale", "not_sure"]
    #: What it says.
    stated: str
    #: The unit that was taken.
    taken: str
    #: The unit that chooses the other reading; empty: none does.
    unit: str = ""
    #: A length by the other reading, as a multiple of what was taken.
    times: float = 1.0

    def text(self, size: tuple[float, float, float]) -> str:
        """A warning about a part of some size, mm."""
        this, other = (" x ".join(f"{times * length:.4g}" for length in size) for times in (1.0, self.times))
        if self.cause == "scale":
            return f"its model space scale is {self.stated}: {this} mm with it, as taken here, {other} mm without it"
        if self.cause == "disagree":
            return f"its unit is in doubt ({self.stated}): {this} mm by its flag, as taken here, {other} mm by its name"
        return f"its unit is in doubt ({self.stated}): taken as {self.taken}, {this} mm"


def unit_doubt(size: tuple[float, float, float], readings: tuple[UnitReading, ...]) -> str:
    """Why the length unit of a part of some size, mm, is doubtful; empty where it is not.

    >>> unit_doubt((40.0, 40.0, 20.0), ())
    ''
    >>> unit_doubt((40.0, 40.0, 20.0), (UnitReading("not_sure", "no flag, no name", "mm"),))
    'its unit is in doubt (no flag, no name): taken as mm, 40 x 40 x 20 mm; give the right one with `--unit` (unit= in Python)'
    """
    largest, texts = max(size), [each.text(size) for each in readings]
    if not LEAST_SIZE <= largest <= MOST_SIZE:
        outside = f"the part is {largest:.4g} mm long, outside {LEAST_SIZE:g} to {MOST_SIZE:g} mm: if the length unit in the file"
        texts.append(f"{outside} is wrong, give the right one with `--unit` (unit= in Python)")
    elif texts:
        texts.append("give the right one with `--unit` (unit= in Python)")
    return "; ".join(texts)
