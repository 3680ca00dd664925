"""Parts that are late, or sampled more coarsely than requested: what comes of them is there, marked, and never taken for more."""

import contextlib
import json
from types import SimpleNamespace

import pytest

from plan_cutters import Options, plan
from plan_cutters.command.codes import guarded, invoked
from plan_cutters.document.clock import Clock
from plan_cutters.errors import TooManySamplesError
from plan_cutters.interim import Interim
from plan_cutters.pipeline import run
from plan_cutters.plan_file.words.names import as_fields, typed
from plan_cutters.report.folder import Staging, write_unfinished
from plan_cutters.scene.preparation import MOST
from plan_cutters_base.workers.child import TIMED_OUT
from plan_cutters_batch import command as of_many
from plan_cutters_batch import run as runs
from plan_cutters_batch import work
from plan_cutters_batch.job import Settings, versions
from plan_cutters_batch.row import FAIL_ON, PartRow, fault
from plan_cutters_batch.run import Terms, foreseen
from plan_cutters_batch.store import Store
from plan_cutters_batch.summary import write_index
from tests.support.commands import in_lines
from tests.support.places import ROOT

GROOVE = str(ROOT / "samples/v_groove.step")
QUICK = {"cutters": "R6L80", "grid": 5, "area_budget": 0}


@pytest.fixture
def out(tmp_path):
    store = Store(str(tmp_path / "out"))
    yield store
    store.end()


@pytest.fixture(autouse=True)
def fit(monkeypatch):
    """Whether the worker is fit is not what is tested here."""
    monkeypatch.setattr(work, "_ready", str)


def task_of(out, options=QUICK, **more):
    settings = Settings(Options(**options, jobs=1))
    words = ("--formats", "json", "--no-cache")
    return work.Task("groove", GROOVE, None, settings.handed, words, settings.key, out.root_url,
                     out.begin(), more.pop("force", False), 240.0, versions(), GROOVE, **more)  # fmt: skip


def late(task, content, folder):
    """The command for one part, ended when the plan of its verdicts was safe."""
    safe = []
    run(GROOVE, Options(**QUICK, jobs=1, answers=["stick-out"]), Clock(), interim=Interim(Clock(), safe.append))
    with Staging(folder / "out") as staging:
        assert write_unfinished(safe[0], ("json", "html"), staging, Clock())
    return TIMED_OUT, work._out_of_time(task)


def page_of(rows):
    files = {}
    write_index(rows, files.__setitem__, title="late", seconds=1.0, cluster={})
    return files["index.html"].decode(), json.loads(files["summary.json"])


def test_a_part_that_is_late_has_the_plan_so_far_and_is_tried_again(out, tmp_path, monkeypatch):
    monkeypatch.setattr(work, "planned", late)
    row = work.work(task_of(out)).row
    assert (row.status, row.code) == ("failed", TIMED_OUT)
    assert "not done within 240 s" in row.error
    assert "Late: the plan so far is there" in row.error
    document = json.loads((tmp_path / "out/groove-plan/plan.json").read_text())
    assert document["not_written"] == {"html": "not done within 240 s"}
    notes = dict(zip(document["note_codes"], document["notes"], strict=True))
    assert row.error.endswith(f"{typed(notes['run_unfinished'])} It is without review.html.")
    # The page leads to it, and no tool is counted for it.
    page, summary = page_of([row])
    assert 'href="./groove-plan/plan.json"' in page
    assert ">failed: late</strong>" in page
    assert (summary["code"], summary["parts"]["failed"], summary["shop"]["not_known"]) == (TIMED_OUT, 1, 1)
    assert summary["shop"]["tools"] == []
    # It is not done: neither a dry run nor a run takes it.
    task = task_of(out)
    assert work.cached(out, task.folder, row.key, "groove", GROOVE) is None
    monkeypatch.undo()
    monkeypatch.setattr(work, "_ready", str)
    again = work.work(task_of(out)).row
    assert (again.status, again.code, again.key) == ("planned", 0, row.key)


@pytest.mark.slow("plans a folder of parts")
def test_a_whole_plan_of_the_same_key_stays_where_a_later_run_is_late(out, tmp_path, monkeypatch):
    done = work.work(task_of(out)).row
    assert done.status == "planned"
    # Within the limit of samples it has no mark.
    assert done.coarser is None
    assert "coarser" not in page_of([done])[0].partition("<body>")[2]
    before = (tmp_path / "out/groove-plan/plan.json").read_bytes()
    monkeypatch.setattr(work, "planned", late)
    row = work.work(task_of(out, force=True)).row
    assert (row.status, row.code, row.folder) == ("failed", TIMED_OUT, None)
    assert (tmp_path / "out/groove-plan/plan.json").read_bytes() == before
    kept = work.work(task_of(out)).row
    assert (kept.status, kept.code) == ("kept", 0)


def test_a_part_that_is_late_without_a_plan_leaves_nothing(out, tmp_path, monkeypatch):
    monkeypatch.setattr(work, "planned", lambda task, content, folder: (TIMED_OUT, "not done within 240 s"))
    row = work.work(task_of(out)).row
    assert (row.status, row.code, row.error, row.folder) == ("failed", TIMED_OUT, "not done within 240 s", None)
    assert not (tmp_path / "out/groove-plan").exists()


@pytest.mark.slow("plans twice", only=("density1",))
@pytest.mark.parametrize(("density", "word"), [({"spacing": 0.5}, "--spacing 0.5"), ({"grid": 40}, "--grid 40")])
def test_a_density_that_asks_too_much_of_a_part_is_marked_in_a_batch_and_refused_alone(out, monkeypatch, density, word):
    options = {"cutters": "R6L80", "area_budget": 0, **density}
    monkeypatch.setenv(MOST, "1000")
    with pytest.raises(TooManySamplesError, match="sample more coarsely"):
        plan(GROOVE, **options)
    row = work.work(task_of(out, options)).row
    assert row.status == "planned", row.error
    assert row.coarser.startswith(f"coarser than requested: `{word}` would take too many samples here; judged at ")
    document = json.loads(out.get("groove-plan/plan.json", 1 << 24))
    # By default, what may lie between the samples is a doubt, as it is not where somebody said how densely to sample.
    assert document["effective"]["sampled_by"] == "default"
    # The part's own plan and page say so, too, above the process.
    note = f"C{row.coarser[1:]}."
    assert dict(zip(document["note_codes"], document["notes"], strict=True))["coarser_than_requested"] == note
    assert document["process"]["doubts"][0] == note
    assert in_lines(" ".join(document["text"]["lines"])).startswith(as_fields(note))
    page, _ = page_of([row])
    assert row.coarser in page
    kept = work.work(task_of(out, options)).row
    assert (kept.status, kept.coarser) == ("kept", row.coarser)


# Exit codes


FOUND = {"refused": 2, "unreadable": 3, "late": TIMED_OUT, "unfinished": 1, "unsure": 4}


def row_with(name, code):
    status = "planned" if code in (0, 1, 4) else "failed"
    return PartRow(name=name, file=f"{name}.step", status=status, code=code)


def test_each_outcome_has_a_word():
    assert {word: fault(row_with("a", code)) for word, code in FOUND.items()} == {word: word for word in FAIL_ON}
    assert fault(row_with("a", 0)) == ""
    assert fault(row_with("a", -9)) == "unreadable"
    assert fault(PartRow(name="a", file="a", status="failed", code=0)) == "unreadable"


@pytest.mark.parametrize(
    ("words", "codes", "expected"),
    [
        ([], [0, 1, 3, 4, TIMED_OUT], TIMED_OUT),
        ([], [0, 0], 0),
        (["--fail-on", "unreadable"], [0, 1, 3, 4, TIMED_OUT], 3),
        (["--fail-on", "unreadable"], [0, 1, 4, TIMED_OUT], 0),
        (["--fail-on", "unreadable,late"], [1, 3, TIMED_OUT], TIMED_OUT),
        (["--fail-on", "unfinished"], [1, 3, TIMED_OUT], 1),
        (["--fail-on", "unsure, unfinished"], [1, 4, 3], 4),
        (["--fail-on", "refused"], [2, 3], 2),
        (["--fail-on", "none"], [0, 1, 2, 3, 4, TIMED_OUT], 0),
    ],
)
def test_the_code_is_the_largest_of_what_the_batch_fails_on(monkeypatch, capsys, tmp_path, words, codes, expected):
    rows = [row_with(f"p{k}", code) for k, code in enumerate(codes)]
    facts = {"address": "here", "workers": 1, "threads": 1, "dashboard": None}
    monkeypatch.setattr(runs, "opened", lambda *_: contextlib.nullcontext(SimpleNamespace()))
    monkeypatch.setattr(runs, "facts", lambda client: facts)
    monkeypatch.setattr("plan_cutters_batch.run.run_batch", lambda *_, **__: iter(rows))
    args = (GROOVE, "--out", str(tmp_path / "out"), "--cutter", "R6L80", "--formats", "json", *words)
    code, line = guarded(lambda: (invoked(of_many.command, "plan-cutters batch", args), ""), False)
    assert (code, line) == (expected, "")
    out, err = capsys.readouterr()
    assert "Look at them in a browser" in out
    assert "pip install bokeh" in err


@pytest.mark.parametrize("words", ["lost", "", "none,late", "late,"])
def test_a_word_that_is_none_is_one_line(capsys, tmp_path, words):
    args = (GROOVE, "--out", str(tmp_path / "out"), "--cutter", "R6L80", "--formats", "json", "--fail-on", words)
    code, line = guarded(lambda: (invoked(of_many.command, "plan-cutters batch", args), ""), False)
    assert code == 2
    assert "--fail-on takes some of refused,unreadable,late,unfinished,unsure, or none" in line
    assert not (tmp_path / "out").exists()


def test_an_address_on_object_storage_is_not_opened_in_a_browser():
    bucket = SimpleNamespace(local=False, root_url="s3://shop/plans")
    assert of_many._where(bucket) == (
        "The table is s3://shop/plans/index.html: copy the folder to this machine to open it, or give --out a folder."
    )


def test_a_dry_run_plans_what_was_late(out, monkeypatch):
    from plan_cutters_batch.job import Job

    monkeypatch.setattr(work, "planned", late)
    work.work(task_of(out))
    (row,) = foreseen([Job("groove", GROOVE, Settings(Options(**QUICK, jobs=1)))], out, Terms())
    assert row.status == "planned"
