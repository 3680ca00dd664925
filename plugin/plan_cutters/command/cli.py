"""The command line: options in, exit code out."""

import contextlib
import gc
import math
import os
import signal
import sys
import tempfile
from collections.abc import Iterator, Sequence
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import BinaryIO, NoReturn

import click

from cad_io.errors import CadIoError
from plan_cutters.command import option_groups, terminal
from plan_cutters.command.codes import CODES, USAGE, ended, guarded, interrupt, invoked, keep_interrupts, raise_interrupts
from plan_cutters.command.entry import module_of, sentences
from plan_cutters.command.option_groups import EXAMPLES, options
from plan_cutters.command.progress import PartCases
from plan_cutters.command.request import PlanRequest, takes
from plan_cutters.command.validation import File
from plan_cutters.errors import OptionError
from plan_cutters_base.terminal_text import clean
from plan_cutters_base.workers.child import (
    INTERRUPTED,
    assignment,
    began,
    can_supervise,
    is_child,
    limit_memory,
    report,
    wait_to_begin,
)
from plan_cutters_base.workers.prompt import is_waited_for, let_go
from plan_cutters_base.workers.supervise import Supervised, Unfinished, default_memory

#: The word for standard input.
PIPE = "-"
#: Names of files by the kind that their content tells.
_SUFFIXES = {"step": ".step", "iges": ".igs", "brep": ".brep", "binary brep": ".brep"}


@contextlib.contextmanager
def spooled(command: click.Command, words: Sequence[str]) -> Iterator[list[str]]:
    """The words of a command, with a file of what comes through the pipe in place of `-`; the file is removed in the end.

    Its name is `stdin`, with the suffix of its kind, so that a plan says where its part came from. The kernel opens a part
    more than once, which a pipe does not allow. OptionError where `-` stands twice, or nothing is piped; ReadError where what
    comes is no CAD file.
    """
    # Behind an option that takes a value the word is that value, as in `--json -`.
    valued = {each for p in command.params if isinstance(p, click.Option) and not (p.is_flag or p.count) for each in p.opts}
    places = [k for k, word in enumerate(words) if word == PIPE and (k == 0 or words[k - 1] not in valued)]
    if not places:
        yield list(words)
        return
    if len(places) > 1:
        raise OptionError("-: standard input is one part")
    from cad_io.read.sniff import sniff

    data = _standard_input().read()
    suffix = _SUFFIXES.get(sniff(data, PIPE), "")
    raise_interrupts()
    with tempfile.TemporaryDirectory(prefix="plan-cutters-") as folder:
        file = Path(folder) / f"stdin{suffix}"
        file.write_bytes(data)
        yield [str(file) if k in places else word for k, word in enumerate(words)]


def listed(sources: Sequence[str]) -> list[str]:
    """Sources of a batch, with the lines of standard input in place of `-`: empty ones and those that begin with # are none.

    OptionError where nothing is piped, what comes is no text, or it has no line.
    """
    if PIPE not in sources:
        return list(sources)
    try:
        lines = [line.strip() for line in _standard_input().read().decode("utf-8-sig").splitlines()]
    except UnicodeDecodeError:
        raise OptionError("-: a list of parts is text in UTF-8, a part in a line; the command plan takes a part itself") from None
    parts = [line for line in lines if line and not line.startswith("#")]
    if not parts:
        raise OptionError("-: no part is listed on standard input")
    return [each for word in sources for each in (parts if word == PIPE else [word])]


def _standard_input() -> BinaryIO:
    """Standard input, where something is piped into it."""
    if sys.stdin is None or sys.stdin.isatty():
        raise OptionError("-: nothing is piped to standard input; give a file, or pipe one: plan-cutters - < part.step")
    return sys.stdin.buffer


_SELF = "plan-cutters"


@click.command(cls=option_groups.Command, subcommands=sentences, examples=EXAMPLES, codes=CODES)
@click.argument("parts", nargs=-1, required=True, metavar="PART...", type=File("PART"))
@options()
@takes(PlanRequest)
def command(request: PlanRequest) -> int:
    """Find the cutters that can finish the sculptured faces of PART (STEP, IGES, BREP) without gouging or collision.

    Each cutter is judged at samples of the surface: a sample is interference-free, accessible, undecided or inaccessible, for a
    reason. The plan, models coloured by verdict and the samples are written into a folder.
    """
    from plan_cutters.command.one_part import one_part
    from plan_cutters.command.validation import check, folders

    parts = request.parts
    requested, _ = check(request)
    if request.check_operations is not None:
        checked = module_of(f"{_SELF} check").checked
        return int(checked(parts[0], request.check_operations, requested, quiet=request.quiet, read_timeout=request.read_timeout))
    codes, cases = list[int](), _part_cases(request)
    outs: list[Path | None] = [*folders(request)] or [None] * len(parts)
    since: float | None = began()
    done, excluded = assignment().done, assignment().excluded
    for part, out in list(zip(parts, outs, strict=True))[done:]:
        code, line = guarded(partial(one_part, part, out, requested, request, since, excluded, cases), request.debug)
        since, excluded = None, {}
        codes.append(code)
        if code != INTERRUPTED:
            report("done", str(code))
        if line and cases is not None:
            cases.failed(line, part)
        if line:
            terminal.error(f"{part}: {line}" if len(parts) > 1 and not request.quiet else line)
        elif len(parts) > 1 and not request.quiet:
            terminal.give(clean(f"{part}: {dict(CODES).get(str(code), '')}") + "\n")
        if code == INTERRUPTED:
            break
    if not is_child():
        if cases is not None:
            cases.write()
        terminal.all_shown()
    return max(codes)


def main(args: Sequence[str] | None = None, name: str = _SELF) -> NoReturn:
    """Run the command: what has a part to read runs in a child process."""
    words = list(sys.argv[1:] if args is None else args)
    if not is_child():

        def piped() -> int:
            with spooled(command, words) as named:
                return _watched(named, name)

        ended(_SELF, words, piped)
    # Whoever started the command may ignore interrupts, as a shell does for what runs in the background: the parent does not.
    signal.signal(signal.SIGINT, interrupt)
    keep_interrupts()
    gc.disable()  # nothing of what imports make is garbage; `one_part` turns it on again
    terminal.keep_streams()
    terminal.keep_output()
    terminal.warn_in_lines()
    if assignment().go is not None:
        load()
        wait_to_begin()
    limit_memory()
    code, line = guarded(lambda: (invoked(command, _SELF, words), ""), "--debug" in words)
    if line:
        terminal.error(line)
    # Everything is on disk: to take the CAD kernel and the compiler down in order would only cost time, up to a second.
    with contextlib.suppress(OSError, ValueError, AttributeError):
        sys.stdout.flush()
        sys.stderr.flush()
    os._exit(code)


def _part_cases(request: PlanRequest) -> PartCases | None:
    """What gathers test cases of the parts, where a file for them is requested."""
    return None if (files := request.case_files) is None else PartCases(files, request.parts)


def load() -> None:
    """Load what every plan needs; nothing where there is no machine code yet: who compiles that begins first."""
    if import_module("plan_cutters.kernels.jit").at_hand("search.search.search_rows") is False:
        return
    import_module("plan_cutters.command.one_part")
    import_module("plan_cutters.report.models")
    import_module("plan_cutters.pipeline")


def _watched(words: list[str], name: str) -> int:
    """Look at the words here, so that help and mistakes cost nothing; leave the work to a child."""
    from plan_cutters.command.partial_plan import show_plan, supervised, without_models
    from plan_cutters.command.progress import Display
    from plan_cutters.command.validation import check
    from plan_cutters.plan_file.words.names import called

    if not words:
        # Whoever types the name alone asks what it does.
        with command.make_context(name, [], resilient_parsing=True) as context:
            click.echo(command.get_help(context), err=True, color=context.color)
        return USAGE
    try:
        with command.make_context(name, list(words)) as context:
            request = PlanRequest(**context.params)
    except click.exceptions.Exit as done:
        return done.exit_code
    cases = _part_cases(request)
    try:
        requested, faults = check(request)
    except CadIoError as unread:
        if cases is not None:
            cases.write(str(unread))
        raise
    if not can_supervise():
        if request.timeout is not None:
            raise OptionError("--timeout: this system has no process that could be ended; leave it out")
        terminal.keep_output()
        return invoked(command, _SELF, words)
    names = {cutter.id: called(cutter) for cutter in requested.judged}
    display = Display(request.quiet, len(names), began(), names=names)
    for fault in faults:
        terminal.error(f"plan-cutters: {fault}; the other parts are planned")
    memory = default_memory() if request.memory is None else int(request.memory * 1e9)
    display.stage("start")
    display.part_cases = cases

    def give_prompt_back(code: int, out: Path) -> None:
        """Models are written behind the prompt."""
        display.clear()
        if not request.quiet:
            where = os.path.relpath(out) if request.out is None else request.out
            terminal.say(
                f"Models are being written into {where} meanwhile; plan.json there names those that are done. --wait waits."
            )
        let_go(code)

    # Nobody needs more of the command than a summary before models are written.
    leaves = len(request.parts) == 1 and request.json_out is None and cases is None and request.timeout is None
    try:
        code = supervised(
            words, parts=request.parts, read_timeout=request.read_timeout, memory=memory, display=display,
            timeout=math.inf if request.timeout is None else request.timeout, since=began(),
            shows=lambda out, summarised: show_plan(out, request, summarised=summarised),
            leave=give_prompt_back if is_waited_for() and leaves else None,
        )  # fmt: skip
    except Unfinished as stopped:
        display.clear()
        code = without_models(stopped, request)
    except Supervised as stopped:
        if cases is not None:
            cases.failed(str(stopped))
            cases.write()
        raise
    finally:
        display.clear()
    if cases is not None:
        cases.write("interrupted" if code == INTERRUPTED else "not planned")
    terminal.all_shown()
    return code
