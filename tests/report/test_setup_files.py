"""Proposed setups as files: `--setup` reads what is written, and a run that has read them leaves them where they are."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plan_cutters import plan
from plan_cutters.domain.fixture import Fixture
from plan_cutters.plan_file.part_info import ProposedSetup, SetupProposal
from plan_cutters.report.folder import stale_files
from plan_cutters.report.process_file import setup_toml
from plan_cutters.setups.files import read_setup
from tests.support.places import SAMPLES

PART = SAMPLES / "v_groove.step"
unit = (
    st.tuples(*[st.floats(-1, 1)] * 3)
    .filter(lambda v: np.linalg.norm(v) > 1e-3)
    .map(lambda v: tuple((np.array(v) / np.linalg.norm(v)).tolist()))
)


@given(axis=unit, faces=st.lists(st.integers(1, 999).map("F{}".format), max_size=3))
def test_a_setup_is_read_as_it_was_proposed(tmp_path_factory, axis, faces):
    file = tmp_path_factory.getbasetemp() / "setup-1.toml"
    file.write_text(setup_toml(ProposedSetup(axis=axis, stands_on=faces, promised=1.0)), encoding="utf-8")
    placed = read_setup(file)
    assert np.allclose(placed.z, axis, rtol=0.0, atol=1e-12)
    assert placed.clamped == tuple(faces)
    assert placed.fixtures == (Fixture.parse("table"),)


@pytest.fixture
def proposed(tmp_path):
    """A folder with a plan whose one setup was proposed."""
    result = plan(PART, cutters="R6L80", grid=3, area_budget=0)
    setup = ProposedSetup(axis=(0.0, 0.0, 1.0), stands_on=[], promised=1.0)
    entry = SetupProposal(setups=[setup], directions=1, searched=1, samples=1, promised=1.0, found=1.0, kept=1.0, held=True,
                          tried=1, why="")  # fmt: skip
    document = result.plan.model_copy(update={"setup_proposal": entry})
    replace(result, plan=document).write(tmp_path, ("json",))
    assert sorted(each.name for each in tmp_path.iterdir()) == ["plan.json", "process.toml", "setup-1.toml"]
    return tmp_path


def test_a_plan_in_a_setup_of_its_own_folder_leaves_that_there(proposed):
    """So that the same command finds it again."""
    words = (proposed / "setup-1.toml").read_bytes()
    for _ in range(2):
        result = plan(PART, cutters="R6L80", grid=3, area_budget=0, setup=str(proposed / "setup-1.toml"))
        document = result.write(proposed, ("json",))
        assert (proposed / "setup-1.toml").read_bytes() == words
        assert stale_files(proposed, document, ("json",)) == []


def test_a_plan_without_it_takes_it_away(proposed):
    plan(PART, cutters="R6L80", grid=3, area_budget=0).write(proposed, ("json",))
    assert sorted(each.name for each in proposed.iterdir()) == ["plan.json", "process.toml"]
