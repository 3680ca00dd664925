"""The first words of the summary: which cutter to take, or why none, and what that means between the samples."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

from rich.text import Text

from plan_cutters.command.rows import cell
from plan_cutters.document.judged import judged
from plan_cutters.document.names import described
from plan_cutters.document.next_steps import axis
from plan_cutters.document.told import lost as lost_percent
from plan_cutters.document.told import percent

if TYPE_CHECKING:
    from plan_cutters.document.model import Plan

_MARKS = {True: "bold green", False: "bold red", None: "bold yellow"}


def headline(plan: "Plan", names: Mapping[str, str]) -> list[Text]:
    """Which cutter to take, with what holder, and why; or why none."""
    entries, told = {c.id: c for c in plan.cutters}, {c.id: described(c, names[c.id]) for c in plan.cutters}
    part, setups = judged(plan), 1 + len(plan.effective.other_setups)
    here = "this setup" if setups == 1 else "these setups"
    # Of several setups one may do by itself.
    alone = next((s.axis for s in entries[plan.selected].setups if not s.lost), None) if plan.selected else None
    if plan.selected and alone not in (None, plan.effective.setup):
        c = entries[plan.selected]
        where = f"in setup {axis(alone or ())}"
        return [_marked(f"Take {names[c.id]}", True, f" for {part}, {where}: {told[c.id]}. It reaches every sample there, and "
                        "needs no other setup.")]  # fmt: skip
    if plan.selected and (setups == 1 or alone):
        c = entries[plan.selected]
        which = (
            "reaches every sample"
            if len(entries) == 1
            else f"is the largest of {len(entries)} cutters that reaches every sample"
        )
        return [_marked(f"Take {names[c.id]}", True, f" for {part}: {told[c.id]}. It {which}.")]
    if plan.selected_over_setups:
        c = entries[plan.selected_over_setups]
        return [_marked(f"Take {names[c.id]}", True, f" for {part}, in {setups} setups: {told[c.id]}. Together they reach "
                        "every sample; no setup does alone.")]  # fmt: skip
    if plan.selected_for_setup:
        c = entries[plan.selected_for_setup]
        return [_marked(f"Take {names[c.id]} in {here}", None, f" for {part}: {told[c.id]}. It leaves only what the axis "
                        f"limit keeps from every cutter, {lost_percent(c, c.area_share)} of the area: that needs another "
                        "setup.")]  # fmt: skip
    best = min(plan.cutters, key=lambda c: c.lost)
    left = best.lost
    name = f"{names[best.id]} ({told[best.id]})"
    if not left:
        return [_marked(f"No cutter is sure for {part}", None, f". {name} reaches every sample that could be judged, but "
                        "obstacles are missing (below) that may be in its way.")]  # fmt: skip
    which = f"{name} was judged: it" if len(entries) == 1 else f"Of {len(entries)} cutters, {name} comes nearest: it"
    much = f"{lost_percent(best, best.area_share)} of the area ({left} of {plan.samples.finished} samples)"
    ask = "" if "mend" in plan.effective.answers else " Ask what would help: --answers mend."
    if best.blocked == 0:
        return [_marked(f"No cutter is sure for {part}", None, f". {which} leaves {much} undecided: neither safe nor blocked to "
                        f"the tolerance.{ask}")]  # fmt: skip
    return [_marked(f"No cutter finishes {part}", False, f". {which} leaves {much}.{ask}")]


def between(plan: "Plan") -> list[str]:
    """What is known of the area between the samples, and what that means."""
    lines = []
    for c in plan.cutters:
        if c.area is None:
            continue
        if c.area.feasible:
            lines.append("Between the samples, too, all of the area is proved safe with the tool axes found.")
            continue
        nothing = c.area.share <= 0.0
        share = "nothing" if nothing else f"{percent(c.area.share, some=True, whole=False)} of the area"
        rest = "area" if nothing else percent(1.0 - c.area.share, some=True, whole=False)
        lines.append(
            f"Between the samples, {share} is proved safe with the tool axis kept as it was found. The {'other ' * (not nothing)}"
            f"{rest} is not proved, which does not mean unsafe: the tool axis has to turn there from one sample to the next, or "
            "the samples are too far apart. Check it in simulation, or ask for more (--spacing, --area-budget)."
        )
    return lines


def _marked(text: str, good: bool | None, rest: str) -> Text:
    return Text.assemble(cell(text, _MARKS[good]), cell(rest))
