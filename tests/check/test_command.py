"""`--check-operations`: exit codes, plans of another part or of other options, files that are broken."""

import json
from pathlib import Path

import pytest

from plan_cutters import Options
from plan_cutters.errors import OptionError
from plan_cutters_check.asking import question_of
from tests.support.forked import run
from tests.support.written_plan import FILES, PART, TYPED, WORDS


@pytest.fixture
def copied(folder, tmp_path):
    for name in ("plan.json", *FILES):
        (tmp_path / name).write_bytes((folder / name).read_bytes())
    return tmp_path


def checked(folder: Path):
    return run(PART, *TYPED, "--check-operations", str(folder / "plan.json"), cwd=folder)


@pytest.mark.slow("checks a plan many times")
def test_a_plan_that_holds_ends_with_0(copied):
    done = checked(copied)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "FAILS" not in done.stdout
    assert "plans.operations.proved_share" in " ".join(done.stdout.split())


@pytest.mark.slow("checks a plan many times")
def test_a_forged_plan_ends_with_1(copied):
    document = json.loads((copied / "plan.json").read_text())
    document["operations"]["plans"][0]["operations"][0]["angles_deg"] = {"C": 0.0, "B": 45.0}
    (copied / "plan.json").write_text(json.dumps(document))
    done = checked(copied)
    assert done.returncode == 1
    assert "FAILS" in done.stdout


def test_arrays_of_another_plan_end_with_1(copied):
    document = json.loads((copied / "plan.json").read_text())
    document["files"]["npz"]["sha256"] = "0" * 64
    (copied / "plan.json").write_text(json.dumps(document))
    done = checked(copied)
    assert done.returncode == 1
    assert "samples.npz is not the file that plan.json names" in " ".join(done.stdout.split())


def test_a_plan_without_operations_is_refused_by_its_name(copied):
    """Its folder has no arrays of them: that is no missing file."""
    document = json.loads((copied / "plan.json").read_text())
    (copied / "plan.json").write_text(json.dumps({**document, "operations": None}))
    (copied / "operations.npz").unlink()
    done = checked(copied)
    assert done.returncode == 2
    assert done.stderr.strip().splitlines()[-1].endswith("plan.json: the plan has no operations: make it with --operations")


@pytest.mark.parametrize("name", FILES)
def test_files_that_are_not_there_or_broken_end_with_2(copied, name):
    (copied / name).write_bytes(b"no archive")
    broken = checked(copied)
    assert broken.returncode == 2
    assert broken.stderr.strip().splitlines()[-1].startswith(f"plan-cutters: {name}")
    (copied / name).unlink()
    gone = checked(copied)
    assert gone.returncode == 2
    assert f"{name} must be in its folder" in gone.stderr


@pytest.mark.parametrize(
    ("place", "value", "words"),
    [(("part", "sha256"), "0" * 64, r"does not fit: part"), (("effective", "cutters"), ["R1L9"], "R1L9"),
     (("effective", "machine"), "3+2", r"3\+2"), (("effective", "tolerance_mm"), 5.0, "tolerance"),
     (("effective", "tilt_deg"), [0.0, 180.0], "tilts"), (("effective", "setup"), [0.0, 1.0, 0.0], "setups")],
)  # fmt: skip
def test_a_plan_of_another_part_or_other_options_is_refused(written, place, value, words):
    document, arrays = written.copies()
    document[place[0]][place[1]] = value
    with pytest.raises(OptionError, match=words):
        question_of(written.part, Options(**WORDS), document, arrays)


def test_a_plan_without_operations_is_refused(written):
    document, arrays = written.copies()
    document["operations"] = None
    with pytest.raises(OptionError, match="no operations"):
        question_of(written.part, Options(**WORDS), document, arrays)
