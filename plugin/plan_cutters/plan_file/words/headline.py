"""The first words: which cutter to take and why, or how much is finished, and what is known between the samples."""

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from plan_cutters.domain.figures import area as area_text
from plan_cutters.domain.figures import capital, count, duration, listed, percent, some
from plan_cutters.domain.placement import axis_words
from plan_cutters.domain.preference import is_free_form, rank, ranks
from plan_cutters.plan_file.model import AreaEntry, CutterEntry, Plan
from plan_cutters.plan_file.nearest import nearest
from plan_cutters.plan_file.shares import reached_share
from plan_cutters.plan_file.words.names import described
from plan_cutters.plan_file.words.scope import judged, requested, sized

_ONE = {"ball": "ball end", "bull": "bull nose", "flat": "flat end", "special": "tapered cutter, barrel, lens or lollipop",
        "last": "engraving, chamfer or form cutter"}  # fmt: skip
_MANY = {"ball": "ball ends", "bull": "bull noses", "flat": "flat ends",
         "special": "tapered cutters, barrels, lenses and lollipops", "last": "engraving, chamfer and form cutters"}  # fmt: skip

#: Cutters that a first look names.
_LOOKED = 3


def rule(free_form: float) -> str:
    """By which rule a cutter is chosen, for a share of free-form faces."""
    kinds = ", then ".join(_all(groups) for groups in ranks(free_form=free_form))
    return (
        f"kind ({_faces(free_form)}: {kinds}), then largest radius, then smaller corner radius, then shorter length, then "
        "library order, among the feasible"
    )


def why(before: Sequence[str]) -> str:
    """Why the first feasible cutter wins: ids of those that come before it."""
    if not before:
        return "no cutter that was given comes before it"
    come, are = ("comes", "is") if len(before) == 1 else ("come", "are")
    return f"{', '.join(before)} {come} before it but {are} not feasible"


def stands(cutter: str) -> str:
    """Why a cutter comes first that leaves what stands on a proposed table."""
    return f"{cutter} comes first, and leaves only what stands on the table of the proposed setup"


def first_looked(setup: Sequence[float], samples: int, of: int, shares: Sequence[tuple[str, float]], together: float) -> str:
    """Say what cutters, by name, reach at some samples of the first setup, before all are judged.

    >>> first_looked((0.0, 0.0, 1.0), 400, 56473, [("D16", 0.5), ("D6", 0.75)], 0.75)
    'First look with 0,0,1 along the spindle, at 400 of 56,473 samples: D6 reaches 75 %, D16 50 %; together 75 %'
    """
    first, *others = sorted(shares, key=lambda each: -each[1])
    each = [f"{first[0]} reaches {percent(first[1])}", *(f"{name} {percent(share)}" for name, share in others[: _LOOKED - 1])]
    rest = f", {count(len(shares) - _LOOKED, 'other cutter')} no more" if len(shares) > _LOOKED else ""
    together_too = f"; together {percent(together)}" if others else ""
    where = f"with {axis_words(setup)} along the spindle, at {samples:,} of {of:,} samples"
    return f"First look {where}: {', '.join(each)}{rest}{together_too}"


def comes_last(plan: Plan) -> str:
    """The cutter that does alone, where the process has cutters of more wanted kinds before it; else empty."""
    entry = next((each for each in plan.cutters if each.id == plan.selected), None)
    steps = plan.process.steps if plan.process else []
    # Operations are chosen by their time: there only what comes last in any case gives way.
    if entry is None or (entry.group != "last" and any(step.mode != "any" for step in steps)):
        return ""
    return entry.id if {step.cutter for step in steps} - {entry.id} else ""


def first_of(plan: Plan, chosen: CutterEntry, every: str) -> str:
    """Say in sentences that a cutter is the most wanted that reaches everything, and by what; `every` names the samples.

    The kind is told only where cutters of another kind were given that come before or after it.
    """
    number = len(plan.cutters)
    if number == 1:
        return f"It reaches {every}."
    largest, share = f"It is the largest of {number} cutters that reaches {every}.", plan.selection.free_form
    if not chosen.group:
        # A plan of an earlier version ranked by size alone.
        return largest
    mine = _rank(chosen, share)
    present = {_rank(each, share) for each in plan.cutters if each.group}
    groups = {each.group for each in plan.cutters}
    order = [[group for group in rank_ if group in groups] for rank_ in ranks(free_form=share)]
    if present == {mine}:
        return largest
    same = _any(order[mine])
    if before := [rank_ for k, rank_ in enumerate(order) if k < mine and k in present]:
        return f"No {' and no '.join(map(_any, before))} reaches {every}. Of {number} cutters it is the largest {same} that does."
    after = min(present - {mine})
    where = "" if after == len(order) - 1 else f" on {_faces(share)}"
    come = f"{_all(order[mine])} come before {_all(order[after])}"
    return f"Of {number} cutters it is the largest {same} that reaches {every}:{where} {come}."


def _rank(entry: CutterEntry, free_form: float) -> int:
    return rank(entry.group, free_form=free_form)


def _faces(free_form: float) -> str:
    return "free-form faces" if is_free_form(free_form) else "planes, cylinders and cones"


def _any(groups: Sequence[str]) -> str:
    return " or ".join(_ONE[each] for each in groups)


def _all(groups: Sequence[str]) -> str:
    return " and ".join(_MANY[each] for each in groups)


#: From this share on a process finishes the part but for some of it; below, it does not.
_MOST = 0.5


class Headline(NamedTuple):
    """Which cutter to take, or how much all finish together (`good`; None: not for sure, or not all); for what; and why.

    `title` is a sentence without its stop, the others are whole ones; `about` may be empty.
    """

    title: str
    good: bool | None
    about: str
    why: str


def headline(plan: Plan, names: Mapping[str, str]) -> Headline:
    """Which cutter to take, with what holder, and why; where one alone does not do, how much all do together."""
    entries = {c.id: c for c in plan.cutters}
    part, setups = judged(plan), 1 + len(plan.effective.other_setups)
    process = plan.process

    def take(name: str, why: str, *, where: str = "") -> Headline:
        about = f"For {part}{where}: {described(entries[name], names[name])}."
        return Headline(f"Take {names[name]}", True, about, why + could_not(plan))

    late = comes_last(plan)
    if process is None or process.finished:
        if plan.selected and not late:
            # Of several setups one may do by itself.
            alone = next((s.axis for s in entries[plan.selected].setups if not s.not_reached), None)
            if alone not in (None, plan.effective.setup):
                why = f"It reaches {every(plan)} there, and needs no other setup."
                return take(plan.selected, why, where=f", in setup {axis_words(alone or ())}")
            if setups == 1 or alone:
                return take(plan.selected, first_of(plan, entries[plan.selected], every(plan)))
        if plan.selected_over_setups:
            why = f"Together they reach {every(plan)}; no setup does alone."
            return take(plan.selected_over_setups, why, where=f", in {setups} setups")
    best = nearest(plan.cutters)
    finished = process.finished if process else not best.not_reached
    share = process.finished_share if process else reached_share(best, best.area_share) or 0.0
    title = f"{_stands(plan)}: {_much(plan, share, finished=finished)}"
    about = "" if plan.scope is None or not plan.scope.not_judged else f"Judged: {requested(plan)}."
    if len(used := {step.cutter for step in process.steps} if process else {best.id}) == 1:
        (only,) = used
        about = " ".join(filter(None, (about, f"{capital(names[only])}: {described(entries[only], names[only])}.")))
    if finished:
        why = f"{capital(every(plan))} is reached" if every(plan).startswith("every") else f"{capital(every(plan))} are reached"
        if plan.missing:
            return Headline(title, None, about, f"{why}, but obstacles are missing that may be in the way.")
        single = f" {capital(names[late])} does alone, but its kind comes after that of step 1." if late else ""
        return Headline(title, True, about, f"{why}.{single}{could_not(plan)}")
    undecided = not any(c.blocked for c in plan.cutters)
    return Headline(title, None if undecided or share >= _MOST else False, about, could_not(plan).strip())


def _stands(plan: Plan) -> str:
    """The part, on which machine, and on what it stands where that was proposed."""
    proposed = plan.setup_proposal.setups if plan.setup_proposal else []
    machine = "" if plan.machine.name == "unlimited" else f", on {plan.machine.name}"
    part, setups = f"{sized(plan, plan.part.file or 'part')}{machine}", 1 + len(plan.effective.other_setups)
    if len(proposed) == 1 and proposed[0].clamping != "table":
        return f"{part}, in a {proposed[0].clamping} on {listed(proposed[0].grips, 2)}"
    if len(proposed) == 1 and proposed[0].stands_on:
        return f"{part}, stood on {listed(proposed[0].stands_on, 2)}"
    return f"{part}{f', in {setups} setups' if setups > 1 else ''}"


def _much(plan: Plan, share: float, *, finished: bool) -> str:
    """How much of what is asked is finished, and in what time."""
    whole = plan.process.asked_mm2 if plan.process else math.nan
    of = f"the {area_text(whole)} to machine" if math.isfinite(whole) else "the area to machine"
    seconds = plan.process.seconds if plan.process else None
    took = f", {duration(seconds)}" if seconds is not None else ""
    if plan.process and plan.process.setup_seconds:
        took += f" and {duration(plan.process.setup_seconds)} to clamp it again"
    return f"{percent(share, some=share > 0.0, whole=finished and share >= 1.0)} of {of}{took}"


def every(plan: Plan) -> str:
    """All samples; where not all could be judged, how many could."""
    if not plan.samples.unjudged and not not_sampled(plan):
        return "every sample but those at sharp inside edges" if plan.samples.exempt else "every sample"
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
