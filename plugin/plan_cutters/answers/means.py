"""What a step may change, each with a value that gains nearly all that the thing can gain and asks for no more than that.

Values are those of a shop: whole steps of length and angle, sides of the part, radii that are sold. They are compared on a few of
the samples that are lost; `steps` judges what is told.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from plan_cutters.answers.areas import Finished
from plan_cutters.answers.option import Axis
from plan_cutters.answers.other_cutter import CORNERS, SLIMMEST, THINNEST, highest, longer, made_of, thinner
from plan_cutters.answers.other_place import FINER, angle, closer, directions, flip_of
from plan_cutters.answers.state import Judgements, State
from plan_cutters.answers.trial import Case, Trials
from plan_cutters.domain.change import Move
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.holder import Holder, Stage
from plan_cutters.domain.machine import Machine
from plan_cutters.domain.shapes import modes
from plan_cutters.options import LEAST_TOLERANCE

Rows = NDArray[np.int64]

#: Samples on which values are compared, at most.
_FEW = 192
#: Shares of what the most would gain, with which less is content.
_NEARLY, _HALF = 0.95, 0.5
#: A direction along the part's own axes is taken where another one gains no more than this share more.
_OWN = 0.1
#: Radii that are tried for the rest: those sold, mm, and down to this share of the present one.
_RADII = (
    0.1, 0.2, 0.25, 0.3, 0.4, 0.5, 0.75, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.5, 16.0, 20.0, 25.0, 31.5, 40.0,
          50.0)  # fmt: skip
_THINNER = 0.1
#: Shares of its radius to which a holder is slimmed.
_SLIM = (0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1, 0.0)
#: Steps of a limit of the axis, deg.
_TURN = 5.0
#: Other given cutters that are looked at for the rest, at most.
_GIVEN = 4


@dataclass(frozen=True, slots=True, eq=False)
class Candidate:
    """A step that may be worth judging.

    Attributes
    ----------
    moves : tuple of Move
    state : State
        After it.
    estimate : float
        Share of the finished area that it may leave.
    nested : bool
        Whether it surely reaches all that is reached now.
    """

    moves: tuple[Move, ...]
    state: State
    estimate: float
    nested: bool


@dataclass(frozen=True, slots=True, eq=False)
class Scan:
    """What is lost now, and some of it.

    state : State
    left : (m,) int64
        Samples that it leaves.
    few : int64
        Some of them.
    finished : Finished
    known : Judgements
    given : tuple of Cutter
        All that the plan judged.
    """

    state: State
    left: Rows
    few: Rows
    finished: Finished
    known: Judgements
    given: tuple[Cutter, ...]

    @classmethod
    def of(
        cls, state: State, left: Rows, finished: Finished, known: Judgements, given: tuple[Cutter, ...]
    ) -> "Scan":  # fmt: skip
        """With every so-manieth of the samples that are left."""
        return cls(state, left, _spread(left), finished, known, given)

    def estimate(self, missed: Rows) -> float:
        """The share of the area that is left, if of the few these are."""
        whole = float(self.finished.area[self.few].sum())
        part = float(self.finished.area[missed].sum()) / whole if whole > 0.0 else len(missed) / max(1, len(self.few))
        return part * self.finished.of_rows(self.left)

    def found(self, move: Move, state: State, missed: Rows, *, nested: bool) -> Candidate:
        """A candidate by what it misses of the few."""
        return Candidate((move,), state, self.estimate(missed), nested)

    def least(
        self, make: Callable[[int], State | None], most: int, shares: Sequence[float] = (_NEARLY,)
    ) -> Iterator[tuple[int, State, Rows]]:  # fmt: skip
        """Of values 0 to `most`, each of which reaches what those before it reach, the least that gains shares of what the most
        gains: its number, its state, and what it misses of the few."""
        while most >= 0 and (end := make(most)) is None:
            most -= 1
        if most < 0 or end is None:
            return
        missed = self.known.glance(end, self.few)
        gained = np.setdiff1d(self.few, missed, assume_unique=True)
        if not len(gained):
            return
        told = set()
        for share in shares:
            low, high, still = -1, most, gained[:0]
            while high - low > 1:
                middle = (low + high) // 2
                state = make(middle)
                lost = gained if state is None else self.known.glance(state, gained)
                if len(lost) <= (1.0 - share) * len(gained):
                    high, still = middle, lost
                else:
                    low = middle
            made = make(high)
            if high not in told and made is not None:
                told.add(high)
                yield high, made, np.union1d(missed, still)


def candidates(scan: Scan) -> list[Candidate]:
    """Steps that gain something of a few samples, those that may leave least first."""
    found: list[Candidate] = []
    for each in (_tolerance, _tilt_range, _stick_out, _given, _corner, _radius, _holder, _axis):
        found += each(scan)
    return sorted(found, key=lambda candidate: candidate.estimate)


def _spread(rows: Rows, most: int = _FEW) -> Rows:
    return rows[:: 1 + (len(rows) - 1) // most] if len(rows) else rows


def _with_first(state: State, cutter: Cutter | None) -> State | None:
    return None if cutter is None else replace(state, cutters=(cutter, *state.cutters[1:]))


def _stick_out(scan: Scan) -> Iterator[Candidate]:
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

    for at, state, missed in scan.least(make, most, (_NEARLY, _HALF)):
        words = f"a stick-out of {value(at):g} mm instead of {cutter.length:g} mm"
        yield scan.found(Move("stick_out", cutter.length, value(at), words), state, missed, nested=False)


def _holder(scan: Scan) -> Iterator[Candidate]:
    cutter = scan.state.cutters[0]
    if cutter.holder is None:
        return
    stages, below = cutter.holder.stages, cutter.stages
    least = max((s.upper_radius for part, _, s in below if part != "holder"), default=cutter.radius)
    least = max(least, cutter.radius)
    now = max(max(s.radius, s.upper_radius) for s in stages)

    def slim(radius: float, share: float) -> float:
        return max(min(radius, least), round(share * radius, 1))

    def holder(at: int) -> Holder:
        share = _SLIM[at]
        return Holder(tuple(Stage(slim(s.radius, share), s.length, slim(s.upper_radius, share)) for s in stages))

    def make(at: int) -> State | None:
        return _with_first(scan.state, made_of(cutter, holder=holder(at)))

    for at, state, missed in scan.least(make, len(_SLIM) - 1):
        asked = max(max(s.radius, s.upper_radius) for s in holder(at).stages)
        if asked < now:
            words = f"a slimmer holder, {holder(at).id} instead of {cutter.holder.id}"
            yield scan.found(Move("holder", cutter.holder.id, holder(at).id, words), state, missed, nested=True)


def _given(scan: Scan) -> Iterator[Candidate]:
    """Other given cutters for the rest: the one that leaves least, and the most wanted that leaves hardly more."""
    base, left, known = scan.state, scan.left, scan.known
    others = [cutter for cutter in scan.given if cutter not in base.cutters]
    rows = scan.few
    if len(others) > _GIVEN:
        # Those that leave least by what is known already.
        alone = [replace(base, cutters=(cutter,), ready=base.ready) for cutter in others]
        count = [len(known.glance(state, rows[:32])) for state in alone]
        order = sorted(range(len(others)), key=lambda k: (count[k], k))[:_GIVEN]
        others = [others[k] for k in sorted(order)]
    tried = []
    for cutter in others:
        state = replace(base, cutters=(*base.cutters, cutter))
        tried.append((len(missed := known.glance(state, rows)), cutter, state, missed))
    tried = [each for each in tried if each[0] < len(rows)]
    if not tried:
        return
    least = min(each[0] for each in tried)
    content = len(rows) - _NEARLY * (len(rows) - least)
    best = next(each for each in tried if each[0] == least)
    nearly = next(each for each in tried if each[0] <= content)
    for _, cutter, state, missed in {id(each): each for each in (nearly, best)}.values():
        move = Move("cutter", None, cutter.id, f"{cutter.id} for the rest")
        yield scan.found(move, state, missed, nested=True)
    del left


def _radius(scan: Scan) -> Iterator[Candidate]:
    """A smaller cutter of the same kind for the rest."""
    cutter, conditions = scan.state.cutters[0], scan.state.ready.conditions
    if cutter.shape == "form":
        return
    least = max(THINNEST * conditions.tolerance, SLIMMEST * cutter.length, _THINNER * cutter.radius)
    radii = [r for r in reversed(_RADII) if least <= r < cutter.radius]

    def make(at: int) -> State | None:
        made = thinner(cutter, radii[at])
        usable = made is not None and conditions.judges(made)
        return replace(scan.state, cutters=(*scan.state.cutters, made)) if usable and made is not None else None

    for _, state, missed in scan.least(make, len(radii) - 1):
        made = state.cutters[-1]
        if made not in scan.given:
            move = Move("radius", cutter.radius, made.radius, f"{head(made)} for the rest")
            yield scan.found(move, state, missed, nested=True)


def _corner(scan: Scan) -> Iterator[Candidate]:
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
            tried.append((len(scan.known.glance(state, few)), abs(corner - cutter.corner_radius), state))
    tried = [each for each in tried if each[0] < len(few)]
    if tried:
        _, _, state = min(tried, key=lambda each: each[:2])
        made = state.cutters[-1]
        move = Move("corner_radius", cutter.corner_radius, made.corner_radius, f"{head(made)} for the rest")
        yield scan.found(move, state, scan.known.glance(state, scan.few), nested=True)


def _tolerance(scan: Scan) -> Iterator[Candidate]:
    """A finer tolerance, where samples are undecided."""
    ready, cutter = scan.state.ready, scan.state.cutters[0]
    few = scan.few[:: max(1, len(scan.few) // 32)]
    if not len(few) or (Case(ready, cutter).look(few).verdict == 0).all():
        return
    now = ready.scene.asked
    asked = float(f"{now * FINER[0]:.6g}")
    if asked < LEAST_TOLERANCE:
        return
    state = replace(scan.state, ready=closer(Case(ready, cutter), asked).ready)
    missed = scan.known.glance(state, scan.few)
    if len(missed) < len(scan.few):
        words = f"a tolerance of {asked:g} mm instead of {now:g} mm"
        yield scan.found(Move("tolerance", now, asked, words), state, missed, nested=False)


def _tilt_range(scan: Scan) -> Iterator[Candidate]:
    """All tilts at which the cutter touches."""
    ready = scan.state.ready
    low, high = (round(math.degrees(tilt), 6) for tilt in ready.conditions.postures.tilt)
    touching = modes(scan.state.cutters[0])
    lowest = min(low, float(math.floor(math.degrees(min(mode.low for mode in touching)) + 1e-6)))
    highest_tilt = max(high, min(180.0, float(math.ceil(math.degrees(max(mode.high for mode in touching)) - 1e-6))))
    if (lowest, highest_tilt) == (low, high):
        return
    asked = (lowest, highest_tilt)
    postures = replace(ready.conditions.postures, tilt=(math.radians(lowest), math.radians(highest_tilt)))
    state = _under(scan.state, replace(ready.conditions, postures=postures))
    missed = scan.known.glance(state, scan.few)
    if len(missed) < len(scan.few):
        words = f"tilts from {lowest:g} to {highest_tilt:g} deg in the search instead of {low:g} to {high:g} deg"
        yield scan.found(Move("tilt_range", (low, high), asked, words), state, missed, nested=True)


def _axis(scan: Scan) -> Iterator[Candidate]:
    """A machine that tilts further, a second setup, another setup: for what is reached without any limit."""
    state, known = scan.state, scan.known
    conditions = state.ready.conditions
    machine = conditions.machine
    if not machine.limited:
        return
    free = _under(state, replace(conditions, machine=Machine()))
    gained = np.setdiff1d(scan.few, known.glance(free, scan.few), assume_unique=True)
    if not len(gained):
        return
    now = None if machine.turns or machine.tilt_limit is None else round(math.degrees(machine.tilt_limit), 6)
    first = math.floor((now or 0.0) / _TURN + 1e-9) + 1
    most = round(180.0 / _TURN) - first

    def limit(at: int) -> State:
        return _under(state, replace(conditions, machine=Machine.parse(f"tilt:{(first + at) * _TURN:g}")))

    for at, made, missed in scan.least(limit, most):
        asked = (first + at) * _TURN
        instead = f"every way instead of {machine.name}" if now is None else f"instead of {now:g} deg"
        move = Move("tilt_limit", now, asked, f"a machine that tilts by {asked:g} deg {instead}")
        yield scan.found(move, made, missed, nested=now is not None)
    yield from _setups(scan, gained)


def _setups(scan: Scan, gained: Rows) -> Iterator[Candidate]:
    state, known, ready = scan.state, scan.known, scan.state.ready
    blocked = np.setdiff1d(scan.few, gained, assume_unique=True)
    kept = np.setdiff1d(np.flatnonzero(scan.finished.wanted), scan.left, assume_unique=True)
    axes = [
        axis for axis in directions(ready, Trials(scan.left, kept)) if all(angle(axis, own) > 1.0 for own in state.axes)
    ]
    now = state.axes[0]
    second = []
    for axis in axes:
        made = replace(state, setups=(*state.setups, (axis, None)))
        missed = known.glance(made, gained)
        second.append((len(missed), angle(now, axis), axis, made, missed))
    best = _plain(second, len(gained))
    if best is not None:
        _, _, axis, made, missed = best
        move = Move(
            "second_setup", now, axis, f"{_clamped(now, axis)} as a {_ORDER.get(len(made.setups), 'further')} setup"
        )
        yield scan.found(move, made, np.union1d(blocked, missed), nested=True)
    if len(state.setups) > 1:
        return
    some = _spread(kept)
    other = []
    for lost, _, axis, _, missed in second:
        if lost < len(gained) and flip_of(ready, axis) == ready.options.flip:
            made = replace(state, setups=((axis, None),))
            worse = known.glance(made, some)
            share = scan.finished.of_rows(kept) * len(worse) / max(1, len(some))
            other.append((scan.estimate(np.union1d(blocked, missed)) + share, angle(now, axis), axis, made))
    if other:
        estimate, _, axis, made = min(other, key=lambda each: (round(each[0], 3), each[1]))
        if estimate < scan.finished.of_rows(scan.left):
            move = Move("setup", now, axis, f"{_clamped(now, axis)} instead")
            yield Candidate((move,), made, estimate, nested=False)


_ORDER = {2: "second", 3: "third", 4: "fourth"}


def _plain(
    second: list[tuple[int, float, Axis, State, Rows]], count: int
) -> tuple[int, float, Axis, State, Rows] | None:  # fmt: skip
    """Of setups the nearest of those that miss least; one along the part's own axes, where that gains nearly as much."""
    gaining = [each for each in second if each[0] < count]
    if not gaining:
        return None
    best = min(gaining, key=lambda each: each[:2])
    own = [each for each in gaining if sorted(map(abs, each[2])) == [0.0, 0.0, 1.0]]
    plain = min(own, key=lambda each: each[:2], default=best)
    return plain if count - plain[0] >= (1.0 - _OWN) * (count - best[0]) else best


def _clamped(now: Axis, axis: Axis) -> str:
    words = ",".join(f"{each:.4g}" for each in axis)
    return f"turned over (setup {words})" if angle(now, axis) > 179.0 else f"clamped with {words} along the spindle"


def _under(state: State, conditions: object) -> State:
    return replace(state, ready=replace(state.ready, conditions=conditions))  # type: ignore[arg-type]


def head(cutter: Cutter) -> str:
    """A cutter without its holder, which is that of the present one."""
    return cutter.id.partition("H")[0]


def _round_down(length: float) -> float:
    """1, 2 or 5 times a power of ten, no more than a length.

    >>> _round_down(6.0), _round_down(0.9), _round_down(24.0)
    (5.0, 0.5, 20.0)
    """
    power = 10.0 ** math.floor(math.log10(length) + 1e-9)
    return float(max(k * power for k in (1.0, 2.0, 5.0) if k * power <= length * (1.0 + 1e-9)))
