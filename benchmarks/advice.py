"""Is the first advice true? Parts are asked as a planner would, and the first step that comes back is followed by command.

`python benchmarks/advice.py [PART ...]`: three cutters with a chuck on a trunnion machine over a table, `--answers mend`; then
the same command with the option of the first step. It prints the share of the area that is not reached at first, the share that
the step promises, the share that a fresh plan finds, and the seconds of both commands. Without parts: real files where they are
at hand.
"""

import argparse
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

REAL = Path(__file__).parent.parent.parent / "shared" / "data" / "cad"
FILES = ("hard/turbo3d_impeller.step", "asitus_repatch-hpdc-colored.stp", "hard/ploopy_secondary_buttons.stp",
         "trimesh_featuretype.STEP", "occt_linkrods.step", "asitus_control_arm.step")  # fmt: skip
CUTTERS = ("--cutter", "D6L40", "--cutter", "D4L30rc2", "--cutter", "D2L20rc1")
WORDS = ("--holder", "er16", "--machine", "trunnion-ac", "--fixture", "table")
#: As in samples.npz.
REACHED, UNJUDGED = (1, 2), 255


def asked(part: Path, out: Path, words: list[str]) -> tuple[dict[str, Any], float]:
    """A plan by command, and its seconds."""
    began = time.monotonic()
    subprocess.run([sys.executable, "-m", "plan_cutters", str(part), *words, "--area-budget", "0", "--formats", "json,npz", "-o",
                    str(out), "--quiet"], capture_output=True, check=False)  # fmt: skip
    return json.loads((out / "plan.json").read_text()), time.monotonic() - began


def not_reached(folder: Path, cutters: list[str]) -> float:
    """The share of the finished area, by the areas of samples, that none of some cutters reaches."""
    with np.load(folder / "samples.npz") as found:
        wanted = (found["surface_class"] != UNJUDGED) & ~found["inside_bodies"]
        left = np.logical_and.reduce([~np.isin(found[f"verdict_{name}"], REACHED) for name in cutters])
        return float(found["area"][wanted & left].sum() / found["area"][wanted].sum())


def row(part: Path) -> str:
    """One line of the table."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        plan, seconds = asked(part, folder / "now", [*CUTTERS, *WORDS, "--answers", "mend"])
        entries = [c for c in plan["cutters"] if c["mend"]]
        best = min(entries, key=lambda c: c["mend"]["lost_share"], default=None)
        step = next((s for s in best["mend"]["steps"] if s["option"]), None) if best else None
        if step is None:
            return f"| {part.name} | no step that is typed | | | | {seconds:.0f} | |"
        typed = step["option"].split()
        kept = [w for k in range(0, len(WORDS), 2) if WORDS[k] not in typed for w in WORDS[k : k + 2]]
        _, again = asked(part, folder / "then", [*CUTTERS, *kept, *typed])
        shares = (not_reached(folder / "now", [best["id"]]), step["lost_after"], not_reached(folder / "then", step["cutters"]))
    told = " | ".join(f"{100 * share:.2f} %" for share in shares)
    return f"| {part.name} | {step['why']} | {told} | {seconds:.0f} | {again:.0f} |"


def main() -> None:
    words = argparse.ArgumentParser()
    words.add_argument("parts", nargs="*", type=Path)
    parts = words.parse_args().parts or [REAL / name for name in FILES if (REAL / name).exists()]
    titles = "part", "first step", "lost now", "promised", "found", "s", "s again"
    print("| " + " | ".join(titles) + " |\n|" + "---|" * len(titles), flush=True)
    for part in parts:
        print(row(part), flush=True)


if __name__ == "__main__":
    main()
