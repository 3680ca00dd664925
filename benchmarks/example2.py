"""The seed's second example: `peaks_and_valleys.step`, 201 x 201 samples, 36 rotations, tolerance 0.01 mm.

`python benchmarks/example2.py` prints the figures that docs/benchmarks.md quotes. Seconds a cutter are dummy tests and search
with compiled kernels, each cutter alone, so that none hands postures to another; `point obstacles` are the samples
themselves, as in the paper. `--maps` adds posture maps of all samples at 72 rotations. The whole command is timed in a
process of its own, files included, after a first one that may compile.
"""

import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

from cad_io.arrays import Triangles
from cad_io.tessellate import tessellate
from plan_cutters import Cutter, Machine, plan
from plan_cutters.domain.posture import PostureRange
from plan_cutters.judging.phases import CONVEX, access, decompose
from plan_cutters.judging.posture_maps import posture_maps
from plan_cutters.scene.conditions import Conditions, Context
from plan_cutters.scene.obstacles import Obstacles
from plan_cutters.scene.surroundings import Surroundings

PART = Path(__file__).parent.parent / "samples" / "peaks_and_valleys.step"
SPECS = ("R12L120", "R10L100", "R8L90", "R6L80")
TOLERANCE, BEST_OF = 0.01, 5


def seconds(*words: str) -> float:
    began = time.perf_counter()
    subprocess.run([sys.executable, "-m", "plan_cutters", *words], check=False, capture_output=True)
    return time.perf_counter() - began


def given(obstacles: Obstacles, postures: PostureRange) -> Conditions:
    return Conditions(Machine(), np.array([0.0, 0.0, 1.0]), postures, Surroundings.sheet(obstacles), TOLERANCE, jobs=2)


def existence(result: Any, obstacles: Obstacles, cutter: Cutter) -> tuple[float, float, int]:
    """Best wall and processor seconds of dummy tests and search, and samples not reached."""
    samples, best = result.samples, [np.inf, np.inf]
    context = Context.of(cutter, given(obstacles, PostureRange()))
    for _ in range(BEST_OF):
        wall, processor = time.perf_counter(), time.process_time()
        free = decompose(samples, result.surface_class == CONVEX, context)
        reach = access(samples, free, context)
        best = [min(best[0], time.perf_counter() - wall), min(best[1], time.process_time() - processor)]
    return best[0], best[1], int((~reach.reached).sum())


def all_maps(result: Any, obstacles: Obstacles, cutter: Cutter) -> None:
    """Posture maps of all samples at 72 rotations."""
    wall, processor = time.perf_counter(), time.process_time()
    maps = posture_maps(
        result.samples, Context.of(cutter, given(obstacles, PostureRange(step=np.radians(5)))), result.reaches[cutter.id]
    )
    wide = np.degrees(maps.undecided)
    print(f"posture maps, {wide.shape[1]} rotations: {time.perf_counter() - wall:.1f} s "
          f"(processor {time.process_time() - processor:.1f}), {len(maps.free)} intervals")  # fmt: skip
    print(f"undecided a rotation: {wide.mean():.3f} deg on average, {(wide > 0.2 + 1e-6).mean():.2%} more than 0.2 deg, "
          f"most {wide.max():.2f} deg")  # fmt: skip


def main() -> None:
    cutters = [Cutter.parse(spec) for spec in SPECS]
    result = plan(PART, cutters=cutters, grid=201, area_budget=0)
    samples, convex = result.samples, result.plan.samples.convex
    triangles = Obstacles(tessellate(result.part, 0.2 * TOLERANCE))
    points = Obstacles(Triangles(np.repeat(samples.point[:, None], 3, axis=1), samples.face, 0.0, ()))
    print(f"samples {len(samples)}, obstacle triangles {len(triangles.triangles)}, 36 rotations, two threads")
    print(f"convex {100 * convex / len(samples):.1f} % of the samples")
    for cutter, entry in zip(cutters, result.plan.cutters, strict=True):
        print(f"{entry.id:8} feasible {entry.feasible!s:5}  free {100 * entry.interference_free / convex:.1f} % of convex")
        for name, obstacles in (("certified", triangles), ("point obstacles", points)):
            wall, processor, not_reached = existence(result, obstacles, cutter)
            print(f"         {name}: {wall:.3f} s (processor {processor:.3f}), {not_reached} not reached")
    if "--maps" in sys.argv:
        all_maps(result, triangles, cutters[-1])
    with tempfile.TemporaryDirectory() as folder:
        words = [str(PART), *(w for s in SPECS for w in ("--cutter", s)), "--grid", "201", "-o", f"{folder}/out"]
        seconds(*words)
        print(f"whole command, four cutters, files included: {seconds(*words):.1f} s")
        print(f"the same with --area-budget 0: {seconds(*words, '--area-budget', '0'):.1f} s")
    seconds("--help")
    print(f"plan-cutters --help: {seconds('--help'):.2f} s")


if __name__ == "__main__":
    main()
