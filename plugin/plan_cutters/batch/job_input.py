"""How options, a part and a cluster come to the command in a worker's child: in a file that its parent names, not in words.

Only the environment names it, for a pickle must come from nobody but ourselves.
"""

import functools
import os
import pickle
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from cad_io import Part
    from plan_cutters.options import Options

#: Environment variable: the file.
FILE = "PLAN_CUTTERS_HANDED"
#: And the process with which the command is to end (`command.worker.PARENT`).
PARENT = "PLAN_CUTTERS_PARENT"


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
    return pickle.loads(_content()["options"]) if FILE in os.environ else None


def holds_part() -> bool:
    """Whether the part was handed, too."""
    return FILE in os.environ and _content()["part"] is not None


def part() -> "Part":
    """The part that was handed: this loads the CAD kernel."""
    result: Part = pickle.loads(_content()["part"])
    return result


def offer() -> Offer | None:
    """The cluster that is lent to this process; None where there is none."""
    return _content()["offer"] if FILE in os.environ else None


def key() -> bytes | None:
    """The key of kept verdicts that was handed to this process; None where there is none."""
    result: bytes | None = _content()["key"] if FILE in os.environ else None
    return result


@functools.cache
def _content() -> dict[str, Any]:
    with open(os.environ[FILE], "rb") as opened:
        return dict(pickle.load(opened))
