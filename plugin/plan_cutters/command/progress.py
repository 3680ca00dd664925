"""How far the work is: one line with a bar and a clock on a terminal, a line now and then otherwise.

The process that waits draws it: the clock runs on while the CAD kernel holds the other one.
"""

import contextlib
import json
import time
import traceback
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from plan_cutters.command import terminal
from plan_cutters.domain.answer_kinds import KINDS
from plan_cutters.domain.figures import part_done
from plan_cutters_base.terminal_text import clean
from plan_cutters_base.workers.child import is_child, report

if TYPE_CHECKING:
    from plan_cutters.cases.files import Case, CaseFiles
    from plan_cutters.plan_file.model import Plan

_SELF = "plan-cutters"

#: What stages are called; several may be one to the user. A stage that is none of these is the judging of a cutter.
_WORDS = {
    "start": "starting",
    **dict.fromkeys(("read", "measure", "sew", "orient"), "reading the part"),
    "fixtures": "reading the fixtures",
    **dict.fromkeys(("sample", "classify"), "taking samples"),
    **dict.fromkeys(("tessellate", "tree"), "meshing what is in the way"),
    **dict.fromkeys(("compile", "bodies", "patterns"), "preparing the search"),
    "setups": "judging in the other setups",
    "proposal": "comparing setups",
    "reasons": "finding the reasons",
    **{kind.word: kind.work for kind in KINDS},
    "operations": "planning the operations",
    "area": "looking between the samples",
    "maps": "mapping all postures",
    "files": "writing the plan and the samples",
    "write": "writing the models",
    "check": "checking the operations",
}
#: Where there is no terminal, seconds between two lines about the same work.
_AGAIN = 5.0
#: Seconds of a stage, and the share of it that is done, from which on the rest is estimated.
_KNOWN, _SHARE = 2.0, 0.02
#: Seconds without a change of the share from which on it is no measure of the rest.
_STILL = 10.0
#: Seconds between two words of how much of a stage is done.
_OFTEN = 0.1


def work_of(stage: str) -> str:
    """Name the work of a stage.

    >>> work_of("operations"), work_of("R6L80")
    ('planning the operations', 'judging the cutters')
    """
    return _WORDS.get(stage, "judging the cutters")


class PartCases:
    """Gathers what came of each part, for the files of `--junit` and `--sarif`.

    Cases of a part come from the process that plans it, and are written when all parts ended; one of which nothing is known then
    is an error.
    """

    def __init__(self, files: "CaseFiles", parts: Sequence[str]) -> None:
        self.files, self.parts = files, parts
        self.part = ""
        self.cases: dict[str, list[Case]] = {}
        self.faults: dict[str, str] = {}

    def planned(self, part: str, plan: "Plan", code: int) -> None:
        """Take the cases of a plan, or hand them to the process that gathers them."""
        from plan_cutters.cases.plan import plan_cases

        cases = plan_cases(plan, code, part)
        if is_child():
            report("cases", json.dumps(cases))
        else:
            self.cases[part] = cases

    def handed(self, text: str) -> None:
        """Take the cases of the part that began last."""
        from plan_cutters.cases.files import Case

        self.cases[self.part] = [Case(*each) for each in json.loads(text)]

    def failed(self, line: str, part: str | None = None) -> None:
        """Take the line on a part without a plan, by default the one that began last."""
        if is_child():
            report("failed", line)
        self.faults.setdefault(self.part if part is None else part, line.removeprefix("plan-cutters: "))

    def write(self, rest: str = "not planned") -> None:
        """Write the files; `rest`: why parts of which nothing is known have no plan. PlanError where one cannot be written."""
        from plan_cutters.cases.files import Case
        from plan_cutters.cases.plan import PROCESS

        cases: list[Case] = []
        for part in self.parts:
            fault = Case(part, PROCESS, "error", "not_planned", self.faults.get(part, rest))
            cases += self.cases.get(part, [fault])
        self.files.write(_SELF, cases)


class Display:
    """Shows what is told; where it is quiet, texts for people alone.

    `cutters` says how many are judged, `names` what they are called, by their ids; `began` is when the command did
    (`time.monotonic`). It draws by `itself`, without being ticked, where that is requested.
    """

    def __init__(
        self, quiet: bool, cutters: int, began: float, *, itself: bool = False, names: Mapping[str, str] | None = None
    ) -> None:
        self.names = names or {}
        self.quiet, self.cutters, self.began, self.itself = quiet, cutters, began, itself
        self.words, self.doing, self.spoke = "", "", 0.0
        self.judged: dict[str, None] = {}
        self.name = "start"
        self.share: float | None = None
        self.since = self.moved = began
        self.bar: Any = None
        self.task: Any = None
        #: Gathers what came of each part, where a report on them is requested.
        self.part_cases: PartCases | None = None

    def begins(self, part: str) -> None:
        self.judged = {}
        if self.part_cases is not None:
            self.part_cases.part = part

    def cases(self, text: str) -> None:
        if self.part_cases is not None:
            self.part_cases.handed(text)

    def failed(self, line: str, part: str | None = None) -> None:
        if self.part_cases is not None:
            self.part_cases.failed(line, part)

    def stage(self, name: str) -> None:
        self.name, self.share, self.doing = name, None, ""
        if name not in _WORDS:
            self.judged.setdefault(name)
            self.share = (len(self.judged) - 1) / max(self.cutters, len(self.judged))
        words, before = work_of(name), self.words
        self.since = self.since if words == before else time.monotonic()
        self.words = words
        self._show(words != before)

    def at(self, done: int, total: int) -> None:
        if total > 1:
            before, self.share = self.share, done / total
            if self.name not in _WORDS:
                self.share = (len(self.judged) - 1 + self.share) / max(self.cutters, len(self.judged))
            self.moved = self.moved if self.share == before else time.monotonic()
        self.tick()

    def detail(self, text: str) -> None:
        """Show the work of this moment, where the stage's own words say too little."""
        self.doing = text
        self.tick()

    def say(self, text: str) -> None:
        self.clear()
        terminal.emit(text)

    def show(self, text: str) -> None:
        self.clear()
        terminal.give(text)

    def interrupted(self) -> None:
        """Say that what is to end writes something first."""
        self.clear()
        if not self.quiet:
            terminal.error("plan-cutters: what stands is written now, in at most a minute; a second interrupt ends it at once")

    def tick(self) -> None:
        self._show(False)

    def clear(self) -> None:
        """Take the line away; the next word draws it again."""
        if self.bar is not None:
            with contextlib.suppress(OSError, ValueError):
                self.bar.stop()
            self.bar = None

    @property
    def line(self) -> str:
        """Name the work that goes on."""
        if self.name in _WORDS:
            return self.doing or self.words
        name = clean(self.names.get(self.name) or self.name.partition("H")[0])
        many = max(self.cutters, len(self.judged))
        return f"judging {name} ({len(self.judged)} of {many})" if many > 1 else f"judging {name}"

    @property
    def rest(self) -> str:
        """How long this stage will take, about, from the share of its counted work that is done; not where that stands still."""
        now = time.monotonic()
        passed = now - self.since
        if self.share is None or self.share < _SHARE or passed < _KNOWN or now - self.moved > _STILL:
            return ""
        return f", about {max(1, round(passed * (1.0 - self.share) / self.share))} s left"

    def _show(self, news: bool) -> None:
        if self.quiet or not self.words:
            return
        if terminal.redraws():
            with contextlib.suppress(OSError, ValueError):
                self._draw()
            return
        now = time.monotonic()
        if news or (now - self.spoke > _AGAIN):
            share = "" if self.share is None or news else f", {part_done(self.share)}{self.rest}"
            terminal.emit(f"{now - self.began:7.1f} s  {self.words if news else self.line}{share}\n")
            self.spoke = now

    def _draw(self) -> None:
        if self.bar is None:
            from rich.progress import BarColumn, Progress, ProgressColumn, TextColumn
            from rich.table import Column
            from rich.text import Text

            began = self.began

            class Clock(ProgressColumn):
                def render(self, task: Any) -> Text:
                    seconds = int(time.monotonic() - began)
                    return Text(f"{seconds // 60}:{seconds % 60:02d}", style="progress.elapsed")

            doing = TextColumn("{task.description}", markup=False, table_column=Column(no_wrap=True, overflow="ellipsis"))
            much = TextColumn("{task.fields[percent]}", markup=False)
            self.bar = Progress(doing, BarColumn(bar_width=20), much, Clock(), console=terminal.console(),
                                transient=True, auto_refresh=self.itself)  # fmt: skip
            self.bar.start()
            self.task = self.bar.add_task(self.line, total=None, percent="")
        percent = "" if self.share is None else part_done(self.share).rjust(5) + self.rest
        total = None if self.share is None else 1.0
        self.bar.update(self.task, description=self.line, total=total, completed=self.share or 0.0, percent=percent)
        self.bar.refresh()


class Teller:
    """Tells each stage to the parent process, or to a display where there is none."""

    def __init__(self, display: Display | None) -> None:
        self.display = display
        self.told = 0.0
        #: What goes on.
        self.work = ""

    def __call__(self, stage: str, done: int, total: int) -> None:
        if done == 0:
            self.work = work_of(stage)
            report("stage", stage)
            if self.display is not None:
                self.display.stage(stage)
        elif 0 < done < total and time.monotonic() - self.told > _OFTEN:
            self.told = time.monotonic()
            report("at", f"{done} {total}")
            if self.display is not None:
                self.display.at(done, total)

    def detail(self, text: str) -> None:
        report("detail", text)
        if self.display is not None:
            self.display.detail(text)


class ModelsListener:
    """A listener tells whoever waits what of the models is being written; with `debug`, why one is not."""

    def __init__(self, tell: Teller, debug: bool) -> None:
        self.tell, self.debug = tell, debug

    def safe(self, plan: "Plan") -> None:
        """The plan and the arrays are in the output."""

    def begins(self, what: str) -> None:
        from plan_cutters.report.folder import file_name

        # Each step has the whole limit of the stage.
        self.tell("write", 0, 1)
        self.tell.detail("splitting the faces" if what == "split" else f"writing {file_name(what)}")

    def failed(self, what: str, error: Exception) -> None:
        if self.debug:
            terminal.emit("".join(traceback.format_exception(error)))
