"""Where parts are planned: clusters that cannot be reached are one line."""

import pytest
from distributed import Client, LocalCluster

from plan_cutters import PlanError
from plan_cutters_batch import run
from plan_cutters_batch.job import versions


@pytest.fixture(scope="module")
def running():
    with LocalCluster(n_workers=1, processes=False, protocol="tcp://", dashboard_address=":0") as found:
        yield found.scheduler_address


def test_nobody_at_an_address_is_one_line(monkeypatch):
    monkeypatch.setattr(run, "_ANSWER", 0.3)
    with pytest.raises(PlanError, match="does the scheduler run") as caught, run.opened("tcp://127.0.0.1:9"):
        pass
    assert "\n" not in str(caught.value)


def test_a_scheduler_without_workers_is_one_line(monkeypatch):
    monkeypatch.setattr(run, "_JOIN", 0.3)
    with (
        LocalCluster(n_workers=0, processes=False, dashboard_address=":0") as empty,
        pytest.raises(PlanError, match="has no worker"),
        run.opened(empty.scheduler_address),
    ):
        pass


def test_workers_with_other_versions_are_refused_with_both_named(running, monkeypatch):
    with run.opened(running):
        pass
    here = versions()
    for there, said in (
        ({**here, "numba": "0.1"}, rf"has numba 0\.1, this machine {here['numba']}: install the same"),
        ({**here, "plan-cutters": "0.0.9+a"}, r"has plan-cutters 0\.0\.9\+a, this machine 0\.1"),
        ({"python": here["python"]}, r"None, this machine"),
        (ModuleNotFoundError("plan_cutters"), r"cannot load plan-cutters \(ModuleNotFoundError\)"),
    ):
        monkeypatch.setattr(Client, "run", lambda self, *_, there=there, **__: {"tcp://w": there})
        with pytest.raises(PlanError, match=said), run.opened(running):
            pass
