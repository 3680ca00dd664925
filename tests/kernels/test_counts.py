"""How much work a search does, in numbers that no machine changes: calls of each kernel, counted without the compiler.

The kernels run as the plain Python they are written in, with a counter around each; the product knows nothing of it.
"""

import numpy as np
import pytest

from plan_cutters.domain.verdicts import blank
from plan_cutters.kernels import material
from plan_cutters.kernels.search import search
from plan_cutters.scene.conditions import verdict_arrays_of
from tests.support import waves
from tests.support.counted import counted

#: Samples without a posture among the tilts that curvature allows are searched among the others, too (decision 19).
#: What the searches below cost together, at most. Lower is better: store what you reach; higher needs a reason in the commit.
STORED = {"tree_hit": 1780, "alive": 68770, "triangle_hit": 12880, "point_arc": 6260, "remove": 10010}
#: What samples without a posture cost, 72 of them.
STORED_NOT_REACHED = {"sweep": 156, "tree_hit": 725, "alive": 16650, "point_arc": 9200, "_deepest": 3950}
#: The same of the posture maps.
STORED_MAPS = {
    "_boxes_pass": 721, "_triangles_pass": 573, "_see": 147, "cut_intervals": 558, "_shrink": 206, "_first_in_the_way": 137,
}  # fmt: skip
#: One last digit of the input moves one search's counts by up to 2 %, and those of all together by less than 1 %.
SLACK, NUDGES = 0.03, range(2)


def assert_no_more(found, stored):
    """More work fails; less does not, but for what no longer happens at all: then the count has lost its object."""
    assert all(0 < found[name] <= stored[name] * (1 + SLACK) for name in stored), f"counted {found}"


def work(nudge):
    """The existence search on 14 x 14 samples, 24 rotations, 7,200 triangles: (verdict, axis)."""
    rng = np.random.default_rng(nudge)
    contacts, vertex = waves.samples(14), waves.triangles(61)
    vertex += 1e-9 * rng.standard_normal(vertex.shape)
    n, turn = len(contacts.point), 2 * np.pi * np.arange(24) / 24
    found = verdict_arrays_of(blank(n))
    found.axis[:] = 0.0
    solids = material.sheet(waves.tree_of(vertex))
    tools = waves.flat(6.0, 40.0, 0.04), waves.flat(6.0, 40.0, 0.06)
    search.search(np.arange(n), contacts, waves.ranges(turn, np.cos(0.8)), *tools, solids, solids, found)
    return found.verdict, found.axis


def test_the_search_does_no_more_work_than_it_did():
    with counted() as calls:
        plain = [work(nudge) for nudge in NUDGES]
    # With and without the compiler it is the same search.
    for nudge, (plain_verdict, plain_axis) in zip(NUDGES, plain, strict=True):
        verdict, axis = work(nudge)
        assert np.bincount(verdict, minlength=2)[:2].min() > 10
        assert (verdict == plain_verdict).all()
        assert axis == pytest.approx(plain_axis, abs=1e-9)
    found = {name: calls[name] for name in STORED}
    assert_no_more(found, STORED)


def not_reached(nudge):
    """The search at 72 contacts between walls 2.6 to 3.4 mm apart for a cutter R1.6L20, 24 rotations: verdicts."""
    rng = np.random.default_rng(nudge)
    contacts, vertex = waves.comb_samples(6), waves.comb_triangles(24)
    vertex += 1e-9 * rng.standard_normal(vertex.shape)
    found, solids = verdict_arrays_of(blank(72)), material.sheet(waves.tree_of(vertex))
    turned = waves.ranges(2 * np.pi * np.arange(24) / 24)
    tools = waves.flat(1.6, 20.0, 0.02), waves.flat(1.6, 20.0, 0.03)
    search.search(np.arange(72), contacts, turned, *tools, solids, solids, found)
    return found.verdict


def test_samples_without_a_posture_cost_no_more_than_they_did():
    with counted() as calls:
        plain = [not_reached(nudge) for nudge in NUDGES[:1]]
    for nudge, verdict in zip(NUDGES, plain, strict=False):
        assert (not_reached(nudge) == verdict).all()
        assert np.bincount(verdict)[0] > 36
    found = {name: calls[name] for name in STORED_NOT_REACHED}
    assert_no_more(found, STORED_NOT_REACHED)


def maps(nudge):
    """Posture maps of 8 samples, 24 rotations, 7,200 triangles: (free intervals, how many, undecided)."""
    rng = np.random.default_rng(nudge)
    contacts, vertex = waves.samples(14), waves.triangles(61)
    vertex += 1e-9 * rng.standard_normal(vertex.shape)
    rows = np.linspace(0, len(contacts.point) - 1, 8).astype(np.int64)
    turn = 2 * np.pi * np.arange(24) / 24
    return waves.mapped(rows, contacts, waves.ranges(turn, np.cos(0.8)), waves.flat(6.0, 40.0, 0.04), waves.tree_of(vertex))


def test_posture_maps_do_no_more_work_than_they_did():
    with counted() as calls:
        plain = [maps(nudge) for nudge in NUDGES[:1]]
    for nudge, found in zip(NUDGES, plain, strict=False):
        for compiled, interpreted in zip(maps(nudge), found, strict=True):
            assert compiled == pytest.approx(interpreted, abs=1e-9)
    found = {name: calls[name] for name in STORED_MAPS}
    assert_no_more(found, STORED_MAPS)
