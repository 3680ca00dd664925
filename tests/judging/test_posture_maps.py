"""Posture maps of all samples: against single probes, the one-point map and the closed forms; the same for any threads."""

import json

import numpy as np
import pytest

from cad_io.tessellate import tessellate
from plan_cutters import Cutter, plan, posture_map
from plan_cutters.domain.verdicts import UNDECIDED
from plan_cutters.kernels.search.search import probe
from plan_cutters.scene.obstacles import Obstacles
from tests.support import waves
from tests.support.forked import run
from tests.support.places import SAMPLES

CUTTER = Cutter.flat(radius=5, length=60)


@pytest.fixture(scope="module")
def found():
    return plan(SAMPLES / "pocket_top.step", cutters=[CUTTER], spacing=6.0, area_budget=0, posture_maps=True)


def free(maps, sample, rotation):
    row = sample * len(maps.rotations) + rotation
    return maps.free[maps.offset[row] : maps.offset[row + 1]]


def test_every_tilt_in_a_free_interval_is_safe(found):
    rng = np.random.default_rng(0)
    samples, maps = found.samples, found.maps
    n, k = maps.undecided.shape
    i, j = rng.integers(0, n, 4000), rng.integers(0, k, 4000)
    rows, tilts = [], []
    for sample, rotation in zip(i, j, strict=True):
        intervals = free(maps, sample, rotation)
        if len(intervals):
            low, high = intervals[rng.integers(len(intervals))]
            rows.append((sample, rotation))
            tilts.append(rng.choice([low, high, rng.uniform(low, high)]))
    sample, rotation = np.array(rows).T
    tilt, turn = np.array(tilts), maps.rotations[rotation]
    n, e1 = samples.normal[sample], samples.direction_max[sample]
    tilt_direction = np.cos(turn)[:, None] * e1 + np.sin(turn)[:, None] * np.cross(n, e1)
    axis = np.cos(tilt)[:, None] * n + np.sin(tilt)[:, None] * tilt_direction
    obstacles = Obstacles(tessellate(found.part, 0.002))
    hit = np.zeros(len(tilt), np.int32)
    # A hair shallower than what the map was made with: the ends are exact.
    depth = 0.01 - obstacles.triangles.chord_error + 1e-9
    probe(np.arange(len(tilt)), samples.point[sample], n, axis, tilt_direction, waves.flat(CUTTER.radius, CUTTER.length, depth),
          obstacles.tree, hit, hit.copy())  # fmt: skip
    assert len(tilt) > 2000
    assert (hit < 0).all()


@pytest.mark.slow("judges many samples")
def test_the_one_point_map_says_the_same(found):
    samples, maps = found.samples, found.maps
    for sample in range(0, len(samples), 17):
        one = posture_map(found.part, point=samples.point[sample], cutter=CUTTER, rotations=maps.rotations, tolerance=0.01)
        if not np.allclose(one.direction_max, samples.direction_max[sample], atol=1e-6):
            continue  # on an edge the nearest face may be another
        for j in range(0, len(maps.rotations), 5):
            here, there = free(maps, sample, j), one.free[j]
            wide = maps.undecided[sample, j] + (one.undecided[j][:, 1] - one.undecided[j][:, 0]).sum()
            total = [(x[:, 1] - x[:, 0]).sum() for x in (here, there)]
            assert total[0] == pytest.approx(total[1], abs=wide + np.radians(0.25))


def test_free_and_undecided_never_exceed_what_was_asked(found):
    maps = found.maps
    width = np.zeros(maps.undecided.size)
    row = np.repeat(np.arange(maps.undecided.size), np.diff(maps.offset))
    np.add.at(width, row, maps.free[:, 1] - maps.free[:, 0])
    assert (width + maps.undecided.ravel() <= np.pi / 2 + 1e-5).all()
    assert (maps.free[:, 1] > maps.free[:, 0]).all()
    same = row[1:] == row[:-1]
    assert (maps.free[1:, 0] >= maps.free[:-1, 1])[same].all()


def test_accessible_samples_have_a_free_tilt_and_threads_do_not_matter(found):
    maps = found.maps
    has = np.diff(maps.offset).reshape(maps.undecided.shape).any(axis=1)
    assert has[found.reaches[CUTTER.id].reached].mean() > 0.999
    again = plan(found.part, cutters=[CUTTER], spacing=6.0, area_budget=0, posture_maps=True, jobs=1).maps
    for name in ("offset", "free", "undecided"):
        assert getattr(again, name).tobytes() == getattr(maps, name).tobytes()


def test_the_command_writes_them(tmp_path):
    done = run(SAMPLES / "v_groove.step", "--cutter", "R8L90", "--grid", "5", "--area-budget", "0", "--posture-maps", "--formats",
               "json", "-o", "out", cwd=tmp_path)  # fmt: skip
    assert done.returncode in (0, 1), done.stderr
    arrays = np.load(tmp_path / "out" / "postures.npz")
    assert arrays["offset_R8L90"][-1] == len(arrays["free_R8L90"])


def test_maps_do_not_depend_on_the_machine(found):
    other = plan(found.part, cutters=[CUTTER], spacing=6.0, area_budget=0, posture_maps=True, machine="tilt:25").maps
    assert other == found.maps


def horn(major=8.2, minor=8.0):
    """A torus with hardly a hole: a few lines of STEP, one face, hundreds of thousands of triangles."""
    from OCP.BRepPrimAPI import BRepPrimAPI_MakeTorus

    return BRepPrimAPI_MakeTorus(major, minor).Shape()


def test_maps_keep_to_an_amount_of_work(monkeypatch):
    """What would take too long is left out evenly, undecided at every tilt, and said; the rest is as it would be."""
    from plan_cutters.judging import posture_maps as map_budget

    options = {"cutters": "R0.5L20", "faces": "all", "grid": 21, "tolerance": 0.05, "area_budget": 0, "posture_maps": True,
               "rotation_step": np.pi / 2}  # fmt: skip
    whole = plan(horn(), **options)
    assert whole.maps.unmapped == 0
    assert not [note for note in whole.plan.notes if "not mapped" in note]
    monkeypatch.setattr(map_budget, "WORK", 2_000)
    for more in ({}, {"map_budget": 50}):
        few = plan(whole.part, **options, **more)
        n, maps = len(few.samples), few.maps
        left = (maps.undecided == np.float32(np.pi / 2)).all(axis=1) & (np.diff(maps.offset).reshape(n, -1) == 0).all(axis=1)
        assert 0 < maps.unmapped < n
        assert left.sum() >= maps.unmapped
        (note,) = [note for note in few.plan.notes if "not mapped" in note]
        assert f"Postures of {maps.unmapped} of {n} samples" in note
        if more:
            assert n - maps.unmapped == 50
        # Evenly spread: no long run without any.
        mapped = np.flatnonzero(~left)
        assert np.diff(mapped).max(initial=0) <= 4 * n / max(1, n - maps.unmapped) + 40
        again = plan(whole.part, **options, **more, jobs=1).maps
        assert again == maps


def test_what_is_missing_is_named_in_the_file(tmp_path):
    from tests.support.cad_parts import box, compound, triangulated

    scene = compound(box(60, 60, 10), triangulated(box(40, 40, 2, at=(-20, -20, 13))))
    result = plan(scene, posture_maps=True, cutters="R4L40", faces="6", grid=9, area_budget=0, rotation_step=np.pi / 6)
    result.write(tmp_path, ("json",))
    about = json.loads(str(np.load(tmp_path / "postures.npz")["about"].reshape(-1)[0]))
    assert tuple(about["missing"]) == result.maps.missing != ()
    assert about["unmapped"] == 0
    assert (result.maps.verdict == UNDECIDED).any()
