"""The answers to an agent: their fields are the output schemas of the tools, and most are made of plans.

Lengths are mm, angles deg, part coordinates; shares are of an area, 0 to 1. Entries of lists have the names of `plan.json`, where
they are of it (`docs/json.md`). Lists are whole here: `short` cuts them.
"""

import json
import math
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field

from plan_cutters.domain.figures import listed
from plan_cutters.plan_file.frozen import Vector
from plan_cutters.plan_file.holes import DrillingStep
from plan_cutters.plan_file.model import CutterEntry, Plan, leaves
from plan_cutters.plan_file.operations import ProcessStep, RemainingEntry
from plan_cutters.plan_file.reasons import INTERVALS, REASONS, reason
from plan_cutters.plan_file.shares import FaceVerdicts, by_share
from plan_cutters.plan_file.words.answers import first_tries
from plan_cutters.plan_file.words.cutters import face_text, helping, in_the_way, main_reason, posture_text, sample_text
from plan_cutters.plan_file.words.holes import missing_tools
from plan_cutters.plan_file.words.names import as_fields, named
from plan_cutters_agents.access import CallError, Permissions
from plan_cutters_agents.requests import ExplainQuestion
from plan_cutters_ci.plans import compare
from plan_cutters_ci.wording import called, cutter_rows, face_rows, headline, mark, remarks

#: What a list of an answer, or an object in it, holds.
Entry = dict[str, Any]
#: Which faces a change was judged on.
About = Literal["this face", "all faces of the plan", "nothing"]
_OF_WITNESSES = ("point", "face", "verdict", "reason", "obstacle_face", "obstacle_point", "best_posture", "depth_mm", "samples",
                 "inside_bodies")  # fmt: skip
#: Shares that differ by less are equal.
_SAME = 1e-9
#: A cutter by its radius or diameter, and its length.
_PLAIN = re.compile(r"[rd][\d.]+(l[\d.]+)?")


class Answer(BaseModel):
    model_config = ConfigDict(frozen=True)

    format_version: int = 1
    part: str
    told: str = Field(description="the answer in sentences")


class OfPlan(Answer):
    """An answer about a plan has these fields."""

    exit_code: int = Field(description="as of the command: 0 a cutter finishes, 1 none does, 4 not all could be judged")
    selected: str | None = Field(description="id of the cutter to take")
    samples: Entry
    cutters: list[Entry] = Field(description="those that reach most first")
    not_judged: list[Entry] = Field(description="target faces that could not be judged, and why: `code` is the face")
    missing: list[Entry] = Field(description="obstacles that are missing or guessed: with one, nothing is feasible beyond doubt")


class PlanAnswer(OfPlan):
    format: Literal["plan-cutters-agent-plan"] = "plan-cutters-agent-plan"
    asked_mm2: float | None = Field(None, description="of the faces to machine, that the steps are to finish")
    finished_share: float | None = Field(None, description="by all steps together; 1 only where nothing is left")
    seconds: float | None = Field(None, description="of all steps, turns and changes of cutters; null without a feed")
    steps: list[Entry] = Field([], description="of the process, in their order")
    left: list[Entry] = Field([], description="what no step finishes, the largest area first")
    drilling: list[Entry] = Field(
        [], description="steps that drill holes with tools of the library, by the numbers of the process"
    )
    missing_tools: list[str] = Field([], description="tools that holes need, and that the library has not")
    notes: list[Entry] = Field(description="what these verdicts do not say")
    files: dict[str, str] = Field({}, description="format -> path, where `out` was given")
    not_written: dict[str, str] = Field({})


class Comparison(OfPlan):
    format: Literal["plan-cutters-agent-comparison"] = "plan-cutters-agent-comparison"
    differ: list[Entry] = Field(description="faces of which cutters reach different shares, the widest difference first")
    together: Entry | None = Field(description="the fewest of them that reach all that any of them reaches")


class MapAnswer(Answer):
    format: Literal["plan-cutters-agent-map"] = "plan-cutters-agent-map"
    cutter: str
    exit_code: int = Field(description="0 some tilt is free, or the point under the flat, 1 none is, 4 none is surely free")
    postures: Entry


class Explanation(Answer):
    format: Literal["plan-cutters-agent-explanation"] = "plan-cutters-agent-explanation"
    cutter: str
    face: str
    reached: bool | None = Field(description="every judged sample of the face; null: undecided, or not to be judged")
    lost_share: float = Field(description="of the face")
    counts: dict[str, int] = Field(description="samples of the face by verdict")
    reasons: list[Entry] = Field(description="the one that loses most first; `try_first` is a rule of thumb, not computed")
    in_the_way: list[Entry]
    witnesses: list[Entry] = Field(description="worst spots, the deepest first; with a point, the nearest first")
    would_help: list[Entry] = Field(description="changes that gain something, each of them judged, the best first")
    help_is_about: About = "nothing"
    no_help: str = Field("", description="why `would_help` is empty")
    postures: Entry | None = Field(description="at the point, where a part was given")
    sample: Entry | None = Field(description="nearest to the point, where a plan with samples.npz was given")
    missing: list[Entry]


class Picture(OfPlan):
    format: Literal["plan-cutters-agent-picture"] = "plan-cutters-agent-picture"
    shown: str = Field(description="id of the cutter whose verdicts are shown")
    legend: dict[str, str] = Field(description="colour -> what it means")


class ShopAnswer(Answer):
    format: Literal["plan-cutters-agent-shop"] = "plan-cutters-agent-shop"
    library: str = Field(description="empty: the built-in set")
    tools: list[Entry]
    unused: list[str] = Field(description="entries of the library that cannot be judged, and why")
    machines: list[Entry]


class PlanDifferenceAnswer(Answer):
    format: Literal["plan-cutters-agent-difference"] = "plan-cutters-agent-difference"
    comparable: bool
    why_not: list[str]
    lost: bool | None = Field(description="whether a face or cutter reaches less; null: not comparable")
    won: bool | None
    selected: list[str | None] = Field(description="ids of the cutters to take, old and new")
    faces: list[Entry] = Field(description="the worst first")
    cutters: list[Entry]
    unreachable: list[str] = Field(description="target faces of the new plan that no cutter reaches whole")


def _fields(record: BaseModel, *names: str) -> Entry:
    """Some fields of a record."""
    return {name: getattr(record, name) for name in names}


def _missing(plan: Plan) -> list[Entry]:
    return [_fields(each, "face", "name", "why") for each in plan.missing]


def planned(plan: Plan, code: int, files: Mapping[str, str]) -> PlanAnswer:
    """Which cutters finish, in which steps, and what the others lose."""
    every = [*zip(plan.note_codes, plan.notes, strict=False), *(("warning", text) for text in plan.part.warnings)]
    process = plan.process
    more = {**_fields(process, "asked_mm2", "finished_share", "seconds"), "steps": [_step(each) for each in process.steps],
            "left": [_remaining(each) for each in process.left],
            "drilling": [_drilling(k, each) for k, each in enumerate(process.drilling, len(process.steps) + 1)],
            "missing_tools": missing_tools(plan)}  # fmt: skip
    notes = [{"code": code, "text": as_fields(text)} for code, text in every]
    return PlanAnswer(**_of_plan(plan, code), **more, notes=notes, files=dict(files), not_written=plan.not_written)


def _step(step: ProcessStep) -> Entry:
    """A step of the process, in the words of `process`: to edit and to judge again; setups from 1, `own` None where planned."""
    own = None
    if step.own is not None:
        near = step.own.nearest
        own = _fields(step.own, "number", "text", "asked_mm2", "wrong") | {
            "leaves": [_remaining(each) for each in step.own.leaves],
            "nearest": None if near is None else {"angles": near.angles_deg, **_fields(near, "axis", "area_mm2")},
        }
    axis = step.axis if step.angles_deg is None else None
    more = _fields(step, "cutter", "faces", "take", "area_mm2", "share", "alone_mm2", "seconds", "clearance_mm")
    return {"setup": step.setup + 1, "mode": step.mode, "angles": step.angles_deg, "axis": axis, **more, "own": own}


def _drilling(number: int, step: DrillingStep) -> Entry:
    """A step that drills; setups from 1, as of `_step`."""
    sizes = _fields(
        step, "kind", "tool", "name", "thread", "diameter_mm", "depth_mm", "pitch_mm", "axis", "seconds", "link_seconds"
    )
    return {"number": number, "setup": step.setup + 1, "angles": step.angles_deg, **sizes, "holes": [
        _fields(each, "hole", "mouth_mm", "tip_mm") for each in step.holes
    ]}  # fmt: skip


def _remaining(area: RemainingEntry) -> Entry:
    return _fields(area, "cause", "area_mm2", "share", "faces", "place_mm", "needs")


def compared(plan: Plan, code: int) -> Comparison:
    """On which faces cutters differ, and which of them do it together."""
    rows: dict[str, dict[str, float]] = {}
    for face in plan.faces:
        shares = {c.id: c.faces[face.id].area_share.reached for c in plan.cutters if face.id in c.faces}
        if shares and max(shares.values()) - min(shares.values()) > _SAME:
            rows[face.id] = shares
    widest = sorted(rows.items(), key=lambda row: min(row[1].values()) - max(row[1].values()))
    together = None
    if (least := plan.least_set) is not None:
        runs = [_fields(each, "cutter", "setup", "share", "samples") for each in least.runs]
        together = {"runs": runs, **_fields(least, "share", "left_share", "proven")}
    differ = [{"face": face, "reached": shares} for face, shares in widest]
    return Comparison(**_of_plan(plan, code), differ=differ, together=together)


def pictured(plan: Plan, code: int) -> Picture:
    """Describe a picture: whose verdicts it shows, and its colours."""
    legend = {colour: plan.legend_words.get(word, word) for word, colour in plan.legend.items()}
    return Picture(**_of_plan(plan, code), shown=plan.shown, legend=legend)


def ranked(plan: Plan) -> list[CutterEntry]:
    """The selected cutter first, then those that leave least."""
    return sorted(plan.cutters, key=lambda c: (c.id != plan.selected, leaves(c)))


def _of_plan(plan: Plan, code: int) -> Entry:
    text = plan.text
    # Given as `spacing_mm` in each call, the widest spacing makes the samples of all calls the same.
    sampling = _fields(plan.effective, "spacing_mm", "sampled_by")
    return {
        "part": plan.part.file or "", "told": "\n".join([text.headline, *text.lines]), "exit_code": code,
        "samples": {"count": plan.samples.count, **sampling, **_fields(plan.samples, "max_gap_mm", "unjudged", "inside_bodies")},
        "selected": plan.selected or plan.selected_over_setups,
        "cutters": [_cutter(plan, c, text.cutters[c.id]) for c in ranked(plan)],
        "not_judged": [{"code": f.id, "text": f.unjudged} for f in plan.faces if f.target and f.unjudged],
        "missing": _missing(plan),
    }  # fmt: skip


def _cutter(plan: Plan, c: CutterEntry, text: str) -> Entry:
    """A cutter, what it reaches, the faces that it does not, the worst first, and the step that gains most."""
    by_face = sorted((-v.area_share.not_reached, name) for name, v in c.faces.items() if v.not_reached)
    faces = [{"face": name, "share": -share, "reason": main_reason(c.faces[name].area_share) or None} for share, name in by_face]
    return {
        "id": c.id, "name": c.name, "text": text, "feasible": c.feasible, "seen": c.seen,
        **_fields(c.area_share, "reached", "inaccessible", "undecided"), "lost_by": dict(by_share(c.area_share.lost_by)),
        "faces": faces, "next": next(iter(_helps(plan, c)), None),
    }  # fmt: skip


def _helps(plan: Plan, c: CutterEntry) -> list[Entry]:
    """The steps that gain something; `finishes`: whether all is reached then, None where that is not decided."""
    mend = c.mend
    return [] if mend is None else [
        {"what": named(plan, each.why), "things": [move.thing for move in each.changes],
         "finishes": None if mend.unsure and not each.left else not each.left,
         "lost_before": each.lost_before, "lost_after": each.lost_after, "gained_samples": each.gained, "option": each.option}
        for each in helping(mend)
    ]  # fmt: skip


def explained(
    plan: Plan, cutter: CutterEntry, face: str, *, point: Vector | None = None, postures: Entry | None = None,
    sample: Entry | None = None,
) -> Explanation:  # fmt: skip
    """Why a cutter does not reach a face, and what would help; a CallError where the plan says nothing about the face."""
    entry = next((f for f in plan.faces if f.id == face), None)
    if entry is None:
        raise CallError(f"there is no such face; the part has {len(plan.faces)}", file=plan.part.file, face=face)
    if not entry.target:
        raise CallError("was not judged in this plan, it is an obstacle only: ask with `part`", file=plan.part.file, face=face)
    counts = cutter.faces.get(face, FaceVerdicts())
    # The nearest to a point first, or the deepest.
    mine = sorted(
        (w for w in cutter.witnesses if w.face == face and not w.inside_bodies),
        key=lambda w: -(w.depth_mm or 0.0) if point is None else math.dist(w.point, point),
    )
    unsure = bool(counts.undecided or counts.unjudged or entry.unjudged or plan.missing or not counts.reached)
    changes, about, unhelped = _helping(
        plan, cutter, alone=[f.id for f in plan.faces if f.target] == [face], lost=bool(counts.not_reached)
    )
    texts = [] if sample is None else [sample_text(sample["distance_mm"], sample["verdict"], sample["reason"])]
    if postures is not None:
        free = postures["free_share"] or float(any(row["free"] for row in postures["rotations"]))
        certified, causes = postures["certified"], by_share(postures["forbidden"])
        texts.append(posture_text(postures["face"], free, postures["undecided_share"], causes, certified=certified))
    texts.append(face_text(plan, cutter, entry, unhelped))
    return Explanation(
        part=plan.part.file or "", told=" ".join(texts), cutter=cutter.id, face=face,
        reached=False if counts.blocked else None if unsure else True, lost_share=counts.area_share.not_reached,
        counts={"reached": counts.reached, "inaccessible": counts.blocked, "undecided": counts.undecided,
                "unjudged": counts.unjudged, "inside_bodies": counts.inside_bodies},
        reasons=[
            {"code": code, "name": reason(code), "meaning": REASONS[code].sentence if code in REASONS else "",
             "try_first": first_tries(code, cutter.mend), "share": part}
            for code, part in by_share(counts.area_share.lost_by)
        ],
        in_the_way=[each._asdict() for each in in_the_way(mine)],
        witnesses=[_fields(each, *_OF_WITNESSES) for each in mine],
        would_help=changes, help_is_about=about, no_help=unhelped, postures=postures, sample=sample, missing=_missing(plan),
    )  # fmt: skip


def _helping(plan: Plan, cutter: CutterEntry, *, alone: bool, lost: bool) -> tuple[list[Entry], About, str]:
    """Give the changes that would help, the faces that they are about, and why there are none."""
    if cutter.mend is not None:
        found = _helps(plan, cutter)
        why = "" if found else cutter.mend.why or "no change that was tried gains anything"
        return found, "this face" if alone else "all faces of the plan", why
    if not lost:
        return [], "nothing", "nothing is lost"
    if "mend" in plan.effective.answers:
        return [], "nothing", "it was not asked about this cutter, for others come nearer: ask with `part`"
    return [], "nothing", "the plan was made without --answers mend: ask with `part`"


def difference(old: Plan, new: Plan) -> PlanDifferenceAnswer:
    """Say what became of the faces and cutters; of plans that are not comparable the reasons alone."""
    result = compare(old, new, name=new.part.file or "part")
    faces = [
        {"name": called(each.old, each.new), "what": mark(each), "was": row[-2], "now": row[-1], "changed": ""}
        for each, row in zip(result.faces, face_rows(result), strict=False)
    ]
    cutters = [
        {"name": row[1], "what": mark(each), "was": row[2], "now": row[3], "changed": row[-1]}
        for each, row in zip(result.cutters, cutter_rows(result), strict=False)
    ]
    comparable = result.comparable
    return PlanDifferenceAnswer(
        part=new.part.file or "", told="\n".join([headline(result), *result.why_not, *remarks(result)]), comparable=comparable,
        why_not=result.why_not, lost=result.lost if comparable else None, won=result.won if comparable else None,
        selected=[*result.selected], faces=faces, cutters=cutters, unreachable=result.unreachable if comparable else [],
    )  # fmt: skip


def cutter_of(plan: Plan, name: str) -> CutterEntry:
    """The cutter of a plan by its id, its name, or the beginning of one; a CallError where none is meant, or several are."""
    mine = chosen(name, [(c.id, c.name) for c in plan.cutters])
    return next(c for c in plan.cutters if c.id == mine)


def chosen(name: str, known: list[tuple[str, str]]) -> str:
    """The one id that is meant, of (id, name); a beginning ends where no number goes on.

    >>> chosen("R6", [("R6L80", ""), ("R60L80", ""), ("R2L40", "finisher")]), chosen("finisher", [("R2L40", "finisher")])
    ('R6L80', 'R2L40')
    >>> chosen("R3", [("R6L80", "")])
    Traceback (most recent call last):
    plan_cutters_agents.access.CallError: no cutter is called 'R3'; there is R6L80
    """
    text = name.strip().lower()

    def begins(word: str) -> bool:
        rest = word.lower()[len(text) :]
        return word.lower().startswith(text) and not (rest[:1].isdigit() or rest[:1] == ".")

    for test in (
        lambda id, label: id == name,
        lambda id, label: text in (id.lower(), label.lower()),
        lambda id, label: begins(id) or begins(label),
    ):
        matches = [id for id, label in known if test(id, label)]
        if len(matches) > 1 and _PLAIN.fullmatch(text):
            # R6 says no corner radius, as R6L80 does.
            matches = [id for id in matches if "rc" not in id] or matches
        if len(matches) == 1:
            return matches[0]
        if matches:
            raise CallError(f"{len(matches)} cutters may be meant by {name!r}: {', '.join(matches[:8])}; give the whole id")
    raise CallError(f"no cutter is called {name!r}; there is {listed([id for id, _ in known])}")


#: Digits behind the point, deg.
_DIGITS = 3


def tools_in(output: bytes) -> tuple[list[Entry], list[str]]:
    """The tools in the output of the command `tools`, and a line for each that cannot be judged."""
    tools, unused = [], []
    for library in json.loads(output)["libraries"]:
        tools += [
            {"id": each["id"], "name": next(iter(each["names"]), ""), "number": next(iter(each["numbers"]), None),
             "kind": each["shape"], "diameter_mm": 2.0 * each["radius"], "corner_radius_mm": each["corner_radius"],
             "stickout_mm": each["length"], "holder": (each["holder"] or {}).get("name", "")}
            for each in library["cutters"]
        ]  # fmt: skip
        unused += [f"{each['place']}: {each['unused']}" for each in library["entries"] if each["unused"]]
    return tools, unused


def built_in_tools() -> list[Entry]:
    """The tools that are judged where none are named."""
    from plan_cutters.domain.standard_tools import builtin
    from plan_cutters.plan_file.words.names import kind

    return [
        {"id": each.id, "name": each.name, "number": None, "kind": kind(each), "diameter_mm": 2.0 * each.radius,
         "corner_radius_mm": each.corner_radius, "stickout_mm": each.length, "holder": ""}
        for each in builtin()
    ]  # fmt: skip


def machines_in(output: bytes) -> list[Entry]:
    """The machines in the output of the command `machines`: axes from the tool to the part, the share of all directions held."""
    return [
        {"name": each["given"],
         "axes": [axis["axis"] for chain in ("tool_chain", "part_chain") for axis in each["machine"].get(chain, [])],
         "reaches": each["share_of_directions"]}
        for each in json.loads(output)["machines"]
    ]  # fmt: skip


def postures_of(output: bytes) -> Entry:
    """The postures in the output of the command `map`: shares of those that were searched, and a row for each rotation."""
    answer = json.loads(output)
    rows, tilt = answer["rotations"], answer["tilt_deg"]
    unit = 10**_DIGITS
    wide = max(1e-12, (tilt[1] - tilt[0]) * len(rows))

    def share(word: str) -> float:
        return sum(high - low for row in rows for low, high in row[word]) / wide

    least = [tilt[1] if (at := row["local_gouge"]) is None else min(max(at, tilt[0]), tilt[1]) for row in rows]
    forbidden = {"local_gouge": sum(at - tilt[0] for at in least) / wide, **{word: share(word) for word in INTERVALS}}
    return {
        **{name: answer[name] for name in ("point", "face", "off_mm", "normal", "direction_max", "certified")},
        "free_share": min(1.0, share("free")),
        "undecided_share": min(1.0, share("undecided")),
        "forbidden": {word: min(1.0, part) for word, part in forbidden.items() if part > 0.0},
        "rotations": [
            {
                "deg": round(row["deg"], _DIGITS),
                # None wider than it is: those too narrow for the digits are left out.
                "free": [
                    [inner, outer]
                    for low, high in row["free"]
                    if (inner := math.ceil(low * unit) / unit) <= (outer := math.floor(high * unit) / unit)
                ],
                "undecided": _rounded(row["undecided"]),
                "local_gouge_below": row["local_gouge"],
                "forbidden": {word: _rounded(row[word]) for word in INTERVALS if row[word]},
            }
            for row in rows
        ],
        "missing": len(answer["missing"]),
        **{name: answer[name] for name in ("flank_axis", "under_flat_mm")},
    }


def _rounded(intervals: list[list[float]]) -> list[list[float]]:
    return [[round(low, _DIGITS), round(high, _DIGITS)] for low, high in intervals]


def nearest_sample(file: str, plan: Plan, cutter: str, question: ExplainQuestion, permissions: Permissions) -> Entry:
    """Look up the sample that is nearest to the point in question; a CallError where none is near enough, or no arrays are."""
    import numpy as np

    from plan_cutters.domain.verdicts import NO_REASON, WORDS
    from plan_cutters.files.arrays import Archive

    if "npz" not in plan.files:
        why = "has no samples.npz in its folder, so a point cannot be looked up: give a face, or plan with the format npz"
        raise CallError(why, file=file)
    npz = str(Path(file).parent / plan.files["npz"].name)
    with Archive(permissions.file(npz), "samples", CallError) as archive:
        names = ("point", "face", f"verdict_{cutter}", f"reason_{cutter}", f"axis_{cutter}")
        if any(name not in archive.headers for name in names):
            raise archive.fault(f"without {cutter}")
        points, faces, verdicts, reasons, axes = (archive.read(name) for name in names)
    shaped = points.ndim == 2 and points.shape[1:] == (3,) and len(points)
    if not shaped or any(len(a) != len(points) for a in (faces, verdicts, reasons, axes)):
        raise CallError("its arrays do not belong together: plan the part again", file=npz)
    off = np.linalg.norm(points - np.array(question.point), axis=1)
    row = int(np.nanargmin(off))
    most, face = max(question.within_mm, plan.samples.max_gap_mm or 0.0), f"F{int(faces[row])}"
    if not off[row] <= most:
        raise CallError(
            f"the nearest sample is {off[row]:.4g} mm from the point, on {face}; give a point within {most:.3g} mm "
            "of one, or a face",
            file=file,
        )
    code = int(reasons[row])
    return {
        "point": points[row].tolist(),
        "distance_mm": float(off[row]),
        "face": face,
        "verdict": WORDS.get(int(verdicts[row]), "unknown"),
        "reason": None if code == NO_REASON or code >= len(plan.reasons) else plan.reasons[code],
        "axis": axes[row].tolist() if np.isfinite(axes[row]).all() else None,
    }
