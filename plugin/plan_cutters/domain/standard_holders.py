"""Collet chucks by word: `er32`, `hsk63a-er32`, `bt40-er16x100`. Outer bounds of what standards and makers make.

Where makers differ, what is wider is taken, and what is wide begins as near to the tip as it does anywhere: a real chuck lies
within the one that is drawn. Nothing is drawn beyond the gauge line: the spindle is not part of a holder.
`docs/tools.md` has these tables with their sources.
"""

import re
from difflib import get_close_matches
from typing import NamedTuple

from plan_cutters.domain.lengths import LENGTH, length
from plan_cutters.errors import CutterError


class Nose(NamedTuple):
    """A clamping nut for ER collets, mm: the widest one's diameter, the shortest one's length, the largest shank."""

    diameter: float
    length: float
    bore: float


class Taper(NamedTuple):
    """The dimensions of a holder below its gauge line, mm: the flange, the body behind it, and the usual gauge length.

    flange, depth : float
        Diameter, and how far it reaches down from the gauge line or the contact face.
    body : float
        Diameter that the body between flange and nut may have.
    gauge : float
        From the gauge line to the nose, of the shortest of the usual chucks: so the flange stands no higher than it does.
    """

    name: str
    flange: float
    depth: float
    body: float
    gauge: float


#: ISO 15488 (DIN 6499): collets and their nuts, plain and slotted, whichever is wider.
NOSES = {
    "er11": Nose(19.1, 11.0, 7.0),
    "er16": Nose(32.0, 17.0, 10.0),
    "er20": Nose(35.0, 18.5, 13.0),
    "er25": Nose(42.1, 19.5, 16.0),
    "er32": Nose(50.1, 22.0, 20.0),
    "er40": Nose(63.1, 25.0, 26.0),
}
#: ISO 12164-1 (DIN 69893): flange d1, its height f1, and the room d10 that is kept for the gripper behind it.
#: ISO 7388-1 (DIN 69871, ASME B5.50): flange, down to its front face, and the body's largest diameter before 35 mm.
#: ISO 7388-2 (JIS B 6339, MAS 403): the same; it leaves the body open, so it is as wide as the flange.
TAPERS = {
    "hsk32a": Taper("HSK32A", 32.0, 20.0, 26.0, 50.0),
    "hsk40a": Taper("HSK40A", 40.0, 20.0, 34.0, 60.0),
    "hsk50a": Taper("HSK50A", 50.0, 26.0, 42.0, 70.0),
    "hsk63a": Taper("HSK63A", 63.0, 26.0, 53.0, 70.0),
    "hsk100a": Taper("HSK100A", 100.0, 29.0, 85.0, 80.0),
    "hsk32e": Taper("HSK32E", 32.0, 20.0, 26.0, 50.0),
    "hsk40e": Taper("HSK40E", 40.0, 20.0, 34.0, 60.0),
    "hsk50e": Taper("HSK50E", 50.0, 26.0, 42.0, 70.0),
    "sk30": Taper("SK30", 50.0, 19.1, 45.0, 50.0),
    "sk40": Taper("SK40", 63.55, 19.1, 50.0, 60.0),
    "sk50": Taper("SK50", 97.5, 19.1, 80.0, 70.0),
    "cat40": Taper("CAT40", 63.6, 19.1, 50.0, 59.0),
    "cat50": Taper("CAT50", 98.6, 19.1, 80.0, 70.0),
    "bt30": Taper("BT30", 46.0, 22.0, 46.0, 50.0),
    "bt40": Taper("BT40", 63.0, 27.0, 63.0, 60.0),
    "bt50": Taper("BT50", 100.0, 38.0, 100.0, 70.0),
}
#: How far a nose alone is drawn unless it is said, mm; and the longest holder.
_ALONE, _LONGEST = 60.0, 500.0
#: Other spellings: HSK-A63 and A63 for hsk63a, DIN 69871's SK and ISO's own short names.
_SPELLED = ((r"(?:hsk)?([ae])(32|40|50|63|100)", r"hsk\2\1"), (r"ct(40|50)", r"cat\1"), (r"(?:iso|dv)(30|40|50)", r"sk\1"))
_WORD = re.compile(rf"(?:(?P<taper>[a-z0-9]+?))?(?P<nose>er[0-9]+)(?:x(?P<length>{LENGTH}))?")


class Chuck(NamedTuple):
    """A holder of the tables: its name, its sections from the nose up (radius, length), and the largest shank; mm."""

    name: str
    stages: tuple[tuple[float, float], ...]
    bore: float


def words() -> list[str]:
    """Every word of the tables, noses alone first."""
    return [*NOSES, *(f"{taper}-{nose}" for taper in TAPERS for nose in NOSES)]


def chuck(text: str) -> Chuck | None:
    """The holder that a word names; None for a text that looks like no such word.

    Raises
    ------
    CutterError
        It looks like one and is none, or is too short for its own flange and nut.

    Examples
    --------
    >>> chuck("ER16"), chuck("HSK-A63/ER32x100").name
    (Chuck(name='ER16', stages=((16.0, 60.0),), bore=10.0), 'HSK63A-ER32x100')
    """
    plain = re.sub(r"[-_/\s]+", "", text.lower())
    if not re.match(r"er[0-9]|hsk|bt[0-9]|sk[0-9]|cat|ct[0-9]|iso[0-9]|dv[0-9]|[ae][0-9]{2,3}er", plain):
        return None
    match = _WORD.fullmatch(plain)
    nose = NOSES.get(match["nose"]) if match else None
    taper = _taper(match["taper"]) if match and match["taper"] else None
    if match is None or nose is None or (match["taper"] and taper is None):
        raise CutterError(f"no holder is called {text!r}; {_near(plain)}")
    short = match["nose"].upper()
    high = _ALONE if taper is None else taper.gauge
    if match["length"]:
        high = length(match["length"])
    least = nose.length if taper is None else nose.length + taper.depth
    if not least <= high <= _LONGEST:
        what = "its nut takes" if taper is None else "its nut and its flange take"
        raise CutterError(
            f"holder {text!r}: {what} {least:g} mm; give a length from that to {_LONGEST:g} mm, as "
            f"{match['taper'] or ''}{'-' if taper else ''}{match['nose']}x100"
        )
    if taper is None:
        return Chuck(short if not match["length"] else f"{short}x{high:g}", ((nose.diameter / 2, high),), nose.bore)
    body = max(nose.diameter, taper.body)
    sections = [(nose.diameter, nose.length), (body, high - least), (max(taper.flange, 0.0), taper.depth)]
    return Chuck(f"{taper.name}-{short}x{high:g}", _merged(sections), nose.bore)


def _merged(sections: list[tuple[float, float]]) -> tuple[tuple[float, float], ...]:
    """Sections, a diameter and a length each, as radii and lengths: those of one diameter that follow each other in one."""
    merged: list[tuple[float, float]] = []
    for diameter, long in sections:
        if merged and merged[-1][0] == diameter / 2:
            merged[-1] = (diameter / 2, merged[-1][1] + long)
        elif long > 0.0:
            merged.append((diameter / 2, long))
    return tuple(merged)


def _taper(plain: str) -> Taper | None:
    for pattern, word in _SPELLED:
        plain = re.sub(rf"^{pattern}$", word, plain)
    return TAPERS.get(plain)


def _near(plain: str) -> str:
    """Suggest holders whose names are like an unknown one, or list the known ones."""
    known = words()
    by = {word.replace("-", ""): word for word in known}
    near = [by[each] for each in get_close_matches(plain.partition("x")[0], by, 3, 0.5)]
    if near:
        return f"{' or '.join(near)}? plan-cutters tools --list-holders lists all"
    return f"known are {', '.join(NOSES)}, alone or on {', '.join(TAPERS)}, as hsk63a-er32"
