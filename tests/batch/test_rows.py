"""A part that is cut into rows and handed out is judged as in a single run, bit for bit."""

import itertools
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from dataclasses import fields

import numpy as np
import pytest
from distributed import Client, LocalCluster
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import plan_cutters
from plan_cutters import Cutter, Options, PlanError
from plan_cutters.batch import distributed_judge as cut
from plan_cutters.batch.distributed_judge import DistributedJudge, judged_block
from plan_cutters.document.clock import Clock
from plan_cutters.domain.nesting import handed
from plan_cutters.domain.verdicts import ACCESSIBLE, INTERFERENCE_FREE, UNJUDGED, Verdicts
from plan_cutters.pipeline import prepare, run
from plan_cutters.scene.ground import Ground
from plan_cutters.scene.threads import CHUNK
from plan_cutters.scene.work import Work
from plan_cutters.stages.judge import judge
from tests.support.places import SAMPLES

PART = SAMPLES / "peaks_and_valleys.step"
CUTTERS = ("R6L60", "R3L40", "R3L40rc3")
ASKED = {"cutters": CUTTERS, "grid": 61, "rotation_step": 0.35}


@pytest.fixture(scope="module")
def client():
    with (
        LocalCluster(n_workers=2, threads_per_worker=1, processes=False, dashboard_address=":0") as cluster,
        Client(cluster, set_as_default=False) as found,
    ):
        yield found


@pytest.fixture(scope="module")
def ready():
    return prepare(PART, Options.of(ASKED))


@pytest.fixture(scope="module")
def single(ready):
    """Of each cutter: verdicts, what followed from others, and the work."""
    found = {}
    for cutter in ready.cutters:
        known = handed(cutter, {c: verdicts for c, (verdicts, _, _) in found.items()}, len(ready.samples))
        work = Work()
        found[cutter] = judge(ready, cutter, known=known, work=work), known, work.looked
    assert any((known.verdict != UNJUDGED).any() for _, known, _ in found.values())
    assert {ACCESSIBLE, INTERFERENCE_FREE} <= {
        v for verdicts, _, _ in found.values() for v in np.unique(verdicts.verdict).tolist()
    }
    return found


def told(result):
    """The plan, but for how long it took."""
    return result.plan.model_dump(exclude={"run"})


@given(block=st.integers(1, 5000), reverse=st.booleans())
@settings(max_examples=6, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_however_it_is_cut_the_verdicts_and_the_work_are_those_of_one_run(client, ready, single, block, reverse):
    judged = DistributedJudge(client, large=0, block=block)
    for cutter in sorted(single, key=lambda c: c.id, reverse=reverse):
        verdicts, known, looked = single[cutter]
        work = Work()
        steps: list[tuple[int, int]] = []
        tell = lambda *at, steps=steps: steps.append(at)  # noqa: E731
        assert judged(ready, cutter, known=known, progress=tell, work=work) == verdicts
        assert work.looked == looked
        pieces = -(-len(ready.samples) // (CHUNK * -(-block // CHUNK)))
        assert steps == [(k, pieces) for k in range(1, pieces + 1)]


@given(st.lists(st.integers(0, 3721 // CHUNK), max_size=4))
@settings(max_examples=10, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_any_pieces_of_a_ground_are_judged_as_the_whole(ready, single, places):
    n = len(ready.samples)
    ground = pickle.loads(pickle.dumps(Ground.of(ready)))
    ends = sorted({0, n, *(min(n, CHUNK * each) for each in places)})
    for cutter, (whole, known, _) in single.items():
        for first, last in itertools.pairwise(ends):
            here = np.arange(first, last)
            assert judge(ground.block(first, last), cutter, known=known.of(here)) == whole.of(here)


def test_a_ground_holds_no_shape_of_the_kernel(ready):
    packed = pickle.dumps(Ground.of(ready))
    assert b"OCP" not in packed
    assert b"TopoDS" not in packed
    assert b"cad_io.part.part" not in packed  # a Part would bring its shape


@pytest.mark.slow("starts servers or clusters")
def test_a_plan_is_the_same_with_its_area_bound_and_other_setups_and_fixtures(client, tmp_path):
    asked = ASKED | {"grid": 25, "other_setups": [(0, 1, 1)], "fixtures": "table"}
    one = run(PART, Options.of(asked), Clock())
    other = run(PART, Options.of(asked), Clock(), judged=DistributedJudge(client, large=0, block=CHUNK))
    assert told(one) == told(other)
    assert one.plan.cutters[0].area is not None or any(each.area for each in one.plan.cutters)
    for cutter, verdicts in one.here.items():
        assert other.here[cutter] == verdicts
    for (_, mine), (_, theirs) in zip(one.elsewhere, other.elsewhere, strict=True):
        assert mine == theirs


def test_python_takes_a_client(client, monkeypatch):
    monkeypatch.setattr(cut, "LARGE", 0)
    monkeypatch.setitem(DistributedJudge.__init__.__kwdefaults__, "large", 0)
    asked = {"cutters": "R6L60", "grid": 25, "area_budget": 0}
    sent = []
    real = client.submit
    monkeypatch.setattr(client, "submit", lambda *given, **more: sent.append(1) or real(*given, **more))
    assert told(plan_cutters.plan(PART, client=client, **asked)) == told(plan_cutters.plan(PART, **asked))
    assert sent


def test_a_small_part_and_single_rows_are_judged_here(ready, single):
    cutter = next(iter(single))
    verdicts, known, _ = single[cutter]
    nobody = DistributedJudge(None)
    assert nobody(ready, cutter, known=known) == verdicts
    rows = np.arange(100, 700)
    assert DistributedJudge(None, large=0)(ready, cutter, rows, known) == verdicts.of(rows)


def test_what_judging_raises_is_raised(client, ready, monkeypatch):
    def broken(*given, **more):
        raise ZeroDivisionError("at sample 7")

    monkeypatch.setattr(cut, "judge", broken)
    with pytest.raises(ZeroDivisionError, match="at sample 7"):
        DistributedJudge(client, large=0)(ready, ready.cutters[0])


def test_a_worker_of_another_version_is_refused(ready):
    answer = judged_block("t", b"", 0, 1, ready.cutters[0], None, "plan-cutters 9.9")
    assert isinstance(answer, str)
    assert "9.9" in answer
    assert cut.made_by() in answer


def test_another_version_is_one_line(client, ready, monkeypatch):
    here, real = threading.get_ident(), cut.made_by
    monkeypatch.setattr(cut, "made_by", lambda: "plan-cutters 9.9" if threading.get_ident() == here else real())
    with pytest.raises(PlanError, match=r"another version .* than this program \(plan-cutters 9\.9\)"):
        DistributedJudge(client, large=0)(ready, ready.cutters[0])


def test_what_is_lost_with_a_worker_is_handed_out_again(client, ready, single, monkeypatch):
    """The ground that was scattered may be gone with all workers that had it: the scheduler then cancels what needs it."""
    cutter = next(iter(single))
    verdicts, known, looked = single[cutter]
    judged, real, rounds, work = DistributedJudge(client, large=0, block=CHUNK), client.submit, [], Work()

    def submit(*given, **more):
        future = real(*given, **more)
        rounds.append(more["key"])  # the ground is the first of each round
        if len(rounds) in (3, 6):
            client.cancel([future])
        return future

    monkeypatch.setattr(client, "submit", submit)
    assert judged(ready, cutter, known=known, work=work) == verdicts
    assert work.looked == looked  # none is counted twice
    pieces = -(-len(ready.samples) // CHUNK)
    assert pieces + 1 < len(rounds) <= pieces + 6


def test_losing_workers_for_ever_is_an_error(client, ready, monkeypatch):
    real = client.submit

    def submit(*given, **more):
        future = real(*given, **more)
        client.cancel([future])
        return future

    monkeypatch.setattr(client, "submit", submit)
    with pytest.raises(PlanError, match="again and again"):
        DistributedJudge(client, large=0)(ready, ready.cutters[0])


@pytest.mark.slow("starts a cluster")
def test_a_worker_that_is_killed_costs_nothing(ready, single):
    """Real processes: bytes travel, and one of two workers is killed while it judges."""
    with (
        LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0", silence_logs=50) as cluster,
        Client(cluster, set_as_default=False) as client,
    ):
        for cutter, (verdicts, known, looked) in single.items():
            before = [each["pid"] for each in client.scheduler_info(n_workers=-1)["workers"].values() if "pid" in each]
            pids = before or list(client.run(os.getpid).values())
            killer = threading.Timer(0.05, lambda pid=pids[0]: os.kill(pid, signal.SIGKILL))
            killer.start()
            work = Work()
            assert DistributedJudge(client, large=0, block=CHUNK)(ready, cutter, known=known, work=work) == verdicts
            assert work.looked == looked
            killer.join()
            client.wait_for_workers(2, timeout=60)
            time.sleep(0.1)


@pytest.mark.slow("starts a cluster")
def test_a_scheduler_that_is_killed_while_blocks_are_on_it_is_one_line(ready, tmp_path):
    """A process of its own, killed once its tasks show that a worker judges; nothing waits for it for ever."""
    file = tmp_path / "scheduler.json"
    begun = [sys.executable, "-m", "distributed.cli.dask_scheduler", "--port", "0", "--no-dashboard", "--scheduler-file", file]
    scheduler = subprocess.Popen(begun, stderr=subprocess.DEVNULL)
    ends, caught = time.monotonic() + 60, []
    try:
        while not file.exists():
            assert time.monotonic() < ends
            time.sleep(0.1)
        begun = [sys.executable, "-m", "distributed.cli.dask_worker", "--scheduler-file", file, "--no-dashboard",
                 "--nthreads", "1", "--local-directory", tmp_path, "--death-timeout", "10"]  # fmt: skip
        worker = subprocess.Popen(begun, stderr=subprocess.DEVNULL)
        try:
            with (
                Client(scheduler_file=file, set_as_default=False) as client,
                Client(scheduler_file=file, set_as_default=False) as eye,
            ):
                client.wait_for_workers(1, timeout=60)

                def with_workers(dask_scheduler):
                    tasks = dask_scheduler.tasks.items()
                    return any(str(key).startswith("judge ") and task.state == "processing" for key, task in tasks)

                def judging():
                    try:
                        DistributedJudge(client, large=0, block=CHUNK)(ready, ready.cutters[0])
                    except PlanError as error:
                        caught.append(str(error))

                thread = threading.Thread(target=judging, daemon=True)
                thread.start()
                while not eye.run_on_scheduler(with_workers):
                    assert thread.is_alive()
                    time.sleep(0.01)
                scheduler.kill()
                thread.join(60)
                assert not thread.is_alive()
        finally:
            worker.kill()
            worker.wait()
    finally:
        scheduler.kill()
        scheduler.wait()
    assert caught == ["the scheduler went away: start it, or leave --cluster out"]


def test_the_columns_of_verdicts_are_all_handed_back():
    columns = ["verdict", "axis", "tilt_direction", "tilt", "rotation", "shift", "reason"]
    assert [each.name for each in fields(Verdicts)] == columns
    assert Cutter.parse("R6L80") == pickle.loads(pickle.dumps(Cutter.parse("R6L80")))
