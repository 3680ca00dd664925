"""A tool assembly drawn to scale: SVG that prints to size on A4."""

import math
from collections.abc import Iterable
from typing import NamedTuple
from xml.sax.saxutils import escape

from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.outline import Outline, Point, Segment, outline
from plan_cutters.domain.shapes import SAME, flank, flute_length, stages, top_radius
from plan_cutters.report.drawing.posture_map import printable, standard

#: All in mm of paper. Height of letters and distance between lines of text; a letter is no wider than this share of its height.
FONT, LINE, _LETTER = 2.8, 4.0, 0.6
#: Width of A4 and its margin; where the view begins, and the most that it is high.
_WIDTH, _MARGIN, _TOP, _HIGH = 210.0, 9.0, 18.0, 222.0
#: Distance of dimension lines; of the view from what stands beside it; room for leaders and for words below it.
_COLUMN, _GAP, _LEADER, _BELOW = 6.5, 5.0, 14.0, 18.0
#: Letters of a name, an id or a fact; points of a form that stand beside its picture.
_LETTERS, _POINTS = 50, 12
#: Directions closer to each other than this have no edge between them, rad.
_SMOOTH = 1e-4

#: A note names each part: colours only help.
FILLS = {"flutes": "#FFD27A", "neck": "#FFF6DD", "shank": "#D9D9D9", "holder": "#BBD5EA"}


class Note(NamedTuple):
    """Words beside the view about what lies at a point of the outline."""

    at: Point
    lines: list[str]


def length(value: float) -> str:
    return f"{value:.6g}"


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
    facts = [f"holder: {printable(name, _LETTERS)}" if name else "a holder without a name" if cutter.holder else "no holder"]
    facts += [f"allowance {length(cutter.allowance)} on the surface, not shown"] if cutter.allowance else []
    clearance = [f"clearance {length(cutter.clearance)} of neck, shank and holder, not shown"] if cutter.clearance else []
    return facts + clearance


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
    its id. Paths of the class `part` are the silhouettes of flutes, neck, shank and holder.

    >>> "no holder" in draw(Cutter.parse("R6L80"))
    True
    """
    line, heights, facts = outline(cutter), heights_of(cutter), facts_of(cutter)
    notes = notes_of(cutter, line)
    title = printable(name or cutter.name or cutter.id, _LETTERS)
    left = _MARGIN + len(heights) * _COLUMN + _GAP
    right = _WIDTH - _MARGIN - max(_LETTER * FONT * len(words) for note in notes for words in note.lines)
    scale = min(1.0, standard(min((right - _LEADER - left) / (2.0 * line.widest), _HIGH / line.height)))
    view = _View(0.5 * (left + right - _LEADER), _TOP + scale * line.height, scale)
    drawn = [*_dimensions(heights, line, view), *_assembly(line, view), *_leaders(notes, line, view, right)]
    y = max(view.y, _TOP + LINE * sum(len(note.lines) for note in notes)) + _BELOW
    for words in dict.fromkeys((title, printable(cutter.id, _LETTERS), *facts, f"scale 1:{1 / scale:g}, in mm")):
        drawn.append(_text(_MARGIN, y, words))
        y += LINE
    high = length(y + _MARGIN - LINE)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" role="img" width="{_WIDTH:g}mm" height="{high}mm" '
        f'viewBox="0 0 {_WIDTH:g} {high}" stroke="#000" stroke-width="0.13" fill="none" font-family="Arial, sans-serif">'
        f'<title>{escape(title)}</title><rect width="100%" height="100%" fill="#fff" stroke="none"/>{"".join(drawn)}</svg>\n'
    )


def _at(point: Point) -> str:
    return f"{length(point[0])} {length(point[1])}"


def _line(points: Iterable[Point], more: str = "") -> str:
    return f'<path d="M{"L".join(map(_at, points))}"{more}/>'


def _text(x: float, y: float, words: str, more: str = 'text-anchor="start"') -> str:
    return f'<text x="{length(x)}" y="{length(y)}" font-size="{FONT}" fill="#000" stroke="none" {more}>{escape(words)}</text>'


def _assembly(line: Outline, view: _View) -> Iterable[str]:
    for part in line.parts:
        segments = line.of(part)
        path = ["M" + _at(view(segments[0].start)), *(_side(segment, view, segment.end) for segment in segments)]
        path.append("L" + _at(view(segments[-1].end, -1.0)))
        path += [_side(segment, view, segment.start, -1.0) for segment in reversed(segments)]
        yield f'<path class="part {part}" d="{"".join(path)}Z" fill="{FILLS[part]}" stroke-width="0.35" stroke-linejoin="round"/>'
    for below, above in zip(line.segments[:-1], line.segments[1:], strict=True):
        # Circles along which the outline has an edge: seen from the side they are lines across.
        (a, b), (c, d) = below.direction(1.0), above.direction(0.0)
        if abs(a * d - b * c) > _SMOOTH:
            yield _line((view(below.end, -1.0), view(below.end)))
    yield _line(((view.x, view.y + 4.0), (view.x, view.y - view.scale * line.height - 4.0)), ' stroke-dasharray="6 1.2 0.6 1.2"')


def _side(segment: Segment, view: _View, to: Point, side: float = 1.0) -> str:
    if segment.centre is None:
        return "L" + _at(view(to, side))
    radius = length(view.scale * segment.radius)
    return f"A{radius} {radius} 0 {int(abs(segment.turn) > math.pi)} {int(segment.turn < 0)} {_at(view(to, side))}"


def _dimensions(heights: dict[str, float], line: Outline, view: _View) -> Iterable[str]:
    """Dimension lines from the tip up, left of the view, with lines to the axis that the assembly lies over."""
    for i, (name, height) in enumerate(heights.items()):
        x, high = view.x - view.scale * line.widest - _GAP - i * _COLUMN, view.y - view.scale * height
        for y in (view.y, high):
            yield _line(((x - 1.2, y), (view.x, y)))
            yield _line(((x - 0.8, y + 0.8), (x + 0.8, y - 0.8)))
        yield _line(((x, view.y), (x, high)))
        x, y = x - 1.0, 0.5 * (view.y + high)
        yield _text(x, y, f"{name} {length(height)}", f'text-anchor="middle" transform="rotate(-90 {_at((x, y))})"')


def _leaders(notes: list[Note], line: Outline, view: _View, x: float) -> Iterable[str]:
    """Notes right of the view from the top down, each as near to the height of its point as the others let it."""
    notes = sorted(notes, key=lambda note: -note.at[1])
    below = LINE * sum(len(note.lines) for note in notes)
    y, bottom = _TOP, max(view.y, _TOP + below)
    for note in notes:
        point, size = view(note.at), LINE * len(note.lines)
        y = max(y, min(point[1] - 0.5 * size, bottom - below))
        middle = y + 0.5 * size
        yield _line((point, (view.x + view.scale * line.widest + 2.0, point[1]), (x - 3.0, middle), (x - 1.0, middle)))
        yield from (_text(x, y + LINE * (i + 0.75), words) for i, words in enumerate(note.lines))
        y, below = y + size, below - size
