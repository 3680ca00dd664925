"""Find the parts that changed in a git repository, and compare their plans, part by part."""

import json
import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import click

from plan_cutters.command.codes import ENDED
from plan_cutters.command.option_groups import Command, heading, options
from plan_cutters.command.request import PlanRequest, Reported, takes
from plan_cutters.command.terminal import error, hand_out, say
from plan_cutters.command.validation import Folder
from plan_cutters.errors import OptionError, PlanError
from plan_cutters.files.lock import require_temporary
from plan_cutters.files.pictures import with_pictures

if TYPE_CHECKING:
    from plan_cutters.cases.files import Case
    from plan_cutters_ci.model import PlanDifference


#: Suffixes of parts, in lower case.
PARTS = (".step", ".stp", ".iges", ".igs", ".brep", ".brp")
_POINTER = b"version https://git-lfs.github.com/spec/"


@dataclass(frozen=True, slots=True)
class Changed:
    """A part that differs between two commits; a path is None where that commit has no such file."""

    old: str | None
    new: str | None

    @property
    def name(self) -> str:
        return self.new or self.old or ""

    @property
    def how(self) -> str:
        if self.old is None or self.new is None:
            return "added" if self.old is None else "deleted"
        return "changed" if self.old == self.new else f"renamed from {self.old}"


def git(*words: str, stdin: bytes | None = None, codes: Collection[int] = (0,)) -> bytes:
    """Standard output of git in the working directory; a PlanError where there is none, or its exit code is none of `codes`."""
    try:
        done = subprocess.run(["git", *words], input=stdin, capture_output=True, check=False)
    except OSError as error:
        raise PlanError(f"cannot be run ({error.strerror}): install it", file="git") from None
    if done.returncode not in codes:
        errors = done.stderr.decode(errors="replace").strip().splitlines() or [f"exit code {done.returncode}"]
        word = next(each for each in words if each[0] not in "-u")
        raise PlanError(f"git {word}: {errors[0]}")
    return done.stdout


def commit(name: str) -> str:
    """The commit of a name: a PlanError where there is none, as in a clone that is not deep enough."""
    if name.startswith("-"):
        raise PlanError(f"{name!r} is no commit")
    try:
        return git("rev-parse", "--verify", "--quiet", f"{name}^{{commit}}").decode().strip()
    except PlanError:
        git("rev-parse", "--git-dir")  # says so where there is no repository at all
        raise PlanError(f"commit {name!r} is not in this repository: fetch it (actions/checkout with fetch-depth: 0)") from None


def changed(base: str, head: str | None) -> tuple[str, str, list[Changed]]:
    """Where to look for the parts that differ, by name: the commit that `head` began at on `base`, and that of `head`.

    Without a `head`, what is staged is compared with `base` itself.
    """
    if head is None:
        began, until = commit(base), git("write-tree").decode().strip()
    else:
        first, until = commit(base), commit(head)
        try:
            began = git("merge-base", first, until).decode().strip()
        except PlanError:
            raise PlanError(f"{base} and {head} have no common commit here: fetch all of them (fetch-depth: 0)") from None
    words = git("diff", "--name-status", "-z", "--find-renames", began, until).decode("utf-8", "surrogateescape")
    each, paths = iter(words.split("\0")), []
    for status in each:
        if not status:
            continue
        old = next(each)
        new = next(each) if status[0] in "RC" else old
        pair = Changed(None if status[0] in "AC" else old, None if status[0] == "D" else new)
        if Path(pair.name).suffix.lower() in PARTS:
            paths.append(pair)
    return began, until, sorted(paths, key=lambda part: part.name)


def content(at: str, path: str) -> bytes:
    """A file's bytes in a commit, as a checkout would have them: a PlanError where it is a pointer of Git LFS."""
    data = git("cat-file", "--filters", f"{at}:{path}")
    if data.startswith(_POINTER):
        raise PlanError("is a pointer of Git LFS, not the part: check it out with lfs: true", file=path)
    return data


#: Rules by which the command fails, each one stricter than the one before it.
RULES = ("none", "lost", "unreachable", "not-comparable")
#: Words of `--annotations`: where none is given, the environment decides.
KINDS = ("github", "none")
#: GitHub shows so many of a step; and findings of a part, in one.
_MOST, _FINDINGS = 10, 5


@dataclass(frozen=True, slots=True)
class Row:
    """A part that changed: what its best cutter reached before and reaches now, the difference, or why there is none."""

    part: Changed
    before: float | None = None
    after: float | None = None
    difference: "PlanDifference | None" = None
    #: The page of both plans, below the output folder, where they differ.
    beside: Path | None = None
    #: Target faces as it is that no cutter reaches whole.
    unreachable: tuple[str, ...] = ()
    #: Why it could not be planned as it is, or as it was.
    failed: str = ""
    unread: str = ""

    def breaks(self, rule: str) -> bool:
        """Whether the part fails by a rule: one of its test cases does."""
        return any(case.outcome in ("failure", "error") for case in row_cases(self, rule))


def row_cases(row: Row, rule: str) -> Iterator["Case"]:
    """The test cases of a part; what the rule lets pass is skipped, so that the report agrees with the exit code."""
    from plan_cutters.cases.files import Case
    from plan_cutters.domain.figures import listed
    from plan_cutters_ci.wording import difference_cases

    name, at = row.part.name, RULES.index(rule)

    def counted(case: Case, least: str) -> Case:
        passes = at < RULES.index(least) and case.outcome in ("failure", "error")
        return case._replace(outcome="skipped", message=f"{case.message} (--fail-on {rule} lets it pass)") if passes else case

    planned = Case(name, "planned")
    if row.part.new is None:
        yield planned._replace(outcome="skipped", message="it was deleted")
        return
    if row.failed:
        yield counted(planned._replace(outcome="error", kind="not_planned", message=row.failed), "lost")
        return
    yield planned
    if row.unread:
        case = Case(name, "planned as it was", "error", "not_planned", row.unread)
        yield counted(case, "not-comparable")
    if row.difference is not None:
        for case in difference_cases(row.difference):
            yield counted(case, "lost" if row.difference.lost else "not-comparable")
    whole = Case(name, "each face is reached whole by a cutter")
    if row.unreachable:
        text = f"no cutter reaches all of {listed(row.unreachable, 20)}"
        whole = whole._replace(outcome="failure", kind="unreachable", message=text)
    yield counted(whole, "unreachable")


def artifacts() -> str:
    """Address of the files that the job keeps; empty where this is no job."""
    names = ("GITHUB_SERVER_URL", "GITHUB_REPOSITORY", "GITHUB_RUN_ID")
    server, repository, run_id = (os.environ.get(name, "") for name in names)
    return f"{server}/{repository}/actions/runs/{run_id}#artifacts" if server and repository and run_id else ""


def summary(rows: Sequence[Row], rule: str, failing: Sequence[Row], began: str, artifacts: str) -> str:
    """The summary: with links to the files beside it, or to the artifacts of the job, which have them."""
    if not rows:
        return f"## plan-cutters\n\nNo part changed since {began[:12]}.\n"
    from plan_cutters.domain.figures import count, listed
    from plan_cutters_ci.wording import escaped, mark_of, page_link, section, table

    lines = ["## plan-cutters", ""]
    many = count(len(rows), "part")
    text = f"{len(failing)} of {many} fail{'s' if len(failing) == 1 else ''}" if failing else f"{many} changed, none fails"
    lines += [f"**{text}** by the rule `{rule}`, since {began[:12]}."]
    cells = (
        ("fails" if row in failing else "", row.part.name, row.part.how,
         row.failed or row.unread or (mark_of(row.difference) if row.difference else ""), _bar(row.before), _bar(row.after))
        for row in rows
    )  # fmt: skip
    lines += table(("", "part", "how", "result", "reached before", "reached now"), cells)
    for row in rows:
        if row.difference is not None and not row.difference.same:
            lines += ["", *section(row.difference)]
        if row.beside is not None:
            lines += ["", page_link(row.beside.as_posix(), artifacts)]
        if row.unreachable:
            lines += ["", f"No cutter reaches all of {listed(row.unreachable, 20)} of {escaped(row.part.name)}."]
    where = "in the artifact of this job" if artifacts else "in the folder of this summary"
    lines += ["", f"Pictures and review pages are {where}."]
    return "\n".join(lines) + "\n"


def _bar(share: float | None) -> str:
    """What the best cutter reaches of a part, drawn with letters: it needs no picture."""
    from plan_cutters.domain.figures import percent

    if share is None:
        return "-"
    # Full only where all is reached.
    full = 10 if share == 1.0 else min(9, int(10 * share))
    return f"{'█' * full}{'░' * (10 - full)} {percent(share)}"


def hand_on(rows: Sequence[Row], out: Path, text: str, job: str, failing: Sequence[Row]) -> None:
    """The summary and the facts, for people, for the job and for its next steps."""
    out.mkdir(parents=True, exist_ok=True)
    parts = [
        {"part": row.part.name, "how": row.part.how, "fails": row in failing, "error": row.failed or row.unread or None,
         "unreachable": list(row.unreachable),
         "difference": None if row.difference is None else json.loads(row.difference.model_dump_json())}
        for row in rows
    ]  # fmt: skip
    facts = {"format": "plan-cutters-changed", "format_version": 1, "parts": parts}
    (out / "summary.md").write_text(text, encoding="utf-8")
    (out / "changed.json").write_text(json.dumps(facts, indent=2) + "\n", encoding="utf-8")
    hand_out(text)
    outputs = {"parts": len(rows), "lost": sum(row.breaks("lost") for row in rows), "failing": len(failing), "folder": out}
    assignments = "".join(f"{name}={value}\n" for name, value in outputs.items())
    for variable, what in (("GITHUB_STEP_SUMMARY", job), ("GITHUB_OUTPUT", assignments)):
        if os.environ.get(variable):
            with open(os.environ[variable], "a", encoding="utf-8") as file:
                file.write(what)


def requested(kind: str | None) -> bool:
    """Whether annotations are written: as requested, else where this is a job of GitHub.

    >>> requested("github"), requested("none")
    (True, False)
    """
    return kind == "github" or (kind is None and os.environ.get("GITHUB_ACTIONS") == "true")


def annotations(parts: Iterable[tuple[str, Sequence["Case"]]]) -> Iterator[str]:
    """Lines, one at the file of each part that fails; of more parts than GitHub shows the last line says how many there are."""
    failing = [(part, [case for case in cases if case.outcome in ("failure", "error")]) for part, cases in parts]
    failing = [(part, cases) for part, cases in failing if cases]
    for part, cases in failing[: _MOST if len(failing) <= _MOST else _MOST - 1]:
        lines = [f"{case.name}: {case.message}" for case in cases[:_FINDINGS]]
        lines += [f"and {len(cases) - _FINDINGS} more"] * (len(cases) > _FINDINGS)
        text = "\n".join(lines)
        # The ends of a property are marked by commas and colons.
        file = _data(part).replace(":", "%3A").replace(",", "%2C")
        yield f"::error file={file},title=plan-cutters::{_data(text)}"
    if len(failing) > _MOST:
        yield f"::error title=plan-cutters::{len(failing) - _MOST + 1} more parts fail: the summary has all"


def _data(text: str) -> str:
    r"""A text that ends no line and begins no command.

    >>> _data("50 %\n::stop")
    '50 %25%0A::stop'
    """
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


if TYPE_CHECKING:
    from plan_cutters_batch.job import Settings

_SELF = "plan-cutters changed"
#: Options of a plan that this command gives itself.
_OURS = ("-o", "--out", "--formats", "--json", "--junit", "--sarif", "--quiet", "--check-operations", "--help",
         "-h", "--version")  # fmt: skip
_PLANNED = (0, 1, 4)

_commits, _output, _rules = heading("Commits"), heading("Output"), heading("Rule")


@dataclass(frozen=True)
class PartRequest:
    """How the parts are planned: the options after `--`, read once, so that all parts have the same tools."""

    settings: "Settings"
    #: More words of the command line, for what is no option of the plan.
    words: tuple[str, ...]

    @classmethod
    def of(cls, words: Sequence[str]) -> "PartRequest":
        """Read the options, and every file that they name; an error where an option has no meaning or a file cannot be used."""
        from plan_cutters.command.cli import command as plan
        from plan_cutters_batch.job import settings_of

        with plan.make_context(_SELF, ["part", *words]) as context:
            requested = PlanRequest(**context.params)
        if len(requested.parts) > 1:
            raise OptionError(f"{requested.parts[1]} cannot stand after --: only options can")
        settings = settings_of(requested, lambda: with_pictures(("json", "html"), lambda line: error(f"{_SELF}: {line}")))
        limits = [f"--{name}={value}" for name in ("timeout", "memory") if (value := getattr(requested, name)) is not None]
        return cls(settings, (*settings.words, *limits, *(["--debug"] if requested.debug else [])))


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ChangedRequest(Reported):
    """Parts that changed in a repository: `plan-cutters changed`."""

    #: Those of a plan, as words of its command line.
    plan_options: tuple[str, ...]
    base: str | None
    head: str
    staged: bool
    fail_on: str
    out: str
    annotations: str | None
    cache: str | None
    debug: bool


@click.command(
    cls=Command,
    examples=(
        (f"{_SELF} --base origin/main", "The parts of this branch, with the cutters that are built in:"),
        (f"{_SELF} --base main --fail-on lost -- --cutters shop.toml", "With options of a plan after --:"),
    ),
    codes=(
        ("0", "no part fails by the rule"),
        ("1", "a part fails by the rule"),
        ("2", "the command line or the repository is wrong"),
        ENDED,
    ),
)
@click.argument("plan_options", nargs=-1, metavar="[-- OPTION...]")
@_commits("--base", metavar="COMMIT",
          help="Compare with where HEAD began on this.  [default: the pull request's base, of GITHUB_BASE_REF]")  # fmt: skip
@_commits("--head", default="HEAD", metavar="COMMIT", help="The commit to look at.  [default: HEAD]")
@_commits("--staged", is_flag=True, help="Look at what is staged for the next commit, in place of a commit.")
@_rules(
    "--fail-on",
    type=click.Choice(RULES),
    default="lost",
    help="lost: a face or cutter is lost, or a part cannot be planned; unreachable: or no cutter reaches some face whole; "
    "not-comparable: or plans are not comparable; none: never.  [default: lost]",
)
@_output("-o", "--out", type=Folder("DIR"), default="plan-cutters-changed",
         help="Plans before and after, summary.md and changed.json.  [default: plan-cutters-changed]")  # fmt: skip
@_output("--cache", type=Folder("DIR"), help="Plans of earlier runs, by content; parts that are there are not planned again.")
@_output(
    "--annotations", type=click.Choice(KINDS),
    help="github: an ::error line for each part that fails, on standard error; none.  [default: github in a job of GitHub]",
)  # fmt: skip
@options("debug", junit={"help": "Also write what became of each part as JUnit XML; what --fail-on lets pass is skipped."},
         sarif={})  # fmt: skip
@takes(ChangedRequest)
def command(request: ChangedRequest) -> int:
    """Find the parts (STEP, IGES, BREP) that changed since COMMIT, and show which faces and cutters were lost.

    Each part is planned as it was and as it is, with the same options: those after --. The summary is Markdown, on standard
    output and in the file that GITHUB_STEP_SUMMARY names.
    """
    for word in request.plan_options:
        if word.partition("=")[0] in _OURS or re.match("-o.", word):
            raise OptionError(f"{word} cannot stand after --: this command gives it itself")
    base = request.base or (f"origin/{ref}" if (ref := os.environ.get("GITHUB_BASE_REF")) else "")
    if not base:
        raise OptionError("compare with which commit? give --base, as --base origin/main")
    files = request.case_files
    if files is not None:
        files.check()
    require_temporary()
    began, head, parts = changed(base, None if request.staged else request.head)
    out = Path(request.out)
    with tempfile.TemporaryDirectory() as folder:
        cache = Path(request.cache or folder).absolute()
        of_part = PartRequest.of(request.plan_options) if parts else None
        rows = [_compared(part, began, head, of_part, cache, out) for part in parts]
    failing = [row for row in rows if row.breaks(request.fail_on)]
    text, job = (summary(rows, request.fail_on, failing, began, at) for at in ("", artifacts()))
    hand_on(rows, out, text, job, failing)
    cases = [(row.part.name, [*row_cases(row, request.fail_on)]) for row in rows]
    if files is not None:
        files.write(_SELF, [case for _, each in cases for case in each])
    for line in annotations(cases) if requested(request.annotations) else ():
        error(line)
    for row in rows:
        for line in filter(None, (row.failed, row.unread)):
            error(f"{_SELF}: {line}")
    return 1 if failing else 0


def _compared(part: Changed, began: str, head: str, request: PartRequest | None, cache: Path, out: Path) -> Row:
    """Plan a part as it was and as it is; what cannot be planned is told in the row. A part that is gone is not planned."""
    if part.new is None or request is None:
        return Row(part)
    from plan_cutters.plan_file.load import PLAN, load_plan
    from plan_cutters_batch.store import MARKER
    from plan_cutters_ci.plans import compare, reached, unreachable
    from plan_cutters_ci.review import PAGE, write_page

    pages: dict[str, Path] = {}
    why: dict[str, str] = {}
    known: dict[bytes, Path] = {}
    for side, at, path in (("after", head, part.new), ("before", began, part.old)):
        if path is None:
            continue
        say(f"{path}: {'as it was' if side == 'before' else 'as it is'}")
        try:
            data = content(at, path)
            # A part that was only renamed is planned once.
            known[data] = plan = known.get(data) or _planned(data, path, request, cache)
            pages[side] = out / side / part.name
            shutil.rmtree(pages[side], ignore_errors=True)
            shutil.copytree(plan, pages[side], ignore=shutil.ignore_patterns(MARKER))
        except PlanError as fault:
            why[side] = str(fault) if fault.file == path else f"{path}: {fault}"
    plans = {side: load_plan(folder / PLAN) for side, folder in pages.items()}
    difference = compare(plans["before"], plans["after"], name=part.name) if len(plans) == 2 else None
    side_page = Path("compare", part.name, PAGE)
    shutil.rmtree((out / side_page).parent, ignore_errors=True)
    if difference and not difference.same:
        (out / side_page).parent.mkdir(parents=True)
        names = {"before": f"as it was, {began[:12]}", "after": "as it is"}
        write_page(out / side_page, difference, [(names[side], pages[side] / PLAN) for side in names])
    shares = {side: max(map(reached, plan.cutters), default=0.0) for side, plan in plans.items()}
    return Row(
        part, shares.get("before"), shares.get("after"), difference, side_page if (out / side_page).is_file() else None,
        tuple(unreachable(plans["after"])) if "after" in plans else (), why.get("after", ""), why.get("before", ""),
    )  # fmt: skip


def _planned(content: bytes, path: str, request: PartRequest, cache: Path) -> Path:
    """The folder of a plan of a part in the cache, planned unless it is there; a PlanError where it cannot be planned."""
    from plan_cutters.plan_file.load import load_plan
    from plan_cutters_base.user_files import checksum
    from plan_cutters_batch import work
    from plan_cutters_batch.job import key_of
    from plan_cutters_batch.row import row_of
    from plan_cutters_batch.store import Store

    name = Path(path).name
    key = key_of(content, request.settings.key)
    # The part's name stands in its plan.
    folder = checksum(f"{key} {name}".encode("utf-8", "surrogateescape"))
    store = Store(str(cache))
    if work.cached(store, folder, key, name, path) is not None:
        return cache / folder
    cache.mkdir(parents=True, exist_ok=True)
    task = work.Task(name, path, None, request.settings.handed, request.words, key)
    with tempfile.TemporaryDirectory(dir=cache, prefix=".") as place:
        code, line = work.planned(task, content, Path(place))
        made = work.files_of(Path(place) / "out")
        if code not in _PLANNED or work.PLAN not in made:
            raise PlanError(line or f"ended with exit code {code} and no plan")
        plan = load_plan(made[work.PLAN])
        store.publish(folder, made, row_of(plan, name=name, file=path, code=code, key=key, folder=folder, seconds=0.0))
    return cache / folder
