"""What was asked for after the plan, in lines for people."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from plan_cutters.document.names import named
from plan_cutters.document.next_steps import cures, is_left_out, remaining, step_told
from plan_cutters.document.told import percent

if TYPE_CHECKING:
    from plan_cutters.document.answers import MendEntry
    from plan_cutters.document.model import CutterEntry, Plan

#: Steps that are said of a cutter.
_STEPS = 5
#: What is told, and behind it what is to be typed.
_Line = tuple[str, str]
#: Stick-outs that differ by less are the same, mm.
_SAME = 0.02


def answered(plan: "Plan") -> list[str]:
    """A line or two for each answer, cutters called as in the summary; what is to be typed is as it must be typed."""
    return [named(plan, text) + typed for text, typed in (*_stick_outs(plan), *_radii(plan), *_mends(plan))]


def _stick_outs(plan: "Plan") -> list[_Line]:
    lines: list[str] = []
    for c in plan.cutters:
        found = c.least_stick_out
        if found is None:
            continue
        if found.limited_by == "floor":
            continue
        if found.least_mm is None:
            lines.append(f"The least stick-out of {c.id} was not looked for: {found.limited_by}.")
            continue
        at = f" when the tool stands at {_place(found.point)} on {found.face}" if found.point is not None else ""
        met = f"its holder meets {found.obstacle_face or 'the part'}{at}"
        if found.longest_mm - found.least_mm < _SAME:
            lines.append(
                f"{c.id} cannot be held shorter than the {found.longest_mm:g} mm that were judged: then {met}."
            )
            continue
        lines.append(
            f"{c.id} can be held shorter: {up(found.least_mm)} mm of its {found.longest_mm:g} mm stick-out are enough for "
            f"all that it reaches now. Shorter still, {met}."
        )
    return [(line, "") for line in (*lines, *_held_short(plan))]


def _radii(plan: "Plan") -> list[_Line]:
    lines = []
    for each in plan.largest_radius:
        if not each.percentiles_mm or each.bottleneck_mm is None or each.bottleneck_point is None:
            continue
        narrowest = f"{_place(each.bottleneck_point)} on {each.bottleneck_face}"
        end = f"{each.shape} end of %s ({each.length_over_radius:g} radii long)"
        whole = f"A {end % radius(each.bottleneck_mm)} reaches every sample" if each.bottleneck_mm else (
            f"Not even a {end % f'R{each.least_mm:.3g}'} reaches every sample: it misses {each.below}"
        )  # fmt: skip
        middle = each.percentiles_mm["50"]
        half = f"takes {radius(middle)} or more" if middle else f"takes less than R{each.least_mm:.3g}"
        least = f"No end larger than {radius(each.most_mm)} was tried." if each.reason is None else (
            f"The narrowest place is {narrowest} ({each.reason.replace('_', ' ')})."
        )  # fmt: skip
        lines.append(f"{whole}; half of the area {half}. {least}")
    if plan.missing and (plan.largest_radius or any(c.least_stick_out for c in plan.cutters)):
        lines.append(
            "Stick-outs and largest radii hold unless a face is in the way that is missing from the obstacles."
        )
    return [(line, "") for line in lines]


def _mends(plan: "Plan") -> list[_Line]:
    lines: list[_Line] = []
    for c in sorted((c for c in plan.cutters if c.mend), key=lambda c: c.mend.lost_share if c.mend else 0.0):
        if c.mend is None:
            continue
        lines += _next(c, c.mend)
        helping = [change.why for change in cures(c.mend) if change.helps]
        unsure = [change.why for change in cures(c.mend) if change.helps is None]
        if helping:
            lines.append((f"{c.id} would finish with {'; or with '.join(helping)}.", ""))
            continue
        if not c.mend.steps:
            why = c.mend.why or "no change of one thing was found to help"
            lines.append((f"Nothing sure would make {c.id} finish: {why}.", ""))
        if unsure:
            lines.append((f"  Not decided: {'; '.join(unsure)}.", ""))
    if plan.not_mended:
        left = len(plan.not_mended)
        which = "cutter that leaves more was" if left == 1 else "cutters that leave more were"
        lines.append((f"{left} more {which} not asked about: --answers mend-all.", ""))
    return lines


def _next(c: "CutterEntry", mend: "MendEntry") -> list[_Line]:
    """Steps for a cutter, the best first, with the option that each takes."""
    if not mend.steps:
        return []
    unsure = " (if nothing is in the way that is missing from the obstacles)" if mend.unsure else ""
    lost = percent(mend.lost_share, some=True, whole=False)
    lines: list[_Line] = [(f"What next for {c.id}, which leaves {lost} of the area{unsure}:", "")]
    shown = [step for step in mend.steps if not is_left_out(step)]
    lines += [
        (
            f"  {k}. {step_told(step)}.",
            f" [{'add ' * step.option.startswith('--cutter')}{step.option}]" if step.option else "",
        )
        for k, step in enumerate(shown[:_STEPS], 1)
    ]
    if len(shown) > _STEPS:
        lines.append((f"  and {len(shown) - _STEPS} more in plan.json.", ""))
    if not shown:
        lines.append(("  No step was found that frees any of it.", ""))
    if rest := remaining(mend):
        lines.append((f"  After step 1 stays: {rest}.", ""))
    return [*lines, *((f"  Else: {step.why}.", "") for step in mend.steps if is_left_out(step))]


def _held_short(plan: "Plan") -> list[str]:
    """Cutters of which no obstacle limits the stick-out, in one sentence."""
    found = [
        f"{c.id} {up(s.least_mm)} mm (judged with {s.longest_mm:g} mm)"
        for c in plan.cutters
        if (s := c.least_stick_out) and s.limited_by == "floor" and s.least_mm is not None
    ]
    if not found:
        return []
    return [
        f"These can be held as short as their flutes and necks allow, and still reach all that they reach: {', '.join(found)}."
    ]


def up(length: float) -> str:
    """A length that must not be less, rounded up."""
    return f"{math.ceil(100.0 * length - 1e-9) / 100.0:.2f}"


def radius(most: float) -> str:
    """A radius that must not be more, rounded down to three digits."""
    digit = 10.0 ** (math.floor(math.log10(most)) - 2)
    return f"R{math.floor(most / digit + 1e-9) * digit:.4g}"


def _place(point: Sequence[float]) -> str:
    return f"({', '.join(f'{x:.4g}' for x in point)})"
