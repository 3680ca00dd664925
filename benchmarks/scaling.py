"""What do more workers bring, and what does the scheduler cost? Points a and d of `docs/scaling.md`.

    python benchmarks/scaling.py parts FOLDER [--parts 200] [--grid 31] [--workers 1 2]
    python benchmarks/scaling.py queue [--parts 100000] [--seconds 0.1] [--threads 32]

`parts`: CAD files of FOLDER and of `samples`, again and again until there are so many, planned one by one by workers of one
thread. `queue`: parts that only wait, handed out to a scheduler and workers in processes of their
own; memory of this process and of the scheduler on the way.

Clocks tell little on a busy machine: processor seconds of the workers stand beside them. Machine code is made before.
"""

import argparse
import contextlib
import itertools
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import psutil
from distributed import Client, LocalCluster, wait

ROOT = Path(__file__).resolve().parent.parent
OPTIONS = {"cutters": ("R6L60", "R6L60rc1"), "grid": 31, "jobs": 1, "area_budget": 2000}
CAD = (".step", ".stp", ".igs", ".iges", ".brep")


@contextlib.contextmanager
def local(workers: int) -> Iterator[Client]:
    with (
        LocalCluster(n_workers=workers, threads_per_worker=1, memory_limit=0, dashboard_address=":0") as cluster,
        Client(cluster) as client,
    ):
        client.run(ready)
        yield client


def ready() -> None:
    """Load all that a plan needs, so that it is not counted."""
    from plan_cutters.pipeline import prepare

    prepare(ROOT / "samples/v_groove.step", options())


def options(**more: object):  # type: ignore[no-untyped-def]
    from plan_cutters.options import Options

    return Options.of(OPTIONS | more)


def spent() -> float:
    """Processor seconds of this process and of what it began and has waited for."""
    return sum(os.times()[:4])


def parts(folder: Path, count: int, grid: int, workers: list[int]) -> None:
    """(a) Many parts: rate, and the share of the threads' time that is not spent on a part."""
    from plan_cutters import plan_many

    files = [f for f in sorted(folder.rglob("*")) if f.suffix.lower() in CAD] + sorted((ROOT / "samples").glob("*.step"))
    named = [(f"{k:03}-{file.stem}", str(file)) for k, file in enumerate(itertools.islice(itertools.cycle(files), count))]
    print(f"{count} parts of {len(files)} files, {len(OPTIONS['cutters'])} cutters, grid {grid}", flush=True)  # type: ignore[arg-type]
    first = 0.0
    for each in workers:
        with local(each) as client, tempfile.TemporaryDirectory() as out:
            before, began = sum(client.run(spent).values()), time.perf_counter()
            rows = [found.row for found in plan_many(named, client, out=out, **OPTIONS | {"grid": grid})]
            clock, used = time.perf_counter() - began, sum(client.run(spent).values()) - before
        if len(rows) != count or len({row.name for row in rows}) != count:
            raise SystemExit(f"{count} parts, {len(rows)} rows")
        inside = sum(row.seconds for row in rows)
        first = first or count / clock
        failed = sum(row.status == "failed" for row in rows)
        print(f"{each} workers: {clock:.1f} s, {count / clock:.3f} parts/s ({count / clock / first:.2f} times), "
              f"processor {used:.1f} s, "
              f"not within a part {100 * (1 - inside / (each * clock)):.1f} %, failed {failed}", flush=True)  # fmt: skip


def rest(task: tuple[int, float]) -> tuple[int, bytes]:
    """A part that is simulated: it waits, and hands back about as much as a row of the table."""
    time.sleep(task[1])
    return task[0], bytes(600)


def queue(count: int, seconds: float, threads: int) -> None:
    """(d) Parts that only wait: how fast they are handed out, and the memory of client and scheduler."""
    from plan_cutters_batch.run import handed_out

    with tempfile.TemporaryDirectory() as folder:
        file = f"{folder}/scheduler.json"
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), *sys.path])}
        dask = [sys.executable, "-m", "distributed.cli.dask_scheduler", "--port", "0", "--dashboard-address", ":0",
                "--scheduler-file", file]  # fmt: skip
        work = [sys.executable, "-m", "distributed.cli.dask_worker", "--scheduler-file", file, "--nthreads", str(threads),
                "--no-nanny", "--no-dashboard", "--memory-limit", "0", "--local-directory", folder]  # fmt: skip
        begun = [subprocess.Popen(dask, env=environment, stderr=subprocess.DEVNULL)]
        try:
            while not os.path.exists(file):
                time.sleep(0.1)
            begun += [subprocess.Popen(work, env=environment, stderr=subprocess.DEVNULL) for _ in range(2)]
            with Client(scheduler_file=file) as client:
                client.wait_for_workers(2)
                wait(client.map(rest, [(k, 0.0) for k in range(100)], pure=False))
                scheduler, here = psutil.Process(begun[0].pid), psutil.Process()
                began, seen = time.perf_counter(), set()
                used = spent_by(scheduler), spent_by(here)
                print(
                    f"{count} parts of {seconds:g} s, 2 workers of {threads} threads: at most {2 * threads / seconds:.0f} parts/s"
                )
                tasks = ((k, seconds) for k in range(count))
                for done, (_, found) in enumerate(handed_out(client, tasks, rest, total=count), 1):
                    if isinstance(found, BaseException):
                        raise found
                    seen.add(found[0])
                    if done in {count // 100, count // 10, count // 4, count // 2, count}:
                        clock = time.perf_counter() - began
                        print(f"{done:7} after {clock:6.1f} s, {done / clock:6.0f} parts/s, memory: scheduler "
                              f"{scheduler.memory_info().rss / 1e6:.0f} MB, client {here.memory_info().rss / 1e6:.0f} MB, "
                              f"processor: scheduler {spent_by(scheduler) - used[0]:.1f} s, "
                              f"client {spent_by(here) - used[1]:.1f} s",
                              flush=True)  # fmt: skip
                if len(seen) != count:
                    raise SystemExit(f"{count - len(seen)} parts are lost")
        finally:
            for each in reversed(begun):
                each.terminate()
            for each in begun:
                try:
                    each.wait(10)
                except subprocess.TimeoutExpired:  # a worker may wait for a scheduler that has gone
                    each.kill()


def spent_by(process: psutil.Process) -> float:
    return sum(process.cpu_times()[:2])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    what = parser.add_subparsers(dest="what", required=True)
    many = what.add_parser("parts")
    many.add_argument("folder", type=Path)
    many.add_argument("--parts", type=int, default=200)
    many.add_argument("--grid", type=int, default=31)
    many.add_argument("--workers", type=int, nargs="+", default=[1, 2])
    waits = what.add_parser("queue")
    waits.add_argument("--parts", type=int, default=100_000)
    waits.add_argument("--seconds", type=float, default=0.1)
    waits.add_argument("--threads", type=int, default=32)
    given = parser.parse_args()
    match given.what:
        case "parts":
            parts(given.folder, given.parts, given.grid, given.workers)
        case "queue":
            queue(given.parts, given.seconds, given.threads)


if __name__ == "__main__":
    main()
