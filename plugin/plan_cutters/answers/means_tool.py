"""Steps that change the tool: how it is held, and what other cutter does the rest."""

import math
from collections.abc import Iterator
from dataclasses import replace

from plan_cutters.answers.scan import HALF, NEARLY, Candidate, Scan
from plan_cutters.answers.state import State
from plan_cutters.answers.what_if_cutter import CORNERS, THINNEST, highest, longer, made_of, thinner
from plan_cutters.domain.change import Move
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.holder import Holder, Segment
from plan_cutters.plan_file.words import change_text

#: Radii that are tried for the rest: those sold, mm, and down to this share of the present one.
_RADII = (
    0.1, 0.2, 0.25, 0.3, 0.4, 0.5, 0.75, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.5, 16.0, 20.0, 25.0, 31.5, 40.0,
          50.0)  # fmt: skip
_THINNER = 0.1
#: Of their length they are no less: 15 diameters are as much as is sold.
_SLENDER = 1.0 / 30.0
#: Shares of its radius to which a holder is slimmed.
_SLIM = (0.9, 0.8, 0.7, 0.6, 0.5, 0.4)
#: What a holder is thicker than what it holds, at least, mm.
_WALL = 2.0
#: Other given cutters that are looked at for the rest, at most.
_MOST_CUTTERS = 4


def stick_out(scan: Scan) -> Iterator[Candidate]:
    cutter = scan.state.cutters[0]
    if cutter.holder is None:
        return
    grain = _round_down(2.0 * cutter.radius)
    first = math.floor(cutter.length / grain + 1e-9) + 1
    most = math.ceil(highest(scan.state.ready, cutter) / grain) - first

    def value(at: int) -> float:
        return round((first + at) * grain, 6)

    def make(at: int) -> State | None:
        return _with_first(scan.state, longer(cutter, value(at)))

    for at, state, missed in scan.least(make, most, (NEARLY, HALF)):
        words = change_text.stick_out(value(at), cutter)
        yield scan.found(Move("stick_out", cutter.length, value(at), words), state, missed, nested=False)


def holder(scan: Scan) -> Iterator[Candidate]:
    cutter = scan.state.cutters[0]
    if cutter.holder is None:
        return
    stages, below = cutter.holder.stages, cutter.stages
    least = max((s.upper_radius for part, _, s in below if part != "holder"), default=cutter.radius)
    least = max(least, cutter.radius) + _WALL
    now = max(max(s.radius, s.upper_radius) for s in stages)

    def slim(radius: float, share: float) -> float:
        return max(min(radius, least), round(share * radius, 1))

    def slimmed(at: int) -> Holder:
        share = _SLIM[at]
        return Holder(tuple(Segment(slim(s.radius, share), s.length, slim(s.upper_radius, share)) for s in stages))

    def make(at: int) -> State | None:
        return _with_first(scan.state, made_of(cutter, holder=slimmed(at)))

    for at, state, missed in scan.least(make, len(_SLIM) - 1):
        tried = max(max(s.radius, s.upper_radius) for s in slimmed(at).stages)
        if tried < now:
            words = change_text.holder(slimmed(at), cutter)
            yield scan.found(Move("holder", cutter.holder.id, slimmed(at).id, words), state, missed, nested=True)


def other_cutters(scan: Scan) -> Iterator[Candidate]:
    """Other given cutters for the rest: the one that leaves least, and the most wanted that leaves hardly more."""
    base, known = scan.state, scan.known
    others = [cutter for cutter in scan.given if cutter not in base.cutters]
    rows = scan.few
    if len(others) > _MOST_CUTTERS:
        # Those that leave least by what is known already.
        alone = [replace(base, cutters=(cutter,), ready=base.ready) for cutter in others]
        estimates = [scan.estimate(known.glance(state, rows[:32])) for state in alone]
        order = sorted(range(len(others)), key=lambda k: (estimates[k], k))[:_MOST_CUTTERS]
        others = [others[k] for k in sorted(order)]
    tried = []
    for cutter in others:
        state = replace(base, cutters=(*base.cutters, cutter))
        tried.append((scan.estimate(missed := known.glance(state, rows)), cutter, state, missed))
    whole = scan.estimate(rows)
    tried = [each for each in tried if each[0] < whole]
    if not tried:
        return
    least = min(each[0] for each in tried)
    content = whole - NEARLY * (whole - least)
    best = next(each for each in tried if each[0] == least)
    nearly = next(each for each in tried if each[0] <= content)
    for _, cutter, state, missed in {id(each): each for each in (nearly, best)}.values():
        move = Move("cutter", None, cutter.id, change_text.rest(cutter.id))
        yield scan.found(move, state, missed, nested=True)


def radius(scan: Scan) -> Iterator[Candidate]:
    """A smaller cutter of the same kind for the rest."""
    cutter, conditions = scan.state.cutters[0], scan.state.ready.conditions
    if cutter.shape == "form":
        return
    least = max(THINNEST * conditions.tolerance, _SLENDER * cutter.length, _THINNER * cutter.radius)
    radii = [r for r in reversed(_RADII) if least <= r < cutter.radius]

    def make(at: int) -> State | None:
        made = thinner(cutter, radii[at])
        usable = made is not None and conditions.judges(made)
        return replace(scan.state, cutters=(*scan.state.cutters, made)) if usable and made is not None else None

    for _, state, missed in scan.least(make, len(radii) - 1):
        made = state.cutters[-1]
        if made not in scan.given:
            move = Move("radius", cutter.radius, made.radius, change_text.rest(change_text.head(made)))
            yield scan.found(move, state, missed, nested=True)


def corner(scan: Scan) -> Iterator[Candidate]:
    """Another corner on the same for the rest."""
    cutter = scan.state.cutters[0]
    if cutter.shape != "end":
        return
    r, few = cutter.radius, scan.few[:: max(1, len(scan.few) // 64)]
    middle = max((c for c in CORNERS if c <= 0.25 * r), default=0.0)
    tried = []
    for corner in dict.fromkeys((0.0, middle, r)):
        made = None if corner == cutter.corner_radius else made_of(cutter, corner_radius=corner)
        if made is not None and made not in scan.given:
            state = replace(scan.state, cutters=(*scan.state.cutters, made))
            estimate = scan.estimate(scan.known.glance(state, few))
            tried.append((estimate, abs(corner - cutter.corner_radius), state))
    tried = [each for each in tried if each[0] < scan.estimate(few)]
    if tried:
        _, _, state = min(tried, key=lambda each: each[:2])
        made = state.cutters[-1]
        move = Move("corner_radius", cutter.corner_radius, made.corner_radius, change_text.rest(change_text.head(made)))
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
