"""Runs a program in a process of its own: seconds, peak memory, and what to do when it dies."""

import multiprocessing
import resource
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from conformance import VERSION
from conformance.posture import Postures
from conformance.programs import program, versions
from conformance.programs.protocol import ANSWERS, UNDECIDED, Unavailable, Words, blind
from conformance.score import TOLERANCE, scored
from conformance.suite import Part, Suite
from conformance.tool import Tool

#: Postures a part of the default run: what plan-cutters answers in about a minute over all made parts.
EACH = 2
#: Seconds that one part may take before its process is ended.
PATIENCE = 1800.0


@dataclass(eq=False)
class Ran:
    """What a program did: answers to the rows of `postures`, in their order, and what it cost."""

    name: str
    postures: Postures
    answers: Words
    why: Counter[str] = field(default_factory=Counter)
    settings: dict[str, Any] = field(default_factory=dict)
    versions: dict[str, str] = field(default_factory=dict)
    start_seconds: float = 0.0
    prepare_seconds: float = 0.0
    answer_seconds: float = 0.0
    memory_mb: float = 0.0
    claims: bool = False

    def document(self, suite: Suite, kind: str, every: bool, rows: NDArray[np.int64] | None = None, tolerance: float = TOLERANCE) -> dict[str, Any]:
        """Return the results as the JSON file has them."""
        families = {name: part.family for name, part in suite.parts.items()}
        total = self.start_seconds + self.prepare_seconds + self.answer_seconds
        return {
            "format": "cutter-accessibility-results",
            "version": VERSION,
            "kind": kind,
            "program": self.name,
            "all": every,
            "claims": self.claims,
            **scored(self.postures, self.answers, families, tolerance, rows),
            "seconds": round(total, 3),
            "start_seconds": round(self.start_seconds, 3),
            "prepare_seconds": round(self.prepare_seconds, 3),
            "answer_seconds": round(self.answer_seconds, 3),
            "memory_mb": round(self.memory_mb, 1),
            "settings": self.settings,
            "versions": {"python": sys.version.split()[0], **self.versions},
            "why": dict(self.why.most_common()),
        }


#: What makes a program of its name.
Make = Callable[[str], Any]
Group = tuple[Part, Tool, str, NDArray[np.int64]]


def run(name: str, suite: Suite, step: Callable[[str], None] = lambda text: None, *, patience: float = PATIENCE, make: Make = program) -> Ran:
    """Run a program over a suite's postures; a claimer over its parts, tools and setups.

    A process that dies, or takes longer than `patience` (seconds) over one group, leaves that group undecided; the rest goes on
    in a new one. `make(name)` makes the program, in its own process.

    Raises
    ------
    ValueError
        No program has that name, or an answer is none of the words.
    Unavailable
        A library is not installed.
    """
    groups = list(suite.groups())
    for part, *_ in groups:
        if not part.path.exists():
            raise ValueError(f"{part.name}: no file {part.path.name}: write it with `generate`, or get it with `fetch`")
    ran = Ran(name, suite.postures, np.full(len(suite.postures), UNDECIDED, dtype="U9"))
    claimed: list[Postures] = []
    pending = list(range(len(groups)))
    while pending:
        began = time.perf_counter()
        for k, reply in _child(make, name, [groups[i] for i in pending], [suite.postures[groups[i][3]] for i in pending], patience):
            if isinstance(reply, Exception):
                raise reply
            if "started" in reply:
                ran.settings, ran.versions, ran.claims = reply["settings"], reply["versions"], reply["claims"]
                ran.start_seconds += time.perf_counter() - began
                continue
            part, tool, setup, rows = groups[pending[k]]
            ran.memory_mb = max(ran.memory_mb, reply.get("memory", 0.0))
            ran.why.update(reply["why"])
            ran.prepare_seconds += reply.get("prepare", 0.0)
            ran.answer_seconds += reply.get("answer", 0.0)
            if "died" in reply:
                ran.why[reply["died"]] += len(rows)
            elif ran.claims:
                claimed.append(_judged(part, tool, setup, reply["claims"]))
            else:
                ran.answers[rows] = _checked(name, reply["answers"], len(rows))
            step(f"{part.name}, {tool.name}")
            last = k
        pending = pending[last + 1 :]
    if ran.claims:
        ran.postures = Postures.joined(claimed) if claimed else suite.postures[np.zeros(0, int)]
        ran.answers = ran.postures.verdict.astype("U9")
    return ran


def _checked(name: str, answers: Any, count: int) -> Words:
    """Return answers of a program, or refuse them."""
    words = np.asarray(answers, dtype="U9")
    if words.shape != (count,) or not np.isin(words, ANSWERS).all():
        raise ValueError(f"{name}: it answers other things than {', '.join(ANSWERS)}, one for each posture")
    return words


def _judged(part: Part, tool: Tool, setup: str, claims: Postures) -> Postures:
    """Return claims with the margins that are true of them."""
    from conformance.truth import limits, truth

    low, high = truth(part.name, tool, setup, claims, part.path)
    return replace(claims, low=low, high=high, limit_deg=limits(part.setups[setup], claims.axis))


def _child(make: Make, name: str, groups: list[Group], postures: list[Postures], patience: float) -> Iterator[tuple[int, Any]]:
    """Yield what a process of the program sends: the number of the group, and a reply; an exception, or that it died."""
    context = multiprocessing.get_context("spawn")
    here, there = context.Pipe(duplex=False)
    process = context.Process(target=_work, args=(there, make, name, [(p, t, s) for p, t, s, _ in groups], [blind(p) for p in postures]), daemon=True)
    process.start()
    there.close()
    done = -1
    try:
        while done < len(groups) - 1:
            if not here.poll(patience):
                yield done + 1, {"died": f"it took longer than {patience:g} s over one part", "why": {}}
                return
            try:
                k, reply = here.recv()
            except EOFError:
                process.join()
                yield done + 1, {"died": f"its process ended with code {process.exitcode}", "why": {}}
                return
            yield k, reply
            done = max(done, k)
    finally:
        process.kill()
        process.join()
        here.close()


def _work(pipe: Connection, make: Make, name: str, groups: list[tuple[Part, Tool, str]], postures: list[Postures]) -> None:
    """Answer group after group in a process of its own."""
    try:
        made = make(name)
        claims = hasattr(made, "claims")
        started = {"started": True, "settings": made.settings, "versions": versions(made.libraries), "claims": claims}
        pipe.send((-1, started))
        before: Part | None = None
        for k, ((part, tool, setup), table) in enumerate(zip(groups, postures, strict=True)):
            made.why = Counter()
            begin = ready = time.perf_counter()
            reply: dict[str, Any]
            try:
                if before is None or part.name != before.name:
                    made.prepare(part)
                before, ready = part, time.perf_counter()
                reply = {"claims": made.claims(part, tool, setup)} if claims else {"answers": made.answer(part, tool, part.setups[setup], table)}
            except Unavailable:
                raise
            except Exception as error:
                reply = {"died": f"{type(error).__name__}: {' '.join(str(error).split())[:200]}"}
            end = time.perf_counter()
            pipe.send((k, {**reply, "why": dict(made.why), "prepare": ready - begin, "answer": end - ready, "memory": peak_memory()}))
    except (Unavailable, ValueError) as error:
        pipe.send((-1, error))
    except KeyboardInterrupt:
        pass


def peak_memory() -> float:
    """Return the peak memory of this process, MB."""
    status = Path("/proc/self/status")
    if status.exists():
        for line in status.read_text(encoding="utf-8").splitlines():
            if line.startswith("VmHWM:"):
                return int(line.split()[1]) / 1024.0
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak / 1024.0 if sys.platform.startswith("linux") else peak / 2**20
