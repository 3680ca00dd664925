"""Write the codes and constants that the page shares with the program: `page/src/codes.ts`, from the tables in Python.

`python page/codes.py` writes the file; `python page/codes.py --check` writes nothing and fails where it differs.
"""

import json
import math
import sys
from pathlib import Path

from plan_cutters.domain.figures import ALL_BUT, HARDLY_ANY, ROUNDING
from plan_cutters.domain.kinematics import SINGULAR
from plan_cutters.kernels.codes import ON_LIMIT, PARALLEL
from plan_cutters.plan_file.reasons import MET, NO_CONTACT

FILE = Path(__file__).parent / "src" / "codes.ts"

_STATES = ("free", "axis_limit", NO_CONTACT.code, *MET, "fixture", "undecided", "tolerance", "buried")
#: Each constant with its comment and its value; a tuple is written as a constant list.
_CONSTANTS = {
    "STATES": ("States of a posture in a map: what can forbid it stands in the order in which it is told.", _STATES),
    "OUTERMOST": (
        "What a tool meets, from its upper end down: a fixture can be moved, as a holder can be changed.",
        (MET[-1], "fixture", *MET[-2::-1]),
    ),
    "PARALLEL": ("Sines of less are none.", PARALLEL),
    "ON_LIMIT": ("By so much an axis may be beyond a limit and still be on it, rad.", ON_LIMIT),
    "SINGULAR": ("Nearer to the first rotary axis than this, degrees, the machine turns fast.", math.degrees(SINGULAR)),
    "ROUNDING": ("What rounding leaves of nothing is below this.", ROUNDING),
    "HARDLY_ANY": ("How a share is written that would be rounded to none.", HARDLY_ANY),
    "ALL_BUT": ("How a share is written that would be rounded to the whole.", ALL_BUT),
}


def text() -> str:
    """The text of the file."""
    lines = ["// Made by `python page/codes.py` from the tables of the program: change those, not this."]
    for name, (comment, value) in _CONSTANTS.items():
        listed = json.dumps(value) + (" as const" if isinstance(value, tuple) else "")
        lines += ["", f"/** {comment} */", f"export const {name} = {listed};"]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    if "--check" not in sys.argv:
        FILE.write_text(text(), encoding="utf-8")
    elif FILE.read_text(encoding="utf-8") != text():
        raise SystemExit("page/src/codes.ts is not up to date: run python page/codes.py and commit what it writes")
