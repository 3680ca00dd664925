"""Another machine or setup on posture maps that are stored: no part is read, nothing is searched."""

import hashlib
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from plan_cutters.command import terminal

if TYPE_CHECKING:
    from plan_cutters.options import Options

_REACHED, _LEFT = 0, 1


def stored(part: str, postures: str, options: "Options", given: dict[str, Any]) -> int:
    """Say what a cutter reaches on the machine that is asked for, by its posture maps of the part; the exit code.

    Raises
    ------
    OptionError
        The maps are of another part or cutter, or cannot be read.
    """
    import numpy as np

    from plan_cutters.domain.verdicts import ACCESSIBLE, INACCESSIBLE, INTERFERENCE_FREE, UNDECIDED, UNJUDGED
    from plan_cutters.errors import OptionError
    from plan_cutters.stages.posture_maps import PostureMaps

    maps, name = PostureMaps.load(postures), Path(postures).name
    try:
        found = hashlib.sha256(Path(part).read_bytes()).hexdigest()
    except OSError as error:
        raise OptionError(f"cannot be read: {error.strerror}", file=part) from None
    if not maps.part or found != maps.part:
        raise OptionError(f"its posture maps are of another part than {Path(part).name}: write them again with "
                          "--posture-maps", file=name)  # fmt: skip
    if options.cutters and maps.cutter not in {cutter.id for cutter in options.judged}:
        raise OptionError(f"its posture maps are of cutter {maps.cutter}, which was not asked for", file=name)
    place = options.placement
    if place is not None and (place.clamped or place.fixtures):
        raise OptionError("posture maps keep the faces and fixtures that they were made with: leave out clamped and fixtures",
                          file=place.file)  # fmt: skip
    low, high = (np.clip(end, *maps.tilt) for end in options.tilt)
    rotation = None if options.rotation[1] - options.rotation[0] > 2 * np.pi - 1e-9 else options.rotation
    reach = maps.within(options.machine, options.setup, tilt=(low, high), rotation=rotation, jobs=options.jobs,
                        x=None if place is None else place.x)  # fmt: skip
    words = {INTERFERENCE_FREE: "interference_free", ACCESSIBLE: "accessible", UNDECIDED: "undecided",
             INACCESSIBLE: "inaccessible", UNJUDGED: "unjudged"}  # fmt: skip
    counts = {word: int((reach.verdict == code).sum()) for code, word in words.items()}
    if given["json_out"] == "-":
        answer = {"format": "plan-cutters-stored", "part": Path(part).name, "cutter": maps.cutter,
                  "machine": options.machine.name, "setup": options.setup, "samples": counts}  # fmt: skip
        terminal.hand_out(json.dumps(answer, indent=2) + "\n")
    if not given["quiet"]:
        axis = ",".join(f"{x:.4g}" for x in options.setup)
        said = ", ".join(f"{count} {word.replace('_', ' ')}" for word, count in counts.items() if count)
        terminal.say(
            terminal.clean(
                f"{Path(part).name}: {maps.cutter} on {options.machine.name}, setup {axis}, by {name}: {said}"
            )
        )
        if counts["undecided"]:
            terminal.say(
                "What is undecided here, a plan with this machine may decide: the maps leave narrow bands of tilt open."
            )
    return _LEFT if counts["inaccessible"] or counts["undecided"] else _REACHED
