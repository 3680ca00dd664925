"""What next: steps whose effect a fresh plan confirms, the least set against all subsets, areas with their place."""

import math
import re
from itertools import combinations
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cad_io import read_part
from plan_cutters import Cutter, Options, plan
from plan_cutters.answers.areas import Finished, patches
from plan_cutters.answers.least_set import cover
from plan_cutters.answers.steps import NEEDS
from plan_cutters.document.clock import Clock
from plan_cutters.pipeline import prepare, run
from plan_cutters.plan_file.words.answers import is_excluded, patch, step_text, together
from tests.support import shapes
from tests.support.advice import answered, asked, followed, left, options, single, steps_of, strip, wall
from tests.support.cad_parts import box, cut, real
from tests.support.places import SAMPLES

# --- steps ----------------------------------------------------------------------------------------------------------------


def pocket(gap=4.0):
    """A floor beside a wall of 40 mm, and one between two walls 4 mm apart, where a cutter of 6 mm does not go."""
    ends = 101.5 - 0.5 * gap, 101.5 + 0.5 * gap
    return shapes.shell(strip(0, 7), wall(-4, 40, 1), strip(100.5, 102.5), wall(ends[0], 20, 1), wall(ends[1], 20, -1))


POCKET = ("--cutter", "R3L25F10S3", "--holder", "R15L200", "--faces", "F1,F3", "--grid", "5", "--tilt", "0:0")


@pytest.mark.slow("plans parts whole")
def test_a_longer_stick_out_is_a_step_also_where_it_does_not_cure_everything():
    """The floor of 560 mm2 is freed by a nose above the wall, that of 160 mm2 is still not reached."""
    result = asked(pocket(), *POCKET)
    (entry,) = result.cutters
    assert entry.mend.lost_share == pytest.approx(1.0)
    (step,) = single(result, "stick_out")
    assert (step.changes[0].now, step.changes[0].asked) == (25.0, 40.0)
    assert (step.gained, step.left) == (25, 25)
    assert step.lost_before == pytest.approx(1.0)
    assert step.lost_after == pytest.approx(160 / 720)
    # Its holder stays with --holder, which is typed already.
    assert step.option == "--cutter R3L40F10S3"
    again = followed(pocket(), step, *POCKET)
    assert left(again, step) == pytest.approx(step.lost_after, abs=1e-12)
    (there,) = [c for c in again.cutters if [c.id] == step.cutters]
    assert there.area_share.inaccessible == pytest.approx(step.lost_after, abs=1e-12)


@pytest.mark.slow("plans parts whole")
def test_two_changes_free_what_one_does_not():
    """Between walls 3.5 mm apart a flat end R2 does not go, and a smaller one may not be held out over the other wall."""
    result = asked(pocket(3.5), *POCKET)
    best = min(steps_of(result), key=lambda step: step.lost_after)
    assert len(best.changes) == 2
    assert all(step.lost_after > 0.0 for step in steps_of(result) if len(step.changes) == 1)
    assert (best.lost_after, best.left, best.gained) == (0.0, 0, 50)
    assert left(followed(pocket(3.5), best, *POCKET), best) == 0.0


def test_what_is_left_by_the_best_step_is_an_area_with_its_place():
    result = asked(pocket(), *POCKET)
    (step,) = single(result, "stick_out")
    (area,) = step.remains
    assert area.area_mm2 == pytest.approx(160.0)
    assert area.faces == ["F3"]
    assert area.point == pytest.approx((101.5, 0, 0))
    assert area.across_mm == pytest.approx(math.hypot(2.0, 80.0), rel=0.03)
    out = [step for step in result.cutters[0].mend.steps if is_excluded(step)]
    assert result.cutters[0].mend.steps[-1:] == out


def below():
    """A block with a pocket in its underside, as deep as the holder is wide above it."""
    return read_part(cut(box(60, 120, 60), box(24, 80, 30, at=(18, 20, 0))))


BELOW = ("--cutter", "R3L20F10S3", "--holder", "R15L100", "--machine", "tilt:10", "--grid", "4")


def test_turned_over_as_a_second_setup():
    """On a block whose top and underside are requested, turned over frees the underside: as many samples as the top has."""
    part = read_part(box(30, 40, 20))
    words = ("--cutter", "R3L40", "--machine", "tilt:10", "--faces", flat_faces(part), "--grid", "5")
    result = asked(part, *words)
    (step,) = single(result, "second_setup")
    assert step.changes[0].asked == (0.0, 0.0, -1.0)
    assert step.changes[0].why.startswith("turned over (setup 0,0,-1)")
    assert (step.gained, step.left) == (25, 0)
    assert step.option == "--setup 0,0,1 --setup 0,0,-1"
    again = followed(part, step, *words)
    assert left(again, step) == 0.0
    assert again.plan.least_set.left == 0
    assert [run.setup for run in again.plan.least_set.runs] == [(0.0, 0.0, 1.0), (0.0, 0.0, -1.0)]
    assert [run.samples for run in again.plan.least_set.runs] == [25, 25]
    # All of the underside is not reached: only whole faces can be left out by an option.
    out = result.cutters[0].mend.steps[-1]
    assert is_excluded(out)
    assert not result.reaches["R3L40"].reached[result.samples.normal[:, 2] < 0].any()
    (top,) = np.unique(result.samples.face[result.samples.normal[:, 2] > 0])
    assert out.option == f"--faces only:F{top}"
    assert followed(part, out, *words).cutters[0].feasible


def test_with_several_setups_steps_are_about_what_all_of_them_leave():
    """Of the six sides of a block two are reached in two setups; a third setup frees one more."""
    part = read_part(box(30, 40, 20))
    words = ("--cutter", "R3L40", "--machine", "tilt:10", "--tilt", "0:30", "--faces", "all", "--grid", "4",
             "--setup", "0,0,1", "--setup", "1,0,0")  # fmt: skip
    result = asked(part, *words)
    (entry,) = result.cutters
    assert entry.mend.lost_share == pytest.approx(1.0 - (1200 + 800) / 5200)
    (step,) = single(result, "second_setup")
    assert step.changes[0].why.endswith("as a third setup")
    assert (len(step.setups), step.gained, step.left) == (3, 16, entry.lost_in_all - 16)
    assert step.option.startswith("--setup 0,0,1 --setup 1,0,0 --setup ")
    assert left(followed(part, step, *words), step) == pytest.approx(step.lost_after, abs=1e-12)
    # What one setup leaves and the other reaches is reached: nothing is to be mended.
    assert asked(part, *words[:4], *words[6:8], "--grid", "4", *words[10:]).cutters[0].mend is None


def flat_faces(part):
    """Top and underside of a block."""
    found = plan(part, cutters="R3L40", faces="all", grid=2, area_budget=0).samples
    return ",".join(f"F{n}" for n in np.unique(found.face[np.abs(found.normal[:, 2]) > 0.5]))


@pytest.mark.slow("plans parts whole")
def test_a_pocket_from_below_needs_a_setup_and_a_stick_out():
    """Neither gains anything alone: the two are looked for together."""
    part = below()
    normal = plan(part, cutters="R3L40", faces="all", grid=2, area_budget=0).samples
    deep = np.unique(normal.face[(normal.point[:, 2] == 30.0) & (normal.normal[:, 2] < -0.5)])
    words = (*BELOW, "--faces", ",".join(f"F{n}" for n in deep))
    result = asked(part, *words)
    assert not single(result, "stick_out")
    assert not single(result, "second_setup")
    pairs = {tuple(change.thing for change in step.changes): step for step in steps_of(result)}
    step = pairs["stick_out", "second_setup"]
    # Its nose has to clear 30 mm.
    assert step.changes[0].asked >= 30.0
    assert step.gained > 0
    assert left(followed(part, step, *words), step) == pytest.approx(step.lost_after, abs=1e-12)


@pytest.mark.slow("plans parts whole")
def test_steps_that_free_enough_are_in_the_order_of_what_they_ask_for():
    """The drawer, setups, how a tool is held, a purchase; those that free less than half of the most come after them."""
    for entry in asked(SAMPLES / "pocket_top.step", *TRIED["pocket_top.step"]).cutters:
        if entry.mend is None:
            continue
        told = [step for step in entry.mend.steps if not is_excluded(step)]
        assert all(step.lost_after < step.lost_before for step in told)
        most = max(step.lost_before - step.lost_after for step in told)
        enough = [step.lost_before - step.lost_after >= 0.5 * most for step in told]
        assert enough == sorted(enough, reverse=True)
        # Nothing is held out farther than usual here.
        asked_for = [max(NEEDS[change.thing] for change in step.changes) for step, much in zip(told, enough, strict=True) if much]
        assert asked_for == sorted(asked_for)


TRIED = {
    "pocket_top.step": ("--cutter", "R6L20", "--cutter", "R3L15", "--holder", "R25L60", "--machine", "tilt:5", "--grid", "21"),
    "peaks_and_valleys.step": ("--cutter", "R4L15F10S4", "--holder", "R20L60", "--machine", "tilt:35", "--grid", "21"),
    "v_groove.step": ("--cutter", "R6L20", "--machine", "tilt:8", "--grid", "21"),
}


@pytest.mark.slow("plans again for each answer", only=("peaks", "pocket_top"))
@pytest.mark.parametrize("name", TRIED)
def test_each_advice_that_is_followed_is_true(name):
    """Each step of each cutter, typed as it is told, leaves what it says."""
    part, words = read_part(SAMPLES / name), TRIED[name]
    result = asked(part, *words)
    count = 0
    for entry in [c for c in result.cutters if c.mend]:
        for step in [each for each in entry.mend.steps if not is_excluded(each)][:3]:
            if step.option is None:
                # What is there already, in another combination.
                assert [change.thing for change in step.changes] == ["cutter"]
                continue
            count += 1
            assert left(followed(part, step, *words), step) == pytest.approx(step.lost_after, abs=0.005)
    assert count


REAL = {
    "trimesh_featuretype.STEP": ("--cutter", "R3L25", "--holder", "R15L60", "--machine", "tilt:60", "--faces", "all"),
    "asitus_control_arm.step": ("--cutter", "R1L12", "--holder", "R15L60", "--machine", "trunnion-ac"),
}


@pytest.mark.slow("plans real parts twice")
@pytest.mark.parametrize("file", real(*REAL), ids=lambda path: path.stem)
def test_the_first_advice_is_true_on_real_parts(file):
    """With default spacing, so that another cutter may bring other samples: within half a point."""
    part, words = read_part(file), REAL[file.name]
    step = steps_of(asked(part, *words))[0]
    assert step.lost_after < 0.5 * step.lost_before
    assert left(followed(part, step, *words), step) == pytest.approx(step.lost_after, abs=0.005)


def test_samples_inside_another_body_are_out_of_the_question():
    """A boss stands on a block and hides some of its top: the steps are about the rest, and their shares of the rest."""
    from tests.support.cad_parts import compound

    part = read_part(compound(box(60, 60, 20), box(20, 20, 20, at=(20, 20, 15))))
    result = asked(part, "--cutter", "R3L30", "--faces", "all", "--machine", "tilt:20", "--grid", "9")
    (entry,) = result.cutters
    inside = result.ready.inside_bodies
    assert inside.any()
    assert entry.mend.buried == int(inside.sum())
    finished = Finished.of(result.ready)
    assert finished.share[inside].sum() == 0.0
    assert finished.share.sum() == pytest.approx(1.0)
    assert entry.mend.lost_share == pytest.approx(
        finished.share[result.reaches[entry.id].not_reached & result.ready.finished].sum()
    )
    assert any(step.lost_after < 0.5 * step.lost_before for step in steps_of(result))


@pytest.mark.slow("plans again for each answer")
def test_the_nearest_three_are_asked_about_and_the_others_are_named():
    words = [word for r in (3, 4, 5, 6, 8) for word in ("--cutter", f"R{r}L60")]
    part = read_part(SAMPLES / "v_groove.step")
    few = asked(part, *words, "--machine", "tilt:3", "--grid", "5")
    not_reached = {c.id: c.area_share.inaccessible + c.area_share.undecided for c in few.cutters}
    failing = sorted((c.id for c in few.cutters if not_reached[c.id]), key=lambda name: not_reached[name])
    assert len(failing) > 3
    mended = {c.id for c in few.cutters if c.mend}
    assert len(mended) == 3
    assert mended | set(few.plan.not_mended) == set(failing)
    assert max(not_reached[name] for name in mended) <= min(not_reached[name] for name in few.plan.not_mended) + 1e-12
    assert any("not asked about: plan with one of them alone" in line for line in answered(few.plan))


def test_of_given_cutters_that_leave_as_little_the_most_wanted_does_the_rest():
    result = asked(pocket(), *POCKET, "--cutter", "R0.5L100", "--cutter", "R1L100", "--cutter", "R0.8L100")
    entry = next(c for c in result.cutters if c.id.startswith("R3"))
    (step, *_) = [each for each in entry.mend.steps if [change.thing for change in each.changes] == ["cutter"]]
    assert step.changes[0].asked.startswith("R1L100")


# --- the least set --------------------------------------------------------------------------------------------------------


def brute(reached):
    """How few columns cover all that any covers, by trying every subset."""
    every = reached.any(axis=1)
    for size in range(reached.shape[1] + 1):
        for chosen in combinations(range(reached.shape[1]), size):
            if (reached[:, list(chosen)].any(axis=1) == every).all():
                return size
    raise AssertionError


@settings(deadline=None, max_examples=60)
@given(st.integers(1, 7), st.integers(1, 40), st.floats(0.1, 0.7), st.integers(1, 3), st.randoms(use_true_random=False))
def test_the_least_set_is_the_least_of_all_subsets(m, n, dense, setups, random):
    reached = np.array([[random.random() < dense for _ in range(m)] for _ in range(n)])
    setup, rank = [k % setups for k in range(m)], [k // setups for k in range(m)]
    chosen, proven = cover(reached, setup, rank)
    assert proven
    assert (reached[:, chosen].any(axis=1) == reached.any(axis=1)).all()
    assert len(chosen) == brute(reached)
    # Of sets of as many: fewest setups, then the least sum of ranks.
    every = reached.any(axis=1)
    alike = [c for c in combinations(range(m), len(chosen)) if (reached[:, list(c)].any(axis=1) == every).all()]
    worth = [(len({setup[k] for k in c}), sum(rank[k] for k in c)) for c in alike]
    assert (len({setup[k] for k in chosen}), sum(rank[k] for k in chosen)) == min(worth)


def test_two_cutters_share_a_part_and_that_is_said_in_every_plan():
    """The large one does not go between the walls, the short one does not clear them: together they reach it all."""
    part = shapes.shell(strip(0, 7), wall(-4, 40, 1), strip(100.5, 102.5), wall(99.5, 5, 1), wall(103.5, 5, -1))
    long = Cutter.flat(radius=3, length=60, flutes=10.0, shank_radius=3.0, holder="R15L100")
    short = Cutter.flat(radius=1, length=10, holder="R15L60")
    small = Cutter.flat(radius=0.5, length=10, holder="R15L60")
    result = plan(part, cutters=(long, short, small), faces="F1,F3", grid=5, tilt=(0, 0), area_budget=0)
    found = result.plan.least_set
    assert found.proven
    assert [run.cutter for run in found.runs] == [long.id, short.id]
    assert [run.faces for run in found.runs] == [["F1"], ["F3"]]
    assert [run.alone for run in found.runs] == [25, 25]
    assert together(result.plan) == f"{long.id} for 77.8 % of the area and {short.id} for the rest reach all of it"
    assert sum(run.samples for run in found.runs) == found.reached
    assert sum(run.area_mm2 for run in found.runs) == pytest.approx(720.0)
    any_reaches = np.logical_or.reduce([reach.reached for reach in result.reaches.values()])
    assert (found.reached, found.left) == (int(any_reaches.sum()), 0)


def test_where_nothing_is_shared_no_set_is_told():
    result = plan(SAMPLES / "v_groove.step", cutters="R6L80", grid=5, area_budget=0)
    assert result.plan.least_set is None
    assert together(result.plan) == ""


def test_a_set_is_a_sentence():
    def of(runs, share, left=0, proven=True, doubtful=False, unjudged=0, causes=()):
        made = [SimpleNamespace(cutter=c, share=s, setup=axis) for c, s, axis in runs]
        found = SimpleNamespace(runs=made, share=share, left=left, left_share=1 - share, proven=proven, doubtful=doubtful)
        samples = SimpleNamespace(unjudged=unjudged)
        process = SimpleNamespace(left=[SimpleNamespace(cause=each) for each in causes])
        return together(SimpleNamespace(least_set=found, samples=samples, faces=[], process=process))

    up, down = (0, 0, 1), (0, 0, -1)
    assert of([("R6L60", 0.81, up), ("R1L12", 0.182, up)], 0.992, left=9) == (
        "R6L60 for 81 % of the area and R1L12 for the rest reach 99.2 %; nothing given reaches the other 0.8 %"
    )
    # Of what stands on a proposed table another cutter may reach something.
    assert of([("R6L60", 0.81, up), ("R1L12", 0.182, up)], 0.992, left=9, causes=["another_setup"]).endswith(
        "; they leave the other 0.8 %, also for another setup"
    )
    assert of([("R6L60", 0.6, up), ("R6L60", 0.4, down)], 1.0) == (
        "R6L60 in setup 0,0,1 for 60 % of the area and R6L60 in setup 0,0,-1 for the rest reach all of it"
    )
    assert "before the proof" in of([("A", 0.6, up), ("B", 0.4, up)], 1.0, proven=False)
    assert "unless a missing obstacle is in the way" in of([("A", 0.6, up), ("B", 0.4, up)], 1.0, doubtful=True)
    assert of([("A", 1.0, up)], 1.0) == ""
    # What could not be judged is not reached.
    assert of([("A", 0.6, up), ("B", 0.3, up)], 0.9, unjudged=3) == (
        "A for 60 % of the area and B for the rest reach all of it that could be judged"
    )
    assert of([("A", 0.6, up), ("B", 0.3, up)], 0.9, left=2, unjudged=3).endswith("; nothing given reaches another 10 %")


# --- areas ----------------------------------------------------------------------------------------------------------------


def test_samples_not_reached_are_areas_with_place_and_extent():
    """Two disks of a plane: their areas, middles and diameters, to the grid."""
    part = shapes.shell(shapes.plane((-20, 20), (-20, 20)))
    ready = prepare(part, Options(cutters=("R3L40",), grid=161, area_budget=0))
    point = ready.samples.point
    large, small = (np.hypot(point[:, 0] - x, point[:, 1] - y) <= r for x, y, r in ((8, 4, 5), (-10, -8, 2)))
    found = patches(ready.samples, Finished.of(ready), np.flatnonzero(large | small))
    assert len(found) == 2
    for each, (x, y, r) in zip(found, ((8, 4, 5), (-10, -8, 2)), strict=True):
        assert each.area_mm2 == pytest.approx(math.pi * r**2, rel=0.05)
        assert each.share == pytest.approx(math.pi * r**2 / 1600.0, rel=0.05)
        assert each.point == pytest.approx((x, y, 0), abs=0.3)
        assert each.across_mm == pytest.approx(2 * r, abs=0.3)
        assert each.faces == ["F1"]
    assert patches(ready.samples, Finished.of(ready), np.zeros(0, np.int64)) == []


def test_an_area_in_words():
    assert patch(1234.5, ["F1", "F2"], (-7e-15, 3.0, -8.123456), 41.26) == (
        "1,230 mm² of F1, F2, about (0, 3, -8.12), 41 mm across"
    )


# --- stick-outs -----------------------------------------------------------------------------------------------------------


def test_a_stick_out_that_may_be_shorter_does_not_read_as_one_that_is_too_short():
    part = shapes.shell(strip(0, 7), wall(-4, 20, 1))
    words = ("--cutter", "R3L40F10S3", "--holder", "R15L200", "--faces", "F1", "--grid", "5", "--tilt", "0:0")
    result = run(part, options(*words, "--answers", "stick-out", "--area-budget", "0"), Clock())
    (line,) = answered(result.plan)
    assert re.search(r"can be held shorter: 20\.0. mm of its 40 mm", line)
    assert "needs" not in line
    words = ("--cutter", "R3L20.005F10S3", *words[2:])
    result = run(part, options(*words, "--answers", "stick-out", "--area-budget", "0"), Clock())
    (line,) = answered(result.plan)
    assert "cannot be held shorter than the 20" in line


def test_what_is_to_be_typed_is_typed_out():
    """Cutters are called as in the summary in sentences, but not in what is to be typed."""
    result = asked(pocket(), *POCKET)
    lines = [line for line in answered(result.plan) if "[add --cutter" in line]
    assert lines
    assert all("--cutter R" in line.partition("[")[2] for line in lines)
    assert all("HR15L200" not in step_text(step) for step in steps_of(result))


def test_sharp_inside_edges_are_offered_to_be_left_and_nothing_is_bought_for_them():
    """A step of two planes without a fillet between them: what is left is the strip that no ball comes to."""
    ledge = cut(box(40, 30, 20), box(40, 15, 10, at=(0, 15, 10)))
    how = {"cutters": "R3L40rc3", "faces": "all", "grid": 21, "area_budget": 0, "answers": "mend", "machine": "trunnion-ac"}
    process = plan(ledge, fixtures="table", **how).plan.process
    sharp = [each.share for each in process.left if each.cause == "sharp_edge"]
    assert sharp
    first = process.next[0]
    assert (first.argv, first.left_share) == (["--sharp-edges", "left"], None)
    after = plan(ledge, fixtures="table", sharp_edges="left", **how).plan.process
    assert not any(each.argv[:1] == ["--sharp-edges"] for each in after.next)
    assert 1.0 - after.finished_share < 1.0 - process.finished_share
