"""The planner's own process: steps are judged as they stand, in their order, and what is wrong with them is said."""

import json
import os

import cadquery as cq
import numpy as np
import pytest

from plan_cutters import plan
from plan_cutters.errors import OptionError
from plan_cutters.machines.process_file import process_of
from plan_cutters.options import Options
from plan_cutters.report.folder import stale_files, write_all
from plan_cutters.report.process_file import process_toml
from tests.support.cad_parts import box
from tests.support.forked import run

#: A block of 40 x 30 x 20; F1 to F6 are its sides, two across each axis.
OPTIONS = {
    "faces": "all",
    "area_budget": 0,
    "feed": 1000.0,
    "machine": "trunnion-ac",
    "grid": 3,
    "cutters": ["D12L60F26", "D6L40rc3F16"],
}
UP, DOWN = {"C": 0.0, "A": 0.0}, {"C": 0.0, "A": 130.0}
FLAT, BALL = "D12L60F26", "D6L40rc3F16"


@pytest.fixture(scope="module")
def block():
    return box(40.0, 30.0, 20.0)


def judged(part, *steps, rest="leave", **more):
    return plan(part, **{**OPTIONS, **more}, process={"step": list(steps), "rest": rest})


def facing(result, direction):
    """Samples whose normals are in a direction."""
    return np.flatnonzero(result.samples.normal @ np.array(direction, float) > 0.99)


def test_each_step_takes_what_it_serves_of_its_faces_and_none_before_it_took(block):
    """The flat end takes the top, then the ball all that the top leaves: its four sides; the bottom stays."""
    result = judged(
        block, {"cutter": FLAT, "angles": UP, "faces": ["F6"]}, {"cutter": BALL, "angles": UP}, {"cutter": FLAT, "angles": UP}
    )
    first, second, third = result.answers.operations.own
    assert set(first.rows.tolist()) == set(facing(result, (0, 0, 1)).tolist())
    sides = np.concatenate([facing(result, each) for each in ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0))])
    assert set(second.rows.tolist()) == set(sides.tolist())
    assert not len(third.rows)
    label, operations = result.answers.operations.plans[0].label, result.answers.operations.plans[0].operations
    assert {operations[k].step for k in label[first.rows].tolist()} == {1}
    assert {operations[k].step for k in label[second.rows].tolist()} == {2}
    assert (label[facing(result, (0, 0, -1))] == -1).all()
    steps = result.plan.process.steps
    assert [step.own.number for step in steps] == [1, 2, 3]
    assert "Step 3 reaches nothing that is left." in result.plan.text.lines
    assert result.plan.process.finished_share == pytest.approx((1200.0 + 2800.0) / 5200.0)


def test_an_orientation_that_the_machine_cannot_hold_is_said_with_one_that_does(block):
    """The bottom needs A 90 at least, and the trunnion does not tilt to 130 deg: what is proposed finishes it."""
    wrong = judged(block, {"cutter": FLAT, "angles": DOWN, "faces": ["F5"]}, tolerance=0.02)
    (found,) = wrong.answers.operations.own
    assert not len(found.rows)
    step = wrong.plan.process.steps[0]
    assert step.own.wrong
    assert step.own.nearest is not None
    assert any("cannot hold" in line for line in wrong.plan.text.lines)
    right = judged(block, {"cutter": FLAT, "angles": step.own.nearest.angles_deg, "faces": ["F5"]}, tolerance=0.02)
    assert right.plan.process.steps[0].area_mm2 == pytest.approx(step.own.nearest.area_mm2)
    assert right.plan.process.steps[0].area_mm2 == pytest.approx(1200.0)


def test_angles_that_no_control_shows_are_noted_as_they_are_judged(block):
    finer = {"cutter": FLAT, "angles": {"C": 37.123456789, "A": 120.0000001}, "faces": ["F6"]}
    plain = {"cutter": BALL, "angles": {"C": 37.123, "A": -0.0}, "faces": ["F6"]}
    result = judged(block, plain, finer)
    noted = dict(zip(result.plan.note_codes, result.plan.notes, strict=True))
    assert noted["angles_rounded"].endswith("judged is step 2 at C 37.123 A 120.")
    assert result.plan.process.steps[1].angles_deg == {"C": 37.123, "A": 120.0}
    assert "angles_rounded" not in judged(block, plain).plan.note_codes


def test_a_step_that_leaves_some_of_its_faces_says_how_much_and_why(block):
    result = judged(block, {"cutter": FLAT, "angles": UP, "faces": ["F5", "F6"]})
    own = result.plan.process.steps[0].own
    assert own.asked_mm2 == pytest.approx(2400.0)
    assert [(each.cause, each.faces) for each in own.leaves] == [("orientation", ["F5"])]
    assert own.leaves[0].area_mm2 == pytest.approx(1200.0)


def test_what_steps_leave_is_planned_behind_them_and_not_with_what_is_forbidden(block):
    process = {"step": [{"cutter": FLAT, "angles": UP, "faces": ["F6"]}], "forbid": [{"cutter": FLAT, "faces": ["F1", "F2"]}]}
    result = plan(block, **OPTIONS, process=process)
    made = result.answers.operations.plans[0]
    assert made.name == "process"
    assert result.plan.process.steps[0].own.number == 1
    assert all(step.own is None for step in result.plan.process.steps[1:])
    assert len(result.plan.process.steps) > 1
    forbidden = np.isin(result.samples.face, (1, 2))
    with_flat = np.isin(made.label, [k for k, each in enumerate(made.operations) if each.cutter.corner_radius == 0.0])
    assert (made.label[forbidden] >= 0).all()
    assert not (forbidden & with_flat).any()
    assert result.plan.process.finished_share == 1.0


def test_the_file_beside_a_plan_gives_the_same_process(block, tmp_path):
    first = plan(block, **OPTIONS, operations="fastest")
    file = tmp_path / "process.toml"
    file.write_text(process_toml(first.plan), encoding="utf-8")
    again = plan(block, **OPTIONS, process=file)
    ours, theirs = first.plan.process, again.plan.process
    assert theirs.finished_share == ours.finished_share
    assert [(s.setup, s.angles_deg, s.cutter) for s in theirs.steps] == [(s.setup, s.angles_deg, s.cutter) for s in ours.steps]
    assert [s.area_mm2 for s in theirs.steps] == pytest.approx([s.area_mm2 for s in ours.steps])
    assert theirs.seconds == pytest.approx(ours.seconds)
    written, asked = (process_of(each).steps for each in (again.plan.effective.process, file))
    assert [(s.setup, s.angles, s.faces) for s in written] == [(s.setup, s.angles, s.faces) for s in asked]


def test_a_simultaneous_step_takes_what_its_cutter_reaches(block):
    result = judged(block, {"cutter": BALL, "mode": "simultaneous"})
    step = result.plan.process.steps[0]
    assert (step.mode, step.own.number) == ("simultaneous", 1)
    assert step.area_mm2 == pytest.approx(5200.0)
    assert result.answers.operations.plans[0].operations[0].step == 1


@pytest.mark.slow("checks a plan twice")
def test_the_checker_follows_the_steps_and_finds_one_that_is_forged(block, tmp_path):
    """A plan whose operation says that it is of another step than it is does not hold."""
    cq.Shape.cast(block).exportStep(str(tmp_path / "block.step"))
    (tmp_path / "process.toml").write_text(
        f'rest = "leave"\n[[step]]\ncutter = "{BALL}"\nmode = "simultaneous"\nfaces = ["F1"]\n'
        f'[[step]]\ncutter = "{FLAT}"\nangles = {{ C = 0.0, A = 0.0 }}\n', encoding="utf-8",
    )  # fmt: skip
    words = [str(tmp_path / "block.step"), "--faces", "all", "--machine", "trunnion-ac", "--feed", "1000", "--grid", "5"]
    words += ["--area-budget", "0", "--cutter", FLAT, "--cutter", BALL, "--process", str(tmp_path / "process.toml")]
    assert run(*words, "--formats", "json,npz", "-o", str(tmp_path / "out")).returncode == 1
    file = tmp_path / "out" / "plan.json"
    check = run(*words, "--check-operations", str(file))
    assert check.returncode == 0, check.stdout + check.stderr
    document = json.loads(file.read_text())
    for each in document["operations"]["plans"][0]["operations"]:
        each["step"] = 3 - each["step"]
    file.write_text(json.dumps(document))
    assert run(*words, "--check-operations", str(file)).returncode == 1


def test_a_simultaneous_step_that_shares_comes_behind_all_others(block):
    """It stands first, and takes of its faces what the fixed step behind it does not serve."""
    moving = {"cutter": BALL, "mode": "simultaneous", "faces": ["F5", "F6"]}
    fixed = {"cutter": FLAT, "angles": UP, "faces": ["F6"]}
    first = judged(block, moving, fixed).plan.process.steps
    assert [each.area_mm2 for each in first] == pytest.approx([2400.0, 0.0])
    result = judged(block, {**moving, "take": "share"}, fixed)
    rest = result.plan.process.steps
    assert [(each.own.number, each.take) for each in rest] == [(1, "share"), (2, "first")]
    assert [each.area_mm2 for each in rest] == pytest.approx([1200.0, 1200.0])
    assert rest[0].own.asked_mm2 == pytest.approx(1200.0)
    assert not any("leaves" in line for line in result.plan.text.lines)
    again = process_of(result.plan.effective.process).steps
    assert [each.take for each in again] == ["share", "first"]
    assert 'faces = ["F5"]\ntake = "share"\n' in process_toml(result.plan)


def test_fixed_steps_that_share_divide_their_faces_by_time(block):
    """The flat end is quicker on the top than the ball that stands first; one that does not share comes before both."""
    ball, flat = ({"cutter": each, "angles": UP, "faces": ["F6"], "take": "share"} for each in (BALL, FLAT))
    shared = judged(block, ball, flat).plan.process
    assert [each.area_mm2 for each in shared.steps] == pytest.approx([0.0, 1200.0])
    assert not any(each.own.leaves for each in shared.steps)
    first = judged(block, flat, {**ball, "take": "first"}).plan.process
    assert [each.area_mm2 for each in first.steps] == pytest.approx([0.0, 1200.0])
    assert [each.own.asked_mm2 for each in first.steps] == pytest.approx([0.0, 1200.0])
    # What neither serves is planned behind them, and counted once.
    whole = judged(block, ball, flat, rest="plan").plan.process
    assert whole.finished_share == 1.0
    assert sum(each.area_mm2 for each in whole.steps) == pytest.approx(5200.0)


def test_what_a_step_does_alone_is_what_goes_with_it(block):
    """Leave out each of three steps in turn: what is finished falls by what it did alone, and another one takes the rest."""
    steps = [
        {"cutter": FLAT, "angles": UP, "faces": ["F6", "F1"]},
        {"cutter": BALL, "mode": "simultaneous", "faces": ["F1", "F2", "F5"]},
        {"cutter": BALL, "angles": UP, "faces": ["F2", "F3"]},
    ]
    whole = judged(block, *steps)
    for k, step in enumerate(whole.plan.process.steps):
        less = judged(block, *[each for each in steps if each is not steps[k]])
        gone = whole.plan.process.finished_mm2 - less.plan.process.finished_mm2
        assert gone == pytest.approx(step.alone_mm2)
        assert 0.0 < gone < step.area_mm2 + 1e-9
    assert whole.plan.process.steps[0].alone_mm2 == pytest.approx(1200.0)


def test_a_step_may_name_a_cutter_where_it_is_forbidden(block):
    """It is not planned there; what a step of the planner's gives it, it does, with a posture at each sample."""
    process = {"step": [{"cutter": BALL, "mode": "simultaneous", "faces": ["F1"]}], "rest": "plan",
               "forbid": [{"cutter": BALL, "faces": ["F1", "F2"]}]}  # fmt: skip
    result = plan(block, **OPTIONS, process=process)
    made = result.answers.operations.plans[0]
    mine = np.flatnonzero(result.samples.face == 1)
    (k,) = {*made.label[mine].tolist()}
    assert made.operations[k].step == 1
    assert result.plan.operations.plans[0].operations[k].clearance_mm is not None
    assert np.isfinite(made.lean[mine]).all()
    assert {made.operations[i].cutter.corner_radius for i in made.label[result.samples.face == 2].tolist()} == {0.0}


def test_a_file_that_a_person_wrote_into_the_folder_stays(block, tmp_path):
    own = tmp_path / "process.toml"
    text = f'# mine\nrest = "leave"\n[[step]]\ncutter = "{FLAT}"\nangles = {{ C = 0.0, A = 0.0 }}\n'
    own.write_text(text, encoding="utf-8")
    for _ in range(2):
        written = write_all(plan(block, **OPTIONS, process=own), tmp_path, ("json",))
        assert stale_files(tmp_path, written, ("json",)) == []
        assert own.read_text(encoding="utf-8") == text


def test_a_proposal_that_was_edited_is_not_written_over(block, tmp_path):
    """The file of a run is replaced by that of the next one, until a person changes it: then it stays, and the plan says so."""
    own, first = tmp_path / "process.toml", plan(block, **{**OPTIONS, "cutters": [FLAT]})
    for _ in range(2):
        assert "process" in write_all(first, tmp_path, ("json",)).files
    own.write_text(own.read_text() + "# mine\n", encoding="utf-8")
    for _ in range(2):
        second = write_all(first, tmp_path, ("json",))
        assert own.read_text().endswith("# mine\n")
        assert "process" not in second.files
        assert "was edited, and stays" in second.not_written["process"]
        assert stale_files(tmp_path, second, ("json",)) == []
    own.unlink()
    assert "process" in write_all(first, tmp_path, ("json",)).files


STEP = {"cutter": FLAT, "angles": UP}


@pytest.mark.parametrize(
    ("process", "said"),
    [
        ({"step": [{**STEP, "cutter": "D13L60"}]}, "step 1: cutter 'D13L60' is not among those that are judged: D12L60F26?"),
        ({"step": [STEP, {"cutter": FLAT}]}, "step 2: angles are missing"),
        ({"step": [{**STEP, "axis": [0.0, 0.0, 1.0]}]}, "step 1: give angles or an axis, not both"),
        ({"step": [{**STEP, "angles": {"B": 0.0, "C": 0.0}}]}, "the rotary axes are C and A"),
        ({"step": [{**STEP, "angles": {"C": float("nan"), "A": 0.0}}]}, "finite number"),
        ({"step": [{"cutter": FLAT, "axis": [0.0, 0.0, 0.0]}]}, "has no direction"),
        ({"step": [{**STEP, "mode": "simultaneous"}]}, "leave them out, or the mode"),
        ({"step": [{**STEP, "setup": 2}]}, "step 1: setup 2: 1 is the only setup"),
        ({"step": [{**STEP, "faces": ["top"]}]}, "step 1: faces: 'top' is no face"),
        ({"step": [{**STEP, "faces": []}]}, 'step 1: faces is a value of type list: write faces = ["F3", "F12"], or "left"'),
        ({"step": [{**STEP, "angles": {"C": 1e308, "A": 0.0}}]}, "step 1 angles: C is 1e+308"),
        ({"step": [{"cutter": FLAT, "axis": [5e-324, 5e-324, 0.0]}]}, "has no direction"),
        ({"step": [STEP] * 10_000}, "at most 500"),
        ({"step": [{**STEP, "cutter": "x" * 100_000}]}, "at most 300 characters"),
        ({"version": 2, "step": [STEP]}, "version is 2"),
        ({}, "has no step, and forbids nothing"),
        ({"step": [{**STEP, "faces": ["F9"]}]}, "step 1: faces: F9: no target face has this number"),
        ({"steps": []}, "'steps' is unknown here"),
        ({"rest": "leave"}, "nothing to judge"),
        ({"rest": "perhaps"}, "rest is 'perhaps'"),
        ({"forbid": [{"cutter": "R1", "faces": ["F1"]}]}, "forbid 1: cutter 'R1'"),
        ("nowhere.toml", "cannot be read"),
        (3, "give a file or the steps"),
    ],
)  # fmt: skip
def test_what_has_no_meaning_is_one_line_with_its_place(block, process, said):
    with pytest.raises(OptionError) as raised:
        plan(block, **OPTIONS, process=process)
    assert said in str(raised.value)
    assert "\n" not in str(raised.value)


FILE = f'[[step]]\ncutter = "{FLAT}"\nangles = {{ C = 0.0, A = 0 }}\n'


@pytest.mark.parametrize(
    "data",
    [FILE.encode("utf-8-sig"), FILE.replace("\n", "\r\n").encode(), FILE.encode("utf-16"),
     json.dumps({"step": [{"cutter": FLAT, "angles": UP}]}).encode()],
)  # fmt: skip
def test_the_same_steps_are_read_from_any_text(tmp_path, data):
    file = tmp_path / "process"
    file.write_bytes(data)
    (step,) = process_of(file).steps
    assert (step.cutter, dict(step.angles), step.faces) == (FLAT, UP, None)


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (b"", "has no step"),
        (b"%", "is no TOML"),
        (b"x = " + b"[" * 100_000, "nested too deeply"),
        (b"x = 1" + b"0" * 5000, "is no TOML: a number has too many digits"),
        (b"<html>", "is a web page"),
        (b'{"step": [', "looks like JSON but cannot be read"),
        (b'{"rest": "plan", "rest": "leave"}', "is given twice"),
        (b"#" * (2 << 20), "is too large"),
        (FILE.replace(FLAT, "\u00d8").encode("latin-1"), "step 1: cutter '\u00d8'"),
    ],
)  # fmt: skip
def test_a_file_that_is_none_is_one_line_with_its_name(tmp_path, data, said):
    file = tmp_path / "mine.toml"
    file.write_bytes(data)
    with pytest.raises(OptionError) as raised:
        Options(cutters=[FLAT], machine="trunnion-ac", feed=1000.0, process=file)
    assert str(raised.value).startswith("mine.toml: ")
    assert said in str(raised.value)
    assert "\n" not in str(raised.value)


def test_what_is_no_file_is_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    for path, said in ((tmp_path, "is a folder"), (tmp_path / "pipe", "a pipe or a device"), ("/dev/zero", "a pipe or a device")):
        with pytest.raises(OptionError, match=said):
            process_of(path)
