"""A tool assembly drawn to scale: one sheet of SVG that holds all it needs and prints to size on A4."""

import math
import unicodedata
import zlib
from collections.abc import Iterable
from typing import NamedTuple
from xml.etree import ElementTree as ET

from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.outline import Outline, Point, Segment, outline
from plan_cutters.domain.shapes import SAME, flank, flute_length, stages, top_radius
from plan_cutters.report.drawing.posture_map import printable, standard

#: Height of letters and distance between lines of text.
FONT, LINE = 2.8, 4.0
#: A letter is no wider than this share of its height in the usual sans-serif fonts, on average; bold ones are wider.
_LETTER, _BOLD = 0.6, 0.68
_FAMILY = "Arial, Helvetica, 'Liberation Sans', 'DejaVu Sans', sans-serif"
#: Length and half width of arrow heads.
ARROW, _HALF = 2.4, 0.4

#: A note tells what each part is: colours only help.
FILLS = {"flutes": "#FFD27A", "neck": "#FFF6DD", "shank": "#D9D9D9", "holder": "#BBD5EA"}
_PENS = {
    "edge": {"stroke": "#000", "stroke-width": "0.35", "stroke-linejoin": "round"},
    "fine": {"stroke": "#000", "stroke-width": "0.13"},
    "frame": {"stroke": "#000", "stroke-width": "0.25"},
    "axis": {"stroke": "#000", "stroke-width": "0.18", "stroke-dasharray": "6 1.2 0.6 1.2"},
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

    Title and description are for readers that see no picture, and of all there is.
    """

    def __init__(self, title: str, description: str) -> None:
        # Several drawings may stand in one page: their ids must differ.
        self.key = f"d{zlib.crc32((title + description).encode()):08x}"
        self.root = ET.Element(
            "svg", {"xmlns": "http://www.w3.org/2000/svg", "role": "img", "aria-labelledby": f"{self.key}-title {self.key}-desc"}
        )
        ET.SubElement(self.root, "title", {"id": f"{self.key}-title"}).text = title
        ET.SubElement(self.root, "desc", {"id": f"{self.key}-desc"}).text = description
        self._lines = ET.SubElement(self.root, "g", {"fill": "none"})
        self._texts = ET.SubElement(self.root, "g", {"font-family": _FAMILY, "fill": "#000"})

    def finished(self, width: float, height: float, **data: str) -> str:
        """The sheet as text, of a size, framed."""
        wide, high = _mm(width), _mm(height)
        self.root.attrib |= {"width": f"{wide}mm", "height": f"{high}mm", "viewBox": f"0 0 {wide} {high}"}
        self.root.attrib |= {f"data-{word}": value for word, value in data.items()}
        self._lines.insert(0, ET.Element("rect", {"width": wide, "height": high, "fill": "#fff"}))
        return ET.tostring(self.root, encoding="unicode") + "\n"

    def path(self, path: str, pen: str, *, fill: str = "", kind: str = "") -> None:
        element = ET.SubElement(self._lines, "path", {"d": path, **_PENS[pen]})
        element.attrib |= {"class": kind} if kind else {}
        element.attrib |= {"fill": fill} if fill else {}

    def lines(self, points: Iterable[Point], pen: str) -> None:
        """Straight lines from point to point."""
        self.path("M" + "L".join(at(point) for point in points), pen)

    def dot(self, centre: Point) -> None:
        ET.SubElement(
            self._lines, "circle", {"cx": _mm(centre[0]), "cy": _mm(centre[1]), "r": "0.4", "fill": "#000", **_PENS["fine"]}
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
        ET.SubElement(self._texts, "text", attributes).text = words

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


#: Most points of a form that stand beside its picture.
_POINTS = 12


class Note(NamedTuple):
    """Words beside the view about what lies at a point of the outline."""

    at: Point
    lines: list[str]

    @property
    def height(self) -> float:
        return LINE * len(self.lines) + 0.8


def across(radius: float, upper: float | None = None) -> str:
    words = f"Ø{length(2 * radius)}"
    return words if upper is None or upper == radius else f"{words} to Ø{length(2 * upper)}"


def notes_of(cutter: Cutter, line: Outline) -> list[Note]:
    """Write a note on each part and segment, from the tip upwards: first the dimensions of the cutting part."""
    corner = cutter.corner_radius
    lines = [f"flutes {across(cutter.radius)} × {length(flute_length(cutter))}"]
    if cutter.shape == "lollipop":
        lines.append(f"ball R{length(corner)}")
    elif cutter.shape == "barrel":
        tip = f"tip R{length(corner)}" if corner else f"flat tip {across(flank(cutter, 0.0))}"
        lines += [f"flank R{length(cutter.arc_radius)}", f"widest {length(cutter.arc_height)} over the tip", tip]
    elif cutter.shape == "lens":
        lines += [f"bottom R{length(cutter.arc_radius)}", f"corner R{length(corner)}"]
    elif cutter.shape == "form":
        points = cutter.outline
        lines.append(f"form of {len(points)} points: Ø at height")
        lines += [f"{across(r)} at {length(h)}" for r, h in points[:_POINTS]]
        lines += [f"… and {len(points) - _POINTS} more"] if len(points) > _POINTS else []
    else:
        ball = f"ball R{length(corner)}" if corner == cutter.radius else f"corner R{length(corner)}"
        lines.append(ball if corner else "flat, sharp corner")
        if cutter.taper:
            angle = length(math.degrees(abs(cutter.taper)))
            lines.append(f"{'taper' if cutter.taper > 0 else 'undercut'} {angle}° (half angle)")
    if abs(top_radius(cutter) - cutter.radius) > SAME and cutter.shape in ("end", "barrel"):
        lines.append(f"{across(top_radius(cutter))} where the flutes end")
    flutes = max((s for s in line.of("flutes") if s.end[1] > s.start[1]), key=lambda s: s.end[1] - s.start[1])
    notes, holder = [Note(flutes.at(0.5), lines)], 0
    for part, low, stage in stages(cutter):
        holder += part == "holder"
        which = f"holder {holder}" if part == "holder" and cutter.holder and len(cutter.holder.stages) > 1 else part
        middle = 0.5 * (stage.radius + stage.upper_radius), low + 0.5 * stage.length
        words = f"{which} {across(stage.radius, stage.upper_radius)} × {length(stage.length)}"
        notes.append(Note(middle, [words]))
    return notes


def heights_of(cutter: Cutter) -> dict[str, float]:
    """Heights over the tip that have a dimension line, mm, the lowest first."""
    if cutter.holder is None:
        return {"length": cutter.length}
    return {"stick-out": cutter.length, "overall": cutter.length + sum(stage.length for stage in cutter.holder.stages)}


def facts_of(cutter: Cutter) -> list[str]:
    """List the facts of the whole assembly: its holder, allowance and clearance."""
    name = cutter.holder.name if cutter.holder else ""
    facts = [f"holder: {printable(name)}" if name else "a holder without a name" if cutter.holder else "no holder"]
    facts += [f"allowance {length(cutter.allowance)} on the surface, not shown"] if cutter.allowance else []
    clearance = [f"clearance {length(cutter.clearance)} of neck, shank and holder, not shown"] if cutter.clearance else []
    return facts + clearance


def description(cutter: Cutter, notes: list[Note], facts: list[str]) -> str:
    """All of it in words, for whoever sees no picture; nothing is left out here."""
    lines = [f"Tool assembly {cutter.id}, in mm, from the tip up", *(", ".join(note.lines) for note in notes)]
    lines += [f"{name} {length(height)}" for name, height in heights_of(cutter).items()]
    form = [f"{across(r)} at height {length(h)}" for r, h in cutter.outline]
    return "; ".join([*lines, *facts, *form]) + "."


#: A4 upright, its margin, and what stands around the view: room for arrows below the tip and for the axis above the end.
_PAGE, _MARGIN, _BELOW, _ABOVE = (210.0, 297.0), 9.0, 15.0, 6.0
#: Distance of dimension lines; of the view from what stands beside it; room for leaders; least width of a sheet.
_COLUMN, _GAP, _LEADER, _LEAST = 6.5, 5.0, 9.0, 112.0
#: Letters of the id, most lines of names and of ids.
_FINE, _NAMES, _IDS = 2.2, 2, 3
#: Directions closer to each other than this have no edge between them, rad.
_SMOOTH = 1e-4


class _View(NamedTuple):
    """Where a height and a radius are on paper: the tip, and mm of paper a mm."""

    x: float
    y: float
    scale: float

    def __call__(self, point: Point, side: float = 1.0) -> Point:
        return self.x + side * self.scale * point[0], self.y - self.scale * point[1]


def draw(cutter: Cutter, *, name: str = "") -> str:
    """A tool assembly as an SVG drawing, an `svg` element without an XML declaration.

    It is drawn upright, its tip at the bottom, 1:1 where that fits an A4 sheet, else in the largest standard reduction that
    does; the sheet states which, and is as large on paper as the SVG says. `name` is the title; else the cutter's own name, or
    its id. `data-scale` is mm on paper a mm; paths of the class `part` are the silhouettes of flutes, neck, shank and holder.

    >>> "no holder" in draw(Cutter.parse("R6L80"))
    True
    """
    line = outline(cutter)
    title = printable(name or cutter.name or cutter.id)
    notes, heights, facts = notes_of(cutter, line), heights_of(cutter), facts_of(cutter)
    sheet = Sheet(title, description(cutter, notes, facts))
    widest = max(width_of(words) for note in notes for words in note.lines)
    high = _PAGE[1] - 2 * _MARGIN - _ABOVE - _BELOW - (4.5 * _NAMES + 3.0 * _IDS + LINE * len(facts) + 8.0)
    broad = _PAGE[0] - 2 * _MARGIN - 2 * _GAP - _LEADER - widest - len(heights) * _COLUMN
    scale = min(1.0, standard(min(broad / (2.0 * line.widest), high / line.height)))
    wide, tall = scale * line.widest, scale * line.height
    right = _MARGIN + len(heights) * _COLUMN + _GAP + 2 * wide + _GAP + _LEADER
    width = max(_LEAST, right + widest + _MARGIN)
    # A sheet is no narrower than its title: the view stands in its middle.
    right = 0.5 * (width + right - widest - _MARGIN)
    top = _MARGIN + _ABOVE
    bottom = top + max(tall + _BELOW, sum(note.height for note in notes))
    view = _View(right - _LEADER - _GAP - wide, top + tall, scale)
    _assembly(sheet, line, view)
    _dimensions(sheet, heights, line, view)
    # The cutting diameter, below the tip.
    y, r = view.y + 9.0, view.scale * cutter.radius
    for side in (-r, r):
        sheet.lines(((view.x + side, view.y + 0.8), (view.x + side, y + 1.2)), "fine")
    sheet.between((view.x - r, y), (view.x + r, y))
    sheet.text(view.x, y + 3.6, across(cutter.radius), anchor="middle")
    _leaders(sheet, notes, view, wide, (right, top, bottom))
    end = _block(sheet, (title, cutter.id), facts, scale, bottom + 3.0, width)
    return sheet.finished(width, end, scale=f"{scale:.10g}")


def _silhouette(segments: tuple[Segment, ...], view: _View) -> str:
    path = ["M" + at(view(segments[0].start))]
    path += [_side(segment, view, segment.end) for segment in segments]
    path.append("L" + at(view(segments[-1].end, -1.0)))
    path += [_side(segment, view, segment.start, -1.0) for segment in reversed(segments)]
    return "".join(path) + "Z"


def _side(segment: Segment, view: _View, to: Point, side: float = 1.0) -> str:
    if segment.centre is None:
        return "L" + at(view(to, side))
    radius = f"{view.scale * segment.radius:.6g}"
    return f"A{radius} {radius} 0 {int(abs(segment.turn) > math.pi)} {int(segment.turn < 0)} {at(view(to, side))}"


def _assembly(sheet: Sheet, line: Outline, view: _View) -> None:
    for part in line.parts:
        sheet.path(_silhouette(line.of(part), view), "edge", fill=FILLS[part], kind=f"part {part}")
    for below, above in zip(line.segments[:-1], line.segments[1:], strict=True):
        # Circles along which the outline has an edge: seen from the side they are lines across.
        (a, b), (c, d) = below.direction(1.0), above.direction(0.0)
        if abs(a * d - b * c) > _SMOOTH:
            sheet.lines((view(below.end, -1.0), view(below.end)), "fine")
    sheet.lines(((view.x, view.y + 4.0), (view.x, view.y - view.scale * line.height - 4.0)), "axis")


def _dimensions(sheet: Sheet, heights: dict[str, float], line: Outline, view: _View) -> None:
    """Dimension lines from the tip up, left of the view, each from the largest radius at its height."""
    ends = [end for segment in line.segments for end in (segment.start, segment.end)]
    for i, (name, height) in enumerate(heights.items()):
        x = view.x - view.scale * line.widest - _GAP - i * _COLUMN
        high = view.y - view.scale * height
        for at_height, y in ((0.0, view.y), (height, high)):
            radius = max((r for r, h in ends if abs(h - at_height) <= 1e-6), default=0.0)
            sheet.lines(((view.x - view.scale * radius - 0.8, y), (x - 1.2, y)), "fine")
        sheet.between((x, view.y), (x, high))
        sheet.text(x - 1.0, 0.5 * (view.y + high), f"{name} {length(height)}", anchor="middle", upright=True)


def _leaders(sheet: Sheet, notes: list[Note], view: _View, wide: float, margins: tuple[float, float, float]) -> None:
    """Notes right of the view, each at the height of what it is about as nearly as the others let it."""
    from scipy.optimize import isotonic_regression

    x, top, bottom = margins
    notes = sorted(notes, key=lambda note: -note.at[1])
    sizes = [note.height for note in notes]
    before = [sum(sizes[:i]) for i in range(len(notes))]
    # Each wants its middle at the height of its point. In order and without overlap, the least squares are isotonic.
    wish = [view(note.at)[1] - 0.5 * size - above for note, size, above in zip(notes, sizes, before, strict=True)]
    slack = max(top, bottom - sum(sizes))
    for note, size, above, start in zip(notes, sizes, before, isotonic_regression(wish).x, strict=True):
        y = above + min(max(float(start), top), slack)
        point = view(note.at)
        elbow = (view.x + wide + 2.0, point[1])
        sheet.lines((point, elbow, (x - 3.0, y + 0.5 * size), (x - 1.0, y + 0.5 * size)), "fine")
        sheet.dot(point)
        for i, words in enumerate(note.lines):
            sheet.text(x, y + LINE * (i + 0.75), words)


def _block(sheet: Sheet, names: tuple[str, str], facts: list[str], scale: float, top: float, width: float) -> float:
    """The title block: name, id, scale, and what is true of the whole; returns where it ends."""
    left, available = _MARGIN, width - 2 * _MARGIN
    title, id_ = names
    lines = wrapped(title, available, 3.6, _NAMES, bold=True)
    ids = wrapped(id_, available, _FINE, _IDS) if id_ != title else []
    y = top + 2.0
    for words in lines:
        y += 4.5
        sheet.text(left, y - 0.8, words, size=3.6, bold=True)
    for words in ids:
        y += 3.0
        sheet.text(left, y - 0.4, words, size=_FINE)
    sheet.lines(((4.0, top), (width - 4.0, top)), "frame")
    y += 1.0
    scale_words = f"scale 1:{1.0 / scale:g}, in mm"
    for i, words in enumerate(facts):
        y += LINE
        fact = wrapped(words, available - (width_of(scale_words) + 4.0 if i == 0 else 0.0), FONT, 1)
        sheet.text(left, y, "".join(fact))
        if i == 0:
            sheet.text(width - _MARGIN, y, scale_words, anchor="end", bold=True)
    y += 8.0
    sheet.path(f"M4 4H{width - 4.0:.4f}V{y - 4.0:.4f}H4Z", "frame")
    return y
