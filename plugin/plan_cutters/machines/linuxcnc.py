"""LinuxCNC configurations, `.ini`: limits are said by the file, how the axes stand on each other by the name of its kinematics.

Only kinematics whose sources were read are taken (src/emc/kinematics of LinuxCNC). Their formulas give the signs: the trunnions
`xyzac-trt-kins` and `xyzbc-trt-kins` count both rotary axes, and `maxkins` and `5axiskins` B, against ISO 841, unless the pin
`conventional-directions` is set, which `5axiskins` does not have.
"""

import math
import re
from pathlib import Path
from typing import Any, NamedTuple

from plan_cutters.domain.checks import shown
from plan_cutters.domain.machine import Axis, Carried, Machine
from plan_cutters.errors import MachineError
from plan_cutters.machines import chain
from plan_cutters.machines.chain import Added, Content, arranged

_SECTION = re.compile(r"\[\s*([\w-]+)\s*\]")
_ENTRY = re.compile(r"([\w-]+)\s*=\s*(.*)")
_INCLUDE = re.compile(r"#INCLUDE\s+(\S.*)")
_FROM_INI = re.compile(r"\[(\w+)\]\(?(\w+)\)?")
_DEEPEST, _FILES = 8, 64


class Ini:
    """Values by section and key, in the order of the files; what a HAL file beside it says is read where asked for."""

    def __init__(self, content: Content) -> None:
        self.path = content.path
        self.values: dict[str, dict[str, list[str]]] = {}
        self.read = 0
        self._section = ""
        self._take(content, (content.path,))

    def _take(self, content: Content, above: tuple[Path, ...]) -> None:
        self.read += 1
        if len(above) > _DEEPEST or self.read > _FILES:
            raise MachineError(f"{content.name} is included too deeply, or too many files are")
        for number, line in enumerate(content.text.replace("\\\r\n", " ").replace("\\\n", " ").splitlines(), 1):
            words = line.strip()
            include = _INCLUDE.match(words)
            if include:
                path = content.path.parent / include[1].strip()[:200]
                if any(_same(path, each) for each in above):
                    raise MachineError(f"{content.name}, line {number}: it includes itself by {path.name}")
                try:
                    self._take(chain.opened(path), (*above, path))
                except MachineError as error:
                    what = f"{path.name}, which line {number} includes"
                    raise MachineError(error.cause, file=error.file if error.file != path.name else what) from None
                continue
            if not words or words[0] in "#;":
                continue
            section, entry = _SECTION.match(words), _ENTRY.match(words)
            if section:
                self._section = section[1].upper()
                self.values.setdefault(self._section, {})
            elif entry and self._section:
                self.values[self._section].setdefault(entry[1].upper(), []).append(entry[2].strip())

    def all(self, section: str, key: str) -> list[str]:
        """All values of a key."""
        return self.values.get(section, {}).get(key, [])

    def one(self, section: str, key: str) -> str | None:
        """The value of a key, said once or always the same."""
        values = list(dict.fromkeys(self.all(section, key)))
        if len(values) > 1:
            raise MachineError(f"[{section}]{key} is given as {shown(values[0])} and as {shown(values[1])}")
        return values[0] if values else None

    def number(self, section: str, key: str) -> float | None:
        """A finite number; what follows it must be a comment."""
        text = self.one(section, key)
        return None if text is None else number(text, f"[{section}]{key}")


def _same(one: Path, other: Path) -> bool:
    try:
        return one.samefile(other)
    except (OSError, ValueError):
        return one == other


def number(text: str, what: str) -> float:
    """A finite number at the beginning of a value."""
    words = text.split(None, 1)
    try:
        result = float(words[0]) if words and (len(words) == 1 or words[1].lstrip()[:1] in ("#", ";")) else math.nan
    except ValueError:
        result = math.nan
    if not math.isfinite(result):
        raise MachineError(f"{what} is {shown(text)}, which is no number")
    return result


def _pin(name: str) -> str:
    return name.replace("_", "-")


class Hal:
    """Read the pins and signals that HAL lines set. The lines stand in the file, or in HAL files beside it."""

    def __init__(self, ini: Ini) -> None:
        self.ini = ini
        self.missing: list[str] = []
        self.pins: dict[str, str] = {}
        self.signals: dict[str, str] = {}
        self.signal_of: dict[str, str] = {}
        self.scripts = ""
        for name in (*ini.all("HAL", "HALFILE"), *ini.all("HAL", "POSTGUI_HALFILE")):
            self._file(name.split()[0] if name.split() else "")
        for line in ini.all("HAL", "HALCMD"):
            self._line(line)

    def _file(self, name: str) -> None:
        # What LinuxCNC itself brings along sets nothing of a machine.
        if not name or name.upper().startswith("LIB:"):
            return
        try:
            text = chain.opened(self.ini.path.parent / name).text
        except MachineError:
            self.missing.append(Path(name).name)
            return
        if name.lower().endswith(".tcl"):
            self.scripts += text
            return
        for line in text.splitlines():
            self._line(line.partition("#")[0])

    def _line(self, line: str) -> None:
        # Underscores and hyphens are one in names of pins.
        words = [word for word in line.split() if word not in ("=>", "<=", "<=>")]
        words = [*words[:1], *(_pin(word) for word in words[1:2]), *words[2:]]
        match words:
            case ["setp", pin, value, *_]:
                self.pins[pin] = value
            case ["sets", signal, value, *_]:
                self.signals[signal] = value
            case ["net", signal, *pins]:
                self.signal_of.update(dict.fromkeys(map(_pin, pins), signal))
            case ["linksp", signal, pin] | ["linkps", pin, signal]:
                self.signal_of[_pin(pin)] = _pin(signal)

    def value(self, pin: str, default: float) -> float | None:
        """Give the value that a pin is set to: `default` where nothing sets it, None where something else feeds it."""
        text = self.pins.get(pin)
        if pin in self.signal_of:
            text = self.signals.get(self.signal_of[pin])
            if text is None:
                return None
        if text is None:
            return None if pin.rpartition(".")[2] in self.scripts else default
        match = _FROM_INI.fullmatch(text)
        if match:
            pin_value = self.ini.one(match[1].upper(), match[2].upper())
            if pin_value is None:
                raise MachineError(f"{pin} is set to {shown(text)}, which the file does not have")
            text = pin_value
        return {"true": 1.0, "false": 0.0}.get(text.lower()) if text.isalpha() else number(text, pin)


_LOOKS = re.compile(r"^\s*\[\s*(KINS|TRAJ|EMCMOT|EMC|JOINT_\d|AXIS_\w)\s*\]", re.MULTILINE)
_LETTERS = "XYZABCUVW"


class Kins(NamedTuple):
    """Kinematics by their formulas."""

    #: Letters of the joints from 0 up, where the file does not say.
    joints: str
    #: Letters of the rotary axes: those that carry the part, the one next to it first; those that carry the tool, the one next
    #: to it last.
    part: str
    tool: str
    #: Letters that are counted against ISO 841.
    against: str
    #: Whether `conventional-directions` turns these.
    pin: bool


KINS = {
    "xyzac-trt-kins": Kins("XYZAC", "CA", "", "AC", True),
    "xyzbc-trt-kins": Kins("XYZBC", "CB", "", "BC", True),
    "maxkins": Kins(_LETTERS, "C", "B", "B", True),
    "5axiskins": Kins("XYZBCW", "", "CB", "B", False),
}
TRIVIAL = "trivkins"
#: Pivots of `maxkins` and `5axiskins` over the controlled point, where nothing sets them, in units of the machine.
_PIVOT = {"maxkins": 0.666, "5axiskins": 250.0}


def is_ini(content: Content) -> bool:
    """Sections of a LinuxCNC configuration, or one of them and what includes the rest."""
    sections = set(_LOOKS.findall(content.text))
    whole = len(sections) >= 2 and content.head[:1] not in ("{", "<")
    return whole or (bool(sections) and "#INCLUDE" in content.text)


def read_ini(content: Content, added: Added) -> Machine:
    """Read it."""
    return _Reading(Ini(content), added).machine()


class _Reading:
    def __init__(self, ini: Ini, added: Added) -> None:
        self.ini, self.added = ini, added
        self.notes: list[str] = []
        self.name, self.given = self.kinematics()
        self.length = chain.unit(ini.one("TRAJ", "LINEAR_UNITS"), chain.LENGTHS, "[TRAJ]LINEAR_UNITS")
        self.angle = chain.unit(ini.one("TRAJ", "ANGULAR_UNITS") or "degree", chain.ANGLES, "[TRAJ]ANGULAR_UNITS")
        self.letters = self.coordinates()
        self.joints = self.letters_of_joints()

    def kinematics(self) -> tuple[str, dict[str, str]]:
        """The name of the kinematics, and what is given with it."""
        text = self.ini.one("KINS", "KINEMATICS")
        if text is None:
            others = [(name, self.ini.one(name, "KINEMATICS")) for name, keys in self.ini.values.items() if "KINEMATICS" in keys]
            if len(others) != 1:
                raise MachineError("it names no kinematics ([KINS]KINEMATICS): how its axes stand on each other is not known")
            section, text = others[0]
            self.notes.append(f"its kinematics are named in [{section}], not in [KINS]")
        words = (text or "").split()
        name = words[0].lower() if words else ""
        if name != TRIVIAL and name not in KINS:
            raise MachineError(
                f"its kinematics {shown(name)} are none of those that are read ({', '.join((TRIVIAL, *KINS))}); write the "
                "machine as TOML (docs/machines.md)"
            )
        words_by_key = dict(word.partition("=")[::2] for word in words[1:] if "=" in word)
        return name, {key.lower(): value for key, value in words_by_key.items()}

    def coordinates(self) -> str:
        text = self.ini.one("TRAJ", "COORDINATES") or self.given.get("coordinates")
        if text is None:
            raise MachineError("it names no axes ([TRAJ]COORDINATES)")
        letters = "".join(dict.fromkeys("".join(text.upper().split())))
        if not letters or not set(letters) <= set(_LETTERS):
            raise MachineError(f"[TRAJ]COORDINATES is {shown(text)}: letters of {_LETTERS} are expected")
        return letters

    def letters_of_joints(self) -> str:
        text = self.given.get("coordinates", "").upper() or self._letters_unsaid()
        for i, letter in enumerate(text):
            for section in (f"JOINT_{i}", f"AXIS_{i}"):
                kind = (self.ini.one(section, "TYPE") or "").upper()
                if kind and kind != ("ANGULAR" if letter in "ABC" else "LINEAR"):
                    raise MachineError(
                        f"[{section}] is {shown(kind)}, but joint {i} is {letter} by its kinematics: say so, as "
                        f"KINEMATICS = {self.name} coordinates={self.letters}"
                    )
        return text

    def _letters_unsaid(self) -> str:
        """The letter of each joint, where the file does not say it."""
        text = KINS[self.name].joints if self.name in KINS else _LETTERS
        sections = [key for key in self.ini.values if re.fullmatch(r"(JOINT|AXIS)_\d", key)]
        numbered = [key for key in sections if key.startswith("AXIS")]
        missing = [key for key in sections if int(key[-1]) >= len(text) or text[int(key[-1])] not in self.letters]
        # Before there were joints, axes were numbered; maxkins numbers all nine, used or not.
        if (self.name == TRIVIAL and missing) or (self.name in KINS and len(text) < len(_LETTERS) and numbered):
            raise MachineError(
                f"which axis [{(missing or numbered)[0]}] is of is not known: say so, as KINEMATICS = "
                f"{self.name} coordinates={self.letters}"
            )
        return text

    def machine(self) -> Machine:
        name = self.ini.one("EMC", "MACHINE") or self.ini.path.stem
        extra = [letter for letter in self.letters if letter in "UVW"]
        if extra:
            self.notes.append(f"{', '.join(extra)}: second linear axes are not used; their travel is not counted")
        lacking = [letter for letter in "XYZ" if letter not in self.letters]
        if lacking:
            self.notes.append(f"it has no axis {', '.join(lacking)}")
        straight = [
            Axis(letter, "linear", "tool", chain.ISO[letter], self.limits(letter, self.name == TRIVIAL), **self.speeds(letter))
            for letter in "XYZ" if letter in self.letters
        ]  # fmt: skip
        rotary = self.trivial() if self.name == TRIVIAL else self.known()
        part, tool = ([each for each in rotary if each.carries == side] for side in ("part", "tool"))
        return chain.machine(name, [*part, *straight, *tool], self.notes)

    def of_joints(self, letter: str) -> tuple[float, list[str]]:
        """The size of the unit of an axis, and the sections of its joints."""
        sections = [f"{kind}_{i}" for i, each in enumerate(self.joints) if each == letter for kind in ("JOINT", "AXIS")]
        return self.angle if letter in "ABC" else self.length, sections

    def limits(self, letter: str, trivial: bool) -> tuple[float, float] | None:
        """Limits of an axis, in rad or mm: those of its joint, and where both mean the same those of the axis."""
        size, sections = self.of_joints(letter)
        stated = [self.ends(section, size) for section in sections if section in self.ini.values]
        own = self.ends(f"AXIS_{letter}", size)
        # Of kinematics that couple axes, those of a linear axis are of the programmed place, not of the machine's.
        if trivial or letter in "ABC" or not any(stated):
            stated.append(own)
        limits = chain.narrowed(stated, f"axis {letter}")
        if len({each for each in stated if each is not None}) > 1:
            self.notes.append(f"{letter}: the limits of the axis and of its joints differ; what all allow is taken")
        return limits

    def ends(self, section: str, size: float) -> tuple[float, float] | None:
        return chain.ranged(self.ini.number(section, "MIN_LIMIT"), self.ini.number(section, "MAX_LIMIT"), size)

    def speeds(self, letter: str) -> dict[str, Any]:
        """The largest speed and acceleration of an axis: the least of what it and its joints say."""
        (size, sections), result = self.of_joints(letter), dict[str, Any]()
        for name, word in (("rate", "MAX_VELOCITY"), ("acceleration", "MAX_ACCELERATION")):
            stated = [self.ini.number(section, word) for section in (f"AXIS_{letter}", *sections)]
            result[name] = min((chain.scaled(each, size) for each in stated if each is not None and each > 0.0), default=None)
        return result

    def rotary(self, letter: str, carries: Carried, against: bool, point: chain.Vector) -> Axis:
        direction = chain.opposite(chain.ISO[letter]) if against else chain.ISO[letter]
        return Axis(letter, "rotary", carries, direction, self.limits(letter, False), point, **self.speeds(letter))

    def trivial(self) -> list[Axis]:
        """Kinematics that say nothing of how axes stand on each other."""
        rotary = [self.rotary(letter, "part", False, (0.0, 0.0, 0.0)) for letter in self.letters if letter in "ABC"]
        return arranged(rotary, self.added, self.notes, TRIVIAL)

    def known(self) -> list[Axis]:
        self.added.refuse(self.ini.path.name, order=True, sign=True)
        kins = KINS[self.name]
        listed = [letter for letter in self.letters if letter in "ABC"]
        more = [letter for letter in listed if letter not in kins.part + kins.tool]
        if more:
            raise MachineError(
                f"it has a third rotary axis, {', '.join(more)}, of which {self.name} says nothing: "
                "machines of up to two are judged"
            )
        missing = [letter for letter in kins.part + kins.tool if letter not in listed]
        if missing:
            raise MachineError(f"[TRAJ]COORDINATES lacks {', '.join(missing)}, which {self.name} turns")
        hal = Hal(self.ini)
        against = self.against(kins, hal)
        points = self.points(hal)
        sides: list[tuple[Carried, str]] = [("part", kins.part), ("tool", kins.tool)]
        return [self.rotary(each, side, each in against, points[each]) for side, letters in sides for each in letters]

    def against(self, kins: Kins, hal: Hal) -> str:
        """Letters that are counted against ISO 841."""
        pin = f"{self.name}.conventional-directions"
        result = hal.value(pin, 0.0) if kins.pin else 0.0
        if result is None or (kins.pin and pin not in hal.pins and pin not in hal.signal_of and hal.missing):
            why = "something else feeds it" if result is None else f"{', '.join(hal.missing)} is not at hand"
            if not all(chain.even(self.limits(letter, False)) for letter in kins.against):
                raise MachineError(
                    f"the sense of its angles hangs on {pin}, and {why}: put the HAL file next to it, or a line "
                    f"HALCMD = setp {pin} 0 (or 1) into [HAL]"
                )
            self.notes.append(f"the sense of its angles hangs on {pin}, and {why}: with its limits it allows the same either way")
        if result:
            self.notes.append(f"{pin} is set: its angles are counted as in ISO 841")
            return ""
        letters = " and ".join(kins.against)
        self.notes.append(f"{self.name} counts {letters} against ISO 841: directions are turned, angles are those of the control")
        return kins.against

    def points(self, hal: Hal) -> dict[str, chain.Vector]:
        """A point of each rotary axis, mm, for no tool length; what is fed by something else counts as 0, and is noted."""

        def pin(name: str, default: float = 0.0) -> float:
            value = hal.value(f"{self.name}.{name}", default)
            if value is None:
                what = f"{self.name}.{name} is not set by the file"
                self.notes.append(f"{what}: it is taken as {default:g}, which matters to linear travel alone")
                value = default
            return value * self.length

        if self.name in _PIVOT:
            return {"C": (0.0, 0.0, 0.0), "B": (0.0, 0.0, pin("pivot-length", _PIVOT[self.name]))}
        x, y, z = (pin(f"{letter}-rot-point") for letter in "xyz")
        if self.name == "xyzac-trt-kins":
            return {"C": (x, y, 0.0), "A": (x, y + pin("y-offset"), z + pin("z-offset"))}
        return {"C": (x, y, 0.0), "B": (x + pin("x-offset"), y, z + pin("z-offset"))}
