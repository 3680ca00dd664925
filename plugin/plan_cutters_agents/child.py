"""A call works by commands, each in a process: its progress is passed on, and it ends with the call, whatever ends that."""

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

from plan_cutters.files.pictures import draws_pictures
from plan_cutters.plan_file.load import plan_of
from plan_cutters.plan_file.model import Plan
from plan_cutters_agents.access import CallError, Limits, Permissions
from plan_cutters_agents.plan_answers import tools_in
from plan_cutters_agents.requests import MapQuestion
from plan_cutters_base.user_files import WITHIN
from plan_cutters_base.workers.child import Assignment, Child, command


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


def _environment(limits: Limits, within: Sequence[Path]) -> Mapping[str, str]:
    folders = json.dumps([*map(str, within)])
    return {**os.environ, MOST_SAMPLES: str(limits.most_samples), WITHIN: folders, "NO_COLOR": "1", "TERM": "dumb"}


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


@dataclass(frozen=True, slots=True)
class Call:
    """A call that is worked on: what it may touch, a folder of its own that goes with it, and who is told of its progress."""

    permissions: Permissions
    cwd: Path
    tell: ProgressListener

    async def _run(self, words: Sequence[str], *folders: Path, answers: Sequence[int] = (0, 1, 4)) -> tuple[bytes, int]:
        """Run `plan-cutters` with some words; its standard output and its exit code.

        It ends with this call, however that ends, and with this process. It reads files in the roots and in `folders` alone,
        those that are named by files, too. Where its exit code is none of `answers`, its own last line is raised as a CallError.
        """
        limits, within = self.permissions.limits, (*self.permissions.roots.folders, *folders)
        more = [] if limits.memory is None or words[0] != "plan" else [f"--memory={limits.memory!r}"]
        name = "plan-cutters" if words[0] == "plan" else f"plan-cutters {words[0]}"
        await self.tell(0.0, "starting")
        # Started by the thread that waits for the call: on Linux the child ends with the thread that started it.
        child = Child(command(name, [*words[1:], *more]), Assignment(parent=os.getpid()), cwd=self.cwd,
                      environment=_environment(limits, within), stdin=DEVNULL, stdout=PIPE, stderr=PIPE, bufsize=0)  # fmt: skip
        output, errors = bytearray(), bytearray()
        try:
            async with anyio.create_task_group() as tasks:
                tasks.start_soon(_collect, child.process.stdout, output)
                tasks.start_soon(_listen, child.process.stderr, errors, self.tell)
            code = await run_sync(child.process.wait, abandon_on_cancel=True)
        finally:
            # In order first, so that it takes away what it had begun to write.
            with anyio.CancelScope(shield=True), child.process:
                await run_sync(child.end, _GRACE)
        if len(output) > _OUTPUT:
            raise CallError("the answer of the command is too long: choose fewer faces or cutters")
        faults = [line for line in bytes(errors).decode(errors="replace").splitlines() if _FAULT.match(line)]
        if code not in answers:
            # Without the command's name: faults of a call stand for themselves.
            last = (
                faults[-1].partition(": ")[2][:2000] if faults else f"the command ended with exit code {code} and wrote nothing"
            )
            raise CallError(last)
        return bytes(output), code

    async def plan(self, words: Sequence[str]) -> tuple[Plan, int]:
        """Plan a part; the plan and the exit code."""
        output, code = await self._run(["plan", *words, "--json=-"], self.cwd)
        return plan_of(output, "the plan", CallError), code

    async def plan_in(self, file: str) -> Plan:
        """Read a plan that is there."""
        path = Path(self.permissions.file(file))
        return plan_of(await run_sync(path.read_bytes), file, CallError)

    async def listed(self, command: str, *words: str) -> bytes:
        """What a command lists, as JSON."""
        return (await self._run([command, *words, "--json"], answers=(0,)))[0]

    async def map(self, question: MapQuestion, spec: str | None = None) -> tuple[bytes, int]:
        """Map the postures at a point; the map as JSON and the exit code."""
        words = [*self.permissions.map(question), *([f"--cutter={spec}"] if spec else []), "--json=-"]
        words += [f"--out={self.cwd / 'map.png'}"] if question.picture or draws_pictures() else []
        return await self._run(["map", *words])

    async def tools_of(self, library: str) -> list[tuple[str, str]]:
        """Id and name of each cutter of a library that may be judged; a CallError where there are too many."""
        rows, _ = tools_in(await self.listed("tools", self.permissions.file(library)))
        libraries = [(each["id"], each["name"]) for each in rows]
        most = self.permissions.limits.most_cutters
        if len(libraries) > most:
            why = f"lists {len(libraries)} cutters, and this server judges at most {most} in a call"
            raise CallError(f"{why}: make a library of those in question", file=library)
        return libraries
