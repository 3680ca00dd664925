"""JUnit files: valid whatever names hold, in agreement with the exit code, and never a pass for what is not reached."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plan_cutters.cases.files import Case, CaseFiles, junit
from plan_cutters.cases.plan import PROCESS, plan_cases
from plan_cutters.command.codes import code_of
from plan_cutters.errors import OptionError, PlanError
from plan_cutters.plan_file.model import MissingEntry
from plan_cutters.plan_file.operations import ProcessEntry, RemainingEntry
from tests.support.cases import OUTCOMES, TEXT
from tests.support.junit import cases, outcomes
from tests.support.plan_files import SAMPLES, cutter, face, made, verdicts

MISSING = MissingEntry(face="F9", entity=None, name="", why="lost in reading", stand_in="box")


@st.composite
def plans(draw):
    """A plan of some faces and cutters, of which samples may be blocked, undecided, unjudged or inside other bodies."""
    faces = [
        face(n, target=draw(st.booleans())).model_copy(update={"unjudged": draw(st.sampled_from([None, None, "no sample"]))})
        for n in range(1, draw(st.integers(2, 5)))
    ]

    def on_face():
        blocked = draw(st.sampled_from([0, 0, 0, 5, SAMPLES]))
        mine = verdicts(blocked, draw(st.sampled_from([0, 0, SAMPLES - blocked])))
        left = mine.accessible
        return mine.model_copy(update=draw(st.sampled_from([
            {}, {}, {"accessible": 0, "unjudged": left}, {"accessible": 0, "inaccessible": blocked + left, "inside_bodies": left},
        ])))  # fmt: skip

    tools = [cutter(name, {f.id: on_face() for f in faces if f.target}) for name in ("R3L40", "R6L80", "R8L90")]
    tools = [c.model_copy(update={"seen": draw(st.sampled_from([True, True, False]))}) for c in tools]
    plan = made(faces, tools).model_copy(update={"missing": draw(st.sampled_from([[], [], [MISSING]]))})
    return plan.model_copy(update={"process": process(plan, draw)})


def remaining(name, cause):
    return RemainingEntry(cause=cause, area_mm2=1, share=0.1, samples=1, faces=[name], place_mm=None)


def process(plan, draw):
    """A process that leaves some of the faces, or nothing."""
    left = [
        remaining(f.id, draw(st.sampled_from(["holder", "unjudged"]))) for f in plan.faces if f.target and draw(st.booleans())
    ]
    return ProcessEntry(steps=[], finished_share=0.9 if left else 1.0, finished_mm2=1, asked_mm2=1, left=left, seconds=None)


@settings(deadline=None, max_examples=200)
@given(plans(), st.sampled_from([None, None, 50.0]))
def test_the_file_agrees_with_the_exit_code(plan, fail_under):
    code = code_of(plan, fail_under)
    ends = outcomes(cases(junit("plan", plan_cases(plan, code, "a.step"))))
    assert ("failure" in ends) == (code == 1)
    assert code != 0 or "error" not in ends
    assert code != 4 or "error" in ends


@settings(deadline=None, max_examples=200)
@given(plans())
def test_a_case_passes_only_where_each_sample_is_judged_and_reached(plan):
    found = cases(junit("plan", plan_cases(plan, code_of(plan), "a.step")))
    targets = [f for f in plan.faces if f.target]
    assert [each.name for each in found[:1]] == [PROCESS]
    assert len(found) == 1 + len(targets) * len(plan.cutters)
    rows = iter(found[1:])
    for f in targets:
        for c in plan.cutters:
            case, v = next(rows), c.faces[f.id]
            assert case.name.split()[0] == f.id
            blocked = v.inaccessible - v.inside_bodies
            if case.outcome == "passed":
                assert blocked == v.undecided == v.unjudged == len(plan.missing) == 0
                assert f.unjudged is None
                assert v.accessible
            if case.outcome == "failure":
                assert blocked
                assert not any(
                    o.faces[f.id].accessible
                    and o.faces[f.id].accessible + o.faces[f.id].inside_bodies == SAMPLES
                    and not f.unjudged
                    for o in plan.cutters
                )
            assert case.outcome == "passed" or f.id in case.message


def test_a_face_that_another_cutter_reaches_is_skipped_with_its_reason():
    ball = cutter("R3L40", {"F1": verdicts(), "F2": verdicts(undecided=3)}, radius=3.0, length=40.0)
    flat = cutter("R6L80", {"F1": verdicts(400, reason="holder"), "F2": verdicts(7, reason="neck")})
    plan = made([face(1), face(2)], [ball, flat])
    found = cases(junit("plan", plan_cases(plan, code_of(plan), "a.step")))
    assert [each.outcome for each in found] == ["failure", "passed", "skipped", "error", "failure"]
    assert found[2].message == "40 % of F1 is not reached: holder collision 40 %; reached by flat end D6 x 40"
    assert (found[3].kind, found[4].kind) == ("holder", "neck")


@given(st.lists(st.tuples(TEXT, TEXT, st.sampled_from(OUTCOMES), TEXT, TEXT, TEXT, st.floats()), max_size=4,
                unique_by=lambda each: len(each[1])))  # fmt: skip
def test_any_text_makes_a_valid_file(rows):
    rows = [Case(a, f"{i}{b}", *more) for i, (a, b, *more) in enumerate(rows)]
    found = cases(junit("su\x00ite", rows))
    assert [each.outcome for each in found] == [row.outcome for row in rows]


def test_markup_is_escaped_and_what_xml_cannot_hold_is_replaced():
    (found,) = cases(junit("s", [Case("a<b>&\"'.step", "F1", "failure", "k", "x\x1b[2J\ny \ud800", "<![CDATA[\x07]]>")]))
    assert found.part == "a<b>&\"'.step"
    assert found.message == "x\ufffd[2J y \ufffd"
    assert found.details == "<![CDATA[\ufffd]]>"


def test_the_file_is_written_whole_or_not_at_all(tmp_path):
    path = tmp_path / "reports/junit.xml"
    files = CaseFiles(str(path))
    files.write("s", [Case("a", "b")])
    before = path.read_bytes()
    assert cases(before)[0].name == "b"

    def broken():
        yield Case("a", "c")
        raise RuntimeError

    with pytest.raises(RuntimeError):
        files.write("s", broken())
    assert path.read_bytes() == before
    assert [each.name for each in path.parent.iterdir()] == ["junit.xml"]
    with pytest.raises(PlanError, match="cannot be written"):
        CaseFiles(str(path / "below.xml")).write("s", [])


@pytest.mark.parametrize("name", ["-", "", "."])
@pytest.mark.parametrize("word", ["junit", "sarif"])
def test_what_is_no_file_is_refused_before_the_work(word, name):
    with pytest.raises(OptionError, match=f"--{word}"):
        CaseFiles(**{word: name}).check()


def test_two_forms_of_one_file_are_refused():
    with pytest.raises(OptionError, match="name one file"):
        CaseFiles("a", "./a").check()
