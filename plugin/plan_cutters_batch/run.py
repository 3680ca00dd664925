"""The run of a batch, on workers of this machine or on a cluster: parts are handed out, a bounded number at a time."""

import contextlib
import itertools
import logging
import os
import pickle
import queue
import signal
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path, PurePath
from typing import TYPE_CHECKING, Any, Unpack

from plan_cutters.domain.checks import spelled_out
from plan_cutters.errors import OptionError, PlanError, extra_hint
from plan_cutters.files.folder import refuse_memory
from plan_cutters.files.lock import require_temporary
from plan_cutters.options import Options, PlanOptions
from plan_cutters_base.user_files import noted
from plan_cutters_batch.job import Job, Settings, key_of, versions
from plan_cutters_batch.row import UNREADABLE, PartRow, failed
from plan_cutters_batch.store import Store
from plan_cutters_batch.work import Outcome, Task, cached, work

if TYPE_CHECKING:
    from plan_cutters.plan_file.model import Plan
    from plan_cutters_batch.progress import Board

#: Bytes of memory for a part where nothing else is said, at least, and the share of a machine's memory that all parts may take.
LEAST_MEMORY, _SHARE = 4_000_000_000, 0.75
#: Seconds in which a scheduler must answer, and its first worker join.
_ANSWER, _JOIN = 5, 30


def workers_of(count: int | None, memory: float | None, threads: int) -> tuple[int, int]:
    """How many workers this machine has room for, `count` if wanted, and the bytes of each; memory and threads are of a part."""
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
    names = ("distributed", *logging.root.manager.loggerDict)
    loggers = [logging.getLogger(name) for name in names if name.partition(".")[0] == "distributed"]
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
    def fault(why: str) -> PlanError:
        return PlanError(why, file=f"--cluster {address}")

    words: dict[str, Any] = {"address": address}
    if os.path.isfile(address):
        words = {"scheduler_file": address}
    elif "://" not in address:
        raise fault("no such file, and no address as tcp://HOST:8786")
    try:
        client = distributed.Client(**words, timeout=_ANSWER)
    except (OSError, ValueError, TypeError) as error:
        why = "it did not answer" if isinstance(error, TimeoutError) or not str(error) else "it cannot be reached"
        raise fault(f"{why} within {_ANSWER} s: does the scheduler run, and can this machine reach it?") from None
    except Exception as error:
        raise fault(f"no scheduler ({type(error).__name__})") from None
    with contextlib.closing(client):
        try:
            client.wait_for_workers(1, timeout=_JOIN)
        except TimeoutError:
            raise fault(f"the scheduler has no worker, and none joined within {_JOIN} s: start some") from None
        yield client


def _same(client: Any) -> None:
    """An error where a worker has other versions than this process."""
    here = versions()
    for where, there in client.run(versions, on_error="return").items():
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
_BROKE = "the connection to the scheduler broke: run the same command again, what is done is reused"


@dataclass(frozen=True)
class Terms:
    """On what terms parts are planned: `force` what is done, too; seconds and bytes for a part."""

    force: bool = False
    timeout: float | None = None
    memory: float | None = None


def run_batch(
    parts: Sequence[Job | PartRow], client: Any, out: Store, terms: Terms, *, board: "Board | None" = None,
    title: str = "plan-cutters batch",
) -> Iterator[PartRow]:  # fmt: skip
    """Plan parts on a cluster (`distributed.Client`), and write the table of all when the last one is done.

    Rows come as they are made, one for each part, the failed ones too; a PlanError where the output cannot be written.
    """
    from plan_cutters_batch.summary import write_index

    began = time.monotonic()
    rows: list[PartRow] = []
    try:
        where = facts(client)
        planned = outcomes([part for part in parts if isinstance(part, Job)], client, terms, out=out, board=board)
        for row in itertools.chain((part for part in parts if isinstance(part, PartRow)), (each.row for each in planned)):
            rows.append(row)
            yield row
        write_index(rows, out.put, title=title, seconds=time.monotonic() - began, cluster=where)
    finally:
        out.end()


def outcomes(
    parts: Iterable[Job | PartRow], client: Any, terms: Terms, *, out: Store | None = None,
    board: "Board | None" = None,
) -> Iterator[Outcome]:  # fmt: skip
    """Plan parts on a cluster; outcomes as they come, those of faulty parts too; without `out`, the files come with them."""
    here = versions()
    store, token = (None, "") if out is None else (out.root_url, out.begin())
    more = () if terms.memory is None else ("--memory", repr(terms.memory / 1e9))
    faulty: list[PartRow] = []

    def tasks() -> Iterator[Task]:
        for job in parts:
            if isinstance(job, PartRow):
                faulty.append(job)
                continue
            try:
                refuse_memory(job.file)
                handed, key = job.settings.handed, job.settings.key
            except PlanError as error:
                faulty.append(failed(job.name, job.file, str(error)))
                continue
            source = job.file if "://" in job.file else os.path.abspath(job.file)
            yield Task(job.name, job.file, job.part, handed, (*job.settings.words, *more), key, store, token, terms.force,
                       terms.timeout, here, source)  # fmt: skip

    for task, outcome in handed_out(client, tasks(), work, board=board):
        if isinstance(outcome, BaseException):
            yield Outcome(failed(task.name, task.file, f"{task.file}: {_why(outcome)}", UNREADABLE))
        else:
            yield outcome
        while faulty:
            yield Outcome(faulty.pop(0))
    yield from map(Outcome, faulty)


def _why(error: BaseException) -> str:
    name = type(error).__name__
    if name == "KilledWorker":
        return "the worker ended at this part, and others after it (killed, or out of memory): it is left out"
    if name in ("CancelledError", "FutureCancelledError"):
        return _BROKE
    return " ".join(str(error).split()) or name


def handed_out(
    client: Any, tasks: Iterator[Any], function: Callable[[Any], Any], *, board: "Board | None" = None
) -> Iterator[tuple[Any, Any]]:
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
                board.progress(done, len(flight.tasks))
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
            yield task, ConnectionError(_BROKE)
    finally:
        # What has not begun is not begun.
        if flight.tasks and client.status == "running":
            client.cancel(list(flight.tasks))


class _Flight:
    """Tasks that a cluster works on, by their futures, and what comes of them."""

    def __init__(self, client: Any, tasks: Iterator[Any], function: Callable[[Any], Any]) -> None:
        self.tasks: dict[Any, Any] = {}
        self._client, self._more, self._function = client, tasks, function
        self._ready: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._threads: dict[str, int] = {}
        self._unfit: set[str] = set()
        self._looked = self._gone = 0.0
        self._most = _LEAST

    def hand(self, task: Any) -> None:
        """Begin a task."""
        fit = [each for each in self._threads if each not in self._unfit] if self._unfit else None
        future = self._client.submit(self._function, task, pure=False, workers=fit or None, allow_other_workers=bool(fit))
        self.tasks[future] = task
        future.add_done_callback(self._ready.put)

    def fill(self) -> None:
        """Begin as many tasks as the cluster is to have at a time; none while its scheduler is gone."""
        if self._gone:
            return
        if time.monotonic() - self._looked > _LOOK:
            self._threads, self._looked = _threads(self._client), time.monotonic()
            self._most = max(_LEAST, _QUEUED * sum(self._threads.values()))
        while len(self.tasks) < self._most and (task := next(self._more, None)) is not None:
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


def _threads(client: Any) -> dict[str, int]:
    """How many threads each worker has."""
    try:
        return dict(client.nthreads())
    except Exception:  # a scheduler that is gone is looked after elsewhere
        return {}


def foreseen(parts: Iterable[Job | PartRow], out: Store, terms: Terms) -> Iterator[PartRow]:
    """Say of each part what a run would do, and do nothing: `planned` with no verdict yet, `kept` or `failed`."""
    for part in parts:
        if isinstance(part, PartRow):
            yield part
            continue
        try:
            key = key_of(part.content(), part.settings.key)
            row = None if terms.force else cached(out, f"{part.name}-plan", key, part.name, part.file)
            yield row or PartRow(name=part.name, file=part.file, status="planned", code=0)
        except PlanError as error:
            yield failed(part.name, part.file, str(error), UNREADABLE)


@dataclass(frozen=True)
class Planned:
    """A result holds what came of one of many parts: its `row` of the table, and its `files`, where no output was named."""

    row: PartRow
    files: dict[str, bytes] = field(default_factory=dict, repr=False)
    _out: str | None = field(default=None, repr=False)

    @property
    def plan(self) -> "Plan | None":
        """The plan document; None where the part failed: then `row.error` says why."""
        from plan_cutters.files.folder import read
        from plan_cutters.plan_file.load import plan_of

        if self.row.folder is None or self.row.status == "failed":
            return None
        content = self.files.get("plan.json") or read(f"{self._out}/{self.row.folder}/plan.json")
        return plan_of(content, "plan.json")


@spelled_out(PlanOptions, Options)
def plan_many(
    parts: Iterable[Any], client: Any = None, *, out: str | os.PathLike[str] | None = None,
    formats: Sequence[str] = ("json",), force: bool = False, timeout_part: float | None = None,
    limit_memory: float | None = None, **options: Unpack[PlanOptions],
) -> Iterator[Planned]:  # fmt: skip
    """Plan many parts, each in a process of its own; results as they come, a failed part among them.

    Parameters
    ----------
    parts : iterable
        Paths, URLs, or objects as `plan` takes them (CadQuery, build123d, `cad_io.Part`). Of objects, the name is their place:
        `part-1`. A pair (name, part) gives another name. They are requested as they are needed.
    client : distributed.Client, optional
        Of a running cluster; default workers of this machine, as many as its cores and memory allow, for this call.
    out : path or URL, optional
        Folder for the files; a part that is done there with the same key is not planned again. Default: results hold their files.
    formats : sequence of str
        As `Result.write` takes them; `json` is always among them.
    force : bool
        Plan what is done, too.
    timeout_part : float, optional
        Seconds for a part.
    limit_memory : float, optional
        GB for a part.
    **options
        As of `plan`; `jobs` is 1 unless it is given.

    Yields
    ------
    Planned

    Raises
    ------
    PlanError
        An option has no meaning, the output cannot be written, or there is no cluster.

    Notes
    -----
    Workers of this machine are started with `spawn`, as dask does: a script calls this below `if __name__ == "__main__":`.
    """
    from plan_cutters.report.folder import read_formats

    refuse_memory(os.fspath(out or ""))
    if isinstance(parts, str | os.PathLike):
        raise OptionError("parts is one path: give a list of parts, or use the command `batch` for folders")
    if isinstance(parts, Sequence) and not parts:
        raise OptionError("parts: the list is empty")
    with noted() as files:
        base = Options.of({"jobs": 1, **options})
    settings = Settings(base, read_formats(",".join(formats)), read=tuple(filter(None, files.values())))
    store = None if out is None else Store(os.fspath(out))
    with contextlib.ExitStack() as stack:
        if store:
            store.begin()  # what is wrong with it is said before any worker is started
            stack.callback(store.end)
        memory = None if limit_memory is None else limit_memory * 1e9
        if client is None:
            count, memory = workers_of(None, memory, settings.options.jobs)
            client = stack.enter_context(opened(None, count))
        terms = Terms(force, timeout_part, memory)
        for outcome in outcomes(_jobs(parts, settings), client, terms, out=store):
            yield Planned(outcome.row, dict(outcome.files), None if store is None else store.root_url)


def _jobs(parts: Iterable[Any], settings: Settings) -> Iterator[Job | PartRow]:
    """Jobs of parts as they are requested, and rows of those that cannot be planned."""
    from cad_io import read_part

    names: set[str] = set()
    for number, entry in enumerate(parts, 1):
        name, part = entry if isinstance(entry, tuple) and len(entry) == 2 and isinstance(entry[0], str) else (None, entry)
        is_file = isinstance(part, str | PurePath)
        file = str(part) if is_file else f"part {number}"
        name = name or (Path(file).stem if is_file else f"part-{number}")
        try:
            if name.casefold() in names:
                raise OptionError(f"has the name {name!r}, as an earlier part: give pairs (name, part)", file=file)
            if name in ("", ".", "..") or "/" in name or "\\" in name or not name.isprintable():
                raise OptionError(f"the name {name!r} cannot be a folder's", file=file)
            names.add(name.casefold())
            if is_file:
                yield Job(name, file, settings)
            else:
                result = read_part(part, settings.options.unit)
                yield Job(name, file, settings.faced(result), pickle.dumps(result, protocol=5))
        except PlanError as error:
            yield failed(f"{name} ({number})" if name.casefold() in names else name, file, str(error))
        except Exception as error:
            yield failed(name, file, f"{file}: {' '.join(str(error).split()) or type(error).__name__}", UNREADABLE)
