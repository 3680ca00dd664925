"""Which wider ranges of tilt would serve: those that are searched, and those of the machine."""

import math
from dataclasses import replace
from typing import Any

from plan_cutters.answers.outcome import none, short
from plan_cutters.answers.trial import Case, Left, Trials, least
from plan_cutters.domain.change import Change
from plan_cutters.domain.machine import Machine
from plan_cutters.domain.shapes import modes

#: Steps of tilts, deg.
GRAIN = 0.1


def tilt_limit(case: Case, trials: Trials) -> Change:
    """The least limit of the machine's axis, to `GRAIN`; for one whose rotary axes limit it, a machine that tilts every way."""
    machine = case.ready.conditions.machine
    if not machine.limited:
        return none("tilt_limit", None, len(trials.lost), "the machine has no limit")
    now = None if machine.turns or machine.tilt_limit is None else _degrees(machine.tilt_limit)
    left = Left.by(_within(case, machine=Machine()), trials.lost)
    if left.count:
        return short("tilt_limit", now, 180.0, left, f"without any limit {left.words}")
    base = math.floor((now or 0.0) / GRAIN + 1e-6)

    def value(at: int) -> float:
        return min(180.0, round((base + at) * GRAIN, 6)) if at else now or 0.0

    def steps(at: int) -> Case:
        return _within(case, machine=Machine.parse(f"tilt:{value(at):.6g}"))

    found = least(steps, math.ceil(180.0 / GRAIN) - base, trials)
    if found is None:
        return none("tilt_limit", now, 0, "no limit was found that serves all samples", len(trials.lost))
    asked, beyond = value(found.steps), None if found.beyond is None else value(found.beyond)
    instead = f"every way instead of {machine.name}" if now is None else f"instead of {now:g} deg"
    return Change("tilt_limit", now, asked, True, 0, len(trials.lost), trials.count, beyond, None,
                  f"a machine that tilts by {asked:g} deg {instead}",
                  {"machine": found.case.ready.conditions.machine})  # fmt: skip


def tilt_range(case: Case, trials: Trials) -> Change:
    """A wider range of tilts to search: one end of it as far as is needed, or both; to `GRAIN`."""
    low, high = (_degrees(tilt) for tilt in case.ready.conditions.postures.tilt)
    touching = modes(case.cutter)
    lowest = min(low, round(math.floor(_degrees(min(mode.low for mode in touching)) / GRAIN) * GRAIN, 6))
    highest = max(high, min(180.0, round(math.ceil(_degrees(max(mode.high for mode in touching)) / GRAIN) * GRAIN, 6)))
    if (lowest, highest) == (low, high):
        why = "the cutter touches at no tilt beyond the range searched"
        return none("tilt_range", (low, high), len(trials.lost), why)
    left = Left.by(_tilts(case, (lowest, highest)), trials.lost)
    if left.count:
        return short("tilt_range", (low, high), (lowest, highest), left,
                       f"at all tilts from {lowest:g} to {highest:g} deg {left.words}")  # fmt: skip
    found: list[tuple[int, tuple[float, float], tuple[float, float] | None]] = []
    # The end that is fixed, or if neither end alone serves, the lower one as low as can be.
    for bottom, down, up in ((low, 0, 1), (low, 1, 0), (lowest, 0, 1)):

        def value(at: int, bottom: float = bottom, down: int = down, up: int = up) -> tuple[float, float]:
            return max(lowest, round(bottom - down * at * GRAIN, 6)), min(highest, round(high + up * at * GRAIN, 6))

        most = math.ceil(max(up * (highest - high), down * (low - lowest)) / GRAIN - 1e-6)
        if most < 1 or (found and bottom != low) or len(_tilts(case, value(most)).misses(trials.lost)):
            continue
        step = least(lambda at, value=value: _tilts(case, value(at)), most, trials)  # type: ignore[misc]
        if step is not None:
            found.append((step.steps, value(step.steps), None if step.beyond is None else value(step.beyond)))
    if not found:
        return none("tilt_range", (low, high), 0, "no range was found that serves all samples", len(trials.lost))
    _, asked, beyond = min(found, key=lambda each: each[0])
    return Change("tilt_range", (low, high), asked, True, 0, len(trials.lost), trials.count, beyond, None,
                  f"tilts from {asked[0]:g} to {asked[1]:g} deg in the search instead of {low:g} to {high:g} deg",
                  {"tilt": (math.radians(asked[0]), math.radians(asked[1]))})  # fmt: skip


def _tilts(case: Case, degrees: tuple[float, float]) -> Case:
    postures = case.ready.conditions.postures
    return _within(case, postures=replace(postures, tilt=(math.radians(degrees[0]), math.radians(degrees[1]))))


def _within(case: Case, **changes: Any) -> Case:
    ready = case.ready
    return replace(case, ready=replace(ready, conditions=replace(ready.conditions, **changes)))


def _degrees(angle: float) -> float:
    # Rounded to what a person typed: 30, not 29.999999999999996.
    return round(math.degrees(angle), 6)
