"""What a command says to its first words: help that fits, names that are nearly right, and a part that comes through a pipe."""

import json
import re
import subprocess
import sys

import pytest

from plan_cutters import plan
from plan_cutters.command import entry
from plan_cutters.command.cli import spooled
from plan_cutters.command.option_groups import MOST_LINES, Grouped
from plan_cutters.errors import OptionError, PlanError
from tests.support.forked import ENV, run
from tests.support.places import ROOT, SAMPLES

GROOVE = SAMPLES / "v_groove.step"
QUICK = ("--cutter", "R3L40", "--grid", "3", "--area-budget", "0", "--formats", "json")


def piped(*words, data, cwd):
    """A command with bytes on its standard input, in a process that begins with nothing imported."""
    line = [sys.executable, "-m", "plan_cutters", *map(str, words)]
    return subprocess.run(line, input=data, cwd=cwd, env=ENV, capture_output=True, check=False)


# ---- help


@pytest.mark.parametrize("name", entry.commands())
def test_help_is_a_look_and_help_all_has_every_option(tmp_path, name):
    short, whole = (run(name, word, cwd=tmp_path, bare=True).stdout for word in ("--help", "--help-all"))
    assert len(short.splitlines()) <= MOST_LINES
    for param in entry.module_of(f"plan-cutters {name}").command.params:
        if isinstance(param, Grouped):
            assert re.search(rf"^ .*{max(param.opts, key=len)}\b", whole, re.MULTILINE), param.name
    listed = set(re.findall(r"(?<!\w)--[a-z][a-z-]+", short))
    assert listed <= set(re.findall(r"(?<!\w)--[a-z][a-z-]+", whole)) | {"--help-all"}
    if short != whole:
        assert "--help-all has all options" in short


def test_the_name_alone_prints_the_short_help(tmp_path):
    done = run(cwd=tmp_path, bare=True)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("Usage: plan-cutters ")
    assert len(done.stderr.splitlines()) <= MOST_LINES


# ---- names that are nearly right


@pytest.mark.parametrize(("word", "meant"), [("plna", "plan"), ("bacth", "batch"), ("tolls", "tools")])
def test_a_mistyped_command_plans_nothing(tmp_path, word, meant):
    """The other words would be planned for a minute, with cutters that nobody named."""
    done = run(word, GROOVE, cwd=tmp_path, bare=True)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == f"plan-cutters: {word} is neither a command nor a file; did you mean {meant}?\n"
    assert list(tmp_path.iterdir()) == []


def test_a_part_whose_name_is_like_a_command_is_planned(tmp_path):
    (tmp_path / "plna").write_bytes(GROOVE.read_bytes())
    done = run("plna", *QUICK, "--quiet", cwd=tmp_path)
    assert done.returncode in (0, 1, 4)
    assert (tmp_path / "plna-plan" / "plan.json").is_file()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"machine": "trunion-ac"}, "did you mean trunnion-ac?"),
        ({"machine": "Trunnion-AC"}, "did you mean trunnion-ac?"),
        ({"machine": "xyz"}, "is not known: give unlimited"),
        ({"progres": print}, "no option is called progres; did you mean progress?"),
        ({"gird": 3}, "no option is called gird; did you mean grid?"),
        ({"cutters": []}, "cutters: the list is empty"),
        ({"cutters": ()}, "cutters: the list is empty"),
    ],
)
def test_names_that_are_nearly_right_have_a_suggestion(options, words):
    with pytest.raises(PlanError, match=re.escape(words)):
        plan(GROOVE, **options)


def test_no_cutters_is_refused_by_name_and_none_is_the_built_in_set():
    from plan_cutters.options import Options

    with pytest.raises(OptionError, match="leave it out for the built-in cutters"):
        Options.of({"cutters": []})
    assert len(Options.of({"cutters": None}).judged) == len(Options.of({}).judged) > 10


# ---- a pipe


def test_a_part_comes_through_a_pipe(tmp_path):
    data = GROOVE.read_bytes()
    done = run("-", *QUICK, "-o", "out", "--quiet", data=data, cwd=tmp_path)
    assert done.returncode in (0, 1, 4), done.stderr
    assert done.stderr == ""
    made = json.loads((tmp_path / "out/plan.json").read_text())
    done = run(GROOVE, *QUICK, "-o", "file", "--quiet", cwd=tmp_path)
    file = json.loads((tmp_path / "file/plan.json").read_text())
    assert made["part"]["file"] == "stdin.step"
    assert made["part"]["sha256"] == file["part"]["sha256"]
    assert made["cutters"] == file["cutters"]


def test_a_plan_goes_from_a_pipe_to_a_pipe(tmp_path):
    """The second `-` is that of standard output."""
    done = run("-", *QUICK[:-2], "--json", "-", "--quiet", data=GROOVE.read_bytes(), cwd=tmp_path)
    assert json.loads(done.stdout)["part"]["file"] == "stdin.step"
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("words", "data", "code", "words_said"),
    [
        (("-",), b"", 3, "-: is empty"),
        (("-",), b"no CAD file at all", 3, "-: is not a CAD file"),
        (("-",), b"\x1f\x8b" + bytes(50), 3, "is compressed (gzip)"),
        (("-", "-"), b"x", 2, "-: standard input is one part"),
        (("batch", "-", "-o", "out"), b"\n# nothing\n", 2, "-: no part is listed"),
        (("batch", "-", "-o", "out"), b"\xff\xfe\x00", 2, "-: a list of parts is text in UTF-8"),
    ],
)
def test_what_comes_through_a_pipe_and_is_no_part_is_one_line(tmp_path, words, data, code, words_said):
    done = (piped if "batch" in words else run)(*words, data=data, cwd=tmp_path)
    assert done.returncode == code
    said = done.stderr if isinstance(done.stderr, str) else done.stderr.decode()
    (line,) = [each for each in said.splitlines() if " s  " not in each]
    assert words_said in line
    assert "/tmp/" not in line


def test_a_list_of_parts_comes_through_a_pipe(tmp_path):
    done = piped(
        "batch",
        "-",
        "-o",
        "out",
        "--dry-run",
        data=f"# parts\n{GROOVE}\n\n{SAMPLES / 'pocket_top.step'}\n".encode(),
        cwd=tmp_path,
    )
    assert done.returncode == 0, done.stderr
    told = (done.stdout + done.stderr).decode()
    assert "v_groove" in told
    assert "pocket_top" in told


@pytest.mark.parametrize("option", ["--json", "--junit", "-o"])
def test_behind_an_option_with_a_value_the_word_is_that_value(option):
    words = ["part.step", option, "-", "--quiet"]
    with spooled(entry.module_of("plan-cutters").command, words) as named:
        assert named == words


@pytest.mark.slow("starts a process for each", only=("none", "nonsense"))
@pytest.mark.parametrize(("rule", "code"), [("none", 0), ("late", 0), ("unreadable", 3), ("nonsense", 2)])
def test_a_batch_of_nothing_but_faults_ends_as_it_is_told(tmp_path, rule, code):
    done = piped("batch", "none.step", "-o", "out", "--fail-on", rule, data=b"", cwd=tmp_path)
    assert done.returncode == code
    assert (b"--fail-on takes" in done.stderr) == (rule == "nonsense")


def test_docs_show_all_options():
    """The pages take the whole help, not the look."""
    assert "--help-all" in (ROOT / "docs/hooks/inserts.py").read_text()
