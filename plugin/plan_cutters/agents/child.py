"""The command as a process of a call: its progress is passed on, and it ends with the call, whatever ends that."""

import contextlib
import json
import os
import re
import signal
import sys
from collections.abc import Awaitable, Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from subprocess import DEVNULL

import anyio
from anyio.abc import ByteReceiveStream, Process

from cad_io.files import WITHIN
from plan_cutters.agents.limits import CallError, Limits

#: Told of each step of the work: seconds since it began, and words about it.
ProgressListener = Callable[[float, str], Awaitable[None]]
#: A line of progress of the command, and a line about what went wrong.
_STEP, _FAULT = re.compile(r"^\s*(\d+\.\d) s  (.+)$"), re.compile(r"^plan-cutters[\w -]*: ")
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
    # Its name is one that the command itself uses; `end_with` kills it if this process is killed.
    begin = (f"from cad_io.lifetime import end_with; end_with({os.getpid()}); "
             f"from plan_cutters.command.entry import begin; begin({name!r})")  # fmt: skip
    await tell(0.0, "starting")
    process = await anyio.open_process(
        [sys.executable, "-c", begin, *words[1:], *more], stdin=DEVNULL, cwd=cwd, env=_environment(limits, within),
        start_new_session=True,
    )  # fmt: skip
    output, errors = bytearray(), bytearray()
    try:
        async with anyio.create_task_group() as tasks:
            tasks.start_soon(_collect, process.stdout, output)
            tasks.start_soon(_listen, process.stderr, errors, tell)
        code = await process.wait()
    finally:
        await _end(process)
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


async def _collect(stream: ByteReceiveStream | None, buffer: bytearray) -> None:
    if stream is not None:
        async for piece in stream:
            if len(buffer) <= _OUTPUT:
                buffer += piece


async def _listen(stream: ByteReceiveStream | None, output: bytearray, tell: ProgressListener) -> None:
    rest = b""
    if stream is None:
        return
    async for piece in stream:
        output += piece
        del output[:-_LOG]
        *lines, rest = (rest + piece).split(b"\n")
        for line in lines:
            if step := _STEP.match(line.decode(errors="replace")):
                await tell(float(step[1]), step[2])


async def _end(process: Process) -> None:
    """End the process if it has not ended: in order first, so that it takes away what it had begun to write."""
    with anyio.CancelScope(shield=True):
        if process.returncode is None:
            with contextlib.suppress(ProcessLookupError):
                process.send_signal(signal.SIGTERM)
            with anyio.move_on_after(_GRACE):
                await process.wait()
        if process.returncode is None:
            with contextlib.suppress(ProcessLookupError, PermissionError):
                os.killpg(process.pid, signal.SIGKILL)
            await process.wait()
        await process.aclose()
