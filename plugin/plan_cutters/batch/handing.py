"""How options and a part come to the command in a worker's child: in a file that its parent names, not in words.

Only the environment names it, for a pickle must come from nobody but ourselves.
"""

import functools
import os
import pickle
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from cad_io import Part
    from plan_cutters.options import Options

#: Environment variable: the file.
FILE = "PLAN_CUTTERS_HANDED"
#: And the process with which the command is to end (`command.worker.PARENT`).
PARENT = "PLAN_CUTTERS_PARENT"


def packed(options: bytes, part: bytes | None) -> bytes:
    """The content of the file."""
    return pickle.dumps({"options": options, "part": part}, protocol=5)


def options() -> "Options | None":
    """The options that were handed to this process; None where its words have them."""
    return pickle.loads(_content()["options"]) if FILE in os.environ else None


def holds_part() -> bool:
    """Whether the part was handed, too."""
    return FILE in os.environ and _content()["part"] is not None


def part() -> "Part":
    """The part that was handed: this loads the CAD kernel."""
    found: Part = pickle.loads(_content()["part"])
    return found


@functools.cache
def _content() -> dict[str, Any]:
    with open(os.environ[FILE], "rb") as opened:
        return dict(pickle.load(opened))
