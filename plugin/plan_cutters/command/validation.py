"""Read and check the words of the command line before any large module is loaded, and tell the shell which it may offer."""

import math
import os
import sys
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, NoReturn

import click
from click.shell_completion import CompletionItem, shell_complete

from cad_io.errors import CadIoError, ReadError
from plan_cutters.command.codes import ended
from plan_cutters.command.entry import OURS, commands, instead, module_of
from plan_cutters.command.request import PlanningRequest, PlanRequest, planning_options
from plan_cutters.errors import OptionError, PlanError
from plan_cutters.option_table import OF_OPERATIONS, ONLY, OPTIONS
from plan_cutters_base.whole import refusal

if TYPE_CHECKING:
    from plan_cutters.options import Options


#: A setup by its direction or file.
_Stand = tuple[float, ...] | str
#: Directions of setups that differ by less are one.
_SAME = 1e-5
#: Where the context of a command says that setups are named behind `auto`.
_NAMED = "plan_cutters.named_setups"
#: What the shell itself completes, which knows about `~` and blanks.
FILE, _FOLDER = CompletionItem("", type="file"), CompletionItem("", type="dir")


class Words(click.ParamType):
    """A text that help calls by a name, or a list of them, parted by commas.

    A shell offers the words, which are asked for only then, and `files` where none of them fits.
    """

    def __init__(
        self, name: str, offered: Callable[[], Iterable[str]] = tuple, *, files: bool = False, listed: bool = False
    ) -> None:
        self.name, self.offered, self.files, self.listed = name, offered, files, listed

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:
        for each in str(value).split(",") if self.listed else ():
            if param is not None and (gone := instead(f"{param.opts[-1]} {each.strip().lower()}")):
                raise click.UsageError(gone, ctx)
        return str(value)

    def added(self, values: Sequence[str]) -> str | None:
        """One value for all of an option that is repeated; None where they do not add up."""
        return ",".join(filter(None, values)) if self.listed else None

    def shell_complete(self, ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
        before, comma, last = incomplete.rpartition(",") if self.listed else ("", "", incomplete)
        words = before.split(",")
        items = [
            CompletionItem(f"{before}{comma}{word}") for word in self.offered() if word.startswith(last) and word not in words
        ]
        return items or ([FILE] if self.files else [])


class Faces(Words):
    """A selection of faces: lists of numbers and kinds add up; a name, a component, a colour or a `!` stands alone, nothing adds
    to `all`, and `only:` takes the place of what is before it."""

    def __init__(self) -> None:
        super().__init__("SELECT", face_words, listed=True)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:
        return super().convert(str(value).removeprefix(ONLY), param, ctx)

    def added(self, values: Sequence[str]) -> str | None:
        alone = any(":" in value or "!" in value or "all" in value.split(",") for value in values)
        return None if alone else super().added(values)


#: A path, completed as a file.
File = partial(Words, files=True)


class Folder(Words):
    """A path, completed as a folder."""

    def shell_complete(self, ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
        return [_FOLDER]


class Plans(click.Choice[str]):
    """Plans of operations by name; `all` are both, as other options have an `all`."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        return super().convert("both" if value == "all" else value, param, ctx)


class Range(click.ParamType):
    """Two numbers of degrees, MIN:MAX."""

    name = "MIN:MAX"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[float, float]:
        try:
            low, high = (float(part) for part in value.split(":"))
        except ValueError:
            self.fail(f"{value!r} is not of the form MIN:MAX in degrees, as 0:60", param, ctx)
        return low, high


def say(ctx: click.Context, text: str) -> None:
    """Say on standard error what the words of a command mean, once: the child that does the work reads them again."""
    from plan_cutters_base.workers.child import is_child

    if not (is_child() or ctx.resilient_parsing):
        click.echo(text, err=True)


def named_setups(ctx: click.Context, _: click.Parameter, value: Any) -> Any:
    """Let an option of advice that is typed behind the command do as it says.

    A direction or file that is named again counts once, `only:` takes the place of all before it, and what is named behind `auto`
    that of `auto`.
    """
    if not isinstance(value, tuple):
        return value
    start = max((k for k, each in enumerate(value) if isinstance(each, Only)), default=0)
    if start:
        say(ctx, f"--setup {value[start].text}: it takes the place of what is named before it")
    value = _once(each.setup if isinstance(each, Only) else each for each in value[start:])
    if value[:1] != ("auto",) or len(value) < 2 or "auto" in value[1:]:
        return value
    named = value[1:]
    ctx.meta[_NAMED] = named
    if "fixtures" in ctx.params:
        ctx.params["fixtures"] = fixtures_of_setups(ctx, _, ctx.params["fixtures"])
    say(ctx, f"--setup auto: {len(named)} named behind it take its place; nothing is proposed")
    return named


def _once(setups: Iterable[_Stand]) -> tuple[_Stand, ...]:
    """Setups without those whose direction or file was named before."""
    result = list[_Stand]()
    for each in setups:
        result += [] if any(_alike(each, one) for one in result) else [each]
    return tuple(result)


def _alike(a: _Stand, b: _Stand) -> bool:
    if isinstance(a, str) or isinstance(b, str):
        return a == b != "auto"
    lengths = math.hypot(*a), math.hypot(*b)
    return min(lengths) > 0.0 and math.dist([x / lengths[0] for x in a], [x / lengths[1] for x in b]) <= _SAME


def fixtures_of_setups(ctx: click.Context, _: click.Parameter, value: Any) -> Any:
    """Leave out what proposed setups were to be held by, where others are named behind `auto` that say it themselves.

    They say it by their files, or by a fixture behind the first one: beside `auto` there is one at most.
    """
    named = ctx.meta.get(_NAMED)
    if named is None or not value:
        return value
    from plan_cutters.domain.fixture import TABLE, Fixture
    from plan_cutters.setups.files import read_setup

    try:
        first = Fixture.parse(value[0])
        stated = len(value) > 1 or all(isinstance(each, str) and read_setup(each).fixtures for each in named)
    except PlanError:
        return value
    if not stated or not (first.to_place or value[0].strip().lower() == TABLE):
        return value
    say(ctx, f"--setup auto: the setups behind it say what holds the part; --fixture {value[0]} is left out")
    return value[1:]


class Only(NamedTuple):
    """A setup that takes the place of those before it, as it is typed."""

    setup: _Stand
    text: str


class Setup(click.ParamType):
    """A direction, as +z or x,y,z, or a setup file; where it is repeatable also `auto`, and `only:` before one of them."""

    name = "AXIS|FILE"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        from plan_cutters.domain.posture import along

        if value.startswith(ONLY) and param is not None and param.multiple:
            return Only(self.convert(value.removeprefix(ONLY), param, ctx), value)
        if (named := along(value)) is not None:
            return named
        if value.strip().lower() == "auto" and param is not None and param.multiple:
            return "auto"
        try:
            x, y, z = (float(part) for part in value.split(","))
        except ValueError:
            if value.lower().endswith(".toml") or os.path.isfile(value):
                return str(value)
            self.fail(f"{value!r} is no direction, as +z, -y or 0,0,1 (x,y,z), a setup file, or auto", param, ctx)
        return x, y, z

    def shell_complete(self, ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
        items = [CompletionItem(f"{sign}{axis}") for axis in "xyz" for sign in "+-"] + [CompletionItem("auto")]
        return [each for each in items if each.value.startswith(incomplete)] or [FILE]


def three(text: str, why: str) -> tuple[float, float, float]:
    """The numbers of `x,y,z`; an OptionError that says why it is none."""
    try:
        x, y, z = (float(word) for word in text.split(","))
    except ValueError:
        raise OptionError(why) from None
    return x, y, z


def machine_names() -> Sequence[str]:
    from plan_cutters.domain.machine import builtin_machines

    return ["unlimited", "tilt:", *builtin_machines()]


def cutter_ids() -> Sequence[str]:
    from plan_cutters.domain.standard_tools import builtin

    return [cutter.id for cutter in builtin()]


def holder_words() -> Sequence[str]:
    from plan_cutters.domain.holder import words

    return [*words(), "none"]


def answers() -> Sequence[str]:
    from plan_cutters.domain.answer_kinds import ANSWERS

    return [*ANSWERS, "all"]


def face_words() -> Sequence[str]:
    return ("sculptured", "blends", "all", "component:", "name:", "color:#")


class Subcommands(click.Group):
    """All subcommands as a shell sees them: words after none of them are those of the first."""

    def __init__(self) -> None:
        # An option may come first, and is one of the first subcommand.
        super().__init__(context_settings={"ignore_unknown_options": True}, add_help_option=False)

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(commands())

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command:
        command: click.Command = module_of(f"plan-cutters {cmd_name}").command
        return command

    def resolve_command(self, ctx: click.Context, args: list[str]) -> tuple[str | None, click.Command | None, list[str]]:
        return super().resolve_command(ctx, args if args[0] in commands() else [next(iter(OURS)), *args])

    def shell_complete(self, ctx: click.Context, incomplete: str) -> list[CompletionItem]:
        if incomplete.startswith("-"):
            first = module_of("plan-cutters").command
            items: list[CompletionItem] = first.shell_complete(click.Context(first, resilient_parsing=True), incomplete)
            return items
        return [CompletionItem(name) for name in commands() if name.startswith(incomplete)] or [FILE]


def complete(name: str) -> NoReturn:
    """Answer the shell that asks about the program of this name, as the environment says."""
    variable = f"_{name.replace('-', '_').upper()}_COMPLETE"
    main_command = Subcommands() if name == "plan-cutters" else module_of(name).command
    ended(name, [], lambda: shell_complete(main_command, {}, name, variable, os.environ[variable]))


#: Bytes of memory below which nothing can be planned.
LEAST_MEMORY = 2e9


def check(request: PlanRequest) -> "tuple[Options, list[CadIoError]]":
    """Options, and why some of several parts cannot be read.

    CadIoError where no part can be read, or a fixture cannot; PlanError where an option has no meaning, or a library or machine
    file cannot be used.
    """
    from cad_io.read.sniff import kind
    from plan_cutters.domain.checks import did_you_mean
    from plan_cutters_base.workers.child import job_input

    # A first word that is no file and nearly a command: the other words would be planned in its place.
    word = request.parts[0]
    meant = "" if os.path.exists(word) else did_you_mean(word, commands())
    _refuse((meant, f"{word} is neither a command nor a file{meant}"))
    _words(request)
    # As far as their first bytes tell.
    faults: list[CadIoError] = []
    for part in () if job_input().part else request.parts:
        try:
            kind(part)
        except CadIoError as error:
            faults.append(error)
    if len(faults) == len(request.parts):
        raise faults[0]
    for out in folders(request):
        writable(out)
    options = options_of(request)
    look_at(options)
    return options, faults


def folders(request: PlanRequest) -> list[Path]:
    """The output folder of each part; none where only standard output is written."""
    if request.json_out == "-" and request.out is None and request.formats is None:
        return []
    outs = [Path(request.out or "") / f"{Path(p).stem}-plan" for p in request.parts]
    outs = [Path(request.out)] if request.out and len(outs) == 1 else outs
    if len(set(outs)) < len(outs):
        twice = next(str(out) for out in outs if outs.count(out) > 1)
        raise OptionError(f"two parts have the same name and would write to the same folder, {twice}; plan them one by one")
    return outs


def _words(request: PlanRequest) -> None:
    """Options that need no file and no number to be read."""
    from plan_cutters.report.folder import read_formats

    if request.formats is not None:
        read_formats(request.formats)
    checks, several = request.check_operations is not None, len(request.parts) > 1
    other = request.json_out not in (None, "-")
    _refuse(
        (request.process is not None and several, "--process names faces of one part: give one part"),
        (other, "--json takes -, for standard output; --formats json writes plan.json into the folder"),
        (request.json_out and several, "--json - writes one plan: give one part, or -o DIR --formats json for a file of each"),
        (request.json_out and sys.stdout is None, "--json -: standard output is closed"),
    )
    if (files := request.case_files) is not None:
        files.check()
    report = "junit" if request.junit is not None else "sarif" if request.sarif is not None else None
    setups = [str(each).lower() for each in request.setup]
    plans_nothing = "--check-operations plans nothing"
    _refuse(
        (request.out == "", "-o: the folder has no name"),
        ("" in request.parts, "PART: a file has no name"),
        (checks and "auto" in setups, f"--setup auto plans what it proposes, and {plans_nothing}: name the setup"),
        (checks and report, f"--{report} is about planning, and {plans_nothing}: leave one of them out"),
        (checks and several, "--check-operations is about one part"),
    )
    if request.check_operations is None:
        refuse_unplanned_operations(request)
    elif not os.path.isfile(request.check_operations):
        raise OptionError("no such file: give the plan.json of a plan of operations", file=request.check_operations)
    percent, timeout, memory = request.fail_under, request.timeout, request.memory
    _refuse(
        (not 0.0 < request.read_timeout < math.inf, "--read-timeout must be a positive number of seconds"),
        (percent is not None and not 0.0 < percent <= 100.0, "--fail-under must be a percentage above 0 and up to 100"),
        (timeout is not None and not 0.0 < timeout < math.inf, "--timeout must be a positive number of seconds"),
        (memory is not None and not LEAST_MEMORY <= memory * 1e9 < 1e18, "--memory must be at least 2 GB"),
    )


def _refuse(*faults: tuple[object, str]) -> None:
    """Raise the first of what is wrong."""
    for wrong, why in faults:
        if wrong:
            raise OptionError(why)


def scheduler(address: str) -> None:
    """OptionError for what is neither a file nor an address."""
    if not os.path.isfile(address) and "://" not in address:
        raise OptionError("no such file, and no address as tcp://HOST:8786", file=f"--cluster {address}")


def refuse_unplanned_operations(request: PlanningRequest) -> None:
    """OptionError for options of a plan of operations where none is requested."""
    if request.operations is not None or getattr(request, "process", None) is not None:
        return
    for name in OF_OPERATIONS:
        if getattr(request, name) != OPTIONS[name].default:
            word = f"--{name.replace('_', '-')}"
            raise OptionError(f"{word} is about a plan of operations: give it with --operations, or leave it out")


def writable(out: Path) -> None:
    """PlanError where a folder can surely not be written."""
    if out.exists() and not out.is_dir():
        raise PlanError("the output must be a folder, this is a file; give another with -o", file=str(out))
    # What grows stands beside the folder, and then in it; folders that are not there are made.
    for folder in (out.absolute().parent, *([out] if out.exists() else [])):
        if why := refusal(folder):
            raise PlanError(f"cannot write there ({why}); give another folder with -o", file=str(out))


def look_at(options: "Options") -> None:
    """An error for words for faces that say nothing, and for fixtures whose file is missing, empty or of no format for them."""
    from plan_cutters.scene.faces import grammar

    names = options.ignore if isinstance(options.ignore, list | tuple) else (options.ignore,)
    for option, text in (("--faces", options.faces), *(("--ignore", each) for each in names)):
        if isinstance(text, str):
            grammar(text, option)
    from cad_io.read.sniff import kind
    from plan_cutters.domain.fixture import CAD, MESH, no_format

    others = [each for place in options.other_placements if place is not None for each in place.fixtures]
    for fixture in (*options.fixtures, *others):
        if not isinstance(file := fixture.source, str) or fixture.kind:
            continue
        suffix = Path(file).suffix.lower()
        if suffix in CAD:
            kind(file)
        elif suffix not in MESH:
            raise ReadError(no_format(file), file=file)
        elif not os.path.isfile(file):
            raise ReadError("is not a file" if os.path.exists(file) else "no such file", file=file)


def options_of(request: PlanningRequest) -> "Options":
    """The options of a plan, from the words of the command line; a PlanError for what has no meaning."""
    import pickle

    from plan_cutters.options import Options
    from plan_cutters_base.workers.child import job_input

    # A batch has looked at its words already, perhaps on another machine.
    handed = job_input().options
    options: Options = pickle.loads(handed) if handed else Options(**planning_options(request))
    return options
