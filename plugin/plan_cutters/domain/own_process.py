"""The planner's own process: steps that a person wrote, each with its setup, orientation, cutter and faces."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters.domain.checks import shown
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.machine import Machine
from plan_cutters.errors import OptionError

#: One tool axis for all contacts of a step, or one for each.
Mode = Literal["fixed", "simultaneous"]
#: What stands for the faces of a step that takes all that no step before it finishes.
LEFT = "left"


@dataclass(frozen=True, slots=True)
class OwnStep:
    """One step."""

    number: int  #: In the file, from 1.
    setup: int  #: 0 for the first.
    mode: Mode  #: `fixed` or `simultaneous`.
    cutter: str  #: Its id, the word by which it was given, or its name.
    #: Positions of the rotary axes by name, deg; None where the axis is written instead, or it is simultaneous.
    angles: tuple[tuple[str, float], ...] | None = None
    axis: tuple[float, float, float] | None = None  #: Unit tool axis, part coordinates.
    faces: tuple[int, ...] | None = None  #: Face numbers; None: all that no step before it finishes.
    #: `first`: all that no such step before it takes. `share`: of what those leave; fixed steps that share divide it by time, and
    #: simultaneous ones take what no fixed one serves.
    take: Literal["first", "share"] = "first"


@dataclass(frozen=True, slots=True)
class Forbidden:
    """A cutter that may not be planned on some faces, by their numbers; steps that name it there are judged all the same."""

    cutter: str
    faces: tuple[int, ...]


#: Digits of an angle in degrees that a control shows: what it shows is judged.
CONTROL_DIGITS = 3


@dataclass(frozen=True, slots=True)
class OwnProcess:
    """The steps in their order, and what is to be done with what they leave."""

    steps: tuple[OwnStep, ...]
    forbidden: tuple[Forbidden, ...] = ()
    #: `plan`: more steps are planned behind them for what they leave; `leave`: it is left.
    rest: Literal["plan", "leave"] = "plan"
    file: str = ""  #: Where it was read from; empty: it was given in Python.

    def check(self, cutters: Sequence[Cutter], setups: int, names: Sequence[str], moves: bool) -> None:
        """See to it that every cutter, setup and angle is one that there is, and every motion.

        `cutters`: all that are judged. `setups`: how many setups there are. `names`: of the rotary axes. `moves`: whether any of
        them can turn the tool. Raises OptionError: it names the step.
        """
        there_are = f"the rotary axes are {' and '.join(names)}" if len(names) > 1 else f"the rotary axis is {''.join(names)}"
        there_are = there_are if names else "the machine has no rotary axis"
        for step in self.steps:
            cutter_of(step.cutter, cutters, self._where(step))
            if step.setup >= setups:
                there = "is the only setup" if setups == 1 else f"to {setups} are the setups"
                raise OptionError(f"{self._where(step)}: setup {step.setup + 1}: 1 {there}; name another with --setup")
            if step.angles is not None and {name for name, _ in step.angles} != set(names):
                written = ", ".join(name if name.isidentifier() else shown(name) for name, _ in step.angles) or "none"
                raise OptionError(f"{self._where(step)}: angles: {written}; {there_are}")
            if step.mode == "simultaneous" and not moves:
                raise OptionError(
                    f"{self._where(step)}: it is simultaneous, and on this machine no axis turns the tool while it cuts"
                )
        for number, each in enumerate(self.forbidden, 1):
            cutter_of(each.cutter, cutters, f"{self._named()}forbid {number}")

    def rounded(self) -> dict[int, dict[str, float]]:
        """Angles as a control shows them, deg, of the steps whose angles have more digits, by the number of the step."""
        shown = {
            step.number: {name: round(angle, CONTROL_DIGITS) + 0.0 for name, angle in step.angles or ()} for step in self.steps
        }
        return {step.number: shown[step.number] for step in self.steps if dict(step.angles or ()) != shown[step.number]}

    @property
    def faces_named(self) -> frozenset[int]:
        """Numbers of the faces that its steps name."""
        return frozenset(number for step in self.steps for number in step.faces or ())

    def check_faces(self, targets: Iterable[int]) -> None:
        """See to it that every face is one that is to be machined. Raises OptionError."""
        known = set(targets)
        for where, faces in [(self._where(step), step.faces or ()) for step in self.steps] + [
            (f"{self._named()}forbid {number}", each.faces) for number, each in enumerate(self.forbidden, 1)
        ]:
            if missing := [f"F{number}" for number in faces if number not in known]:
                raise OptionError(f"{where}: faces: {', '.join(missing[:4])}: no target face has this number; see --faces")

    def written(self) -> dict[str, Any]:
        """The same as a file has it, for `machines.process_file.process_of`."""
        return {
            "rest": self.rest,
            "step": [_written(step) for step in self.steps],
            "forbid": [{"cutter": each.cutter, "faces": _ids(each.faces)} for each in self.forbidden],
        }

    def _named(self) -> str:
        return f"{Path(self.file).name}: " if self.file else "process: "

    def _where(self, step: OwnStep) -> str:
        return f"{self._named()}step {step.number}"


def cutter_of(word: str, cutters: Sequence[Cutter], where: str) -> Cutter:
    """The cutter with an id, the word by which it was given, or a name.

    Raises OptionError: there is none, or there are several.
    """
    for names in ([c.id for c in cutters], [c.typed for c in cutters], [c.name for c in cutters]):
        if names.count(word) == 1:
            return cutters[names.index(word)]
        if names.count(word) > 1:
            ids = ", ".join(c.id for c, name in zip(cutters, names, strict=True) if name == word)
            raise OptionError(f"{where}: cutter {word!r} may be each of {ids}: give the id")
    words: Mapping[str, None] = dict.fromkeys([*(c.typed for c in cutters), *(c.id for c in cutters)])
    near = get_close_matches(word, list(words), 1)
    hint = f"{near[0]}?" if near else ", ".join(list(words)[:6])
    raise OptionError(f"{where}: cutter {word!r} is not among those that are judged: {hint}")


def _written(step: OwnStep) -> dict[str, Any]:
    turned: dict[str, Any] = {}
    if step.angles is not None:
        turned = {"angles": dict(step.angles)}
    elif step.axis is not None:
        turned = {"axis": list(step.axis)}
    faces = LEFT if step.faces is None else _ids(step.faces)
    rest = {"take": step.take} if step.take == "share" else {}
    return {"setup": step.setup + 1, "mode": step.mode, **turned, "cutter": step.cutter, "faces": faces, **rest}


def _ids(faces: Iterable[int]) -> list[str]:
    return [f"F{number}" for number in faces]


def unit_axis(axis: Sequence[float], where: str) -> tuple[float, float, float]:
    """An axis (3,) of length 1. Raises OptionError: it has no direction."""
    largest = max(abs(each) for each in axis)
    # Numbers next to 0 have few digits.
    if not 1e-100 < largest < math.inf:
        raise OptionError(f"{where}: axis {list(axis)} has no direction")
    scaled = [float(each) / largest for each in axis]
    x, y, z = (each / math.hypot(*scaled) for each in scaled)
    return x, y, z


@dataclass(frozen=True, slots=True, eq=False)
class Nearest:
    """The orientation next to one that a person wrote which serves more: its angles (k,), deg, its axis (3,), and the rows."""

    angle: Floats
    axis: Floats
    rows: NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class OwnResult:
    """A step of the planner's own process does this."""

    number: int  #: In the file, from 1.
    setup: int
    mode: Mode
    cutter: Cutter
    axis: Floats | None  #: (3,) float: None where it is simultaneous.
    #: (k,) float: as written, deg, or the nearest that the machine has for an axis; None where it is simultaneous.
    angle: Floats | None
    requested: NDArray[np.int64]  #: (m,) int64: samples of its faces that no step before it finishes.
    rows: NDArray[np.int64]  #: (r,) int64: those of them that it finishes.
    serves: NDArray[np.int64]  #: (k,) int64: all samples of its faces that it could finish, whoever takes them.
    wrong: str = ""  #: Why it does less than is asked of it, in words; empty where it does all.
    nearest: Nearest | None = None  #: An orientation that would do, where there is one.


def operations_requested(
    operations: str | None, process: OwnProcess | None, cutters: Sequence[Cutter], feeds: Mapping[Cutter, float],
    machine: Machine, setups: int,
) -> str:  # fmt: skip
    """The operations that are planned: what was requested; behind a process, else, the fastest if all have feeds.

    `operations`: as requested. `cutters`: all that are judged. `feeds`: of those that have one, mm/min. `setups`: how many there
    may be. Raises OptionError: a step is about something that there is not, or a feed is missing where time counts.
    """
    unpriced = list[str]()
    if process is not None:
        names = [axis.name for axis in machine.rotary] if machine.turns else ["azimuth", "tilt"]
        process.check(cutters, setups, names, not machine.turns or (machine.turning > 0 and not machine.indexed))
        named = [cutter_of(each.cutter, cutters, "process") for each in process.steps]
        unpriced = [each.typed for each in named if each not in feeds]
    chosen = operations or ("fewest" if unpriced or not feeds else "fastest")
    if chosen != "fewest" and unpriced:
        raise OptionError(f"process: {unpriced[0]} has no feed: give --feed MM/MIN, or --operations fewest")
    if chosen != "fewest" and not feeds:
        raise OptionError("the fastest operations need a feed: give --feed MM/MIN, or ask for the fewest")
    return chosen
