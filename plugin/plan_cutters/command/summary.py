"""Print the results in a terminal: the story of a plan is laid out in paragraphs and tables."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich.text import Text

from plan_cutters.command.rows import cell, cutter_rows, worst_faces
from plan_cutters.command.terminal import show
from plan_cutters.plan_file.words.details import details, scene, unjudged_share
from plan_cutters.plan_file.words.story import Story, story_of

if TYPE_CHECKING:
    from plan_cutters.plan_file.model import Plan
    from plan_cutters.plan_file.words.line import Line

#: Doubts of one kind that are shown unless all are requested.
_LINES = 5
_MARKS = {True: "bold green", False: "bold red", None: "bold yellow"}


def summary(plan: "Plan", *, verbose: bool = False, tells: Callable[..., None] = show) -> None:
    """Tell what is found, but not what is not reached: that comes last."""
    story = story_of(plan)
    title, good, about, why = story.headline
    tells(
        "",
        *([_marked("Inside other bodies:", story.inside[0]), *map(cell, story.inside[1:]), ""] if story.inside else []),
        Text.assemble(cell(title, _MARKS[good]), cell(". " + " ".join(filter(None, (about, why))))),
        *map(cell, (*story.proposal, *story.scope, *story.between)),
        cell(scene(plan)),
        "",
        *cutter_rows(plan, story, verbose=verbose),
        *([f"  {unjudged}"] if (unjudged := unjudged_share(plan)) else []),
        *_apart(worst_faces(story)),
        *_apart(list(_lines(story.setups, verbose))),
        *_apart([cell(line.text) for line in story.operations]),
        *_apart([cell(line.text + line.typed) for line in story.answers]),
        *_apart([*_doubts(story, verbose), *_lines(story.notes, verbose), *(map(cell, details(plan)) if verbose else ())]),
    )


def written(plan: "Plan", out: Path | None, formats: Sequence[str]) -> list[Any]:
    """List the files of the output, and the faces that the models do not show split in their place."""
    from plan_cutters.report.folder import stale_files

    lines = []
    files = [*(["plan.json"] if "json" in formats else []), *sorted(f.name for f in plan.files.values())]
    if files:
        lines.append(f"Written to {out}: {', '.join(files)} ({plan.run.total:.0f} s in all).")
    if out is not None and "html" in plan.files:
        lines.append(f"Look at it in a browser: {out / plan.files['html'].name}")
    splits = [("", plan.split)]
    splits += [(f" in the {each.name} plan", each.split) for each in (plan.operations.plans if plan.operations else [])]
    for where, split in splits:
        for face, entry in split.items():
            if entry.rung != "contour":
                how = "it is one piece in the STEP, and the GLB shows it by its samples"
                lines.append(f"{face} could not be split in its place{where} ({entry.why}): {how}.")
    if out is not None and formats and (old := stale_files(out, plan, formats)):
        lines.append(f"Left over from an earlier run, or not ours: {', '.join(old)} in {out}")
    return lines


def _apart(lines: Sequence[Any]) -> list[Any]:
    """A paragraph, set apart, if there is any."""
    return ["", *lines] if lines else []


def _lines(lines: "Iterable[Line]", verbose: bool) -> Iterator[Text]:
    """Those of some lines that are requested."""
    for line in lines:
        if verbose or not line.minor:
            yield Text.assemble(cell(f"{line.mark} " if line.mark else ""), cell(line.text + line.typed))


def _doubts(story: Story, verbose: bool) -> Iterator[Text]:
    """Give the causes that make verdicts unsure, the first ones of each kind."""
    for what, lines in story.doubts.items():
        most = len(lines) if verbose else _LINES
        yield from (_marked(line.mark, line.text) for line in lines[:most])
        if len(lines) > most:
            yield Text(f"  and {len(lines) - most} more {what}: -v or plan.json.")


def _marked(word: str, rest: str) -> Text:
    return Text.assemble((f"{word} ", "bold yellow"), cell(rest))
