"""What a user chose last, in FreeCAD's parameters: not what was picked, which belongs to a document."""

from __future__ import annotations

import json
from dataclasses import dataclass, fields

from . import host


@dataclass(frozen=True)
class Choices:
    """Choices of the panel, each under its name with a capital letter in the parameters.

    Parameters
    ----------
    faces : str
        `sculptured,blends`, `all`, or `picked`.
    libraries, typed : tuple of str
        Tool libraries (paths) and tools in short words.
    holder : str
        Of the tools that have none.
    stick_out : float
        mm, of the tools that state none; 0: not given.
    machine, setup : str
        As the program has them; a picked setup axis is not remembered.
    allowance : float
        mm.
    table : bool
        Whether a table under the part is in the way.
    operations : str
        `fewest`, `fastest`, `both`, or empty for none.
    more : str
        More words for the program.
    show_tool : bool
        Whether the tool is shown at a worst spot.
    """

    faces: str = "sculptured,blends"
    libraries: tuple[str, ...] = ()
    typed: tuple[str, ...] = ()
    holder: str = ""
    stick_out: float = 0.0
    machine: str = ""
    setup: str = "+z"
    allowance: float = 0.0
    table: bool = False
    operations: str = ""
    more: str = ""
    show_tool: bool = True


def _key(name: str) -> str:
    return "".join(word.capitalize() for word in name.split("_"))


def load() -> Choices:
    """What was chosen last; where a value cannot be read, what is chosen at first."""
    kept, values = host.settings(), {}
    for each in fields(Choices):
        key, first = _key(each.name), each.default
        if isinstance(first, bool):
            values[each.name] = kept.GetBool(key, first)
        elif isinstance(first, float):
            values[each.name] = kept.GetFloat(key, first)
        elif isinstance(first, str):
            values[each.name] = kept.GetString(key, first)
        else:
            values[each.name] = _words(kept.GetString(key, "[]"))
    return Choices(**values)


def _words(text: str) -> tuple[str, ...]:
    try:
        found = json.loads(text)
    except ValueError:
        return ()
    return tuple(each for each in found if isinstance(each, str)) if isinstance(found, list) else ()


def save(choices: Choices) -> None:
    """Keep choices for the next time."""
    kept = host.settings()
    for each in fields(Choices):
        key, value = _key(each.name), getattr(choices, each.name)
        if isinstance(value, bool):
            kept.SetBool(key, value)
        elif isinstance(value, float):
            kept.SetFloat(key, value)
        elif isinstance(value, str):
            kept.SetString(key, value)
        else:
            kept.SetString(key, json.dumps(list(value)))
