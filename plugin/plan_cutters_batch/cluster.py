"""Where the parts are planned: workers of this machine, or a cluster that runs already."""

import contextlib
import logging
import os
import signal
from collections.abc import Iterator
from typing import Any

from plan_cutters.errors import PlanError, extra_hint
from plan_cutters.files.lock import require_temporary
from plan_cutters_batch import keys

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
