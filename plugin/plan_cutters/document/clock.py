"""Seconds by stage: what `run.seconds` of the plan is made of."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from plan_cutters.plan_file.model import Plan, Run
from plan_cutters.scene.work import METER

#: Told the stage, how much of it is done, of how much.
Progress = Callable[[str, int, int], None]


class Clock:
    """Measure the seconds of each stage, one after the other; a stage that comes again is added to.

    `progress` is called for the stages that are shown; `began` is `time.monotonic()` when the command began: what has passed
    since then is the stage `start`. `seconds` and `boxes`, of the trees that were looked at, are by stage.
    """

    def __init__(self, progress: Progress | None = None, *, began: float | None = None) -> None:
        self.progress = progress
        self.seconds: dict[str, float] = {}
        self.boxes: dict[str, int] = {}
        self._began = time.monotonic()
        if began is not None:
            self.seconds["start"], self._began = self._began - began, began

    @classmethod
    def after(cls, run: Run) -> "Clock":
        """One that goes on after what has been written into a plan."""
        clock = cls()
        clock.seconds |= run.seconds
        clock.boxes |= run.boxes
        clock._began -= run.total
        return clock

    @property
    def total(self) -> float:
        """Seconds since the command began, or the clock was made: all stages, and what lies between them."""
        return time.monotonic() - self._began

    def stamp(self, plan: Plan, **more: Any) -> Plan:
        """The plan with the seconds so far, and with more of its fields."""
        run = Run(time=plan.run.time, seconds=dict(self.seconds), boxes=dict(self.boxes), total=self.total)
        return plan.model_copy(update={**more, "run": run})

    @contextmanager
    def stage(self, name: str, *, shown: bool = True) -> Iterator[Callable[[int, int], None]]:
        """Inside the block, time counts for the stage; tell what is given how much of how much is done."""

        def tell(done: int, total: int) -> None:
            if self.progress and shown:
                self.progress(name, done, total)

        tell(0, 1)
        began, boxes = time.monotonic(), METER.looked
        try:
            yield tell
        finally:
            self.seconds[name] = self.seconds.get(name, 0.0) + time.monotonic() - began
            if METER.looked > boxes:
                self.boxes[name] = self.boxes.get(name, 0) + METER.looked - boxes
        tell(1, 1)
