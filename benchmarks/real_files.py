"""Plan every CAD file of a folder with one cutter and write what became of each as a table.

`python benchmarks/real_files.py FOLDER docs/real_files.md` runs the command as a user would, one file at a time.
"""

import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

CUTTER, LIMIT = "R3L40", 300
SUFFIXES = {".step", ".stp", ".iges", ".igs", ".brep"}


def row(file: Path, out: Path) -> list[str]:
    began = time.perf_counter()
    try:
        done = subprocess.run([sys.executable, "-m", "plan_cutters", str(file), "--cutter", CUTTER, "-o", str(out)],
                              capture_output=True, text=True, timeout=LIMIT, check=False)  # fmt: skip
    except subprocess.TimeoutExpired:
        return [file.name, "-", f"> {LIMIT}", "", "", "", "", "", "not finished in time"]
    seconds = f"{time.perf_counter() - began:.1f}"
    if not (out / "plan.json").exists():
        said = done.stderr.strip().splitlines()[-1].removeprefix("plan-cutters: ").replace(f"{file}: ", "")
        return [file.name, str(done.returncode), seconds, "", "", "", "", "", said]
    plan = json.loads((out / "plan.json").read_text())
    faces, entry = plan["faces"], plan["cutters"][0]
    targets = [f for f in faces if f["target"]]
    unjudged = [f for f in targets if not f["samples"]]
    assert len(faces) == plan["part"]["faces"]
    assert all(f["unjudged"] for f in unjudged), "a face was dropped without a word"
    size = " x ".join(f"{s:.4g}" for s in plan["part"]["size_mm"])
    counts = " / ".join(
        str(entry[k]) for k in ("interference_free", "accessible", "undecided", "inaccessible", "unjudged")
    )
    notes = [*plan["part"]["warnings"], *(f"{k} whole: {v}" for k, v in plan["split"].items())]
    return [
        file.name, str(done.returncode), seconds, size, str(len(faces)), f"{len(targets) - len(unjudged)} + {len(unjudged)}",
        counts, f"{plan['effective']['tolerance_mm']:.3g}", "; ".join(notes)[:240],
    ]  # fmt: skip


def main(folder: str, target: str) -> None:
    files = sorted(f for f in Path(folder).rglob("*") if f.suffix.lower() in SUFFIXES)
    rows = []
    with tempfile.TemporaryDirectory() as scratch:
        for i, file in enumerate(files):
            rows.append(row(file, Path(scratch) / str(i)))
            print(" | ".join(rows[-1]), flush=True)
    head = ["file", "exit", "seconds", "size mm", "faces", "targets judged + unjudged",
            "free / accessible / undecided / inaccessible / unjudged samples", "tolerance mm", "said"]  # fmt: skip
    lines = [
        "# Real files",
        "",
        f"Made by `python benchmarks/real_files.py`: each file planned with `--cutter {CUTTER}` and default spacing.",
        "Exit codes: 0 feasible, 1 not feasible, 3 refused, 4 feasible as far as judged.",
        "",
        *("| " + " | ".join(cells) + " |" for cells in (head, ["---"] * len(head), *rows)),
    ]
    Path(target).write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main(*sys.argv[1:3])
