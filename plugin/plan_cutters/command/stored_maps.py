"""`plan-cutters stored`: another machine or setup on posture maps that are stored; nothing is read but them, or searched."""

import json
from collections.abc import Collection, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import click

from plan_cutters.command import terminal
from plan_cutters.command.codes import ENDED, FEASIBLE, NONE_FEASIBLE, NOT_ALL_JUDGED, run
from plan_cutters.command.help_groups import Command, named
from plan_cutters.command.option_groups import options
from plan_cutters.command.request import StoredRequest, judging_options, takes
from plan_cutters.command.validation import NAMED
from plan_cutters.command.values import File
from plan_cutters.files.terminal_text import clean

if TYPE_CHECKING:
    from plan_cutters.command.request import PlanRequest
    from plan_cutters.options import Options
    from plan_cutters.stages.posture_maps import PostureMaps

_SELF = "plan-cutters stored"
#: Parameters that are about files, which are not written here.
_FILES = {"out": "-o", "formats": "--formats", "step_schema": "--step-schema"}
#: Obstacles that are listed.
_LISTED = 3


@click.command(
    cls=Command,
    examples=(
        (f"{_SELF} blade-plan/postures.npz --machine trunnion-ac", "On another machine:"),
        (f"{_SELF} blade-plan/postures.npz blade.step --setup +x", "In another setup, if blade.step is still that part:"),
    ),
    codes=(
        ("0", "the cutter reaches every sample"),
        ("1", "it does not"),
        ("2", "the command line is wrong, or the maps cannot answer it"),
        ("3", "the part cannot be read"),
        ("4", "it reaches all that is known, but something is undecided or was not judged, or obstacles are missing"),
        ENDED,
    ),
)
@click.argument("file", metavar="FILE", type=File("FILE"))
@click.argument("part", metavar="[PART]", required=False, type=File("PART"))
@options(
    "cutter", "cutters", "holder", "assume_stickout", "skip_bad", "machine", "setup", "fixture", "faces", "ignore", "flip",
    "unit", "spacing", "grid", "tolerance", "allowance", "holder_clearance", "tilt", "rotation", "rotation_step", "quiet", "jobs",
    "debug", json={"help": "The answer on standard output."}, defaults=False,
)  # fmt: skip
@takes(StoredRequest)
def command(request: StoredRequest) -> int:
    """Judge the cutter of FILE on another machine, in another setup, or within fewer tilts and rotations.

    FILE is the postures.npz that a plan writes with --posture-maps; with PART, it must be of this part. Options that are not
    given stay as the maps were made; a question that the maps cannot answer is refused.
    """
    from cad_io.read.sniff import kind
    from plan_cutters.command.validation import look_at, maps_file
    from plan_cutters.errors import OptionError
    from plan_cutters.options import Options

    if request.json_out not in (None, "-"):
        raise OptionError("--json takes -, for standard output")
    maps_file(request.file)
    if request.part is not None:
        kind(request.part)
    requested = Options(**judging_options(request))
    look_at(requested)
    return stored(request.part, request.file, requested, request, named())


def main(args: Sequence[str] | None = None, name: str = _SELF) -> NoReturn:
    """Run the command."""
    run(command, name, args)


def stored(
    part: str | None, postures: str, options: "Options", request: "StoredRequest | PlanRequest", named: Collection[str]
) -> int:
    """Say what a cutter reaches on the machine that is requested, by its posture maps of the part; the exit code.

    Parameters
    ----------
    part : str, optional
        Its file; not looked at where there is none.
    postures : str
        The file of the maps.
    options : Options
    request : StoredRequest or PlanRequest
    named : collection of str
        Its fields that stand on the command line: the others mean what the maps were made with.

    Raises
    ------
    OptionError
        The maps are of another part or question, or cannot be read.
    """
    import numpy as np

    from plan_cutters.domain.placement import axis_words
    from plan_cutters.domain.verdicts import WORDS
    from plan_cutters.errors import OptionError
    from plan_cutters.scene.question import setup_of, words_of
    from plan_cutters.stages.posture_maps import PostureMaps

    for word, option in _FILES.items():
        if word in named:
            raise OptionError(f"{option}: nothing is written with --postures; leave it out")
    maps, name = PostureMaps.load(postures), Path(postures).name
    try:
        reach = maps.asked(part, **_requested(options, request, named), jobs=options.jobs)
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
    if request.json_out == "-":
        answer = {"format": "plan-cutters-stored", "format_version": 1, "part": part and Path(part).name,
                  "cutter": maps.cutter,
                  "machine": options.machine.name, "setup": setup, "samples": counts, "inside_bodies": inside,
                  "missing": list(missing), "unjudged_faces": list(unjudged), "asked": dict(maps.about)}  # fmt: skip
        terminal.hand_out(json.dumps(answer, indent=2) + "\n")
    if not request.quiet:
        on = f"{maps.cutter} on {options.machine.name}, setup {axis_words(setup)}"
        lines = [
            f"{Path(part).name if part else name}: {on}, by {name}: {_counted(counts)}",
            *_remarks(maps, inside, counts["undecided"], missing, unjudged),
        ]
        tells = terminal.say if request.json_out == "-" else terminal.show
        tells(*(clean(line) for line in lines))
    if counts["inaccessible"]:
        return NONE_FEASIBLE
    return NOT_ALL_JUDGED if counts["undecided"] or counts["unjudged"] or missing or unjudged else FEASIBLE


def _counted(counts: dict[str, int]) -> str:
    return ", ".join(f"{count} {word.replace('_', ' ')}" for word, count in counts.items() if count)


def _remarks(maps: "PostureMaps", inside: int, undecided: int, missing: Sequence[str], unjudged: Sequence[str]) -> Iterator[str]:
    """What must be said of an answer from posture maps."""
    from plan_cutters.plan_file.numbers import listed

    if inside:
        yield f"{inside} more samples lie inside another body of the part: they are no surface of it."
    if undecided:
        yield "What is undecided here, a plan with this machine may decide: the maps leave narrow bands of tilt open."
    if maps.unmapped:
        yield f"{maps.unmapped} samples were not mapped (--map-budget): they are undecided."
    if missing:
        yield f"Obstacles are missing or guessed, so nothing is beyond doubt: {listed(missing, _LISTED)}."
    if unjudged:
        yield f"Not judged: {listed(unjudged, _LISTED)}."


def _requested(options: "Options", request: "StoredRequest | PlanRequest", named: Collection[str]) -> dict[str, Any]:
    """Gather the options that the user gave, by the names of `Options`."""
    from dataclasses import fields

    known = {each.name for each in fields(options)}
    words = {NAMED.get(name, name) for name in named} & known
    if "setup" in named:
        words |= {"placement"} | ({"other_setups"} if len(request.setup) > 1 else set())
    if options.fixtures:  # a setup file brings some, too
        words |= {"fixtures"}
    return {word: getattr(options, word) for word in sorted(words - {"jobs"})}
