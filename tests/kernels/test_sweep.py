"""Samples without a posture, on bent walls 3 mm apart: verdicts and witnesses beside slow twins that probe each rotation."""

import itertools

import numpy as np
import pytest

from cad_io.arrays import Triangles
from plan_cutters import Cutter, Machine
from plan_cutters.domain.posture import PostureRange
from plan_cutters.domain.verdicts import ACCESSIBLE, INACCESSIBLE, UNDECIDED, blank
from plan_cutters.judging import witness
from plan_cutters.kernels import material
from plan_cutters.kernels.rows import Contacts
from plan_cutters.kernels.search import place, search, sweep
from plan_cutters.scene.conditions import Conditions, verdict_arrays_of
from plan_cutters.scene.obstacles import Obstacles
from plan_cutters.scene.surroundings import Surroundings
from tests.support import waves

TURNS, SAFE, BLOCKED, LENGTH = 12, 0.02, 0.03, 20.0
RANGES = waves.ranges(2 * np.pi * np.arange(TURNS) / TURNS)
#: Tilts a rotation that the twin probes.
TILTS = 361


@pytest.fixture(scope="module")
def comb():
    """Contacts on the walls, and the walls."""
    return waves.comb_samples(9), material.sheet(waves.tree_of(waves.comb_triangles(40)))


def searched(contacts, solids, radius, rows, **how):
    reach = blank(len(contacts.point))
    tools = waves.flat(radius, LENGTH, SAFE), waves.flat(radius, LENGTH, BLOCKED)
    search.search(rows, contacts, RANGES, *tools, solids, solids, verdict_arrays_of(reach), **how)
    return reach


def probed(contacts, solids, radius, row, depth):
    """Whether each posture (rotations, tilts) is let pass at a depth, local gouging included."""
    # Not the ends of the range: there an interval may be left that is too narrow to be looked at.
    tilts = (np.arange(TILTS) + 0.5) / TILTS * np.pi / 2
    n, e1 = contacts.normal[row], contacts.direction_max[row]
    most, least = contacts.curvature[row]
    free = np.zeros((TURNS, TILTS), bool)
    for turn in range(TURNS):
        c, s = RANGES.rotation_cos[turn], RANGES.rotation_sin[turn]
        tilt_direction = np.repeat([c * e1 + s * np.cross(n, e1)], TILTS, axis=0)
        axis = np.cos(tilts)[:, None] * n + np.sin(tilts)[:, None] * tilt_direction
        triangle = np.empty(TILTS, np.int32)
        search.probe(np.arange(TILTS), np.repeat([contacts.point[row]], TILTS, 0), np.repeat([n], TILTS, 0), axis, tilt_direction,
                     waves.flat(radius, LENGTH, depth), solids.tree, triangle, triangle.copy())  # fmt: skip
        free[turn] = (triangle < 0) & (np.sin(tilts) >= radius * (most * s * s + least * c * c))
    return free


@pytest.mark.slow("another step of the same law", but=("1.7",))
@pytest.mark.parametrize("radius", [1.45, 1.55, 1.7, 3.0])
def test_verdicts_are_those_of_a_twin_that_probes_each_rotation(comb, radius):
    contacts, solids = comb
    rows = np.arange(len(contacts.point))
    reach = searched(contacts, solids, radius, rows)
    for row in rows:
        outer_tool, inner_tool = (probed(contacts, solids, radius, row, depth) for depth in (SAFE, BLOCKED))
        verdict = reach.verdict[row]
        if outer_tool.any():
            assert verdict == ACCESSIBLE
        elif inner_tool.any():
            assert verdict in (ACCESSIBLE, UNDECIDED)
        if verdict == ACCESSIBLE:
            posture = np.array([reach.axis[row]]), np.array([reach.tilt_direction[row]])
            triangle = np.empty(1, np.int32)
            search.probe(np.zeros(1, np.int64), contacts.point[row : row + 1], contacts.normal[row : row + 1], *posture,
                         waves.flat(radius, LENGTH, SAFE), solids.tree, triangle, triangle.copy())  # fmt: skip
            assert triangle[0] == -1
    # Each radius stands for a case: from mostly reached to hopeless.
    not_reached = (reach.verdict == INACCESSIBLE).mean()
    assert not_reached == 1.0 if radius == 3.0 else 0.1 < not_reached < 0.95


@pytest.mark.parametrize("radius", [1.45, 1.55, 1.7, 3.0])
def test_verdicts_do_not_hang_on_the_company(comb, radius):
    """What is remembered from other samples only makes the work less."""
    contacts, solids = comb
    rows = np.arange(len(contacts.point))
    together = searched(contacts, solids, radius, rows).verdict
    back = searched(contacts, solids, radius, np.ascontiguousarray(rows[::-1])).verdict
    alone = np.array([searched(contacts, solids, radius, rows[i : i + 1]).verdict[i] for i in rows])
    assert (together == back).all()
    assert (together == alone).all()


def test_the_least_depth_is_that_of_a_grid(comb):
    contacts, solids = comb
    radius, share = 2.0, witness._PRECISION
    cutter, vertex = Cutter.flat(radius=radius, length=LENGTH), waves.comb_triangles(40)
    walls = Obstacles(Triangles(vertex, np.ones(len(vertex), np.int32), 0.001, ()))
    postures = PostureRange(step=2 * np.pi / TURNS)
    conditions = Conditions(
        Machine(), np.array([0, 0, 1.0]), postures, Surroundings.sheet(walls), SAFE + walls.triangles.chord_error, 1
    )
    assert np.cos(postures.rotations) == pytest.approx(RANGES.rotation_cos, abs=1e-12)
    not_reached = np.flatnonzero(searched(contacts, solids, radius, np.arange(len(contacts.point))).verdict == INACCESSIBLE)
    short = []
    for row in not_reached[:: max(1, len(not_reached) // 12)]:
        one = Contacts(*(column[row : row + 1].copy() for column in contacts))
        best, low, high = witness._least_depth(one, 0, cutter, conditions)
        assert low < high <= low * (1 + 2 * share)
        for depth, free in ((high * (1 + 1e-9), True), (low, False)):
            triangle = np.empty(1, np.int32)
            search.probe(np.zeros(1, np.int64), one.point, one.normal, best.axis, best.tilt_direction,
                         waves.flat(radius, LENGTH, depth), solids.tree, triangle, triangle.copy())  # fmt: skip
            assert (triangle[0] < 0) == free
        assert not probed(contacts, solids, radius, row, SAFE).any()
        short.append(probed(contacts, solids, radius, row, 0.9 * low).any())
    # Tilts far apart are looked at first: now and then the best of them is not beside the best of all.
    assert len(short) >= 10
    assert np.mean(short) <= 0.2


@pytest.mark.parametrize("most", [0, 30, 300, 20_000])
@pytest.mark.parametrize("radius", [1.45, 1.7])
def test_a_brief_search_leaves_undecided_what_it_gives_up_and_else_says_the_same(comb, radius, most, monkeypatch):
    contacts, solids = comb
    rows = np.arange(len(contacts.point))
    patient = searched(contacts, solids, radius, rows)
    monkeypatch.setattr(search, "_BRIEF", most)
    brief = searched(contacts, solids, radius, rows, brief=True)
    same = brief.verdict == patient.verdict
    assert ((brief.verdict == UNDECIDED) | same).all()
    assert same.all() if most == 20_000 else not same.all()


def test_every_rotation_is_looked_at():
    """A posture left at one rotation alone is found wherever the search begins: roof and wall but for a slot."""
    angle = np.linspace(0, 2 * np.pi, 73)
    for slot in range(0, 72, 12):
        walls = []
        for k in range(72):
            if abs((k - slot + 36) % 72 - 36) <= 2:
                continue
            a, b = (np.array([9 * np.cos(angle[j]), 9 * np.sin(angle[j]), -1.0]) for j in (k, k + 1))
            up = np.array([0, 0, 30.0])
            walls += [[a, b, b + up], [a, b + up, a + up]]
        roof = np.array([0, 0, 12.0])
        disk = [np.array([7 * np.cos(t), 7 * np.sin(t), 12.0]) for t in angle]
        walls += [[roof, *pair] for pair in itertools.pairwise(disk)]
        solids = material.sheet(waves.tree_of(np.array(walls)))
        contact = Contacts(np.zeros((1, 3)), np.array([[0.0, 0, 1]]), np.array([[1.0, 0, 0]]), np.zeros((1, 2)))
        reach = searched(contact, solids, 0.4, np.zeros(1, np.int64))
        free = probed(contact, solids, 0.4, 0, SAFE).any(axis=1)
        assert 1 <= free.sum() <= 2
        assert reach.verdict[0] == ACCESSIBLE
        assert free[reach.rotation[0]]


@pytest.mark.parametrize("given", [1, 127, 128, 129, 256, 300])
def test_what_is_remembered_is_seen_from_the_contact_at_hand(given):
    """Points met far away change nothing here, wherever they seemed to be from the contact before."""
    contact = Contacts(np.zeros((1, 3)), np.array([[0.0, 0, 1]]), np.array([[1.0, 0, 0]]), np.zeros((1, 2)))
    # A speck on the axis of the first posture tried, 45 deg at rotation 0, so that what is remembered is asked.
    speck = np.array([7.0, 0, 8.0]) + 0.1 * np.array([[1.0, 0, 0], [0, 1, 0], [0, 0, 1]])
    solids, tool = material.sheet(waves.tree_of(speck[None])), waves.flat(1.0, LENGTH, SAFE)

    def swept(past):
        side = sweep.Side(tool, solids, 0.25, 1e-5, sweep.WITHOUT_END, place.Proof(np.zeros(0), 0.0, solids))
        return sweep.sweep(contact, 0, RANGES, side, (0, -1.0), TURNS, past, place.search_workspace())

    full = sweep.memory(TURNS, 1, False)
    full.given[0], full.pool[:] = given, 1e4
    rng = np.random.default_rng(0)
    full.seen[:] = rng.uniform([[-4], [-4], [0.1]], [[4], [4], [4]], full.seen.shape)
    rotation, tilt = swept(full)
    assert (rotation, tilt) == swept(sweep.memory(TURNS, 1, False))
    assert (rotation, tilt != np.pi / 4) == (0, True)
