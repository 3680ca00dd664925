"""How far all parts are: a bar on a terminal, plain lines elsewhere, always to standard error."""

import contextlib
import textwrap
import time

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn
from rich.text import Text

from plan_cutters.domain.figures import duration
from plan_cutters_base.terminal_text import clean
from plan_cutters_batch.row import OUTCOMES, PartRow, cause, outcome

#: Where there is no terminal, up to so many parts have a line each; of more, counts are told now and then.
EACH = 200
#: Seconds between two such lines: in the first minute, and later.
_SOON, _LATER = 5.0, 30.0
#: Of a line, at most.
COLUMNS = 80


class Screen(Console):
    """A console whose reader may go away: rich would end the process then."""

    def on_broken_pipe(self) -> None:
        self.quiet = True


class Board:
    """A board shows what came of parts, and how many there still are.

    Failures are always told, each in a line with its cause; `quiet`: nothing else is. `total`: parts there are; None where that
    is not known. It never raises for a stream that cannot be written to: the files and the exit code say all.
    """

    def __init__(self, quiet: bool, total: int | None, *, console: Screen | None = None) -> None:
        self.quiet, self.total = quiet, total
        self.console = console or Screen(stderr=True, highlight=False, markup=False, emoji=False)
        self.done = self.running = self.failed = 0
        self._rows = self._planned = 0
        self._said: set[str] = set()
        self._began = self._spoke = time.monotonic()
        self._bar: Progress | None = None
        if not quiet and self.console.is_terminal and not self.console.is_dumb_terminal:
            words = TextColumn("{task.description}", markup=False)
            self._bar = Progress(
                words, BarColumn(bar_width=20), TimeElapsedColumn(), TimeRemainingColumn(), console=self.console, transient=True
            )
            with contextlib.suppress(OSError, ValueError):
                self._bar.start()
            self._bar.add_task("", total=total)
            self._update()

    def row(self, row: PartRow) -> None:
        """Show what came of a part."""
        self._rows += 1
        self.done = max(self.done, self._rows)
        result = outcome(row)
        self.failed += result == "failed"
        self._planned += row.status != "kept" and row.seconds > 0.0
        if result == "failed":
            self._print(f"{self._front}{row.name}: failed: {cause(row)}")
        elif not self.quiet and self._bar is None and self._each:
            note = "; reused from an earlier run" if row.status == "kept" else ""
            wrong = f"; {row.error}" if row.error else ""
            rest = f": {OUTCOMES[result]}{'; coarser than requested' * bool(row.coarser)}: {row.verdict}{note}{wrong}"
            self._print(f"{self._front}{row.name}{rest}")
        self._update()

    def progress(self, done: int, running: int) -> None:
        """Take over counts from whoever knows them better, which may be before a row comes: parts done, and in work."""
        self.done, self.running = max(done, self._rows), running
        self._update()

    def say(self, text: str) -> None:
        """Tell a line, once however often it is said: such as the address of the dashboard."""
        if not self.quiet and text not in self._said:
            self._said.add(text)
            self._print(text)

    def close(self) -> None:
        """Take the bar away, and tell the counts a last time where there is none."""
        bar, self._bar, quiet = self._bar, None, self.quiet
        # What failed is told even later; counts are not.
        self.quiet = True
        if bar is not None:
            with contextlib.suppress(OSError, ValueError):
                bar.stop()
        elif not quiet:
            self._print(f"{self._front}{self._so_far}")

    @property
    def _front(self) -> str:
        """How many parts of all are done, for how long and for how long still; nothing where a bar shows it."""
        if self._bar is not None:
            return ""
        since = time.monotonic() - self._began
        done = f"{self.done}" if self.total is None else f"{self.done:>{len(str(self.total))}}/{self.total}"
        remaining = (self.total or 0) - self.done
        # By the parts that were planned: what is reused from an earlier run takes no time.
        more = f", about {duration(remaining * since / self._planned)} left" if self._planned and remaining > 0 else ""
        return f"{done}  {duration(since)}{more}  "

    @property
    def _each(self) -> bool:
        """Whether each part has a line of its own."""
        return max(self.total or 0, self.done) <= EACH

    @property
    def _so_far(self) -> str:
        rest = [f"{self.running:,} in work"] * bool(self.running) + [f"{self.failed:,} failed"] * bool(self.failed)
        return ", ".join(["parts done", *rest])

    def _update(self) -> None:
        now = time.monotonic()
        if self.quiet:
            return
        if self._bar is not None:
            of = f" of {self.total:,}" if self.total is not None else ""
            with contextlib.suppress(OSError, ValueError):
                self._bar.update(self._bar.task_ids[0], completed=self.done, description=f"{self.done:,}{of} {self._so_far}")
        elif not self._each and now - self._spoke > (_SOON if now - self._began < 60.0 else _LATER):
            self._spoke = now
            self._print(f"{self._front}{self._so_far}")

    def _print(self, line: str) -> None:
        """Print a text in lines of at most 80 columns; words, as addresses and paths, are never parted: scripts look for them."""
        lines = textwrap.wrap(clean(line), COLUMNS, subsequent_indent="    ", break_long_words=False, break_on_hyphens=False)
        with contextlib.suppress(OSError, ValueError, AttributeError):
            for each in lines:
                self.console.print(Text(each), soft_wrap=True)
