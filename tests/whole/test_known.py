"""Nothing is paid for what is known: what is counted, not how long it takes."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cad_io import read_part
from cad_io.tessellate.start import starts
from cad_io.write import render_mesh as drawing
from cad_io.write.render_mesh import Net, cut
from plan_cutters import Cutter, Options, plan
from plan_cutters.judging import witness
from plan_cutters.judging.between import between
from plan_cutters.judging.judge import judge
from plan_cutters.judging.phases import access
from plan_cutters.pipeline import prepare
from plan_cutters.scene.conditions import Context
from plan_cutters.scene.inside_material import cover
from plan_cutters.scene.work import Work
from tests.support import shapes
from tests.support.cad_parts import box, compound
from tests.support.places import SAMPLES

SMALL = Cutter.flat(radius=2, length=30)


def bolted():
    """Two plates that touch, and two bolts through both."""
    bolts = [box(4, 4, 24, at=(x, 8, -2)) for x in (6, 30)]
    return compound(box(40, 20, 10), box(40, 20, 10, at=(0, 0, 10)), *bolts)


@pytest.fixture(scope="module")
def ready():
    return prepare(bolted(), Options.of({"cutters": [SMALL], "faces": "all", "grid": 13, "area_budget": 0}))


@pytest.fixture(scope="module")
def reach(ready):
    return judge(ready, SMALL)


def test_no_search_and_no_witness_search_for_what_is_inside(ready, reach, monkeypatch):
    inside = np.flatnonzero(ready.inside_bodies)
    assert len(inside) > 100
    work, none = Work(), np.zeros(len(ready.samples), bool)
    access(ready.samples, none, Context.of(SMALL, ready.conditions), inside=ready.inside, rows=inside, work=work)
    assert work.looked == 0
    some = Work()
    access(ready.samples, none, Context.of(SMALL, ready.conditions), inside=ready.inside, work=some)
    assert some.looked > 0
    searched, real = [], witness._witness
    monkeypatch.setattr(witness, "_witness", lambda s, row, *more: searched.append(row) or real(s, row, *more))
    found = witness.witnesses(ready.samples, reach, Context.of(SMALL, ready.conditions), inside=ready.inside)
    assert not ready.inside_bodies[searched].any()
    mine = [w for w in found if ready.inside_bodies[w.sample]]
    # One a body and face, and together they stand for all.
    pairs = {(int(ready.samples.face[row]), int(ready.inside[row])) for row in inside.tolist()}
    assert len(mine) == len(pairs)
    assert sum(w.samples for w in mine) == len(inside)
    assert all(w.obstacle_face is not None and w.depth is None for w in mine)


def test_the_plan_says_for_how_many_samples_a_witness_stands():
    entry = plan(bolted(), cutters=[SMALL], faces="all", grid=7, area_budget=0).plan.cutters[0]
    groups = {}
    for w in entry.witnesses:
        groups.setdefault((w.face, w.reason, w.obstacle_face if w.inside_bodies else None, w.samples), w.samples)
    assert sum(groups.values()) == entry.inaccessible + entry.undecided


@given(st.integers(0, 10_000))
@settings(max_examples=25, deadline=None)
def test_the_way_out_is_the_one_that_all_triangles_tell(ready, seed):
    """The walk of the tree, beside a look at each triangle."""
    rng = np.random.default_rng(seed)
    around = ready.conditions.surroundings
    skin, body = around.certain, around.enclosing[int(rng.integers(len(around.enclosing)))]
    mine = np.isin(skin.triangles.face, body.faces)
    vertex, face = skin.triangles.vertex[mine], skin.triangles.face[mine]
    low, high = vertex.min(axis=(0, 1)), vertex.max(axis=(0, 1))
    point, normal = low + rng.uniform(0.01, 0.99, 3) * (high - low), rng.normal(size=3)
    normal /= np.linalg.norm(normal)
    away, met = np.inf, None
    for (a, b, c), number in zip(vertex, face, strict=True):
        u, v, t = np.linalg.lstsq(np.stack([b - a, c - a, -normal], axis=1), point - a, rcond=None)[0]
        at = point + t * normal
        if u >= 0 and v >= 0 and u + v <= 1 and 0 < t < away and np.allclose(a + u * (b - a) + v * (c - a), at):
            away, met = t, number
    found = cover(point, normal, skin, body)
    assert found is not None
    assert found.face == met
    assert np.allclose(found.point, point + away * normal)


def test_depths_are_searched_in_so_many_groups_whatever_there_are():
    rows = np.arange(3)
    groups = [witness._Group(1 + k // 4, 2 + k % 4, -1, rows, 100.0 - 0.1 * k) for k in range(400)]
    groups.append(witness._Group(1, 5, 7, rows, 1e9))
    chosen = witness._measured(groups)
    assert len(chosen) == len(set(chosen)) == 60
    assert len({groups[i].face for i in chosen}) == 60, "the largest of each face comes before the second of any"
    assert 400 not in chosen, "there is nothing to search for within a body"


@given(st.integers(1, 40), st.integers(1, 8), st.integers(0, 100))
@settings(max_examples=40, deadline=None)
def test_samples_tried_are_far_apart(count, most, seed):
    point = np.random.default_rng(seed).normal(size=(count + 5, 3))
    rows = np.arange(5, count + 5)
    found = witness.far_apart(point, rows, most)
    assert len(set(found)) == len(found) == min(most, count)
    assert set(found) <= set(rows.tolist())
    for k in range(1, len(found)):
        away = [min(np.linalg.norm(point[row] - point[other]) for other in found[:k]) for row in rows]
        mine = min(np.linalg.norm(point[found[k]] - point[other]) for other in found[:k])
        assert mine == pytest.approx(max(away))


@pytest.fixture(scope="module")
def valley():
    asked = {"cutters": ["R12L100"], "grid": 21, "area_budget": 0, "rotation_step": 0.35}
    ready = prepare(SAMPLES / "peaks_and_valleys.step", Options.of(asked))
    cutter = ready.cutters[0]
    return ready, cutter, judge(ready, cutter)


def area(valley, most, jobs=1):
    from dataclasses import replace

    ready, cutter, reach = valley
    work = Work()
    context = Context.of(cutter, replace(ready.conditions, jobs=jobs))
    found = between(ready.samples, reach, context, ready.scene.part, ready.scene.orientation, budget=6_000,
                    most=most, work=work)  # fmt: skip
    return found, work.looked


def test_the_area_ends_where_its_work_is_done_and_says_so(valley):
    whole, all_of_it = area(valley, np.inf)
    assert whole.short < whole.left
    for share in (0.3, 0.6):
        part, looked = area(valley, share * all_of_it)
        assert abs(looked - share * all_of_it) < 0.1 * all_of_it, "it is spent, and a round may go on beyond it"
        assert part.short > 0
        assert part.left >= part.short
        assert part.contacts < whole.contacts
        assert part.share <= whole.share + 1e-3
        assert not part.feasible


def test_no_work_serves_nothing_and_threads_do_not_matter(valley):
    none, looked = area(valley, 0.0)
    assert (none.share, looked, none.contacts) == (0.0, 0, 0)
    assert none.left == none.short > 0
    assert not none.feasible
    some, looked = area(valley, 1.0)
    assert some.contacts <= 512, "few to begin with"
    assert looked < 3e5
    (one, first), (two, second) = area(valley, 3e6), area(valley, 3e6, jobs=2)
    assert first == second
    assert (one.share, one.contacts, one.left, one.short) == (two.share, two.contacts, two.left, two.short)


def test_what_the_search_did_not_reach_is_not_searched_again(valley):
    """A sample without a posture costs the area no search of its own."""
    from dataclasses import replace

    ready, cutter, reach = valley
    assert reach.not_reached.any()
    found = area(valley, np.inf)[1]
    blank = replace(reach, verdict=np.where(reach.not_reached, 255, reach.verdict).astype(np.uint8))
    forgetful = area((ready, cutter, blank), np.inf)[1]
    assert found < forgetful


def test_the_page_asks_for_one_coarse_mesh_and_draws_what_it_may(monkeypatch):
    part, calls = read_part(SAMPLES / "peaks_and_valleys.step"), []
    monkeypatch.setattr(drawing, "starts", lambda *a, **more: calls.append(a[2]) or starts(*a, **more))
    sides = np.ones(len(part.faces))
    for most, chord in ((60_000, 1e-2), (2_000, 3e-2)):
        found = drawing.render_mesh(part, sides, most=most, deflection=chord)
        assert len(calls) == 1
        assert calls.pop() > chord
        assert sum(len(mesh.triangle) for mesh in found.meshes.values()) <= most
        assert found.deflection >= chord
    assert found.deflection > 3e-2, "what could not be drawn is said"


@given(st.integers(0, 50), st.sampled_from([0.3, 0.05, 0.01]))
@settings(max_examples=10, deadline=None)
def test_triangles_to_look_at_lie_near_the_surface_without_cracks(seed, chord):
    patch = shapes.Patch.random(np.random.default_rng(seed), size=40.0, height=8.0, n=6)
    part = read_part(patch.face())
    start = starts(part, [1], 8.0)[0][1]
    net = Net.of(part.surface(1), start)

    def planar():
        a, b, c = net.uv[net.corner].transpose(1, 0, 2)
        return 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])

    before = planar().sum()
    left = cut([net], chord, 0.35, 1_000_000)
    assert planar().min() > 0
    assert planar().sum() == pytest.approx(before, rel=1e-6)
    ends = np.sort(np.stack([net.corner, np.roll(net.corner, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    _, uses = np.unique(ends, axis=0, return_counts=True)
    assert uses.max() == 2
    assert (uses == 1).sum() == len(net.border), "an edge that is used once lies on the border"
    share = np.random.default_rng(seed).dirichlet([1, 1, 1], 4)
    for each in share:
        uv, flat = np.einsum("c,tcx->tx", each, net.uv[net.corner]), np.einsum("c,tcx->tx", each, net.point[net.corner])
        off = np.linalg.norm(part.surface(1).values(*uv.T) - flat, axis=1)
        # Where a surface has no third derivative, no point of a triangle is farther off than 4/3 of the farthest middle of an
        # edge: with weights a, b, c it is off by 4 (ab e + bc f + ca g), and ab + bc + ca <= 1/3. Small triangles are nearly so.
        # `left` is what was seen before the last of the rounds.
        assert off.max() < 1.5 * max(chord, left)
        assert (off > 4.0 / 3.0 * chord).mean() < 0.003


def test_a_stage_of_many_cutters_tells_one_progress():
    told = []
    plan(SAMPLES / "v_groove.step", cutters=["R6L80", "R8L80", "R10L80"], grid=9, area_budget=0, machine="tilt:20",
         progress=lambda stage, done, total: told.append((stage, done / total)))  # fmt: skip
    shares = [share for stage, share in told if stage == "reasons"]
    assert len(shares) > 4
    assert shares == sorted(shares)
