"""Tools of all kinds: how long they take, and whether what is reported free is.

`python benchmarks/tools.py`: dummy tests and search on `peaks_and_valleys.step`, 201 x 201 samples, 36 rotations, each
tool alone, best of five, as a ratio to the flat end of its radius; then ten tools in one plan.

`python benchmarks/tools.py --exact PART ... [--count 10000]`: random postures reported free, a tool of each kind at each
part, against points of the exact surface all over and about the contact. The tool's outline and its depth are those of
`tests/support/tool_reference.py`, which shares no code with the search. Prints the deepest point, mm.
"""

import argparse
import math
import sys
import time
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from cad_io import read_part
from cad_io.part.bodies import orient
from cad_io.sample import sample
from plan_cutters import Cutter, Holder, Segment, plan
from plan_cutters.document.clock import Clock
from plan_cutters.judging.judge import judge
from plan_cutters.options import Options
from plan_cutters.pipeline import prepare, run
from plan_cutters.scene.conditions import Context

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


def speed() -> None:
    """Print seconds of search."""
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
        pieces = Context.of(cutter, ready.conditions).outer_tool.piece.shape[1]
        print(f"| {cutter.id} | {pieces} | {least:.3f} | {ratio} | {int((~reach.reached).sum())} |", flush=True)
    ten = [each for each in TOOLS if not each.plain]
    result = run(PART, Options(cutters=tuple(ten), grid=201, area_budget=0), Clock(None))
    print(f"{len(ten)} tools in one plan: {sum(each.seconds for each in result.cutters):.2f} s of search")


def exact(path: Path, cutter: Cutter, count: int) -> str:
    """The deepest that the exact surface was found in a tool at postures reported free, in words."""
    from tests.support.tool_reference import Reference

    part = read_part(path)
    side = orient(part, towards=np.array([0.0, 0.0, 1.0]), flip=False)
    size = float(np.linalg.norm(part.size))
    cloud = sample(part, side, spacing=size / 250, faces=[face.number for face in part.faces]).point
    # Dense about the contact, where clearances are small; farther away a sixth of the points.
    tree, far = cKDTree(cloud), cloud[::6]
    result = plan(part, cutters=[cutter], spacing=size / 120, area_budget=0)
    reach, samples, (entry,) = result.reaches[cutter.id], result.samples, result.plan.cutters
    rows = np.flatnonzero(reach.reached)
    rng, tool = np.random.default_rng(0), Reference(cutter)
    rows = rows[rng.permutation(len(rows))[:count]] if count < len(rows) else rng.choice(rows, min(count, 20 * len(rows)))
    worst = -math.inf
    for row in rows:
        tilt_direction = reach.tilt_direction[row]
        if reach.interference_free[row]:
            # Free in every rotation.
            turn = rng.uniform(0.0, 2.0 * math.pi)
            tilt_direction = math.cos(turn) * tilt_direction + math.sin(turn) * np.cross(samples.normal[row], tilt_direction)
        tip, frame = tool.frame(samples.point[row], samples.normal[row], tilt_direction, float(reach.tilt[row]))
        near = cloud[tree.query_ball_point(samples.point[row], 3.0 * cutter.radius)]
        x, y, w = ((np.concatenate([far, near]) - tip) @ frame.T).T
        q = np.hypot(x, y)
        close = (w > -1.0) & (w < tool.end + 1.0) & (q < tool.wide + 1.0)
        if close.any():
            worst = max(worst, float(tool.over(q[close], w[close], 0.0, 0.0).max()))
    not_reached = entry.inaccessible + entry.undecided
    return f"{path.name} {cutter.id}: {len(rows)} postures, {len(cloud)} points, {not_reached} lost, deepest {worst:.4f} mm"


def main() -> None:
    words = argparse.ArgumentParser()
    words.add_argument("--exact", nargs="*", type=Path)
    words.add_argument("--count", type=int, default=10_000)
    words.add_argument("--scale", type=float, default=1.0, help="of the tools")
    given = words.parse_args()
    if given.exact is None:
        speed()
        return
    sys.path.insert(0, str(Path(__file__).parent.parent))
    for path in given.exact:
        for cutter in kinds(given.scale):
            print(exact(path, cutter, given.count), flush=True)


def kinds(scale: float) -> list[Cutter]:
    """A tool of each kind."""
    holder = Holder((Segment(8 * scale, 6 * scale, 10 * scale), Segment(12 * scale, 40 * scale)))
    more = {"shank_radius": 3 * scale, "holder": holder}
    return [
        Cutter.flat(radius=3 * scale, length=40 * scale, flutes=15 * scale, **more),
        Cutter.bull(radius=3 * scale, corner_radius=scale, length=40 * scale, flutes=15 * scale, **more),
        Cutter.ball(radius=3 * scale, length=40 * scale, flutes=15 * scale, **more),
        Cutter.ball(radius=1.5 * scale, length=40 * scale, taper=math.radians(5), holder=holder),
        Cutter.bull(radius=2 * scale, corner_radius=0.5 * scale, length=40 * scale, taper=math.radians(3), holder=holder),
        Cutter.lollipop(radius=3 * scale, neck_radius=1.5 * scale, length=40 * scale, holder=holder),
        Cutter.barrel(radius=3 * scale, flank_radius=40 * scale, tip_radius=scale, length=40 * scale, flutes=11 * scale),
        Cutter.lens(radius=4 * scale, bottom_radius=20 * scale, corner_radius=0.5 * scale, length=40 * scale, holder=holder),
        Cutter.form([(0, 0), (2 * scale, 0), (3 * scale, scale), (3 * scale, 8 * scale)], length=40 * scale, holder=holder),
    ]


if __name__ == "__main__":
    main()
