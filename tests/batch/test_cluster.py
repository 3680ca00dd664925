"""Where parts are planned: clusters that cannot be reached are one line, and a cluster is lent to large parts."""

from dataclasses import fields

import numpy as np
import pytest
from distributed import Client, LocalCluster

from plan_cutters import Options, PlanError, plan, plan_many
from plan_cutters.batch import cluster
from plan_cutters.batch.job_input import Offer
from plan_cutters.batch.shared_cluster import SharedCluster
from plan_cutters.domain.verdicts import Verdicts
from plan_cutters.files.lock import Lock
from plan_cutters.pipeline import prepare
from plan_cutters.stages.judge import judge
from tests.support.places import SAMPLES

NAMES = [each.name for each in fields(Verdicts)]


@pytest.fixture(scope="module")
def running():
    with LocalCluster(n_workers=1, processes=False, protocol="tcp://", dashboard_address=":0") as found:
        yield found.scheduler_address


@pytest.fixture(scope="module")
def ready():
    return prepare(SAMPLES / "v_groove.step", Options.of({"cutters": ("R6L80", "R2L30"), "grid": 9, "area_budget": 0}))


def same(a: Verdicts, b: Verdicts) -> bool:
    return all(np.array_equal(getattr(a, name), getattr(b, name), equal_nan=name == "tilt") for name in NAMES)


def test_nobody_at_an_address_is_one_line(monkeypatch):
    monkeypatch.setattr(cluster, "_ANSWER", 0.3)
    with pytest.raises(PlanError, match="does the scheduler run") as caught, cluster.opened("tcp://127.0.0.1:9"):
        pass
    assert "\n" not in str(caught.value)


def test_a_scheduler_without_workers_is_one_line(monkeypatch):
    monkeypatch.setattr(cluster, "_JOIN", 0.3)
    with (
        LocalCluster(n_workers=0, processes=False, dashboard_address=":0") as empty,
        pytest.raises(PlanError, match="has no worker"),
        cluster.opened(empty.scheduler_address),
    ):
        pass


def test_workers_with_other_versions_are_refused_with_both_named(running, monkeypatch):
    def versions(self, **_):
        return {"client": {"packages": {"plan_cutters": "1.0"}}, "workers": {"w": {"packages": {"plan_cutters": "0.9"}}}}

    monkeypatch.setattr(Client, "get_versions", versions)
    with pytest.raises(PlanError, match=r"plan-cutters 0\.9, this machine 1\.0"), cluster.opened(running):
        pass


def test_a_large_part_of_a_batch_is_judged_by_its_cluster_and_says_so(ready, running, tmp_path):
    offer = Offer(running, str(tmp_path / "turn"), str(tmp_path / "said"))
    cutter = ready.cutters[0]
    lent = SharedCluster(offer, large=len(ready.samples))
    try:
        found = lent(ready, cutter)
        assert (tmp_path / "said").exists()
        with pytest.raises(PlanError):
            Lock(tmp_path / "turn")
    finally:
        lent.close()
    Lock(tmp_path / "turn").release()
    assert same(found, judge(ready, cutter))


@pytest.mark.parametrize("why", ["small", "taken", "no scheduler"])
def test_a_part_that_does_not_get_the_cluster_judges_by_itself(ready, running, tmp_path, monkeypatch, why):
    monkeypatch.setattr(cluster, "_ANSWER", 0.3)
    address = "tcp://127.0.0.1:9" if why == "no scheduler" else running
    offer = Offer(address, str(tmp_path / "turn"), str(tmp_path / "said"))
    other = Lock(tmp_path / "turn") if why == "taken" else None
    lent = SharedCluster(offer, large=len(ready.samples) + (why == "small"))
    found = lent(ready, ready.cutters[0])
    lent.close()
    assert not (tmp_path / "said").exists()
    assert same(found, judge(ready, ready.cutters[0]))
    if other is not None:
        other.release()


@pytest.mark.slow("starts servers or clusters")
def test_a_cluster_that_is_lost_on_the_way_costs_nothing(ready, tmp_path):
    with LocalCluster(n_workers=1, processes=False, dashboard_address=":0") as mortal:
        lent = SharedCluster(Offer(mortal.scheduler_address, str(tmp_path / "turn"), str(tmp_path / "said")), large=0)
        lent(ready, ready.cutters[0])
    found = lent(ready, ready.cutters[1])
    lent.close()
    assert same(found, judge(ready, ready.cutters[1]))


def test_a_task_offers_the_cluster_that_it_runs_on(running, tmp_path):
    from plan_cutters.batch.work import _offered

    assert _offered(tmp_path) is None
    with Client(running, set_as_default=False) as client:
        assert client.submit(_offered, tmp_path, pure=False).result().scheduler == running


@pytest.mark.slow("starts a cluster")
def test_two_large_parts_on_one_thread_do_not_wait_for_each_other():
    """The first gives its place away; the other one has the cluster after it, or judges by itself."""
    asked = {"cutters": "R6L80", "grid": 320, "area_budget": 0}
    file = SAMPLES / "peaks_and_valleys.step"
    alone = plan(file, **asked).plan.cutters[0].model_copy(update={"seconds": 0.0})
    with (
        LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=":0", silence_logs=50) as one,
        Client(one, set_as_default=False) as client,
    ):
        found = list(plan_many([("a", str(file)), ("b", str(file))], client, **asked))
        judged = client.run_on_scheduler(lambda dask_scheduler: {str(each[0]) for each in dask_scheduler.transition_log})
    assert any(key.startswith("judge ") for key in judged)
    for each in found:
        assert each.row.error is None
        assert each.row.samples >= 100_000
        assert each.plan.cutters[0].model_copy(update={"seconds": 0.0}) == alone
