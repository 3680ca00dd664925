"""Canonical orientations: those that a machinist would write stand for those of a choice wherever they serve the same.

An orientation goes only for another one that was judged, with the axis of its angles as they are written, at every sample that no
other one of the choice serves: a choice serves afterwards what it served before. All exchanges together cost at most 2 % of the
time (`docs/operations_proof.md`, lemmas E1 and E2).
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain, product

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters.domain.operations import Columns, columns_of
from plan_cutters.operations.orientations import face_directions
from plan_cutters.operations.plans import clearance_of, costs_with
from plan_cutters.operations.task import Task
from plan_cutters.outcome import Operation
from plan_cutters.scene.work import Progress

Served = NDArray[np.bool_]
Rows = NDArray[np.int64]
#: Times that differ by less are equal, as a share.
_EQUAL = 0.02
#: Whole multiples of these that are tried, deg, in this order; and those to which an axis is written within its accuracy.
_STEPS, _SHORT = (90.0, 45.0, 30.0, 15.0, 5.0, 1.0, 0.1), (1.0, 0.1)
#: Samples at which candidates are judged first, and candidates of one rank whose clearances are compared.
_FIRST, _COMPARED = 48, 3


@dataclass(frozen=True, slots=True, eq=False)
class _Choice:
    """Columns with what each sample of a task costs with each: made by `_choice`.

    `cost` (r, k) float: infinite where a column does not serve. `best` (r,) int: the cheapest column of each sample. `served`
    (r,) bool: samples that some column serves. `cutting`: the cost of all samples that are served, each with its best column.
    """

    task: Task
    columns: Columns
    cost: Floats
    best: Rows
    served: Served
    cutting: float

    def seconds(self) -> float:
        """The cost with the time of the rotary axes; without a feed the length of the cuts alone."""
        return self.cutting + (0.0 if self.task.paths.feed is None else self.task.together(self.columns))

    def own(self, k: int) -> Rows:
        """Samples, numbers in the task's rows, that are cheapest with a column."""
        return np.flatnonzero(np.isfinite(self.cost[:, k]) & (self.best == k))

    def needed(self, k: int) -> Rows:
        """Samples that no other column serves; where there are none, those that are cheapest with this one."""
        serves = np.isfinite(self.cost)
        alone = np.flatnonzero(serves[:, k] & (serves.sum(axis=1) == 1))
        return alone if len(alone) else self.own(k)

    def order(self) -> list[int]:
        """The columns, that with the most samples first."""
        return sorted(range(len(self.columns)), key=lambda k: -len(self.own(k)))

    def without(self, which: Sequence[int]) -> "_Choice":
        """The choice without some of its columns."""
        others = np.delete(np.arange(len(self.columns)), np.array(which, np.int64))
        return _choice(self.task, self.columns.of(others), self.cost[:, others])

    def exchanged(self, k: int, other: Columns) -> "_Choice":
        """The choice with another column in the place of one."""
        place = np.arange(len(self.columns))
        place[k] = len(self.columns)
        cost = self.cost.copy()
        cost[:, k] = costs_with(self.task, other)[1][:, 0]
        return _choice(self.task, self.columns.and_(other).of(place), cost)

    def as_good(self, before: "_Choice", most: float) -> bool:
        """Whether it serves all that another choice does, and cuts it at no more than a cost."""
        return bool(self.served[before.served].all()) and self.cutting <= most


def _choice(task: Task, columns: Columns, cost: Floats) -> _Choice:
    """Columns with their costs (r, k), and what follows from these."""
    served = np.asarray(np.isfinite(cost).any(axis=1))
    return _Choice(task, columns, cost, cost.argmin(axis=1), served, float(cost[served].min(axis=1, initial=np.inf).sum()))


def canonical(task: Task, columns: Columns, *, progress: Progress | None = None) -> Columns:
    """Exchange orientations of a choice for canonical ones.

    The setup axis comes first, then normals of floors, directions of walls, and whole multiples of 90, 45, 30, 15, 5, 1 and
    0.1 deg next to the angles. Of those of one rank that take the same time the one with the largest least clearance is taken.
    What lies within the accuracy of the axes is one orientation then, and is written as short as serves.

    Returns at most as many, in their order: the same where rotary axes lock at whole multiples of an angle alone.
    """
    if not len(columns) or task.ready.options.index_step is not None:
        return columns
    first = choice = _choice(task, columns, costs_with(task, columns)[1])
    most, faces = (1.0 + _EQUAL) * choice.cutting, face_directions(task.ready.samples)
    tell, count = progress or (lambda done, total: None), 2 * len(columns)
    for done, k in enumerate(choice.order()):
        tell(done, count)
        choice = _preferred(choice, k, most, faces)
    for done, k in enumerate(choice.order(), len(columns)):
        tell(done, count)
        choice = _shortened(choice, k, most)
    choice = _merged(choice, most)
    return choice.columns if choice.seconds() <= (1.0 + _EQUAL) * first.seconds() else columns


def _preferred(choice: _Choice, k: int, most: float, faces: tuple[Floats, Floats]) -> _Choice:
    """The choice with the orientation of the first rank that serves as well as a column."""
    where = choice.task.orientations[choice.columns.setup[k]]
    # Of each rank angles, deg, and axes, the next one where none of the ranks before did.
    ranks = chain(
        (where.near(directions) for directions in (where.conditions.setup[None], *faces)),
        (where.set_to(_multiples(choice.columns.angle[k], step)) for step in _STEPS),
    )
    for angle, axis in ranks:
        if (angle == choice.columns.angle[k]).all(axis=1).any():
            return choice
        good = _as_good(choice, k, angle, axis, most)
        if good:
            return _clearest(good, k)
    return choice


def _multiples(angle: Floats, step: float) -> Floats:
    """Whole multiples (n, 2) of a step on both sides of angles (2,), deg."""
    sides = [{math.floor(each / step + 1e-9) * step, math.ceil(each / step - 1e-9) * step} for each in angle.tolist()]
    return np.array(list(product(*map(sorted, sides))))


def _as_good(choice: _Choice, k: int, angle: Floats, axis: Floats, most: float) -> list[_Choice]:
    """The choices with one of some orientations in the place of a column that serve as well at no more than a cost."""
    task, needed = choice.task, choice.needed(k)
    others = columns_of(axis, angle, int(choice.columns.cutter[k]), int(choice.columns.setup[k]))
    # Most of them do not serve: few samples tell.
    for rows in (needed[:: max(1, len(needed) // _FIRST)], needed):
        if len(others):
            others = others.of(np.flatnonzero(task.table(task.rows[rows], others).all(axis=0)))
    exchanged = (choice.exchanged(k, others.of(np.array([i]))) for i in range(len(others)))
    return [each for each in exchanged if each.as_good(choice, most)]


def _clearest(choices: Sequence[_Choice], k: int) -> _Choice:
    """Of choices with another column at one place, of those that take the same time, that with the largest clearance there."""
    times = sorted(choices, key=lambda each: each.cutting)
    equal = [each for each in times if each.cutting <= (1.0 + _EQUAL) * times[0].cutting][:_COMPARED]
    return equal[0] if len(equal) == 1 else max(equal, key=lambda each: _clearance(each, k))


def _clearance(choice: _Choice, k: int) -> float:
    """The least clearance, mm, of a column at the samples that are cheapest with it."""
    columns, rows = choice.columns, choice.task.rows[choice.own(k)]
    cutter, setup = choice.task.cutters[columns.cutter[k]], int(columns.setup[k])
    operation = Operation("", "fixed", cutter, setup, columns.axis[k], columns.angle[k], None, rows)
    clearance = clearance_of(choice.task, operation)
    return -math.inf if clearance is None else clearance


def _shortened(choice: _Choice, k: int, most: float) -> _Choice:
    """The choice with angles of a column written as short as serves, within the accuracy of the axes."""
    columns, where = choice.columns, choice.task.orientations[choice.columns.setup[k]]
    for step in _SHORT:
        angle, axis = where.set_to(_multiples(columns.angle[k], step))
        if (angle == columns.angle[k]).all(axis=1).any():
            return choice
        near = _within(axis, columns.axis[k], choice.task.ready.options.accuracy)
        good = _as_good(choice, k, angle[near], axis[near], most)
        if good:
            return _clearest(good, k)
    return choice


def _merged(choice: _Choice, most: float) -> _Choice:
    """The choice with one orientation for those of a setup that are nearer than the accuracy of the axes, where it serves."""
    accuracy, order = choice.task.ready.options.accuracy, choice.order()
    gone = list[int]()
    for place, k in enumerate(order):
        for j in order[place + 1 :]:
            columns = choice.columns
            near = bool(_within(columns.axis[[j]], columns.axis[k], accuracy)[0])
            if k in gone or j in gone or columns.setup[k] != columns.setup[j] or not near:
                continue
            # What is gone serves nothing any more.
            now = choice.without(gone)
            if columns.cutter[k] != columns.cutter[j]:
                good = _as_good(choice, j, columns.angle[[k]], columns.axis[[k]], most)
                if good and good[0].without(gone).as_good(now, most):
                    choice = good[0]
            elif choice.without([*gone, j]).as_good(now, most):
                gone.append(j)
    return choice.without(gone)


def _within(axis: Floats, other: Floats, angle: float) -> Served:
    """Which axes (n, 3) are at most an angle, rad, from another one (3,)."""
    return np.asarray(np.linalg.norm(axis - other, axis=1) <= 2.0 * math.sin(0.5 * angle) + 1e-12)
