"""The command, by what a user sees: its files, its codes and its lines."""

import json
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("typer")
from typer.testing import CliRunner

from conformance.__main__ import app, main, write_aside
from conformance.score import write_answers
from conformance.suite import Suite


def call(*words: object) -> tuple[int, str, str]:
    """Return the code, and what was printed."""
    result = CliRunner().invoke(app, [str(word) for word in words], env={"COLUMNS": "160"})
    assert result.exception is None or isinstance(result.exception, SystemExit), result.exception
    return result.exit_code, result.stdout, result.stderr


@pytest.mark.parametrize(("words", "text"), [
    (("run", "--program", "nix"), "no program is called 'nix'"),
    (("run", "--program", "undecided", "--json", "."), "is a folder; give the name of a file"),
    (("check", "sloot"), "did you mean slot"),
    (("run", "--program", "undecided", "--part", "nix"), "no part is called 'nix'"),
    (("run", "--program", "undecided", "--kind", "nix"), "choose made or real"),
    (("run", "--program", "undecided", "--tolerance", "-1"), "between 0 and 10 mm"),
    (("run", "--program", "undecided", "--answers", "a.txt"), "give a .csv or a .parquet"),
    (("run", "--program", "undecided", "--each", "0"), "give at least 1"),
    (("score", "nowhere.csv"), "nowhere.csv: no such file"),
    (("check", "nix"), "no made part is called 'nix'"),
])  # fmt: skip
def test_what_cannot_be_done_is_one_line(small_folder: Path, words: tuple[str, ...], text: str):
    more = () if words[0] == "check" else ("--data", small_folder)
    code, _, err = call(*words, *more)
    assert code == 2
    assert text in err
    assert err.count("\n") == 1


def test_a_place_that_nothing_can_be_written_to_is_one_line(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]):
    monkeypatch.setattr("sys.argv", ["conformance", "export", "/proc/x"])
    with pytest.raises(SystemExit) as ended:
        main()
    assert (ended.value.code, capsys.readouterr().err) == (2, "/proc/x: No such file or directory\n")


def test_a_suite_that_is_not_there_is_one_line(tmp_path: Path):
    code, _, err = call("run", "--program", "undecided", "--data", tmp_path)
    assert code == 2
    assert err.startswith("the suite cannot be read")
    assert err.count("\n") == 1


def test_help_names_every_command():
    code, out, _ = call("--help")
    assert code == 0
    for word in ("run", "score", "export", "check", "generate", "programs", "table"):
        assert f" {word} " in out


def test_programs_lists_each_with_what_it_needs():
    code, out, _ = call("programs")
    assert code == 0
    assert all(name in out for name in ("plan-cutters", "fcl", "embree", "trimesh", "opencamlib", "naive", "undecided"))


def test_a_run_writes_what_its_issue_asks_for(small_folder: Path, tmp_path: Path):
    path, answers = tmp_path / "new" / "undecided.json", tmp_path / "answers.parquet"
    code, out, _ = call("run", "--program", "undecided", "--all", "--data", small_folder, "--json", path, "--answers", answers)
    assert code == 0
    document = json.loads(path.read_text())
    assert {"parts", "postures", "false_safe", "false_blocked", "undecided", "seconds", "border", "right", "worst_mm",
            "families", "settings",
            "versions", "memory_mb"} <= set(document)  # fmt: skip
    assert (document["parts"], document["postures"], document["score"], document["right"]) == (1, 72, 0.0, 0)
    assert document["undecided"] + document["border"] == 72
    assert "it never decides" in out
    assert call("score", answers, "--data", small_folder)[0] == 0
    assert sorted(p.name for p in tmp_path.rglob("*")) == ["answers.parquet", "new", "undecided.json"]


def test_a_run_without_all_takes_a_few_of_each_part(small_folder: Path, tmp_path: Path):
    assert call("run", "--program", "undecided", "--each", 5, "--data", small_folder, "--json", tmp_path / "r.json")[0] == 0
    document = json.loads((tmp_path / "r.json").read_text())
    assert (document["postures"], document["all"]) == (5, False)


def test_a_title_says_that_a_score_is_of_a_part(small: Suite, small_folder: Path, tmp_path: Path):
    write_answers(tmp_path / "one.csv", np.array([0]), small.postures.verdict[:1])
    code, out, _ = call("score", tmp_path / "one.csv", "--only-answered", "--data", small_folder)
    assert code == 0
    assert "1 of 72 answered" in " ".join(out.split())


def test_a_perfect_file_scores_all_and_what_is_missing_counts_as_undecided(small: Suite, small_folder: Path, tmp_path: Path):
    rows = np.arange(len(small.postures))
    write_answers(tmp_path / "all.csv", rows, small.postures.verdict)
    write_answers(tmp_path / "half.csv", rows[::2], small.postures.verdict[::2])
    made = {}
    for name, more in (("all", ()), ("half", ()), ("only", ("--only-answered",))):
        file = tmp_path / f"{'half' if name == 'only' else name}.csv"
        code, out, err = call("score", file, "--data", small_folder, "--json", tmp_path / f"{name}.json", *more)
        assert code == 0
        assert ("36 of 72 answered" in " ".join(out.split())) == (name == "only")
        assert ("36 of 72 postures are not answered" in err) == (name == "half")
        made[name] = json.loads((tmp_path / f"{name}.json").read_text())
    assert (made["all"]["score"], made["only"]["score"]) == (1.0, 1.0)
    assert 0.2 < made["half"]["score"] < 0.8
    assert made["half"]["postures"] == 72
    assert made["only"]["postures"] == 36


def test_export_writes_table_and_schemas(small_folder: Path, tmp_path: Path):
    assert call("export", tmp_path / "out", "--data", small_folder)[0] == 0
    assert sorted(p.name for p in (tmp_path / "out").iterdir()) == ["made.csv", "parts.schema.json", "postures.schema.json"]


def test_the_page_of_results_has_each_program(small_folder: Path, tmp_path: Path):
    for name in ("undecided", "naive"):
        pytest.importorskip("OCP")
        assert call("run", "--program", name, "--each", 6, "--data", small_folder, "--json", tmp_path / f"{name}.json")[0] == 0
    assert call("table", tmp_path / "results.md", "--results", tmp_path)[0] == 0
    text = (tmp_path / "results.md").read_text()
    assert text.index("\n| naive ") < text.index("\n| undecided ")
    assert "pitch_mm 1.0" in text
    empty = tmp_path / "empty"
    empty.mkdir()
    assert call("table", tmp_path / "results.md", "--results", empty)[0] == 2


def test_what_is_interrupted_leaves_the_former_file(tmp_path: Path):
    path = tmp_path / "r.json"
    path.write_text("former")

    def stop(aside: Path) -> None:
        aside.write_text("half")
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_aside(path, stop)
    assert path.read_text() == "former"
    assert list(tmp_path.iterdir()) == [path]
