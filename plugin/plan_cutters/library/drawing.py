"""A tool assembly drawn to scale: one sheet of SVG that holds all it needs and prints to size on A4."""

import math
from typing import NamedTuple

from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.outline import AnyPart, Outline, Segment, outline
from plan_cutters.domain.shapes import flank, flute_length, stages, top_radius
from plan_cutters.library.sheet import FONT, LINE, Point, Sheet, at, legible, length, width_of, wrapped

#: A4 upright, its margin, and what stands around the view: room for arrows below the tip and for the axis above the end.
_PAGE, _MARGIN, _BELOW, _ABOVE = (210.0, 297.0), 9.0, 15.0, 6.0
#: Distance of dimension lines; of the view from what stands beside it; room for leaders; least width of a sheet.
_COLUMN, _GAP, _LEADER, _LEAST = 6.5, 5.0, 9.0, 112.0
#: The enlarged cutting end, and what is drawn smaller than this asks for it.
_DETAIL, _SMALL = (44.0, 40.0), 6.0
#: Letters of the id, most lines of names and ids, most points of a form that are written out.
_FINE, _NAMES, _IDS, _POINTS = 2.2, 2, 3, 12
#: Directions closer to each other than this have no edge between them, rad.
_SMOOTH = 1e-4


class _Note(NamedTuple):
    """Words beside the view about what lies at a point of the outline."""

    at: Point
    lines: list[str]


class _Span(NamedTuple):
    """A length along the axis, between two heights."""

    low: float
    high: float
    words: str


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
    >>> draw(Cutter.parse("R6L80")).count("no holder")
    3
    """
    line = outline(cutter)
    title = legible(name or cutter.name or cutter.id)
    notes, spans = _notes(cutter, line), _spans(cutter)
    facts = _facts(cutter)
    sheet = Sheet(title, _description(cutter, notes, spans, facts))
    columns = _columns(spans, 1.0)
    beside = max(width_of(words) for note in notes for words in note.lines)
    room = _PAGE[0] - 2 * _MARGIN - 2 * _GAP - _LEADER - len(spans) * _COLUMN - beside
    high = _PAGE[1] - 2 * _MARGIN - _ABOVE - _BELOW - _block_height(_NAMES, _IDS, len(facts))
    scale = min(1.0, _standard(min(room / (2.0 * line.widest), high / line.height)))
    columns = _columns(spans, scale)
    wide, tall = scale * line.widest, scale * line.height
    zoom = _zoom(cutter, line, scale)
    shown = _fitting(notes, high - (_DETAIL[1] + 2 * LINE if zoom else 0.0))
    listed = sum(_height(note) for note in shown) + (_DETAIL[1] + 2 * LINE if zoom else 0.0)
    left, top = _MARGIN + len(columns) * _COLUMN + _GAP, _MARGIN + _ABOVE
    right = left + 2 * wide + _GAP + _LEADER
    width = max(_LEAST, right + max(beside, _DETAIL[0] + 12.0 if zoom else 0.0) + _MARGIN)
    # A narrow sheet is no narrower than its title: the view stands in its middle.
    shift = 0.5 * (width - right - max(beside, _DETAIL[0] if zoom else 0.0) - _MARGIN)
    bottom = top + max(tall, listed - _BELOW)
    view = _View(left + wide + shift, top + tall, scale)
    _assembly(sheet, line, view)
    _lengths(sheet, columns, cutter, view, wide)
    _across(sheet, cutter, view)
    place = (right + shift, bottom + _BELOW - _DETAIL[1]) if zoom else (right + shift, bottom + _BELOW)
    _leaders(sheet, shown, view, wide, (right + shift, top, place[1] - (2 * LINE if zoom else 0.0)))
    if zoom:
        _detail(sheet, cutter, line, view, zoom, place)
    foot = bottom + _BELOW + 3.0
    end = _block(sheet, (title, cutter.id), facts, line.parts, scale, foot, width)
    return sheet.finished(width, end, scale=f"{scale:.10g}")


def _standard(most: float) -> float:
    """The largest standard scale that is no larger: 1, 2 or 5 times a power of ten."""
    power = 10.0 ** math.floor(math.log10(most))
    return max(step * power for step in (0.5, 1.0, 2.0, 5.0) if step * power <= most * (1.0 + 1e-9))


def _words(scale: float) -> str:
    return f"{scale:g}:1" if scale >= 1.0 else f"1:{1.0 / scale:g}"


def _across_words(radius: float, upper: float | None = None) -> str:
    words = f"Ø{length(2 * radius)}"
    return words if upper is None or upper == radius else f"{words} to Ø{length(2 * upper)}"


def _notes(cutter: Cutter, line: Outline) -> list[_Note]:
    """What is said of each part and stage, from the tip up."""
    flutes = max((s for s in line.of("flutes") if s.end[1] > s.start[1]), key=lambda s: s.end[1] - s.start[1])
    found = [_Note(flutes.at(0.5), _cutting(cutter))]
    holder = 0
    for part, low, stage in stages(cutter):
        holder += part == "holder"
        which = f"holder {holder}" if part == "holder" and cutter.holder and len(cutter.holder.stages) > 1 else part
        middle = 0.5 * (stage.radius + stage.upper_radius), low + 0.5 * stage.length
        words = f"{which} {_across_words(stage.radius, stage.upper_radius)} × {length(stage.length)}"
        found.append(_Note(middle, [words]))
    return found


def _cutting(cutter: Cutter) -> list[str]:
    """The dimensions of the cutting part."""
    corner = cutter.corner_radius
    lines = [f"flutes {_across_words(cutter.radius)} × {length(flute_length(cutter))}"]
    if cutter.shape == "lollipop":
        lines.append(f"ball R{length(corner)}")
    elif cutter.shape == "barrel":
        lines.append(f"flank R{length(cutter.arc_radius)}")
        lines.append(f"widest {length(cutter.arc_height)} over the tip")
        lines.append(f"tip R{length(corner)}" if corner else f"flat tip {_across_words(flank(cutter, 0.0))}")
    elif cutter.shape == "lens":
        lines += [f"bottom R{length(cutter.arc_radius)}", f"corner R{length(corner)}"]
    elif cutter.shape == "form":
        points = cutter.outline
        lines.append(f"form of {len(points)} points: Ø at height")
        lines += [f"{_across_words(r)} at {length(h)}" for r, h in points[:_POINTS]]
        lines += [f"… and {len(points) - _POINTS} more"] if len(points) > _POINTS else []
    else:
        ball = f"ball R{length(corner)}" if corner == cutter.radius else f"corner R{length(corner)}"
        lines.append(ball if corner else "flat, sharp corner")
        if cutter.taper:
            angle = length(math.degrees(abs(cutter.taper)))
            lines.append(f"{'taper' if cutter.taper > 0 else 'undercut'} {angle}° (half angle)")
    if abs(top_radius(cutter) - cutter.radius) > 1e-9 and cutter.shape in ("end", "barrel"):
        lines.append(f"{_across_words(top_radius(cutter))} where the flutes end")
    return lines


def _spans(cutter: Cutter) -> list[_Span]:
    top, found = flute_length(cutter), []
    if stages(cutter):
        found.append(_Span(0.0, top, "flutes"))
    found += [_Span(low, low + stage.length, part) for part, low, stage in stages(cutter) if part != "holder"]
    found.append(_Span(0.0, cutter.length, "stick-out" if cutter.holder else "length"))
    if cutter.holder:
        end = cutter.length + sum(stage.length for stage in cutter.holder.stages)
        found += [_Span(cutter.length, end, "holder"), _Span(0.0, end, "overall")]
    found = list({(span.low, span.high): span for span in reversed(found)}.values())
    return [span._replace(words=f"{span.words} {length(span.high - span.low)}") for span in found]


def _columns(spans: list[_Span], scale: float) -> list[list[_Span]]:
    """Spans in columns, from the view outwards: short ones first, and none over the words of another."""
    columns: list[list[_Span]] = []
    taken: list[list[tuple[float, float]]] = []
    for span in sorted(spans, key=lambda each: each.high - each.low):
        middle = 0.5 * scale * (span.low + span.high)
        half = 0.5 * max(scale * (span.high - span.low), width_of(span.words) + 1.0)
        mine = (middle - half, middle + half)
        for column, others in zip(columns, taken, strict=True):
            if all(mine[1] <= low + 1e-6 or mine[0] >= high - 1e-6 for low, high in others):
                column.append(span)
                others.append(mine)
                break
        else:
            columns.append([span])
            taken.append([mine])
    return columns


def _facts(cutter: Cutter) -> list[str]:
    """What is true of the whole."""
    holder = "no holder"
    if cutter.holder:
        holder = f"holder: {legible(cutter.holder.name)}" if cutter.holder.name else "with its holder"
    found = [holder]
    if cutter.allowance:
        found.append(f"allowance {length(cutter.allowance)} on the surface, not drawn")
    if cutter.clearance:
        found.append(f"clearance {length(cutter.clearance)} of neck, shank and holder, not drawn")
    return found


def _description(cutter: Cutter, notes: list[_Note], spans: list[_Span], facts: list[str]) -> str:
    """All of it in words, for whoever sees no picture; nothing is left out here."""
    form = "; ".join(f"{_across_words(r)} at height {length(h)}" for r, h in cutter.outline)
    said = [f"Tool assembly {cutter.id}, in mm, from the tip up", *(", ".join(note.lines) for note in notes)]
    return "; ".join([*said, *(span.words for span in spans), *facts, *([form] if form else [])]) + "."


def _height(note: _Note) -> float:
    return LINE * len(note.lines) + 0.8


def _fitting(notes: list[_Note], room: float) -> list[_Note]:
    """The notes for which there is room, from the tip up, and how many there are besides."""
    if sum(map(_height, notes)) <= room:
        return notes
    count = 1
    while count < len(notes) and sum(map(_height, notes[: count + 1])) + LINE <= room:
        count += 1
    rest = _Note(notes[count].at, [f"… {len(notes) - count} more stages: see the description"])
    return [*notes[:count], rest]


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
    found = []
    for below, above in zip(line.segments[:-1], line.segments[1:], strict=True):
        (a, b), (c, d) = below.direction(1.0), above.direction(0.0)
        if abs(a * d - b * c) > _SMOOTH:
            found.append((below.end[1], below.end[0]))
    return found


def _lengths(sheet: Sheet, columns: list[list[_Span]], cutter: Cutter, view: _View, wide: float) -> None:
    """Dimension lines along the axis, in columns left of the view."""
    line = outline(cutter)
    for i, column in enumerate(columns):
        x = view.x - wide - _GAP - i * _COLUMN
        for span in column:
            low, high = view.y - view.scale * span.low, view.y - view.scale * span.high
            for height, y in ((span.low, low), (span.high, high)):
                sheet.lines(((view.x - view.scale * _radius(line, height) - 0.8, y), (x - 1.2, y)), "fine")
            sheet.between((x, low), (x, high))
            sheet.text(x - 1.0, 0.5 * (low + high), span.words, anchor="middle", upright=True)


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
    sheet.text(view.x, y + 3.6, _across_words(cutter.radius), anchor="middle")


def _leaders(sheet: Sheet, notes: list[_Note], view: _View, wide: float, room: tuple[float, float, float]) -> None:
    """Notes right of the view, each at the height of what it is about as nearly as the others let it."""
    from scipy.optimize import isotonic_regression

    x, top, bottom = room
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
    flutes = line.of("flutes")
    least = min([2.0 * cutter.radius, *(s.length for s in flutes if s.centre or cutter.shape == "form")])
    high = max((s.end[1] for s in flutes if s.centre), default=cutter.radius)
    if cutter.shape == "form":
        high = flute_length(cutter)
    found = _standard(min(_DETAIL[0] / max(s.widest for s in flutes), _DETAIL[1] / high))
    return found if scale * least < _SMALL and found > scale else 0.0


def _detail(sheet: Sheet, cutter: Cutter, line: Outline, view: _View, zoom: float, place: Point) -> None:
    """The cutting end, enlarged, right of its axis."""
    x, y = place
    near = _View(x, y + _DETAIL[1] - 3.0, zoom)
    sheet.window(x - 0.2, y, _DETAIL[0], _DETAIL[1] - 2.5)
    for part in line.parts:
        sheet.fill(_silhouette(line.of(part), near), part, f"detail {part}")
    sheet.window(0, 0, 0, 0)
    sheet.lines(((x, y - 1.0), (x, y + _DETAIL[1])), "axis")
    sheet.text(x, y - 2.5, f"A ({_words(zoom)})", bold=True)
    seen = max(1.6, 0.5 * view.scale * _DETAIL[1] / zoom)
    sheet.circle((view.x, view.y - 0.6 * seen), 1.2 * seen, "mark")
    sheet.text(view.x - 1.2 * seen - 1.0, view.y - 0.6 * seen, "A", anchor="end", bold=True)
    for segment in line.of("flutes"):
        if segment.centre:
            point, (a, b) = near(segment.at(0.5)), segment.direction(0.5)
            end = (point[0] + 5.0 * b, point[1] + 5.0 * a)
            sheet.lines((end, point), "fine")
            sheet.arrow(point, end)
            sheet.text(end[0] + 0.6, end[1] + 1.0, f"R{length(segment.radius)}")


def _block_height(names: int, ids: int, facts: int) -> float:
    return 4.5 * names + 3.0 * ids + LINE * facts + LINE + 8.0


def _block(sheet: Sheet, names: tuple[str, str], facts: list[str], parts: tuple[AnyPart, ...], scale: float, top: float,
           width: float) -> float:  # fmt: skip
    """The title block: name, id, scale, what is true of the whole, and which fill is which part; returns where it ends."""
    left, room = _MARGIN, width - 2 * _MARGIN
    title, id_ = names
    lines = wrapped(title, room, 3.6, _NAMES, bold=True)
    ids = wrapped(id_, room, _FINE, _IDS) if id_ != title else []
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
        fact = wrapped(words, room - (width_of(scale_words) + 4.0 if i == 0 else 0.0), FONT, 1)
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
