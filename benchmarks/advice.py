"""Is the first advice true? Parts are asked as a planner would, and the first step that comes back is followed by command.

`python benchmarks/advice.py [PART ...]`: three cutters with a chuck on a trunnion machine over a table, `--answers mend`;
then the same command with the option of the first step. It prints the share of the area that is lost at first, the share that
the step promises, the share that a fresh plan finds, and the seconds of both commands. Without parts: real files where they
are at hand.
"""

import argparse
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

REAL = Path(__file__).parent.parent.parent / "shared" / "data" / "cad"
FILES = ("hard/turbo3d_impeller.step", "asitus_repatch-hpdc-colored.stp", "hard/ploopy_secondary_buttons.stp",
         "trimesh_featuretype.STEP", "occt_linkrods.step", "asitus_control_arm.step")  # fmt: skip
CUTTERS = ("D6L40", "D4L30rc2", "D2L20rc1")
WORDS = ("--holder", "er16", "--machine", "trunnion-ac", "--fixture", "table")


def asked(part: Path, cutters: list[str], words: list[str]) -> tuple[dict[str, Any], float]:
    """A plan by command, and its seconds."""
    typed = [word for cutter in cutters for word in ("--cutter", cutter)]
    with tempfile.TemporaryDirectory() as folder:
        began = time.monotonic()
        subprocess.run([sys.executable, "-m", "plan_cutters", str(part), *typed, *words, "--area-budget", "0", "--formats",
                        "json", "-o", folder, "--quiet"], capture_output=True, check=False)  # fmt: skip
        return json.loads((Path(folder) / "plan.json").read_text()), time.monotonic() - began


def lost(plan: dict[str, Any], cutters: list[str]) -> float:
    """The share of the area that none of some cutters reaches, as the plan's own least set tells; of one its own."""
    if len(cutters) > 1:
        return float(plan["least_set"]["left_share"])
    share = next(c["area_share"] for c in plan["cutters"] if c["id"] == cutters[0])
    return float(share["inaccessible"] + share["undecided"])


def row(part: Path) -> str:
    """One line of the table."""
    plan, seconds = asked(part, list(CUTTERS), [*WORDS, "--answers", "mend"])
    entries = [c for c in plan["cutters"] if c["mend"] and c["mend"]["steps"]]
    best = min(entries, key=lambda c: c["mend"]["lost_share"], default=None)
    steps = [s for s in best["mend"]["steps"] if s["option"]] if best else []
    if not steps:
        return f"| {part.name} | no step that can be typed | | | | {seconds:.0f} | |"
    step = steps[0]
    typed = step["option"].split()
    pairs = [(typed[k], typed[k + 1]) for k in range(0, len(typed), 2)]
    cutters = [value for word, value in pairs if word == "--cutter"] or [best["id"]]
    kept = [w for k in range(0, len(WORDS), 2) if WORDS[k] not in typed for w in WORDS[k : k + 2]]
    others = [w for word, value in pairs if word != "--cutter" for w in (word, value)]
    fresh, again = asked(part, cutters, [*kept, *others])
    found = lost(fresh, step["cutters"] if len(cutters) > 1 else [fresh["cutters"][0]["id"]])
    numbers = (step["lost_before"], step["lost_after"], found)
    return (
        f"| {part.name} | {step['why']} | "
        + " | ".join(f"{100 * x:.2f} %" for x in numbers)
        + f" | {seconds:.0f} | {again:.0f} |"
    )


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
