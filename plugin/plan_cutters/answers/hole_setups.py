"""Setups for holes alone: in directions from which tools of the libraries make holes that they make in no other setup."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace

import numpy as np

from plan_cutters.answers.candidates import SAME, distinct
from plan_cutters.answers.drilling import drilled
from plan_cutters.answers.serving import reached_by
from plan_cutters.domain.drill import Bored
from plan_cutters.plan_file.frozen import vector
from plan_cutters.plan_file.operations import HoleSetupEntry
from plan_cutters.scene.conditions import Conditions
from plan_cutters.scene.holes import made_of
from plan_cutters.scene.preparation import Axis, Prepared


def made_in(ready: Prepared, conditions: Iterable[Conditions], holes: Iterable[int]) -> set[int]:
    """Those of some holes, by their numbers, that tools of the libraries, and mills at bottoms that are theirs, make under some
    conditions, each a setup."""
    left, made = sorted(holes), set[int]()
    for each in conditions:
        few = replace(ready, conditions=each, others=(), holes=tuple(ready.holes[k] for k in left))
        floors = [face for hole in few.holes for face in hole.floor if face not in hole.faces]
        done = reached_by(ready, np.flatnonzero(np.isin(ready.samples.face, floors) & ready.finished), each, usual=False)
        made |= {k for k, bored in zip(left, drilled(few, done), strict=True) if bored.by is not None}
        left = [k for k in left if k not in made]
    return made


def _bare(ready: Prepared, axis: Axis) -> Conditions:
    """A setup in which nothing but the part is there."""
    few = ready.conditions
    return replace(few, setup=np.array(axis), x=None, surroundings=few.surroundings.alone or few.surroundings)


def _promised(ready: Prepared, holes: Iterable[int], without: Sequence[Axis]) -> dict[Axis, set[int]]:
    """By directions along holes, those of the holes that tools make where nothing but the part is there."""
    left = sorted(holes)
    if not left:
        return {}
    along = [way * ready.holes[k].axis for k in left for way in ((1.0, -1.0) if ready.holes[k].through else (1.0,))]
    axes = distinct(np.array(along).reshape(-1, 3))
    known = np.array(without).reshape(-1, 3)
    new = [vector(np.round(axis, 6) + 0.0) for axis in axes if not (known @ axis >= SAME).any()]
    return {axis: made_in(ready, [_bare(ready, axis)], left) for axis in new}


def for_holes(
    ready: Prepared,
    axes: Sequence[Axis],
    conditions: Iterable[Conditions | None],
    hold: Callable[[Axis], Conditions | None],
    most: int,
) -> dict[Axis, int]:
    """Directions in which holes are made that are made in no setup that is there: at most so many, with how many more in each.

    `axes`, `conditions`: of the setups that are there. `hold`: the conditions in a direction with what holds the part there; None
    where nothing does.
    """
    result, left = dict[Axis, int](), {*range(len(ready.holes))}
    if not left or not axes or most <= 0 or not made_of(ready.options.libraries):
        return result
    left -= made_in(ready, filter(None, conditions), left)
    promised = _promised(ready, left, axes)
    while promised and len(result) < most:
        axis = max(promised, key=lambda each: len(promised[each] & left))
        if not promised.pop(axis) & left or (held := hold(axis)) is None:
            continue
        if made := made_in(ready, [held], left):
            result[axis] = len(made)
            left -= made
    return result


def further_setup(ready: Prepared, made: Sequence[Bored], typed: Callable[[Axis], list[str] | None]) -> HoleSetupEntry | None:
    """The setup that would be best for the holes that no tool makes in those of a plan; None where none would do.

    `made`: by which tools each hole is made. `typed`: the words that ask for a direction beside the setups of the plan.
    """
    left = [k for k, each in enumerate(made) if each.by is None]
    if not left or not made_of(ready.options.libraries):
        return None
    promised = _promised(ready, left, [axis for axis, _ in ready.axes])
    axis = max(promised, key=lambda each: len(promised[each]), default=None)
    if axis is None or not promised[axis]:
        return None
    return HoleSetupEntry(axis=axis, holes=len(promised[axis]), argv=typed(axis) or [])
