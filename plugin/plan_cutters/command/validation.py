"""Check the words of the command line before any large module is loaded and any process is started.

Cheap questions come first: files before numbers, so that a name that is mistyped costs nothing.
"""

import math
import os
import sys
from collections.abc import Sequence
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cad_io.errors import CadIoError, ReadError
from plan_cutters.command.entry import commands
from plan_cutters.command.request import PlanningRequest, PlanRequest, planning_options
from plan_cutters_base.whole import refusal

if TYPE_CHECKING:
    from plan_cutters.options import Options

#: Options that count in a plan of operations alone: without one they must not be ignored.
OF_OPERATIONS = ("feed", "scallop", "stepover", "index_step", "index_time", "change_time", "setup_time",
                 "overlap", "most_operations", "max_orientations")  # fmt: skip
#: Bytes of memory below which nothing can be planned.
LEAST_MEMORY = 2e9


def check(request: PlanRequest) -> "tuple[Options, list[CadIoError]]":
    """Options, and why some of several parts cannot be read.

    Raises
    ------
    CadIoError
        No part can be read, or a fixture cannot.
    PlanError
        An option has no meaning, or a library or machine file cannot be used.
    """
    _first_word(request.parts[0])
    _words(request)
    faults = _faults(request.parts)
    if len(faults) == len(request.parts):
        raise faults[0]
    for out in folders(request):
        writable(out)
    options = options_of(request)
    look_at(options)
    return options, faults


def _first_word(word: str) -> None:
    """Refuse a first word that is no file and nearly a command: the other words would be planned in its place."""
    from plan_cutters.domain.checks import did_you_mean
    from plan_cutters.errors import OptionError

    meant = "" if os.path.exists(word) else did_you_mean(word, commands())
    if meant:
        raise OptionError(f"{word} is neither a command nor a file{meant}")


def folders(request: PlanRequest) -> list[Path]:
    """The output folder of each part; none where only standard output is written."""
    from plan_cutters.errors import OptionError

    if request.json_out == "-" and request.out is None and request.formats is None:
        return []
    if request.out is not None and len(request.parts) > 1:
        outs = [Path(request.out) / f"{Path(p).stem}-plan" for p in request.parts]
    else:
        outs = [Path(request.out or f"{Path(p).stem}-plan") for p in request.parts]
    if len(set(outs)) < len(outs):
        twice = next(str(out) for out in outs if outs.count(out) > 1)
        raise OptionError(f"two parts have the same name and would write to the same folder, {twice}; plan them one by one")
    return outs


def _words(request: PlanRequest) -> None:
    """Options that need no file and no number to be read."""
    from plan_cutters.errors import OptionError
    from plan_cutters.report.folder import read_formats

    if request.formats is not None:
        read_formats(request.formats)
    _json_out(request)
    if (files := request.case_files) is not None:
        files.check()
    if request.out == "":
        raise OptionError("-o: the folder has no name")
    if "" in request.parts:
        raise OptionError("PART: a file has no name")
    _plans_nothing(request)
    if request.check_operations is None:
        refuse_unplanned_operations(request)
    if request.check_operations is not None and not os.path.isfile(request.check_operations):
        raise OptionError("no such file: give the plan.json of a plan of operations", file=request.check_operations)
    if not 0.0 < request.read_timeout < math.inf:
        raise OptionError("--read-timeout must be a positive number of seconds")
    if request.fail_under is not None and not 0.0 < request.fail_under <= 100.0:
        raise OptionError("--fail-under must be a percentage above 0 and up to 100")
    if request.timeout is not None and not 0.0 < request.timeout < math.inf:
        raise OptionError("--timeout must be a positive number of seconds")
    if request.memory is not None and not LEAST_MEMORY <= request.memory * 1e9 < 1e18:
        raise OptionError("--memory must be at least 2 GB")


def scheduler(address: str) -> None:
    """Refuse what is neither a file nor an address.

    Raises
    ------
    OptionError
    """
    from plan_cutters.errors import OptionError

    if not os.path.isfile(address) and "://" not in address:
        raise OptionError("no such file, and no address as tcp://HOST:8786", file=f"--cluster {address}")


def _json_out(request: PlanRequest) -> None:
    from plan_cutters.errors import OptionError

    if request.process is not None and len(request.parts) > 1:
        raise OptionError("--process names faces of one part: give one part")
    if request.json_out not in (None, "-"):
        raise OptionError("--json takes -, for standard output; --formats json writes plan.json into the folder")
    if request.json_out and len(request.parts) > 1:
        raise OptionError("--json - writes one plan: give one part, or -o DIR --formats json for a file of each")
    if request.json_out and sys.stdout is None:
        raise OptionError("--json -: standard output is closed")


def _plans_nothing(request: PlanRequest) -> None:
    """Refuse what is about planning, and several parts, where something that was planned is looked at."""
    from plan_cutters.errors import OptionError

    if request.check_operations is None:
        return
    word = "--check-operations"
    if any(str(each).lower() == "auto" for each in request.setup):
        raise OptionError(f"--setup auto plans what it proposes, and {word} plans nothing: name the setup")
    planning = [each for each in ("junit", "sarif") if getattr(request, each) is not None]
    if planning:
        raise OptionError(f"--{planning[0]} is about planning, and {word} plans nothing: leave one of them out")
    if len(request.parts) > 1:
        raise OptionError(f"{word} is about one part")


def refuse_unplanned_operations(request: PlanningRequest) -> None:
    """Refuse options of a plan of operations where none is requested.

    Raises
    ------
    OptionError
    """
    from plan_cutters.errors import OptionError

    if request.operations is not None or getattr(request, "process", None) is not None:
        return
    from plan_cutters.option_types import ANGLES
    from plan_cutters.options import Options

    defaults: dict[str, Any] = {each.name: each.default for each in fields(Options)}
    for name in OF_OPERATIONS:
        default = defaults[name]
        if name in ANGLES and default is not None:  # the command takes degrees
            default = round(math.degrees(default), 9)
        if getattr(request, name) != default:
            word = f"--{name.replace('_', '-')}"
            raise OptionError(f"{word} is about a plan of operations: give it with --operations, or leave it out")


def _faults(parts: Sequence[str]) -> list[CadIoError]:
    """Why parts cannot be read, as far as their first bytes tell."""
    from cad_io.read.sniff import kind
    from plan_cutters_base.workers.assignment import job_input

    errors: list[CadIoError] = []
    for part in () if job_input().part else parts:
        try:
            kind(part)
        except CadIoError as error:
            errors.append(error)
    return errors


def writable(out: Path) -> None:
    """An error where a folder can surely not be written.

    Raises
    ------
    PlanError
    """
    from plan_cutters.errors import PlanError

    if out.exists() and not out.is_dir():
        raise PlanError("the output must be a folder, this is a file; give another with -o", file=str(out))
    # What grows stands beside the folder, and then in it; folders that are not there are made.
    for folder in (out.absolute().parent, *([out] if out.exists() else [])):
        if why := refusal(folder):
            raise PlanError(f"cannot write there ({why}); give another folder with -o", file=str(out))


def look_at(options: "Options") -> None:
    """An error for words for faces that say nothing, and for fixtures whose file cannot be read."""
    from plan_cutters.scene.faces import grammar

    names = options.ignore if isinstance(options.ignore, list | tuple) else (options.ignore,)
    for option, text in (("--faces", options.faces), *(("--ignore", each) for each in names)):
        if isinstance(text, str):
            grammar(text, option)
    others = [each for place in options.other_placements if place is not None for each in place.fixtures]
    for fixture in (*options.fixtures, *others):
        if isinstance(fixture.source, str) and not fixture.kind:
            _fixture(fixture.source)


def _fixture(file: str) -> None:
    """An error for the file of a fixture that is missing, empty or of no format that fixtures have."""
    from cad_io.read.sniff import kind
    from plan_cutters.domain.fixture import CAD, MESH, no_format

    suffix = Path(file).suffix.lower()
    if suffix in CAD:
        kind(file)
    elif suffix in MESH:
        if not os.path.exists(file):
            raise ReadError("no such file", file=file)
        if not os.path.isfile(file):
            raise ReadError("is not a file", file=file)
    else:
        raise ReadError(no_format(file), file=file)


def options_of(request: PlanningRequest) -> "Options":
    """The options of a plan, from the words of the command line; a PlanError for what has no meaning."""
    import pickle

    from plan_cutters.options import Options
    from plan_cutters_base.workers.assignment import job_input

    # A batch has looked at its words already, perhaps on another machine.
    handed = job_input().options
    options: Options = pickle.loads(handed) if handed else Options(**planning_options(request))
    return options
