"""`plan-cutters batch` as people run it: bad input is one line each, and a run that is killed is gone on with."""

import contextlib
import csv
import json
import random
import signal
import subprocess
import sys
import time

import psutil
import pytest

from plan_cutters.command.codes import guarded, invoked
from plan_cutters_batch import command as of_many
from tests.support.forked import ENV
from tests.support.junit import cases
from tests.support.places import ROOT
from tests.support.sarif import findings

GROOVE = (ROOT / "samples/v_groove.step").read_bytes()
QUICK = ("--cutter", "R6L80", "--grid", "5", "--area-budget", "0", "--formats", "json")


@pytest.fixture
def parts(tmp_path):
    folder = tmp_path / "parts"
    folder.mkdir()
    for name in ("a", "b", "c"):
        (folder / f"{name}.step").write_bytes(GROOVE + f"/* {name} */\n".encode())
    return folder


@pytest.fixture
def batch(monkeypatch, capsys):
    """Run the command in this process: what it is refused for starts none."""

    def run(*words, cwd):
        monkeypatch.chdir(cwd)
        code, line = guarded(lambda: (invoked(of_many.command, "plan-cutters batch", words), ""), False)
        out, err = capsys.readouterr()
        return subprocess.CompletedProcess(words, code, out, err + (f"{line}\n" if line else ""))

    return run


def started(*words, cwd):
    command = [sys.executable, "-P", "-m", "plan_cutters", "batch", *words]
    return subprocess.Popen(command, cwd=cwd, env=ENV, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                            start_new_session=True)  # fmt: skip


def descendants(process):
    with contextlib.suppress(psutil.Error):
        return psutil.Process(process.pid).children(recursive=True)
    return []


def planning(processes):
    """Whether one of them is the command for one part."""
    for each in processes:
        with contextlib.suppress(psutil.Error):
            if "plan" in each.cmdline() and "plan_cutters" in each.cmdline():
                return True
    return False


def test_nothing_to_plan_is_one_line(batch, tmp_path):
    (tmp_path / "empty").mkdir()
    done = batch("empty", "--out", "out", cwd=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == "plan-cutters batch: empty: the folder holds no STEP, IGES or BREP file\n"
    done = batch("none.step", "none.toml", "--out", "out", "--dry-run", cwd=tmp_path)
    assert done.returncode == 3
    assert not (tmp_path / "out").exists()


def test_parts_that_cannot_be_planned_are_errors_of_the_report(batch, tmp_path):
    (tmp_path / "all.toml").write_text("[[part]]\nfile='b.step'\ngrit=5\n")
    assert batch("all.toml", "--out", "out", "--junit", "junit.xml", "--sarif", "all.sarif", cwd=tmp_path).returncode == 2
    (found,) = cases((tmp_path / "junit.xml").read_bytes())
    (same,) = findings((tmp_path / "all.sarif").read_bytes())
    assert (same.part, same.rule, same.level) == (found.part, found.kind, "warning")
    assert (found.name, found.outcome) == ("b", "error")
    assert "no option of a part is called grit" in found.message
    for words in (["--junit", "-"], ["--junit", "b.xml", "--dry-run"]):
        done = batch("none.step", "--out", "out", *words, cwd=tmp_path)
        assert (done.returncode, "--junit" in done.stderr) == (2, True)
    assert not (tmp_path / "b.xml").exists()


def test_each_bad_part_of_a_manifest_is_one_line_and_the_others_go_on(batch, parts):
    (parts / "all.toml").write_text(
        "[[part]]\nfile='a.step'\n[[part]]\nfile='b.step'\ngrit=5\n[[part]]\nfile='c.step'\ngrid='many'\n"
        "[[part]]\nfile='gone.step'\n[[part]]\nfile='c.step'\nname='d'\ntolerance=-1\n"
        "[[part]]\nfile='c.step'\nname='e'\nflip='perhaps'\n[[part]]\nfile='c.step'\nname='f'\nfaces=['F1','F2']\n"
    )
    done = batch("all.toml", "--out", "out", *QUICK, "--dry-run", cwd=parts)
    assert done.returncode == 3
    assert done.stdout.splitlines() == [
        "a: would be planned",
        "b: cannot be planned: all.toml:5: no option of a part is called grit; grid?",
        "c: cannot be planned: all.toml:6: Invalid value for '--grid': 'many' is not a valid integer.",
        "gone: cannot be planned: all.toml:9: no such file: gone.step",
        "d: cannot be planned: all.toml:11: tolerance -1 must lie between 0.0001 and 10 mm",
        "e: cannot be planned: all.toml:15: flip is true or false, not 'perhaps'",
        "f: cannot be planned: all.toml:19: faces takes one value, not a list",
    ]


@pytest.mark.slow("starts servers or clusters", only=("words6",))
@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--cutter", "R6"], "R6"),
        (["--formats", "dwg"], "format 'dwg' is not built in"),
        (["--timeout-part", "-1"], "--timeout-part must be a positive number"),
        (["--timeout", "0"], "--timeout-part must be a positive number"),
        (["--limit-memory", "1"], "--limit-memory must be at least 2 GB"),
        (["--cluster", "none.json"], "--cluster none.json: no such file"),
        (["--cluster", "tcp://127.0.0.1:1"], "--cluster tcp://127.0.0.1:1: "),
        (["--cluster", "tcp://127.0.0.1:1", "--workers", "2"], "--workers is about this machine"),
        (["--feed", "500"], "--feed is about a plan of operations"),
        (["--postures", "x.npz"], "No such option"),
    ],
)
def test_wrong_words_are_one_line(batch, parts, words, said):
    done = batch("a.step", "--out", "out", *words, cwd=parts)
    assert (done.returncode, done.stdout) == (2, "")
    assert said in done.stderr
    assert len(done.stderr.splitlines()) <= 2
    assert not list(parts.glob("out/*"))


def test_an_output_that_cannot_be_written_is_one_line(batch, parts):
    done = batch("a.step", "--out", "b.step", cwd=parts)
    assert (done.returncode, len(done.stderr.splitlines())) == (2, 1)
    assert "b.step" in done.stderr


def killed_at(parts, moment, victim, workers="2"):
    """Begin a batch and kill something; the client's exit code, and what was left alive."""
    client = started(".", "--out", "out", *QUICK, "--workers", workers, "--quiet", cwd=parts)
    try:
        moment(client)
        seen = descendants(client)
        workers = [each for each in seen if each.is_running() and planning(each.children())] if victim != "client" else []
        with contextlib.suppress(psutil.NoSuchProcess, ProcessLookupError):
            (workers[0] if workers else client).kill()
        client.communicate(timeout=240)
        _, alive = psutil.wait_procs(seen, timeout=20)
        return client.returncode, alive
    finally:
        client.kill()
        client.communicate()


def finished(parts, workers="2"):
    """Run again to the end: what each part was, planned or kept."""
    client = started(".", "--out", "out", *QUICK, "--workers", workers, "--junit", "ci/junit.xml", cwd=parts)
    found, said = client.communicate(timeout=240)
    assert client.returncode == 0, said
    first, *where = found.splitlines()
    assert first == "3 parts: 3 finished."
    assert "".join("".join(where).split()) == f"Lookattheminabrowser:{parts}/out/index.html"
    with (parts / "out/index.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    for name in ("a", "b", "c"):
        assert json.loads((parts / f"out/{name}-plan/plan.json").read_text())["selected"] == "R6L80"
    assert not (parts / "out/.batch").exists()
    reported = cases((parts / "ci/junit.xml").read_bytes())
    assert [(each.name, each.outcome) for each in reported] == [("a", "passed"), ("b", "passed"), ("c", "passed")]
    return {row["name"]: row["status"] for row in rows}


@pytest.mark.slow("starts servers or clusters")
def test_a_killed_client_leaves_nothing_and_is_gone_on_with(parts):
    def one_is_done(client):
        ends = time.monotonic() + 120
        while not list(parts.glob("out/*-plan/done.json")) and time.monotonic() < ends and client.poll() is None:
            time.sleep(0.02)

    code, alive = killed_at(parts, one_is_done, "client", "1")
    assert code == -signal.SIGKILL
    assert alive == []
    before = {file.parent.name[0] for file in parts.glob("out/*-plan/done.json")}
    assert 1 <= len(before) < 3
    statuses = finished(parts, "1")
    assert {name for name, status in statuses.items() if status == "kept"} == before
    assert set(statuses) == {"a", "b", "c"}


@pytest.mark.slow("starts a cluster and ends it, twenty times")
@pytest.mark.parametrize("seed", range(20))
def test_kills_at_random_moments_lose_nothing(parts, seed):
    chance = random.Random(seed)
    victim = chance.choice(["client", "worker"])
    code, alive = killed_at(parts, lambda client: time.sleep(chance.uniform(0.5, 20.0)), victim)
    assert code in (0, -signal.SIGKILL)
    assert alive == []
    assert set(finished(parts)) == {"a", "b", "c"}
