"""Test cases of comparisons, batches and changed parts agree with the exit codes of their commands."""

import itertools

import pytest

from plan_cutters.cases.files import junit
from plan_cutters.report.to_json import dumps
from plan_cutters_batch.row import PartRow, part_case
from plan_cutters_ci.changed import RULES, Changed, Row, row_cases
from plan_cutters_ci.diff import compare_folders
from plan_cutters_ci.plans import compare
from plan_cutters_ci.wording import comparison_cases, difference_cases
from tests.support.forked import run
from tests.support.junit import cases, outcomes
from tests.support.plan_files import cutter, face, made, verdicts

WHOLE, HALF, UNSURE = verdicts(), verdicts(500), verdicts(undecided=500)


def plan(*on_faces, **more):
    faces = [face(n + 1, name="rim \x1b<&>") for n in range(len(on_faces))]
    return made(faces, [cutter("R6L80", {f.id: v for f, v in zip(faces, on_faces, strict=True)})], **more)


ONES = [plan(WHOLE, WHOLE), plan(WHOLE, HALF), plan(UNSURE, WHOLE), plan(WHOLE, WHOLE, effective={"tolerance_mm": 1.0}),
        plan(HALF, HALF, effective={"tolerance_mm": 1.0})]  # fmt: skip


def saved(folder, one):
    folder.mkdir(parents=True)
    (folder / "plan.json").write_text(dumps(one), encoding="utf-8")


@pytest.mark.slow("plans pairs of parts", but=("4-4",))
@pytest.mark.parametrize(("old", "new"), [*itertools.product(range(len(ONES)), repeat=2)])
def test_a_comparison_fails_where_something_is_lost_and_is_an_error_where_it_cannot_be_told(tmp_path, old, new):
    saved(tmp_path / "old", ONES[old])
    saved(tmp_path / "new", ONES[new])
    done = run("diff", "old", "new", "--junit", "junit.xml", cwd=tmp_path)
    ends = outcomes(cases((tmp_path / "junit.xml").read_bytes()))
    assert ("failure" in ends) == (done.returncode == 1)
    assert ("error" in ends) == (done.returncode == 2)
    assert ("passed" in ends) == (done.returncode != 2)


def test_folders_of_many_have_a_case_for_each_plan(tmp_path):
    for name, one in (("a", ONES[0]), ("gone", ONES[0]), ("broken", ONES[0])):
        saved(tmp_path / "old" / name, one)
    for name, one in (("a", ONES[1]), ("added", ONES[0]), ("broken", ONES[0])):
        saved(tmp_path / "new" / name, one)
    (tmp_path / "new/broken/plan.json").write_text("{")
    found = cases(junit("diff", comparison_cases(compare_folders(tmp_path / "old", tmp_path / "new", slack=0.001))))
    ends = {(each.part.split("/")[-2] if "/" in each.part else each.part, each.name.split()[0], each.outcome) for each in found}
    assert ends == {
        ("a", "comparable", "passed"), ("a", "face", "failure"), ("a", "cutter", "failure"), ("gone", "comparable", "failure"),
        ("added", "comparable", "passed"), ("broken", "comparable", "error"),
    }  # fmt: skip
    (lost,) = [each for each in found if each.name.startswith("face")]
    assert lost.name == "face F2 rim \ufffd<&>"
    assert lost.message == "was reached, now partly 50 % (holder collision)"


def test_a_face_that_is_gone_and_another_one_of_its_number_are_two_cases():
    difference = compare(ONES[0], ONES[1], name="part")
    (one,) = difference.faces
    apart = [one.model_copy(update={"new": None, "now": None}), one.model_copy(update={"old": None, "was": None})]
    difference = difference.model_copy(update={"faces": apart})
    names = [case.name for case in difference_cases(difference)]
    assert {name.partition("F2")[0] for name in names if "face" in name} == {"face ", "new face "}
    assert len({*names}) == len(names)


def test_a_plan_that_cannot_be_read_is_an_error(tmp_path):
    saved(tmp_path / "old", ONES[0])
    assert run("diff", "old", "none", "--junit", "junit.xml", cwd=tmp_path).returncode == 2
    assert outcomes(cases((tmp_path / "junit.xml").read_bytes())) == {"error"}
    refused = run("diff", "old", "old", "--junit", "-", cwd=tmp_path)
    assert (refused.returncode, "--junit" in refused.stderr) == (2, True)


ROWS = [
    Row(Changed("a", None)),
    Row(Changed("a", "a"), failed="a: cannot be read"),
    Row(Changed("a", "a"), unread="a: cannot be read"),
    Row(Changed(None, "a"), unreachable=("F1",)),
    *(
        Row(Changed("a", "a"), difference=compare(x, y, name="a"), unreachable=u)
        for x in ONES
        for y in ONES
        for u in ((), ("F2",))
    ),
]


@pytest.mark.parametrize("rule", RULES)
def test_a_changed_part_fails_as_its_rule_says_and_never_passes_what_the_rule_lets_pass(rule):
    for row in ROWS:
        found = cases(junit("changed", row_cases(row, rule)))
        assert bool(outcomes(found) & {"failure", "error"}) == row.breaks(rule)
        strictest = cases(junit("changed", row_cases(row, RULES[-1])))
        assert [each.outcome == "passed" for each in found] == [each.outcome == "passed" for each in strictest]


@pytest.mark.parametrize(
    ("code", "status", "outcome"),
    [(0, "planned", "passed"), (0, "kept", "passed"), (1, "kept", "failure"), (4, "planned", "error"), (3, "failed", "error"),
     (124, "failed", "error"), (0, "failed", "error"), (139, "planned", "error")],
)  # fmt: skip
def test_a_part_of_many_is_a_case(code, status, outcome):
    row = PartRow(name="n", file="in/n.step", status=status, code=code, verdict="Says", seconds=1.5, reason="holder",
                  error="why" if status == "failed" else None)  # fmt: skip
    (found,) = cases(junit("batch", [part_case(row)]))
    assert (found.part, found.name, found.outcome) == ("in/n.step", "n", outcome)
    assert found.message or outcome == "passed"
