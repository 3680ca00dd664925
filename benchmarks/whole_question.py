"""Ask whole questions as a user at a prompt does: seconds to the first line of the summary, seconds to the last file, memory.

    python benchmarks/whole_question.py                                  the parts named below
    python benchmarks/whole_question.py part.step --question first --before HEAD~3
    python benchmarks/whole_question.py part.step --cache codes          keep machine code from run to run

Each question is asked of a former revision, by default the parent commit, in a work tree of its own, and of this tree, in turn. A
run in which machine code was compiled does not count: the same is run again. Nothing else is kept, but what a second question
finds of the first. The clock is that of a machine that may have other work; processor seconds, of all processes of a command, are
beside it.
"""

import os
import subprocess
import sys
import tempfile
import threading
import time
from dataclasses import dataclass
from pathlib import Path

import click
from releases import ROOT, former, pair, table, timed

CAD = ROOT.parent / "shared" / "data" / "cad"
#: From 119 to 597 faces.
PARTS = ("asitus_ANC101-ill.stp", "asitus_repatch-hpdc-colored.stp", "hard/gmsh_pump_carter_sup.stp",
         "hard/odri_lower_leg_base.step", "hard/gmsh_Block.stp", "hard/brlcad_NIST_MBE_PMI_2.stp")  # fmt: skip
FIRST = "--cutter D6L40rc3F20S6 --machine trunnion-ac --faces all"
#: Words of each question; the second ones are asked after the first.
QUESTIONS = {
    "first": FIRST,
    "second, cutter": "--cutter D8L40F20S8 --machine trunnion-ac --faces all",
    "second, machine": "--cutter D6L40rc3F20S6 --machine head-table-bc --faces all",
    "second, setup": "--cutter D6L40rc3F20S6 --machine trunnion-ac --setup +y --faces all",
    "whole": "--cutter D6L40rc3F20S6 --cutter D10L50rc5F22S10 --cutter D16L60F30S16 --holder er25 --machine trunnion-ac "
    "--faces all --setup auto --answers mend --operations fastest --feed 2000",
}


@dataclass(frozen=True)
class Asked:
    """One run: its exit code, seconds to the first line on standard output and to its end, of processors, and most memory, MB."""

    code: int
    first: float
    end: float
    processor: float
    memory: float


class Tree:
    """A source tree to ask, with folders for machine code and for what is kept of parts."""

    def __init__(self, root: Path, code: Path) -> None:
        self.root, self.code = root, code

    def ask(self, part: Path, question: str, limit: float) -> Asked:
        """One question of a part, machine code compiled beforehand."""
        with tempfile.TemporaryDirectory() as kept:
            stages = kept if question.startswith("second") else ""
            if stages:
                self._once(part, FIRST, stages, limit)
            while True:
                # A copy of what is kept: a second question asked twice would be a third.
                again = tempfile.mkdtemp(dir=kept) if stages else ""
                for each in Path(stages).glob("*.stage") if stages else ():
                    os.link(each, Path(again) / each.name)
                before = self._compiled()
                asked = self._once(part, QUESTIONS[question], again, limit)
                if self._compiled() == before:
                    return asked

    def _compiled(self) -> set[Path]:
        return {path for path in self.code.rglob("*") if path.is_file()}

    def _once(self, part: Path, words: str, stages: str, limit: float) -> Asked:
        paths = os.pathsep.join([str(self.root / "plugin"), str(self.root)])
        environment = {**os.environ, "PYTHONPATH": paths, "NUMBA_CACHE_DIR": str(self.code), "PLAN_CUTTERS_CACHE": stages}
        with tempfile.TemporaryDirectory() as folder:
            command = [sys.executable, "-m", "plan_cutters", str(part), "-o", str(Path(folder) / "out"), *words.split()]
            began = time.monotonic()
            child = subprocess.Popen(command, env=environment, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
            watch = threading.Timer(limit, child.terminate)
            watch.start()
            assert child.stdout is not None
            child.stdout.readline()
            first = time.monotonic() - began
            child.stdout.read()
            _, status, used = os.wait4(child.pid, 0)
            watch.cancel()
            child.returncode = os.waitstatus_to_exitcode(status)  # it has been waited for
            child.stdout.close()
        unit = 1e6 if sys.platform == "darwin" else 1e3
        return Asked(child.returncode, first, time.monotonic() - began, used.ru_utime + used.ru_stime, used.ru_maxrss / unit)


HEAD = ["part", "question", "exit", "to the first line s", "to the end s", "processor s", "memory MB"]


def row(part: Path, question: str, was: Asked, now: Asked) -> list[str]:
    """Former revision > this tree (ratio)."""
    seconds = [timed(getattr(was, each), getattr(now, each)) for each in ("first", "end", "processor")]
    return [part.name, question, pair(was.code, now.code, "{}"), *seconds, pair(was.memory, now.memory, "{:.0f}")]


@click.command()
@click.argument("parts", nargs=-1, type=Path)
@click.option("--before", default="HEAD~1", show_default=True, help="The former revision.")
@click.option("--question", "questions", multiple=True, type=click.Choice(list(QUESTIONS)), help="Default: all. Repeatable.")
@click.option("--limit", default=900.0, show_default=True, help="Seconds after which a run is ended.")
@click.option("--cache", type=Path, help="Folder for machine code of both; default one that is removed.")
def main(parts: tuple[Path, ...], before: str, questions: tuple[str, ...], limit: float, cache: Path | None) -> None:
    """Ask a former revision and this tree questions about PARTS."""
    rows = []
    with former(before) as root, tempfile.TemporaryDirectory() as folder:
        code = Path(folder) if cache is None else cache.resolve()
        trees = [Tree(root, code / "before"), Tree(ROOT, code / "after")]
        for part in [each.resolve() for each in parts] or [CAD / name for name in PARTS]:
            for question in questions or QUESTIONS:
                rows.append(row(part, question, *(tree.ask(part, question, limit) for tree in trees)))
                click.echo(" | ".join(rows[-1]))
    click.echo("\n" + table(HEAD, rows))


if __name__ == "__main__":
    main()
