"""Parts on a cluster of this machine: rows as they come, what is kept, and what is lost with a child, a worker or a scheduler."""

import contextlib
import json
import os
import threading
import time
from typing import ClassVar

import psutil
import pytest

from plan_cutters import Options, plan_many
from plan_cutters.errors import PlanError
from plan_cutters_base.workers.child import TIMED_OUT
from plan_cutters_batch import job as made
from plan_cutters_batch import run as runs
from plan_cutters_batch.job import Job, Settings
from plan_cutters_batch.row import PartRow, failed
from plan_cutters_batch.run import Terms, foreseen, handed_out, outcomes, run_batch
from plan_cutters_batch.store import Store
from plan_cutters_batch.work import Outcome
from tests.support.places import ROOT

GROOVE = (ROOT / "samples/v_groove.step").read_bytes()
QUICK = {"cutters": "R6L80", "grid": 5, "area_budget": 0, "jobs": 1}


@pytest.fixture(scope="module")
def client():
    with runs.opened(None, 2) as client:
        yield client


def settings(**options):
    return Settings(Options(**{**QUICK, **options}))


def jobs(folder, *names, of=None):
    of = of or settings()
    made = []
    for name in names:
        file = folder / f"{name}.step"
        if not file.exists():
            # Parts of different content, so that no two have one key.
            file.write_bytes(GROOVE + f"/* {name} */\n".encode())
        made.append(Job(name, str(file), of))
    return made


def ran(parts, client, out, **terms):
    rows = list(run_batch(parts, client, out, Terms(**terms)))
    assert sorted(row.name for row in rows) == sorted(part.name for part in parts)
    return {row.name: row for row in rows}


def children(client):
    """Processes of the command that workers have begun, without their own children."""
    found = []
    for pid in client.run(os.getpid).values():
        with contextlib.suppress(psutil.Error):
            for each in psutil.Process(pid).children():
                with contextlib.suppress(psutil.Error):
                    if "plan_cutters" in each.cmdline():
                        found.append(each)
    return found


def when_one_runs(client, act):
    """Act on the first child that a worker begins, and its process number, in a thread."""

    def wait():
        ends = time.monotonic() + 120
        while time.monotonic() < ends:
            if found := children(client):
                act(found[0])
                return
            time.sleep(0.01)

    thread = threading.Thread(target=wait)
    thread.start()
    return thread


@pytest.mark.slow("plans a folder of parts")
def test_rows_come_what_is_done_is_kept_and_a_broken_part_costs_itself(client, tmp_path):
    out = Store(str(tmp_path / "out"))
    parts = jobs(tmp_path, "a", "deep")
    (tmp_path / "broken.step").write_text("no part")
    parts += [*jobs(tmp_path, "broken"), failed("twice", "twice.step", "twice.step: told")]
    rows = ran(parts, client, out)
    assert {name: (row.status, row.code) for name, row in rows.items()} == {
        "a": ("planned", 0), "deep": ("planned", 0), "broken": ("failed", 3), "twice": ("failed", 2)}  # fmt: skip
    assert rows["broken"].error.startswith(str(tmp_path / "broken.step"))
    assert rows["a"].share == 1.0
    assert "D12" in rows["a"].cutter
    assert sorted(each.name for each in (tmp_path / "out").iterdir() if each.is_dir()) == ["a-plan", "deep-plan"]
    assert (tmp_path / "out/summary.json").is_file()
    plan = json.loads((tmp_path / "out/a-plan/plan.json").read_text())
    assert plan["part"]["file"] == "a.step"

    # Again: nothing but the part that failed, and one whose file has changed; and one that is new, which would be planned.
    made = {name: (tmp_path / f"out/{name}-plan/plan.json").stat().st_mtime_ns for name in ("a", "deep")}
    (tmp_path / "deep.step").write_bytes(GROOVE + b"/* changed */\n")
    parts = parts[:3]
    foreseen_ = [row.status for row in foreseen([*parts, *jobs(tmp_path, "new")], out, Terms())]
    assert foreseen_ == ["kept", "planned", "planned", "planned"]
    rows = ran(parts, client, out)
    assert {name: row.status for name, row in rows.items()} == {"a": "kept", "deep": "planned", "broken": "failed"}
    again = {name: (tmp_path / f"out/{name}-plan/plan.json").stat().st_mtime_ns for name in ("a", "deep")}
    assert again["a"] == made["a"]
    assert again["deep"] > made["deep"]
    assert rows["a"].verdict


def test_a_killed_child_and_one_that_takes_too_long_cost_one_part(client, tmp_path):
    out = Store(str(tmp_path / "out"))
    thread = when_one_runs(client, lambda child: child.kill())
    rows = ran(jobs(tmp_path, "a"), client, out)
    thread.join()
    assert (rows["a"].status, rows["a"].code) == ("failed", 3)
    assert "killed (SIGKILL)" in rows["a"].error
    rows = ran(jobs(tmp_path, "a"), client, out, timeout=0.3)
    assert "not done within 0.3 s" in rows["a"].error
    assert rows["a"].code == TIMED_OUT
    assert children(client) == []
    assert not (tmp_path / "out/a-plan").exists()


@pytest.mark.slow("ends a worker, which is started again")
def test_a_lost_worker_loses_nothing_and_leaves_nothing(client, tmp_path):
    out = Store(str(tmp_path / "out"))
    left = []

    def kill_worker(child):
        left.extend([child, *child.children(recursive=True)])
        child.parent().kill()

    thread = when_one_runs(client, kill_worker)
    rows = ran(jobs(tmp_path, "a"), client, out)
    thread.join()
    assert (rows["a"].status, rows["a"].code) == ("planned", 0)
    assert left
    _, alive = psutil.wait_procs(left, timeout=10)
    assert alive == []


def test_the_memory_of_one_process_is_refused(client):
    with pytest.raises(PlanError, match=r"memory://plans: memory:// is the memory of one process"):
        next(plan_many(["a.step"], client, out="memory://plans"))
    (row,) = (each.row for each in plan_many(["memory:///shelf/a.step"], client, **QUICK))
    assert (row.status, row.code) == ("failed", 2)


@pytest.mark.slow("starts servers or clusters")
def test_plan_many_gives_plans_of_shapes_and_paths(client):
    from cad_io.kernel.shapes import corner

    parts = [("corner", corner(20.0, 0.2)), "none.step"]
    found = {each.row.name: each for each in plan_many(parts, client, faces=[1], **QUICK)}
    assert found["corner"].plan.cutters[0].id == "R6L80"
    assert found["corner"].plan.effective.target_faces == ["F1"]
    assert found["none"].plan is None
    assert found["none"].row.error == "none.step: no such file"
    with pytest.raises(PlanError, match="no option is called grit"):
        next(plan_many(parts, client, grit=5))


def test_versions_that_differ_are_refused_with_both_named(client, tmp_path, monkeypatch):
    monkeypatch.setattr(runs, "versions", lambda: {"numba": "0.1"})
    (found,) = outcomes(jobs(tmp_path, "a"), client, Terms())
    assert found.row.code == 2
    assert "numba 0." in found.row.error
    assert "0.1 where the batch was begun" in found.row.error


def test_a_worker_that_does_not_see_the_output_writes_nothing(client, tmp_path, monkeypatch):
    out = Store(str(tmp_path))
    monkeypatch.setattr(out, "begin", lambda: "another")
    (found,) = outcomes(jobs(tmp_path, "a"), client, Terms(), out=out)
    assert "does not see" in found.row.error
    assert list(tmp_path.iterdir()) == [tmp_path / "a.step"]


def _half(task):
    if task % 50 == 7:
        raise ValueError(f"task {task}")
    return task / 2


@pytest.mark.slow("starts servers or clusters")
def test_what_is_in_flight_is_bounded_and_an_error_is_not_tried_again(client):
    class Counted:
        most = 0

        def progress(self, done, running):
            self.most = max(self.most, running)

    board, drawn = Counted(), []

    def tasks():
        for task in range(300):
            drawn.append(task)
            yield task

    found = {}
    for task, result in handed_out(client, tasks(), _half, board=board):
        assert len(drawn) - len(found) <= 9
        found[task] = result
    assert board.most <= 8
    assert sorted(found) == list(range(300))
    assert all(isinstance(result, ValueError) if task % 50 == 7 else result == task / 2 for task, result in found.items())


def _picky(task):
    """On a worker without what it takes, each task ends at once."""
    from distributed import get_worker

    unfit, number = task
    address = get_worker().address
    row = PartRow(name=f"{number}", file="", status="failed", code=2, error="no kernel")
    if address in unfit:
        return Outcome(row, {}, unfit=address)
    time.sleep(0.05)
    return Outcome(row.model_copy(update={"status": "planned"}), {})


def test_a_worker_that_can_plan_nothing_is_left_out_and_fails_no_part(client):
    class Board:
        lines: ClassVar[list[str]] = []

        def progress(self, *_):
            pass

        def say(self, text):
            self.lines.append(text)

    # A worker that a test before this one has cost is started again.
    client.wait_for_workers(2, timeout=60)
    first, second = client.nthreads()
    found = [each for _, each in handed_out(client, iter([((first,), k) for k in range(40)]), _picky, board=Board())]
    assert {each.row.name for each in found} == {f"{k}" for k in range(40)}
    assert {each.row.status for each in found} == {"planned"}
    assert set(Board.lines) == {f"worker {first} is left out: no kernel"}
    # Where all are like that, each part says why.
    found = [each for _, each in handed_out(client, iter([((first, second), k) for k in range(9)]), _picky)]
    assert len(found) == 9
    assert {each.row.status for each in found} == {"failed"}


@pytest.mark.slow("starts servers or clusters")
def test_no_scheduler_is_one_line_within_seconds(tmp_path):
    began = time.monotonic()
    for address in ("tcp://127.0.0.1:1", str(tmp_path / "none.json"), "nonsense://x:1"):
        with pytest.raises(PlanError, match=r"^--cluster ") as error, runs.opened(address):
            pass
        assert "\n" not in str(error.value)
    (tmp_path / "scheduler.json").write_text("{}")
    with pytest.raises(PlanError), runs.opened(str(tmp_path / "scheduler.json")):
        pass
    assert time.monotonic() - began < 60


def test_workers_by_cores_and_memory():
    count, memory = runs.workers_of(None, None, 1)
    assert count >= 1
    assert memory >= runs.LEAST_MEMORY
    assert runs.workers_of(3, 2e9, 1) == (3, 2_000_000_000)
    assert runs.workers_of(None, 1e15, 1)[0] == 1


@pytest.mark.slow("starts servers or clusters")
def test_what_another_version_planned_is_not_taken(tmp_path, monkeypatch):
    """Neither by a batch nor, whose keys are the same, by `changed`."""
    from plan_cutters_batch import work as works

    out = Store(str(tmp_path / "out"))
    (job,) = parts = jobs(tmp_path, "a")
    task = works.Task(job.name, job.file, None, job.settings.handed, (), job.settings.key, out.root_url, out.begin())
    monkeypatch.setattr(works, "_ready", lambda: "")
    assert works.work(task).row.status == "planned"
    assert [row.status for row in foreseen(parts, out, Terms())] == ["kept"]
    monkeypatch.setattr(made, "made_by", lambda: b"another program")
    assert [row.status for row in foreseen(jobs(tmp_path, "a"), out, Terms())] == ["planned"]


@pytest.mark.parametrize("name", ["made_by", "_own"])
def test_an_edit_of_the_core_or_of_the_batch_makes_another_program(monkeypatch, name):
    before = made.program()
    assert getattr(made, name)()
    monkeypatch.setattr(made, name, lambda: b"another")
    assert made.program() != before
    assert made.versions()["plan-cutters"].endswith(made.program().hex()[:12])


def test_a_full_disk_on_a_worker_is_one_line(tmp_path, monkeypatch):
    from pathlib import Path

    from plan_cutters_batch import work as works

    def full(*words):
        raise OSError(28, "No space left on device")

    out = Store(str(tmp_path / "out"))
    (job,) = jobs(tmp_path, "a")
    task = works.Task(job.name, job.file, None, job.settings.handed, (), job.settings.key, out.root_url, out.begin())
    monkeypatch.setattr(works, "_ready", lambda: "")
    monkeypatch.setattr(Path, "write_bytes", full)
    row = works.work(task).row
    assert (row.status, row.code) == ("failed", 2)
    assert "No space left on device" in row.error
    assert out.row("a-plan") is None
