"""A fixed orientation as words of a control: a tilted work plane as LinuxCNC has it, and positions of rotary axes.

`G68.2 P0 Q313` turns the plane by Euler angles in degrees: about Z by I, about the new X by J, about the new Z by K, in the
coordinates of the part as it stands with all rotary axes at zero; its zero is that of the work offset, which is G54 there
(LinuxCNC, `configs/sim/axis/vismach/5axis`). `G53.1` turns the tool onto it. P says which of two solutions: 0 the shortest way of
the first rotary axis from where it is, 1 the positive way, 2 the negative one; here from zero.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from cad_io.arrays import Floats
from plan_cutters.domain.own_process import CONTROL_DIGITS

#: Digits of the angles of a plane: a control turns to angles that it reckons from these.
_DIGITS = 6
#: A plane whose z has a part across the spindle of less than this lies across it.
_LEVEL = 1e-9
#: Angles that differ by less are one, deg.
_SAME = 0.01
#: The work offset in which LinuxCNC defines a plane.
_OFFSET = "G54"


@dataclass(frozen=True, slots=True)
class ControlWords:
    """Blocks of a program; None where the machine has no such word."""

    g68_2: str | None = None  #: The tilted plane.
    g53_1: str | None = None  #: The turn onto it.
    rotary: str | None = None  #: Instead of both: the work offset and the rotary axes.


def control_words(
    frame: Floats, plane: Floats, angles: Mapping[str, float] | None, other: Mapping[str, float] | None
) -> ControlWords:
    """Write a fixed orientation.

    `frame`, `plane` (3, 3): X, Y and Z of the machine at zero angles and of the tilted plane, as rows, part coordinates.
    `angles`, `other`: of the rotary axes by name, deg, the first one next to the part, and of the other solution, if there is
    one; None where the machine names no rotary axes. Without rotary axes nothing turns: there is the work offset alone.

    >>> import numpy as np
    >>> plane, two = np.array([[0.0, 1, 0], [0, 0, 1], [1, 0, 0]]), ({"C": 90.0, "A": 90.0}, {"C": -90.0, "A": -90.0})
    >>> words = control_words(np.eye(3), plane, *two)
    >>> words.g68_2, words.g53_1, words.rotary
    ('G68.2 P0 Q313 X0 Y0 Z0 I90 J90 K0', 'G53.1 P1', 'G54 G0 A90 C90')
    """
    if angles is not None and not angles:
        return ControlWords(rotary=_OFFSET)
    i, j, k = euler_angles(plane @ frame.T)
    words = f"G68.2 P0 Q313 X0 Y0 Z0 I{_number(i)} J{_number(j)} K{_number(k)}"
    if angles is None:
        return ControlWords(words, "G53.1 P0")
    named = all(name in ("A", "B", "C") for name in angles)
    turned = " ".join(f"{name}{_number(angles[name], CONTROL_DIGITS)}" for name in sorted(angles))
    solution = solution_of([*angles.values()], None if other is None else [*other.values()])
    return ControlWords(words, f"G53.1 P{solution}", f"{_OFFSET} G0 {turned}" if named else None)


def euler_angles(plane: Floats) -> tuple[float, float, float]:
    """The angles I, J, K, deg, of a plane whose x, y, z are the rows of a rotation (3, 3): R = Rz(I) Rx(J) Rz(K).

    Where its z lies along Z, I alone turns it. Of two ways that with the smaller angles I and K is taken.
    """
    x, y, z = plane
    across = math.hypot(z[0], z[1])
    if across <= _LEVEL:
        return math.degrees(math.atan2(x[1], x[0])), 0.0 if z[2] > 0.0 else 180.0, 0.0
    angles = math.atan2(z[0], -z[1]), math.atan2(across, z[2]), math.atan2(x[2], y[2])
    first, second, third = (math.degrees(each) for each in angles)
    other_first, other_third = (math.remainder(each + 180.0, 360.0) for each in (first, third))
    if abs(other_first) + abs(other_third) < abs(first) + abs(third) - _LEVEL:
        return other_first, -second, other_third
    return first, second, third


def solution_of(angles: Sequence[float], other: Sequence[float] | None) -> int:
    """P of G53.1 by which a control, its rotary axes at zero, takes some angles, deg, and not the other ones."""
    if other is None or math.dist(angles[1:], other[1:]) <= _SAME:
        # Along the first axis any angle of that will do.
        return 0
    mine, others = (round(first, CONTROL_DIGITS) % 360.0 for first in (angles[0], other[0]))
    if min(mine, 360.0 - mine) < min(others, 360.0 - others):
        return 0
    return 1 if mine < others else 2


def _number(value: float, digits: int = _DIGITS) -> str:
    """A number without an exponent, and without zeros at its end."""
    return f"{round(value, digits) + 0.0:.{digits}f}".rstrip("0").rstrip(".")
