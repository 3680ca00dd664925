"""A branch has a row for each part that changed: by which rule it fails, its test cases, its lines for a job, and the summary."""

import hashlib
import json
import os
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from plan_cutters.command.terminal import hand_out
from plan_cutters_ci.repository import Changed, publish

if TYPE_CHECKING:
    from plan_cutters.cases.case import Case
    from plan_cutters_ci.model import PlanDifference

#: Rules by which the command fails, each one stricter than the one before it.
RULES = ("none", "lost", "unreachable", "not-comparable")
#: Words of `--annotations`: where none is given, the environment decides.
KINDS = ("github", "none")
#: GitHub shows so many of a step; and findings of a part, in one.
_MOST, _FINDINGS = 10, 5


@dataclass(frozen=True, slots=True)
class Row:
    """A part that changed: its folders of plans before and after, the difference, or why there is none."""

    part: Changed
    before: Path | None = None
    after: Path | None = None
    difference: "PlanDifference | None" = None
    #: The page of both plans, below the output folder, where they differ.
    beside: Path | None = None
    #: Target faces as it is that no cutter reaches whole.
    unreachable: tuple[str, ...] = ()
    #: Why it could not be planned as it is, or as it was.
    failed: str = ""
    unread: str = ""

    def breaks(self, rule: str) -> bool:
        """Whether the part fails by a rule."""
        at = RULES.index(rule)
        worse = self.difference is not None and self.difference.lost
        doubtful = bool(self.unread) or (self.difference is not None and not self.difference.comparable)
        return (at >= 1 and (worse or bool(self.failed))) or (at >= 2 and bool(self.unreachable)) or (at >= 3 and doubtful)


def row_cases(row: Row, rule: str) -> Iterator["Case"]:
    """The test cases of a part; what the rule lets pass is skipped, so that the report agrees with the exit code."""
    from plan_cutters.cases.case import Case
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


def links_of(rows: Sequence[Row], branch: str) -> dict[Path, str]:
    """Addresses of the pictures of folders, once they are pushed."""
    data = {
        folder: (folder / "review.png").read_bytes()
        for row in rows
        for folder in (row.before, row.after)
        if folder is not None and (folder / "review.png").is_file()
    }
    names = {folder: f"{hashlib.sha256(each).hexdigest()[:32]}.png" for folder, each in data.items()}
    made = publish({names[folder]: each for folder, each in data.items()}, branch, "origin")
    where = f"{os.environ.get('GITHUB_SERVER_URL', '')}/{os.environ.get('GITHUB_REPOSITORY', '')}/raw/{made}"
    return {folder: f"{where}/{name}" for folder, name in names.items()}


def artifacts() -> str:
    """Address of the files that the job keeps; empty where this is no job."""
    names = ("GITHUB_SERVER_URL", "GITHUB_REPOSITORY", "GITHUB_RUN_ID")
    server, repository, run_id = (os.environ.get(name, "") for name in names)
    return f"{server}/{repository}/actions/runs/{run_id}#artifacts" if server and repository and run_id else ""


def summary(rows: Sequence[Row], rule: str, failing: Sequence[Row], links: dict[Path, str], began: str, artifacts: str) -> str:
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
        shown = [(side, links[folder]) for side, folder in (("before", row.before), ("now", row.after)) if folder in links]
        lines += [line for side, link in shown for line in ("", f"![{escaped(row.part.name)} {side}]({link})")]
    if not links:
        where = "in the artifact of this job" if artifacts else "in the folder of this summary"
        lines += ["", f"Pictures and review pages are {where}."]
    return "\n".join(lines) + "\n"


def _bar(folder: Path | None) -> str:
    """What the best cutter reaches of a part, drawn with letters: it needs no picture."""
    from plan_cutters.domain.figures import percent
    from plan_cutters.plan_file.load import PLAN, load_plan
    from plan_cutters_ci.plans import reached

    if folder is None:
        return "-"
    share = max((reached(cutter) for cutter in load_plan(folder / PLAN).cutters), default=0.0)
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
    """The lines, without line ends, of parts by their paths in the repository: one at the file of each that fails.

    Of more parts than GitHub shows the last line says how many there are.
    """
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
