"""The seed's second example: `peaks_and_valleys.step`, 201 x 201 samples, 36 rotations, tolerance 0.01 mm.

`python benchmarks/example2.py` prints the figures that the README quotes. Seconds a cutter are dummy tests and search
with compiled kernels; the whole command is timed in a process of its own, files included, after a first one that
may compile.
"""

import subprocess
import sys
import tempfile
import time
from pathlib import Path

from plan_cutters import Cutter, plan

PART = Path(__file__).parent.parent / "samples" / "peaks_and_valleys.step"
SPECS = ("R12L120", "R10L100", "R8L90", "R6L80")


def seconds(*words: str) -> float:
    began = time.perf_counter()
    subprocess.run([sys.executable, "-m", "plan_cutters", *words], check=False, capture_output=True)
    return time.perf_counter() - began


def main() -> None:
    cutters = [Cutter.parse(spec) for spec in SPECS]
    runs = [plan(PART, cutters=cutters, grid=201) for _ in range(3)]
    plan_ = runs[0].plan
    print(f"samples {plan_.samples.count}, obstacle triangles {plan_.effective.obstacle_triangles}")
    convex = plan_.samples.convex
    print(f"convex {100 * convex / plan_.samples.count:.1f} % of the samples")
    for i, entry in enumerate(plan_.cutters):
        best = min(run.cutters[i].seconds for run in runs)
        print(f"{entry.id:8} feasible {entry.feasible!s:5}  free {100 * entry.interference_free / convex:.1f} % of convex  "
              f"lost {entry.inaccessible + entry.undecided:5}  {best:.2f} s")  # fmt: skip
    with tempfile.TemporaryDirectory() as folder:
        words = [str(PART), *(w for s in SPECS for w in ("--cutter", s)), "--grid", "201", "-o", f"{folder}/out"]
        seconds(*words)
        print(f"whole command, four cutters, files included: {seconds(*words):.1f} s")
    seconds("--help")
    print(f"plan-cutters --help: {seconds('--help'):.2f} s")


if __name__ == "__main__":
    main()
