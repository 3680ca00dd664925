"""The tools: each takes a question, has the command work on it, and makes an answer that is no longer than is allowed."""

import contextlib
import json
import shutil
from collections.abc import Awaitable, Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import anyio.to_thread

from plan_cutters.domain.figures import percent
from plan_cutters.errors import CutterError
from plan_cutters.plan_file.model import Plan
from plan_cutters_agents import plan_answers as answers
from plan_cutters_agents import requests
from plan_cutters_agents.access import CallError, spelled
from plan_cutters_agents.child import Call
from plan_cutters_agents.short import LISTS, short

#: How long lists may be, until the answer is short enough; of rotations in an explanation.
_LENGTHS, _ROTATIONS = (60, 30, 12, 5, 2, 0), 12
#: Largest picture that is handed over, bytes.
_PICTURE = 8 << 20


@dataclass(frozen=True, slots=True)
class Reply:
    """An answer, and a picture (PNG) where there is one."""

    answer: answers.Answer
    picture: bytes | None = None
    #: Written files, by what they are.
    files: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Tool:
    """A tool by its name: what it is for, the models of question and answer, and its work."""

    name: str
    title: str
    description: str
    question: type[requests.Question]
    answer: type[answers.Answer]
    work: Callable[[Any, Call], Awaitable[Reply]]
    writes: bool = False


def fitting(answer: answers.Answer, characters: int) -> dict[str, Any]:
    """The answer as JSON, with the longest lists with which it is short enough; a CallError where it is too long without them."""
    whole = answer.model_dump(mode="json")
    for most in _LENGTHS:
        lengths = dict.fromkeys(LISTS, most)
        if isinstance(answer, answers.Explanation):
            lengths["rotations"] = min(most, _ROTATIONS)
        made = short(whole, lengths)
        for row in made.get("differ", ()):
            names = {each["id"] for each in made["cutters"]}
            row["reached"] = {name: share for name, share in row["reached"].items() if name in names}
        if len(json.dumps(made, ensure_ascii=False)) <= characters:
            return made
    raise CallError(f"the answer has more than {characters} characters even without its lists: ask about fewer faces or cutters")


async def plan_part(question: requests.PlanQuestion, call: Call) -> Reply:
    """Plan a part, into a folder where one is named."""
    words = await _part(question, call)
    words += spelled(answers=",".join(question.answers) or None, operations=question.operations, feed=question.feed_mm_min)
    if question.process is not None:
        # Beside nothing else: the name is the place that its faults are told with.
        file = call.cwd / "process.json"
        file.write_text(question.process.model_dump_json(exclude_none=True), encoding="utf-8")
        words += [f"--process={file}"]
    if question.out is None:
        plan, code = await call.plan(words)
        files = {}
    else:
        out = call.permissions.roots.folder(question.out)
        formats = ",".join(dict.fromkeys(("json", *question.formats)))
        with _whole(out):
            plan, code = await call.plan([*words, f"--out={out}", f"--formats={formats}"])
        files = {"json": str(out / "plan.json"), **{name: str(out / each.name) for name, each in plan.files.items()}}
    return Reply(answers.planned(plan, code, files), files=files)


async def compare_cutters(question: requests.CompareQuestion, call: Call) -> Reply:
    """Judge some cutters and tell them apart."""
    plan, code = await call.plan(await _part(question, call))
    return Reply(answers.compared(plan, code))


async def render(question: requests.RenderQuestion, call: Call) -> Reply:
    """Draw the part with the verdicts of the cutter that the plan selects, or that comes nearest."""
    out = call.cwd / "review"
    plan, code = await call.plan([*await _part(question, call), f"--out={out}", "--formats=json,png"])
    picture = out / "review.png"
    if not picture.is_file():
        raise CallError(plan.not_written.get("png", "the picture was not written"), file=plan.part.file)
    if picture.stat().st_size > _PICTURE:
        raise CallError(f"the picture has more than {_PICTURE >> 20} MB", file=plan.part.file)
    return Reply(answers.pictured(plan, code), picture.read_bytes())


async def posture_map(question: requests.MapQuestion, call: Call) -> Reply:
    """Map all postures of a cutter at a point."""
    if question.library is not None:
        await call.tools_of(question.library)
    spec = await _spec(question.cutter, question, call) if question.library is None else None
    output, code = await call.map(question, spec)
    picture = (call.cwd / "map.png").read_bytes() if question.picture else None
    cutter, postures = json.loads(output)["cutter"], answers.postures_of(output)
    free, undecided = percent(postures["free_share"]), percent(postures["undecided_share"])
    where = f"({', '.join(f'{x:.6g}' for x in postures['point'])}) on {postures['face']}"
    text = f"{cutter} at {where}: {free} of the postures searched are free, {undecided} undecided."
    part = Path(question.part).name
    return Reply(answers.MapAnswer(part=part, told=text, cutter=cutter, exit_code=code, postures=postures), picture)


async def explain_sample(question: requests.ExplainQuestion, call: Call) -> Reply:
    """Say why a cutter does not reach a face or a point, and what would help."""
    postures = sample = None
    if question.plan is not None:
        plan = await call.plan_in(question.plan)
        cutter, face = answers.cutter_of(plan, question.cutter), question.face
        if question.point is not None:
            sample = await anyio.to_thread.run_sync(
                answers.nearest_sample, question.plan, plan, cutter.id, question, call.permissions
            )
            face = sample["face"]
    else:
        plan, name, face, postures = await _judged(question, call)
        cutter = answers.cutter_of(plan, name)
    if face is None:
        raise CallError("which place? give a face or a point")
    at = None if postures is None else answers.postures_of(postures)
    return Reply(answers.explained(plan, cutter, face, point=question.point, postures=at, sample=sample))


async def list_tools_and_machines(question: requests.ShopQuestion, call: Call) -> Reply:
    """List the tools of a library, or the built-in ones, and the built-in machines."""
    unused: list[str] = []
    if question.library is None:
        tools = await anyio.to_thread.run_sync(answers.built_in_tools)
    else:
        tools, unused = answers.tools_in(await call.listed("tools", call.permissions.file(question.library)))
    machines = answers.machines_in(await call.listed("machines")) if question.machines else []
    library = "" if question.library is None else Path(question.library).name
    what = library or "the built-in set, for a first look: nobody's tools"
    text = f"{len(tools)} tools of {what}; {len(machines)} built-in machines; `unlimited` and `tilt:DEG` are others."
    return Reply(answers.ShopAnswer(part="", told=text, library=library, tools=tools, unused=unused, machines=machines))


async def compare_plans(question: requests.DifferenceQuestion, call: Call) -> Reply:
    """Compare two plans that are there."""
    old, new = [await call.plan_in(file) for file in (question.old, question.new)]
    return Reply(await anyio.to_thread.run_sync(answers.difference, old, new))


async def _judged(question: requests.ExplainQuestion, call: Call) -> tuple[Plan, str, str, bytes | None]:
    """Judge the face in question with the cutter in question: the plan, the cutter, the face, and the map at the point."""
    if question.part is None:
        raise CallError("give either `part` or `plan`")
    spec = await _spec(question.cutter, question, call)
    face, postures = question.face, None
    under = {name: getattr(question, name) for name in requests.Conditions.model_fields if name != "library"}
    if question.point is not None:
        if question.setup[0] == "auto":
            raise CallError("setup: `auto` proposes one for a plan; for a point, name the direction")
        at = requests.MapQuestion(
            part=question.part, cutter=spec, point=question.point, within_mm=question.within_mm, setup=question.setup[0], **under
        )
        postures, _ = await call.map(at)
        face = json.loads(postures)["face"]
    one = requests.PartQuestion(part=question.part, cutters=[spec], setup=question.setup, faces=face or "", grid=question.grid,
                       spacing_mm=question.spacing_mm, **under)  # fmt: skip
    plan, _ = await call.plan([*call.permissions.part(one), "--answers=mend"])
    # An id may have been given a holder.
    return plan, plan.cutters[0].id, face or "", postures


async def _part(question: requests.PartQuestion, call: Call) -> list[str]:
    """Words of a question about a part, once it is known that its cutters are not too many."""
    words = call.permissions.part(question)
    if question.library is not None:
        await call.tools_of(question.library)
    return words


async def _spec(name: str, question: requests.Conditions, call: Call) -> str:
    """A cutter by words, where a tool of a library or of the built-in set may be meant."""
    from plan_cutters.domain.cutter import Cutter

    if question.library is None:
        try:
            Cutter.parse(name)
        except CutterError as error:
            from plan_cutters.domain.standard_tools import builtin

            known = [(each.id, each.name) for each in builtin()]
            try:
                return answers.chosen(name, known)
            except CallError as other:
                raise CallError(f"{error.cause}; or the built-in set is meant: {other.cause}") from None
        return name
    mine = answers.chosen(name, await call.tools_of(question.library))
    try:
        if Cutter.parse(mine).id == mine:
            return mine
    except CutterError:
        pass
    raise CallError(
        f"{mine} has no form that words can say: plan the part with the library, `faces` and `answers`, and ask with `plan`",
        file=question.library,
    )


@contextlib.contextmanager
def _whole(out: Path) -> Iterator[None]:
    """Take a folder away again that a call has made and not finished: its plan may be there, and models not."""
    before = out.exists()
    try:
        yield
    except BaseException:
        # Another run may have begun there; its lock says so.
        if not before and not out.with_name(f".{out.name}.lock").exists():
            shutil.rmtree(out, ignore_errors=True)
        raise


TOOLS = (
    Tool(
        "plan_part", "Which cutters finish a part",
        "Judge cutters on a part (STEP, IGES, BREP) without any toolpath: which finish its sculptured faces without gouging or "
        "collision, what each one reaches, where and why the others fail; with `operations`, in which steps; with `process`, "
        "what your own steps do and leave. Writes files only where `out` is given. Takes seconds to minutes.",
        requests.PlanQuestion, answers.PlanAnswer, plan_part, writes=True,
    ),
    Tool(
        "posture_map", "All postures at a point",
        "Map the free tilts of one cutter at one point of a part, rotation by rotation, and what forbids the others.",
        requests.MapQuestion, answers.MapAnswer, posture_map,
    ),
    Tool(
        "explain_sample", "Why a cutter does not reach a face or point, and what would help",
        "Say in one call why a cutter does not reach a face (F12) or a point: reasons with codes, the worst places, what is in "
        "the way, and which changes would help by how much, each of them judged. Give `part` to judge it now, or `plan` (a "
        "plan.json) to read what is known.",
        requests.ExplainQuestion, answers.Explanation, explain_sample,
    ),
    Tool(
        "compare_cutters", "How cutters differ on a part",
        "Judge several cutters on a part: what each one reaches, on which faces they differ, and the fewest of them that reach "
        "all that any of them reaches.",
        requests.CompareQuestion, answers.Comparison, compare_cutters,
    ),
    Tool(
        "render", "A picture of the verdicts",
        "Draw a part in four views (PNG), coloured by the verdicts of the cutter that is selected, or that comes nearest: give "
        "one cutter to see its verdicts.",
        requests.RenderQuestion, answers.Picture, render,
    ),
    Tool(
        "list_tools_and_machines", "Which tools and machines there are",
        "List the tools of a library, or the built-in ones, by id, kind and size, and the built-in machines: words for "
        "`cutters`, `cutter` and `machine`.",
        requests.ShopQuestion, answers.ShopAnswer, list_tools_and_machines,
    ),
    Tool(
        "compare_plans", "What changed from one plan to another",
        "Compare two plan.json files, as before and after a change of the part: which faces and cutters reach less or more.",
        requests.DifferenceQuestion, answers.PlanDifferenceAnswer, compare_plans,
    ),
)  # fmt: skip
