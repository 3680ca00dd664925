"""Existence search and tree against the number of samples and of triangles: seconds, peak memory, fitted exponents.

`python benchmarks/growth.py` prints markdown tables: `peaks_and_valleys.step`, R6L80, 36 rotations, two threads, warm.
Each size runs in a process of its own, so that its peak memory is its own; the peak before the search is what reading,
sampling and tessellating took. Seconds of the search are dummy tests and posture search, by the clock on the wall and,
since other work may share the machine, by the processor; the exponents are fitted to the latter.
"""

import json
import resource
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np

PART = Path(__file__).parent.parent / "samples" / "peaks_and_valleys.step"
TOLERANCE, JOBS = 0.01, 2
#: Grid lines a side with the default chord; chord errors (mm) with the middle grid, from about 10 k to 2 M triangles.
GRIDS, CHORD, CHORDS, GRID = (100, 200, 400, 800, 1000), 0.2 * TOLERANCE, (0.03, 0.0075, 0.002, 0.0005, 0.00015), 201


def peak() -> float:
    """MB, so far."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def one(grid: int, chord: float) -> dict[str, float]:
    """One size, in this process."""
    from cad_io import read_part
    from cad_io.part.bodies import orient
    from cad_io.sample import sample
    from cad_io.tessellate import tessellate
    from plan_cutters import Cutter
    from plan_cutters.domain.machine import Machine
    from plan_cutters.domain.posture import PostureRange
    from plan_cutters.judging.phases import CONVEX, access, classify, decompose
    from plan_cutters.scene.conditions import Conditions, Context
    from plan_cutters.scene.obstacles import Obstacles
    from plan_cutters.scene.surroundings import Surroundings

    part, cutter = read_part(PART), Cutter.flat(radius=6, length=80)
    orientation = orient(part, towards=(0, 0, 1))

    def search(grid: int, obstacles: Obstacles) -> tuple[float, float, int]:
        samples = sample(part, orientation, grid=grid, faces=[1])
        kind = classify(samples, float(np.linalg.norm(part.size)))
        before.append(peak())
        tolerance = max(TOLERANCE, 4 * obstacles.triangles.chord_error)
        conditions = Conditions(
            Machine(), np.array([0.0, 0.0, 1.0]), PostureRange(), Surroundings.sheet(obstacles), tolerance, JOBS
        )
        began = time.perf_counter(), time.process_time()
        context = Context.of(cutter, conditions)
        free = decompose(samples, kind == CONVEX, context)
        reach = access(samples, free, context)
        return time.perf_counter() - began[0], time.process_time() - began[1], int(reach.reached.sum())

    before: list[float] = []
    obstacles = Obstacles(tessellate(part, 0.05))
    search(20, obstacles)  # compiles
    triangles = tessellate(part, chord)
    tessellated, before = peak(), []
    obstacles = Obstacles(triangles)
    began = time.process_time()
    tree = sum(np.asarray(part).nbytes for part in obstacles.tree)
    built = time.process_time() - began
    wall, processor, reached = search(grid, obstacles)
    return {
        "samples": grid * grid, "triangles": len(triangles), "reached": reached, "tree": built, "tree_mb": tree / 2**20,
        "wall": wall, "processor": processor, "tessellated_mb": tessellated, "before_mb": before[0], "peak_mb": peak(),
    }  # fmt: skip


def exponent(x: Sequence[float], y: Sequence[float]) -> float:
    return float(np.polyfit(np.log(x), np.log(y), 1)[0])


def apart(grid: int, chord: float) -> dict[str, float]:
    """`one` in a process of its own."""
    done = subprocess.run([sys.executable, __file__, str(grid), str(chord)], check=True, capture_output=True, text=True)
    found: dict[str, float] = json.loads(done.stdout)
    return found


COLUMNS = {
    "samples": "samples", "triangles": "triangles", "reached": "reached", "search s": "wall", "processor s": "processor",
    "tree s": "tree", "tree MB": "tree_mb", "peak MB after tessellating": "tessellated_mb", "before the search": "before_mb",
    "in all": "peak_mb",
}  # fmt: skip


def main() -> None:
    for name, key, sizes in (
        ("samples", "samples", [(g, CHORD) for g in GRIDS]),
        ("triangles", "triangles", [(GRID, c) for c in CHORDS]),
    ):
        print(f"\n| {' | '.join(COLUMNS)} |\n|{' --- |' * len(COLUMNS)}", flush=True)
        rows = []
        for size in sizes:
            rows.append(apart(*size))
            cells = [f"{rows[-1][c]:.0f}" if rows[-1][c] >= 100 else f"{rows[-1][c]:.3g}" for c in COLUMNS.values()]
            print(f"| {' | '.join(cells)} |", flush=True)
        x = [r[key] for r in rows]
        print(f"\nExponents in {name}: search {exponent(x, [r['processor'] for r in rows]):.2f}", end="")
        print(f", tree {exponent(x, [r['tree'] for r in rows]):.2f}" if key == "triangles" else "", flush=True)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        print(json.dumps(one(int(sys.argv[1]), float(sys.argv[2]))))
    else:
        main()
