"""How a plan answers for a face and for a cutter, whatever the order of its cutters."""

from collections.abc import Iterable, Mapping

from plan_cutters.plan_file.model import CutterEntry, FaceEntry, Plan
from plan_cutters.plan_file.shares import AreaShare, FaceVerdicts, VerdictCounts, reached_share
from plan_cutters_ci.model import CutterState, FaceState, Reach

#: Rank of what is reached: to fall is a loss. What is inside other bodies is no surface: neither loss nor gain.
_RANK: dict[Reach, int] = {"reached": 2, "undecided": 1}


def face_state(plan: Plan, face: FaceEntry) -> FaceState:
    """How all cutters together answer for a face: each by itself, for what two reach in turns is in no plan file."""
    if not face.target:
        return FaceState(reach="not asked", share=0.0, cutters=[], reason=None)
    by_cutter = {c.id: c.faces[face.id] for c in plan.cutters if face.id in c.faces}
    if not by_cutter:
        return FaceState(reach="not judged", share=0.0, cutters=[], reason=None)
    if all(not _finished(each) for each in by_cutter.values()):
        return FaceState(reach="inside other bodies", share=0.0, cutters=[], reason=None)
    whole = sorted(name for name, each in by_cutter.items() if reached_whole(each))
    if whole:
        return FaceState(reach="reached", share=1.0, cutters=whole, reason=None)
    best = by_cutter[max(sorted(by_cutter), key=lambda name: (not by_cutter[name].blocked, reached(by_cutter[name])))]
    share = reached(best)
    reach: Reach = "undecided" if not best.blocked else "partly" if share > 0.0 else "not reached"
    if _finished(best) == best.unjudged:
        reach = "not judged"
    return FaceState(reach=reach, share=share, cutters=[], reason=worst(best.area_share.lost_by))


def cutter_state(plan: Plan, cutter: CutterEntry) -> CutterState:
    """How a cutter is answered for, over all setups that were requested."""
    over = plan.selected_over_setups is not None and cutter.lost_in_all == 0
    return CutterState(
        id=cutter.id, finishes=True if over else cutter.feasible, share=reached(cutter), reason=worst(cutter.area_share.lost_by)
    )


def reached(verdicts: FaceVerdicts | CutterEntry) -> float:
    """Share of the area that is reached, 0 to 1; of the samples in plans of older versions, which have no areas."""
    share = verdicts.area_share
    if share == AreaShare():
        return (verdicts.interference_free + verdicts.accessible) / max(1, _finished(verdicts))
    return reached_share(verdicts, share) or 0.0


def reached_whole(verdicts: FaceVerdicts | None) -> bool:
    """Whether every sample of the finished part's surface is judged and reached; nothing is reached where there is none."""
    return verdicts is not None and _finished(verdicts) > 0 and not (verdicts.not_reached or verdicts.unjudged)


def worst(shares: Mapping[str, float]) -> str | None:
    """The reason of the largest share, the first by name of several."""
    return min(shares, key=lambda reason: (-shares[reason], reason), default=None)


def falls(was: FaceState, now: FaceState, slack: float) -> bool:
    """Whether less of a face is reached: by rank, or by more than `slack` of its area."""
    if "inside other bodies" in (was.reach, now.reach):
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


def remaining_area(plan: Plan, state: CutterState) -> float:
    """The area that a cutter leaves of the target faces, mm2; nan where areas are not known."""
    return (1.0 - state.share) * sum(face.area_mm2 for face in _targets(plan))


def unreachable(plan: Plan) -> list[str]:
    """Target faces that no cutter reaches whole, those included that nothing is known of."""
    doubtful = ("reached", "not asked", "inside other bodies")
    return [face.id for face in _targets(plan) if face_state(plan, face).reach not in doubtful]


def _targets(plan: Plan) -> Iterable[FaceEntry]:
    return (face for face in plan.faces if face.target)


def _finished(verdicts: VerdictCounts) -> int:
    judged = verdicts.interference_free + verdicts.accessible + verdicts.inaccessible + verdicts.undecided
    return judged + verdicts.unjudged - verdicts.inside_bodies - verdicts.exempt
