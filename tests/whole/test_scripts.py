"""What a script sees first: quick imports, a headline, names of its own."""

import inspect
import subprocess
import sys

import pytest

from plan_cutters import Cutter, Options, plan, posture_map
from plan_cutters.errors import CutterError
from tests.support.forked import ENV
from tests.support.places import SAMPLES

HEAVY = ("OCP", "numba", "llvmlite", "scipy", "shapely", "pydantic", "matplotlib", "jinja2")


def test_names_are_imported_without_what_their_calls_need():
    """The kernel and the compiler are loaded with the first call."""
    script = "from plan_cutters import Cutter, Machine, Options, plan, posture_map; import sys; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", script], env=ENV, capture_output=True, text=True, check=True)
    loaded = {name.partition(".")[0] for name in done.stdout.split()}
    assert loaded & {*HEAVY} == set()
    assert "plan_cutters" in loaded


def test_calls_show_all_of_their_words():
    assert {*inspect.signature(Options).parameters} <= {*inspect.signature(plan).parameters}
    assert {"point", "cutter", "setup", "fixtures"} <= {*inspect.signature(posture_map).parameters}


@pytest.fixture(scope="module")
def result():
    named = {"Rougher": "D12L80", "Finisher": Cutter.flat(radius=2, length=30), "R3L50": "R3L50"}
    return plan(SAMPLES / "v_groove.step", cutters=named, grid=5, area_budget=0)


def test_a_result_is_printed_as_its_headline(result):
    assert str(result) == result.plan.text.headline == result.summary().splitlines()[0]
    assert repr(result).startswith("Result(Part(")


def test_names_of_cutters_are_those_of_the_script(result):
    assert {each.id: each.name for each in result.cutters} == {"R6L80": "Rougher", "R2L30": "Finisher", "R3L50": "R3L50"}
    assert result.names == {"R6L80": "Rougher D12", "R2L30": "Finisher D4", "R3L50": "flat end D6 x 50"}
    assert all(name in result.summary() for name in result.names.values())


def test_a_name_for_what_is_no_cutter():
    with pytest.raises(CutterError, match="R6"):
        plan(SAMPLES / "v_groove.step", cutters={"Finisher": "R6"})
