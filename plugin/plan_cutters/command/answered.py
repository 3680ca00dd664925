"""What was asked for after the plan, in lines for people."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from plan_cutters.document.model import Plan


def answered(plan: "Plan") -> list[str]:
    """A line or two for each answer."""
    lines = []
    for c in plan.cutters:
        found = c.least_stick_out
        if found is None:
            continue
        if found.limited_by == "floor":
            continue
        if found.least_mm is None:
            lines.append(f"The least stick-out of {c.id} was not looked for: {found.limited_by}.")
            continue
        at = f", when the tool stands at {_place(found.point)} on {found.face}" if found.point is not None else ""
        lines.append(
            f"{c.id} needs a stick-out of {up(found.least_mm)} mm at least ({found.longest_mm:g} mm was judged): with less, its "
            f"holder meets {found.obstacle_face or 'the part'}{at}."
        )
    lines += _held_short(plan)
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
    for c in plan.cutters:
        if c.mend is None:
            continue
        helping = [change.why for change in c.mend.changes if change.helps]
        unsure = [change.why for change in c.mend.changes if change.helps is None]
        if helping:
            lines.append(f"{c.id} would finish with {'; or with '.join(helping)}.")
            continue
        lines.append(
            f"Nothing sure would make {c.id} finish: {c.mend.why or 'no change of one thing was found to help'}."
        )
        if unsure:
            lines.append(f"  Not decided: {'; '.join(unsure)}.")
    return lines


def _held_short(plan: "Plan") -> list[str]:
    """Cutters of which no obstacle limits the stick-out, in one sentence."""
    found = [
        f"{c.id} {up(s.least_mm)} mm ({s.longest_mm:g} mm was judged)"
        for c in plan.cutters
        if (s := c.least_stick_out) and s.limited_by == "floor" and s.least_mm is not None
    ]
    if not found:
        return []
    return [f"No obstacle limits these stick-outs, but the length of flutes and neck does: {', '.join(found)}."]


def up(length: float) -> str:
    """A length that must not be less, rounded up."""
    return f"{math.ceil(100.0 * length - 1e-9) / 100.0:.2f}"


def radius(most: float) -> str:
    """A radius that must not be more, rounded down to three digits."""
    digit = 10.0 ** (math.floor(math.log10(most)) - 2)
    return f"R{math.floor(most / digit + 1e-9) * digit:.4g}"


def _place(point: Sequence[float]) -> str:
    return f"({', '.join(f'{x:.4g}' for x in point)})"
