"""From the axes that a file lists to a machine: units, limits and signs."""

import math
import os
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import Any, NamedTuple

from plan_cutters.domain.checks import finite, shown
from plan_cutters.domain.machine import Axis, Carried, Machine, X, Y, Z
from plan_cutters.errors import MachineError
from plan_cutters.files.content import Content

#: How the two senses of an axis that carries the part are called after `FILE#`.
TABLE, TOOL = "table", "tool-relative"


def opened(path: str | os.PathLike[str]) -> Content:
    """Read a file that may be a machine file."""
    return Content.of(path, "machine file", MachineError)


class Added(NamedTuple):
    """The user adds these facts to a machine's file, where the file leaves them open."""

    #: Names of rotary axes: those that carry the part, the one next to the part first; those that carry the tool, the one next
    #: to the tool last.
    part: tuple[str, ...] = ()
    tool: tuple[str, ...] = ()
    #: `table`: positive angles of axes that carry the part are those of the table's own motion; `tool-relative`: of the tool
    #: relative to the part, as in ISO 841; empty where nothing is said.
    sign: str = ""

    @property
    def order(self) -> tuple[str, ...]:
        """Names of rotary axes from the part to the tool."""
        return self.part + self.tool

    @property
    def text(self) -> str:
        """How it was said."""
        order = ",".join(self.part) + ("/" + ",".join(self.tool) if self.tool else "")
        return ",".join(word for word in (order, self.sign) if word)

    @classmethod
    def parse(cls, text: str) -> "Added":
        """Read what stands after `FILE#`, as `C,A`, `C/B`, `table` or `C,A,table`.

        >>> Added.parse("C/B,table")
        Added(part=('C',), tool=('B',), sign='table')
        """
        words, sign = [], ""
        for word in text.split(","):
            if word.strip().lower() in (TABLE, TOOL):
                sign = word.strip().lower()
            else:
                words.append(word.strip())
        part, _, tool = ",".join(words).partition("/")
        sides = [tuple(word.strip().upper() for word in side.split(",") if word.strip()) for side in (part, tool)]
        names = sides[0] + sides[1]
        if not (names or sign) or len(set(names)) < len(names) or not all(name.isalnum() for name in names):
            raise MachineError(
                f"{shown('#' + text)} says nothing of a machine: give its rotary axes from the part to the tool, as #C,A, or "
                f"#C/B where C carries the part and B the tool; or how angles of a table are counted, #{TABLE} or #{TOOL}"
            )
        return cls(sides[0], sides[1], sign)

    def refuse(self, name: str, *, order: bool = False, sign: bool = False) -> None:
        """An error where something is said that the file says itself."""
        if (order and self.order) or (sign and self.sign):
            what = "the order of its axes" if order and self.order else "how its angles are counted"
            raise MachineError(f"it says {what} itself: leave out #{self.text}", file=name)


Vector = tuple[float, float, float]

#: mm.
LENGTHS = {
    "mm": 1.0, "millimeter": 1.0, "millimeters": 1.0, "millimetre": 1.0, "metric": 1.0,
    "cm": 10.0, "centimeter": 10.0, "m": 1000.0, "meter": 1000.0,
    "inch": 25.4, "inches": 25.4, "in": 25.4, "imperial": 25.4,
}  # fmt: skip
#: rad.
ANGLES = {
    "deg": math.pi / 180.0, "degree": math.pi / 180.0, "degrees": math.pi / 180.0,
    "rad": 1.0, "radian": 1.0, "radians": 1.0,
    "grad": math.pi / 200.0, "gon": math.pi / 200.0, "revolution": 2.0 * math.pi,
}  # fmt: skip
#: Directions by the names of ISO 841.
ISO = {"X": X, "Y": Y, "Z": Z, "A": X, "B": Y, "C": Z}
#: Limits of one axis that are both turned back to front are the same up to this, rad.
_EVEN = 1e-9


def unit(value: Any, known: dict[str, float], what: str) -> float:
    """The size of a unit, which must be said."""
    if value is None or value == "":
        raise MachineError(f"{what} is missing: say one of {', '.join(list(known)[:5])}")
    result = known.get(value.strip().lower()) if isinstance(value, str) else None
    if result is None:
        raise MachineError(f"{what} {shown(value)} is not known")
    return result


def scaled(value: float, size: float) -> float:
    """A number in another unit; degrees as `math.radians` turns them."""
    return math.radians(value) if size == math.pi / 180.0 else value * size


#: A finite number of a file; a text is none.
real = partial(finite, error=MachineError)


def vector(value: Any, what: str) -> Vector:
    """Three finite numbers of a file."""
    if not isinstance(value, list | tuple) or len(value) != 3:
        raise MachineError(f"{what} must be three numbers, not {shown(value)}")
    x, y, z = (real(each, what) for each in value)
    return x, y, z


def opposite(direction: Vector) -> Vector:
    x, y, z = direction
    return -x or 0.0, -y or 0.0, -z or 0.0


def ranged(low: float | None, high: float | None, size: float) -> tuple[float, float] | None:
    """Limits in rad or mm, of which one may be missing."""
    if low is None and high is None:
        return None
    return -math.inf if low is None else scaled(low, size), math.inf if high is None else scaled(high, size)


def narrowed(limits: Sequence[tuple[float, float] | None], what: str) -> tuple[float, float] | None:
    """Give the range that all of several limits allow; None where there is no limit."""
    stated = [each for each in limits if each is not None]
    if not stated:
        return None
    for low, high in stated:
        if low > high:
            raise MachineError(f"{what}: its limits {low:g} to {high:g} must run upwards")
    low, high = max(low for low, _ in stated), min(high for _, high in stated)
    if low > high:
        raise MachineError(f"{what}: its limits contradict each other, {low:g} is above {high:g}")
    return low, high


def even(limits: tuple[float, float] | None) -> bool:
    """Whether the sense in which a rotary axis is counted matters to nothing that it allows."""
    if limits is None:
        return True
    low, high = limits
    return low == -high or abs(low + high) <= _EVEN or high - low >= 2.0 * math.pi


def machine(name: str, axes: Sequence[Axis], notes: Sequence[str] = (), *, tool: Vector = ISO["Z"]) -> Machine:
    """A machine of these axes, from the part to the tool; what is unlimited is said aloud."""
    lines = list(notes)
    free = [each.name for each in axes if each.limits is None]
    if free:
        lines.append(f"no limits in the file for {', '.join(free)}: taken as unlimited")
    for each in axes:
        for i, side in enumerate(("least", "largest")):
            if each.limits is not None and math.isinf(each.limits[i]):
                lines.append(f"{each.name} has no {side} position in the file: it is taken as unlimited there")
    rotary = [each for each in axes if each.kind == "rotary"]
    if rotary and len(rotary) <= 2:
        last, iso = rotary[-1], ISO.get(rotary[-1].name[:1].upper())
        if abs(_dot(last.direction, tool)) > 1.0 - 1e-12 and iso is not None and abs(_dot(last.direction, iso)) < 0.5:
            raise MachineError(
                f"axis {last.name} runs along the tool, which it only turns about itself; {last.name} turns about "
                f"{'XYZ'[iso.index(1.0)]} in ISO 841: correct its direction"
            )
    return Machine(name[:200], axes=tuple(axes), tool_axis=tool, notes=tuple(dict.fromkeys(lines)), fixed=not rotary)


def _dot(a: Vector, b: Vector) -> float:
    return sum(p * q for p, q in zip(a, b, strict=True)) / math.sqrt(sum(p * p for p in a) * sum(q * q for q in b))


def arranged(rotary: list[Axis], added: Added, notes: list[str], who: str) -> list[Axis]:
    """Rotary axes of a file that does not say which stands on which, from the part to the tool."""
    names = [each.name.upper() for each in rotary]
    if added.order and sorted(added.order) != sorted(names):
        raise MachineError(f"#{added.text}: its rotary axes are {', '.join(names) or 'none'}")
    if len(rotary) > 1 and not added.order:
        raise MachineError(
            f"{who} does not say how its rotary axes {', '.join(names)} stand on each other: say it from the part to the "
            f"tool, as FILE#{','.join(names[::-1])}, or FILE#{names[-1]}/{names[0]} where the last carries the tool"
        )
    if rotary and not added.sign:
        notes.append("its angles are taken as those of the tool relative to the part (ISO 841), for the file does not say")
    if rotary and not added.order:
        notes.append(f"{names[0]} is taken to carry the part, which matters to linear travel alone")
    by_name = {each.name.upper(): each for each in rotary}
    part = added.part if added.order else tuple(names)
    sides: list[tuple[Carried, tuple[str, ...]]] = [("part", part), ("tool", added.tool)]
    axes = []
    for side, listed in sides:
        for axis in (by_name[name] for name in listed):
            turned = opposite(axis.direction) if side == "part" and added.sign == TABLE else axis.direction
            axes.append(replace(axis, carries=side, direction=turned))
    return axes
