"""Tools of all kinds on `peaks_and_valleys.step`, 201 x 201 samples, 36 rotations: seconds of search, against a flat end.

`python benchmarks/tools.py` prints dummy tests and search of each tool alone, best of five, as a ratio to the flat end of its
radius, then ten tools in one plan.
"""

import math
import sys
from pathlib import Path

from plan_cutters import Cutter
from plan_cutters.document.clock import Clock
from plan_cutters.options import Options
from plan_cutters.pipeline import judge, prepare, run

PART = Path(__file__).parent.parent / "samples" / "peaks_and_valleys.step"
HOLDER = "R12.5L6+R13:20L10+R20L10+R18:22L8+R22L10+R30L40"
BEST_OF = 5


def assembled(radius: float, corner: float, length: float = 60.0) -> Cutter:
    """A tool with a shank and a holder of six stages."""
    return Cutter(radius, length, corner, flutes=20.0, shank_radius=radius, holder=HOLDER)  # type: ignore[arg-type]


TOOLS = (
    Cutter.flat(radius=6, length=80),
    Cutter.bull(radius=6, corner_radius=1, length=80),
    Cutter.bull(radius=6, corner_radius=3, length=80),
    assembled(6, 1),
    assembled(6, 3),
    Cutter.flat(radius=4, length=60),
    Cutter.ball(radius=4, length=60),
    assembled(4, 4),
    Cutter.ball(radius=2, length=60, taper=math.radians(5)),
    Cutter.barrel(radius=6, flank_radius=85, tip_radius=2, length=80, flutes=22.0),
    Cutter.lollipop(radius=4, neck_radius=2, length=60),
    Cutter.lens(radius=6, bottom_radius=40, corner_radius=1, length=80),
)


def main() -> None:
    import time

    ready = prepare(PART, Options(cutters=TOOLS, grid=201, area_budget=0))
    flat: dict[float, float] = {}
    print("| tool | pieces | search s | times a flat end | not reached |\n|---|---|---|---|---|")
    for cutter in TOOLS:
        judge(ready, cutter)
        least = math.inf
        for _ in range(BEST_OF):
            began = time.perf_counter()
            reach = judge(ready, cutter)
            least = min(least, time.perf_counter() - began)
        if cutter.plain:
            flat[cutter.radius] = least
        ratio = f"{least / flat[cutter.radius]:.2f}" if cutter.radius in flat else ""
        pieces = ready.conditions.light(cutter).piece.shape[1]
        print(f"| {cutter.id} | {pieces} | {least:.3f} | {ratio} | {int((~reach.reached).sum())} |", flush=True)
    ten = [each for each in TOOLS if not each.plain]
    result = run(PART, Options(cutters=tuple(ten), grid=201, area_budget=0), Clock(None))
    print(f"{len(ten)} tools in one plan: {sum(each.seconds for each in result.cutters):.2f} s of search")


if __name__ == "__main__":
    sys.exit(main())
