"""Steps that change the tool: how it is held, and what other cutter does the rest."""

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from plan_cutters.answers.scan import HALF, NEARLY, Candidate, Rows, Scan
from plan_cutters.answers.state import State
from plan_cutters.domain.change import Move
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.holder import Holder
from plan_cutters.domain.preference import group_of
from plan_cutters.domain.shapes import SAME, flute_length
from plan_cutters.domain.standard_holders import NOSES, chuck
from plan_cutters.domain.standard_tools import MOST, USUAL, corners, is_standard, smaller
from plan_cutters.errors import CutterError
from plan_cutters.plan_file.words import answers as next_steps
from plan_cutters.scene.preparation import Prepared

#: Samples on which the cutters that are sold are compared, at most about so many.
_LOOKED_AT = 48
#: Every so-manieth of these comes first; a size that gains this share there of what the best one gains is looked at on all.
_FIRST_OF, _MAY_DO = 4, 0.7
#: Other given cutters that are looked at for the rest, at most.
_MOST_CUTTERS = 4
#: Groups of cutters without a round tip.
_SHARP = ("flat", "last")


def stick_out(scan: Scan) -> Iterator[Candidate]:
    """A longer stick-out: the least that gains nearly all that a usual one gains, and so of the longest that are still in use."""
    cutter = scan.state.cutters[0]
    if cutter.holder is None:
        return
    grain = _round_down(2.0 * cutter.radius)
    first = math.floor(cutter.length / grain + 1e-9) + 1
    high = highest(scan.state.ready, cutter)

    def value(at: int) -> float:
        return round((first + at) * grain, 6)

    def make(at: int) -> State | None:
        return _with_first(scan.state, longer(cutter, value(at)))

    seen = set[int]()
    for ratio in (USUAL, MOST):
        most = math.floor(min(high + grain, ratio * 2.0 * cutter.radius) / grain + 1e-9) - first
        for at, state, missed in scan.least(make, most, (NEARLY, HALF)):
            if at not in seen:
                seen.add(at)
                words = next_steps.stick_out(value(at), cutter)
                yield scan.found(Move("stick_out", cutter.length, value(at), words), state, missed, nested=False)


def highest(ready: Prepared, cutter: Cutter) -> float:
    """Give a stick-out with which the nose is above all obstacles wherever the cutter touches them, mm."""
    size = max(float(np.linalg.norm(np.ptp(conditions.obstacles.corners, axis=0))) for conditions in ready.setups)
    return size + 2.0 * cutter.radius + flute_length(cutter) + (cutter.clearance or 0.0)


def longer(cutter: Cutter, length: float) -> Cutter | None:
    """Make the same with its nose so far from the tip; what is right below it goes on, and it cuts no higher up than it does."""
    ends = {} if cutter.shape in ("lollipop", "form") else {"flutes": flute_length(cutter)}
    return made_of(cutter, length=length, **ends)


def made_of(cutter: Cutter, **changes: object) -> Cutter | None:
    try:
        return replace(cutter, **changes)  # type: ignore[arg-type]
    except CutterError:
        return None


def holder(scan: Scan) -> Iterator[Candidate]:
    """A slimmer holder of the table that takes the shank, as long as the present one."""
    cutter = scan.state.cutters[0]
    if cutter.holder is None:
        return
    slimmer = [held for each in _chucks(cutter.holder) if (held := made_of(cutter, holder=each)) is not None]

    def make(at: int) -> State | None:
        return _with_first(scan.state, slimmer[at])

    for at, state, missed in scan.least(make, len(slimmer) - 1):
        other = slimmer[at].holder
        if other is not None:
            move = Move("holder", cutter.holder.id, other.id, next_steps.holder(other, cutter))
            yield scan.found(move, state, missed, nested=False)


def _chucks(now: Holder) -> list[Holder]:
    """Collet chucks of the table that are slimmer at the nose than a holder, the widest first, on its taper if it has one."""
    name = now.name.lower()
    taper, nose, length = name.rpartition("er") if _is_chuck(name) else ("", "", "")
    _, times, mm = length.partition("x")
    long = f"x{mm}" if times else "" if nose else f"x{sum(stage.length for stage in now.stages):.10g}"
    slimmer = []
    for word in NOSES:
        try:
            made = Holder.parse(f"{taper}{word}{long}")
        except CutterError:
            continue
        if made.stages[0].radius < now.stages[0].radius - SAME:
            slimmer.append(made)
    return slimmer[::-1]


def _is_chuck(name: str) -> bool:
    """Whether a name is the word of a holder of the table."""
    try:
        return chuck(name) is not None
    except CutterError:
        return False


def other_cutters(scan: Scan) -> Iterator[Candidate]:
    """Other given cutters for the rest: the one that leaves least, and the most wanted that leaves hardly more.

    What comes last (engraving, chamfer and form cutters) is looked at beside those that come first: it has to leave less.
    """
    base = scan.state
    others = [each for each in scan.given if each not in base.cutters and of_a_kind(scan, base.cutters[0], each)]
    whole = scan.estimate(scan.few)
    first = _tried(scan, [each for each in others if group_of(each) != "last"], whole)
    least = min((each[0] for each in first), default=whole)
    tried = [*first, *_tried(scan, [each for each in others if group_of(each) == "last"], least)]
    if not tried:
        return
    least = min(each[0] for each in tried)
    content = whole - NEARLY * (whole - least)
    best = next(each for each in tried if each[0] == least)
    nearly = next(each for each in tried if each[0] <= content)
    for _, state, missed in {id(each): each for each in (nearly, best)}.values():
        cutter = state.cutters[-1]
        move = Move("cutter", None, cutter.id, next_steps.rest(cutter.id))
        yield scan.found(move, state, missed, nested=True)


def _tried(scan: Scan, others: list[Cutter], less_than: float) -> list[tuple[float, State, Rows]]:
    """What some other cutters, the likeliest, leave beside the present ones, of those that leave less than a share."""
    base, known, rows = scan.state, scan.known, scan.few
    if len(others) > _MOST_CUTTERS:
        # Those that leave least by what is known already.
        alone = [replace(base, cutters=(cutter,), ready=base.ready) for cutter in others]
        estimates = [scan.estimate(known.glance(state, rows[:32])) for state in alone]
        order = sorted(range(len(others)), key=lambda k: (estimates[k], k))[:_MOST_CUTTERS]
        others = [others[k] for k in sorted(order)]
    tried = []
    for cutter in others:
        state = replace(base, cutters=(*base.cutters, cutter))
        tried.append((scan.estimate(missed := known.glance(state, rows)), state, missed))
    return [each for each in tried if each[0] < less_than]


def of_a_kind(scan: Scan, cutter: Cutter, other: Cutter) -> bool:
    """Whether another cutter may do the rest of one: on free-form faces no sharp end comes after a round one."""
    return not scan.sculptured or group_of(cutter) in _SHARP or group_of(other) not in _SHARP


def radius(scan: Scan) -> Iterator[Candidate]:
    """A thinner cutter of the same kind that is sold, for the rest: with a usual stick-out, and with the longest that is in use.

    A thinner one has a shorter stick-out, and does not reach all that a thicker one reaches: so each size is looked at on a few
    samples, and those that may leave least on more.
    """
    cutter, known, rows = scan.state.cutters[0], scan.known, scan.few[:: max(1, len(scan.few) // _LOOKED_AT)]
    whole, content = scan.estimate(rows), math.inf
    for ratio in (USUAL, MOST):
        states = [
            replace(scan.state, cutters=(*scan.state.cutters, made))
            for made in smaller(cutter, ratio)
            if made not in scan.given and scan.state.ready.conditions.judges(made)
        ]
        some = rows[::_FIRST_OF]
        gains = [scan.estimate(some) - scan.estimate(known.glance(state, some)) for state in states]
        tried = [
            (scan.estimate(known.glance(state, rows)), state)
            for state, gain in zip(states, gains, strict=True)
            if gain >= _MAY_DO * max(gains)
        ]
        least = min((each[0] for each in tried), default=whole)
        if least >= min(whole, content):
            continue
        content = whole - NEARLY * (whole - least)
        # The thickest that leaves hardly more: they come by size.
        state = next(state for estimate, state in tried if estimate <= content)
        made = state.cutters[-1]
        move = Move("radius", cutter.radius, made.radius, f"{next_steps.tool(made)}, for the rest")
        yield scan.found(move, state, known.glance(state, scan.few), nested=True)


def corner(scan: Scan) -> Iterator[Candidate]:
    """Another corner on the same for the rest: a bull nose stays one, and a flat end may have a rounder one."""
    cutter = scan.state.cutters[0]
    r, now, few = cutter.radius, cutter.corner_radius, scan.few[:: max(1, len(scan.few) // _LOOKED_AT)]
    if cutter.shape != "end" or now == r or not is_standard(cutter):
        return
    usual = [c for c in corners(cutter) if c < r]
    wanted = {max((c for c in usual if c <= 0.25 * r), default=now)}
    wanted |= {max((c for c in usual if c < now), default=now)} if now else {r}
    tried = []
    for corner in sorted(wanted - {now}):
        made = made_of(cutter, corner_radius=corner)
        if made is not None and made not in scan.given:
            state = replace(scan.state, cutters=(*scan.state.cutters, made))
            estimate = scan.estimate(scan.known.glance(state, few))
            tried.append((estimate, abs(corner - now), state))
    tried = [each for each in tried if each[0] < scan.estimate(few)]
    if tried:
        _, _, state = min(tried, key=lambda each: each[:2])
        made = state.cutters[-1]
        move = Move("corner_radius", now, made.corner_radius, f"{next_steps.tool(made)}, for the rest")
        yield scan.found(move, state, scan.known.glance(state, scan.few), nested=True)


def _with_first(state: State, cutter: Cutter | None) -> State | None:
    return None if cutter is None else replace(state, cutters=(cutter, *state.cutters[1:]))


def _round_down(length: float) -> float:
    """1, 2 or 5 times a power of ten, no more than a length.

    >>> _round_down(6.0), _round_down(0.9), _round_down(24.0)
    (5.0, 0.5, 20.0)
    """
    power = 10.0 ** math.floor(math.log10(length) + 1e-9)
    return float(max(k * power for k in (1.0, 2.0, 5.0) if k * power <= length * (1.0 + 1e-9)))
