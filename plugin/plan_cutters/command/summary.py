"""What is found, for people: which cutter to take, how far each gets, where the one shown fails, what is not sure."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich.text import Text

from plan_cutters.command.answered import answered
from plan_cutters.command.headline import between, headline
from plan_cutters.command.rows import cell, cutter_rows, shown, take, worst_faces
from plan_cutters.command.terminal import say
from plan_cutters.document.judged import not_judged, not_seen
from plan_cutters.document.names import named, short_names
from plan_cutters.document.next_steps import together
from plan_cutters.document.told import inside, percent, reasons
from plan_cutters.document.told import lost as lost_percent

if TYPE_CHECKING:
    from plan_cutters.document.model import CutterEntry, Plan

#: Lines of one kind that are said unless all are asked for: warnings, obstacles that are missing, cutters that do not reach.
_LINES, _OTHERS = 5, 3
#: Tools that are named for each reason why they are not used, and places of a tool.
_PLACES = 3


def summary(plan: "Plan", *, verbose: bool = False) -> None:
    """Say what is found, but not what is not reached: that comes last."""
    names = short_names(plan)
    targets, ignored = len(plan.effective.target_faces), sum(f.ignored for f in plan.faces)
    many = "1 face" if plan.part.faces == 1 else f"{plan.part.faces} faces"
    faces = f"The part has {many}: {targets} to machine{f', {ignored} ignored' if ignored else ''}"
    say(
        "",
        *_first_of_all(plan),
        *headline(plan, names),
        *map(cell, (*not_judged(plan), *not_seen(plan, names))),
        *_together(plan),
        *between(plan),
        cell(f"{faces}, with {plan.samples.count} samples, at most {plan.samples.max_gap_mm:.3g} mm apart. {_machine(plan)}"),
        "",
        *cutter_rows(plan, names, verbose=verbose),
        *_unjudged_share(plan),
        *_apart(worst_faces(plan, names[shown(plan).id])),
        *_apart([cell(named(plan, line)) for line in (*setups(plan, verbose=verbose), *_travel(plan, verbose=verbose))]),
        *_apart([cell(line) for line in answered(plan)]),
        *_apart([*_unsure(plan, verbose=verbose), *(_details(plan) if verbose else ())]),
    )  # fmt: skip


def _first_of_all(plan: "Plan") -> list[Any]:
    """What is no surface of the finished part: before anybody relies on the rest."""
    lines = [cell(named(plan, line)) for line in inside(plan)]
    return [_marked("Inside other bodies:", lines[0].plain), *lines[1:], ""] if lines else []


def _together(plan: "Plan") -> list[Text]:
    """Where no cutter finishes: which of those given do most together, which costs nothing to know."""
    if plan.selected or plan.selected_over_setups or not (said := together(plan)):
        return []
    return [cell(f"{named(plan, said)}.")]


def written(plan: "Plan", out: Path | None, formats: Sequence[str]) -> list[Any]:
    """What is in the output, and which faces the models show otherwise than split in their place."""
    from plan_cutters.report.folder import left_over

    lines = []
    files = [*(["plan.json"] if "json" in formats else []), *sorted(f.name for f in plan.files.values())]
    if files:
        lines.append(f"Written to {out}: {', '.join(files)} ({plan.run.total:.0f} s in all).")
    if out is not None and "html" in plan.files:
        lines.append(f"Look at it in a browser: {out / plan.files['html'].name}")
    for face, entry in plan.split.items():
        if entry.rung != "contour":
            how = "it is one piece in the STEP, and the GLB shows it by its samples"
            lines.append(f"{face} could not be split in its place ({entry.why}): {how}.")
    if out is not None and formats and (old := left_over(out, plan, formats)):
        lines.append(f"Left over from an earlier run, or not ours: {', '.join(old)} in {out}")
    return lines


def not_reached(plan: "Plan", *, verbose: bool = False) -> list[str]:
    """What the larger cutters than the one to take (or all) leave, and why: of many those that come nearest."""
    larger: list[CutterEntry] = []
    for c in plan.cutters:
        if c.id == plan.selected:
            break
        if c.lost:
            larger.append(c)
    near = larger
    if not verbose and len(larger) > _OTHERS:
        near = sorted(larger, key=lambda c: (c.id != take(plan), c.lost))[:_OTHERS]
    lines = [named(plan, _lost(plan, c)) for c in larger if c in near]
    if rest := [c for c in larger if c not in near]:
        ends = [min(rest, key=_lost_share), max(rest, key=_lost_share)]
        least, most = (lost_percent(c, c.area_share) for c in ends)
        which = "larger cutter" if plan.selected else "cutter"
        lines.insert(0, f"{len(rest)} more {which}{'s leave' if len(rest) > 1 else ' leaves'} "
                        f"{least if least == most else f'{least} to {most}'} of the area: -v or plan.json say why.")  # fmt: skip
    return lines


def _lost_share(c: "CutterEntry") -> float:
    return c.area_share.inaccessible + c.area_share.undecided


def _lost(plan: "Plan", c: "CutterEntry") -> str:
    """What a cutter leaves: how much, why, on which faces, and the worst place."""
    left = c.lost
    why = ", ".join(reasons(c))
    if c.undecided:
        why += f"; of it {percent(c.area_share.undecided, some=True, whole=False)} is undecided"
    worst = sorted(((v.lost, name) for name, v in c.faces.items()), key=lambda x: -x[0])
    on = ", ".join(name for count, name in worst[:_PLACES] if count)
    more = sum(count > 0 for count, _ in worst) - _PLACES
    on += f" and {more} more" if more > 0 else ""
    deepest = max(
        (w for w in c.witnesses if w.depth_mm is not None and not w.inside_bodies),
        key=lambda w: w.depth_mm or 0,
        default=None,
    )
    where = ""
    if deepest and deepest.depth_mm is not None:
        place = ", ".join(f"{x:.4g}" for x in deepest.point)
        sure = "may be" if deepest.verdict == "undecided" else "is"
        where = f"; the worst is on {deepest.face} at ({place}), where the best posture {sure} {deepest.depth_mm:.3g} mm too deep"
    return (f"{c.id} does not reach {lost_percent(c, c.area_share)} of the area ({left} of {plan.samples.finished} samples): "
            f"{why or 'no reason'}. They lie on {on}{where}.")  # fmt: skip


def setups(plan: "Plan", *, verbose: bool = True) -> list[str]:
    """What no cutter can reach in this setup, which cutter does the rest, and how much is within the limit in other setups."""
    lines = []
    count = 1 + len(plan.effective.other_setups)
    if count > 1:
        best = shown(plan)
        each = "; ".join(f"{s.interference_free + s.accessible:,} with {_axis(s.axis)}" for s in best.setups)
        what = f"leaves {best.lost_in_all:,}" if best.lost_in_all else "reaches all"
        lines.append(
            f"Over the {count} setups {best.id} {what} of {plan.samples.finished:,} samples. It reaches {each}."
        )
    lost = max((c.beyond_setup for c in plan.cutters), default=0)
    if not lost:
        return lines
    here = "this setup" if count == 1 else "these setups"
    lines += [f"Beyond {here}: the axis limit loses {lost} of {plan.samples.finished} samples for every cutter."]
    if plan.selected_for_setup and verbose:
        lines.append(f"For {here}: {plan.selected_for_setup}, which leaves nothing else.")
    within = [(s, percent(s.share, some=bool(s.within), whole=s.within == plan.samples.judged)) for s in plan.setups]
    now = [f"{_axis(s.axis)} {share}" for s, share in within if s.reached is not None]
    others = ", ".join(f"{_axis(s.axis)} {share}" for s, share in within if s.reached is None)
    lines.append(
        f"Area within the limit by setup axis: {within[0][1] if count == 1 else ', '.join(now)} now; {others}."
    )
    return lines


def _machine(plan: "Plan") -> str:
    """What limits the tool axis, and how the part stands."""
    along = f"spindle points along {_axis(plan.effective.setup)} of the part"
    if plan.effective.other_setups:
        along += f", in other setups along {'; '.join(map(_axis, plan.effective.other_setups))}"
    if plan.machine.name == "unlimited":
        return f"No machine limits the tool axis; the {along}."
    return f"The machine is {plan.machine.name}; its {along}."


def _travel(plan: "Plan", *, verbose: bool) -> Sequence[str]:
    """Whether the machine's linear axes reach what the cutter shown reaches."""
    from plan_cutters.document.travel import travel_lines

    best = shown(plan)
    lines = travel_lines(best.travel, best.id)
    return lines if verbose else [line for line in lines if not line.startswith("Within")]


def _axis(axis: Sequence[float]) -> str:
    return ",".join(f"{x:.4g}" for x in axis)


def _apart(lines: Sequence[Any]) -> list[Any]:
    """A paragraph, set apart, if there is any."""
    return ["", *lines] if lines else []


def _unjudged_share(plan: "Plan") -> list[str]:
    share, count = plan.cutters[0].area_share.unjudged, plan.samples.unjudged
    if not share and not count:
        return []
    return [f"  Besides, {percent(share, some=True, whole=False)} of the area could not be judged, for any cutter."]


def _unsure(plan: "Plan", *, verbose: bool) -> list[Text]:
    """Warnings, obstacles that are missing, what was not judged, and what else makes a verdict unsure."""
    most = 10**9 if verbose else _LINES
    lines = _first([Text.assemble(("Warning: ", "bold yellow"), cell(w)) for w in plan.part.warnings], "warnings", most)
    lines += _first([_marked("Not judged:", f"{f.id} ({f.unjudged}).") for f in plan.faces if f.target and f.unjudged],
                    "faces that are not judged", most)  # fmt: skip
    lines += _first(list(_missing(plan)), "missing obstacles", most)
    if verbose or not plan.part.orientation.confident:
        lines.append(cell(_side(plan)))
    for library in plan.libraries:
        lines += [cell(line) for line in libraries_of(library, verbose=verbose)]
    areas = {c.id for c in plan.cutters if c.area}
    # Said in other words above.
    told = ("Verdicts are about samples;", *(f"{name} {word}" for name in areas for word in ("reaches", "serves")))
    lines += [cell(named(plan, f"Note: {note}")) for note in plan.notes if verbose or not note.startswith(told)]
    return lines


def _first(lines: list[Text], what: str, most: int) -> list[Text]:
    more = len(lines) - most
    return [*lines[:most], *([Text(f"  and {more} more {what}: -v or plan.json.")] if more > 0 else [])]


def _marked(word: str, rest: str) -> Text:
    return Text.assemble((f"{word} ", "bold yellow"), cell(rest))


def _missing(plan: "Plan") -> Iterator[Text]:
    """Which obstacles are missing, so that no cutter is feasible beyond doubt."""
    where = {"none": "nothing stands for it", "box": "the box around it stands for it",
             "triangles": "its own triangles stand for it", "edges": "its edges stand for it"}  # fmt: skip
    for m in plan.missing:
        which = m.face or m.entity or m.name or "a face of the file"
        yield _marked("Missing obstacle:", f"{which} ({m.why}; {where[m.stand_in]}).")


def _side(plan: "Plan") -> str:
    """How the side of the material was found, how sure that is, and what is open."""
    found, sewing = plan.part.orientation, plan.part.sewing
    sure = " (sure)" if found.confident else "" if "guess" in found.method else " (a guess)"
    line = f"Side of the material: {found.method}{sure}."
    if sewing and sewing.tolerance_mm is not None:
        line += f" Faces were joined at {sewing.tolerance_mm:.3g} mm."
    if sewing and sewing.open_edges:
        line += f" Open edges: {sewing.open_edges}, {sewing.open_length_mm:.4g} mm long."
    return line


def _details(plan: "Plan") -> Iterator[Text]:
    """What only those want who ask for all."""
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


def libraries_of(library: Any, *, verbose: bool) -> list[str]:
    """What was read of a tool library, and what of it is not used, reason by reason."""
    cutters, tools = (
        f"{n} {word}{'' if n == 1 else 's'}" for n, word in ((library.cutters, "cutter"), (library.tools, "tool"))
    )
    unused = len(library.unused)
    more = f"; {unused} {'is' if unused == 1 else 'are'} not used (-v says why)" if unused and not verbose else ""
    lines = [f"{library.file} ({library.format}) gives {cutters} of {tools}{more}."]
    if not verbose:
        return lines
    lines += [f"  {note}" for note in library.notes]
    reasons: dict[str, list[str]] = {}
    for tool in library.unused:
        reasons.setdefault(tool.why, []).append(f'{tool.place} "{tool.name}"' if tool.name else tool.place)
    for why, places in reasons.items():
        left = f" and {len(places) - _PLACES} more" if len(places) > _PLACES else ""
        lines.append(f"  Not used: {', '.join(places[:_PLACES])}{left}: {why}.")
    return lines
