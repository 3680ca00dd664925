"""Every entry of a plan of operations, forged: the checker finds it, or lists that entry as unchecked."""

import copy
import json
from collections import defaultdict

import numpy as np
import pytest

from plan_cutters.plan_file.model import Plan
from plan_cutters.plan_file.operations import OperationsEntry
from plan_cutters_check.check import check
from plan_cutters_check.findings import leaves, pattern
from tests.support.forging import forged, put
from tests.support.unchecked import UNCHECKED, listed

#: Entries for which the checker puts many tools down, without which they are unchecked.
_SLOW = ("plans[].operations[].clearance_mm",)
#: Entries of one kind that are forged, each in turn.
_OF_A_KIND = [1, pytest.param(4, marks=pytest.mark.slow("forges four entries of each kind"))]


def schema_patterns(schema, part, path=""):
    """The leaves that plan.json may have by its schema, with null and empty ones."""
    if "$ref" in part:
        return schema_patterns(schema, schema["$defs"][part["$ref"].rpartition("/")[2]], path)
    if "anyOf" in part:
        return {leaf for each in part["anyOf"] for leaf in schema_patterns(schema, each, path)}
    if "properties" in part:
        return {
            leaf
            for name, each in part["properties"].items()
            for leaf in schema_patterns(schema, each, f"{path}.{name}" if path else name)
        }
    if isinstance(part.get("additionalProperties"), dict):
        return schema_patterns(schema, part["additionalProperties"], f"{path}.*")
    if part.get("type") == "array":
        below = part.get("items") or part["prefixItems"][0]
        return schema_patterns(schema, below, f"{path}[]")
    return set() if part.get("type") == "null" else {path}


def nulls(schema, part, path=""):
    """The entries that may be null."""
    if "$ref" in part:
        return nulls(schema, schema["$defs"][part["$ref"].rpartition("/")[2]], path)
    found = {path} if any(each.get("type") == "null" for each in part.get("anyOf", [])) else set()
    for each in part.get("anyOf", []):
        found |= nulls(schema, each, path)
    for name, each in part.get("properties", {}).items():
        found |= nulls(schema, each, f"{path}.{name}" if path else name)
    if isinstance(part.get("additionalProperties"), dict):
        found |= nulls(schema, part["additionalProperties"], f"{path}.*")
    if part.get("type") == "array" and isinstance(part.get("items"), dict):
        found |= nulls(schema, part["items"], f"{path}[]")
    return found


def found(written, document=None, arrays=None, seconds=1e6):
    return check(written.question(document, arrays), seconds=seconds)


def named(answer, path):
    """Whether an entry, or what holds it, is named as not checked."""
    return any(path == each or path.startswith((f"{each}.", f"{each}[")) for each in answer.entries.unchecked)


def unchecked(kind):
    """Whether an entry of operations may be unchecked."""
    return listed(f"operations.{kind}")


@pytest.mark.slow("checks a plan many times")
def test_what_is_written_holds(written):
    answer = found(written)
    assert answer.holds, "\n".join(answer.lines)
    assert not answer.entries.differ
    assert all(each.holds for each in answer.findings)
    assert any(path.startswith("operations.") and "clearance_mm" in path for path in answer.entries.agree)


def test_no_entry_of_the_schema_is_forgotten(written):
    answer = found(written, seconds=0.0)
    assert not answer.entries.differ
    # What is neither checked in this plan nor listed as unchecked would be an entry that nobody looks at.
    schema = OperationsEntry.model_json_schema()
    checked, every = {pattern(path) for path in answer.entries.agree}, schema_patterns(schema, schema)
    assert not sorted(each for each in every if f"operations.{each}" not in checked and not unchecked(each))
    # Nor does the list name entries that there are not.
    whole = Plan.model_json_schema()
    there = schema_patterns(whole, whole) | nulls(whole, whole)
    assert not [each for each in UNCHECKED if not any(path.startswith(each.removesuffix("**")) for path in there)]
    assert all(listed(pattern(path)) for path in answer.entries.unchecked if path.startswith("operations."))


def test_a_new_entry_fails(written):
    document, _ = written.copies()
    document["operations"]["plans"][0]["operations"][0]["novel"] = 3.0
    answer = check(written.asked(document), seconds=0.0)
    assert not answer.holds
    assert any("novel" in line for line in answer.lines[1:])


def test_a_new_name_where_a_plan_makes_the_names_fails(written):
    document, _ = written.copies()
    document["operations"]["plans"][0]["operations"][0]["angles_deg"]["novel"] = 3.0
    lines = found(written, document, seconds=0.0).lines
    assert any("angles_deg.novel is an entry that no plan has" in line for line in lines)


def _kinds():
    """Each entry that a plan may have; those for which many tools are put down are slow."""
    schema = OperationsEntry.model_json_schema()
    return [
        pytest.param(kind, marks=pytest.mark.slow("puts down many tools")) if kind in _SLOW else kind
        for kind in sorted(schema_patterns(schema, schema))
    ]


@pytest.mark.parametrize("of_a_kind", _OF_A_KIND)
@pytest.mark.parametrize("kind", _kinds())
def test_a_forged_entry_is_found_or_listed_as_unchecked(written, kind, of_a_kind):
    of_kind = defaultdict(list)
    for path, value in leaves(written.document["operations"]):
        of_kind[pattern(path)].append((path, value))
    every = of_kind.get(kind, [])
    if not every:
        # An entry that this plan does not have: nothing else is left unforged.
        assert unchecked(kind)
        return
    many = min(2, of_a_kind) if kind in _SLOW else of_a_kind
    picked = {*np.linspace(0, len(every) - 1, many).astype(int).tolist()}
    # What is unchecked whatever is put down needs no tool put down.
    seconds = 0.0 if unchecked(kind) and kind not in _SLOW else 1e6
    for path, value in (every[k] for k in sorted(picked)):
        others = forged(value) + ([None] if value is not None else [])
        # Of one entry of a kind one other value will do, another one for other kinds; of four, all of them.
        for other in others[len(kind) % len(others) :][:1] if of_a_kind == 1 else others:
            if kind.endswith(".clearance_mm") and (other or 0.0) <= 1.45 * value:
                # What comes no nearer than that much comes no nearer than less; and reported clearances are below the true ones.
                continue
            document, _ = written.copies()
            put(document["operations"], path, other)
            answer = found(written, document, seconds=seconds)
            assert not answer.holds or named(answer, f"operations.{path}"), (path, value, other)


@pytest.mark.parametrize("name", ["plans", "operations", "regions", "rows", "faces"])
def test_a_list_that_is_cut_is_found(written, name):
    document, _ = written.copies()
    entry = document["operations"]
    plan, one = entry["plans"][0], entry["plans"][0]["operations"][0]
    where = {"operations": plan, "regions": one, "faces": one, "rows": one["regions"][0]}
    where.get(name, entry)[name].pop()
    assert not found(written, document).holds


@pytest.mark.slow("checks a plan once for each array and alteration")
def test_each_array_that_is_altered_is_found(written):
    # Those of the fewest orientations are not read.
    every = written.arrays["operations.npz"].items()
    for name, array in ((name, array) for name, array in every if name != "chosen" and not name.startswith("candidate")):
        there = np.flatnonzero(np.isfinite(array.astype(float)).reshape(len(array), -1).all(axis=1))
        for how in ("cut", "nan", "kind", "gone", "one"):
            document, arrays = written.copies()
            forged_ = arrays["operations.npz"]
            if (how == "cut" and not len(array)) or (how in ("nan", "one") and not len(there)):
                continue
            if how == "one" and name.startswith("moving_piece"):
                continue  # in which proved piece a sample lies is not looked for again
            if how == "cut":
                forged_[name] = array[:-1]
            elif how == "nan":
                if array.dtype.kind != "f":
                    continue
                forged_[name][there[0]] = np.nan
            elif how == "kind":
                forged_[name] = array.astype(complex)
            elif how == "gone":
                del forged_[name]
            else:
                row = int(there[0])
                forged_[name][row] = ~array[row] if array.dtype.kind == "b" else array[row] + 7
            answer = found(written, document, arrays)
            assert not answer.holds, (name, how)


def test_samples_that_are_moved_are_found(written):
    for name in ("point", "normal", "direction_max", "uv", "face", "area"):
        document, arrays = written.copies()
        arrays["samples.npz"][name][3] = arrays["samples.npz"][name][3] * 1.5 + 1
        assert not found(written, document, arrays).holds, name


class TestTheForgeriesOfTheTrial:
    @pytest.mark.slow("checks a plan many times", only=("clearance",))
    @pytest.mark.parametrize(
        ("word", "value"),
        [("frame", {"origin": [0.0, 0.0, 0.0], "x": [0.6, 0.8, 0.0], "z": [0.0, 0.0, 1.0]}), ("clearance_mm", 50.0),
         ("axis", [0.0, 0.6, 0.8]), ("axis", [float("nan")] * 3), ("setup", -1), ("setup", 1), ("samples", 1),
         ("other_angles_deg", {"C": 1.0, "B": 1.0}), ("cutter", "R2L40rc2F10S3HR16L60"), ("mode", "simultaneous")],
    )  # fmt: skip
    def test_an_operation(self, written, word, value):
        document, _ = written.copies()
        one = document["operations"]["plans"][0]["operations"][0]
        assert one[word] != value
        one[word] = value
        assert not found(written, document).holds

    @pytest.mark.slow("checks a plan many times")
    @pytest.mark.parametrize("word", ["proved_share", "approaches_proved"])
    def test_what_is_proved_between_samples_is_listed_as_unchecked(self, written, word):
        document, _ = written.copies()
        document["operations"]["plans"][0]["operations"][0][word] = 1
        answer = found(written, document, seconds=0.0)
        assert f"operations.plans[0].operations[0].{word}" in answer.entries.unchecked
        assert f"plans.operations.{word}" in answer.first

    @pytest.mark.slow("checks a plan many times")
    def test_a_lean(self, written):
        document, arrays = written.copies()
        lean, label = arrays["operations.npz"]["lean"], arrays["operations.npz"]["operation"]
        lean[np.flatnonzero(label == 0)] *= -1.0
        assert not found(written, document, arrays).holds

    @pytest.mark.slow("checks a plan many times")
    def test_no_plans(self, written):
        document, _ = written.copies()
        document["operations"]["plans"] = []
        assert not found(written, document).holds

    @pytest.mark.slow("checks a plan many times")
    def test_plans_that_are_renamed(self, written):
        document, _ = written.copies()
        for plan, name in zip(document["operations"]["plans"], ["fastest", "fewest"], strict=False):
            plan["name"] = name
        assert not found(written, document).holds


def test_a_sample_given_to_an_operation_that_does_not_serve_it_is_found(written):
    document, arrays = written.copies()
    question = written.question(document, arrays)
    plan = document["operations"]["plans"][0]
    label, normal = arrays["operations.npz"]["operation"], arrays["samples.npz"]["normal"]
    # Those with a fixed axis come first.
    axes = np.array([each["axis"] for each in plan["operations"] if each["axis"] is not None])
    away = np.flatnonzero((label >= 0) & ((normal @ axes.T).min(axis=1) < -0.05))
    assert len(away)
    label[away] = (normal[away] @ axes.T).argmin(axis=1)
    assert not check(question).holds


def test_a_check_without_time_says_what_it_did_not_look_at(written):
    answer = check(written.question(), seconds=0.0)
    assert answer.holds
    assert any("were not put down in the time" in line for line in answer.lines)
    assert not any(path.startswith("operations.") and "clearance_mm" in path for path in answer.entries.agree)


def test_forged_files_are_told_by_their_checksums(written):
    from dataclasses import replace

    question = replace(written.question(), checksums={"operations.npz": ("0" * 64, "1" * 64)})
    assert not check(question).holds


@pytest.mark.slow("checks a plan many times")
def test_json_can_say_nothing_that_ends_the_checker(written):
    """Entries exchanged for others of any kind end in an answer that fails, never in an exception."""
    for path in ("plans", "assumed", "plans[0].operations", "rotary"):
        for value in (None, 3, "x", [], {}, [3], [None], {"a": 1}):
            document, _ = written.copies()
            put(document["operations"], path, value)
            assert not found(written, json.loads(json.dumps(copy.deepcopy(document)))).holds, (path, value)
