"""Least stick-out: seconds of the search for one cutter, and what it says.

    python benchmarks/stick_out.py [PART] [GRID]

By default the 201 x 201 samples of `samples/peaks_and_valleys.step`; tolerance 0.01, 36 rotations, a spindle-like holder. Seconds
by the clock and of the processor, all threads, the best of three, machine code loaded before; beside them the search that judges.
"""

import sys
import time
from pathlib import Path

from plan_cutters import Cutter, Options
from plan_cutters.answers.stick_out import least_stick_out
from plan_cutters.domain.verdicts import REASONS, UNDECIDED
from plan_cutters.judging.judge import judge
from plan_cutters.pipeline import prepare

PART = Path(__file__).parent.parent / "samples" / "peaks_and_valleys.step"
HOLDER = "R25:40L5+R40L25+R40:80L30+R80L60"
CUTTERS = ("R4L60F6S4", "R6L80F10S6", "R6L80rc1F10S6", "R4L80rc4F10S4", "R12L90F12S12")


def main() -> None:
    part, grid = sys.argv[1] if len(sys.argv) > 1 else str(PART), int(sys.argv[2]) if len(sys.argv) > 2 else 201
    cutters = tuple(Cutter.parse(text) for text in CUTTERS)
    ready = prepare(part, Options(cutters=cutters, holder=HOLDER, grid=grid))
    print(f"{part}: {len(ready.samples)} samples, {len(ready.conditions.obstacles.triangles)} triangles")
    print("| cutter | judging, s | least stick-out, s | processor s | each sample to 0.5 mm, s | mm | limited by | below it |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    for cutter in ready.cutters:
        reach = judge(ready, cutter)
        judging, clock, processor = [], [], []
        for _ in range(3):
            start = time.perf_counter()
            reach = judge(ready, cutter)
            judging.append(time.perf_counter() - start)
            start, began = time.perf_counter(), time.process_time()
            found = least_stick_out(ready, cutter, reach)
            clock.append(time.perf_counter() - start)
            processor.append(time.process_time() - began)
        start = time.perf_counter()
        least_stick_out(ready, cutter, reach, step=0.5)
        each = time.perf_counter() - start - min(clock)
        below = "" if found.sample < 0 else "undecided" if found.verdict == UNDECIDED else "inaccessible"
        not_reached = int(reach.not_reached.sum())
        name = cutter.id.split("H")[0] + (
            f" ({not_reached} lost, {REASONS[int(reach.reason[reach.not_reached][0])]})" if not_reached else ""
        )
        print(f"| {name} | {min(judging):.2f} | {min(clock):.2f} | {min(processor):.2f} | {each:.1f} | "
              f"{found.least:.3f} | {found.why} {found.sample} | {below} |", flush=True)  # fmt: skip


if __name__ == "__main__":
    main()
