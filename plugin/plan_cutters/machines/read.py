"""A file becomes a machine, or one line that says why not."""

import os
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

from plan_cutters.domain.machine import Machine, builtin_machines
from plan_cutters.errors import MachineError
from plan_cutters.files.content import Foreign, Format, called, recognised, rooted
from plan_cutters.machines import freecad, fusion, linuxcnc, toml
from plan_cutters.machines.chain import Added, Content, opened

Reader = Callable[[Content, Added], Machine]
FORMATS: tuple[Format[Reader], ...] = (
    Format("plan-cutters TOML", (".toml",), toml.is_toml, toml.read_toml),
    Format("plan-cutters JSON", (".json",), toml.is_json, toml.read_json),
    Format("FreeCAD machine", (".fcm",), freecad.is_fcm, freecad.read_fcm),
    Format("Fusion machine", (".mch",), fusion.is_mch, fusion.read_mch),
    Format("LinuxCNC configuration", (".ini",), linuxcnc.is_ini, linuxcnc.read_ini),
    # By its name alone, so that it is said where it is no TOML or what is missing.
    Format("plan-cutters TOML", (".toml",), toml.is_named, toml.read_toml),
)

_TOML = "write the machine as TOML (docs/machines.md)"


FOREIGN = (
    Foreign("a web page (HTML)", rooted("!doctype html", "html", "head", "body"),
            "download the machine itself: perhaps a log-in stands before it"),
    Foreign("a robot (URDF)", rooted("robot"), f"no machine tool is known in it; {_TOML}"),
    Foreign("a robot (SDF)", rooted("sdf"), f"no machine tool is known in it; {_TOML}"),
    Foreign("MTConnect data", rooted("MTConnectDevices", "MTConnectStreams", "MTConnectAssets", "MTConnectError"),
            f"it does not say how the axes stand on each other; {_TOML}, ten lines do"),
    Foreign("a PowerMill machine", called(".mtd"), _TOML),
    Foreign("a LinuxCNC HAL file", called(".hal", ".tcl"), "give the .ini that names it"),
    Foreign("a LinuxCNC tool table", called(".tbl"), "give the .ini as the machine; its tools go with --cutters"),
    Foreign("a Fusion tool library", lambda c: isinstance(c.json, dict) and isinstance(c.json.get("data"), list),
            "give it with --cutters"),
    Foreign("an ISO 10303-21 file (STEP)", lambda c: c.head.startswith("iso-10303-21"), _TOML),
    Foreign("a zip archive", lambda c: c.data.startswith(b"PK\x03\x04"), "give the machine that is in it"),
    Foreign("an SQLite database", lambda c: c.data.startswith(b"SQLite format 3\0"), _TOML),
    Foreign("a binary file", lambda c: re.search(r"[\0-\x08\x0e-\x1f]", c.text[:65536]) is not None, _TOML),
)  # fmt: skip


def read_machine(path: str | os.PathLike[str], added: str = "") -> Machine:
    """The machine that a file describes; how it was understood, where that is not plain, is in `notes`.

    `path`: our own TOML or JSON, FreeCAD `.fcm`, LinuxCNC `.ini`, Fusion `.mch`. What the file holds decides. `added`: what some
    files leave open: rotary axes from the part to the tool, as `C,A`, or `C/B` where C carries the part and B the tool; `table`
    or `tool-relative`: how angles of a table are counted. Raises MachineError: the file is no machine that is read, contradicts
    itself, or leaves open what decides where the tool can point.

    >>> read_machine("none.fcm")
    Traceback (most recent call last):
    plan_cutters.errors.MachineError: none.fcm: cannot be read: No such file or directory
    """
    return described(path, added)[0]


def described(path: str | os.PathLike[str], added: str = "") -> tuple[Machine, str]:
    """The same, and the name of the format."""
    content = opened(path)
    form = recognised(
        content, FORMATS, FOREIGN[1:], first=FOREIGN[:1], xml=f"no machine file that is known; {_TOML}",
        json="no machine of Fusion (kinematics), FreeCAD (machine.axes) or ours (part_chain)",
    )  # fmt: skip
    try:
        machine = form.read(content, Added.parse(added) if added else Added())
    except MachineError as error:
        name = content.name if error.file in (None, content.name) else f"{content.name}: {error.file}"
        raise MachineError(error.cause, file=name) from None
    except RecursionError:
        raise MachineError("it is nested too deeply", file=content.name) from None
    return machine, form.name


def machine_of(value: Any) -> Machine:
    """Read a value of `--machine`: `unlimited`, `tilt:DEG`, a built-in name, or a file.

    `FILE#C,A` gives the order of the rotary axes where the file leaves it open.

    Raises MachineError.

    >>> machine_of("trunnion-ac").rotary[0].name
    'C'
    """
    return source_of(value)[0]


def source_of(value: Any) -> tuple[Machine, str]:
    """The same, and the name of the file's format; empty for none."""
    if not isinstance(value, str | os.PathLike) or value == "unlimited":
        return Machine.of(value), ""
    text = os.fspath(value)
    if text in builtin_machines() or text.startswith("tilt:"):
        return Machine.parse(text), ""
    file, mark, added = text.rpartition("#")
    if mark and not _there(text) and (_there(file) or _file_like(file)):
        return described(file, added or "#")
    if _there(text) or _file_like(text):
        return described(text)
    return Machine.parse(text), ""


def _there(text: str) -> bool:
    try:
        return bool(text) and Path(text).exists()
    except (OSError, ValueError):
        return False


def _file_like(text: str) -> bool:
    return os.sep in text or Path(text).suffix.lower() in (".toml", ".json", ".fcm", ".mch", ".ini", ".xml", ".urdf")
