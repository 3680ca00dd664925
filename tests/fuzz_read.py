"""Damage CAD files and plan them, thousands of times: `python tests/fuzz_read.py FOLDER --count 20000 --seed 1`.

A preloaded process forks one child for each mutated file, so that kernel and kernels are loaded once. What the command's
supervisor turns into one line (a crash, a read that hangs) is counted, not blamed. What counts as a fault: an error
without a cause of its own (the command would say "internal error"), a hang after reading, and a plan that ends well though
it judged nothing or lost faces without a word.
"""

import argparse
import os
import re
import select
import signal
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

import numpy as np

SUFFIXES = {".step", ".stp", ".iges", ".igs"}
LARGEST = 300_000  # bytes; larger files only cost time
READING, REST = 10.0, 40.0  # seconds
NUMBERS = [b"0.", b"1.", b"-1.", b"1E300", b"1E-300", b"NaN", b"INF", b"99999999", b"1.E12", b"#1", b"$", b"*", b"''"]


def mutated(data: bytes, rng: np.random.Generator) -> bytes:
    """Flip bytes, drop, double or swap lines, or replace numbers."""
    kind = rng.integers(6)
    if kind == 0:
        out = bytearray(data)
        for _ in range(int(rng.integers(1, 6))):
            out[int(rng.integers(len(out)))] = int(rng.integers(256))
        return bytes(out)
    if kind in (1, 2, 3):
        lines = data.splitlines(keepends=True)
        i, j = (int(k) for k in rng.integers(len(lines), size=2))
        if kind == 1:
            del lines[i]
        elif kind == 2:
            lines.insert(j, lines[i])
        else:
            lines[i], lines[j] = lines[j], lines[i]
        return b"".join(lines)
    found = list(re.finditer(rb"[-+]?\d+\.\d*(E[-+]?\d+)?" if kind == 4 else rb"\d+", data))
    if not found:
        return data
    # One number, or the same damage at a few.
    out = data
    picked = sorted(
        (found[int(k)] for k in rng.integers(len(found), size=int(rng.integers(1, 4)))), key=lambda m: -m.start()
    )
    for match in picked:
        out = out[: match.start()] + NUMBERS[int(rng.integers(len(NUMBERS)))] + out[match.end() :]
    return out


def child(file: Path, pipe: int) -> None:
    """Plan one file; tell stage and outcome over the pipe."""
    from plan_cutters.cli import _guarded
    from plan_cutters.cutter import Cutter
    from plan_cutters.options import Options
    from plan_cutters.pipeline import run

    def tell(stage: str, done: int, _total: int) -> None:
        if done == 0:
            os.write(pipe, f"stage {stage}\n".encode())

    def work() -> tuple[int, str]:
        result = run(str(file), Options(cutters=(Cutter.parse("R3L40"),), grid=4, tolerance=0.1, jobs=1), progress=tell)
        plan = result.plan
        judged = plan.samples.count - plan.samples.unjudged
        silent = [f.id for f in plan.faces if f.target and not f.samples and not f.unjudged]
        if not judged or silent or len(plan.faces) != plan.part.faces:
            return 0, f"EMPTY judged {judged}, silent {silent}"
        text = file.read_bytes()
        if text.lstrip().startswith(b"ISO-10303"):
            said = len(re.findall(rb"=\s*(?:ADVANCED_FACE|FACE_SURFACE)\s*\(", text))
            if said > plan.part.faces and not plan.part.warnings:
                return 0, f"LOST {said} faces in the text, {plan.part.faces} read, no warning"
        return 0, "planned"

    code, line = _guarded(work, debug=False)
    os.write(pipe, f"done {code} {line}\n".encode())


def attempt(file: Path) -> tuple[str, str]:
    """Outcome and detail of one mutated file."""
    here, there = os.pipe()
    pid = os.fork()
    if pid == 0:
        os.close(here)
        quiet = os.open(os.devnull, os.O_WRONLY)
        os.dup2(quiet, 1)
        os.dup2(quiet, 2)
        try:
            child(file, there)
        finally:
            os._exit(0)
    os.close(there)
    text, stage, since = b"", "start", time.monotonic()
    try:
        while True:
            limit = READING if stage in ("start", "read") else REST
            if not select.select([here], [], [], max(0.0, since + limit - time.monotonic()))[0]:
                os.kill(pid, signal.SIGKILL)
                return ("read ended", "") if stage == "read" else ("HANG", stage)
            data = os.read(here, 1 << 16)
            if not data:
                break
            text += data
            stages = re.findall(rb"stage (\S+)", text)
            if stages and stages[-1].decode() != stage:
                stage, since = stages[-1].decode(), time.monotonic()
    finally:
        os.close(here)
        _, status = os.waitpid(pid, 0)
    done = re.search(rb"done (\d+) (.*)", text)
    if not done:
        return (f"crash at {stage}", "") if os.WIFSIGNALED(status) else ("SILENT", stage)
    code, line = int(done[1]), done[2].decode(errors="replace")
    if "internal error" in line or line.startswith(("EMPTY", "LOST")):
        return "FAULT", line
    return ("planned" if code == 0 else f"refused {code}"), line


def main() -> int:
    words = argparse.ArgumentParser(description=__doc__)
    words.add_argument("folder", type=Path)
    words.add_argument("--count", type=int, default=200)
    words.add_argument("--seed", type=int, default=0)
    words.add_argument("--keep", type=Path, help="folder for the files that show a fault")
    given = words.parse_args()
    from plan_cutters.cutter import Cutter
    from plan_cutters.pipeline import plan

    files = sorted(f for f in given.folder.glob("*") if f.suffix.lower() in SUFFIXES and 0 < f.stat().st_size < LARGEST)
    plan(Path(__file__).parent.parent / "samples" / "v_groove.step", cutters=[Cutter.parse("R3L40")], grid=4)
    rng = np.random.default_rng(given.seed)
    outcomes: Counter[str] = Counter()
    faults = 0
    began = time.monotonic()
    with tempfile.TemporaryDirectory() as scratch:
        for i in range(given.count):
            source = files[int(rng.integers(len(files)))]
            file = Path(scratch) / f"mutated{source.suffix}"
            file.write_bytes(mutated(source.read_bytes(), rng))
            outcome, detail = attempt(file)
            outcomes[outcome] += 1
            if outcome.isupper():
                faults += 1
                print(f"{i} {source.name}: {outcome} {detail}", flush=True)
                if given.keep:
                    given.keep.mkdir(exist_ok=True)
                    (given.keep / f"{given.seed}-{i}{source.suffix}").write_bytes(file.read_bytes())
    print(f"{given.count} files, {time.monotonic() - began:.0f} s: {dict(outcomes.most_common())}; {faults} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
