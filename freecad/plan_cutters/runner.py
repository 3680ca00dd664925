"""The program as a process of its own: started, watched, cancelled."""

from __future__ import annotations

import atexit
import dataclasses
import json
import os
import re
import shutil
import signal
import subprocess
import tempfile
import threading
import time
from typing import Any, Callable

from . import files, host, model, results
from .words import later, tr, unit

#: Exit codes with which there is a plan: a cutter finishes, none does, something could not be judged.
PLANNED = (0, 1, 4)
#: A line of progress: seconds, the stage, and how much of it is done.
_PROGRESS = re.compile(r"\s*[\d.]+ s  (.*?)(?:, (\d+) %)?\s*$")
#: Options that the program names in its faults, and what they are in the panel.
_IN_THE_PANEL = (
    ("give --assume-stickout MM", later("fill in “Stick-out”")),
    ("give --holder SPEC, as R15L30 (or none)", later("choose one in “Holder”, or “None at all”")),
)
#: The window asks so often, ms; a program that was told to end gets so long, s.
_OFTEN, _PATIENCE = 100, 5.0
#: Folders that have to be gone when FreeCAD ends, and programs that run.
_folders: set[str] = set()
_programs: set[subprocess.Popen] = set()


class Process:
    """A program that is read without waiting for it.

    Its standard error is kept as lines, its standard output as one text.
    """

    def __init__(self, words: list[str], folder: str) -> None:
        own_group: dict[str, Any] = {"start_new_session": True}
        if os.name == "nt":
            own_group = {"creationflags": getattr(subprocess, "CREATE_NO_WINDOW", 0)}
        try:
            self.popen = subprocess.Popen(
                words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8",
                errors="replace", env=host.environment(), cwd=folder, **own_group,
            )  # fmt: skip
        except (OSError, ValueError) as error:
            raise model.Refused(
                tr("{program} cannot be started: {why}").format(program=words[0], why=getattr(error, "strerror", error))
            ) from None
        _programs.add(self.popen)
        self.lines: list[str] = []
        self._output: list[str] = []
        self._readers = [
            threading.Thread(target=self._read, args=given, daemon=True)
            for given in ((self.popen.stderr, self.lines), (self.popen.stdout, self._output))
        ]
        for each in self._readers:
            each.start()

    @staticmethod
    def _read(stream, into: list[str]) -> None:
        with stream:
            into.extend(iter(stream.readline, ""))

    def ended(self) -> bool:
        """Whether it ended and all that it said was read."""
        if self.popen.poll() is None:
            return False
        _programs.discard(self.popen)
        for each in self._readers:
            each.join(1.0)
        return True

    def progress(self) -> tuple[str, float | None] | None:
        """The last stage that it named, and how much of that is done."""
        for line in reversed(self.lines):
            match = _PROGRESS.match(line)
            if match:
                return match[1], int(match[2]) / 100.0 if match[2] else None
        return None

    def fault(self) -> str:
        """Why it gave no answer, in one line."""
        lines = [line.strip() for line in self.lines if line.strip() and not _PROGRESS.match(line)]
        named = [place for place, line in enumerate(lines) if line.startswith("plan-cutters")]
        text = " ".join(lines[named[-1] :] if named else lines[-1:])
        text = re.sub(r"^plan-cutters[\w ]*: ", "", text)
        for option, field in _IN_THE_PANEL:
            text = text.replace(option, tr(field))
        return text or tr("the program ended with code {code} and wrote nothing").format(code=self.popen.returncode)

    def output(self) -> str:
        """Its standard output."""
        return "".join(self._output)

    def end(self) -> None:
        """End it and all that it started; it is gone on return."""
        for word in ("SIGTERM", "SIGKILL"):
            if self.popen.poll() is not None:
                break
            try:
                if os.name == "nt":
                    self.popen.kill()
                else:
                    os.killpg(self.popen.pid, getattr(signal, word))
            except OSError:
                break
            try:
                self.popen.wait(_PATIENCE)
            except subprocess.TimeoutExpired:
                continue
        _programs.discard(self.popen)


class _Watched:
    """A program that a window waits for; it tells its end once, and leaves no folder unless it answers."""

    def __init__(self, on_progress, on_done, on_error) -> None:
        self.state = "running"  # then done, failed or cancelled
        self.folder = folder()
        self._tell = (on_progress, on_done, on_error)
        self._process: Process | None = None
        self._fault = ""
        self._seen: Any = None
        try:
            self._process = Process(self._words(), self.folder)
        except (model.Refused, OSError) as error:
            self._fault = str(error)
        except Exception as error:  # the kernel raises many kinds
            self._fault = tr("the body cannot be written: {why}").format(why=error)
        self._stop = host.every(_OFTEN, self.poll)

    def _words(self) -> list[str]:
        raise NotImplementedError

    def _answer(self, process: Process):
        raise NotImplementedError

    def poll(self) -> str:
        """Look at the program, and tell what is new; the state."""
        if self.state != "running":
            return self.state
        if self._process is None:
            self._ends("failed", self._fault)
        elif self._process.ended():
            try:
                answer = self._answer(self._process)
            except model.Refused as error:
                self._ends("failed", str(error))
            except Exception as error:  # a window must not ask again and again
                self._ends("failed", tr("the answer cannot be read ({why})").format(why=f"{type(error).__name__}: {error}"))
            else:
                self._ends("done", answer)
        else:
            news = self._process.progress()
            if news is not None and news != self._seen:
                self._seen = news
                self._tell[0](*news)
        return self.state

    def _ends(self, state: str, told) -> None:
        self.state = state
        self._stop()
        if state != "done":
            removed(self.folder)
        self._tell[1 if state == "done" else 2](told)

    def cancel(self) -> None:
        """End the program; nothing of it is left, and `on_error` is told."""
        if self.state == "running":
            if self._process is not None:
                self._process.end()
            self._ends("cancelled", tr("cancelled; nothing was changed"))

    def wait(self, seconds: float = 600.0) -> str:
        """Wait for the end; the state."""
        until = time.monotonic() + seconds
        while self.poll() == "running" and time.monotonic() < until:
            time.sleep(0.05)
        return self.state


class Run(_Watched):
    """A plan in the background.

    It starts when it is made. `on_progress(words, fraction)` has the stage and how much of it is done, 0 to 1, or None where
    that is not known. `on_done(result)` or `on_error(line)` ends it, exactly one of them and never while it is made. With a
    window they are called from its own loop; without, by `wait` or `poll`. The files of a result are in a temporary folder,
    until `objects.show` took them into the document or `result.discard()` took them away.
    """

    def __init__(
        self,
        job: model.Job,
        on_progress: Callable[[str, float | None], None],
        on_done: Callable[[results.Result], None],
        on_error: Callable[[str], None],
    ) -> None:
        self.job = job
        super().__init__(on_progress, on_done, on_error)

    def _words(self) -> list[str]:
        words, fingerprints = files.words(self.job, self.folder)
        with open(os.path.join(self.folder, results.JOB), "w", encoding="utf-8") as file:
            json.dump({**dataclasses.asdict(self.job), "fingerprints": fingerprints}, file)
        # Behind the options of the user the last one of a kind counts, so what is only preferred stands before them.
        place = len(files.command())
        words[place:place] = ["--units", unit()]
        return [*words, "--out", os.path.join(self.folder, "plan"), "--formats", files.FORMATS]

    def _answer(self, process: Process) -> results.Result:
        if process.popen.returncode not in PLANNED:
            raise model.Refused(process.fault())
        return results.read(self.folder)


class Map(_Watched):
    """The posture map of one cutter at a picked point, in the background; as `Run`.

    `on_done(found)` has `picture`, the path of a PNG in the temporary `folder`, which `removed(folder)` takes away, and `json`,
    the answer of `plan-cutters map --json -`.
    """

    def __init__(self, group, point, cutter: str, on_progress, on_done, on_error) -> None:
        from . import objects  # which shows what a run answers

        self._given = objects.result_of(group), tuple(point), cutter
        self._stale = objects.stale(group)
        super().__init__(on_progress, on_done, on_error)

    def _words(self) -> list[str]:
        result, point, cutter = self._given
        if self._stale:
            raise model.Refused(self._stale)
        words, _ = files.words(files.of_one_point(result), self.folder)
        entry = result.shown(cutter)
        at = ",".join(f"{value:.12g}" for value in point)
        place = len(files.command())
        return [
            *words[:place], "map", *words[place:], "--at", at, "--cutter", entry["id"],
            "--cutters", files.library(result, entry, self.folder), "--out", os.path.join(self.folder, "map.png"), "--json", "-",
        ]  # fmt: skip

    def _answer(self, process: Process) -> dict[str, Any]:
        if process.popen.returncode not in PLANNED:
            raise model.Refused(process.fault())
        try:
            found = json.loads(process.output())
            return {"picture": os.path.join(self.folder, "map.png"), "json": found, "folder": self.folder}
        except ValueError:
            raise model.Refused(tr("the program drew no posture map that can be read")) from None


def folder() -> str:
    """A temporary folder, gone when FreeCAD ends if not before."""
    made = tempfile.mkdtemp(prefix="plan-cutters-")
    _folders.add(made)
    return made


def removed(folder: str) -> None:
    """Take a temporary folder away."""
    shutil.rmtree(folder, ignore_errors=True)
    _folders.discard(folder)


@atexit.register
def _leave() -> None:
    for program in list(_programs):
        program.kill()
    for folder in list(_folders):
        removed(folder)
