"""The program as a process of its own: started, watched, cancelled."""

from __future__ import annotations

from typing import Callable

from . import model, results


class Run:
    """A plan in the background.

    It starts when it is made. `on_progress(words, fraction)` has the stage and how much of it is done, 0 to 1, or None where that is
    not known; `on_done(result)` or `on_error(line)` ends it, exactly one of them and never while it is made. With a window
    they are called from its own loop; without, by `wait`.
    """

    def __init__(
        self,
        job: model.Job,
        on_progress: Callable[[str, float | None], None],
        on_done: Callable[[results.Result], None],
        on_error: Callable[[str], None],
    ) -> None:
        self.job = job
        self.state = "running"  # then done, failed or cancelled
        self._on_error = on_error

    def cancel(self) -> None:
        """End the program; nothing of it is left, and `on_error` is told."""
        if self.state == "running":
            self.state = "cancelled"
            self._on_error("cancelled; nothing was changed")

    def wait(self, seconds: float = 600.0) -> str:
        """Wait for the end; the state."""
        return self.state
