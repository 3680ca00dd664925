"""What is found, in a few lines for people."""

import math
import re
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from plan_cutters.document.model import CutterEntry, Plan


def written(plan: "Plan", out: Path, formats: Sequence[str]) -> list[str]:
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


def summary(plan: "Plan") -> None:
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
    console.print(f"Machine {plan.machine.name}, setup {_axis(plan.effective.setup)}.")
    for line in libraries(plan):
        console.print(line)
    table, names = Table(box=None, pad_edge=False), short_names(plan)
    held = any(c.least_stick_out for c in plan.cutters)
    for column in (
        "cutter",
        "feasible",
        "free",
        "accessible",
        "undecided",
        "inaccessible",
        *(["stick-out"] if held else []),
    ):
        table.add_column(column, justify="left" if column in ("cutter", "feasible") else "right", overflow="fold")
    for c in plan.cutters:
        word = {True: "yes", False: "no", None: "undecided"}[c.feasible]
        table.add_row(names[c.id] + (" *" if c.id == plan.selected else ""), word, str(c.interference_free),
                      str(c.accessible), str(c.undecided), str(c.inaccessible), *([_held(c)] if held else []))  # fmt: skip
    console.print(table)
    console.print(named(plan, f"Selected: {plan.selected or 'none'} ({plan.selection.why})."))
    for line in setups(plan):
        console.print(named(plan, line))
    for line in _travel(plan):
        console.print(named(plan, line))
    console.print(_side(plan))
    for area in (c.area for c in plan.cutters if c.area):
        console.print(f"Between samples: {_percent(area.share)} of the target area is served with the axes found "
                      f"({area.contacts} contacts looked at).")  # fmt: skip
    for line in answered(plan):
        console.print(named(plan, line))
    for warning in plan.part.warnings:
        console.print(f"Warning: {warning}")
    for note in plan.notes:
        console.print(named(plan, f"Note: {note}"))
    for face in plan.faces:
        if face.target and face.unjudged:
            console.print(f"Not judged: {face.id} ({face.unjudged}).")
    for line in _missing(plan):
        console.print(line)


def setups(plan: "Plan") -> list[str]:
    """What no cutter can reach in this setup, which cutter does the rest, and how much is within the limit in other setups."""
    lines = []
    count = 1 + len(plan.effective.other_setups)
    if count > 1 and plan.selected_over_setups is None:
        best = min(plan.cutters, key=lambda c: c.lost_in_all or 0)
        lines.append(
            f"Over the {count} setups no cutter reaches every sample: {best.id} loses {best.lost_in_all} in all of them."
        )
    elif count > 1:
        best = next(c for c in plan.cutters if c.id == plan.selected_over_setups)
        each = "; ".join(f"{_axis(s.axis)}: {s.interference_free + s.accessible}" for s in best.setups)
        lines.append(f"Over the {count} setups {best.id} reaches every sample ({each}).")
    lost = max((c.beyond_setup for c in plan.cutters), default=0)
    if not lost:
        return lines
    lines += [f"Beyond this setup: the axis limit loses {lost} of {plan.samples.count} samples for every cutter."]
    if plan.selected_for_setup:
        lines.append(f"For this setup: {plan.selected_for_setup}, which leaves nothing else.")
    others = ", ".join(f"{_axis(each.axis)} {_percent(each.share)}" for each in plan.setups[1:])
    lines.append(f"Area within the limit by setup axis: {_percent(plan.setups[0].share)} now; {others}.")
    return lines


def _travel(plan: "Plan") -> Sequence[str]:
    """Whether the machine's linear axes reach what the cutter shown reaches."""
    from plan_cutters.document.travel import travel_lines

    best = max(plan.cutters, key=lambda c: (c.id == plan.selected, c.interference_free + c.accessible))
    return travel_lines(best.travel, best.id)


def _axis(axis: Sequence[float]) -> str:
    return ",".join(f"{x:.4g}" for x in axis)


def short_names(plan: "Plan") -> dict[str, str]:
    """How cutters are called in a line, by their ids: as a library does, or without the holder, where that tells them apart."""
    listed, heads = {}, {}
    for c in plan.cutters:
        numbers = dict.fromkeys(f"T{s.number}" for s in c.sources if s.number is not None)
        listed[c.id] = " ".join([*list(numbers)[:_PLACES], c.name]) if c.sources and c.name else c.id
        heads[c.id] = c.id.partition("H")[0]
    said, dimensions = Counter(listed.values()), Counter(heads.values())
    return {
        name: listed[name] if said[listed[name]] == 1 and listed[name] != name
        else heads[name] if dimensions[heads[name]] == 1 else name
        for name in heads
    }  # fmt: skip


def named(plan: "Plan", text: str) -> str:
    """A text with cutters called as in `short_names`."""
    names = short_names(plan)
    # The longest first: an id may begin as another one does.
    ids = "|".join(re.escape(name) for name in sorted(names, key=len, reverse=True))
    return re.sub(ids, lambda found: names[found[0]], text)


def libraries(plan: "Plan") -> list[str]:
    """What was read of tool libraries, and what of it is not used, reason by reason."""
    lines = []
    for library in plan.libraries:
        cutters, tools = (
            f"{n} {word}{'' if n == 1 else 's'}" for n, word in ((library.cutters, "cutter"), (library.tools, "tool"))
        )
        lines.append(f"{library.file} ({library.format}): {cutters} of {tools}.")
        lines += [f"  {note}" for note in library.notes]
        reasons: dict[str, list[str]] = {}
        for tool in library.unused:
            reasons.setdefault(tool.why, []).append(f'{tool.place} "{tool.name}"' if tool.name else tool.place)
        for why, places in reasons.items():
            more = f" and {len(places) - _PLACES} more" if len(places) > _PLACES else ""
            lines.append(f"  Not used: {', '.join(places[:_PLACES])}{more}: {why}.")
    return lines


#: Tools that are named for each reason why they are not used.
_PLACES = 3


def answered(plan: "Plan") -> list[str]:
    """What was asked for after the plan."""
    lines = []
    for c in plan.cutters:
        found = c.least_stick_out
        if found is not None and found.point is not None:
            lines.append(f"{c.id} must stand out {_up(found.least_mm)} mm at {_place(found.point)} on {found.face}: "
                         f"a shorter one's holder is stopped by {found.obstacle_face or 'the part'}.")  # fmt: skip
    for each in plan.largest_radius:
        if not each.percentiles_mm or each.bottleneck_mm is None or each.bottleneck_point is None:
            continue
        most = f"{_radius(each.most_mm)}, the largest tried"
        narrowest = f"{_place(each.bottleneck_point)} on {each.bottleneck_face}"
        whole = f"{_radius(each.bottleneck_mm)} reaches every sample" if each.bottleneck_mm else (
            f"not even R{each.least_mm:.3g} reaches {each.below} samples"
        )  # fmt: skip
        middle = each.percentiles_mm["50"]
        half = f"takes {_radius(middle)} or more" if middle else f"takes less than R{each.least_mm:.3g}"
        least = most if each.reason is None else f"{narrowest} ({_spoken(each.reason)})"
        lines.append(f"Largest {each.shape} end, {each.length_over_radius:g} radii long: {whole}, half of the area {half}; "
                     f"the narrowest: {least}.")  # fmt: skip
    if plan.missing and (plan.largest_radius or any(c.least_stick_out for c in plan.cutters)):
        lines.append(
            "Stick-outs and largest radii hold unless a face is in the way that is missing from the obstacles."
        )
    for c in plan.cutters:
        if c.mend is None:
            continue
        helping = [change.why for change in c.mend.changes if change.helps]
        unsure = [change.why for change in c.mend.changes if change.helps is None]
        text = "; or ".join(helping) if helping else c.mend.why or "no change of one thing was found to help"
        lines.append(f"What would make {c.id} finish: {text}.")
        if unsure and not helping:
            lines.append(f"  Not decided: {'; '.join(unsure)}.")
    return lines


def _held(cutter: "CutterEntry") -> str:
    """The least stick-out, and the one it was judged with."""
    found = cutter.least_stick_out
    if found is None:
        return ""
    if found.least_mm is None:
        return found.limited_by
    end = ", flutes end" if found.limited_by == "floor" else ""
    return f"{_up(found.least_mm)} of {found.longest_mm:g}{end}"


def _up(length: float | None) -> str:
    """A length that must not be less, rounded up."""
    return f"{math.ceil(100.0 * (length or 0.0) - 1e-9) / 100.0:.2f}"


def _radius(radius: float) -> str:
    """A radius that must not be more, rounded down to three digits."""
    digit = 10.0 ** (math.floor(math.log10(radius)) - 2)
    return f"R{math.floor(radius / digit + 1e-9) * digit:.4g}"


def _place(point: Sequence[float]) -> str:
    return f"({', '.join(f'{x:.4g}' for x in point)})"


def _spoken(reason: str) -> str:
    return reason.replace("_", " ")


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


def not_reached(plan: "Plan") -> list[str]:
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
        line = f"Not reached by {c.id}: {left} of {plan.samples.count} samples ({reasons or 'none'}{undecided}), on {on}{where}."
        lines.append(named(plan, line))
    return lines
