"""Sheets that pictures are drawn on: matplotlib without a screen, and the same bytes for the same sheet.

Matplotlib is loaded here alone, and only when something is drawn. The package VTK, which the CAD kernel's binding depends on,
depends on it: it is there wherever the kernel is.
"""

from pathlib import Path
from typing import Any

#: Dots an inch of PNG files.
DPI = 150
_STYLE = {
    "svg.hashsalt": "plan-cutters",
    "svg.fonttype": "path",
    "font.family": "DejaVu Sans",
    "hatch.linewidth": 0.6,
    "axes.linewidth": 0.8,
}


def figure(width: float, height: float) -> Any:
    """An empty white sheet, inches."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), dpi=DPI, facecolor="white")


def save(sheet: Any, path: Path) -> None:
    """Write a sheet as PNG or SVG, by the ending of the path."""
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.backends.backend_svg import FigureCanvasSVG

    # The program's version and the time of writing would change the bytes.
    with matplotlib.rc_context(_STYLE):
        if path.suffix.lower() == ".svg":
            FigureCanvasSVG(sheet).print_svg(path, metadata={"Date": None, "Creator": "plan-cutters"})
        else:
            FigureCanvasAgg(sheet).print_png(path, metadata={"Software": "plan-cutters"})
