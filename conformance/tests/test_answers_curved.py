"""Each answer of the curved and freeform parts against points of the exact surface."""

import pytest

from conformance.made import balls, cones, freeform, rods, rounds
from conformance.tests.answers import wrong

#: Points of the exact surface take minutes for all of them.
pytestmark = pytest.mark.slow
CASES = [(part, k) for family in (balls, cones, rounds, rods, freeform) for part in family.PARTS for k in range(len(part.answers))]


@pytest.mark.parametrize(("part", "k"), CASES, ids=[f"{p.name}-{p.answers[k].kind}-{k}" for p, k in CASES])
def test_the_slow_twin_confirms_the_answer(part, k):
    assert wrong(part, part.answers[k]) == []
