"""The first words: which cutter to take, or why none, of how much that could be judged, and what is known between the samples."""

from collections.abc import Mapping
from typing import NamedTuple

from plan_cutters.domain.placement import axis_words
from plan_cutters.plan_file.model import AreaEntry, CutterEntry, Plan
from plan_cutters.plan_file.nearest import nearest
from plan_cutters.plan_file.numbers import capital, count, listed, some
from plan_cutters.plan_file.shares import unreached
from plan_cutters.plan_file.words.names import described
from plan_cutters.plan_file.words.scope import judged


class Headline(NamedTuple):
    """Which cutter to take, or that none does (`good`; None: not for sure, or not all); for what and how it is held; and why.

    `title` is a sentence without its stop, the others are whole ones; `about` may be empty.
    """

    title: str
    good: bool | None
    about: str
    why: str


def headline(plan: Plan, names: Mapping[str, str]) -> Headline:
    """Which cutter to take, with what holder, and why; or why none."""
    entries = {c.id: c for c in plan.cutters}
    part, setups = judged(plan), 1 + len(plan.effective.other_setups)
    here = "this setup" if setups == 1 else "these setups"

    def take(name: str, good: bool | None, why: str, *, to: str = "", where: str = "") -> Headline:
        about = f"For {part}{where}: {described(entries[name], names[name])}."
        return Headline(f"Take {names[name]}{to}", good, about, why + could_not(plan))

    if plan.selected:
        # Of several setups one may do by itself.
        alone = next((s.axis for s in entries[plan.selected].setups if not s.not_reached), None)
        if alone not in (None, plan.effective.setup):
            why = f"It reaches {every(plan)} there, and needs no other setup."
            return take(plan.selected, True, why, where=f", in setup {axis_words(alone or ())}")
        if setups == 1 or alone:
            which = "" if len(entries) == 1 else f"is the largest of {len(entries)} cutters that "
            return take(plan.selected, True, f"It {which}reaches {every(plan)}.")
    if plan.selected_over_setups:
        why = f"Together they reach {every(plan)}; no setup does alone."
        return take(plan.selected_over_setups, True, why, where=f", in {setups} setups")
    if plan.selected_for_setup:
        c = entries[plan.selected_for_setup]
        why = (
            f"It leaves only what the axis limit keeps from every cutter, {unreached(c, c.area_share)} of {area(plan)}: "
            "that needs "
            "another setup."
        )
        return take(c.id, None, why, to=f" in {here}")
    best = nearest(plan.cutters)
    name = f"{names[best.id]} ({described(best, names[best.id])})"
    unsure = f"No cutter is sure for {part}"
    if not best.not_reached:
        why = f"{capital(name)} reaches {every(plan)}, but obstacles are missing (see below) that may be in its way."
        return Headline(unsure, None, "", why + could_not(plan))
    which = f"{capital(name)} was judged: it" if len(entries) == 1 else f"Of {len(entries)} cutters, {name} comes nearest: it"
    much = f"{unreached(best, best.area_share)} of {area(plan)} ({best.not_reached:,} of {plan.samples.finished:,} samples)"
    ask = "" if "mend" in plan.effective.answers else " Ask what would help: --answers mend."
    if best.blocked == 0:
        why = f"{which} leaves {much} undecided: neither safe nor blocked to the tolerance."
        return Headline(unsure, None, "", why + could_not(plan) + ask)
    return Headline(f"No cutter finishes {part}", False, "", f"{which} leaves {much}." + could_not(plan) + ask)


def every(plan: Plan) -> str:
    """All samples; where not all could be judged, how many could."""
    if not plan.samples.unjudged and not not_sampled(plan):
        return "every sample"
    judged = plan.samples.judged
    return f"all {judged:,} samples that could be judged" if judged != 1 else "the 1 sample that could be judged"


def could_not(plan: Plan) -> str:
    """Say what part could not be judged, in a sentence that follows others; empty where all could be judged."""
    lines, number = [], plan.samples.unjudged
    if number:
        faces = [f.id for f in plan.faces if f.target and f.unjudged and f.samples]
        on = f" on {listed(faces)}" if faces else ""
        lines.append(f"{number:,} of {count(plan.samples.count, 'sample')}{on} could not be judged")
    if empty := not_sampled(plan):
        lines.append(f"{listed(empty)} could not be sampled")
    return f" {', and '.join(lines)}." if lines else ""


def not_sampled(plan: Plan) -> list[str]:
    """Ids of target faces that have no sample."""
    return [f.id for f in plan.faces if f.target and not f.samples]


def area(plan: Plan) -> str:
    """Name the area that shares refer to: the area of faces without samples may be unknown."""
    return "the area that could be sampled" if not_sampled(plan) else "the area"


def between(plan: Plan, c: CutterEntry) -> str:
    """Say how much is known of the area between the samples, and its meaning; empty where that was not requested."""
    return "" if c.area is None else _between(c.area, area(plan))


def _between(area: AreaEntry, of: str) -> str:
    if area.feasible:
        return "Between the samples, too, all of the area is proved safe with the tool axes found."
    if area.share == 1.0 and area.left_out:
        return (
            f"Between the samples, all area that is known is proved safe with the tool axes found; that of "
            f"{listed(area.left_out)} is not known."
        )
    nothing = area.share <= 0.0
    share = "nothing" if nothing else f"{some(area.share)} of {of}"
    rest = "area" if nothing else some(1.0 - area.share)
    return (
        f"Between the samples, {share} is proved safe with the tool axis kept as it was found. The {'other ' * (not nothing)}"
        f"{rest} is not proved, which does not mean unsafe: the tool axis has to turn there from one sample to the next, or "
        "the samples are too far apart. Check it in simulation, or ask for more (--spacing, --area-budget)."
    )
