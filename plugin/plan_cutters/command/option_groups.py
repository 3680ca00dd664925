"""The options of the commands, each declared once, in the groups that help shows."""

import os
import shutil
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import click

from plan_cutters import __version__
from plan_cutters.command import validation
from plan_cutters.command.validation import Faces, File, Folder, Plans, Range, Setup, Words, fixtures_of_setups, named_setups, say
from plan_cutters.option_table import GROUPS, OPTIONS, Option
from plan_cutters.report.folder import DEFAULT_FORMATS, FORMATS

#: Width of the column of names; what is longer has a line of its own.
_NAMES = 22
#: Widest that help is set.
WIDEST = 100
#: Lines that `--help` has, at most, and its examples where it leaves something out.
MOST_LINES, _EXAMPLES = 90, 3
#: Where a context says that all of the help is wanted.
_ALL = "plan_cutters.help_all"


class Grouped(click.Option):
    """An option under a heading of the help. Lists that are repeated add up; of any other option the last value counts.

    `brief` is its line in a short help, which leaves out options that have none; True: the same as in the whole one.
    """

    def __init__(self, *words: Any, group: str = "", brief: str | bool = False, **more: Any) -> None:
        super().__init__(*words, **more)
        self.group, self.brief = group, brief

    def add_to_parser(self, parser: Any, ctx: click.Context) -> None:
        if self.multiple or self.is_flag or self.count:
            super().add_to_parser(parser, ctx)
        else:
            parser.add_option(obj=self, opts=self.opts, dest=self.name, action="append", nargs=self.nargs)

    def consume_value(self, ctx: click.Context, opts: Mapping[str, Any]) -> Any:
        if not self.multiple and isinstance(values := opts.get(self.name or ""), list):
            opts = {**opts, self.name or "": self._one(values, ctx)}
        return super().consume_value(ctx, opts)

    def _one(self, values: list[str], ctx: click.Context) -> str:
        """The value that repeated ones make; where the last one takes the place of others, that is said."""
        if ctx.resilient_parsing or all(value == values[0] for value in values):
            return values[-1]
        if isinstance(self.type, Words) and (added := self.type.added(values)) is not None:
            return added
        others = {self.type_cast_value(ctx, value): value for value in values}
        others.pop(self.type_cast_value(ctx, values[-1]))
        if others:
            say(ctx, f"{max(self.opts, key=len)} {values[-1]} behind it takes the place of {' and '.join(others.values())}")
        return values[-1]


def heading(title: str) -> Any:
    """Make a decorator that declares options under a heading: `click.option` with a group."""

    def option(*words: str, **more: Any) -> Any:
        return click.option(*words, cls=Grouped, group=title, **more)

    return option


class Command(click.Command):
    """A command whose help has headings in the order in which they are declared, then examples and exit codes.

    `subcommands` are what help lists first, asked when it is shown. Each of these is a pair of texts: what is typed or seen, and
    what it does or means.
    """

    def __init__(
        self, *words: Any, subcommands: Callable[[], Sequence[tuple[str, str]]] = tuple,
        examples: Sequence[tuple[str, str]] = (), codes: Sequence[tuple[str, str]] = (), **more: Any,
    ) -> None:  # fmt: skip
        more["context_settings"] = {"help_option_names": ["-h", "--help"]}
        super().__init__(*words, **more)
        click.version_option(__version__, prog_name="plan-cutters")(self)
        click.option("--help-all", is_flag=True, is_eager=True, expose_value=False, callback=_help_all,
                     help="Show all options, and exit.")(self)  # fmt: skip
        self.subcommands, self.examples, self.codes = subcommands, examples, codes

    def make_context(self, *words: Any, **more: Any) -> click.Context:
        # 80 columns where the output is no terminal.
        settings = {"terminal_width": min(WIDEST, shutil.get_terminal_size().columns) - 1, "color": colour()}
        return super().make_context(*words, **{**settings, **more})

    def get_help(self, ctx: click.Context) -> str:
        wanted = ctx.meta.get(_ALL, False)
        ctx.meta[_ALL] = True
        whole = super().get_help(ctx)
        if wanted or whole.count("\n") < MOST_LINES:
            return whole
        ctx.meta[_ALL] = False
        return super().get_help(ctx)

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        groups = {"Commands": [(name.ljust(_NAMES), what) for name, what in listed]} if (listed := self.subcommands()) else {}
        title = "Options"
        for param in self.get_params(ctx):
            record, title = param.get_help_record(ctx), getattr(param, "group", title)
            brief = True if ctx.meta.get(_ALL) else getattr(param, "brief", True)
            if record is not None and brief and not isinstance(param, click.Argument):
                # As wide as all others, so that the text begins in one column throughout.
                groups.setdefault(title, []).append((record[0].ljust(_NAMES), record[1] if brief is True else brief))
        for title, records in groups.items():
            with formatter.section(_bold(title)):
                formatter.write_dl(records, col_max=_NAMES)

    def format_epilog(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        whole = ctx.meta.get(_ALL)
        if self.examples:
            with formatter.section(_bold("Examples")):
                for line, what in self.examples[: None if whole else _EXAMPLES]:
                    formatter.write_text(what)
                    formatter.write(f"{'':{formatter.current_indent + 2}}{click.style(line, fg='cyan')}\n")
        if not whole:
            formatter.write_paragraph()
            formatter.write_text("--help-all has all options with their defaults, more examples and the exit codes.")
        elif self.codes:
            with formatter.section(_bold("Exit codes")):
                formatter.write_dl(self.codes)


def _help_all(ctx: click.Context, param: click.Parameter, requested: bool) -> None:
    if not requested or ctx.resilient_parsing:
        return
    ctx.meta[_ALL] = True
    click.echo(ctx.get_help(), color=ctx.color)
    ctx.exit()


def colour() -> bool | None:
    """Whether output has colours: never where the environment asks for none, else where it goes to a terminal (None)."""
    return False if os.environ.get("NO_COLOR") or os.environ.get("TERM") == "dumb" else None


def _bold(title: str) -> str:
    return click.style(title, bold=True)


EXAMPLES = (
    ("plan-cutters blade.step", "The sculptured faces and fillets, with the built-in cutters:"),
    ("plan-cutters blade.step --cutter D12L80 --cutter D6L60rc3 --holder er32", "Two cutters, flat and ball, in a holder:"),
    ("plan-cutters mould.step --cutters shop.tools --machine trunnion-ac", "Your tool library on a machine:"),
    ("plan-cutters mould.step --faces F3,7-12 --fixture vise.stl@0,0,-20", "Some faces, the part in a vise:"),
    ("plan-cutters blade.step --cutter R6L80 --answers stick-out,mend", "How short it can be held, and what would help:"),
    ("plan-cutters map blade.step --at 12,3,40 --cutter R6L80", "A picture of all postures of a cutter at one point:"),
    ("plan-cutters blade.step --cutter R6L80 --json - --quiet", "For a script, the plan on standard output:"),
)


def _list_cutters(ctx: click.Context, param: click.Parameter, requested: bool) -> None:
    """Print the default tool set, one cutter a line, and end."""
    if not requested or ctx.resilient_parsing:
        return
    from plan_cutters.domain.standard_tools import builtin

    click.echo("Built-in cutters: usual metric sizes in plain holders, for a first look; nobody's tools. Lengths in mm.")
    for cutter in builtin():
        click.echo(f"{cutter.id:36}  {cutter.name}")
    ctx.exit()


#: Of options whose values are no plain numbers, texts and choices.
_SPECIAL: dict[str, dict[str, Any]] = {
    "cutters": {"type": Words("SPEC", validation.cutter_ids)},
    "libraries": {"type": File("FILE")},
    "holder": {"type": Words("SPEC|FILE", validation.holder_words, files=True)},
    "list_cutters": {"is_eager": True, "expose_value": False, "callback": _list_cutters},
    "machine": {"type": Words("NAME|FILE", validation.machine_names, files=True)},
    "setup": {"type": Setup(), "callback": named_setups},
    "fixtures": {"type": File("FILE[@X,Y,Z[,RX,RY,RZ]][:UNIT]"), "callback": fixtures_of_setups},
    "faces": {"type": Faces()},
    "ignore": {"type": Faces()},
    "tilt": {"type": Range()},
    "rotation": {"type": Range()},
    "out": {"type": Folder("DIR")},
    "formats": {"type": Words("LIST", lambda: FORMATS, listed=True)},
    "json_out": {"type": Words("-", lambda: ("-",))},
    "junit": {"type": File("FILE")},
    "sarif": {"type": File("FILE")},
    "answers": {"type": Words("LIST", validation.answers, listed=True)},
    "operations": {"type": Plans(OPTIONS["operations"].choices)},
    "process": {"type": File("FILE")},
    "check_operations": {"type": File("FILE")},
}
#: By the heading of help, in its order: the options of a plan, and what is about a run of the command.
_OPTIONS = {
    **GROUPS,
    "Cutters": (
        *GROUPS["Cutters"],
        Option("assume_stickout", float, None, "Stick-out of the libraries' tools that state none.", brief=True, unit="mm"),
        Option("skip_bad", bool, False, "If some tools of a library are broken, use the others."),
        Option("list_cutters", bool, False, "List the built-in cutters and exit."),
    ),
    "Output": (
        Option("out", str, None, "Folder for the files.  [default: <part>-plan]", brief=True),
        Option(
            "formats", str, None, brief="Of json, step, glb, html, npz, png, csv and more.",
            help=f"Of {', '.join(FORMATS)}; merged is a GLB of one mesh, for parts of thousands of faces.  "
            f"[default: {','.join(DEFAULT_FORMATS)}]",
        ),
        Option(
            "step_schema", str, "ap242", "Application protocol of the STEP file.  [default: ap242]",
            choices=("ap242", "ap214", "ap203"),
        ),
        Option(
            "json_out", str, None, typed="json", brief="The plan of one part on standard output.",
            help="The plan of one part on standard output, nothing else there; files only where -o names a folder.",
        ),
        Option(
            "junit", str, None,
            "Also write a report for continuous integration (JUnit XML): a test case for each face and cutter, of many parts "
            "for each part.",
        ),
        Option("sarif", str, None, "Also write what fails, or is not sure, as findings for code scanning (SARIF)."),
        *GROUPS["Output"],
        Option("verbose", bool, False, "Print all details, not only the summary.", brief=True),
        Option("quiet", bool, False, "Print no progress and no summary, only errors.", brief=True),
        Option(
            "wait", bool, False,
            "At a shell's prompt, end when the models are written, too. Scripts, pipes and containers always wait for them.",
        ),
    ),
    "Plan of operations": (
        *GROUPS["Plan of operations"],
        Option(
            "check_operations", str, None,
            "Check the operations in a plan.json against the exact part, with the options that it was made with; write nothing.",
        ),
    ),
    "Run": (
        *GROUPS["Run"],
        Option(
            "cache", bool, True, typed="no_cache",
            help="Neither use nor keep what stages made of a part: mesh, trees, samples, verdicts, in the user's cache folder.",
        ),
        Option(
            "read_timeout", float, 120.0, unit="s",
            help="Seconds that reading a part may take; from it follow the limits of later stages and single faces.",
        ),
        Option(
            "fail_under", float, None, metavar="PERCENT", brief="End with 0 where at least so much is finished.",
            help="End with 0 where at least so much of the area to machine is finished.  [default: all of it, and all judged]",
        ),
        Option(
            "timeout", float, None, unit="s", brief="Seconds for the whole of a part.",
            help="Seconds for the whole of a part; one that is not done by then is left with a line and exit code 124, and the "
            "next one is planned.",
        ),
        Option("memory", float, None, "Most memory to use.  [default: 3/4 of the machine's]", unit="gb"),
        Option("debug", bool, False, "Show tracebacks."),
    ),
}  # fmt: skip


def options(*names: str, **changes: dict[str, Any]) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Declare these options, all of them where none is named, in the order above; `changes`: what is otherwise, by name.

    A name is that of the option on the command line, without the dashes and with `_` for `-`.
    """

    def declare(function: Callable[..., Any]) -> Callable[..., Any]:
        for group, each in reversed([(group, each) for group, rows in _OPTIONS.items() for each in rows]):
            if not names or each.called in names or each.called in changes:
                short = {"out": ("-o",), "verbose": ("-v",)}.get(each.word, ())
                words = (*short, f"--{each.called.replace('_', '-')}", each.word)
                function = heading(group)(*words, **{**_of_click(each), **changes.get(each.called, {})})(function)
        return function

    return declare


def _of_click(option: Option) -> dict[str, Any]:
    more: dict[str, Any] = {"help": option.help, "brief": option.brief}
    if option.kind is bool:
        more |= {"is_flag": True, **({"flag_value": False} if option.default else {})}
    elif option.kind in (int, float):
        more |= {"type": option.kind, "metavar": option.metavar or option.unit.upper() or "N"}
        more["help"] += "" if option.default is None else f"  [default: {option.default:g}]"
    elif option.choices:
        more["type"] = click.Choice(option.choices)
    more |= {"multiple": True} if option.several else {}
    more |= {} if option.default in (None, ()) else {"default": option.default}
    return {**more, **_SPECIAL.get(option.word, {})}
