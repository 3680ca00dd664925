"""The command as a user calls it: exit codes, one clear line, nothing half-written."""

import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import jsonschema
import pytest

from plan_cutters.report.folder import Staging
from tests.support.commands import assert_one_line, in_lines, leftovers, said_until
from tests.support.forked import ENV, run, start
from tests.support.places import ROOT, SAMPLES


def run_anew(*words, cwd, timeout=240):
    """The command in a process that begins with nothing imported."""
    return subprocess.run([sys.executable, "-m", "plan_cutters", *map(str, words)], cwd=cwd, env=ENV,
                          capture_output=True, text=True, timeout=timeout, check=False)  # fmt: skip


def test_help_and_version_do_not_load_the_kernel(tmp_path):
    done = run_anew("--help", cwd=tmp_path)
    assert done.returncode == 0
    assert "--cutter SPEC" in done.stdout
    code = "import sys; sys.argv = ['x', '--help']\nfrom plan_cutters.command.cli import main\n"
    code += "try: main()\nexcept SystemExit: pass\n"
    code += "assert not {'OCP', 'numba', 'scipy', 'numpy', 'pydantic'} & set(sys.modules), sorted(sys.modules)"
    subprocess.run([sys.executable, "-c", code], cwd=tmp_path, env=ENV, check=True, capture_output=True)
    assert "0.1.0" in run("--version", cwd=tmp_path).stdout


@pytest.mark.parametrize(
    ("name", "content", "cause"),
    [
        ("missing.step", None, "missing.step"),
        ("empty.step", b"", "empty"),
        ("text.step", b"This is a shopping list.\nMilk\n", "STEP"),
        ("page.step", b"<!DOCTYPE html><html><body>404</body></html>", "web page"),
        ("garbage.igs", bytes(range(256)) * 40, "not"),
        ("part.dwg", b"AC1032\0\0\0", "part.dwg"),
    ],
)
def test_what_cannot_be_read_is_refused_with_its_cause(tmp_path, name, content, cause):
    if content is not None:
        (tmp_path / name).write_bytes(content)
    done = run(name, "--cutter", "R6L80", cwd=tmp_path)
    assert_one_line(done, 3, name, cause)
    assert leftovers(tmp_path, name) == []


def test_part_without_faces(tmp_path):
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge
    from OCP.gp import gp_Pnt
    from OCP.STEPControl import STEPControl_AsIs, STEPControl_Writer

    writer = STEPControl_Writer()
    writer.Transfer(BRepBuilderAPI_MakeEdge(gp_Pnt(0, 0, 0), gp_Pnt(1, 0, 0)).Edge(), STEPControl_AsIs)
    writer.Write(str(tmp_path / "wire.step"))
    assert_one_line(run("wire.step", cwd=tmp_path), 3, "wire.step", "surface")
    assert leftovers(tmp_path, "wire.step") == []


@pytest.mark.parametrize(
    ("words", "cause"),
    [
        (["--cutter", "X9"], "R6L80"),
        (["--cutter", "R-6L80"], "positive"),
        (["--cutter", "R6L0"], "positive"),
        (["--cutter", "R6L80F90"], "shorter than its flutes"),
        (["--cutter", "R6L80rc9"], "corner radius"),
        (["--tilt", "60:0"], "60:0"),
        (["--tilt", "0:190"], "0:190"),
        (["--tilt", "steep"], "MIN:MAX"),
        (["--rotation", "0:400"], "0:400"),
        (["--rotation-step", "0"], "rotation step"),
        (["--machine", "tilt:x"], "tilt:"),
        (["--machine", "haas"], "haas"),
        (["--setup", "0,0,0"], "setup"),
        (["--setup", "up"], "x,y,z"),
        (["--grid", "1"], "grid"),
        (["--grid", "5", "--spacing", "1"], "not both"),
        (["--spacing", "-1"], "spacing"),
        (["--spacing", "1e-9"], "samples"),
        (["--grid", "4000"], "samples"),
        (["--tolerance", "0"], "tolerance"),
        (["--faces", "G3"], "--faces"),
        (["--faces", "1-9999999999"], "no face F9999999999"),
        (["--faces", "component:rim"], "component"),
        (["--ignore", "F9"], "--ignore F9"),
        (["--ignore", "all"], "--ignore"),
        (["--faces", "7"], "F7"),
        (["--formats", "pdf"], "pdf"),
        (["--jobs", "0"], "jobs"),
        (["--cutters", "shop.tools"], "shop.tools: cannot be read"),
        (["--skip-bad"], "give it with --cutters"),
        (["--assume-stickout", 30], "give it with --cutters"),
        (["--holder", "er16.fcholder"], "er16.fcholder"),
        (["--answers", "radii"], "radii"),
        (["--fixture", "box:1,2"], "box takes x,y,z"),
        (["--allowance", "-0.3"], "allowance -0.3"),
        (["--holder-clearance", "nan"], "holder clearance must be a number"),
        (["--holder", "R15"], "R15L30"),
        (["--cutter", "R6L80", "--holder", "R5L30"], "narrower than what it holds"),
        (["--cluster", "tcp://x:1"], "--cluster was taken out: one part is judged here"),
        (["--verdicts", "kept"], "--verdicts was taken out: leave it out"),
        (["--nonsense"], "--nonsense"),
        (["--json", "plan.json"], "standard output"),
    ],
)
def test_wrong_words_are_named(tmp_path, words, cause):
    done = run(SAMPLES / "v_groove.step", *words, cwd=tmp_path)
    assert_one_line(done, 2, cause)
    assert leftovers(tmp_path) == []


def test_output_that_cannot_be_written(tmp_path):
    (tmp_path / "taken").write_text("a file")
    assert_one_line(run(SAMPLES / "v_groove.step", "-o", "taken", cwd=tmp_path), 2, "taken", "folder")
    assert_one_line(run(SAMPLES / "v_groove.step", "-o", "taken/inside", cwd=tmp_path), 2, "taken", "write")
    assert leftovers(tmp_path, "taken") == []


def test_the_files_of_a_plan(tmp_path):
    done = run(SAMPLES / "pocket_top.step", "--cutter", "R3L60", "--cutter", "R40L60", "--spacing", "4",
               "--area-budget", "300", cwd=tmp_path)  # fmt: skip
    assert done.returncode == 0, done.stderr
    out = tmp_path / "pocket_top-plan"
    assert leftovers(tmp_path) == ["pocket_top-plan"]
    assert leftovers(out) == ["annotated.glb", "annotated.step", "plan.json", "process.toml", "review.html", "samples.npz"]
    plan = json.loads((out / "plan.json").read_text())
    schema = json.loads((ROOT / "plugin/plan_cutters/plan.schema.json").read_text())
    jsonschema.Draft202012Validator(schema).validate(plan)
    assert plan["selected"] == "R3L60"
    assert [c["id"] for c in plan["cutters"]] == ["R40L60", "R3L60"]
    assert plan["cutters"][0]["feasible"] is False
    for c in plan["cutters"]:
        parts = ("interference_free", "accessible", "inaccessible", "undecided", "unjudged")
        assert sum(c[k] for k in parts) == plan["samples"]["count"]
        assert sum(c["by_reason"].values()) == c["inaccessible"]
    assert "R3L60" in done.stdout
    assert "without a holder" in in_lines(done.stdout)
    assert done.stdout.index("Take flat end D6 x 60") < done.stdout.index("flat end D80 x 60 ")
    # The last lines say what is not reached, and why.
    assert "Each alone reaches: flat end D80 x 60" in done.stdout
    assert len(done.stdout.splitlines()) <= 25


@pytest.mark.slow("runs whole commands")
def test_two_runs_give_the_same_bytes(tmp_path):
    """One in a process that begins with nothing, one in a copy of this one, which has done much else before."""
    words = [SAMPLES / "pocket_top.step", "--cutter", "R4L60", "--grid", "9", "--area-budget", "60", "--quiet"]
    for name, jobs, how in (("a", 1, run_anew), ("b", 2, run)):
        done = how(*words, "-o", name, "--jobs", jobs, cwd=tmp_path)
        assert done.returncode == 0
        assert done.stderr == ""
    for file in ("annotated.glb", "annotated.step", "samples.npz"):
        assert (tmp_path / "a" / file).read_bytes() == (tmp_path / "b" / file).read_bytes(), file
    plans = [json.loads((tmp_path / n / "plan.json").read_text()) for n in ("a", "b")]
    for plan in plans:
        del plan["run"]
    assert plans[0] == plans[1]


def test_plan_on_standard_output_and_exit_1(tmp_path):
    done = run(
        SAMPLES / "v_groove.step",
        "--cutter",
        "R8L90",
        "--grid",
        "9",
        "--area-budget",
        "0",
        "--json",
        "-",
        "--machine",
        "tilt:10",
        cwd=tmp_path,
    )
    assert done.returncode == 1
    plan = json.loads(done.stdout)
    assert plan["selected"] is None
    assert leftovers(tmp_path) == []


def test_several_parts_the_largest_code(tmp_path):
    (tmp_path / "bad.step").write_text("no")
    done = run(
        SAMPLES / "v_groove.step",
        "bad.step",
        "--cutter",
        "R2L90",
        "--grid",
        "9",
        "--area-budget",
        "0",
        "--formats",
        "json",
        cwd=tmp_path,
    )
    assert done.returncode == 3
    assert leftovers(tmp_path, "bad.step") == ["v_groove-plan"]
    assert "bad.step: plan-cutters: bad.step" in done.stderr


@pytest.mark.slow("starts commands and ends them on the way", only=("in",))
@pytest.mark.parametrize("ignored", [False, True], ids=["", "in the background"])
def test_an_interrupt_leaves_nothing(tmp_path, ignored):
    """A shell lets what it runs in the background ignore interrupts; asked for in person, one still counts."""
    process = start(SAMPLES / "peaks_and_valleys.step", "--grid", "401", cwd=tmp_path,
                    ignored=(signal.SIGINT,) if ignored else ())  # fmt: skip
    said_until(process, "taking samples")  # a first look stands after it
    process.send_signal(signal.SIGINT)
    _, rest = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "Traceback" not in rest
    assert "interrupted" in rest
    assert leftovers(tmp_path) == []


def test_a_read_that_hangs_is_ended(tmp_path):
    process = start(SAMPLES / "peaks_and_valleys.step", "--read-timeout", "1", cwd=tmp_path)
    said_until(process, "reading")
    children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
    os.kill(int(children[0]), signal.SIGSTOP)
    _, rest = process.communicate(timeout=60)
    assert process.returncode == 3
    assert "peaks_and_valleys.step" in rest
    assert "--read-timeout" in rest.strip().splitlines()[-1]
    assert leftovers(tmp_path) == []


def test_a_crash_of_the_kernel_is_one_line(tmp_path):
    process = start(SAMPLES / "peaks_and_valleys.step", "--grid", "401", cwd=tmp_path)
    said_until(process, "taking samples")
    children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
    os.kill(int(children[0]), signal.SIGSEGV)
    _, rest = process.communicate(timeout=60)
    assert process.returncode == 3
    assert "Traceback" not in rest
    assert "SIGSEGV" in rest.strip().splitlines()[-1]
    assert leftovers(tmp_path) == []


def test_an_interrupt_at_the_very_start(tmp_path):
    for delay in (0.1, 0.3, 0.8):
        process = subprocess.Popen(
            [sys.executable, "-m", "plan_cutters", str(SAMPLES / "v_groove.step")],
            cwd=tmp_path, env=ENV, stderr=subprocess.PIPE, text=True,
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),  # whoever runs the tests may ignore it
        )  # fmt: skip
        time.sleep(delay)
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=60)
        # Before any code of ours runs, the interpreter itself may end with 1.
        assert process.returncode in (130, -signal.SIGINT, *([1] if delay < 0.2 else []))
        assert delay < 0.2 or process.returncode == 130
        assert delay < 0.2 or "Traceback" not in said
        assert leftovers(tmp_path) == []


def test_a_folder_is_named_before_it_exists(tmp_path):
    seen = []
    with Staging(tmp_path / "out", lambda folder: seen.append((folder, folder.exists()))) as staging:
        assert (staging.folder, False) in seen
        assert staging.folder.is_dir()
    assert leftovers(tmp_path) == []


def test_debug_shows_the_traceback_and_keeps_the_code(tmp_path):
    done = run("missing.step", "--debug", cwd=tmp_path)
    assert done.returncode == 3
    assert "Traceback" in done.stderr
    assert done.stderr.strip().splitlines()[-1].startswith("plan-cutters: missing.step")


@pytest.mark.slow("starts commands and ends them on the way")
def test_a_copy_of_this_process_says_what_a_new_one_does(tmp_path):
    """What lets most tests of the command run without the start of an interpreter."""
    (tmp_path / "bad.step").write_text("no")
    quick = (SAMPLES / "v_groove.step", "--cutter", "R2L90", "--grid", "5", "--area-budget", "0", "--formats", "json")
    seconds = re.compile(r"^ +[0-9.]+ s  .*$|[0-9.]+ s\b", re.MULTILINE)  # which stage began when, and how long all took
    for words in ((*quick, "bad.step"), (*quick, "--grid", "1")):
        anew, copied = run_anew(*words, cwd=tmp_path), run(*words, cwd=tmp_path)
        assert anew.returncode == copied.returncode
        for a, b in ((anew.stderr, copied.stderr), (anew.stdout, copied.stdout)):
            assert seconds.sub("", a).split() == seconds.sub("", b).split()


def test_too_little_memory_is_said(tmp_path):
    assert_one_line(run(SAMPLES / "v_groove.step", "--memory", "1", cwd=tmp_path), 2, "--memory")
