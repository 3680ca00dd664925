"""Make the shapes of a result that a host shows: kernel shapes with names and colours, in groups."""

import itertools
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from cad_io import Part
from cad_io.arrays import Floats
from cad_io.kernel.shapes import Side, of_triangles, placed, revolved
from plan_cutters.domain.checks import shown as written
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.outline import outline
from plan_cutters.domain.travel import tips
from plan_cutters.domain.verdicts import UNDECIDED, blank
from plan_cutters.errors import OptionError
from plan_cutters.plan_file.model import WitnessEntry
from plan_cutters.plan_file.reasons import rgb
from plan_cutters.report.models import product, split_result, styles, verdict_of
from plan_cutters.report.page.arrays import row_of
from plan_cutters.result import Result

Colour = tuple[float, float, float]
#: Parts of a tool assembly, from light to dark up to the holder.
_TOOL: dict[str, Colour] = {
    "flutes": (0.85, 0.78, 0.35),
    "neck": (0.72, 0.72, 0.74),
    "shank": (0.62, 0.62, 0.66),
    "holder": (0.36, 0.37, 0.42),
}


@dataclass(frozen=True, slots=True)
class Shown:
    """A shape of the kernel in part coordinates, with a name that no other one has, and sRGB, 0 to 1."""

    shape: Any
    name: str
    colour: Colour


def shown(
    result: Result, at: int | WitnessEntry | None = None, cutter: str | None = None
) -> tuple[str, dict[str, tuple[Shown, ...]]]:
    """The part's name, and groups of what is to be seen: targets by verdict, check faces, ignored faces, fixtures, the tool.

    `at` is a sample, by its row, or a witness of the plan: there the tool is put, at the posture found or the best one tried; an
    OptionError where none is known. `cutter`: the id of the one whose verdicts and tool are shown, or the result's own choice.
    """
    names = _Names()
    roots = result.part.tree
    name = names.of((len(roots) == 1 and roots[0].name) or product(result))
    groups: dict[str, list[Shown]] = {word: [] for word in ("targets", "check faces", "ignored faces", "fixtures")}
    for word in groups:
        names.of(word)
    tool = result.judged(cutter)
    split, style = split_result(result, tool.id), styles(result)
    for piece in split.pieces:
        title, colour, _ = style(piece)
        group = {"check": "check faces", "ignored": "ignored faces"}.get(verdict_of(piece), "targets")
        groups[group].append(Shown(piece.shape, names.of(title), colour))
    for each in result.conditions.surroundings.fixtures:
        if isinstance(each.source, Part):
            shape = placed(each.source.shape, np.column_stack([each.fixture.rotation, each.fixture.shift]))
        else:
            shape = of_triangles(each.shown)
        groups["fixtures"].append(Shown(shape, names.of(each.name), rgb("fixture")))
    filled = {word: tuple(each) for word, each in groups.items() if each}
    if at is not None:
        tip, axis = _posture(result, tool, at)
        filled[names.of(f"tool {tool.id}")] = tuple(_tool(tool, tip, axis, names))
    return name, filled


class _Names(set[str]):
    """Names that are each used once; a path has no slash within a name."""

    def of(self, wanted: str) -> str:
        base = wanted.replace("/", "_")
        name = next(name for k in itertools.count(1) if (name := base if k == 1 else f"{base} {k}") not in self)
        self.add(name)
        return name


def _posture(result: Result, cutter: Cutter, at: int | WitnessEntry) -> tuple[Floats, Floats]:
    samples, reach = result.samples, result.reaches[cutter.id]
    if isinstance(at, WitnessEntry):
        if at.best_posture is None:
            raise OptionError(f"no posture is within the axis limits at {at.face}: there is none to show")
        try:
            row = row_of(samples, at)
        except ValueError as error:
            raise OptionError(str(error)) from None
        axis, tilt, normal = np.array(at.best_posture.axis), np.radians(at.best_posture.tilt), samples.normal[row]
        tilt_direction = axis - (axis @ normal) * normal
        size = float(np.linalg.norm(tilt_direction))
        if size < 1e-9:
            # Upright it says where under the tool the sample is.
            own = reach.tilt_direction[row]
            tilt_direction, size = (own if tilt == 0.0 and np.isfinite(own).all() else samples.direction_max[row]), 1.0
        one = blank(1)
        one.axis[0], one.tilt_direction[0], one.tilt[0] = axis, tilt_direction / size, tilt
        posture = one.freeze()
    else:
        row = _row(at, len(samples))
        posture = reach.of(np.array([row]))
        if not np.isfinite(posture.tilt[0]):
            what = "undecided" if posture.verdict[0] == UNDECIDED else "not reached"
            raise OptionError(
                f"sample {row} is {what} with {cutter.id}, so no posture is known there: give a witness of the plan, as "
                "result.face(...).worst"
            )
    tip = tips(cutter, samples.point[row : row + 1], samples.normal[row : row + 1], posture)[0]
    if not np.isfinite(tip).all():
        tilt = np.degrees(posture.tilt[0])
        raise OptionError(f"{cutter.id} cannot touch at a tilt of {tilt:.3g} deg: there is nothing to show")
    return tip, posture.axis[0]


def _row(value: Any, count: int) -> int:
    if isinstance(value, bool) or not isinstance(value, int | np.integer) or not -count <= value < count:
        raise OptionError(f"at must be the row of a sample, 0 to {count - 1}, or a witness, not {written(value)}")
    return int(value) % count


def _tool(cutter: Cutter, tip: Floats, axis: Floats, names: _Names) -> Iterator[Shown]:
    across = np.eye(3)[int(np.abs(axis).argmin())]
    x = np.cross(across, axis)
    x /= np.linalg.norm(x)
    place = np.column_stack([x, np.cross(axis, x), axis, tip])
    whole = outline(cutter)
    for part in whole.parts:
        mine = whole.of(part)
        (_, low), (_, high) = mine[0].start, mine[-1].end
        sides = [Side(mine[0].start), *(Side(s.end, s.at(0.5) if s.centre else None) for s in mine)]
        ends, at = [], (0.0, low)
        for side in [*sides, Side((0.0, high)), Side((0.0, low))]:
            if np.hypot(side.end[0] - at[0], side.end[1] - at[1]) > 1e-9:
                ends.append(side)
                at = side.end
        if high - low > 1e-9:
            yield Shown(placed(revolved((0.0, low), ends), place), names.of(part), _TOOL[part])
