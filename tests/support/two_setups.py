"""A cube that two setups hold differently: each with jaws of its own, and the face on the table clamped."""

import numpy as np

from plan_cutters import plan
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.placement import Placement

HOW = {"cutters": "R2L40rc2", "faces": "all", "grid": 5, "area_budget": 0}
UP, DOWN = (0.0, 0.0, 1.0), (0.0, 0.0, -1.0)
#: Jaws beside a cube of 10 mm, on its sides across x, up to its middle; and the same upside down.
LOWER = tuple(Fixture.parse(f"box:20,30,25@{x},-10,-20") for x in (10, -20))
UPPER = tuple(Fixture.parse(f"box:20,30,25@{x},-10,5") for x in (10, -20))


def faces_at(found):
    """Number of the face of each direction."""
    return {tuple(np.round(found.samples.normal[found.samples.face == n][0]).astype(int).tolist()): n
            for n in np.unique(found.samples.face).tolist()}  # fmt: skip


def name_of(part, normal):
    return f"F{faces_at(plan(part, **HOW))[normal]}"


def two(part, **more):
    bottom, top = name_of(part, (0, 0, -1)), name_of(part, (0, 0, 1))
    first = Placement(UP, clamped=(bottom,), fixtures=(*LOWER, Fixture.parse("table")))
    other = Placement(DOWN, clamped=(top,), fixtures=(*UPPER, Fixture.parse("table")))
    return plan(part, setup=first, other_setups=[other], **{**HOW, **more})
