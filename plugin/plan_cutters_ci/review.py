"""The page of two plans side by side: tables of what changed, and both parts under one camera."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

from markupsafe import Markup

from plan_cutters.domain import figures as numbers
from plan_cutters.files.markup import embedded, policy, template, with_three
from plan_cutters.plan_file.load import load_plan
from plan_cutters.plan_file.model import Plan
from plan_cutters.plan_file.palette import PALETTE
from plan_cutters.plan_file.words.chip import Chip
from plan_cutters.plan_file.words.names import short_names
from plan_cutters_ci.folders import plans_in
from plan_cutters_ci.matching import match_cutters, match_faces
from plan_cutters_ci.model import Comparison, PlanDifference
from plan_cutters_ci.pictures import Picture, picture_of
from plan_cutters_ci.plans import taken
from plan_cutters_ci.states import face_state
from plan_cutters_ci.wording import change, choice, cutter_rows, face_rows, headline, known, mark

PAGE = "review.html"
#: What became of a face: in words, its colour and its pattern in both pictures.
MARKS = {
    "lost": ("lost", PALETTE["inaccessible"], "hatch"),
    "won": ("won", PALETTE["interference_free"], "cross"),
    "changed": ("changed, neither lost nor won", PALETTE["mixed"], "lines"),
    "alone": ("in this plan alone, neither lost nor won", PALETTE["accessible"], "bars"),
    "reached": ("reached whole in both", "#D9E4DD", "plain"),
    "not reached": ("reached whole in neither", "#A99BB5", "dots"),
    "inside other bodies": ("inside another body", PALETTE["inside_bodies"], "plain"),
    "not asked": ("not to be machined", PALETTE["check"], "plain"),
}
#: The same of faces that are compared with none.
_ALONE = {"reached": ("reached whole", *MARKS["reached"][1:]), "not reached": ("not reached whole", *MARKS["not reached"][1:])}
_HERE = Path(__file__).parent


class Side(NamedTuple):
    """One of two plans: how it is called, the plan, and its picture."""

    called: str
    plan: Plan
    picture: Picture


def pages(old: Path, new: Path, comparison: Comparison) -> Iterator[tuple[str, bytes | None]]:
    """A page for each pair of plans that differ, by name; one without a name for two plans, whether they differ or not.

    Parameters
    ----------
    old, new : Path
        As they were compared.
    comparison : Comparison
        Of these two.

    Yields
    ------
    name : str
        Of the pair.
    page : bytes or None
        None where nothing differs in one of many pairs.

    Raises
    ------
    PlanError
        A plan is not there any more, or cannot be read any more.
    """
    mine, theirs = plans_in(old), plans_in(new)
    for each in comparison.plans:
        name = "" if "" in mine else each.name
        if name and each.same:
            yield name, None
            continue
        sides = []
        for folder, path in ((old, mine[name]), (new, theirs[name])):
            plan = load_plan(path)
            sides.append(Side(str(folder / name) if name else str(folder), plan, picture_of(path, plan)))
        yield name, page(each, *sides)


def page(difference: PlanDifference, old: Side, new: Side) -> bytes:
    """The page of two plans, UTF-8; the same for the same plans.

    Parameters
    ----------
    difference : PlanDifference
        From the old one to the new one.
    old, new : Side
    """
    sides = {"old": old, "new": new}
    # Of plans that are not comparable the pictures show what each one reaches, and nothing of what became of a face.
    shown, marks = (difference.faces, MARKS) if difference.comparable else ([], {**MARKS, **_ALONE})
    data = {
        "marks": {word: dict(zip(("label", "colour", "pattern"), row, strict=True)) for word, row in marks.items()},
        "states": {word: _states(side.plan, {getattr(f, word): mark(f) for f in shown}) for word, side in sides.items()},
        "pairs": [(a.id, b.id) for a, b, _ in match_faces(old.plan, new.plan)],
        "cutters": list(_cutters(old.plan, new.plan)),
        **{word: side.picture.meta for word, side in sides.items()},
    }
    script, style = ((_HERE / name).read_text(encoding="utf-8") for name in ("review.js", "review.css"))
    script = with_three(script)
    return _TEMPLATE.render(
        policy=policy(script, style, "data: blob:"),
        script=Markup(script),
        style=Markup(style),
        told=Markup(embedded(data)),
        data={word: Markup(side.picture.data) for word, side in sides.items()},
        sides=sides,
        found=difference,
        outcome=_outcome(difference),
        headline=headline(difference),
        remarks=[line for line in (choice(difference), known(difference)) if line and difference.comparable],
        changes=[change(each) for each in difference.changes if not each.hinders],
        faces=list(zip(shown, face_rows(difference), strict=True)),
        cutters=list(cutter_rows(difference)),
        facts=list(_facts(old.plan, new.plan)),
        w=numbers,
    ).encode()


def _outcome(difference: PlanDifference) -> Chip:
    """What became of the part."""
    if not difference.comparable:
        return Chip("unsure", "?", "Not comparable")
    if difference.lost:
        return Chip("bad", "✕", "Lost and won" if difference.won else "Lost")
    return Chip("good", "✓", "Won" if difference.won else "Nothing lost")


def _states(plan: Plan, marked: dict[str | None, str]) -> dict[str, str]:
    """What became of each face, in words of `MARKS`."""
    states = {}
    for face in plan.faces:
        word = marked.get(face.id) or face_state(plan, face).reach
        word = {"new": "alone", "gone": "alone", "lost and won": "lost"}.get(word, word)
        states[face.id] = word if word in MARKS else "not reached"
    return states


def _cutters(old: Plan, new: Plan) -> Iterator[dict[str, str | None]]:
    """Cutters of both, then those of one alone."""
    then, now = short_names(old), short_names(new)
    pairs = match_cutters(old, new)
    for a, b, _ in pairs:
        yield {"name": now[b.id], "old": a.id, "new": b.id}
    for c in old.cutters:
        if c.id not in {a.id for a, _, _ in pairs}:
            yield {"name": f"{then[c.id]} (old plan alone)", "old": c.id, "new": None}
    for c in new.cutters:
        if c.id not in {b.id for _, b, _ in pairs}:
            yield {"name": f"{now[c.id]} (new plan alone)", "old": None, "new": c.id}


def _facts(old: Plan, new: Plan) -> Iterator[tuple[str, str, str]]:
    """Rows on what was compared: a title, and a cell of each plan."""
    yield from ((title, value_of(old), value_of(new)) for title, value_of in _FACTS)


def _size(plan: Plan) -> str:
    return " \N{MULTIPLICATION SIGN} ".join(f"{x:.6g}" for x in plan.part.size_mm) + " mm"


_FACTS: tuple[tuple[str, Callable[[Plan], str]], ...] = (
    ("Part", lambda plan: plan.part.file or "part"),
    ("SHA-256", lambda plan: (plan.part.sha256 or "no file")[:12]),
    ("Size", _size),
    ("Faces", lambda plan: f"{len(plan.effective.target_faces)} to machine, of {plan.part.faces}"),
    ("Machine", lambda plan: plan.machine.name),
    ("Cutters", lambda plan: numbers.count(len(plan.cutters), "cutter")),
    ("Cutter to take", lambda plan: short_names(plan).get(taken(plan) or "", "none")),
    ("Version", lambda plan: plan.versions.get("plan_cutters", "not known")),
)
_TEMPLATE = template(_HERE / "review.html.jinja")
