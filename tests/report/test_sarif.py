"""SARIF: a finding for each case that fails or is not known, with the reason as its rule, whatever names hold."""

from hypothesis import given
from hypothesis import strategies as st

from plan_cutters.cases.files import Case, sarif
from tests.support.cases import OUTCOMES, TEXT
from tests.support.sarif import findings


@given(st.lists(st.tuples(TEXT, TEXT, st.sampled_from(OUTCOMES), TEXT, TEXT, TEXT), max_size=5))
def test_each_case_that_fails_is_a_finding(rows):
    rows = [Case(f"p{a}", f"{i}{b}", *more) for i, (a, b, *more) in enumerate(rows)]
    found = findings(sarif("plan", rows))
    levels = {"failure": "error", "error": "warning"}
    assert [each.level for each in found] == [levels[row.outcome] for row in rows if row.outcome in levels]


def test_a_reason_is_a_rule_once():
    rows = [Case("a.step", f"F{i}", "failure", kind, "lost") for i, kind in enumerate(["holder", "rear_gouge", "holder", ""])]
    assert [each.rule for each in findings(sarif("plan", rows))] == ["holder", "rear_gouge", "holder", "failure"]


def test_a_finding_is_known_again_when_its_share_changed():
    def mark(message):
        import json

        (result,) = json.loads(sarif("plan", [Case("a", "F1", "failure", "holder", message)]))["runs"][0]["results"]
        return result["partialFingerprints"]

    assert mark("12 % is lost") == mark("13 % is lost")


def test_a_file_whose_name_is_no_text_is_a_finding_all_the_same():
    (found,) = findings(sarif("plan", [Case("p\udcff\ud800.step", "F1", "failure", "holder", "lost", "")]))
    assert found.level == "error"
