"""The run of a batch, on workers of this machine or on a cluster: parts are handed out, a bounded number at a time."""

import contextlib
import itertools
import logging
import os
import queue
import secrets
import signal
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

from plan_cutters.errors import PlanError, extra_hint
from plan_cutters.files.folder import read, refuse_memory
from plan_cutters.files.lock import require_temporary
from plan_cutters_batch import job as keys
from plan_cutters_batch import run as clusters
from plan_cutters_batch.job import UNREADABLE, USAGE, Fault, Handed, Job, Settings, handed
from plan_cutters_batch.row import PartRow
from plan_cutters_batch.store import Store
from plan_cutters_batch.work import Outcome, Task, cached, content_of, work

#: Bytes of memory for a part where nothing else is said, at least, and the share of a machine's memory that all parts may take.
LEAST_MEMORY, _SHARE = 4_000_000_000, 0.75
#: Seconds in which a scheduler must answer, and its first worker join.
_ANSWER, _JOIN = 5, 30


def workers_of(count: int | None, memory: float | None, threads: int) -> tuple[int, int]:
    """How many workers this machine has room for, and the bytes of memory of each.

    `count` as asked for, default by cores and memory; `memory` in bytes and `threads` are those of a part.
    """
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    try:
        whole = int(_SHARE * os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
    except (AttributeError, ValueError, OSError):
        whole = LEAST_MEMORY * cores
    count = count or max(1, min(cores // threads, int(whole // (memory or LEAST_MEMORY))))
    return count, int(memory or max(LEAST_MEMORY, whole // count))


@contextlib.contextmanager
def opened(address: str | None, workers: int = 1) -> Iterator[Any]:
    """A client of a cluster: the one of an address or a scheduler's file, or workers of this machine that end with the block.

    A PlanError where there is no scheduler, it has no workers, or versions differ.
    """
    try:
        import distributed
    except ImportError:
        raise PlanError(f"the package distributed is not there: {extra_hint('batch')}") from None
    with contextlib.ExitStack() as stack:
        stack.enter_context(_quiet())
        if address is None:
            require_temporary()
            with _deaf():
                # Memory is that of the children, which dask does not see: it is limited there.
                cluster = stack.enter_context(
                    distributed.LocalCluster(n_workers=workers, threads_per_worker=1, processes=True, memory_limit=0,
                                             dashboard_address=":0", silence_logs=logging.CRITICAL)
                )  # fmt: skip
            client = stack.enter_context(distributed.Client(cluster))
        else:
            client = stack.enter_context(_reached(distributed, address))
            _same(client)
        yield client


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    """Keep the lines and tracebacks of dask from people: what goes wrong is said here, once."""
    # Dask gives some of its loggers levels of their own.
    loggers = [
        logging.getLogger(name)
        for name in ("distributed", *logging.root.manager.loggerDict)
        if name.partition(".")[0] == "distributed"
    ]
    before = [logger.level for logger in loggers]
    for logger in loggers:
        logger.setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        for logger, level in zip(loggers, before, strict=True):
            logger.setLevel(level)


@contextlib.contextmanager
def _deaf() -> Iterator[None]:
    """Start processes that ignore an interrupt from the terminal: it is for this one, which ends them."""
    try:
        before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    except ValueError:  # not the main thread
        yield
        return
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


@contextlib.contextmanager
def _reached(distributed: Any, address: str) -> Iterator[Any]:
    words: dict[str, Any] = {"address": address}
    if os.path.isfile(address):
        words = {"scheduler_file": address}
    elif "://" not in address:
        raise PlanError("no such file, and no address as tcp://HOST:8786", file=f"--cluster {address}")
    try:
        client = distributed.Client(**words, timeout=_ANSWER)
    except (OSError, ValueError, TypeError) as error:
        why = "it did not answer" if isinstance(error, TimeoutError) or not str(error) else "it cannot be reached"
        raise PlanError(
            f"{why} within {_ANSWER} s: does the scheduler run, and can this machine reach it?", file=f"--cluster {address}"
        ) from None
    except Exception as error:
        raise PlanError(f"no scheduler ({type(error).__name__})", file=f"--cluster {address}") from None
    try:
        try:
            client.wait_for_workers(1, timeout=_JOIN)
        except TimeoutError:
            raise PlanError(
                f"the scheduler has no worker, and none joined within {_JOIN} s: start some", file=f"--cluster {address}"
            ) from None
        yield client
    finally:
        client.close()


def _same(client: Any) -> None:
    """An error where a worker has other versions than this process."""
    here = keys.versions()
    for where, there in client.run(keys.versions, on_error="return").items():
        if isinstance(there, BaseException):
            raise PlanError(f"worker {where} cannot load plan-cutters ({type(there).__name__}): install it there, as it is here")
        for name, version in here.items():
            if there.get(name) != version:
                raise PlanError(f"worker {where} has {name} {there.get(name)}, this machine {version}: install the same on both")


def facts(client: Any) -> dict[str, object]:
    """Say of a cluster what the table names: its address, workers and threads, and where dask shows it."""
    from importlib.util import find_spec

    threads = client.nthreads()
    # Where bokeh is not there, dask has none.
    board = str(client.dashboard_link) if find_spec("bokeh") and client.dashboard_link else None
    address = client.scheduler.address
    return {"address": address, "workers": len(threads), "threads": sum(threads.values()), "dashboard": board}


#: Tasks in flight for each thread of the cluster, and at least so many: the next one is there when a thread is free.
_QUEUED, _LEAST = 2, 8
#: How often a quiet run looks around, s, and how long its scheduler may be gone before it is given up.
_LOOK, _GONE = 1.0, 20.0


class ProgressListener(Protocol):
    """Who is told how far a run is: `progress.Board`."""

    def progress(self, done: int, running: int, total: int | None) -> None:
        """So many parts are done and so many are with workers, of all."""

    def say(self, text: str) -> None:
        """A line for people."""


@dataclass
class Terms:
    """On what terms parts are planned: `force` what is done, too; seconds and bytes for a part."""

    force: bool = False
    timeout: float | None = None
    memory: float | None = None
    packed: dict[int, tuple[Settings, Handed, str]] = field(default_factory=dict)

    def of(self, settings: Settings) -> tuple[Handed, str]:
        """Settings as they travel, and their key: made once for all parts that share them."""
        packed = self.packed.get(id(settings))
        if packed is None:
            there = handed(settings.options)
            # The settings are kept with it, so that no other ones get their number.
            packed = self.packed[id(settings)] = (settings, there, keys.settings_key(settings, there))
        return packed[1], packed[2]


def run_batch(
    parts: Sequence[Job | Fault], client: Any, out: Store, terms: Terms, *, board: ProgressListener | None = None,
    title: str = "plan-cutters batch",
) -> Iterator[PartRow]:  # fmt: skip
    """Plan parts on a cluster (`distributed.Client`), and write the table of all when the last one is done.

    Rows come as they are made, one for each part, the failed ones too; a PlanError where the output cannot be written.
    """
    from plan_cutters_batch.summary import write_index

    began = time.monotonic()
    token = out.begin()
    rows: list[PartRow] = []
    try:
        facts = clusters.facts(client)
        faults = [part for part in parts if isinstance(part, Fault)]
        jobs = [part for part in parts if isinstance(part, Job)]
        for fault in faults:
            rows.append(fault.row)
            yield fault.row
        for outcome in outcomes(jobs, client, terms, out=out, token=token, board=board):
            rows.append(outcome.row)
            yield outcome.row
        rows.sort(key=lambda row: row.name)
        write_index(rows, out.put, title=title, seconds=time.monotonic() - began, cluster=facts)
    finally:
        out.end()


def outcomes(
    jobs: Iterable[Job], client: Any, terms: Terms, *, out: Store | None = None, token: str = "",
    board: ProgressListener | None = None, total: int | None = None,
) -> Iterator[Outcome]:  # fmt: skip
    """Plan parts on a cluster; outcomes as they come. Without `out`, the files come with them."""
    if total is None and isinstance(jobs, Sequence):
        total = len(jobs)
    versions = keys.versions()
    where = None if out is None else out.root_url
    faulty: list[Outcome] = []

    def tasks() -> Iterator[Task]:
        for job in jobs:
            try:
                refuse_memory(job.file)
                there, key = terms.of(job.settings)
            except PlanError as error:
                faulty.append(Outcome(_failed(job, str(error), USAGE), {}))
                continue
            settings = job.settings
            words = ["--formats", ",".join(settings.formats), "--step-schema", settings.step_schema,
                     "--read-timeout", repr(settings.read_timeout), *([] if settings.cache else ["--no-cache"]),
                     *([] if terms.memory is None else ["--memory", repr(terms.memory / 1e9)])]  # fmt: skip
            yield Task(job.name, job.file, job.part, there, tuple(words), key, where, token, terms.force, terms.timeout,
                       versions, job.file if "://" in job.file else os.path.abspath(job.file))  # fmt: skip

    for task, outcome in handed_out(client, tasks(), work, board=board, total=total):
        if isinstance(outcome, BaseException):
            yield Outcome(_failed(task, _lost_worker(task, outcome), UNREADABLE), {})
        else:
            yield outcome
        while faulty:
            yield faulty.pop()
    yield from faulty


def handed_out(
    client: Any, tasks: Iterator[Any], function: Callable[[Any], Any], *, board: ProgressListener | None = None,
    total: int | None = None,
) -> Iterator[tuple[Any, Any]]:  # fmt: skip
    """Work on tasks on a cluster, a bounded number at a time; each with its result, or the exception that it ended in.

    What is asked of dask never grows with the number of tasks, so that neither this process nor the scheduler does. A task
    whose worker is lost goes to another one (dask's `allowed-failures`); what the function raises is not tried again. A worker
    that is unfit (`Outcome.unfit`) gets no more tasks as long as there are others: it would fail them all in no time.
    """
    flight, done = _Flight(client, tasks, function), 0
    try:
        while not flight.gone():
            flight.fill()
            if board is not None:
                board.progress(done, len(flight.tasks), total)
            if not flight.tasks:
                return
            answer = flight.answer()
            if answer is None:
                continue
            task, outcome = answer
            if flight.for_another(outcome):
                if board is not None:
                    board.say(f"worker {outcome.unfit} is left out: {outcome.row.error}")
                flight.hand(task)
                continue
            done += 1
            yield task, outcome
        for task in itertools.chain(flight.tasks.values(), tasks):
            why = "the connection to the scheduler broke: run the same command again, what is done is reused"
            yield task, ConnectionError(why)
    finally:
        flight.cancel()


class _Flight:
    """Tasks that a cluster works on, by their futures, and what comes of them."""

    def __init__(self, client: Any, tasks: Iterator[Any], function: Callable[[Any], Any]) -> None:
        self.tasks: dict[Any, Any] = {}
        self._client, self._more, self._function = client, tasks, function
        self._run, self._count = secrets.token_hex(4), itertools.count()
        self._ready: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._threads: dict[str, int] = {}
        self._unfit: set[str] = set()
        self._looked = self._gone = 0.0
        self._most, self._begun_all = _LEAST, False

    def hand(self, task: Any) -> None:
        """Begin a task."""
        fit = [each for each in self._threads if each not in self._unfit] if self._unfit else None
        future = self._client.submit(self._function, task, key=f"plan-{self._run}-{next(self._count)}", pure=False, retries=0,
                                     workers=fit or None, allow_other_workers=bool(fit))  # fmt: skip
        self.tasks[future] = task
        future.add_done_callback(self._ready.put)

    def fill(self) -> None:
        """Begin as many tasks as the cluster is to have at a time; none while its scheduler is gone."""
        if self._gone:
            return
        if time.monotonic() - self._looked > _LOOK:
            self._threads, self._looked = _threads(self._client), time.monotonic()
            self._most = max(_LEAST, _QUEUED * sum(self._threads.values()))
        while not self._begun_all and len(self.tasks) < self._most:
            task = next(self._more, None)
            if task is None:
                self._begun_all = True
            else:
                self.hand(task)

    def answer(self) -> tuple[Any, Any] | None:
        """A task that has ended, with its result or the exception that it ended in; None where it is quiet for a while."""
        try:
            future = self._ready.get(timeout=_LOOK)
        except queue.Empty:
            self._gone = 0.0 if self._client.status == "running" else self._gone or time.monotonic()
            return None
        if future not in self.tasks:
            return None
        task = self.tasks.pop(future)
        try:
            outcome = future.result(timeout=60)
        except Exception as error:
            outcome = error
        future.release()
        return task, outcome

    def gone(self) -> bool:
        """Whether the scheduler has been gone for too long."""
        return bool(self._gone) and (self._client.status == "closed" or time.monotonic() - self._gone > _GONE)

    def for_another(self, outcome: Any) -> bool:
        """Whether a task is for another worker, since its own is unfit and there is one."""
        where = getattr(outcome, "unfit", "")
        if not where:
            return False
        self._unfit.add(where)
        self._threads = _threads(self._client)
        return any(each not in self._unfit for each in self._threads)

    def cancel(self) -> None:
        """Begin none of what has not begun."""
        if self.tasks and self._client.status == "running":
            self._client.cancel(list(self.tasks))


def _threads(client: Any) -> dict[str, int]:
    """How many threads each worker has."""
    try:
        return dict(client.nthreads())
    except Exception:  # a scheduler that is gone is looked after elsewhere
        return {}


def _lost_worker(task: Task, error: BaseException) -> str:
    name = type(error).__name__
    if name == "KilledWorker":
        return f"{task.file}: the worker ended at this part, and others after it (killed, or out of memory): it is left out"
    if name in ("CancelledError", "FutureCancelledError"):
        return f"{task.file}: the connection to the scheduler broke: run the same command again, what is done is reused"
    return f"{task.file}: {' '.join(str(error).split()) or name}"


def _failed(job: Job | Task, why: str, code: int) -> PartRow:
    return PartRow(name=job.name, file=job.file, status="failed", code=code, error=why)


def foreseen(parts: Iterable[Job | Fault], out: Store, terms: Terms) -> Iterator[PartRow]:
    """Say of each part what a run would do, and do nothing: `planned` with no verdict yet, `kept` or `failed`."""
    for part in parts:
        if isinstance(part, Fault):
            yield part.row
            continue
        try:
            there, key = terms.of(part.settings)
            task = Task(part.name, part.file, part.part, there, (), key, out.url, "", False, None, {})
            key = keys.key(content_of(task).key, task.settings)
            row = None if terms.force else cached(out, task.folder, key, task.name, task.file)
            if row is None:
                read(part.file) if part.part is None and terms.force else None
            yield row or PartRow(name=part.name, file=part.file, status="planned", code=0)
        except PlanError as error:
            yield _failed(part, str(error), UNREADABLE)
