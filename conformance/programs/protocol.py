"""What a program that is scored has to offer, and what adapters share."""

from collections import Counter
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from conformance.posture import Postures
from conformance.suite import Held, Part
from conformance.tool import Floats, Tool

Words = NDArray[np.str_]

#: What a program may answer about a posture.
SAFE, BLOCKED, UNDECIDED = "safe", "blocked", "undecided"
ANSWERS = (SAFE, BLOCKED, UNDECIDED)


class Program(Protocol):
    """A program as the runner sees it.

    Attributes
    ----------
    name : str
        As the command has it.
    settings : mapping
        All that a user of the library would choose: mesh chord error, tolerance, sampling. Written into the results.
    libraries : tuple of str
        Distributions whose versions are written into the results.
    why : Counter
        Why postures are undecided, with counts; also a note about a part or tool that the program cannot take.
    """

    name: str
    settings: dict[str, Any]
    libraries: tuple[str, ...]
    why: Counter[str]

    def prepare(self, part: Part) -> None:
        """Read a part: what is done once, whatever the number of postures."""

    def answer(self, part: Part, tool: Tool, setup: Held, postures: Postures) -> Words:
        """Return a word (n,) for each posture: one of `ANSWERS`. The known answers are blanked."""


class Claimer(Protocol):
    """A program that has postures of its own: its claims are judged by the truth.

    `claims` gives postures whose `verdict` is what the program claims; `low` and `high` are nan.
    """

    name: str
    settings: dict[str, Any]
    libraries: tuple[str, ...]
    why: Counter[str]

    def prepare(self, part: Part) -> None:
        """Read a part."""

    def claims(self, part: Part, tool: Tool, setup: str) -> Postures:
        """Return postures that the program calls safe or blocked, of a tool in a setup by its name."""


class Unavailable(Exception):
    """A program cannot run here: the text says in one line what to install."""


def blind(postures: Postures) -> Postures:
    """Return postures without their known answers."""
    n = len(postures)
    unknown, none = np.full(n, np.nan), np.full(n, "")
    return replace(postures, verdict=none, low=unknown, high=unknown, limit_deg=unknown, reason=none, proof=none)


def claimed(part: Part, tool: Tool, setup: str, rows: Mapping[str, Any]) -> Postures:
    """Return a table of claims.

    `rows` has `contact, normal, axis (n, 3)` and `verdict (n,)`, and `tip (n, 3)` where the tool has it elsewhere.
    """
    contact, normal, axis = (np.asarray(rows[name], float).reshape(-1, 3) for name in ("contact", "normal", "axis"))
    n = len(contact)
    tip = rows.get("tip")
    tip = tool.stands(contact, normal, axis) if tip is None else np.asarray(tip, float).reshape(-1, 3)
    unknown, word = np.full(n, np.nan), lambda text: np.full(n, text)
    verdict = np.asarray(rows["verdict"], dtype="U9")
    return Postures(word(part.name), word(tool.name), word(setup), contact, normal, axis, tip, verdict, unknown, unknown, unknown, word(""), word(""))


def beyond_limit(setup: Held, axis: Floats) -> NDArray[np.bool_]:
    """Whether axes (n, 3) lie beyond the machine's limit: a user of any library writes this line."""
    if setup.limit_deg is None:
        return np.zeros(len(axis), bool)
    up = np.array(setup.axis, float) / np.linalg.norm(setup.axis)
    angle = np.degrees(np.arctan2(np.linalg.norm(np.cross(axis, up), axis=1), axis @ up))
    return np.asarray(angle > setup.limit_deg)


def below_table(tool: Tool, setup: Held, axis: Floats, tip: Floats, tolerance: float) -> NDArray[np.bool_]:
    """Whether a tool (n,) reaches into the table of a setup by more than the tolerance: its lowest point, by its support."""
    if setup.table is None:
        return np.zeros(len(axis), bool)
    up = np.array(setup.axis, float) / np.linalg.norm(setup.axis)
    down = np.broadcast_to(-up, axis.shape)
    lowest = np.min([-piece.support(down, tip, axis) for piece in tool.pieces], axis=0)
    return np.asarray(lowest < setup.table - tolerance)


def within_boxes(setup: Held, points: Floats, tolerance: float) -> NDArray[np.bool_]:
    """Whether points (..., 3) lie deeper than the tolerance in a box of a setup."""
    out = np.zeros(points.shape[:-1], bool)
    for low, high in setup.boxes:
        out |= np.all((points > np.array(low) + tolerance) & (points < np.array(high) - tolerance), axis=-1)
    return out


def answered(blocked: NDArray[np.bool_]) -> Words:
    """Return `blocked` or `safe` (n,)."""
    return np.where(blocked, BLOCKED, SAFE)
