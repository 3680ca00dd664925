"""The command line: options in, exit code out."""

import gc
import os
import signal
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import click

from cad_io.units import UNITS
from plan_cutters import __version__
from plan_cutters.command.codes import guarded
from plan_cutters.command.supervise import (
    INTERRUPTED,
    Unfinished,
    began,
    can_supervise,
    default_memory,
    is_child,
    keep_output,
    limit_memory,
    report,
    supervise,
)

if TYPE_CHECKING:
    from plan_cutters.options import Options

#: Options of the interface that later versions will have: asked for now, they must not be ignored.
_NOT_BUILT = {
    "cluster": "clusters are not used yet; --jobs gives threads on this machine",
}


class _Range(click.ParamType):
    """Two numbers of degrees, MIN:MAX."""

    name = "MIN:MAX"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[float, float]:
        try:
            low, high = (float(part) for part in value.split(":"))
        except ValueError:
            self.fail(f"{value!r} is not of the form MIN:MAX in degrees, as 0:60", param, ctx)
        return low, high


class _Setup(click.ParamType):
    """A direction x,y,z, or a setup file."""

    name = "X,Y,Z|FILE"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[float, ...] | str:
        try:
            x, y, z = (float(part) for part in value.split(","))
        except ValueError:
            if value.lower().endswith(".toml") or os.path.isfile(value):
                return str(value)
            self.fail(f"{value!r} is not of the form x,y,z, as 0,0,1, nor a setup file", param, ctx)
        return x, y, z


def _list_cutters(ctx: click.Context, param: click.Parameter, asked: bool) -> None:
    """Print the built-in drawer, one cutter a line, and end."""
    if not asked or ctx.resilient_parsing:
        return
    from plan_cutters.domain.drawer import builtin

    click.echo(
        "Built-in cutters: usual metric sizes in plain holders, for a first look; nobody's tools. Lengths in mm."
    )
    for cutter in builtin():
        click.echo(f"{cutter.id:36}  {cutter.name}")
    ctx.exit()


@click.command(
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 110},
    epilog="Exit codes: 0 a cutter finishes every sample; 1 none does; 2 wrong command line; 3 the part cannot be "
    "read; 4 a cutter would finish all that could be judged, but something could not; 130 interrupted.",
)
@click.argument("parts", nargs=-1, required=True, metavar="PART...")
@click.option(
    "--cutters",
    multiple=True,
    metavar="FILE",
    help="Tool library: Fusion .json, .tools or CSV, HSMWorks .hsmlib, FreeCAD .fctl or .fctb, or TOML; plan-cutters-tools shows "
    "what is understood of it. Repeatable.",
)
@click.option(
    "--cutter",
    multiple=True,
    metavar="SPEC",
    help="R6L80: radius 6, length 80 mm; then rc1 corner radius (rc6: ball), T5 taper (half angle, deg), F20 flutes, N5.5x40 "
    "neck (radius x length; more of them upwards), S6 shank radius. Repeatable; default: the built-in drawer (--list-cutters).",
)
@click.option(
    "--holder",
    metavar="SPEC|FILE",
    help="Holder of the cutters that have none: R15L30 (radius, length); stages from the nose up joined by +, cones as "
    "R12:15L20; a file with a holder (FILE#NAME if it has several); or `none`.",
)
@click.option(
    "--list-cutters",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_list_cutters,
    help="List the built-in cutters and exit.",
)
@click.option(
    "--machine",
    default="unlimited",
    metavar="NAME|FILE",
    help="`unlimited`; `tilt:DEG`, a limit of the tool axis from the setup axis; a built-in machine (plan-cutters-machines lists "
    "them); or a machine file: TOML, JSON, FreeCAD .fcm, LinuxCNC .ini, Fusion .mch, MTConnect.  [default: unlimited]",
)
@click.option(
    "--setup",
    type=_Setup(),
    multiple=True,
    default=["0,0,1"],
    metavar="X,Y,Z|FILE",
    help="Direction of the part along the machine's spindle, or a setup file (TOML) that says where the part stands. Repeatable: "
    "every cutter is judged in each, and what they reach together is said.  [default: 0,0,1]",
)
@click.option(
    "--faces",
    default="sculptured",
    metavar="SELECT",
    help="`sculptured`, `all`, `F3,7-12`, `component:NAME`, `name:REGEX` or `color:#RRGGBB`, after a `!` all but these; the "
    "others are obstacles.  [default: sculptured]",
)
@click.option(
    "--ignore",
    multiple=True,
    metavar="SELECT",
    help="Faces that are neither machined nor obstacles, as construction geometry; the same words. Repeatable.",
)
@click.option(
    "--fixture",
    multiple=True,
    metavar="FILE[@X,Y,Z[,RX,RY,RZ]][:UNIT]",
    help="A body in the way: STEP, IGES, BREP, STL, OBJ, PLY, GLB, or `box:X,Y,Z`, `cylinder:R,H`, `table:Z`, placed in part "
    "coordinates (mm, degrees). Repeatable.",
)
@click.option("--grid", type=int, metavar="N", help="N x N parameter samples a face.")
@click.option(
    "--spacing",
    type=float,
    metavar="MM",
    help="Samples at most this far apart.  [default: from curvature, the smallest cutter and a budget]",
)
@click.option(
    "--tilt", type=_Range(), default="0:90", metavar="MIN:MAX", help="Tilts to search, degrees.  [default: 0:90]"
)
@click.option(
    "--rotation",
    type=_Range(),
    default="0:360",
    metavar="MIN:MAX",
    help="Rotations to search, from the direction of the largest curvature, degrees.  [default: 0:360]",
)
@click.option("--rotation-step", type=float, default=10.0, metavar="DEG", help="[default: 10]")
@click.option("--tolerance", type=float, default=0.01, metavar="MM", help="Gouge tolerance.  [default: 0.01]")
@click.option("--allowance", type=float, default=0.0, metavar="MM", help="Stock left on the surface.  [default: 0]")
@click.option(
    "--holder-clearance",
    type=float,
    default=0.0,
    metavar="MM",
    help="Room asked of neck, shank and holder.  [default: 0]",
)
@click.option("--assume-stickout", type=float, metavar="MM", help="Stick-out of the libraries' tools that state none.")
@click.option("--skip-bad", is_flag=True, help="Use the other tools of a library that has broken ones.")
@click.option("-o", "--out", metavar="DIR", help="Folder for the files.  [default: <stem>-plan]")
@click.option(
    "--formats",
    metavar="LIST",
    help="Of json,step,glb,npz and merged (a GLB of one mesh, for parts of thousands of faces).  "
    "[default: json,step,glb,npz]",
)
@click.option(
    "--step-schema",
    type=click.Choice(["ap242", "ap214", "ap203"]),
    default="ap242",
    help="Application protocol of the STEP file.  [default: ap242]",
)
@click.option("--json", "json_out", metavar="-", help="With `-`: the plan on standard output, nothing else there.")
@click.option(
    "--posture-maps",
    is_flag=True,
    help="Also write every sample's free tilt intervals at every rotation (postures.npz), for the cutter shown.",
)
@click.option(
    "--postures",
    metavar="FILE",
    help="Answer for this machine, setup, tilts and rotations from the part's postures.npz alone, without a new search.",
)
@click.option(
    "--answers",
    default="",
    metavar="LIST",
    help="Answer more: stick-out (how short each cutter can be held), stick-out-map (that for every sample, too), radius (the "
    "largest flat and ball end that reaches each sample), mend (what would make each cutter that fails feasible), or all "
    "(without the map).",
)
@click.option(
    "--length-over-radius",
    type=float,
    default=10.0,
    metavar="N",
    help="Of the ends whose largest radius is asked for.  [default: 10]",
)
@click.option("--jobs", type=int, metavar="N", help="Threads.  [default: all cores]")
@click.option("--cluster", metavar="ADDRESS", hidden=True)
@click.option(
    "--area-budget",
    type=int,
    metavar="N",
    help="Contacts to look at between the samples of the selected cutter; 0: samples alone.  [default: 24 a sample, at most "
    "100000]",
)
@click.option("--flip", is_flag=True, help="Machine the other side of open shells and loose faces.")
@click.option(
    "--unit",
    type=click.Choice(list(UNITS)),
    help="What lengths in the part's file are in, where it says so wrongly.  [default: what it says]",
)
@click.option(
    "--read-timeout",
    type=float,
    default=120.0,
    metavar="S",
    help="Seconds that reading a part may take; later stages of the CAD kernel five times as long.  [default: 120]",
)
@click.option("--memory", type=float, metavar="GB", help="Most memory to use.  [default: 3/4 of the machine's]")
@click.option("--quiet", is_flag=True, help="No progress and no summary.")
@click.option("--debug", is_flag=True, help="Show tracebacks.")
@click.version_option(__version__, prog_name="plan-cutters")
def command(parts: tuple[str, ...], **given: Any) -> int:
    """Which cutters can finish the sculptured faces of PART (STEP, IGES, BREP) without gouging or collision?

    Each is judged at samples of the surface: interference-free, accessible, undecided or inaccessible, and why. Writes
    plan.json, a coloured STEP, a coloured GLB and the samples into a folder.
    """
    from plan_cutters.command.one_part import one_part
    from plan_cutters.errors import OptionError

    for name, why in _NOT_BUILT.items():
        if given[name] not in (None, (), False):
            raise OptionError(f"--{name.replace('_', '-')}: {why}")
    if given["json_out"] not in (None, "-"):
        raise OptionError("--json takes -, for standard output; --formats json writes plan.json into the folder")
    if given["out"] is not None and len(parts) > 1:
        outs = [Path(given["out"]) / f"{Path(p).stem}-plan" for p in parts]
    else:
        outs = [Path(given["out"] or f"{Path(p).stem}-plan") for p in parts]
    if len(set(outs)) < len(outs):
        raise OptionError("two parts have the same name and would write to the same folder; plan them one by one")
    options = _options(given)
    if given["postures"] is not None:
        if len(parts) > 1:
            raise OptionError("--postures is about one part")
        from plan_cutters.command.stored import stored

        return stored(parts[0], given["postures"], options, given)
    codes = []
    since: float | None = began()
    for part, out in zip(parts, outs, strict=True):
        code, line = guarded(
            lambda part=part, out=out, since=since: one_part(part, out, options, given, since), given["debug"]
        )
        since = None
        codes.append(code)
        report("done", str(code))
        if len(parts) > 1 and not given["quiet"]:
            click.echo(f"{part}: {line}", err=True)
        elif code and line:
            click.echo(line, err=True)
        if code == INTERRUPTED:
            break
    return max(codes)


def _options(given: dict[str, Any]) -> "Options":
    from plan_cutters.domain.cutter import Cutter
    from plan_cutters.domain.holder import Holder
    from plan_cutters.domain.posture import PostureRange
    from plan_cutters.errors import OptionError
    from plan_cutters.library.records import Library
    from plan_cutters.options import Options

    postures = PostureRange.degrees(given["tilt"], given["rotation"], given["rotation_step"])
    more = {} if given["jobs"] is None else {"jobs": given["jobs"]}
    holder: Holder | str | None = None
    libraries: list[Library] = []
    if given["holder"] is not None or given["cutters"]:
        # Who names neither need not load the readers.
        from plan_cutters.library.read import holder_of, read_library

        holder = None if given["holder"] is None else holder_of(given["holder"])
        words = {"assume_stickout": given["assume_stickout"], "holder": holder, "skip_bad": given["skip_bad"]}
        libraries = [read_library(file, **words) for file in given["cutters"]]
    if not given["cutters"] and (given["assume_stickout"] is not None or given["skip_bad"]):
        word = "--skip-bad" if given["skip_bad"] else "--assume-stickout"
        raise OptionError(f"{word} is about the tools of a library: give it with --cutters")
    return Options(
        cutters=tuple(Cutter.parse(spec) for spec in given["cutter"]),
        libraries=tuple(libraries),
        holder=None if isinstance(holder, str) else holder,
        allowance=given["allowance"],
        holder_clearance=given["holder_clearance"],
        machine=given["machine"],
        setup=given["setup"][0],
        other_setups=given["setup"][1:],
        faces=given["faces"],
        ignore=given["ignore"],
        grid=given["grid"],
        spacing=given["spacing"],
        tilt=postures.tilt,
        rotation=postures.rotation,
        rotation_step=postures.step,
        tolerance=given["tolerance"],
        flip=given["flip"],
        area_budget=given["area_budget"],
        posture_maps=given["posture_maps"],
        answers=given["answers"],
        length_over_radius=given["length_over_radius"],
        unit=given["unit"],
        fixtures=given["fixture"],
        **more,
    )


def main(args: Sequence[str] | None = None) -> NoReturn:
    """Entry point of the command: what has a part to read runs in a child process."""
    words = list(sys.argv[1:] if args is None else args)
    if words[:1] == ["map"] and not os.path.exists("map"):
        from plan_cutters.command.map import main as map_of_a_point

        map_of_a_point(words[1:])
    if is_child():
        # Whoever started the command may ignore interrupts, as a shell does for what runs in the background: the parent does not.
        signal.signal(signal.SIGINT, signal.default_int_handler)
        gc.disable()  # nothing of what imports make is garbage; `one_part` turns it on again
        limit_memory()
        keep_output()
        code, line = guarded(lambda: (_parsed(words), ""), "--debug" in words)
    else:
        code, line = guarded(lambda: (_watched(words), ""), "--debug" in words)
    if line:
        click.echo(line, err=True)
    if is_child():
        # Everything is on disk: to take the CAD kernel and the compiler down in order would only cost time, up to a second.
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)
    sys.exit(code)


def _parsed(words: list[str]) -> int:
    try:
        return int(command.main(words, prog_name="plan-cutters", standalone_mode=False) or 0)
    except click.Abort:
        raise KeyboardInterrupt from None


def _watched(words: list[str]) -> int:
    """Look at the words here, so that help and mistakes cost nothing; leave the work to a child."""
    try:
        with command.make_context("plan-cutters", list(words)) as context:
            given = dict(context.params)
    except click.exceptions.Exit as done:
        return done.exit_code
    if not given["read_timeout"] > 0:
        raise click.BadParameter("--read-timeout must be a positive number of seconds")
    if not can_supervise():
        keep_output()
        return _parsed(words)
    memory = default_memory() if given["memory"] is None else int(given["memory"] * 1e9)
    if memory < 2e9:
        raise click.BadParameter("--memory must be at least 2 GB")
    try:
        return supervise(words, read_timeout=given["read_timeout"], memory=memory)
    except Unfinished as ended:
        from plan_cutters.command.one_part import without_models

        return without_models(ended, given)
