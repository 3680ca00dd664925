"""Setups that are proposed in a vise or chuck: what holds the part there, why, and the file that says it again."""

import click
import numpy as np
import pytest

from plan_cutters import plan
from plan_cutters.answers.holding import Held, best_hold
from plan_cutters.command.validation import fixtures_of_setups
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.verdicts import ANOTHER_SETUP
from plan_cutters.errors import OptionError
from plan_cutters.plan_file.words.headline import proposal
from plan_cutters.plan_file.words.text import story_of
from plan_cutters.report.process_file import setup_toml
from plan_cutters.setups.files import read_setup
from tests.support.cad_parts import ball, box, rod

HOW = {"cutters": "R2L60HR15L30", "faces": "all", "grid": 4, "area_budget": 0, "machine": "trunnion-ac", "setup": "auto",
       "stock": "part"}  # fmt: skip
#: The same with a ball, as the slow ones ask.
BALL = {**HOW, "cutters": "R2L60rc2HR15L30", "grid": 7}


@pytest.fixture(scope="module")
def held():
    return plan(box(40, 30, 20), fixtures="vise", **HOW)


@pytest.mark.slow("plans parts whole")
def test_each_proposed_setup_has_a_vise_placed_for_it(held):
    said = held.plan.setup_proposal
    assert said.held
    assert [each.clamping for each in said.setups] == ["vise"] * len(said.setups)
    assert [each.name for each in held.plan.fixtures] == ["fixture:vise"] * len(said.setups)
    for setup, entry in zip(said.setups, held.plan.fixtures, strict=True):
        assert len(setup.grips) == 2
        assert set(setup.grips).isdisjoint(setup.stands_on)
        assert setup.fixtures == [entry.clamping]
        assert not setup.why_held


def test_what_the_jaws_hide_is_left_for_another_setup_and_named(held):
    (name,) = held.reaches
    verdicts = held.reaches[name]
    left = {each.cause: each for each in held.plan.process.left}
    assert "fixture" not in left
    if verdicts.not_reached.any():
        assert (verdicts.reason[verdicts.not_reached] == ANOTHER_SETUP).any()
        assert set(left["another_setup"].faces) & set(held.plan.setup_proposal.setups[0].grips)
    assert " grips F" in story_of(held.plan).proposal[0]


def test_the_setup_file_is_the_same_clamping_again(held, tmp_path):
    files = []
    for number, setup in enumerate(held.plan.setup_proposal.setups, 1):
        file = tmp_path / f"setup-{number}.toml"
        file.write_text(setup_toml(setup), encoding="utf-8")
        assert "the vise grips F" in file.read_text(encoding="utf-8")
        (fixture,) = read_setup(file).fixtures
        assert fixture == Fixture.parse(setup.fixtures[0])
        files.append(str(file))
    again = plan(box(40, 30, 20), **{**HOW, "setup": files[0], "other_setups": files[1:]})
    for one, other in zip(held.plan.fixtures, again.plan.fixtures, strict=True):
        assert (one.clamping, one.placement, one.triangles) == (other.clamping, other.placement, other.triangles)
    (name,) = held.reaches
    assert np.array_equal(held.reaches[name].verdict, again.reaches[name].verdict)


@pytest.mark.slow("plans each proposed clamping", but=("block",))
@pytest.mark.parametrize(
    ("shape", "how", "taken", "why"),
    [
        (box(40, 30, 20), HOW, {"vise"}, "a chuck has nothing to grip (no outside cylinder"),
        (rod(12, 40), BALL, {"chuck"}, "a vise has nothing to grip (no two opposite plane faces"),
        (ball(), BALL, {"table"}, "a vise has nothing to grip"),
    ],
    ids=["block", "bar", "ball"],
)
def test_what_grips_the_part_is_proposed_and_a_table_where_nothing_does(shape, how, taken, why):
    said = plan(shape, **how).plan.setup_proposal
    first = said.setups[0]
    assert {each.clamping for each in said.setups} <= {*taken, "table"}
    assert first.clamping in taken
    assert f"the {first.clamping} serves " in first.why_held
    assert why in first.why_held
    assert bool(first.hidden_mm2) == bool(first.grips) == bool(first.how_held) == (first.clamping != "table")


@pytest.mark.slow("plans each proposed clamping")
def test_a_block_lies_on_its_largest_faces():
    """Upright it would show more of itself in each setup, and as much in both: it lies low all the same."""
    found = plan(box(80, 50, 40), **BALL)
    said = found.plan.setup_proposal
    assert sorted(each.axis for each in said.setups) == [(0.0, 0.0, -1.0), (0.0, 0.0, 1.0)]
    assert said.promised == 1.0
    # What the one stands on and grips, the other one machines.
    for own, setup in enumerate(said.setups):
        (left,) = setup.left_for
        assert left.setup == 1 - own
        assert set(setup.stands_on) <= set(left.faces) <= {*setup.stands_on, *setup.grips}
    assert f"what it hides of {', '.join(said.setups[0].left_for[0].faces)} is machined in setup 2" in proposal(found.plan)[1]


@pytest.mark.slow("plans each proposed clamping")
def test_of_table_vise_and_chuck_one_may_be_requested():
    said = plan(box(), **BALL, fixtures="table").plan.setup_proposal
    assert {each.clamping for each in said.setups} == {"table"}
    assert said.setups[0].fixtures == ["table"]
    assert not said.setups[0].why_held


def test_a_table_is_taken_where_jaws_hide_too_much():
    area = np.array([1.0, 1.0, 1.0, 1.0])
    table, vise = (
        Held(Fixture.parse("table"), area > 0),
        Held(Fixture.parse("vise:46x25x65:3:40@1,0,0"), np.arange(4) > 0, (1, 2)),
    )
    assert best_hold([table, vise], {}, area).kind == "table"
    assert best_hold([table, vise], {}, np.array([0.2, 1.0, 1.0, 1.0])).kind == "vise"
    assert "the vise serves 75 %" in best_hold([table, vise], {"chuck": "none"}, area).why


@pytest.mark.slow("plans parts whole")
def test_where_no_vise_holds_the_part_one_line_says_so():
    with pytest.raises(OptionError, match="nothing to grip") as caught:
        plan(ball(), fixtures="vise", **HOW)
    assert "\n" not in str(caught.value)


@pytest.mark.slow("plans parts whole")
def test_setups_named_behind_auto_bring_what_holds_them(tmp_path, held):
    """What `--fixture` asked for falls away with `auto`, and that is told: the files say how the part is held."""
    from tests.support.forked import run
    from tests.support.places import SAMPLES

    file = tmp_path / "setup-1.toml"
    file.write_text('unit = "mm"\naxis = [0, 0, 1]\nfixtures = ["vise"]\n', encoding="utf-8")
    for order in ([0, 1, 2], [1, 0, 2], [0, 2, 1]):
        words = [("--setup", "auto"), ("--fixture", "chuck"), ("--setup", str(file))]
        ordered = [word for k in order for word in words[k]]
        done = run(SAMPLES / "pocket_top.step", "--cutter", "R5L60", *ordered, "--spacing", "8", "--area-budget", "0",
                   "--json", "-", "--quiet", cwd=tmp_path)  # fmt: skip
        assert '"clamping": "vise:' in done.stdout, done.stderr
        assert done.stdout.count('"name": "fixture:') == 1
        assert done.stderr.count("--fixture chuck is left out") == 1


@pytest.mark.slow("plans each proposed clamping")
def test_a_vise_stays_where_what_is_named_behind_auto_says_nothing_of_it(tmp_path):
    bare = tmp_path / "bare.toml"
    bare.write_text('unit = "mm"\naxis = [0, 0, 1]\n', encoding="utf-8")
    context = click.Context(click.Command("plan"))
    for named, texts, left in [
        (((0.0, 0.0, 1.0),), ("vise",), ("vise",)),
        ((str(bare),), ("vise",), ("vise",)),
        (((0.0, 0.0, 1.0),), ("vise", "vise:46x25x65:3:40@1,0,0"), ("vise:46x25x65:3:40@1,0,0",)),
        (((0.0, 0.0, 1.0),), ("clamp.step", "table"), ("clamp.step", "table")),
    ]:
        context.meta["plan_cutters.named_setups"] = named
        assert fixtures_of_setups(context, None, texts) == left
