"""Put small faults into a room of the program, one at a time, and see whether the tests of that room fail.

    python -m tests.mutants --room kernels --count 100 --seed 1

Each fault stands in a copy of the sources, and its compiled code in a copy of the cache. Of the room's tests, without the slow
ones, those run whose file runs the line that has the fault: first short ones that run the line, then long ones, then the others
of these files, up to the first that fails. A test that takes three times as long as without a fault, and some seconds, is ended.
A fault that no test notices survives, and is printed.
"""

import argparse
import contextlib
import gc
import hashlib
import json
import math
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import traceback
from collections.abc import Callable
from functools import partial
from itertools import islice, pairwise
from pathlib import Path
from types import CodeType, FunctionType
from typing import NoReturn

import pytest

from tests.mutants.faults import Mutant, drawn
from tests.mutants.plugins import Reach, Verdict, preload
from tests.support.places import PACKAGES, git

ROOT = Path(__file__).resolve().parents[2]
EQUIVALENT = Path(__file__).with_name("equivalent.txt")
#: The modules of each room, and its tests.
ROOMS = {
    "kernels": ("plugin/plan_cutters/kernels", "tests/kernels"),
    "scene": ("plugin/plan_cutters/scene", "tests/scene"),
    "judging": ("plugin/plan_cutters/judging", "tests/judging"),
    "operations": ("plugin/plan_cutters/operations", "tests/operations"),
    "cad_io/tessellate": ("cad_io/tessellate", "tests/cad_io/tessellate"),
    "domain/kinematics": ("plugin/plan_cutters/domain/kinematics.py", "tests/domain"),
}
#: Where functions are compiled anew for a fault.
COMPILED = (ROOMS["kernels"][0], ROOMS["cad_io/tessellate"][0])
OPTIONS = ("-q", "-p", "no:cacheprovider", "-p", "no:xdist", "--hypothesis-seed=0")
#: A test may take so many times as long as without a fault, and so many seconds more; so long is compiling a line of a kernel.
TIMES, MORE, PER_LINE = 3.0, 10.0, 0.05
#: Tests that take longer than this, s, run after the others.
SHORT = 1.0
#: Seconds by the clock after which tests are ended, which wait for something then: a busy machine is no fault.
HOUR = 3600.0
KILLED, TIMED_OUT, SURVIVED = "killed", "timed out", "survived"
#: Exit code of a process in which pytest could not begin.
BROKEN = 99


def listed(*folders: str) -> list[str]:
    """Files of the checkout below folders, those too that are not committed yet."""
    words = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard", *folders]
    names = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=True).stdout.split("\0")
    return sorted(name for name in set(names) if (ROOT / name).is_file())


def overlaid(cache: Path, other: Path) -> None:
    """Lay a cache of its own over a common one: files are linked, and whoever writes one puts another in its place."""
    shutil.rmtree(other.parent, ignore_errors=True)
    left_out = shutil.ignore_patterns("stages", "scratch", "test_*", "tests.*")
    shutil.copytree(cache, other, copy_function=os.link, ignore=left_out) if cache.is_dir() else other.mkdir(parents=True)


class Copy:
    """A copy of the checkout, with a cache of compiled code of its own, in which tests run."""

    def __init__(self, work: Path, number: int, cache: Path | None = None) -> None:
        self.folder, self.cache = work / f"copy{number}" / "checkout", cache or work / f"cache{number}"
        self.common, self.entered = work / "common", False
        shutil.rmtree(self.folder, ignore_errors=True)
        for name in listed():
            (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, self.folder / name)
        for name in (".venv", "node_modules", "../shared"):
            if (ROOT / name).exists() and not (self.folder / name).exists():
                (self.folder / name).symlink_to((ROOT / name).resolve())

    def run(self, files: list[str], plugin: object, result: Path, swap: Callable[[], None] = lambda: None) -> int | None:
        """Run files of tests in a process of their own: pytest's exit code; None where it was ended.

        What the plugin gathers is in `result`, if it is asked for.
        """
        process = os.fork()
        if process == 0:
            code = BROKEN
            try:
                os.setsid()
                self.enter(result.with_suffix(".log"))
                swap()
                code = int(pytest.main([*OPTIONS, *(["-x"] if isinstance(plugin, Verdict) else []), *files], plugins=[plugin]))
                if isinstance(plugin, Reach):
                    sys.settrace(None)
                    result.write_text(json.dumps(plugin.tests))
            except BaseException:
                traceback.print_exc()
            finally:
                sys.stdout.flush()
                os._exit(code)
        ends, status = time.monotonic() + HOUR, None
        try:
            while status is None and time.monotonic() < ends:
                time.sleep(0.02)
                pid, status = os.waitpid(process, os.WNOHANG)
                status = status if pid else None
        finally:  # nothing that the tests began outlives them
            for end in (os.killpg, os.kill) if status is None else (os.killpg,):
                with contextlib.suppress(ProcessLookupError):
                    end(process, signal.SIGKILL)
            if status is None:
                os.waitpid(process, 0)
        if status is None:
            return None
        code = os.waitstatus_to_exitcode(status)
        if code == BROKEN:
            sys.exit(f"pytest could not begin, see {result.with_suffix('.log')}")
        return None if code == -signal.SIGPROF else code

    def enter(self, log: Path) -> None:
        """Make this process one that begins in the copy, if it is none yet."""
        with open(log, "w") as file:
            os.dup2(file.fileno(), 1)
            os.dup2(file.fileno(), 2)
        scratch = self.cache / "scratch"
        scratch.mkdir(parents=True, exist_ok=True)
        if self.entered:
            return
        self.entered = True
        os.chdir(self.folder)
        ours = [str(self.folder / "plugin"), str(self.folder)]
        sys.path[:] = [*ours, *(each for each in sys.path if "site-packages" in each or each.startswith(sys.base_prefix))]
        sys.path_importer_cache.clear()
        for name in [name for name in sys.modules if name.partition(".")[0] in ("tests", *PACKAGES)]:
            del sys.modules[name]
        tempfile.tempdir = None
        os.environ |= {"PYTHONPATH": os.pathsep.join(ours), "NUMBA_CACHE_DIR": str(self.cache), "TMPDIR": str(scratch)}
        os.environ["HYPOTHESIS_STORAGE_DIRECTORY"] = str(scratch / "hypothesis")
        os.environ.pop("PYTEST_ADDOPTS", None)  # options of the checkout's own plugins, which are not loaded
        import cad_io

        assert Path(cad_io.__file__).is_relative_to(self.folder), cad_io.__file__

    def clear(self) -> None:
        """Begin with the common cache and without files of earlier tests."""
        if self.entered:  # nothing was compiled of a fault
            shutil.rmtree(self.cache / "scratch", ignore_errors=True)
        else:
            overlaid(self.common / "plan-cutters", self.cache / "plan-cutters")

    def collect(self, files: list[str]) -> None:
        """Make this process one that begins in the copy and has collected tests, to be copied for each fault."""
        self.clear()
        self.enter(self.cache.with_suffix(".log"))
        pytest.main([*OPTIONS, "--collect-only", *files])


def reach(tests: list[str], work: Path) -> dict[str, dict]:
    """Which lines each test of some folders runs, by its file; what is known of a file that is as it was is not asked again."""
    copy, known = None, work / "reach.json"
    found = json.loads(known.read_text()) if known.exists() else {}
    common = digest(listed("plugin", "cad_io", "tests/support", "tests/conftest.py", "tests/nightly.txt", "pyproject.toml"))
    result = {}
    for name in (each for each in listed(*tests) if Path(each).name.startswith("test_")):
        key = f"{common} {digest([name])}"
        if name in found and found[name]["key"] == key:
            result[name] = found[name]
            continue
        copy = copy or Copy(work, 0, work / "common")
        began, file = time.monotonic(), work / "reached.json"
        file.unlink(missing_ok=True)
        code = copy.run([name], Reach(copy.folder, str(work / "copies.txt")), file)
        if not file.exists():
            sys.exit(f"{name}: pytest ended with {code}, see {file.with_suffix('.log')}")
        result[name] = {"key": key, "tests": json.loads(file.read_text())}
        each = result[name]["tests"]
        failed = [test for test in each if each[test].get("failed")]
        print(
            f"{name}: {len(each) - 1} tests, {time.monotonic() - began:.0f} s",
            *(f"\n  fails without a fault: {test}" for test in failed),
        )
        known.write_text(json.dumps(found | result))
    return result


def digest(names: list[str]) -> str:
    """Digest of files of the checkout."""
    return hashlib.sha256(b"".join(name.encode() + (ROOT / name).read_bytes() for name in names)).hexdigest()[:16]


def runs(test: dict, mutant: Mutant) -> bool:
    """Whether a test runs the lines of a fault; of one that stands in no function, whether it runs anything of its module."""
    lines = int(test["lines"].get(mutant.path, "0"), 16)
    first, last = mutant.lines
    return bool(lines >> first & ((1 << (last - first + 1)) - 1)) if last else bool(lines)


def ordered(reached: dict[str, dict], mutant: Mutant) -> tuple[list[str], list[str], list[str], dict[str, float]]:
    """Files of tests that can notice a fault; their tests in the order in which they run; those that fail anyway; limits, s."""
    files, order, left_out, limits = [], [], [], {}
    for file, each in reached.items():
        tests = each["tests"]
        if not any(runs(test, mutant) or test["starts"] for test in tests.values()):
            continue
        costs = {}
        for test, known in tests.items():
            costs[test] = known["seconds"]
            if known["entries"] and mutant.path.startswith(COMPILED):
                costs[test] += PER_LINE * sum(int(lines, 16).bit_count() for lines in known["lines"].values())
            limits[test] = TIMES * costs[test] + MORE
        ours = {test for test in tests if runs(tests[test], mutant)}
        left_out += [test for test in tests if tests[test].get("failed")]
        classes = {test: 2 if test not in ours else int(tests[test]["seconds"] > SHORT) for test in tests if test}
        files.append(file)
        for rank in range(3):
            some = sorted((test for test in classes if classes[test] == rank), key=costs.__getitem__)
            order.append((rank, costs[some[0]] if some else 0.0, file, some))
    return files, [test for _, _, _, some in sorted(order) for test in some], left_out, limits


def judged(mutant: Mutant, copy: Copy, reached: dict[str, dict], most: float = math.inf) -> dict:
    """Put one fault into a copy, and see whether tests notice it, which begin within so many processor seconds."""
    files, order, left_out, limits = ordered(reached, mutant)
    began, result = time.monotonic(), {"verdict": SURVIVED, "by": "no test of the room runs it", "tests": 0}
    place = copy.folder / mutant.path
    source, stat = place.read_bytes(), place.stat()
    if mutant.name in equivalents():
        result["by"] = "it changes nothing: none"
    elif files:
        copy.clear()
        note = copy.cache.with_suffix(".test")
        note.write_text("while tests are collected")
        sys.stdout.flush()
        place.write_bytes(mutant.applied(source))
        os.utime(place, (1e9, 1e9))  # no byte code is older
        try:
            swap = partial(swapped, place, mutant.applied(source)) if copy.entered else lambda: None
            code = copy.run(files, Verdict(order, left_out, limits, note, most), copy.cache.with_suffix(".json"), swap)
        finally:
            place.write_bytes(source)
            os.utime(place, ns=(stat.st_atime_ns, stat.st_mtime_ns))
            for each in place.parent.glob(f"__pycache__/{place.stem}.*.pyc"):
                each.unlink()
        verdict = {None: TIMED_OUT, 0: SURVIVED}.get(code, KILLED)
        result = {"verdict": verdict, "by": note.read_text(), "tests": len(order)}
    return {
        **mutant._asdict(),
        "name": mutant.name,
        "diff": mutant.diff(source),
        **result,
        "seconds": round(time.monotonic() - began, 1),
    }


def soon(mutant: Mutant, reached: dict[str, dict]) -> bool:
    """Whether a fault can be put into functions that are there: they are neither compiled nor run while tests are collected."""
    there = any(runs(each["tests"][""], mutant) for each in reached.values())
    return bool(mutant.lines[1]) and not mutant.path.startswith(COMPILED) and not there


def swapped(path: Path, source: bytes) -> None:
    """Give the functions of a module that is imported the code of another source, in which they have the same order."""
    gc.unfreeze()
    known = [each for each in gc.get_objects() if isinstance(each, FunctionType) and each.__code__.co_filename == str(path)]
    codes, waiting = [], [compile(source, str(path), "exec", dont_inherit=True)]
    while waiting:
        code = waiting.pop()
        codes.append(code)
        waiting += [each for each in code.co_consts if isinstance(each, CodeType)]
    for name in {each.__code__.co_qualname for each in known}:
        new = sorted((each for each in codes if each.co_qualname == name), key=lambda each: each.co_firstlineno)
        places = sorted({each.__code__.co_firstlineno for each in known if each.__code__.co_qualname == name})
        for function in known:
            if function.__code__.co_qualname == name and len(new) == len(places):
                function.__code__ = new[places.index(function.__code__.co_firstlineno)]
    gc.freeze()


def void(rows: list[dict], copy: Copy) -> str:
    """Run the tests that noticed faults without one, in one process: the first that fails, which has noticed nothing."""
    killers = list(
        dict.fromkeys(row["by"].rpartition(" (")[0] for row in rows if row["verdict"] != SURVIVED and " (" in row["by"])
    )
    if not killers:
        return ""
    note = copy.cache.with_suffix(".test")
    plugin = Verdict(killers, [], {"": HOUR}, note, only=True)
    code = copy.run(sorted({test.partition("::")[0] for test in killers}), plugin, copy.cache.with_suffix(".json"))
    return "" if code == 0 else note.read_text()


def equivalents() -> dict[str, str]:
    """Faults that change nothing that anybody can see, each with the reason: names, each followed by an indented line."""
    lines = EQUIVALENT.read_text(encoding="utf-8").splitlines() if EQUIVALENT.exists() else []
    return {name: why.strip() for name, why in pairwise(lines) if why.startswith("  ") and not name.startswith("  ")}


def table(rows: list[dict]) -> str:
    """The table of a room or of several: of how many faults the tests noticed how many."""
    same = equivalents()
    lines = [
        "| room | faults | killed | timed out | survived | of these equivalent | share | without equivalent | s |",
        "|---|" + "---:|" * 8,
    ]
    for room in dict.fromkeys(row["room"] for row in rows):
        ours = [row for row in rows if row["room"] == room]
        killed, timed, lived = (sum(row["verdict"] == each for row in ours) for each in (KILLED, TIMED_OUT, SURVIVED))
        equal = sum(row["verdict"] == SURVIVED and row["name"] in same for row in ours)
        # Rounded down: what is not all is not 100 %.
        shares = [f"{100 * (killed + timed) // max(1, each)} %" for each in (len(ours), len(ours) - equal)]
        cells = [room, len(ours), killed, timed, lived, equal, *shares, f"{sum(row['seconds'] for row in ours):.0f}"]
        lines.append(f"| {' | '.join(map(str, cells))} |")
    return "\n".join(lines)


def work(mutants: list[Mutant], copy: Copy, reached: dict[str, dict], most: float, head: dict, out: Path) -> NoReturn:
    """Try faults in this process, which ends with it; write the results, each with a head, and print them."""
    with os.fdopen(os.dup(1), "w") as terminal:
        try:
            for mutant in sorted(mutants, key=lambda each: soon(each, reached)):
                if soon(mutant, reached) and not copy.entered:
                    copy.collect(sorted(reached))
                row = head | judged(mutant, copy, reached, most)
                with open(out, "a") as file:
                    file.write(json.dumps(row) + "\n")
                print(shown(row), file=terminal, flush=True)
        except SystemExit as end:
            print(end, file=terminal)
        except BaseException:
            traceback.print_exc(file=terminal)
    os._exit(0)


def shown(row: dict) -> str:
    """A fault as a reader of changes knows it."""
    place = f"{row['path']}:{row['line']} ({row['kind']}), {row['by']} of {row['tests']} tests, {row['seconds']} s"
    return "\n  ".join([f"{row['verdict']}: {row['name']}", *row["diff"], place])


def main() -> None:
    words = argparse.ArgumentParser(
        "python -m tests.mutants", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    words.add_argument("--room", choices=ROOMS, required=True)
    words.add_argument("--count", type=int, default=100, help="faults that are drawn")
    words.add_argument("--seed", type=int, default=1)
    words.add_argument("--jobs", type=int, default=1, help="copies in which faults are tried at a time")
    words.add_argument("--only", default="", help="of these faults those alone whose module or function has this in its name")
    words.add_argument("--again", action="store_true", help="try those once more that survived")
    words.add_argument("--most", type=float, default=math.inf, help="seconds of tests after which a fault counts as not noticed")
    words.add_argument("--tests", nargs="+", help="folders or files of tests in the place of those of the room")
    words.add_argument("--out", type=Path, help="results, a line of JSON each; what stands there is not tried again")
    words.add_argument("--work", type=Path, default=Path(tempfile.gettempdir(), "plan-cutters-mutants"), help="folder for copies")
    asked = words.parse_args()
    asked.work.mkdir(parents=True, exist_ok=True)
    out = asked.out or asked.work / f"{asked.room.replace('/', '-')}-{asked.seed}.jsonl"
    old = [json.loads(line) for line in out.read_text().splitlines()] if out.exists() else []
    known = {row["name"]: row for row in old if not (asked.again and row["verdict"] == SURVIVED)}
    # Who is ended ends what it began.
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    preload()
    if not (asked.work / "common").exists():
        from plan_cutters_base.user_cache import roots

        overlaid(next(roots()), asked.work / "common" / "plan-cutters")
    reached = reach(asked.tests or [ROOMS[asked.room][1]], asked.work)
    commit = git("rev-parse", "--short", "HEAD")
    modules = [name for name in listed(ROOMS[asked.room][0]) if name.endswith(".py")]
    mutants = list(islice(drawn(ROOT, modules, f"{asked.room} {asked.seed}"), asked.count))
    waiting = [each for each in mutants if each.name not in known and asked.only in each.name]
    head = {"room": asked.room, "seed": asked.seed, "commit": commit}
    workers = []
    for number in range(min(asked.jobs, len(waiting))):
        workers.append(os.fork())
        if workers[-1] == 0:
            work(waiting[number :: asked.jobs], Copy(asked.work, 1 + number), reached, asked.most, head, out)
    try:
        for worker in workers:
            os.waitpid(worker, 0)
    except BaseException:
        for worker in workers:
            os.kill(worker, signal.SIGTERM)
        raise
    latest = {row["name"]: row for row in map(json.loads, out.read_text().splitlines())} if out.exists() else {}
    rows = [latest[each.name] for each in mutants if each.name in latest]
    print(table(rows), *(shown(row) for row in rows if row["verdict"] == SURVIVED), sep="\n")
    if waiting and (test := void(rows, Copy(asked.work, 1, asked.work / "common"))):
        sys.exit(f"It fails without a fault, too: {test}. Faults that it noticed count for nothing.")


if __name__ == "__main__":
    main()
