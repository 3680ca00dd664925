"""The page of two plans side by side: tables of what changed, and both parts under one camera."""

import base64
import hashlib
import json
import re
import zlib
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from markupsafe import Markup

from plan_cutters.domain import figures as numbers
from plan_cutters.errors import PlanError
from plan_cutters.files.markup import embedded, policy, template, with_three
from plan_cutters.plan_file.load import load_plan
from plan_cutters.plan_file.model import Plan
from plan_cutters.plan_file.reasons import PALETTE
from plan_cutters.plan_file.words.names import short_names
from plan_cutters.plan_file.words.text import Chip
from plan_cutters_base.whole import whole
from plan_cutters_ci.matching import match_cutters, match_faces, with_others
from plan_cutters_ci.model import PlanDifference
from plan_cutters_ci.plans import face_state, taken
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
    "drilled": ("for drills", PALETTE["drilled"], "plain"),
    "not asked": ("not to be machined", PALETTE["check"], "plain"),
}
#: The same of faces that are compared with none.
_ALONE = {"reached": ("reached whole", *MARKS["reached"][1:]), "not reached": ("not reached whole", *MARKS["not reached"][1:])}
_HERE = Path(__file__).parent
#: Data that a comparison shows nothing of: postures and their maps, operations, other colours, and the frames of samples.
_OMITTED = re.compile(
    r"(tilt|lean|maps|scalar|operation|operation_lean|setup|reason)\.|sample\.(point|normal|direction|curvature)$"
)
_FORMAT = 1
#: A script element of a page with its id and its text: what the page draws stands in two of them.
_ELEMENT = re.compile(r'<script [^>]*\bid="([\w-]+)">(.*?)</script>', re.DOTALL)
_AGAIN = "plan the part again with --formats json,html"


class Picture(NamedTuple):
    """Hold what the page draws of a plan: `meta` and the stream of `docs/review_page_data.md`; or why there is none."""

    meta: dict[str, Any] | None
    data: str
    why: str


class Side(NamedTuple):
    """One of two plans: how it is called, the plan, and its picture."""

    called: str
    plan: Plan
    picture: Picture


def page(difference: PlanDifference, old: Side, new: Side) -> bytes:
    """The page of two plans, UTF-8; the same for the same plans. `difference` is that from the old one to the new one."""
    sides = {"old": old, "new": new}
    # Of plans that are not comparable the pictures show what each one reaches, and nothing of what became of a face.
    shown, marks = (difference.faces, MARKS) if difference.comparable else ([], {**MARKS, **_ALONE})
    # What became of each face, in words of `MARKS`.
    alike = {"new": "alone", "less": "lost", "gone": "alone", "lost and won": "lost"}
    states = dict[str, dict[str, str]]()
    for side_name, side in sides.items():
        marked = {getattr(f, side_name): mark(f) for f in shown}
        words = {face.id: marked.get(face.id) or face_state(side.plan, face).reach for face in side.plan.faces}
        words = {name: alike.get(word, word) for name, word in words.items()}
        states[side_name] = {name: word if word in MARKS else "not reached" for name, word in words.items()}
    outcome = Chip("unsure", "?", "Not comparable")
    if difference.comparable and difference.lost:
        outcome = Chip("bad", "✕", "Lost and won" if difference.won else "Lost")
    elif difference.comparable:
        outcome = Chip("good", "✓", "Won" if difference.won else "Nothing lost")
    data = {
        "marks": {word: dict(zip(("label", "colour", "pattern"), row, strict=True)) for word, row in marks.items()},
        "states": states,
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
        outcome=outcome,
        headline=headline(difference),
        remarks=[line for line in (choice(difference), known(difference)) if line and difference.comparable],
        changes=[change(each) for each in difference.changes if not each.hinders],
        faces=list(zip(shown, face_rows(difference), strict=True)),
        cutters=list(cutter_rows(difference)),
        facts=[(title, value_of(old.plan), value_of(new.plan)) for title, value_of in _FACTS],
        w=numbers,
    ).encode()


def write_page(path: Path, difference: PlanDifference, files: Iterable[tuple[str, Path]]) -> None:
    """Write the page of two plans, named and by their plan.json; a PlanError where it cannot be written, or one not be read."""
    with whole(path, PlanError) as temporary:
        shown = [Side(word, plan := load_plan(file), picture_of(file, plan)) for word, file in files]
        temporary.write_bytes(page(difference, *shown))


def _cutters(old: Plan, new: Plan) -> Iterator[Mapping[str, str | None]]:
    then, now = short_names(old), short_names(new)
    for a, b, _ in with_others(old.cutters, new.cutters, match_cutters(old, new)):
        name = now[b.id] if b else then[a.id] if a else ""
        alone = "" if a and b else f" ({'old' if a else 'new'} plan alone)"
        yield {"name": f"{name}{alone}", "old": a.id if a else None, "new": b.id if b else None}


def picture_of(path: Path, plan: Plan) -> Picture:
    """The picture of a plan, taken out of the review page beside its file: triangles, samples and verdicts as drawn there."""
    entry = plan.files.get("html")
    name = entry.name if entry else "review.html"
    page = path.parent / name

    def none(why: str) -> Picture:
        return Picture(None, "", f"{why}: {_AGAIN}")

    try:
        data = page.read_bytes()
    except OSError:
        return none(f"there is no {name} in the folder of the plan")
    if entry and hashlib.sha256(data).hexdigest() != entry.sha256:
        return none(f"{name} is not the one that was written with the plan")
    try:
        picture = _picture(data.decode("utf-8"))
    except (ValueError, LookupError, TypeError, AttributeError, zlib.error):
        return none(f"{name} cannot be read")
    if picture is None or picture.meta is None:
        return none(f"{name} was made by another version of the program")
    shows = picture.meta["part"]["sha256"], {each["id"] for each in picture.meta["faces"]}
    return picture if shows == (plan.part.sha256, {face.id for face in plan.faces}) else none(f"{name} is of another part")


def _picture(text: str) -> Picture | None:
    """The picture that a page holds; None where its data have another form."""
    elements = dict(_ELEMENT.findall(text))
    meta, stream = json.loads(elements["meta"]), elements["data"]
    if meta["format"] != _FORMAT:
        return None
    whole = {name: entry for name, entry in meta["arrays"].items() if not _OMITTED.match(name)}
    end = max(entry["offset"] + entry["bytes"] for entry in whole.values())
    inflated = zlib.decompressobj(-15).decompress(base64.b64decode(stream, validate=True), end)
    if len(inflated) < end or min(min(entry["offset"], entry["bytes"]) for entry in whole.values()) < 0:
        raise ValueError("the stream ends too soon")
    packed, entries, offset = zlib.compressobj(6, zlib.DEFLATED, -15), {}, 0
    pieces = []
    for name, entry in whole.items():
        entries[name] = {**entry, "offset": offset}
        offset += entry["bytes"]
        pieces.append(packed.compress(inflated[entry["offset"] : entry["offset"] + entry["bytes"]]))
    data = base64.b64encode(b"".join([*pieces, packed.flush()])).decode("ascii")
    cutters = [{"id": each["id"], "name": each["name"]} for each in meta["cutters"]]
    if any(f"verdict.{each['id']}" not in entries for each in cutters):
        raise LookupError("a cutter has no verdicts")
    reduced = {**meta, "cutters": cutters, "spots": [], "scalars": [], "operations": None, "maps": None, "arrays": entries}
    return Picture(reduced, data, "")


#: Rows on what was compared: a title, and the cell of a plan.
_FACTS: tuple[tuple[str, Callable[[Plan], str]], ...] = (
    ("Part", lambda plan: plan.part.file or "part"),
    ("SHA-256", lambda plan: (plan.part.sha256 or "no file")[:12]),
    ("Size", lambda plan: " \N{MULTIPLICATION SIGN} ".join(f"{x:.6g}" for x in plan.part.size_mm) + " mm"),
    ("Faces", lambda plan: f"{len(plan.effective.target_faces)} to machine, of {plan.part.faces}"),
    ("Machine", lambda plan: plan.machine.name),
    ("Cutters", lambda plan: numbers.count(len(plan.cutters), "cutter")),
    ("Cutter to take", lambda plan: short_names(plan).get(taken(plan) or "", "none")),
    ("Version", lambda plan: plan.versions.get("plan_cutters", "not known")),
)
_TEMPLATE = template(_HERE / "review.html.jinja")
