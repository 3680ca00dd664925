"""Advice that a shop can follow: usual stick-outs, sold cutters of the same kind, and options that keep their word."""

from types import SimpleNamespace

import pytest

from cad_io import read_part
from plan_cutters import Cutter, plan
from plan_cutters.answers.steps import worth
from plan_cutters.domain.dimensions import is_spec
from plan_cutters.domain.standard_tools import INCH, METRIC, MOST, slenderness
from tests.support import shapes
from tests.support.advice import answered, asked, followed, left, steps_of, strip, wall
from tests.support.cad_parts import box, cut, real
from tests.support.places import SAMPLES

SIZES = {round(each.diameter, 6) for each in (*METRIC, *INCH)}


def usual(result):
    """That each cutter of each step that is not given is sold, is held as usual, and is of the kind of one that is given."""
    given = {c.id: c for c in result.ready.cutters}
    kinds = {kind(each) for each in given.values()}
    longest = max([MOST, *map(slenderness, given.values())])
    for entry in [c for c in result.cutters if c.mend]:
        for step in entry.mend.steps:
            for name in set(step.cutters) - set(given):
                made = result_cutter(name)
                assert round(2.0 * made.radius, 6) in SIZES | {round(2.0 * each.radius, 6) for each in given.values()}
                assert slenderness(made) <= longest + 1e-9
                assert kind(made) in kinds or kinds == {"flat"}


def result_cutter(name):
    assert is_spec(name)
    return Cutter.parse(name)


def kind(cutter):
    return "flat" if not cutter.corner_radius else "ball" if cutter.corner_radius == cutter.radius else "bull"


DEEP = ("--cutter", "D6L25F10S6", "--holder", "D30L200", "--faces", "F1", "--grid", "5", "--tilt", "0:0")


def test_a_stick_out_that_nobody_uses_is_not_advised():
    """Beside a wall of 200 mm the holder would have to stand 33 diameters out."""
    result = asked(shapes.shell(strip(0, 7), wall(-4, 200, 1)), *DEEP)
    assert not any("a stick-out of" in line for line in answered(result.plan))
    usual(result)


def test_a_stick_out_of_more_than_five_diameters_says_so():
    result = asked(shapes.shell(strip(0, 7), wall(-4, 52, 1)), *DEEP)
    (step,) = [each for each in steps_of(result) if [change.thing for change in each.changes] == ["stick_out"]]
    assert step.changes[0].asked == 55.0
    assert step.why == "a stick-out of 55 mm (9.17 D, more than the usual 5 D) instead of 25 mm"
    usual(result)
    again = followed(shapes.shell(strip(0, 7), wall(-4, 52, 1)), step, *DEEP)
    assert left(again, step) == pytest.approx(step.lost_after, abs=1e-12)


def test_one_that_is_held_farther_out_already_is_held_no_farther():
    words = ("--cutter", "D6L80F10S6", *DEEP[2:])
    result = asked(shapes.shell(strip(0, 7), wall(-4, 200, 1)), *words)
    assert not any("a stick-out of" in line for line in answered(result.plan))
    usual(result)


def test_a_ball_stays_a_ball_and_its_size_is_sold():
    """On free-form faces: no flat end, no corner for it, and no flat end of the drawer either."""
    words = ("--cutter", "D12L60rc6F26S12", "--cutter", "D4L20F11S4", "--holder", "er20", "--grid", "15")
    result = asked(SAMPLES / "peaks_and_valleys.step", *words)
    ball = next(c for c in result.cutters if c.id.startswith("R6"))
    assert ball.mend.lost_share > 0.01
    steps = [step for step in ball.mend.steps if len(step.cutters) > 1]
    assert steps
    for step in steps:
        assert all(kind(result_cutter(name)) == "ball" for name in step.cutters)
    assert not any(change.thing == "corner_radius" for step in ball.mend.steps for change in step.changes)
    usual(result)


def test_what_frees_next_to_nothing_is_no_advice():
    """A slit of 0.8 mm2 in a top of 640 mm2."""
    part = read_part(cut(box(16, 40, 10), box(0.02, 60, 5, at=(7.99, -10, 5))))
    every = plan(part, cutters="R3L40", faces="all", grid=2, area_budget=0).samples
    up = every.normal[:, 2] > 0.5
    faces = ",".join(f"F{n}" for n in sorted({int(n) for n in every.face[up]}))
    (entry,) = asked(part, "--cutter", "D6L40", "--faces", faces, "--grid", "5").cutters
    assert 0.0 < entry.area_share.inaccessible + entry.area_share.undecided < 0.002
    assert entry.mend.steps == []
    assert "too little for advice" in entry.mend.why


@pytest.mark.parametrize(("area", "gain", "told"), [(500.0, 0.0015, False), (500.0, 0.0025, True), (1e5, 0.0005, False)])
def test_a_gain_is_advice_from_a_thousandth_and_a_square_millimetre_on(area, gain, told):
    assert worth(SimpleNamespace(whole=area), gain) == told


def test_a_holder_that_is_advised_is_one_of_the_table_and_takes_the_shank():
    words = ("--cutter", "D6L20F10S6", "--holder", "er32", "--faces", "F1", "--grid", "5", "--tilt", "0:0")
    part = shapes.shell(shapes.plane((0, 40), (-60, 60), (0, 0, 0)), wall(-4, 30, 1))
    result = asked(part, *words)
    (step,) = [each for each in steps_of(result) if [change.thing for change in each.changes] == ["holder"]]
    assert step.why in ("the holder ER25 instead of ER32", "the holder ER20 instead of ER32", "the holder ER16 instead of ER32",
                        "the holder ER11 instead of ER32")  # fmt: skip
    assert "Her" in step.option
    assert left(followed(part, step, *words), step) == pytest.approx(step.lost_after, abs=1e-12)
    usual(result)


def brackets(part, *words, most=2, has=(), folder=""):
    """How many options were followed: each leaves what it says of the same area, within half a point."""
    result, count = asked(part, *words, folder=folder), 0
    usual(result)
    area = sum(face.area_mm2 for face in result.plan.faces if face.target)
    for entry in [c for c in result.cutters if c.mend]:
        for step in [each for each in steps_of(result, entry.id) if each.option][:most]:
            assert all(word in step.option for word in has)
            again = followed(part, step, *words)
            assert left(again, step) == pytest.approx(step.lost_after, abs=0.005)
            assert sum(face.area_mm2 for face in again.plan.faces if face.target) == pytest.approx(area)
            count += 1
    return count


#: Two setups are proposed for a block with a slot, and the tool is too thick and too short for the slot.
SLOT = ("--cutter", "D12L60rc1F26S12", "--holder", "er20", "--machine", "trunnion-ac", "--setup", "auto", "--faces", "all",
        "--spacing", "12")  # fmt: skip


def slotted():
    return read_part(cut(box(60, 60, 40), box(5, 40, 20, at=(28, 10, 20))))


@pytest.mark.slow("plans again for each answer")
def test_with_a_proposed_setup_the_option_names_it(tmp_path):
    """Another cutter might make `auto` choose otherwise: the files of the setups, their tables in them, stand in the option."""
    files = [tmp_path / f"setup-{number}.toml" for number in (1, 2)]
    assert brackets(slotted(), *SLOT, most=1, has=[f"--setup {file}" for file in files], folder=tmp_path) == 1
    assert all('"vise:' in file.read_text() for file in files)
    assert sorted(file.name for file in tmp_path.iterdir()) == ["plan.json", "process.toml", "setup-1.toml", "setup-2.toml"]


@pytest.mark.slow("plans again for each answer")
def test_with_several_proposed_setups_in_no_file_no_option_is_said_that_would_not_keep_its_word():
    """Another cutter might make `auto` choose otherwise, and no option says that each setup stands on a table of its own."""
    result = asked(slotted(), *SLOT)
    assert len(result.plan.setup_proposal.setups) > 1
    (entry,) = result.cutters
    steps = steps_of(result, entry.id)
    assert steps
    assert not any(step.option for step in steps)
    usual(result)


HARD = {
    "hard/gmsh_pump_carter_sup.stp": ("--cutter", "D16L60F32S16", "--holder", "er25", "--machine",
                                 "trunnion-ac", "--setup", "auto", "--spacing", "14", "--faces", "all"),
    "hard/jack_phone.igs": ("--cutter", "D8L40rc4F16S8", "--cutter", "D4L35rc2F12S6", "--holder", "er20",
                            "--machine", "trunnion-ac", "--spacing", "4"),
}  # fmt: skip


@pytest.mark.slow("plans real parts for each answer")
@pytest.mark.parametrize("file", real(*HARD), ids=lambda path: path.stem)
def test_what_a_bracket_says_is_true_on_real_parts(file, tmp_path):
    assert brackets(read_part(file), *HARD[f"hard/{file.name}"], folder=tmp_path) > 0
