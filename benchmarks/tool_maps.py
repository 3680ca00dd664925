"""Posture maps of tools of every kind beside a flat end of the same size.

    python benchmarks/tool_maps.py

60 of the 201 x 201 samples of `samples/peaks_and_valleys.step` (seed 0), 36 rotations, processor time of one thread, the best of
four.
"""

import time
from pathlib import Path

import numpy as np

from plan_cutters import Cutter
from plan_cutters.judging.posture_maps import NARROWEST
from plan_cutters.kernels.maps.free_map import free_map
from plan_cutters.options import Options
from plan_cutters.pipeline import prepare
from plan_cutters.scene.conditions import Context, contacts_of

PART = Path(__file__).parent.parent / "samples" / "peaks_and_valleys.step"
HOLDER = "R12.5L6+R13:20L10+R20L10+R18:22L8+R22L10+R30L40"
STAGES = {"radius": 6, "length": 60, "flutes": 20.0, "shank_radius": 6.0, "holder": HOLDER}
TOOLS = {
    "flat R6L80": Cutter.parse("R6L80"),
    "bull R6rc1": Cutter.parse("R6L80rc1"),
    "bull R6rc3": Cutter.parse("R6L80rc3"),
    "ball R6": Cutter.parse("R6L80rc6"),
    "taper ball R2 5 deg": Cutter.parse("R2L80rc2T5"),
    "flat, shank, six stages": Cutter.flat(**STAGES),
    "bull rc1, shank, six stages": Cutter.bull(corner_radius=1, **STAGES),
    "ball, shank, six stages": Cutter.ball(**STAGES),
}
SAMPLES, TURNS, ROOM = 60, 36, 8


def main() -> None:
    options = Options(cutters=tuple(TOOLS.values()), grid=201, rotation_step=2.0 * np.pi / TURNS)
    ready = prepare(str(PART), options)
    contacts, obstacles = contacts_of(ready.samples), ready.conditions.obstacles
    rows = np.sort(np.random.default_rng(0).permutation(len(ready.samples))[:SAMPLES])
    part, count, unsure = (np.zeros((SAMPLES, TURNS, ROOM, 2)), np.zeros((SAMPLES, TURNS), np.int32), np.zeros((SAMPLES, TURNS)))
    print("| tool | us a rotation | free deg | undecided deg |\n| --- | --- | --- | --- |")
    for name, cutter in TOOLS.items():
        tool, best = Context.of(cutter, ready.conditions).outer, np.inf
        for _ in range(4):
            start = time.process_time()
            free_map(
                rows, contacts, ready.conditions.ranges, tool, NARROWEST, obstacles.tree, obstacles.wide_tree, ROOM, part,
                count, unsure,
            )  # fmt: skip
            best = min(best, time.process_time() - start)
        free = np.where(np.arange(ROOM) < count[..., None], part[..., 1] - part[..., 0], 0.0).sum(-1)
        print(
            f"| {name} | {best / SAMPLES / TURNS * 1e6:.1f} | {np.degrees(free.mean()):.2f} | {np.degrees(unsure.mean()):.3f} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
