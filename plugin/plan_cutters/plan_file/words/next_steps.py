"""Put the next steps into words."""

from plan_cutters.domain.figures import percent
from plan_cutters.domain.placement import axis_words
from plan_cutters.plan_file.answers import MendEntry, RunEntry, StepEntry
from plan_cutters.plan_file.model import CutterEntry, Plan
from plan_cutters.plan_file.nearest import ANOTHER_SETUP
from plan_cutters.plan_file.words.headline import not_sampled

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
        stood = plan.process is not None and any(each.cause == ANOTHER_SETUP for each in plan.process.left)
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


def remaining(advice: MendEntry) -> str:
    """Say in a clause which areas are still not reached after the best step; empty where there are none."""
    best = next((step for step in advice.steps if not is_excluded(step)), None)
    if best is None or not best.remains:
        return ""
    return "; ".join(each.why for each in best.remains)
