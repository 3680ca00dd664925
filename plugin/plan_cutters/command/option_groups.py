"""The options of the commands, each declared once, in the groups that help shows."""

import os
import shutil
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import click

from cad_io.units import UNITS
from plan_cutters import __version__
from plan_cutters.command import validation
from plan_cutters.command.validation import Faces, File, Folder, Plans, Range, Setup, Words, fixtures_of_setups, named_setups
from plan_cutters.domain.answer_kinds import KINDS
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
    """An option under a heading of the help. Lists that are repeated add up; any other option has one value.

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
        """The value that repeated ones make; a usage error where they contradict each other."""
        if ctx.resilient_parsing or all(value == values[0] for value in values):
            return values[-1]
        added = self.type.added(values) if isinstance(self.type, Words) else None
        if added is None and len({self.type_cast_value(ctx, value) for value in values}) > 1:
            several = " and ".join(dict.fromkeys(values))
            raise click.UsageError(f"{max(self.opts, key=len)} has one value, not {several}: give one of them", ctx)
        return values[-1] if added is None else added


def heading(title: str) -> Any:
    """Make a decorator that declares options under a heading: `click.option` with a group."""

    def option(*words: str, **more: Any) -> Any:
        return click.option(*words, cls=Grouped, group=title, **more)

    return option


class Command(click.Command):
    """A command whose help has headings in the order in which they are declared, then examples and exit codes.

    Parameters
    ----------
    subcommands : callable
        What help lists first, asked when it is shown: other commands, and what they answer, each as (str, str).
    examples : sequence of (str, str)
        A command line, and what it does.
    codes : sequence of (str, str)
        Exit codes, and what they mean.
    """

    def __init__(
        self,
        *words: Any,
        subcommands: Callable[[], Sequence[tuple[str, str]]] = tuple,
        examples: Sequence[tuple[str, str]] = (),
        codes: Sequence[tuple[str, str]] = (),
        **more: Any,
    ) -> None:
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
    """Print all of the help, and end."""
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


class _Declared(NamedTuple):
    """An option as it is declared: its group, the words that it is called by, and what click is told of it."""

    group: str
    words: tuple[str, ...]
    more: dict[str, Any]


def _group(title: str) -> Callable[..., _Declared]:
    return lambda *words, **more: _Declared(title, words, more)


_cutters, _machine, _faces = _group("Cutters"), _group("Machine and setup"), _group("Faces")
_samples, _postures = _group("Sampling and tolerances"), _group("Postures")
_output, _answers, _run = _group("Output"), _group("Answers"), _group("Run")
_operations = _group("Plan of operations")

_OPTIONS = (
    _cutters(
        "--cutter",
        brief="D12L80, then rc1, T5, F20, N11x40, S12; repeatable.",
        type=Words("SPEC", validation.cutter_ids),
        multiple=True,
        help="D12L80: diameter 12, 80 mm from tip to holder, or R6L80 by radius; then rc1 corner radius (rc6: ball), T5 taper "
        "(half angle, deg), F20 length of flutes, N11x40 neck (diameter x length; more of them upwards), S12 shank; behind R, "
        "N and S are radii, too. Inches: D0.5inL3in. Repeatable.  [default: the built-in tool set]",
    ),
    _cutters(
        "--cutters",
        brief="Tool library: Fusion, FreeCAD, CSV, TOML; repeatable.",
        type=File("FILE"),
        multiple=True,
        help="Tool library: Fusion .json, .tools or CSV, HSMWorks .hsmlib, FreeCAD .fctl or .fctb, or TOML; "
        "the command `tools` shows how it is understood. Repeatable.",
    ),
    _cutters(
        "--holder",
        brief="Holder of cutters without one: er32, D30L30.",
        type=Words("SPEC|FILE", validation.holder_words, files=True),
        help="Holder of the cutters that have none: a collet chuck as er32, hsk63a-er32 or bt40-er16x100 (the command `tools` "
        "lists them with --list-holders); D30L30 or R15L30 (diameter or radius, length); stages from the nose up joined by +, "
        "cones as D24:30L20; a file with a holder (FILE#NAME if it has several); or `none`.",
    ),
    _cutters(
        "--assume-stickout", brief=True, type=float, metavar="MM", help="Stick-out of the libraries' tools that state none."
    ),
    _cutters("--skip-bad", is_flag=True, help="If some tools of a library are broken, use the others."),
    _cutters(
        "--list-cutters",
        is_flag=True,
        is_eager=True,
        expose_value=False,
        callback=_list_cutters,
        help="List the built-in cutters and exit.",
    ),
    _machine(
        "--machine",
        brief="Built-in name, tilt:DEG, or a machine file.",
        default="unlimited",
        type=Words("NAME|FILE", validation.machine_names, files=True),
        help="`unlimited`; `tilt:DEG`, a limit of the tool axis from the setup axis; a built-in machine "
        "(the command `machines` lists them); or a machine file: TOML, JSON, FreeCAD .fcm, LinuxCNC .ini, Fusion .mch.  "
        "[default: unlimited]",
    ),
    _machine(
        "--setup",
        brief="Part axis along the spindle: +z, x,y,z; or `auto`.",
        type=Setup(),
        multiple=True,
        callback=named_setups,
        default=["0,0,1"],
        help="Direction of the part along the machine's spindle, +z, -y or x,y,z, or a setup file (TOML) that says where the "
        "part stands. Repeatable: every cutter is judged in each, and the summary says what they reach together. `auto` "
        "proposes the fewest that reach most, in a vise, a chuck or on a table, and plans what it proposes; setups named "
        "behind it take its place.  "
        "[default: 0,0,1]",
    ),
    _machine(
        "--fixture",
        brief="Body in the way: a file, table, vise, chuck.",
        type=File("FILE[@X,Y,Z[,RX,RY,RZ]][:UNIT]"),
        multiple=True,
        callback=fixtures_of_setups,
        help="A body in the way: STEP, IGES, BREP, STL, OBJ, PLY, GLB, or `box:X,Y,Z`, `cylinder:R,H`, placed in part "
        "coordinates (mm, degrees); `table`, all below the part along the setup axis, or `table:H`, all below H. "
        "`vise[:JAW_WIDTHxJAW_HEIGHTxOPENING][:GRIP]` and `chuck[:JAWSxHEIGHT][:GRIP]` are placed for each setup, on what they "
        "can grip there. With --setup auto all three are tried, or the one that is given. Repeatable.",
    ),
    _faces(
        "--faces",
        brief="sculptured, blends, all, F3,7-12, name:REGEX.",
        default="sculptured,blends",
        type=Faces(),
        help="`sculptured` (faces that are no plane, cylinder, cone, sphere or torus in shape; all faces where none is), "
        "`blends` (fillets and rounds: they join two faces smoothly), `all`, `F3,7-12`, a list of these, `component:NAME`, "
        "`name:REGEX` or `color:#RRGGBB`, after a `!` all but these; the others are not judged, only obstacles.  "
        "[default: sculptured,blends]",
    ),
    _faces(
        "--ignore",
        brief="Faces neither machined nor in the way.",
        type=Faces(),
        multiple=True,
        help="Faces that are neither machined nor obstacles, as construction geometry; the same words. Repeatable.",
    ),
    _faces("--flip", is_flag=True, help="Machine the other side of open shells and loose faces."),
    _faces(
        "--sharp-edges",
        type=click.Choice(["asked", "left"]),
        default="asked",
        help="`left`: the strips along sharp inside edges (two faces meet without a fillet) that no cutter enters are not "
        "required.  [default: all are required]",
    ),
    _samples(
        "--effort",
        type=click.Choice(["quick", "normal", "thorough"]),
        default="normal",
        help="Work that advice and proofs after the verdicts may take: a fifth of the usual, or five times as much.  "
        "[default: normal]",
    ),
    _faces(
        "--unit",
        type=click.Choice(list(UNITS)),
        help="Unit of the lengths in the part's file, if the file states a wrong one.  [default: as stated]",
    ),
    _samples(
        "--spacing",
        brief="Largest distance of neighbouring samples.",
        type=float,
        metavar="MM",
        help="Largest distance of neighbouring samples.  [default: from curvature, the smallest cutter and a budget]",
    ),
    _samples("--grid", type=int, metavar="N", help="N x N samples in the parameters of each face, instead of a spacing."),
    _samples(
        "--area-budget",
        type=int,
        metavar="N",
        help="Contacts to look at between the samples, for the selected cutter; 0: none.  [default: 24 a sample, at most 100000]",
    ),
    _samples("--tolerance", brief=True, type=float, default=0.01, metavar="MM", help="Gouge tolerance.  [default: 0.01]"),
    _samples("--allowance", brief=True, type=float, default=0.0, metavar="MM", help="Stock left on the surface.  [default: 0]"),
    _samples(
        "--holder-clearance",
        brief="Clearance of neck, shank and holder.  [default: 0]",
        type=float,
        default=0.0,
        metavar="MM",
        help="Clearance that neck, shank and holder must keep.  [default: 0]",
    ),
    _postures("--tilt", type=Range(), help="Tilts to search, deg from the normal.  [default: 0:90, or as far as cutters touch]"),
    _postures(
        "--rotation",
        type=Range(),
        default="0:360",
        help="Rotations to search, degrees from the direction of the largest curvature.  [default: 0:360]",
    ),
    _postures("--rotation-step", type=float, default=10.0, metavar="DEG", help="Step between rotations.  [default: 10]"),
    _postures(
        "--axis-accuracy",
        type=float,
        metavar="DEG",
        help="Of the rotary axes: a floor or wall that is off by less is square to the axis or along it, and "
        "orientations that are nearer are one.  [default: the machine's own, else 0.05]",
    ),
    _postures(
        "--posture-maps",
        is_flag=True,
        help="Also write every sample's free tilt intervals at every rotation (postures.npz), for the cutter shown.",
    ),
    _postures(
        "--map-budget",
        type=int,
        metavar="N",
        help="Samples to map, at most, evenly spread; the others are undecided there.  [default: as many as some minutes allow]",
    ),
    _output("-o", "--out", brief=True, type=Folder("DIR"), help="Folder for the files.  [default: <part>-plan]"),
    _output(
        "--formats",
        brief="Of json, step, glb, html, npz, png, csv and more.",
        type=Words("LIST", lambda: FORMATS, listed=True),
        help=f"Of {', '.join(FORMATS)}; merged is a GLB of one mesh, for parts of thousands of faces.  "
        f"[default: {','.join(DEFAULT_FORMATS)}]",
    ),
    _output(
        "--step-schema",
        type=click.Choice(["ap242", "ap214", "ap203"]),
        default="ap242",
        help="Application protocol of the STEP file.  [default: ap242]",
    ),
    _output(
        "--json",
        "json_out",
        brief="The plan of one part on standard output.",
        type=Words("-", lambda: ("-",)),
        help="The plan of one part on standard output, nothing else there; files only where -o names a folder.",
    ),
    _output(
        "--junit",
        type=File("FILE"),
        help="Also write a report for continuous integration (JUnit XML): a test case for each face and cutter, of many parts "
        "for each part.",
    ),
    _output("--sarif", type=File("FILE"), help="Also write what fails, or is not sure, as findings for code scanning (SARIF)."),
    _output(
        "--units",
        brief="Unit of lengths in the summary and on the page.",
        type=click.Choice(["mm", "in"]),
        help="Unit of lengths in the summary and on the page; files have mm.  [default: mm; in where all cutters are in inches]",
    ),
    _output("-v", "--verbose", brief=True, is_flag=True, help="Print all details, not only the summary."),
    _output("--quiet", brief=True, is_flag=True, help="Print no progress and no summary, only errors."),
    _output(
        "--wait",
        is_flag=True,
        help="At a shell's prompt, end when the models are written, too. Scripts, pipes and containers always wait for them.",
    ),
    _answers(
        "--answers",
        brief="More questions to answer, or all.",
        default="",
        type=Words("LIST", validation.answers, listed=True),
        help=f"More questions to answer: {', '.join(f'{kind.word} ({kind.meaning})' for kind in KINDS)}, or all.",
    ),
    _answers(
        "--length-over-radius",
        type=float,
        default=10.0,
        metavar="N",
        help="Length of the ends of --answers radius, in radii.  [default: 10]",
    ),
    _operations(
        "--operations",
        brief="Plan fixed orientations (3+2): two rotary axes.",
        type=Plans(["fewest", "fastest", "both"]),
        help="Plan operations with fixed orientations (3+2) that finish together all that is reached: the fewest, with a proof "
        "that there are no fewer, the fastest, or both. The machine has two rotary axes, or none is named. Only finishing is "
        "planned.",
    ),
    _operations(
        "--feed",
        brief="Feed of all cutters.",
        type=float,
        metavar="MM/MIN",
        help="Feed of all cutters.  [default: the libraries' finishing presets; without them "
        "cut lengths are reported, and no times]",
    ),
    _operations("--scallop", type=float, default=0.01, metavar="MM", help="Height of the cusps between passes.  [default: 0.01]"),
    _operations(
        "--stepover", type=float, default=0.75, metavar="N", help="Widest distance of passes, in diameters.  [default: 0.75]"
    ),
    _operations(
        "--index-step",
        type=float,
        metavar="DEG",
        help="Rotary axes lock at whole multiples of this angle alone.  [default: they lock anywhere]",
    ),
    _operations(
        "--index-time",
        type=float,
        metavar="S",
        help="Seconds that another orientation takes.  [default: by the rates of the machine's rotary axes, else 5]",
    ),
    _operations("--change-time", type=float, default=20.0, metavar="S", help="Seconds that another cutter takes.  [default: 20]"),
    _operations("--setup-time", type=float, default=300.0, metavar="S", help="Seconds that another setup takes.  [default: 300]"),
    _operations(
        "--overlap", type=float, default=2.0, metavar="MM", help="Overlap of operations at a common border.  [default: 2]"
    ),
    _operations(
        "--link-time", type=float, default=1.0, metavar="S", help="Seconds from the end of a pass to the next.  [default: 1]"
    ),
    _operations(
        "--border-cost",
        type=float,
        default=0.05,
        metavar="S",
        help="Seconds that a mm of border between operations on a free-form face counts in comparisons.  [default: 0.05]",
    ),
    _operations(
        "--most-operations", type=int, metavar="N", help="Fixed orientations, at most; simultaneous motion finishes the rest."
    ),
    _operations(
        "--max-orientations",
        type=int,
        default=8,
        metavar="N",
        help="Where the fastest plan has more fixed orientations, simultaneous motion is recommended for the rest.  [default: 8]",
    ),
    _operations(
        "--process",
        brief="Your own steps: an edited process.toml.",
        type=File("FILE"),
        help="Your own steps, a process.toml as it is written with a plan, edited: they are judged as they stand, in their "
        "order, and the rest is planned behind them.",
    ),
    _operations(
        "--check-operations",
        type=File("FILE"),
        help="Check the operations in a plan.json against the exact part, with the options that it was made with; write nothing.",
    ),
    _run(
        "--no-patterns",
        "patterns",
        is_flag=True,
        default=True,
        flag_value=False,
        help="Judge and plan each face by itself, also where faces are equal.",
    ),
    _run("--jobs", brief=True, type=int, metavar="N", help="Threads.  [default: all cores]"),
    _run(
        "--no-cache",
        "cache",
        is_flag=True,
        default=True,
        flag_value=False,
        help="Neither use nor keep what stages made of a part: mesh, trees, samples, verdicts, in the user's cache folder.",
    ),
    _run(
        "--read-timeout",
        type=float,
        default=120.0,
        metavar="S",
        help="Seconds that reading a part may take; from it follow the limits of later stages and single faces.  [default: 120]",
    ),
    _run(
        "--fail-under",
        brief="End with 0 where at least so much is finished.",
        type=float,
        metavar="PERCENT",
        help="End with 0 where at least so much of the area to machine is finished.  [default: all of it, and all judged]",
    ),
    _run(
        "--timeout",
        brief="Seconds for the whole of a part.",
        type=float,
        metavar="S",
        help="Seconds for the whole of a part; one that is not done by then is left with a line and exit code 124, and the "
        "next one is planned.",
    ),
    _run("--memory", type=float, metavar="GB", help="Most memory to use.  [default: 3/4 of the machine's]"),
    _run("--debug", is_flag=True, help="Show tracebacks."),
)


def options(*names: str, **changes: dict[str, Any]) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Declare these options, all of them where none is named, in the order above; `changes`: what is otherwise, by name.

    A name is that of the option on the command line, without the dashes and with `_` for `-`.
    """

    def declare(function: Callable[..., Any]) -> Callable[..., Any]:
        for option in reversed(_OPTIONS):
            name = next(word for word in option.words if word.startswith("--"))[2:].replace("-", "_")
            if not names or name in names or name in changes:
                more = {**option.more, **changes.get(name, {})}
                function = heading(option.group)(*option.words, **more)(function)
        return function

    return declare
