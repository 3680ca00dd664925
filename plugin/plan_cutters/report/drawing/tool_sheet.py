"""The sheet of a tool drawing as SVG: lines, arrows, texts, and fills that differ without colour. All lengths are mm on paper."""

import math
import unicodedata
import zlib
from collections.abc import Iterable
from xml.etree import ElementTree as ET

Point = tuple[float, float]

#: Height of letters and distance between lines of text.
FONT, LINE = 2.8, 4.0
#: A letter is no wider than this share of its height in the usual sans-serif fonts, on average; bold ones are wider.
_LETTER, _BOLD = 0.6, 0.68
_FAMILY = "Arial, Helvetica, 'Liberation Sans', 'DejaVu Sans', sans-serif"
#: Length and half width of arrow heads.
ARROW, _HALF = 2.4, 0.4

#: Fills: the ground; colour, angle, deg, and distance of the strokes on it, and how long each of them is (distance: a line).
FILLS: dict[str, tuple[str, str, float, float, float]] = {
    "flutes": ("#FFD27A", "#7A4A00", 45.0, 1.2, 1.2),
    "neck": ("#FFF6DD", "#8C6D1F", 45.0, 1.3, 0.3),
    "shank": ("#D9D9D9", "#D9D9D9", 0.0, 1.0, 0.0),
    "holder": ("#BBD5EA", "#2F5D86", -45.0, 2.6, 2.6),
}
_PENS = {
    "edge": {"stroke": "#000", "stroke-width": "0.35", "stroke-linejoin": "round"},
    "fine": {"stroke": "#000", "stroke-width": "0.13"},
    "frame": {"stroke": "#000", "stroke-width": "0.25"},
    "axis": {"stroke": "#000", "stroke-width": "0.18", "stroke-dasharray": "6 1.2 0.6 1.2"},
    "mark": {"stroke": "#000", "stroke-width": "0.18", "stroke-dasharray": "1.2 0.8"},
}


def width_of(text: str, size: float = FONT, *, bold: bool = False) -> float:
    """How wide a text may be, an estimate that errs to the large side."""
    letters = sum(1.0 if unicodedata.east_asian_width(c) in "WF" else _BOLD if bold else _LETTER for c in text)
    return letters * size


def wrapped(text: str, width: float, size: float, most: int, *, bold: bool = False) -> list[str]:
    """A text in lines of a width, broken after blanks or plus signs where it can be; an ellipsis ends more than `most` lines."""
    lines: list[str] = []
    rest = text
    while rest and len(lines) < most:
        fits = len(rest)
        while fits > 1 and width_of(rest[:fits], size, bold=bold) > width:
            # The estimate is a sum over letters: a guess by share comes close, then one by one.
            fits = max(1, min(fits - 1, math.ceil(fits * width / width_of(rest[:fits], size, bold=bold))))
        if fits < len(rest):
            fits = max(rest.rfind(" ", 1, fits), rest.rfind("+", 1, fits)) + 1 or fits
        lines.append(rest[:fits].rstrip())
        rest = rest[fits:]
    if rest:
        lines[-1] = lines[-1][: max(0, len(lines[-1]) - 2)] + "…"
    return lines


def length(value: float) -> str:
    """A length for people: mm with up to four decimals, as few as it has; tiny and huge ones with six digits."""
    if abs(value) >= 1e7:
        return f"{value:.6g}"
    text = _mm(value)
    return f"{value:.6g}" if text == "0" and value else text


def _mm(value: float) -> str:
    text = f"{value:.4f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


class Sheet:
    """A sheet collects a drawing in layers: fills and lines at the bottom, texts over them.

    Parameters
    ----------
    title, description : str
        For readers that see no picture, and of all there is.
    """

    def __init__(self, title: str, description: str) -> None:
        # Several drawings may stand in one page: their ids must differ.
        self.key = f"d{zlib.crc32((title + description).encode()):08x}"
        self.root = ET.Element(
            "svg", {"xmlns": "http://www.w3.org/2000/svg", "role": "img", "aria-labelledby": f"{self.key}-title {self.key}-desc"}
        )
        self._add(self.root, "title", {"id": f"{self.key}-title"}).text = title
        self._add(self.root, "desc", {"id": f"{self.key}-desc"}).text = description
        self._defs = self._add(self.root, "defs")
        self._lines = self._add(self.root, "g", {"fill": "none"})
        self._texts = self._add(self.root, "g", {"font-family": _FAMILY, "fill": "#000"})
        self._clip: str | None = None

    def _add(self, to: ET.Element, tag: str, attributes: dict[str, str] | None = None) -> ET.Element:
        return ET.SubElement(to, tag, attributes or {})

    def finished(self, width: float, height: float, **data: str) -> str:
        """The sheet as text, of a size, framed."""
        self.root.attrib |= {
            "width": f"{_mm(width)}mm",
            "height": f"{_mm(height)}mm",
            "viewBox": f"0 0 {_mm(width)} {_mm(height)}",
        }
        self.root.attrib |= {f"data-{word}": value for word, value in data.items()}
        paper = ET.Element("rect", {"width": _mm(width), "height": _mm(height), "fill": "#fff"})
        self._lines.insert(0, paper)
        return ET.tostring(self.root, encoding="unicode") + "\n"

    def window(self, x: float, y: float, width: float, height: float) -> None:
        """From here on only what lies in a rectangle is drawn of paths; a width of 0 ends that."""
        self._clip = None
        if width:
            self._clip = f"{self.key}-window"
            within = self._add(self._defs, "clipPath", {"id": self._clip})
            self._add(within, "rect", {"x": _mm(x), "y": _mm(y), "width": _mm(width), "height": _mm(height)})

    def fill(self, path: str, name: str, kind: str) -> None:
        """A closed path in the fill of a part; `kind` is its class."""
        ground, colour, angle, gap, stroke = FILLS[name]
        id_ = f"{self.key}-{name}"
        if self._defs.find(f"pattern[@id='{id_}']") is None:
            pattern = self._add(self._defs, "pattern", {"id": id_, "width": _mm(gap), "height": _mm(gap), "patternUnits":
                                "userSpaceOnUse", "patternTransform": f"rotate({angle:g})"})  # fmt: skip
            self._add(pattern, "rect", {"width": _mm(gap), "height": _mm(gap), "fill": ground})
            if stroke:
                line = {"d": f"M0 {_mm(0.5 * gap)}h{_mm(stroke)}", "stroke": colour, "stroke-width": "0.25"}
                self._add(pattern, "path", line)
        self.path(path, "edge", fill=f"url(#{id_})", kind=kind)

    def path(self, path: str, pen: str, *, fill: str = "", kind: str = "") -> None:
        element = self._add(self._lines, "path", {"d": path, **_PENS[pen]})
        element.attrib |= {"class": kind} if kind else {}
        element.attrib |= {"fill": fill} if fill else {}
        element.attrib |= {"clip-path": f"url(#{self._clip})"} if self._clip else {}

    def lines(self, points: Iterable[Point], pen: str) -> None:
        """Straight lines from point to point."""
        self.path("M" + "L".join(at(point) for point in points), pen)

    def circle(self, centre: Point, radius: float, pen: str, *, fill: str = "none") -> None:
        self._add(
            self._lines, "circle", {"cx": _mm(centre[0]), "cy": _mm(centre[1]), "r": _mm(radius), "fill": fill, **_PENS[pen]}
        )

    def text(self, x: float, y: float, words: str, *, size: float = FONT, anchor: str = "start", bold: bool = False,
             upright: bool = False) -> None:  # fmt: skip
        """Words at their base line; upright ones are read from the right. Lines under them are kept off by a white rim."""
        attributes = {"x": _mm(x), "y": _mm(y), "font-size": _mm(size), "text-anchor": anchor, "stroke": "#fff",
                 "stroke-width": "0.7", "stroke-linejoin": "round", "paint-order": "stroke"}  # fmt: skip
        if bold:
            attributes["font-weight"] = "bold"
        if upright:
            attributes["transform"] = f"rotate(-90 {_mm(x)} {_mm(y)})"
        self._add(self._texts, "text", attributes).text = words

    def arrow(self, tip: Point, tail: Point) -> None:
        """A filled arrow head whose tip points away from `tail`."""
        away = math.dist(tip, tail)
        along = ((tail[0] - tip[0]) / away, (tail[1] - tip[1]) / away)
        base = (tip[0] + ARROW * along[0], tip[1] + ARROW * along[1])
        corners = [tip, *((base[0] + side * along[1], base[1] - side * along[0]) for side in (_HALF, -_HALF))]
        self.path("M" + "L".join(map(at, corners)) + "Z", "fine", fill="#000")

    def between(self, a: Point, b: Point) -> None:
        """A dimension line with arrow heads at its ends: from within where there is room, else from without."""
        apart = math.dist(a, b)
        if apart >= 3.0 * ARROW:
            self.lines((a, b), "fine")
            self.arrow(a, b)
            self.arrow(b, a)
            return
        along = ((b[0] - a[0]) / apart, (b[1] - a[1]) / apart) if apart else (1.0, 0.0)
        out = [(end[0] + way * 2 * ARROW * along[0], end[1] + way * 2 * ARROW * along[1]) for end, way in ((a, -1), (b, 1))]
        self.lines((out[0], out[1]), "fine")
        self.arrow(a, out[0])
        self.arrow(b, out[1])


def at(point: Point) -> str:
    """A point as paths have it."""
    return f"{_mm(point[0])} {_mm(point[1])}"
