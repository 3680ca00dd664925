"""A written plan of operations is checked: a sound one holds, each kind of forgery is found, strangers are refused."""

import copy
import json

import numpy as np
import pytest

from plan_cutters import Options, plan
from plan_cutters.errors import OptionError
from plan_cutters.operations.check import check_operations
from plan_cutters.pipeline import prepare
from tests.support.forked import run
from tests.support.places import ROOT

WORDS = {"cutters": "R6L80", "faces": "all", "grid": 7, "machine": "trunnion-ac", "area_budget": 0}
POCKET = "samples/pocket_top.step"


@pytest.fixture(scope="module")
def ready():
    return prepare(POCKET, Options(**WORDS))


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    out = tmp_path_factory.mktemp("operations")
    plan(POCKET, operations="fewest", **WORDS).write(out, ["json"])
    return out


@pytest.fixture
def written(folder):
    with np.load(folder / "operations.npz") as archive:
        return json.loads((folder / "plan.json").read_text()), {name: archive[name].copy() for name in archive.files}


def holds(ready, document, arrays):
    return all(each.holds for each in check_operations(ready, document, arrays))


def test_what_is_written_holds(ready, written):
    assert holds(ready, *written)


def test_a_sample_given_to_an_operation_that_does_not_serve_it_is_found(ready, written):
    document, arrays = written
    label, normal = arrays["operation"], ready.samples.normal
    axes = np.array([each["axis"] for each in document["operations"]["plans"][0]["operations"]])
    away = np.flatnonzero((normal @ axes.T).min(axis=1) < -0.1)
    label[away] = (normal[away] @ axes.T).argmin(axis=1)
    assert not holds(ready, document, arrays)


def test_a_turned_axis_is_found(ready, written):
    document, arrays = written
    one = document["operations"]["plans"][0]["operations"][0]["angles_deg"]
    for name in one:
        one[name] += 70.0
    assert not holds(ready, document, arrays)


@pytest.mark.parametrize("forged", ["beyond", "below"])
def test_samples_given_to_operations_that_there_are_not_are_found(ready, written, forged):
    document, arrays = written
    label = arrays["operation"]
    label[:5] = len(document["operations"]["plans"][0]["operations"]) if forged == "beyond" else -2
    document["operations"]["plans"][0]["rest"]["samples"] += 5 * (forged == "below")
    assert not holds(ready, document, arrays)


@pytest.mark.parametrize(
    ("word", "value"),
    [("axis", [0.0, 0.6, 0.8]), ("axis", [float("nan")] * 3), ("setup", -1), ("setup", 1), ("samples", 1),
     ("other_angles_deg", {"C": 1.0, "A": 1.0})],
)  # fmt: skip
def test_an_operation_that_contradicts_itself_is_found(ready, written, word, value):
    document, arrays = written
    document["operations"]["plans"][0]["operations"][0][word] = value
    assert not holds(ready, document, arrays)


def test_fewer_than_there_are_is_found(ready, written):
    document, arrays = written
    few = document["operations"]["fewest"]
    few["found"] = few["at_least"] = few["found"] - 1
    assert not holds(ready, document, arrays)


def test_samples_of_simultaneous_motion_are_said_not_to_be_put_down(ready, written):
    document, arrays = written
    one = document["operations"]["plans"][0]["operations"][0]
    one["mode"] = "simultaneous"
    said = " ".join(each.words for each in check_operations(ready, document, arrays))
    assert f"{one['samples']} of simultaneous motion were not put down" in said


def test_samples_that_are_dropped_are_found(ready, written):
    document, arrays = written
    arrays["operation"][:5] = -1
    assert not holds(ready, document, arrays)


def test_an_operation_that_is_left_out_is_found(ready, written):
    document, arrays = written
    document["operations"]["plans"][0]["operations"].pop()
    found = check_operations(ready, document, arrays)
    assert not all(each.holds for each in found)
    assert "leaves" in found[-1].words


def test_regions_that_are_not_the_samples_are_found(ready, written):
    document, arrays = written
    region = document["operations"]["plans"][0]["operations"][0]["regions"][0]
    region["rows"][0][1] += 1
    assert not holds(ready, document, arrays)


@pytest.mark.parametrize("forged", ["doubled", "more", "negative", "beyond", "huge"])
def test_weights_that_prove_too_much_are_found(ready, written, forged):
    document, arrays = written
    few = document["operations"]["fewest"]
    row = few["weights"][0][0]
    if forged == "doubled":
        few["weights"] *= 2
    if forged == "more":
        few["weights"] = [[each, 1_000_000] for each in range(0, len(ready.samples), 3)]
    few["weights"] += {"negative": [[row, -5]], "beyond": [[10**7, 5]], "huge": [[row, 2**62]] * 3}.get(forged, [])
    if forged in ("doubled", "more"):
        few["at_least"] = few["found"] = 2 * few["found"]
    assert not holds(ready, document, arrays)


def test_weight_on_samples_that_nothing_serves_proves_nothing(ready, written):
    document, arrays = written
    document["operations"]["fewest"]["weights"].append([0, 1_000_000])
    kept = ready.samples.normal[0] @ arrays["candidate_axis"].T < -0.05
    for name in ("candidate_cutter", "candidate_setup", "candidate_angle", "candidate_axis"):
        arrays[name] = arrays[name][kept]
    assert not holds(ready, document, arrays)


@pytest.mark.parametrize(
    ("place", "value", "said"),
    [(("part", "sha256"), "0" * 64, r"does not fit: part"), (("effective", "cutters"), ["R1L9"], "R1L9"),
     (("effective", "machine"), "3+2", r"3\+2"), (("samples", "count"), 3, "number of samples")],
)  # fmt: skip
def test_a_plan_of_another_part_or_other_options_is_refused(ready, written, place, value, said):
    document = copy.deepcopy(written[0])
    document[place[0]][place[1]] = value
    with pytest.raises(OptionError, match=said):
        check_operations(ready, document, written[1])


def test_the_command_ends_with_0_1_or_2(folder, tmp_path):
    words = [str(ROOT / POCKET), "--cutter", "R6L80", "--faces", "all", "--grid", "7", "--machine", "trunnion-ac"]
    done = run(*words, "--check-operations", str(folder / "plan.json"), cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("holds:") == 3
    document = json.loads((folder / "plan.json").read_text())
    document["operations"]["plans"][0]["operations"][0]["angles_deg"] = {"C": 0.0, "A": 45.0}
    (tmp_path / "plan.json").write_text(json.dumps(document))
    alone = run(*words, "--check-operations", str(tmp_path / "plan.json"), cwd=tmp_path)
    assert alone.returncode == 2
    assert "operations.npz must stand beside it" in alone.stderr
    (tmp_path / "operations.npz").write_bytes((folder / "operations.npz").read_bytes())
    forged = run(*words, "--check-operations", str(tmp_path / "plan.json"), cwd=tmp_path)
    assert forged.returncode == 1
    assert "FAILS" in forged.stdout
    (tmp_path / "operations.npz").write_bytes(b"no archive")
    broken = run(*words, "--check-operations", str(tmp_path / "plan.json"), cwd=tmp_path)
    assert broken.returncode == 2
    assert broken.stderr.strip().splitlines()[-1].startswith("plan-cutters: operations.npz")
