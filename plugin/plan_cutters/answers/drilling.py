"""Which tools of the libraries make each hole: along the hole's axis they must stand free down to where they cut."""

import math
from collections.abc import Iterator, Sequence
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from cad_io.part.holes import Hole, Step
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.drill import CONES, Bored, Drill, Drilled, Missing, Why
from plan_cutters.domain.fixture import STOCK, TABLE
from plan_cutters.domain.thread import Thread, thread_in, tolerance_in
from plan_cutters.kernels.rows import Contacts
from plan_cutters.scene.conditions import Conditions, Context, free_in_posture
from plan_cutters.scene.holes import made_of
from plan_cutters.scene.preparation import Prepared

#: Share of a flat's radius that is none.
_NO_WAY = 1e-12
#: Share of the area of a bottom that mills have to finish.
_BOTTOM = 0.99
#: Pitches that a tap goes further through a hole: the lead of most (form C).
_LEAD = 3.0
#: Cosine of the angle between directions that are one.
_ALONG = 1.0 - 1e-9


class _Way(NamedTuple):
    """Into a hole from one end: a setup, the tool axis, and the middle of the mouth."""

    setup: int
    axis: Floats
    mouth: Floats


class _Task(NamedTuple):
    """A tool goes so deep under a mouth, mm: its body, and how far that is above the end of its depth."""

    drill: Drill
    body: Cutter | None
    depth: float
    diameter: float
    main: bool = False


def drilled(ready: Prepared, done: NDArray[np.bool_], used: Sequence[int] = ()) -> list[Bored]:
    """Find of each hole the tools that make it.

    A drill of its diameter does, the nearest, of equal ones the shortest; else a reamer behind a drill; before a drill comes a
    centre drill where there is one. Countersinks and counterbores are made by tools of their own.

    `done` (n,): samples that mills reach: the bottom of a hole may be among them. `used`: setups that are there anyway, which
    come first.
    """
    maker = _Maker(ready, sorted(made_of(ready.options.libraries), key=lambda each: each.body.length), done, used)
    return [maker.bored(hole) for hole in ready.holes]


class _Maker:
    def __init__(self, ready: Prepared, drills: Sequence[Drill], done: NDArray[np.bool_], used: Sequence[int]) -> None:
        self.ready, self.drills, self.done = ready, drills, done
        # What points of drills may go into; a table last.
        over = any(each.fixture.kind == TABLE for setup in ready.setups for each in setup.surroundings.fixtures)
        self.below = ((STOCK,), (STOCK, TABLE)) if over else ((STOCK,),)
        self.order = sorted(range(len(ready.setups)), key=lambda setup: (setup not in used, setup))

    def _nearest(self, diameter: float) -> list[Drill]:
        return sorted(self.drills, key=lambda each: round(abs(each.diameter - diameter), 6))

    def bored(self, hole: Hole) -> Bored:
        """The tools of a hole."""
        uses, missing, thread = self._cylinder(hole), list[Missing](), thread_in(hole.sizes, hole.diameter)
        if not uses or not self._floored(hole):
            missing.append(Missing("hole", hole.diameter, hole.depth, why="bottom" if uses else self._why(hole)))
            uses = []
        for step in hole.steps:
            if not {*step.faces}.intersection(hole.faces) or (thread is not None and thread.is_whole(step.diameter)):
                # A mill makes it, or a tap.
                continue
            use = self._widened(hole, step)
            # Where there is no hole nothing is sunk.
            uses += [use] if uses and use is not None else []
            deep, angle = (None, step.angle) if step.kind == "countersink" else (abs(step.inner - step.outer), None)
            missing += [Missing(step.kind, step.diameter, deep, angle)] if use is None else []
        if thread is not None:
            taps = [drill for drill in self.drills if drill.taps(thread)]
            cut = next((use for tap in taps for use in self._tapped(hole, thread, tap, uses)), None)
            uses += [] if cut is None else [cut]
            why: Why = "in_the_way" if taps and uses else ""
            missing += [] if cut is not None else [Missing("thread", thread.diameter, name=thread.name, why=why)]
        elif uses and not any(use.drill.kind == "reamer" for use in uses):
            tolerance = tolerance_in(hole.sizes, hole.diameter)
            missing += [] if tolerance is None or not tolerance.reamed else [Missing("reamer", hole.diameter, name=tolerance.fit)]
        return Bored(tuple(uses), tuple(missing))

    def _tapped(self, hole: Hole, thread: Thread, tap: Drill, uses: Sequence[Drilled]) -> Iterator[Drilled]:
        """A tap behind the drill of a hole, from the same end in the same setup."""
        for first in uses:
            if not first.main:
                continue
            deep = hole.depth + _LEAD * thread.pitch * hole.through
            mine = [step.inner for step in hole.steps if thread.is_whole(step.diameter) and not step.far]
            deep = max(mine, default=deep) if first.axis @ hole.axis > 0.0 else deep
            task = _Task(tap, tap.in_hole(min(hole.diameter, tap.diameter)), deep, thread.diameter)
            if (use := self._use(task, _Way(first.setup, first.axis, first.mouth))) is not None:
                yield use

    def _why(self, hole: Hole) -> Why:
        """Why no tools make its narrowest cylinder."""
        chains, setups = [*self._chains(hole)], self.ready.setups
        if not chains:
            return ""
        if not any(all(task.body is not None and task.drill.reach >= task.depth for task in chain) for chain in chains):
            return "short"
        allowed = any(setups[way.setup].allows(way.axis[None])[0] for way in self._ways(hole))
        return "in_the_way" if allowed else "axis"

    def _floored(self, hole: Hole) -> bool:
        """Whether mills finish a bottom that no drill leaves."""
        samples = self.ready.samples
        milled = [n for n in hole.floor if n not in hole.faces]
        mine = np.isin(samples.face, milled) & self.ready.finished
        area = np.nan_to_num(samples.area)
        return not milled or bool(mine.any() and area[mine & self.done].sum() >= _BOTTOM * area[mine].sum())

    def _cylinder(self, hole: Hole) -> list[Drilled]:
        """The tools of its narrowest cylinder; none where they cannot make it."""
        tasks = [each for each in self._chains(hole) if all(task.body is not None for task in each)]
        for chain, below in product(tasks, self.below):
            for way in self._ways(hole):
                made = [self._use(task, way) or self._into(below, task, hole, way) for task in chain]
                if all(made):
                    first = self._centre(hole, way)
                    return [*([] if first is None else [first]), *(use for use in made if use is not None)]
        return []

    def _chains(self, hole: Hole) -> Iterator[list[_Task]]:
        """Tools that make it one after the other: the best first."""
        thread, tolerance = thread_in(hole.sizes, hole.diameter), tolerance_in(hole.sizes, hole.diameter)
        if thread is not None:
            yield from self._before_a_tap(hole, thread)
            return
        near = self._nearest(hole.diameter)
        alone = [
            [_down(drill, hole, hole.diameter, main=True)]
            for drill in near if drill.kind == "drill" and drill.wide_as(hole.diameter) and _ends(drill, hole)
        ]  # fmt: skip
        if tolerance is not None and tolerance.reamed:
            yield from (*self._reamed(hole, near), *alone)
        else:
            yield from (*alone, *self._reamed(hole, near))

    def _before_a_tap(self, hole: Hole, thread: Thread) -> Iterator[list[_Task]]:
        """The drill of a hole that is tapped: models have it as wide as that drill, as the nut's inside, or as the thread."""
        for drill in self._nearest(thread.core):
            if drill.kind == "drill" and thread.is_core(drill.diameter) and _ends(drill, hole):
                same = drill.wide_as(hole.diameter)
                task = _down(drill, hole, min(hole.diameter, drill.diameter), main=True)
                yield [task._replace(diameter=hole.diameter if same else drill.diameter)]

    def _reamed(self, hole: Hole, near: Sequence[Drill]) -> Iterator[list[_Task]]:
        if hole.bottom not in ("open", "cone"):
            return
        for reamer in (each for each in near if each.kind == "reamer" and each.wide_as(hole.diameter)):
            # The largest drill comes first: it leaves the least.
            for drill in sorted(self.drills, key=lambda each: -each.diameter):
                if drill.kind == "drill" and drill.comes_before(reamer) and _ends(drill, hole):
                    yield [_down(drill, hole, drill.diameter), _down(reamer, hole, hole.diameter, main=True)]

    def _centre(self, hole: Hole, way: _Way) -> Drilled | None:
        """A centre drill makes a cone no wider than the hole before the drill, if the libraries have one."""
        for drill in self._nearest(hole.diameter):
            if drill.kind == "centre drill" and drill.point is not None:
                wide = min(drill.diameter, hole.diameter)
                task = _Task(drill, drill.as_cone(drill.point), 0.5 * wide / math.tan(0.5 * drill.point), wide)
                if task.depth < hole.depth and (use := self._use(task, way)) is not None:
                    return use
        return None

    def _widened(self, hole: Hole, step: Step) -> Drilled | None:
        """The tool that makes a countersink or counterbore."""
        deep = abs(step.inner - step.outer)
        for drill in self._nearest(step.diameter):
            if step.kind == "countersink" and step.angle is not None and drill.sinks(step.diameter, step.angle):
                task = _Task(drill, drill.as_cone(step.angle), 0.5 * step.diameter / math.tan(0.5 * step.angle), step.diameter)
            elif step.kind == "counterbore" and drill.wide_as(step.diameter) and _floors(drill, step) and drill.reach >= deep:
                task = _Task(drill, drill.in_hole(step.diameter), deep, step.diameter)
            else:
                continue
            axis, mouth = -hole.axis if step.far else hole.axis, hole.place - step.outer * hole.axis
            for setup in self.order:
                if (use := self._use(task, _Way(setup, axis, mouth))) is not None:
                    return use
        return None

    def _ways(self, hole: Hole) -> Iterator[_Way]:
        for setup in self.order:
            yield _Way(setup, hole.axis, hole.place)
            if hole.through:
                yield _Way(setup, -hole.axis, hole.place - hole.depth * hole.axis)

    def _into(self, kinds: Sequence[str], task: _Task, hole: Hole, way: _Way) -> Drilled | None:
        """A tool through a hole whose point goes into what is below the part: stock, which is cut away later, or a table, on
        which the part is put on parallels."""
        conditions = self.ready.setups[way.setup]
        surroundings, up = conditions.surroundings, np.asarray(conditions.setup, float)
        point, end = task.drill.point_length, way.mouth - hole.depth * way.axis
        lowest = float(((surroundings.alone or surroundings).certain.lowest(up) @ up).min())
        foots = [each.obstacles.triangles.vertex @ up for each in surroundings.fixtures if each.fixture.kind in kinds]
        below = max((lowest - float(each.min()) for each in foots), default=0.0)
        if not hole.through or way.axis @ up < _ALONG or not below > point or end @ up > lowest + conditions.tolerance:
            return None
        return self._use(task._replace(depth=hole.depth), way)

    def _use(self, task: _Task, way: _Way) -> Drilled | None:
        """A tool in a hole if it stands free there; None: it does not, or is too short."""
        drill, body = task.drill, task.body
        # A tap's shank may go into its hole.
        if body is None or (drill.kind not in (*CONES, "tap") and drill.reach < task.depth):
            return None
        conditions = self.ready.setups[way.setup]
        context = Context.of(body.asked(0.0, self.ready.options.holder_clearance, None), conditions)
        if not _free(context, conditions, way.mouth - task.depth * way.axis, way.axis):
            return None
        return Drilled(drill, way.setup, way.axis, way.mouth, task.depth, task.diameter, task.main)


def _ends(drill: Drill, hole: Hole) -> bool:
    """Whether the point of a drill leaves the bottom, or what a mill may make of it."""
    return hole.bottom != "cone" or drill.points_at(hole.cone)


def _floors(drill: Drill, step: Step) -> bool:
    """Whether a tool leaves the floor of a counterbore."""
    if step.floor == "cone":
        return drill.kind == "drill" and drill.points_at(step.angle)
    return step.floor == "flat" and drill.kind == "counterbore"


def _down(drill: Drill, hole: Hole, diameter: float, *, main: bool = False) -> _Task:
    """A tool down to the bottom: until all of its width is through, or as wide as a cone is; over a floor with its tip."""
    deep, point = hole.depth, drill.point_length
    if hole.through:
        deep += point
    elif hole.bottom == "cone" and hole.cone is not None:
        deep += 0.5 * (hole.diameter - diameter) / math.tan(0.5 * hole.cone)
    else:
        deep -= point
    return _Task(drill, drill.in_hole(diameter) if deep > 0.0 else None, deep, diameter, main)


def _free(context: Context, conditions: Conditions, tip: Floats, axis: Floats) -> bool:
    """Whether a tool stands free with the middle of its tip at a point; an axis that the machine cannot hold is no way."""
    if not context.judges or conditions.surroundings.doubtful or not conditions.allows(axis[None])[0]:
        return False
    point, normal = np.ascontiguousarray(tip[None]), np.ascontiguousarray(axis[None])
    across = np.linalg.svd(normal)[2][1:2]
    contacts = Contacts(point, normal, across, np.zeros((1, 2)))
    # The contact lies under the middle of the flat: of the tilt direction that has no length, the way alone counts.
    return bool(free_in_posture(contacts, np.zeros(1, np.int64), normal, _NO_WAY * across, context)[0])
