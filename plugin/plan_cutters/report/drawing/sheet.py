"""Sheets that pictures are drawn on: matplotlib without a screen, and the same bytes for the same sheet.

Matplotlib is loaded in this room alone, and only when something is drawn: the extra `pictures` brings it.
"""

import math
import re
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

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
