"""Say which faces and samples were judged and which were not, and how much is known between the samples."""

from collections.abc import Mapping

from plan_cutters.domain.figures import joined, mm, percent, size
from plan_cutters.plan_file.model import CutterEntry, Plan
from plan_cutters.plan_file.nearest import nearest
from plan_cutters.plan_file.part_info import Scope

#: Choices that name kinds of faces, not faces.
_BY_KIND = frozenset({"sculptured", "blends", "all"})


def judged(plan: Plan) -> str:
    """The part with its size, or what of it was judged: `the 6 fillets of part.step, 40 x 40 x 20 mm (23 % of the area)`."""
    part, scope = sized(plan, plan.part.file or "the part"), plan.scope
    if scope is None or not scope.not_judged:
        return part
    return f"{_requested(plan, scope)} of {part} ({_share(scope)} of the area)"


def requested(plan: Plan) -> str:
    """Name what of the part was judged, below a line with its name: `the 6 fillets (23 % of the area)`."""
    return f"{_requested(plan, plan.scope)} ({_share(plan.scope)} of the area)" if plan.scope else "the part"


def sized(plan: Plan, part: str) -> str:
    """The name of the part, and its size, which shows a wrong unit at a glance."""
    return f"{part}, {size(plan.part.size_mm)}"


def headline_cutter(plan: Plan) -> CutterEntry:
    """The cutter that the headline is about: the one to take, else the one that leaves the least area."""
    taken = plan.selected or plan.selected_over_setups or plan.selected_for_setup
    return next((c for c in plan.cutters if c.id == taken), None) or nearest(plan.cutters)


def shown_cutter(plan: Plan) -> CutterEntry:
    """The cutter that models and pictures show."""
    return next((c for c in plan.cutters if c.id == plan.shown), None) or nearest(plan.cutters)


def not_judged(plan: Plan) -> list[str]:
    """Say in a sentence which faces were not judged, and which option requests them."""
    scope = plan.scope
    if scope is None or not scope.not_judged:
        return []
    many = scope.not_judged > 1
    what = _listed(scope.not_judged_by_kind)
    return [f"{what} {'were' if many else 'was'} not judged, only {'obstacles' if many else 'an obstacle'}: --faces all."]


def _requested(plan: Plan, scope: Scope) -> str:
    words = {word.strip() for word in plan.effective.faces.split(",")}
    if words <= _BY_KIND:
        return f"the {_listed(scope.judged_by_kind).removeprefix('1 ')}"
    return f"the {scope.judged} faces asked for" if scope.judged > 1 else "the face asked for"


def _listed(kinds: dict[str, int]) -> str:
    """Faces by their kinds: `6 free-form faces, 39 plane and round faces and 12 fillets`."""
    free, blends = kinds.get("sculptured", 0), kinds.get("blend", 0)
    plane = kinds.get("plane", 0)
    others = sum(kinds.values()) - free - blends
    simple = "plane and round" if 0 < plane < others else "plane" if plane else "round"
    each = [_counted(free, "free-form face"), _counted(others, f"{simple} face"), _counted(blends, "fillet")]
    return joined([text for text in each if text])


def _counted(number: int, word: str) -> str:
    return f"{number:,} {word}{'' if number == 1 else 's'}" if number else ""


def _share(scope: Scope) -> str:
    whole = scope.judged_mm2 + scope.not_judged_mm2
    return percent(scope.judged_mm2 / whole if whole > 0.0 else 0.0, some=scope.judged > 0, whole=False)


def unseen(plan: Plan) -> bool:
    """Whether a cutter of the process may miss what lies between the samples; who says how densely to sample asked for that."""
    if plan.effective.sampled_by != "default":
        return False
    used = {step.cutter for step in plan.process.steps} if plan.process else set()
    taken = plan.selected or plan.selected_over_setups
    return any(not c.seen for c in plan.cutters if c.id == taken or (taken is None and c.id in used))


def not_seen(plan: Plan, names: Mapping[str, str]) -> list[str]:
    """Whether more lies between the samples than the cutter to take, or the one that comes nearest, is wide; in a sentence."""
    entry = headline_cutter(plan)
    if entry.seen:
        return []
    widest = max(plan.faces, key=lambda f: f.gap_mm or 0.0)
    on = f" on {widest.id}" if widest.gap_mm else ""
    return [
        f"What lies between the samples was not seen: they are up to {mm(plan.samples.max_gap_mm)} apart{on}, more than the "
        f"radius of {names[entry.id]}, {mm(entry.radius, 4)}. --spacing {entry.radius:.4g} looks more closely."
    ]
