"""Long work tells how far it is, again and again: a bar moves, and who listens can end it there."""

from itertools import pairwise

import pytest

from plan_cutters import plan
from plan_cutters.operations.planning import _PARTS
from tests.support.places import SAMPLES

OPTIONS = {"cutters": ("R6L80", "R2L30"), "grid": 3, "operations": "both", "feed": 1000.0, "area_budget": 20}
#: What may be repeated, the first table, the plans and their proof: one orientation does here, so nothing is to be refined.
REPEATS, TABLE, PLANS, PROOF = range(_PARTS)


def test_every_part_of_the_operations_tells_its_own():
    every = []
    plan(SAMPLES / "v_groove.step", progress=lambda *each: every.append(each), **OPTIONS)
    told = [done / total for stage, done, total in every if stage == "operations"]
    inside = told[1:-1]
    assert (told[0], told[-1]) == (0.0, 1.0)
    assert all(one <= other for one, other in pairwise(inside))
    for part in (REPEATS, TABLE, PLANS, PROOF):
        assert any(part / _PARTS < each <= (part + 1) / _PARTS for each in inside), part
    assert any(0 < done < total for stage, done, total in every if stage == "area")


@pytest.mark.slow("another moment of the same law", but=("2",))
@pytest.mark.parametrize("part", [PLANS, PROOF])
def test_who_listens_may_end_it_there(part):
    heard = []

    def ends(stage, done, total):
        if stage == "operations" and total > 1 and done / total > part / _PARTS:
            heard.append(done / total)
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        plan(SAMPLES / "v_groove.step", progress=ends, **OPTIONS)
    assert len(heard) == 1
    assert heard[0] <= (part + 1) / _PARTS
