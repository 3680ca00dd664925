"""Something else about the part may serve: how it is clamped, how closely it is judged, which faces are to be finished."""

import math
from dataclasses import replace
from functools import partial
from itertools import islice, product
from typing import Any

import numpy as np

from cad_io.arrays import Floats
from cad_io.part.orient import orient
from plan_cutters.answers.trial import Case, StillMissed, Trials
from plan_cutters.answers.what_if import Way, WhatIf, none
from plan_cutters.domain.change import UNDECIDED, Change
from plan_cutters.domain.posture import unit
from plan_cutters.options import LEAST_TOLERANCE
from plan_cutters.plan_file.numbers import mm
from plan_cutters.plan_file.words import change_text
from plan_cutters.plan_file.words.change_text import samples
from plan_cutters.scene.inside_material import inside_bodies, inside_material
from plan_cutters.scene.preparation import Prepared
from plan_cutters.scene.setups import conditions_of, with_setups

#: Steps of the setup axis, deg.
TURN = 1.0
#: Directions that serve are approached along the way from the present axis, at most so many.
_APPROACHED = 3
#: Directions closer to each other than this are one, deg.
_ALIKE = 0.5
#: Shares of the tolerance that are tried. The triangles grow in number as it falls: a tenth takes longer than all else.
FINER = (0.5, 0.25)

Axis = tuple[float, float, float]


def setup(case: Case, trials: Trials) -> WhatIf | Change:
    """Try other setup axes: of the directions tried the nearest that serves, and on the way there the first.

    What a machine of another limit changes is known already. The side of the material stays as it is.
    """
    ready, not_reached = case.ready, len(trials.not_reached)
    now: Axis = ready.scene.setup
    if not ready.conditions.machine.limited:
        return none("setup", now, not_reached, "the machine has no limit, so it turns to any axis")
    if ready.others and not ready.alike:
        why = f"{UNDECIDED}the setups hold the part in their own ways; a further setup is looked for among the next steps"
        return replace(none("setup", now, not_reached, why), helps=None, why=why)
    if any(each.follows_setup for each in ready.scene.fixtures):
        why = f"{UNDECIDED}a table lies across the setup axis, so it would lie elsewhere; ask with another --setup"
        return replace(none("setup", now, not_reached, why), helps=None, why=why)
    unlimited = trials.found["tilt_limit"]
    if unlimited.left:
        # An axis within a limit is one without.
        why = f"{unlimited.left:,} of {unlimited.looked:,} samples are not reached without any limit of the axis"
        change = none("setup", now, unlimited.left, why, unlimited.looked)
        return change if unlimited.helps is False else replace(change, helps=None, why=UNDECIDED + why)
    tried = {axis: made for axis in directions(ready, trials) if (made := _turned(case, axis)) is not None}
    if not tried:
        return none("setup", now, not_reached, "under every other axis a plan would work on other sides of open faces")
    ends = (axis for axis, made in tried.items() if not trials.stopped(made, everywhere=True))
    ways = (Way(math.ceil(angle(now, end) / TURN - 1e-9), partial(_towards, now, end)) for end in islice(ends, _APPROACHED))

    def fails(_: Case, rest: StillMissed) -> str:
        if rest.count and not rest.blocked:
            return f"the best of {len(tried)} directions tried leaves {rest.count:,} of {rest.looked:,} samples undecided"
        why = f"the best leaves {rest.count:,} of {rest.looked:,} samples" if rest.count else "each loses some samples"
        return f"none of {len(tried)} directions tried serves, {why}"

    def serves(requested: Axis, _: Case) -> tuple[str, dict[str, Any]]:
        flip = flip_of(ready, requested)
        changes = {} if flip == ready.options.flip else {"flip": flip}
        return change_text.setup(requested, angle(now, requested), changes.get("flip")), {"setup": requested, **changes}

    return WhatIf(
        now=now,
        ways=ways,
        make=lambda axis: _turned(case, axis),
        ends=[*tried.values()],
        reads=lambda end: _axis(end.ready.conditions.setup),
        fails=fails,
        serves=serves,
    )


def directions(ready: Prepared, trials: Trials) -> list[Axis]:
    """Give directions to try: faces, edges and corners of a cube, and the mean normals of what is not reached and of all; the
    nearest to the present axis first.
    """
    now = ready.scene.setup
    means = [
        ready.samples.normal[rows].mean(axis=0) for rows in (trials.not_reached, np.sort([*trials.not_reached, *trials.kept]))
    ]
    cube = [np.array(each, float) for each in product((-1, 0, 1), repeat=3) if any(each)]
    axes: list[Axis] = []
    for vector in [*means, *cube]:
        if np.linalg.norm(vector) > 1e-6:
            axis = _axis(vector)
            if all(angle(axis, other) > _ALIKE for other in [now, *axes]):
                axes.append(axis)
    return sorted(axes, key=lambda axis: (round(angle(now, axis), 6), axis))


def _axis(vector: Floats) -> Axis:
    """Round a direction as it is told: what is judged is what is told."""
    x, y, z = (float(each) + 0.0 for each in np.round(vector / np.linalg.norm(vector), 6))
    return x, y, z


def angle(a: Axis, b: Axis) -> float:
    """Measure the angle between two directions, deg."""
    return math.degrees(math.atan2(float(np.linalg.norm(np.cross(a, b))), float(np.dot(a, b))))


def _towards(now: Axis, end: Axis, at: int) -> Axis:
    """Give the direction so many steps of `TURN` from the present one on the way to another; no farther than that."""
    degrees = at * TURN
    if not 0.0 < degrees < angle(now, end):
        return end if degrees > 0.0 else now
    start, other = np.array(now), np.array(end)
    across = other - (other @ start) * start
    if np.linalg.norm(across) < 1e-9:
        # Straight back: any way serves.
        across = np.cross(start, np.eye(3)[int(np.abs(start).argmin())])
    turn = math.radians(degrees)
    return _axis(math.cos(turn) * start + math.sin(turn) * across / np.linalg.norm(across))


def _turned(case: Case, axis: Axis) -> Case | None:
    """Make the same under another setup axis; None if a plan would then work on other sides of open faces, flipped or not."""
    ready = case.ready
    if flip_of(ready, axis) is None:
        return None
    conditions = replace(ready.conditions, setup=unit(axis, "setup axis"), x=None)
    return replace(case, ready=replace(ready, conditions=conditions))


def flip_of(ready: Prepared, axis: Axis) -> bool | None:
    """Choose `flip` for a setup axis so that the faces keep their sides; the result is None if no value keeps them."""
    scene, flip = ready.scene, ready.options.flip
    if scene.orientation.confident:
        return flip
    for each in (flip, not flip):
        if (orient(scene.part, towards=axis, flip=each).sign == scene.orientation.sign).all():
            return each
    return None


def tolerance(case: Case, trials: Trials) -> Change:
    """Try a finer tolerance, where samples are undecided alone: `FINER` shares of it."""
    ready = case.ready
    now = ready.scene.asked
    if trials.blocked:
        why = f"{samples(trials.blocked)} blocked for certain, which no finer tolerance mends"
        return none("tolerance", now, trials.blocked, why)
    not_reached, best, before = len(trials.not_reached), now, now
    for share in FINER:
        finer = float(f"{now * share:.6g}")
        if finer < LEAST_TOLERANCE:
            break
        finely = closer(case, finer)
        if not trials.stopped(finely, everywhere=True) and not len(finely.judged()):
            return Change("tolerance", now, finer, True, 0, len(trials.not_reached), trials.count, before, None,
                          change_text.tolerance(finer, now), {"tolerance": finer})  # fmt: skip
        still = StillMissed.by(finely, trials.not_reached)
        if still.blocked:
            why = f"with {mm(finer)} {samples(still.blocked)} blocked for certain"
            return none("tolerance", now, still.count, why, still.looked)
        before = finer
        if still.count >= not_reached:
            # Nothing was gained.
            break
        not_reached, best = still.count, finer
    return Change("tolerance", now, None if best == now else best, None, not_reached, len(trials.not_reached), 0, None, None,
                  f"{UNDECIDED}with {mm(before)}, the finest tried, {samples(not_reached)} undecided")  # fmt: skip


def closer(case: Case, requested: float) -> Case:
    """Make the same, surrounded anew for a finer tolerance."""
    ready = case.ready
    scene, now = replace(ready.scene, asked=requested), ready.conditions
    # On all threads: what is found stays in the scene, and the setups take it from there.
    scene.surround(jobs=now.jobs)
    # What another step changes of the conditions stays changed.
    each = [replace(one, machine=now.machine, postures=now.postures) for one in conditions_of(scene, ready.options)]
    conditions, surroundings = each[0], each[0].surroundings
    within = inside_material(ready.samples, scene.orientation, surroundings.enclosing, surroundings.certain, conditions.tolerance)
    inside = inside_bodies(within, surroundings.bodies, scene.orientation)
    closely = replace(ready, scene=scene, conditions=conditions, inside=within, inside_bodies=inside)
    return replace(case, ready=with_setups(closely, each))


def faces(case: Case, trials: Trials) -> Change:
    """Leave out the faces with samples that are not reached: they stay in the way, but need not be finished."""
    ready = case.ready
    face, infos = ready.samples.face, ready.scene.part.faces
    bad = np.unique(face[trials.not_reached]).tolist()
    ids = tuple(f"F{n}" for n in bad)
    rest = [n for n in ready.chosen.targets if n not in set(bad)]
    judged = np.unique(face[trials.kept])
    if not np.isin(judged, rest).any():
        return none("faces", ids, len(trials.not_reached), "every target face has samples that are lost")
    area = sum(infos[n - 1].area for n in bad)
    whole = sum(infos[n - 1].area for n in ready.chosen.targets)
    out = np.isin(np.concatenate([trials.not_reached, trials.kept]), np.flatnonzero(np.isin(face, bad)))
    return Change("faces", ids, ids, True, 0, len(trials.not_reached), int((~out).sum()), None, None,
                  change_text.faces(ids, area, area / whole), {"faces": ",".join(f"F{n}" for n in rest)})  # fmt: skip
