"""A tool assembly drawn to scale: one sheet of SVG that holds all it needs and prints to size on A4."""

import math
from typing import NamedTuple

from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.outline import AnyPart, Outline, Segment, outline
from plan_cutters.domain.shapes import flute_length
from plan_cutters.report.drawing.sheet import printable, standard
from plan_cutters.report.drawing.tool_notes import Note, Span, across, description, facts_of, notes_of, spans_of
from plan_cutters.report.drawing.tool_sheet import ARROW, FONT, LINE, Point, Sheet, at, length, width_of, wrapped

#: A4 upright, its margin, and what stands around the view: room for arrows below the tip and for the axis above the end.
_PAGE, _MARGIN, _BELOW, _ABOVE = (210.0, 297.0), 9.0, 15.0, 6.0
#: Distance of dimension lines; of the view from what stands beside it; room for leaders; least width of a sheet.
_COLUMN, _GAP, _LEADER, _LEAST = 6.5, 5.0, 9.0, 112.0
#: The enlarged cutting end, room for words below it, and what is drawn smaller than this asks for it.
_DETAIL, _LABELS, _SMALL = (44.0, 40.0), 6.0, 6.0
#: Letters of the id, most lines of names and of ids.
_FINE, _NAMES, _IDS = 2.2, 2, 3
#: Parts whose lengths the notes tell as well.
_NOTED = ("flutes", "neck", "shank")
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
    """A tool assembly as an SVG drawing.

    It is drawn upright, its tip at the bottom, 1:1 where that fits an A4 sheet, else in the largest standard reduction that
    does; the sheet states which, and is as large on paper as the SVG says. What is small of the cutting end is drawn again,
    enlarged.

    Parameters
    ----------
    cutter : Cutter
    name : str
        The title; the cutter's own name, or its id, if it is left out.

    Returns
    -------
    str
        The `svg` element, without an XML declaration. `data-scale` is mm on paper a mm; paths of the class `part` are the
        silhouettes of flutes, neck, shank and holder.

    Examples
    --------
    >>> "no holder" in draw(Cutter.parse("R6L80"))
    True
    """
    line = outline(cutter)
    title = printable(name or cutter.name or cutter.id)
    notes, spans = notes_of(cutter, line), spans_of(cutter)
    facts = facts_of(cutter)
    sheet = Sheet(title, description(cutter, notes, spans, facts))
    widest = max(width_of(words) for note in notes for words in note.lines)
    high = _PAGE[1] - 2 * _MARGIN - _ABOVE - _BELOW - _block_height(_NAMES, _IDS, len(facts))
    available = _PAGE[0] - 2 * _MARGIN - 2 * _GAP - _LEADER
    scale = _scale(line, spans, available - widest, high)
    if _zoom(cutter, line, scale):
        widest = max(widest, _DETAIL[0] + 12.0)
        scale = _scale(line, spans, available - widest, high)
    zoom = _zoom(cutter, line, scale)
    enlarged = _DETAIL[1] + 2 * LINE if zoom else 0.0
    columns = _columns(spans, scale)
    wide, tall = scale * line.widest, scale * line.height
    right = _MARGIN + len(columns) * _COLUMN + _GAP + 2 * wide + _GAP + _LEADER
    width = max(_LEAST, right + widest + _MARGIN)
    # A sheet is no narrower than its title: the view stands in its middle.
    right = 0.5 * (width + right - widest - _MARGIN)
    top = _MARGIN + _ABOVE
    bottom = top + max(tall + _BELOW, sum(map(_height, notes)) + enlarged)
    view = _View(right - _LEADER - _GAP - wide, top + tall, scale)
    _assembly(sheet, line, view)
    _lengths(sheet, columns, line, view)
    _across(sheet, cutter, view)
    _leaders(sheet, notes, view, wide, (right, top, bottom - enlarged))
    if zoom:
        _detail(sheet, cutter, line, view, zoom, (right, bottom - _DETAIL[1]))
    end = _block(sheet, (title, cutter.id), facts, line.parts, scale, bottom + 3.0, width)
    return sheet.finished(width, end, scale=f"{scale:.10g}")


def _scale(line: Outline, spans: list[Span], wide: float, high: float) -> float:
    """The largest standard scale, 1:1 at most, in which the view fits a width with its dimension lines, and a height."""
    scale = min(1.0, standard(min(wide / (2.0 * line.widest), high / line.height)))
    while 2.0 * scale * line.widest + len(_columns(spans, scale)) * _COLUMN > wide:
        scale = standard(0.9 * scale)
    return scale


def _words(scale: float) -> str:
    return f"{scale:g}:1" if scale >= 1.0 else f"1:{1.0 / scale:g}"


def _columns(spans: list[Span], scale: float) -> list[list[tuple[Span, str]]]:
    """Spans and what is written on them in columns, from the view outwards: short ones first, and none over another's words.

    A span of the cutter too short for its words has its number alone; one that is too short for that is left to the notes.
    """
    columns: list[list[tuple[Span, str]]] = []
    taken: list[list[Point]] = []
    for span in sorted(spans, key=lambda each: each.high - each.low):
        column_width, words = scale * (span.high - span.low), span.words
        if span.name in _NOTED and width_of(words) > column_width:
            words = span.number
            if max(width_of(words), 3.0 * ARROW) > column_width:
                continue
        middle, half = 0.5 * scale * (span.low + span.high), 0.5 * max(column_width, width_of(words) + 1.0)
        mine = (middle - half, middle + half)
        for column, others in zip(columns, taken, strict=True):
            if all(mine[1] <= low + 1e-6 or mine[0] >= high - 1e-6 for low, high in others):
                column.append((span, words))
                others.append(mine)
                break
        else:
            columns.append([(span, words)])
            taken.append([mine])
    return columns


def _height(note: Note) -> float:
    return LINE * len(note.lines) + 0.8


def _silhouette(segments: tuple[Segment, ...], view: _View) -> str:
    """A closed path about the axis."""
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
        sheet.fill(_silhouette(line.of(part), view), part, f"part {part}")
    for height, radius in _edges(line):
        sheet.lines((view((radius, height), -1.0), view((radius, height))), "fine")
    sheet.lines(((view.x, view.y + 4.0), (view.x, view.y - view.scale * line.height - 4.0)), "axis")


def _edges(line: Outline) -> list[Point]:
    """Heights and radii of the circles along which the outline has an edge: seen from the side they are lines across."""
    edges = []
    for below, above in zip(line.segments[:-1], line.segments[1:], strict=True):
        (a, b), (c, d) = below.direction(1.0), above.direction(0.0)
        if abs(a * d - b * c) > _SMOOTH:
            edges.append((below.end[1], below.end[0]))
    return edges


def _lengths(sheet: Sheet, columns: list[list[tuple[Span, str]]], line: Outline, view: _View) -> None:
    """Dimension lines along the axis, in columns left of the view."""
    for i, column in enumerate(columns):
        x = view.x - view.scale * line.widest - _GAP - i * _COLUMN
        for span, words in column:
            low, high = view.y - view.scale * span.low, view.y - view.scale * span.high
            for height, y in ((span.low, low), (span.high, high)):
                sheet.lines(((view.x - view.scale * _radius(line, height) - 0.8, y), (x - 1.2, y)), "fine")
            sheet.between((x, low), (x, high))
            sheet.text(x - 1.0, 0.5 * (low + high), words, anchor="middle", upright=True)


def _radius(line: Outline, height: float) -> float:
    """The largest of an outline at one of its corners' heights."""
    ends = [end for segment in line.segments for end in (segment.start, segment.end)]
    return max((r for r, h in ends if abs(h - height) <= 1e-6), default=0.0)


def _across(sheet: Sheet, cutter: Cutter, view: _View) -> None:
    """The cutting diameter, below the tip."""
    y, r = view.y + 9.0, view.scale * cutter.radius
    for side in (-r, r):
        sheet.lines(((view.x + side, view.y + 0.8), (view.x + side, y + 1.2)), "fine")
    sheet.between((view.x - r, y), (view.x + r, y))
    sheet.text(view.x, y + 3.6, across(cutter.radius), anchor="middle")


def _leaders(sheet: Sheet, notes: list[Note], view: _View, wide: float, margins: tuple[float, float, float]) -> None:
    """Notes right of the view, each at the height of what it is about as nearly as the others let it."""
    from scipy.optimize import isotonic_regression

    x, top, bottom = margins
    notes = sorted(notes, key=lambda note: -note.at[1])
    sizes = [_height(note) for note in notes]
    before = [sum(sizes[:i]) for i in range(len(notes))]
    # Each wants its middle at the height of its point. In order and without overlap, the least squares are isotonic.
    wish = [view(note.at)[1] - 0.5 * size - above for note, size, above in zip(notes, sizes, before, strict=True)]
    slack = max(top, bottom - sum(sizes))
    for note, size, above, start in zip(notes, sizes, before, isotonic_regression(wish).x, strict=True):
        y = above + min(max(float(start), top), slack)
        point = view(note.at)
        elbow = (view.x + wide + 2.0, point[1])
        sheet.lines((point, elbow, (x - 3.0, y + 0.5 * size), (x - 1.0, y + 0.5 * size)), "fine")
        sheet.circle(point, 0.4, "fine", fill="#000")
        for i, words in enumerate(note.lines):
            sheet.text(x, y + LINE * (i + 0.75), words)


def _zoom(cutter: Cutter, line: Outline, scale: float) -> float:
    """The scale of the enlarged cutting end; 0 where nothing of it is small."""
    features = [s for s in line.of("flutes") if s.centre or cutter.shape == "form"]
    if not features:
        return 0.0
    least = min(features, key=lambda s: s.length)
    high = flute_length(cutter) if cutter.shape == "form" else least.end[1]
    zoom = standard(min(_DETAIL[0] / cutter.radius, (_DETAIL[1] - _LABELS) / high))
    return zoom if scale * min(2.0 * cutter.radius, least.length) < _SMALL and zoom > scale else 0.0


def _detail(sheet: Sheet, cutter: Cutter, line: Outline, view: _View, zoom: float, place: Point) -> None:
    """The cutting end, enlarged, right of its axis."""
    x, y = place
    tall = _DETAIL[1] - _LABELS
    near = _View(x, y + tall, zoom)
    sheet.window(x - 0.2, y, _DETAIL[0] + 0.4, tall + 0.4)
    for part in line.parts:
        sheet.fill(_silhouette(line.of(part), near), part, f"detail {part}")
    sheet.window(0, 0, 0, 0)
    sheet.lines(((x, y - 1.0), (x, y + tall + 3.0)), "axis")
    sheet.text(x, y - 2.5, f"A ({_words(zoom)})", bold=True)
    seen = view((0.5 * cutter.radius, 0.5 * tall / zoom))
    radius = max(2.2, math.dist(seen, (view.x, view.y)))
    sheet.circle(seen, radius, "mark")
    sheet.text(seen[0] + 0.75 * radius + 0.6, seen[1] + 0.75 * radius + 2.5, "A", bold=True)
    for segment in line.of("flutes"):
        # The highest of some points of an arc that can be seen.
        points = [share for share in (0.5, 0.25, 0.1) if segment.at(share)[1] <= 0.9 * tall / zoom]
        if segment.centre and points:
            point, (a, b) = near(segment.at(points[0])), segment.direction(points[0])
            end = (point[0] + 5.0 * b, point[1] + 5.0 * a)
            sheet.lines((end, point), "fine")
            sheet.arrow(point, end)
            sheet.text(end[0] + 0.6, end[1] + 1.0, f"R{length(segment.radius)}")


def _block_height(names: int, ids: int, facts: int) -> float:
    return 4.5 * names + 3.0 * ids + LINE * facts + LINE + 8.0


def _block(
    sheet: Sheet, names: tuple[str, str], facts: list[str], parts: tuple[AnyPart, ...], scale: float, top: float, width: float
) -> float:
    """The title block: name, id, scale, what is true of the whole, and which fill is which part; returns where it ends."""
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
    scale_words = f"scale {_words(scale)}, in mm"
    for i, words in enumerate(facts):
        y += LINE
        fact = wrapped(words, available - (width_of(scale_words) + 4.0 if i == 0 else 0.0), FONT, 1)
        sheet.text(left, y, "".join(fact))
        if i == 0:
            sheet.text(width - _MARGIN, y, scale_words, anchor="end", bold=True)
    y += LINE + 2.0
    x = left
    for part in parts:
        sheet.fill(f"M{at((x, y - 3.0))}h7v3.6h-7Z", part, "legend")
        sheet.text(x + 8.5, y, part)
        x += 8.5 + width_of(part) + 5.0
    y += 8.0
    sheet.path(f"M4 4H{width - 4.0:.4f}V{y - 4.0:.4f}H4Z", "frame")
    return y
