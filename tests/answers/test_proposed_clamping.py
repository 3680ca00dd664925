"""Setups that are proposed in a vise or chuck: what holds the part there, why, and the file that says it again."""

import numpy as np
import pytest

from plan_cutters import plan
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.verdicts import ANOTHER_SETUP
from plan_cutters.errors import OptionError
from plan_cutters.machines.setups import read_setup
from plan_cutters.plan_file.words.story import story_of
from plan_cutters.report.setup_files import setup_toml
from tests.support.cad_parts import ball, box, rod

HOW = {"cutters": "R2L60rc2HR15L30", "faces": "all", "grid": 7, "area_budget": 0, "machine": "trunnion-ac", "setup": "auto"}


@pytest.fixture(scope="module")
def held():
    return plan(box(40, 30, 20), fixtures="vise", **HOW)


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


def test_auto_takes_what_serves_most_and_says_what_the_others_do():
    found = plan(box(40, 30, 20), fixtures="auto", **HOW)
    (setup, *_) = found.plan.setup_proposal.setups
    assert setup.clamping == "vise"
    assert setup.why_held.startswith("of these samples' area vise ")
    assert "table" in setup.why_held
    assert "a chuck has nothing to grip" in setup.why_held
    round_ = plan(rod(12, 40), fixtures="auto", **HOW)
    clamped = {each.clamping for each in round_.plan.setup_proposal.setups}
    assert "chuck" in clamped
    assert "vise" not in clamped
    nothing = plan(ball(), fixtures="auto", **HOW)
    assert {each.clamping for each in nothing.plan.setup_proposal.setups} == {"table"}


def test_a_table_is_proposed_where_nothing_is_said_and_may_be_said():
    one, other = plan(box(), **HOW), plan(box(), fixtures="table", **HOW)
    assert one.plan.setup_proposal == other.plan.setup_proposal
    assert one.plan.setup_proposal.setups[0].fixtures == ["table"]
    assert "--fixture auto tries a vise and a chuck" in one.plan.setup_proposal.why


def test_where_no_vise_holds_the_part_one_line_says_so():
    with pytest.raises(OptionError, match="nothing to grip") as caught:
        plan(ball(), fixtures="vise", **HOW)
    assert "\n" not in str(caught.value)


def test_setups_named_behind_auto_bring_what_holds_them(tmp_path, held):
    """What `--fixture auto` asked for falls away with `auto`: the files say how the part is held."""
    from tests.support.forked import run
    from tests.support.places import SAMPLES

    file = tmp_path / "setup-1.toml"
    file.write_text('unit = "mm"\naxis = [0, 0, 1]\nfixtures = ["vise"]\n', encoding="utf-8")
    for order in ([0, 1, 2], [1, 0, 2], [0, 2, 1]):
        words = [("--setup", "auto"), ("--fixture", "auto"), ("--setup", str(file))]
        ordered = [word for k in order for word in words[k]]
        done = run(SAMPLES / "pocket_top.step", "--cutter", "R5L60", *ordered, "--spacing", "8", "--area-budget", "0",
                   "--json", "-", "--quiet", cwd=tmp_path)  # fmt: skip
        assert '"clamping": "vise:' in done.stdout, done.stderr
        assert done.stdout.count('"name": "fixture:') == 1
