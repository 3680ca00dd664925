"""`plan-cutters-tools`: tables, JSON, conversion, exit codes; nothing is written where anything is wrong."""

import json
import subprocess
import sys

import pytest

from plan_cutters.library import read_library
from tests.support.forked import run as run_copied
from tests.support.places import ROOT
from tests.support.schemas import valid
from tests.support.tool_files import HOLDER, ID, fusion, write_bit, write_json

CALL = "from plan_cutters.command.entry import tools; tools()"


def run(*words):
    done = run_copied(*words, command="plan-cutters-tools")
    assert "Traceback" not in done.stderr
    return done


def test_a_table_says_what_was_understood_and_what_was_not(tmp_path):
    path = write_json(tmp_path / "a.json", [fusion(number=4), fusion("boring head", number=5), fusion(number=6), HOLDER])
    done = run(path)
    assert done.returncode == 0
    assert done.stderr == ""
    assert "a.json: Fusion JSON, 3 tools listed, 2 used, 1 different" in done.stdout
    assert "holder chuck: R12:15L20+R20L10" in done.stdout
    assert ID in done.stdout
    assert "not a mill that finishes surfaces" in done.stdout


def test_json_has_all_of_it(tmp_path):
    path = write_json(tmp_path / "a.json", [fusion(number=4), fusion("boring head", number=5), fusion(number=6)])
    done = run(path, "--json")
    (library,) = valid("tools", json.loads(done.stdout))["libraries"]
    assert [cutter["numbers"] for cutter in library["cutters"]] == [[4, 6]]
    assert [entry["cutter"] for entry in library["entries"]] == [ID, None, ID]
    assert library["entries"][1]["unused"].startswith('type "boring head"')
    assert library["entries"][0]["given"]["LPR"] == 40


def test_it_loads_neither_the_cad_kernel_nor_the_compiler(tmp_path):
    path = write_json(tmp_path / "a.json", [fusion()])
    told = "print(sorted({'OCP', 'numba'} & set(sys.modules)))"
    code = f"import sys; sys.argv[1:] = [{str(path)!r}]\ntry:\n    {CALL}\nfinally:\n    {told}"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False,
                          env={"PYTHONPATH": f"{ROOT / 'plugin'}:{ROOT}", "PYTHONIOENCODING": "utf-8"})  # fmt: skip
    assert done.stdout.splitlines()[-1] == "[]"


def test_files_are_converted_together(tmp_path):
    one = write_json(tmp_path / "a.json", [fusion(number=1)])
    two = write_json(tmp_path / "b.json", [fusion(number=2, LB=50)])
    assert run(one, two, "--to-toml", tmp_path / "all.toml").returncode == 0
    library = read_library(tmp_path / "all.toml")
    assert list(library) == [*read_library(one), *read_library(two)]
    assert [library.numbers(cutter) for cutter in library] == [(1,), (2,)]


def test_assumptions_and_holders_from_files(tmp_path):
    bit = write_bit(tmp_path / "bit.fctb")
    holder = write_json(tmp_path / "holder.json", [HOLDER])
    done = run(bit)
    assert done.returncode == 2
    assert "--assume-stickout" in done.stderr
    assert "--holder" in done.stderr
    done = run(bit, "--assume-stickout", 40, "--holder", holder, "--json")
    assert done.returncode == 0
    assert valid("tools", json.loads(done.stdout))["libraries"][0]["cutters"][0]["id"] == "R3L40F12S3HR12:15L20+R20L10"


@pytest.mark.parametrize("words", [["none.tools"], ["a.json", "--holder", "R15"], ["a.json", "--assume-stickout", "-3"],
                                   ["a.json", "--assume-stickout", "nan"], [], ["a.json", "--colour"], ["bad.json"]])  # fmt: skip
def test_what_is_wrong_is_one_line_and_writes_nothing(tmp_path, words, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_json(tmp_path / "a.json", [fusion()])
    write_json(tmp_path / "bad.json", [fusion(), fusion(LB=-3)])
    before = sorted(tmp_path.iterdir())
    done = run(*words, *(["--to-toml", "out.toml", "--draw", "drawn"] if words else []))
    assert done.returncode == 2
    assert done.stderr.startswith("plan-cutters-tools: ")
    assert len(done.stderr.splitlines()) == 1
    assert sorted(tmp_path.iterdir()) == before


def test_one_wrong_file_among_others_keeps_all_from_being_written(tmp_path):
    good = write_json(tmp_path / "a.json", [fusion()])
    bad = write_json(tmp_path / "bad.json", [fusion(), fusion(LB=-3)])
    done = run(good, bad, "--to-toml", tmp_path / "out.toml")
    assert done.returncode == 2
    assert ID in done.stdout
    assert not (tmp_path / "out.toml").exists()
    done = run(good, bad, "--to-toml", tmp_path / "out.toml", "--skip-bad")
    assert done.returncode == 0
    assert "broken: LB is -3" in done.stdout
    assert (tmp_path / "out.toml").exists()


def test_a_place_that_cannot_be_written_to(tmp_path):
    path = write_json(tmp_path / "a.json", [fusion()])
    done = run(path, "--to-toml", tmp_path / "no" / "out.toml")
    assert done.returncode == 2
    assert "cannot be written" in done.stderr


def test_each_assembly_is_drawn(tmp_path):
    path = write_json(tmp_path / "a.json", [fusion(number=4, name="a/b: 6 mm"), fusion(number=4, name="a/b: 6 mm", LB=50)])
    assert run(path, "--draw", tmp_path / "drawn").returncode == 0
    names = sorted(each.name for each in (tmp_path / "drawn").iterdir())
    assert names == ["T4_a_b_6_mm.svg", "T4_a_b_6_mm_2.svg"]
    assert all("<svg" in (tmp_path / "drawn" / name).read_text(encoding="utf-8") for name in names)


def test_a_narrow_terminal_shows_lines_in_place_of_a_table(tmp_path, monkeypatch):
    import io
    import sys

    from plan_cutters.command import tools
    from plan_cutters.command.terminal import paper
    from plan_cutters.library.read import listing

    class Terminal(io.StringIO):
        def isatty(self):
            return True

    path = write_json(tmp_path / "a.json", [fusion(number=7), fusion("drill")])
    shown = {}
    for columns in (80, 200):
        monkeypatch.setenv("COLUMNS", str(columns))
        monkeypatch.setattr(sys, "stdout", Terminal())
        with paper(200) as console:
            tools._table(listing(path), console)
        shown[columns] = sys.stdout.getvalue()
    assert "Stick-out" in shown[200]
    assert 'T7 "a tool" flat end mill' in shown[80]
    assert "DC 6, RE 0, LCF 12, Stick-out 40, Shank 8, Holder chuck (mm in the file)" in " ".join(shown[80].split())
    assert max(map(len, shown[80].splitlines())) <= 80
    assert len(shown[80].splitlines()) <= 12
