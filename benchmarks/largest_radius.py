"""Largest radius that reaches each sample: processor time, and what the map says.

    python benchmarks/largest_radius.py [PART] [GRID]

By default the 201 x 201 samples of `samples/peaks_and_valleys.step`; tolerance 0.01, 36 rotations, flat and ball ends ten radii
long, radii from 0.5 to 60 mm in steps of 2 %. Processor time of all threads, the best of three, machine code loaded before.
"""

import sys
import time
from pathlib import Path

import numpy as np

from plan_cutters.answers.largest_radius import largest_radius
from plan_cutters.domain.verdicts import INACCESSIBLE, UNDECIDED
from plan_cutters.options import Options
from plan_cutters.pipeline import prepare

PART = Path(__file__).parent.parent / "samples" / "peaks_and_valleys.step"
GRID, RANGE = 201, {"ratio": 10.0, "step": 0.02, "least": 0.5, "most": 60.0}


def main() -> None:
    part, grid = sys.argv[1] if len(sys.argv) > 1 else str(PART), int(sys.argv[2]) if len(sys.argv) > 2 else GRID
    ready = prepare(part, Options(cutters="R6L80", grid=grid))
    print("| end | samples | s | us each | percentiles, mm | no less than most | bottleneck | beyond: lost | not decided |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- | --- |")
    for shape in ("flat", "ball"):
        largest_radius(ready, shape, **RANGE)
        taken = []
        for _ in range(3):
            start = time.process_time()
            found = largest_radius(ready, shape, **RANGE)
            taken.append(time.process_time() - start)
        count, row = int(found.judged.sum()), found.bottleneck
        said = ", ".join(f"{q}: {radius:.3g}" for q, radius in found.percentiles().items())
        print(f"| {shape} | {count} | {min(taken):.2f} | {min(taken) / count * 1e6:.0f} | {said} | {found.no_less.sum()} | "
              f"{row} at {np.round(ready.samples.point[row], 3).tolist()} | {(found.beyond == INACCESSIBLE).sum()} | "
              f"{(found.beyond == UNDECIDED).sum()} |", flush=True)  # fmt: skip


if __name__ == "__main__":
    main()
