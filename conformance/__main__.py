"""The command: `python -m conformance --help`."""

import json
import os
import sys
import tempfile
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Annotated, Any, NoReturn

import numpy as np
import typer
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn
from rich.table import Table

from conformance import VERSION
from conformance.programs import MODULES, program
from conformance.programs.protocol import UNDECIDED, Unavailable
from conformance.suite import DATA, Suite, read

app = typer.Typer(
    help="A benchmark of cutter accessibility: may this tool stand at this point? Parts with known answers, and a scorer.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode="rich",
)
out, err = Console(), Console(stderr=True)
#: Where results lie.
RESULTS = Path(__file__).parent / "results"

Kind = Annotated[str, typer.Option(help="Which half of the suite: made (closed forms) or real (bounds).")]
Data = Annotated[Path, typer.Option(help="Folder with made.json, made.parquet and made/.", show_default="the suite's own")]
Tolerance = Annotated[float, typer.Option(help="Depths and clearances up to this are at the border, mm: there each answer is right.")]


def _refuse(text: object) -> NoReturn:
    """End with one line and code 2."""
    err.print(" ".join(str(text).split()), style="red", markup=False, highlight=False, soft_wrap=True)
    raise typer.Exit(2)


def _suite(kind: str, data: Path, parts: list[str] | None = None) -> Suite:
    """Read a half of the suite, or end with one line."""
    if kind not in ("made", "real"):
        _refuse(f"--kind {kind}: choose made or real")
    try:
        suite = read(kind, data)
    except (OSError, ValueError, KeyError) as error:
        _refuse(f"the suite cannot be read: {error}")
    unknown = sorted(set(parts or ()) - set(suite.parts))
    if unknown:
        _refuse(f"no part is called {unknown[0]!r}{_near(unknown[0], suite.parts)}; {kind}.json has {len(suite.parts)}, and a new part after `generate`")
    return suite


def _positive(tolerance: float) -> float:
    if not 0 < tolerance <= 10:
        _refuse(f"--tolerance {tolerance:g}: it lies between 0 and 10 mm")
    return tolerance


def write_aside(path: Path, write: Callable[[Path], Any]) -> None:
    """Write a file under another name in its folder, and rename it: what is interrupted leaves no half of a file."""
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.stem}.", suffix=path.suffix)
    os.close(handle)
    try:
        write(Path(name))
        os.chmod(name, 0o644)
        os.replace(name, path)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise


def _writable(*paths: Path | None) -> None:
    """Refuse before the work what no file can be written to."""
    for path in paths:
        if path is None:
            continue
        if path.is_dir():
            _refuse(f"{path}: is a folder; give the name of a file")
        parent = next(p for p in path.absolute().parents if p.exists())
        if not parent.is_dir() or not os.access(parent, os.W_OK):
            _refuse(f"{path}: cannot be written there")


def _write_json(path: Path, document: dict[str, Any]) -> None:
    text = json.dumps(document, indent=1, ensure_ascii=False, allow_nan=False) + "\n"
    write_aside(path, lambda aside: aside.write_text(text, encoding="utf-8"))


@app.command("run")
def run_command(
    name: Annotated[str, typer.Option("--program", help="Which program; `programs` lists them.")],
    json_file: Annotated[Path | None, typer.Option("--json", help="Write the results here.")] = None,
    every: Annotated[bool, typer.Option("--all", help="All postures, in place of a few of each part.")] = False,
    each: Annotated[int | None, typer.Option(help="How many postures of each part.", show_default="2, twins left out")] = None,
    part: Annotated[list[str] | None, typer.Option(help="Only this part; may be given again.")] = None,
    kind: Kind = "made",
    data: Data = DATA,
    tolerance: Tolerance = 0.01,
    answers: Annotated[Path | None, typer.Option(help="Write the answers here, as CSV or Parquet.")] = None,
) -> None:
    """Run a program over the suite and score it."""
    from conformance.run import EACH, run
    from conformance.score import write_answers

    _positive(tolerance)
    suite = _suite(kind, data, part)
    if each is not None and each < 1:
        _refuse(f"--each {each}: give at least 1")
    if answers is not None and answers.suffix not in (".csv", ".parquet"):
        _refuse(f"--answers {answers.name}: give a .csv or a .parquet")
    _writable(json_file, answers)
    count = len(suite.postures) if every else EACH if each is None else each
    # The default run leaves the twins out: it is a first look.
    names = set(part) if part else None if every or each is not None else {n for n, p in suite.parts.items() if p.twin_of is None}
    rows = suite.rows(max(1, count), names)
    some = Suite(suite.parts, suite.postures[rows])
    groups = sum(1 for _ in some.groups())
    columns = TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn()
    try:
        with Progress(*columns, console=err, transient=True, disable=not err.is_terminal) as progress:
            task = progress.add_task(name, total=groups)
            ran = run(name, some, lambda text: progress.update(task, advance=1, description=text))
    except (Unavailable, ValueError) as error:
        _refuse(error)
    except KeyboardInterrupt:
        err.print("interrupted: nothing is written", style="red")
        raise typer.Exit(130) from None
    document = ran.document(some, kind, every, None if ran.claims else rows, tolerance)
    if json_file is not None:
        _write_json(json_file, document)
    if answers is not None and not ran.claims:
        write_aside(answers, lambda aside: write_answers(aside, rows, ran.answers))
    _show(document, len(suite.postures))


@app.command("score")
def score_command(
    file: Annotated[Path, typer.Argument(help="CSV or Parquet with the columns id (row of the table, from 0) and answer (safe, blocked, undecided).")],
    json_file: Annotated[Path | None, typer.Option("--json", help="Write the results here.")] = None,
    only_answered: Annotated[
        bool, typer.Option("--only-answered", help="Leave out postures that the file does not have; else they count as undecided.")
    ] = False,
    name: Annotated[str | None, typer.Option("--name", help="Name of the program.", show_default="that of the file")] = None,
    kind: Kind = "made",
    data: Data = DATA,
    tolerance: Tolerance = 0.01,
) -> None:
    """Score the answers of any program."""
    from conformance.run import Ran
    from conformance.score import read_answers

    _positive(tolerance)
    suite = _suite(kind, data)
    if not file.is_file():
        _refuse(f"{file.name}: no such file")
    _writable(json_file)
    try:
        rows, words = read_answers(file, len(suite.postures))
    except ValueError as error:
        _refuse(error)
    if not only_answered:
        whole = np.full(len(suite.postures), UNDECIDED, dtype="U9")
        whole[rows] = words
        missing = len(whole) - len(rows)
        if missing:
            err.print(f"{missing} of {len(whole)} postures are not answered: they count as undecided", style="yellow")
        rows, words = np.arange(len(whole)), whole
    table = suite.postures[rows]
    document = Ran(name or file.stem, table, words).document(Suite(suite.parts, table), kind, not only_answered, rows, tolerance)
    if json_file is not None:
        _write_json(json_file, document)
    _show(document, len(suite.postures))


@app.command()
def export(
    folder: Annotated[Path, typer.Argument(help="Where to: made if it is missing.")],
    kind: Kind = "made",
    data: Data = DATA,
    answers: Annotated[bool, typer.Option(help="With the known answers, or without: what a program gets.")] = True,
) -> None:
    """Write the postures as CSV, beside the schemas of table and parts."""
    suite = _suite(kind, data)
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{kind}.csv"
    write_aside(path, lambda aside: suite.postures.write_csv(aside, answers=answers))
    for schema in sorted((Path(__file__).parent / "schema").glob("*.schema.json")):
        text = schema.read_text(encoding="utf-8")
        write_aside(folder / schema.name, lambda aside, text=text: aside.write_text(text, encoding="utf-8"))
    out.print(f"{path}: {len(suite.postures)} postures of {len(set(suite.postures.part.tolist()))} parts", highlight=False)


@app.command()
def check(name: Annotated[str, typer.Argument(help="A made part.")], count: Annotated[int, typer.Option(help="Postures that are compared.")] = 24) -> None:
    """Compare a made part's closed forms and answers with points of its exact surface, and with bounds over it."""
    from conformance.exact.slow import read as shape_of
    from conformance.made.answers import doubts
    from conformance.made.check import AGREE, differences, faults, write_step
    from conformance.made.confirm import Around, contradictions
    from conformance.made.part import postures
    from conformance.made.parts import PARTS

    if name not in PARTS:
        _refuse(f"no made part is called {name!r}{_near(name, PARTS)}; a new one stands in PARTS at the end of its module in made/")
    part, tell = PARTS[name], lambda line: out.print(line, highlight=False, markup=False, soft_wrap=True)
    wrong = list(faults(part))
    if wrong:
        for line in wrong:
            tell(line)
        raise typer.Exit(1)
    table = postures(part, count, seed=1)

    def row(k: int) -> str:
        return f"posture {k}, {table.tool[k]} at {np.round(table.contact[k], 3)}, axis {np.round(table.axis[k], 4)}"

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"{name}.step"
        write_step(part, path)
        err.print(f"bounds over the surface: {len(table)} postures, {len(part.answers)} answers")
        around = Around(part, shape_of(path))
        excluded, unsure = list(contradictions(around, table)), list(doubts(around))
    err.print(f"points of the surface: {len(table)} postures, about a second each")
    apart = list(differences(part, table))
    for each in apart:
        tell(f"{row(each.row)}: form {each.form:.6f} mm, points {each.twin:.6f} mm")
    for each in excluded:
        tell(f"{row(each.row)}: form {each.form:.6f} mm, bounds {each.low:.6f} to {each.high:.6f} mm")
    for line in unsure:
        tell(line)
    tell(
        f"{name}: of {len(table)} postures points differ by more than {AGREE:g} mm in {len(apart)}, and bounds exclude {len(excluded)}; "
        f"of {len(part.answers)} answers bounds contradict {len({line.split(',')[0] for line in unsure})}"
    )
    if apart or excluded or unsure:
        raise typer.Exit(1)


def _near(name: str, names: Iterable[str]) -> str:
    """Return ": did you mean ..." where a name is nearly one of them."""
    from difflib import get_close_matches

    close = get_close_matches(name, list(names), 3, 0.5)
    return f": did you mean {', '.join(close)}?" if close else ""


@app.command()
def fetch(
    remote: Annotated[str, typer.Option(help="Address of a repository, with {repo} for owner/name.")] = "https://github.com/{repo}.git",
    files: Annotated[Path | None, typer.Option(help="A folder that is looked through first, by checksum.")] = None,
    only: Annotated[list[str] | None, typer.Option("--part", help="Only this part; may be given again.")] = None,
) -> None:
    """Bring the files of the real parts by git, into data/fetched; each has the licence that real/sources.csv names."""
    from conformance.real.sources import fetch as bring
    from conformance.real.sources import sources

    listed = [s for s in sources() if not only or s.name in only]
    if not listed:
        _refuse(f"--part {only[0] if only else ''}: no real part has that name")
    failed = bring(listed, remote=remote, files=files, tell=lambda line: out.print(line, highlight=False))
    for line in failed:
        err.print(line, style="red", markup=False, highlight=False, soft_wrap=True)
    if failed:
        raise typer.Exit(1)


@app.command()
def generate(
    data: Annotated[Path, typer.Option(help="Where to.", show_default="the suite's own folder")] = DATA,
    each: Annotated[int | None, typer.Option(help="Postures of each part.", show_default="those of the suite")] = None,
    only: Annotated[list[str] | None, typer.Option("--part", help="Only this part and its twin, the others stay; may be given again.")] = None,
) -> None:
    """Write the made half of the suite: STEP files, made.json, made.parquet."""
    from conformance.made.generate import EACH
    from conformance.made.generate import generate as write
    from conformance.made.parts import PARTS

    for name in only or ():
        if name not in PARTS:
            _refuse(f"no made part is called {name!r}{_near(name, PARTS)}")
    write(data, EACH if each is None else each, lambda line: out.print(line, highlight=False), only or ())


@app.command()
def programs() -> None:
    """List the programs that can be run, and what each needs."""
    table = Table("program", "what it is", "here")
    for name, (_, _, title) in MODULES.items():
        table.add_row(name, title, available(name))
    out.print(table)


def available(name: str) -> str:
    """Return `yes`, or what is missing."""
    try:
        program(name)
    except Unavailable as error:
        return str(error)
    return "yes"


@app.command()
def table(
    file: Annotated[Path, typer.Argument(help="The page to write.")], results: Annotated[Path, typer.Option(help="Folder with results as JSON.")] = RESULTS
) -> None:
    """Write the page of results: a table of the programs, and one of each class of parts."""
    from conformance.page import page

    try:
        text = page(results)
    except ValueError as error:
        _refuse(error)
    write_aside(file, lambda aside: aside.write_text(text, encoding="utf-8"))
    out.print(str(file), highlight=False)


def _show(document: dict[str, Any], total: int) -> None:
    """Show results as tables; where they are about a part of the postures, the title says of how many."""
    from conformance.page import CELLS, cells

    head = f"{document['program']}, {document['kind']} parts, tolerance {document['tolerance_mm']:g} mm, benchmark {VERSION}"
    if document["postures"] < total:
        head += f": {document['postures']:,} of {total:,} answered"
    shown = Table("family", *(title for title, _ in CELLS), title=head)
    for family, counted in document["families"].items():
        shown.add_row(family, *cells(counted))
    shown.add_section()
    shown.add_row("all", *cells(document), style="bold")
    out.print(shown)
    for text, count in document["why"].items():
        out.print(f"{count} times: {text}", markup=False, highlight=False)
    if document["seconds"]:
        out.print(
            f"{document['seconds']:.1f} s ({document['prepare_seconds']:.1f} to prepare, "
            f"{document['answer_seconds']:.1f} to answer), "
            f"{document['memory_mb']:.0f} MB",
            highlight=False,
        )
    for each in document["false_answers"][:5]:
        out.print(
            f"false {each['answer']}: row {each['row']}, {each['part']}, {each['tool']}, {each['setup']}: "
            f"margin {each['low']} to {each['high']} mm, "
            f"{each['reason']}",
            markup=False,
            highlight=False,
            soft_wrap=True,
        )


def main() -> None:
    """Run the command; a file that cannot be read or written is one line."""
    try:
        app(prog_name="python -m conformance")
    except OSError as error:
        err.print(f"{error.filename or 'a file'}: {error.strerror or error}", style="red", markup=False, highlight=False, soft_wrap=True)
        sys.exit(2)


if __name__ == "__main__":
    main()
