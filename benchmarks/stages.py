"""Time the whole command, stage by stage, on real CAD files.

`python benchmarks/stages.py FOLDER...` plans every STEP and IGES file of the folders with one cutter, writes all four
files, and prints a table in Markdown: seconds of the command by the clock, processor seconds of it and all its processes,
and the seconds of each stage. Two runs a file: the second one is printed, so that machine code is made and files are read.
Run it on a machine that does nothing else. `--limit SECONDS` ends a command (300), `--once` leaves the first run out.
"""

import argparse
import json
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

CUTTER = "R3L40"
SUFFIXES = {".step", ".stp", ".iges", ".igs"}


class Run(NamedTuple):
    """One command: exit code (None: ended at the limit), seconds, seconds by stage; faces of mixed verdicts, those left whole."""

    code: int | None
    seconds: float
    processor: float
    stages: dict[str, float]
    mixed: int = 0
    whole: int = 0
    said: str = ""


def command(file: Path, limit: float) -> Run:
    """Plan a file in a folder that is thrown away."""
    with tempfile.TemporaryDirectory() as folder:
        out, before, began = Path(folder) / "out", _spent(), time.perf_counter()
        words = [sys.executable, "-m", "plan_cutters", str(file), "--cutter", CUTTER, "-o", str(out), "--quiet"]
        child = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        try:
            _, errors = child.communicate(timeout=limit)
            code = child.returncode
        except subprocess.TimeoutExpired:
            child.terminate()
            errors, code = child.communicate()[1], None
        seconds, processor = time.perf_counter() - began, _spent() - before
        if not (out / "plan.json").exists():
            return Run(code, seconds, processor, {}, said=" ".join(errors.split())[-120:])
        plan = json.loads((out / "plan.json").read_text())
    rungs = [entry["rung"] for entry in plan["split"].values()]
    return Run(code, seconds, processor, plan["run"]["seconds"], len(rungs), sum(rung != "contour" for rung in rungs))


def _spent() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def rows(files: list[Path], limit: float, once: bool) -> Iterator[list[str]]:
    """Table rows, each as soon as it is measured."""
    measured: list[float] = []
    for file in files:
        run = command(file, limit)
        if not once and run.code is not None:
            run = command(file, limit)
        measured.append(run.seconds)
        longest = sorted(run.stages.items(), key=lambda each: -each[1])
        stages = ", ".join(f"{name} {seconds:.1f}" for name, seconds in longest if seconds >= 0.1)
        yield [file.name, "ended" if run.code is None else str(run.code), f"{run.seconds:.1f}", f"{run.processor:.1f}",
               f"{run.whole} of {run.mixed}", stages or run.said]  # fmt: skip
    yield ["median", "", f"{statistics.median(measured):.1f}", "", "", ""]
    yield ["largest", "", f"{max(measured):.1f}", "", "", ""]


def main() -> None:
    """Measure the files of the folders given."""
    words = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    words.add_argument("folders", nargs="+", type=Path)
    words.add_argument("--limit", type=float, default=300.0)
    words.add_argument("--once", action="store_true")
    given = words.parse_args()
    files = [f for folder in given.folders for f in sorted(folder.iterdir()) if f.suffix.lower() in SUFFIXES]
    head = ["file", "exit", "seconds", "processor", "mixed faces whole", "stages, seconds"]
    for cells in (head, ["---"] * len(head)):
        print("| " + " | ".join(cells) + " |")
    for cells in rows(files, given.limit, given.once):
        print("| " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
