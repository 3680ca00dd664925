"""Put the answers after the plan into words: changes, next steps, what would help against a cause, stick-outs and radii."""

import math
import re
from collections.abc import Iterator, Sequence

from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.dimensions import notation
from plan_cutters.domain.figures import ROUNDING, angle, capital, down, listed, mm, percent, place, reported, some, up
from plan_cutters.domain.figures import area as size
from plan_cutters.domain.holder import Holder
from plan_cutters.domain.placement import axis_words
from plan_cutters.domain.standard_tools import USUAL, slenderness
from plan_cutters.plan_file.answers import LostAreaEntry, MendEntry, RadiusEntry, RunEntry, StepEntry, StickOutEntry
from plan_cutters.plan_file.model import ANOTHER_SETUP, CutterEntry, Plan
from plan_cutters.plan_file.operations import UNJUDGED_CAUSE, FitEntry, HelpEntry, RemainingEntry
from plan_cutters.plan_file.reasons import CLOSED_VOID, REASONS, reason
from plan_cutters.plan_file.words.headline import every, not_sampled, shown_cutter
from plan_cutters.plan_file.words.names import Line, kind, named

Range = tuple[float, float]

#: Faces that are named one by one.
_FACES = 5
_ORDER = {2: "second", 3: "third", 4: "fourth"}


def tolerance(requested: float, now: float) -> str:
    return f"a tolerance of {mm(requested)} instead of {mm(now)}"


def tilt_range(wanted: Range, now: Range) -> str:
    return f"tilts from {angle(wanted[0])} to {angle(wanted[1])} in the search instead of {angle(now[0])} to {angle(now[1])}"


def tilt_limit(requested: float, now: float | None, machine: str) -> str:
    """Name a machine that tilts further; `now` is None where rotary axes limit it, not an angle."""
    instead = f"every way instead of {machine}" if now is None else f"instead of {angle(now)}"
    return f"a machine that tilts by {angle(requested)} {instead}"


def stick_out(requested: float, now: Cutter) -> str:
    """Name a stick-out; one of more than the usual diameters says so."""
    how, ratio = notation(now.name), requested / (2.0 * now.radius)
    return f"a stick-out of {how.mm(requested)}{_ratio(ratio)} instead of {how.mm(now.length)}"


def tool(cutter: Cutter) -> str:
    """Name a cutter that is sold, by kind, size and stick-out.

    >>> tool(Cutter.parse("D4L20rc2")), tool(Cutter.parse("R2L40rc0.5"))
    ('a ball end D4 held 20 mm out', 'a bull nose R2 rc0.5 held 40 mm out (10 D, more than the usual 5 D)')
    """
    how = notation(cutter.name)
    return f"a {kind(cutter)} {typed_size(cutter)} held {how.mm(cutter.length)} out{_ratio(slenderness(cutter))}"


def typed_size(cutter: Cutter) -> str:
    """The size of an end mill as it is typed, with the corner of a bull nose.

    >>> typed_size(Cutter.parse("D4L20rc2")), typed_size(Cutter.parse("R2L40rc0.5"))
    ('D4', 'R2 rc0.5')
    """
    how = notation(cutter.name)
    corner = f" rc{how.length(cutter.corner_radius)}" if kind(cutter) == "bull nose" else ""
    return f"{how.by}{how.across(cutter.radius)}{corner}"


def _ratio(ratio: float) -> str:
    return f" ({ratio:.3g} D, more than the usual {USUAL:g} D)" if ratio > USUAL * (1.0 + 1e-9) else ""


def holder(requested: Holder, now: Cutter) -> str:
    how = notation(now.name)
    return f"the holder {requested.called(how)} instead of {now.holder.called(how) if now.holder else 'none'}"


def rest(cutter: str) -> str:
    return f"{cutter} for the rest"


def clamped(axis: Sequence[float], degrees: float) -> str:
    """Say how the part is clamped for a setup axis that is so many degrees from the present one."""
    words = axis_words(axis)
    return f"turned over (setup {words})" if degrees > 179.0 else f"clamped with {words} along the spindle"


def more_setup(axis: Sequence[float], degrees: float, number: int) -> str:
    return f"{clamped(axis, degrees)} as a {_ORDER.get(number, 'further')} setup"


def patch(area: float, faces: Sequence[str], place: Sequence[float], across: float) -> str:
    """An area that is lost, mm2, with its place.

    >>> patch(57.2, ["F31"], (12.0, 3.0, -8.04), 4.13)
    '57.2 mm² of F31, about (12, 3, -8.04), 4.1 mm across'
    """
    wide = f", {mm(float(f'{across:.2g}'))} across" if across else ""
    where = ", ".join(f"{round(x, 4) + 0.0:.3g}" for x in place)
    return f"{size(area)} of {listed(faces, _FACES)}, about ({where}){wide}"


def excluded_areas(areas: Sequence[LostAreaEntry], area: float) -> str:
    """Say which connected areas to leave to another process, and how much they are in all, mm2."""
    if len(areas) == 1:
        return f"leave to another process: {areas[0].why}"
    return f"leave to another process: {size(area)} in {len(areas):,} places, the largest {areas[0].why}"


def samples(count: int) -> str:
    """Give a number of samples as the subject of a sentence and its verb."""
    return "1 sample is" if count == 1 else f"{count:,} samples are"


#: Runs that are named one by one.
_RUNS = 6


def together(plan: Plan) -> str:
    """Which of the given cutters and setups reach together all that any of them reaches, as one sentence without its stop.

    Empty where the plan does not say, or where one cutter in one setup reaches everything.
    """
    least = plan.least_set
    if least is None or (len(least.runs) < 2 and not least.left):
        return ""
    if not least.runs:
        return "No cutter given reaches any of the area"
    several = len({run.setup for run in least.runs}) > 1
    judged = not plan.samples.unjudged and not not_sampled(plan)
    whole = percent(least.share, some=True, whole=judged and not least.left)
    if len(least.runs) == 1:
        text = f"{_run(least.runs[0], several)} alone reaches all that any cutter given reaches, {whole} of the area"
    else:
        named, last = least.runs[:-1][:_RUNS], least.runs[-1]
        each = [f"{_run(run, several)} for {percent(run.share, some=True, whole=False)}" for run in named]
        each[0] += " of the area"
        more = len(least.runs) - 1 - len(named)
        if more:
            each.append(f"{more} more cutters for {percent(sum(r.share for r in least.runs[_RUNS:-1]), some=True, whole=False)}")
        every = "all of it" if judged else "all of it that could be judged"
        text = f"{', '.join(each)} and {_run(last, several)} for the rest reach {whole if least.left else every}"
    if least.left:
        other = "the other" if judged else "another"
        rest = f"{other} {percent(least.left_share, some=True, whole=False)}"
        stood = any(each.cause == ANOTHER_SETUP for each in plan.process.left)
        text += f"; they leave {rest}, also for another setup" if stood else f"; nothing given reaches {rest}"
    if not least.proven:
        text += " (a smaller set may do: the search ended before the proof)"
    if least.doubtful:
        text += ", unless a missing obstacle is in the way"
    return text


def _run(run: RunEntry, several: bool) -> str:
    return f"{run.cutter} in setup {axis_words(run.setup)}" if several else run.cutter


def effect(step: StepEntry) -> str:
    """Say how much a step gains.

    >>> effect(StepEntry(changes=[], lost_before=0.348, lost_after=0.322, gained=883, left=9000, cutters=[], setups=[],
    ...                  option=None, why="", remains=[]))
    'lost 34.8 to 32.2 % of the area (883 more samples)'
    """
    before = percent(step.lost_before, some=True, whole=False)
    after = percent(step.lost_after, some=bool(step.left), whole=False)
    many = f"{step.gained:,} more sample{'' if step.gained == 1 else 's'}"
    end = "; then nothing is lost" if not step.left else ""
    if before == after:
        return f"lost {before} of the area, hardly less than now ({many}){end}"
    return f"lost {before.removesuffix(' %')} to {after} of the area ({many}){end}"


def is_excluded(step: StepEntry) -> bool:
    """Whether a step changes nothing but leaves what is not reached to other means."""
    return any(change.thing == "area" for change in step.changes)


def step_text(step: StepEntry) -> str:
    """A step and its effect, without its stop."""
    if is_excluded(step):
        return step.why
    return f"{step.why}: {effect(step)}"


def first_step(entry: CutterEntry) -> StepEntry | None:
    """The best step of a cutter; None where there is none but to leave it."""
    return next((step for step in (entry.mend.steps if entry.mend else []) if not is_excluded(step)), None)


#: Faces that are named; shares of an area from which on points are named, and from which on they are most of it.
_FEW, _NAMED, _POINTS, _MAINLY = 2, 3, 0.05, 0.5
#: A step that does less of an area is no answer to it; what does so much leaves hardly any; a size that fits less does not fit.
_HELPS, _NEARLY, _SOME = 0.1, 0.9, 0.01
#: Shares that differ by less are alike.
_ALIKE = 0.05


def needs(plan: Plan, entry: RemainingEntry) -> str:
    """Say what would help against a cause, in a clause; empty where nothing is known."""
    if entry.cause == "sharp_edge" and plan.sharp_edges:
        return f"the model has no fillet there, and the cutter leaves one of {_fillets(plan, entry)}"
    if entry.cause == UNJUDGED_CAUSE:
        faces = set(entry.faces)
        return next((face.unjudged for face in plan.faces if face.id in faces and face.unjudged), "") or ""
    if entry.cause not in REASONS:
        return ""
    if entry.cause == "buried" and (shut := [face for face in entry.faces if face in plan.part.void_faces]):
        if len(shut) == len(entry.faces):
            return CLOSED_VOID
        return f"{CLOSED_VOID} at {listed(shut, _NAMED)}; for the rest {REASONS[entry.cause].hint}"
    advice = shown_cutter(plan).mend
    hint = first_tries(entry.cause, advice)
    if advice is not None and (best := _best(entry, advice)) is not None:
        what = re.sub(r" \([^()]*\)|,? for the rest$", "", advice.steps[best.step].why)
        first, share = f"{what} {'may finish' if advice.unsure else 'finishes'} {_share(best.share)} of it", best.share
    elif hint and entry.fits is not None:
        # What was judged says more than a hint; a size that reaches next to nothing is none that fits.
        first = _sizes(entry.fits)
        share = entry.fits[-1].share if first else 0.0
    else:
        first, share = hint or "no change that was tried helps", 0.0
    points = _points(entry, share)
    return "; ".join(
        filter(None, (first or ("" if points else "no usual size fits: an undercut cutter or another direction may"), points))
    )


def _fillets(plan: Plan, entry: RemainingEntry) -> str:
    """The radii that the steps leave at the sharp edges of some faces: of each edge that of the finest cutter that comes there.

    An edge in the plan has the radius of the cutter shown, which is that of its corner or of its flutes.
    """
    shown, faces, radii = shown_cutter(plan), set(entry.faces), set[float]()
    by_id = {each.id: each for each in plan.cutters}
    for edge in [each for each in plan.sharp_edges if faces & {*each.faces}] or plan.sharp_edges[:1]:
        by_corner = abs(edge.radius_mm - shown.allowance_mm - shown.corner_radius) < ROUNDING
        used = [by_id[step.cutter] for step in plan.process.steps if {*step.faces} & {*edge.faces}]
        left = [each.allowance_mm + ((by_corner and each.corner_radius) or each.radius) for each in used]
        radii.add(reported(min(left, default=edge.radius_mm)))
    least, most = f"R{min(radii):.4g}", f"R{max(radii):.4g}"
    return least if least == most else f"{least} to {most}"


def _best(entry: RemainingEntry, advice: MendEntry) -> HelpEntry | None:
    """The step that does most of an area; where others do hardly less, one on the same machine, of fewer changes."""
    known = [each for each in entry.helped if each.step < len(advice.steps) and each.share >= _HELPS]

    def effort(each: HelpEntry) -> tuple[bool, int, float, int]:
        things = [change.thing for change in advice.steps[each.step].changes]
        return "tilt_limit" in things, len(things), -each.share, each.step

    return min((each for each in known if each.share >= known[0].share - _ALIKE), key=effort, default=None)


def first_tries(cause: str, advice: MendEntry | None) -> str:
    """Say what to try first against a cause, but for what an answer found to be of no use; empty where that is all of it."""
    if cause not in REASONS:
        return ""
    # Where steps were looked for, a change that none of them makes is refuted.
    compared = bool(advice and advice.steps)
    made = {change.thing for step in advice.steps for change in step.changes} if advice else set()
    tries = REASONS[cause].tries
    return ", or ".join(words for words, means in tries if not (compared and means and made.isdisjoint(means)))


def _sizes(fits: list[FitEntry]) -> str:
    """Which sizes reach how much; empty where they reach less than a hundredth.

    >>> fits = [("R1.5L40", "D3", 3.0, 0.749), ("R1L40", "D2", 2.0, 0.9)]
    >>> _sizes([FitEntry(cutter=spec, kind="flat end", size=d, diameter_mm=mm, share=s) for spec, d, mm, s in fits])
    'flat end D3 fits 74 % of it, D2 90 %'
    """
    if not fits or fits[0].share < _SOME:
        return ""
    first, *more = fits
    smaller = [f"{each.size} {_share(each.share)}" for each in more]
    return ", ".join([f"{first.kind} {first.size} fits {_share(first.share)} of it", *smaller])


def _share(share: float) -> str:
    """A share in whole percents, no more than it is.

    >>> _share(0.749), _share(1.0), _share(0.004)
    ('74 %', '100 %', '<0.1 %')
    """
    return percent(math.floor(100.0 * share + 1e-9) / 100.0, some=True)


def _points(entry: RemainingEntry, share: float) -> str:
    """Say that no end fits the points of cones: where they are most of an area, or much of one of which a share leaves a part."""
    points = entry.points
    if points is None or points.share < (_MAINLY if share >= _NEARLY else _POINTS):
        return ""
    which = "" if share else f" ({listed(points.faces, _FEW)})"
    return f"no end fits a cone's point{which}: left for a drill or by hand"


#: Steps that are said of a cutter.
_STEPS = 5
#: Stick-outs that differ by less are the same, mm.
SAME = 0.02


def answers(plan: Plan) -> list[Line]:
    """A line or two for each answer, cutters called as everywhere; what is to be typed is as it must be typed."""
    lines = (*_stick_outs(plan), *_radii(plan), *_next(plan))
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
        so = "These can be held as short as their flutes and necks allow, and still reach all that they reach"
        yield Line(f"{so}: {', '.join(short)}.")


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


def _next(plan: Plan) -> Iterator[Line]:
    """Steps for each cutter, the best first, with the option that each takes."""
    for c in sorted((c for c in plan.cutters if c.mend), key=lambda c: c.mend.lost_share if c.mend else 0.0):
        advice = c.mend
        if advice is None or not advice.steps:
            yield Line(f"Nothing sure would make {c.id} finish: {advice.why if advice else ''}.")
            continue
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
            yield Line(f"  Compared {len(steps)} of {of} changes, those that promised most; `--effort thorough` compares more.")
        if steps and (rest := "; ".join(each.why for each in steps[0].remains)):
            yield Line(f"  After step 1 stays: {rest}.")
        yield from (Line(f"  Or {step.why}.") for step in advice.steps if is_excluded(step))
    if omitted := len(plan.not_mended):
        which = "cutter that leaves more was" if omitted == 1 else "cutters that leave more were"
        yield Line(f"{omitted} more {which} not asked about: plan with one of them alone.")
