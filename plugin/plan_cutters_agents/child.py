"""The command as a process of a call: its progress is passed on, and it ends with the call, whatever ends that."""

import json
import os
import re
from collections.abc import AsyncIterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from subprocess import DEVNULL, PIPE
from typing import IO, Protocol

import anyio
from anyio.to_thread import run_sync

from plan_cutters_agents.limits import CallError, Limits
from plan_cutters_base.user_files import WITHIN
from plan_cutters_base.workers.assignment import Assignment
from plan_cutters_base.workers.child import Child, command


class ProgressListener(Protocol):
    """Told of each step of the work: seconds since it began, words about it, and the seconds it will still take, where known."""

    async def __call__(self, seconds: float, words: str, rest: float | None = None) -> None: ...


#: A line of progress of the command, and a line about what went wrong.
_STEP = re.compile(r"^\s*(\d+\.\d) s  (.+?)(?:, about (\d+) s left)?$")
_FAULT = re.compile(r"^plan-cutters[\w -]*: ")
#: Seconds that a process has to end in order.
_GRACE = 3.0
#: Most bytes of its output that are kept: what is longer is no answer, and of what it says the end counts.
_OUTPUT, _LOG = 256 << 20, 1 << 20
#: Environment variable by which the command knows how many samples it may take.
MOST_SAMPLES = "PLAN_CUTTERS_MOST_SAMPLES"


@dataclass(frozen=True, slots=True)
class Ended:
    """How a command ended: its exit code, its standard output, and its lines about what went wrong."""

    code: int
    output: bytes
    faults: tuple[str, ...]


async def run(
    words: Sequence[str],
    cwd: Path,
    limits: Limits,
    tell: ProgressListener,
    *,
    within: Sequence[Path],
    answers: Sequence[int] = (0, 1, 4),
) -> Ended:
    """Run `plan-cutters` with some words.

    It ends with this call, however that ends, and with this process. It reads files in the folders `within` alone, those that
    are named by files, too.

    Raises
    ------
    CallError
        Its exit code is none of `answers`: with its own last line.
    """
    more = [] if limits.memory_gb is None or words[0] != "plan" else [f"--memory={limits.memory_gb!r}"]
    name = "plan-cutters" if words[0] == "plan" else f"plan-cutters {words[0]}"
    await tell(0.0, "starting")
    # Started by the thread that waits for the call: on Linux the child ends with the thread that started it.
    child = Child(command(name, [*words[1:], *more]), Assignment(parent=os.getpid()), environment=_environment(limits, within),
                  cwd=cwd, stdin=DEVNULL, stdout=PIPE, stderr=PIPE, bufsize=0)  # fmt: skip
    output, errors = bytearray(), bytearray()
    try:
        async with anyio.create_task_group() as tasks:
            tasks.start_soon(_collect, child.process.stdout, output)
            tasks.start_soon(_listen, child.process.stderr, errors, tell)
        code = await run_sync(child.process.wait, abandon_on_cancel=True)
    finally:
        # In order first, so that it takes away what it had begun to write.
        with anyio.CancelScope(shield=True), child.process:
            await run_sync(child.end, _GRACE)
    if len(output) > _OUTPUT:
        raise CallError("the answer of the command is too long: choose fewer faces or cutters")
    faults = tuple(line for line in bytes(errors).decode(errors="replace").splitlines() if _FAULT.match(line))
    if code not in answers:
        raise CallError(_line(faults[-1]) if faults else f"the command ended with exit code {code} and wrote nothing")
    return Ended(code, bytes(output), faults)


def _environment(limits: Limits, within: Sequence[Path]) -> Mapping[str, str]:
    folders = json.dumps([*map(str, within)])
    return {**os.environ, MOST_SAMPLES: str(limits.samples), WITHIN: folders, "NO_COLOR": "1", "TERM": "dumb"}


def _line(fault: str) -> str:
    """A fault without the command's name; those of a call stand for themselves."""
    return fault.partition(": ")[2][:2000]


async def _pieces(pipe: IO[bytes] | None) -> AsyncIterator[bytes]:
    while pipe is not None and (piece := await run_sync(pipe.read, 1 << 16, abandon_on_cancel=True)):
        yield piece


async def _collect(pipe: IO[bytes] | None, buffer: bytearray) -> None:
    async for piece in _pieces(pipe):
        if len(buffer) <= _OUTPUT:
            buffer += piece


async def _listen(pipe: IO[bytes] | None, output: bytearray, tell: ProgressListener) -> None:
    rest = b""
    async for piece in _pieces(pipe):
        output += piece
        del output[:-_LOG]
        *lines, rest = (rest + piece).split(b"\n")
        for line in lines:
            if step := _STEP.match(line.decode(errors="replace")):
                await tell(float(step[1]), step[2], None if step[3] is None else float(step[3]))
