"""Print the results in a terminal: the story of a plan is laid out in paragraphs and tables."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich.text import Text

from plan_cutters.command.rows import cell, cutter_rows, worst_faces
from plan_cutters.command.terminal import show
from plan_cutters.domain.lengths import reporting
from plan_cutters.plan_file.words.details import details, scene, unjudged_share
from plan_cutters.plan_file.words.story import Story, story_of
from plan_cutters.plan_file.words.text import text_of

if TYPE_CHECKING:
    from plan_cutters.plan_file.model import Plan
    from plan_cutters.plan_file.words.line import Line

_MARKS = {True: "bold green", False: "bold red", None: "bold yellow"}


@reporting(lambda plan: plan.effective.units)
def summary(plan: "Plan", *, verbose: bool = False, tells: Callable[..., None] = show) -> None:
    """Tell the process; with `verbose` all that is found, but not what is not reached: that comes last."""
    story = story_of(plan)
    title, good, about, why = story.headline
    text = text_of(plan)
    tells(Text.assemble(cell(title, _MARKS[good]), cell(".")), *map(cell, text.lines))
    if not verbose:
        return
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
        *_apart([*_doubts(story), *_lines(story.notes), *map(cell, details(plan))]),
    )


def written(plan: "Plan", out: Path | None, formats: Sequence[str], *, verbose: bool = False) -> list[Any]:
    """Say where the review page is, or the plan; with `verbose` list all files, and faces that are not split in their place."""
    from plan_cutters.report.folder import stale_files

    lines: list[Any] = []
    files = [*(["plan.json"] if "json" in formats else []), *sorted(f.name for f in plan.files.values())]
    if files and verbose:
        lines.append(f"Written to {out}: {', '.join(files)} ({plan.run.total:.0f} s in all).")
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
    splits = [("", plan.split)]
    splits += [(f" in the {each.name} plan", each.split) for each in (plan.operations.plans if plan.operations else [])]
    for where, split in splits:
        for face, entry in split.items():
            if entry.rung != "contour":
                how = "it is one piece in the STEP, and the GLB shows it by its samples"
                yield f"{face} could not be split in its place{where} ({entry.why}): {how}."


def _apart(lines: Sequence[Any]) -> list[Any]:
    """A paragraph, set apart, if there is any."""
    return ["", *lines] if lines else []


def _lines(lines: "Iterable[Line]") -> Iterator[Text]:
    for line in lines:
        yield Text.assemble(cell(f"{line.mark} " if line.mark else ""), cell(line.text + line.typed))


def _doubts(story: Story) -> Iterator[Text]:
    """Give the causes that make verdicts unsure."""
    for lines in story.doubts.values():
        yield from (_marked(line.mark, line.text) for line in lines)


def _marked(word: str, rest: str) -> Text:
    return Text.assemble((f"{word} ", "bold yellow"), cell(rest))
