"""One child process does the whole job; this one only watches it.

The CAD kernel can crash or hang on a bad file, and neither can be caught from inside. A child that dies, takes too long
to read or too much memory becomes one line and an exit code; what it had begun to write is taken away. On Windows there is
no such child: the command does the job itself, and a crash of the kernel ends it.
"""

import contextlib
import math
import os
import select
import shutil
import signal
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

from plan_cutters_base.forks import process_status
from plan_cutters_base.whole import sweep
from plan_cutters_base.workers.child import INTERRUPTED, Worker, early


@dataclass(eq=False)
class Supervised(Exception):
    """The child did not end by itself: `text` says what happened, in words for the user."""

    text: str

    def __str__(self) -> str:
        return self.text


@dataclass(eq=False)
class Stuck(Supervised):
    """So it was, at a face of a part, and why: without it, there may be a plan."""

    part: str
    face: int
    why: str
    #: Parts that were done, and the exit code that these ask for.
    before: int
    code: int
    #: When this part began (`time.monotonic`).
    since: float


@dataclass(eq=False)
class OutOfTime(Supervised):
    """A part was not done within the time for the whole of it; `before` and `code` as of `Stuck`."""

    text: str = field(default="not done in time", init=False)
    before: int
    code: int
    #: The output where the plan was in it already, so that only models are missing.
    out: Path | None
    #: Whether its summary was shown.
    summarised: bool = False


@dataclass(eq=False)
class Unfinished(Supervised):
    """So it was, but the plan was in the output already: what is missing are models."""

    #: The exit code that the plans so far ask for.
    code: int
    out: Path
    #: Parts that were begun.
    parts: int
    #: Whether the summary of the plan was shown.
    summarised: bool = False


class Display(Protocol):
    """Who is told what the child reports: `command.progress.Display`."""

    def begins(self, part: str) -> None: ...
    def stage(self, stage: str) -> None: ...
    def detail(self, text: str) -> None: ...
    def say(self, text: str) -> None: ...
    def show(self, text: str) -> None: ...
    def at(self, done: int, total: int) -> None: ...
    def tick(self) -> None: ...
    def cases(self, text: str) -> None: ...
    def failed(self, line: str) -> None: ...
    def interrupted(self) -> None: ...


#: Seconds that an interrupted child has to end in order; it has not if the kernel does not come back to it.
GRACE = 0.25
#: Seconds that it has where verdicts stand, to begin to write what there is of a plan; and, once it writes, until page, samples
#: and models are done.
BEGINNING, WRITING = 9.0, 60.0
_WRITES = ("files", "write")
#: Stages in which the kernel works on what the file says, and how many times the limit of reading each may take.
LIMITED = {"read": 1.0, "measure": 5.0, "sew": 5.0, "orient": 5.0, "fixtures": 5.0, "sample": 5.0, "tessellate": 5.0,
           "write": 5.0}  # fmt: skip
_WORK = {"measure": "measuring of faces", "sew": "sewing", "orient": "search for the inside", "fixtures": "reading of fixtures",
         "sample": "sampling", "tessellate": "tessellation", "write": "splitting and writing"}  # fmt: skip
#: Of these, how many times the limit of reading one face may take, in processor time. Samples may be requested by the million.
A_FACE = {"measure": 0.25, "sample": 1.0, "tessellate": 0.25}


def default_memory() -> int:
    """Three quarters of the machine's memory, bytes."""
    return int(0.75 * os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))


def supervise(
    words: Sequence[str], *, read_timeout: float = math.inf, memory: int | None = None, display: Display | None = None,
    name: str = "plan-cutters", timeout: float = math.inf, since: float | None = None, done: int = 0,
    excluded: Mapping[int, str] | None = None, leave: Callable[[int, Path], None] | None = None,
) -> int:  # fmt: skip
    """Run a command in a child; its exit code.

    An interrupt, a request to end or a closed terminal ends it within GRACE, whatever it is doing; where verdicts stand, within
    WRITING, in which it writes them, and within BEGINNING where it does not; a second one ends it at once. So does the end of
    `timeout`.

    `words`, `name`: its arguments, and the command's name as `entry.begin` takes it.
    `read_timeout`: seconds that reading one part may take; the limits of later stages follow from it.
    `memory`: bytes of address space that the child may use.
    `display`: told what the child tells.
    `timeout`, `since`: seconds that the whole of a part may take; when the first part began (`time.monotonic`), default now.
    `done`, `excluded`: as of `Assignment`.
    `leave`: called once with the exit code and the output of the one part, when its summary was shown and models are all that is
      left.

    Raises Supervised: it crashed or was stopped; `Stuck` where this was at a face, `OutOfTime` by the `timeout`.
    """
    watch = _Watch(read_timeout, display, began=since)
    child: Worker | None = None
    signals: list[int] = []
    ending, late, announced = 0.0, False, False

    def ask(child: Worker) -> None:
        nonlocal ending
        ending = time.monotonic()
        child.process.send_signal(signal.SIGINT)
        # The system's timer, for this process may be waiting for its reader just now.
        signal.setitimer(signal.ITIMER_REAL, GRACE)

    def stop(number: int, _: object) -> None:
        # Ask once; a child that has not begun, or is asked again, has nothing to tidy that this process does not.
        signals.append(number)
        if child is not None and (ending or watch.stage == "start"):
            child.kill()
        elif child is not None:
            ask(child)

    def waited(*_: object) -> None:
        rest = ending + (WRITING if watch.stage in _WRITES else BEGINNING) - time.monotonic()
        if watch.stands and rest > 0.0:
            signal.setitimer(signal.ITIMER_REAL, rest)
        elif child is not None:
            child.kill()

    previous = {number: signal.signal(number, stop) for number in _stopping()}
    previous[signal.SIGALRM] = signal.signal(signal.SIGALRM, waited)
    try:
        again = done or excluded
        child = (None if again else early(words)) or Worker(words, name, memory, done=done, excluded=excluded)
        watch.pipe, watch.child = child.here, child.process.pid
        if signals:  # before there was anyone to tell
            raise KeyboardInterrupt
        child.begin(memory)
        while child.process.poll() is None:
            watch.listen(0.2)
            if watch.over:  # neither the child nor a copy of it holds the other end: it has ended, or is about to
                child.ended(0.2)
            if not ending and time.monotonic() - watch.began > timeout:
                if not watch.stands:
                    raise OutOfTime(watch.dones, watch.code, watch.safe and watch.safe[1])
                late = True
                ask(child)
            if ending and watch.stands and not announced:
                announced = True
                if display is not None:
                    display.interrupted()
            if leave is not None and not ending and watch.safe and watch.summarised and watch.stage == "write":
                leave(*watch.safe)
                leave = None
            if watch.late():
                raise watch.ended(*watch.verdict())
            if display is not None:
                display.tick()
    finally:
        if child is not None:
            child.end()
            # What it said last counts, too: a folder is named before it exists.
            watch.listen(0.0)
            os.close(child.here)
        watch.clear()
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        for number, handler in previous.items():
            signal.signal(number, handler)
    code = child.process.returncode
    if late and not signals:
        raise OutOfTime(watch.dones, watch.code, watch.safe and watch.safe[1], watch.summarised)
    if code == INTERRUPTED and watch.safe is not None:
        raise watch.ended("interrupted", "", interrupted=True)
    if code >= 0:
        return code
    # Whoever ends all processes of a service, as its manager does, ends the child at the same time.
    if signals or -code in _stopping():
        if watch.safe is None:
            raise KeyboardInterrupt
        raise watch.ended("interrupted", "", interrupted=True)
    name = signal.Signals(-code).name
    if name != "SIGKILL":  # which comes from outside
        watch.why = f"the CAD kernel crashed ({name}) at its {_WORK.get(watch.stage, watch.stage)}"
    at = " ".join(filter(None, (watch.stage, watch.face)))
    raise watch.ended(f"the CAD kernel crashed ({name}, while it was at '{at}')", "the file may be damaged: export it again")


def _stopping() -> list[int]:
    """Signals that end a run in order: an interrupt, a request to end, and a terminal that is closed, unless `nohup` was used."""
    signals = [signal.SIGINT, signal.SIGTERM]
    if hasattr(signal, "SIGHUP") and signal.getsignal(signal.SIGHUP) is not signal.SIG_IGN:
        signals.append(signal.SIGHUP)
    return [int(number) for number in signals]


def _processor(child: int | None) -> float:
    """Processor seconds that a process has used, without its children; 0 where the system does not tell (only Linux does)."""
    status = process_status(child)
    return (int(status[11]) + int(status[12])) / os.sysconf("SC_CLK_TCK") if status else 0.0


class _Watch:
    """Keep all that the child has reported so far."""

    def __init__(self, read_timeout: float, display: Display | None = None, *, began: float | None = None) -> None:
        self.pipe, self.read_timeout, self.display = -1, read_timeout, display
        self.part, self.stage, self.since = "part", "start", time.monotonic()
        self.began = self.since if began is None else began
        self.work, self.spent, self.why = "", 0.0, ""
        self.child: int | None = None
        self.staging: set[str] = set()
        self.rest = b""
        self.parts, self.dones, self.code = 0, 0, 0
        self.over = False
        self.safe: tuple[int, Path] | None = None
        self.stands = self.summarised = False

    def listen(self, seconds: float) -> None:
        while select.select([self.pipe], [], [], seconds)[0]:
            data = os.read(self.pipe, 1 << 16)
            if not data:
                self.over = True
                return
            seconds = 0.0  # a child that speaks again and again is not listened to for ever
            *lines, self.rest = (self.rest + data).split(b"\n")
            for line in lines:
                word, _, text = line.decode("unicode_escape").partition(" ")
                self._show(word, text)
                if word == "stage":
                    self.stage, self.since, self.work = text, time.monotonic(), ""
                elif word == "work":
                    self.work, self.spent = text, _processor(self.child)
                elif word == "part":
                    self.part, self.parts, self.safe = text, self.parts + 1, None
                    self.stands = self.summarised = False
                elif word in ("stands", "summarised"):
                    setattr(self, word, True)
                elif word == "safe":
                    code, _, folder = text.partition(" ")
                    self.safe = int(code), Path(folder)
                elif word == "done":
                    self.code, self.safe, self.stands = max(self.code, int(text)), None, False
                    self.dones, self.began = self.dones + 1, time.monotonic()
                elif word == "staging":
                    self.staging.add(text)

    def _show(self, word: str, text: str) -> None:
        if self.display is None:
            return
        if word in ("part", "stage", "detail", "say", "show", "cases", "failed"):
            getattr(self.display, "begins" if word == "part" else word)(text)
        elif word == "at":
            done, total = map(int, text.split())
            self.display.at(done, total)

    @property
    def limit(self) -> float:
        return self.read_timeout * LIMITED.get(self.stage, math.inf)

    def late(self) -> bool:
        if self.stage in A_FACE and self.work.startswith("kernel F"):
            within = A_FACE[self.stage] * self.read_timeout
            if _processor(self.child) - self.spent > within:
                work = _WORK.get(self.stage, self.stage)
                self.why = f"the CAD kernel did not end its {work} within {within:g} s of processor time"
                return True
        return time.monotonic() - self.since > self.limit

    @property
    def face(self) -> str:
        """The face that is being worked on, `F12`; empty where no one said."""
        return self.work.partition(" ")[2]

    def verdict(self) -> tuple[str, str]:
        """Say which work took too long, whose it was and where; and give advice."""
        where, within = f"{self.face}: " if self.face else "", f"within {self.limit:g} s"
        more = "give more time (--read-timeout)"
        if self.stage == "read":
            return f"{where}not read {within}", f"the file may be damaged, or {more}"
        if self.work.startswith("own"):
            own = f"{where}our own {_WORK.get(self.stage, self.stage)} did not end {within}"
            return own, f"try a coarser --tolerance, or {more}"
        fewer = "--faces, " if self.stage == "sample" else ""
        return (
            f"{where}the CAD kernel did not end its {_WORK.get(self.stage, self.stage)} {within}",
            f"the file may be damaged: export it again, or try {fewer}a coarser --tolerance, or {more}",
        )

    def ended(self, what: str, advice: str, *, interrupted: bool = False) -> Supervised:
        """Make the error to raise when the child is gone."""
        if self.safe is None and self.face and self.why and not interrupted:
            face, before = int(self.face[1:]), self.parts - 1
            return Stuck(f"{self.part}: {what}; {advice}", self.part, face, self.why, before, self.code, self.began)
        if self.safe is None:
            return Supervised(f"{self.part}: {what}; {advice}")
        code, out = self.safe
        return Unfinished(what, INTERRUPTED if interrupted else max(self.code, code), out, self.parts, self.summarised)

    def clear(self) -> None:
        """Take away what the child had begun to write and not given to the output."""
        for folder in self.staging:
            if folder.endswith(".lock"):
                sweep(Path(folder))
            else:
                with contextlib.suppress(OSError):
                    Path(folder).unlink()
                shutil.rmtree(folder, ignore_errors=True)
