"""Posture maps of all samples: against single probes, the one-point map and the closed forms; the same for any threads."""

from pathlib import Path

import numpy as np
import pytest
import waves

from cad_io.tessellate import tessellate
from plan_cutters import Cutter, plan, posture_map
from plan_cutters.kernels.search import probe
from plan_cutters.scene.obstacles import Obstacles

SAMPLES = Path(__file__).parent.parent / "samples"
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
    lean = np.cos(turn)[:, None] * e1 + np.sin(turn)[:, None] * np.cross(n, e1)
    axis = np.cos(tilt)[:, None] * n + np.sin(tilt)[:, None] * lean
    obstacles = Obstacles(tessellate(found.part, 0.002))
    hit = np.zeros(len(tilt), np.int32)
    # A hair shallower than what the map was made with: the ends are exact.
    depth = 0.01 - obstacles.triangles.chord_error + 1e-9
    probe(np.arange(len(tilt)), samples.point[sample], n, axis, lean, waves.flat(CUTTER.radius, CUTTER.length, depth),
          obstacles.tree, hit, hit.copy())  # fmt: skip
    assert len(tilt) > 2000
    assert (hit < 0).all()


def test_the_one_point_map_says_the_same(found):
    samples, maps = found.samples, found.maps
    for sample in range(0, len(samples), 17):
        one = posture_map(
            found.part, point=samples.point[sample], cutter=CUTTER, rotations=maps.rotations, tolerance=0.01
        )
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
    import subprocess
    import sys

    done = subprocess.run(
        [sys.executable, "-m", "plan_cutters", str(SAMPLES / "v_groove.step"), "--cutter", "R8L90", "--grid", "5",
         "--posture-maps", "--formats", "json", "-o", str(tmp_path / "out")], capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode in (0, 1), done.stderr
    arrays = np.load(tmp_path / "out" / "postures.npz")
    assert arrays["offset_R8L90"][-1] == len(arrays["free_R8L90"])
