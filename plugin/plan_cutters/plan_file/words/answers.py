"""Put the answers after the plan into words: least stick-outs, largest radii and next steps."""

from collections.abc import Iterator

from plan_cutters.domain.dimensions import notation
from plan_cutters.domain.figures import capital, down, mm, place, some, up
from plan_cutters.plan_file.answers import MendEntry, RadiusEntry, StickOutEntry
from plan_cutters.plan_file.model import CutterEntry, Plan
from plan_cutters.plan_file.words.cutters import reason
from plan_cutters.plan_file.words.headline import every
from plan_cutters.plan_file.words.names import Line, named
from plan_cutters.plan_file.words.next_steps import is_excluded, remaining, step_text

#: Steps that are said of a cutter.
_STEPS = 5
#: Stick-outs that differ by less are the same, mm.
SAME = 0.02


def answers(plan: Plan) -> list[Line]:
    """A line or two for each answer, cutters called as everywhere; what is to be typed is as it must be typed."""
    lines = (*_stick_outs(plan), *_radii(plan), *_mends(plan))
    return [line._replace(text=capital(named(plan, line.text))) for line in lines]


def limit(stick_out: StickOutEntry) -> str:
    """Say in a sentence which obstacle or part of the tool limits a stick-out."""
    if stick_out.least_mm is None:
        return f"It was not looked for: {stick_out.limited_by}."
    if stick_out.limited_by == "floor" or stick_out.face is None:
        return "Its flutes and neck are that long."
    met = stick_out.obstacle_face or "the part"
    return f"Held shorter, its holder meets {met} when the tool stands at ({place(stick_out.point)}) on {stick_out.face}."


def _stick_outs(plan: Plan) -> Iterator[Line]:
    short = []
    for c in plan.cutters:
        stick_out = c.least_stick_out
        if stick_out is None:
            continue
        if stick_out.least_mm is None:
            yield Line(f"The least stick-out of {c.id} was not looked for: {stick_out.limited_by}.")
        elif stick_out.limited_by == "floor":
            short.append(f"{c.id} {up(stick_out.least_mm)} (judged with {mm(stick_out.longest_mm, 6)})")
        elif stick_out.longest_mm - stick_out.least_mm < SAME:
            longest = mm(stick_out.longest_mm, 6)
            yield Line(f"{c.id} cannot be held shorter than the {longest} that were judged. {limit(stick_out)}")
        else:
            yield Line(
                f"{c.id} can be held shorter: {up(stick_out.least_mm)} of its {mm(stick_out.longest_mm, 6)} stick-out are enough "
                f"for all that it reaches now. {limit(stick_out)}"
            )
    if short:
        yield Line(
            "These can be held as short as their flutes and necks allow, and still reach all that they reach: "
            f"{', '.join(short)}."
        )


def narrowest(radius: RadiusEntry) -> str:
    """Where the largest radius is the least, and why."""
    if radius.bottleneck_point is None:
        return ""
    why = f"({reason(radius.reason)})" if radius.reason else "(no larger end was tried)"
    return f"({place(radius.bottleneck_point)}) on {radius.bottleneck_face} {why}"


def _radii(plan: Plan) -> Iterator[Line]:
    # As the cutters were given: by diameter, unless one was given by radius.
    across, times = ("radius", 1.0) if any(notation(c.name).by == "R" for c in plan.cutters) else ("diameter", 2.0)
    for each in plan.largest_radius:
        if not each.percentiles_mm or each.bottleneck_mm is None:
            continue
        end, rest = f"{each.shape} end of {across}", f"({each.length_over_radius:g} radii long) reaches {every(plan)}"
        whole = f"A {end} {down(times * each.bottleneck_mm)} {rest}"
        if not each.bottleneck_mm:
            whole = f"Not even a {end} {mm(times * each.least_mm)} {rest}: it misses {each.below}"
        middle = each.percentiles_mm["50"]
        half = f"{down(times * middle)} or more" if middle else f"less than {mm(times * each.least_mm)}"
        yield Line(f"{whole}; half of the area takes {half}. The narrowest place is {narrowest(each)}.")
    if plan.missing and (plan.largest_radius or any(c.least_stick_out for c in plan.cutters)):
        yield Line("Stick-outs and largest radii hold provided that no missing obstacle is in the way.")


def _mends(plan: Plan) -> Iterator[Line]:
    for c in sorted((c for c in plan.cutters if c.mend), key=lambda c: c.mend.lost_share if c.mend else 0.0):
        if c.mend is None:
            continue
        yield from _next(c, c.mend)
        if not c.mend.steps:
            yield Line(f"Nothing sure would make {c.id} finish: {c.mend.why}.")
    if omitted := len(plan.not_mended):
        which = "cutter that leaves more was" if omitted == 1 else "cutters that leave more were"
        yield Line(f"{omitted} more {which} not asked about: plan with one of them alone.")


def _next(c: CutterEntry, advice: MendEntry) -> Iterator[Line]:
    """Steps for a cutter, the best first, with the option that each takes."""
    if not advice.steps:
        return
    unsure = " (provided that no missing obstacle is in the way)" if advice.unsure else ""
    yield Line(f"What next for {c.id}, which leaves {some(advice.lost_share)} of the area{unsure}:")
    steps = [step for step in advice.steps if not is_excluded(step)]
    for k, step in enumerate(steps[:_STEPS], 1):
        typed = f" [{'add ' * step.option.startswith('--cutter')}{step.option}]" if step.option else ""
        yield Line(f"  {k}. {step_text(step)}.", typed=typed)
    if len(steps) > _STEPS:
        yield Line(f"  and {len(steps) - _STEPS} more in plan.json.")
    if not steps:
        yield Line("  No step was found that frees any of it.")
    if advice.uncompared:
        of = len(steps) + advice.uncompared
        yield Line(f"  Compared {len(steps)} of {of} changes, those that promised most; --effort thorough compares more.")
    if rest := remaining(advice):
        yield Line(f"  After step 1 stays: {rest}.")
    for step in advice.steps:
        if is_excluded(step):
            yield Line(f"  Or {step.why}.")
