"""`plan-cutters tools`: what was understood of tool libraries, as a table, as JSON, as drawings and in our own format."""

import json
import re
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from plan_cutters.command.codes import ENDED, USAGE, faults
from plan_cutters.command.option_groups import Command, heading, options
from plan_cutters.command.request import ToolsRequest, takes
from plan_cutters.command.terminal import error, hand_out, paper
from plan_cutters.command.validation import File, Folder
from plan_cutters.errors import PlanError
from plan_cutters_base.terminal_text import clean
from plan_cutters_base.whole import whole

if TYPE_CHECKING:
    from rich.console import Console

    from plan_cutters.library.raw_tool import Entry, Library

_SELF = "plan-cutters tools"
_COLUMNS = ("", "No.", "Name", "Type", "Unit", "DC", "RE", "LCF", "Stick-out", "Shank", "Holder", "Id, or why not used")
#: Columns of a terminal in which the table would fall into pieces.
_NARROW = 130


_cutters, _output = heading("Cutters"), heading("Output")


@click.command(
    cls=Command,
    examples=(
        (f"{_SELF} shop.tools", "The tools of a library that can be judged, and why the rest cannot:"),
        (f"{_SELF} shop.tools --assume-stickout 35 --holder R15L40", "With what the library leaves out:"),
        (f"{_SELF} --cutter D12L80 --holder hsk63a-er32 --draw drawings", "A picture of an assembly given by words:"),
        (f"{_SELF} --list-holders", "The built-in holders:"),
        (f"{_SELF} shop.tools --draw drawings --to-toml shop.toml", "Drawings to scale, and the tools as TOML:"),
    ),
    codes=(
        ("0", "each file holds a tool that can be judged, or a holder"),
        ("2", "one does not, or the command line is wrong"),
        ENDED,
    ),
)
@click.argument("files", nargs=-1, metavar="[FILE]...", type=File("FILE"))
@options(
    "holder",
    "assume_stickout",
    "skip_bad",
    cutter={"help": "A cutter by words, D12L80 and so on, to be shown, also as a picture. Repeatable."},
)
@_cutters("--list-holders", is_flag=True, help="List the built-in holders; with --draw, draw each with its largest shank.")
@_output("--json", "as_json", is_flag=True, help="All that was understood, as JSON on standard output.")
@_output("--to-toml", type=File("FILE"), help="Write the tools that can be judged in our own format.")
@_output("--draw", type=Folder("DIR"), help="Draw each assembly to scale (SVG) into a folder.")
@options("debug")
@takes(ToolsRequest)
def command(request: ToolsRequest) -> int:
    """List the tools in FILE as they are understood, and say why some cannot be judged.

    It reads Fusion .tools, .json and CSV, HSMWorks .hsmlib, FreeCAD .fctl, .fctb and .fcholder, and TOML.
    """
    from plan_cutters.library.read import holder_of, listing, nothing, of_words

    if request.list_holders:
        return _holders(request)
    if not request.files and not request.cutters:
        raise click.UsageError("Missing argument 'FILE...'.")
    holder = None if request.holder is None else holder_of(request.holder)
    libraries: list[Library] = []
    if request.cutters:
        libraries.append(of_words(request.cutters, None if isinstance(holder, str) else holder))

    def one(file: str) -> None:
        library = listing(file, assume_stickout=request.assume_stickout, holder=holder, skip_bad=request.skip_bad)
        libraries.append(library)
        if not library and not library.drills and not (library.holders and not library.entries):
            raise nothing(library)

    lines = faults(request.files, one, request.debug)
    if not lines:
        # Nothing is written if anything was wrong.
        if request.to_toml is not None:
            texts = [import_module("plan_cutters.library").to_toml(library) for library in libraries]
            # Every part says the unit; the file says it once.
            text = "".join([texts[0], *(part.replace('unit = "mm"\n', "", 1) for part in texts[1:])])
            with whole(request.to_toml, PlanError) as temporary:
                temporary.write_text(text, encoding="utf-8")
        if request.draw is not None:
            _draw(libraries, Path(request.draw))
    if request.as_json:
        document = {"format": "plan-cutters-tools", "format_version": 1, "libraries": [_plain(library) for library in libraries]}
        hand_out(json.dumps(document, indent=2, ensure_ascii=False) + "\n")
    else:
        with paper(200) as console:
            for library in libraries:
                _table(library, console)
    for line in lines:
        error(line)
    return USAGE if lines else 0


def _holders(request: ToolsRequest) -> int:
    """The built-in holders: listed, and drawn where that is requested."""
    from plan_cutters.library.read import pinned, standard

    named = {"cutter": request.cutters, "holder": request.holder, "assume-stickout": request.assume_stickout,
             "to-toml": request.to_toml}  # fmt: skip
    others = [*request.files, *(f"--{word}" for word, value in named.items() if value)]
    if others:
        raise click.UsageError(f"--list-holders lists the built-in holders alone: leave out {others[0]}")
    if request.draw is not None:
        _draw(pinned(), Path(request.draw))
    if request.as_json:
        plain = [{"word": word, "name": each.name, "id": each.id, "bore": each.bore} for word, each in standard().items()]
        document = {"format": "plan-cutters-holders", "format_version": 1, "holders": plain}
        hand_out(json.dumps(document, indent=2) + "\n")
        return 0
    lines = [
        "Collet chucks as outer bounds, from the nose up to the gauge line; mm. A chuck of another length: hsk63a-er32x120.",
        f"{'word':14}{'shank up to':>12}  {'length':>6}  sections from the nose up, diameter x length",
    ]
    for word, each in standard().items():
        sections = " + ".join(f"D{2.0 * stage.radius:g} x {stage.length:g}" for stage in each.stages)
        lines.append(f"{word:14}{each.bore:12g}  {sum(stage.length for stage in each.stages):6g}  {sections}")
    hand_out("\n".join(lines) + "\n")
    return 0


def _plain(library: "Library") -> dict[str, Any]:
    from plan_cutters.domain.shapes import flute_length

    return {
        "file": library.file,
        "format": library.format,
        "notes": list(library.notes),
        "cutters": [
            {"id": cutter.id, "numbers": list(library.numbers(cutter)), "names": list(library.names(cutter)),
             "shape": cutter.shape, "radius": cutter.radius, "corner_radius": cutter.corner_radius, "length": cutter.length,
             "flutes": flute_length(cutter), "holder": cutter.holder and {"name": cutter.holder.name, "id": cutter.holder.id}}
            for cutter in library
        ],
        "entries": [
            {"place": entry.place, "number": entry.number, "name": entry.name, "type": entry.kind, "unit": entry.unit or None,
             "cutter": entry.cutter and entry.cutter.id, "drill": entry.drill and entry.drill.id, "unused": entry.unused,
             "broken": entry.broken, "notes": list(entry.notes), "given": dict(entry.given)}
            for entry in library.entries
        ],
        "holders": [{"name": holder.name, "id": holder.id} for holder in library.holders],
    }  # fmt: skip


def _table(library: "Library", console: "Console") -> None:
    """A library for people: widths follow the words where the output is no terminal."""
    from rich.table import Table

    used = sum(entry.cutter is not None or entry.drill is not None for entry in library.entries)
    tools = "1 tool" if len(library.entries) == 1 else f"{len(library.entries)} tools"
    heads = [f"{library.file}: {library.format}, {tools} listed, {used} used, {len(library)} different"]
    heads += [f"  {note}" for note in library.notes]
    heads += [f"  holder {holder.name}: {holder.id}" for holder in library.holders]
    for line in heads:
        console.print(clean(line), soft_wrap=True)
    if not library.entries:
        return
    if console.width < _NARROW:
        for entry in library.entries:
            _listed(console, _row(entry))
        return
    table = Table(*_COLUMNS)
    for column in table.columns[5:10]:
        column.justify = "right"
    table.columns[-1].overflow = "fold"
    for entry in library.entries:
        table.add_row(*_row(entry))
    console.print(table)


def _listed(console: "Console", row: list[str]) -> None:
    """A tool where a table has no room: a line of names, a line of dimensions, and its id or why it is not used."""
    from rich.padding import Padding

    place, number, name, kind, unit, *sizes, why = row
    console.print(" ".join(word for word in (place, number and f"T{number}", name and f'"{name}"', kind) if word))
    sizes_text = [f"{word} {size}" for word, size in zip(_COLUMNS[5:11], sizes, strict=True) if size]
    if sizes_text:
        console.print(Padding(f"{', '.join(sizes_text)}{f' ({unit} in the file)' if unit else ''}", (0, 0, 0, 4)))
    console.print(Padding(why, (0, 0, 0, 4)), overflow="fold")


def _row(entry: "Entry") -> list[str]:
    codes, cutter = dict(entry.given), entry.cutter
    if entry.drill is not None:
        codes |= {"LCF": entry.drill.body.flutes or codes.get("LCF", 0.0)}
    number = "" if entry.number is None else str(entry.number)
    words = [entry.place, number, entry.name, entry.kind, entry.unit]
    if cutter is None:
        why = f"{'broken' if entry.broken else 'not used'}: {entry.unused}" if entry.drill is None else entry.drill.id
        sizes = [f"{codes[key]:.6g}" if key in codes else "" for key in ("DC", "RE", "LCF", "LPR", "DMM")]
        return [*map(clean, (*words, *sizes, "", "; ".join([why, *entry.notes])))]
    from plan_cutters.domain.shapes import flute_length

    shank = "" if cutter.shank_radius is None else f"{2 * cutter.shank_radius:.6g}"
    lengths = [2 * cutter.radius, cutter.corner_radius, flute_length(cutter), cutter.length]
    holder = "none" if cutter.holder is None else cutter.holder.name or cutter.holder.id
    sizes = [f"{length:.6g}" for length in lengths]
    return [*map(clean, (*words, *sizes, shank, holder, "; ".join([cutter.id, *entry.notes])))]


def _draw(libraries: "Sequence[Library]", folder: Path) -> None:
    from plan_cutters.domain.dimensions import is_spec
    from plan_cutters.plan_file.words.names import called

    draw = import_module("plan_cutters.report.drawing.tool").draw
    drawings: dict[str, str] = {}
    for library in libraries:
        for cutter in library:
            numbers = library.numbers(cutter)
            held = f", {cutter.holder.name}" if cutter.holder and is_spec(cutter.name or cutter.id) else ""
            words = [*(f"T{number}" for number in numbers[:1]), f"{called(cutter)}{held}"]
            stem = re.sub(r"[^\w.-]+", "_", " ".join(words)).strip("._")[:80] or "tool"
            name, i = stem, 2
            while name in drawings:
                name, i = f"{stem}_{i}", i + 1
            drawings[name] = draw(cutter, name=" ".join(words))
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise PlanError(f"cannot be made: {error.strerror}", file=str(folder)) from None
    for name, text in drawings.items():
        with whole(folder / f"{name}.svg", PlanError) as temporary:
            temporary.write_text(text, encoding="utf-8")
