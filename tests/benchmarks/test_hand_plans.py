"""Minutes of cutting beside hand plans of an independent program: within a tenth of each, or off for a reason that is stated."""

import importlib
import sys

import pytest

from tests.support.places import ROOT

pytestmark = pytest.mark.slow("plans the parts whose plans were worked out by hand")
#: Parts that take another share of the hand plan's minutes, from and to, and why.
OTHERWISE = {
    "six pins of radius 2": (0.75, 0.9, "by hand a first pass goes round each pin on the floor, and its wall is run as well"),
    "mould half": (0.6, 0.75, "the flat end, tilted, cuts the dish quicker than the ball"),
}


@pytest.fixture(scope="module")
def hand_plans():
    sys.path.insert(0, str(ROOT / "benchmarks"))
    try:
        yield importlib.import_module("hand_plans")
    finally:
        sys.path.remove(str(ROOT / "benchmarks"))


@pytest.mark.parametrize("kind", ["blocks", "leaning", "narrow", "pockets", "curved"])
def test_cutting_takes_what_the_paths_of_the_centre_say(hand_plans, kind, tmp_path):
    """Arcs about sharp outer corners, in which nothing is cut, count for the hand plan or not, as shops differ."""
    off = []
    for case in getattr(hand_plans, kind)():
        seconds = hand_plans.cut_seconds(hand_plans.planned(case, tmp_path))
        low, high, _ = OTHERWISE.get(case.name, (0.9, 1.1, ""))
        without = (case.path.length - case.path.corners) / hand_plans.FEED
        if not low * without <= seconds <= high * case.path.seconds:
            off.append((case.name, seconds / case.path.seconds, seconds / without))
    assert not off
