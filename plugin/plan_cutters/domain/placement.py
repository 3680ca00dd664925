"""Where a part stands in a machine: its directions along the machine's, its point at the machine's zero, and what holds it."""

import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from cad_io.arrays import Floats, cross
from plan_cutters.domain.checks import items, numbers, shown
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.posture import Direction, Heading, HostAxis, HostPlane, unit
from plan_cutters.errors import OptionError

#: Directions whose angle has a smaller sine are parallel.
_PARALLEL = 1e-6
#: Lengths beyond this, mm, are rather a mistake.
_FARTHEST = 1e6


@dataclass(frozen=True, slots=True)
class Placement:
    """How a part is clamped.

    Attributes
    ----------
    z : (float, float, float)
        Direction of the part along the machine's Z (the spindle) at zero angles; kept with length 1.
    x : (float, float, float), optional
        Direction of the part along the machine's X there; kept across `z`, with length 1. None: as near to the part's X
        as can be.
    origin : (float, float, float), optional
        Point of the part, mm, at the machine's zero: that of its table, where all its axes are at zero. None: not known, so
        linear travel is not judged.
    clamped : tuple of str
        Faces that the part is held or stands on, in the words for faces: never targets.
    fixtures : tuple of Fixture
        What holds it.
    file : str
        Where it was read from, or will be written; empty where it was not.
    stands_on : tuple of str
        Faces that stand on a table which was proposed with the setup, and which nobody has yet: what it forbids there is left
        for another setup, and decides nothing.
    proposed : bool
        It was proposed: nobody has named it.

    Raises
    ------
    OptionError
        A direction is none, the two are parallel, or a value is of the wrong kind.

    Examples
    --------
    >>> Placement(z=(0, 0, 2), x=(0, 3, 1)).x
    (0.0, 1.0, 0.0)
    """

    z: Direction = (0.0, 0.0, 1.0)
    x: Direction | None = None
    origin: tuple[float, float, float] | None = None
    clamped: tuple[str, ...] = ()
    fixtures: tuple[Fixture, ...] = ()
    file: str = ""
    stands_on: tuple[str, ...] = ()
    proposed: bool = False

    if TYPE_CHECKING:

        def __init__(
            self, z: Heading = ..., x: Heading | None = None, origin: Sequence[float] | Floats | None = None,
            clamped: str | Sequence[str] = ..., fixtures: Any = ..., file: str = "", stands_on: tuple[str, ...] = (),
            proposed: bool = False,
        ) -> None: ...  # fmt: skip

    def __post_init__(self) -> None:
        z = unit(self.z, "setup axis")
        object.__setattr__(self, "z", tuple(z.tolist()))
        if self.x is not None:
            x = unit(self.x, "setup x")
            if float(np.linalg.norm(cross(x, z))) <= _PARALLEL:
                raise OptionError("setup x is parallel to the setup axis; give the direction of the part along the machine's X")
            across = x - (x @ z) * z
            # One that has length 1 across z up to rounding stays as it is: what is kept is kept when it is given again.
            across_x = x if abs(x @ z) <= 1e-15 else across / np.linalg.norm(across)
            object.__setattr__(self, "x", tuple((across_x + 0.0).tolist()))
        if self.origin is not None:
            origin = numbers(self.origin, "setup origin", 3)
            if not all(abs(each) <= _FARTHEST for each in origin):
                raise OptionError(f"setup origin must be three finite numbers, up to {_FARTHEST:g} mm; is its unit right?")
            object.__setattr__(self, "origin", origin)
        words = [self.clamped] if isinstance(self.clamped, str) else items(self.clamped, "clamped faces", "texts")
        for each in words:
            if not isinstance(each, str) or not each.strip():
                raise OptionError(f"clamped faces are words as F1,F3-5, not {shown(each)}")
        object.__setattr__(self, "clamped", tuple(words))
        object.__setattr__(self, "fixtures", Fixture.each_of(self.fixtures))
        if not isinstance(self.file, str):
            raise OptionError(f"a setup's file is a name, not {shown(self.file)}")

    @property
    def where(self) -> str:
        """How errors name its clamped faces."""
        return f"{self.file}: clamped" if self.file else "clamped"


def axis_words(axis: Sequence[float]) -> str:
    """Write a setup axis for a text.

    >>> axis_words((0.0, -0.0, 0.70710678))
    '0,0,0.7071'
    """
    return ",".join(f"{each + 0.0:.4g}" for each in axis)


def frame_of(setup: Floats, x: Floats | None = None) -> Floats:
    """A machine's X, Y and Z (3, 3), as rows, where unit directions of the part, the setup axis and
    `x`, point along its Z and, across that, its X.

    Without `x`, X is as near to the part's X as can be; where the part's X points along Z, Y is that of the part.
    """
    z = np.asarray(setup, float)
    reference = np.array([1.0, 0.0, 0.0]) if x is None else np.asarray(x, float)
    across = reference - (reference @ z) * z
    if np.linalg.norm(across) < _PARALLEL:
        across = cross(np.array([0.0, 1.0, 0.0]), z)
    across = across / np.linalg.norm(across)
    return np.array([across, cross(z, across), z])


#: Axes of the part by name; `auto`: the setups that the plan proposes.
SetupWord = Literal["x", "+x", "-x", "y", "+y", "-y", "z", "+z", "-z", "X", "+X", "-X", "Y", "+Y", "-Y", "Z", "+Z", "-Z", "auto"]
#: A text is a word: type checkers find those that are none. A setup file is a path.
Setup = SetupWord | HostAxis | Iterable[float] | HostPlane | Placement | os.PathLike[str]
