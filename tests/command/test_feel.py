"""How the command feels: what it says, how soon, how wide, and what it does with streams and names that are odd."""

import json
import os
import pty
import re
import signal
import subprocess
import sys
import time
import warnings
from itertools import takewhile
from pathlib import Path
from types import SimpleNamespace

import pytest

from plan_cutters import plan
from plan_cutters.command import entry, one_part
from plan_cutters.command import map as of_a_point
from plan_cutters.command import summary as summaries
from plan_cutters.command.codes import CODES
from plan_cutters.command.progress import Display
from plan_cutters.command.summary import _distinct
from plan_cutters.command.terminal import show
from plan_cutters.domain.figures import percent
from plan_cutters.domain.standard_tools import builtin
from plan_cutters.plan_file.model import Plan
from plan_cutters.plan_file.words.cutters import others
from plan_cutters.plan_file.words.text import story_of, with_text
from plan_cutters_base.terminal_text import clean
from plan_cutters_base.user_cache import CacheWarning
from plan_cutters_base.workers.child import VARIABLE, Assignment
from plan_cutters_base.workers.supervise import _Watch
from tests.support.commands import assert_one_line, in_lines, leftovers, said_until
from tests.support.forked import ENV, run, start
from tests.support.places import SAMPLES

GROOVE = SAMPLES / "v_groove.step"
QUICK = ("--cutter", "R6L80", "--grid", "5", "--area-budget", "0")
FILES = ("--formats", "json,step,glb,npz", "-o", "out")
#: A part, cutters that fail and one that does not.
WAVES = SAMPLES / "peaks_and_valleys.step"
COLOUR = re.compile(r"\x1b\[[0-9;]*m")


@pytest.fixture(scope="module")
def planned():
    return plan(WAVES, cutters=["R12L120", "R6L80", "R3L60"], grid=41, area_budget=4000).plan


@pytest.fixture(scope="module")
def failing():
    return plan(SAMPLES / "pocket_top.step", cutters=["R40L60", "R30L60", "R25L60"], faces="all", grid=7, area_budget=0,
                machine="tilt:20", other_setups=[(1, 0, 0)]).plan  # fmt: skip


def shown(capsys, document, *, verbose=False):
    """What the summary says."""
    capsys.readouterr()
    summaries.summary(document, verbose=verbose)
    after = others(document) if verbose else []
    show(*after, *summaries.written(document, Path("out"), ("json",), verbose=verbose))
    return capsys.readouterr().out


# ---- what is looked at before the kernel


@pytest.mark.parametrize(
    ("words", "code", "cause"),
    [
        (["missing.step"], 3, "missing.step: no such file"),
        (["empty.step"], 3, "empty.step: is empty"),
        (["folder.step"], 3, "folder.step: is a folder"),
        (["text.step"], 3, "text.step: is named .step but does not start as STEP does"),
        ([""], 2, "PART"),
        ([GROOVE, "--cutter", "X9"], 2, "R6L80"),
        ([GROOVE, "--formats", "pdf"], 2, "pdf"),
        ([GROOVE, "--formats", ""], 2, "no format given"),
        ([GROOVE, "--spacing", "1e300"], 2, "spacing 1e+300 must be"),
        ([GROOVE, "--spacing", "nan"], 2, "spacing must be a number"),
        ([GROOVE, "--allowance", "1e300"], 2, "allowance 1e+300 must be"),
        ([GROOVE, "--holder-clearance", "inf"], 2, "holder clearance inf must be"),
        ([GROOVE, "--jobs", "99999999999"], 2, "jobs"),
        ([GROOVE, "--read-timeout", "nan"], 2, "--read-timeout"),
        ([GROOVE, "--timeout", "0"], 2, "--timeout"),
        ([GROOVE, "--memory", "nan"], 2, "--memory"),
        ([GROOVE, "--faces", "9-3"], 2, "9-3 runs backwards"),
        ([GROOVE, "--faces", "F0"], 2, "numbered from 1"),
        ([GROOVE, "--faces", "name:("], 2, "not a regular expression"),
        ([GROOVE, "--ignore", "what"], 2, "--ignore what: give sculptured"),
        ([GROOVE, "--fixture", "vise.stl"], 3, "vise.stl: no such file"),
        ([GROOVE, "--fixture", "empty.step"], 3, "empty.step: is empty"),
        ([GROOVE, "-o", "text.step"], 2, "text.step: the output must be a folder"),
        ([GROOVE, "-o", ""], 2, "-o"),
        ([GROOVE, WAVES, "--json", "-"], 2, "-o DIR --formats json"),
        (["-x.step"], 2, "./-x.step"),
    ],
)
def test_mistakes_cost_little_and_load_no_kernel(tmp_path, words, code, cause):
    (tmp_path / "empty.step").touch()
    (tmp_path / "folder.step").mkdir()
    (tmp_path / "text.step").write_text("a shopping list")
    (tmp_path / "-x.step").write_bytes(GROOVE.read_bytes())
    done = run(*words, cwd=tmp_path, bare=True)
    assert_one_line(done, code, cause)
    assert len(done.stderr.splitlines()) == 1
    assert leftovers(tmp_path, "empty.step", "folder.step", "text.step", "-x.step") == []


@pytest.mark.slow("starts commands and ends them on the way")
def test_of_several_parts_those_that_cannot_be_read_are_named_at_once(tmp_path):
    done = run(GROOVE, "missing.step", *QUICK, "--formats", "json", cwd=tmp_path)
    assert done.returncode == 3
    first, *rest = done.stderr.splitlines()
    assert first == "plan-cutters: missing.step: no such file; the other parts are planned"
    assert rest[-1] == "missing.step: plan-cutters: missing.step: no such file"
    assert f"{GROOVE}: {dict(CODES)['0']}" in done.stdout.splitlines()
    assert leftovers(tmp_path) == ["v_groove-plan"]


# ---- help and completion


def test_help_is_in_groups_with_examples_and_fits(tmp_path):
    said = run("--help-all", cwd=tmp_path).stdout
    heads = re.findall(r"^(\w.*):$", said, re.MULTILINE)
    assert heads == ["Commands", "Cutters", "Machine and setup", "Faces", "Sampling and tolerances", "Postures", "Output",
                     "Answers", "Plan of operations", "Run", "Examples", "Exit codes"]  # fmt: skip
    assert max(map(len, said.splitlines())) <= 80
    assert "\x1b" not in said
    examples = [line.split() for line in said.splitlines() if line.strip().startswith("plan-cutters ")]
    assert len(examples) >= 5
    for _, *words in examples:
        name = f"plan-cutters {words.pop(0)}" if words[0] in entry.commands() else "plan-cutters"
        params = entry.module_of(name).command.make_context(name, words).params
        assert params.get("parts") or params["part"]


def completed(words, cwd):
    """What bash is offered after these words."""
    asked = {"_PLAN_CUTTERS_COMPLETE": "bash_complete", "COMP_WORDS": " ".join(["plan-cutters", *words]),
             "COMP_CWORD": str(len(words))}  # fmt: skip
    done = run(cwd=cwd, environment=ENV | asked, bare=True)
    assert done.returncode == 0
    return done.stdout.split()


@pytest.mark.parametrize(
    ("words", "offered"),
    [
        (["--machine", "trunnion-a"], ["plain,trunnion-ac"]),
        (["--machine", "shop.f"], ["file,"]),
        (["--formats", "json,g"], ["plain,json,glb"]),
        (["--answers", "m"], ["plain,mend"]),
        (["--faces", "s"], ["plain,sculptured"]),
        (["--unit", "i"], ["plain,in"]),
        (["--out", ""], ["dir,"]),
        (["bla"], ["file,"]),
        (["--list-c"], ["plain,--list-cutters"]),
    ],
)
def test_completion_knows_names_and_loads_no_kernel(tmp_path, words, offered):
    assert completed(words, tmp_path) == offered


# ---- what is said


def test_the_first_line_says_which_cutter_to_take(capsys, planned):
    said = shown(capsys, planned, verbose=True)
    assert said.startswith("Take flat end D12 x 80: it finishes all 7,010 mm².\nAn open shell: ")
    assert "\nFor peaks_and_valleys.step, 28.67 x 111.5 x 58.51 mm: R6L80, " in said
    assert "without a holder" in in_lines(said)
    assert re.search(r"^> flat end D12 x 80 +yes ", said, re.MULTILINE)
    assert re.search(r"^  flat end D24 x 120 +no ", said, re.MULTILINE)
    # Near the end is what is not reached, and why.
    assert re.search(r"\nFlat end D24 x 120 does not reach (.*\n  )*.*(rear\s+gouge|collision)(.*\n  )*.*\n", said)


def test_what_is_served_between_samples_is_put_in_words(capsys, planned):
    (entry,) = [c for c in planned.cutters if c.area]
    said = in_lines(shown(capsys, planned, verbose=True))
    assert f"{percent(entry.area.share, some=True, whole=False)} of the area is proved safe with the tool axis kept" in said
    assert "is not proved, which does not mean unsafe" in said


def test_where_none_is_feasible_the_worst_faces_are_listed(capsys, failing):
    said = shown(capsys, failing, verbose=True)
    assert in_lines(said).startswith("2 steps in 2 setups finish 99.6 % of 9,040 mm²; 0.4 % stay")
    assert "pocket_top.step, 60 x 40 x 24.51 mm, on tilt:20." in in_lines(said)
    assert "--answers mend" in in_lines(said)
    assert "Each alone reaches: " in in_lines(shown(capsys, failing))
    head = next(i for i, line in enumerate(said.splitlines()) if line.startswith("Where "))
    rows = [line.split() for line in takewhile(str.strip, said.splitlines()[head + 2 :])]
    best = max(failing.cutters, key=lambda c: c.interference_free + c.accessible)
    areas = {face.id: face.area_mm2 for face in failing.faces}
    not_reached = {name: areas[name] * (v.area_share.inaccessible + v.area_share.undecided) for name, v in best.faces.items()}
    worst = sorted(not_reached.values(), reverse=True)[:5]
    assert [not_reached[row[0]] for row in rows] == pytest.approx([each for each in worst if each])
    assert all(head in said for head in ("mm2 not reached", "of the face"))
    assert "Over the 2 setups" in said


def test_percentages_are_never_nicer_than_the_truth(planned):
    assert percent(0.0, some=False, whole=False) == "0 %"
    assert percent(1e-9, some=True, whole=False) == "<0.1 %"
    # A sample without an area is still one.
    assert percent(0.0, some=True, whole=False) == "<0.1 %"
    assert percent(1.0, some=True, whole=False) == ">99.9 %"
    assert percent(0.9996, some=True, whole=False) == ">99.9 %"
    assert percent(1.0, some=True, whole=True) == "100 %"
    assert percent(0.123456, some=True, whole=False) == "12.3 %"


NASTY = "rim\n\x1b[2J\x9b31m\r\u202eevil\x07\u2028 <b>"


def everywhere(value, text):
    """A plan file's content with a text at the end of each of its own that is only shown."""
    if isinstance(value, dict):
        kept = {
            "format",
            "id",
            "selected",
            "selected_over_setups",
            "selected_for_setup",
            "stand_in",
            "rung",
            "verdict",
            "part",
            "carries",
            "sampled_by",
            "sharp_edges",
            "effort",
            "units",
            "group",
            "mode",
            "kind",
            "strategy",
            "take",
            "cutter",
            "shown",
            "cause",
        }
        return {k: v if k in kept and isinstance(v, str) else everywhere(v, text) for k, v in value.items()}
    if isinstance(value, list):
        return [everywhere(each, text) for each in value]
    return value + text if isinstance(value, str) else value


def nasty(document):
    found = json.loads(document.model_dump_json())
    return with_text(Plan.model_validate(everywhere(found, NASTY) | {"units": found["units"], "text": found["text"]}))


@pytest.mark.parametrize("verbose", [False, True])
def test_no_name_steers_the_terminal(capsys, planned, failing, verbose):
    for document in (planned, failing):
        said = COLOUR.sub("", shown(capsys, nasty(document), verbose=verbose))
        assert set(said) & set(map(chr, range(32))) == {"\n"}
        assert not set(said) & set("\x7f\x9b\u202e\u2028")
        assert r"\n\x1b[2J\x9b31m\r\u202eevil\x07\u2028" in said.replace("\n", "").replace("  ", "") or "x1b" in said
        assert max(map(len, said.splitlines())) <= 80


def long_names(document):
    """The same plan from a library with long names that differ in the middle or at the end."""
    cutters = []
    for i, c in enumerate(document.cutters):
        name = f"{'ultra ' * (i % 3)}long reach high performance end mill for moulds, variant {i} of the series, coated"
        source = {"file": "a.tools", "place": f"entry {i}", "number": i, "name": name, "kind": "flat", "unit": "mm", "notes": []}
        cutters.append(c.model_dump() | {"name": name, "sources": [source], "seconds": 0.0})
    return Plan.model_validate(document.model_dump() | {"cutters": cutters})


@pytest.mark.parametrize("columns", [20, 40, 72, 79, 80, 200])
def test_it_fits_any_terminal(capsys, monkeypatch, planned, failing, columns):
    monkeypatch.setattr("plan_cutters.command.terminal.is_terminal", lambda *_: True)
    monkeypatch.setenv("COLUMNS", str(columns))
    monkeypatch.setenv("NO_COLOR", "1")
    for document in (planned, failing, long_names(planned), long_names(failing)):
        for verbose in (False, True):
            said = COLOUR.sub("", shown(capsys, document, verbose=verbose))
            assert max(map(len, said.splitlines())) <= min(columns, 80)


def test_many_cutters_are_said_in_few_lines(capsys, failing):
    many = [c.model_copy(update={"id": f"{c.id}S{i}"}) for i in range(20) for c in failing.cutters]
    document = failing.model_copy(update={"cutters": many, "shown": many[0].id})
    assert len(shown(capsys, document).splitlines()) <= 25
    whole = in_lines(shown(capsys, document, verbose=True))
    assert all(f" ({c.id})" in whole for c in many)


def test_nineteen_cutters_are_one_table_with_their_whole_names(capsys):
    document = plan(GROOVE, cutters=builtin()[:19], grid=3, area_budget=0).plan
    names = [each.name for each in story_of(document).cutters]
    said = shown(capsys, document, verbose=True).splitlines()
    head = next(k for k, line in enumerate(said) if line.startswith("  cutter "))
    rows = said[head + 1 : head + 20]
    assert [re.match(r"[> ] (.*?) +(?:yes|no|unsure) ", row)[1] for row in rows] == names
    assert len(set(names)) == 19
    assert max(map(len, rows)) <= 80
    assert said[head + 20] == ""


def test_a_long_name_has_a_second_line_of_its_own(capsys, planned):
    said = shown(capsys, long_names(planned), verbose=True)
    rows = re.findall(r"^[> ] (\S.*?) +(?:yes|no) .*\n +(\S.*)$", said, re.MULTILINE)
    assert len({row for row in rows if "ultra" in row[0] or row[0].startswith("T0")}) == len(planned.cutters)


def test_names_that_are_shortened_stay_apart():
    names = [f"a long name of a tool, size {i}, of the same maker" for i in range(12)]
    short = _distinct(names, 20)
    assert len(set(short)) == 12
    assert max(map(len, short)) <= 20


def test_colours_where_they_help_and_words_always(capsys, monkeypatch, planned):
    plain = shown(capsys, planned, verbose=True)
    assert "\x1b" not in plain
    monkeypatch.setattr("plan_cutters.command.terminal.is_terminal", lambda *_: True)
    monkeypatch.setenv("TERM", "xterm-256color")
    monkeypatch.setenv("COLUMNS", "80")
    monkeypatch.delenv("NO_COLOR", raising=False)
    coloured = shown(capsys, planned, verbose=True)
    assert "\x1b[32myes" in coloured
    assert "\x1b[31mno" in coloured
    monkeypatch.setenv("NO_COLOR", "1")
    bold = shown(capsys, planned, verbose=True)
    assert not re.search(r"\x1b\[[0-9;]*3[0-9]", bold)
    # The same words in all of them.
    assert COLOUR.sub("", coloured).split() == COLOUR.sub("", bold).split() == plain.split()


def test_control_characters_are_written_out():
    assert clean("Kühlung ø8 ±0.1 工具") == "Kühlung ø8 ±0.1 工具"
    assert clean("a\tb\udcff") == r"a\tb\udcff"


# ---- progress


def test_plain_progress_is_a_line_now_and_then(capsys, monkeypatch):
    now = 0.0
    monkeypatch.setattr(time, "monotonic", lambda: now)
    display = Display(False, 40, 0.0)
    for stage in ("start", "read", "measure", "sew", "sample"):
        display.stage(stage)
        now += 0.2
    for i in range(40):
        display.stage(f"R{i + 1}L80")
        for done in range(30):
            now += 0.1
            display.at(done, 30)
            display.tick()
    said = capsys.readouterr().err.splitlines()
    assert [line.split("s  ")[1] for line in said[:4]] == [
        "starting",
        "reading the part",
        "taking samples",
        "judging the cutters",
    ]
    assert all(re.fullmatch(r" +\d+\.\d s  .+", line) for line in said)
    # 121 s of judging, a line every 5 s, with what is left of it.
    assert 21 <= len(said) - 4 <= 25
    shares = [int(re.search(r", (\d+) %", line)[1]) for line in said[4:]]
    left = [int(re.search(r"about (\d+) s left", line)[1]) for line in said[4:]]
    assert left == sorted(left, reverse=True)
    assert all(abs(share / 100 * 121 + rest - 121) < 5 for share, rest in zip(shares, left, strict=True))
    assert shares == sorted(shares)
    assert shares[-1] > 60
    assert "(39 of 40)" in said[-1] or "(3" in said[-1]


def test_work_that_stands_still_has_no_rest(monkeypatch):
    """What is left is reckoned from the share: one that does not grow would say the same second for a minute."""
    now = 0.0
    monkeypatch.setattr(time, "monotonic", lambda: now)
    display = Display(True, 1, 0.0)
    display.stage("reasons")
    for now, done in ((4.0, 96), (13.0, 96), (15.0, 96), (60.0, 96), (61.0, 98)):
        display.at(done, 100)
        assert bool(display.rest) == (now not in (15.0, 60.0))


def test_nothing_is_shown_where_it_is_quiet(capsys):
    display = Display(True, 1, 0.0)
    display.stage("read")
    display.tick()
    assert capsys.readouterr().err == ""


def test_what_the_child_says_comes_through_whatever_it_holds():
    here, there = os.pipe()
    heard = []
    display = SimpleNamespace(begins=heard.append, stage=heard.append, at=lambda *n: heard.append(n), say=heard.append,
                              show=heard.append)  # fmt: skip
    watch = _Watch(1.0, display)
    watch.pipe = here
    odd = "a\nsafe 0 /tmp\\x\udcff ü\u2028.step"
    child = f"from plan_cutters_base.workers.child import report as tell; odd = {odd!r}\n"
    child += "tell('part', odd); tell('at', '3 9'); tell('say', odd); tell('show', odd)"
    subprocess.run(
        [sys.executable, "-c", child], env=ENV | {VARIABLE: str(Assignment(report=there))}, pass_fds=(there,), check=True
    )
    watch.listen(0.0)
    os.close(here)
    os.close(there)
    assert heard == [odd, (3, 9), odd, odd]
    assert watch.part == odd
    assert watch.safe is None


def test_it_speaks_soon_and_shows_a_clock_on_a_terminal(tmp_path):
    parent, child = pty.openpty()
    environment = ENV | {"TERM": "xterm", "COLUMNS": "80"}
    process = start(GROOVE, *QUICK, *FILES, cwd=tmp_path, environment=environment, out=child, err=child)
    os.close(child)
    said = b""
    while True:
        try:
            data = os.read(parent, 1 << 16)
        except OSError:  # closed at the other end
            break
        if not data:
            break
        said += data
    os.close(parent)
    assert process.wait(120) == 0
    text = said.decode()
    before, _, after = text.partition("Take ")
    assert "starting" in before
    assert "0:0" in before
    assert "reading the part" in before
    assert "R6L80" in after
    # The line is taken away, and the cursor is there again.
    assert text.rstrip().endswith("\x1b[2K") or text.rstrip()[-1] in ".,)"
    assert text.rindex("\x1b[?25h") > text.rindex("\x1b[?25l")


# ---- streams


def test_what_is_found_goes_to_standard_output_and_all_else_to_standard_error(tmp_path):
    done = run(GROOVE, *QUICK, *FILES, cwd=tmp_path)
    assert done.stdout.startswith("Take flat end D12 x 80: it finishes all 13,300 mm².\nAn open shell: ")
    assert "\nFor v_groove.step" in done.stdout
    assert "\nWritten to out: plan.json" in done.stdout
    assert done.stderr
    assert all(re.fullmatch(r" +\d+\.\d s  .+", line) for line in done.stderr.splitlines())
    done = run(GROOVE, *QUICK, "--json", "-", cwd=tmp_path)
    assert json.loads(done.stdout)["selected"] == "R6L80"
    assert "\nTake flat end D12 x 80: it finishes all 13,300 mm².\nAn open shell: " in done.stderr


@pytest.mark.slow("starts commands and ends them on the way", only=(">",))
@pytest.mark.parametrize(("close", "code", "said"), [
    ("| true", 141, []),
    (">/dev/full", 2, ["plan-cutters: standard output: cannot be written: No space left on device"]),
    (">&-", 0, []),
])  # fmt: skip
def test_a_summary_that_nobody_can_read_costs_no_file(tmp_path, close, code, said):
    words = " ".join(map(str, (GROOVE, *QUICK, *FILES)))
    done = subprocess.run(["bash", "-c", f"{sys.executable} -m plan_cutters {words} {close}; exit ${{PIPESTATUS[0]}}"],
                          cwd=tmp_path, env=ENV, capture_output=True, text=True, check=False)  # fmt: skip
    assert done.returncode == code
    assert [line for line in done.stderr.splitlines() if " s  " not in line] == said
    assert leftovers(tmp_path / "out") == ["annotated.glb", "annotated.step", "plan.json", "process.toml", "samples.npz"]
    assert json.loads((tmp_path / "out/plan.json").read_text())["not_written"] == {}


@pytest.mark.slow("starts commands and ends them on the way")
def test_a_full_disk_behind_standard_output_is_one_line(tmp_path):
    for words in ((GROOVE, *QUICK, "--json", "-", "--quiet"), ("--help",)):
        with open("/dev/full", "w") as full:
            done = subprocess.run([sys.executable, "-m", "plan_cutters", *map(str, words)], cwd=tmp_path, env=ENV, stdout=full,
                                  stderr=subprocess.PIPE, text=True, check=False)  # fmt: skip
        assert done.returncode == 2
        assert done.stderr == "plan-cutters: standard output: cannot be written: No space left on device\n"


def closed(*words, cwd, close):
    """The command in a shell that closes a stream."""
    line = f'exec "$0" -m plan_cutters "$@" {close}'
    return subprocess.run(["sh", "-c", line, sys.executable, *map(str, words)], cwd=cwd, env=ENV, capture_output=True,
                          text=True, check=False)  # fmt: skip


@pytest.mark.slow("starts commands and ends them on the way")
def test_closed_streams(tmp_path):
    done = closed(GROOVE, *QUICK, "--json", "-", cwd=tmp_path, close=">&-")
    assert (done.returncode, done.stderr) == (2, "plan-cutters: --json -: standard output is closed\n")
    done = closed(GROOVE, *QUICK, *FILES, cwd=tmp_path, close="<&- >&- 2>&-")
    assert done.returncode == 0
    assert leftovers(tmp_path / "out") == ["annotated.glb", "annotated.step", "plan.json", "process.toml", "samples.npz"]


def test_a_reader_that_has_seen_enough_ends_it_quietly(tmp_path):
    reading, writing = os.pipe()
    os.close(reading)
    process = start(GROOVE, *QUICK, "--json", "-", "--quiet", cwd=tmp_path, out=writing)
    os.close(writing)
    assert process.communicate(120) == (None, "")
    assert process.returncode == 141
    process = subprocess.Popen([sys.executable, "-m", "plan_cutters", "--list-cutters"], cwd=tmp_path, env=ENV,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE)  # fmt: skip
    process.stdout.close()
    assert process.stderr.read() == b""
    process.stderr.close()
    assert process.wait(120) == 141


@pytest.mark.slow("starts commands and ends them on the way")
def test_standard_error_that_cannot_be_written_changes_nothing(tmp_path):
    with open("/dev/full", "w") as full:
        done = subprocess.run([sys.executable, "-m", "plan_cutters", str(GROOVE), *QUICK, *FILES], cwd=tmp_path, env=ENV,
                              stdout=subprocess.PIPE, stderr=full, check=False)  # fmt: skip
    assert done.returncode == 0
    assert done.stdout.startswith(b"Take flat end D12 x 80")
    assert leftovers(tmp_path / "out") == ["annotated.glb", "annotated.step", "plan.json", "process.toml", "samples.npz"]


# ---- names


def test_files_with_odd_names(tmp_path):
    odd = "a\n\x1b[31mß.step"
    (tmp_path / odd).write_bytes(GROOVE.read_bytes())
    done = run(odd, *QUICK, "--formats", "json", "-o", "out", cwd=tmp_path)
    assert done.returncode == 0
    assert "\x1b" not in done.stdout + done.stderr
    assert r"For a \x1b[31mß.step" in done.stdout
    (tmp_path / "-x.step").write_bytes(GROOVE.read_bytes())
    assert run("--quiet", "--formats", "json", "-o", "out", *QUICK, "--", "-x.step", cwd=tmp_path).returncode == 0


def test_a_name_that_is_no_text(tmp_path):
    (tmp_path / "bad\udcff.step").write_bytes(GROOVE.read_bytes())
    done = run("bad\udcff.step", *QUICK, cwd=tmp_path)
    assert_one_line(done, 3, r"bad\udcff.step: its name is no text")


# ---- signals


@pytest.mark.slow("starts commands and ends them on the way", only=("judging",))
@pytest.mark.parametrize("until", ["reading", "judging"])
def test_a_terminal_that_is_closed_ends_the_run(tmp_path, until):
    process = subprocess.Popen(
        [sys.executable, "-m", "plan_cutters", str(WAVES), "--grid", "401"], cwd=tmp_path, env=ENV, stderr=subprocess.PIPE,
        text=True, preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_DFL),  # whoever runs the tests may ignore it
    )  # fmt: skip
    said_until(process, until)
    children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
    process.send_signal(signal.SIGHUP)
    _, rest = process.communicate(timeout=60)
    assert process.returncode == 130
    assert rest.strip().splitlines()[-1] == "plan-cutters: interrupted; no file is half-written"
    assert not any(Path(f"/proc/{child}").exists() for child in children)
    assert leftovers(tmp_path) == []


@pytest.mark.slow("starts commands and ends them on the way")
def test_a_run_that_shall_survive_its_terminal_does(tmp_path):
    process = subprocess.Popen(
        [sys.executable, "-m", "plan_cutters", str(GROOVE), *QUICK, "--formats", "json"], cwd=tmp_path, env=ENV,
        stderr=subprocess.PIPE, text=True, preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN),
    )  # fmt: skip
    said_until(process, "reading")
    process.send_signal(signal.SIGHUP)
    process.communicate(timeout=60)
    assert process.returncode == 0


def test_an_interrupt_while_it_is_imported_is_one_line(tmp_path):
    """An interrupt within the imports: what they say is one line."""
    trap = "import builtins, os, signal\nreal = builtins.__import__\n"
    trap += "def slow(name, *rest):\n    if name == 'click': os.kill(os.getpid(), signal.SIGINT)\n    return real(name, *rest)\n"
    trap += "signal.signal(signal.SIGINT, signal.default_int_handler)\nbuiltins.__import__ = slow\n"
    call = f"{trap}from plan_cutters.command.entry import plan_cutters; plan_cutters()"
    done = subprocess.run([sys.executable, "-c", call, str(GROOVE)], cwd=tmp_path, env=ENV, capture_output=True, text=True,
                          check=False)  # fmt: skip
    assert (done.returncode, done.stderr) == (130, "plan-cutters: interrupted; no file is half-written\n")


@pytest.mark.parametrize("asked", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize(("module", "error"), [
    ("click", ""), ("plan_cutters.library.read", ""), ("plan_cutters.library.read", "ImportError('initialization failed')"),
])  # fmt: skip
def test_a_request_to_end_is_an_interrupt_in_commands_without_a_child(tmp_path, asked, module, error):
    """Within imports, too, which make of it what they like once the command is there."""
    trap = "import builtins, os, signal, time\nsignal.signal(signal.SIGINT, signal.default_int_handler)\n"
    trap += "real = builtins.__import__\ndef ends(name, *rest):\n"
    trap += f"    if name != {module!r}: return real(name, *rest)\n"
    trap += f"    try:\n        os.kill(os.getpid(), {int(asked)})\n        time.sleep(20)\n"
    trap += f"    except KeyboardInterrupt: raise {error}\nbuiltins.__import__ = ends\n"
    call = f"{trap}from plan_cutters.command.entry import plan_cutters; plan_cutters()"
    done = subprocess.run([sys.executable, "-c", call, "tools", str(SAMPLES / "shop.toml")], cwd=tmp_path, env=ENV,
                          capture_output=True, text=True, check=False)  # fmt: skip
    assert (done.returncode, done.stderr) == (130, "plan-cutters tools: interrupted; no file is half-written\n")


@pytest.mark.parametrize("words", [("tools", SAMPLES / "shop.toml"), (GROOVE,)])
def test_an_interrupt_that_nobody_can_raise_ends_the_command(tmp_path, words):
    """Within a callback, as that of a lock of an import, Python swallows it."""
    trap = "import builtins, os, signal\nreal = builtins.__import__\n"
    trap += "class Deaf:\n    def __del__(self): os.kill(os.getpid(), signal.SIGINT)\n"
    trap += "def deaf(name, *rest):\n    if name == 'click': Deaf()\n    return real(name, *rest)\nbuiltins.__import__ = deaf\n"
    call = f"{trap}from plan_cutters.command.entry import plan_cutters; plan_cutters()"
    done = subprocess.run(
        [sys.executable, "-c", call, *words], cwd=tmp_path, env=ENV, capture_output=True, text=True, check=False
    )
    name = "plan-cutters tools" if words[0] == "tools" else "plan-cutters"
    assert (done.returncode, done.stderr) == (130, f"{name}: interrupted; no file is half-written\n")


def interrupted_import(*_):
    """What a compiled module does whose import is interrupted: it raises an error of its own."""
    try:
        os.kill(os.getpid(), signal.SIGINT)
        time.sleep(20)
    except KeyboardInterrupt:
        raise ImportError("initialization failed") from None


def ended_from_outside(*_):
    os.kill(os.getpid(), signal.SIGTERM)
    time.sleep(20)


@pytest.mark.parametrize("work", [interrupted_import, ended_from_outside])
@pytest.mark.parametrize(("command", "module", "name", "words"), [
    ("plan-cutters", one_part, "one_part", (*QUICK, "--quiet")),
    ("plan-cutters-map", of_a_point, "_options", ("--at", "0,0,0", "--cutter", "R6L80")),
], ids=["plan", "map"])  # fmt: skip
def test_an_interrupt_that_becomes_another_error_is_still_one(tmp_path, monkeypatch, command, module, name, words, work):
    monkeypatch.setattr(module, name, work)
    done = run(GROOVE, *words, cwd=tmp_path, command=command)
    assert (done.returncode, done.stderr) == (130, f"{command}: interrupted; no file is half-written\n")


def test_what_is_warned_of_the_cache_of_the_compiler_is_one_line(tmp_path, monkeypatch):
    def warned(*_):
        warnings.warn("a warning of another kind", UserWarning, stacklevel=1)
        warnings.warn("kernels/search.nbc: is damaged", CacheWarning, stacklevel=1)
        return 0, ""

    monkeypatch.setattr(one_part, "one_part", warned)
    done = run(GROOVE, *QUICK, "--quiet", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "plan-cutters: kernels/search.nbc: is damaged\n")


@pytest.mark.slow("starts commands and ends them on the way")
def test_an_interrupt_where_none_can_be_raised_is_taken_again():
    code = """
import os, signal, sys, time
from plan_cutters.command.codes import keep_interrupts
from plan_cutters.plan_file.words.cutters import others
from plan_cutters.plan_file.words.text import with_text
keep_interrupts()
class Deaf:
    def __del__(self):
        os.kill(os.getpid(), signal.SIGINT)
        for _ in range(1000): pass
Deaf()
try:
    time.sleep(20)
except KeyboardInterrupt:
    print("heard")
"""
    done = subprocess.run([sys.executable, "-c", code], env=ENV, capture_output=True, text=True, timeout=30, check=False,
                          preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler))  # fmt: skip
    assert (done.stdout, done.stderr) == ("heard\n", "")


@pytest.mark.slow("starts commands and ends them on the way", but=("| true-141-words1",))
@pytest.mark.parametrize("words", [("tools", SAMPLES / "shop.toml"), ("machines",), ("machines", "trunnion-ac")])
@pytest.mark.parametrize(("close", "code"), [("| true", 141), (">/dev/full", 2), (">&-", 2)])
def test_the_other_commands_survive_a_closed_output(tmp_path, words, close, code):
    call = f"from plan_cutters.command.entry import {words[0]}; {words[0]}()"
    line = f"""{sys.executable} -c '{call}' {" ".join(map(str, words[1:]))} {close}; exit ${{PIPESTATUS[0]}}"""
    done = subprocess.run(["bash", "-c", line], cwd=tmp_path, env=ENV, capture_output=True, text=True, check=False)
    assert done.returncode == code
    assert done.stderr.count("\n") == (0 if code == 141 else 1)
    assert "internal error" not in done.stderr
