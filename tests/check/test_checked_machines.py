"""Plans of machines of no and of one rotary axis: the checker accepts them, and finds axes and angles that are forged."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plan_cutters import Axis, Machine
from plan_cutters_check.asking import machine_axes
from plan_cutters_check.check import check
from plan_cutters_check.question import Setup, allowed, axes_of, held
from tests.support.written_plan import PART, WORDS, Written, write

#: A head that leans about Y, off the machine's axes.
HEAD = Machine("head", axes=(Axis.rotary("B", "tool", (0.0, 1.0, 0.2), limits_deg=(-70.0, 95.0), rate_deg=20.0),))
MACHINES = ("3-axis", "4-axis-a", HEAD)


@pytest.fixture(scope="module", params=MACHINES, ids=lambda machine: getattr(machine, "name", machine))
def written(request, tmp_path_factory):
    words = WORDS | {"machine": request.param, "tilt": None, "other_setups": [(0.0, 1.0, 0.0)], "grid": 2}
    out = tmp_path_factory.mktemp("machine")
    write(out, words)
    return Written(out, PART, words)


def test_a_plan_holds(written):
    answer = check(written.asked(), seconds=1e6)
    assert answer.holds, "\n".join(answer.lines)


def test_other_angles_and_other_axes_are_found(written):
    names, rotary = written.document["operations"]["rotary"], written.document["machine"]["rotary"]
    assert names == [each["name"] for each in rotary]
    document, arrays = written.copies()
    fixed = next(each for each in document["operations"]["plans"][0]["operations"] if each["mode"] == "fixed")
    if names:
        fixed["angles_deg"] = {names[0]: fixed["angles_deg"][names[0]] + 7.0}
    else:
        fixed["axis"] = [0.0, math.sin(0.1), math.cos(0.1)]
    assert not check(written.asked(document, arrays), seconds=1e6).holds
    document, arrays = written.copies()
    document["machine"]["rotary"] = None
    assert not written.read(document, arrays).holds


@given(st.sampled_from(MACHINES), st.floats(-math.pi, math.pi), st.floats(-1.0, 1.0), st.floats(-200.0, 200.0))
def test_what_a_machine_holds_is_what_its_axis_turns_to(machine, turn, z, degrees):
    """Those of its own angles within limits, and no axis beside its circle; as the program has it by other formulas."""
    machine = Machine.of(machine)
    axes, setup = machine_axes(machine), Setup((0.0, 0.0, 1.0), None, None, (), frozenset())
    angle = np.full((1, len(axes.names)), degrees)
    own, other = (
        axes_of(axes, setup, angle),
        np.array([[math.sqrt(1 - z * z) * math.cos(turn), math.sqrt(1 - z * z) * math.sin(turn), z]]),
    )
    for axis in (own, other):
        assert held(axes, setup, axis).tolist() == machine.allows(axis, np.eye(3)).tolist()
    if allowed(axes, setup, angle).all():
        assert held(axes, setup, own).all()


def test_counts_of_verdicts_over_all_setups_are_exact(written):
    """A sample more that is accessible, and one fewer that is not: the sums agree, the samples do not."""
    document, arrays = written.copies()
    document["cutters"][0]["accessible"] += 1
    document["cutters"][0]["inaccessible"] -= 1
    answer = check(written.asked(document, arrays), seconds=1e6)
    assert not answer.holds
    assert any("cutters[0].accessible" in line for line in answer.lines)
