"""Axes for simultaneous motion: what is written holds, what is forged is found."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plan_cutters import plan
from plan_cutters_check.bench import Bench
from plan_cutters_check.check import check
from plan_cutters_check.question import MachineAxes, Setup, axes_of, held
from plan_cutters_check.reckoned import Reckoned
from plan_cutters_check.records import document_of
from plan_cutters_check.surface import Clock
from plan_cutters_check.trials import placed
from tests.support.places import SAMPLES
from tests.support.written_plan import Written

PART = str(SAMPLES / "blade.step")
WORDS = {"cutters": "D4L40rc2", "machine": "trunnion-ac", "spacing": 8.0, "faces": "all"}


@pytest.fixture(scope="module")
def blade(tmp_path_factory):
    out = tmp_path_factory.mktemp("blade")
    plan(PART, operations="fastest", feed=1500, max_orientations=1, **WORDS).write(out, ["json", "npz"])
    return Written(out, PART, WORDS)


def answered(blade, arrays=None, document=None, seconds=1e6):
    return check(blade.question(document, arrays), seconds=seconds)


def placed_of(written, arrays=None):
    """The finding about operations that were put down at all their samples."""
    question = written.question(None, arrays)
    reckoned = Reckoned(question)
    (line,) = placed(reckoned, Bench(question, str), Clock(math.inf), str, document_of(reckoned)["operations"])
    return line


def told(answer, *words):
    return [each for each in answer.findings if all(word in each.words for word in words)]


@pytest.mark.slow("puts down every tool of a plan")
def test_what_is_written_holds(blade):
    answer = answered(blade)
    assert answer.holds, "\n".join(answer.lines)
    piece = blade.arrays["operations.npz"]["moving_piece"]
    assert (piece >= 0).sum() > 5


@pytest.mark.parametrize("how", ["long", "gone", "of another", "below none", "turned over", "all pieces"])
def test_what_is_forged_is_found(blade, how):
    document, arrays = blade.copies()
    forged = arrays["operations.npz"]
    axis, piece, label = (forged[name] for name in ("moving_axis", "moving_piece", "operation"))
    proved = np.flatnonzero(piece >= 0)
    fixed = np.flatnonzero(label == [each["mode"] for each in document["operations"]["plans"][0]["operations"]].index("fixed"))
    if how == "long":
        axis[proved[0]] *= 1.01
    elif how == "gone":
        axis[proved[0]] = np.nan
    elif how == "of another":
        piece[fixed[0]], axis[fixed[0]] = 0, [0.0, 0.0, 1.0]
    elif how == "below none":
        piece[proved[0]] = -2
    elif how == "turned over":
        # The machine tilts to 120 deg, and no farther.
        axis[proved[0]] = [0.0, 0.0, -1.0]
    else:
        next(each for each in document["operations"]["plans"][0]["operations"] if each["turning"])["turning"]["pieces_mm2"] = []
    answer = answered(blade, arrays, document, seconds=0.0)
    assert not answer.holds
    words = "cannot stand" if how == "turned over" else "axes for simultaneous motion"
    assert [each for each in told(answer, words) if each.holds is False], answer.lines


def test_an_axis_at_which_the_tool_gouges_is_found_by_putting_it_placed_of(blade):
    fair = placed_of(blade)
    assert fair.holds
    assert "; at 0 the tool is too deep" in fair.words
    _, arrays = blade.copies()
    forged, normal = arrays["operations.npz"], arrays["samples.npz"]["normal"]
    proved = np.flatnonzero(forged["moving_piece"] >= 0)
    # Away from the surface, where the machine can hold it: the shank goes through the blade.
    axis = -normal[proved]
    able = held(blade.question().machine, blade.question().setups[0], axis)
    assert able.any()
    forged["moving_axis"][proved[able]] = axis[able]
    line = placed_of(blade, arrays)
    assert line.holds is False
    assert f"at {able.sum()} the tool is too deep" in line.words


@given(seed=st.integers(0, 2**32 - 1))
def test_the_machine_holds_an_axis_where_some_of_its_angles_give_it(seed):
    rng = np.random.default_rng(seed)
    direction, tool = rng.standard_normal((2, 3)), rng.standard_normal(3)
    direction /= np.linalg.norm(direction, axis=1)[:, None]
    limits = np.sort(rng.uniform(-4.0, 4.0, (2, 2)), axis=1)
    machine = MachineAxes(("A", "B"), direction, limits, tool / np.linalg.norm(tool), math.pi, False)
    setup = Setup(tuple(rng.standard_normal(3)), tuple(rng.standard_normal(3)), None, (), frozenset())
    inside = np.degrees(rng.uniform(limits[:, 0], limits[:, 1], (20, 2)))
    assert held(machine, setup, axes_of(machine, setup, inside)).all()
    axis = rng.standard_normal((10, 3))
    axis /= np.linalg.norm(axis, axis=1)[:, None]
    every = np.degrees(np.stack(np.meshgrid(*(np.linspace(*each, 80) for each in limits)), axis=-1).reshape(-1, 2))
    nearest = (axes_of(machine, setup, every) @ axis.T).max(axis=0)
    holds, step = held(machine, setup, axis), math.cos(1.5 * float(np.diff(limits).max()) / 79)
    assert (nearest[holds] >= step).all()
    # What a fine grid comes as near to as its own step may lie a hair beyond a limit.
    assert not holds[nearest < step].any()


@pytest.fixture(scope="module")
def leaning(tmp_path_factory):
    """A blade that a bull nose cuts as a whole with simultaneous motion, leaning as little as its passes want."""
    out = tmp_path_factory.mktemp("leaning")
    words = {**WORDS, "cutters": "D10L60rc1", "holder": "er16"}
    plan(PART, operations="fastest", feed=1500, area_budget=0, **words).write(out, ["json", "npz"])
    return Written(out, PART, words)


def test_every_axis_of_wide_passes_stands_free_by_another_program(leaning):
    arrays = leaning.arrays["operations.npz"]
    label, axis = arrays["operation"], arrays["moving_axis"]
    modes = [each["mode"] for each in leaning.document["operations"]["plans"][0]["operations"]]
    moved = label == modes.index("simultaneous")
    assert np.isfinite(axis[moved]).all()
    # These are others than those of the verdicts.
    found = leaning.arrays["samples.npz"][f"axis_{leaning.document['cutters'][0]['id']}"]
    assert (np.abs(axis - found).max(axis=1)[moved] > 1e-3).mean() > 0.5
    line = placed_of(leaning)
    assert line.holds, line.words
    assert f"put down at {(label >= 0).sum()} samples; at 0 " in line.words


def test_an_axis_that_is_not_free_is_found_though_nothing_is_proved_about_it(leaning):
    _, arrays = leaning.copies()
    forged, normal = arrays["operations.npz"], arrays["samples.npz"]["normal"]
    axis = -normal
    able = np.flatnonzero(held(leaning.question().machine, leaning.question().setups[0], axis) & (forged["operation"] >= 0))[:20]
    forged["moving_axis"][able] = axis[able]
    line = placed_of(leaning, arrays)
    assert line.holds is False
    assert f"at {len(able)} the tool is too deep" in line.words
