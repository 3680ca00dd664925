"""The parts that a branch changes: the action's own step, run in a local repository with the variables of a job."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import cadquery as cq
import pytest
import yaml

from plan_cutters.cases.files import Case
from plan_cutters.errors import PlanError
from plan_cutters_ci.changed import RULES, Changed, PartRequest, Row, annotations, changed, content, requested
from tests.support.forked import ENV
from tests.support.junit import cases
from tests.support.places import ROOT, real_file
from tests.support.sarif import findings

ACTION = yaml.safe_load((ROOT / "action.yml").read_text(encoding="utf-8"))
POINTER = "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n"
OPTIONS = "--faces all --grid 3 --area-budget 0\n--cutter 'R3L20' --holder R15L30"


def git(*words):
    author = ["-c", "user.name=t", "-c", "user.email=t@localhost", "-c", "init.defaultBranch=main"]
    return subprocess.run(["git", *author, *words], check=True, capture_output=True, text=True).stdout.strip()


def part(path, deep):
    """A block with a slot as wide as a cutter, and so deep."""
    Path(path).parent.mkdir(parents=True, exist_ok=True)
    body = cq.Workplane().box(40, 40, 40).cut(cq.Workplane().box(40, 10, deep).translate((0, 0, 20 - deep / 2)))
    cq.exporters.export(body, str(path))


@pytest.fixture(scope="module")
def repository(tmp_path_factory):
    """A branch that deepens a slot, renames, deletes and adds parts, and the commit that it began at."""
    folder = tmp_path_factory.mktemp("repository")
    before = Path.cwd()
    os.chdir(folder)
    try:
        git("init", "-q")
        part("parts/slot.step", 8)
        part("old.step", 6)
        shutil.copy("old.step", "gone.stp")
        Path("gone.stp").write_text(Path("gone.stp").read_text() + "/* another file */\n" * 400)
        Path("notes.txt").write_text("no part")
        git("add", "-A")
        git("commit", "-qm", "base")
        base = git("rev-parse", "HEAD")
        part("parts/slot.step", 34)
        Path("sub").mkdir()
        git("mv", "old.step", "sub/a name.step")
        git("rm", "-q", "gone.stp")
        Path("large.STEP").write_text(POINTER)
        Path("notes.txt").write_text("still no part")
        git("add", "-A")
        git("commit", "-qm", "head")
    finally:
        os.chdir(before)
    return folder, base


def step(folder, base, temp, **inputs):
    """Run the action's step as a runner does: what it wrote to the summary and the outputs."""
    (mine,) = [each for each in ACTION["runs"]["steps"] if each.get("id") == "changed"]
    given = {name: each.get("default", "") for name, each in ACTION["inputs"].items()} | {"base": base} | inputs
    assert set(mine["env"].values()) <= {f"${{{{ inputs.{name} }}}}" for name in given}
    env = {key: given[value.removeprefix("${{ inputs.").removesuffix(" }}")] for key, value in mine["env"].items()}
    (temp / "plan-cutters/bin").mkdir(parents=True, exist_ok=True)
    program = temp / "plan-cutters/bin/plan-cutters"
    program.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m plan_cutters "$@"\n')
    program.chmod(0o755)
    for name in ("summary", "output"):
        (temp / name).unlink(missing_ok=True)
    job = {"RUNNER_TEMP": str(temp), "GITHUB_STEP_SUMMARY": str(temp / "summary"), "GITHUB_OUTPUT": str(temp / "output"),
           "GITHUB_SERVER_URL": "https://forge.test", "GITHUB_REPOSITORY": "us/parts", "GITHUB_RUN_ID": "7",
           "GITHUB_ACTIONS": "true", "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"}  # fmt: skip
    done = subprocess.run(["bash", "--noprofile", "--norc", "-eo", "pipefail", "-c", mine["run"]], cwd=folder,
                          env=ENV | job | env, capture_output=True, text=True, check=False)  # fmt: skip
    outputs = (
        dict(line.split("=", 1) for line in (temp / "output").read_text().splitlines()) if (temp / "output").exists() else {}
    )
    return done, (temp / "summary").read_text() if (temp / "summary").exists() else "", outputs


@pytest.fixture(scope="module")
def ran(repository, tmp_path_factory):
    temp = tmp_path_factory.mktemp("runner")
    return temp, step(*repository, temp, options=OPTIONS)


@pytest.mark.slow("runs whole commands")
def test_the_action_tells_what_a_branch_loses(repository, ran):
    temp, (done, summary, outputs) = ran
    assert done.returncode == 1, done.stderr
    assert outputs == {"parts": "4", "lost": "2", "failing": "2", "folder": str(temp / "plan-cutters-changed")}
    told = {each["part"]: each for each in json.loads((temp / "plan-cutters-changed/changed.json").read_text())["parts"]}
    assert {name: each["how"] for name, each in told.items()} == {
        "gone.stp": "deleted", "large.STEP": "added", "parts/slot.step": "changed", "sub/a name.step": "renamed from old.step",
    }  # fmt: skip
    assert [name for name, each in told.items() if each["fails"]] == ["large.STEP", "parts/slot.step"]
    assert told["parts/slot.step"]["difference"]["lost"]
    assert told["parts/slot.step"]["unreachable"]
    assert not told["sub/a name.step"]["difference"]["lost"]
    lines = [line for line in done.stderr.splitlines() if line.startswith("plan-cutters changed: ")]
    assert lines == ["plan-cutters changed: large.STEP: is a pointer of Git LFS, not the part: check it out with lfs: true"]
    assert "| fails | parts/slot.step | changed | lost" in summary
    assert "renamed from old.step" in summary
    assert not (temp / "plan-cutters-changed/before/gone.stp").exists()
    # Both plans side by side: linked beside the summary, and in the artifact of the job.
    page = "compare/parts/slot.step/review.html"
    assert b"No picture" not in (temp / "plan-cutters-changed" / page).read_bytes()
    assert f"[Both plans side by side]({page})\n" in (temp / "plan-cutters-changed/summary.md").read_text()
    artifacts = "https://forge.test/us/parts/actions/runs/7#artifacts"
    assert f"[Both plans side by side]({artifacts}): {page} there\n" in summary
    assert not (temp / "plan-cutters-changed/compare/sub").exists()
    # The report agrees with the rule, and each part that fails has one line at its file.
    reported = cases((temp / "plan-cutters-changed/junit.xml").read_bytes())
    assert {each.part for each in reported if each.outcome in ("failure", "error")} == {"large.STEP", "parts/slot.step"}
    assert {each.part for each in reported} == set(told)
    assert {each.part for each in findings((temp / "plan-cutters-changed/plans.sarif").read_bytes())} == {
        "large.STEP",
        "parts/slot.step",
    }
    marked = [line for line in done.stderr.splitlines() if line.startswith("::error ")]
    assert [line.partition(",")[0] for line in marked] == ["::error file=large.STEP", "::error file=parts/slot.step"]
    assert (temp / "plan-cutters-changed/after/sub/a name.step/review.html").is_file()


@pytest.mark.slow("runs whole commands")
def test_what_was_planned_is_not_planned_again(repository, ran):
    """Without a change of content the plans of the cache are taken, byte for byte; the rule alone makes the code."""
    temp, (_, summary, _) = ran
    kept = {path: path.stat().st_mtime_ns for path in (temp / "plan-cutters-plans").rglob("plan.json")}
    assert len(kept) == 3
    done, again, _ = step(*repository, temp, options=OPTIONS, **{"fail-on": "none"})
    assert done.returncode == 0
    assert {path: path.stat().st_mtime_ns for path in (temp / "plan-cutters-plans").rglob("plan.json")} == kept
    assert [line for line in again.splitlines() if "F" in line] == [
        line.replace("| fails |", "|   |") for line in summary.splitlines() if "F" in line
    ]


def test_a_branch_without_parts_passes(repository, tmp_path):
    done, summary, outputs = step(repository[0], "HEAD", tmp_path)
    assert (done.returncode, outputs["parts"]) == (0, "0")
    assert "No part changed" in summary


def command(words, folder, **environment):
    """Run it in a process of its own: it starts others."""
    return subprocess.run([sys.executable, "-m", "plan_cutters", "changed", *words], cwd=folder, env=ENV | environment,
                          capture_output=True, text=True, check=False)  # fmt: skip


def test_mistakes_are_one_line(repository, tmp_path):
    folder, base = repository
    for words, said in (
        (["--base", "nowhere"], "'nowhere' is not in this repository"),
        (["--base", base, "--", "-o", "there"], "-o cannot stand after --"),
        ([], "give --base"),
        (["--base", base, "--", "--cutters", "none.fctl"], "none.fctl: cannot be read"),
        (["--base", base, "--", "other.step"], "other.step cannot stand after --"),
        (["--base", base, "--fail-on", "rain"], "'rain'"),
    ):
        done = command(words, folder)
        assert (done.returncode, done.stdout) == (2, "")
        (line,) = done.stderr.splitlines()
        assert line.startswith("plan-cutters changed: ")
        assert said in line
    done = command(["--base", "HEAD"], tmp_path, GIT_CEILING_DIRECTORIES=str(tmp_path.parent))
    assert (done.returncode, len(done.stderr.splitlines())) == (2, 1)


def test_what_is_staged_is_found_before_the_commit(tmp_path, monkeypatch):
    """The hook of pre-commit looks at the index, not at files that are not added."""
    monkeypatch.chdir(tmp_path)
    git("init", "-q")
    Path("a.step").write_text("one")
    git("add", "a.step")
    git("commit", "-qm", "one")
    Path("a.step").write_text("two")
    assert changed("HEAD", None)[2] == []
    git("add", "a.step")
    Path("a.step").write_text("three")
    _, until, found = changed("HEAD", None)
    assert found == [Changed("a.step", "a.step")]
    assert content(until, "a.step") == b"two"
    (hook,) = yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text())
    assert hook["entry"].split() == ["plan-cutters", "changed", "--base", "HEAD", "--staged"]
    Path("a.step").write_text(POINTER)
    git("add", "a.step")
    with pytest.raises(PlanError, match="pointer of Git LFS"):
        content(changed("HEAD", None)[1], "a.step")


def shop(folder):
    """A library of FreeCAD, whose bit lies in another folder, and a machine of LinuxCNC, which includes a file."""
    for name in ("tools/Library", "tools/Bit", "machine"):
        (folder / name).mkdir(parents=True)
    bit = {"shape": "ballend.fcstd", "name": "b", "parameter": {
        "Diameter": "4 mm", "CuttingEdgeHeight": "20 mm", "Length": "50 mm", "ShankDiameter": "4 mm"}}  # fmt: skip
    (folder / "tools/Bit/b.fctb").write_text(json.dumps(bit))
    (folder / "tools/Library/l.fctl").write_text(json.dumps({"tools": [{"nr": 1, "path": "b.fctb"}], "version": 1}))
    (folder / "machine/base.inc").write_bytes(real_file("machines/linuxcnc_xyzac-trt.ini").read_bytes())
    (folder / "machine/m.ini").write_text("[KINS]\nJOINTS = 5\n#INCLUDE base.inc\n")
    return ["--cutters", "tools/Library/l.fctl", "--assume-stickout", "30", "--holder", "none", "--machine", "machine/m.ini"]


def test_a_file_that_an_option_leads_to_makes_another_key(tmp_path, monkeypatch):
    """Not the files that options name alone: what these name in turn, wherever it lies."""
    monkeypatch.chdir(tmp_path)
    words = shop(tmp_path)

    def key():
        request = PartRequest.of(words)
        return request.settings.key

    first = key()
    assert key() == first
    seen = {first}
    for name, old, new in (
        ("tools/Bit/b.fctb", "4 mm", "12 mm"),
        ("machine/base.inc", "MAX_LIMIT =   50", "MAX_LIMIT =   40"),
        ("machine/switchkins_postgui.hal", "", "setp a b"),
    ):
        file = tmp_path / name
        text = file.read_text() if file.exists() else ""
        assert old in text
        file.write_text(text.replace(old, new) if old else new)
        assert key() not in seen
        seen.add(key())
        file.write_text(text) if text else file.unlink()
        assert key() == first


@pytest.mark.slow("starts commands and ends them on the way")
def test_a_tool_that_changed_in_another_folder_is_planned_anew(tmp_path):
    """The bit grows from D4 to D12 in a folder beside that of the library which the option names."""
    words = shop(tmp_path)[:6]
    part(tmp_path / "a.step", 8)
    before = Path.cwd()
    os.chdir(tmp_path)
    try:
        git("init", "-q")
        git("commit", "-q", "--allow-empty", "-m", "none")
        git("add", "a.step")
        git("commit", "-qm", "part")
    finally:
        os.chdir(before)
    asked = ["--base", "HEAD~1", "--cache", "kept", "--fail-on", "none", "--"]
    plan, ids = tmp_path / "plan-cutters-changed/after/a.step/plan.json", []
    for size in ("4 mm", "12 mm", "4 mm"):
        bit = tmp_path / "tools/Bit/b.fctb"
        bit.write_text(bit.read_text().replace("4 mm", size).replace("12 mm", size))
        done = command([*asked, "--faces", "all", "--grid", "3", "--area-budget", "0", *words], tmp_path)
        assert done.returncode == 0, done.stderr
        ids += [each["id"] for each in json.loads(plan.read_text())["cutters"]]
    assert [each.partition("L")[0] for each in ids] == ["R2", "R6", "R2"]
    assert len(list((tmp_path / "kept").glob("*/plan.json"))) == 2
    # What was changed in the cache by hand is not believed: it is planned anew.
    for kept in (tmp_path / "kept").glob("*/plan.json"):
        kept.write_text(kept.read_text().replace('"feasible": false', '"feasible": true '))
    done = command([*asked, "--faces", "all", "--grid", "3", "--area-budget", "0", *words], tmp_path)
    assert '"feasible": true ' not in plan.read_text()
    assert not plan.with_name("done.json").exists()


def test_each_rule_is_stricter_than_the_one_before():
    lost, unread = Row(Changed("a", "a"), failed="x"), Row(Changed("a", "a"), unread="x")
    open_face = Row(Changed(None, "a"), unreachable=("F1",))
    assert [[row.breaks(rule) for rule in RULES] for row in (lost, open_face, unread)] == [
        [False, True, True, True], [False, False, True, True], [False, False, False, True],
    ]  # fmt: skip
    assert set(RULES) == set(ACTION["inputs"]["fail-on"]["description"].partition(" (")[0].replace(" or ", ", ").split(", "))


def test_a_job_without_a_request_has_annotations_and_nobody_else(monkeypatch):
    monkeypatch.setenv("GITHUB_ACTIONS", "true")
    assert [requested(kind) for kind in (None, "github", "none")] == [True, True, False]
    monkeypatch.delenv("GITHUB_ACTIONS")
    assert [requested(kind) for kind in (None, "github", "none")] == [False, True, False]


def test_names_can_neither_end_an_annotation_nor_begin_a_command():
    """As the runner reads a line: properties up to `::`, parted by commas, then the text; each with its escapes undone."""
    name, text = "a,b:c\n::stop%0A.step", "100 %\r\n::add-mask::x"
    (line,) = annotations([(name, [Case(name, "F1", "failure", "k", text), Case(name, "F2"), Case(name, "F3", "skipped")])])
    assert len(line.splitlines()) == 1
    head, _, data = line.removeprefix("::error ").partition("::")

    def undone(value):
        for escape, char in (("%3A", ":"), ("%2C", ","), ("%0A", "\n"), ("%0D", "\r"), ("%25", "%")):
            value = value.replace(escape, char)
        return value

    properties = dict(each.split("=") for each in head.split(","))
    assert {key: undone(value) for key, value in properties.items()} == {"file": name, "title": "plan-cutters"}
    assert undone(data) == f"F1: {text}"


def test_no_more_annotations_are_written_than_github_shows():
    def lines(parts, findings=1):
        rows = [(f"{i}.step", [Case("p", f"F{k}", "error", "k", "m") for k in range(findings)]) for i in range(parts)]
        return [*annotations(rows)]

    assert [len(lines(n)) for n in (0, 1, 10, 11, 40)] == [0, 1, 10, 10, 10]
    assert lines(40)[-1].endswith("::31 more parts fail: the summary has all")
    assert lines(1, 7)[0].endswith("%0AF4: m%0Aand 2 more")


def test_what_pip_downloads_is_cached_before_it_is_installed():
    steps = ACTION["runs"]["steps"]
    (cache,) = [i for i, each in enumerate(steps) if each.get("with", {}).get("path") == "~/.cache/pip"]
    (install,) = [i for i, each in enumerate(steps) if each.get("name") == "Install"]
    (key,) = [i for i, each in enumerate(steps) if each.get("id") == "requirements"]
    assert key < cache < install
    assert "steps.requirements.outputs.key" in steps[cache]["with"]["key"]
    assert {"author", "branding"} <= set(ACTION)
    assert set(ACTION["branding"]) == {"icon", "color"}


def test_the_image_is_slim_and_not_root():
    """Its build step is that of `.ci/installed.py`: the package and its declared requirements alone."""
    lines = (ROOT / "Dockerfile").read_text(encoding="utf-8").splitlines()
    users = [line.split()[1] for line in lines if line.startswith("USER ")]
    assert users
    assert users[-1] not in ("root", "0")
    assert all("slim" in line for line in lines if line.startswith("FROM "))
    kept = {line[1:] for line in (ROOT / ".dockerignore").read_text().splitlines() if line.startswith("!")}
    assert {"plugin", "cad_io", "pyproject.toml", "README.md", "LICENSE"} == kept
    setup = (ROOT / "setup.sh").read_text(encoding="utf-8")
    assert all(name in "\n".join(lines) and name in setup for name in ("libgl1", "libx11-6"))
