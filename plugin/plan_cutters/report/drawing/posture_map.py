"""The posture map of one point as a picture: tilt against rotation, as the seed's Fig. 7, in colours and hatches."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from cad_io.arrays import Floats
from plan_cutters.domain.intervals import complement, without
from plan_cutters.plan_file.palette import PALETTE
from plan_cutters.plan_file.reasons import CAUSES, NO_CONTACT, REASONS
from plan_cutters.report.drawing.sheet import Look, figure, fitting, legend, save, write

#: Inches: the sheet's width, the room left at its sides, and the plot, from its left and with its size.
_WIDTH, _SIDE, _PLOT = 9.0, 0.3, (0.675, 6.3, 3.45)
#: Points: the letters of the title and of the notes; and inches that a line of each takes.
_TITLE, _NOTE, _TITLE_LINE, _NOTE_LINE = 11, 8, 0.23, 0.168


def _look(code: str) -> Look:
    look = REASONS.get(code, NO_CONTACT)
    return Look(look.name, look.colour, look.hatch)


#: In this order each counts for what is forbidden: where the cutter does not touch, nothing else is drawn.
_CAUSES = (NO_CONTACT.code, *CAUSES)
#: All that is drawn, in the legend's order. "Other" is neither free nor undecided, and nothing alone forbids it: within the
#: bounds of the search.
_LOOKS = {
    "free": Look("free", PALETTE["interference_free"]),
    "undecided": Look("undecided", PALETTE["undecided"], ".."),
    **{code: _look(code) for code in _CAUSES},
    "other": Look("not free", "#555555"),
}


def forbidden(posture_map: Any, low: float, high: float) -> dict[str, list[Floats]]:
    """Find the tilts that each cause forbids in a posture map: intervals (k, 2) at each rotation, rad.

    No tilt is counted twice: it belongs to the first cause that forbids it.

    Parameters
    ----------
    posture_map : PostureMap
    low, high : float
        The tilts that were requested, rad.
    """
    shares: dict[str, list[Floats]] = {code: [] for code in (*_CAUSES, "undecided", "other")}
    whole = np.array([[low, high]])
    for i in range(len(posture_map.rotations)):
        remaining = without(without(whole, posture_map.free[i]), posture_map.undecided[i])
        shares["undecided"].append(posture_map.undecided[i])
        for cause in _CAUSES:
            mine = _gouged(posture_map, i, low, high) if cause == "local_gouge" else getattr(posture_map, cause)[i]
            rest = without(remaining, mine)
            shares[cause].append(without(remaining, rest))
            remaining = rest
        shares["other"].append(remaining)
    return shares


def _gouged(posture_map: Any, i: int, low: float, high: float) -> Floats:
    """Tilts (k, 2) that local gouging alone forbids at a rotation."""
    least, most = posture_map.local_gouge[i], posture_map.local_gouge_most[i]
    if np.isnan(least):
        return np.array([[low, high]])
    return complement(np.array([[least, most]]), low, high)


def draw_map(posture_map: Any, tilt: tuple[float, float], title: str, notes: Sequence[str], paths: Sequence[Path]) -> None:
    """Draw a posture map, once for each path: PNG or SVG by its ending.

    Parameters
    ----------
    posture_map : PostureMap
        At rotations that ascend evenly.
    tilt : (float, float)
        The tilts that were requested, rad.
    title : str
    notes : sequence of str
        Lines beneath the picture.
    paths : sequence of Path

    The same map gives the same bytes. Each rotation that was searched is a column; nothing is known between.
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
