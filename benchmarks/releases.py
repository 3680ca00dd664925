"""Plan real files with a former release and with this tree, in turn: seconds stage by stage, answers, memory.

    python benchmarks/releases.py                          every file of ../shared/data/cad
    python benchmarks/releases.py FOLDER --only wing --only nacelle --markdown table.md
    python benchmarks/releases.py samples --before HEAD~3 --words "--cutter R6L80 --grid 101"

The former release is a revision of this repository, checked out into a temporary folder. Both run as a user would run them,
one file at a time, each file by the one and then by the other, with all files written. A run in which machine code was
compiled does not count: the same is run again. Where a file is planned several times (`--times`), the quickest run counts.
Seconds of the clock are those of a machine that may have other work; processor seconds, of all processes of a command, are
beside them. Memory is the largest of the command's processes. Nothing is kept from run to run, but with `--second`.
"""

import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import click

ROOT = Path(__file__).parents[1]
SUFFIXES = {".step", ".stp", ".iges", ".igs", ".brep"}
#: The last revision before surfaces were evaluated in compiled code.
FORMER = "0c04489"
#: Stages as the tables have them, and the keys of `run.seconds` that they are made of; the keys of cutters are the search.
STAGES = {
    "start": ("start",),
    "read": ("read",),
    "sides, samples": ("measure", "sew", "orient", "sample", "classify"),
    "tessellate": ("tessellate",),
    "tree, code": ("tree", "compile", "bodies"),
    "search": (),
    "setups, reasons": ("proposal", "setups", "reasons"),
    "area": ("area",),
    "answers": ("stick-out", "radius", "mend"),
    "operations": ("operations",),
    "write": (
        "write",
        "plan",
        "npz",
        "json",
        "show",
        "html",
        "png",
        "split",
        "glb",
        "step",
        "split_operations",
        "operations_step",
        "operations_glb",
    ),
}
_KNOWN = {key for keys in STAGES.values() for key in keys}


@dataclass(frozen=True)
class Ran:
    """One run of the command: exit code, seconds of the clock and of processors, most memory MB, and the plan if there is one."""

    code: int | None
    seconds: float
    processor: float
    memory: float
    plan: dict[str, Any] | None

    def stage(self, name: str) -> float | None:
        """Seconds of a stage; None where the release does not tell."""
        told = self.plan["run"]["seconds"] if self.plan else {}
        mine = [s for key, s in told.items() if key in STAGES[name] or (name == "search" and key not in _KNOWN)]
        return sum(mine) if mine else None


class Tree:
    """A source tree to run the command of; `second`: what a first run has kept of a part is there."""

    def __init__(self, root: Path, cache: Path, *, second: bool = False) -> None:
        self.root, self.cache, self.second = root, cache, second

    def run(self, file: Path, words: Sequence[str], limit: float, times: int) -> Ran:
        """The quickest of several runs, machine code compiled beforehand."""
        kept: list[Ran] = []
        if self.second:
            self._once(file, words, limit)
        while len(kept) < times:
            before = self._compiled()
            ran = self._once(file, words, limit)
            if self._compiled() == before:
                kept.append(ran)
        return min(kept, key=lambda ran: ran.seconds)

    def _compiled(self) -> set[Path]:
        return {path for path in self.cache.rglob("*") if path.is_file()}

    def _once(self, file: Path, words: Sequence[str], limit: float) -> Ran:
        paths = os.pathsep.join([str(self.root / "plugin"), str(self.root)])
        environment = {**os.environ, "PYTHONPATH": paths, "NUMBA_CACHE_DIR": str(self.cache),
                       "PLAN_CUTTERS_CACHE": f"{self.cache}-stages" if self.second else ""}  # fmt: skip
        with tempfile.TemporaryDirectory() as folder:
            out = Path(folder) / "out"
            command = [sys.executable, "-m", "plan_cutters", str(file), "-o", str(out), "--quiet", *words]
            began = time.monotonic()
            child = subprocess.Popen(command, env=environment, cwd=folder, stdout=subprocess.DEVNULL,
                                     stderr=subprocess.DEVNULL)  # fmt: skip
            ended, status, used = 0, 0, None
            while not ended and time.monotonic() - began < limit:
                ended, status, used = os.wait4(child.pid, os.WNOHANG)
                time.sleep(0.005)
            if not ended:
                child.terminate()
                time.sleep(0.5)
                child.terminate()  # the second one is obeyed at once
                _, status, used = os.wait4(child.pid, 0)
            seconds = time.monotonic() - began
            child.returncode = os.waitstatus_to_exitcode(status)  # it has been waited for
            plan = json.loads((out / "plan.json").read_text()) if ended and (out / "plan.json").exists() else None
        assert used is not None
        unit = 1e6 if sys.platform == "darwin" else 1e3
        return Ran(child.returncode if ended else None, seconds, used.ru_utime + used.ru_stime, used.ru_maxrss / unit, plan)


@contextmanager
def former(revision: str) -> Iterator[Path]:
    """A revision of this repository in a folder of its own."""
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder) / "former"
        git = ["git", "-C", str(ROOT), "worktree"]
        subprocess.run([*git, "add", "--detach", str(root), revision], check=True, capture_output=True)
        try:
            yield root
        finally:
            subprocess.run([*git, "remove", "--force", str(root)], check=True, capture_output=True)


def pair(before: Any, after: Any, shape: str = "{:.3g}") -> str:
    """`before > after`; once where they are the same, `-` where there is none."""
    words = ["-" if value is None else shape.format(value) for value in (before, after)]
    return words[0] if words[0] == words[1] else " > ".join(words)


def timed(before: float | None, after: float | None) -> str:
    """`before > after (ratio)`, seconds."""
    text = " > ".join("-" if s is None else f"{s:.2f}" for s in (before, after))
    return f"{text} ({before / after:.2g})" if before and after and max(before, after) >= 0.1 else text


def same(before: Ran, after: Ran) -> str:
    """Whether two runs say the same of every cutter."""
    if not (before.plan and after.plan):
        return pair(before.code, after.code, "exit {}")
    was, now = ({c["id"]: c for c in ran.plan["cutters"]} for ran in (before, after) if ran.plan)
    if before.code != after.code or {i: c["feasible"] for i, c in was.items()} != {i: c["feasible"] for i, c in now.items()}:
        return "differ"
    kinds = ("interference_free", "accessible", "undecided", "inaccessible", "unjudged")
    moved = max(sum(abs(was[i][k] - now[i][k]) for k in kinds) // 2 for i in was)
    return f"same, but {moved} samples" if moved else "same"


def answers(file: Path, before: Ran, after: Ran) -> list[str]:
    """A row of the table of whole commands."""

    def told(*keys: str) -> tuple[Any, Any]:
        values = []
        for ran in (before, after):
            value: Any = ran.plan
            for key in keys:
                value = value[key] if value else None
            values.append(value)
        return values[0], values[1]

    return [
        file.name, pair(*told("part", "faces"), "{}"), pair(*told("samples", "count"), "{}"),
        pair(*told("effective", "obstacle_triangles"), "{}"), timed(before.seconds, after.seconds),
        timed(before.processor, after.processor), pair(*told("effective", "tolerance_mm")),
        pair(*told("effective", "chord_error_mm")), same(before, after), pair(before.memory, after.memory, "{:.0f}"),
    ]  # fmt: skip


def totals(rows: Sequence[tuple[Ran, Ran]]) -> list[list[str]]:
    """Largest, median and sum, for both tables: whole commands, stages."""
    ways = {"largest": max, "median": statistics.median, "sum": sum}
    out = []
    for name, way in ways.items():
        both = [[way(getattr(row[i], key) for row in rows) for i in (0, 1)] for key in ("seconds", "processor", "memory")]
        out.append([name, "", "", "", timed(*both[0]), timed(*both[1]), "", "", "",
                    "" if name == "sum" else pair(*both[2], "{:.0f}")])  # fmt: skip
    return out


def stage_totals(rows: Sequence[tuple[Ran, Ran]]) -> list[str]:
    cells = []
    for stage in STAGES:
        known = [[s for row in rows if (s := row[i].stage(stage)) is not None] for i in (0, 1)]
        cells.append(timed(*(sum(s) if s else None for s in known)))
    return ["sum", *cells]


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    return "\n".join("| " + " | ".join(cells) + " |" for cells in (head, ["---"] * len(head), *rows))


HEAD = ["file", "faces", "samples", "triangles", "whole command s", "processor s", "tolerance mm", "chord error mm",
        "verdicts", "memory MB"]  # fmt: skip


@click.command()
@click.argument("folder", type=Path, default=ROOT.parent / "shared" / "data" / "cad")
@click.option("--before", default=FORMER, show_default=True, help="The former release: a git revision.")
@click.option("--only", multiple=True, help="Files whose name holds this. Repeatable.")
@click.option("--words", default="--cutter R3L40", show_default=True, help="What else the command is told.")
@click.option("--times", default=1, show_default=True, help="Runs of each; the quickest counts.")
@click.option("--second", is_flag=True, help="Time the second question: what a first run keeps of a part is there.")
@click.option("--limit", default=400.0, show_default=True, help="Seconds after which a run is ended.")
@click.option("--markdown", type=Path, help="Where to write the tables, too.")
def main(
    folder: Path, before: str, only: tuple[str, ...], words: str, times: int, second: bool, limit: float, markdown: Path | None
) -> None:  # fmt: skip
    """Plan the CAD files of FOLDER with a former release and with this tree."""
    files = sorted(f for f in folder.resolve().iterdir() if f.suffix.lower() in SUFFIXES)
    files = [f for f in files if not only or any(word in f.name for word in only)]
    rows: list[tuple[Ran, Ran]] = []
    with former(before) as root, tempfile.TemporaryDirectory() as cache:
        trees = (Tree(root, Path(cache) / "before", second=second), Tree(ROOT, Path(cache) / "after", second=second))
        for file in files:
            was, now = (tree.run(file, words.split(), limit, times) for tree in trees)
            rows.append((was, now))
            click.echo(" | ".join(answers(file, was, now)))
    stages = [[f.name, *(timed(was.stage(s), now.stage(s)) for s in STAGES)] for f, (was, now) in zip(files, rows, strict=True)]
    whole = [answers(f, was, now) for f, (was, now) in zip(files, rows, strict=True)]
    text = "\n\n".join(
        [
            f"`python benchmarks/releases.py`, `{words}`, {before} > this tree (ratio)",
            table(HEAD, [*whole, *totals(rows)]),
            "Stages, seconds of the clock (`-`: the release does not tell):",
            table(["file", *STAGES], [*stages, stage_totals(rows)]),
        ]
    )
    click.echo("\n" + text)
    if markdown:
        markdown.write_text(text + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
