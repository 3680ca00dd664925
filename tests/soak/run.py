"""Draw cases of the laws, one after the other, each in a process of its own; make smaller what falls, and tell."""

import contextlib
import math
import os
import pickle
import random
import resource
import select
import signal
import sys
import time
import traceback
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from hypothesis import HealthCheck, Phase, find, settings
from hypothesis.errors import HypothesisException, NoSuchExample

from tests.soak.cases import VoidError
from tests.soak.register import LAWS, Law

#: Two examples: the first one that hypothesis tries is the simplest of all, whatever the seed.
_DRAW = {"max_examples": 2, "database": None, "derandomize": False, "deadline": None, "phases": (Phase.generate,),
         "suppress_health_check": list(HealthCheck)}  # fmt: skip
#: Times as long by the clock as a case may take of the processor.
_WAITS = 10
#: Between the numbers of the cases of one seed and those of the next one.
_STRIDE = 1_000_000


class Outcome(NamedTuple):
    """What became of a case: `held`, `void`, `fell`, `late` or `crashed`, and in words why."""

    kind: str
    why: str = ""

    @property
    def fell(self):
        return self.kind in ("fell", "crashed")


def _stream(law: Law, number: int) -> random.Random:
    """Draws of its own for each case of each law."""
    return random.Random(f"{law.name} {number}")


def drawn(law: Law, number: int) -> Any:
    """The case of a number: the same today and tomorrow."""
    seen: list[Any] = []

    def kept(case):
        seen.append(case)
        return False

    with contextlib.suppress(NoSuchExample):
        find(law.cases, kept, settings=settings(**_DRAW), random=_stream(law, number))
    return seen[-1]


def judged(law: Law, case: Any) -> Outcome:
    """Whether a law holds in a case, in this process."""
    try:
        law.holds(case)
    except VoidError as void:
        return Outcome("void", str(void))
    except Exception as error:
        last = traceback.extract_tb(error.__traceback__)[-1]
        where = "" if isinstance(error, AssertionError) else f" ({last.filename.rpartition('/')[2]}:{last.lineno})"
        return Outcome("fell", f"{type(error).__name__}{where}: {error}")
    return Outcome("held")


def alone(law: Law, case: Any) -> Outcome:
    """The same in a copy of this process, which is ended when its time is over."""
    here, there = os.pipe()
    pid = os.fork()
    if pid == 0:
        try:
            os.close(here)
            os.setsid()
            # Processor time, for a busy machine is no fault; the clock ends what only waits.
            resource.setrlimit(resource.RLIMIT_CPU, (math.ceil(law.seconds + time.process_time()), resource.RLIM_INFINITY))
            signal.signal(signal.SIGINT, signal.SIG_DFL)
            with open(os.devnull, "w") as nowhere, contextlib.redirect_stdout(nowhere):
                outcome = judged(law, case)
            with os.fdopen(there, "wb") as pipe:
                pickle.dump(tuple(outcome), pipe)
        finally:
            os._exit(0)
    os.close(there)
    ended = False
    try:
        with os.fdopen(here, "rb") as pipe:
            if not select.select([pipe], [], [], _WAITS * law.seconds)[0]:
                return Outcome("late", f"past {_WAITS * law.seconds:.0f} s")
            try:
                outcome = Outcome(*pickle.load(pipe))
            except EOFError:
                _, status = os.waitpid(pid, 0)
                ended, code = True, os.waitstatus_to_exitcode(status)
                if code == -signal.SIGXCPU:
                    return Outcome("late", f"past {law.seconds:.0f} s of processor time")
                return Outcome("crashed", f"the process ended by itself: {code}")
        return outcome
    finally:
        if not ended:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(pid, signal.SIGKILL)
            with contextlib.suppress(ProcessLookupError):
                os.kill(pid, signal.SIGKILL)
            os.waitpid(pid, 0)


def smaller(law: Law, number: int, seconds: float, judge: Callable[[Law, Any], Outcome] = alone) -> tuple[Any, Outcome]:
    """The smallest case that falls as that of a number does, as far as the time suffices, and how it falls."""
    ends, fell = time.monotonic() + seconds, list[tuple[Any, Outcome]]()

    def falls(case):
        if time.monotonic() > ends:
            return False
        outcome = judge(law, case)
        if outcome.fell:
            fell.append((case, outcome))
        return outcome.fell

    with contextlib.suppress(HypothesisException):
        least = find(law.cases, falls, random=_stream(law, number),
                     settings=settings(**{**_DRAW, "phases": (Phase.generate, Phase.shrink)}))  # fmt: skip
        for case, outcome in reversed(fell):
            if case == least:
                return case, outcome
    return fell[-1] if fell else (drawn(law, number), judge(law, drawn(law, number)))


def as_test(law: Law, number: int, case: Any, outcome: Outcome) -> str:
    """A case that falls as a test that can be pasted."""
    why = " ".join(outcome.why.split("; Setting(")[0].split())[:400].replace("\\", "\\\\").replace('"""', "'''")
    return (
        f"from tests.soak.cases import Mill, Part, Setting, Tool, Turn  # noqa: F401\n"
        f"from tests.soak.commands import Line  # noqa: F401\n"
        f"from tests.soak.register import LAWS\n"
        f"from tests.soak.solids import Body  # noqa: F401\n\n\n"
        f"def test_{law.name}_{number}():\n"
        f'    """python -m tests.soak --only {law.name} --case {number}\n\n    {why}\n    """\n'
        f'    LAWS["{law.name}"].holds({case!r})\n'
    )


@dataclass
class Row:
    """What a law's cases came to."""

    law: Law
    counts: dict[str, int] = field(default_factory=lambda: dict.fromkeys(("held", "void", "late", "fell", "crashed"), 0))
    seconds: float = 0.0
    late: list[int] = field(default_factory=list)
    fell: list[tuple[int, Any, Outcome]] = field(default_factory=list)

    @property
    def cases(self):
        return sum(self.counts.values())


class Soak:
    """A run: the cases of some laws in turn, by a seed, until the time is over."""

    def __init__(self, laws: list[Law], seed: int = 0, *, shrink: float = 120.0, tell: Callable[[str], None] = print) -> None:
        self.rows, self.seed, self.shrink, self.tell = [Row(law) for law in laws], seed, shrink, tell

    def numbers(self) -> Iterator[tuple[Row, int]]:
        """The laws in turn, with the numbers of their cases."""
        count = 0
        while True:
            for row in self.rows:
                yield row, self.seed * _STRIDE + count
            count += 1

    def run(self, minutes: float, most: float = float("inf")) -> bool:
        """Work until the time is over, or so many cases of each law are done; whether all held."""
        ends = time.monotonic() + 60 * minutes
        try:
            for row, number in self.numbers():
                if time.monotonic() > ends or row.cases >= most:
                    break
                self.one(row, number)
        except KeyboardInterrupt:
            self.tell("interrupted")
        self.tell(self.table())
        return not any(row.fell for row in self.rows)

    def one(self, row: Row, number: int) -> Outcome:
        """Judge the case of a number; one that falls is made smaller and told, the first of its kind alone."""
        began = time.monotonic()
        outcome = alone(row.law, drawn(row.law, number))
        row.counts[outcome.kind] += 1
        row.seconds += time.monotonic() - began
        if outcome.kind == "late":
            row.late.append(number)
        if outcome.fell:
            self.tell(f"FELL {row.law.name} --case {number}: {outcome.why[:1500]}")
            case, least = smaller(row.law, number, self.shrink) if self.shrink > 0 else (drawn(row.law, number), outcome)
            row.fell.append((number, case, least))
            self.tell(as_test(row.law, number, case, least))
        return outcome

    def table(self) -> str:
        """Of each law its cases, seconds and what fell."""
        head = f"{'law':40}{'cases':>7}{'void':>7}{'late':>6}{'fell':>6}{'seconds':>9}{'cases/min':>11}"
        lines = [head, "-" * len(head)]
        for row in self.rows:
            fell, speed = len(row.fell), 60 * row.cases / row.seconds if row.seconds else 0.0
            lines.append(f"{row.law.name:40}{row.cases:7}{row.counts['void']:7}{row.counts['late']:6}{fell:6}"
                         f"{row.seconds:9.0f}{speed:11.1f}")  # fmt: skip
        cases, seconds = sum(row.cases for row in self.rows), sum(row.seconds for row in self.rows)
        void, late, fell = (sum(n) for n in ((r.counts["void"] for r in self.rows), (len(r.late) for r in self.rows),
                                            (len(r.fell) for r in self.rows)))  # fmt: skip
        lines.append(f"{'all':40}{cases:7}{void:7}{late:6}{fell:6}{seconds:9.0f}{60 * cases / max(seconds, 1e-9):11.1f}")
        for row in self.rows:
            for number, _, outcome in row.fell:
                lines.append(f"fell: --only {row.law.name} --case {number}: {outcome.why[:160]}")
            if row.late:
                lines.append(f"late: --only {row.law.name} --case {', '.join(map(str, row.late[:10]))}")
        return "\n".join(lines)


def flushed(text: str) -> None:
    print(text)
    sys.stdout.flush()


__all__ = ["LAWS", "Outcome", "Row", "Soak", "alone", "as_test", "drawn", "flushed", "judged", "smaller"]
