"""A what-if has values of one thing; one driver finds the value that asks least and tells what comes of it."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

from plan_cutters.answers.trial import Case, Step, StillMissed, Trials, first, least
from plan_cutters.domain.change import UNDECIDED, Change, Thing, Value


@dataclass(frozen=True, slots=True)
class Way:
    """Give values by the number of steps from the present one; a last resort is tried where no other way serves."""

    most: int
    value: Callable[[int], Any]
    last_resort: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class WhatIf:
    """Hold the values of one thing to try, and the words for what comes of it.

    `make` gives the case with a value, None where there can be none. Of `ways` the one that serves with the fewest steps is
    taken, of equals the first; where each value allows all that those before it allow (`nested`), steps are halved. A value that
    serves has its sentence, and the options of a plan that differ with it (`serves`). Where nothing serves, the best case of
    `ends` is told (`fails`): as no help if it leaves a sample blocked, else as undecided, with its value (`reads`). `value_of` is
    told of a value that serves: itself, unless it is a whole cutter.
    """

    now: Value
    ways: Iterable[Way]
    make: Callable[[Any], Case | None]
    ends: list[Case]
    nested: bool = False
    reads: Callable[[Case], Value]
    fails: Callable[[Case, StillMissed], str]
    serves: Callable[[Any, Case], tuple[str, dict[str, Any]]]
    value_of: Callable[[Any], Value] = lambda value: value


def search(thing: Thing, what: WhatIf, trials: Trials) -> Change:
    """Find the value that asks least, judged on all samples as is the one before it; or tell what the best one leaves."""
    remaining = StillMissed.by(what.ends[0], trials.not_reached) if what.nested else None
    best = None if remaining and remaining.count else _fewest(what, trials)
    if best:
        step, value = best
        result, beyond = value(step.steps), None if step.beyond is None else value(step.beyond)
        words, options = what.serves(result, step.case)
        (cutter,) = options.get("cutters", (None,))
        values = [None if each is None else what.value_of(each) for each in (result, beyond)]
        return Change(
            thing, what.now, values[0], True, 0, len(trials.not_reached), trials.count, values[1], cutter, words, options
        )
    end = what.ends[0] if what.nested else trials.closest(what.ends)
    remaining = remaining or StillMissed.by(end, trials.not_reached)
    why = what.fails(end, remaining)
    # Where all that are not reached now are reached, others are not.
    worst = remaining if remaining.count or not len(trials.kept) else StillMissed.by(end, trials.kept)
    if worst.blocked or not worst.count:
        return none(thing, what.now, remaining.count, why, remaining.looked)
    why = UNDECIDED + why
    return Change(thing, what.now, what.reads(end), None, worst.count, worst.looked, 0, None, None, why)


def _fewest(what: WhatIf, trials: Trials) -> tuple[Step, Callable[[int], Any]] | None:
    best: tuple[Step, Callable[[int], Any]] | None = None
    for way in what.ways:
        if best and way.last_resort:
            break

        def steps(at: int, way: Way = way) -> Case | None:
            return what.make(way.value(at))

        most = min(way.most, best[0].steps - 1) if best and not what.nested else way.most
        step = (least if what.nested else first)(steps, most, trials)
        if step and (best is None or step.steps < best[0].steps):
            best = step, way.value
    return best


def none(thing: Thing, now: Value, unserved: int, why: str, looked: int | None = None) -> Change:
    """Tell that nothing serves, or that there is nothing to try; `looked`: samples looked at, if not all that are left."""
    looked = unserved if looked is None else looked
    return Change(thing, now, None, False, unserved, looked, 0, None, None, f"does not help: {why}")
