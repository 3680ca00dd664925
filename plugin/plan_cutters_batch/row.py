"""A line of the table of all parts, and what of a plan it is made of: its answer, and the tools that finish the part."""

from collections.abc import Iterable, Sequence
from typing import Literal

from pydantic import BaseModel, ConfigDict

from plan_cutters.plan_file.model import CutterEntry, FaceEntry, Plan
from plan_cutters.plan_file.shares import reached_share

#: `planned` in this run, `kept` from an earlier one, or `failed`: then `error` says why.
Status = Literal["planned", "kept", "failed"]
#: Needs of a part that its row names.
_NEEDS = 3


class FaceTools(BaseModel):
    """The tools that reach a face whole, and those that reach some of it."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    whole: tuple[str, ...]
    partly: tuple[str, ...] = ()


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
    #: What reaches the faces: the ways that say more than others (`essential`). Empty where the part was judged in several
    #: setups, for the plan counts the samples of a face in the first one alone.
    faces: tuple[FaceTools, ...] = ()
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
        return bool(self.faces) and all(there & set(face.whole) for face in self.faces)


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
    #: Of the area to machine that this cutter reaches, 0 to 1.
    share: float | None = None
    #: The reason, a code of the plan's, by which it loses most.
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
    reason = None
    if cutter:
        # The code by which most of the area is not reached; by samples where these stand for no area.
        reason = main_reason(cutter.area_share) or None
        if not reason and cutter.not_reached:
            both = (cutter.by_reason, cutter.undecided_by_reason)
            samples = {code: sum(each.get(code, 0) for each in both) for each in both for code in each}
            reason = max(samples, key=lambda code: samples[code], default=None)
    written = {form: f"{folder}/{file_name(form)}" for form in plan.files} if folder else {}
    return PartRow(
        name=name, file=file, key=key, status=status, code=code,
        verdict=headline(plan, names).title if cutter else "No cutter was judged",
        cutter=names[cutter.id] if cutter else None,
        share=reached_share(cutter, cutter.area_share) if cutter else None,
        reason=reason,
        cutters=len(plan.cutters), samples=plan.samples.judged,
        faces=sum(face.target and face.samples > 0 for face in plan.faces),
        seconds=plan.run.total if seconds is None else seconds,
        folder=folder, page=written.get("html"), picture=written.get("png"), tools=part_tools(plan, code, names),
    )  # fmt: skip


def part_tools(plan: Plan, code: int, names: dict[str, str]) -> PartTools:
    """Read from a plan with an exit code which tools finish its part; `names`: how its tools are called in a line, by id."""
    process = plan.process
    used = {step.cutter: None for step in process.steps} if process else {}
    if not used and (taken := plan.selected or plan.selected_over_setups):
        used = {taken: None}
    needs: list[str] = []
    if process is not None and process.left:
        # The next things to try, then what each area left needs; to ask for more answers is nothing that the part needs.
        tries = [each.words for each in process.next if "--answers" not in each.argv]
        needs = [text for text in dict.fromkeys((*tries, *(each.needs for each in process.left))) if text][:_NEEDS]
    share = process.finished_share if process else None
    made = PartTools(names=names, used=tuple(used), share=share, needs=tuple(needs))
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


def _faces(faces: Iterable[FaceEntry], cutters: list[CutterEntry]) -> tuple[FaceTools, ...]:
    """The ways in which the tools reach the faces that are to be machined."""
    ways: dict[FaceTools, None] = {}
    for face in faces:
        counts = {c.id: c.faces[face.id] for c in cutters if face.id in c.faces}
        # Without a sample of the finished part's surface there is nothing to reach.
        if not face.target or not any(each.reached + each.not_reached + each.unjudged for each in counts.values()):
            continue
        whole = tuple(name for name, each in counts.items() if each.reached and not each.not_reached and not each.unjudged)
        partly = tuple(name for name, each in counts.items() if each.reached and name not in whole)
        ways[FaceTools(whole=whole, partly=partly)] = None
    return essential(tuple(ways))


def essential(ways: Sequence[FaceTools]) -> tuple[FaceTools, ...]:
    """Keep the ways that say more than others do, so that a part of many faces has a short row.

    A way follows from another one if whatever tools do that face whole do this one, and those that do some of it as well.

    >>> essential([FaceTools(whole=("D6",)), FaceTools(whole=("D6", "D8"))])
    (FaceTools(whole=('D6',), partly=()),)
    """
    names = {name: 1 << k for k, name in enumerate(dict.fromkeys(name for way in ways for name in (*way.whole, *way.partly)))}
    masks = {way: (sum(names[name] for name in way.whole), sum(names[name] for name in way.partly)) for way in ways}
    stays: dict[FaceTools, tuple[int, int]] = {}
    for way in sorted(masks, key=lambda each: (len(each.whole), len(each.partly))):
        whole, partly = masks[way]
        if not any(not (w & ~whole) and not (p & ~(whole | partly)) for w, p in stays.values()):
            stays[way] = whole, partly
    return tuple(stays)
