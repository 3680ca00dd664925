"""Show which faces and cutters were lost or won from one plan to another."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import click

from plan_cutters.command.codes import ENDED, USAGE
from plan_cutters.command.option_groups import Command, heading, options
from plan_cutters.command.request import takes
from plan_cutters.command.terminal import error, hand_out, paper
from plan_cutters.command.validation import File, Folder, Words
from plan_cutters.errors import PlanError
from plan_cutters_base.terminal_text import clean

if TYPE_CHECKING:
    from rich.console import Console

    from plan_cutters_ci.model import Comparison, PlanDifference

_SELF = "plan-cutters diff"
#: Something was lost; two plans that cannot be compared are as a wrong command line.
LOST, NOT_COMPARABLE = 1, USAGE
_COLOURS = {"lost": "bold red", "less": "red", "won": "green", "lost and won": "bold red"}

_output, _rules = heading("Output"), heading("Comparison")


def requested_words() -> Sequence[str]:
    from plan_cutters_ci.model import REQUESTED

    return REQUESTED


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class DiffRequest:
    """The difference of two plans: `plan-cutters diff`."""

    old: str
    new: str
    as_json: bool
    as_markdown: bool
    out: str | None
    junit: str | None
    slack: float
    despite: str
    debug: bool


@click.command(
    cls=Command,
    examples=(
        (f"{_SELF} before-plan after-plan", "What a change of the part costs:"),
        (f"{_SELF} before-plan after-plan -o compared", "Both parts side by side, in compared/review.html:"),
        (f"{_SELF} monday friday --markdown", "Two folders of many plans, as Markdown:"),
    ),
    codes=(
        ("0", "nothing was lost"),
        ("1", "a face or a cutter lost, or a plan is in OLD alone"),
        ("2", "the plans are not comparable, cannot be read, or the command line is wrong"),
        ENDED,
    ),
)
@click.argument("old", type=File("OLD"))
@click.argument("new", type=File("NEW"))
@_output("--json", "as_json", is_flag=True, help="All differences, as JSON on standard output.")
@_output("--markdown", "as_markdown", is_flag=True, help="The same tables as Markdown, for the summary of a job.")
@_output(
    "-o", "--out", type=Folder("DIR"),
    help="Both plans side by side, in DIR/review.html; of two folders of many, DIR/NAME/review.html for each pair that differs.",
)  # fmt: skip
@_rules(
    "--slack", type=click.FloatRange(0.0, 100.0), default=0.1, metavar="PERCENT",
    help="Shares of an area that differ by no more are the same: samples of a changed part lie in other places.  [default: 0.1]",
)  # fmt: skip
@_rules("--despite", type=Words("LIST", requested_words, listed=True), default="",
        help="Compare although these differ: unit, faces, sampling, postures, tolerance, clearance, machine, setup, "
        "fixtures.")  # fmt: skip
@options("debug", junit={"help": "Also write JUnit XML: a test case for each face and cutter that differs."})
@takes(DiffRequest)
def command(request: DiffRequest) -> int:
    """Show which faces and cutters were lost or won from plan OLD to plan NEW.

    OLD and NEW are plan.json files, the folders of two plans, or two folders of many plans, which are paired by name.
    A face whose number shifted is known again by its place, its surface or its neighbours; one that is not known again is told.
    """
    from plan_cutters.cases.files import Case, CaseFiles
    from plan_cutters.errors import OptionError
    from plan_cutters_base.whole import refusal
    from plan_cutters_ci.wording import COMPARABLE, apart, comparison_cases, markdown, verdict

    if request.as_json and request.as_markdown:
        raise OptionError("--json and --markdown both write standard output: give one of them")
    despite = [word.strip() for word in request.despite.split(",") if word.strip()]
    for word in despite:
        if word not in requested_words():
            raise OptionError(f"--despite {word!r} is not known; give some of {','.join(requested_words())}")
    files = None if request.junit is None else CaseFiles(request.junit)
    if files is not None:
        files.check()
    if request.out and (why := refusal(request.out)):
        raise OptionError(f"cannot write there ({why}); give another folder with -o", file=request.out)
    old, new = Path(request.old), Path(request.new)
    try:
        comparison = compare_folders(old, new, slack=request.slack / 100.0, despite=despite)
    except PlanError as fault:
        if files is not None:
            files.write(_SELF, [Case(request.new, COMPARABLE, "error", "unread", str(fault))])
        raise
    if files is not None:
        files.write(_SELF, comparison_cases(comparison))
    made = _pages(old, new, comparison, Path(request.out)) if request.out else {}
    if request.as_json:
        hand_out(comparison.model_dump_json(indent=2) + "\n")
    elif request.as_markdown:
        hand_out(markdown(comparison, {name: path.as_posix() for name, path in made.items()}))
    else:
        with paper(120) as console:
            for each in comparison.plans:
                _show(each, console)
            lines = [f"Side by side: {path}" for path in made.values()]
            for line in (*apart(comparison), *lines, verdict(comparison)):
                console.print(clean(line), soft_wrap=True)
    for line in comparison.unread if request.as_json or request.as_markdown else ():
        error(f"{_SELF}: {line}")
    return NOT_COMPARABLE if not comparison.comparable else LOST if comparison.lost else 0


def plans_in(folder: Path) -> dict[str, Path]:
    """Plan files by folders below a folder of many, or the one of a file or plan folder, without a name; else a PlanError."""
    from plan_cutters.plan_file.load import PLAN

    if folder.is_file():
        return {"": folder}
    if not folder.exists():
        raise PlanError("no such file or folder", file=str(folder))
    if (folder / PLAN).is_file():
        return {"": folder / PLAN}
    plans = {path.parent.relative_to(folder).as_posix(): path for path in sorted(folder.rglob(PLAN)) if path.is_file()}
    # Beside an output, a run that goes on has a folder of its own whose name begins with a dot.
    plans = {name: path for name, path in plans.items() if not any(part.startswith(".") for part in name.split("/"))}
    if not plans:
        raise PlanError(f"holds no {PLAN}: give a plan, its folder, or a folder of many", file=str(folder))
    return plans


def compare_folders(old: Path, new: Path, *, slack: float, despite: Collection[str] = ()) -> "Comparison":
    """Compare all plans of two folders, or two plans; a plan that cannot be read makes them not comparable.

    A PlanError where a side holds no plan, or one is a single plan and the other is not.
    """
    from plan_cutters.plan_file.load import load_plan
    from plan_cutters_ci.model import Comparison
    from plan_cutters_ci.plans import compare

    mine, theirs = plans_in(old), plans_in(new)
    if ("" in mine) != ("" in theirs):
        many, one = (new, old) if "" in mine else (old, new)
        raise PlanError(f"is a folder of many plans, and {one} is one plan: give two of one kind", file=str(many))
    pairs, unread = [], []
    for name in sorted(set(mine) & set(theirs)):
        try:
            was, now = load_plan(mine[name]), load_plan(theirs[name])
        except PlanError as fault:
            if not name:
                raise
            unread.append(str(fault))
        else:
            pairs.append(compare(was, now, name=name or now.part.file or "part", slack=slack, despite=despite))
    gone, added = sorted(set(mine) - set(theirs)), sorted(set(theirs) - set(mine))
    return Comparison(
        old=str(old), new=str(new), slack=slack, plans=pairs, unread=unread, only_old=gone, only_new=added,
        comparable=bool(pairs) and not unread and all(each.comparable for each in pairs),
        lost=bool(gone) or any(each.lost for each in pairs),
        won=bool(added) or any(each.won for each in pairs),
    )  # fmt: skip


def _pages(old: Path, new: Path, comparison: "Comparison", out: Path) -> dict[str, Path]:
    """Write a page for each pair of plans that differ, and for two plans whether they differ or not; where each is, by name.

    A PlanError where a page would take the place of a plan's own or cannot be written, or a plan cannot be read any more.
    """
    from plan_cutters.plan_file.load import PLAN
    from plan_cutters_ci.review import PAGE, write_page

    made = {}
    # A plan may be compared with itself.
    sides = [(folder, plans_in(folder)) for folder in (old, new)]
    for each in comparison.plans:
        name = "" if "" in sides[0][1] else each.name
        path = out / name / PAGE
        if (path.parent / PLAN).exists():
            raise PlanError("holds a plan, whose page would be overwritten: give another folder to -o", file=str(path.parent))
        try:
            if name and each.same:
                # What an earlier comparison left says what is not so any more.
                path.unlink(missing_ok=True)
                continue
            path.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise PlanError(f"cannot be written: {error.strerror}", file=str(path)) from None
        write_page(path, each, [(str(folder / name) if name else str(folder), files[name]) for folder, files in sides])
        made[name] = path
    return made


def _show(difference: "PlanDifference", console: "Console") -> None:
    from rich.table import Table
    from rich.text import Text

    from plan_cutters_ci.wording import CUTTERS, FACES, cutter_rows, face_rows, headline, remarks

    def say(text: str, style: str = "") -> None:
        console.print(Text(clean(text), style), soft_wrap=True)

    say(headline(difference), "bold")
    for line in difference.why_not:
        say(f"  not comparable: {line}", "bold yellow")
    for line in remarks(difference):
        say(f"  {line}")
    for names, rows in ((FACES, list(face_rows(difference))), (CUTTERS, list(cutter_rows(difference)))):
        if rows:
            table = Table(*names)
            for row in rows:
                table.add_row(Text(row[0], _COLOURS.get(row[0], "")), *(Text(clean(cell)) for cell in row[1:]))
            console.print(table)
