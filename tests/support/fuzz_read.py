"""Damage CAD files and give them to the command, thousands of times: `python -m tests.support.fuzz_read --count 20000 --seed 1`.

A preloaded process forks the command's child, so that kernel and kernels are loaded once, and watches it as the command's
supervisor does. What that turns into one line (a crash, a stage past its limit) is counted, not blamed. Faults are: a
traceback or an internal error, an exit code that the command does not have, words on standard output, a refusal that is
not one line naming the file, a hang where there is no limit, files left behind, a plan that is wrong (see `wrong`), and
faces that are gone without a word (see `silent`).
"""

import argparse
import contextlib
import gc
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
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cache, partial
from pathlib import Path
from typing import Any, NamedTuple

import jsonschema
import numpy as np

from cad_io import Part
from cad_io.kernel import silence
from cad_io.read.faults import edge_count
from plan_cutters import pipeline
from plan_cutters.command import cli, codes, terminal
from plan_cutters.document import plan as plan_module
from plan_cutters.report.to_json import schema
from plan_cutters.scene import surroundings
from plan_cutters_base.workers.child import VARIABLE, Assignment, limit_memory
from plan_cutters_base.workers.supervise import LIMITED
from tests.support.fuzz_seeds import write_seeds

SUFFIXES = {".step", ".stp", ".iges", ".igs"}
LARGEST = 30_000  # bytes; larger files only cost time
READING, REST = 5.0, 15.0  # seconds
#: A plan as coarse as can be: what is tried is not the search.
WORDS = ["--cutter", "R3L40", "--faces", "all", "--grid", "3", "--tolerance", "0.5", "--rotation-step", "60",
         "--jobs", "1", "--area-budget", "500", "--quiet"]  # fmt: skip
BATCH = 25  # files to a fork
TRIANGLES = 20_000
MODELS = 40  # every so many damaged files are written as models, too
#: A damaged part this many times larger or smaller than the whole one must come with a warning.
PLAUSIBLE = 100.0
NUMBERS = [b"0.", b"1.", b"-1.", b"1E300", b"1E-300", b"NaN", b"INF", b"99999999", b"1.E12", b"#1", b"$", b"*", b"''"]
VERDICTS = ("interference_free", "accessible", "inaccessible", "undecided", "unjudged")
VALIDATOR = jsonschema.Draft202012Validator(schema())
_STEP_FACES = re.compile(rb"\b(?:ADVANCED_FACE|FACE_SURFACE)\s*\(")


class Outcome(NamedTuple):
    """What became of one file: a class (a fault is in capitals), what was said, plan and part if there are."""

    kind: str
    detail: str
    plan: dict[str, Any] | None = None
    part: dict[str, Any] | None = None


def recorded(read: Callable[..., Part]) -> Callable[..., Part]:
    """Reading that leaves beside the file what the part is like, for `silent`."""

    def reading(source: Any, **more: Any) -> Part:
        part = read(source, **more)
        shapes = [part.face(face.number) for face in part.faces]
        said = [*part.warnings, *(f.unjudged for f in part.faces if f.unjudged)]
        facts = {"lost": [str(each) for each in part.lost], "altered": [each.face for each in part.lost if each.face],
                 "closed": part.closed, "said": said, "edges": [edge_count(shape) for shape in shapes]}  # fmt: skip
        Path(source).with_name("facts").write_text(json.dumps(facts))
        return part

    return reading


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
    picked = sorted((found[int(k)] for k in rng.integers(len(found), size=int(rng.integers(1, 4)))), key=lambda m: -m.start())
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


@dataclass(frozen=True)
class Case:
    """One damaged file, in a folder of its own, in which the command leaves `out` and what it `said`."""

    file: Path
    whole: dict[str, Any] = field(default_factory=dict)
    models: bool = False
    part: dict[str, Any] = field(default_factory=dict)

    @property
    def folder(self) -> Path:
        return self.file.parent

    def clear(self) -> None:
        """Take away what a run has left."""
        for left in self.folder.iterdir():
            if left.is_dir():
                shutil.rmtree(left)

    def run(self) -> int:
        """Exit code of the command."""
        words = [str(self.file), "-o", str(self.folder / "out"), *([] if self.models else ["--formats", "json"]), *WORDS]
        with (self.folder / "said").open("w") as said, (self.folder / "printed").open("w") as printed:
            sys.stderr, sys.stdout = said, printed
            code, line = codes.guarded(lambda: (codes.invoked(cli.command, "plan-cutters", words), ""), False)
            print(line, file=sys.stderr)
        return code


def attempt(cases: Sequence[Case]) -> Iterator[Outcome]:
    """Run the command's child on one file after the other.

    One fork serves many, since it costs more than most files do. What ends it is tried again alone, so that nothing is
    blamed on a file that an earlier one has caused.
    """
    rest = list(cases)
    while rest:
        codes, ended = _forked(rest)
        yield from (_judged(code, case) for code, case in zip(codes, rest, strict=False))
        rest = rest[len(codes) :]
        if ended and rest:
            rest[0].clear()
            codes, ended = _forked(rest[:1])
            yield ended if ended else _judged(codes[0], rest[0])
            del rest[0]


def _forked(cases: Sequence[Case]) -> tuple[list[int], Outcome | None]:
    """Exit codes of the cases that came to their end, and how the next one ended the process, if one did."""
    here, there = os.pipe()
    pid = os.fork()
    if pid == 0:
        try:
            os.setsid()  # reading may fork again
            os.close(here)
            os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
            os.environ[VARIABLE] = str(Assignment(report=there, memory=8 << 30))
            limit_memory()
            terminal.keep_output()
            for case in cases:
                os.write(there, b"stage start\n")
                os.write(there, f"ended {case.run()}\n".encode())
        finally:
            os._exit(70)
    os.close(there)
    codes: list[int] = []
    stage, since, left, open_ = "start", time.monotonic(), b"", True
    try:
        while len(codes) < len(cases):
            limit = READING if stage in ("start", "read") else REST
            if not select.select([here], [], [], max(0.0, since + limit - time.monotonic()))[0]:
                return codes, Outcome(f"{stage} past its limit" if stage in LIMITED else "HANG", stage)
            data = os.read(here, 1 << 16)
            if not data:
                open_ = False
                break
            *lines, left = (left + data).split(b"\n")
            for word, _, text in (line.decode(errors="replace").partition(" ") for line in lines):
                if word == "ended":
                    codes.append(int(text))
                elif word == "stage":
                    stage, since = text, time.monotonic()
    finally:
        os.close(here)
        if open_:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(pid, signal.SIGKILL)
            os.kill(pid, signal.SIGKILL)
        _, status = os.waitpid(pid, 0)
    if len(codes) == len(cases):
        return codes, None
    if os.WIFSIGNALED(status):
        return codes, Outcome(f"crash at {stage}", signal.Signals(os.WTERMSIG(status)).name)
    return codes, Outcome("TRACEBACK", f"outside of the command's guard, at {stage}")


def _judged(code: int, case: Case) -> Outcome:
    said = (case.folder / "said").read_text(errors="replace").strip()
    last = said.splitlines()[-1] if said else ""
    if "Traceback" in said or "internal error" in said or code not in (0, 1, 2, 3, 4):
        return Outcome("TRACEBACK", f"exit {code}: {last}")
    if (case.folder / "printed").stat().st_size:
        return Outcome("PRINTED", last)
    if code in (0, 1, 4):
        try:
            plan = json.loads((case.folder / "out" / "plan.json").read_text())
        except (OSError, ValueError) as error:
            return Outcome("NO PLAN", f"exit {code}: {error}")
        if said:
            # What fails of the models is said, and stands in the plan.
            missing = [line for line in said.splitlines() if not any(why in line for why in plan["not_written"].values())]
            if missing:
                return Outcome("TALKS", said)
        text, part = case.file.read_bytes(), json.loads((case.folder / "facts").read_text())
        if fault := wrong(plan, code, text, case.whole or plan):
            return Outcome("WRONG PLAN", fault, plan)
        if fault := silent(part | {"said": part["said"] + plan["part"]["warnings"]}, case.part or part, code, text):
            return Outcome("SILENT LOSS", fault, plan)
        return Outcome(f"planned {code}" + (", faces lost" if part["lost"] else ""), "", plan, part)
    if {p.name for p in case.folder.iterdir()} - {"facts"} != {case.file.name, "said", "printed"}:
        return Outcome("LEFT BEHIND", last)
    if said != last or not said.startswith("plan-cutters: ") or str(case.file) not in said or len(said) > 600:
        return Outcome("UNCLEAR", said)
    return Outcome(f"refused {code}", said)


def wrong(plan: dict[str, Any], code: int, text: bytes, whole: dict[str, Any]) -> str:
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
        by_face = sum(counts[k] for counts in cutter["faces"].values() for k in VERDICTS)
        if not count == by_face == sum(cutter[k] for k in VERDICTS):
            return f"{cutter['id']}: verdicts do not add up to {count} samples"
        if cutter["id"] == plan["selected"] and cutter["inaccessible"] + cutter["undecided"]:
            return "the cutter selected does not reach every sample"
    if code == 0 and (samples["unjudged"] or any(f["target"] and f["unjudged"] for f in plan["faces"])):
        return "exit 0 although something was not judged"
    warned = set(part["warnings"]) - set(whole["part"]["warnings"])
    ratio = max(part["size_mm"]) / max(whole["part"]["size_mm"])
    if not warned and not 1 / PLAUSIBLE < ratio < PLAUSIBLE:
        return f"{ratio:.3g} times as large, no warning"
    return ""


def silent(part: dict[str, Any], whole: dict[str, Any], code: int, text: bytes) -> str:
    """What is gone from a damaged file's part without a word, given that of the whole file; empty if nothing is.

    A face may go with its statement, since then the file says nothing of it; but a solid that was closed must not open.
    """
    if part["lost"]:
        return "exit 0 although faces are lost" if code == 0 else ""
    found, before = len(part["edges"]), len(whole["edges"])
    step = text.lstrip().startswith(b"ISO-10303")
    written = len(_STEP_FACES.findall(text)) if step else before
    if found < written:
        return f"{found} of {written} faces that are written"
    if found < before and (whole["closed"] and not part["closed"]):
        return f"{found} of {before} faces, and open now"
    if not part["said"] and whole["closed"] and not part["closed"] and sum(part["edges"]) < sum(whole["edges"]):
        return f"{sum(part['edges'])} of {sum(whole['edges'])} edges, and open now"
    return ""


def _numbers(value: Any) -> Iterator[float]:
    if isinstance(value, dict | list):
        for inner in value.values() if isinstance(value, dict) else value:
            yield from _numbers(inner)
    elif isinstance(value, float):
        yield value


def sources(folders: list[Path], scratch: Path) -> list[tuple[Path, dict[str, Any], dict[str, Any]]]:
    """Small files that can be planned, each with its plan and what its part is like."""
    found = sorted(f for d in folders for f in d.glob("*") if f.suffix.lower() in SUFFIXES)
    found = [f for f in found if 0 < f.stat().st_size < LARGEST]
    cases = [_case(scratch / str(i), file.name, file.read_bytes()) for i, file in enumerate(found)]
    outcomes = list(attempt(cases))
    for file, outcome in zip(found, outcomes, strict=True):
        if not outcome.plan:
            print(f"not used: {file.name}: {outcome.kind} {outcome.detail}", flush=True)
    each = zip(found, outcomes, strict=True)
    return [(file, outcome.plan, outcome.part) for file, outcome in each if outcome.plan and outcome.part]


def _case(folder: Path, name: str, text: bytes, **more: Any) -> Case:
    folder.mkdir(parents=True)
    (folder / name).write_bytes(text)
    return Case(folder / name, **more)


def main() -> int:
    words = argparse.ArgumentParser(description=__doc__)
    words.add_argument("folders", type=Path, nargs="*", help="more files to damage than those made here")
    words.add_argument("--count", type=int, default=200)
    words.add_argument("--seed", type=int, default=0)
    words.add_argument("--first", type=int, default=0, help="number of the first file: takes a run up again")
    words.add_argument("--keep", type=Path, help="folder for the files that show a fault or a crash")
    given = words.parse_args()
    # Compile and load everything once, here; the children inherit it.
    silence()
    surroundings.tessellate = partial(surroundings.tessellate, budget=TRIANGLES)
    pipeline.read_part = recorded(pipeline.read_part)
    plan_module.versions = cache(plan_module.versions)
    outcomes: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as folder:
        (seeds := Path(folder) / "seeds").mkdir()
        write_seeds(seeds)
        made = [str(file) for file in seeds.glob("*")]
        cli.command.main([*made, "-o", f"{folder}/out", *WORDS], prog_name="plan-cutters", standalone_mode=False)
        files = sources([*given.folders, seeds], Path(folder) / "whole")
        gc.collect()
        gc.freeze()  # not to be touched, and so copied, by the children
        began = time.monotonic()
        for start in range(given.first, given.first + given.count, BATCH):
            numbers = range(start, min(start + BATCH, given.first + given.count))
            cases = []
            for i in numbers:
                # Each has its own stream, so that one can be made again alone.
                rng = np.random.default_rng([given.seed, i])
                source, whole, part = files[int(rng.integers(len(files)))]
                text = mutated(source.read_bytes(), rng)
                cases.append(_case(Path(folder) / str(i), source.name, text, whole=whole, part=part, models=i % MODELS == 0))
            for i, case, outcome in zip(numbers, cases, attempt(cases), strict=True):
                kind = outcome.kind + (" with models" if case.models and outcome.plan else "")
                outcomes[kind] += 1
                if outcome.kind.isupper() or outcome.kind.startswith(("crash", *LIMITED)):
                    print(f"{i} {case.file.name}: {kind}: {outcome.detail}", flush=True)
                    if given.keep:
                        given.keep.mkdir(exist_ok=True)
                        (given.keep / f"{given.seed}-{i}-{case.file.name}").write_bytes(case.file.read_bytes())
                shutil.rmtree(case.folder)
            done = numbers.stop - given.first
            if done % 1000 < BATCH or done == given.count:
                told = {k: outcomes[k] for k in sorted(outcomes)}
                print(f"{done} files, {time.monotonic() - began:.0f} s: {told}", flush=True)
    faults = sum(count for kind, count in outcomes.items() if kind.split(" with")[0].isupper())
    print(f"{given.count} files, seed {given.seed}: {faults} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
