"""The process: every sample in one step or left for one cause, areas that add up, and lines that fit a terminal."""

import json
from types import SimpleNamespace

import pytest
from OCP.BRep import BRep_Builder
from OCP.TopoDS import TopoDS_Face

from plan_cutters import plan
from plan_cutters.command.codes import FEASIBLE, NONE_FEASIBLE, NOT_ALL_JUDGED, code_of
from plan_cutters.command.summary import summary
from plan_cutters.plan_file.model import Plan
from plan_cutters.plan_file.operations import UNJUDGED_CAUSE
from plan_cutters.plan_file.words.process import WIDTH, process_story
from plan_cutters.plan_file.words.text import MOST, text_of
from tests.support.cad_parts import box, compound
from tests.support.forked import run
from tests.support.places import SAMPLES

pytestmark = pytest.mark.slow("plans operations of two kinds", only=("fewest",))
#: The cheapest that still answers.
QUICK = {"grid": 5, "area_budget": 0, "spacing": None}


def no_surface():
    """A face that has no surface."""
    face = TopoDS_Face()
    BRep_Builder().MakeFace(face)
    return face


TURNED = {"machine": "trunnion-ac", "operations": "fastest", "feed": 1000}
BOX = {"faces": "all", "setup": (0, 0, 1), **QUICK}
CASES = {
    "one cutter finishes": (SAMPLES / "peaks_and_valleys.step", {"cutters": ["R1L40"], **QUICK}),
    "one cutter leaves some": (SAMPLES / "pocket_top.step", {"cutters": ["R9L40"], "machine": "tilt:10", **QUICK}),
    "two cutters": (SAMPLES / "pocket_top.step", {"cutters": ["R9L40", "R3L40"], "machine": "tilt:10", **QUICK}),
    "two setups": (box(20, 20, 6), {**BOX, "cutters": ["R3L30"], "machine": "tilt:60", "other_setups": [(0, 0, -1)]}),
    "operations": (box(20, 20, 6), {**BOX, "cutters": ["R3L30", "R2L30rc2"], **TURNED}),
    "fewest operations": (box(20, 20, 6), {**BOX, "cutters": ["R3L30"], "machine": "trunnion-ac", "operations": "fewest"}),
    "nothing is reached": (box(20, 20, 6), {**BOX, "cutters": ["R3L30"], "faces": "5", "machine": "tilt:20"}),
    "a face without a surface": (compound(box(20, 20, 20), no_surface()), {"cutters": ["R3L40"], "faces": "all", **QUICK}),
}  # fmt: skip


@pytest.fixture(scope="module", params=CASES)
def found(request):
    part, how = CASES[request.param]
    return SimpleNamespace(plan=plan(part, **how).plan, name=request.param)


@pytest.mark.slow("plans whole parts", only=("operations",))
def test_steps_and_what_is_left_are_all_that_was_asked(found):
    process = found.plan.process
    left = sum(each.area_mm2 for each in process.left)
    assert sum(step.area_mm2 for step in process.steps) == pytest.approx(process.finished_mm2)
    assert process.finished_mm2 + left == pytest.approx(process.asked_mm2)
    assert sum(each.share for each in (*process.steps, *process.left)) == pytest.approx(1.0)
    assert (process.finished_share == 1.0) == (not process.left)
    assert [each.area_mm2 for each in process.left] == sorted((each.area_mm2 for each in process.left), reverse=True)
    assert all(step.area_mm2 > 0.0 and step.faces for step in process.steps)


def test_the_process_agrees_with_the_shares_of_the_cutters(found):
    """No cutter alone reaches more than all do together; where there is one and no operations, they are the same."""
    process, reached = found.plan.process, []
    for cutter in found.plan.cutters:
        share = cutter.area_share
        reached.append(share.interference_free + share.accessible)
    if found.plan.operations is None and not found.plan.effective.other_setups:
        assert process.finished_share >= max(reached) - 1e-9
        if len(reached) == 1:
            assert process.finished_share == pytest.approx(reached[0])


def test_the_exit_code_is_that_of_the_process(found):
    process = found.plan.process
    code = code_of(found.plan)
    assert (code == NONE_FEASIBLE) == any(each.cause != UNJUDGED_CAUSE for each in process.left)
    if any(each.cause == UNJUDGED_CAUSE for each in process.left):
        assert code != FEASIBLE


def test_the_lines_fit_a_terminal(found):
    lines = found.plan.text.lines
    assert len(lines) <= MOST
    assert all(len(line) <= WIDTH for line in lines)
    assert text_of(found.plan) == found.plan.text


def test_the_file_holds_the_process(found):
    document = json.loads(found.plan.model_dump_json())
    assert Plan.model_validate(document).process == found.plan.process


def test_operations_are_the_steps():
    part, how = CASES["operations"]
    done = plan(part, **how).plan
    fastest = next(each for each in done.operations.plans if each.name == "fastest")
    assert fastest.seconds == min(each.seconds for each in done.operations.plans)
    told = sorted((step.setup, step.mode, step.cutter, round(step.area_mm2, 9)) for step in done.process.steps)
    assert told == sorted((each.setup, each.mode, each.cutter, round(each.area_mm2, 9)) for each in fastest.operations)
    assert done.process.setup_seconds is not None
    assert done.process.seconds == pytest.approx(fastest.seconds)
    each = (getattr(done.process, f"{word}_seconds") for word in ("cutting", "link", "index", "change", "setup"))
    assert sum(each) == pytest.approx(done.process.seconds)
    assert {step.mode for step in done.process.steps} <= {"fixed", "simultaneous"}


def test_of_many_steps_the_largest_are_told():
    part, how = CASES["two cutters"]
    done = plan(part, **how).plan
    step, shares = done.process.steps[0], [0.001 * k * k for k in (1, 9, 2, 3, 11, 4, 5, 12, 6, 7, 8, 10)]
    steps = [step.model_copy(update={"share": share}) for share in shares]
    many = done.model_copy(update={"process": done.process.model_copy(update={"steps": steps})})
    story = process_story(many, {})
    assert [row.number for row in story.rows] == ["2", "5", "6", "7", "8", "9", "10", "11", "12"]
    assert story.more.startswith("and 3 smaller steps for 1.4 %")
    assert story.unlisted == {0}


@pytest.mark.parametrize(("hidden", "says"), [(True, "Setup 2: -Z up"), (False, "Setup 2: -Z up. No step.")])
def test_a_setup_whose_steps_are_not_listed_has_some(hidden, says):
    part, how = CASES["two cutters"]
    done = plan(part, **how).plan
    step, (stand, *_) = done.process.steps[0], done.process.setups
    steps = [step.model_copy(update={"share": 0.05}) for _ in range(11)]
    steps += [step.model_copy(update={"share": 0.01, "setup": 1})] * hidden
    setups = [stand, stand.model_copy(update={"number": 2, "text": "Setup 2: -Z up" if hidden else "Setup 2: -Z up."})]
    many = done.model_copy(update={"process": done.process.model_copy(update={"steps": steps, "setups": setups})})
    assert says in [line.strip() for line in process_story(many, {}).table()]


@pytest.mark.slow("looks for what would help in two pockets")
def test_a_next_step_takes_something_off_what_the_process_leaves():
    import cadquery as cq

    shallow = cq.Workplane().rect(24, 18).extrude(-6).edges("|Z").fillet(2.5).translate((-20, 0, 0))
    deep = cq.Workplane().rect(24, 18).extrude(-20).edges("|Z").fillet(6.0).translate((20, 0, 0))
    part = cq.Workplane().box(80, 30, 25).translate((0, 0, -12.5)).cut(shallow).cut(deep)
    bottom = 1 + next(k for k, face in enumerate(part.faces().vals()) if face.BoundingBox().zmax < -24.0)
    asked = {
        "cutters": ["D10L40F25S10", "D6L10F9S6"],
        "holder": "D40L30",
        "faces": f"!{bottom}",
        "spacing": 4.0,
        "area_budget": 0,
    }
    done = plan(part, **asked, answers="mend").plan
    left = 1.0 - done.process.finished_share
    assert left > 0.0
    # The larger cutter alone would need the smaller one, which is in the process already.
    assert {step.cutter for step in done.process.steps} == {cutter.id for cutter in done.cutters}
    assert done.process.next
    assert all(each.left_share is None or each.left_share <= left - 0.0009 for each in done.process.next)


def test_a_face_without_a_surface_is_left_by_name_and_never_finished():
    part, how = CASES["a face without a surface"]
    done = plan(part, **how).plan
    (left,) = done.process.left
    assert (left.cause, left.samples) == (UNJUDGED_CAUSE, 0)
    assert left.faces == [face.id for face in done.faces if not face.samples]
    assert done.process.finished
    assert done.process.finished_share < 1.0 or left.area_mm2 == 0.0
    assert code_of(done) == NOT_ALL_JUDGED


@pytest.mark.parametrize(("missing", "code"), [([], FEASIBLE), (["a face"], NOT_ALL_JUDGED)])
def test_less_may_be_enough_but_not_where_obstacles_are_missing(missing, code):
    part, how = CASES["one cutter leaves some"]
    done = plan(part, **how).plan.model_copy(update={"missing": missing})
    share = 100.0 * done.process.finished_share
    assert code_of(done) == NONE_FEASIBLE
    assert code_of(done, share - 0.01) == code
    assert code_of(done, share + 0.01) == NONE_FEASIBLE


@pytest.mark.parametrize("percent", ["0", "-1", "100.1", "nan", "inf", "much"])
def test_a_percentage_that_is_none_is_refused_in_one_line(tmp_path, percent):
    done = run(SAMPLES / "v_groove.step", "--fail-under", percent, cwd=tmp_path)
    assert done.returncode == 2
    assert len(done.stderr.splitlines()) == 1
    assert "--fail-under" in done.stderr


def test_the_command_leads_with_it_in_25_lines(tmp_path, capsys):
    words = (
        "--cutter",
        "R9L40",
        "--cutter",
        "R3L40",
        "--machine",
        "tilt:10",
        "--grid",
        "5",
        "--area-budget",
        "0",
        "--formats",
        "json,html",
    )
    done = run(SAMPLES / "pocket_top.step", *words, "-o", "out", cwd=tmp_path)
    lines = done.stdout.splitlines()
    assert len(lines) <= 25
    assert all(len(line) <= WIDTH for line in lines[:-1])
    assert lines[-1].startswith("Review page: ")
    document = Plan.model_validate_json((tmp_path / "out" / "plan.json").read_text())
    assert lines[0] == document.text.headline
    summary(document)
    assert capsys.readouterr().out.splitlines() == lines[:-1]
