"""Whole commands with random options: each ends as the documents say, in one line where it fails, with whole files."""

import functools
import json
import math
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import click
from hypothesis import strategies as st

from plan_cutters.command.entry import module_of
from plan_cutters.plan_file.words.text import with_text
from plan_cutters.report.to_json import dumps
from tests.soak.files import adds_up
from tests.soak.register import law
from tests.support.forked import ENV, run
from tests.support.fuzz_seeds import write_seeds
from tests.support.places import SAMPLES as FILES
from tests.support.plan_files import SAMPLES, cutter, face, made, verdicts
from tests.support.schemas import valid

#: Exit codes that the documents know; those that say that nothing was done; seconds that a command may take before it is ended.
_CODES, _REFUSED, _SECONDS = {0, 1, 2, 3, 4, 124}, {2, 3}, 90
#: What keeps a plan short, unless a case says otherwise.
_SHORT = {"--grid": "3", "--tolerance": "0.5", "--rotation-step": "60", "--jobs": "1", "--area-budget": "0", "--cutter": "R3L40",
          "--faces": "all", "--formats": "json"}  # fmt: skip
_OF_MAP = {"--at": "0,0,0", "--cutter": "R3L40", "--rotation-step": "60", "--within": "50"}
#: A batch plans its parts in processes that are begun for it.
_OF_BATCH = {**{word: value for word, value in _SHORT.items() if word != "--formats"}, "--out": "plans", "--workers": "1"}
COMMANDS = ("plan", "map", "tools", "machines", "diff", "batch")
_NUMBERS = ("0", "1", "-1", "2", "0.5", "3.75", "10", "60", "200", "nan", "inf", "-inf", "1e-300", "1e300", "-0", "1e9", "", " ",
            "x", "1,5", "0x10", "1_0", "٣", "9" * 40, "1e", "--", "5 mm")  # fmt: skip
_TEXTS = (
    "", " ", "-", "--", "=", "none", "all", "auto", "nan", "R6L80", "D12L80rc3", "R3L40rc3HR12L30", "D0.5inL3in", "r0L0",
    "R-1L5", "R1e300L1", "RnanL9", "R6L80T89", "R6L80T-89", "R3L40F50", "R3L1e-9", "er32", "R15L30", "R15:1L30+R1L1", "tilt:60",
    "tilt:-1", "tilt:nan", "tilt:", "tilt:1e9", "trunnion-ac", "head-table", "3-axis", "unlimited", "0,0,1", "0,0,0",
    "1e-300,0,0", "nan,0,1", "x", "+z", "-y", "1,2", "1,2,3,4", "box:1,2,3", "box:1,2,3@90,0,0", "box:0,1,1", "table",
    "table:-5", "table:nan", "vise", "chuck", "vise:1x1x1", "cylinder:3,4@0,0,200", "F1", "F1,F2", "F0", "F999", "1-3", "3-1",
    "1-", "sculptured", "blends", "name:(", "name:.*", "color:#00ff00", "component:", "!F1", "!all", "0:90", "90:0", "0:180",
    "nan:1", "-10:10", "0:360", "350:380", "0:0", ":", "json", "json,html", "npz,csv,regions,vtk", "png", "merged,glb",
    "nothing", "stick-out", "radius", "stick-out,radius,mend", "fewest", "é\u202e\x07", "a" * 300, "../x", "out/../out", "NUL",
    "'", "$(x)", "*", "samples.npz", "plan.json", "shop.toml", "part.step", "missing.step", "folder", "empty.step",
)  # fmt: skip
#: Options that reach beyond this machine, or that are about what does.
_LEFT_OUT = {"--cluster", "--help", "--help-all", "--version", "--list-cutters", "--list-holders", "--debug"}


@functools.cache
def _options(command):
    """The options of a command: the word of each, and its type; None for a flag."""
    made = module_of("plan-cutters" if command == "plan" else f"plan-cutters {command}").command
    found = {}
    for each in made.params:
        if isinstance(each, click.Option) and not _LEFT_OUT.intersection(each.opts):
            word = max(each.opts, key=len)
            found[word] = None if each.is_flag else each.type
    return found


def _values(kind):
    if isinstance(kind, click.Choice):
        return st.sampled_from([*kind.choices, *kind.choices, "", "other", "all"])
    if kind in (click.INT, click.FLOAT):
        return st.sampled_from(_NUMBERS)
    offered = tuple(kind.offered()) if hasattr(kind, "offered") else ()
    return st.sampled_from(_TEXTS) if not offered else st.one_of(st.sampled_from(offered), st.sampled_from(_TEXTS))


@dataclass(frozen=True)
class Line:
    """A command with the files that it is asked about, and words: an option and its value each, None for a flag."""

    command: str
    file: str
    words: tuple[tuple[str, str | None], ...]

    @property
    def typed(self):
        """Words as they stand on the command line."""
        given = [word for word, _ in self.words]
        short = {"plan": _SHORT, "map": _OF_MAP, "batch": _OF_BATCH}.get(self.command, {})
        words = [each for word, value in short.items() if word not in given for each in (word, value)]
        for word, value in self.words:
            words += [word] if value is None else [f"{word}={value}"]
        return [self.command, *self.file.split(), *words]


@st.composite
def lines(draw):
    """A command with up to four options at random."""
    command = draw(st.sampled_from([*COMMANDS[:1] * 5, *COMMANDS[1:2] * 2, *COMMANDS[2:]]))
    plans = [
        "old.json new.json",
        "new.json old.json",
        "old.json old.json",
        "old.json part.step",
        "missing.json old.json",
        "folder .",
    ]
    files = {
        "diff": plans,
        "batch": ["part.step", "part.step bump.step empty.step", "folder", "*.step", ".", "shop.toml", ""],
        "tools": ["shop.toml", "part.step", "missing.toml", ""],
        "machines": ["", "trunnion-ac", "shop.toml", "nothing"],
    }
    parts = [*["part.step"] * 6, "bump.step", "sheet.igs", "missing.step", "empty.step", "folder", "shop.toml", ""]
    file = draw(st.sampled_from(files.get(command, parts)))
    options = _options(command)
    words = draw(st.lists(st.sampled_from(sorted(options)), max_size=4))
    return Line(command, file, tuple((word, None if options[word] is None else draw(_values(options[word]))) for word in words))


@functools.cache
def _seeds():
    folder = Path(tempfile.mkdtemp(prefix="soak-"))
    write_seeds(folder)
    return {name: (folder / file).read_bytes() for name, file in
            {"part.step": "pocket_mm.step", "bump.step": "bump_mm.step", "sheet.igs": "open_faces.igs"}.items()}  # fmt: skip


def laid_out(folder):
    """Put the files that commands are asked about into a folder."""
    for name, content in _seeds().items():
        (folder / name).write_bytes(content)
    (folder / "shop.toml").write_bytes((FILES / "shop.toml").read_bytes())
    (folder / "empty.step").write_bytes(b"")
    for name, reached in (("old", 900), ("new", 700)):
        there = {"F1": verdicts(SAMPLES - reached), "F2": verdicts(0, 30)}
        (folder / f"{name}.json").write_text(dumps(with_text(made([face(1), face(2)], [cutter("R6L80", there)], sha=name))))
    (folder / "folder").mkdir()


@law(lines(), seconds=_SECONDS + 30)
def commands_end_as_they_say(line: Line):
    """An exit code that the documents know, no traceback, an error of one line, whole files, and a plan that adds up."""
    with tempfile.TemporaryDirectory() as outer:
        folder = Path(outer) / "a" / "b"
        folder.mkdir(parents=True)
        laid_out(folder)
        before = _listed(Path(outer))
        try:
            done = _done(line, folder)
        except subprocess.TimeoutExpired:
            return  # what was asked for takes long
        after = _listed(Path(outer))
        said = f"exit {done.returncode}; {line.typed}\nstderr: {done.stderr[-1500:]}\nstdout: {done.stdout[-500:]}"
        assert done.returncode in _CODES, said
        for text in (done.stderr, done.stdout):
            assert "Traceback" not in text, said
            assert "internal error" not in text, said
        if done.returncode in _REFUSED and not any(name.endswith("summary.json") for name in after - before):
            _refused(done, said)
            assert after - before == set() or any(name.endswith("plan.json") for name in after), f"left: {after - before}; {said}"
        assert before <= after, f"gone: {before - after}; {said}"
        odd = [name for name in after if Path(name).name.startswith(".") or name.endswith((".tmp", ".part", "~"))]
        odd = [name for name in odd if ".plan-cutters" not in name]
        assert not odd, f"half-written: {odd}; {said}"
        _read(line, done, folder, after - before, said)


def _done(line, folder):
    """Run it in a copy of this process; a batch in one of its own, for its loop outlives no fork."""
    if line.command != "batch":
        return run(*line.typed, cwd=folder, timeout=_SECONDS)
    words = [sys.executable, "-m", "plan_cutters", *line.typed]
    return subprocess.run(words, cwd=folder, env=ENV, timeout=_SECONDS, capture_output=True, text=True, check=False)


def _listed(folder):
    return {str(each.relative_to(folder)) for each in folder.rglob("*") if each.is_file()}


def _refused(done, said):
    """A mistake is one line, the last one, that begins with the name of the command."""
    lines = done.stderr.strip().splitlines()
    assert lines, said
    errors = [each for each in lines if each.startswith("plan-cutters")]
    assert lines[-1:] == errors[-1:], said
    assert len(lines[-1]) < 1500, said


def _read(line, done, folder, new, said):
    """All JSON can be read, is finite and as its schema says, and plans add up."""
    given = dict(line.words)
    for name in sorted(new):
        path = folder.parents[1] / name
        if name.endswith("plan.json"):
            plan = _json(path.read_text(), said)
            fault = adds_up(plan, done.returncode if "--fail-under" not in given and done.returncode in (0, 1, 4) else 1)
            assert not fault, f"{name}: {fault}; {said}"
        elif name.endswith(".json") and not name.endswith("labels.json"):
            _json(path.read_text(), said)
    if line.command == "plan" and given.get("--json") == "-" and done.returncode in (0, 1, 4):
        _json(done.stdout, said)
    if line.command in ("map", "tools", "machines") and ("--json", None) in line.words and done.returncode in (0, 1, 4):
        valid(line.command, _json(done.stdout, said))


def _json(text, said):
    def none(word):
        raise AssertionError(f"{word} in JSON; {said}")

    try:
        found = json.loads(text, parse_constant=none)
    except ValueError as error:
        raise AssertionError(f"no JSON: {error}; {said}") from None
    assert math.isfinite(len(text))
    return found
