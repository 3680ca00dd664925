"""One command with subcommands: what the first word means, the three old names, what shells are offered."""

import re
import subprocess
import sys

import click
import pytest

from plan_cutters.command import entry
from plan_cutters_base.workers import child
from plan_cutters_base.workers.child import VARIABLE
from tests.support.forked import ENV, run
from tests.support.places import ROOT

GROOVE = str(ROOT / "samples/v_groove.step")
QUICK = ("--cutter", "R6L80", "--grid", "5", "--area-budget", "0", "--formats", "json")


@pytest.mark.slow("runs whole commands", but=("tools-words1-2",))
@pytest.mark.parametrize(
    ("subcommand", "words", "code"),
    [
        ("tools", ["--list-holders"], 0),
        ("tools", [], 2),
        ("tools", ["none.tools"], 2),
        ("machines", ["trunnion-ac", "--json"], 0),
        ("machines", ["none"], 2),
        ("map", [GROOVE, "--at", "0,0", "--cutter", "R8L90"], 2),
        ("map", ["none.step", "--at", "0,0,0", "--cutter", "R8L90"], 3),
    ],
)
def test_the_old_names_are_aliases(tmp_path, subcommand, words, code):
    new = run(subcommand, *words, cwd=tmp_path)
    old = run(*words, cwd=tmp_path, command=f"plan-cutters-{subcommand}")
    assert (new.returncode, new.stdout) == (old.returncode, old.stdout) == (code, old.stdout)
    assert bool(new.stdout) == (code == 0)
    assert old.stderr == new.stderr.replace(f"plan-cutters {subcommand}:", f"plan-cutters-{subcommand}:")
    assert code == 0 or new.stderr.startswith(f"plan-cutters {subcommand}: ")


def test_a_first_word_that_is_no_subcommand_is_a_part(tmp_path):
    """And one that is: a file of its name is said with its folder, or after `plan`."""
    for name in entry.commands():
        (tmp_path / name).write_text("no part")
    for words in (["./map"], ["plan", "map"], ["plan", "plan"], ["part.step", "map"]):
        done = run(*words, cwd=tmp_path)
        assert done.returncode == 3
        assert "no part" not in done.stderr
        assert all(word in done.stderr for word in ("plan-cutters: ", "part.step" if words[0] == "part.step" else words[-1]))
    done = run("map", "--grid", "5", cwd=tmp_path)
    assert done.returncode == 2
    assert done.stderr.startswith("plan-cutters map: ")
    assert done.stderr.endswith("for the file, write ./map\n")
    assert "did you mean machines?" in run("machine", cwd=tmp_path).stderr


def test_plan_is_the_main_job(tmp_path):
    for words in ([], ["plan"]):
        done = run(*words, GROOVE, *QUICK, "-o", f"out{len(words)}", "--quiet", cwd=tmp_path)
        assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
        assert (tmp_path / f"out{len(words)}" / "plan.json").is_file()


@pytest.mark.parametrize("name", entry.commands())
def test_the_help_of_each_says_its_exit_codes_and_loads_no_kernel(tmp_path, name):
    done = run(name, "--help-all", cwd=tmp_path, bare=True)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith(f"Usage: plan-cutters {name} ")
    codes = done.stdout.partition("\nExit codes:\n")[2]
    assert set(re.findall(r"^  (\d+) ", codes, re.MULTILINE)) >= {"0", "2", "130"}
    assert max(map(len, done.stdout.splitlines())) <= 80
    assert run(name, "--version", cwd=tmp_path, bare=True).stdout == run("--version", cwd=tmp_path, bare=True).stdout


def test_each_help_begins_with_an_imperative():
    """As docstrings do: no sentence is a question in disguise."""
    verbs = {"Find", "Draw", "Judge", "List", "Show", "Serve", "Plan"}
    for name, told in entry.sentences():
        command = entry.module_of(f"plan-cutters {name}").command
        for text in (told, command.help):
            first = " ".join(text.split()).partition(". ")[0]
            assert first.split()[0] in verbs
            assert "?" not in first
            assert not re.search(r"\bwhat\b", first, re.IGNORECASE)


@pytest.mark.parametrize("name", ["map", "batch", "diff", "changed", "tools", "machines", "mcp"])
def test_help_loads_neither_numpy_nor_the_kernel(tmp_path, name):
    code = f"import sys; sys.argv = ['x', {name!r}, '--help']\nfrom plan_cutters.command.entry import plan_cutters\n"
    code += "try: plan_cutters()\nexcept SystemExit: pass\n"
    code += "assert not {'OCP', 'numba', 'scipy', 'numpy', 'pydantic'} & set(sys.modules), sorted(sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, env=ENV, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")


def test_one_help_names_all_subcommands(tmp_path):
    said = run("--help", cwd=tmp_path, bare=True).stdout
    listed = said.partition("\nCommands:\n")[2].partition("\n\n")[0]
    assert re.findall(r"^  (\w+) ", listed, re.MULTILINE) == list(entry.commands())
    told = (ROOT / "docs/command.md").read_text()
    for name in entry.commands():
        assert isinstance(entry.module_of(f"plan-cutters {name}").command, click.Command)
        assert f"<!-- help: plan-cutters{'' if name == 'plan' else f' {name}'} -->" in told


@pytest.mark.parametrize(
    ("words", "offered"),
    [
        (["m"], ["plain,map", "plain,machines", "plain,mcp"]),
        ([""], [f"plain,{name}" for name in entry.commands()]),
        (["blade"], ["file,"]),
        (["blade.step", "m"], ["file,"]),
        (["--map"], ["plain,--map-budget"]),
        (["--cutter", "R6L80", "--map"], ["plain,--map-budget"]),
        (["plan", "--map"], ["plain,--map-budget"]),
        (["map", "--wi"], ["plain,--within"]),
        (["map", "--machine", "trunnion-a"], ["plain,trunnion-ac"]),
        (["tools", "--list"], ["plain,--list-holders"]),
        (["machines", "trunnion-a"], ["plain,trunnion-ac"]),
    ],
)
def test_a_shell_is_offered_subcommands_and_what_they_take(tmp_path, words, offered):
    asked = {"_PLAN_CUTTERS_COMPLETE": "zsh_complete", "COMP_WORDS": " ".join(["plan-cutters", *words[:-1], f'"{words[-1]}"']),
             "COMP_CWORD": str(len(words))}  # fmt: skip
    done = run(cwd=tmp_path, environment=ENV | asked, bare=True)
    lines = done.stdout.splitlines()
    assert [f"{kind},{value.strip()}" for kind, value in zip(lines[::3], lines[1::3], strict=True)] == offered


@pytest.mark.parametrize(
    ("words", "begun"),
    [
        ([GROOVE], [GROOVE]),
        (["plan", GROOVE], [GROOVE]),
        (["plan", GROOVE, "--help"], None),
        (["map", GROOVE], None),
        (["tools", GROOVE], None),
        (["machines", GROOVE], None),
    ],
)
def test_only_a_plan_begins_early(monkeypatch, words, begun):
    made = []

    class Made:
        drop = None

    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.setattr(child, "_early", [])
    monkeypatch.setattr(child.atexit, "register", lambda call: None)
    monkeypatch.setattr(child, "Worker", lambda words, name, *, waits: made.append((words, name, waits)) or Made)
    monkeypatch.setattr(entry, "module_of", lambda name: type("Module", (), {"main": lambda words, name: None}))
    monkeypatch.setattr(sys, "argv", ["plan-cutters", *words])
    entry.plan_cutters()
    assert made == ([(begun, "plan-cutters", True)] if begun else [])
