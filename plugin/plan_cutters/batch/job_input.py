"""How options, a part and a cluster come to the command in a worker's child: in a file that its parent names, not in words.

Only the `Assignment` names it, for a pickle must come from nobody but ourselves.
"""

import functools
import pickle
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from plan_cutters.workers.assignment import assignment

if TYPE_CHECKING:
    from cad_io import Part
    from plan_cutters.options import Options


@dataclass(frozen=True)
class Offer:
    """What a task of a batch offers to the process that plans its part.

    Attributes
    ----------
    scheduler : str
        Address.
    turn : str
        One part of a worker has it at a time: memory of a worker is not for several large parts.
    said : str
        The file that says to the task that the offer is taken: it gives its place at the worker to another part.
    """

    scheduler: str
    turn: str
    said: str


def packed(options: bytes, part: bytes | None, offer: Offer | None = None, key: bytes | None = None) -> bytes:
    """The content of the file."""
    return pickle.dumps({"options": options, "part": part, "offer": offer, "key": key}, protocol=5)


def options() -> "Options | None":
    """The options that were handed to this process; None where its words have them."""
    handed = _content()["options"]
    return None if handed is None else pickle.loads(handed)


def holds_part() -> bool:
    """Whether the part was handed, too."""
    return _content()["part"] is not None


def part() -> "Part":
    """The part that was handed: this loads the CAD kernel."""
    result: Part = pickle.loads(_content()["part"])
    return result


def offer() -> Offer | None:
    """The cluster that is lent to this process; None where there is none."""
    return _content()["offer"]


def key() -> bytes | None:
    """The key of kept verdicts that was handed to this process; None where there is none."""
    result: bytes | None = _content()["key"]
    return result


def _content() -> dict[str, Any]:
    file = assignment().job
    return dict.fromkeys(("options", "part", "offer", "key")) if file is None else _read(file)


@functools.cache
def _read(file: str) -> dict[str, Any]:
    with open(file, "rb") as opened:
        return dict(pickle.load(opened))
