"""Which cutters a plan of operations must have compared, as the checker reckons it."""

import numpy as np
import pytest

from plan_cutters_check.reckoned import considered

IDS = ["ball", "flat", "small"]
KINDS = {"ball": "ball", "flat": "flat", "small": "ball"}
ALL = dict.fromkeys(IDS, np.ones(4, bool))


@pytest.mark.parametrize(
    ("reached", "tried", "wanted"),
    [
        (ALL, None, IDS),
        (ALL, set(IDS), IDS),
        # The kind of the flat end comes last, and the others reach all without it.
        (ALL, {"ball", "small"}, ["ball", "small"]),
        # One of a kind that is needed must have been compared.
        (ALL, {"ball"}, ["ball", "small"]),
        # It reaches something that no other one does.
        (ALL | {"ball": np.arange(4) > 0, "small": np.arange(4) > 1}, {"ball", "small"}, IDS),
    ],
)
def test_a_kind_that_comes_last_may_be_left_out_where_the_others_reach_all(reached, tried, wanted):
    document = {
        "effective": {}, "operations": {"assumed": {"feed_mm_min": None}}, "least_set": {"runs": [{"cutter": "ball"}]},
        "cutters": [{"id": each, "group": KINDS[each]} for each in IDS],
    }  # fmt: skip
    assert considered(document, IDS, reached, tried) == wanted
