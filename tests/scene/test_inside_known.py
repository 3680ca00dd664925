"""In which bodies samples lie: what is known of a part's bodies holds in each of its setups."""

import numpy as np
import pytest

from plan_cutters.answers.state import on_table
from plan_cutters.options import Options
from plan_cutters.pipeline import prepare
from plan_cutters.scene.inside_material import inside_material
from tests.support.cad_parts import box, compound, rod
from tests.support.places import real_file


def impeller():
    return real_file("cad/hard/turbo3d_impeller.step")


def crossing():
    """Two blocks that overlap, and a rod through both."""
    return compound(box(30, 20, 20), box(20, 20, 30, at=(15, 5, 0)), rod(4, 60, at=(20, 10, -10)))


@pytest.fixture(scope="module", params=[crossing, pytest.param(impeller, marks=pytest.mark.slow("prepares a large real file"))])
def ready(request):
    options = Options.of({"cutters": "R3L40", "faces": "all", "grid": 4, "fixtures": "table", "machine": "trunnion-ac"})
    return prepare(request.param(), options)


@pytest.mark.parametrize("axis", [(0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, -0.6, 0.8)])
def test_another_setup_finds_what_all_bodies_tell(ready, axis):
    """Bodies of the part overlap, and each table holds other faces."""
    assert (ready.inside >= 0).any()
    there = on_table(ready, axis)
    surroundings, conditions = there.conditions.surroundings, there.conditions
    whole = inside_material(ready.samples, ready.scene.orientation, surroundings.enclosing, surroundings.certain,
                            conditions.tolerance)  # fmt: skip
    assert np.array_equal(there.inside, whole)
