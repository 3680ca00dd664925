"""Steps that change how closely is judged, which tilts are searched, how the part is clamped, or what the machine tilts."""

import math
from collections.abc import Iterator
from dataclasses import replace
from itertools import product

import numpy as np

from cad_io.arrays import Floats
from plan_cutters.answers.option import Axis
from plan_cutters.answers.scan import Candidate, Rows, Scan, spread, under
from plan_cutters.answers.state import SetupOf, State
from plan_cutters.answers.trial import Case
from plan_cutters.domain.change import Move
from plan_cutters.domain.machine import Machine
from plan_cutters.domain.shapes import modes
from plan_cutters.domain.verdicts import UNDECIDED
from plan_cutters.judging.setups import within_limits
from plan_cutters.options import LEAST_TOLERANCE
from plan_cutters.plan_file.words import answers as next_steps
from plan_cutters.scene.inside_material import inside_bodies, inside_material
from plan_cutters.scene.preparation import Prepared
from plan_cutters.scene.setups import conditions_of, with_setups

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
        yield scan.found(Move("tolerance", now, tried, next_steps.tolerance(tried, now)), state, missed, nested=False)


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
        move = Move("tilt_range", (low, high), tried, next_steps.tilt_range(tried, (low, high)))
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
        move = Move("tilt_limit", now, tried, next_steps.tilt_limit(tried, now, machine.name))
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
    facing = towards(ready.samples.normal[gained].mean(axis=0), now)
    second = []
    for axis in axes:
        made = replace(state, setups=(*state.setups, SetupOf(axis)))
        missed = known.glance(made, gained)
        second.append((scan.estimate(missed), _angle(facing, axis), axis, made, missed))
    best = _plain(second, scan.estimate(gained))
    if best is not None:
        _, _, axis, made, missed = best
        move = Move("second_setup", now, axis, next_steps.more_setup(axis, _angle(now, axis), len(made.setups)))
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
            move = Move("setup", now, axis, f"{next_steps.clamped(axis, _angle(now, axis))} instead")
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


def towards(vector: Floats, otherwise: Axis) -> Axis:
    """A direction; another one where there is none."""
    length = float(np.linalg.norm(vector))
    if not length > 1e-6:
        return otherwise
    x, y, z = (vector / length).tolist()
    return x, y, z


def _own(axis: Axis) -> bool:
    """Whether it is one of the part's own."""
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
            axis = _axis(vector)
            if all(_angle(axis, other) > _ALIKE for other in [now, *axes]):
                axes.append(axis)
    return sorted(axes, key=lambda axis: (round(_angle(now, axis), 6), axis))


def _axis(vector: Floats) -> Axis:
    """Round a direction as it is told: what is judged is what is told."""
    x, y, z = (float(each) + 0.0 for each in np.round(vector / np.linalg.norm(vector), 6))
    return x, y, z


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
