"""A task of a batch: one part, on a worker. The command works in a child process, so that a crash or hang costs that part."""

import contextlib
import functools
import os
import pickle
import signal
import subprocess
import tempfile
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path, PurePosixPath
from typing import Any

from plan_cutters.errors import PlanError
from plan_cutters.files.folder import read
from plan_cutters_base.whole import system_lock
from plan_cutters_base.workers.child import INTERRUPTED, TIMED_OUT, Assignment, Child, JobInput, can_supervise, compiler
from plan_cutters_base.workers.supervise import WRITING
from plan_cutters_batch.job import Handed, key_of, versions
from plan_cutters_batch.row import UNREADABLE, USAGE, PartRow, failed, row_of
from plan_cutters_batch.store import Store

PLAN = "plan.json"
#: Exit codes with which a plan is there.
_PLANNED = (0, 1, 4)
#: How often a child is looked after, s, and how long it may take to end in order.
_LOOK, _GRACE = 0.1, 2.0
#: Most characters of an error that are handed on.
_LONGEST = 600


@dataclass(frozen=True)
class Task:
    """All that a worker needs for a part: what is not said here is as of the `Job`."""

    name: str
    file: str
    part: bytes | None
    handed: Handed
    #: Of the command line, for what is no option of the plan.
    words: tuple[str, ...]
    #: The key of its `Settings`.
    settings: str
    #: URL of the output; None: the files come back with the row.
    store: str | None = None
    #: Lies in the output: a worker that does not see it writes elsewhere.
    token: str = ""
    #: Whether what is done is planned, too.
    force: bool = False
    #: Seconds for the part.
    timeout: float | None = None
    #: Of where the batch was begun.
    versions: Mapping[str, str] = field(default_factory=dict)
    #: The file as workers find it, in whatever folder they run.
    source: str = ""

    @property
    def folder(self) -> str:
        """Its folder below the output."""
        return f"{self.name}-plan"


@dataclass(frozen=True)
class Outcome:
    """An outcome holds the row of a part, and its files where the worker could not write them."""

    row: PartRow
    files: Mapping[str, bytes] = field(default_factory=dict)
    #: Address of the worker where no part can be planned, whatever it is: `row.error` says why. The part is for another one.
    unfit: str = ""


def work(task: Task) -> Outcome:
    """Plan a part: never raises, for the task would be tried again elsewhere with the same end."""
    began, key = time.monotonic(), ""

    def fault(why: str, code: int) -> Outcome:
        line = " ".join(why.split())[:_LONGEST]
        return Outcome(failed(task.name, task.file, line, code, key=key, seconds=time.monotonic() - began))

    try:
        output = None if task.store is None else Store(task.store)
        why = _unfit(task.versions)
        if not why and output is not None and not output.seen(task.token):
            why = (
                f"{_here()}: this worker does not see {task.store} (give a folder that all machines share, or a URL), "
                "or another batch has begun there since"
            )
        if why:
            worker = _worker()
            return replace(fault(why, USAGE), unfit="" if worker is None else str(worker.address))
        source = task.source or task.file
        try:
            whole = task.part or read(source)
        except PlanError as error:
            return fault(str(error).replace(source, task.file), UNREADABLE)
        key = key_of(whole, task.settings)
        if output is not None and not task.force and (row := cached(output, task.folder, key, task.name, task.file)):
            return Outcome(row)
        # The worker's folder, which dask clears when the worker was killed.
        scratch = getattr(_worker(), "local_directory", None)
        with tempfile.TemporaryDirectory(prefix="plan-", dir=scratch, ignore_cleanup_errors=True) as name:
            folder = Path(name)
            code, line = planned(task, whole, folder)
            late = code == TIMED_OUT and (folder / "out" / PLAN).is_file()
            if late:
                line = _late(task, folder / "out")
            made = files_of(folder / "out")
            # A partial plan does not take the place of a whole one of an earlier run with the same key.
            done = late and output is not None and cached(output, task.folder, key, task.name, task.file) is not None
            if PLAN not in made or not (late or code in _PLANNED) or done:
                return fault(line or f"ended with exit code {code} and no plan", code if code > 1 else UNREADABLE)
            from plan_cutters.plan_file.load import plan_of

            row = row_of(plan_of(made[PLAN].read_bytes(), PLAN), name=task.name, file=task.file, code=code, key=key,
                         folder=task.folder, seconds=time.monotonic() - began)  # fmt: skip
            if late:
                row = row.model_copy(update={"status": "failed", "error": line})
            if output is None:
                return Outcome(row, {name: path.read_bytes() for name, path in made.items()})
            output.publish(task.folder, made, row)
        return Outcome(row)
    except PlanError as error:
        return fault(str(error), USAGE)
    except OSError as error:
        return fault(f"{_here()}: {error.strerror or error}", USAGE)
    except Exception as error:
        return fault(f"internal error ({type(error).__name__}: {error})", UNREADABLE)


def cached(output: Store, folder: str, key: str, name: str, file: str) -> PartRow | None:
    """The row of an earlier run with the same key; None where there is none, or its files have changed."""
    row = output.row(folder)
    if row is None or row.key != key or row.status == "failed":
        return None
    return row.model_copy(update={"status": "kept", "name": name, "file": file})


def _unfit(there: Mapping[str, str]) -> str:
    """Why this worker cannot plan as the others do, by versions that are given; empty where it can."""
    for name, here in versions().items():
        if there.get(name, here) != here:
            return f"{_here()}: {name} {here} on this worker, {there[name]} where the batch was begun: install the same on both"
    return _ready()


@functools.cache
def _ready() -> str:
    """Make sure, once a worker, that the CAD kernel loads here and that there is machine code; why not."""
    loaded = Child(["-c", "import OCP"], Assignment(), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    words = loaded.process.communicate()[1].decode(errors="replace")
    if loaded.ended():
        why = (words.strip().splitlines() or ["it crashed"])[-1]
        return f"{_here()}: the CAD kernel cannot be loaded ({why}): install it, libgl1 on Debian"
    from plan_cutters.kernels.jit import at_hand

    # The first of the workers of a machine compiles for all of them. Where it cannot, each part does, and says what is wrong.
    place = Path(tempfile.gettempdir(), f"plan-cutters-compiling-{getattr(os, 'getuid', int)()}.lock")
    if at_hand("search.search.search_rows") is False:
        with contextlib.suppress(OSError), system_lock(place):
            if at_hand("search.search.search_rows") is False:
                made = compiler(maps=False)
                try:
                    made.ended()
                finally:
                    made.end()
    return ""


def _here() -> str:
    return os.uname().nodename if hasattr(os, "uname") else "worker"


def _worker() -> Any:
    """The dask worker that this runs on; None outside of one."""
    try:
        from distributed import get_worker

        return get_worker()
    except (ImportError, ValueError):
        return None


def _wanted() -> Callable[[], bool]:
    """Whether somebody still waits for this task: whoever began the batch may be gone, and dask stops no thread."""
    worker = _worker()
    if worker is None:
        return lambda: True
    from distributed.worker import thread_state

    name = thread_state.key

    def wanted() -> bool:
        state = worker.state.tasks.get(name)
        return state is not None and state.state in ("executing", "long-running")

    return wanted


def planned(task: Task, content: bytes, folder: Path) -> tuple[int, str]:
    """Run the command in a folder; its exit code, and the last line that it said."""
    name = PurePosixPath(task.file.replace("\\", "/")).name or "part"
    if task.part is None:
        (folder / name).write_bytes(content)
    if any((folder / file).exists() for file, _ in task.handed.files):
        return USAGE, f"{task.file}: a fixture's file is called like the part: rename one"
    for file, data in task.handed.files:
        (folder / file).write_bytes(data)
    (folder / ".handed").write_bytes(pickle.dumps(JobInput(task.handed.options, task.part), protocol=5))
    words = ["-m", "plan_cutters", "plan", f"./{name}", "-o", "out", "--quiet", *task.words]
    limit = float("inf")
    if task.timeout:
        limit = task.timeout
        if can_supervise():
            # The command ends itself in time, and writes what stands by then.
            words += ["--timeout", repr(task.timeout)]
            limit += WRITING + _GRACE
    wanted = _wanted()
    with open(folder / ".said", "wb") as log:
        knows = Assignment(parent=os.getpid(), job=str(folder / ".handed"))
        child = Child(words, knows, cwd=folder, stdin=subprocess.DEVNULL, stdout=log, stderr=log)
    try:
        ends = time.monotonic() + limit
        while (code := child.ended(_LOOK)) is None:
            if time.monotonic() > ends:
                return TIMED_OUT, _out_of_time(task)
            if not wanted():
                return INTERRUPTED, f"{task.file}: interrupted"
    finally:
        child.end(_GRACE)
    log_lines = (folder / ".said").read_text(encoding="utf-8", errors="replace").strip().splitlines()
    line = log_lines[-1] if log_lines else ""
    if code == TIMED_OUT:
        return TIMED_OUT, _out_of_time(task)
    if code < 0:
        return UNREADABLE, f"{task.file}: the process was killed ({signal.Signals(-code).name}): out of memory, perhaps"
    line = line.removeprefix("plan-cutters: ")
    return code, line if task.file in line else line.replace(f"./{name}", task.file)


def _out_of_time(task: Task) -> str:
    advice = "sample more coarsely (--spacing), or give more time (--timeout-part)"
    return f"{task.file}: not done within {task.timeout:g} s: {advice}"


def _late(task: Task, out: Path) -> str:
    """Say in a plan that was safe before its part ran out of time what it is without; the line about the part."""
    from plan_cutters.plan_file.words.names import typed
    from plan_cutters.report.folder import ended, file_name
    from plan_cutters.report.to_json import not_written, unfinished

    ended(out, f"not done within {task.timeout:g} s")
    missing = ", ".join(map(file_name, not_written(out / PLAN)))
    text = " ".join(filter(None, (typed(unfinished(out / PLAN)), f"It is without {missing}." if missing else "")))
    return f"{_out_of_time(task)}. Late: the plan so far is there. {text}".rstrip()


def files_of(folder: Path) -> dict[str, Path]:
    """Files of a plan, the plan itself last."""
    files = {each.relative_to(folder).as_posix(): each for each in sorted(folder.rglob("*")) if each.is_file()}
    return dict(sorted(files.items(), key=lambda each: each[0] == PLAN))
