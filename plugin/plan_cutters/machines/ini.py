"""LinuxCNC's `.ini`: sections and keys, with the files that it includes, and what its HAL lines set."""

import re
from pathlib import Path

from plan_cutters.domain.checks import shown
from plan_cutters.errors import MachineError
from plan_cutters.machines.files import Content

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
                    self._take(Content.of(path), (*above, path))
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
    rest = words[1].lstrip() if len(words) > 1 else ""
    try:
        result = float(words[0]) if words and (not rest or rest[0] in "#;") else float("nan")
    except ValueError:
        result = float("nan")
    if result != result or result in (float("inf"), float("-inf")):
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
            text = Content.of(self.ini.path.parent / name).text
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
