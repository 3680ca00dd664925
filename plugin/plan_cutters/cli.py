"""The command: arguments in, exit code out. The only module that prints and exits."""

import math
import sys
import traceback
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import click

from cad_io.units import UNITS
from plan_cutters import __version__
from plan_cutters.supervise import (
    INTERRUPTED,
    Supervised,
    Unfinished,
    default_memory,
    is_child,
    keep_output,
    limit_memory,
    report,
    supervise,
)

if TYPE_CHECKING:
    from plan_cutters.model import Plan
    from plan_cutters.options import Options

FEASIBLE, NONE_FEASIBLE, USAGE, UNREADABLE, NOT_ALL_JUDGED = 0, 1, 2, 3, 4

#: Options of the interface that later versions will have: asked for now, they must not be ignored.
_NOT_BUILT = {
    "cutters": "tool library files are not read yet; give each cutter with --cutter R6L80",
    "fixture": "fixtures are not read yet",
    "allowance": "an allowance is not judged yet",
    "holder_clearance": "holders are not judged yet",
    "holder": "holders are not judged yet",
    "assume_stickout": "tool library files are not read yet",
    "skip_bad": "tool library files are not read yet",
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


class _Vector(click.ParamType):
    """A direction x,y,z."""

    name = "X,Y,Z"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[float, ...]:
        try:
            x, y, z = (float(part) for part in value.split(","))
        except ValueError:
            self.fail(f"{value!r} is not of the form x,y,z, as 0,0,1", param, ctx)
        return x, y, z


@click.command(
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 110},
    epilog="Exit codes: 0 a cutter finishes every sample; 1 none does; 2 wrong command line; 3 the part cannot be "
    "read; 4 a cutter would finish all that could be judged, but something could not; 130 interrupted.",
)
@click.argument("parts", nargs=-1, required=True, metavar="PART...")
@click.option("--cutters", multiple=True, metavar="FILE", hidden=True)
@click.option(
    "--cutter",
    multiple=True,
    metavar="SPEC",
    help="A flat end as R6L80: radius 6, length 80 mm. Repeatable; default: built-in flat ends, R 1 to 12.",
)
@click.option(
    "--machine",
    default="unlimited",
    metavar="NAME",
    help="`unlimited` or `tilt:DEG`, a limit of the tool axis from the setup axis.  [default: unlimited]",
)
@click.option(
    "--setup",
    type=_Vector(),
    default="0,0,1",
    metavar="X,Y,Z",
    help="Direction of the part along the machine's spindle.  [default: 0,0,1]",
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
@click.option("--fixture", multiple=True, metavar="FILE", hidden=True)
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
@click.option("--allowance", type=float, hidden=True)
@click.option("--holder-clearance", type=float, hidden=True)
@click.option("--holder", multiple=True, metavar="FILE", hidden=True)
@click.option("--assume-stickout", type=float, hidden=True)
@click.option("--skip-bad", is_flag=True, hidden=True)
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
@click.option("--jobs", type=int, metavar="N", help="Threads.  [default: all cores]")
@click.option("--cluster", metavar="ADDRESS", hidden=True)
@click.option(
    "--area-budget",
    type=int,
    default=100_000,
    metavar="N",
    help="Contacts to look at between the samples of the selected cutter; 0: samples alone.  [default: 100000]",
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
    codes = []
    for part, out in zip(parts, outs, strict=True):
        code, line = _guarded(lambda part=part, out=out: _one(part, out, options, given), given["debug"])
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
    from plan_cutters.cutter import Cutter
    from plan_cutters.machine import Machine
    from plan_cutters.options import Options
    from plan_cutters.posture import PostureRange

    more = {} if given["jobs"] is None else {"jobs": given["jobs"]}
    return Options(
        cutters=tuple(Cutter.parse(spec) for spec in given["cutter"]),
        machine=Machine.parse(given["machine"]),
        setup=given["setup"],
        faces=given["faces"],
        ignore=given["ignore"],
        grid=given["grid"],
        spacing=given["spacing"],
        postures=PostureRange.degrees(given["tilt"], given["rotation"], given["rotation_step"]),
        tolerance=given["tolerance"],
        flip=given["flip"],
        area_budget=given["area_budget"],
        posture_maps=given["posture_maps"],
        unit=given["unit"],
        **more,
    )


def _one(part: str, out: Path, options: "Options", given: dict[str, Any]) -> tuple[int, str]:
    """Plan one part; exit code and a line about it."""
    from plan_cutters.report import DEFAULT_FORMATS, PLAN, Staging, file_name, read_formats, write_all
    from plan_cutters.report.to_json import dumps, explain

    to_stdout = given["json_out"] == "-"
    # The plan on standard output: files only where they are asked for.
    default = () if to_stdout and given["out"] is None else DEFAULT_FORMATS
    formats = read_formats(given["formats"]) if given["formats"] else default
    report("part", part)
    staging = Staging(out) if formats else None
    if staging:
        report("staging", str(staging.folder))
    watch = _Onlooker(out, given)
    try:
        from plan_cutters.pipeline import run

        with _progress(given["quiet"]) as tell:
            result = run(part, options, progress=tell, read_timeout=given["read_timeout"])
        document = result.plan
        if not formats:
            watch.summarise(document)
        else:
            with watch:
                document = write_all(result, out, formats, staging, step_schema=given["step_schema"], onlooker=watch)
    except KeyboardInterrupt:
        if watch.plan is None:
            raise
        explain(out / PLAN, "interrupted")
        return INTERRUPTED, f"plan-cutters: interrupted; the plan is in {out}, not all models are"
    finally:
        if staging:
            staging.discard()
    if to_stdout:
        sys.stdout.write(dumps(document))
        sys.stdout.flush()
    if not given["quiet"]:
        for line in (*_written(document, out, formats), *_not_reached(document)):
            click.echo(line, err=True)
    for name, why in document.not_written.items():
        click.echo(f"plan-cutters: {file_name(name)} was not written: {why}", err=True)
    return _code(document), ""


def _code(plan: "Plan") -> int:
    if plan.selected is None:
        # What is missing from the obstacles leaves open whether a cutter that nothing else stops is stopped by it.
        doubtful = plan.missing and any(c.feasible is None for c in plan.cutters)
        return NOT_ALL_JUDGED if doubtful else NONE_FEASIBLE
    unjudged = plan.samples.unjudged or any(f.target and f.unjudged for f in plan.faces)
    return NOT_ALL_JUDGED if unjudged else FEASIBLE


def _written(plan: "Plan", out: Path, formats: Sequence[str]) -> list[str]:
    """What is in the output, and which faces the models show otherwise than split in their place."""
    from plan_cutters.report import left_over

    lines = []
    written = [*sorted(f.name for f in plan.files.values()), *(["plan.json"] if "json" in formats else [])]
    if written:
        lines.append(f"Written: {', '.join(written)} in {out}")
    for face, entry in plan.split.items():
        if entry.rung != "contour":
            how = "split beside the part" if entry.rung == "beside" else "one piece in the STEP, by samples in the GLB"
            lines.append(f"Not split in its place: {face} ({entry.why}): {how}.")
    if formats and (old := left_over(out, plan, formats)):
        lines.append(f"Left over from an earlier run, or not ours: {', '.join(old)} in {out}")
    return lines


def _summary(plan: "Plan") -> None:
    """What is found, but not what is not reached: that comes last."""
    from rich.console import Console
    from rich.table import Table

    console = Console(stderr=True, highlight=False, soft_wrap=True, markup=False)
    size = " x ".join(f"{s:.4g}" for s in plan.part.size_mm)
    targets = len(plan.effective.target_faces)
    ignored = sum(f.ignored for f in plan.faces)
    console.print(f"{plan.part.file or 'part'}: {size} mm, {plan.part.faces} faces, {targets} to machine, "
                  f"{f'{ignored} ignored, ' if ignored else ''}"
                  f"{plan.samples.count} samples, gaps up to {plan.samples.max_gap_mm:.3g} mm")  # fmt: skip
    table = Table(box=None, pad_edge=False)
    for column in ("cutter", "feasible", "free", "accessible", "undecided", "inaccessible"):
        table.add_column(column, justify="left" if column in ("cutter", "feasible") else "right")
    for c in plan.cutters:
        word = {True: "yes", False: "no", None: "undecided"}[c.feasible]
        table.add_row(c.id + (" *" if c.id == plan.selected else ""), word, str(c.interference_free),
                      str(c.accessible), str(c.undecided), str(c.inaccessible))  # fmt: skip
    console.print(table)
    console.print(f"Selected: {plan.selected or 'none'} ({plan.selection.why}).")
    console.print(_side(plan))
    for area in (c.area for c in plan.cutters if c.area):
        console.print(f"Between samples: {_percent(area.share)} of the target area is served with the axes found "
                      f"({area.contacts} contacts looked at).")  # fmt: skip
    for warning in plan.part.warnings:
        console.print(f"Warning: {warning}")
    for note in plan.notes:
        console.print(f"Note: {note}")
    for face in plan.faces:
        if face.target and face.unjudged:
            console.print(f"Not judged: {face.id} ({face.unjudged}).")
    for line in _missing(plan):
        console.print(line)


def _side(plan: "Plan") -> str:
    """How the side of the material was found, how sure that is, and what is open."""
    found, sewing = plan.part.orientation, plan.part.sewing
    line = f"Side of the material: {found.method} ({'sure' if found.confident else 'a guess'})."
    if sewing and sewing.tolerance_mm is not None:
        line += f" Faces were joined at {sewing.tolerance_mm:.3g} mm."
    if sewing and sewing.open_edges:
        line += f" Open edges: {sewing.open_edges}, {sewing.open_length_mm:.4g} mm long."
    return line


def _missing(plan: "Plan") -> list[str]:
    """Which obstacles are missing, so that no cutter is feasible beyond doubt."""
    where = {"none": "nothing stands for it", "box": "the box around it stands for it",
             "triangles": "its own triangles stand for it", "edges": "its edges stand for it"}  # fmt: skip
    return [
        f"Missing obstacle: {m.face or m.entity or 'a face of the file'} ({m.why}; {where[m.stand_in]})."
        for m in plan.missing
    ]


def _percent(share: float) -> str:
    """Rounded down, so that 100 % is all of it."""
    return f"{math.floor(1e4 * share) / 100:g} %"


def _not_reached(plan: "Plan") -> list[str]:
    """What the larger cutters than the selected (or all) leave, and why."""
    lines = []
    for c in plan.cutters:
        if c.id == plan.selected:
            break
        if not c.inaccessible + c.undecided:
            continue
        reasons = ", ".join(f"{count} {name.replace('_', ' ')}" for name, count in c.by_reason.items() if count)
        deepest = max((w for w in c.witnesses if w.depth_mm is not None), key=lambda w: w.depth_mm or 0, default=None)
        where = ""
        if deepest and deepest.depth_mm is not None:
            x, y, z = deepest.point
            where = (f"; at ({x:.4g}, {y:.4g}, {z:.4g}) on {deepest.face} the best posture is "
                     f"{deepest.depth_mm:.3g} mm too deep")  # fmt: skip
        left = c.inaccessible + c.undecided
        worst = sorted(((v.inaccessible + v.undecided, name) for name, v in c.faces.items()), key=lambda x: -x[0])
        on = ", ".join(f"{name} ({count})" for count, name in worst[:3] if count)
        more = sum(count > 0 for count, _ in worst) - 3
        on += f" and {more} more" if more > 0 else ""
        undecided = f", {c.undecided} undecided" if c.undecided else ""
        lines.append(
            f"Not reached by {c.id}: {left} of {plan.samples.count} samples ({reasons or 'none'}{undecided}), on {on}{where}."
        )
    return lines


class _Onlooker:
    """Shows what is found as soon as it is safe on disk, and tells the parent how far it is."""

    def __init__(self, out: Path, given: dict[str, Any]) -> None:
        self.out, self.given = out, given
        self.plan: Plan | None = None
        self.progress = _progress(given["quiet"])
        self.tell: Any = None

    def __enter__(self) -> "_Onlooker":
        return self

    def __exit__(self, *_: object) -> None:
        self.progress.__exit__()

    def summarise(self, plan: "Plan") -> None:
        if not self.given["quiet"]:
            _summary(plan)

    def safe(self, plan: "Plan") -> None:
        self.plan = plan
        report("safe", f"{_code(plan)} {self.out.absolute()}")
        self.summarise(plan)

    def begins(self, what: str) -> None:
        # Each step has the whole limit of the stage.
        self.tell = self.tell or self.progress.__enter__()
        self.tell("write", 0, 1)

    def failed(self, what: str, error: Exception) -> None:
        if self.given["debug"]:
            traceback.print_exception(error)


class _progress:
    """A bar on a terminal, plain lines otherwise, nothing where quiet."""

    def __init__(self, quiet: bool) -> None:
        self.quiet = quiet
        self.bar: Any = None
        self.tasks: dict[str, Any] = {}
        self.told: set[str] = set()

    def __enter__(self) -> Any:
        if not self.quiet and sys.stderr.isatty():
            from rich.console import Console
            from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

            self.bar = Progress(TextColumn("{task.description:>10}"), BarColumn(), TimeElapsedColumn(),
                                console=Console(stderr=True), transient=True)  # fmt: skip
            self.bar.start()
        return self.tell

    def tell(self, stage: str, done: int, total: int) -> None:
        if done == 0:
            report("stage", stage)
        if self.bar is not None:
            if stage not in self.tasks:
                self.tasks[stage] = self.bar.add_task(stage, total=total)
            self.bar.update(self.tasks[stage], completed=done, total=total)
        elif not self.quiet and stage not in self.told:
            self.told.add(stage)
            click.echo(f"{stage} ...", err=True)

    def __exit__(self, *_: object) -> None:
        if self.bar is not None:
            self.bar.stop()


def _guarded(work: Any, debug: bool) -> tuple[int, str]:
    """Run; errors that have a cause become an exit code and a line."""
    from cad_io.errors import CadIoError, WriteError
    from plan_cutters.errors import PlanError, UnjudgeableError

    try:
        code, line = work()
        return int(code), str(line)
    except (Exception, KeyboardInterrupt) as error:
        if debug:
            traceback.print_exc()
        match error:
            case KeyboardInterrupt():
                return INTERRUPTED, "plan-cutters: interrupted; no file is half-written"
            case Supervised():
                return UNREADABLE, f"plan-cutters: {error}"
            case MemoryError():
                return UNREADABLE, "plan-cutters: out of memory; sample more coarsely (--spacing), or give --memory"
            case UnjudgeableError():
                return UNREADABLE, f"plan-cutters: {error}"
            case WriteError() | PlanError():
                return USAGE, f"plan-cutters: {error}"
            case CadIoError():
                return UNREADABLE, f"plan-cutters: {error}"
            case click.ClickException():
                return USAGE, f"plan-cutters: {error.format_message()}"
            case _:
                return (
                    UNREADABLE,
                    f"plan-cutters: internal error ({type(error).__name__}: {error}); --debug shows where",
                )


def main(args: Sequence[str] | None = None) -> NoReturn:
    """Entry point of the command: what has a part to read runs in a child process."""
    words = list(sys.argv[1:] if args is None else args)
    if is_child():
        limit_memory()
        keep_output()
        code, line = _guarded(lambda: (_parsed(words), ""), "--debug" in words)
    else:
        code, line = _guarded(lambda: (_watched(words), ""), "--debug" in words)
    if line:
        click.echo(line, err=True)
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
    memory = default_memory() if given["memory"] is None else int(given["memory"] * 1e9)
    if memory < 2e9:
        raise click.BadParameter("--memory must be at least 2 GB")
    try:
        return supervise(words, read_timeout=given["read_timeout"], memory=memory)
    except Unfinished as ended:
        return _without_models(ended, given)


def _without_models(ended: Unfinished, given: dict[str, Any]) -> int:
    """The plan was safe when the process that made it was ended: say what is missing; its exit code stands."""
    from plan_cutters.report import PLAN, file_name
    from plan_cutters.report.to_json import explain

    path = ended.out / PLAN
    missing = ", ".join(map(file_name, explain(path, str(ended)))) or "a model"
    click.echo(f"plan-cutters: {missing} in {ended.out}: not written: {ended}", err=True)
    if given["json_out"] == "-" and path.is_file():
        click.echo(path.read_text(encoding="utf-8"), nl=False)
    left = given["parts"][ended.parts :]
    if left and ended.code != INTERRUPTED:
        click.echo(f"plan-cutters: not planned: {', '.join(left)}", err=True)
        return max(ended.code, UNREADABLE)
    return ended.code
