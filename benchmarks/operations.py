"""How long the plan of operations takes after the plan itself, and what it finds: one line a part.

    python benchmarks/operations.py [FOLDER]

FOLDER holds public CAD files (`DATA.md`); without it the samples alone are planned. Seconds are by the clock: run it on a quiet
machine. `probes`: millions of times that a tool was put down.
"""

import sys
import time
from pathlib import Path

from plan_cutters import plan

SAMPLES = Path(__file__).parents[1] / "samples"
CASES = {
    "peaks 61": ("peaks_and_valleys.step", {"cutters": "R6L80", "grid": 61}),
    "peaks 201": ("peaks_and_valleys.step", {"cutters": "R6L80", "grid": 201}),
    "peaks 201, 5 deg": (
        "peaks_and_valleys.step",
        {"cutters": "R6L80", "grid": 201, "index_step": 0.08726646259971647},
    ),
    "pocket_top": ("pocket_top.step", {"cutters": "R6L80", "faces": "all", "spacing": 2.0}),
    "control_arm": (
        "control_arm.step",
        {"cutters": "R6L60rc6", "faces": "all", "spacing": 3.0, "holder": "R15L40+R25L60"},
    ),
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


def main() -> None:
    """Plan each case with the fewest operations, and with the fastest."""
    plan(SAMPLES / "pocket_top.step", cutters="R6L80", grid=4, operations="both", feed=2000, area_budget=0)
    cases = {name: (SAMPLES / file, more) for name, (file, more) in CASES.items()}
    if len(sys.argv) > 1:
        cases |= {name: (Path(sys.argv[1]) / file, more) for name, (file, more) in REAL.items()}
    print(
        "part                samples  fewest (at least, proof)        candidates  deg   probes M  plan s  fewest s  both s"
    )
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
        print(
            f"{name:18} {len(result.samples):8}  {found:30} {few.candidates:11}  {few.spacing_deg:4.2g} {spent}",
            flush=True,
        )


if __name__ == "__main__":
    main()
