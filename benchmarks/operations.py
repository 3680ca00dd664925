"""How long the plan of operations takes after the plan itself, and what it finds: one line a part.

    python benchmarks/operations.py [FOLDER]

FOLDER holds public CAD files (`DATA.md`); without it the samples alone are planned. Seconds are by the clock: run it on a quiet
machine. `probes`: millions of times that a tool was put down.

    python benchmarks/operations.py --memory [FOLDER]

says instead how much memory each case takes at most, with `--operations both` and without: MB, each in a process of its own.
"""

import multiprocessing
import resource
import sys
import time
from pathlib import Path
from typing import Any

from plan_cutters import plan

SAMPLES = Path(__file__).parents[1] / "samples"
CASES = {
    "peaks 61": ("peaks_and_valleys.step", {"cutters": "R6L80", "grid": 61}),
    "peaks 201": ("peaks_and_valleys.step", {"cutters": "R6L80", "grid": 201}),
    "peaks 201, 5 deg": ("peaks_and_valleys.step", {"cutters": "R6L80", "grid": 201, "index_step": 0.08726646259971647}),
    "pocket_top": ("pocket_top.step", {"cutters": "R6L80", "faces": "all", "spacing": 2.0}),
    "control_arm": ("control_arm.step", {"cutters": "R6L60rc6", "faces": "all", "spacing": 3.0, "holder": "R15L40+R25L60"}),
}
REAL = {
    "featuretype": (
        "trimesh_featuretype.STEP",
        {"cutters": "R6L50rc6F20S6", "faces": "all", "spacing": 2.0, "holder": "R15L40+R25L60"},
    ),
    "hpdc": (
        "asitus_repatch-hpdc-colored.stp",
        {"cutters": "R6L50rc6F20S6", "faces": "all", "spacing": 2.5, "holder": "R15L40+R25L60"},
    ),
}


def peak(file: Path, more: dict[str, Any]) -> float:
    """Most memory, MB, that this process has taken once a plan is made."""
    plan(file, machine="trunnion-ac", area_budget=0, **more)
    size = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return size / (1e6 if sys.platform == "darwin" else 1e3)


def memory(cases: dict[str, tuple[Path, dict[str, Any]]]) -> None:
    """Print the memory of each case, without operations and with both plans."""
    print("part                    plan MB   both MB   ratio")
    for name, (file, more) in cases.items():
        found = []
        for asked in ({}, {"operations": "both", "feed": 2000}):
            with multiprocessing.get_context("spawn").Pool(1) as one:
                found.append(one.apply(peak, (file, {**more, **asked})))
        print(f"{name:22} {found[0]:8.0f}  {found[1]:8.0f}  {found[1] / found[0]:6.2f}", flush=True)


def main() -> None:
    """Plan each case with the fewest operations, and with the fastest."""
    given = [word for word in sys.argv[1:] if word != "--memory"]
    cases = {name: (SAMPLES / file, more) for name, (file, more) in CASES.items()}
    if given:
        cases |= {name: (Path(given[0]) / file, more) for name, (file, more) in REAL.items()}
    if "--memory" in sys.argv:
        memory(cases)
        return
    plan(SAMPLES / "pocket_top.step", cutters="R6L80", grid=4, operations="both", feed=2000, area_budget=0)
    print("part                samples  fewest (at least, proof)        candidates  deg   probes M  plan s  fewest s  both s")
    for name, (file, more) in cases.items():
        took = {}
        for which in ("fewest", "both"):
            began = time.perf_counter()
            result = plan(file, machine="trunnion-ac", operations=which, feed=2000, area_budget=0, **more)
            whole, mine = time.perf_counter() - began, result.plan.run.seconds["operations"]
            took[which] = mine
        entry = result.plan.operations
        few = entry.fewest
        found = f"{few.found} ({few.at_least}, {few.proof})"
        spent = f"{entry.probes / 1e6:9.2f} {whole - mine:7.1f} {took['fewest']:9.1f} {took['both']:7.1f}"
        print(f"{name:18} {len(result.samples):8}  {found:30} {few.candidates:11}  {few.spacing_deg:4.2g} {spent}", flush=True)


if __name__ == "__main__":
    main()
