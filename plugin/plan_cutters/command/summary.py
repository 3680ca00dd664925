"""Print the results in a terminal: the story of a plan is laid out in paragraphs and tables."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich.text import Text

from plan_cutters.command.rows import cell, cutter_rows, worst_faces
from plan_cutters.command.terminal import show
from plan_cutters.plan_file.nearest import leaves
from plan_cutters.plan_file.numbers import capital, count, percent
from plan_cutters.plan_file.shares import unreached
from plan_cutters.plan_file.words.cutters import left
from plan_cutters.plan_file.words.headline import area
from plan_cutters.plan_file.words.names import named
from plan_cutters.plan_file.words.notes import machine
from plan_cutters.plan_file.words.story import Story, story_of

if TYPE_CHECKING:
    from plan_cutters.plan_file.model import CutterEntry, Plan
    from plan_cutters.plan_file.words.line import Line

#: Lines of one kind that are said unless all are asked for: doubts, cutters that do not reach.
_LINES, _OTHERS = 5, 3
_MARKS = {True: "bold green", False: "bold red", None: "bold yellow"}


def summary(plan: "Plan", *, verbose: bool = False, tells: Callable[..., None] = show) -> None:
    """Tell what is found, but not what is not reached: that comes last."""
    story = story_of(plan)
    title, good, about, why = story.headline
    targets, ignored = len(plan.effective.target_faces), sum(f.ignored for f in plan.faces)
    tells(
        "",
        *([_marked("Inside other bodies:", story.inside[0]), *map(cell, story.inside[1:]), ""] if story.inside else []),
        Text.assemble(cell(title, _MARKS[good]), cell(f"{about}. {why}")),
        *map(cell, (*story.proposal, *story.scope, *story.between)),
        cell(f"The part has {count(plan.part.faces, 'face')}: {targets} to machine{f', {ignored} ignored' if ignored else ''}, "
             f"with {plan.samples.count} samples, at most {plan.samples.max_gap_mm:.3g} mm apart. {machine(plan)}"),
        "",
        *cutter_rows(plan, story, verbose=verbose),
        *_unjudged_share(plan),
        *_apart(worst_faces(story)),
        *_apart(list(_lines(story.setups, verbose))),
        *_apart([cell(line.text) for line in story.operations]),
        *_apart([cell(line.text + line.typed) for line in story.answers]),
        *_apart([*_doubts(story, verbose), *_lines(story.notes, verbose), *(_details(plan) if verbose else ())]),
    )  # fmt: skip


def written(plan: "Plan", out: Path | None, formats: Sequence[str]) -> list[Any]:
    """List the files of the output, and the faces that the models do not show split in their place."""
    from plan_cutters.report.folder import left_over

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
    if out is not None and formats and (old := left_over(out, plan, formats)):
        lines.append(f"Left over from an earlier run, or not ours: {', '.join(old)} in {out}")
    return lines


def not_reached(plan: "Plan", *, verbose: bool = False) -> list[str]:
    """Say how much the cutters before the one to take (or all) do not reach, and why; of many, only the nearest ones."""
    larger: list[CutterEntry] = []
    for c in plan.cutters:
        if c.id == plan.selected:
            break
        if c.not_reached:
            larger.append(c)
    near = larger
    if not verbose and len(larger) > _OTHERS:
        taken = plan.selected_over_setups or plan.selected_for_setup
        near = sorted(larger, key=lambda c: (c.id != taken, leaves(c)))[:_OTHERS]
    lines = [capital(named(plan, left(plan, c))) for c in larger if c in near]
    if rest := [c for c in larger if c not in near]:
        ends = [of(rest, key=leaves) for of in (min, max)]
        least, most = (unreached(c, c.area_share) for c in ends)
        which = "larger cutter" if plan.selected else "cutter"
        much = least if least == most else f"{least} to {most}"
        leave = f"{len(rest)} more {which}{'s leave' if len(rest) > 1 else ' leaves'}"
        lines.insert(0, f"{leave} {much} of {area(plan)}: -v or plan.json say why.")
    return lines


def _apart(lines: Sequence[Any]) -> list[Any]:
    """A paragraph, set apart, if there is any."""
    return ["", *lines] if lines else []


def _unjudged_share(plan: "Plan") -> list[str]:
    share = plan.cutters[0].area_share.unjudged
    if not share and not plan.samples.unjudged:
        return []
    return [f"  Besides, {percent(share, some=True, whole=False)} of the area could not be judged, for any cutter."]


def _lines(lines: "Iterable[Line]", verbose: bool) -> Iterator[Text]:
    """Those of some lines that are asked for."""
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


def _details(plan: "Plan") -> Iterator[Text]:
    """Give the details that are only shown to users who ask for all of them."""
    size = " x ".join(f"{s:.4g}" for s in plan.part.size_mm)
    e = plan.effective
    yield cell(f"Part: {size} mm, {plan.part.solids} solids, SHA-256 {plan.part.sha256}.")
    yield cell(named(plan, f"Choice: {plan.selection.why}; by {plan.selection.rule}."))
    yield cell(f"Samples: {plan.samples.convex} convex, {plan.samples.concave} concave, {plan.samples.saddle} saddle, "
               f"{plan.samples.unjudged} not judged, in {plan.samples.regions} regions.")  # fmt: skip
    yield cell(f"Searched: tilts {e.tilt_deg[0]:g} to {e.tilt_deg[1]:g} deg, rotations {e.rotation_deg[0]:g} to "
               f"{e.rotation_deg[1]:g} deg every {e.rotation_step_deg:g} deg; tolerance {e.tolerance_mm:.4g} mm, of which "
               f"{e.chord_error_mm:.3g} mm for {e.obstacle_triangles} obstacle triangles.")  # fmt: skip
    for c in plan.cutters:
        if c.area:
            yield cell(
                f"Between samples of {c.id}: {c.area.contacts} contacts were looked at, {c.area.left} cells are not proved."
            )
    yield cell(f"Versions: {', '.join(f'{name} {number}' for name, number in plan.versions.items())}.")
    slow = sorted(plan.run.seconds.items(), key=lambda item: -item[1])[:6]
    yield cell(f"Seconds: {', '.join(f'{name} {seconds:.1f}' for name, seconds in slow)}.")
