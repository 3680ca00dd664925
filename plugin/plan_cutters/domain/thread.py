"""Threads of holes by their designations: metric (ISO 261) and unified (ASME B1.1)."""

import re
from collections.abc import Iterable
from dataclasses import dataclass

from cad_io.arrays import SizeNote

#: Pitches, mm, that a metric thread has where none is stated, by its diameter, mm (ISO 261, coarse).
_COARSE = {
    1.0: 0.25, 1.1: 0.25, 1.2: 0.25, 1.4: 0.3, 1.6: 0.35, 1.8: 0.35, 2.0: 0.4, 2.2: 0.45, 2.5: 0.45, 3.0: 0.5, 3.5: 0.6, 4.0: 0.7,
    4.5: 0.75, 5.0: 0.8, 6.0: 1.0, 7.0: 1.0, 8.0: 1.25, 9.0: 1.25, 10.0: 1.5, 11.0: 1.5, 12.0: 1.75, 14.0: 2.0, 16.0: 2.0,
    18.0: 2.5, 20.0: 2.5, 22.0: 2.5, 24.0: 3.0, 27.0: 3.0, 30.0: 3.5, 33.0: 3.5, 36.0: 4.0,
}  # fmt: skip
_INCH = 25.4
_NUMBER = r"\d+(?:[.,]\d+)?"
#: Before both: how many holes have it.
_TIMES = r"(?:\d+\s*[xX×]\s+)?"
_METRIC = re.compile(
    rf"{_TIMES}(?P<name>M\s*(?P<wide>{_NUMBER})(?:\s*[xX×*]\s*(?P<pitch>{_NUMBER}))?)(?:\s*-\s*(?P<fit>\d[GH](?:\d[GH])?)\b)?"
    r"(?P<left>\s*-?\s*LH\b)?"
)
_UNIFIED = re.compile(
    rf"{_TIMES}(?P<name>(?P<size>#?\d+(?:/\d+)?|\d+[ -]\d+/\d+|\d*\.\d+)\s*-\s*(?P<turns>\d+)"
    r"\s*(?P<series>UN(?:C|F|EF|S|JC|JF)?))\b"
    r"(?:\s*-?\s*(?P<fit>[123]B)\b)?(?P<left>\s*-?\s*LH\b)?"
)
#: After it: how deep it is, and nothing that makes it a screw or a note on something else.
_REST = re.compile(
    rf"(?:\W|{_NUMBER}|thru|through|all|tap|tapped|thread|threads|deep|depth|dp|rh|mm|in|inch|min|max|x)*", re.IGNORECASE
)
#: Largest number of a screw that has one, and its diameters, inch.
_MOST, _FIRST, _EACH = 12, 0.06, 0.013
#: Turns an inch that a thread of whole inches has at most: what has more, and no sign, is a screw's.
_TURNS = 16
#: The last grade that a drill does not hold, and its width in units of ISO 286.
_REAMED, _GRADE = 9, 40.0
#: Diameters of a hole before it is tapped, below that of its thread, in pitches: of drills, and of models.
_TAPPED, _MODELLED = (0.75, 1.15), (0.5, 1.3)
#: Share of a pitch within which diameters are one, and diameters and pitches that differ by less, mm, are equal.
_SAME, _NEAR = 0.3, 0.02


@dataclass(frozen=True, slots=True)
class Thread:
    """A thread in a hole."""

    name: str  #: As `M4`, `M8x1` or `1/4-20 UNC`.
    diameter: float  #: mm; its largest.
    pitch: float  #: mm
    fit: str = ""  #: Its tolerance class, as `6H` or `2B`; empty where none is stated.
    left: bool = False  #: It turns to the left.

    @property
    def core(self) -> float:
        """Diameter of the drill before the tap, mm."""
        return self.diameter - self.pitch

    def is_core(self, diameter: float, *, modelled: bool = False) -> bool:
        """Whether a hole of a diameter, mm, is one to tap; `modelled`: as models have it, which may be its smallest."""
        least, most = _MODELLED if modelled else _TAPPED
        return least <= (self.diameter - diameter) / self.pitch <= most

    def is_whole(self, diameter: float) -> bool:
        """Whether a model has the hole as wide as the thread; its diameter in mm."""
        return abs(diameter - self.diameter) <= _SAME * self.pitch

    def equals(self, diameter: float, pitch: float | None, *, left: bool) -> bool:
        """Whether a tap of a diameter and a pitch, mm, cuts it."""
        near = pitch is not None and abs(pitch - self.pitch) <= _NEAR * self.pitch
        return near and abs(diameter - self.diameter) <= _NEAR * self.pitch + _NEAR and left == self.left


def thread_of(text: str, *, whole: bool = True) -> Thread | None:
    """The thread that a text designates, with a depth behind it or not; None where it designates none.

    Not `whole`: it may stand anywhere in the text.

    Examples
    --------
    >>> thread_of("M4x0.7 - 6H")
    Thread(name='M4', diameter=4.0, pitch=0.7, fit='6H', left=False)
    >>> thread_of("1/4-20 UNC-2B").pitch, thread_of("4X M8x1").name, thread_of("#10-32 UNF").diameter
    (1.27, 'M8x1', 4.826)
    >>> [thread_of(text) for text in ("", "4X", "theoretical", "DIM4", "M99", "0/4-20 UNC", "M8 BOLT")]
    [None, None, None, None, None, None, None]
    """
    for pattern, made in ((_METRIC, _metric), (_UNIFIED, _unified)):
        match = pattern.match(text.strip()) if whole else re.search(rf"(?<![\w.]){pattern.pattern}", text)
        if match is None or (whole and not _REST.fullmatch(text.strip()[match.end() :])):
            continue
        if (thread := made(match)) is not None:
            return thread
    return None


def thread_in(sizes: Iterable[SizeNote], diameter: float) -> Thread | None:
    """The thread that notes on a hole of a diameter, mm, designate; None of several, and of one that fits no such hole."""
    each = {thread for size in sizes for note in size.notes if (thread := thread_of(note)) is not None}
    fits = [thread for thread in each if thread.is_core(diameter, modelled=True) or thread.is_whole(diameter)]
    return fits[0] if len(fits) == len(each) == 1 else None


@dataclass(frozen=True, slots=True)
class Tolerance:
    """The diameter of a hole lies within this."""

    nominal: float  #: mm
    lower: float | None  #: mm; deviations, None where none are stated.
    upper: float | None
    fit: str  #: Its class, as `H7`; empty where none is stated.

    @property
    def reamed(self) -> bool:
        """Whether it is finer than what a drill holds: up to the ninth grade of ISO 286."""
        grade = re.search(r"\d+", self.fit)
        if grade is not None:
            return int(grade[0]) <= _REAMED
        width = None if self.lower is None or self.upper is None else self.upper - self.lower
        return width is not None and width <= 1e-3 * _GRADE * (0.45 * self.nominal ** (1.0 / 3.0) + 1e-3 * self.nominal)


def tolerance_in(sizes: Iterable[SizeNote], diameter: float) -> Tolerance | None:
    """The tolerance that is stated of a hole of a diameter, mm; None where there is none, or several."""
    stated = {
        Tolerance(diameter if each.nominal is None else each.nominal, each.lower, each.upper, each.fit)
        for each in sizes
        if each.fit or (each.lower is not None and each.upper is not None)
    }
    return stated.pop() if len(stated) == 1 else None


def _metric(match: re.Match[str]) -> Thread | None:
    wide = float(match["wide"].replace(",", "."))
    coarse = _COARSE.get(wide)
    pitch = float(match["pitch"].replace(",", ".")) if match["pitch"] else coarse
    if pitch is not None and pitch >= 0.5 * wide:
        # No pitch is so large: `M6 x 12` is 12 deep.
        pitch = coarse
    if not pitch:
        return None
    name = f"M{wide:.6g}" if pitch == coarse else f"M{wide:.6g}x{pitch:.6g}"
    return Thread(name, wide, pitch, match["fit"] or "", bool(match["left"]))


def _unified(match: re.Match[str]) -> Thread | None:
    size, turns = match["size"], int(match["turns"])
    if "/" in size:
        whole, _, rest = size.replace(" ", "-").rpartition("-")
        top, below = (int(each) for each in rest.split("/"))
        wide = (int(whole) if whole else 0) + top / below if below else 0.0
    elif "." in size:
        wide = float(size)
    else:
        number, signed = int(size.removeprefix("#")), size[0] == "#"
        if signed and number > _MOST:
            return None
        wide = _FIRST + _EACH * number if signed or (number <= _MOST and turns > _TURNS) else float(number)
    if not turns or not 0.0 < 1.0 / turns < 0.5 * wide:
        return None
    name = f"{size}-{turns} {match['series']}"
    return Thread(name, round(wide * _INCH, 6), round(_INCH / turns, 6), match["fit"] or "", bool(match["left"]))
