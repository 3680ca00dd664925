"""A line of the table of all parts: what a plan says of its part in a line, and what that means for many."""

from collections import Counter
from typing import Literal, get_args

from pydantic import BaseModel, ConfigDict

from plan_cutters.cases import files as case
from plan_cutters.cases.files import Case
from plan_cutters.plan_file.model import Plan
from plan_cutters.plan_file.reasons import REASONS
from plan_cutters.plan_file.shares import reached_share
from plan_cutters_base.workers.child import TIMED_OUT
from plan_cutters_batch.tools import PartTools, part_tools

#: Exit codes of a batch: as of a single plan (`docs/command.md`).
USAGE, UNREADABLE = 2, 3
#: `planned` in this run, `kept` from an earlier one, or `failed`: then `error` says why.
Status = Literal["planned", "kept", "failed"]
#: What came of a part, from worst to best.
Outcome = Literal["failed", "not_finished", "not_sure", "finished"]
#: The same in words for people.
OUTCOMES: dict[Outcome, str] = {word: word.replace("_", " ") for word in get_args(Outcome)}
#: What is not sure is neither reached nor known not to be.
_AS_CASES: dict[Outcome, case.Outcome] = {
    "failed": "error", "not_finished": "failure", "not_sure": "error", "finished": "passed"
}  # fmt: skip
#: By the exit code of a single plan; every other code is a failure.
_OF_CODES: dict[int, Outcome] = {0: "finished", 1: "not_finished", 4: "not_sure"}


class PartRow(BaseModel):
    """A row says what came of one part."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    #: Of the part among all, and of its folder.
    name: str
    #: Path or URL, as it was given.
    file: str
    #: Of the content of the file, the effective options, tools, machine and version: SHA-256; empty where it is not known.
    key: str = ""
    status: Status
    #: Exit code, as of a single plan (`docs/command.md`).
    code: int
    #: The headline of the plan: one sentence.
    verdict: str = ""
    #: The cutter selected, or the one that leaves the least area.
    cutter: str | None = None
    #: Of the area to machine that the process finishes, as the headline has it, 0 to 1; of an older plan what the cutter reaches.
    share: float | None = None
    #: The cause, a code of the plan's, for which most of it stays.
    reason: str | None = None
    #: How many were judged.
    cutters: int | None = None
    samples: int | None = None
    faces: int | None = None
    #: By the clock, of the run that made it.
    seconds: float = 0.0
    #: With the files of a single plan, below the output.
    folder: str | None = None
    #: The review page and the picture, below the output, where they were written.
    page: str | None = None
    picture: str | None = None
    #: One line: file, face, cause, what to try.
    error: str | None = None
    #: The part was sampled more coarsely than requested: what was requested, and what was done in its place.
    coarser: str | None = None
    #: Which tools finish the part, alone or together; in no table.
    tools: PartTools | None = None


def row_of(
    plan: Plan, *, name: str, file: str, code: int, key: str = "", status: Status = "planned", folder: str | None = None,
    seconds: float | None = None,
) -> PartRow:  # fmt: skip
    """Sum up a plan, as written, in a line; its cutter is the one that the headline names, its code what the plan asks for.

    `folder` has the part's files, below the output and with `/`; without it the row names no page and no picture. `seconds` by
    the clock; default what the plan says of its own run.
    """
    from plan_cutters.plan_file.words.cutters import main_reason
    from plan_cutters.plan_file.words.headline import headline, headline_cutter
    from plan_cutters.plan_file.words.names import short_names
    from plan_cutters.report.folder import file_name

    names = short_names(plan)
    cutter = headline_cutter(plan) if plan.cutters else None
    causes = [each.cause for each in plan.process.left if each.cause in REASONS] if plan.process else []
    reason = causes[0] if causes else None
    if cutter and not reason:
        # The code by which most of the area is not reached; by samples where these stand for no area.
        reason = main_reason(cutter.area_share) or None
        if not reason and cutter.not_reached:
            samples = Counter(cutter.by_reason) + Counter(cutter.undecided_by_reason)
            reason = max(samples, key=lambda code: samples[code], default=None)
    written = {form: f"{folder}/{file_name(form)}" for form in plan.files} if folder else {}
    # Sampled more coarsely than requested: that would have taken too many samples.
    coarser = dict(zip(plan.note_codes, plan.notes, strict=False)).get("coarser_than_requested")
    missing = "; ".join(f"{name}: {why}" for name, why in plan.not_written.items())
    return PartRow(
        name=name, file=file, key=key, status=status, code=code,
        verdict=headline(plan, names).title if cutter else "No cutter was judged",
        cutter=names[cutter.id] if cutter else None,
        share=plan.process.finished_share if plan.process else reached_share(cutter, cutter.area_share) if cutter else None,
        reason=reason,
        cutters=len(plan.cutters), samples=plan.samples.judged,
        faces=sum(face.target and face.samples > 0 for face in plan.faces),
        seconds=plan.run.total if seconds is None else seconds,
        folder=folder, page=written.get("html"), picture=written.get("png"),
        error=f"not written: {missing}" if missing else None,
        coarser=None if coarser is None else f"{coarser[:1].lower()}{coarser[1:].removesuffix('.')}",
        tools=part_tools(plan, code, names),
    )  # fmt: skip


def failed(name: str, file: str, why: str, code: int = USAGE, *, key: str = "", seconds: float = 0.0) -> PartRow:
    """The row of a part that cannot be planned, or of a source that holds none: `why` is one line, with the place."""
    return PartRow(name=name, file=file, key=key, status="failed", code=code, error=why, seconds=seconds)


def outcome(row: PartRow) -> Outcome:
    """Sum up a part in a word.

    >>> outcome(PartRow(name="a", file="a.step", status="kept", code=4))
    'not_sure'
    >>> outcome(PartRow(name="a", file="a.step", status="planned", code=139))
    'failed'
    """
    return "failed" if row.status == "failed" else _OF_CODES.get(row.code, "failed")


def code_of(row: PartRow) -> int:
    """The exit code of a part: a failure has never that of an answer.

    >>> code_of(PartRow(name="a", file="a.step", status="failed", code=0))
    3
    """
    return row.code if outcome(row) != "failed" or row.code > 1 else 3


#: What may end a batch with a code that is not zero, as `--fail-on` names it.
FAIL_ON = ("refused", "unreadable", "late", "unfinished", "unsure")


def fault(row: PartRow) -> str:
    """Name what is wrong with a part, as `--fail-on` does; empty where it is finished.

    >>> fault(PartRow(name="a", file="a.step", status="failed", code=124))
    'late'
    >>> fault(PartRow(name="a", file="a.step", status="failed", code=139))
    'unreadable'
    >>> fault(PartRow(name="a", file="a.step", status="kept", code=0))
    ''
    """
    result = outcome(row)
    if result == "failed":
        return {2: "refused", TIMED_OUT: "late"}.get(code_of(row), "unreadable")
    return {"not_finished": "unfinished", "not_sure": "unsure", "finished": ""}[result]


def cause(row: PartRow) -> str:
    """Why a part failed: never empty."""
    return row.error or f"no cause was reported (exit code {row.code})"


def part_case(row: PartRow) -> Case:
    """The case of a part: an error without an answer or where the answer is not sure, a failure where it is not finished.

    >>> part_case(PartRow(name="a", file="in/a.step", status="failed", code=124, error="not done within 9 s")).outcome
    'error'
    """
    result = outcome(row)
    if result == "finished":
        return Case(row.file, row.name, seconds=row.seconds)
    text = cause(row) if result == "failed" else row.verdict
    kind = f"exit_code_{row.code}" if result == "failed" else row.reason or result
    details = row.error or "" if result != "failed" else ""
    return Case(row.file, row.name, _AS_CASES[result], kind, text, details, row.seconds)
