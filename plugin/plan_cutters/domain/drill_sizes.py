"""Names of drills in inches: fractions, numbers and letters (ASME B94.11M)."""

from fractions import Fraction

#: Diameters, 1/10,000 inch: of numbers 1 to 60, and of letters A to Z.
_NUMBERS = (
    2280, 2210, 2130, 2090, 2055, 2040, 2010, 1990, 1960, 1935, 1910, 1890, 1850, 1820, 1800, 1770, 1730, 1695, 1660, 1610, 1590,
    1570, 1540, 1520, 1495, 1470, 1440, 1405, 1360, 1285, 1200, 1160, 1130, 1110, 1100, 1065, 1040, 1015, 995, 980, 960, 935, 890,
    860, 820, 810, 785, 760, 730, 700, 670, 635, 595, 550, 520, 465, 430, 420, 410, 400,
)  # fmt: skip
_LETTERS = (
    2340, 2380, 2420, 2460, 2500, 2570, 2610, 2660, 2720, 2770, 2810, 2900, 2950, 3020, 3160, 3230, 3320, 3390, 3480, 3580, 3680,
    3770, 3860, 3970, 4040, 4130,
)  # fmt: skip
_NAMES = {**{each: f"#{k}" for k, each in enumerate(_NUMBERS, 1)}, **{each: chr(65 + k) for k, each in enumerate(_LETTERS)}}
#: A diameter is that of a name within this, inch.
_SAME = 0.0004


def inch_name(diameter: float) -> str:
    """Name a drill of a diameter, inch: by a whole number of 1/64, a number or a letter; empty where it has no name.

    >>> inch_name(0.125), inch_name(0.201), inch_name(0.257), inch_name(0.25), inch_name(0.1299)
    ('1/8', '#7', 'F', '1/4', '')
    """
    fraction, near = Fraction(round(64.0 * diameter), 64), min(_NAMES, key=lambda each: abs(1e-4 * each - diameter))
    off, other = abs(float(fraction) - diameter) if fraction else 1.0, abs(1e-4 * near - diameter)
    if off <= min(_SAME, other):
        whole, rest = divmod(fraction, 1)
        return f"{whole}-{rest}" if whole and rest else str(fraction)
    return _NAMES[near] if other <= _SAME else ""
