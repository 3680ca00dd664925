"""Say why a cutter is taken and not another one: its kind comes first, then its size."""

from collections.abc import Sequence

from plan_cutters.domain.preference import is_free_form, rank, ranks
from plan_cutters.plan_file.model import CutterEntry, Plan

_ONE = {"ball": "ball end", "bull": "bull nose", "flat": "flat end", "special": "tapered cutter, barrel, lens or lollipop",
        "last": "engraving, chamfer or form cutter"}  # fmt: skip
_MANY = {"ball": "ball ends", "bull": "bull noses", "flat": "flat ends",
         "special": "tapered cutters, barrels, lenses and lollipops", "last": "engraving, chamfer and form cutters"}  # fmt: skip


def rule(free_form: float) -> str:
    """By which rule a cutter is chosen, for a share of free-form faces."""
    kinds = ", then ".join(_all(groups) for groups in ranks(free_form=free_form))
    return (
        f"kind ({_faces(free_form)}: {kinds}), then largest radius, then smaller corner radius, then shorter length, then "
        "library order, among the feasible"
    )


def why(before: Sequence[str]) -> str:
    """Why the first feasible cutter wins: ids of those that come before it."""
    if not before:
        return "no cutter that was given comes before it"
    come, are = ("comes", "is") if len(before) == 1 else ("come", "are")
    return f"{', '.join(before)} {come} before it but {are} not feasible"


def stands(cutter: str) -> str:
    """Why a cutter comes first that leaves what stands on a proposed table."""
    return f"{cutter} comes first, and leaves only what stands on the table of the proposed setup"


def comes_last(plan: Plan) -> str:
    """The cutter that does alone, where the process has cutters of more wanted kinds before it; else empty."""
    entry = next((each for each in plan.cutters if each.id == plan.selected), None)
    steps = plan.process.steps if plan.process else []
    # Operations are chosen by their time: there only what comes last in any case gives way.
    if entry is None or (entry.group != "last" and any(step.mode != "any" for step in steps)):
        return ""
    return entry.id if {step.cutter for step in steps} - {entry.id} else ""


def first_of(plan: Plan, chosen: CutterEntry, every: str) -> str:
    """Say in sentences that a cutter is the most wanted that reaches everything, and by what; `every` names the samples.

    The kind is told only where cutters of another kind were given that come before or after it.
    """
    number = len(plan.cutters)
    if number == 1:
        return f"It reaches {every}."
    largest, share = f"It is the largest of {number} cutters that reaches {every}.", plan.selection.free_form
    if not chosen.group:
        # A plan of an earlier version ranked by size alone.
        return largest
    mine = _rank(chosen, share)
    present = {_rank(each, share) for each in plan.cutters if each.group}
    groups = {each.group for each in plan.cutters}
    order = [[group for group in rank_ if group in groups] for rank_ in ranks(free_form=share)]
    if present == {mine}:
        return largest
    same = _any(order[mine])
    if before := [rank_ for k, rank_ in enumerate(order) if k < mine and k in present]:
        return f"No {' and no '.join(map(_any, before))} reaches {every}. Of {number} cutters it is the largest {same} that does."
    after = min(present - {mine})
    where = "" if after == len(order) - 1 else f" on {_faces(share)}"
    come = f"{_all(order[mine])} come before {_all(order[after])}"
    return f"Of {number} cutters it is the largest {same} that reaches {every}:{where} {come}."


def _rank(entry: CutterEntry, free_form: float) -> int:
    return rank(entry.group, free_form=free_form)


def _faces(free_form: float) -> str:
    return "free-form faces" if is_free_form(free_form) else "planes, cylinders and cones"


def _any(groups: Sequence[str]) -> str:
    return " or ".join(_ONE[each] for each in groups)


def _all(groups: Sequence[str]) -> str:
    return " and ".join(_MANY[each] for each in groups)
