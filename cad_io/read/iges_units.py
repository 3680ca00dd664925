"""Which unit an IGES file's lengths are in: its global section states it twice, and a scale besides."""

import re
from collections.abc import Sequence
from typing import NamedTuple

from cad_io.units import UNITS, UnitReading

#: Units by the standard's numbers, and the lengths of all of them, mm; in capitals they have the standard's names.
FLAGS = {1: "in", 2: "mm", 4: "ft", 5: "mi", 6: "m", 7: "km", 8: "mil", 9: "um", 10: "cm", 11: "uin"}
_LENGTHS = UNITS | {"mi": 1609344.0, "uin": 2.54e-5}
#: Other names for them that programs write.
_NAMES = {
    "INCH": "in", "INCHES": "in", "MILLIMETER": "mm", "MILLIMETERS": "mm", "MILLIMETRE": "mm", "MILLIMETRES": "mm", "MMS": "mm",
    "FOOT": "ft", "FEET": "ft", "METER": "m", "METERS": "m", "METRE": "m", "METRES": "m", "CENTIMETER": "cm",
    "CENTIMETERS": "cm", "CENTIMETRE": "cm", "CENTIMETRES": "cm", "MICRON": "um", "MICRONS": "um", "MILS": "mil",
}  # fmt: skip
#: Parameters of the global section, counted from 0; the flag that leaves the unit to its name.
_SCALE, _FLAG, _NAME, _BY_NAME = 12, 13, 14, 3
#: Letters of a name that are shown.
_LONGEST = 16
_HOLLERITH = re.compile(rb"\s*(\d+)H")


class IgesUnit(NamedTuple):
    """The unit of a file's numbers, what real length is to model length, and what is doubtful about both."""

    unit: str
    scale: float
    readings: tuple[UnitReading, ...]


def unit_of(lines: Sequence[bytes]) -> IgesUnit:
    """The unit that the lines of a global section state.

    A known flag decides, as the standard says; the name decides where the flag says so, or where it is none of the standard's.
    Where neither is known, mm are taken, but inches, the standard's default, where both are left out. The scale is the ratio
    of model space to real space: lengths are divided by it.

    Examples
    --------
    >>> unit_of([b",,,,,,,,,,,,1.,2,2HMM;"])
    IgesUnit(unit='mm', scale=1.0, readings=())
    >>> unit_of([b",,,,,,,,,,,,1.,1,2HMM;"]).readings[0]
    UnitReading(cause='disagree', stated='flag 1, name "MM"', taken='in', unit='mm', times=0.03937007874015748)
    >>> unit_of([b""]).readings[0].stated, unit_of([b",,,,,,,,,,,,.5,3,2HCM;"]).scale
    ('no flag, no name', 0.5)
    """
    parameters = [*_parameters(b"".join(line[:72].ljust(72) for line in lines)), *[b""] * (_NAME + 1)]
    flag_text, name = (parameters[i].decode("ascii", "replace").strip() for i in (_FLAG, _NAME))
    flag = int(flag_text) if re.fullmatch(r"[+-]?\d{1,9}", flag_text) else None
    by_flag, by_name = FLAGS.get(flag or 0), _named(name)
    stated = ", ".join(
        (f"flag {flag_text[:_LONGEST]}" if flag_text else "no flag", f'name "{name[:_LONGEST]}"' if name else "no name")
    )
    taken = by_flag or by_name or ("mm" if flag_text or name else "in")
    readings = []
    if by_flag and by_name and by_flag != by_name:
        choice = by_name if by_name in UNITS else ""
        readings.append(UnitReading("disagree", stated, taken, choice, _LENGTHS[by_name] / _LENGTHS[by_flag]))
    elif (by_flag and name and not by_name) or (not by_flag and (flag != _BY_NAME or not by_name)):
        readings.append(UnitReading("not_sure", stated, taken))
    scale, doubt = _scale(parameters[_SCALE].decode("ascii", "replace").strip(), taken)
    return IgesUnit(taken, scale, (*readings, *doubt))


def _named(name: str) -> str | None:
    plain = name.upper().rstrip(".")
    return next((unit for unit in _LENGTHS if unit.upper() == plain), _NAMES.get(plain))


def _scale(text: str, taken: str) -> tuple[float, tuple[UnitReading, ...]]:
    number = text.upper().replace("D", "E")
    scale = float(number) if re.fullmatch(r"[+-]?(\d+\.?\d*|\.\d+)(E[+-]?\d{1,2})?", number) else (0.0 if text else 1.0)
    if scale == 1.0:
        return 1.0, ()
    if scale <= 0.0:
        return 1.0, (UnitReading("not_sure", f"model space scale {text[:_LONGEST]}", taken),)
    return scale, (UnitReading("scale", f"{scale:.6g}", taken, taken if taken in UNITS else "", scale),)


def _parameters(text: bytes) -> list[bytes]:
    """Parameters of a section in free format; strings in them are counted, and may hold the delimiters."""
    delimiters, values, at = [b",", b";"], list[bytes](), 0
    while at < len(text):
        value, after = b"", at
        if match := _HOLLERITH.match(text, at):
            after = match.end() + int(match[1][:9])
            value = text[match.end() : after]
        if len(values) < len(delimiters) and len(value) == 1:
            delimiters[len(values)] = value
        ends = [end for each in delimiters if (end := text.find(each, after)) >= 0]
        end = min(ends, default=len(text))
        values.append(value if match else text[at:end])
        if text[end : end + 1] == delimiters[1]:
            break
        at = end + 1
    return values
