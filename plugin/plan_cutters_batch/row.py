"""A line of the table of all parts: what a plan says of its part in a line, and what that means for many."""

import math
from collections import Counter
from collections.abc import Iterable, Sequence
from itertools import chain
from typing import Literal, get_args

from pydantic import BaseModel, ConfigDict

from plan_cutters.cases import files as case
from plan_cutters.cases.files import Case
from plan_cutters.plan_file.model import CutterEntry, FaceEntry, Plan
from plan_cutters.plan_file.reasons import REASONS
from plan_cutters_base.workers.child import TIMED_OUT

#: Needs of a part that its row names.
_NEEDS = 3
#: Seconds that each of the two searches may take; then the best set so far is reported, with the bound that is proved by then.
_SECONDS = 10.0


class PartTools(BaseModel):
    """The part of a plan from which the tools of many parts are chosen: sets that finish the part beyond doubt."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    #: How people call each tool that was judged, by its id: the same dimensions, the same id.
    names: dict[str, str]
    #: Whether the tools finish the part beyond doubt (exit code 0). All but `used`, `share` and `needs` is empty where not.
    finished: bool = False
    #: Ids of the tools each of which reaches every judged sample.
    alone: tuple[str, ...] = ()
    #: Sets that the plan states to finish the part: its process, its least set.
    together: tuple[tuple[str, ...], ...] = ()
    #: Of each face the tools that reach it whole, but for what follows from others (`essential`). Empty where the part was judged
    #: in several setups, for the plan counts the samples of a face in the first one alone.
    faces: tuple[tuple[str, ...], ...] = ()
    #: Tools of the steps of the plan, whatever it finishes.
    used: tuple[str, ...] = ()
    #: Of what is requested, that all tools finish together, 0 to 1.
    share: float | None = None
    #: What would finish more, the best first.
    needs: tuple[str, ...] = ()

    def finished_by(self, tools: Iterable[str]) -> bool:
        """Whether the plan states that some tools finish the part together."""
        there = set(tools)
        if not self.finished:
            return False
        if there & set(self.alone) or any(there.issuperset(each) for each in self.together):
            return True
        return bool(self.faces) and all(there & set(face) for face in self.faces)


def part_tools(plan: Plan, code: int, names: dict[str, str]) -> PartTools:
    """Read from a plan with an exit code which tools finish its part; `names`: how its tools are called in a line, by id."""
    process = plan.process
    used = {step.cutter: None for step in process.steps}
    if not used and (taken := plan.selected or plan.selected_over_setups):
        used = {taken: None}
    # The next things to try, then what each area left needs; to ask for more answers is nothing that the part needs.
    tries = [each.words for each in process.next if "--answers" not in each.argv and process.left]
    needs = [text for text in dict.fromkeys((*tries, *(each.needs for each in process.left))) if text][:_NEEDS]
    made = PartTools(names=names, used=tuple(used), share=process.finished_share, needs=tuple(needs))
    if code != 0:
        return made
    # What may lie between its samples is a doubt: such a tool finishes nothing beyond doubt.
    sure = [c for c in plan.cutters if c.seen or plan.effective.sampled_by != "default"]
    ids = {c.id for c in sure}
    sets = [tuple(used)] if used else []
    if plan.least_set is not None and not plan.least_set.left and not plan.least_set.doubtful and plan.least_set.runs:
        sets.append(tuple(dict.fromkeys(run.cutter for run in plan.least_set.runs)))
    several = bool(plan.effective.other_setups) or any(len(c.setups) > 1 for c in plan.cutters)
    return made.model_copy(
        update={
            "finished": True,
            "alone": tuple(c.id for c in sure if c.feasible or (several and c.lost_in_all == 0)),
            "together": tuple(dict.fromkeys(tuple(sorted(each)) for each in sets if ids.issuperset(each))),
            "faces": () if several else _faces(plan.faces, sure),
        }
    )


def _faces(faces: Iterable[FaceEntry], cutters: list[CutterEntry]) -> tuple[tuple[str, ...], ...]:
    """The tools that reach each of the faces that are to be machined whole."""
    every = list[tuple[str, ...]]()
    for face in faces:
        counts = {c.id: c.faces[face.id] for c in cutters if face.id in c.faces}
        # Without a sample of the finished part's surface there is nothing to reach.
        if not face.target or not any(each.reached + each.not_reached + each.unjudged for each in counts.values()):
            continue
        every.append(tuple(name for name, each in counts.items() if each.reached and not each.not_reached and not each.unjudged))
    return essential(every)


def essential(faces: Iterable[tuple[str, ...]]) -> tuple[tuple[str, ...], ...]:
    """Keep the faces that say more than others do: whatever does these does a face that more tools reach whole.

    >>> essential([("D6",), ("D6", "D8")])
    (('D6',),)
    """
    stays: list[tuple[str, ...]] = []
    for whole in sorted(dict.fromkeys(faces), key=len):
        if not any(set(whole).issuperset(one) for one in stays):
            stays.append(whole)
    return tuple(stays)


#: A condition: columns with their factors, and what they sum up to at least.
_Condition = tuple[frozenset[tuple[int, float]], float]


def fewest(parts: Sequence[PartTools]) -> tuple[str, ...]:
    """Find the fewest tools for all parts that are finished: their ids, the one that finishes most parts alone first.

    A set counts as finishing a part if the plan says so: a tool that does so alone, the tools of its process or of its least set,
    or tools of which one reaches each face whole. Tools that share a face in some other way might do as well; the plans do not
    state it. Parts that are not finished are left out.

    Examples
    --------
    >>> a = PartTools(names={}, finished=True, alone=("D6", "D8"))
    >>> b = PartTools(names={}, finished=True, alone=("D8",))
    >>> fewest([a, b]), fewest([])
    (('D8',), ())
    """
    stated = (part for part in parts if part.finished and (part.alone or part.together or part.faces))
    different = list({(*map(frozenset, (part.names, part.alone, part.faces)), frozenset(map(frozenset, part.together))): part
                      for part in stated}.values())  # fmt: skip
    if not different:
        return ()
    alone = Counter(name for part in parts for name in part.alone)
    used = Counter(name for part in parts for name in part.used)
    names = {name for part in different for name in (*part.names, *part.alone, *chain(*part.together, *part.faces))} | {*alone}
    tools = sorted(names, key=lambda name: (-alone[name], -used[name], name))
    place = {name: k for k, name in enumerate(tools)}
    rows, columns = _stated(different, place)
    # Of sets of as many, the one of the tools that finish most parts alone.
    cost = [1.0 + k / (1.0 + len(tools) ** 2) for k in range(len(tools))]
    values = _least(cost + [0.0] * (columns - len(tools)), rows)
    chosen = None if values is None else {name for name, k in place.items() if values[k] > 0.5}
    if chosen is None or not all(part.finished_by(chosen) for part in different):
        chosen = _greedy(different)
    return tuple(sorted(chosen, key=place.__getitem__))


def _stated(parts: Sequence[PartTools], place: dict[str, int]) -> tuple[list[_Condition], int]:
    """The conditions under which tools finish all parts, and how many columns: tools, then sets of a part that are used whole."""
    rows, columns = dict[_Condition, None](), len(place)
    for part in parts:
        mine: set[int] = set()
        for names in part.together:
            if not set(names) & set(part.alone):
                rows |= dict.fromkeys((frozenset({(place[name], 1.0), (columns, -1.0)}), 0.0) for name in names)
                mine.add(columns)
                columns += 1
        mine |= {place[name] for name in part.alone}
        for whole in {*part.faces} or {()}:
            rows[frozenset((k, 1.0) for k in mine | {place[name] for name in whole}), 1.0] = None
    return list(rows), columns


def _greedy(parts: Sequence[PartTools]) -> set[str]:
    """A set that finishes all parts, not the fewest: for each part the smallest set that its plan states."""
    chosen: set[str] = set()
    for part in parts:
        if not part.finished_by(chosen):
            sets = [{name} for name in part.alone] + [set(each) for each in part.together]
            chosen |= min(sets, key=len) if sets else {face[0] for face in part.faces}
    return chosen


def _least(cost: Sequence[float], rows: Sequence[_Condition]) -> Sequence[float] | None:
    """The values 0 or 1 of least cost under conditions; None where none were found in time."""
    from scipy.optimize import Bounds, LinearConstraint, milp
    from scipy.sparse import coo_array

    entries = [(i, k, factor) for i, (factors, _) in enumerate(rows) for k, factor in factors]
    i, k, values_there = zip(*entries, strict=True)
    table = coo_array((values_there, (i, k)), shape=(len(rows), len(cost))).tocsr()
    values: Sequence[float] | None = milp(
        list(cost),
        integrality=[1] * len(cost),
        bounds=Bounds(0, 1),
        options={"time_limit": _SECONDS, "mip_rel_gap": 0.0},
        constraints=LinearConstraint(table, [least for _, least in rows], math.inf),
    ).x
    return values


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
    #: Of the area to machine that the process finishes, as the headline has it, 0 to 1.
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
    plan: Plan, *, name: str, file: str, code: int, key: str = "", folder: str | None = None, seconds: float | None = None
) -> PartRow:
    """Sum up a plan, as written, in a line; its cutter is the one that the headline names, its code what the plan asks for.

    `folder` has the part's files, below the output and with `/`; without it the row names no page and no picture. `seconds` by
    the clock; default what the plan says of its own run.
    """
    from plan_cutters.plan_file.words.cutters import main_reason
    from plan_cutters.plan_file.words.headline import headline, headline_cutter
    from plan_cutters.plan_file.words.names import short_names
    from plan_cutters.report.folder import file_name

    names = short_names(plan)
    cutter = headline_cutter(plan)
    causes = [each.cause for each in plan.process.left if each.cause in REASONS]
    reason = causes[0] if causes else None
    if not reason:
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
        name=name, file=file, key=key, status="planned", code=code,
        verdict=headline(plan, names).title,
        cutter=names[cutter.id],
        share=plan.process.finished_share,
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
