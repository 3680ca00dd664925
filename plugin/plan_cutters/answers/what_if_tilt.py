"""Wider ranges of tilt may serve: those that are searched, and those of the machine (Lemma W2 of `docs/what_if_proof.md`)."""

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from plan_cutters.answers.trial import Case, Trials
from plan_cutters.answers.what_if import Way, WhatIf, none
from plan_cutters.domain.change import Change
from plan_cutters.domain.machine import Machine
from plan_cutters.domain.shapes import modes
from plan_cutters.plan_file.numbers import angle
from plan_cutters.plan_file.words import change_text

#: Steps of tilts, deg.
GRAIN = 0.1

Range = tuple[float, float]


def tilt_limit(case: Case, trials: Trials) -> WhatIf | Change:
    """Try the least limit of the axis, to `GRAIN`; for a machine whose rotary axes limit it, one that tilts every way."""
    machine = case.ready.conditions.machine
    if not machine.limited:
        return none("tilt_limit", None, len(trials.not_reached), "the machine has no limit")
    now = None if machine.turns or machine.tilt_limit is None else _degrees(machine.tilt_limit)
    base = math.floor((now or 0.0) / GRAIN + 1e-6)
    most = math.ceil(180.0 / GRAIN) - base
    way = Way(most, lambda at: min(180.0, round((base + at) * GRAIN, 6)) if at else now or 0.0)
    return WhatIf(
        now=now,
        ways=[way],
        ends=[_within(case, machine=Machine())],
        nested=True,
        make=lambda limit: _within(case, machine=Machine.parse(f"tilt:{limit:.6g}")),
        reads=lambda _: 180.0,
        fails=lambda _, rest: f"without any limit {rest.words}" if rest.count else "no limit was found that serves all samples",
        serves=lambda requested, made: (
            change_text.tilt_limit(requested, now, machine.name),
            {"machine": made.ready.conditions.machine},
        ),
    )


def tilt_range(case: Case, trials: Trials) -> WhatIf | Change:
    """Try a wider range of tilts to search: one end of it as far as is needed, or both; to `GRAIN`."""
    low, high = (_degrees(tilt) for tilt in case.ready.conditions.postures.tilt)
    touching = modes(case.cutter)
    lowest = min(low, round(math.floor(_degrees(min(mode.low for mode in touching)) / GRAIN) * GRAIN, 6))
    highest = max(high, min(180.0, round(math.ceil(_degrees(max(mode.high for mode in touching)) / GRAIN) * GRAIN, 6)))
    if (lowest, highest) == (low, high):
        why = "the cutter touches at no tilt beyond the range searched"
        return none("tilt_range", (low, high), len(trials.not_reached), why)

    def make(degrees: Range) -> Case:
        tilt = math.radians(degrees[0]), math.radians(degrees[1])
        return _within(case, postures=replace(case.ready.conditions.postures, tilt=tilt))

    def ways() -> Iterator[Way]:
        # The end that is fixed, or if neither end alone serves, the lower one as low as can be.
        for bottom, down, up, both in ((low, 0, 1, False), (low, 1, 0, False), (lowest, 0, 1, True)):

            def value(at: int, bottom: float = bottom, down: int = down, up: int = up) -> Range:
                return max(lowest, round(bottom - down * at * GRAIN, 6)), min(highest, round(high + up * at * GRAIN, 6))

            most = math.ceil(max(up * (highest - high), down * (low - lowest)) / GRAIN - 1e-6)
            if most >= 1 and (both or not len(make(value(most)).misses(trials.not_reached))):
                yield Way(most, value, last_resort=both)

    return WhatIf(
        now=(low, high), ways=ways(), make=make, ends=[make((lowest, highest))], nested=True,
        reads=lambda _: (lowest, highest),
        fails=lambda _, rest: f"at all tilts from {angle(lowest)} to {angle(highest)} {rest.words}" if rest.count else
        "no range was found that serves all samples",
        serves=lambda requested, made: (
            change_text.tilt_range(requested, (low, high)), {"tilt": made.ready.conditions.postures.tilt}),
    )  # fmt: skip


def _within(case: Case, **changes: Any) -> Case:
    return replace(case, ready=case.ready.under(**changes))


def _degrees(angle: float) -> float:
    # Rounded to what a person typed: 30, not 29.999999999999996.
    return round(math.degrees(angle), 6)
