"""Damage CAD files and give them to the command, thousands of times: `python tests/fuzz_read.py --count 20000 --seed 1`.

A preloaded process forks the command's own child for each damaged file, so that kernel and kernels are loaded once, and
watches it as the command's supervisor does. What that turns into one line (a crash, a read past its limit) is counted,
not blamed. Faults are: a traceback or an internal error, an exit code that the command does not have, words on standard
output, a hang after reading, files left behind, and a plan that is wrong: see `wrong`.
"""

import argparse
import contextlib
import io
import json
import math
import os
import re
import select
import shutil
import signal
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import jsonschema
import numpy as np
from fuzz_seeds import write_seeds

from cad_io.kernel import silence
from plan_cutters import cli, pipeline, supervise
from plan_cutters.report.to_json import schema

SUFFIXES = {".step", ".stp", ".iges", ".igs"}
LARGEST = 60_000  # bytes; larger files only cost time
READING, REST = 10.0, 30.0  # seconds
#: A plan as coarse as can be: what is tried is not the search.
WORDS = ["--cutter", "R3L40", "--faces", "all", "--grid", "3", "--tolerance", "0.5", "--rotation-step", "60",
         "--jobs", "1"]  # fmt: skip
TRIANGLES = 20_000
MODELS = 10  # every so many damaged files are written as models, too
#: A damaged part this many times larger or smaller than the whole one must come with a warning.
PLAUSIBLE = 100.0
NUMBERS = [b"0.", b"1.", b"-1.", b"1E300", b"1E-300", b"NaN", b"INF", b"99999999", b"1.E12", b"#1", b"$", b"*", b"''"]
_STEP_FACES = re.compile(rb"\b(?:ADVANCED_FACE|FACE_SURFACE)\s*\(")


class Outcome(NamedTuple):
    """What became of one file: a class (a fault is in capitals), what was said, and the plan if there is one."""

    kind: str
    detail: str
    plan: dict[str, Any] | None = None


def mutated(data: bytes, rng: np.random.Generator) -> bytes:
    """Flip bytes, drop, double or swap lines, cut off, or replace numbers."""
    kind = rng.integers(8)
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
    if kind == 4 and rng.integers(4) == 0:
        return data[: int(rng.integers(len(data)))]
    found = list(re.finditer(rb"\d+" if kind == 5 else rb"[-+]?\d+\.\d*([ED][-+]?\d+)?", data))
    if not found:
        return data
    # One number, or the same damage at a few.
    out = data
    picked = sorted(
        (found[int(k)] for k in rng.integers(len(found), size=int(rng.integers(1, 4)))), key=lambda m: -m.start()
    )
    for match in picked:
        out = out[: match.start()] + _other(match[0], rng) + out[match.end() :]
    return out


def _other(number: bytes, rng: np.random.Generator) -> bytes:
    """Another number, as wide as it was where it can be: IGES counts columns."""
    kind = rng.integers(3)
    if kind == 0:
        new = bytearray(number)
        digits = [i for i, c in enumerate(new) if chr(c).isdigit()]
        new[digits[int(rng.integers(len(digits)))]] = ord("0") + int(rng.integers(10))
        return bytes(new)
    if kind == 1 and number[:1].isdigit():
        return b"-" + number[1:] if len(number) > 2 else b"-" + number
    return NUMBERS[int(rng.integers(len(NUMBERS)))].ljust(len(number))


def attempt(file: Path, *, models: bool) -> Outcome:
    """Run the command's child on one file."""
    out, said = file.parent / "out", file.parent / "said"
    here, there = os.pipe()
    pid = os.fork()
    if pid == 0:
        code = 70
        try:
            os.close(here)
            for number, name in ((1, "printed"), (2, "said")):
                os.dup2(os.open(file.parent / name, os.O_CREAT | os.O_TRUNC | os.O_WRONLY), number)
            os.environ[supervise.REPORT] = str(there)
            os.environ[supervise.MEMORY] = str(8 << 30)
            cli.main([str(file), "-o", str(out), *([] if models else ["--formats", "json"]), *WORDS])
        except SystemExit as end:
            code = int(end.code or 0)
        finally:
            sys.stderr.flush()
            os._exit(code)
    os.close(there)
    try:
        status, stage = _watched(pid, here)
        return _judged(status, stage, said.read_text(errors="replace"), out, file)
    finally:
        os.close(here)
        for left in (out, *file.parent.glob(".out-*")):
            shutil.rmtree(left, ignore_errors=True)


def _watched(pid: int, pipe: int) -> tuple[int | None, str]:
    """Wait status, None if it had to be ended, and the stage it was last in."""
    stage, since, late = "start", time.monotonic(), False
    while True:
        limit = READING if stage in ("start", *supervise.READING) else REST
        if not select.select([pipe], [], [], max(0.0, since + limit - time.monotonic()))[0]:
            os.kill(pid, signal.SIGKILL)
            late = True
            break
        data = os.read(pipe, 1 << 16)
        if not data:
            break
        for told in re.findall(r"stage (\S+)", data.decode(errors="replace")):
            stage, since = told, time.monotonic()
    _, status = os.waitpid(pid, 0)
    return None if late else status, stage


def _judged(status: int | None, stage: str, said: str, out: Path, file: Path) -> Outcome:
    if status is None:
        return Outcome("read past its limit" if stage in supervise.READING else "HANG", stage)
    if os.WIFSIGNALED(status):
        return Outcome(f"crash at {stage}", signal.Signals(os.WTERMSIG(status)).name)
    code, last = os.waitstatus_to_exitcode(status), (said.strip().splitlines() or [""])[-1]
    if "Traceback" in said or "internal error" in said or code not in (0, 1, 2, 3, 4):
        return Outcome("TRACEBACK", f"exit {code}, {stage}: {last}")
    if (file.parent / "printed").stat().st_size:
        return Outcome("PRINTED", last)
    if code in (0, 1, 4):
        try:
            plan = json.loads((out / "plan.json").read_text())
        except (OSError, ValueError) as error:
            return Outcome("NO PLAN", f"exit {code}: {error}")
        return Outcome(f"planned {code}", last, plan)
    if list(file.parent.glob(".out-*")) or out.exists():
        return Outcome("LEFT BEHIND", last)
    if not last.startswith("plan-cutters: ") or str(file) not in last or len(last) > 600:
        return Outcome("UNCLEAR", last)
    return Outcome(f"refused {code}", last)


def wrong(plan: dict[str, Any], code: str, text: bytes, whole: dict[str, Any]) -> str:
    """What is wrong with the plan of a damaged file, given that of the whole one; empty if nothing is."""
    try:
        VALIDATOR.validate(plan)
    except jsonschema.ValidationError as error:
        return f"schema: {error.message[:200]}"
    if not all(map(math.isfinite, _numbers(plan))):
        return "numbers are not finite"
    part, samples = plan["part"], plan["samples"]
    count = samples["count"]
    if not 0 <= samples["unjudged"] < count:
        return f"nothing judged: {samples['unjudged']} of {count} samples unjudged"
    if part["faces"] != len(plan["faces"]) or sum(f["samples"] for f in plan["faces"]) != count:
        return "faces or samples do not add up"
    silent = [f["id"] for f in plan["faces"] if f["target"] and not f["samples"] and not f["unjudged"]]
    if silent:
        return f"faces neither judged nor listed: {silent}"
    for cutter in plan["cutters"]:
        for counts in (cutter, *cutter["faces"].values()):
            expected = count if counts is cutter else None
            found = sum(counts[k] for k in VERDICTS)
            if expected is not None and found != expected:
                return f"{cutter['id']}: {found} verdicts on {count} samples"
        if cutter["id"] == plan["selected"] and cutter["inaccessible"] + cutter["undecided"]:
            return "the cutter selected does not reach every sample"
    if code == "planned 0" and (samples["unjudged"] or any(f["target"] and f["unjudged"] for f in plan["faces"])):
        return "exit 0 although something was not judged"
    warned = bool(part["warnings"])
    written = len(_STEP_FACES.findall(text)) if text.lstrip().startswith(b"ISO-10303") else 0
    if not warned and written > part["faces"]:
        return f"{written} faces in the text, {part['faces']} read, no warning"
    if not warned and part["faces"] < whole["part"]["faces"]:
        return f"{part['faces']} of {whole['part']['faces']} faces, no warning"
    ratio = max(part["size_mm"]) / max(whole["part"]["size_mm"])
    if not warned and not 1 / PLAUSIBLE < ratio < PLAUSIBLE:
        return f"{ratio:.3g} times as large, no warning"
    return ""


VERDICTS = ("interference_free", "accessible", "inaccessible", "undecided", "unjudged")
VALIDATOR = jsonschema.Draft202012Validator(schema())


def _numbers(value: Any) -> Iterator[float]:
    if isinstance(value, dict | list):
        for inner in value.values() if isinstance(value, dict) else value:
            yield from _numbers(inner)
    elif isinstance(value, float):
        yield value


def sources(folders: list[Path], scratch: Path) -> list[tuple[Path, dict[str, Any]]]:
    """Small files that can be planned, each with its plan."""
    found = sorted(f for d in (*folders, scratch) for f in d.glob("*") if f.suffix.lower() in SUFFIXES)
    result = []
    for file in (f for f in found if 0 < f.stat().st_size < LARGEST):
        copy = scratch / f"whole{file.suffix}"
        copy.write_bytes(file.read_bytes())
        outcome = attempt(copy, models=False)
        copy.unlink()
        if outcome.plan:
            result.append((file, outcome.plan))
        else:
            print(f"not used: {file.name}: {outcome.kind} {outcome.detail}", flush=True)
    return result


def main() -> int:
    words = argparse.ArgumentParser(description=__doc__)
    words.add_argument("folders", type=Path, nargs="*", help="more files to damage than those made here")
    words.add_argument("--count", type=int, default=200)
    words.add_argument("--seed", type=int, default=0)
    words.add_argument("--keep", type=Path, help="folder for the files that show a fault or a crash")
    given = words.parse_args()
    # Compile and load everything once, here; the children inherit it.
    silence()
    pipeline.tessellate = partial(pipeline.tessellate, budget=TRIANGLES)
    outcomes: Counter[str] = Counter()
    faults = 0
    with tempfile.TemporaryDirectory() as folder:
        (seeds := Path(folder) / "seeds").mkdir()
        write_seeds(seeds)
        with contextlib.redirect_stderr(io.StringIO()):
            made = [str(file) for file in seeds.glob("*")]
            cli.command.main([*made, "-o", f"{folder}/out", *WORDS], prog_name="plan-cutters", standalone_mode=False)
        files = sources([*given.folders, seeds], Path(folder))
        began = time.monotonic()
        for i in range(given.count):
            # Each has its own stream, so that one can be made again alone.
            rng = np.random.default_rng([given.seed, i])
            source, whole = files[int(rng.integers(len(files)))]
            file = Path(folder) / f"mutated{source.suffix}"
            text = mutated(source.read_bytes(), rng)
            file.write_bytes(text)
            outcome = attempt(file, models=i % MODELS == 0)
            if outcome.plan and (fault := wrong(outcome.plan, outcome.kind, text, whole)):
                outcome = Outcome("WRONG PLAN", fault)
            kind = outcome.kind + (" with models" if i % MODELS == 0 and outcome.plan else "")
            outcomes[kind] += 1
            faults += kind.isupper()
            if kind.isupper() or "crash" in kind or "limit" in kind:
                print(f"{i} {source.name}: {kind}: {outcome.detail}", flush=True)
                if given.keep:
                    given.keep.mkdir(exist_ok=True)
                    (given.keep / f"{given.seed}-{i}-{source.name}").write_bytes(text)
            if i % 1000 == 999 or i + 1 == given.count:
                told = {k: outcomes[k] for k in sorted(outcomes)}
                print(f"{i + 1} files, {time.monotonic() - began:.0f} s: {told}; {faults} faults", flush=True)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
