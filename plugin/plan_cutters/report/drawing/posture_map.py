"""Sheets of matplotlib without a screen, and the posture map of one point on one: tilt against rotation, as the seed's Fig. 7."""

import math
import re
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from cad_io.arrays import Floats
from plan_cutters.domain.posture import complement, without
from plan_cutters.plan_file.reasons import CAUSES, NO_CONTACT, PALETTE, REASONS

#: Dots an inch of PNG files.
DPI = 150
#: Letters that are set on whole dots are wider than they are in the font, by up to this.
_ON_DOTS = 1.05
_FONT = "DejaVu Sans"
_STYLE = {
    "svg.hashsalt": "plan-cutters",
    "svg.fonttype": "path",
    "font.family": _FONT,
    "hatch.linewidth": 0.6,
    "axes.linewidth": 0.8,
}


class Look(NamedTuple):
    """A look is how something is drawn: words of the legend, a colour of matplotlib, a hatch, the colour of hatch and edge."""

    words: str
    colour: Any
    hatch: str = ""
    edge: Any = "#00000066"

    @property
    def style(self) -> dict[str, Any]:
        return {"facecolor": self.colour, "edgecolor": self.edge, "hatch": self.hatch or None}


def legend(sheet: Any, looks: Sequence[Look], **place: Any) -> None:
    """Put a legend on a sheet, at a place as matplotlib has it."""
    from matplotlib.patches import Patch

    handles = [Patch(label=look.words, linewidth=0.5, **look.style) for look in looks]
    sheet.legend(handles=handles, frameon=False, fontsize=9, handlelength=2.6, handleheight=1.5, **place)


def figure(width: float, height: float) -> Any:
    """An empty white sheet, inches."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), dpi=DPI, facecolor="white")


def printable(text: str, most: int = 200) -> str:
    """A text from a file as it may stand on a sheet: on one line, no signs that steer, and its middle left out where it is long.

    What no sheet can show, or what would turn the rest of it round, is U+FFFD.

    >>> printable("rim\\n2"), printable("abcdefgh", 5)
    ('rim 2', 'ab…gh')
    """
    text = "".join(letter if letter.isprintable() else "\ufffd" for letter in " ".join(text.split()))
    if len(text) <= most:
        return text
    return f"{text[: most // 2]}…{text[len(text) - (most - 1) // 2 :]}"


def standard(most: float) -> float:
    """The largest of 1, 2 and 5 times a power of ten that is no larger.

    >>> standard(49.0), standard(0.5)
    (20.0, 0.5)
    """
    power = 10.0 ** math.floor(math.log10(most))
    return max(step * power for step in (0.5, 1.0, 2.0, 5.0, 10.0) if step * power <= most * (1.0 + 1e-9))


def write(sheet: Any, lines: Sequence[str], place: tuple[float, float], size: float) -> None:
    """Write lines on a sheet, at `place`, inches from its lower left corner to theirs at the top, in letters of `size` points.

    They are taken as they are: nothing in them is a formula.
    """
    x, y = place[0] / sheet.get_figwidth(), place[1] / sheet.get_figheight()
    sheet.text(x, y, "\n".join(lines), fontsize=size, va="top", linespacing=1.5, parse_math=False)


def fitting(text: str, size: float, width: float) -> list[str]:
    """A text in lines of a width, inches, as its letters are wide; words that are wider are broken, too."""
    from matplotlib.font_manager import FontProperties
    from matplotlib.textpath import text_to_path

    font = FontProperties(family=_FONT, size=size)

    def wide(line: str) -> float:
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", "Glyph")
            return float(text_to_path.get_text_width_height_descent(line, font, ismath=False)[0]) * _ON_DOTS / 72.0

    lines = [""]
    for word in re.findall(r"\s*\S+", text):
        if wide(lines[-1] + word) <= width:
            lines[-1] += word
            continue
        rest = word.lstrip()
        if lines[-1]:
            lines.append("")
        for letter in rest if wide(rest) > width else [rest]:
            if lines[-1] and wide(lines[-1] + letter) > width:
                lines.append("")
            lines[-1] += letter
    return lines


def save(sheet: Any, path: Path) -> None:
    """Write a sheet as PNG or SVG, by the ending of the path."""
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.backends.backend_svg import FigureCanvasSVG

    # The program's version and the time of writing would change the bytes.
    with matplotlib.rc_context(_STYLE), warnings.catch_warnings():
        # A letter that the font does not have is drawn as a box: that is no word for standard error.
        warnings.filterwarnings("ignore", "Glyph")
        if path.suffix.lower() == ".svg":
            FigureCanvasSVG(sheet).print_svg(path, metadata={"Date": None, "Creator": "plan-cutters"})
        else:
            FigureCanvasAgg(sheet).print_png(path, metadata={"Software": "plan-cutters"})


#: Inches: the sheet's width, the room left at its sides, and the plot, from its left and with its size.
_WIDTH, _SIDE, _PLOT = 9.0, 0.3, (0.675, 6.3, 3.45)
#: Points: the letters of the title and of the notes; and inches that a line of each takes.
_TITLE, _NOTE, _TITLE_LINE, _NOTE_LINE = 11, 8, 0.23, 0.168


#: In this order each counts for what is forbidden: where the cutter does not touch, nothing else is drawn.
_CAUSES = (NO_CONTACT.code, *CAUSES)
#: All that is drawn, in the legend's order. "Other" is neither free nor undecided, and nothing alone forbids it: within the
#: bounds of the search.
_LOOKS = {
    "free": Look("free", PALETTE["interference_free"]),
    "undecided": Look("undecided", PALETTE["undecided"], ".."),
    **{each.code: Look(each.name, each.colour, each.hatch) for each in (REASONS.get(code, NO_CONTACT) for code in _CAUSES)},
    "other": Look("not free", "#555555"),
}


def forbidden(posture_map: Any, low: float, high: float) -> dict[str, list[Floats]]:
    """Find the tilts that each cause forbids in a posture map: intervals (k, 2) at each rotation, rad.

    `low` and `high` are the tilts that were requested, rad. No tilt is counted twice: it belongs to the first cause that
    forbids it.
    """
    shares: dict[str, list[Floats]] = {code: [] for code in (*_CAUSES, "undecided", "other")}
    whole = np.array([[low, high]])
    for i in range(len(posture_map.rotations)):
        remaining = without(without(whole, posture_map.free[i]), posture_map.undecided[i])
        shares["undecided"].append(posture_map.undecided[i])
        for cause in _CAUSES:
            if cause == "local_gouge":
                least, most = posture_map.local_gouge[i], posture_map.local_gouge_most[i]
                mine = whole if np.isnan(least) else complement(np.array([[least, most]]), low, high)
            else:
                mine = getattr(posture_map, cause)[i]
            rest = without(remaining, mine)
            shares[cause].append(without(remaining, rest))
            remaining = rest
        shares["other"].append(remaining)
    return shares


def draw_map(posture_map: Any, tilt: tuple[float, float], title: str, notes: Sequence[str], paths: Sequence[Path]) -> None:
    """Draw a posture map, once for each path: PNG or SVG by its ending. The same map gives the same bytes.

    Its rotations ascend evenly; each that was searched is a column, and nothing is known between. `tilt`: what was requested,
    rad; `notes` are lines beneath the picture.
    """
    from matplotlib.collections import PolyCollection

    low, high = np.degrees(tilt)
    turns = np.degrees(posture_map.rotations)
    step = float(np.diff(turns).min()) if len(turns) > 1 else 10.0
    whole = len(turns) > 1 and abs(turns[-1] + step - turns[0] - 360.0) < 1e-6
    # A full turn ends with its first rotation.
    places = [*enumerate(turns.tolist()), *([(0, float(turns[0]) + 360.0)] if whole else [])]
    left, right = (places[0][1], places[-1][1]) if whole else (places[0][1] - 0.5 * step, places[-1][1] + 0.5 * step)
    shares = {"free": posture_map.free, **forbidden(posture_map, *tilt)}
    width = _WIDTH - 2.0 * _SIDE
    head = fitting(title, _TITLE, width)
    below = [line for note in notes for line in fitting(note, _NOTE, width)]
    # The plot keeps its size: the sheet grows with what is written above and below.
    foot, top = 0.8 + _NOTE_LINE * len(below), 0.25 + _TITLE_LINE * len(head)
    high_sheet = foot + _PLOT[2] + top
    sheet = figure(_WIDTH, high_sheet)
    plot = sheet.add_axes((_PLOT[0] / _WIDTH, foot / high_sheet, _PLOT[1] / _WIDTH, _PLOT[2] / high_sheet))
    used = []
    for code, look in _LOOKS.items():
        boxes = [
            [(at - 0.5 * step, a), (at + 0.5 * step, a), (at + 0.5 * step, b), (at - 0.5 * step, b)]
            for i, at in places
            for a, b in np.degrees(shares[code][i]).tolist()
        ]
        if not boxes and code != "free":
            continue
        plot.add_collection(PolyCollection(boxes, linewidth=0.0, **look.style))
        used.append(look)
    plot.set_xlabel("rotation θ from the direction of largest curvature (deg)")
    plot.set_ylabel("tilt λ from the surface normal (deg)")
    plot.set_xticks(_ticks(left, right))
    plot.set_yticks(_ticks(low, high))
    plot.set_xlim(left, right)
    plot.set_ylim(low, high if high > low else low + 1.0)
    legend(sheet, used, loc="upper left", bbox_to_anchor=(0.785, (foot + _PLOT[2]) / high_sheet), title="tilts", alignment="left")
    write(sheet, head, (_SIDE, high_sheet - 0.12), _TITLE)
    write(sheet, below, (_SIDE, foot - 0.55), _NOTE)
    for path in paths:
        save(sheet, path)


def _ticks(low: float, high: float) -> list[float]:
    """Round numbers of degrees between two ends."""
    span = max(high - low, 1e-9)
    step = next((s for s in (1, 2, 5, 10, 15, 30, 45, 60) if span / s <= 13), 90)
    first = np.ceil((low - 1e-9) / step) * step
    return [float(x) + 0.0 for x in np.arange(first, high + 1e-9, step)]
