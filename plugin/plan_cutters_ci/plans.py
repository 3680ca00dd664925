"""Compare two plans: what was asked, which faces and which cutters lost or won."""

import math
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Mapping
from typing import Any

from plan_cutters.domain.figures import count
from plan_cutters.plan_file.model import CutterEntry, FaceEntry, Plan
from plan_cutters.plan_file.shares import FaceVerdicts, by_share, reached_share
from plan_cutters.plan_file.words.names import called
from plan_cutters_ci.matching import Matched, match_cutters, match_faces, moved_faces, with_others
from plan_cutters_ci.model import (
    REQUESTED,
    Change,
    CutterDifference,
    CutterState,
    FaceDifference,
    FaceState,
    PlanDifference,
    Reach,
)

#: The old radius of a face and the new one, mm; its old id and the new one, None where a plan has it not.
Radii = tuple[float, float]
Ids = tuple[str | None, str | None]
#: Shares of an area that differ by no more are the same: samples of a changed part lie in other places.
SLACK = 0.001
#: Plans of which fewer faces are known again, as a share of those of the plan with fewer of them, are of two parts, unless so
#: large a share of the area is the same.
UNRELATED = 0.25
#: Entries of a cutter that say how it is made.
_FORM = ("radius", "corner_radius", "length", "shape", "taper_deg", "flutes_mm", "holder", "stages", "allowance_mm",
         "clearance_mm")  # fmt: skip
#: A target face that is in none of these is not reached whole.
_CLOSED: tuple[Reach, ...] = ("reached", "not asked", "inside other bodies", "drilled")
#: Rank of what is reached: to fall is a loss. What is inside other bodies, or for drills, is neither loss nor gain.
_RANK: dict[Reach, int] = {"reached": 2, "undecided": 1}


def compare(old: Plan, new: Plan, *, name: str = "", slack: float = SLACK, despite: Collection[str] = ()) -> PlanDifference:
    """Compare two plans; the same plan twice gives no difference, and in reverse order what was lost is won.

    Faces that one plan has alone are no such matter: a new one that is not reached is lost, and one that is gone is not won.

    Shares, 0 to 1, that differ by no more than `slack` are the same. `despite` codes of `model.REQUESTED` that differ the plans
    are compared.
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
    elif not (
        (pairs and len(pairs) >= UNRELATED * min(len(old.faces), len(new.faces))) or _same_area(old, new, pairs) >= UNRELATED
    ):
        why_not.append(
            f"of {count(len(old.faces), 'face')} of the old plan and {len(new.faces)} of the new one {len(pairs) or 'none'} "
            f"{'are' if len(pairs) > 1 else 'is'} known again: they seem to be of two parts"
        )
    if not tools:
        why_not.append("no cutter of the old plan is known again in the new one")
    radii = _other_radii(old, new, pairs)
    all_faces = (_face(old, a, new, b, how, slack, radii) for a, b, how in with_others(old.faces, new.faces, pairs))
    all_cutters = (_cutter(old, a, new, b, how, pairs, slack) for a, b, how in with_others(old.cutters, new.cutters, tools))
    faces, cutters = sorted(filter(None, all_faces), key=_worst_face), sorted(filter(None, all_cutters), key=_worst_cutter)
    rows: list[FaceDifference | CutterDifference] = [*faces, *cutters]
    return PlanDifference(
        name=name, comparable=not why_not, why_not=why_not, changes=changes, selected=(taken(old), taken(new)),
        matched=dict(sorted(Counter(str(how) for _, _, how in pairs).items())), faces=faces, cutters=cutters,
        unreachable=unreachable(new), lost=any(each.lost for each in rows), won=any(each.won for each in rows),
    )  # fmt: skip


def _same_area(old: Plan, new: Plan, pairs: Matched) -> float:
    """The share of the area of either plan that is the same at the same place."""
    same, shares = [(a.id, b.id) for a, b, how in pairs if how == "place"], []
    for plan, names in zip((old, new), zip(*same, strict=True), strict=False):
        area = {face.id: face.area_mm2 for face in plan.faces if math.isfinite(face.area_mm2)}
        shares.append(sum(area.get(name, 0.0) for name in names) / max(sum(area.values()), 1e-300))
    return min(shares, default=0.0)


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
    others: dict[str, Callable[[Plan], Any]] = {
        "part": lambda plan: (plan.part.sha256 or "")[:12], "tools": lambda plan: sorted(c.id for c in plan.cutters),
        "version": lambda plan: plan.versions.get("plan_cutters"), "missing": lambda plan: len(plan.missing),
    }  # fmt: skip
    for what, value in others.items():
        if value(old) != value(new):
            yield Change(what=what, old=_text(value(old)), new=_text(value(new)))


def _requested(plan: Plan) -> dict[str, Any]:
    """Answers to what differs here are answers to two questions; by the codes of `model.REQUESTED`."""
    e = plan.effective
    return {
        "unit": e.unit,
        "faces": (e.faces, *e.ignore, *(["flip"] if e.flip else [])),
        "sampling": {"grid": e.grid, "spacing": e.spacing_mm}.get(e.sampled_by, "default"),
        "postures": (*e.tilt_deg, *e.rotation_deg, e.rotation_step_deg),
        "tolerance": round(e.tolerance_mm, 9),
        "clearance": (e.allowance_mm, e.holder_clearance_mm),
        "machine": (plan.machine.name, plan.machine.tilt_limit_deg,
                    *((a.name, a.carries, a.direction, a.limits_deg) for a in plan.machine.rotary or ())),
        "setup": [(e.setup, e.placement), *zip(e.other_setups, e.other_placements or [None] * len(e.other_setups), strict=False)],
        "fixtures": [(f.name, (f.sha256 or "")[:12], f.unit, f.placement, f.clamping, tuple(f.setups)) for f in plan.fixtures],
    }  # fmt: skip


def _text(value: Any) -> str:
    """A value in a line, its middle left out where it is long."""
    if isinstance(value, list | tuple):
        text = ", ".join(_text(each) for each in value) or "none"
    else:
        text = "none" if value in (None, "") else f"{value:.9g}" if isinstance(value, float) else str(value)
    return text if len(text) <= 120 else f"{text[:57]} ... {text[-57:]}"


def _face(
    old: Plan, a: FaceEntry | None, new: Plan, b: FaceEntry | None, how: Any, slack: float, radii: Mapping[Ids, Radii]
) -> FaceDifference | None:
    """A face as the last plan has it that has it; None where both have it and its answer is the same.

    Of those that one plan has a new target that is not reached whole is lost, and one that is gone is not won.
    """
    was, now = None if a is None else face_state(old, a), None if b is None else face_state(new, b)
    if was and now:
        loses, wins = falls(was, now, slack), falls(now, was, slack)
        # Which cutters reach all of it is told with each cutter.
        if not (loses or wins) and (was.reach, was.reason) == (now.reach, now.reason):
            return None
    else:
        loses, wins = now is not None and now.reach not in _CLOSED, False
    face, ids = b or a, (a.id if a else None, b.id if b else None)
    assert face is not None
    return FaceDifference(
        old=ids[0], new=ids[1], matched_by=how, name=face.name, kind=face.kind or face.shape,
        area_mm2=face.area_mm2 if math.isfinite(face.area_mm2) else None, centre_mm=face.centre_mm, was=was, now=now, lost=loses,
        won=wins, radius_mm=radii.get(ids),
    )  # fmt: skip


def _other_radii(old: Plan, new: Plan, pairs: Matched) -> dict[Ids, Radii]:
    """Radii, by their ids, of faces of one shape of which each plan has one alone, among mostly the same faces."""
    again = {a.id: b.id for a, b, _ in pairs}
    theirs = {*again.values()}
    came = [(face, radius) for face in new.faces if face.id not in theirs and (radius := _radius(face))]
    radii: dict[Ids, Radii] = {}
    for face in old.faces:
        if face.id in again or not (radius := _radius(face)):
            continue
        neighbours = {again[name] for name in face.neighbours or () if name in again}
        for other, its in came:
            same = neighbours & {*(other.neighbours or ())}
            if other.shape == face.shape and 2 * len(same) > len(neighbours) > 1 and not math.isclose(radius, its, rel_tol=1e-4):
                radii |= {(face.id, None): (radius, its), (None, other.id): (radius, its)}
    return radii


def _radius(face: FaceEntry) -> float | None:
    """Of a cylinder or sphere, or of the tube of a torus, mm."""
    return None if face.carrier is None else face.carrier.minor_radius_mm or face.carrier.radius_mm


def _cutter(
    old: Plan, a: CutterEntry | None, new: Plan, b: CutterEntry | None, how: Any, pairs: Matched, slack: float
) -> CutterDifference | None:
    """A cutter that one plan has, or both; None where its form and its answer are the same.

    Of those that one plan has one that finished the part is lost with its going, and won with its coming.
    """
    was, now = None if a is None else cutter_state(old, a), None if b is None else cutter_state(new, b)
    gone, won, changes = list[tuple[str, str]](), list[tuple[str, str]](), list[Change]()
    if a and b and was and now:
        for mine, theirs, _ in pairs:
            if mine.target and theirs.target:
                before, after = reached_whole(a.faces.get(mine.id)), reached_whole(b.faces.get(theirs.id))
                if before != after:
                    (gone if before else won).append((mine.id, theirs.id))
        forms = zip(_FORM, *([_text(_formed(each, name)) for name in _FORM] for each in (a, b)), strict=True)
        changes = [Change(what=name, old=before, new=after) for name, before, after in forms if before != after]
        # What a cutter leaves of the target faces, mm2; nan where areas are not known.
        then, today = ((1.0 - state.share) * sum(face.area_mm2 for face in plan.faces if face.target)
                       for plan, state in ((old, was), (new, now)))  # fmt: skip
        # An area that is not known may have grown.
        loses = cutter_falls(was, now, slack, leaves_more=not today - then <= slack * then) or bool(gone)
        wins = cutter_falls(now, was, slack, leaves_more=not then - today <= slack * today) or bool(won)
        if not (loses or wins or changes):
            return None
    else:
        loses, wins = was is not None and bool(was.finishes), now is not None and bool(now.finishes)
    one = b or a
    assert one is not None
    return CutterDifference(
        name=called(one), matched_by=how, was=was, now=now, changes=changes, faces_lost=gone, faces_won=won, lost=loses, won=wins
    )


def _formed(cutter: CutterEntry, name: str) -> Any:
    stages = [
        f"{s.part} R{s.radius_mm:.6g}-{s.upper_radius_mm:.6g} x {s.length_mm:.6g} from {s.low_mm:.6g}" for s in cutter.stages
    ]
    return stages if name == "stages" else getattr(cutter, name)


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


def face_state(plan: Plan, face: FaceEntry) -> FaceState:
    """How all cutters together answer for a face: each by itself, for what two reach in turns is in no plan file."""
    by_cutter = {c.id: c.faces[face.id] for c in plan.cutters if face.id in c.faces}
    if not face.target or not any(each.required for each in by_cutter.values()):
        none: Reach = "not asked" if not face.target else "inside other bodies" if by_cutter else "not judged"
        if face.target and any(each.drilled for each in by_cutter.values()):
            none = "drilled"
        return FaceState(reach=none, share=0.0, cutters=[], reason=None)
    whole = sorted(name for name, each in by_cutter.items() if reached_whole(each))
    if whole:
        return FaceState(reach="reached", share=1.0, cutters=whole, reason=None)
    best = by_cutter[max(sorted(by_cutter), key=lambda name: (not by_cutter[name].blocked, reached(by_cutter[name])))]
    share = reached(best)
    reach: Reach = "undecided" if not best.blocked else "partly" if share > 0.0 else "not reached"
    if best.required == best.unjudged:
        reach = "not judged"
    return FaceState(reach=reach, share=share, cutters=[], reason=worst(best.area_share.lost_by))


def cutter_state(plan: Plan, cutter: CutterEntry) -> CutterState:
    """How a cutter is answered for, over all setups that were requested."""
    over = plan.selected_over_setups is not None and cutter.lost_in_all == 0
    return CutterState(
        id=cutter.id, finishes=True if over else cutter.feasible, share=reached(cutter), reason=worst(cutter.area_share.lost_by)
    )


def reached(verdicts: FaceVerdicts | CutterEntry) -> float:
    """Share of the area that is reached, 0 to 1."""
    return reached_share(verdicts, verdicts.area_share) or 0.0


def reached_whole(verdicts: FaceVerdicts | None) -> bool:
    """Whether every sample of the finished part's surface is judged and reached; nothing is reached where there is none."""
    return verdicts is not None and verdicts.required > 0 and verdicts.required == verdicts.reached


def worst(shares: Mapping[str, float]) -> str | None:
    """The reason of the largest share, the first by name of several."""
    return next((reason for reason, _ in by_share(shares)), None)


def falls(was: FaceState, now: FaceState, slack: float) -> bool:
    """Whether less of a face is reached: by rank, or by more than `slack` of its area."""
    if {"inside other bodies", "drilled"}.intersection((was.reach, now.reach)):
        return False
    before, after = _RANK.get(was.reach, 0), _RANK.get(now.reach, 0)
    return after < before or (after == before and was.share - now.share > slack)


def cutter_falls(was: CutterState, now: CutterState, slack: float, *, leaves_more: bool = True) -> bool:
    """Whether a cutter finishes less: no more, no more for sure, or by more than `slack` of the area.

    `leaves_more`: whether the area that it leaves grew. Of a part from which reached faces were taken away a smaller share is
    reached, and nothing was lost.
    """
    rank = {True: 2, None: 1, False: 0}
    before, after = rank[was.finishes], rank[now.finishes]
    return after < before or (leaves_more and was.share - now.share > slack)


def unreachable(plan: Plan) -> list[str]:
    """Target faces that no cutter reaches whole, those included that nothing is known of."""
    return [face.id for face in plan.faces if face.target and face_state(plan, face).reach not in _CLOSED]
