"""Find the changes for a step, each with the smallest value that gains nearly all that such a change can gain.

Changes are of how closely is judged, which tilts are searched, how the part is clamped, what the machine tilts; how the tool is
held, and what other cutter does the rest. Values are those of a shop: whole steps of length and angle, sides of the part, radii
that are sold. They are compared on a few of the samples that are not reached; `steps` judges each step before it is reported.
"""

import math
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from functools import cache
from itertools import product

import numpy as np

from cad_io.arrays import Floats, Ints
from plan_cutters.answers.state import HALF, NEARLY, Candidate, Case, Rows, Scan, SetupOf, State, move_of, spread, under
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.holder import NOSES, Holder, chuck
from plan_cutters.domain.machine import Machine
from plan_cutters.domain.preference import group_of
from plan_cutters.domain.shapes import SAME, flute_length, modes
from plan_cutters.domain.standard_tools import MOST, USUAL, Fit, corners, is_standard, smaller
from plan_cutters.domain.verdicts import UNDECIDED
from plan_cutters.errors import CutterError
from plan_cutters.judging.limits import within_limits
from plan_cutters.option_table import LEAST_TOLERANCE
from plan_cutters.plan_file.words import answers as next_steps
from plan_cutters.scene.inside_material import inside_bodies, inside_material
from plan_cutters.scene.preparation import Axis, Prepared, conditions_of, with_setups
from plan_cutters.scene.work import Budget

#: A direction along the part's own axes is taken where another one gains no more than this share more.
_OWN = 0.1
#: Steps of a limit of the axis, deg.
_TURN = 5.0
#: The most that machines tilt, deg: what asks for more is for another setup.
_MOST = 120.0
#: Share of the samples not reached that must be undecided for a finer tolerance to be worth its triangles.
_UNSURE = 0.1
#: Share of the tolerance that is tried: the triangles grow in number as it falls.
_FINER = 0.5
#: Triangles beside which none are made anew for a finer tolerance.
_MANY = 400_000
#: Directions that are compared, at most.
_COMPARED = 6
#: Directions closer to each other than this are one, deg.
_ALIKE = 0.5


def tolerance(scan: Scan) -> Iterator[Candidate]:
    """A finer tolerance, where samples are undecided."""
    ready, cutter = scan.state.ready, scan.state.cutters[0]
    few = scan.few[:: max(1, len(scan.few) // 32)]
    if not len(few) or (Case(ready, cutter).look(few).verdict == UNDECIDED).mean() < _UNSURE:
        return
    now = ready.scene.asked
    if ready.conditions.tolerance > now * (1.0 + 1e-9) or len(ready.conditions.obstacles.triangles) > _MANY:
        # The triangles are as many as there may be, and would follow the surface no closer; or to make twice as many to compare
        # them takes longer than all else. That undecided samples ask for a finer tolerance is said where they are told.
        return
    tried = float(f"{now * _FINER:.6g}")
    if tried < LEAST_TOLERANCE:
        return
    state = replace(scan.state, ready=_closer(ready, tried))
    missed = scan.known.glance(state, scan.few)
    if len(missed) < len(scan.few):
        yield scan.found(move_of("tolerance", now, tried, next_steps.tolerance(tried, now)), state, missed, nested=False)


def tilt_range(scan: Scan) -> Iterator[Candidate]:
    """All tilts at which the cutter touches."""
    ready = scan.state.ready
    low, high = (round(math.degrees(tilt), 6) for tilt in ready.conditions.postures.tilt)
    touching = modes(scan.state.cutters[0])
    lowest = min(low, float(math.floor(math.degrees(min(mode.low for mode in touching)) + 1e-6)))
    highest_tilt = max(high, min(180.0, float(math.ceil(math.degrees(max(mode.high for mode in touching)) - 1e-6))))
    if (lowest, highest_tilt) == (low, high):
        return
    tried = (lowest, highest_tilt)
    postures = replace(ready.conditions.postures, tilt=(math.radians(lowest), math.radians(highest_tilt)))
    state = under(scan.state, postures=postures)
    missed = scan.known.glance(state, scan.few)
    if len(missed) < len(scan.few):
        move = move_of("tilt_range", (low, high), tried, next_steps.tilt_range(tried, (low, high)))
        yield scan.found(move, state, missed, nested=True)


def axis(scan: Scan, *, plain: bool = False) -> Iterator[Candidate]:
    """A machine that tilts further, a second setup, another setup: for what is reached without any limit.

    `plain`: of setups those along the part's own axes alone.
    """
    state, known = scan.state, scan.known
    conditions = state.ready.conditions
    machine = conditions.machine
    if not machine.limited:
        return
    free = under(state, machine=Machine())
    gained = np.setdiff1d(scan.few, known.glance(free, scan.few), assume_unique=True)
    if not len(gained):
        return
    now = None if machine.turns or machine.tilt_limit is None else round(math.degrees(machine.tilt_limit), 6)
    first = math.floor((now or 0.0) / _TURN + 1e-9) + 1
    most = math.floor(_MOST / _TURN) - first

    def limit(at: int) -> State:
        return under(state, machine=Machine.parse(f"tilt:{(first + at) * _TURN:g}"))

    for at, made, missed in scan.least(limit, most):
        tried = (first + at) * _TURN
        move = move_of("tilt_limit", now, tried, next_steps.tilt_limit(tried, now, machine.name))
        yield scan.found(move, made, missed, nested=now is not None)
    yield from _setups(scan, gained, plain=plain)


def _setups(scan: Scan, gained: Rows, *, plain: bool) -> Iterator[Candidate]:
    state, known, ready = scan.state, scan.known, scan.state.ready
    blocked = np.setdiff1d(scan.few, gained, assume_unique=True)
    retained = np.setdiff1d(np.flatnonzero(scan.finished.wanted), scan.left, assume_unique=True)
    axes = [axis for axis in _directions(ready, scan.left, retained) if all(_angle(axis, own) > 1.0 for own in state.axes)]
    now = state.axes[0]
    if plain:
        axes = [axis for axis in axes if _own(axis)]
    axes = _promising(ready, state, axes, gained)
    mean = ready.samples.normal[gained].mean(axis=0)
    length = float(np.linalg.norm(mean))
    x, y, z = (mean / length).tolist() if length > 1e-6 else now
    facing = x, y, z
    second = []
    for axis in axes:
        made = replace(state, setups=(*state.setups, SetupOf(axis)))
        missed = known.glance(made, gained)
        second.append((scan.estimate(missed), _angle(facing, axis), axis, made, missed))
    best = _plain(second, scan.estimate(gained))
    if best is not None:
        _, _, axis, made, missed = best
        move = move_of("second_setup", now, axis, next_steps.more_setup(axis, _angle(now, axis), len(made.setups)))
        yield scan.found(move, made, np.union1d(blocked, missed), nested=True)
    # A table that is given with `--fixture` would lie elsewhere.
    if plain or len(state.setups) > 1 or any(each.follows_setup for each in ready.options.fixtures):
        return
    some = spread(retained)
    other = []
    for open_count, _, axis, _, missed in second:
        if open_count < scan.estimate(gained) and ready.scene.same_sides(axis):
            made = replace(state, setups=(SetupOf(axis),))
            worse = known.glance(made, some)
            share = scan.finished.of_rows(retained) * len(worse) / max(1, len(some))
            other.append((scan.estimate(np.union1d(blocked, missed)) + share, _angle(now, axis), axis, made))
    if other:
        estimate, _, axis, made = min(other, key=lambda each: (round(each[0], 3), each[1]))
        if estimate < scan.finished.of_rows(scan.left):
            move = move_of("setup", now, axis, f"{next_steps.clamped(axis, _angle(now, axis))} instead")
            yield Candidate((move,), made, estimate, nested=False)


def _promising(ready: Prepared, state: State, axes: list[Axis], gained: Rows) -> list[Axis]:
    """Those of some directions in which the machine holds axes at most samples, in the order in which they came: of each that is
    compared the part is searched anew."""

    def bound(axis: Axis) -> int:
        return int(within_limits(ready.samples, state.cutters, ready.conditions, axis, gained).sum())

    held = sorted(((bound(axis), axis) for axis in axes), key=lambda each: (-each[0], not _own(each[1])))[:_COMPARED]
    best = {axis for many, axis in held if many}
    return [axis for axis in axes if axis in best]


def _plain(second: list[tuple[float, float, Axis, State, Rows]], whole: float) -> tuple[float, float, Axis, State, Rows] | None:
    """Of setups that miss least that which faces the samples; one along the part's own axes, if that gains nearly as much."""
    gaining = [each for each in second if each[0] < whole]
    if not gaining:
        return None
    best = min(gaining, key=lambda each: each[:2])
    own = [each for each in gaining if _own(each[2])]
    plain = min(own, key=lambda each: each[:2], default=best)
    return plain if whole - plain[0] >= (1.0 - _OWN) * (whole - best[0]) else best


def _own(axis: Axis) -> bool:
    return sorted(map(abs, axis)) == [0.0, 0.0, 1.0]


def _directions(ready: Prepared, missed: Rows, kept: Rows) -> list[Axis]:
    """Give directions to try: faces, edges and corners of a cube, and the mean normals of what is not reached and of all; the
    nearest to the present axis first.
    """
    now = ready.scene.setup
    means = [ready.samples.normal[rows].mean(axis=0) for rows in (missed, np.sort([*missed, *kept]))]
    cube = [np.array(each, float) for each in product((-1, 0, 1), repeat=3) if any(each)]
    axes: list[Axis] = []
    for vector in [*means, *cube]:
        if np.linalg.norm(vector) > 1e-6:
            # Rounded as it is told: what is judged is what is told.
            x, y, z = (float(each) + 0.0 for each in np.round(vector / np.linalg.norm(vector), 6))
            axis = x, y, z
            if all(_angle(axis, other) > _ALIKE for other in [now, *axes]):
                axes.append(axis)
    return sorted(axes, key=lambda axis: (round(_angle(now, axis), 6), axis))


def _angle(a: Axis, b: Axis) -> float:
    """Measure the angle between two directions, deg."""
    return math.degrees(math.atan2(float(np.linalg.norm(np.cross(a, b))), float(np.dot(a, b))))


def _closer(ready: Prepared, requested: float) -> Prepared:
    """Make the same, surrounded anew for a finer tolerance."""
    scene, now = replace(ready.scene, asked=requested), ready.conditions
    # On all threads: what is found stays in the scene, and the setups take it from there.
    scene.surround(jobs=now.jobs)
    # What another step changes of the conditions stays changed.
    each = [replace(one, machine=now.machine, postures=now.postures) for one in conditions_of(scene, ready.options)]
    conditions, surroundings = each[0], each[0].surroundings
    within = inside_material(ready.samples, scene.orientation, surroundings.enclosing, surroundings.certain, conditions.tolerance)
    inside = inside_bodies(within, surroundings.bodies, scene.orientation)
    closely = replace(ready, scene=scene, conditions=conditions, inside=within, inside_bodies=inside)
    return with_setups(closely, each)


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
                yield scan.found(move_of("stick_out", cutter.length, value(at), words), state, missed, nested=False)


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
            move = move_of("holder", cutter.holder.id, other.id, next_steps.holder(other, cutter))
            yield scan.found(move, state, missed, nested=False)


def _chucks(now: Holder) -> list[Holder]:
    """Collet chucks of the table that are slimmer at the nose than a holder, the widest first, on its taper if it has one."""
    name = now.name.lower()
    taper, nose, length = "", "", ""
    # Of a holder of the table the name is its word.
    with suppress(CutterError):
        taper, nose, length = name.rpartition("er") if chuck(name) is not None else ("", "", "")
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
        move = move_of("cutter", None, cutter.id, next_steps.rest(cutter.id))
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
        move = move_of("radius", cutter.radius, made.radius, f"{next_steps.tool(made)}, for the rest")
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
        move = move_of("corner_radius", now, made.corner_radius, f"{next_steps.tool(made)}, for the rest")
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


#: What changes the tool alone.
_TOOLS = (stick_out, other_cutters, corner, radius, holder)
#: Changes of the tool that are looked at together with another axis.
_JOINED = 3


def candidates(scan: Scan, budget: Budget) -> tuple[list[Candidate], int]:
    """Steps that gain something of a few samples, those that may leave least first; and how many kinds were not looked at.

    Once something was found, no others are looked for when the work is spent.
    """
    result, skipped = list[Candidate](), 0
    for each in (tolerance, tilt_range, *_TOOLS, axis):
        if result and not budget.left:
            skipped += 1
        else:
            result += each(scan)
    return sorted(result, key=lambda candidate: candidate.estimate), skipped


def joined(scan: Scan) -> list[Candidate]:
    """Steps of another tool and of axes that the machine does not hold now: neither may gain anything alone."""
    state = scan.state
    conditions = state.ready.conditions
    if not conditions.machine.limited:
        return []
    free = under(state, machine=Machine())
    missed = scan.known.glance(free, scan.few)
    if not len(missed):
        return []
    result: list[Candidate] = []
    tools = [each for tool in _TOOLS for each in tool(replace(scan, state=free, left=missed, few=missed))]
    for first in sorted(tools, key=lambda each: each.estimate)[:_JOINED]:
        held = under(first.state, machine=conditions.machine)
        for second in axis(replace(scan, state=held), plain=True):
            result.append(replace(second, moves=(*first.moves, *second.moves), nested=first.nested and second.nested))
    return sorted(result, key=lambda candidate: candidate.estimate)


#: Samples on which sizes are compared, at most.
_SIZED = 128
#: What a second size reaches more than the first one, at least, a share of the area.
_NOTABLY = 0.1


def fitting(ready: Prepared, cutter: Cutter, rows: Rows, area: Floats) -> tuple[Fit, ...] | None:
    """Find the largest usual size that reaches most of some samples, and a smaller one where that reaches notably more.

    Each is judged as long as the cutter, in its holder, without a thinner neck or a thicker shank, under the conditions of the
    plan: whether a tool of that size is sold so long is not asked here.

    `cutter`: of its kind the sizes are. `rows` (m,) int64: samples that it does not reach. Of very many some are looked at, as
    many of each face as it has of the area. `area` (n,) float: mm2 that each sample stands for. It is empty where no size
    reaches any. None where nothing was judged: sizes have no meaning (form cutters, tapers), none is smaller, or obstacles are
    missing.
    """
    conditions = ready.conditions
    if conditions.surroundings.doubtful or not area[rows].sum() > 0.0:
        return None
    few, weight = _few(ready.samples.face, rows, area)
    bare = (replace(made, length=cutter.length, flutes=None, neck=None, shank_radius=None) for made in smaller(cutter, MOST))
    sizes = [made for made in bare if conditions.judges(made)]

    # Of each sample the largest size that is known to reach it, and the smallest that does not: each is taken to reach what
    # those before it reach, as round and flat ends of one length do but for what their holders meet.
    reaches, fails = np.full(len(few), len(sizes)), np.full(len(few), -1)

    @cache
    def reached(k: int) -> float:
        open_ = np.flatnonzero((k < reaches) & (k > fails))
        missed = np.isin(few[open_], Case(ready, sizes[k]).misses(few[open_])) if len(open_) else np.zeros(0, bool)
        reaches[open_[~missed]], fails[open_[missed]] = k, k
        return float(weight[k >= reaches].sum() / weight.sum())

    def largest(share: float, above: int) -> int:
        """The largest of the sizes after one that reaches a share."""
        low, high = above, len(sizes) - 1
        while high - low > 1:
            middle = (low + high) // 2
            low, high = (low, middle) if reached(middle) >= share else (middle, high)
        return high

    if not sizes:
        return None
    most = reached(len(sizes) - 1)
    if not most > 0.0:
        return ()
    chosen = [largest(HALF if most >= HALF else NEARLY * most, -1)]
    first = reached(chosen[0])
    if first >= HALF and most - first >= _NOTABLY:
        chosen.append(largest(max(first + _NOTABLY, first + HALF * (most - first)), chosen[0]))
    return tuple(Fit(sizes[k], reached(k)) for k in chosen)


def _few(face: Ints, rows: Rows, area: Floats) -> tuple[Rows, Floats]:
    """Some of some samples (m,), ascending, with what each counts: all of them by area, or of very many as many by area.

    What is taken of a face does not depend on the others, nor on the sequence of its samples, which go along its parameters.
    """
    if len(rows) <= _SIZED:
        return np.sort(rows), area[np.sort(rows)]
    each = [rows[face[rows] == number] for number in np.unique(face[rows])]
    mixed = np.concatenate([mine[np.random.default_rng(0).permutation(len(mine))] for mine in each])
    sums = np.cumsum(area[mixed])
    at = np.searchsorted(sums, sums[-1] * (np.arange(_SIZED) + 0.5) / _SIZED)
    few, count = np.unique(mixed[np.minimum(at, len(mixed) - 1)], return_counts=True)
    return few, count.astype(float)
