"""`plan-cutters map`: every free tilt of one cutter at one point of a part, as a table and as a picture."""

import contextlib
import json
import math
import os
import signal
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import click

from plan_cutters.command.codes import ENDED, ended, interrupt, invoked
from plan_cutters.command.option_groups import Command, heading, options
from plan_cutters.command.progress import Display
from plan_cutters.command.request import MapRequest, posture_options, read_tools, takes
from plan_cutters.command.terminal import hand_out, paper
from plan_cutters.command.validation import File, Setup, Words, cutter_ids, three
from plan_cutters.errors import OptionError, PlanError
from plan_cutters.option_table import LEAST_TOLERANCE, OF_A_SCENE, OPTIONS
from plan_cutters_base.terminal_text import clean
from plan_cutters_base.whole import refusal, whole
from plan_cutters_base.workers.child import began, can_supervise, is_child, report
from plan_cutters_base.workers.supervise import supervise

if TYPE_CHECKING:
    from rich.console import Console

    from cad_io.arrays import Floats
    from plan_cutters.domain.cutter import Cutter
    from plan_cutters.judging.posture_maps import PostureMap
    from plan_cutters.options import Options

_SELF = "plan-cutters map"
#: Some tilt is free; none is; none is, but some are undecided, or obstacles are missing.
_FREE, _NONE, _UNDECIDED = 0, 1, 4


_point = heading("Point")


@click.command(
    cls=Command,
    examples=(
        (f"{_SELF} samples/v_groove.step --at 0,0,0 --cutter R8L90 --tilt 0:60", "A cutter at the bottom of a groove:"),
        (f"{_SELF} blade.step --at 12,3,4 --cutter R6L80 --machine trunnion-ac", "The tilts that a machine holds there:"),
    ),
    codes=(
        ("0", "some tilt is free, or the tool with the point under its flat or along its flank"),
        ("1", "none is"),
        ("2", "wrong command line"),
        ("3", "the part cannot be read, or the point is on none of its faces"),
        ("4", "no tilt is surely free, but some are undecided"),
        ENDED,
    ),
)
@click.argument("part", metavar="PART", type=File("PART"))
@_point("--at", required=True, metavar="X,Y,Z", help="The point, part coordinates, mm.")
@_point(
    "--within",
    type=float,
    default=1.0,
    metavar="MM",
    help="How far the point may be from the part: the nearest point of a face is taken, and reported.  [default: 1]",
)
@options(
    *(each.called for each in OPTIONS.values() if each.of_a_point), "debug",
    cutter={"multiple": False, "default": None, "type": Words("SPEC|NAME", cutter_ids),
            "help": "D12L80, R6L80 and so on; with --cutters the id or the name of a tool there, unless it holds one alone."},
    cutters={"multiple": False, "default": None, "help": "Tool library that the cutter is taken from."},
    setup={"multiple": False, "default": "0,0,1", "type": File("AXIS|FILE"),
           "help": "Direction of the part along the machine's spindle, +z, -y or x,y,z, or a setup file.  [default: 0,0,1]"},
    rotation_step={"default": 5.0, "help": "Step between rotations.  [default: 5]"},
    tolerance={"help": "Gouge tolerance; 0: the nominal answer, which proves nothing.  [default: 0.01]"},
    out={"multiple": True, "type": File("FILE"), "help": ".png or .svg. Repeatable.  [default: <part>-map.png and .svg]"},
    json={"help": "The map on standard output, and no table."},
    quiet={"help": "No table."},
)  # fmt: skip
@takes(MapRequest)
def command(request: MapRequest) -> int:
    """Find the free tilts of one cutter at one point of PART, rotation by rotation, and the causes that forbid the others.

    The free intervals are printed, and the map is drawn: tilt against rotation, forbidden tilts coloured by cause, undecided
    ones apart.
    """
    from cad_io.read.sniff import kind
    from plan_cutters.files.pictures import NO_PICTURES, draws_pictures

    part = request.part
    report("part", part)
    place = three(request.at, why := f"--at {request.at!r} is not 3 numbers, as 0,0,1")
    if not all(map(math.isfinite, place)):
        raise OptionError(why)
    if not request.within >= 0:
        raise OptionError("--within must be a distance in mm that is not negative")
    if request.json_out not in (None, "-"):
        raise OptionError("--json takes -, for standard output")
    kinds = ("png", "svg") if draws_pictures() else ()
    outs = [Path(out) for out in request.out] or [Path(f"{Path(part).stem}-map.{kind}") for kind in kinds]
    for out in outs:
        if out.suffix.lower() not in (".png", ".svg"):
            raise OptionError(f"-o {out}: pictures are written as .png or .svg")
        if not kinds:
            raise OptionError(f"-o {out}: {NO_PICTURES}")
        if not out.absolute().parent.is_dir():
            raise OptionError("cannot be written: there is no such folder", file=str(out))
        if why := refusal(out.absolute().parent):
            raise OptionError(f"cannot be written: {why}", file=str(out))
    kind(part)
    options = _options(request)
    (cutter,), machine, placement = options.judged, options.machine, options.placement
    if machine.turns and machine.turning < 2:
        raise OptionError(
            f"machine {machine.name} has fewer than two rotary axes: it holds no tilt at most rotations, and the map would be "
            "empty; leave --machine out, or plan the part with it"
        )
    from cad_io import read_part
    from cad_io.sample import locate, nearest
    from plan_cutters.calls import posture_map
    from plan_cutters.scene.scene import Scene

    words: dict[str, Any] = {word: getattr(options, word) for word in OF_A_SCENE if word != "tolerance"}
    words |= {"tolerance": request.tolerance} if request.tolerance > 0 else {}
    scene = Scene.of(read_part(part, unit=options.unit, guarded=hasattr(os, "fork")), **words)
    foot, off = nearest(scene.part, place, ignore=scene.ignored)
    if off > request.within:
        raise OptionError(
            f"the point ({_text(place)}) is {off:.4g} mm from the part: the nearest point of a face is ({_text(foot)}); give "
            f"that, or --within {math.ceil(off)}",
            file=part,
        )
    result = posture_map(
        scene, point=foot.tolist(), cutter=cutter, rotations=options.postures.rotations, tilt=options.tilt, machine=machine,
        tolerance=request.tolerance, x=None if placement is None else placement.x,
    )  # fmt: skip
    face = f"F{locate(scene.part, scene.orientation, foot.tolist(), ignore=scene.ignored).face[0]}"
    about = _about(result, face, off, cutter, request)
    if outs:
        _draw(result, options.tilt, about, outs)
    if request.json_out == "-":
        hand_out(json.dumps(_facts(result, face, off, cutter, request, options.tilt), indent=2) + "\n")
    elif not request.quiet:
        with paper(80) as console:
            _table(result, about, outs, console)
    if (result.lies_flat or result.lies_along or any(len(each) for each in result.free)) and not result.missing:
        return _FREE
    return _UNDECIDED if result.missing or any(len(each) for each in result.undecided) else _NONE


def _options(request: MapRequest) -> "Options":
    """The options of a plan of one cutter, which is inline or of a library."""
    from plan_cutters.options import Options

    library, options = request.libraries, posture_options(request)
    if library:
        tools = read_tools((), (library,), request.holder, skip_bad=True)
        cutters = tuple(each for each in tools.libraries[0] if request.cutters in (None, each.id, each.name))
        if len(cutters) != 1:
            many = "several tools are" if cutters else "no tool is"
            which = "there: give one with --cutter" if request.cutters is None else f"called {request.cutters!r}"
            raise OptionError(f"{many} {which}; plan-cutters tools lists them", file=library)
    elif request.cutters is None:
        raise OptionError("give the cutter: --cutter D12L80, or the --cutters of a library")
    else:
        tools = read_tools((request.cutters,), (), request.holder)
        cutters = tools.cutters
    # A map may be requested with a smaller one, and with none.
    tolerance = max(request.tolerance, LEAST_TOLERANCE)
    words: dict[str, Any] = {**options, "cutters": cutters, "holder": tools.holder, "tolerance": tolerance,
                             "setup": Setup().convert(request.setup, None, None)}  # fmt: skip
    return Options(**words)


def _text(values: Iterable[float]) -> str:
    return ", ".join(f"{round(float(x), 9) + 0.0:.6g}" for x in values)


def _about(result: "PostureMap", face: str, off: float, cutter: "Cutter", request: MapRequest) -> list[str]:
    """Describe the map line by line: its contact, cutter and search; the first line is its title."""
    from plan_cutters.domain.dimensions import notation, parted
    from plan_cutters.domain.figures import angle, capital, mm
    from plan_cutters.plan_file.words.names import called
    from plan_cutters.report.drawing.posture_map import printable

    curvature = ", ".join(f"{x + 0.0:.4g}" for x in result.curvature)
    apart = "one rotation: others are not judged"
    if len(result.rotations) > 1:
        step = math.degrees(result.rotations[1] - result.rotations[0])
        apart = f"rotations {angle(step)} apart: nothing is said between them"
    proved = f"gouge tolerance {mm(result.tolerance)}" if result.tolerance else "nominal, not certified"
    held = f", {cutter.holder.called(notation(cutter.name))}" if cutter.holder else ""
    title = f"{capital(called(cutter))}{held} ({parted(cutter.typed)[0]})"
    moved = f"; the requested point is {mm(off)} off" if off > 1e-3 else ""
    lines = [
        f"{title} at ({_text(result.point)}) on {face} of {printable(Path(request.part).name, 80)}",
        f"Normal ({_text(result.normal)}), rotation 0 towards ({_text(result.direction_max)}); curvatures "
        f"{curvature} 1/mm, concave positive{moved}.",
        f"Machine {printable(Path(request.machine).name, 40)}, setup {printable(Path(request.setup).name, 40)}; {proved}; "
        f"{apart}.",
    ]
    if result.missing:
        lines.append(
            f"Not certified: obstacles are missing or guessed ({len(result.missing)}), first {printable(result.missing[0])}."
        )
    elif result.tolerance:
        lines.append(
            "A free tilt is safe for the true surface to the tolerance; of several causes the first in the legend is shown."
        )
    if result.lies_flat:
        away = mm(math.hypot(*result.under_flat.tolist()))
        lines.append(f"Upright the tool is free with the point under its flat, {away} from its axis.")
    if result.lies_along:
        lines.append(f"With the axis ({_text(result.flank_axis)}) the tool is free, its flank along the surface.")
    return lines


def _degrees(intervals: "Floats") -> list[list[float]]:
    return [[math.degrees(low), math.degrees(high)] for low, high in intervals.tolist()]


def _facts(
    result: "PostureMap", face: str, off: float, cutter: "Cutter", request: MapRequest, searched: tuple[float, float]
) -> dict[str, Any]:
    """The map as JSON has it; degrees and mm."""
    from plan_cutters.plan_file.reasons import INTERVALS

    words = ("free", "undecided", *INTERVALS)
    none = [None if math.isnan(x) else math.degrees(x) for x in result.local_gouge.tolist()]
    return {
        "format": "plan-cutters-map", "format_version": 1,
        "part": Path(request.part).name, "face": face, "point": result.point.tolist(),
        "off_mm": off, "normal": result.normal.tolist(), "direction_max": result.direction_max.tolist(),
        "curvature": result.curvature.tolist(), "cutter": cutter.id, "machine": request.machine,
        "setup": request.setup,
        "under_flat_mm": result.under_flat.tolist() if result.lies_flat else None,
        "flank_axis": result.flank_axis.tolist() if result.lies_along else None,
        "tilt_deg": [math.degrees(tilt) for tilt in searched],
        "tolerance_mm": result.tolerance, "certified": result.certified, "missing": list(result.missing),
        "rotations": [
            {"deg": math.degrees(turn), "local_gouge": none[i], **{w: _degrees(getattr(result, w)[i]) for w in words}}
            for i, turn in enumerate(result.rotations.tolist())
        ],
    }  # fmt: skip


def _draw(result: "PostureMap", tilt: tuple[float, float], about: list[str], outs: Sequence[Path]) -> None:
    """Draw the files, each whole or not at all."""
    from plan_cutters.report.drawing.posture_map import draw_map

    temporary: dict[Path, Path] = {}
    try:
        with contextlib.ExitStack() as stack:
            for out in outs:
                temporary[stack.enter_context(whole(out, named=lambda path: report("staging", str(path.absolute()))))] = out
            draw_map(result, tilt, about[0], about[1:], list(temporary))
    except OSError as error:
        out = next((out for path, out in temporary.items() if error.filename == str(path)), outs[0])
        raise PlanError(f"cannot be written: {error.strerror or error}", file=str(out)) from None


def _table(result: "PostureMap", about: list[str], outs: Sequence[Path], console: "Console") -> None:
    from rich.table import Table

    from plan_cutters.files.pictures import NO_PICTURES

    for line in about:
        console.print(clean(line), soft_wrap=True)
    table = Table("Rotation", "Free tilts (deg)", "Undecided", "Local gouge below")
    for column in (table.columns[0], table.columns[3]):
        column.justify = "right"
    for i, turn in enumerate(result.rotations.tolist()):
        gouge = result.local_gouge[i]
        below = "always" if math.isnan(gouge) else f"{math.degrees(gouge):.2f}"
        table.add_row(
            f"{math.degrees(turn):g}",
            _spans(result.free[i]) or ("under 0.01" if len(result.free[i]) else "none"),
            _spans(result.undecided[i], False),
            below,
        )
    console.print(table)
    names = " and ".join(clean(str(out)) for out in outs)
    console.print(f"Pictures in {names}." if outs else f"No picture: {NO_PICTURES}", soft_wrap=True)


def _spans(intervals: "Floats", inward: bool = True) -> str:
    """Intervals of degrees, two digits behind the point: of free ones none is told wider than it is."""
    spans = []
    for low, high in _degrees(intervals):
        first, last = (math.ceil, math.floor) if inward else (math.floor, math.ceil)
        if not inward or first(100 * low - 1e-7) <= last(100 * high + 1e-7):
            spans.append(f"{first(100 * low - 1e-7) / 100:.2f} to {last(100 * high + 1e-7) / 100:.2f}")
    return ", ".join(spans)


def main(words: Sequence[str], name: str | None = None) -> NoReturn:
    """Run the command.

    The work is done in a child process, which can be ended while the CAD kernel is busy; not where Python calls, which gives no
    name.
    """
    if name and can_supervise() and not is_child():
        ended(name, words, lambda: _watched(words, name))
    if is_child():
        signal.signal(signal.SIGINT, interrupt)
    ended(name or _SELF, words, lambda: invoked(command, name or _SELF, words))


def _watched(words: Sequence[str], name: str) -> int:
    """Look at the words here, so that help and mistakes cost nothing; leave the work to a child."""
    try:
        command.make_context(name, list(words)).close()
    except click.exceptions.Exit as done:
        return done.exit_code
    return supervise(words, display=Display(True, 1, began()), name=name)
