"""A file becomes a machine, or one line that says why not."""

import os
from pathlib import Path
from typing import Any

from plan_cutters.domain.machine import Machine, builtin_machines
from plan_cutters.errors import MachineError
from plan_cutters.machines.files import Added, Content
from plan_cutters.machines.formats import recognised


def read_machine(path: str | os.PathLike[str], added: str = "") -> Machine:
    """The machine that a file describes; how it was understood, where that is not plain, is in `notes`.

    Parameters
    ----------
    path : path
        Our own TOML or JSON, FreeCAD `.fcm`, LinuxCNC `.ini`, Fusion `.mch`. What the file holds decides.
    added : str
        What some files leave open: rotary axes from the part to the tool, as `C,A`, or `C/B` where C carries the part and B the
        tool; `table` or `tool-relative`: how angles of a table are counted.

    Raises
    ------
    MachineError
        The file is no machine that is read, contradicts itself, or leaves open what decides where the tool can point.

    Examples
    --------
    >>> read_machine("none.fcm")
    Traceback (most recent call last):
    plan_cutters.errors.MachineError: none.fcm: cannot be read: No such file or directory
    """
    return described(path, added)[0]


def described(path: str | os.PathLike[str], added: str = "") -> tuple[Machine, str]:
    """The same, and the name of the format."""
    try:
        file = Path(path)
    except TypeError:
        raise MachineError(f"a machine file is a file's name, not a value of type {type(path).__name__}") from None
    content = Content.of(file)
    form = recognised(content)
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

    Raises
    ------
    MachineError

    Examples
    --------
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
