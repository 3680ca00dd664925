"""Print the results in a terminal: the story of a plan is laid out in paragraphs and tables."""

import textwrap
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich.measure import Measurement
from rich.table import Table
from rich.text import Text

from plan_cutters.command.terminal import show, wrapped
from plan_cutters.domain.figures import reporting, unit
from plan_cutters.plan_file.model import leaves
from plan_cutters.plan_file.words.cutters import FEASIBLE, scene, unjudged_share, worst_face_text
from plan_cutters.plan_file.words.names import typed
from plan_cutters.plan_file.words.text import Story, process_lines, story_of
from plan_cutters_base.terminal_text import clean

if TYPE_CHECKING:
    from rich.console import Console, ConsoleOptions

    from plan_cutters.plan_file.model import Plan
    from plan_cutters.plan_file.words.cutters import CutterStory
    from plan_cutters.plan_file.words.names import Line


#: Verdicts, what a column calls them.
WORDS = {"interference_free": "free", "accessible": "accessible", "undecided": "undecided", "inaccessible": "inaccessible"}
#: Rows that are shown unless all are requested.
MOST_ROWS = 40
#: Widest line of a cutter's name beside its numbers, so that 80 columns hold all; what is longer has a second line.
_NAME = 27
#: Longest that a cutter is called here, and an obstacle.
_CUTTER, _OBSTACLE = 2 * _NAME - 4, 22
#: Files of more bytes have their size told.
_LARGE = 100_000
_COLOURS = {True: "green", False: "red", None: "yellow"}


def cell(text: str, style: str = "") -> Text:
    """A text from a file, for a table or a paragraph."""
    return Text(clean(typed(text)), style)


def cutter_rows(plan: "Plan", story: "Story", *, verbose: bool) -> list[Any]:
    """A row for each cutter, of many the best alone, and how many more there are."""
    rows = list(story.cutters)
    if not verbose and len(rows) > MOST_ROWS:
        missing_shares = {c.id: leaves(c) for c in plan.cutters}
        rows = sorted(rows, key=lambda c: (c.id != story.taken, missing_shares[c.id]))[:MOST_ROWS]
        rows = [c for c in story.cutters if c in rows]
    here = f", over {1 + len(plan.effective.other_setups)} setups" if plan.effective.other_setups else ""
    lines: list[Any] = [f"Share of the area to machine, by the verdict of its samples{here}:"]
    short = _distinct([clean(c.name) for c in rows], _CUTTER)
    table = _table(("  cutter", "feasible"), tuple(WORDS.values()), apart=1)
    for c, name in zip(rows, short, strict=True):
        taken = c.id == story.taken
        # In lines that its column has room for, all but the first indented.
        lines_of_name = "\n".join(textwrap.wrap(name, _NAME, subsequent_indent="    ", break_on_hyphens=False)) or name
        table.add_row(
            Text(f"{'>' if taken else ' '} {lines_of_name}", "bold" if taken else ""),
            Text(FEASIBLE[c.feasible], _COLOURS[c.feasible]),
            *(c.shares[word] for word in WORDS),
        )
    lines.append(_Fitting(table, [_listed(c, c.id == story.taken) for c in rows]))
    if len(rows) < len(plan.cutters):
        lines.append(f"  and {len(plan.cutters) - len(rows)} more cutters that reach less: -v or plan.json.")
    return lines


def _listed(c: "CutterStory", taken: bool) -> Text:
    text = ", ".join(f"{word} {c.shares[key]}" for key, word in WORDS.items() if c.shares[key] != "0 %")
    return Text.assemble(
        cell(f"{'>' if taken else ' '} {c.name}: ", "bold" if taken else ""),
        (FEASIBLE[c.feasible], _COLOURS[c.feasible]),
        f"; {text}",
    )


def worst_faces(story: "Story") -> list[Any]:
    """Where the cutter shown fails: the faces on which it leaves the most area."""
    c = story.cutter(story.shown)
    if not c.faces:
        return []
    few = c.failing > len(c.faces)
    which = f"the {len(c.faces)} worst of {c.failing} faces" if few else f"{c.failing} face{'s' if c.failing > 1 else ''}"
    lines: list[Any] = [cell(f"Where {c.name} {'fails' if c.feasible is False else 'is not sure'}, {which}:")]
    table = _table(("  face", "mainly", "in the way"), (f"{unit()}2 not reached", "of the face", f"{unit()} too deep"))
    for f in c.faces:
        table.add_row(f"  {f.id}", f.reason, cell(_distinct([f.obstacle or "-"], _OBSTACLE)[0]), f.area, f.share, f.depth or "-")
    return [*lines, _Fitting(table, [cell(f"  {worst_face_text(f)}") for f in c.faces])]


@dataclass(frozen=True)
class _Fitting:
    """A table is shown where there is room for all of it, and lines elsewhere."""

    table: Table
    lines: Sequence[Text]

    def __rich_console__(self, page: "Console", options: "ConsoleOptions") -> "Iterator[Table | Text]":
        if Measurement.get(page, options.update_width(1000), self.table).maximum <= page.width:
            yield self.table
        else:
            for line in self.lines:
                yield from wrapped(line, page)


def _table(words: Sequence[str], numbers: Sequence[str], *, apart: int = 2) -> Table:
    """An empty table without lines: columns of words, then of numbers, `apart` blanks from each other."""
    table = Table(box=None, pad_edge=False, padding=(0, apart, 0, 0), header_style="bold")
    for name in (*words, *numbers):
        table.add_column(name, justify="right" if name in numbers else "left", no_wrap=True)
    return table


def _distinct(names: Sequence[str], most: int) -> list[str]:
    """Names no longer than `most`, each still another one's: the middle is left out, or a number tells them apart.

    Examples
    --------
    >>> _distinct(["R6L80", "a long ball nose R3", "a long ball nose R4"], 13)
    ['R6L80', 'a lon...se R3', 'a lon...se R4']
    """
    short = [name if len(name) <= most else f"{name[: (most - 2) // 2]}...{name[-(most - 3) // 2 :]}" for name in names]
    return [
        text if short.count(text) == 1 or names[i] == text else f"{text[: most - len(str(i)) - 2]}#{i + 1}"
        for i, text in enumerate(short)
    ]


_MARKS = {True: "bold green", False: "bold red", None: "bold yellow"}


@reporting(lambda plan: plan.effective.units)
def summary(plan: "Plan", *, verbose: bool = False, tells: Callable[..., None] = show) -> None:
    """Tell the process; with `verbose` all that is found, but not what is not reached: that comes last."""
    story = story_of(plan)
    title, good, about, why = story.headline
    tells(Text.assemble(cell(title, _MARKS[good]), cell(".")), *map(cell, process_lines(plan, story, typed)))
    if not verbose:
        return
    doubts = [_marked(line.mark, line.text) for lines in story.doubts.values() for line in lines]
    tells(
        "",
        *([_marked("Inside other bodies:", story.inside[0]), *map(cell, story.inside[1:]), ""] if story.inside else []),
        *map(cell, filter(None, (about, why, *story.proposal, *story.scope, *story.between))),
        cell(scene(plan)),
        "",
        *cutter_rows(plan, story, verbose=verbose),
        *([f"  {unjudged}"] if (unjudged := unjudged_share(plan)) else []),
        *_apart(worst_faces(story)),
        *_apart(list(_lines(story.setups))),
        *_apart([cell(line.text) for line in story.operations]),
        *_apart([cell(line.text + line.typed) for line in story.answers]),
        *_apart([*doubts, *_lines(story.notes)]),
    )


def written(plan: "Plan", out: Path | None, formats: Sequence[str], *, verbose: bool = False) -> list[Any]:
    """Say where the review page is, or the plan; with `verbose` list all files, and faces that are not split in their place."""
    from plan_cutters.report.folder import stale_files

    lines: list[Any] = []
    files = [*(["plan.json"] if "json" in formats else []), *sorted(f.name for f in plan.files.values())]
    if files and verbose:
        sizes = {f.name: f" ({f.size_bytes / 1e6:.1f} MB)" for f in plan.files.values() if f.size_bytes >= _LARGE}
        each = ", ".join(f"{name}{sizes.get(name, '')}" for name in files)
        lines.append(f"Written to {out}: {each} ({plan.run.total:.0f} s in all).")
    if verbose:
        lines += _not_split(plan)
    if out is not None and formats and (old := stale_files(out, plan, formats)):
        lines.append(f"Left over from an earlier run, or not ours: {', '.join(old)} in {out}")
    if out is not None and "html" in plan.files:
        lines.append(f"Review page: {out / plan.files['html'].name}")
    elif files and not verbose:
        lines.append(f"Written to {out}: {', '.join(files)}.")
    return lines


def _not_split(plan: "Plan") -> Iterator[str]:
    plans = plan.operations.plans if plan.operations else []
    for where, split in [("", plan.split), *((f" in the {each.name} plan", each.split) for each in plans)]:
        for face, entry in split.items():
            if entry.rung != "contour":
                how = "it is one piece in the models"
                yield f"{face} could not be split in its place{where} ({entry.why}): {how}."


def _apart(lines: Sequence[Any]) -> list[Any]:
    return ["", *lines] if lines else []


def _lines(lines: "Iterable[Line]") -> Iterator[Text]:
    for line in lines:
        yield Text.assemble(cell(f"{line.mark} " if line.mark else ""), cell(line.text + line.typed))


def _marked(word: str, rest: str) -> Text:
    return Text.assemble((f"{word} ", "bold yellow"), cell(rest))
