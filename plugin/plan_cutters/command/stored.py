"""Another machine or setup on posture maps that are stored: no part is read, nothing is searched."""

import json
from collections.abc import Collection
from pathlib import Path
from typing import TYPE_CHECKING, Any

from plan_cutters.command import terminal
from plan_cutters.command.codes import FEASIBLE, NONE_FEASIBLE, NOT_ALL_JUDGED

if TYPE_CHECKING:
    from plan_cutters.options import Options

#: Parameters of the command that name an option otherwise than `Options` does.
_OPTIONS = {"cutter": "cutters", "fixture": "fixtures"}
#: Parameters that are about files, which are not written here.
_FILES = {"out": "-o", "formats": "--formats", "step_schema": "--step-schema"}
#: Obstacles that are listed.
_LISTED = 3


def stored(part: str, postures: str, options: "Options", given: dict[str, Any], named: Collection[str]) -> int:
    """Say what a cutter reaches on the machine that is asked for, by its posture maps of the part; the exit code.

    Parameters
    ----------
    part, postures : str
        Their files.
    options : Options
    given : dict
        The parameters of the command.
    named : collection of str
        Those that were given: the others mean what the maps were made with.

    Raises
    ------
    OptionError
        The maps are of another part or question, or cannot be read.
    """
    import numpy as np

    from plan_cutters.domain.verdicts import WORDS
    from plan_cutters.errors import OptionError
    from plan_cutters.scene.question import setup_of, words_of
    from plan_cutters.stages.posture_maps import PostureMaps

    for word, option in _FILES.items():
        if word in named:
            raise OptionError(f"{option}: nothing is written with --postures; leave it out")
    maps, name = PostureMaps.load(postures), Path(postures).name
    try:
        reach = maps.asked(part, **_asked(options, given, named), jobs=options.jobs)
        setup = options.setup if "setup" in named else setup_of(maps.about).z
        missing, unjudged = maps.missing, words_of(maps.about, "unjudged_faces")
    except OptionError as error:
        if error.file:
            raise
        raise OptionError(error.cause, file=name) from None
    # What lies inside another body is no surface of the finished part.
    verdict = reach.verdict[~maps.inside]
    counts = {word: int((verdict == code).sum()) for code, word in WORDS.items()}
    inside = int(np.count_nonzero(maps.inside))
    if given["json_out"] == "-":
        answer = {"format": "plan-cutters-stored", "part": Path(part).name, "cutter": maps.cutter,
                  "machine": options.machine.name, "setup": setup, "samples": counts, "inside_bodies": inside,
                  "missing": list(missing), "unjudged_faces": list(unjudged), "asked": dict(maps.about)}  # fmt: skip
        terminal.hand_out(json.dumps(answer, indent=2) + "\n")
    if not given["quiet"]:
        axis = ",".join(f"{x:.4g}" for x in setup)
        said = ", ".join(f"{count} {word.replace('_', ' ')}" for word, count in counts.items() if count)
        lines = [f"{Path(part).name}: {maps.cutter} on {options.machine.name}, setup {axis}, by {name}: {said}"]
        if inside:
            lines.append(f"{inside} more samples lie inside another body of the part: they are no surface of it.")
        if counts["undecided"]:
            lines.append(
                "What is undecided here, a plan with this machine may decide: the maps leave narrow bands of tilt open."
            )
        if maps.unmapped:
            lines.append(f"{maps.unmapped} samples were not mapped (--map-budget): they are undecided.")
        if missing:
            lines.append(f"Obstacles are missing or guessed, so nothing is beyond doubt: {_some(missing)}.")
        if unjudged:
            lines.append(f"Not judged: {_some(unjudged)}.")
        terminal.say(*(terminal.clean(line) for line in lines))
    if counts["inaccessible"]:
        return NONE_FEASIBLE
    return NOT_ALL_JUDGED if counts["undecided"] or counts["unjudged"] or missing or unjudged else FEASIBLE


def _asked(options: "Options", given: dict[str, Any], named: Collection[str]) -> dict[str, Any]:
    """What was asked for, by the names of `Options`."""
    from dataclasses import fields

    known = {each.name for each in fields(options)}
    words = {_OPTIONS.get(name, name) for name in named} & known
    if "cutters" in named:  # files of tools; what the command calls `cutter` are cutters
        words = words - {"cutters"} | {"libraries"} | ({"cutters"} if "cutter" in named else set())
    if "setup" in named:
        words |= {"placement"} | ({"other_setups"} if len(given["setup"]) > 1 else set())
    if options.fixtures:  # a setup file brings some, too
        words |= {"fixtures"}
    return {word: getattr(options, word) for word in sorted(words - {"jobs"})}


def _some(words: Collection[str]) -> str:
    """The first few of a list."""
    more = f" and {len(words) - _LISTED} more" if len(words) > _LISTED else ""
    return ", ".join(list(words)[:_LISTED]) + more
