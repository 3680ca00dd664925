"""Write the notes on the drawing of a tool assembly: dimensions of its parts, lengths along its axis, and all in one text."""

import math
from typing import NamedTuple

from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.outline import Outline, Point
from plan_cutters.domain.shapes import SAME, flank, flute_length, stages, top_radius
from plan_cutters.report.drawing.sheet import printable
from plan_cutters.report.drawing.tool_sheet import length

#: Most points of a form that stand beside its picture.
_POINTS = 12


class Note(NamedTuple):
    """Words beside the view about what lies at a point of the outline."""

    at: Point
    lines: list[str]


class Span(NamedTuple):
    """A length along the axis, between two heights."""

    low: float
    high: float
    name: str

    @property
    def number(self) -> str:
        return length(self.high - self.low)

    @property
    def words(self) -> str:
        return f"{self.name} {self.number}"


def across(radius: float, upper: float | None = None) -> str:
    words = f"Ø{length(2 * radius)}"
    return words if upper is None or upper == radius else f"{words} to Ø{length(2 * upper)}"


def notes_of(cutter: Cutter, line: Outline) -> list[Note]:
    """Write a note on each part and segment, from the tip upwards."""
    flutes = max((s for s in line.of("flutes") if s.end[1] > s.start[1]), key=lambda s: s.end[1] - s.start[1])
    notes = [Note(flutes.at(0.5), _cutting(cutter))]
    holder = 0
    for part, low, stage in stages(cutter):
        holder += part == "holder"
        which = f"holder {holder}" if part == "holder" and cutter.holder and len(cutter.holder.stages) > 1 else part
        middle = 0.5 * (stage.radius + stage.upper_radius), low + 0.5 * stage.length
        words = f"{which} {across(stage.radius, stage.upper_radius)} × {length(stage.length)}"
        notes.append(Note(middle, [words]))
    return notes


def _cutting(cutter: Cutter) -> list[str]:
    """The dimensions of the cutting part."""
    corner = cutter.corner_radius
    lines = [f"flutes {across(cutter.radius)} × {length(flute_length(cutter))}"]
    if cutter.shape == "lollipop":
        lines.append(f"ball R{length(corner)}")
    elif cutter.shape == "barrel":
        lines.append(f"flank R{length(cutter.arc_radius)}")
        lines.append(f"widest {length(cutter.arc_height)} over the tip")
        lines.append(f"tip R{length(corner)}" if corner else f"flat tip {across(flank(cutter, 0.0))}")
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
    return lines


def spans_of(cutter: Cutter) -> list[Span]:
    top, spans = flute_length(cutter), []
    if stages(cutter):
        spans.append(Span(0.0, top, "flutes"))
    spans += [Span(low, low + stage.length, part) for part, low, stage in stages(cutter) if part != "holder"]
    spans.append(Span(0.0, cutter.length, "stick-out" if cutter.holder else "length"))
    if cutter.holder:
        end = cutter.length + sum(stage.length for stage in cutter.holder.stages)
        spans += [Span(cutter.length, end, "holder"), Span(0.0, end, "overall")]
    return spans


def facts_of(cutter: Cutter) -> list[str]:
    """List the facts of the whole assembly: its holder, allowance and clearance."""
    holder = "no holder"
    if cutter.holder:
        holder = f"holder: {printable(cutter.holder.name)}" if cutter.holder.name else "a holder without a name"
    facts = [holder]
    if cutter.allowance:
        facts.append(f"allowance {length(cutter.allowance)} on the surface, not shown")
    if cutter.clearance:
        facts.append(f"clearance {length(cutter.clearance)} of neck, shank and holder, not shown")
    return facts


def description(cutter: Cutter, notes: list[Note], spans: list[Span], facts: list[str]) -> str:
    """All of it in words, for whoever sees no picture; nothing is left out here."""
    form = "; ".join(f"{across(r)} at height {length(h)}" for r, h in cutter.outline)
    lines = [f"Tool assembly {cutter.id}, in mm, from the tip up", *(", ".join(note.lines) for note in notes)]
    return "; ".join([*lines, *(span.words for span in spans), *facts, *([form] if form else [])]) + "."
