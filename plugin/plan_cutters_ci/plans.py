"""Compare two plans: what was asked, which faces and which cutters lost or won."""

import math
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Sequence
from typing import Any

from plan_cutters.domain.figures import count
from plan_cutters.plan_file.model import CutterEntry, FaceEntry, Plan
from plan_cutters.plan_file.part_info import FixtureEntry, PartInfo
from plan_cutters.plan_file.words.names import called
from plan_cutters_base.user_files import fingerprint
from plan_cutters_ci.matching import Matched, match_cutters, match_faces, moved_faces
from plan_cutters_ci.model import REQUESTED, Change, CutterDifference, FaceDifference, FaceState, PlanDifference
from plan_cutters_ci.states import cutter_falls, cutter_state, face_state, falls, reached_whole, remaining_area, unreachable

#: Shares of an area that differ by no more are the same: samples of a changed part lie in other places.
SLACK = 0.001
#: Plans of which fewer faces are known again, as a share of those of the plan with fewer of them, are of two parts, unless so
#: large a share of the area is the same.
UNRELATED = 0.25
#: Entries of a cutter that say how it is made.
_FORM = (
    "radius",
    "corner_radius",
    "length",
    "shape",
    "taper_deg",
    "flutes_mm",
    "holder",
    "stages",
    "allowance_mm",
    "clearance_mm",
)


def compare(old: Plan, new: Plan, *, name: str = "", slack: float = SLACK, despite: Collection[str] = ()) -> PlanDifference:
    """Compare two plans; the same plan twice gives no difference, and in reverse order what was lost is won.

    Faces that one plan has alone are no such matter: a new one that is not reached is lost, and one that is gone is not won.

    Parameters
    ----------
    old, new : Plan
    name : str
        Of both.
    slack : float
        Shares, 0 to 1, that differ by no more are the same.
    despite : collection of str
        Codes of `model.ASKED`: the plans are compared although these differ.
    """
    changes = list(_changes(old, new, despite))
    pairs = match_faces(old, new)
    tools = match_cutters(old, new)
    why_not = [f"{each.what} differs: {each.old} -> {each.new}" for each in changes if each.hinders]
    if moved := moved_faces(old, new, pairs):
        why_not.append(
            f"{moved} of {count(len(old.faces), 'face')} of the old plan stand at other places in the new one: it was moved, "
            "turned or mirrored as a whole; export both from one origin"
        )
    elif not _related(old, new, pairs):
        why_not.append(
            f"of {count(len(old.faces), 'face')} of the old plan and {len(new.faces)} of the new one {len(pairs) or 'none'} "
            f"{'are' if len(pairs) > 1 else 'is'} known again: they seem to be of two parts"
        )
    if not tools:
        why_not.append("no cutter of the old plan is known again in the new one")
    face_rows = sorted(filter(None, _faces(old, new, pairs, slack)), key=_worst_face)
    cutter_rows = sorted(filter(None, _cutters(old, new, tools, pairs, slack)), key=_worst_cutter)
    differences: list[FaceDifference | CutterDifference] = [*face_rows, *cutter_rows]
    return PlanDifference(
        name=name,
        comparable=not why_not,
        why_not=why_not,
        changes=changes,
        selected=(taken(old), taken(new)),
        matched=dict(sorted(Counter(str(how) for _, _, how in pairs).items())),
        faces=face_rows,
        cutters=cutter_rows,
        unreachable=unreachable(new),
        lost=any(each.lost for each in differences),
        won=any(each.won for each in differences),
    )


def _related(old: Plan, new: Plan, pairs: Matched) -> bool:
    """Whether two plans are of one part: enough of their faces are known again, or enough area is the same at the same place."""
    if len(pairs) >= UNRELATED * min(len(old.faces), len(new.faces)):
        return bool(pairs)
    same = [(a.id, b.id) for a, b, how in pairs if how == "place"]
    shares = (_share_of(plan.faces, names) for plan, names in zip((old, new), zip(*same, strict=True), strict=False))
    return bool(same) and min(shares) >= UNRELATED


def _share_of(faces: Sequence[FaceEntry], names: Collection[str]) -> float:
    """Share of the area of all faces that some of them have."""
    area = {face.id: face.area_mm2 for face in faces if math.isfinite(face.area_mm2)}
    return sum(area.get(name, 0.0) for name in names) / max(sum(area.values()), 1e-300)


def taken(plan: Plan) -> str | None:
    """The cutter to take."""
    return plan.selected or plan.selected_over_setups


def _changes(old: Plan, new: Plan, despite: Collection[str]) -> Iterable[Change]:
    """Differences of what was asked, then of other things that may be the cause of differences."""
    then, now = _requested(old), _requested(new)
    for what, (mine, theirs) in {word: (then[word], now[word]) for word in REQUESTED}.items():
        if mine != theirs:
            if what == "machine" and mine[0] != theirs[0]:
                mine, theirs = mine[0], theirs[0]
            proposed = what == "setup" and old.setup_proposal is not None and new.setup_proposal is not None
            yield Change(what=what, old=_text(mine), new=_text(theirs), hinders=what not in despite and not proposed)
    others: tuple[tuple[str, Any, Any], ...] = (
        ("part", _bytes(old.part), _bytes(new.part)),
        ("tools", sorted(c.id for c in old.cutters), sorted(c.id for c in new.cutters)),
        ("version", old.versions.get("plan_cutters"), new.versions.get("plan_cutters")),
        ("missing", len(old.missing), len(new.missing)),
    )
    for what, mine, theirs in others:
        if mine != theirs:
            yield Change(what=what, old=_text(mine), new=_text(theirs))


def _requested(plan: Plan) -> dict[str, Any]:
    """Answers to what differs here are answers to two questions; by the codes of `model.ASKED`."""
    e = plan.effective
    return {
        "unit": e.unit,
        "faces": (e.faces, *e.ignore, *(["flip"] if e.flip else [])),
        "sampling": {"grid": e.grid, "spacing": e.spacing_mm}.get(e.sampled_by, "default"),
        "postures": (*e.tilt_deg, *e.rotation_deg, e.rotation_step_deg),
        "tolerance": round(e.tolerance_mm, 9),
        "clearance": (e.allowance_mm, e.holder_clearance_mm),
        "machine": (
            plan.machine.name,
            plan.machine.tilt_limit_deg,
            *((a.name, a.carries, a.direction, a.limits_deg) for a in plan.machine.rotary or ()),
        ),
        "setup": [(e.setup, e.placement), *zip(e.other_setups, e.other_placements or [None] * len(e.other_setups), strict=False)],
        "fixtures": [(f.name, _bytes(f), f.unit, f.placement, f.clamping, tuple(f.setups)) for f in plan.fixtures],
    }


def _bytes(entry: PartInfo | FixtureEntry) -> str:
    """A short checksum of a file with all that it refers to; empty where there is no file."""
    return fingerprint(entry.sha256 or "", [(each.file, each.sha256) for each in entry.references])[:12]


def _text(value: Any) -> str:
    """A value in a line, its middle left out where it is long."""
    if isinstance(value, list | tuple):
        text = ", ".join(_text(each) for each in value) or "none"
    else:
        text = "none" if value in (None, "") else f"{value:.9g}" if isinstance(value, float) else str(value)
    return text if len(text) <= 120 else f"{text[:57]} ... {text[-57:]}"


def _rest(entries: Iterable[Any], known: Collection[str]) -> list[Any]:
    names = set(known)
    return [each for each in entries if each.id not in names]


def _face(old: Plan, a: FaceEntry, new: Plan, b: FaceEntry, how: Any, slack: float) -> FaceDifference | None:
    """A face that both have; None where its answer is the same."""
    was, now = face_state(old, a), face_state(new, b)
    loses, wins = falls(was, now, slack), falls(now, was, slack)
    # Which cutters reach all of it is told with each cutter.
    if not (loses or wins) and (was.reach, was.reason) == (now.reach, now.reason):
        return None
    return _face_difference(b, old=a.id, new=b.id, matched_by=how, was=was, now=now, lost=loses, won=wins)


def _faces(
    old: Plan, new: Plan, pairs: Sequence[tuple[FaceEntry, FaceEntry, Any]], slack: float
) -> Iterator[FaceDifference | None]:
    yield from (_face(old, a, new, b, how, slack) for a, b, how in pairs)
    yield from (_gone(old, face) for face in _rest(old.faces, [a.id for a, _, _ in pairs]))
    yield from (_added(new, face) for face in _rest(new.faces, [b.id for _, b, _ in pairs]))


def _cutters(
    old: Plan,
    new: Plan,
    tools: Sequence[tuple[CutterEntry, CutterEntry, Any]],
    pairs: Sequence[tuple[FaceEntry, FaceEntry, Any]],
    slack: float,
) -> Iterator[CutterDifference | None]:
    yield from (_cutter(old, a, new, b, how, pairs, slack) for a, b, how in tools)
    yield from (_one_sided(old, c, None) for c in _rest(old.cutters, [a.id for a, _, _ in tools]))
    yield from (_one_sided(new, None, c) for c in _rest(new.cutters, [b.id for _, b, _ in tools]))


def _gone(plan: Plan, face: FaceEntry) -> FaceDifference:
    was = face_state(plan, face)
    return _face_difference(face, old=face.id, was=was, lost=False, won=False)


def _added(plan: Plan, face: FaceEntry) -> FaceDifference:
    now = face_state(plan, face)
    return _face_difference(face, new=face.id, now=now, lost=_open(now), won=False)


def _open(state: FaceState) -> bool:
    """Whether a face is a target that is not reached whole."""
    return state.reach not in ("reached", "not asked", "inside other bodies")


def _face_difference(face: FaceEntry, **fields: Any) -> FaceDifference:
    """A face as the last plan has it that has it."""
    area = face.area_mm2 if math.isfinite(face.area_mm2) else None
    return FaceDifference(name=face.name, kind=face.kind or face.shape, area_mm2=area, centre_mm=face.centre_mm, **fields)


def _cutter(
    old: Plan,
    a: CutterEntry,
    new: Plan,
    b: CutterEntry,
    how: Any,
    pairs: Iterable[tuple[FaceEntry, FaceEntry, Any]],
    slack: float,
) -> CutterDifference | None:
    """A cutter that both have; None where its form and its answer are the same."""
    was, now = cutter_state(old, a), cutter_state(new, b)
    gone, won = list[tuple[str, str]](), list[tuple[str, str]]()
    for mine, theirs, _ in pairs:
        if mine.target and theirs.target:
            before, after = reached_whole(a.faces.get(mine.id)), reached_whole(b.faces.get(theirs.id))
            if before != after:
                (gone if before else won).append((mine.id, theirs.id))
    forms = [(name, _form(a, name), _form(b, name)) for name in _FORM]
    changes = [Change(what=name, old=before, new=after) for name, before, after in forms if before != after]
    then, today = remaining_area(old, was), remaining_area(new, now)
    # An area that is not known may have grown.
    loses = cutter_falls(was, now, slack, leaves_more=not today - then <= slack * then) or bool(gone)
    wins = cutter_falls(now, was, slack, leaves_more=not then - today <= slack * today) or bool(won)
    if not (loses or wins or changes):
        return None
    return CutterDifference(
        name=called(b), matched_by=how, was=was, now=now, changes=changes, faces_lost=gone, faces_won=won, lost=loses, won=wins
    )


def _form(cutter: CutterEntry, name: str) -> str:
    if name != "stages":
        return _text(getattr(cutter, name))
    return _text(
        [f"{s.part} R{s.radius_mm:.6g}-{s.upper_radius_mm:.6g} x {s.length_mm:.6g} from {s.low_mm:.6g}" for s in cutter.stages]
    )


def _one_sided(plan: Plan, gone: CutterEntry | None, added: CutterEntry | None) -> CutterDifference:
    """A cutter that one plan has: one that finished the part is lost with its going, and won with its coming."""
    was = None if gone is None else cutter_state(plan, gone)
    now = None if added is None else cutter_state(plan, added)
    either = gone or added
    assert either is not None
    return CutterDifference(name=called(either), matched_by=None, was=was, now=now, changes=[], faces_lost=[], faces_won=[],
                            lost=was is not None and bool(was.finishes), won=now is not None and bool(now.finishes))  # fmt: skip


def _worst_face(face: FaceDifference) -> tuple[int, float, int, int]:
    """Order of rows: what is lost, new faces that are not reached, changed, won, new, gone ones; the largest area first."""
    place, share = 2, 1.0
    if face.old is None or face.new is None:
        place = 1 if face.lost else 4 if face.old is None else 5
    elif face.was is not None and face.now is not None and (face.lost or face.won):
        place = 0 if face.lost else 3
        share = abs(face.was.share - face.now.share)
    number, other = (int(each[1:]) if each else 0 for each in (face.new or face.old, face.old))
    return place, -share * (face.area_mm2 or 0.0), number, other


def _worst_cutter(cutter: CutterDifference) -> tuple[int, float, str]:
    """Order of rows: what is lost, then what changed, then what is won; the largest share first."""
    state = cutter.now or cutter.was
    assert state is not None
    share = abs((cutter.was.share if cutter.was else 0.0) - (cutter.now.share if cutter.now else 0.0))
    return (0 if cutter.lost else 2 if cutter.won else 1), -share, state.id
