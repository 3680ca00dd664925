"""What would make it feasible: how long that takes, as a ratio to planning the part with that cutter.

`python benchmarks/mend.py [PART ...]`: for each part a few cutters that do not finish it; plan (reading, sampling,
tessellation, judging) and mend, processor and wall seconds, the least of a few runs in turn, and the changes that help.
Without parts: the samples, and real files where they are at hand.
"""

import argparse
import time
from pathlib import Path
from typing import Any

from plan_cutters import Cutter, plan
from plan_cutters.answers.mend import mend
from plan_cutters.options import Options
from plan_cutters.pipeline import prepare
from plan_cutters.stages.judge import judge

ROOT = Path(__file__).parent.parent
REAL = ROOT.parent / "shared" / "data" / "cad"
SAMPLES = [ROOT / "samples" / name for name in ("peaks_and_valleys.step", "blade.step", "pocket_top.step")]
FILES = [REAL / name for name in ("asitus_control_arm.step", "tigl_nacelle.stp", "bladex_upper.iges")]
RUNS = 3


def cases(size: float) -> list[dict[str, Any]]:
    """Cutters of a share of a part's size, each with what may stop it: its holder, its radius, the machine, all of these."""
    r = float(f"{size / 60:.2g}")
    above = {"flutes": 3 * r, "shank_radius": r, "holder": f"R{10 * r:g}L{40 * r:g}"}
    return [
        {"cutters": Cutter.flat(radius=r, length=4 * r, **above), "machine": "tilt:15"},
        {"cutters": Cutter.ball(radius=r, length=8 * r, **above)},
        {"cutters": Cutter.ball(radius=12 * r, length=40 * r)},
        {"cutters": Cutter.bull(radius=2 * r, corner_radius=r / 2, length=20 * r), "machine": "tilt:8"},
        {"cutters": Cutter.flat(radius=6 * r, length=40 * r), "machine": "tilt:2"},
    ]


def main() -> None:
    words = argparse.ArgumentParser()
    words.add_argument("parts", nargs="*", type=Path)
    parts = words.parse_args().parts or [*SAMPLES, *(path for path in FILES if path.exists())]
    titles = "part", "cutter", "samples", "lost", "plan s", "mend s", "ratio", "ratio, wall clock", "helps"
    print("| " + " | ".join(titles) + " |\n|" + "---|" * len(titles))
    for path in parts:
        size = max(prepare(path, Options(grid=2)).scene.part.size)
        for options in cases(float(size)):
            if line := row(path, options):
                print(line, flush=True)


def row(path: Path, options: dict[str, Any]) -> str:
    """One line of the table; none if the cutter finishes."""
    ready = prepare(path, Options(**options))
    cutter = ready.cutters[0]
    reach = judge(ready, cutter)
    if reach.reached[ready.samples.unjudged < 0].all():
        return ""
    plans, mends = [], []
    for _ in range(RUNS):
        plans.append(timed(lambda: plan(path, **options)))
        mends.append(timed(lambda: mend(ready, cutter, reach)))
    (cpu, wall), (mend_cpu, mend_wall) = (tuple(map(min, zip(*each, strict=True))) for each in (plans, mends))
    found = mend(ready, cutter, reach)
    helps = "; ".join(change.why for change in found.changes if change.helps)
    if found.least is None and found.lost:
        helps = found.why
    name = f"{cutter.id} {options.get('machine', '')}".strip()
    cells = (path.name, name, f"{len(ready.samples)}", f"{found.lost}", f"{cpu:.2f}", f"{mend_cpu:.2f}",
             f"{mend_cpu / cpu:.2f}", f"{mend_wall / wall:.2f}", helps)  # fmt: skip
    return "| " + " | ".join(cells) + " |"


def timed(work: Any) -> tuple[float, float]:
    """Processor and wall seconds."""
    cpu, wall = time.process_time(), time.perf_counter()
    work()
    return time.process_time() - cpu, time.perf_counter() - wall


if __name__ == "__main__":
    main()
